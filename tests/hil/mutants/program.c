/* A program with tasks, interrupts and most kernel objects: what the mutants of C are made of. */
#include <string.h>
#include <stdlib.h>
#include <math.h>
#include <xdc/std.h>
#include <xdc/runtime/System.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include "F28x_Project.h"

#define SAMPLES 8

typedef enum { WAITING, BUSY, FAULT } State;
typedef struct { int code; float values[4]; State state; } Message;
typedef int (*Step)(int);

static Semaphore_Handle ready, done;
static GateMutexPri_Handle gate;
static Clock_Handle period;
static Swi_Handle later;
static Hwi_Handle tick;
static Message box;
static volatile unsigned int samples[SAMPLES];
static volatile unsigned int head = 0, count = 0;
static char line[40];
static unsigned long total = 0;

static int twice(int n) { return n * 2; }
static int third(int n) { return n / 3; }
static const Step steps[2] = {twice, third};

static void Tick(UArg arg)
{
    CpuTimer0Regs.TCR.bit.TIF = 1;
    samples[head] = AdcaResultRegs.ADCRESULT0;
    head = (head + 1) % SAMPLES;
    count += 1;
    Swi_post(later);
}

static void Later(UArg a, UArg b)
{
    if (count >= SAMPLES) {
        count = 0;
        Semaphore_post(ready);
    }
}

static void Period(UArg arg)
{
    Semaphore_post(done);
}

static float mean(const volatile unsigned int *v, unsigned int n)
{
    unsigned int i;
    unsigned long sum = 0;
    for (i = 0; i < n; i++) {
        sum += v[i];
    }
    return (float)sum / n;
}

static int sign(float x)
{
    switch ((int)x % 3) {
    case 0:
        return 0;
    case 1:
        return 1;
    default:
        break;
    }
    return -1;
}

void Measure(UArg a, UArg b)
{
    int key, i;
    int copy[SAMPLES];
    while (1) {
        Semaphore_pend(ready, BIOS_WAIT_FOREVER);
        for (i = 0; i < SAMPLES; i++) {
            copy[i] = samples[i] >> 1;
        }
        key = GateMutexPri_enter(gate);
        box.code = steps[copy[0] & 1](copy[1]);
        box.values[copy[2] & 3] = mean(samples, SAMPLES);
        box.values[0] = sqrt(fabs(box.values[1]));
        box.state = BUSY;
        GateMutexPri_leave(gate, key);
        total += (unsigned long)copy[3] << 4;
        AdcaRegs.ADCSOCFRC1.all = 1;
        while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0) { }
        AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    }
}

void Report(UArg a, UArg b)
{
    Message mine;
    unsigned int key, n;
    while (1) {
        Semaphore_pend(done, 20);
        key = GateMutexPri_enter(gate);
        memcpy(&mine, &box, sizeof(Message));
        box.state = WAITING;
        GateMutexPri_leave(gate, key);
        System_sprintf(line, "%d %5.2f %u", mine.code, mine.values[0], count);
        for (n = 0; n < strlen(line); n++) {
            SciaRegs.SCITXBUF.all = line[n] & 0xFF;
        }
        box.code = atoi(line) + sign(mine.values[1]);
        if (mine.state == FAULT || mine.code > 300) {
            Clock_stop(period);
            Task_sleep(5);
            Clock_start(period);
        }
    }
}

static void Converter(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    EDIS;
    DELAY_US(1000);
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    EDIS;
    AdcaRegs.ADCSOCFRC1.all = 1;
}

void main(void)
{
    Task_Params task;
    Clock_Params clock;
    Swi_Params swi;
    Hwi_Params hwi;

    Converter();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    EDIS;
    ready = Semaphore_create(0, NULL, NULL);
    done = Semaphore_create(0, NULL, NULL);
    gate = GateMutexPri_create(NULL, NULL);
    Swi_Params_init(&swi);
    swi.priority = 3;
    later = Swi_create(Later, &swi, NULL);
    Clock_Params_init(&clock);
    clock.period = 7;
    clock.startFlag = TRUE;
    period = Clock_create(Period, 5, &clock, NULL);
    Hwi_Params_init(&hwi);
    hwi.arg = 1;
    tick = Hwi_create(38, Tick, &hwi, NULL);
    Task_Params_init(&task);
    task.priority = 4;
    task.stackSize = 512;
    Task_create(Measure, &task, NULL);
    task.priority = 2;
    Task_create(Report, &task, NULL);
    CpuTimer0Regs.PRD.all = 99999;
    CpuTimer0Regs.TPR.all = 0;
    CpuTimer0Regs.TPRH.all = 0;
    CpuTimer0Regs.TCR.all = 0x4020;
    BIOS_start();
}
