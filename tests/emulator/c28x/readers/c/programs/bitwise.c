// & | ^ ~ and what binds stronger: comparison before &, + before <<.
// masks() == 62: (0x3C & 0x0F | 0x30) ^ 0x02: 0x0C, 0x3C, 0x3E
// complement() == -1: ~0
// complement_long() == 4294901760: ~0xFFFFul
// binds() == 1: 2 == 2 is 1, 3 & 1
// shift_binds() == 24: 3 << (1 + 2)
// set_and_clear() == 9: bit 3 set, bit 1 cleared of 3
int masks(void)
{
    int x = 0x3C;
    return (x & 0x0F | 0x30) ^ 0x02;
}
int complement(void)
{
    int x = 0;
    return ~x;
}
unsigned long complement_long(void)
{
    unsigned long x = 0xFFFFul;
    return ~x;
}
int binds(void)
{
    int x = 3;
    return x & 2 == 2;
}
int shift_binds(void)
{
    int x = 3;
    return x << 1 + 2;
}
int set_and_clear(void)
{
    unsigned int x = 3;
    x |= 1u << 3;
    x &= ~(1u << 1);
    return x;
}
