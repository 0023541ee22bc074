// Arguments with effects, each on another object; a call within an index and within an assignment's target.
// f() == 12: a = 1 and b = 2 are passed, both are incremented
// in_target() == 42: v[1] = 42
// nested(2) == 9: square(square(2) - 1) = 3 * 3
int v[3];
static int two(int a, int b)
{
    return a * 10 + b;
}
static int one(void)
{
    return 1;
}
static int square(int x)
{
    return x * x;
}
int f(void)
{
    int a = 1, b = 2, r;
    r = two(a++, b++);
    return a == 2 && b == 3 ? r : -1;
}
int in_target(void)
{
    v[one()] = 42;
    return v[1];
}
int nested(int x)
{
    return square(square(x) - 1);
}
