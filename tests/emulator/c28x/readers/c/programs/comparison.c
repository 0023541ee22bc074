// Comparisons give the int 0 or 1, so a < b < c compares that.
// chained() == 1: (5 < 3) is 0, 0 < 2
// sum() == 2: two of three hold
// long_compare() == 1: 65536L > 1, though its low word is 0
// mixed_sign() == 1: -1 == 65535u in 16 bits
// pointers() == 1: within one array the address grows with the index
// floats() == 6: 0.5 < 0.75 twice 2, and 0.5 == 0.5 twice 1
int chained(void)
{
    int a = 5, b = 3, c = 2;
    return a < b < c;
}
int sum(void)
{
    int a = 1, b = 2;
    return (a < b) + (a == b) + (a != b);
}
int long_compare(void)
{
    long a = 65536L;
    return a > 1;
}
int mixed_sign(void)
{
    int a = -1;
    unsigned int b = 65535u;
    return a == b;
}
int pointers(void)
{
    int v[3] = { 0, 0, 0 };
    int *p = v, *q = v + 3;
    return p < q && q >= p && p != q && p <= v;
}
int floats(void)
{
    float a = 0.5f, b = 0.75f;
    return (a < b) * 2 + (b > a) * 2 + (a == 0.5f) + (a <= a);
}
