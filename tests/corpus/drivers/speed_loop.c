/*
 * speed_loop.c: a speed loop for a DC motor.  An encoder at eQEP1, a bridge at ePWM1 (A forward, B backward), the
 * current at ADCINA2, speeds as two octets at SCI-B (lower one first), a lamp that blinks by timer 1.
 */
#include "F28x_Project.h"

#define PERIOD          5000        /* 20 kHz */
#define DUTY_LIMIT      4500
#define LINES           250
#define COUNTS_PER_REV  (4 * LINES)
#define CURRENT_LIMIT   1200        /* counts about the offset */
#define SPEED_LIMIT     3600
#define ORDER_MS        80U
#define HALF_ORDER_MS   5
#define CLOCK           200000000UL
#define BLINK_SLOW      20U
#define BLINK_FAST      64U
#define BLINK_STEP      8U
#define LAMP            31
#define CAL_SAMPLES     64
#define KP_Q8           180
#define KI_Q8           12
#define INTEGRAL_LIMIT  (DUTY_LIMIT * 256L)

typedef enum { MOTOR_OFF, MOTOR_CALIBRATE, MOTOR_RUN, MOTOR_FAULT } MotorState;

static volatile MotorState state = MOTOR_OFF;
static volatile uint32_t millis = 0;
static volatile int32_t speedRpm = 0;
static volatile int32_t targetRpm = 0;
static int32_t integral = 0;
static uint32_t lastCount = 0;
static int32_t offsetSum = 0;
static uint16_t offsetCount = 0;
static int16_t currentOffset = 2048;
static volatile int16_t current = 0;
static volatile uint16_t overCount = 0;
static volatile uint16_t refused = 0;
static uint16_t halfMs = 0;
static volatile uint32_t orderedAt = 0;
static volatile uint16_t blink = BLINK_SLOW;
static volatile uint16_t lampOn = 0;

interrupt void adcIsr(void);
interrupt void timerIsr(void);
interrupt void receivedIsr(void);
interrupt void blinkIsr(void);

static void initPwm(void)
{
    EALLOW;
    GpioCtrlRegs.GPAMUX1.bit.GPIO0 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO1 = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm1Regs.TBPRD = PERIOD - 1;
    EPwm1Regs.TBCTR = 0;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm1Regs.TBCTL.bit.CLKDIV = 0;
    EPwm1Regs.TBCTL.bit.CTRMODE = 0;
    EPwm1Regs.CMPCTL.bit.SHDWAMODE = 0;
    EPwm1Regs.CMPCTL.bit.LOADAMODE = 0;
    EPwm1Regs.CMPCTL.bit.SHDWBMODE = 0;
    EPwm1Regs.CMPCTL.bit.LOADBMODE = 0;
    EPwm1Regs.CMPA.bit.CMPA = 0;
    EPwm1Regs.CMPB.bit.CMPB = 0;
    EPwm1Regs.AQCTLA.bit.ZRO = 2;
    EPwm1Regs.AQCTLA.bit.CAU = 1;
    EPwm1Regs.AQCTLB.bit.ZRO = 2;
    EPwm1Regs.AQCTLB.bit.CBU = 1;
    EPwm1Regs.ETSEL.bit.SOCASEL = 2;
    EPwm1Regs.ETPS.bit.SOCAPRD = 1;
    EPwm1Regs.ETSEL.bit.SOCAEN = 1;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static void initAdc(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    EDIS;
    DELAY_US(1000);
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    EDIS;
}

static void initEncoder(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1;
    GpioCtrlRegs.GPAGMUX2.bit.GPIO20 = 0;
    GpioCtrlRegs.GPAMUX2.bit.GPIO20 = 1;
    GpioCtrlRegs.GPAGMUX2.bit.GPIO21 = 0;
    GpioCtrlRegs.GPAMUX2.bit.GPIO21 = 1;
    EDIS;
    EQep1Regs.QDECCTL.bit.QSRC = 0;
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QEPCTL.bit.PCRM = 1;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
}

static void initSci(void)
{
    GPIO_SetupPinMux(18, GPIO_MUX_CPU1, 2);
    GPIO_SetupPinOptions(18, GPIO_OUTPUT, GPIO_PUSHPULL);
    GPIO_SetupPinMux(19, GPIO_MUX_CPU1, 2);
    GPIO_SetupPinOptions(19, GPIO_INPUT, GPIO_ASYNC);
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_B = 1;
    EDIS;
    ScibRegs.SCICCR.all = 0x0007;
    ScibRegs.SCIHBAUD.all = 0;
    ScibRegs.SCILBAUD.all = 162;        /* 50 MHz / 8 / 163 = 38344 */
    ScibRegs.SCIFFTX.all = 0xE000;
    ScibRegs.SCIFFRX.all = 0x0022;      /* an interrupt for two octets */
    ScibRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    ScibRegs.SCIFFRX.bit.RXFIFORESET = 1;
    ScibRegs.SCICTL1.all = 0x0023;
}

static int16_t limitDuty(int32_t duty)
{
    if (duty > DUTY_LIMIT)
        return DUTY_LIMIT;
    if (duty < -DUTY_LIMIT)
        return -DUTY_LIMIT;
    return (int16_t)duty;
}

static void drive(int16_t duty)
{
    if (duty >= 0)
    {
        EPwm1Regs.CMPB.bit.CMPB = 0;
        EPwm1Regs.CMPA.bit.CMPA = (uint16_t)duty;
    }
    else
    {
        EPwm1Regs.CMPA.bit.CMPA = 0;
        EPwm1Regs.CMPB.bit.CMPB = (uint16_t)-duty;
    }
}

static void calibrate(int16_t raw)
{
    offsetSum += raw;
    offsetCount++;
    if (offsetCount >= CAL_SAMPLES)
    {
        currentOffset = (int16_t)(offsetSum / CAL_SAMPLES);
        state = MOTOR_RUN;
    }
}

interrupt void adcIsr(void)
{
    int16_t raw = (int16_t)AdcaResultRegs.ADCRESULT0;

    if (state == MOTOR_CALIBRATE)
    {
        calibrate(raw);
    }
    else
    {
        current = raw - currentOffset;
        if (current > CURRENT_LIMIT || current < -CURRENT_LIMIT)
        {
            if (++overCount > 20)
                state = MOTOR_FAULT;
        }
        else
        {
            overCount = 0;
        }
    }
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

interrupt void timerIsr(void)
{
    uint32_t count = EQep1Regs.QPOSCNT;
    int32_t delta = (int32_t)(count - lastCount);
    int32_t error;

    lastCount = count;
    millis++;
    if (millis - orderedAt > ORDER_MS)
        targetRpm = 0;
    if (ScibRegs.SCIFFRX.bit.RXFFST == 1)
    {
        if (++halfMs >= HALF_ORDER_MS)
        {
            ScibRegs.SCIFFRX.bit.RXFIFORESET = 0;
            ScibRegs.SCIFFRX.bit.RXFIFORESET = 1;
        }
    }
    else
    {
        halfMs = 0;
    }
    speedRpm += (delta * (60000L / COUNTS_PER_REV) - speedRpm) / 4;
    switch (state)
    {
    case MOTOR_OFF:
        drive(0);
        if (millis > 10)
            state = MOTOR_CALIBRATE;
        break;
    case MOTOR_CALIBRATE:
        drive(0);
        break;
    case MOTOR_RUN:
        error = targetRpm - speedRpm;
        integral += error * KI_Q8;
        if (integral > INTEGRAL_LIMIT)
            integral = INTEGRAL_LIMIT;
        if (integral < -INTEGRAL_LIMIT)
            integral = -INTEGRAL_LIMIT;
        drive(limitDuty((error * KP_Q8 + integral) / 256));
        break;
    case MOTOR_FAULT:
        integral = 0;
        drive(0);
        break;
    }
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

interrupt void receivedIsr(void)
{
    uint16_t low = ScibRegs.SCIRXBUF.bit.SAR;
    uint16_t high = ScibRegs.SCIRXBUF.bit.SAR;
    int16_t rpm = (int16_t)(low | high << 8);

    if (rpm >= -SPEED_LIMIT && rpm <= SPEED_LIMIT)
    {
        targetRpm = rpm;
        orderedAt = millis;
    }
    else
    {
        refused++;
    }
    ScibRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

/* Fast while the motor turns; the rate moves by a step at each edge */
interrupt void blinkIsr(void)
{
    uint32_t counts;

    lampOn = !lampOn;
    if (lampOn)
        GpioDataRegs.GPASET.bit.GPIO31 = 1;
    else
        GpioDataRegs.GPACLEAR.bit.GPIO31 = 1;
    if (targetRpm != 0 && blink < BLINK_FAST)
        blink += BLINK_STEP;
    else if (targetRpm == 0 && blink > BLINK_SLOW)
        blink -= BLINK_STEP;
    counts = CLOCK / blink;
    CpuTimer1Regs.PRD.all = counts - 1UL;
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
    PieVectTable.ADCA1_INT = &adcIsr;
    PieVectTable.TIMER0_INT = &timerIsr;
    PieVectTable.TIMER1_INT = &blinkIsr;
    PieVectTable.SCIB_RX_INT = &receivedIsr;
    EDIS;
    initPwm();
    initAdc();
    initEncoder();
    initSci();
    GPIO_SetupPinMux(LAMP, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(LAMP, GPIO_OUTPUT, GPIO_PUSHPULL);
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    ConfigCpuTimer(&CpuTimer1, 200, 50000);
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx3 = 1;
    IER |= M_INT1 | M_INT9 | M_INT13;
    CpuTimer0Regs.TCR.all = 0x4000;
    CpuTimer1Regs.TCR.all = 0x4000;
    EINT;
    for (;;)
        ;
}
