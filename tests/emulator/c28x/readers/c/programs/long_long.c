// 64-bit integers: arithmetic, shifts, comparison, conversion both ways, constants.
// product() == 10000000000: 100000 * 100000
// add_wraps() == 0: 2^64 - 1 + 1, unsigned
// quotient() == -3333333333: -10000000000 / 3, truncated
// remainder() == -1: -10000000000 - 3 * -3333333333
// shift(40) == 1099511627776: 2^40
// shift_right() == -1: an arithmetic shift of -2^40 by 60
// logical() == 15: 2^64 - 1 shifted by 60
// narrowed() == 1410065408: 10000000000 - 2 * 2^32
// sign_extended() == -5: from int
// zero_extended() == 65535: from unsigned int
// compare() == 1: 2^40 > 2^39 though their low words are equal
// mixed() == 1: long long holds every unsigned long: -1 < 1ul
// to_float() == 1099511627776.0: exactly
// from_float() == 8589934592: 2^33
// increments() == 4294967296: 2^32 - 1, incremented
// bits() == 1311768465173141112: 0x1234567812345678
long long product(void)
{
    long long a = 100000;
    return a * a;
}
unsigned long long add_wraps(void)
{
    unsigned long long a = 0xFFFFFFFFFFFFFFFFULL;
    return a + 1;
}
long long quotient(void)
{
    long long a = -10000000000LL;
    return a / 3;
}
long long remainder(void)
{
    long long a = -10000000000LL;
    return a % 3;
}
long long shift(int n)
{
    return 1LL << n;
}
long long shift_right(void)
{
    long long a = -1099511627776LL;
    return a >> 60;
}
unsigned long long logical(void)
{
    unsigned long long a = ~0ULL;
    return a >> 60;
}
unsigned long narrowed(void)
{
    long long a = 10000000000LL;
    return (unsigned long)a;
}
long long sign_extended(void)
{
    int i = -5;
    return i;
}
long long zero_extended(void)
{
    unsigned int u = 65535u;
    return u;
}
int compare(void)
{
    long long a = 1099511627776LL, b = 549755813888LL;
    return a > b;
}
int mixed(void)
{
    long long a = -1;
    unsigned long b = 1;
    return a < b;
}
float to_float(void)
{
    long long a = 1099511627776LL;
    return a;
}
long long from_float(void)
{
    float f = 8589934592.0f;
    return (long long)f;
}
unsigned long long increments(void)
{
    unsigned long long a = 4294967295u;
    a++;
    return a;
}
unsigned long long bits(void)
{
    unsigned long long a = 0x12345678UL;
    return a << 32 | a;
}
