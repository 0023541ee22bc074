"""Inputs of the Input X-BAR and who listens to them: finds a driver whose input is chosen for somebody else.

    InputXbarRegs.INPUT6SELECT = ECHO_GPIO;         /* right: INPUT7, which is that of eCAP1 */
    ...
    width = ECap1Regs.CAP2;

In a driver file without a `main` the application may choose pins as well.  So it takes two: a listener of the file
whose input no statement chooses, and an input that the file chooses and that nothing in the source uses.  More than one
of either may belong together in other ways: nothing is said then.

Sources: DS, Input X-BAR (destinations); TRM, trip-zone submodule, digital compare, time-base synchronisation.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from emulator.c28x.sites import Place
from emulator.chip import ECAP_INPUT, EPWM_COUNT, EXTSOC_INPUT, INPUT_TRIPINS, XBAR_INPUTS, XBAR_TRIPS, XINT_INPUT, Chip
from emulator.peripherals.adc_socs import ADCEXTSOC
from emulator.register_writes import RegisterWrites

#: Inputs that are also EXTSYNCIN1 and EXTSYNCIN2 (TRM, time-base synchronisation).
_SYNC_INPUTS: Final = (5, 6)
#: Inputs of the Input X-BAR.
_INPUTS: Final = range(1, 15)


@dataclass(frozen=True, slots=True)
class Listener:
    """A part that waits for edges of one input: its name, the input, and where the source sets it up."""

    name: str
    number: int
    place: Place


@dataclass(frozen=True, slots=True)
class OtherInput:
    """A listener without a pin, and the statement that chooses the pin of an input that nothing uses."""

    listener: Listener
    number: int
    place: Place

    @property
    def message(self) -> str:
        """What is wrong."""
        name, own = self.listener.name, self.listener.number
        return (
            f"{name} listens to INPUT{own} of the Input X-BAR, for which no statement chooses a pin; "
            f"INPUT{self.number} gets one, and nothing uses that input"
        )


def other_inputs(chip: Chip, source: RegisterWrites) -> Iterator[OtherInput]:
    """The listeners of driver files for which another input was chosen, one of each file at most."""
    users = _Users(chip, source)
    chosen = {
        number: place for number in _INPUTS
        if (place := source.last("InputXbarRegs", _select(number))) is not None
    }  # fmt: skip
    if not chosen or source.anywhere:
        return
    waiting = [each for each in users.listeners() if not users.may_choose(each.number)]
    idle = {number: place for number, place in chosen.items() if not users.used(number)}
    for number, place in idle.items():
        here = [each for each in waiting if each.place.file == place.file]
        beside = [other for other in idle.values() if other.file == place.file]
        if len(here) == len(beside) == 1:
            yield OtherInput(here[0], number, place)


def _select(number: int) -> str:
    return f"INPUT{number}SELECT"


class _Users:
    """What a program does with the inputs."""

    def __init__(self, chip: Chip, source: RegisterWrites) -> None:
        self._chip = chip
        self._source = source

    def may_choose(self, number: int) -> bool:
        """Whether a statement may choose the pin of an input, or something has."""
        register = self._chip.blocks["InputXbarRegs"].registers[_select(number)]
        return register.value != register.reset_value or self._could("InputXbarRegs", _select(number), "", zero=True)

    def listeners(self) -> Iterator[Listener]:
        """The captures that are read, the external interrupts that are enabled, and the trip zones that are chosen."""
        for n, number in ECAP_INPUT.items():
            name = f"ECap{n}Regs"
            place = self._source.last(name, "ECCTL2")
            read = any((name, f"CAP{k}") in self._source.reads for k in range(1, 5))
            if place is not None and read and not self._could(name, "ECCTL2", "CAP_APWM"):
                yield Listener(f"eCAP{n}", number, place)
        for n, number in XINT_INPUT.items():
            place = self._source.last("XintRegs", f"XINT{n}CR")
            if place is not None and self._could("XintRegs", f"XINT{n}CR", "ENABLE"):
                yield Listener(f"XINT{n}", number, place)
        for n, number in self._trip_zones():
            place = self._source.last(f"EPwm{n}Regs", "TZSEL")
            if place is not None:
                yield Listener(f"TZ{number} of ePWM{n}", number, place)

    def _trip_zones(self) -> Iterator[tuple[int, int]]:
        for n in range(1, EPWM_COUNT + 1):
            for number in XBAR_TRIPS:
                if any(self._could(f"EPwm{n}Regs", "TZSEL", f"{kind}{number}") for kind in ("OSHT", "CBC")):
                    yield n, number

    def used(self, number: int) -> bool:
        """Whether anything in the source may use an input."""
        source = self._source
        ecaps = [f"ECap{n}Regs" for n, own in ECAP_INPUT.items() if own == number]
        xints = [f"XINT{n}CR" for n, own in XINT_INPUT.items() if own == number]
        if any(source.last(name) for name in ecaps) or any(source.last("XintRegs", name) for name in xints):
            return True
        if number in XBAR_INPUTS and any(source.last(name) for name in ("EPwmXbarRegs", "OutputXbarRegs")):
            return True
        epwms = [f"EPwm{n}Regs" for n in range(1, EPWM_COUNT + 1)]
        if number in INPUT_TRIPINS and any(source.last(name, "DCTRIPSEL") for name in epwms):
            return True
        if number in XBAR_TRIPS and any(own == number for _, own in self._trip_zones()):
            return True
        if number == EXTSOC_INPUT and any(
            self._could(f"Adc{x}Regs", f"ADCSOC{n}CTL", "TRIGSEL", ADCEXTSOC) for x in "abcd" for n in range(16)
        ):
            return True
        return number in _SYNC_INPUTS and (
            source.last("SyncSocRegs") is not None
            or any(self._could(name, "TBCTL", "PHSEN") for name in epwms)
            or any(self._could(f"ECap{n}Regs", "ECCTL2", "SYNCI_EN") for n in ECAP_INPUT)
        )

    def _could(self, block: str, register: str, field: str, value: int | None = None, *, zero: bool = False) -> bool:
        """Whether a statement may give a field a value, or any that is not 0; `zero`: 0 counts too."""
        cell = self._chip.blocks[block].registers[register]
        mask = cell.fields[field].mask if field else (1 << cell.bits) - 1
        right = (lambda word: zero or word != 0) if value is None else (lambda word: word == value)
        return self._source.could(block, register, mask, right)
