"""The Input X-BAR: which pin is INPUT4, 5, 6, 13 and 14, the inputs of the external interrupts and of ADCEXTSOC.

Modelled: INPUTxSELECT of those five, INPUTSELECTLOCK, EALLOW (by the register core).  What an input shows is what DAT
of its pin shows: behind inversion and qualification, whatever the function and direction of the pin.
Not modelled: trips of the ePWM (INPUT1 to 3, 6), EXTSYNCIN (INPUT5, 6), eCAP (INPUT7 to 12), the ePWM and Output X-BAR:
selecting a pin for an input that has nothing else is reported, and so is an ePWM set to listen to one.
Time: none; an input changes in the cycle of its pin.
CHOICE: a bit of INPUTSELECTLOCK that is set stays set until reset, and what is written to a locked INPUTxSELECT is
dropped silently, as with the other lock registers of the chip: HDR only names the bits.
CHOICE: selecting a pin of another level, and switching the inversion of a selected one, is an edge for the input: the
manual says nothing of a change on the way.
Sources: DS Input X-BAR (destinations); TRM X-BAR; HDR F2837xS_input_xbar.h.  That qualification lies before it: TI's
example of external interrupts, which qualifies their pins.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from emulator.cpu import Cpu
from emulator.registers.core import ALL
from emulator.registers.input_xbar import InputXbarRegs

Listener = Callable[[int], None]


class InputXbar:
    """The X-BAR over its registers.

    `inputs[n](level)` is told every change of INPUTn.  `follow(pin, listener)` has GPIO tell every change of a pin's
    input, `unfollow` ends it and `level(pin)` reads one; `pins` is how many there are.
    """

    def __init__(
        self,
        cpu: Cpu,
        regs: InputXbarRegs,
        inputs: Mapping[int, Listener],
        *,
        pins: int,
        level: Callable[[int], int],
        follow: Callable[[int, Listener], None],
        unfollow: Callable[[int, Listener], None],
    ) -> None:
        self._cpu, self._regs, self._inputs = cpu, regs, dict(inputs)
        self._pins, self._level, self._follow, self._unfollow = pins, level, follow, unfollow
        self._lock = regs.registers["INPUTSELECTLOCK"]
        for n in range(1, 15):
            regs.bind(f"INPUT{n}SELECT", write=partial(self._write_INPUTxSELECT, n))
        for n, listener in self._inputs.items():
            follow(regs.registers[f"INPUT{n}SELECT"].value, listener)

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
        if n in self._inputs:
            self._choose(self._inputs[n], before, register.value)
        if word >= self._pins:
            self._cpu.findings.report(
                "unmodelled",
                f"{register.path} = {word} is no pin (they are 0 to {self._pins - 1}): what the input shows then "
                "is not modelled, it is low here",
                object=register.path, value=word,
            )  # fmt: skip

    def _choose(self, listener: Listener, before: int, after: int) -> None:
        """Another pin for an input: where its level differs, the input sees an edge."""
        # CHOICE: a pin that does not exist is low.
        was, level = [self._level(pin) if pin < self._pins else 0 for pin in (before, after)]
        if before < self._pins:
            self._unfollow(before, listener)
        if after < self._pins:
            self._follow(after, listener)
        if level != was:
            listener(level)
