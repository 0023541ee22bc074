/* barrier.c: a barrier that orders of one line open and shut.  CPU timer 1 (1 kHz) turns the arm, and measures its
   speed; CPU timer 0 (1 kHz) is the clock of main.  The arm and the line of orders are simulated in the chip. */
#include "F28x_Project.h"
#include <math.h>
#include <string.h>

#define CONTROL_S       0.001f
#define TURN_RAD_S      8.0f
#define OPEN_RAD        1.4f
#define ARM_M           3.0f
#define MOVE_MAX_MS     250u
#define HEIGHT_MIN_M    0.4f
#define LINE_SIZE       8u
#define REST_MS         30u

typedef enum { SHUT, OPENING, OPEN, SHUTTING, STUCK } ARM;

/* What the line sends, a character each 5 ms; two lines are too long */
static const char script[] = "open\nshutters now\nshut\nopen\nshut\nopenopenopen\nopen\n";

static volatile Uint16 tickMs = 0;
static volatile float angle = 0.0f;             /* rad */
static volatile float turning = 0.0f;           /* rad/s, wanted */
static volatile float speed = 0.0f;             /* rad/s, measured */
static float lastAngle = 0.0f;
static ARM arm = SHUT;
static Uint16 stateMs = 0;
static Uint16 lowMs = 0;
static Uint16 blocked = 0;
static Uint16 seenBlocked = 0;
static char line[LINE_SIZE];
static Uint16 length = 0;
static Uint16 tooLong = 0;
static Uint16 next = 0;
Uint16 refused = 0;
Uint16 opened = 0;
float tip_m = 0.0f;                             /* height of the arm's end */

interrupt void Tick(void)
{
    tickMs++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

interrupt void Turn(void)
{
    float now = angle + turning * CONTROL_S;
    angle = now;
    speed = (now - lastAngle) / CONTROL_S;
    lastAngle = now;
}

static void Enter(ARM wanted)
{
    arm = wanted;
    stateMs = 0;
}

static void Stop(ARM wanted)
{
    turning = 0.0f;
    Enter(wanted);
}

static void Obey(const char *order)
{
    if (strcmp(order, "open") == 0 && arm == SHUT)
        Enter(OPENING);
    else if (strcmp(order, "shut") == 0 && arm == OPEN)
        Enter(SHUTTING);
    else
        refused++;
}

static void Receive(char c)
{
    if (c == '\n') {
        line[length] = '\0';
        if (tooLong || length == 0)
            refused++;
        else
            Obey(line);
        length = 0;
        tooLong = 0;
    } else if (length < LINE_SIZE - 1u) {
        line[length++] = c;
    } else {
        tooLong = 1;
    }
}

static void Move(void)
{
    stateMs++;
    if (speed == 0.0f && turning != 0.0f && stateMs > 5u)
        blocked++;
    switch (arm) {
    case OPENING:
        turning = TURN_RAD_S;
        if (angle >= OPEN_RAD) {
            opened++;
            Stop(OPEN);
        } else if (stateMs > MOVE_MAX_MS || blocked != seenBlocked) {
            seenBlocked = blocked;
            Stop(STUCK);
        }
        break;
    case SHUTTING:
        turning = -TURN_RAD_S;
        if (angle <= 0.0f)
            Stop(SHUT);
        else if (stateMs > MOVE_MAX_MS)
            Stop(STUCK);
        break;
    case STUCK:
        if (stateMs > REST_MS)
            Enter(angle > OPEN_RAD / 2.0f ? OPEN : SHUT);
        break;
    default:
        break;
    }
}

static void Look(void)
{
    float up = angle;
    tip_m = ARM_M * sinf(up);
    lowMs = arm == OPEN && tip_m < HEIGHT_MIN_M ? lowMs + 1u : 0u;
    if (lowMs > REST_MS)
        Stop(STUCK);
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
    PieVectTable.TIMER1_INT = &Turn;
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
        if (last % 20u == 0u && script[next] != '\0')
            Receive(script[next++]);
        Move();
        Look();
    }
}
