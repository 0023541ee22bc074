/* memcpy counted in octets: right on a PC, twice too long on this chip. */
#include <string.h>

float last(const float *v, int n)
{
    float copy[20];
    memcpy(copy, v, 4 * n); /* DEFECT */
    return copy[n - 1];
}

int main(void)
{
    float v[13] = {0};
    return last(v, 13) > 1.0f;
}
