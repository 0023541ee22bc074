// continue in a for runs the step.
// odd(6) == 9: 1 + 3 + 5
// nested() == 12: three times the four values 0, 1, 3, 4 of k
int odd(int n)
{
    int i, sum = 0;
    for (i = 0; i < n; i++) {
        if (i % 2 == 0)
            continue;
        sum += i;
    }
    return sum;
}
int nested(void)
{
    int i, k, n = 0;
    for (i = 0; i < 3; i++)
        for (k = 0; k < 5; k++) {
            if (k == 2)
                continue;
            n++;
        }
    return n;
}
