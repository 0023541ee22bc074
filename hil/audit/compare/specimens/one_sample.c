/* Fifty reads of one sample. */
#include "chip.h"

float offset(void)
{
    float sum = 0;
    int i;
    for (i = 0; i < 50; i++)
        sum += read_gyro(); /* DEFECT */
    return sum / 50;
}

int main(void)
{
    return offset() > 1.0f;
}
