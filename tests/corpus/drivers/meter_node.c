/*
 * meter_node.c: a current meter that reports over CAN-A and listens to its own reports (loopback), as a self-test does.
 *
 * Timer 0 starts a conversion each 50 us.  The interrupt of the ADC gathers 40 codes to a block: mean, peak, number.
 * main takes each block, keeps the last means in a ring, and sends the mean of the ring.  The interrupt of the CAN
 * compares what came back.  A report that does not come back within 5 ms is counted as lost.
 */
#include "F28x_Project.h"

#define BLOCK 40u
#define KEPT 16u
#define KEPT_MASK (KEPT - 1u)
#define SENT_OBJECT 1u
#define HEARD_OBJECT 2u
#define IDENTIFIER 0x2A4UL
#define PATIENCE_TICKS 100u
#define FAULT_LOST 0x1u
#define FAULT_OTHER 0x2u
#define FAULT_HIGH 0x4u
#define LAMP 31

typedef struct {
    Uint16 mean;
    Uint16 peak;
    Uint16 number;
    Uint16 spare;
} BLOCK_RESULT;

typedef enum { QUIET, AWAITED, HEARD } ECHO;

static BLOCK_RESULT Result = {0, 0, 0, 0};
static Uint32 Sum = 0;
static Uint16 Count = 0, Peak = 0;
static volatile Uint16 Ticks = 0;
static volatile Uint16 Faults = 0;
static volatile Uint16 Echo_Value = 0;
static volatile ECHO Echo = QUIET;
static Uint16 Means[KEPT] = {0};
static Uint16 Next = 0;
static Uint16 Filled = 0;

__interrupt void Converted(void)
{
    Uint16 code = AdcaResultRegs.ADCRESULT2;

    Ticks++;
    Sum += code;
    if (code > Peak)
        Peak = code;
    if (++Count == BLOCK) {
        Result.mean = Sum / BLOCK;
        Result.peak = Peak;
        Result.number++;
        Sum = 0;
        Count = 0;
        Peak = 0;
    }
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Await_Interface_2(void)
{
    Uint16 polls;

    for (polls = 0; polls < 200u; polls++) {
        if (!CanaRegs.CAN_IF2CMD.bit.Busy)
            break;
    }
}

__interrupt void Came_Back(void)
{
    CanaRegs.CAN_IF2CMD.all = 0x007F0000UL | HEARD_OBJECT;
    Await_Interface_2();
    Echo_Value = CanaRegs.CAN_IF2DATA.all & 0xFFFFu;
    if (Echo == AWAITED)
        Echo = HEARD;
    else
        Faults |= FAULT_OTHER;
    CanaRegs.CAN_GLB_INT_CLR.bit.INT0_FLG_CLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

static void Await_Interface_1(void)
{
    Uint16 polls;

    for (polls = 0; polls < 200u; polls++) {
        if (!CanaRegs.CAN_IF1CMD.bit.Busy)
            break;
    }
}

static void Set_Up_Object(Uint16 number, Uint32 direction, Uint32 control)
{
    CanaRegs.CAN_IF1MSK.all = 0xFFFFFFFFUL;
    CanaRegs.CAN_IF1ARB.all = 0x80000000UL | direction | IDENTIFIER << 18;
    CanaRegs.CAN_IF1MCTL.all = control;
    CanaRegs.CAN_IF1CMD.all = 0x00F00000UL | number;
    Await_Interface_1();
}

static void Init_Can(void)
{
    GPIO_SetupPinMux(70, GPIO_MUX_CPU1, 5);
    GPIO_SetupPinOptions(70, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinMux(71, GPIO_MUX_CPU1, 5);
    GPIO_SetupPinOptions(71, GPIO_OUTPUT, GPIO_PUSHPULL);
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    CanaRegs.CAN_CTL.all = 0x00000001UL;
    CanaRegs.CAN_CTL.all = 0x000000C1UL;                        /* Test, CCE, Init */
    CanaRegs.CAN_BTR.all = 19u | 2UL << 6 | 12UL << 8 | 5UL << 12;
    CanaRegs.CAN_TEST.bit.LBACK = 1;
    Set_Up_Object(SENT_OBJECT, 0x20000000UL, 0x0080u | 2u);
    Set_Up_Object(HEARD_OBJECT, 0, 0x1480u | 2u);
    CanaRegs.CAN_GLB_INT_EN.bit.GLBINT0_EN = 1;
    CanaRegs.CAN_CTL.all = 0x00000082UL;                        /* Test, line 0 */
    EDIS;
}

static void Init_Adc(void)
{
    EALLOW;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC2CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC2CTL.bit.ACQPS = 24;
    AdcaRegs.ADCSOC2CTL.bit.TRIGSEL = 1;                        /* timer 0 */
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 2;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
}

static Uint16 Mean_Of_All(Uint16 mean)
{
    Uint32 sum = 0;
    Uint16 i;

    Means[Next] = mean;
    Next = (Next + 1u) & KEPT_MASK;
    if (Filled < KEPT)
        Filled++;
    for (i = 1; i <= Filled; i++)
        sum += Means[(Next - i) & KEPT_MASK];
    return (Uint16)(sum / Filled);
}

/* Sends a report and waits for it to come back. */
static void Report(Uint16 value)
{
    Uint16 begun;

    Echo = AWAITED;
    CanaRegs.CAN_IF1DATA.all = value;
    CanaRegs.CAN_IF1CMD.all = 0x00860000UL | SENT_OBJECT;
    Await_Interface_1();
    begun = Ticks;
    while (Echo == AWAITED) {
        if ((Uint16)(Ticks - begun) > PATIENCE_TICKS) {
            Echo = QUIET;
            DINT;
            Faults |= FAULT_LOST;
            EINT;
            return;
        }
    }
    Echo = QUIET;
    DINT;
    if (Echo_Value != value)
        Faults |= FAULT_OTHER;
    else
        Faults &= ~FAULT_LOST;
    EINT;
}

void main(void)
{
    BLOCK_RESULT now;
    Uint16 seen = 0;

    InitSysCtrl();
    InitGpio();
    DINT;
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.ADCA1_INT = &Converted;
    PieVectTable.CANA0_INT = &Came_Back;
    EDIS;
    GPIO_SetupPinMux(LAMP, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(LAMP, GPIO_OUTPUT, GPIO_PUSHPULL);
    Init_Adc();
    Init_Can();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 50);
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx5 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    StartCpuTimer0();
    for (;;) {
        DINT;
        now = Result;
        EINT;
        if (now.number == seen)
            continue;
        seen = now.number;
        if (now.peak > 4000u) {
            DINT;
            Faults |= FAULT_HIGH;
            EINT;
        }
        Report(Mean_Of_All(now.mean));
        GPIO_WritePin(LAMP, Faults != 0);
    }
}
