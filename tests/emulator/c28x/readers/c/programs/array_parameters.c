// An array parameter is a pointer: the callee writes the caller's array; a matrix is a pointer to rows.
// written() == 7: the callee's 7
// sized() == 6: v[3] says nothing about the length; 1 + 2 + 3
// matrix() == 10: 1 + 2 + 3 + 4
// moved() == 2: the parameter itself may be moved
static void set(int v[], int i, int x)
{
    v[i] = x;
}
static int sum(const int v[3], int n)
{
    int s = 0;
    while (n > 0)
        s += v[--n];
    return s;
}
static int total(int m[][2], int rows)
{
    int i, s = 0;
    for (i = 0; i < rows; i++)
        s += m[i][0] + m[i][1];
    return s;
}
static int second(const int v[])
{
    v++;
    return *v;
}
int written(void)
{
    int a[2] = { 0, 0 };
    set(a, 1, 7);
    return a[1] + a[0];
}
int sized(void)
{
    static const int a[3] = { 1, 2, 3 };
    return sum(a, 3);
}
int matrix(void)
{
    int m[2][2] = { { 1, 2 }, { 3, 4 } };
    return total(m, 2);
}
int moved(void)
{
    static const int a[3] = { 1, 2, 3 };
    return second(a);
}
