// Structures as parameters and results are copies.
// parameter() == 71: the callee's copy is 7, the caller's x is still 1
// result() == 34: 3, 4
// member_of_result() == 4: make(3, 4).y
// both() == 46: add(make(1, 2), make(3, 4)): 4, 6
// array_inside() == 10: an array within goes along: 1 + 2 + 3 + 4
// recursive(4) == 10: 4 + 3 + 2 + 1, each level has its own
struct point { int x, y; };
struct block { int v[4]; };
static int change(struct point p)
{
    p.x = 7;
    return p.x;
}
static struct point make(int x, int y)
{
    struct point p;
    p.x = x;
    p.y = y;
    return p;
}
static struct point add(struct point a, struct point b)
{
    a.x += b.x;
    a.y += b.y;
    return a;
}
static int sum(struct block b)
{
    return b.v[0] + b.v[1] + b.v[2] + b.v[3];
}
static struct point down(struct point p)
{
    struct point below;
    if (p.x == 0)
        return p;
    below = down(make(p.x - 1, p.y + p.x));
    return below;
}
int parameter(void)
{
    struct point p = { 1, 2 };
    return change(p) * 10 + p.x;
}
int result(void)
{
    struct point p = make(3, 4);
    return p.x * 10 + p.y;
}
int member_of_result(void)
{
    return make(3, 4).y;
}
int both(void)
{
    struct point p = add(make(1, 2), make(3, 4));
    return p.x * 10 + p.y;
}
int array_inside(void)
{
    struct block b = { { 1, 2, 3, 4 } };
    return sum(b);
}
int recursive(int n)
{
    return down(make(n, 0)).y;
}
