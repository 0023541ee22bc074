// Shifts: logical for unsigned, arithmetic for signed values; the type is the left operand's.
// left(3, 4) == 48: 3 * 16
// top_lost() == 65280: 0xFFFF << 8 in 16 bits
// logical() == 4095: 0xFFFF >> 4
// arithmetic() == -2: -16 >> 3
// long_left(1, 20) == 1048576: 2^20
// long_right() == -1: -70000 >> 20
// octets() == 4660: (0x12 << 8) | 0x34
// by_long() == 8: the count's type does not widen the left operand
unsigned int left(unsigned int x, int n)
{
    return x << n;
}
unsigned int top_lost(void)
{
    unsigned int x = 0xFFFF;
    return x << 8;
}
unsigned int logical(void)
{
    unsigned int x = 0xFFFF;
    return x >> 4;
}
int arithmetic(void)
{
    int x = -16;
    return x >> 3;
}
long long_left(long x, int n)
{
    return x << n;
}
long long_right(void)
{
    long x = -70000;
    return x >> 20;
}
unsigned int octets(void)
{
    unsigned char high = 0x12, low = 0x34;
    return (high << 8) | low;
}
unsigned int by_long(void)
{
    unsigned int x = 0x8001;
    return x << 3L;
}
