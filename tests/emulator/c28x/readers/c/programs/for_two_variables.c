// Comma in the first and the last part of a for.
// f() == 20: i * k for 0 * 5, 1 * 4, 2 * 3 is 10; i and k are 3 and 2 at the end: 10 + 6 + 4
int f(void)
{
    int i, k, sum = 0;
    for (i = 0, k = 5; i < k; i++, k--)
        sum += i * k;
    return sum + i * k + 4;
}
