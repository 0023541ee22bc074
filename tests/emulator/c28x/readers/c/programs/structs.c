// Structures: nested, with arrays, pointers to themselves, an anonymous type, &s.member, array of structures.
// nested() == 35: inner.x 3, inner.y 5
// list() == 6: 1 + 2 + 3 over next
// anonymous() == 9: an object of a type without a name
// member_address() == 8: through &o.inner.y
// array_member() == 20: o.v[1] by a pointer to o
// negative_offset() == 4: the element before, by index
struct inner { int x, y; };
struct outer { int id; struct inner inner; int v[3]; };
struct link { int value; struct link *next; };
static struct { int a, b; } pair = { 4, 5 };
static struct outer o = { 1, { 3, 5 }, { 10, 20, 30 } };
static struct link third = { 3, 0 }, second = { 2, &third }, first = { 1, &second };
static struct inner points[3] = { { 1, 2 }, { 3, 4 }, { 5, 6 } };
int nested(void)
{
    struct outer *p = &o;
    p->inner.y = 5;
    return p->inner.x * 10 + o.inner.y;
}
int list(void)
{
    const struct link *p;
    int sum = 0;
    for (p = &first; p; p = p->next)
        sum += p->value;
    return sum;
}
int anonymous(void)
{
    return pair.a + pair.b;
}
int member_address(void)
{
    int *p = &o.inner.y;
    *p = 8;
    return o.inner.y;
}
int array_member(void)
{
    struct outer *p = &o;
    return p->v[1];
}
int negative_offset(void)
{
    struct inner *p = &points[2];
    return p[-1].y;
}
