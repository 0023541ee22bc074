// A test with an effect is evaluated before each turn and once more at the end.
// f(5) == 1505: the sum 4 + 3 + 2 + 1 + 0 = 10; n is -1 at the end: 10 * 150 + 6 - 1
// g() == 8: 3 + 5 before the 0; p stops behind the 0, 3 elements on: + 3 - 3
int v[4] = { 3, 5, 0, 9 };
int f(int n)
{
    int sum = 0;
    while (n--)
        sum += n;
    return sum * 150 + 6 + n;
}
int g(void)
{
    const int *p = v;
    int sum = 0, x;
    while ((x = *p++) != 0)
        sum += x;
    return sum + (int)(p - v) - 3;
}
