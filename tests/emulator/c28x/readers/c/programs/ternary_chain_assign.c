// Assignments and calls within ?:, && and ||, in the order of C.
// f(1) == 101: a = 1 is the value, b stays 0
// f(0) == 20: b = 2
// guard(0) == 0: the division is not reached
// guard(4) == 1: 12 / 4 > 2
// first(5) == 5: the first that is not 0
// first(0) == 7: the second
static int x;
int f(int n)
{
    int a = 0, b = 0, r;
    r = n ? (a = 1) : (b = 2);
    return a * 100 + b * 10 + (n ? r : 0);
}
int guard(int n)
{
    return n != 0 && 12 / n > 2;
}
int first(int n)
{
    int r;
    (r = n) || (r = 7);
    x = r;
    return x;
}
