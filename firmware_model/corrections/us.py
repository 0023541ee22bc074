"""us.c with its defects corrected, each where its id stands."""

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
from emulator.sysbios.headers import Task_sleep
from firmware_model.us import US_SENSOR, F_Calib_b, F_Calib_m, L_Calib_b, L_Calib_m, R_Calib_b, R_Calib_m

# A conversion takes 44 cycles; a thousand passes of the loop are more than a hundred of them.
MOST_POLLS = 1000
NO_READING = 0xFFFF  # a code has 12 bits
NO_DISTANCE: const[float32] = -1.0
DEAD_SUM: const[float32] = 138.0  # half of 6 inches: Vcc / 512 an inch, twelve conversions, divided by 2.3
CEILING_SUM: const[float32] = 12000.0  # the sensor's ceiling is 255 inches, 11710, and its noise
SONAR_POWER_UP_MS = 300
WINDOW_COUNTS = 5
MEDIAN_MOST = 20
CONVERSIONS = 13 if FIXED("US-samples-12") else 12


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

    if FIXED("US-start-before-ready"):
        Task_sleep(SONAR_POWER_UP_MS)
    GpioDataRegs.GPCDAT.bit.GPIO69 = 1
    DelayUs(25)
    GpioDataRegs.GPCDAT.bit.GPIO69 = 0
    DelayUs(10)

    EALLOW()
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 0
    EDIS()


# us.c: Read_Channel
def Read_Channel(CH: char) -> uint16:

    if FIXED("US-poll-forever"):
        polls: uint16 = 0
    if FIXED("US-channel-unchecked"):
        if CH < 0 or CH > 2:
            return 0
    EALLOW()
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = CH
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    EDIS()

    AdcaRegs.ADCSOCFRC1.all = 0x0001 << CH

    if FIXED("US-poll-forever"):
        while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
            polls += 1
            if polls == MOST_POLLS:
                return NO_READING
    else:
        while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
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
    if FIXED("US-poll-forever") or FIXED("US-dead-sonar") or FIXED("US-implausible") or FIXED("US-accumulator") or FIXED("US-index-before-start") or FIXED("US-correction-after-sum") or FIXED("US-window-one-sided") or FIXED("US-window-far-only") or FIXED("US-median-unused") or FIXED("US-average-unused") or FIXED("US-samples-12"):  # noqa: E501
        sum: float32 = 0.0
        match USS:
            case US_SENSOR.LEFT:
                sum = Measure(0)
                distance = L_Calib_m * sum + L_Calib_b
            case US_SENSOR.FRONT:
                sum = Measure(1)
                distance = F_Calib_m * sum + F_Calib_b
            case US_SENSOR.RIGHT:
                sum = Measure(2)
                distance = R_Calib_m * sum + R_Calib_b
        if FIXED("US-poll-forever") or FIXED("US-dead-sonar"):
            if sum < (DEAD_SUM if FIXED("US-dead-sonar") else 0):
                return NO_DISTANCE
        if FIXED("US-implausible"):
            if sum > CEILING_SUM:
                return NO_DISTANCE
        return distance
    else:
        i: uchar
        j: uchar
        k: uchar
        v: array[float32, 12]
        result: float32
        vR: array[float32, 12]
        resultR: float32
        vF: array[float32, 12]
        resultF: float32

        match USS:
            case US_SENSOR.LEFT:

                for i in range(12):
                    v[i] = Read_Channel(0)

                    if v[i - 1] > v[i] + 5 and v[i] > 350:
                        v[i - 1] = v[i]

                    result += v[i]
                distance = result / 2.3
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


# us.c: Read_Distance
def Measure(CH: char) -> float32:
    i: uchar
    if FIXED("US-poll-forever"):
        code: uint16
    v: array[float32, CONVERSIONS]
    if not FIXED("US-average-unused"):
        result: float32
    if FIXED("US-median-unused"):
        middle: float32

    if FIXED("US-accumulator") and not FIXED("US-average-unused"):
        result = 0.0

    for i in range(CONVERSIONS):
        if FIXED("US-poll-forever"):
            code = Read_Channel(CH)
            if code == NO_READING:
                return NO_DISTANCE
            v[i] = code
        else:
            v[i] = Read_Channel(CH)
        if not FIXED("US-median-unused"):
            if not FIXED("US-index-before-start") or i > 0:
                if v[i - 1] > v[i] + WINDOW_COUNTS and (FIXED("US-window-far-only") or v[i] > 350):
                    v[i - 1] = v[i]
                elif FIXED("US-window-one-sided") and (FIXED("US-index-before-start") or i > 0) and (
                    v[i - 1] < v[i] - WINDOW_COUNTS and (FIXED("US-window-far-only") or v[i] > 350)
                ):
                    v[i] = v[i - 1]
            if not FIXED("US-correction-after-sum") and not FIXED("US-average-unused"):
                result += v[i]
    if FIXED("US-median-unused"):
        # The window lies around the median: around the sample before, one wrong sample is the measure of the next.
        middle = median(v, CONVERSIONS)
        for i in range(CONVERSIONS):
            if FIXED("US-window-far-only") or middle > 350:
                if v[i] > middle + WINDOW_COUNTS:
                    v[i] = middle
                elif FIXED("US-window-one-sided") and v[i] < middle - WINDOW_COUNTS:
                    v[i] = middle
    if FIXED("US-average-unused"):
        return average(v, CONVERSIONS) * 12.0 / 2.3  # the calibration is that of 12 samples
    else:
        if FIXED("US-median-unused") or FIXED("US-correction-after-sum"):
            for i in range(CONVERSIONS):
                result += v[i]
        return result * 12.0 / CONVERSIONS / 2.3 if FIXED("US-samples-12") else result / 2.3


# us.c: median
def median(v: ptr[float32], n: uchar) -> float32:
    aux: array[float32, 20]
    i: uchar
    j: uchar
    temp: float32

    if FIXED("US-median-empty"):
        if n == 0:
            return 0.0
    if FIXED("US-median-many"):
        if n > MEDIAN_MOST:
            n = MEDIAN_MOST
    if FIXED("US-median-octets"):
        memcpy(aux, v, n * sizeof(float32))
    else:
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
        return (aux[n / 2 - 1] + aux[n / 2]) / 2.0 if FIXED("US-median-even") else (aux[n / 2] + aux[n / 2 + 1]) / 2.0


# us.c: average
def average(v: ptr[float32], n: uchar) -> float32:
    result: float32
    i: uchar

    if FIXED("US-average-accumulator"):
        result = 0.0
    if FIXED("US-average-empty"):
        if n == 0:
            return 0.0
    for i in range(n):
        result += v[i]

    return result / n
