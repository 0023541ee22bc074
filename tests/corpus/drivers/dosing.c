/* dosing.c: doses a liquid out of a tank that is simulated in the chip: a valve on ePWM2, a level, a tilt, a heater; each
   part has a unit of its own. */
#include "F28x_Project.h"
#include <math.h>

#define TICK_US         1000.0f
#define PERIOD          5000u           /* counts of 100 MHz: 20 kHz */
#define SETTLE_US       200
#define OPEN_MS         40
#define PAUSE_MS        25
#define DRAIN_TIME_US   60000UL
#define LEAST_MM        120
#define FULL_CM         30
#define RISE_RPM        4.0f            /* rpm */
#define FALL_RPM        8.0f            /* rpm */
#define FAST_RPM        240.0f
#define TURNS_PER_S     0.0166667f
#define HOT_TEMP_DC     452             /* 45.2 degrees, in tenths */
#define TILT_LIMIT_DEG  12.0f
#define VALVE_MV        3300L

typedef struct {
    int16   level;                      /* mm */
    int16   temperatureDc;
    float   x;                          /* of gravity, 1 is all of it */
    float   z;
} Tank;

static volatile Uint16 tickMs = 0;
static Tank tank = {250, 200, 0.05f, 0.99f};
static float speedRpm = 0.0f;
static float turns = 0.0f;
static Uint16 openedMs = 0;
static Uint32 openUs = 0;               /* in all */
static int16 levelCm = 0;
static float tiltDeg = 0.0f;
static Uint16 heating = 0;
static Uint16 doses = 0;
static int16 valveMv = 0;
static int16 duty_permille = 0;

__interrupt void Tick(void)
{
    tickMs++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Valve(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm2Regs.TBPRD = PERIOD - 1;
    EPwm2Regs.TBCTR = 0;
    EPwm2Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm2Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm2Regs.CMPA.bit.CMPA = 0;
    EPwm2Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm2Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    InitEPwm2Gpio();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static void Set_Valve(int16 permille)
{
    duty_permille = permille;
    valveMv = (int16)(VALVE_MV * permille / 1000);
    EPwm2Regs.CMPA.bit.CMPA = (Uint16)((Uint32)PERIOD * (Uint16)permille / 1000u);
    DELAY_US(SETTLE_US);
}

/* How long the valve has been open, in microseconds */
static Uint32 Opened_us(void)
{
    return (Uint32)(Uint16)(tickMs - openedMs) * 1000UL;
}

static void Pump(float targetRpm)
{
    float error = targetRpm - speedRpm;
    if (targetRpm > speedRpm + RISE_RPM)
        speedRpm += RISE_RPM;
    else if (targetRpm < speedRpm - FALL_RPM)
        speedRpm -= FALL_RPM;
    else
        speedRpm = targetRpm;
    turns += speedRpm * TURNS_PER_S * 0.001f;
    if (fabsf(error) > FAST_RPM)
        speedRpm = 0.0f;
}

/* What the tank does in a millisecond */
static void Simulate(void)
{
    if (duty_permille > 0 && tank.level > 0 && (tickMs & 7u) == 0u)
        tank.level--;
    if (heating)
        tank.temperatureDc++;
    else if (tank.temperatureDc > 200)
        tank.temperatureDc--;
    tank.x = 0.05f + (float)(tickMs & 63u) * 0.001f;
}

static void Dose(void)
{
    Uint16 now = tickMs;
    if (duty_permille == 0) {
        if ((Uint16)(now - openedMs) > PAUSE_MS && tank.level > LEAST_MM) {
            openedMs = now;
            Set_Valve(700);
        }
    } else if (Opened_us() >= OPEN_MS * 1000UL) {
        openUs += Opened_us();
        openedMs = now;
        doses++;
        Set_Valve(0);
    }
    if (openUs > DRAIN_TIME_US)
        openUs = 0;
}

static void Look(void)
{
    levelCm = tank.level / 10;
    if (levelCm > FULL_CM)
        Set_Valve(900);
    tiltDeg = atan2f(tank.x, tank.z) * (180.0f / 3.14159265f);
    heating = tank.temperatureDc < HOT_TEMP_DC && tiltDeg < TILT_LIMIT_DEG;
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
    EDIS;
    Init_Valve();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200.0f, TICK_US);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    for (;;) {
        if (tickMs == last)
            continue;
        last = tickMs;
        Simulate();
        Pump(tickMs < 200u ? 120.0f : 60.0f);
        Dose();
        Look();
    }
}
