/* command.c: orders come in over SCI-A, which is looped back to itself for a self test: the driver sends each order and
   must understand it. A watchdog of states, a table of functions, answers in a list. */
#include "F28x_Project.h"
#include <string.h>

#define LINE        16u
#define ANSWERS     4u
#define PATIENCE    2000u

enum ORDER { NONE, STOP, GO, TURN, ASK };
enum STATE { RESTING, DRIVING, TURNING };

struct ANSWER {
    enum ORDER order;
    Uint16 number;
};

static char Line[LINE];
static Uint16 Length = 0;
static enum STATE State = RESTING;
static Uint16 Speed = 0;
static Uint16 Errors = 0;
static struct ANSWER Answers[ANSWERS];
static Uint16 Answered = 0;
static Uint16 Stops = 0;

static void Stop(Uint16 number)
{
    State = RESTING;
    Speed = 0;
    Stops += number;
}

static void Go(Uint16 number)
{
    State = DRIVING;
    Speed = number;
}

static void Turn(Uint16 number)
{
    State = TURNING;
    Speed = number / 2;
}

static void (*const Doing[])(Uint16) = {Stop, Go, Turn};

static void Init_Sci(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    EDIS;
    SciaRegs.SCICTL1.all = 0x0000;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCICCR.bit.LOOPBKENA = 1;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x2040;
    SciaRegs.SCIFFCT.all = 0x0000;
    SciaRegs.SCICTL1.bit.RXENA = 1;
    SciaRegs.SCICTL1.bit.TXENA = 1;
    SciaRegs.SCICTL1.bit.SWRESET = 1;
}

static void Send(const char *text)
{
    while (*text) {
        SciaRegs.SCITXBUF.all = *text;
        text++;
    }
}

/* 1: a line has come, without its end. */
static Uint16 Receive(void)
{
    char c;
    Uint16 patience = PATIENCE;
    Length = 0;
    while (patience > 0) {
        if (SciaRegs.SCIFFRX.bit.RXFFST == 0) {
            patience--;
            DELAY_US(1);
            continue;
        }
        c = SciaRegs.SCIRXBUF.bit.SAR;
        if (c == '\r') {
            Line[Length] = 0;
            return 1;
        }
        if (Length < LINE - 1) {
            Line[Length] = c;
            Length++;
        }
    }
    return 0;
}

static enum ORDER Understand(const char *line)
{
    enum ORDER order = NONE;
    if (strncmp(line, "STOP", 4) == 0)
        order = STOP;
    else if (strncmp(line, "GO", 2) == 0)
        order = GO;
    else if (strncmp(line, "TURN", 4) == 0)
        order = TURN;
    else if (strncmp(line, "ASK", 3) == 0)
        order = ASK;
    return order;
}

static Uint16 Number(const char *line)
{
    Uint16 value = 0;
    while (*line != 0 && (*line < '0' || *line > '9'))
        line++;
    while (*line >= '0' && *line <= '9') {
        value = value * 10 + (*line - '0');
        line++;
    }
    return value;
}

static void Answer(enum ORDER order, Uint16 number)
{
    Answers[Answered % ANSWERS].order = order;
    Answers[Answered % ANSWERS].number = number;
    Answered++;
}

static void Obey(enum ORDER order, Uint16 number)
{
    switch (order) {
    case STOP:
    case GO:
    case TURN:
        Doing[order - STOP](number);
        break;
    case ASK:
        Answer(order, Speed);
        break;
    default:
        Errors++;
        break;
    }
}

static void Pass(const char *text)
{
    Send(text);
    if (Receive())
        Obey(Understand(Line), Number(Line));
    else
        Errors++;
}

void main(void)
{
    InitSysCtrl();
    DINT;
    Init_Sci();
    for (;;) {
        Pass("GO 300\r");
        Pass("ASK\r");
        Pass("TURN 90\r");
        Pass("STOP 1\r");
        Pass("HELLO\r");
    }
}
