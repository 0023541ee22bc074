// ++ and op= on members, through a pointer too; the pointer's own ++ binds weaker than ->.
// f() == 322: count 1 -> 2 -> 3; old value 2 of the post increment; w.x 2
// through() == 62: p->count++ twice, 4 + 2; p->x *= 2 gives 2
// next() == 9: p++->x is 4, then p->x is 5
// before() == 5: (++p)->x
struct item { int count; int x; };
static struct item a = { 1, 2 };
static struct item list[2] = { { 0, 4 }, { 0, 5 } };
int f(void)
{
    struct item w = { 1, 2 };
    int old;
    ++w.count;
    old = w.count++;
    return w.count * 100 + old * 10 + w.x;
}
int through(void)
{
    struct item *p = &a;
    p->count = 4;
    p->x = 1;
    p->count++;
    ++p->count;
    p->x *= 2;
    return a.count * 10 + a.x;
}
int next(void)
{
    struct item *p = list;
    int first = p++->x;
    return first + p->x;
}
int before(void)
{
    struct item *p = list;
    return (++p)->x;
}
