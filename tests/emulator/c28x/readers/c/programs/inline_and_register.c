// static inline, register and __inline, __interrupt: words that change no value.
// f(4) == 12: twice 4 plus 4
// g() == 6: 0 + 1 + 2 + 3
static inline int twice(int x)
{
    return 2 * x;
}
static __inline int same(int x)
{
    return x;
}
int f(int x)
{
    return twice(x) + same(x);
}
int g(void)
{
    register int i, sum = 0;
    for (i = 0; i < 4; i++)
        sum += i;
    return sum;
}
