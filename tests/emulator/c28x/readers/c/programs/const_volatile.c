// const and volatile in all their places; they do not change a value.
// constant() == 3: const int in both orders
// pointer() == 5: int *const and const int *
// volatile_local() == 6: read and written as it stands
// structure() == 9: a const structure with an array
// cast_away() == 4: reading through a pointer without const
const int a = 1;
int const b = 2;
volatile int flag = 0;
static const struct { int n; const int v[2]; } table = { 2, { 4, 5 } };
int constant(void)
{
    return a + b;
}
int pointer(void)
{
    int x = 2, y = 3;
    int *const p = &x;
    const int *q = &x;
    int sum = *q;
    q = &y;
    *p = 2;
    return sum + *q;
}
int volatile_local(void)
{
    volatile int x = 5;
    flag = 1;
    x += flag;
    return x;
}
int structure(void)
{
    return table.v[0] + table.v[1];
}
int cast_away(void)
{
    const int x = 4;
    int *p = (int *)&x;
    return *p;
}
