"""Registers: what each is (offset, width, fields, access, reset, protection), one module a peripheral.

`SOURCES` names each document once; register and device modules cite its keys.
"""

from typing import Final

SOURCES: Final = {
    "DS": "TMS320F2837xS data sheet, SPRS881",
    "TRM": "TMS320F2837xS technical reference manual, SPRUHX5",
    "HDR": "C2000Ware f2837xs device headers, F2837xS_*.h",
    "ERR": "TMS320F2837xS errata, SPRZ422",
    "CPU": "TMS320C28x CPU and instruction set, SPRU430",
    "CC": "TMS320C28x optimizing C/C++ compiler, SPRU514",
    "L3G": "L3G4200D data sheet, ST Doc ID 17116",
    "EZ": "LV-MaxSonar-EZ data sheet, MaxBotix PD11832",
    "NXT": "LEGO NXT servo motor 9842, published measurements",
    "LB": "LB1836M data sheet, ON Semiconductor",
    "XB": "XBee/XBee-PRO 802.15.4 OEM RF modules manual, Digi 90000982",
    "BIOS": "TI SYS/BIOS real-time kernel user's guide, SPRUEX3",
    "TFG": "the thesis on the robot: section or annex given with each citation",
}
