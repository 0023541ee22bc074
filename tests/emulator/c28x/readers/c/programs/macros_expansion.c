// The order of expansion, as ISO C 6.10.3 has it.
// twice() == 34: INC within an argument of INC: 32 + 1 + 1
// paste_first() == 7: ## joins before the result is expanded: NAME is 7
// blue() == 5: A becomes B and B becomes A, which is not replaced again within itself
// avr: what # makes is no wide string there
// once() == 3: # takes N as it stands, one letter; XSTR expands it first, to 12, two letters
#define N 12
#define STR(a) #a
#define XSTR(a) STR(a)
#define INC(x) ((x) + 1)
#define NAME 7
#define GLUE(a, b) a ## b
static int length(const char *s)
{
    int n = 0;
    while (*s++)
        n++;
    return n;
}
int once(void)
{
    return length(STR(N)) + length(XSTR(N));
}
int twice(void)
{
    return INC(INC(32));
}
int paste_first(void)
{
    return GLUE(NA, ME);
}
int blue(void)
{
    int A = 5;
#define A B
#define B A
    return A;
}
