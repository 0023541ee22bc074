"""L3G4200D: its registers and the meaning of their codes.  `l3g4200d.py` has the behaviour.

Sources: L3G sections 4-7 (register map, CTRL_REG1-5, FIFO, interrupt generator), table of mechanical
characteristics.  LPF1 cut-offs are not in that document: see `LPF1_HZ`.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Final


class Rw(enum.Enum):
    """How the serial interface may use a register."""

    RW = "read, write"
    R = "read only"


@dataclass(frozen=True, slots=True)
class DeviceRegister:
    """One 8-bit register.  `fields` maps a name to its (hi, lo) bits; `writable` masks the bits that are stored."""

    name: str
    address: int
    access: Rw
    reset: int
    fields: dict[str, tuple[int, int]]
    writable: int = 0xFF


def _bits(names: str) -> dict[str, tuple[int, int]]:
    """Eight single bits, bit 7 first; `-` marks a bit without a name."""
    return {name: (7 - i, 7 - i) for i, name in enumerate(names.split()) if name != "-"}


WHO_AM_I: Final = 0x0F
CTRL_REG1: Final = 0x20
CTRL_REG2: Final = 0x21
CTRL_REG3: Final = 0x22
CTRL_REG4: Final = 0x23
CTRL_REG5: Final = 0x24
REFERENCE: Final = 0x25
OUT_TEMP: Final = 0x26
STATUS_REG: Final = 0x27
OUT_X_L: Final = 0x28
OUT_Z_H: Final = 0x2D
FIFO_CTRL_REG: Final = 0x2E
FIFO_SRC_REG: Final = 0x2F
INT1_CFG: Final = 0x30
INT1_SRC: Final = 0x31
INT1_THS_XH: Final = 0x32
INT1_DURATION: Final = 0x38

WHO_AM_I_VALUE: Final = 0xD3

_RW, _R = Rw.RW, Rw.R

# fmt: off
REGISTERS: Final = tuple(DeviceRegister(*row) for row in (
    # name            addr  access reset  fields
    ("WHO_AM_I",      0x0F, _R,    0xD3,  {"WHO_AM_I": (7, 0)}),
    ("CTRL_REG1",     0x20, _RW,   0x07,  {"DR": (7, 6), "BW": (5, 4), "PD": (3, 3), "Zen": (2, 2), "Yen": (1, 1),
                                           "Xen": (0, 0)}),
    ("CTRL_REG2",     0x21, _RW,   0x00,  {"HPM": (5, 4), "HPCF": (3, 0)}),
    ("CTRL_REG3",     0x22, _RW,   0x00,  _bits("I1_Int1 I1_Boot H_Lactive PP_OD I2_DRDY I2_WTM I2_ORun I2_Empty")),
    ("CTRL_REG4",     0x23, _RW,   0x00,  {"BDU": (7, 7), "BLE": (6, 6), "FS": (5, 4), "ST": (2, 1), "SIM": (0, 0)}),
    ("CTRL_REG5",     0x24, _RW,   0x00,  {"BOOT": (7, 7), "FIFO_EN": (6, 6), "HPen": (4, 4), "INT1_Sel": (3, 2),
                                           "Out_Sel": (1, 0)}),
    ("REFERENCE",     0x25, _RW,   0x00,  {"REF": (7, 0)}),
    ("OUT_TEMP",      0x26, _R,    0x00,  {"TEMP": (7, 0)}),
    ("STATUS_REG",    0x27, _R,    0x00,  _bits("ZYXOR ZOR YOR XOR ZYXDA ZDA YDA XDA")),
    ("OUT_X_L",       0x28, _R,    0x00,  {"X": (7, 0)}),
    ("OUT_X_H",       0x29, _R,    0x00,  {"X": (7, 0)}),
    ("OUT_Y_L",       0x2A, _R,    0x00,  {"Y": (7, 0)}),
    ("OUT_Y_H",       0x2B, _R,    0x00,  {"Y": (7, 0)}),
    ("OUT_Z_L",       0x2C, _R,    0x00,  {"Z": (7, 0)}),
    ("OUT_Z_H",       0x2D, _R,    0x00,  {"Z": (7, 0)}),
    ("FIFO_CTRL_REG", 0x2E, _RW,   0x00,  {"FM": (7, 5), "WTM": (4, 0)}),
    ("FIFO_SRC_REG",  0x2F, _R,    0x20,  {"WTM": (7, 7), "OVRN": (6, 6), "EMPTY": (5, 5), "FSS": (4, 0)}),
    ("INT1_CFG",      0x30, _RW,   0x00,  _bits("AND_OR LIR ZHIE ZLIE YHIE YLIE XHIE XLIE")),
    ("INT1_SRC",      0x31, _R,    0x00,  _bits("- IA ZH ZL YH YL XH XL")),
    ("INT1_THS_XH",   0x32, _RW,   0x00,  {"THSX": (6, 0)}, 0x7F),   # the high half has the lower address
    ("INT1_THS_XL",   0x33, _RW,   0x00,  {"THSX": (7, 0)}),
    ("INT1_THS_YH",   0x34, _RW,   0x00,  {"THSY": (6, 0)}, 0x7F),
    ("INT1_THS_YL",   0x35, _RW,   0x00,  {"THSY": (7, 0)}),
    ("INT1_THS_ZH",   0x36, _RW,   0x00,  {"THSZ": (6, 0)}, 0x7F),
    ("INT1_THS_ZL",   0x37, _RW,   0x00,  {"THSZ": (7, 0)}),
    ("INT1_DURATION", 0x38, _RW,   0x00,  {"WAIT": (7, 7), "D": (6, 0)}),
))

#: DR -> output data rate in Hz.
ODR_HZ: Final = (100, 200, 400, 800)

#: DR -> cut-off of the first low-pass filter in Hz.
#: CHOICE: quoted for the sister part L3GD20H; this part's data sheet gives none.
LPF1_HZ: Final[tuple[float, ...]] = (32.0, 63.3, 128.0, 211.0)

#: DR, BW -> cut-off of the second low-pass filter in Hz (on the output only with Out_Sel = 1x).
LPF2_HZ: Final[tuple[tuple[float, ...], ...]] = (
    (12.5, 25.0, 25.0, 25.0),
    (12.5, 25.0, 50.0, 70.0),
    (20.0, 25.0, 50.0, 110.0),
    (30.0, 35.0, 50.0, 110.0),
)

#: DR, HPCF -> cut-off of the high-pass filter in Hz.  Codes above 9 are not defined.
HPF_HZ: Final[tuple[tuple[float, ...], ...]] = (
    (8.0, 4.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01),
    (15.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02),
    (30.0, 15.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05),
    (56.0, 30.0, 15.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.2, 0.1),
)
# fmt: on

#: FS -> nominal range, sensitivity, typical zero-rate level and typical self-test change.
FULL_SCALE_DPS: Final[tuple[float, ...]] = (250.0, 500.0, 2000.0, 2000.0)
SENSITIVITY_DPS: Final[tuple[float, ...]] = (0.00875, 0.0175, 0.07, 0.07)
ZERO_RATE_DPS: Final[tuple[float, ...]] = (10.0, 15.0, 75.0, 75.0)
ZERO_RATE_DPS_PER_C: Final[tuple[float, ...]] = (0.03, 0.03, 0.04, 0.04)
SELF_TEST_DPS: Final[tuple[float, ...]] = (130.0, 200.0, 530.0, 530.0)

#: dps / sqrt(Hz), typical at a bandwidth of 50 Hz.
NOISE_DENSITY_DPS: Final = 0.03

INT16_MAX: Final = 32767
INT16_MIN: Final = -32768


class FifoMode(enum.IntEnum):
    """FM[2:0] of FIFO_CTRL_REG."""

    BYPASS = 0
    FIFO = 1
    STREAM = 2
    STREAM_TO_FIFO = 3
    BYPASS_TO_STREAM = 4


class HighPassMode(enum.IntEnum):
    """HPM[1:0] of CTRL_REG2."""

    NORMAL_RESET = 0
    REFERENCE = 1
    NORMAL = 2
    AUTO_RESET = 3
