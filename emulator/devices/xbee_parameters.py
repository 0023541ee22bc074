"""XBee S1: its AT parameters, their ranges and factory values.  Description, and the two stores of one module.

Modelled: working values, non-volatile values (WR, FR), factory values (RE).
Not modelled: the parameters in `STORED_ONLY`: they are kept and read back, and have no effect.
Time: none.
Sources: XB command reference tables.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class AtParameter:
    """One AT parameter: smallest and largest value (hexadecimal on the line), factory value, whether it can be set."""

    low: int
    high: int
    factory: int
    writable: bool = True


# fmt: off
PARAMETERS: Final = {
    #                  low    high        factory
    "CH": AtParameter(   0x0B,  0x1A,       0x0C),
    "ID": AtParameter(   0,     0xFFFF,     0x3332),
    "DH": AtParameter(   0,     0xFFFFFFFF, 0),
    "DL": AtParameter(   0,     0xFFFFFFFF, 0),          # CHOICE: factory 0, so that a fresh pair talks
    "MY": AtParameter(   0,     0xFFFF,     0),          # CHOICE: likewise
    "SH": AtParameter(   0,     0xFFFFFFFF, 0x0013A200, writable=False),
    "SL": AtParameter(   0,     0xFFFFFFFF, 0,          writable=False),
    "RR": AtParameter(   0,     6,          0),
    "RN": AtParameter(   0,     3,          0),
    "MM": AtParameter(   0,     3,          0),
    "BD": AtParameter(   0,     7,          3),
    "RO": AtParameter(   0,     0xFF,       3),
    "AP": AtParameter(   0,     2,          0),
    "NB": AtParameter(   0,     4,          0),
    "D6": AtParameter(   0,     5,          0),
    "D7": AtParameter(   0,     5,          1),
    "CT": AtParameter(   2,     0xFFFF,     0x64),
    "GT": AtParameter(   2,     0x0CE4,     0x3E8),
    "CC": AtParameter(   0,     0xFF,       0x2B),
    "VR": AtParameter(   0,     0xFFFF,     0x10EC,     writable=False),    # CHOICE: an example of the family
    "HV": AtParameter(   0,     0xFFFF,     0x1700,     writable=False),    # CHOICE: likewise
    "EA": AtParameter(   0,     0xFFFF,     0),
    "EC": AtParameter(   0,     0xFFFF,     0),
    "DB": AtParameter(   0,     0x64,       0x28,       writable=False),    # CHOICE: -40 dBm, a robot in the same room
    "AI": AtParameter(   0,     0xFF,       0,          writable=False),
}
# fmt: on

#: BD code -> true bits a second.  CHOICE: 7 is 111,111, as listed for a sister part.
BAUDS: Final = (1200, 2400, 4800, 9600, 19200, 38400, 57600, 111_111)
NOMINAL_BAUDS: Final = (1200, 2400, 4800, 9600, 19200, 38400, 57600, 115_200)

#: Accepted and read back without effect, beyond the value given.
STORED_ONLY: Final = {"AP": 0, "NB": 0, "D6": 0, "RN": 0}

#: Longest NI string.
NAME_LENGTH: Final = 20

BROADCAST: Final = 0xFFFF


class XBeeSettings:
    """The parameters of one module: `working` are in use now, `stored` survive a reset."""

    __slots__ = ("_factory", "name", "stored", "stored_name", "working")

    def __init__(self, serial_low: int) -> None:
        self._factory = {key: parameter.factory for key, parameter in PARAMETERS.items()}
        self._factory["SL"] = serial_low
        self.working = dict(self._factory)
        self.stored = dict(self._factory)
        self.name = self.stored_name = " "

    def __getitem__(self, key: str) -> int:
        return self.working[key]

    def write(self) -> None:
        """WR."""
        self.stored = dict(self.working)
        self.stored_name = self.name

    def restore_factory(self) -> None:
        """RE: working values only; WR makes them permanent."""
        self.working = dict(self._factory)
        self.name = " "

    def reset(self) -> None:
        """Reset: working values become the stored ones, and the error counters start again."""
        self.working = dict(self.stored)
        self.working["EA"] = self.working["EC"] = 0
        self.name = self.stored_name
