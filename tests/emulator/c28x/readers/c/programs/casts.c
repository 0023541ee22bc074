// Casts between arithmetic types: the value modulo 2^n, or truncated.
// to_int() == -25536: 40000 - 65536
// to_unsigned() == 65535: of -1
// low_word() == 22136: 0x12345678 & 0xFFFF = 0x5678
// high_word() == 4660: shifted down first
// sign_then_wide() == -1: (long)(int)0xFFFF
// wide_then_sign() == 65535: (long)0xFFFFu
// float_to_int() == 3: 3.99
// of_expression() == 1: (int)(1.5 + 0.25)
// precedence() == 2.5: (float)5 / 2: the cast binds stronger
// to_char() == 300: a char has 16 bits
// bool_like() == 1: !!0x100 does not get lost
int to_int(void)
{
    long x = 40000;
    return (int)x;
}
unsigned int to_unsigned(void)
{
    int x = -1;
    return (unsigned int)x;
}
unsigned int low_word(void)
{
    long x = 0x12345678;
    return (unsigned int)x;
}
int high_word(void)
{
    long x = 0x12345678;
    return (int)(x >> 16);
}
long sign_then_wide(void)
{
    unsigned int x = 0xFFFF;
    return (long)(int)x;
}
long wide_then_sign(void)
{
    unsigned int x = 0xFFFF;
    return (long)x;
}
int float_to_int(void)
{
    float f = 3.99f;
    return (int)f;
}
int of_expression(void)
{
    float f = 1.5f;
    return (int)(f + 0.25f);
}
float precedence(void)
{
    int n = 5;
    return (float)n / 2;
}
int to_char(void)
{
    int x = 300;
    return (unsigned char)x;
}
int bool_like(void)
{
    int x = 0x100;
    return !!x;
}
