// Under the COFF ABI a double is a float: constants without f too.
// constant() == 0.10000000149011612: 0.1 in 24 bits
// same() == 1: 0.1 and 0.1f are one value
// sum() == 0.30000001192092896: 0.1 + 0.2 in 24 bits: 0x3E99999A
// lost() == 16777216.0: 16777216 + 1, rounded to even
double constant(void)
{
    return 0.1;
}
int same(void)
{
    double d = 0.1;
    float f = 0.1f;
    return d == f;
}
double sum(void)
{
    double a = 0.1, b = 0.2;
    return a + b;
}
double lost(void)
{
    double a = 16777216.0;
    return a + 1.0;
}
