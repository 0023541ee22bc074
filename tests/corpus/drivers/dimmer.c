/* dimmer.c: a lamp on ePWM4 whose brightness a wall switch orders over CAN-A; without an order for 60 ms it is dark. A
   PC sets the gain by lines over SCI-B. A photodiode is reported over the CAN each 20 ms. */
#include "F28x_Project.h"

#define PERIOD      10000u          /* 100 us */
#define LOST_MS     60u
#define REPORT_MS   20u
#define LINE        12u
#define ORDER       1u              /* message objects */
#define REPORT      2u
#define MOVE_ALL    0x00F00000uL    /* to the object: mask, identifier, control */
#define SEND        0x00870000uL    /* to the object: bytes; request */
#define FETCH       0x000F0000uL    /* from the object: bytes; clear NewDat and IntPnd */

static volatile Uint16 Milliseconds = 0;
static volatile Uint16 Brightness = 0;
static volatile Uint16 Ordered_At = 0;
static volatile Uint16 Damaged = 0;
static char Line[LINE] = {0};
static volatile Uint16 Length = 0;
static volatile Uint16 Line_Ready = 0;
static Uint16 Gain = 10;

__interrupt void Tick(void)
{
    Milliseconds++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

__interrupt void Ordered(void)
{
    Uint16 value, inverse, patience = 200;
    if (CanaRegs.CAN_INT.bit.INT0ID == ORDER) {
        CanaRegs.CAN_IF2CMD.all = FETCH | ORDER;
        while (CanaRegs.CAN_IF2CMD.bit.Busy && patience > 0)
            patience--;
        value = CanaRegs.CAN_IF2DATA.bit.Data_0;
        inverse = CanaRegs.CAN_IF2DATA.bit.Data_1;
        if (value + inverse == 0xFF) {
            Brightness = value;
            Ordered_At = Milliseconds;
        } else {
            Damaged++;
        }
    }
    CanaRegs.CAN_GLB_INT_CLR.bit.INT0_FLG_CLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

__interrupt void Letters(void)
{
    Uint16 c;
    if (ScibRegs.SCIRXST.bit.RXERROR) {
        ScibRegs.SCICTL1.bit.SWRESET = 0;       /* a break stops the receiver until then */
        ScibRegs.SCICTL1.bit.SWRESET = 1;
        if (!Line_Ready)
            Length = 0;
    }
    while (ScibRegs.SCIFFRX.bit.RXFFST > 0) {
        c = ScibRegs.SCIRXBUF.bit.SAR;
        if (Line_Ready)
            continue;               /* main still reads the line before */
        if (c == '\n') {
            Line[Length] = 0;
            Line_Ready = 1;
        } else if (Length < LINE - 1) {
            Line[Length] = c;
            Length++;
        }
    }
    ScibRegs.SCIFFRX.bit.RXFFOVRCLR = 1;
    ScibRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

static void Init_Lamp(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM4 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    GPIO_SetupPinMux(6, GPIO_MUX_CPU1, 1);
    EPwm4Regs.TBPRD = PERIOD - 1;
    EPwm4Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm4Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm4Regs.CMPA.bit.CMPA = 0;
    EPwm4Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm4Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm4Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static void Init_Light(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcbRegs.ADCSOC2CTL.bit.CHSEL = 4;
    AdcbRegs.ADCSOC2CTL.bit.ACQPS = 19;
    AdcbRegs.ADCINTSEL1N2.bit.INT2SEL = 2;
    AdcbRegs.ADCINTSEL1N2.bit.INT2E = 1;
    EDIS;
}

static void Init_Line(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_B = 1;
    EDIS;
    GPIO_SetupPinMux(19, GPIO_MUX_CPU1, 2);
    GPIO_SetupPinOptions(19, GPIO_INPUT, GPIO_ASYNC);
    ScibRegs.SCICCR.all = 0x0007;
    ScibRegs.SCIHBAUD.all = 0;
    ScibRegs.SCILBAUD.all = 53;
    ScibRegs.SCIFFTX.all = 0xE040;
    ScibRegs.SCIFFRX.all = 0x2061;
    ScibRegs.SCIFFCT.all = 0;
    ScibRegs.SCICTL1.all = 0x0061;
}

static void Wait_IF1(void)
{
    Uint16 patience = 200;
    while (CanaRegs.CAN_IF1CMD.bit.Busy && patience > 0)
        patience--;
}

static void Init_Can(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    EDIS;
    GPIO_SetupPinMux(36, GPIO_MUX_CPU1, 6);     /* CANRXA */
    GPIO_SetupPinMux(37, GPIO_MUX_CPU1, 6);     /* CANTXA */
    CanaRegs.CAN_CTL.bit.Init = 1;
    CanaRegs.CAN_CTL.bit.CCE = 1;
    CanaRegs.CAN_BTR.all = 39uL | (13uL << 8) | (4uL << 12);    /* 20 quanta of 0.2 us */
    CanaRegs.CAN_CTL.bit.CCE = 0;
    CanaRegs.CAN_IF1MSK.all = 0x1FFC0000uL;
    CanaRegs.CAN_IF1ARB.all = 0x80000000uL | (0x210uL << 18);
    CanaRegs.CAN_IF1MCTL.all = 0x1482uL;        /* mask, interrupt, two bytes */
    CanaRegs.CAN_IF1CMD.all = MOVE_ALL | ORDER;
    Wait_IF1();
    CanaRegs.CAN_IF1MSK.all = 0;
    CanaRegs.CAN_IF1ARB.all = 0xA0000000uL | (0x310uL << 18);
    CanaRegs.CAN_IF1MCTL.all = 0x0088uL;        /* eight bytes */
    CanaRegs.CAN_IF1CMD.all = MOVE_ALL | REPORT;
    Wait_IF1();
    CanaRegs.CAN_CTL.bit.IE0 = 1;
    CanaRegs.CAN_GLB_INT_EN.bit.GLBINT0_EN = 1;
    CanaRegs.CAN_CTL.bit.Init = 0;
}

static Uint16 Light(void)
{
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT2 = 1;
    AdcbRegs.ADCSOCFRC1.bit.SOC2 = 1;
    while (AdcbRegs.ADCINTFLG.bit.ADCINT2 == 0)
        ;
    return AdcbResultRegs.ADCRESULT2;
}

static void Report(Uint16 light, Uint16 gain)
{
    static Uint16 number = 0;
    Wait_IF1();
    CanaRegs.CAN_IF1DATA.all = (Uint32)light << 16 | number;
    CanaRegs.CAN_IF1DATB.all = (Uint32)number << 16 | gain;
    CanaRegs.CAN_IF1CMD.all = SEND | REPORT;
    number++;
}

static void Obey(const char *line)
{
    if (line[0] == 'o')
        Gain = 0;
    else if (line[0] == 'g' && line[4] == ' ' && line[5] >= '0' && line[5] <= '9')
        Gain = line[5] - '0' + 5;
}

static void Shine(Uint16 brightness, Uint16 gain)
{
    Uint32 width = (Uint32)brightness * gain * 3;
    if (width > PERIOD)
        width = PERIOD;
    EPwm4Regs.CMPA.bit.CMPA = width;
}

void main(void)
{
    Uint16 reported = 0, brightness, age;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.CANA0_INT = &Ordered;
    PieVectTable.SCIB_RX_INT = &Letters;
    EDIS;
    Init_Lamp();
    Init_Light();
    Init_Line();
    Init_Can();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    StartCpuTimer0();
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx3 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx5 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    while (1) {
        DINT;
        brightness = Brightness;
        age = Milliseconds - Ordered_At;
        EINT;
        if (age > LOST_MS)
            brightness = 0;
        Shine(brightness, Gain);
        if (Line_Ready) {
            Obey(Line);
            Length = 0;
            Line_Ready = 0;
        }
        if ((Uint16)(Milliseconds - reported) >= REPORT_MS) {
            reported += REPORT_MS;
            Report(Light(), Gain);
        }
        DELAY_US(200);
    }
}
