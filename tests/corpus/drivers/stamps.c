/* stamps.c: a stepper that must be pulsed in time, a key that is debounced, a lamp that blinks: all by stamps of a free
   counter of 5.12 us, 16 bits of which wrap each 335 ms.  The key is the coil's own end switch, played by CPU timer 0:
   it closes for 12 ms out of each 64, and bounces. */
#include "F28x_Project.h"

#define TICKS_PER_MS    195u            /* 1000 / 5.12 */
#define STEP_TICKS      (2u * TICKS_PER_MS)
#define LATE_TICKS      (3u * TICKS_PER_MS)
#define STEADY_TICKS    (3u * TICKS_PER_MS)
#define BLINK_TICKS     (50u * TICKS_PER_MS)
#define STEP_PIN        35u
#define LAMP_PIN        34u

static volatile Uint16 Switch = 0;
static volatile Uint16 Played_Ms = 0;
static Uint16 Steps = 0;
static Uint16 Late_Steps = 0;
static Uint16 Keys = 0;
static Uint16 Blinks = 0;

__interrupt void Play(void)
{
    Uint16 phase;
    Played_Ms++;
    phase = Played_Ms % 64;
    if (phase == 2 || phase == 4 || phase == 13)
        Switch = 0;
    else
        Switch = phase >= 1 && phase <= 14;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static Uint16 Stamp(void)
{
    return (Uint16)(~CpuTimer1Regs.TIM.all >> 10);
}

/* 1 when a step is due; `next` moves on by one interval, so that no delay adds up. */
static Uint16 Due(Uint16 *next, Uint16 interval)
{
    if ((int16)(Stamp() - *next) < 0)
        return 0;
    *next += interval;
    return 1;
}

static void Init(void)
{
    GpioDataRegs.GPBCLEAR.all = 0x0000000C;
    GPIO_SetupPinMux(STEP_PIN, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(STEP_PIN, GPIO_OUTPUT, GPIO_PUSHPULL);
    GPIO_SetupPinMux(LAMP_PIN, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(LAMP_PIN, GPIO_OUTPUT, GPIO_PUSHPULL);
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    CpuTimer1Regs.PRD.all = 0xFFFFFFFF;
    CpuTimer1Regs.TCR.bit.TRB = 1;
    CpuTimer1Regs.TCR.bit.TSS = 0;
}

void main(void)
{
    Uint16 next_step, next_blink, changed, raw, before = 0, steady = 0, stepped;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Play;
    EDIS;
    Init();
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    next_step = next_blink = changed = stepped = Stamp();
    for (;;) {
        if (Due(&next_step, STEP_TICKS)) {
            if ((Uint16)(Stamp() - stepped) > LATE_TICKS)
                Late_Steps++;
            stepped = Stamp();
            GpioDataRegs.GPBTOGGLE.bit.GPIO35 = 1;
            Steps++;
        }
        if (Due(&next_blink, BLINK_TICKS)) {
            GpioDataRegs.GPBTOGGLE.bit.GPIO34 = 1;
            Blinks++;
        }
        raw = Switch;
        if (raw != before) {
            before = raw;
            changed = Stamp();
        } else if (raw != steady && (Uint16)(Stamp() - changed) >= STEADY_TICKS) {
            steady = raw;
            if (steady)
                Keys++;
        }
        DELAY_US(20);
    }
}
