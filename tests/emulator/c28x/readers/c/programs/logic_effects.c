// && and || stop at what decides; their result is 0 or 1.
// and_stops() == 0: the right side is not evaluated, n stays 0
// and_goes() == 11: 1 and n = 1
// or_stops() == 10: 1 and n = 0
// or_goes() == 11: 1 and n = 1
// value(5, 7) == 1: never 7
// not_not(5) == 1: !!5
// three() == 102: 1 && (n = 1) && (n = 2): result 1, n = 2
// float_test(0.5) == 1: 0.5 is not 0, though it is as an int
static int n;
static int bump(int result)
{
    n++;
    return result;
}
int and_stops(void)
{
    n = 0;
    return (0 && bump(1)) * 10 + n;
}
int and_goes(void)
{
    n = 0;
    return (n == 0 && bump(5)) * 10 + n;
}
int or_stops(void)
{
    n = 0;
    return (n == 0 || bump(1)) * 10 + n;
}
int or_goes(void)
{
    int r;
    n = 0;
    r = n || bump(3);
    return r * 10 + n;
}
int value(int a, int b)
{
    return a && b;
}
int not_not(int a)
{
    return !!a;
}
int three(void)
{
    int r;
    n = 0;
    r = n == 0 && (n = 1) && (n = 2);
    return r * 100 + n;
}
int float_test(float x)
{
    if (x && !0.0f)
        return 1;
    return 0;
}
