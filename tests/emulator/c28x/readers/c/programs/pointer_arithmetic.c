// p + n, p - n, p += n, p - q count elements; p[n] is *(p + n), n[p] too; a negative index is behind.
// f() == 405: v[4] is 40 and v[1] 10: 40 * 10 + 10 / 2
// difference() == 3: elements, not words: of long
// negative() == 10: q[-1]
// commuted() == 20: 2[v]
// step() == 30: p = v + 4; p -= 1
// end() == 100: p < end is the usual loop: 0 + 10 + 20 + 30 + 40
// signed_offset() == 10: v + i - 1 for the unsigned i = 2
// structures() == 6: p + 1 steps over a whole structure
static int v[5] = { 0, 10, 20, 30, 40 };
static long w[4] = { 1, 2, 3, 4 };
struct s { int a; long b; };
static struct s list[2] = { { 1, 2 }, { 5, 6 } };
int f(void)
{
    int *p = v;
    return *(p + 4) * 10 + p[1] / 2;
}
int difference(void)
{
    long *p = &w[3], *q = w;
    return (int)(p - q);
}
int negative(void)
{
    int *q = v + 2;
    return q[-1];
}
int commuted(void)
{
    return 2[v];
}
int step(void)
{
    int *p = v + 4;
    p -= 1;
    return *p;
}
int end(void)
{
    const int *p, *last = v + 5;
    int sum = 0;
    for (p = v; p < last; p++)
        sum += *p;
    return sum;
}
int signed_offset(void)
{
    unsigned int i = 2;
    return *(v + i - 1);
}
long structures(void)
{
    struct s *p = list;
    return (p + 1)->b;
}
