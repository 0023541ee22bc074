// void * takes and gives any data pointer without a cast; a null pointer is 0 or (void *)0.
// there_and_back() == 5: the same object
// generic() == 35: a function that is told by a flag what it gets: int 3 * 10 + long 5
// null() == 2: both spellings are null
#define NOTHING ((void *)0)
int there_and_back(void)
{
    int x = 5;
    void *p = &x;
    int *q = p;
    return *q;
}
static long value(const void *p, int is_long)
{
    if (is_long)
        return *(const long *)p;
    return *(const int *)p;
}
int generic(void)
{
    int i = 3;
    long l = 5;
    return (int)(value(&i, 0) * 10 + value(&l, 1));
}
int null(void)
{
    int *p = NOTHING, *q = 0;
    return (p == 0) + !q;
}
