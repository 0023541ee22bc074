/* drive_link.c: a motor whose speed comes in frames "<nnn>" over SCI-A.  Frames that are older than 100 ms stop it.
   The module is looped back: for the first 300 ms the driver sends the frames itself, then the link is silent. */
#include "F28x_Project.h"

#define BRR_115200      53u             /* 50 MHz / (54 * 8) = 115.7 kBd */
#define LINK_LOST_MS    100u
#define SELF_TEST_MS    300u
#define PERIOD          5000u
#define SPEED_MAX       100u
#define FIFO_DEPTH      16u

static volatile Uint16 Now_Ms = 0;
static volatile Uint16 Last_Frame_Ms = 0;
static volatile Uint16 Speed = 0;           /* percent */
static volatile Uint16 Frames = 0;
static volatile Uint16 Overruns = 0;
static volatile Uint16 Lost = 0;

static Uint16 Inside = 0;
static Uint16 Number = 0;
static Uint16 Digits = 0;

static void Take(Uint16 c)
{
    if (c == '<') {
        Inside = 1;
        Number = 0;
        Digits = 0;
    } else if (c == '>') {
        if (Inside && Digits == 3 && Number <= SPEED_MAX) {
            Speed = Number;
            Last_Frame_Ms = Now_Ms;
            Frames++;
        }
        Inside = 0;
    } else if (c >= '0' && c <= '9' && Digits < 3) {
        Number = 10 * Number + (c - '0');
        Digits++;
    } else {
        Inside = 0;
    }
}

__interrupt void Received(void)
{
    if (SciaRegs.SCIFFRX.bit.RXFFOVF == 1) {
        SciaRegs.SCIFFRX.bit.RXFIFORESET = 0;
        SciaRegs.SCIFFRX.bit.RXFFOVRCLR = 1;
        SciaRegs.SCIFFRX.bit.RXFIFORESET = 1;
        Overruns++;
        Inside = 0;
    }
    if (SciaRegs.SCIRXST.bit.RXERROR == 1) {
        SciaRegs.SCICTL1.bit.SWRESET = 0;
        SciaRegs.SCICTL1.bit.SWRESET = 1;
        Inside = 0;
    }
    while (SciaRegs.SCIFFRX.bit.RXFFST > 0)
        Take(SciaRegs.SCIRXBUF.bit.SAR);
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

__interrupt void Tick(void)
{
    Now_Ms++;
    if ((Uint16)(Now_Ms - Last_Frame_Ms) > LINK_LOST_MS) {
        if (Speed != 0)
            Lost++;
        Speed = 0;
        Last_Frame_Ms = Now_Ms - LINK_LOST_MS;      /* does not come back when the counter wraps */
    }
    EPwm2Regs.CMPA.bit.CMPA = Speed * (PERIOD / 100);
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Sci(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    ClkCfgRegs.LOSPCP.bit.LSPCLKDIV = 2;
    EDIS;
    SciaRegs.SCICTL1.all = 0x0000;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCICCR.bit.LOOPBKENA = 1;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = BRR_115200;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6061;              /* interrupt at one character */
    SciaRegs.SCIFFCT.all = 0x0000;
    SciaRegs.SCICTL1.all = 0x0023;
}

static void Init_Motor(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm2Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm2Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm2Regs.TBPRD = PERIOD - 1;
    EPwm2Regs.CMPA.bit.CMPA = 0;
    EPwm2Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm2Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    InitEPwm2Gpio();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static void Put(Uint16 c)
{
    while (SciaRegs.SCIFFTX.bit.TXFFST >= FIFO_DEPTH)
        ;
    SciaRegs.SCITXBUF.all = c;
}

static void Send(Uint16 speed)
{
    Put('<');
    Put('0' + speed / 100);
    Put('0' + speed / 10 % 10);
    Put('0' + speed % 10);
    Put('>');
}

void main(void)
{
    Uint16 speed = 20, next_ms = 10;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.SCIA_RX_INT = &Received;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    Init_Motor();
    Init_Sci();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    StartCpuTimer0();
    while (Now_Ms < SELF_TEST_MS) {
        if (Now_Ms >= next_ms) {
            Send(speed);
            speed = speed < 60 ? speed + 5 : 20;
            next_ms += 20;
        }
    }
    for (;;)
        ;
}
