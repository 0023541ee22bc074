// C99: the variable of a for lives in the for; outside stands another of the same name.
// f() == 106: 0 + 1 + 2 + 3 = 6, and the outer i is still 100
int f(void)
{
    int i = 100, sum = 0;
    for (int i = 0; i < 4; i++)
        sum += i;
    return i + sum;
}
