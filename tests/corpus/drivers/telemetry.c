/* telemetry.c: a report each 100 ms over SCI-C to a radio of 9600 baud; the transmit FIFO is fed by its interrupt. */
#include "F28x_Project.h"
#include <stdio.h>

#define LSPCLK_HZ   50000000ul
#define BAUD        9600ul
#define BRR         (LSPCLK_HZ / (BAUD * 8) - 1)
#define FIFO_DEPTH  16u
#define LINE        40

static volatile Uint16 Ticks = 0;
static char Line[LINE] = "";
static volatile Uint16 Length = 0;
static volatile Uint16 Sent = 0;
static Uint16 Reports = 0;
static Uint16 Skipped = 0;

__interrupt void Transmit(void)
{
    while (Sent < Length && ScicRegs.SCIFFTX.bit.TXFFST < FIFO_DEPTH) {
        ScicRegs.SCITXBUF.all = Line[Sent];
        Sent++;
    }
    if (Sent == Length)
        ScicRegs.SCIFFTX.bit.TXFFIENA = 0;
    ScicRegs.SCIFFTX.bit.TXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP8;
}

__interrupt void Tick(void)
{
    Ticks++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Pins(void)
{
    GPIO_SetupPinMux(89, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinOptions(89, GPIO_OUTPUT, GPIO_PUSHPULL);
    GPIO_SetupPinMux(90, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinOptions(90, GPIO_INPUT, GPIO_PULLUP | GPIO_ASYNC);
}

static void Init_Sci(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_C = 1;
    ClkCfgRegs.LOSPCP.bit.LSPCLKDIV = 2;            /* SYSCLK / 4 */
    EDIS;
    ScicRegs.SCICTL1.all = 0x0000;
    ScicRegs.SCICCR.all = 0x0007;                   /* 8N1 */
    ScicRegs.SCIHBAUD.all = BRR >> 8;
    ScicRegs.SCILBAUD.all = BRR & 0xFF;
    ScicRegs.SCIFFTX.all = 0xE040;
    ScicRegs.SCIFFRX.all = 0x6040;
    ScicRegs.SCIFFCT.all = 0x0000;
    ScicRegs.SCICTL1.bit.TXENA = 1;
    ScicRegs.SCICTL1.bit.SWRESET = 1;
}

static Uint16 Report(Uint16 ms, Uint16 number)
{
    if (Sent < Length || ScicRegs.SCICTL2.bit.TXEMPTY == 0)
        return 0;
    Length = 0;
    Sent = 0;
    Length = sprintf(Line, "#%u,%u\r\n", number, ms);
    ScicRegs.SCIFFTX.bit.TXFFIENA = 1;
    return 1;
}

void main(void)
{
    Uint16 before = 0;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.SCIC_TX_INT = &Transmit;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    Init_Pins();
    Init_Sci();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER8.bit.INTx6 = 1;
    IER |= M_INT1 | M_INT8;
    EINT;
    StartCpuTimer0();
    for (;;) {
        Uint16 now = Ticks;
        if ((Uint16)(now - before) >= 100) {
            before += 100;
            if (Report(now, Reports))
                Reports++;
            else
                Skipped++;
        }
    }
}
