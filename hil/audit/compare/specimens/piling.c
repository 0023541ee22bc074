/* Releases that come faster than they are taken. */
#include "chip.h"

void release(void)
{
    Semaphore_post(sem); /* DEFECT */
}

void task_slow(void)
{
    Semaphore_pend(sem);
    DelayUs(20000);
}

int main(void)
{
    release();
    task_slow();
    return 0;
}
