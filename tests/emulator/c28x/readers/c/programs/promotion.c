// Integer promotion on this chip: unsigned char has 16 bits, so it promotes to unsigned int; char is a signed int.
// below() == 65535: 0 - 1 in unsigned int
// never() == 0: (a - b) < 0 is false for unsigned chars
// negative_less() == 0: -1 becomes 65535, which is not below 5
// complement() == 65280: ~0x00FF in 16 bits
// no_octet() == 256: 255 + 1 fits an unsigned char
// char_sum() == -6: a char is signed and has 16 bits: -3 - 3
// short_is_int() == -32768: a short has 16 bits
// minus() == 65531: -5 of an unsigned char is 65536 - 5
// as_long() == 65535: the difference is made in 16 bits, then widened without a sign
unsigned int below(void)
{
    unsigned char a = 0;
    return a - 1;
}
int never(void)
{
    unsigned char a = 3, b = 5;
    return (a - b) < 0;
}
int negative_less(void)
{
    unsigned char a = 5;
    int m = -1;
    return m < a;
}
unsigned int complement(void)
{
    unsigned char a = 0xFF;
    return ~a;
}
int no_octet(void)
{
    unsigned char a = 255;
    a = a + 1;
    return a;
}
int char_sum(void)
{
    char a = -3;
    return a + a;
}
int short_is_int(void)
{
    short s = -32767;
    s = s - 1;
    return s;
}
unsigned int minus(void)
{
    unsigned char a = 5;
    return -a;
}
long as_long(void)
{
    unsigned char a = 4, b = 5;
    return a - b;
}
