"""The pins that can carry each signal of a modelled module, and the pin function for it.

A function is (GMUX << 2) + MUX, as the pin's two registers hold it.  Of several pins, messages name the first one.  It
is the pin where the LaunchPad brings the signal out, else the lowest.
The Input X-BAR takes trips and other inputs from any pin.
Sources: DS, signal multiplexing; HDR pin_map.h.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

#: Signal -> GPIO -> function.
PIN_FUNCTIONS: Final[Mapping[str, Mapping[int, int]]] = MappingProxyType({
    "EPWM1A": {0: 1, 145: 1},
    "EPWM1B": {1: 1, 146: 1},
    "EPWM2A": {2: 1, 147: 1},
    "EPWM2B": {3: 1, 148: 1},
    "EPWM3A": {4: 1, 149: 1},
    "EPWM3B": {5: 1, 150: 1},
    "EPWM4A": {6: 1, 151: 1},
    "EPWM4B": {7: 1, 152: 1},
    "EPWM5A": {8: 1, 153: 1},
    "EPWM5B": {9: 1, 154: 1},
    "EPWM6A": {10: 1, 155: 1},
    "EPWM6B": {11: 1, 156: 1},
    "EPWM7A": {12: 1, 157: 1},
    "EPWM7B": {13: 1, 158: 1},
    "EPWM8A": {14: 1, 159: 1},
    "EPWM8B": {15: 1, 160: 1},
    "EPWM9A": {16: 5, 161: 1},
    "EPWM9B": {17: 5, 162: 1},
    "EPWM10A": {18: 5, 163: 1},
    "EPWM10B": {19: 5, 164: 1},
    "EPWM11A": {20: 5, 165: 1},
    "EPWM11B": {21: 5, 166: 1},
    "EPWM12A": {22: 5, 167: 1},
    "EPWM12B": {23: 5, 168: 1},
    "EQEP1A": {10: 5, 20: 1, 50: 1, 96: 5},
    "EQEP1B": {11: 5, 21: 1, 51: 1, 97: 5},
    "EQEP1S": {12: 5, 22: 1, 52: 1, 98: 5},
    "EQEP1I": {13: 5, 23: 1, 53: 1, 99: 5},
    "EQEP2A": {24: 2, 54: 5, 78: 6, 100: 5},
    "EQEP2B": {25: 2, 55: 5, 79: 6, 101: 5},
    "EQEP2S": {27: 2, 56: 5, 80: 6, 102: 5},
    "EQEP2I": {26: 2, 57: 5, 81: 6, 103: 5},
    "EQEP3A": {62: 5, 6: 5, 28: 6, 104: 5},
    "EQEP3B": {63: 5, 7: 5, 29: 6, 105: 5},
    "EQEP3S": {8: 5, 30: 6, 64: 5, 106: 5},
    "EQEP3I": {9: 5, 31: 6, 65: 5, 107: 5},
    "SCITXDA": {84: 5, 8: 6, 29: 1, 36: 1, 42: 15, 48: 6, 65: 6, 135: 6},
    "SCIRXDA": {85: 5, 9: 6, 28: 1, 35: 1, 43: 15, 49: 6, 64: 6, 136: 6},
    "SCITXDB": {86: 5, 9: 2, 10: 6, 14: 2, 18: 2, 22: 3, 54: 6, 70: 6, 137: 6},
    "SCIRXDB": {87: 5, 11: 2, 15: 2, 19: 2, 23: 3, 55: 6, 71: 6, 138: 6},
    "SCITXDC": {89: 6, 12: 6, 38: 5, 56: 6, 63: 1, 72: 6, 106: 6, 140: 6},
    "SCIRXDC": {90: 6, 13: 6, 39: 5, 57: 6, 62: 1, 73: 6, 107: 6, 139: 6},
    "SCITXDD": {47: 6, 76: 6, 93: 6, 104: 6, 142: 6},
    "SCIRXDD": {46: 6, 77: 6, 94: 6, 105: 6, 141: 6},
    "SPISIMOA": {58: 15, 16: 1, 54: 1},
    "SPISOMIA": {59: 15, 17: 1, 55: 1},
    "SPICLKA": {60: 15, 18: 1, 56: 1},
    "SPISTEA": {61: 15, 19: 1, 57: 1},
    "SPISIMOB": {63: 15, 24: 6, 60: 6},
    "SPISOMIB": {64: 15, 25: 6, 61: 6},
    "SPICLKB": {65: 15, 22: 6, 26: 6, 58: 6},
    "SPISTEB": {66: 15, 23: 6, 27: 6, 59: 6},
    "SPISIMOC": {69: 15, 50: 6, 100: 6, 122: 6},
    "SPISOMIC": {70: 15, 51: 6, 101: 6, 123: 6},
    "SPICLKC": {71: 15, 52: 6, 102: 6, 124: 6},
    "SPISTEC": {72: 15, 53: 6, 103: 6, 125: 6},
    "SDAA": {0: 6, 32: 1, 42: 6, 91: 6, 104: 1},
    "SCLA": {1: 6, 33: 1, 43: 6, 92: 6, 105: 1},
    "SDAB": {2: 6, 34: 6, 40: 6, 66: 6},
    "SCLB": {3: 6, 35: 6, 41: 6, 69: 6},
    "CANTXA": {4: 6, 19: 3, 31: 1, 37: 6, 63: 6, 71: 5},
    "CANRXA": {5: 6, 18: 3, 30: 1, 36: 6, 62: 6, 70: 5},
    "CANTXB": {6: 6, 8: 2, 12: 2, 16: 2, 20: 3, 38: 6, 72: 5},
    "CANRXB": {7: 6, 10: 2, 13: 2, 17: 2, 21: 3, 39: 6, 73: 5},
    "OUTPUTXBAR1": {2: 5, 24: 1, 34: 1, 58: 5},
    "OUTPUTXBAR2": {3: 2, 25: 1, 37: 1, 59: 5},
    "OUTPUTXBAR3": {4: 5, 5: 3, 14: 6, 26: 1, 48: 1, 60: 5},
    "OUTPUTXBAR4": {6: 2, 15: 6, 27: 1, 49: 1, 61: 5},
    "OUTPUTXBAR5": {7: 3, 28: 5},
    "OUTPUTXBAR6": {9: 3, 29: 5},
    "OUTPUTXBAR7": {11: 3, 16: 3, 30: 5},
    "OUTPUTXBAR8": {17: 3, 31: 5},
})  # fmt: skip
