// float32 arithmetic, each operation rounded; conversions to and from integers truncate.
// tenth_sum() == 1.0000001192092896: ten times 0.1f, each sum rounded to 24 bits: 0x3F800001
// truncated() == -2: -2.9 to int
// from_int() == 16777216.0: 16777217 needs 25 bits, ties to even
// precedence() == 7.0: 1 + 2 * 3
// division() == 0.5: 1 / 2 in float
// int_division() == 0.0: 1 / 2 in int, then converted
// negative() == -0.25: unary minus
// third() == 0.3333333432674408: 1 / 3 in 24 bits: 0x3EAAAAAB
// compound() == 4.5: 3 * 1.5
// increment() == 2.5: ++ adds 1 to a float too
// big() == 100000: a float holds it exactly
float tenth_sum(void)
{
    float s = 0.0f;
    int i;
    for (i = 0; i < 10; i++)
        s += 0.1f;
    return s;
}
int truncated(void)
{
    float f = -2.9f;
    return (int)f;
}
float from_int(void)
{
    long n = 16777217;
    return n;
}
float precedence(void)
{
    float a = 1, b = 2, c = 3;
    return a + b * c;
}
float division(void)
{
    float a = 1;
    return a / 2;
}
float int_division(void)
{
    int a = 1;
    return a / 2;
}
float negative(void)
{
    float a = 0.25f;
    return -a;
}
float third(void)
{
    float a = 1.0f;
    return a / 3.0f;
}
float compound(void)
{
    float a = 3.0f;
    a *= 1.5f;
    return a;
}
float increment(void)
{
    float a = 0.5f;
    a++;
    ++a;
    return a;
}
long big(void)
{
    float a = 1e5f;
    return (long)a;
}
