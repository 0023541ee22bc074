"""The four post-processing blocks (PPB) of an ADC module: they change results, and raise events.

Each block watches the SOC in its CONFIG; out of reset all four watch SOC0.

Modelled: the offset correction of ADCRESULT, with saturation (if several blocks have one SOC, the highest number
counts); the difference from a reference and its negative, sign-extended; high and low limit and zero crossing with
their flags; ADCxEVT, which comes again only after its flag is cleared; REQSTAMP and DLYSTAMP.
Not modelled: events to the trip zones of the ePWM (ADCEVTSEL: setting it is reported).
Time: none of its own.  The result of a block latches with the ADCRESULT; flags and interrupt come with the EOC.
CHOICE: a result of 0 counts as positive for the zero crossing.  An ADCINT that triggers a SOC gives a stamp as a
hardware trigger does.
CHOICE: until a program accesses a block, its result and its flags are those of the last result of SOC0.
Reported: a limit that is compared with a signed result, which this silicon does wrong (ERR); and an OFFCAL that
another block of the same SOC overrides (`not-configured`).
Sources: TRM ADC, post-processing blocks; HDR F2837xS_adc.h; ERR ADC post-processing block limit compare.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.registers.cell import Cell
from emulator.registers.core import ALL

# ADCPPBxCONFIG
TWOSCOMPEN: Final = 0x10
# The events of block 1 in ADCEVTSTAT, ADCEVTCLR, ADCEVTSEL, ADCEVTINTSEL; those of block x lie 4 (x - 1) bits higher
TRIPHI: Final = 1
TRIPLO: Final = 2
ZERO: Final = 4
#: ADCPPBxTRIPLO: where REQSTAMP begins.
REQSTAMP_SHIFT: Final = 20


def signed(word: int, bits: int) -> int:
    """The low `bits` of a word as a number in two's complement."""
    return (word & (1 << bits) - 1 ^ 1 << bits - 1) - (1 << bits - 1)


class _Block:
    """One block: its registers, and its result while that has not latched."""

    __slots__ = ("before", "config", "latched_at", "number", "offcal", "offref", "result", "stamp", "triphi", "triplo")

    def __init__(self, number: int, regs: AdcRegs, results: AdcResultRegs) -> None:
        registers, name = regs.registers, f"ADCPPB{number}"
        self.number = number
        self.config, self.stamp = registers[f"{name}CONFIG"], registers[f"{name}STAMP"]
        self.offcal, self.offref = registers[f"{name}OFFCAL"], registers[f"{name}OFFREF"]
        self.triphi, self.triplo = registers[f"{name}TRIPHI"], registers[f"{name}TRIPLO"]
        self.result: Cell = results.registers[f"{name}RESULT"]
        #: The value that the result register shows until `latched_at`.
        self.before = self.latched_at = 0


class PostProcessing:
    """PPB1..4 of one ADC; `event` is the pulse of ADCxEVT to the PIE.

    `woken` is called when a block is touched for the first time since reset: from then on each result has to pass
    `process`.  `soc0()` is the last result of SOC0.
    """

    __slots__ = (
        "_blocks",
        "_clock",
        "_cpu",
        "_enabled",
        "_event",
        "_flags",
        "_set_by",
        "_soc0",
        "_stamped",
        "_woken",
        "in_use",
        "watched",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: AdcRegs, results: AdcResultRegs, event: Callable[[], None],
                 woken: Callable[[], None], soc0: Callable[[], int]) -> None:  # fmt: skip
        self._clock, self._cpu, self._event = clock, cpu, event
        self._woken, self._soc0 = woken, soc0
        self._blocks = tuple(_Block(number, regs, results) for number in (1, 2, 3, 4))
        #: Register -> the statement that wrote it.  Findings about a setting are reported there.
        self._set_by: dict[Cell, Cause | None] = {}
        self._flags, self._enabled = regs.registers["ADCEVTSTAT"], regs.registers["ADCEVTINTSEL"]
        for block in self._blocks:
            for register in (block.config, block.offcal, block.offref, block.triphi):
                regs.bind(register.name, write=partial(self._write, register))
            regs.bind(block.triplo.name, read=partial(self._read, block.triplo),
                      write=partial(self._write, block.triplo))  # fmt: skip
            regs.bind(block.stamp.name, read=partial(self._read, block.stamp))
            results.bind(block.result.name, read=partial(self._read_ADCPPBxRESULT, block))
        regs.bind("ADCEVTSTAT", read=partial(self._read, self._flags))
        regs.bind("ADCEVTCLR", write=self._write_ADCEVTCLR)
        regs.bind("ADCEVTINTSEL", write=partial(self._write, self._enabled))
        self.reset()

    def reset(self) -> None:
        """Reset the state; the owner has reset the registers."""
        #: Whether results have to pass `process`.
        self.in_use = False
        #: The blocks that get delay stamps: one, as long as all have the same.
        self._stamped = self._blocks[:1]
        #: The SOCs that some block watches.
        self.watched = 1
        for block in self._blocks:
            block.before = block.latched_at = 0

    def freeze(self, cycles: int) -> None:
        """The module's clock stood still for `cycles`."""
        for block in self._blocks:
            block.latched_at += cycles

    # --- delay stamps ------------------------------------------------------------------------------------------------

    def requested(self, socs: int, counter: int) -> None:
        """Hardware triggers some of the watched SOCs while FREECOUNT is `counter`."""
        for block in self._stamped:
            if socs >> (block.config.value & 0xF) & 1:
                triplo = block.triplo
                triplo.value = triplo.value & (1 << REQSTAMP_SHIFT) - 1 | counter << REQSTAMP_SHIFT

    def begins(self, soc: int, counter: int) -> None:
        """The window of a SOC that hardware has triggered opens at FREECOUNT `counter`."""
        for block in self._stamped:
            if block.config.value & 0xF == soc:
                block.stamp.value = counter - (block.triplo.value >> REQSTAMP_SHIFT) & 0xFFF

    # --- results -----------------------------------------------------------------------------------------------------

    def process(self, soc: int, code: int, full_scale: int, latch_at: int) -> int:
        """The value of ADCRESULT for the `code` of a conversion that ends now.  Each block of the SOC processes it."""
        blocks = [block for block in self._blocks if block.config.value & 0xF == soc]
        if blocks:
            offset = blocks[-1].offcal.value
            for block in blocks:
                if block.offcal.value not in (0, offset):
                    self._overridden(block, blocks[-1])
            code = max(0, min(code - signed(offset, 10), full_scale - 1))
        rising = 0
        for block in blocks:
            rising |= self._post_process(block, code, full_scale, latch_at)
        if rising & self._enabled.value:
            self._event()
        return code

    def _post_process(self, block: _Block, code: int, full_scale: int, latch_at: int) -> int:
        """Result and events of one block; returns the flags that rise."""
        bits = 13 if full_scale == 4096 else 17
        error = code - (block.offref.value & 0xFFFF)
        if block.config.value & TWOSCOMPEN:
            error = -error
        before = signed(block.result.value, 32)
        block.before, block.latched_at = block.result.value, latch_at
        block.result.value = error & ALL
        compared = signed(error, bits)
        events = ZERO if (error < 0) != (before < 0) else 0
        if compared > signed(block.triphi.value, bits):
            events |= TRIPHI
        if compared < signed(block.triplo.value, bits):
            events |= TRIPLO
        shift = 4 * (block.number - 1)
        if error < 0 and self._enabled.value >> shift & (TRIPHI | TRIPLO):
            self._signed_limit(block, error)
        flags = self._flags
        rising = events << shift & ~flags.value
        flags.value |= rising
        return rising

    def _overridden(self, block: _Block, last: _Block) -> None:
        lost, soc = block.offcal, block.config.value & 0xF
        self._cpu.findings.report(
            "not-configured",
            f"{lost.path} = {signed(lost.value, 10)} has no effect: PPB{last.number} has SOC{soc} too, and the OFFCAL "
            f"of the highest block is used, which is {signed(last.offcal.value, 10)}",
            object=lost.path, value=lost.value, cause=self._set_by.get(lost),
        )  # fmt: skip

    def _signed_limit(self, block: _Block, error: int) -> None:
        path = block.result.path
        setting = block.config if block.config.value & TWOSCOMPEN else block.offref
        self._cpu.findings.report(
            "adc-limit-signed",
            f"{path} is {error}, and the limits of PPB{block.number} do not compare signed results on this silicon: "
            "leave ADCPPBxOFFREF at 0 and TWOSCOMPEN off where TRIPHI or TRIPLO interrupt",
            object=path, value=error, cause=self._set_by.get(setting),
        )  # fmt: skip

    # --- register handlers -------------------------------------------------------------------------------------------

    def _wake(self) -> None:
        """Process every result from now on.  The last result of SOC0 is processed now, with the reset settings."""
        self.in_use = True
        self._woken()
        result, first = self._soc0(), self._blocks[0]
        self._stamped = self._blocks
        for block in self._blocks:
            block.stamp.value, block.triplo.value = first.stamp.value, first.triplo.value
            block.result.value = block.before = result
            if result:
                self._flags.value |= TRIPHI << 4 * (block.number - 1)

    def _write(self, register: Cell, word: int, lanes: int = ALL) -> None:
        if not self.in_use:
            self._wake()
        register.store(word, lanes)
        self._set_by[register] = self._cpu.findings.mark()
        self.watched = 0
        for block in self._blocks:
            self.watched |= 1 << (block.config.value & 0xF)

    def _read_ADCPPBxRESULT(self, block: _Block) -> int:
        if not self.in_use:
            self._wake()
        return block.before if self._clock.now < block.latched_at else block.result.value

    def _read(self, register: Cell) -> int:
        if not self.in_use:
            self._wake()
        return register.value

    def _write_ADCEVTCLR(self, word: int, lanes: int = ALL) -> None:
        if not self.in_use:
            self._wake()
        self._flags.value &= ~word
