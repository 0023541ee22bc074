/* A protected register written without EALLOW. */
#include "chip.h"

void power_up(void)
{
    AdcaRegs.ADCCTL1 = 0x0080; /* DEFECT */
}

int main(void)
{
    power_up();
    return 0;
}
