// interrupt marks a function; it may still be called through a table.
// f() == 2: both have run
static volatile int count = 0;
interrupt void first(void)
{
    count++;
}
interrupt void second(void)
{
    count++;
}
static void (*const vectors[2])(void) = { first, second };
int f(void)
{
    count = 0;
    vectors[0]();
    vectors[1]();
    return count;
}
