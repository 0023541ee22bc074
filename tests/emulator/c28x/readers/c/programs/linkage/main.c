// Several files: an extern object and function, static ones of the same name, a tentative definition in both.
// sum() == 42: the object of the other file
// static_of_each() == 12: 1 here, 2 there
// through_header() == 9: declared in a header
// shared_object() == 5: written there, read here
// tentative() == 6: `both` is one object
// table(1) == 20: an array whose length only the other file knows
#include "other.h"
extern int answer;
extern int points[];
int both;
static int hidden = 1;
static int helper(void)
{
    return hidden;
}
int sum(void)
{
    return answer;
}
int static_of_each(void)
{
    return helper() * 10 + other_helper();
}
int through_header(void)
{
    return square(3);
}
int shared_object(void)
{
    store(5);
    return shared;
}
int tentative(void)
{
    set_both(6);
    return both;
}
int table(int i)
{
    return points[i];
}
