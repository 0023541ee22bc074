/* log_line.c: lines of a logger, formed with sprintf and sent over SCI-A by polling: counters, positions, voltages, names. */
#include "F28x_Project.h"
#include <stdio.h>
#include <string.h>

#define LINE        64
#define NAME        8
#define FIFO_DEPTH  16u

struct CHANNEL {
    char name[NAME];        /* ends with 0 */
    int16 offset_mv;
    float32 volts;
};

static char Line[LINE];
static Uint16 Number = 0;
static int16 Speed_mm_s = -120;
static int32 Position_um = -1234567l;
static Uint32 Uptime_ms = 98765ul;
static float32 Temperature_c = 21.75f;
static struct CHANNEL Channels[2] = {{"left", -3, 1.25f}, {"right", 12, 0.5f}};

static void Send(const char *text)
{
    while (*text != 0) {
        while (SciaRegs.SCIFFTX.bit.TXFFST == FIFO_DEPTH)
            ;
        SciaRegs.SCITXBUF.all = *text;
        text++;
    }
}

static void Init_Sci(void)
{
    GPIO_SetupPinMux(29, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinOptions(29, GPIO_OUTPUT, GPIO_PUSHPULL);
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    EDIS;
    SciaRegs.SCICTL1.all = 0x0000;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;             /* 50 MHz / 8 / 54: 115741 baud */
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6040;
    SciaRegs.SCIFFCT.all = 0x0000;
    SciaRegs.SCICTL1.bit.TXENA = 1;
    SciaRegs.SCICTL1.bit.SWRESET = 1;
}

static void Log_Counters(void)
{
    sprintf(Line, "#%u up %lu ms\r\n", Number, Uptime_ms);
    Send(Line);
}

static void Log_Motion(void)
{
    sprintf(Line, "v %d mm/s, x %ld um\r\n", Speed_mm_s, Position_um);
    Send(Line);
}

static void Log_Temperature(void)
{
    sprintf(Line, "%.1f C, status %04x\r\n", Temperature_c, Number);
    Send(Line);
}

static void Log_Channel(const struct CHANNEL *channel)
{
    char name[NAME];
    strcpy(name, channel->name);
    sprintf(Line, "%-6s %6.3f V, offset %d mV, kind %c\r\n", name, channel->volts, channel->offset_mv, name[0]);
    Send(Line);
}

static void Log_Raw(Uint32 word)
{
    sprintf(Line, "raw %08lx\r\n", word);
    Send(Line);
}

void main(void)
{
    InitSysCtrl();
    DINT;
    Init_Sci();
    for (;;) {
        Log_Counters();
        Log_Motion();
        Log_Temperature();
        Log_Channel(&Channels[0]);
        Log_Channel(&Channels[1]);
        Log_Raw((Uint32)Position_um);
        Number++;
        Uptime_ms += 40;
        Position_um += Speed_mm_s * 40l;
    }
}
