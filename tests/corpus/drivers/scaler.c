/* scaler.c: 16 samples a millisecond become a mean, a voltage, a filtered value and a DAC code; stamps and time-outs of a
   16-bit millisecond counter. */
#include "F28x_Project.h"
#include <math.h>
#include <stdlib.h>

#define SAMPLES     16u
#define FULL_MV     3000u
#define TIMEOUT_MS  50u
#define Q           15
#define LIMIT_V     2.5f

static const int16 Table[SAMPLES] = {
    4000, 3990, 4010, 4005, 3995, 4000, 4020, 3980, 4000, 4000, 4011, 3989, 4003, 3997, 4001, 3999
};

static volatile Uint16 Millis = 65500u;
static Uint32 Runtime_ms = 0;
static int16 Mean = 0;
static Uint16 Mean_mv = 0;
static int16 Filtered = 0;
static int32 Energy = 0;
static Uint32 Stamp = 0;
static Uint16 Timeouts = 0;
static int16 Celsius = 0;
static float32 Deviation_v = 0.0f;
static Uint16 Percent = 0;
static Uint16 Far = 0;
static Uint16 Ramp = 0;
static int32 Way_um = 0;

__interrupt void Millisecond(void)
{
    Millis++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Dac(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR16.bit.DAC_A = 1;
    DacaRegs.DACCTL.bit.DACREFSEL = 1;
    DacaRegs.DACOUTEN.bit.DACOUTEN = 1;
    EDIS;
    DELAY_US(10);
}

/* 0 to 4095. */
static void Set_Dac(Uint16 code)
{
    if (code > 4095u)
        code = 4095u;
    DacaRegs.DACVALS.all = code;
}

static int16 Average(void)
{
    int32 sum = 0;
    Uint16 i;
    for (i = 0; i < SAMPLES; i++)
        sum += Table[i];
    return (int16)(sum / SAMPLES);
}

static Uint16 To_Millivolts(int16 code)
{
    return (Uint16)((Uint32)code * FULL_MV / 4096u);
}

/* A first-order low pass with a gain in Q15. */
static int16 Low_Pass(int16 before, int16 now, int16 gain)
{
    return before + (int16)((int32)gain * (now - before) >> Q);
}

static Uint16 Expired(Uint16 since)
{
    return (Uint16)(Millis - since) >= TIMEOUT_MS;
}

/* One byte of a sensor, two's complement. */
static int16 Signed_Byte(Uint16 byte)
{
    return byte >= 128u ? (int16)byte - 256 : (int16)byte;
}

static Uint16 Share(Uint16 part, Uint16 whole)
{
    return (Uint16)((Uint32)part * 100u / whole);
}

static Uint16 Is_Far(Uint16 target, Uint16 actual)
{
    return abs((int16)target - (int16)actual) > 100;
}

static Uint32 Joined(Uint16 high, Uint16 low)
{
    return (Uint32)high << 16 | low;
}

static int32 Power(int16 millivolts, int16 milliamps)
{
    return (int32)millivolts * milliamps;
}

static void Work(void)
{
    Uint16 since = Millis, last = Millis, now;
    for (;;) {
        now = Millis;
        if (now == last)
            continue;
        Runtime_ms += (Uint16)(now - last);
        last = now;
        Mean = Average();
        Mean_mv = To_Millivolts(Mean);
        Filtered = Low_Pass(Filtered, Mean, 16384);
        Energy = Power((int16)Mean_mv, 1200);
        Stamp = Joined(3u, now);
        Celsius = Signed_Byte(0xF6u);
        Deviation_v = fabs(LIMIT_V - Mean_mv / 1000.0f);
        Percent = Share(Mean_mv, FULL_MV);
        Far = Is_Far(Mean_mv, 3000u);
        Way_um += Mean_mv * 10l;
        Ramp = Ramp < 4000u ? Ramp + 50u : 0u;
        Set_Dac(Ramp);
        if (Expired(since)) {
            Timeouts++;
            since = now;
        }
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
    EDIS;
    Init_Dac();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    Work();
}
