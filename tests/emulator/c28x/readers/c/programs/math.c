// math.h: in single precision under the COFF ABI.
// absolute() == 2.5: fabs
// root() == 1.5: sqrt(2.25) is exact
// cosine() == 1.0: cos(0)
#include <math.h>
float absolute(void)
{
    float x = -2.5f;
    return fabs(x);
}
float root(void)
{
    float x = 2.25f;
    return sqrt(x);
}
float cosine(void)
{
    float x = 0.0f;
    return cos(x);
}
