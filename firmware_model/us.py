"""us.c: device driver of the three ultrasound sensors on ADC-A.

Channel 0 (SOC0, ADCINA2) is the left sensor, 1 (SOC1, ADCINA3) the front one, 2 (SOC2, ADCINA4) the right one.
GPIO69 starts the ring of sensors with one pulse.  Sources: TFG section 3.1.1, annex 1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import memcpy
from emulator.device_h import (
    ADC_ADCA,
    ADC_RESOLUTION_12BIT,
    ADC_SIGNALMODE_SINGLE,
    EALLOW,
    EDIS,
    AdcaRegs,
    AdcaResultRegs,
    AdcSetMode,
    CpuSysRegs,
    DelayUs,
    GpioCtrlRegs,
    GpioDataRegs,
)


class US_SENSOR(enum):
    LEFT = 0
    FRONT = 1
    RIGHT = 2


R_Calib_m: float32 = 1.0
R_Calib_b: float32 = 0.0
F_Calib_m: float32 = 1.0
F_Calib_b: float32 = 0.0
L_Calib_m: float32 = 1.0
L_Calib_b: float32 = 0.0


# us.c: Init_US
def Init_US() -> void:

    EALLOW()

    CpuSysRegs.PCLKCR13.bit.ADC_A = 1

    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE)
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1

    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1

    DelayUs(1000)

    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19

    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 3
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 19

    AdcaRegs.ADCSOC2CTL.bit.CHSEL = 4
    AdcaRegs.ADCSOC2CTL.bit.ACQPS = 19

    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 1
    GpioDataRegs.GPCDAT.bit.GPIO69 = 0
    DelayUs(1000)

    EDIS()

    GpioDataRegs.GPCDAT.bit.GPIO69 = 1
    DelayUs(25)
    GpioDataRegs.GPCDAT.bit.GPIO69 = 0
    DelayUs(10)

    EALLOW()
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 0
    EDIS()


# us.c: Calibrate_US
def Calibrate_US(USS: US_SENSOR, slope: float32, bias: float32) -> void:
    match USS:
        case US_SENSOR.LEFT:
            L_Calib_m = slope
            L_Calib_b = bias
        case US_SENSOR.FRONT:
            F_Calib_m = slope
            F_Calib_b = bias
        case US_SENSOR.RIGHT:
            R_Calib_m = slope
            R_Calib_b = bias


# us.c: Read_Channel
def Read_Channel(CH: char) -> uint16:

    EALLOW()
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = CH
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    EDIS()

    AdcaRegs.ADCSOCFRC1.all = 0x0001 << CH

    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:  # as in C: no time-out
        pass
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1

    if CH == 0:
        return AdcaResultRegs.ADCRESULT0
    if CH == 1:
        return AdcaResultRegs.ADCRESULT1
    if CH == 2:
        return AdcaResultRegs.ADCRESULT2

    return 0


# us.c: Read_Distance
def Read_Distance(USS: US_SENSOR) -> float32:
    distance: float32 = 0.0
    i: uchar
    j: uchar
    k: uchar
    v: array[float32, 12]
    result: float32  # as in C: the three accumulators are never initialised
    vR: array[float32, 12]
    resultR: float32
    vF: array[float32, 12]
    resultF: float32

    match USS:
        case US_SENSOR.LEFT:

            for i in range(12):
                v[i] = Read_Channel(0)

                if v[i - 1] > v[i] + 5 and v[i] > 350:  # as in C: at i = 0 the index is 65535
                    v[i - 1] = v[i]  # as in C: what is corrected here has been added already

                result += v[i]
            distance = result / 2.3  # as in C: 12 samples are summed, a mean of counts is never made
            distance = L_Calib_m * distance + L_Calib_b
        case US_SENSOR.FRONT:

            for k in range(12):
                vF[k] = Read_Channel(1)
                if vF[k - 1] > vF[k] + 5 and vF[k] > 350:
                    vF[k - 1] = vF[k]

                resultF += vF[k]
            distance = resultF / 2.3
            distance = F_Calib_m * distance + F_Calib_b
        case US_SENSOR.RIGHT:

            for j in range(12):
                vR[j] = Read_Channel(2)
                if vR[j - 1] > vR[j] + 5 and vR[j] > 350:
                    vR[j - 1] = vR[j]
                resultR += vR[j]
            distance = resultR / 2.3
            distance = R_Calib_m * distance + R_Calib_b
    return distance


# us.c: median
def median(v: ptr[float32], n: uchar) -> float32:
    aux: array[float32, 20]
    i: uchar
    j: uchar
    temp: float32

    # as in C: memcpy counts words of 16 bits, so 2n floats are copied; us.c includes no prototype of it
    memcpy(aux, v, 4 * n)
    for i in range(1, n):
        for j in range(n - i):
            if aux[j] > aux[j + 1]:
                temp = aux[j + 1]
                aux[j + 1] = aux[j]
                aux[j] = temp
    if n % 2:
        return aux[n / 2]
    else:
        return (aux[n / 2] + aux[n / 2 + 1]) / 2.0  # as in C: the pair of an even n starts one too high


# us.c: average
def average(v: ptr[float32], n: uchar) -> float32:
    result: float32  # as in C: never initialised
    i: uchar

    for i in range(n):
        result += v[i]

    return result / n
