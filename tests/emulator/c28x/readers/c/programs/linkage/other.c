#include "other.h"
int answer = 42;
int points[3] = { 10, 20, 30 };
int shared = 0;
int both;
static int hidden = 2;
static int helper(void)
{
    return hidden;
}
int other_helper(void)
{
    return helper();
}
int square(int x)
{
    return x * x;
}
void store(int x)
{
    shared = x;
}
void set_both(int x)
{
    both = x;
}
