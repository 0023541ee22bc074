/* The middle of an even number of values, one too high. */
float middle(const float *sorted, int n)
{
    if (n % 2)
        return sorted[n / 2];
    return (sorted[n / 2] + sorted[n / 2 + 1]) / 2; /* DEFECT */
}

int main(void)
{
    float v[4] = {1, 2, 3, 4};
    return middle(v, 4) < 0;
}
