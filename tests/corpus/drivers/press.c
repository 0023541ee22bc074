/* press.c: a small press with three coils.  CPU timer 0 (1 kHz) moves the ram and puts its steps into a ring; main takes
   them, measures the speed, and leads the press through its states.  Ram and scale are simulated in the chip. */
#include "F28x_Project.h"

#define RING            16u
#define SELECT_PIN      12u
#define LAMP_PIN        31u
#define DOOR_PIN        14u     /* high: shut */
#define KG_MAX          90u
#define DOWN_MAX_MS     60u
#define HOLD_MS         25u
#define REST_MS         15u
#define FAULT_MS        40u
#define LOOK_MS         10u
#define BOTTOM          120
#define TOP             4

typedef enum { REST, DOWN, HOLD, UP, FAULT } PRESS;

typedef struct {
    Uint16 current;
    Uint16 wanted;
    Uint16 warm;
} COIL;

static volatile int16 ring[RING];
static volatile Uint16 ringIn = 0;
static volatile Uint16 fresh = 0;
static volatile Uint16 tickMs = 0;
static volatile int16 direction = 0;            /* of the ram, per ms */
static Uint16 ringOut = 0;
static COIL left = {0, 0, 0};
static COIL middle = {0, 0, 0};
static COIL right = {0, 0, 0};
static PRESS press = REST;
static Uint16 stateMs = 0;
static int16 depth = 0;
Uint16 scaleRaw = 300;                          /* what the scale measures */
Uint16 scaleReady = 1;
Uint16 unread = 0;
Uint16 faults = 0;
Uint16 cycles = 0;
int16 speed = 0;                                /* in LOOK_MS */

interrupt void Tick(void)
{
    tickMs++;
    ring[ringIn] = direction;
    ringIn = (ringIn + 1u) % RING;
    fresh = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

/* One value of the scale, in kg; 0: it had none */
static Uint16 Weigh(Uint16 *kg)
{
    GPIO_WritePin(SELECT_PIN, 0);
    if (!scaleReady) {
        unread++;
        GPIO_WritePin(SELECT_PIN, 1);
        return 0;
    }
    *kg = scaleRaw >> 2;
    GPIO_WritePin(SELECT_PIN, 1);
    return 1;
}

static void Coils_Off(void)
{
    left.current = 0;
    left.wanted = 0;
    left.warm = 0;
    middle.current = 0;
    middle.wanted = 0;
    middle.warm = 0;
    right.current = 0;
    right.wanted = 0;
    right.warm = 0;
}

static void Coils_On(Uint16 kg)
{
    left.wanted = kg;
    middle.wanted = kg + 1u;
    right.wanted = kg;
}

static void Warm(COIL *coil)
{
    coil->current = coil->wanted;
    if (coil->current > 0)
        coil->warm++;
}

static void Ram(void)
{
    depth += ring[ringOut];
    ringOut = (ringOut + 1u) % RING;
}

static void Lead(void)
{
    Uint16 kg = 0;

    stateMs++;
    switch (press) {
    case REST:
        if (stateMs > REST_MS && GPIO_ReadPin(DOOR_PIN) && Weigh(&kg) && kg < KG_MAX) {
            Coils_On(kg);
            direction = 3;
            press = DOWN;
            stateMs = 0;
        }
        break;
    case DOWN:
        if (depth > BOTTOM) {
            direction = 0;
            press = HOLD;
            stateMs = 0;
        } else if (stateMs > DOWN_MAX_MS) {
            direction = 0;
            Coils_Off();
            press = FAULT;
            stateMs = 0;
        } else if (Weigh(&kg) && kg > KG_MAX) {
            direction = 0;
            Coils_Off();
            press = FAULT;
            stateMs = 0;
        }
        break;
    case HOLD:
        if (stateMs > HOLD_MS) {
            direction = -3;
            press = UP;
            stateMs = 0;
        } else if (!Weigh(&kg)) {
            direction = 0;
            Coils_Off();
            press = FAULT;
            stateMs = 0;
        }
        break;
    case UP:
        if (depth < TOP) {
            direction = 0;
            Coils_Off();
            cycles++;
            press = REST;
            stateMs = 0;
        } else if (stateMs > DOWN_MAX_MS) {
            direction = 0;
            Coils_Off();
            press = FAULT;
            stateMs = 0;
        }
        break;
    default:
        if (stateMs > FAULT_MS && depth >= TOP) {
            direction = -3;
            faults++;
            press = UP;
            stateMs = 0;
        }
        break;
    }
}

void main(void)
{
    Uint16 last = 0, ms = 0;
    int16 seen = 0;
    InitSysCtrl();
    GPIO_SetupPinMux(SELECT_PIN, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(SELECT_PIN, GPIO_OUTPUT, GPIO_PUSHPULL);
    GPIO_SetupPinMux(DOOR_PIN, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(DOOR_PIN, GPIO_INPUT, GPIO_PULLUP);
    GPIO_SetupPinMux(LAMP_PIN, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(LAMP_PIN, GPIO_OUTPUT, GPIO_PUSHPULL);
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200.0f, 1000.0f);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    for (;;) {
        if (fresh) {
            fresh = 0;
            while (ringOut != ringIn)
                Ram();
        }
        if (tickMs == last)
            continue;
        last++;
        ms++;
        if (ms >= LOOK_MS) {
            speed = depth - seen;
            seen = depth;
            ms = 0;
        }
        Lead();
        Warm(&left);
        Warm(&middle);
        Warm(&right);
        GPIO_WritePin(LAMP_PIN, press == FAULT);
        scaleReady = last % 97u != 0u;
    }
}
