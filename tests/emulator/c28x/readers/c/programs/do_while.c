// The body of do runs once before the first test.
// count(0) == 1: n = 0 -> body once, then 0 > 0 is false
// count(3) == 3: the body for n = 3, 2, 1
int count(int n)
{
    int turns = 0;
    do {
        turns++;
        n--;
    } while (n > 0);
    return turns;
}
