// The limit of a for is evaluated at every turn, and the body may change the variable.
// f() == 3: n falls as i grows: (0, 6) (1, 5) (2, 4) then 3 < 3 is false
// g() == 4: i = 0, 2, 4, 6: each turn adds 1 in the body and 1 in the step
int f(void)
{
    int i, n = 6;
    for (i = 0; i < n; i++)
        n--;
    return i;
}
int g(void)
{
    int i, turns = 0;
    for (i = 0; i < 8; i++) {
        i++;
        turns++;
    }
    return turns;
}
