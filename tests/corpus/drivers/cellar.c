/* cellar.c: the ventilation of a cellar.  CPU timer 1 (1 kHz) is the line: it takes characters out of a ring, and brings
   what a station outdoors measures.  CPU timer 0 (1 kHz) is the clock of main.  Line and air are simulated in the chip. */
#include "F28x_Project.h"

#define WANTED_MIN      (-120)          /* tenths of a degree */
#define WANTED_MAX      250
#define BAND            4
#define RING            16u
#define STATION_MS      60u
#define FRAMES          25u
#define DAMP_MAX        70u

typedef struct {
    int16 tenths;
    Uint16 damp;
    Uint16 ms;                          /* when it came */
    Uint16 valid;
} STATION;

/* What the line orders: a temperature in two octets */
static const Uint16 script[] = {0x00, 0x5A, 0xFF, 0xEC, 0x02, 0x58, 0x00, 0x50};
static const Uint16 duties[4] = {0, 30, 60, 100};
static const Uint16 blinks[3][2] = {{1, 9}, {3, 3}, {8, 2}};

static volatile Uint16 tickMs = 0;
static volatile Uint16 ring[RING];
static volatile Uint16 ringIn = 0;
static volatile Uint16 ringOut = 0;
static volatile Uint16 wire = 0;
static volatile STATION station = {0, 0, 0, 0};
static volatile Uint16 switches = 0x10;
static int16 air = 120;
static int16 wanted = 80;
static Uint16 cooling = 0;
static Uint16 blink = 0;
static Uint16 number = 0;
static Uint16 at = 0;
Uint16 refused = 0;
Uint16 lost = 0;
Uint16 duty = 0;
Uint16 lamp = 0;

interrupt void Tick(void)
{
    tickMs++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

interrupt void Line(void)
{
    static Uint16 gap = 0;
    static Uint16 frames = 0;
    if (ringOut != ringIn) {
        wire = ring[ringOut];
        ringOut = (ringOut + 1u) & (RING - 1u);
    }
    gap++;
    if (gap < 20u)
        return;
    gap = 0;
    switches += 0x10;
    if (frames < FRAMES) {
        frames++;
        station.tenths = (int16)frames - 10;
        station.damp = 40u + frames;
        station.ms = tickMs;
        station.valid = 1;
    }
}

static void Send(Uint16 c)
{
    Uint16 next = (ringIn + 1u) & (RING - 1u);
    if (next == ringOut) {
        lost++;
        return;
    }
    ring[ringIn] = c;
    ringIn = next;
}

static Uint16 Chosen(void)
{
    return switches >> 4 & 3u;
}

static void Obey(Uint16 high, Uint16 low, Uint16 allowed)
{
    int16 asked = (int16)(high << 8 | low);
    if (allowed && asked >= WANTED_MIN && asked <= WANTED_MAX)
        wanted = asked;
    else
        refused++;
    blink = (blink + 1u) % (sizeof(blinks) / sizeof(blinks[0]));
}

static void Control(void)
{
    STATION outside;
    Uint16 chosen = Chosen();
    DINT;
    if ((Uint16)(tickMs - station.ms) > STATION_MS)
        station.valid = 0;
    outside = station;
    EINT;
    if (air > wanted + BAND)
        cooling = 1;
    else if (air < wanted - BAND)
        cooling = 0;
    duty = 0;
    if (outside.valid && outside.damp < DAMP_MAX && outside.tenths < air && cooling)
        duty = duties[chosen];
    air += duty > 20u ? -2 : 1;
}

static void Report(void)
{
    Send(0x40u | (number & 0xFu));
    Send((Uint16)air & 0xFFu);
    Send(duty);
    number++;
}

void main(void)
{
    Uint16 last = 0;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.TIMER1_INT = &Line;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200.0f, 1000.0f);
    ConfigCpuTimer(&CpuTimer1, 200.0f, 1000.0f);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1 | M_INT13;
    EINT;
    StartCpuTimer0();
    StartCpuTimer1();
    for (;;) {
        if (tickMs == last)
            continue;
        last++;
        if (last % 10u == 0u)
            Control();
        if (last % 30u == 0u)
            Report();
        if (last % 100u == 0u && at + 1u < sizeof(script)) {
            Obey(script[at], script[at + 1u], duty < 100u);
            at += 2u;
        }
        lamp = last % 16u < blinks[blink][0] + blinks[blink][1];
    }
}
