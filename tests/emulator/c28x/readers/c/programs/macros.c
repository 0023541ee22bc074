// Macros: arguments, nested ones, # and ##, several lines, a macro named like a function without a call.
// max(3, 9) == 9: the larger
// nested() == 16: SQUARE(SQUARE(2))
// precedence() == 11: without parentheses 1 + 2 * 5 is what stands there
// pasted() == 42: value_1 ## 2
// text() == 97: #a is the string of one a
// lines(4) == 8: do { } while (0) over several lines
// not_called() == 3: the name alone is the function
// itself() == 8: a macro is not replaced within itself
// arguments() == 6: parentheses hold the commas of an argument together
#define MAX(a, b) ((a) > (b) ? (a) : (b))
#define SQUARE(x) ((x) * (x))
#define SUM 1 + 2
#define JOIN(a, b) a ## b
#define TEXT(a) #a
#define TWICE(x)        \
    do {                \
        (x) += (x);     \
    } while (0)
#define ADD(a, b) ((a) + (b))
#define counter counter + 1
int value_12 = 42;
int max(int a, int b)
{
    return MAX(a, b);
}
int nested(void)
{
    return SQUARE(SQUARE(2));
}
int precedence(void)
{
    return SUM * 5;
}
int pasted(void)
{
    return JOIN(value_, 12);
}
int text(void)
{
    return TEXT(a)[0];
}
int lines(int x)
{
    if (x)
        TWICE(x);
    else
        x = 1;
    return x;
}
static int (same)(int x)
{
    return x;
}
#define same(x) ((x) + 100)
int not_called(void)
{
    int (*f)(int) = same;
    return f(3);
}
int itself(void)
{
#undef counter
    int counter = 7;
#define counter counter + 1
    return counter;
#undef counter
}
static int first(int a, int b)
{
    return a;
}
int arguments(void)
{
    return ADD(first(1, 2), (3, 5));
}
