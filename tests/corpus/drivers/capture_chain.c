/* capture_chain.c: an interrupt of CPU timer 0 samples into a ring, each eighth posts a Swi, which makes a block of it
   and releases the task that works on blocks. */
#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include "F28x_Project.h"

#define TIMER0_INT  38              /* PIE 1.7 */
#define RING        32u
#define BLOCK       8u

static Swi_Handle Block_Swi;
static Semaphore_Handle Block_Ready;
static Uint16 Ring[RING] = {0};
static volatile Uint16 Written = 0;
static Uint16 Read = 0;
static Uint16 Block[BLOCK] = {0};
static volatile Uint16 Block_Full = 0;
static volatile Uint16 Lost_Blocks = 0;
static Uint32 Total = 0;
static Uint16 Blocks = 0;
static Uint16 Counter = 0;

static void Sample(UArg arg)
{
    Counter += 3;
    Ring[Written % RING] = Counter & 0x0FFF;
    Written++;
    if (Written % BLOCK == 0)
        Swi_post(Block_Swi);
}

/* Behind the interrupt, before all tasks. */
static void Make_Block(UArg a0, UArg a1)
{
    Uint16 i;
    while ((Uint16)(Written - Read) >= BLOCK) {
        if (Block_Full) {
            Lost_Blocks++;
            Read += BLOCK;
            continue;
        }
        for (i = 0; i < BLOCK; i++)
            Block[i] = Ring[(Uint16)(Read + i) % RING];
        Read += BLOCK;
        Block_Full = 1;
        Semaphore_post(Block_Ready);
    }
}

static void Work(UArg a0, UArg a1)
{
    Uint16 i;
    Uint32 sum;
    while (1) {
        Semaphore_pend(Block_Ready, BIOS_WAIT_FOREVER);
        sum = 0;
        for (i = 0; i < BLOCK; i++)
            sum += Block[i];
        Block_Full = 0;
        Total += sum;
        Blocks++;
    }
}

int main(void)
{
    Swi_Params swi;
    Task_Params task;
    Hwi_Params hwi;
    InitSysCtrl();

    Block_Ready = Semaphore_create(0, NULL, NULL);

    Swi_Params_init(&swi);
    swi.priority = 5;
    Block_Swi = Swi_create((Swi_FuncPtr)Make_Block, &swi, NULL);

    Task_Params_init(&task);
    task.stackSize = 384;
    task.priority = 2;
    Task_create((Task_FuncPtr)Work, &task, NULL);

    Hwi_Params_init(&hwi);
    Hwi_create(TIMER0_INT, (Hwi_FuncPtr)Sample, &hwi, NULL);

    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 250);
    StartCpuTimer0();
    BIOS_start();
    return 0;
}
