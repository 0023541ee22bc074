// Declarators read from the inside out; several in one declaration; storage and type words in any order.
// several() == 16: 1 + *p + v[1] + f(4): 1 + 1 + 10 + 4
// words() == 6: long unsigned int, unsigned long, int static long: 1 + 2 + 3
// array_of_pointers() == 2: int *v[2]
// function_returning_pointer() == 7: int *f(void)
// pointer_to_function_returning_pointer() == 7: called through
// parenthesised() == 3: (x) is x
int several(void)
{
    int x = 1, *p = &x, v[2] = { 5, 10 }, f(int);
    return x + *p + v[1] + f(4);
}
int f(int x)
{
    return x;
}
int words(void)
{
    long unsigned int a = 1;
    unsigned long b = 2;
    int static long c = 3;
    return (int)(a + b + c);
}
int array_of_pointers(void)
{
    int x = 1, y = 2;
    int *v[2];
    v[0] = &x;
    v[1] = &y;
    return *v[1];
}
static int seven = 7;
static int *where(void)
{
    return &seven;
}
int function_returning_pointer(void)
{
    return *where();
}
int pointer_to_function_returning_pointer(void)
{
    int *(*g)(void) = where;
    return *g();
}
int parenthesised(void)
{
    int (x) = 3;
    return ((x));
}
