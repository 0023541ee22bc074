"""The Input X-BAR: which pin is INPUT1 to INPUT14, the inputs of trip zones, digital compares, external interrupts,
ADCEXTSOC, the eCAP modules and the other X-BARs.

Modelled: INPUTxSELECT, INPUTSELECTLOCK, EALLOW (by the register core).  The level of an input is the one that DAT of
its pin shows: after inversion and qualification, whatever the function and direction of the pin.
Not modelled: EXTSYNCIN (INPUT5, 6).
Time: none; an input changes in the cycle of its pin.  A pin is followed only while its input has a listener.
CHOICE: a bit of INPUTSELECTLOCK that is set stays set until reset, and a write to a locked INPUTxSELECT is dropped
silently, as with the other lock registers of the chip: HDR only names the bits.
CHOICE: selecting a pin of another level, or switching the inversion of a selected pin, is an edge for the input.  The
manual does not describe this case.
Sources: DS Input X-BAR (destinations); TRM X-BAR; HDR F2837xS_input_xbar.h.  That qualification comes before it follows
from TI's example of external interrupts, which qualifies their pins.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from emulator.cpu import Cpu
from emulator.registers.core import ALL
from emulator.registers.input_xbar import InputXbarRegs
from emulator.signal import Signal


class InputXbar:
    """The X-BAR over its registers.

    `level(pin)` is the input of a pin, and `pin_changed[pin]` happens at each change of it.
    """

    def __init__(
        self,
        cpu: Cpu,
        regs: InputXbarRegs,
        *,
        level: Callable[[int], int],
        pin_changed: Sequence[Signal[int]],
    ) -> None:
        self._cpu, self._regs = cpu, regs
        self._pins, self._level, self._pin_changed = len(pin_changed), level, pin_changed
        self._lock = regs.registers["INPUTSELECTLOCK"]
        #: INPUTn -> (level): every change of it.
        self.changed: dict[int, Signal[int]] = {n: Signal(partial(self._wanted, n)) for n in range(1, 15)}
        #: Input -> the function that stops listening to its pin; only for inputs with listeners.
        self._stops: dict[int, Callable[[], None]] = {}
        for n in self.changed:
            regs.bind(f"INPUT{n}SELECT", write=partial(self._write_INPUTxSELECT, n))

    def signal(self, n: int) -> XbarInput:
        """INPUTn as a level, for receivers that select among several signals."""
        return XbarInput(self, n)

    def input(self, n: int) -> int:
        """The level of INPUTn now."""
        return self._level_of(self._regs.registers[f"INPUT{n}SELECT"].value)

    def _wanted(self, n: int, wanted: bool) -> None:
        """A first listener connects to INPUTn (`wanted`), or the last one has gone."""
        if wanted:
            self._listen(n, self._regs.registers[f"INPUT{n}SELECT"].value)
        else:
            self._stops.pop(n)()

    def _listen(self, n: int, pin: int) -> None:
        """Listen to this pin for INPUTn.  A pin that does not exist never changes."""
        self._stops[n] = self._pin_changed[pin].connect(self.changed[n].emit) if pin < self._pins else _nothing

    def _level_of(self, pin: int) -> int:
        # CHOICE: a pin that does not exist is low.
        return self._level(pin) if pin < self._pins else 0

    def _write_INPUTxSELECT(self, n: int, word: int, lanes: int = ALL) -> None:
        register = self._regs.registers[f"INPUT{n}SELECT"]
        before = register.value
        if self._lock.value >> n - 1 & 1:
            if word != before:
                self._cpu.findings.report(
                    "locked", f"{register.path} is locked by INPUTSELECTLOCK: the write was dropped silently",
                    object=register.path, value=word,
                )  # fmt: skip
            return
        register.store(word, lanes)
        if n in self._stops:
            self._choose(n, before, register.value)
        if word >= self._pins:
            self._cpu.findings.report(
                "unmodelled",
                f"{register.path} = {word} is no pin (pins are 0 to {self._pins - 1}): the level of the input "
                "is not modelled and is low here",
                object=register.path, value=word,
            )  # fmt: skip

    def _choose(self, n: int, before: int, after: int) -> None:
        """An input gets another pin.  If the pin's level differs, the input sees an edge."""
        was, level = self._level_of(before), self._level_of(after)
        self._stops[n]()
        self._listen(n, after)
        if level != was:
            self.changed[n].emit(level)


def _nothing() -> None:
    """Stop listening to a pin that does not exist: there is nothing to do."""


class XbarInput:
    """One input of the X-BAR: its level, for receivers that select among inputs."""

    __slots__ = ("_number", "_xbar")

    def __init__(self, xbar: InputXbar, number: int) -> None:
        self._xbar, self._number = xbar, number

    @property
    def level(self) -> int:
        """The level now."""
        return self._xbar.input(self._number)

    @property
    def changed(self) -> Signal[int]:
        """(level): every change of it."""
        return self._xbar.changed[self._number]
