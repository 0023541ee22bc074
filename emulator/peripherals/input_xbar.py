"""The Input X-BAR: which pin is INPUT1 to INPUT14, the inputs of trip zones, digital compares, external interrupts,
ADCEXTSOC, the eCAP modules and the other X-BARs.

Modelled: INPUTxSELECT, INPUTSELECTLOCK, EALLOW (by the register core).  What an input shows is what DAT of its pin
shows: behind inversion and qualification, whatever the function and direction of the pin.
Not modelled: EXTSYNCIN (INPUT5, 6).
Time: none; an input changes in the cycle of its pin.  A pin is followed only while somebody listens to its input.
CHOICE: a bit of INPUTSELECTLOCK that is set stays set until reset, and what is written to a locked INPUTxSELECT is
dropped silently, as with the other lock registers of the chip: HDR only names the bits.
CHOICE: selecting a pin of another level, and switching the inversion of a selected one, is an edge for the input: the
manual says nothing of a change on the way.
Sources: DS Input X-BAR (destinations); TRM X-BAR; HDR F2837xS_input_xbar.h.  That qualification lies before it: TI's
example of external interrupts, which qualifies their pins.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from emulator.cpu import Cpu
from emulator.registers.core import ALL
from emulator.registers.input_xbar import InputXbarRegs

Listener = Callable[[int], None]


class InputXbar:
    """The X-BAR over its registers.

    `follow(pin, listener)` has GPIO tell every change of a pin's input, `unfollow` ends it and `level(pin)` reads one;
    `pins` is how many there are.
    """

    def __init__(
        self,
        cpu: Cpu,
        regs: InputXbarRegs,
        *,
        pins: int,
        level: Callable[[int], int],
        follow: Callable[[int, Listener], None],
        unfollow: Callable[[int, Listener], None],
    ) -> None:
        self._cpu, self._regs = cpu, regs
        self._pins, self._level, self._follow, self._unfollow = pins, level, follow, unfollow
        self._lock = regs.registers["INPUTSELECTLOCK"]
        #: Who listens to an input, and what hears its pin.
        self._listeners: dict[int, list[Listener]] = {}
        self._heard: dict[int, Listener] = {}
        for n in range(1, 15):
            regs.bind(f"INPUT{n}SELECT", write=partial(self._write_INPUTxSELECT, n))
            self._listeners[n] = []
            self._heard[n] = partial(self._hear, n)

    def signal(self, n: int) -> XbarInput:
        """INPUTn, for who takes it among other signals."""
        return XbarInput(self, n)

    def input(self, n: int) -> int:
        """The level of INPUTn now."""
        return self._level_of(self._regs.registers[f"INPUT{n}SELECT"].value)

    def listen(self, n: int, listener: Listener) -> None:
        """Call `listener(level)` at every change of INPUTn."""
        listeners, pin = self._listeners[n], self._regs.registers[f"INPUT{n}SELECT"].value
        if not listeners and pin < self._pins:
            self._follow(pin, self._heard[n])
        listeners.append(listener)

    def ignore(self, n: int, listener: Listener) -> None:
        """End a `listen`."""
        listeners, pin = self._listeners[n], self._regs.registers[f"INPUT{n}SELECT"].value
        listeners.remove(listener)
        if not listeners and pin < self._pins:
            self._unfollow(pin, self._heard[n])

    def _hear(self, n: int, level: int) -> None:
        for listener in list(self._listeners[n]):
            listener(level)

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
        if self._listeners[n]:
            self._choose(n, before, register.value)
        if word >= self._pins:
            self._cpu.findings.report(
                "unmodelled",
                f"{register.path} = {word} is no pin (they are 0 to {self._pins - 1}): what the input shows then "
                "is not modelled, it is low here",
                object=register.path, value=word,
            )  # fmt: skip

    def _choose(self, n: int, before: int, after: int) -> None:
        """Another pin for an input: where its level differs, the input sees an edge."""
        was, level = self._level_of(before), self._level_of(after)
        if before < self._pins:
            self._unfollow(before, self._heard[n])
        if after < self._pins:
            self._follow(after, self._heard[n])
        if level != was:
            self._hear(n, level)


class XbarInput:
    """One input of the X-BAR."""

    __slots__ = ("_number", "_xbar")

    def __init__(self, xbar: InputXbar, number: int) -> None:
        self._xbar, self._number = xbar, number

    @property
    def level(self) -> int:
        """The level now."""
        return self._xbar.input(self._number)

    def on_change(self, listener: Listener) -> None:
        """Call `listener(level)` at every change."""
        self._xbar.listen(self._number, listener)

    def forget(self, listener: Listener) -> None:
        """End an `on_change`."""
        self._xbar.ignore(self._number, listener)
