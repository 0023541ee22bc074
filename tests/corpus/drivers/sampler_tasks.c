/* sampler_tasks.c: a Clock releases the sampling task, a mailbox takes its samples to the filter, a gate keeps the
   statistics together that a third task reports. */
#include <stdio.h>
#include <string.h>
#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include "F28x_Project.h"

#define SAMPLE_TICKS    5
#define REPORT_SAMPLES  20
#define DEPTH           8
#define CEILING         3500

typedef struct {
    Uint16 number;
    Uint16 value;
    Uint32 ticks;
} SAMPLE;

typedef struct {
    Uint16 count;
    Uint16 missed;
    Uint16 largest;
    Uint32 sum;
} STATISTICS;

static Clock_Handle Release_Clock;
static Semaphore_Handle Release;
static Semaphore_Handle Report_Wanted;
static Mailbox_Handle Samples;
static GateMutexPri_Handle Statistics_Gate;
static STATISTICS Statistics = {0, 0, 0, 0};
static char Text[60] = "";
static Uint16 Reports = 0;
static Uint16 Alarms = 0;

static void Release_Sampler(UArg arg)
{
    Semaphore_post(Release);
}

static Uint16 Convert(void)
{
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    return AdcaResultRegs.ADCRESULT0;
}

static void Sampler(UArg a0, UArg a1)
{
    SAMPLE sample;
    sample.number = 0;
    while (1) {
        Semaphore_pend(Release, BIOS_WAIT_FOREVER);
        sample.number++;
        sample.value = Convert();
        sample.ticks = Clock_getTicks();
        Mailbox_post(Samples, &sample, BIOS_WAIT_FOREVER);
    }
}

static void Count(const SAMPLE *sample, Uint16 missed)
{
    IArg key = GateMutexPri_enter(Statistics_Gate);
    Statistics.count++;
    Statistics.missed += missed;
    Statistics.sum += sample->value;
    if (sample->value > Statistics.largest)
        Statistics.largest = sample->value;
    GateMutexPri_leave(Statistics_Gate, key);
}

static void Filter(UArg a0, UArg a1)
{
    SAMPLE sample;
    Uint16 expected = 1, since = 0;
    while (1) {
        Mailbox_pend(Samples, &sample, BIOS_WAIT_FOREVER);
        Count(&sample, sample.number - expected);
        expected = sample.number + 1;
        if (++since == REPORT_SAMPLES) {
            since = 0;
            Semaphore_post(Report_Wanted);
        }
    }
}

static void Reporter(UArg a0, UArg a1)
{
    STATISTICS taken;
    char line[60];
    IArg key;
    while (1) {
        Semaphore_pend(Report_Wanted, BIOS_WAIT_FOREVER);
        key = GateMutexPri_enter(Statistics_Gate);
        taken = Statistics;
        Statistics.sum = 0;
        Statistics.count = 0;
        GateMutexPri_leave(Statistics_Gate, key);
        if (taken.largest > CEILING)
            Alarms++;
        if (taken.count > 0) {
            sprintf(line, "n %u mean %lu missed %u", taken.count, taken.sum / taken.count, taken.missed);
            strcpy(Text, line);
        }
        Reports++;
    }
}

static void Init_Adc(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 0;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 29;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    EDIS;
}

int main(void)
{
    Clock_Params clock;
    Task_Params task;
    InitSysCtrl();
    Init_Adc();
    Release = Semaphore_create(0, NULL, NULL);
    Report_Wanted = Semaphore_create(0, NULL, NULL);
    Samples = Mailbox_create(sizeof(SAMPLE), DEPTH, NULL, NULL);
    Statistics_Gate = GateMutexPri_create(NULL, NULL);

    Task_Params_init(&task);
    task.stackSize = 512;
    task.priority = 4;
    Task_create((Task_FuncPtr)Sampler, &task, NULL);

    Task_Params_init(&task);
    task.stackSize = 512;
    task.priority = 3;
    Task_create((Task_FuncPtr)Filter, &task, NULL);

    Task_Params_init(&task);
    task.stackSize = 768;
    task.priority = 1;
    Task_create((Task_FuncPtr)Reporter, &task, NULL);

    Clock_Params_init(&clock);
    clock.period = SAMPLE_TICKS;
    clock.startFlag = TRUE;
    Release_Clock = Clock_create((Clock_FuncPtr)Release_Sampler, SAMPLE_TICKS, &clock, NULL);

    BIOS_start();
    return 0;
}
