// A block has its own names, which hide those outside; an empty statement does nothing.
// f() == 17: the inner x is 10 and 5 there; outside x stays 2: 10 + 5 + 2
int f(void)
{
    int x = 2, sum = 0;
    {
        int x = 10;
        sum += x;
        {
            int x = 5;
            sum += x;
        }
    }
    ;
    return sum + x;
}
