/* watch_station.c: a heater under SYS/BIOS.  One task measures, one controls, one is the operator; the operator switches
   the sensor off for a while, as in service.  The controller heats with a fresh temperature only, and with an order
   that is not older than a quarter of a second. */
#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include "F28x_Project.h"

#define MEASURE_TICKS   5
#define CONTROL_TICKS   10
#define SAMPLE_AGE      25
#define ORDER_AGE       250
#define WARM_UP_TICKS   50
#define WARM            2048
#define HEATER          34

typedef struct {
    Uint16 value;
    Uint32 taken;
} SAMPLE;

enum STATE { STARTING, HEATING, SAFE };

static GateMutexPri_Handle Sample_Gate;
static Semaphore_Handle Measure_Release;
static Mailbox_Handle Orders;
static SAMPLE Last = {0, 0};
static volatile Uint16 Sensor_On = 1;
static enum STATE State = STARTING;
static Uint16 Heats = 0;
static Uint16 Safes = 0;

static void Release_Measure(UArg arg)
{
    Semaphore_post(Measure_Release);
}

static Uint16 Convert(void)
{
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    return AdcaResultRegs.ADCRESULT0;
}

static void Measure(UArg a0, UArg a1)
{
    Uint16 value;
    IArg key;
    while (1) {
        Semaphore_pend(Measure_Release, BIOS_WAIT_FOREVER);
        if (!Sensor_On)
            continue;
        value = Convert();
        key = GateMutexPri_enter(Sample_Gate);
        Last.value = value;
        Last.taken = Clock_getTicks();
        GateMutexPri_leave(Sample_Gate, key);
    }
}

static void Heat(Uint16 on)
{
    if (on) {
        GpioDataRegs.GPBSET.bit.GPIO34 = 1;
        Heats++;
    } else {
        GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1;
    }
}

static void Control(UArg a0, UArg a1)
{
    SAMPLE sample;
    Uint16 wanted = 0;
    Uint32 ordered = 0, begun = Clock_getTicks(), now;
    IArg key;
    while (1) {
        if (Mailbox_pend(Orders, &wanted, CONTROL_TICKS))
            ordered = Clock_getTicks();
        key = GateMutexPri_enter(Sample_Gate);
        sample = Last;
        GateMutexPri_leave(Sample_Gate, key);
        now = Clock_getTicks();
        switch (State) {
        case STARTING:
            if (now - begun >= WARM_UP_TICKS)
                State = HEATING;
            break;
        case HEATING:
            if (now - sample.taken > SAMPLE_AGE || now - ordered > ORDER_AGE)
                State = SAFE;
            else
                Heat(sample.value < wanted);
            break;
        case SAFE:
        default:
            Heat(0);
            Safes++;
            if (now - sample.taken <= SAMPLE_AGE && now - ordered <= ORDER_AGE) {
                begun = now;
                State = STARTING;
            }
            break;
        }
    }
}

static void Operator(UArg a0, UArg a1)
{
    Uint16 wanted = WARM, i;
    for (i = 0; i < 6; i++) {
        Mailbox_post(Orders, &wanted, BIOS_NO_WAIT);
        Sensor_On = i != 2;
        Task_sleep(100);
    }
    /* Nobody orders any more. */
    while (1)
        Task_sleep(1000);
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
    GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1;
    GPIO_SetupPinMux(HEATER, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(HEATER, GPIO_OUTPUT, GPIO_PUSHPULL);
    Init_Adc();
    Sample_Gate = GateMutexPri_create(NULL, NULL);
    Measure_Release = Semaphore_create(0, NULL, NULL);
    Orders = Mailbox_create(sizeof(Uint16), 4, NULL, NULL);
    Make_Task((Task_FuncPtr)Measure, 4);
    Make_Task((Task_FuncPtr)Control, 3);
    Make_Task((Task_FuncPtr)Operator, 1);
    Clock_Params_init(&clock);
    clock.period = MEASURE_TICKS;
    clock.startFlag = TRUE;
    Clock_create((Clock_FuncPtr)Release_Measure, MEASURE_TICKS, &clock, NULL);
    BIOS_start();
    return 0;
}
