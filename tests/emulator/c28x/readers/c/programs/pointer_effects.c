// *p++, (*p)++, *++p, ++*p; copying with *p++ = *q++.
// copy() == 123: the three values, copied
// until_zero() == 3: a copy that stops at the 0, which is copied too
// four() == 1423: *p++ is 1; (*p)++ is 2 and makes v[1] 3; *++p is 4; ++*--p is v[1] + 1 = 4, less 1
static const int from[4] = { 1, 2, 3, 0 };
static int to[4];
int copy(void)
{
    const int *q = from;
    int *p = to;
    int n = 3;
    while (n-- > 0)
        *p++ = *q++;
    return to[0] * 100 + to[1] * 10 + to[2];
}
int until_zero(void)
{
    const int *q = from;
    int *p = to;
    while ((*p++ = *q++) != 0)
        ;
    return (int)(p - to) - 1;
}
int four(void)
{
    int v[4] = { 1, 2, 4, 8 };
    int *p = v;
    int a, b, c, d;
    a = *p++;
    b = (*p)++;
    c = *++p;
    d = ++*--p - 1;
    return a * 1000 + c * 100 + b * 10 + d;
}
