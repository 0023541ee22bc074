// ?: evaluates one of its two values; the result has the common type of both.
// effects(1) == 10: only a is incremented: 1 * 10 + 0
// effects(0) == 1: only b
// nested(-7) == -1: first test
// nested(0) == 0: second
// nested(7) == 1: neither
// common() == 1: -1 as unsigned int (the other value is unsigned) is greater than 0
// wide() == 65535: the unsigned int 65535 becomes a long
// floats() == 2.0: the int 2 becomes a float
// target() == 23: *(1 ? &a : &b) = 2: a = 2, b = 3
int effects(int which)
{
    int a = 0, b = 0;
    which ? a++ : b++;
    return a * 10 + b;
}
int nested(int x)
{
    return x < 0 ? -1 : x == 0 ? 0 : 1;
}
int common(void)
{
    int yes = 1, minus = -1;
    unsigned int zero = 0;
    return (yes ? minus : zero) > 0;
}
long wide(void)
{
    int yes = 1;
    unsigned int u = 65535u;
    long l = 5;
    return yes ? u : l;
}
float floats(void)
{
    int yes = 1, two = 2;
    float f = 0.5f;
    return yes ? two : f;
}
int target(void)
{
    int a = 1, b = 3, yes = 1;
    *(yes ? &a : &b) = 2;
    return a * 10 + b;
}
