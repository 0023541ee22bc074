// The comma operator: left, then right, whose value it has.
// f() == 12: a = 3, then b = a + 1 = 4; the value is a * b
// in_test(4) == 24: the product 4 * 3 * 2 * 1
// argument() == 9: one argument, its value the right one
int f(void)
{
    int a, b, c;
    c = (a = 3, b = a + 1, a * b);
    return c;
}
int in_test(int n)
{
    int r = 1, k;
    while (k = n--, k > 0)
        r *= k;
    return r;
}
static int same(int x)
{
    return x;
}
int argument(void)
{
    int x = 0;
    return same((x = 4, x + 5));
}
