// An assignment is an expression of the type and value of what was assigned to.
// chain() == 33: x = y = z = 11, their sum
// narrowed() == 4464: 70000 through an unsigned int: 70000 - 65536
// through_float() == 3: y is 3 after the float 3.75 went through an int
// in_test(5) == 5: the value is tested
// in_test(0) == -1: zero is false
int chain(void)
{
    int x, y, z;
    x = y = z = 11;
    return x + y + z;
}
long narrowed(void)
{
    long a;
    unsigned int b;
    a = b = (unsigned int)70000;
    return a + (b - b);
}
int through_float(void)
{
    int i;
    float f;
    f = i = (int)3.75f;
    return (int)f;
}
int in_test(int n)
{
    int x;
    if ((x = n) != 0)
        return x;
    return -1;
}
