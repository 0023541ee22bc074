// A prototype converts the arguments; one without names; one in a block; a call before the definition.
// converted() == 7.5: the int 7 becomes a float
// narrowed() == 4464: 70000 becomes an unsigned int
// widened() == -2: an int becomes a long, with its sign
// later() == 6: defined at the end
// in_block() == 9: declared where it is used
// result() == 3: the float result 3.9 of an int function
// nothing() == 1: a void function, called for its effect
float add_half(float);
long as_long(long x);
int defined_later(int x);
static int done = 0;
static unsigned int low(unsigned int x)
{
    return x;
}
float converted(void)
{
    return add_half(7);
}
unsigned int narrowed(void)
{
    return low((unsigned int)70000);
}
long widened(void)
{
    int x = -2;
    return as_long(x);
}
int later(void)
{
    return defined_later(5);
}
int in_block(void)
{
    int squared(int);
    return squared(3);
}
static int truncating(float x)
{
    return x;
}
int result(void)
{
    return truncating(3.9f);
}
static void act(void)
{
    if (done)
        return;
    done = 1;
}
int nothing(void)
{
    act();
    act();
    return done;
}
float add_half(float x)
{
    return x + 0.5f;
}
long as_long(long x)
{
    return x;
}
int defined_later(int x)
{
    return x + 1;
}
int squared(int x)
{
    return x * x;
}
