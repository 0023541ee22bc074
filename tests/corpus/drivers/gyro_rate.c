/* gyro_rate.c: the rate of turn of an L3G4200D on SPI-A, 8 bits, mode 3, five megabits; a rate that the sensor does
   not renew counts as lost after 20 ms, and so does a sensor that does not say who it is. */
#include "F28x_Project.h"

#define WHO_AM_I        0x0F
#define CTRL_REG1       0x20
#define CTRL_REG4       0x23
#define STATUS_REG      0x27
#define OUT_Z_L         0x2C
#define READ            0x80
#define AGAIN           0x40        /* the address counts */
#define I_AM            0xD3
#define ZDA             0x04        /* new data of Z */
#define BRR             9           /* 50 MHz / 10: the part takes 10 MHz at most */
#define LOST_AFTER_MS   20u
#define SETTLE_MS       250u

enum STATE { SEARCHING, MEASURING, LOST };

static volatile Uint16 Now_Ms = 0;
static enum STATE State = SEARCHING;
static int16 Rate = 0;                  /* 8.75 mdps a digit */
static int64 Heading = 0;
static Uint16 Samples = 0;
static Uint16 Losses = 0;

__interrupt void Tick(void)
{
    Now_Ms++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Spi(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1;
    EDIS;
    GPIO_SetupPinMux(58, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(59, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(60, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinOptions(58, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(59, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(60, GPIO_INPUT, GPIO_ASYNC);
    GpioDataRegs.GPBSET.bit.GPIO61 = 1;
    GPIO_SetupPinMux(61, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(61, GPIO_OUTPUT, GPIO_PUSHPULL);
    SpiaRegs.SPICCR.bit.SPISWRESET = 0;
    SpiaRegs.SPICCR.bit.SPICHAR = 7;
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1;
    SpiaRegs.SPICTL.bit.CLK_PHASE = 0;
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpiaRegs.SPICTL.bit.TALK = 1;
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = BRR;
    SpiaRegs.SPICCR.bit.SPISWRESET = 1;
}

static void Select(void)
{
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1;
}

static void Release(void)
{
    GpioDataRegs.GPBSET.bit.GPIO61 = 1;
    DELAY_US(1);
}

static Uint16 Exchange(Uint16 octet)
{
    SpiaRegs.SPITXBUF = octet << 8;
    while (SpiaRegs.SPISTS.bit.INT_FLAG == 0)
        ;
    return SpiaRegs.SPIRXBUF & 0xFF;
}

static void Write_Register(Uint16 address, Uint16 value)
{
    Select();
    Exchange(address);
    Exchange(value);
    Release();
}

static Uint16 Read_Register(Uint16 address)
{
    Uint16 value;
    Select();
    Exchange(address | READ);
    value = Exchange(0);
    Release();
    return value;
}

static int16 Read_Z(void)
{
    Uint16 low, high;
    Select();
    Exchange(OUT_Z_L | READ | AGAIN);
    low = Exchange(0);
    high = Exchange(0);
    Release();
    return (int16)(high << 8 | low);
}

/* 1 if the sensor is there and measures. */
static Uint16 Start_Gyro(void)
{
    if (Read_Register(WHO_AM_I) != I_AM)
        return 0;
    Write_Register(CTRL_REG1, 0xCF);        /* 800 Hz, all axes */
    Write_Register(CTRL_REG4, 0x80);        /* both octets of one sample */
    return Read_Register(CTRL_REG1) == 0xCF;
}

void main(void)
{
    Uint16 fresh_ms = 0, now;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    Init_Spi();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    for (;;) {
        now = Now_Ms;
        switch (State) {
        case SEARCHING:
            if (Start_Gyro()) {
                fresh_ms = now + SETTLE_MS;
                while ((int16)(Now_Ms - fresh_ms) < 0)
                    ;
                State = MEASURING;
            } else {
                DELAY_US(5000);
            }
            break;
        case MEASURING:
            if (Read_Register(STATUS_REG) & ZDA) {
                Rate = Read_Z();
                Heading += Rate;
                Samples++;
                fresh_ms = now;
            } else if ((int16)(now - fresh_ms) > (int16)LOST_AFTER_MS) {
                State = LOST;
            }
            break;
        case LOST:
        default:
            Rate = 0;
            Losses++;
            State = SEARCHING;
            break;
        }
        DELAY_US(200);
    }
}
