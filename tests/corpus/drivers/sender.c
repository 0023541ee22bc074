/* sender.c: lines over SCI-A, sent by its transmit interrupt out of one of two buffers, while main fills the other. */
#include "F28x_Project.h"

#define LINE    24
#define NOBODY  2u

struct BUFFER {
    Uint16 length;
    char text[LINE];
};

static struct BUFFER Buffers[2];
static volatile Uint16 Sending = NOBODY;    /* the buffer that is sent: the interrupt gives it back */
static volatile Uint16 Next = 0;            /* of it: the next character */
static volatile Uint32 Total = 0;           /* characters sent */
static volatile Uint16 Check = 0;           /* their sum, of the line that is sent */
static volatile Uint32 Ticks = 0;

static Uint16 Lines = 0;
static Uint16 Waited = 0;

__interrupt void Transmit(void)
{
    struct BUFFER *buffer;
    if (Sending != NOBODY) {
        buffer = &Buffers[Sending];
        if (Next < buffer->length) {
            SciaRegs.SCITXBUF.all = buffer->text[Next];
            Check = Check + buffer->text[Next];
            Next++;
            Total++;
        } else {
            Sending = NOBODY;
            SciaRegs.SCIFFTX.bit.TXFFIENA = 0;
        }
    }
    SciaRegs.SCIFFTX.bit.TXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

__interrupt void Tick(void)
{
    Ticks++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static Uint16 Digits(char *text, Uint16 value)
{
    Uint16 divisor = 10000, length = 0, digit;
    while (divisor > 0) {
        digit = value / divisor % 10;
        text[length] = '0' + digit;
        length++;
        divisor /= 10;
    }
    return length;
}

static void Fill(struct BUFFER *buffer, Uint16 number, Uint16 ticks)
{
    Uint16 at = 0;
    buffer->text[at++] = '#';
    at += Digits(&buffer->text[at], number);
    buffer->text[at++] = ',';
    at += Digits(&buffer->text[at], ticks);
    buffer->text[at++] = '\r';
    buffer->length = at;
}

static void Send(Uint16 which)
{
    while (Sending != NOBODY)
        Waited++;
    /* The interrupt is off here, and nobody sends. */
    Next = 0;
    Check = 0;
    Sending = which;
    SciaRegs.SCIFFTX.bit.TXFFIENA = 1;
}

static Uint32 Sent(void)
{
    Uint32 sent;
    DINT;
    sent = Total;
    EINT;
    return sent;
}

static Uint16 Milliseconds(void)
{
    Uint32 ticks;
    DINT;
    ticks = Ticks;
    EINT;
    return (Uint16)(ticks / 10);
}

static void Init_Sci(void)
{
    GPIO_SetupPinMux(29, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinOptions(29, GPIO_OUTPUT, GPIO_PUSHPULL);
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    EDIS;
    SciaRegs.SCICTL1.all = 0x0000;
    SciaRegs.SCICCR.all = 0x0007;           /* 8N1 */
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;             /* 50 MHz / 8 / 54: 115741 baud */
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6040;
    SciaRegs.SCIFFCT.all = 0x0000;
    SciaRegs.SCICTL1.bit.TXENA = 1;
    SciaRegs.SCICTL1.bit.SWRESET = 1;
}

void main(void)
{
    Uint16 which = 0;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.SCIA_TX_INT = &Transmit;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    Init_Sci();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 100);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx2 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    StartCpuTimer0();
    for (;;) {
        Fill(&Buffers[which], Lines, Milliseconds());
        Send(which);
        which = 1 - which;
        Lines++;
        if (Sent() > 60000ul)
            Lines = 0;
    }
}
