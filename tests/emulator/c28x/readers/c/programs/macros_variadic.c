// __VA_ARGS__ takes the rest of the arguments, commas too; empty arguments; #__VA_ARGS__.
// three() == 6: 1 + 2 + 3
// empty() == 5: an empty argument leaves nothing
// avr: what # makes is no wide string there
// text() == 3: 1, comma, blank, 2: the length 4, less 1
static int add(int a, int b, int c)
{
    return a + b + c;
}
#define CALL(f, ...) f(__VA_ARGS__)
#define TEXT(...) #__VA_ARGS__
#define PREFIX(a) a 5
int three(void)
{
    return CALL(add, 1, 2, 3);
}
int text(void)
{
    const char *s = TEXT(1, 2);
    int n = 0;
    while (s[n])
        n++;
    return n - 1;
}
int empty(void)
{
    return PREFIX();
}
