// The type of a constant, by its size, base and suffix; shown by what arithmetic gives.
// decimal() == 40000: 40000 does not fit an int, so it is a long: 40000 * 2 - 40000
// hexadecimal() == 1: 0xFFFF fits an unsigned int: + 1 is 0
// hexadecimal_int() == 32767: 0x7FFF is an int
// octal() == 8: 010
// octal_unsigned() == 1: 0177777 is 65535, an unsigned int: + 1 is 0
// suffix_u() == 1: -1 < 1u is false, since 1u is unsigned
// suffix_l() == 70000: 35000L * 2
// suffix_ul() == 1: 0 - 1ul is above 1
// minus_32768() == 1: 32768 is a long, so - 32768 is one too: below -32767 as a number
// long_hexadecimal() == 1: 0x10000 is a long: 0x10000 - 0x10001 is below 0
// unsigned_long_hexadecimal() == 1: 0x80000000 is an unsigned long: - it is itself
// character() == 97: 'a' is an int
// two_escapes() == 10: '\n'
// floating() == 0.25: 1e-2f * 25
// big_decimal() == 1: 2147483648 is a long long: - 1 - it is -1
// parts() == 3: both cases of x, u and l: 3 + 0 + 3 - 3
long decimal(void)
{
    return 40000 * 2 - 40000;
}
int hexadecimal(void)
{
    return 0xFFFF + 1 == 0;
}
int hexadecimal_int(void)
{
    return 0x7FFF;
}
int octal(void)
{
    return 010;
}
int octal_unsigned(void)
{
    return 0177777 + 1 == 0;
}
int suffix_u(void)
{
    return !(-1 < 1u);
}
long suffix_l(void)
{
    return 35000L * 2;
}
int suffix_ul(void)
{
    return 0 - 1ul > 1;
}
int minus_32768(void)
{
    return -32768 < -32767;
}
int long_hexadecimal(void)
{
    return 0x10000 - 0x10001 < 0;
}
int unsigned_long_hexadecimal(void)
{
    return -0x80000000 == 0x80000000;
}
int character(void)
{
    return 'a';
}
int two_escapes(void)
{
    return '\n';
}
float floating(void)
{
    return 0.01e2f * 25 / 100;
}
int big_decimal(void)
{
    return 2147483648 - 1 - 2147483648 == -1;
}
int parts(void)
{
    return 0x3u + 0X0L + 3Ul - 3;
}
