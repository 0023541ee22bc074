// Function pointers: with and without & and *, as parameters, in tables and structures; compared; returned.
// plain(3) == 9: three times 3
// star(3) == 9: (*f)(3) is the same
// table(2, 10) == 8: subtract: 10 - 2
// parameter() == 25: apply(square, 5)
// member() == 6: through a member of a structure, by a pointer
// choose(1) == 7: 5 + 2
// choose(0) == 3: 5 - 2
// compare() == 1: equal to itself, not to another
// null() == 1: a null function pointer is false
static int triple(int x)
{
    return 3 * x;
}
static int square(int x)
{
    return x * x;
}
static int plus(int a, int b)
{
    return a + b;
}
static int minus(int a, int b)
{
    return a - b;
}
static int times(int a, int b)
{
    return a * b;
}
static int (*const operations[])(int, int) = { plus, times, minus };
struct handler { int id; int (*run)(int); };
static const struct handler handlers[] = { { 1, triple }, { 2, &square } };
int plain(int x)
{
    int (*f)(int) = triple;
    return f(x);
}
int star(int x)
{
    int (*f)(int) = &triple;
    return (*f)(x);
}
int table(int which, int x)
{
    return operations[which](x, 2);
}
static int apply(int (*f)(int), int x)
{
    return f(x);
}
int parameter(void)
{
    return apply(square, 5);
}
int member(void)
{
    const struct handler *h = handlers;
    return h->run(2);
}
static int (*pick(int add))(int, int)
{
    return add ? plus : minus;
}
int choose(int add)
{
    return pick(add)(5, 2);
}
int compare(void)
{
    int (*f)(int) = triple;
    return f == triple && f != square;
}
int null(void)
{
    int (*f)(int) = 0;
    return !f;
}
