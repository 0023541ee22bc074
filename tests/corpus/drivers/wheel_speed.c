/* wheel_speed.c: position and speed of a measuring wheel with 500 lines on eQEP1; the unit timer latches the position
   each 10 ms and interrupts, main makes a speed of it. */
#include "F28x_Project.h"

#define UNIT_CYCLES     2000000ul       /* 10 ms of 200 MHz */
#define COUNTS_PER_TURN 2000
#define UM_PER_TURN     314159l
#define STILL_AFTER     20u             /* windows without a count */

struct WHEEL {
    int32 counts;           /* since the start */
    int32 mm;               /* the same as a length */
    int32 um_per_s;
    Uint16 still;           /* 1: it stands */
};

static volatile Uint32 Latched = 0;
static volatile Uint16 Windows = 0;
static struct WHEEL Wheel = {0, 0, 0, 1};

__interrupt void Unit(void)
{
    Latched = EQep1Regs.QPOSLAT;
    Windows++;
    EQep1Regs.QCLR.bit.UTO = 1;
    EQep1Regs.QCLR.bit.INT = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP5;
}

static void Init_Pins(void)
{
    EALLOW;
    GpioCtrlRegs.GPAPUD.bit.GPIO20 = 0;
    GpioCtrlRegs.GPAPUD.bit.GPIO21 = 0;
    GpioCtrlRegs.GPAQSEL2.bit.GPIO20 = 0;
    GpioCtrlRegs.GPAQSEL2.bit.GPIO21 = 0;
    GpioCtrlRegs.GPAGMUX2.bit.GPIO20 = 0;
    GpioCtrlRegs.GPAGMUX2.bit.GPIO21 = 0;
    GpioCtrlRegs.GPAMUX2.bit.GPIO20 = 1;
    GpioCtrlRegs.GPAMUX2.bit.GPIO21 = 1;
    EDIS;
}

static void Init_Eqep(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1;
    EDIS;
    EQep1Regs.QDECCTL.all = 0;                  /* quadrature */
    EQep1Regs.QEPCTL.bit.FREE_SOFT = 2;
    EQep1Regs.QEPCTL.bit.PCRM = 1;              /* from QPOSMAX to 0 */
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QPOSCNT = 0;
    EQep1Regs.QUPRD = UNIT_CYCLES;
    EQep1Regs.QEPCTL.bit.QCLM = 1;              /* latch with the unit timer */
    EQep1Regs.QEINT.bit.UTO = 1;
    EQep1Regs.QCLR.all = 0x0FFF;
    EQep1Regs.QEPCTL.bit.UTE = 1;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
}

static void Follow(void)
{
    Uint16 seen = 0, now, quiet = 0;
    Uint32 before = 0, latched;
    int32 step;
    for (;;) {
        do {
            now = Windows;
        } while (now == seen);
        seen = now;
        latched = Latched;
        step = (int32)(latched - before);
        before = latched;
        Wheel.counts += step;
        Wheel.mm = (int32)((int64)Wheel.counts * UM_PER_TURN / COUNTS_PER_TURN / 1000);
        Wheel.um_per_s = (int32)((int64)step * 100 * UM_PER_TURN / COUNTS_PER_TURN);
        quiet = step != 0 ? 0 : quiet < STILL_AFTER ? quiet + 1 : STILL_AFTER;
        Wheel.still = quiet == STILL_AFTER;
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
    PieVectTable.EQEP1_INT = &Unit;
    EDIS;
    Init_Pins();
    Init_Eqep();
    PieCtrlRegs.PIEIER5.bit.INTx1 = 1;
    IER |= M_INT5;
    EINT;
    Follow();
}
