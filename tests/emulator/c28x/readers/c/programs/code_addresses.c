// The address of a function as a number, and back; a void * holds one too.  C28x: 22 bits, in a long.
// back() == 9: the square of 3
// through_void() == 25: the square of 5
// same() == 1: one function has one address, two have two, and none is 0
static int square(int x)
{
    return x * x;
}
static int cube(int x)
{
    return x * x * x;
}
int back(void)
{
    unsigned long address = (unsigned long)square;
    return ((int (*)(int))address)(3);
}
int through_void(void)
{
    void *p = (void *)square;
    return ((int (*)(int))p)(5);
}
int same(void)
{
    void *p = (void *)square;
    return (unsigned long)square == (unsigned long)&square && (unsigned long)p == (unsigned long)square
        && (unsigned long)square != (unsigned long)cube && (unsigned long)cube != 0;
}
