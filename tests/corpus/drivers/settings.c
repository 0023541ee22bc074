/* settings.c: settings of four motors in RAM, with a copy and a check sum; a log of what was changed; output to ePWM1. */
#include "F28x_Project.h"
#include <string.h>

#define MOTORS      4u
#define NAME        6
#define LOG         8u

enum MODE { OFF, SLOW, FAST };

struct MOTOR {
    char name[NAME];
    int16 limit;
    Uint16 gains[3];
    enum MODE mode;
};

struct SETTINGS {
    struct MOTOR motors[MOTORS];
    Uint16 sum;
};

struct ENTRY {
    Uint16 motor;
    Uint16 value;
};

static const struct MOTOR Default = {"motor", 500, {10, 20, 30}, SLOW};
static struct SETTINGS Active;
static struct SETTINGS Saved;
static struct ENTRY Log[LOG];
static Uint16 Logged = 0;
static Uint16 Newest = 0;
static Uint16 Damaged = 0;
static Uint16 Highest = 0;
static Uint16 Duty = 0;

static Uint16 Sum(const struct SETTINGS *settings)
{
    const Uint16 *words = (const Uint16 *)settings;
    Uint16 sum = 0, i;
    for (i = 0; i < sizeof(struct MOTOR) * MOTORS; i++)
        sum += words[i];
    return sum;
}

static void Reset(struct SETTINGS *settings)
{
    Uint16 i;
    memset(settings, 0, sizeof(struct SETTINGS));
    for (i = 0; i < MOTORS; i++)
        memcpy(&settings->motors[i], &Default, sizeof(struct MOTOR));
    settings->sum = Sum(settings);
}

static void Save(void)
{
    Active.sum = Sum(&Active);
    Saved = Active;
}

static Uint16 Load(void)
{
    if (Saved.sum != Sum(&Saved))
        return 0;
    memcpy(&Active, &Saved, sizeof(Active));
    return 1;
}

static void Rename(struct MOTOR *motor, const char *name)
{
    strncpy(motor->name, name, NAME - 1);
    motor->name[NAME - 1] = 0;
}

static void Note(Uint16 motor, Uint16 value)
{
    Log[Newest].motor = motor;
    Log[Newest].value = value;
    Newest++;
    if (Newest == LOG)
        Newest = 0;
    Logged++;
}

static Uint16 Speed(const struct MOTOR *motor)
{
    Uint16 speed = 0;
    switch (motor->mode) {
    case OFF:
        speed = 0;
        break;
    case SLOW:
        speed = 100;
        break;
    case FAST:
        speed = 400;
        break;
    }
    return speed;
}

static Uint16 Greatest_Gain(const struct MOTOR *motor)
{
    Uint16 greatest, i;
    greatest = motor->gains[0];
    for (i = 1; i < 3; i++) {
        if (motor->gains[i] > greatest)
            greatest = motor->gains[i];
    }
    return greatest;
}

static struct MOTOR *Find(char first)
{
    Uint16 i;
    for (i = 0; i < MOTORS; i++) {
        if (Active.motors[i].name[0] == first)
            return &Active.motors[i];
    }
    return 0;
}

static void Set_Limit(struct MOTOR *motor, int16 limit)
{
    if (limit < 0)
        limit = 0;
    motor->limit = limit;
}

static void Init_Pwm(void)
{
    GPIO_SetupPinMux(0, GPIO_MUX_CPU1, 1);
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm1Regs.TBPRD = 1000;
    EPwm1Regs.TBCTL.bit.CLKDIV = 0;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm1Regs.CMPA.bit.CMPA = 0;
    EPwm1Regs.AQCTLA.bit.ZRO = 2;
    EPwm1Regs.AQCTLA.bit.CAU = 1;
    EPwm1Regs.TBCTL.bit.CTRMODE = 0;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static void Round(Uint16 turn)
{
    struct MOTOR *motor = &Active.motors[turn % MOTORS];
    struct MOTOR *other;
    motor->mode = (enum MODE)(turn % 3);
    motor->gains[turn % 3] = turn;
    Set_Limit(motor, (int16)turn);
    Note(turn % MOTORS, turn);
    Highest = Greatest_Gain(motor);
    Duty = Speed(motor);
    EPwm1Regs.CMPA.bit.CMPA = Duty;
    other = Find('b');
    if (other != 0)
        other->limit = motor->limit;
    Save();
    if (!Load())
        Damaged++;
}

void main(void)
{
    Uint16 turn = 0;
    InitSysCtrl();
    DINT;
    Init_Pwm();
    Reset(&Active);
    Rename(&Active.motors[0], "arm");
    Rename(&Active.motors[1], "belt");
    Rename(&Active.motors[2], "conveyor");
    Rename(&Active.motors[3], "drum");
    for (;;) {
        Round(turn);
        turn++;
        DELAY_US(200);
    }
}
