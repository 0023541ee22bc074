"""The temperature sensor of the chip: a voltage at input 13 of ADC-A.

Modelled: TSNSCTL.ENABLE; a voltage that rises with `temperature_c`.
Not modelled: its start-up time, the sample window of 700 ns that it needs, the heat of the chip itself.
CHOICE: it is exact, with the slope and offset that TI's code uses for a part without calibration: code 1788 at 0 C, of
    12 bits and a reference of 2.5 V, and 5196 / 32768 C for each code.  CHOICE: the chip has 25 C.
Sources: HDR F2837xS_TempSensorConv.c, F2837xS_analogsubsys.h; TI's example of the sensor: input and window.
"""

from __future__ import annotations

from typing import Final

from emulator.registers.core import ALL
from emulator.registers.sysctrl import TSNSCTL, AnalogSubsysRegs
from emulator.signals import AnalogWire

#: Calibration: degrees a code in Q15, and the code at 0 degrees.
SLOPE_Q15: Final = 5196
OFFSET: Final = 1788
_VOLTS_PER_CODE: Final = 2.5 / 4096


class TemperatureSensor:
    """The sensor over its register; it drives `output` while it is on."""

    __slots__ = ("_output", "_regs", "temperature_c")

    def __init__(self, regs: AnalogSubsysRegs, output: AnalogWire) -> None:
        self._regs, self._output = regs, output
        #: The temperature of the chip in degrees Celsius; a test may set it.
        self.temperature_c = 25.0
        regs.bind("TSNSCTL", write=self._write_TSNSCTL)

    def _volts(self, _cycles: int) -> float:
        return (OFFSET + self.temperature_c * 32768 / SLOPE_Q15) * _VOLTS_PER_CODE

    def _write_TSNSCTL(self, word: int, lanes: int = ALL) -> None:
        register = self._regs.registers["TSNSCTL"]
        register.store(word, lanes)
        self._output.drive(self._volts if register.value & TSNSCTL.ENABLE.mask else None)
