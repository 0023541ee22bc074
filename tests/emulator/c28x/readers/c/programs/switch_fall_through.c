// Without break the next case's statements run, whatever its label.
// f(1) == 7: 1 + 2 + 4, all three
// f(2) == 6: 2 + 4
// f(3) == 4: the last only
// f(4) == 0: no case
// shared(2) == 1: cases 1, 2 and 3 share a body
// shared(4) == 0: the default
// into_default(1) == 11: 1, then the default's 10
// out_of_default(7) == 30: the default's 10, then case 2's 20
int f(int x)
{
    int r = 0;
    switch (x) {
    case 1:
        r += 1;
    case 2:
        r += 2;
    case 3:
        r += 4;
    }
    return r;
}
int shared(int x)
{
    switch (x) {
    case 1:
    case 2:
    case 3:
        return 1;
    default:
        return 0;
    }
}
int into_default(int x)
{
    int r = 0;
    switch (x) {
    case 1:
        r += 1;
    default:
        r += 10;
    }
    return r;
}
int out_of_default(int x)
{
    int r = 0;
    switch (x) {
    case 1:
        r = 1;
        break;
    default:
        r += 10;
    case 2:
        r += 20;
    }
    return r;
}
