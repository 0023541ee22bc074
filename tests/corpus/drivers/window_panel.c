/* window_panel.c: the panel of a shop window with keys, a text display and a counter of turns.  CPU timer 1 (1 kHz) is
   the line: it brings keys, texts and turns.  CPU timer 0 (1 kHz) is the clock of main.  Line and relays are simulated
   in the chip. */
#include "F28x_Project.h"

#define TEXT            12u
#define END             13u
#define RELAY_MS        2u
#define REPORT_MS       50u

static const Uint16 script[] = {'h', 'o', 't', END, 'w', 'a', 'r', 'm', END, 'c', 'o', 'l', 'd', END};
static const Uint16 keys[] = {'+', '-', '+', '+', '-'};

static volatile Uint16 tickMs = 0;
static volatile Uint16 text[TEXT];
static volatile Uint16 length = 0;
static volatile Uint16 full = 0;
static volatile Uint16 key = 0;
static volatile Uint16 turns = 0;
static Uint16 shown[TEXT];
Uint16 relays = 0;
Uint16 level = 5;
Uint16 rate = 0;
Uint16 digits[4];

interrupt void Tick(void)
{
    tickMs++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

interrupt void Line(void)
{
    static Uint16 at = 0;
    static Uint16 pressed = 0;
    static Uint16 gap = 0;
    Uint16 c = script[at];
    gap++;
    if (gap % 3u != 0u)
        turns++;
    if (gap % 20u == 0u) {
        key = keys[pressed];
        pressed = (pressed + 1u) % (sizeof(keys) / sizeof(keys[0]));
    }
    if (full)
        return;
    at = (at + 1u) % (sizeof(script) / sizeof(script[0]));
    if (c == END)
        full = 1;
    else if (length < TEXT)
        text[length++] = c;
}

/* A relay takes its time to switch. */
static void Switch(Uint16 pattern)
{
    Uint16 begun = tickMs;
    relays = pattern;
    while ((Uint16)(tickMs - begun) < RELAY_MS)
        ;
    relays = 0;
}

static void Press(Uint16 pressed)
{
    if (pressed == '+' && level < 9u) {
        level++;
        Switch(1);
    } else if (pressed == '-' && level > 0u) {
        level--;
        Switch(2);
    }
}

static void Show(void)
{
    Uint16 n;
    Uint16 i;
    n = length;
    for (i = 0; i < n; i++)
        shown[i] = text[i];
    for (; i < TEXT; i++)
        shown[i] = ' ';
    length = 0;
    full = 0;
}

static void Report(Uint16 number)
{
    Uint16 i;
    for (i = 0; i < 4u; i++) {
        digits[i] = number % 10u;
        number /= 10u;
    }
}

static void Measure(void)
{
    Uint16 n;
    DINT;
    n = turns;
    turns = 0;
    EINT;
    rate = n * (1000u / REPORT_MS);
    Report(rate);
}

void main(void)
{
    Uint16 last = 0;
    Uint16 pressed;
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
        DINT;
        pressed = key;
        key = 0;
        EINT;
        if (pressed != 0u)
            Press(pressed);
        if (full)
            Show();
        if (last % REPORT_MS == 0u)
            Measure();
    }
}
