// A static local keeps its value between calls; each function and each block has its own.
// thrice() == 3: 1, 2, 3
// own() == 102: the counter of `other` begins at 100 and is another object
// table(2) == 30: a constant table within a function
// starts_at_zero() == 0: { 0 } clears both elements
static int counter(void)
{
    static int n = 0;
    n++;
    return n;
}
static int other(void)
{
    static int n = 100;
    return ++n;
}
int thrice(void)
{
    counter();
    counter();
    return counter();
}
int own(void)
{
    counter();
    other();
    return other();
}
int table(int i)
{
    static const int t[] = { 10, 20, 30 };
    return t[i];
}
int starts_at_zero(void)
{
    static int n[2] = { 0 };
    return n[0] + n[1];
}
