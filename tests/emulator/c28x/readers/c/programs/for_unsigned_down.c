// An unsigned variable counts down to 0 with a test before the decrement.
// f() == 10: the values used are 4, 3, 2, 1, 0
// last() == 65535: the last test decrements 0, which wraps in 16 bits
unsigned int v[5] = { 0, 1, 2, 3, 4 };
unsigned int f(void)
{
    unsigned int i = 5, sum = 0;
    while (i-- > 0)
        sum += v[i];
    return sum;
}
unsigned int last(void)
{
    unsigned int i = 5;
    while (i-- > 0)
        ;
    return i;
}
