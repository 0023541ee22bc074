// continue in a switch belongs to the loop around; break to the switch.
// f() == 1432: r is 1 at i = 0, unchanged at 1, 14 at 2, 143 at 3, 1432 at 4
// first_zero() == 2: the loop ends by its own test, which the switch sets
int v[4] = { 5, 6, 0, 0 };
int f(void)
{
    int i, r = 0;
    for (i = 0; i < 5; i++) {
        switch (i) {
        case 1:
            continue;
        case 0:
            r += 1;
            break;
        case 2:
            r = r * 10 + 4;
            break;
        default:
            if (i == 4) {
                r = r * 10 + 2;
                continue;
            }
            r = r * 10 + 3;
        }
    }
    return r;
}
int first_zero(void)
{
    int i = 0, going = 1;
    while (going) {
        switch (v[i]) {
        case 0:
            going = 0;
            break;
        default:
            i++;
            break;
        }
    }
    return i;
}
