// The common type of two operands, at 16, 32 and 64 bits.
// int_unsigned() == 1: -1 becomes 65535u, above 1
// long_unsigned() == 1: long holds every unsigned int: -1L < 1u
// long_unsigned_long() == 0: -1 becomes 4294967295, not below 1
// product() == 24464: 300 * 300 = 90000 in unsigned 16 bits: 90000 - 65536
// wide_product() == 90000: one operand is a long
// late() == 24464: widened behind the product
// subtract() == 65535: 1u - 2u as a long: it was made in 16 bits
// subtract_long() == -1: 1u - 2L
// float_int() == 2.5: the int becomes a float
// char_plus_long() == 65537: 65536L + 1
// sum_of_long_and_unsigned() == 4294967295: -1L + 0ul is 2^32 - 1
int int_unsigned(void)
{
    int a = -1;
    unsigned int b = 1;
    return a > b;
}
int long_unsigned(void)
{
    long a = -1;
    unsigned int b = 1;
    return a < b;
}
int long_unsigned_long(void)
{
    long a = -1;
    unsigned long b = 1;
    return a < b;
}
unsigned int product(void)
{
    unsigned int a = 300;
    return a * a;
}
long wide_product(void)
{
    int a = 300;
    return (long)a * a;
}
unsigned long late(void)
{
    unsigned int a = 300;
    return a * a;
}
long subtract(void)
{
    unsigned int a = 1, b = 2;
    return a - b;
}
long subtract_long(void)
{
    unsigned int a = 1;
    long b = 2;
    return a - b;
}
float float_int(void)
{
    int a = 2;
    return a + 0.5f;
}
long char_plus_long(void)
{
    char c = 1;
    return c + 65536L;
}
unsigned long sum_of_long_and_unsigned(void)
{
    long a = -1;
    unsigned long b = 0;
    return a + b;
}
