/* A sum that 16 bits do not hold. */
int mean(const int *v, int n)
{
    int sum = 0, i;
    for (i = 0; i < n; i++)
        sum += v[i]; /* DEFECT */
    return sum / n;
}

int main(void)
{
    int v[100], i;
    for (i = 0; i < 100; i++)
        v[i] = 400;
    return mean(v, 100) != 400;
}
