// Pointers and integers of their width are cast into each other; words of a wider object through a pointer.
// round_trip() == 7: through an unsigned long and back
// distance() == 0: the same address twice
// low_word() == 22136: 0x5678 of 0x12345678 comes first
// high_word() == 4660: 0x1234
// write_high() == 65536: word 1 is 1
// float_words() == 16320: 0x3FC0, the upper word of 1.5f
// is_zero() == 1: the null pointer as a number
int round_trip(void)
{
    int x = 7;
    unsigned long address = (unsigned long)&x;
    return *(int *)address;
}
int distance(void)
{
    int x = 7;
    return (int)((unsigned long)&x - (unsigned long)(void *)&x);
}
unsigned int low_word(void)
{
    long x = 0x12345678;
    return *(unsigned int *)&x;
}
unsigned int high_word(void)
{
    long x = 0x12345678;
    return ((unsigned int *)&x)[1];
}
long write_high(void)
{
    long x = 0;
    unsigned int *p = (unsigned int *)&x;
    p[1] = 1;
    return x;
}
unsigned int float_words(void)
{
    float f = 1.5f;
    unsigned int *p = (unsigned int *)&f;
    return *(p + 1);
}
int is_zero(void)
{
    int *p = 0;
    return (unsigned long)p == 0;
}
