// Arrays of arrays: rows lie behind each other; a row decays to a pointer; three dimensions.
// sum() == 21: 1 + 2 + 3 + 4 + 5 + 6
// row() == 5: m[1] is a pointer to 4; [1] of it
// flat() == 6: m + 1 is the second row, + 2 its third element
// three() == 123: t[1][0][1]
// written() == 12: row 2, column 1 holds 2 * 5 + 1, plus 1
static const int m[2][3] = { { 1, 2, 3 }, { 4, 5, 6 } };
static const int t[2][2][2] = { { { 1, 2 }, { 3, 4 } }, { { 5, 123 }, { 7, 8 } } };
int sum(void)
{
    int i, k, s = 0;
    for (i = 0; i < 2; i++)
        for (k = 0; k < 3; k++)
            s += m[i][k];
    return s;
}
int row(void)
{
    const int *p = m[1];
    return p[1];
}
int flat(void)
{
    return *(*(m + 1) + 2);
}
int three(void)
{
    return t[1][0][1];
}
int written(void)
{
    int a[3][2];
    int i, k;
    for (i = 0; i < 3; i++)
        for (k = 0; k < 2; k++)
            a[i][k] = i * 5 + k;
    return a[2][1] + 1;
}
