// break in an if, in a block or behind code leaves the switch; in a loop within a case it leaves the loop.
// f(1, 0) == 110: case 1 goes on behind the if: 10, then 100 behind the switch
// f(1, 1) == 100: the break skips the 10
// f(2, 3) == 103: the loop within case 2 ends at 3, then 100
// f(2, 9) == 105: the loop within case 2 runs to 5
// falls(1, 1) == 1: break in the if, no fall-through
// falls(1, 0) == 3: 1, then falls into case 2
int f(int x, int y)
{
    int r = 0, i;
    switch (x) {
    case 1:
        if (y) {
            if (y == 1)
                break;
            r = 1000;
        }
        r += 10;
        break;
    case 2:
        for (i = 0; i < 5; i++) {
            if (i == y)
                break;
        }
        r = i;
        break;
    }
    return r + 100;
}
int falls(int x, int y)
{
    int r = 0;
    switch (x) {
    case 1:
        r += 1;
        if (y)
            break;
    case 2:
        r += 2;
    }
    return r;
}
