/* clock_stamp.c: timer 0 counts milliseconds and a time of day, timer 1 stamps events into a ring. main takes the
   stamps out, keeps the longest distance of two, and sets the next alarm. */
#include "F28x_Project.h"

#define RING        16u         /* a power of two */
#define RAN_FULL    0x0001u
#define ALARM       0x0002u
#define ALARM_MS    70ul

struct TIME {
    Uint16 hours;
    Uint16 minutes;
    Uint16 seconds;
};

static volatile Uint32 Millis = 65000ul;
static volatile struct TIME Time = {11, 59, 59};
static volatile Uint16 Part = 500;
static volatile Uint32 Alarm_ms = 65070ul;
static volatile Uint16 Flags = 0;
static volatile Uint32 Ring[RING];
static volatile Uint16 Head = 0;
static volatile Uint16 Tail = 0;

static Uint32 Longest_ms = 0;
static Uint16 Alarms = 0;
static Uint16 Losses = 0;
static Uint16 Noon = 0;

__interrupt void Millisecond(void)
{
    Millis++;
    if (Millis == Alarm_ms)
        Flags |= ALARM;
    Part++;
    if (Part == 1000) {
        Part = 0;
        Time.seconds++;
        if (Time.seconds == 60) {
            Time.seconds = 0;
            Time.minutes++;
        }
        if (Time.minutes == 60) {
            Time.minutes = 0;
            Time.hours++;
        }
        if (Time.hours == 24)
            Time.hours = 0;
    }
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

__interrupt void Event(void)
{
    Uint16 next = (Head + 1) & (RING - 1);
    if (next == Tail) {
        Flags |= RAN_FULL;
    } else {
        Ring[Head] = Millis;
        Head = next;
    }
}

static Uint32 Now(void)
{
    Uint32 now;
    DINT;
    now = Millis;
    EINT;
    return now;
}

static Uint16 Take_Flags(void)
{
    Uint16 taken;
    DINT;
    taken = Flags;
    Flags = 0;
    EINT;
    return taken;
}

static void Set_Alarm(Uint32 at)
{
    DINT;
    Alarm_ms = at;
    EINT;
}

static Uint16 Minute_Of_Day(void)
{
    Uint16 hours, minutes;
    DINT;
    hours = Time.hours;
    minutes = Time.minutes;
    EINT;
    return hours * 60 + minutes;
}

static Uint16 Take(Uint32 *stamp)
{
    if (Tail == Head)
        return 0;
    *stamp = Ring[Tail];
    Tail = (Tail + 1) & (RING - 1);
    return 1;
}

static void Watch(void)
{
    Uint32 stamp = 0, last = 0;
    Uint16 flags, known = 0;
    for (;;) {
        while (Take(&stamp)) {
            if (known && stamp - last > Longest_ms)
                Longest_ms = stamp - last;
            last = stamp;
            known = 1;
        }
        flags = Take_Flags();
        if (flags & ALARM) {
            Alarms++;
            Set_Alarm(Now() + ALARM_MS);
        }
        if (flags & RAN_FULL) {
            Losses++;
            known = 0;
        }
        if (Minute_Of_Day() == 720)
            Noon = 1;
        DELAY_US(3000);
    }
}

void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Millisecond;
    PieVectTable.TIMER1_INT = &Event;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    ConfigCpuTimer(&CpuTimer1, 200, 430);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1 | M_INT13;
    EINT;
    StartCpuTimer0();
    StartCpuTimer1();
    Watch();
}
