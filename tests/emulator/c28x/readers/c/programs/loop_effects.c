// Effects in the parts of a for and in tests with && and ||.
// f() == 1234: the test assigns and compares; digits until the 0
// g(3) == 3: the index moves in the test: v[0..2] are not 0, v[3] is
// h() == 55: the whole work is done in the for's own parts
static const int v[] = { 1, 2, 3, 4, 0 };
static const int w[] = { 7, 7, 7, 0, 7 };
int f(void)
{
    int i, x, r = 0;
    for (i = 0; (x = v[i++]) != 0 && i < 9;)
        r = r * 10 + x;
    return r;
}
int g(int n)
{
    int i = 0;
    while (i < n + 1 && w[i] != 0)
        i++;
    return i;
}
int h(void)
{
    int i, s;
    for (i = 1, s = 0; i <= 10; s += i, i++)
        ;
    return s;
}
