// _Bool is 0 or 1, whatever is stored; stdbool.h gives it its names.
// from_int() == 1: 256 is not 0
// from_float() == 1: 0.25 is not 0, though it truncates to 0
// from_pointer() == 1: a pointer to an object is not null
// sum() == 2: true + true is an int
// negated() == 0: !true
#include <stdbool.h>
int from_int(void)
{
    int x = 256;
    bool b = x;
    return b;
}
int from_float(void)
{
    float f = 0.25f;
    _Bool b = f;
    return b;
}
int from_pointer(void)
{
    int x = 0;
    bool b = &x;
    return b + x;
}
int sum(void)
{
    bool b = true;
    return b + b;
}
int negated(void)
{
    bool b = true;
    b = !b;
    return b == false ? 0 : 1;
}
