/* A busy wait above everybody else. */
#include "chip.h"

void task_sensor(void)
{
    int i;
    for (i = 0; i < 100; i++)
        DelayUs(20000); /* DEFECT */
}

int main(void)
{
    task_sensor();
    return 0;
}
