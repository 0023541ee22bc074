// A switch with a default, in the middle too.
// f(1) == 10: its case
// f(2) == 20: its case
// f(9) == 99: the default
// middle(5) == 50: its case stands behind the default
// middle(6) == -1: no case, so the default, though it is not the last
// none(3) == 7: no case and no default: nothing happens
int f(int x)
{
    switch (x) {
    case 1:
        return 10;
    case 2:
        return 20;
    default:
        return 99;
    }
}
int middle(int x)
{
    int r = 0;
    switch (x) {
    case 1:
        r = 10;
        break;
    default:
        r = -1;
        break;
    case 5:
        r = 50;
        break;
    }
    return r;
}
int none(int x)
{
    int r = 7;
    switch (x) {
    case 1:
        r = 1;
        break;
    }
    return r;
}
