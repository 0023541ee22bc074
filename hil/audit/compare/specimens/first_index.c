/* The element before the first one. */
int changes(const int *v, unsigned char n)
{
    unsigned char i;
    int count = 0;
    for (i = 0; i < n; i++)
        if (v[i - 1] != v[i]) /* DEFECT */
            count++;
    return count;
}

int main(void)
{
    int v[4] = {1, 1, 2, 2};
    return changes(v, 4) > 4;
}
