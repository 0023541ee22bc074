// Assigning a structure copies all of it, arrays within too; the two are separate then.
// f() == 159: b keeps 1 5 9 while a changes
// elements() == 21: list[1] = list[0], then list[0] changes
// through_pointers() == 34: *p = *q
// chain() == 99: a = b = c
struct s { int x; int v[2]; };
static struct s list[2] = { { 1, { 0, 0 } }, { 0, { 0, 0 } } };
int f(void)
{
    struct s a = { 1, { 5, 9 } }, b;
    b = a;
    a.x = 7;
    a.v[1] = 7;
    return b.x * 100 + b.v[0] * 10 + b.v[1];
}
int elements(void)
{
    list[0].x = 1;
    list[1] = list[0];
    list[0].x = 2;
    return list[0].x * 10 + list[1].x;
}
int through_pointers(void)
{
    struct s a = { 3, { 4, 0 } }, b = { 0, { 0, 0 } };
    struct s *p = &b, *q = &a;
    *p = *q;
    return b.x * 10 + b.v[0];
}
int chain(void)
{
    struct s a, b, c = { 99, { 0, 0 } };
    a = b = c;
    return a.x;
}
