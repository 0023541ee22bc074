// Arrays of structures and structures of arrays, with and without inner braces; compound values in locals.
// sum() == 21: 1 + 2 + 3 + 4 + 5 + 6
// mixed() == 12340: id 1, v = 2 3, next id 4, v = 0 0
// local(5) == 56: { n, n + 1 }: not constant, in a local
// copied() == 34: a local initialised by another object of the type
struct pair { int a, b; };
struct row { int id; int v[2]; };
static const struct pair pairs[3] = { { 1, 2 }, { 3, 4 }, { 5, 6 } };
static const struct row rows[2] = { 1, { 2, 3 }, { 4 } };
int sum(void)
{
    int i, s = 0;
    for (i = 0; i < 3; i++)
        s += pairs[i].a + pairs[i].b;
    return s;
}
int mixed(void)
{
    return rows[0].id * 10000 + rows[0].v[0] * 1000 + rows[0].v[1] * 100 + rows[1].id * 10 + rows[1].v[1];
}
int local(int n)
{
    struct pair p = { n, n + 1 };
    return p.a * 10 + p.b;
}
int copied(void)
{
    struct pair p = pairs[1];
    p.a = 3;
    return p.a * 10 + p.b;
}
