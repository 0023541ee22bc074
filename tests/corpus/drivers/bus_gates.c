/* bus_gates.c: two tasks talk over one SPI, which a GateMutexPri keeps apart, while a third computes.  The frames of
   the display are long and may wait; the control task asks each 10 ms and must have its answer soon. */
#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include "F28x_Project.h"

#define CONTROL_TICKS   10
#define FRAME           96u
#define CHUNK           8u

typedef struct {
    float gain;
    float limit;
    Uint16 valid;
} SETTINGS;

static GateMutexPri_Handle Bus;
static GateMutexPri_Handle Settings_Gate;
static Semaphore_Handle Control_Release;
static Semaphore_Handle Compute_Release;
static SETTINGS Settings = {0.5f, 100.0f, 1};
static Uint16 Answers = 0;
static Uint16 Wrong = 0;
static Uint16 Frames = 0;
static float Output = 0.0f;
static Uint32 Checksum = 0;

static void Release_Control(UArg arg)
{
    Semaphore_post(Control_Release);
}

static void Release_Compute(UArg arg)
{
    Semaphore_post(Compute_Release);
}

/* One word over the bus; the caller holds its gate. */
static Uint16 Exchange(Uint16 word)
{
    SpibRegs.SPITXBUF = word;
    while (SpibRegs.SPISTS.bit.INT_FLAG == 0)
        ;
    return SpibRegs.SPIRXBUF;
}

static float Gained(Uint16 answer)
{
    float wanted;
    IArg key = GateMutexPri_enter(Settings_Gate);
    wanted = Settings.gain * answer;
    if (wanted > Settings.limit)
        wanted = Settings.limit;
    GateMutexPri_leave(Settings_Gate, key);
    return wanted;
}

static void Control(UArg a0, UArg a1)
{
    Uint16 answer;
    IArg key;
    while (1) {
        Semaphore_pend(Control_Release, BIOS_WAIT_FOREVER);
        key = GateMutexPri_enter(Bus);
        answer = Exchange(0x0155);
        GateMutexPri_leave(Bus, key);
        if (answer != 0x0155)
            Wrong++;
        Output = Gained(answer);
        Answers++;
    }
}

static void Display(UArg a0, UArg a1)
{
    Uint16 i, j;
    IArg key;
    while (1) {
        for (i = 0; i < FRAME; i += CHUNK) {
            key = GateMutexPri_enter(Bus);
            for (j = 0; j < CHUNK; j++)
                Exchange(i + j);
            GateMutexPri_leave(Bus, key);
        }
        Frames++;
        Task_sleep(6);
    }
}

static void Compute(UArg a0, UArg a1)
{
    Uint16 i;
    IArg key;
    while (1) {
        Semaphore_pend(Compute_Release, BIOS_WAIT_FOREVER);
        for (i = 0; i < 2000; i++)
            Checksum = (Checksum << 1 | Checksum >> 31) ^ i;
        key = GateMutexPri_enter(Settings_Gate);
        Settings.gain = Settings.gain < 2.0f ? Settings.gain + 0.25f : 0.5f;
        Settings.valid = 1;
        GateMutexPri_leave(Settings_Gate, key);
    }
}

static void Init_Spi(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_B = 1;
    EDIS;
    SpibRegs.SPICCR.bit.SPISWRESET = 0;
    SpibRegs.SPICCR.bit.SPICHAR = 15;
    SpibRegs.SPICCR.bit.SPILBK = 1;
    SpibRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpibRegs.SPICTL.bit.TALK = 1;
    SpibRegs.SPIBRR.bit.SPI_BIT_RATE = 49;      /* 1 MHz */
    SpibRegs.SPICCR.bit.SPISWRESET = 1;
}

static void Make_Task(Task_FuncPtr function, int priority)
{
    Task_Params task;
    Task_Params_init(&task);
    task.stackSize = 512;
    task.priority = priority;
    Task_create(function, &task, NULL);
}

int main(void)
{
    Clock_Params clock;
    InitSysCtrl();
    Init_Spi();
    Bus = GateMutexPri_create(NULL, NULL);
    Settings_Gate = GateMutexPri_create(NULL, NULL);
    Control_Release = Semaphore_create(0, NULL, NULL);
    Compute_Release = Semaphore_create(0, NULL, NULL);

    Clock_Params_init(&clock);
    clock.period = CONTROL_TICKS;
    clock.startFlag = TRUE;
    Clock_create((Clock_FuncPtr)Release_Control, CONTROL_TICKS, &clock, NULL);
    Clock_create((Clock_FuncPtr)Release_Compute, CONTROL_TICKS + 3, &clock, NULL);

    Make_Task((Task_FuncPtr)Control, 5);
    Make_Task((Task_FuncPtr)Compute, 3);
    Make_Task((Task_FuncPtr)Display, 1);
    BIOS_start();
    return 0;
}
