// An else belongs to the nearest if.
// f(0, 0) == 0: the outer test fails, and it has no else
// f(1, 0) == 2: the inner else
// f(1, 1) == 1: both tests hold
// chain(-5) == -1: first of the chain
// chain(0) == 0: second
// chain(8) == 1: last
int f(int a, int b)
{
    int r = 0;
    if (a)
        if (b)
            r = 1;
        else
            r = 2;
    return r;
}
int chain(int x)
{
    if (x < 0)
        return -1;
    else if (x == 0)
        return 0;
    else
        return 1;
}
