/* A wait for a conversion that nobody started. */
#include "chip.h"

int result(void)
{
    while ((AdcaRegs.ADCINTFLG & 1) == 0) /* DEFECT */
        ;
    return 0;
}

int main(void)
{
    return result();
}
