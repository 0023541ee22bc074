// An index with an effect, on both sides.
// f() == 312: n is 3, v[0] is 1, v[1] is 2
// store() == 570: v[0] is 5, v[1] is 7, i is 2, less 2
int v[3];
int f(void)
{
    int n = 0;
    v[n++] = 1;
    v[n++] = 2;
    v[n++] = 3;
    return n * 100 + v[0] * 10 + v[1];
}
int store(void)
{
    int i = 0;
    v[i++] = 5;
    v[i] = 7;
    ++i;
    return v[0] * 100 + v[1] * 10 + i - 2;
}
