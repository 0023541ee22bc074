// Initialiser lists: with inner braces, without them, and partly; what is not named is 0.
// nested() == 123456: the rows 1 2 3 and 4 5 6
// flat() == 123456: the same values in one row
// partial() == 1040: the rows 1 0 and 4 0, since braces begin a new one
// partial_flat() == 1240: without inner braces the values follow each other: 1 2 / 4 0
// local() == 700: locals too: 7 0 0
// zero() == 0: { 0 } clears all
// counted() == 4: the length comes from the list
static const int a[2][3] = { { 1, 2, 3 }, { 4, 5, 6 } };
static const int b[2][3] = { 1, 2, 3, 4, 5, 6 };
static const int c[2][2] = { { 1 }, { 4 } };
static const int d[2][2] = { 1, 2, 4 };
static const int n[] = { 9, 8, 7, 6, };
static long digits(const int *p, int count)
{
    long r = 0;
    while (count-- > 0)
        r = r * 10 + *p++;
    return r;
}
long nested(void)
{
    return digits(a[0], 3) * 1000 + digits(a[1], 3);
}
long flat(void)
{
    return digits(b[0], 3) * 1000 + digits(b[1], 3);
}
int partial(void)
{
    return c[0][0] * 1000 + c[0][1] * 100 + c[1][0] * 10 + c[1][1];
}
int partial_flat(void)
{
    return d[0][0] * 1000 + d[0][1] * 100 + d[1][0] * 10 + d[1][1];
}
int local(void)
{
    int v[3] = { 7 };
    return v[0] * 100 + v[1] * 10 + v[2];
}
int zero(void)
{
    int v[4] = { 0 };
    return v[0] + v[1] + v[2] + v[3];
}
int counted(void)
{
    return sizeof(n) / sizeof(n[0]);
}
