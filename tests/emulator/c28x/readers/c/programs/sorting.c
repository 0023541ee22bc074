// Insertion sort and a binary search with a comparison by function pointer.
// sorted() == 24579: 9 2 7 4 5 in order, as digits
// found(7) == 3: 7 is the fourth
// found(6) == -1: not there
static int v[5];
static int less(int a, int b)
{
    return a < b;
}
static void sort(int *p, int n, int (*before)(int, int))
{
    int i, k, x;
    for (i = 1; i < n; i++) {
        x = p[i];
        for (k = i; k > 0 && before(x, p[k - 1]); k--)
            p[k] = p[k - 1];
        p[k] = x;
    }
}
static void fill(void)
{
    static const int from[5] = { 9, 2, 7, 4, 5 };
    int i;
    for (i = 0; i < 5; i++)
        v[i] = from[i];
    sort(v, 5, less);
}
int sorted(void)
{
    int i, r = 0;
    fill();
    for (i = 0; i < 5; i++)
        r = r * 10 + v[i];
    return r;
}
int found(int x)
{
    int low = 0, high = 4;
    fill();
    while (low <= high) {
        int middle = (low + high) / 2;
        if (v[middle] == x)
            return middle;
        if (v[middle] < x)
            low = middle + 1;
        else
            high = middle - 1;
    }
    return -1;
}
