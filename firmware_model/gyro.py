"""GYRO.c: device driver of the Pmod GYRO (L3G4200D) on SPI-A.

Only Z is powered, 100 Hz, 250 degrees per second.  Sources: TFG section 3.1.2, annex 1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import DelayUs
from firmware_model.board_support.spi import HIGH, LOW, Init_SPIA, Set_CS, SPI_transfer

WHO_AM_I = 0x0F
CTRL_REG1 = 0x20
CTRL_REG2 = 0x21
CTRL_REG3 = 0x22
CTRL_REG4 = 0x23
CTRL_REG5 = 0x24
REFERENCE = 0x25
OUT_TEMP = 0x26
STATUS_REG = 0x27
OUT_X_L = 0x28
OUT_X_H = 0x29
OUT_Y_L = 0x2A
OUT_Y_H = 0x2B
OUT_Z_L = 0x2C
OUT_Z_H = 0x2D
FIFO_CTRL_REG = 0x2E
FIFO_SRC_REG = 0x2F
INT1_CFG = 0x30
INT1_SRC = 0x31
INT1_TSH_XH = 0x32
INT1_TSH_XL = 0x33
INT1_TSH_YH = 0x34
INT1_TSH_YL = 0x35
INT1_TSH_ZH = 0x36
INT1_TSH_ZL = 0x37
INT1_DURATION = 0x38

REG1_DR1 = 0x80
REG1_DR0 = 0x40
REG1_BW1 = 0x20
REG1_BW0 = 0x10
REG1_PD = 0x08
REG1_ZEN = 0x04
REG1_YEN = 0x02
REG1_XEN = 0x01

REG3_I1_INT1 = 0x80
REG3_I1_BOOT = 0x40
REG3_H_LACTIVE = 0x20
REG3_PP_OD = 0x10
REG3_I2_DRDY = 0x08
REG3_I2_WTM = 0x04
REG3_I2_ORUN = 0x02
REG3_I2_EMPTY = 0x01

REG4_BDU = 0x80

REG5_FIFO_EN = 0x40

INT1_ANDOR = 0x80
INT1_LIR = 0x40
INT1_ZHIE = 0x20
INT1_ZLIE = 0x10
INT1_YHIE = 0x08
INT1_YLIE = 0x04
INT1_XHIE = 0x02
INT1_XLIE = 0x01

WRITE = 0x00
MULTI_WRITE = 0x40
READ = 0x80
MULTI_READ = 0xC0


class GYRO_SENSOR(enum):
    X = 0
    Y = 1
    Z = 2


Z_dc_offset: int16 = 0

buff: array[int16, 100]
i: int16 = 0
aux: int16 = 0

temp: char = 0

X_Calib_b: float32 = 0.0
Y_Calib_b: float32 = 0.0
Z_Calib_b: float32 = 0.0


# GYRO.c: Init_GYRO
def Init_GYRO() -> void:
    n: int16

    Init_SPIA()
    Set_CS(HIGH)

    writeReg(CTRL_REG4, REG4_BDU)
    writeReg(CTRL_REG5, REG5_FIFO_EN)
    writeReg(FIFO_CTRL_REG, 0x00)
    writeReg(CTRL_REG1, REG1_PD | REG1_ZEN)

    for n in range(100):

        buff[i] = getZ()
        aux += buff[i]  # as in C: 16 bits, and not cleared before a second call
        i = (i + 1) % 100
        DelayUs(20000)
    Z_dc_offset = aux / 100

    return


# GYRO.c: getX
def getX() -> int16:
    temp: array[uchar, 2] = (0, 0)
    xAxis: uint16 = 0

    readReg(OUT_X_L, temp, 2)

    xAxis = temp[0]
    xAxis |= temp[1] << 8
    xAxis = xAxis + X_Calib_b  # as in C: unsigned to float and back; a negative sum does not fit
    return xAxis


# GYRO.c: getY
def getY() -> int16:
    temp: array[uchar, 2] = (0, 0)
    yAxis: uint16 = 0

    readReg(OUT_Y_L, temp, 2)

    yAxis = temp[0]
    yAxis |= temp[1] << 8
    yAxis = yAxis + Y_Calib_b
    return yAxis


# GYRO.c: getZ
def getZ() -> int16:
    temp: array[uchar, 2] = (0, 0)
    zAxis: uint16 = 0

    readReg(OUT_Z_L, temp, 2)

    zAxis = temp[0]
    zAxis |= temp[1] << 8
    zAxis = zAxis + Z_Calib_b
    return int16(zAxis) - Z_dc_offset


# GYRO.c: getTemp
def getTemp() -> schar:
    temp: schar = 0

    readReg(OUT_TEMP, cast(ptr[uchar], addressof(temp)), 1)

    temp = 44 - temp  # as in C: char has 16 bits, so the sign of the register is lost
    return temp


# GYRO.c: writeReg
def writeReg(reg: uchar, value: uchar) -> int16:
    temp: uchar

    Set_CS(LOW)
    DelayUs(20)
    SPI_transfer(reg)
    SPI_transfer(value)
    Set_CS(HIGH)

    Set_CS(LOW)
    SPI_transfer(READ | reg)
    temp = SPI_transfer(0x00)
    Set_CS(HIGH)

    if temp != value:
        return 0

    return 1


# GYRO.c: readReg
def readReg(reg: uchar, recv: ptr[uchar], count: int16) -> void:
    i: int16 = 0  # in the C it is declared in the else branch, hiding the file-scope i there only

    if count == 1:

        Set_CS(LOW)
        SPI_transfer(READ | reg)
        recv[0] = SPI_transfer(0x00)
        Set_CS(HIGH)
    else:
        Set_CS(LOW)
        SPI_transfer(MULTI_READ | reg)
        for i in range(0, count):
            recv[0] = SPI_transfer(0x00)
            recv += 1
        Set_CS(HIGH)


# GYRO.c: Offset_GYRO
def Offset_GYRO(AXIS: GYRO_SENSOR) -> float32:
    Calib_b: array[float32, 50]
    resultX: float32 = 0
    resultY: float32 = 0
    resultZ: float32 = 0

    bias_Gyro: float32  # as in C: returned uninitialised for any other axis
    i: uchar
    match AXIS:
        case GYRO_SENSOR.X:
            for i in range(50):
                Calib_b[i] = getX()
                resultX += Calib_b[i]
            bias_Gyro = resultX / 50
        case GYRO_SENSOR.Y:
            for i in range(50):
                Calib_b[i] = getY()
                resultY += Calib_b[i]
            bias_Gyro = resultY / 50
        case GYRO_SENSOR.Z:
            for i in range(50):
                Calib_b[i] = getZ()
                resultZ += Calib_b[i]
            bias_Gyro = resultZ / 50

    return bias_Gyro


# GYRO.c: get_GYRO
def get_GYRO(AXIS: GYRO_SENSOR, bias: float32) -> float32:

    g_deg_s: float32
    W: float32
    V: float32
    Wabs: float32  # as in C: only Z gives it a value

    match AXIS:
        case GYRO_SENSOR.X:
            V = getX()
            g_deg_s = (V - bias) * (250.0 / 32767.0)  # as in C: the data sheet's digit is 8.75 mdps
            W = g_deg_s * 0.0174

        case GYRO_SENSOR.Y:
            V = getY()
            g_deg_s = (V - bias) * (250.0 / 32767.0)
            W = g_deg_s * 0.0174

        case GYRO_SENSOR.Z:
            V = getZ()
            g_deg_s = (V - bias) * (250.0 / 32767.0)
            W = g_deg_s * 0.0174
            if W <= 0.01:  # as in C: every turn to the right is cut off too
                Wabs = 0.0
            else:
                Wabs = W

    return Wabs
