/* supervisor.c: a watchdog that is only served if main and its tick are both alive, and a lamp that shows the same.
   Main sums a block of memory again and again; a run must be done within 8 ms. */
#include "F28x_Project.h"

#define LAMP            34u
#define WORDS           256u
#define RUN_MS          5u
#define DEADLINE_MS     8u

static volatile Uint16 Now_Ms = 0;
static volatile Uint16 Alive = 0;           /* a run was made since the watchdog was served */
static volatile Uint16 Late = 0;
static Uint16 Data[WORDS] = {0};
static Uint32 Sum = 0;
static Uint16 Runs = 0;

__interrupt void Tick(void)
{
    Now_Ms++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Lamp(void)
{
    GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1;
    GPIO_SetupPinMux(LAMP, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(LAMP, GPIO_OUTPUT, GPIO_PUSHPULL);
}

/* 10 MHz / 512 / 2 / 256: 26.2 ms */
static void Start_Watchdog(void)
{
    EALLOW;
    WdRegs.WDKEY.bit.WDKEY = 0x55;
    WdRegs.WDKEY.bit.WDKEY = 0xAA;
    WdRegs.WDCR.all = 0x002A;
    EDIS;
}

static void Serve(void)
{
    EALLOW;
    WdRegs.WDKEY.bit.WDKEY = 0x0055;
    WdRegs.WDKEY.bit.WDKEY = 0x00AA;
    EDIS;
}

/* One run over the data, in pieces. */
static void Run(void)
{
    Uint16 i;
    Uint32 sum = 0;
    for (i = 0; i < WORDS; i++) {
        Data[i] = (Data[i] + i) & 0x0FFF;
        sum += Data[i];
        DELAY_US(12);
    }
    Sum = sum;
    Runs++;
    Alive = 1;
}

void main(void)
{
    Uint16 begun, last = 0;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    Init_Lamp();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    Start_Watchdog();
    for (;;) {
        begun = Now_Ms;
        Run();
        if ((Uint16)(Now_Ms - begun) > DEADLINE_MS)
            Late++;
        if (Alive && Now_Ms != last) {
            last = Now_Ms;
            Alive = 0;
            Serve();
            GpioDataRegs.GPBTOGGLE.bit.GPIO34 = 1;
        }
        while ((Uint16)(Now_Ms - begun) < RUN_MS)
            ;
    }
}
