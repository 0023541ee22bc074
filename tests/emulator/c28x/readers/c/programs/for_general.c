// A for at large: limits with <=, != and >, steps other than 1, empty parts.
// le(4) == 10: 1 + 2 + 3 + 4
// ne() == 15: 0 + 3 + 6, then i, which is 9, less 3
// down() == 321: 3, 2, 1 as digits
// empty() == 7: the loop is left at i == 7
// after(0) == 5: no turn is made, i keeps its start
int le(int n)
{
    int i, sum = 0;
    for (i = 1; i <= n; i++)
        sum += i;
    return sum;
}
int ne(void)
{
    int i, sum = 0;
    for (i = 0; i != 9; i += 3)
        sum += i;
    return sum + i - 3;
}
int down(void)
{
    int i, digits = 0;
    for (i = 3; i > 0; --i)
        digits = digits * 10 + i;
    return digits;
}
int empty(void)
{
    int i = 0;
    for (;;) {
        if (i == 7)
            break;
        i++;
    }
    return i;
}
int after(int n)
{
    int i;
    for (i = 5; i < n; i++)
        ;
    return i;
}
