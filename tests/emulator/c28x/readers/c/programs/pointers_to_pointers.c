// A pointer to a pointer changes where the other points; a table of pointers; a pointer to an array.
// change() == 2: p is moved to b
// table() == 30: *tab[2]
// rows() == 4: pr points to a row of 3; pr + 1 is the next row
// row_size() == 3: the difference of two of its elements
// whole() == 6: &v points to the array, (*p)[2] is its last
// out_parameter() == 9: a function sets the caller's pointer
static int a = 1, b = 2;
static int ten = 10, twenty = 20, thirty = 30;
static int *const tab[] = { &ten, &twenty, &thirty };
static int m[2][3] = { { 1, 2, 3 }, { 4, 5, 6 } };
static int nine = 9;
int change(void)
{
    int *p = &a;
    int **pp = &p;
    *pp = &b;
    return *p;
}
int table(void)
{
    int *const *p = tab;
    return *p[2];
}
int rows(void)
{
    int (*pr)[3] = m;
    pr++;
    return (*pr)[0];
}
int row_size(void)
{
    int (*pr)[3] = m;
    return (int)(&(*pr)[3] - &pr[0][0]);
}
int whole(void)
{
    int v[3] = { 4, 5, 6 };
    int (*p)[3] = &v;
    return (*p)[2];
}
static void find(int **p)
{
    *p = &nine;
}
int out_parameter(void)
{
    int *p = 0;
    find(&p);
    return *p;
}
