/* A sum without a first value. */
float average(const float *v, int n)
{
    float sum;
    int i;
    for (i = 0; i < n; i++)
        sum += v[i]; /* DEFECT */
    return sum / n;
}

int main(void)
{
    float v[3] = {1.0f, 2.0f, 3.0f};
    return average(v, 3) > 1000.0f;
}
