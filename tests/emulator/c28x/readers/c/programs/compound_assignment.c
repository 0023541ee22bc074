// Every op=; the target is evaluated once; the operation is done in the common type.
// all() == 5: ((((20 + 4 - 2) * 3 / 4) % 9) << 2 >> 1 & 14 | 1) ^ 10: 22, 66, 16, 7, 28, 14, 14, 15, 5
// once() == 15: f is called once, v[1] is 5 + 10
// wide() == -32768: the sum is made in long, 16384 + 16384 = 32768, then becomes an int: - 65536
// mixed() == 7: int *= float: 3 * 2.5 = 7.5, stored as 7
// shift() == 96: the right operand is a long, the left one stays int
int calls;
int v[3] = { 1, 5, 9 };
static int f(void)
{
    calls++;
    return 1;
}
int all(void)
{
    int x = 20;
    x += 4;
    x -= 2;
    x *= 3;
    x /= 4;
    x %= 9;
    x <<= 2;
    x >>= 1;
    x &= 14;
    x |= 1;
    x ^= 10;
    return x;
}
int once(void)
{
    calls = 0;
    v[1] = 5;
    v[f()] += 10;
    return calls == 1 ? v[1] : -1;
}
int wide(void)
{
    int x = 16384;
    x += 16384L;
    return x;
}
int mixed(void)
{
    int x = 3;
    x *= 2.5f;
    return x;
}
int shift(void)
{
    int x = 3;
    x <<= 5L;
    return x;
}
