// / truncates towards 0, % has the sign of the left operand.
// quotient(7, 2) == 3: 3.5
// quotient(-7, 2) == -3: -3.5
// quotient(7, -2) == -3: -3.5
// remainder(-7, 2) == -1: -7 - 2 * -3
// remainder(7, -2) == 1: 7 - -2 * -3
// unsigned_quotient() == 32764: -7 is 65529, / 2
// long_quotient() == -33333: -100000 / 3
// long_remainder() == -1: -100000 + 99999
// by_unsigned() == 21843: -7 becomes 65529, / 3
int quotient(int a, int b)
{
    return a / b;
}
int remainder(int a, int b)
{
    return a % b;
}
unsigned int unsigned_quotient(void)
{
    unsigned int a = -7;
    return a / 2;
}
long long_quotient(void)
{
    long a = -100000;
    return a / 3;
}
long long_remainder(void)
{
    long a = -100000;
    return a % 3;
}
unsigned int by_unsigned(void)
{
    int a = -7;
    unsigned int b = 3;
    return a / b;
}
