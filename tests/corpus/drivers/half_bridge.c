/* half_bridge.c: a half bridge on ePWM2 with dead band and a trip input; a CPU timer leads its duty along a ramp, and
   lets it start again some time after a trip. */
#include "F28x_Project.h"

#define HALF_PERIOD  2500u          /* 100 MHz, up and down: 20 kHz */
#define DEAD_TIME    50u            /* 500 ns */
#define DUTY_MIN     125u           /* 5 % */
#define DUTY_MAX     2250u          /* 90 % */
#define STEP         5u
#define FAULT_PIN    43u            /* open drain of the gate driver, low = fault */
#define REST_TICKS   50u

enum STATE { RAMPING, HOLDING, TRIPPED };

static volatile enum STATE State = RAMPING;
static volatile Uint16 Wanted = DUTY_MAX;
static volatile Uint16 Duty = DUTY_MIN;
static volatile Uint16 Trips = 0;
static Uint16 Rest = 0;

__interrupt void Fault(void)
{
    Trips++;
    Duty = DUTY_MIN;
    EPwm2Regs.CMPA.bit.CMPA = Duty;
    Rest = REST_TICKS;
    State = TRIPPED;
    EALLOW;
    EPwm2Regs.TZEINT.bit.OST = 0;       /* the latch holds its interrupt until it is cleared */
    EDIS;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP2;
}

__interrupt void Ramp(void)
{
    switch (State) {
    case RAMPING:
        if (Duty < Wanted) {
            Duty += STEP;
        } else {
            Duty = Wanted;
            State = HOLDING;
        }
        break;
    case HOLDING:
        if (Duty != Wanted)
            State = RAMPING;       /* the wish has changed */
        break;
    case TRIPPED:
        if (Rest > 0) {
            Rest--;
        } else {
            EALLOW;
            EPwm2Regs.TZCLR.bit.OST = 1;
            EPwm2Regs.TZCLR.bit.INT = 1;
            EPwm2Regs.TZEINT.bit.OST = 1;
            EDIS;
            State = RAMPING;
        }
        break;
    default:
        State = HOLDING;
        break;
    }
    EPwm2Regs.CMPA.bit.CMPA = Duty;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Pins(void)
{
    GPIO_SetupPinMux(FAULT_PIN, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(FAULT_PIN, GPIO_INPUT, GPIO_PULLUP | GPIO_ASYNC);
    EALLOW;
    InputXbarRegs.INPUT1SELECT = FAULT_PIN;
    GpioCtrlRegs.GPAPUD.bit.GPIO2 = 1;
    GpioCtrlRegs.GPAPUD.bit.GPIO3 = 1;
    GpioCtrlRegs.GPAGMUX1.bit.GPIO2 = 0;
    GpioCtrlRegs.GPAGMUX1.bit.GPIO3 = 0;
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO3 = 1;
    EDIS;
}

static void Init_Bridge(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm2Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm2Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm2Regs.TBPRD = HALF_PERIOD;
    EPwm2Regs.TBCTR = 0;
    EPwm2Regs.CMPCTL.bit.SHDWAMODE = CC_SHADOW;
    EPwm2Regs.CMPCTL.bit.LOADAMODE = CC_CTR_ZERO;
    EPwm2Regs.CMPA.bit.CMPA = DUTY_MIN;
    EPwm2Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm2Regs.AQCTLA.bit.CAD = AQ_SET;
    EPwm2Regs.DBCTL.bit.IN_MODE = DBA_ALL;
    EPwm2Regs.DBCTL.bit.POLSEL = DB_ACTV_HIC;
    EPwm2Regs.DBRED.bit.DBRED = DEAD_TIME;
    EPwm2Regs.DBFED.bit.DBFED = DEAD_TIME;
    EPwm2Regs.DBCTL.bit.OUT_MODE = DB_FULL_ENABLE;
    EALLOW;
    EPwm2Regs.TZSEL.bit.OSHT1 = TZ_ENABLE;
    EPwm2Regs.TZCTL.bit.TZA = TZ_FORCE_LO;
    EPwm2Regs.TZCTL.bit.TZB = TZ_FORCE_LO;
    EPwm2Regs.TZCLR.all = 0x0007;
    EPwm2Regs.TZEINT.all = 0x0004;
    EDIS;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UPDOWN;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
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
    PieVectTable.EPWM2_TZ_INT = &Fault;
    PieVectTable.TIMER0_INT = &Ramp;
    EDIS;
    Init_Pins();                        /* the trip input first: pin 0 is none */
    Init_Bridge();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 100);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER2.bit.INTx2 = 1;
    IER |= M_INT1 | M_INT2;
    EINT;
    StartCpuTimer0();
    for (;;) {
        /* A test of the trip, once the bridge has reached its duty. */
        if (State == HOLDING && Trips == 0) {
            EALLOW;
            EPwm2Regs.TZFRC.bit.OST = 1;
            EDIS;
        }
        DELAY_US(200);
    }
}
