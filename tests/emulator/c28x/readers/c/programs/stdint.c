// stdint.h: fixed widths as the chip has them.
// wraps() == 0: uint16_t
// wide() == 4294967295: uint32_t: 0 - 1
// signed_wide() == -2147483648: int32_t
// sixty_four() == 4294967296: uint64_t
// limits() == 1: the limits' values
#include <stdint.h>
uint16_t wraps(void)
{
    uint16_t x = 65535;
    x = x + 1;
    return x;
}
uint32_t wide(void)
{
    uint32_t x = 0;
    return x - 1;
}
int32_t signed_wide(void)
{
    int32_t x = -2147483647;
    return x - 1;
}
uint64_t sixty_four(void)
{
    uint64_t x = 4294967295u;
    return x + 1;
}
int limits(void)
{
    return INT16_MAX == 32767 && UINT16_MAX == 65535u && INT32_MAX == 2147483647;
}
