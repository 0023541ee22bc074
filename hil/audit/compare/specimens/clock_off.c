/* A peripheral whose clock is off. */
#include "chip.h"

void baud(void)
{
    SpiaRegs.SPIBRR = 49; /* DEFECT */
}

int main(void)
{
    baud();
    return 0;
}
