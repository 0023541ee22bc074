"""GYRO.c with its defects corrected, each where its id stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.c28x.language import *
from emulator.device_h import DelayUs
from emulator.sysbios.headers import Task_sleep
from firmware_model.board_support.spi import HIGH, Init_SPIA, Set_CS
from firmware_model.gyro import (
    CTRL_REG1,
    CTRL_REG4,
    CTRL_REG5,
    FIFO_CTRL_REG,
    GYRO_SENSOR,
    OUT_TEMP,
    OUT_X_L,
    OUT_Y_L,
    OUT_Z_L,
    REG1_PD,
    REG1_XEN,
    REG1_YEN,
    REG1_ZEN,
    REG4_BDU,
    REG5_FIFO_EN,
    X_Calib_b,
    Y_Calib_b,
    Z_Calib_b,
    Z_dc_offset,
    aux,
    i,
    temp,
)

if TYPE_CHECKING:
    from firmware_model.gyro import buff

# Data sheet of the L3G4200D, table 4: 8.75 mdps a digit at 250 dps.
DEG_S_PER_DIGIT: const[float32] = 0.00875
RAD_PER_DEG: const[float32] = 0.01745329
# Below this a turn is taken for noise.
QUIET_RAD_S: const[float32] = 0.0 if FIXED("GYRO-dead-band") else 0.01
TURN_ON_MS = 300
SAMPLE_MS = 10
ATTEMPTS = 3
INT_MAX = 32767
INT_MIN = -32767

sum_Z: int32 = 0
SPREAD_MOST = 400  # digits, 3.5 deg/s: the noise is 0.2 deg/s, and an offset may be 10
Rested: uint16 = 0  # the robot stood while the offset was measured last

if FIXED("GYRO-global-names"):
    del i
    del temp
if FIXED("GYRO-sum16"):
    del aux


# GYRO.c: Init_GYRO
def Init_GYRO() -> void:
    n: int16

    Init_SPIA()
    Set_CS(HIGH)

    if FIXED("GYRO-write-unchecked"):
        Write_Checked(CTRL_REG4, REG4_BDU)
        Write_Checked(CTRL_REG5, 0x00 if FIXED("GYRO-fifo-bypassed") else REG5_FIFO_EN)
        Write_Checked(FIFO_CTRL_REG, 0x00)
        if FIXED("GYRO-xy-off"):
            Write_Checked(CTRL_REG1, REG1_PD | REG1_ZEN | REG1_YEN | REG1_XEN)
        else:
            Write_Checked(CTRL_REG1, REG1_PD | REG1_ZEN)
    else:
        writeReg(CTRL_REG4, REG4_BDU)
        writeReg(CTRL_REG5, 0x00 if FIXED("GYRO-fifo-bypassed") else REG5_FIFO_EN)
        writeReg(FIFO_CTRL_REG, 0x00)
        writeReg(CTRL_REG1, REG1_PD | REG1_ZEN | REG1_YEN | REG1_XEN if FIXED("GYRO-xy-off") else REG1_PD | REG1_ZEN)

    if FIXED("GYRO-turn-on"):
        Task_sleep(TURN_ON_MS)
    if FIXED("GYRO-sum16"):
        sum_Z = 0
    for n in range(100):

        if FIXED("GYRO-global-names"):
            buff[n] = getZ()
            if FIXED("GYRO-sum16"):
                sum_Z += buff[n]
            else:
                aux += buff[n]
        else:
            buff[i] = getZ()
            if FIXED("GYRO-sum16"):
                sum_Z += buff[i]
            else:
                aux += buff[i]
            i = (i + 1) % 100
        if FIXED("GYRO-starves-at-start"):
            Task_sleep(20)
        else:
            DelayUs(20000)
    if FIXED("GYRO-sum16"):
        Z_dc_offset = sum_Z / 100
    else:
        Z_dc_offset = aux / 100

    return


# GYRO.c: writeReg
def Write_Checked(reg: uchar, value: uchar) -> void:
    n: uchar

    for n in range(ATTEMPTS):
        if writeReg(reg, value):
            return


# GYRO.c: Init_GYRO
def Set_Up_Again() -> void:
    writeReg(CTRL_REG4, REG4_BDU)
    writeReg(CTRL_REG5, 0x00 if FIXED("GYRO-fifo-bypassed") else REG5_FIFO_EN)
    writeReg(FIFO_CTRL_REG, 0x00)
    if FIXED("GYRO-xy-off"):
        writeReg(CTRL_REG1, REG1_PD | REG1_ZEN | REG1_YEN | REG1_XEN)
    else:
        writeReg(CTRL_REG1, REG1_PD | REG1_ZEN)


# GYRO.c: readReg
def Gyro_Answers() -> char:
    value: uchar = 0

    readReg(CTRL_REG1, addressof(value), 1)
    if FIXED("GYRO-xy-off"):
        return value == (REG1_PD | REG1_ZEN | REG1_YEN | REG1_XEN)
    else:
        return value == (REG1_PD | REG1_ZEN)


# GYRO.c: getX
def getX() -> int16:
    temp: array[uchar, 2] = (0, 0)
    xAxis: uint16 = 0

    readReg(OUT_X_L, temp, 2)

    xAxis = temp[0]
    xAxis |= temp[1] << 8
    if FIXED("GYRO-bias-unsigned"):
        return Within_Int(float32(int16(xAxis)) + X_Calib_b)
    else:
        xAxis = xAxis + X_Calib_b
        return xAxis


# GYRO.c: getY
def getY() -> int16:
    temp: array[uchar, 2] = (0, 0)
    yAxis: uint16 = 0

    readReg(OUT_Y_L, temp, 2)

    yAxis = temp[0]
    yAxis |= temp[1] << 8
    if FIXED("GYRO-bias-unsigned"):
        return Within_Int(float32(int16(yAxis)) + Y_Calib_b)
    else:
        yAxis = yAxis + Y_Calib_b
        return yAxis


# GYRO.c: getZ
def getZ() -> int16:
    temp: array[uchar, 2] = (0, 0)
    zAxis: uint16 = 0

    readReg(OUT_Z_L, temp, 2)

    zAxis = temp[0]
    zAxis |= temp[1] << 8
    if FIXED("GYRO-bias-unsigned") and FIXED("GYRO-offset-wraps"):
        return Within_Int(float32(int16(zAxis)) + Z_Calib_b - Z_dc_offset)
    elif FIXED("GYRO-bias-unsigned"):
        return Within_Int(float32(int16(zAxis)) + Z_Calib_b) - Z_dc_offset
    else:
        zAxis = zAxis + Z_Calib_b
        if FIXED("GYRO-offset-wraps"):
            return Within_Int(float32(int16(zAxis)) - Z_dc_offset)
        else:
            return int16(zAxis) - Z_dc_offset


# GYRO.c: getZ
def Within_Int(value: float32) -> int16:
    if value > INT_MAX:
        return INT_MAX
    if value < INT_MIN:
        return INT_MIN
    return int16(value)


# GYRO.c: getTemp
def getTemp() -> schar:
    temp: schar = 0

    readReg(OUT_TEMP, cast(ptr[uchar], addressof(temp)), 1)

    if FIXED("GYRO-temperature-sign"):
        if temp > 127:
            temp = temp - 256
    temp = 44 - temp
    return temp


# GYRO.c: Offset_GYRO
def Offset_GYRO(AXIS: GYRO_SENSOR) -> float32:
    Calib_b: array[float32, 50]
    resultX: float32 = 0
    resultY: float32 = 0
    resultZ: float32 = 0

    bias_Gyro: float32
    i: uchar
    if FIXED("GYRO-offset-unknown-axis"):
        if AXIS > GYRO_SENSOR.Z:
            return 0.0
    match AXIS:
        case GYRO_SENSOR.X:
            for i in range(50):
                if FIXED("GYRO-offset-one-sample"):
                    Task_sleep(SAMPLE_MS)
                Calib_b[i] = getX()
                resultX += Calib_b[i]
            bias_Gyro = resultX / 50
        case GYRO_SENSOR.Y:
            for i in range(50):
                if FIXED("GYRO-offset-one-sample"):
                    Task_sleep(SAMPLE_MS)
                Calib_b[i] = getY()
                resultY += Calib_b[i]
            bias_Gyro = resultY / 50
        case GYRO_SENSOR.Z:
            for i in range(50):
                if FIXED("GYRO-offset-one-sample") or FIXED("GYRO-offset-moving"):
                    Task_sleep(SAMPLE_MS)
                Calib_b[i] = getZ()
                resultZ += Calib_b[i]
            if FIXED("GYRO-offset-moving"):
                Rested = Spread(Calib_b, 50) <= SPREAD_MOST
            bias_Gyro = resultZ / 50

    return bias_Gyro


# GYRO.c: Offset_GYRO
def Spread(v: ptr[float32], n: uchar) -> float32:
    least: float32 = v[0]
    most: float32 = v[0]
    k: uchar

    for k in range(1, n):
        if v[k] < least:
            least = v[k]
        if v[k] > most:
            most = v[k]
    return most - least


# GYRO.c: get_GYRO
def get_GYRO(AXIS: GYRO_SENSOR, bias: float32) -> float32:

    g_deg_s: float32
    W: float32
    V: float32
    Wabs: float32

    if FIXED("GYRO-unknown-axis"):
        if AXIS != GYRO_SENSOR.X and AXIS != GYRO_SENSOR.Y and AXIS != GYRO_SENSOR.Z:
            return 0.0
    match AXIS:
        case GYRO_SENSOR.X:
            V = getX()
            g_deg_s = (V - bias) * (DEG_S_PER_DIGIT if FIXED("GYRO-scale") else 250.0 / 32767.0)
            W = g_deg_s * (RAD_PER_DEG if FIXED("GYRO-radians") else 0.0174)
            if FIXED("GYRO-xy-result"):
                Wabs = W

        case GYRO_SENSOR.Y:
            V = getY()
            g_deg_s = (V - bias) * (DEG_S_PER_DIGIT if FIXED("GYRO-scale") else 250.0 / 32767.0)
            W = g_deg_s * (RAD_PER_DEG if FIXED("GYRO-radians") else 0.0174)
            if FIXED("GYRO-xy-result"):
                Wabs = W

        case GYRO_SENSOR.Z:
            V = getZ()
            g_deg_s = (V - bias) * (DEG_S_PER_DIGIT if FIXED("GYRO-scale") else 250.0 / 32767.0)
            W = g_deg_s * (RAD_PER_DEG if FIXED("GYRO-radians") else 0.0174)
            if (
                (W <= QUIET_RAD_S and W >= -QUIET_RAD_S)
                if FIXED("GYRO-clockwise-zero")
                else (W <= (0.0 if FIXED("GYRO-dead-band") else 0.01))
            ):
                Wabs = 0.0
            else:
                Wabs = W

    return Wabs


if FIXED("GYRO-temperature-unused"):
    del getTemp
