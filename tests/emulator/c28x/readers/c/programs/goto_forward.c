// `goto` forward: it leaves blocks, loops and switches for a label behind them.
static int log_of[20], logged;
static void note(int what) { log_of[logged++] = what; }

// started(-1) == 9: nothing was begun, so only the last step is undone
// started(1) == 1289: the second step fails, the first one is undone
// started(5) == 12389: both are begun
int started(int steps)
{
    int i, sum = 0;
    logged = 0;
    if (steps < 0) goto out;
    note(1);
    if (steps < 2) { note(2); goto undo; }
    int late = 2;
    note(late);
    note(3);
undo:
    note(8);
out:
    note(9);
    for (i = 0; i < logged; i++) sum = sum * 10 + log_of[i];
    return sum;
}
// searched(7) == 12: row 1, column 2 of the table
// searched(8) == -1: it is not there
int searched(int what)
{
    static const int table[2][3] = { { 1, 2, 3 }, { 5, 6, 7 } };
    int row, column, found = -1;
    for (row = 0; row < 2; row++) {
        column = 0;
        while (1) {
            switch (column) {
            case 3: break;
            default: if (table[row][column] == what) goto found_it;
            }
            if (column == 3) break;
            column++;
        }
    }
    goto out;
found_it:
    found = row * 10 + column;
out:
    return found;
}
// skipped(4) == 14: turns 0 and 2 give 1 each, turn 1 gives 1, turn 3 gives 11
int skipped(int turns)
{
    int i, sum = 0;
    for (i = 0; i < turns; i++) {
        if (i % 2 == 0) goto next;
        if (i == 1) { sum += 1; continue; }
        sum += 10;
next:
        sum += 1;
    }
    return sum;
}
// in_a_case(1) == 1010: the label is in the case
// in_a_case(2) == 1000: a break of the switch from among the statements before the label
// in_a_case(3) == 1037: neither
// in_a_case(4) == 4: out of the switch and the function's rest
int in_a_case(int which)
{
    int r = 0;
    switch (which) {
    case 1:
    case 2:
    case 3: {
        if (which == 1) goto ten;
        if (which == 2) break;
        r = 27;
ten:
        r += 10;
        break;
    }
    default:
        do { if (++r == which) goto end; } while (r < 10);
    }
    r += 1000;
end:
    return r;
}
