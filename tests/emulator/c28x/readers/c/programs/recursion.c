// Functions that call themselves and each other; each call has its own locals.
// factorial(10) == 3628800: 10!
// fibonacci(15) == 610: 0 1 1 2 3 5 8 13 21 34 55 89 144 233 377 610
// even(7) == 0: 7 is odd
// gcd(1071, 462) == 21: Euclid's own example, 1071 = 2 * 462 + 147
// own_locals(3) == 123: each level adds its digit behind
// hanoi(8) == 255: 2^8 - 1 moves
long factorial(int n)
{
    return n <= 1 ? 1 : n * factorial(n - 1);
}
int fibonacci(int n)
{
    if (n < 2)
        return n;
    return fibonacci(n - 1) + fibonacci(n - 2);
}
static int odd(int n);
int even(int n)
{
    return n == 0 ? 1 : odd(n - 1);
}
static int odd(int n)
{
    return n == 0 ? 0 : even(n - 1);
}
int gcd(int a, int b)
{
    return b ? gcd(b, a % b) : a;
}
int own_locals(int n)
{
    int v[2], before;
    if (n == 0)
        return 0;
    v[0] = n;
    before = own_locals(n - 1);
    return before * 10 + v[0];
}
static int moves;
static void move(int n, int from, int to, int by)
{
    if (n == 0)
        return;
    move(n - 1, from, by, to);
    moves++;
    move(n - 1, by, to, from);
}
int hanoi(int n)
{
    moves = 0;
    move(n, 1, 2, 3);
    return moves;
}
