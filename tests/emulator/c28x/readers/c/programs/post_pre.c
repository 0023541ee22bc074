// i++ gives the old value, ++i the new one; the same for --.
// f() == 4653: a = 4 and i is 5; b = i = 6; c = 6 and i is 5; d = i = 4: the digits a, b, c - 1, d - 1
// unsigned_wrap() == 65535: 0 - 1 in 16 bits
// long_post() == 70001: the old value is added to 1
int f(void)
{
    int i = 4, a, b, c, d;
    a = i++;
    b = ++i;
    c = i--;
    d = --i;
    return a * 1000 + b * 100 + (c - 1) * 10 + d - 1;
}
unsigned int unsigned_wrap(void)
{
    unsigned int u = 0;
    u--;
    return u;
}
long long_post(void)
{
    long n = 70000, old;
    old = n++;
    return old + (n - old);
}
