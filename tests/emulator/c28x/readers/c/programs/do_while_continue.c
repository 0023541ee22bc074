// continue in do-while goes to the test, not to the body.
// f() == 44: i runs 1..5, the sum leaves out 3: 1 + 2 + 4 + 5 = 12; test evaluated 5 times: 12 + 32 = 44
// g() == 1: continue at once, the test 0 ends it
int f(void)
{
    int i = 0, sum = 0, tests = 0;
    do {
        i++;
        if (i == 3)
            continue;
        sum += i;
    } while (++tests < 5);
    return sum + (tests == 5 ? 32 : 0);
}
int g(void)
{
    int n = 0;
    do {
        n++;
        continue;
    } while (0);
    return n;
}
