/* i2c_probe.c: a thermometer at address 0x48 of I2C-A, asked each 20 ms; it may be missing, and comes back when it is
   plugged in.  Every wait has an end, and what is older than 200 ms is not used. */
#include "F28x_Project.h"

#define ADDRESS         0x48
#define WAIT_MS         5u
#define MAX_AGE_MS      200u
#define TRIES           3u
#define NO_VALUE        0x7FFF

static volatile Uint16 Now_Ms = 0;
static int16 Degrees = NO_VALUE;            /* 1/16 degree */
static Uint16 Taken_Ms = 0;
static Uint16 Fan = 0;
static Uint16 Missing = 0;
static Uint16 Bus_Errors = 0;

__interrupt void Tick(void)
{
    Now_Ms++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_I2c(void)
{
    GPIO_SetupPinMux(32, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinOptions(32, GPIO_OUTPUT, GPIO_PULLUP | GPIO_ASYNC);
    GPIO_SetupPinMux(33, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinOptions(33, GPIO_OUTPUT, GPIO_PULLUP | GPIO_ASYNC);
    EALLOW;
    CpuSysRegs.PCLKCR9.bit.I2C_A = 1;
    EDIS;
    I2caRegs.I2CMDR.all = 0x0000;
    I2caRegs.I2CPSC.all = 19;               /* 10 MHz */
    I2caRegs.I2CCLKL = 45;                  /* 100 ticks of 0.1 us with both 5 that the module adds: 100 kHz */
    I2caRegs.I2CCLKH = 45;
    I2caRegs.I2CMDR.all = 0x0020;           /* out of reset */
}

/* 1 if one of the flags came in time, and no refusal. */
static Uint16 Await(Uint16 flags)
{
    Uint16 begun = Now_Ms, state;
    do {
        state = I2caRegs.I2CSTR.all;
        if (state & I2C_CLR_NACK_BIT)
            return 0;
        if (state & flags)
            return 1;
    } while ((Uint16)(Now_Ms - begun) < WAIT_MS);
    Bus_Errors++;
    return 0;
}

/* A STOP, and everything ready for the next message. */
static void Give_Up(void)
{
    Uint16 begun = Now_Ms;
    I2caRegs.I2CMDR.bit.STP = 1;
    while (I2caRegs.I2CSTR.bit.BB == 1 && (Uint16)(Now_Ms - begun) < WAIT_MS)
        ;
    I2caRegs.I2CSTR.all = I2C_CLR_NACK_BIT | I2C_CLR_ARDY_BIT | I2C_CLR_SCD_BIT;
}

/* 1 if there is a new value. */
static Uint16 Ask(void)
{
    Uint16 high, low;
    if (I2caRegs.I2CSTR.bit.BB == 1)
        return 0;
    I2caRegs.I2CSAR.all = ADDRESS;
    I2caRegs.I2CCNT = 2;
    I2caRegs.I2CMDR.all = 0x2C20;           /* START, STOP, controller, receiver */
    if (!Await(I2C_CLR_RRDY_BIT)) {
        Give_Up();
        return 0;
    }
    high = I2caRegs.I2CDRR.all;
    if (!Await(I2C_CLR_RRDY_BIT)) {
        Give_Up();
        return 0;
    }
    low = I2caRegs.I2CDRR.all;
    Degrees = (int16)(high << 8 | low) >> 4;
    Taken_Ms = Now_Ms;
    return 1;
}

void main(void)
{
    Uint16 tries, begun;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    Init_I2c();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    for (;;) {
        begun = Now_Ms;
        for (tries = 0; tries < TRIES; tries++)
            if (Ask())
                break;
        if (tries == TRIES)
            Missing++;
        if ((Uint16)(Now_Ms - Taken_Ms) > MAX_AGE_MS)
            Degrees = NO_VALUE;
        Fan = Degrees > 16 * 30;            /* without a value too: it cools to be safe */
        while ((Uint16)(Now_Ms - begun) < 20)
            ;
    }
}
