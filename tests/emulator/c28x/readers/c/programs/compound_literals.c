// (type){ values } is an object without a name.
// structure() == 12: 1 * 10 + 2
// array() == 30: the third value
// assigned() == 70: a structure set as a whole; y is left 0
// address() == 5: its address may be taken
struct point { int x, y; };
static int both(struct point p)
{
    return p.x * 10 + p.y;
}
int structure(void)
{
    return both((struct point){ 1, 2 });
}
int array(void)
{
    const int *p = (int[]){ 10, 20, 30 };
    return p[2];
}
int assigned(void)
{
    struct point p;
    p = (struct point){ .x = 7 };
    return both(p);
}
int address(void)
{
    int *p = &(int){ 4 };
    ++*p;
    return *p;
}
