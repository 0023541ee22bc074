"""The DMA: six channels that copy words, one burst for each trigger.

Modelled: bursts, transfers, steps, wraps, active and shadow addresses, words of 16 and 32 bits, one-shot and continuous
mode, RUN, HALT, soft and hard reset; triggers by software and by the modules that are modelled (levels of the SPI FIFOs
too); overflow of a trigger; interrupts at the beginning or end of a transfer and at an overflow; round robin, and high
priority of channel 1; what the DMA can reach through bridges and memories; clock gate.
Not modelled: triggers of modules that are not modelled (selecting one is reported), EMIF, stalls by accesses of the CPU
to the same memory, the emulation halt (there is no debugger).
Time: a burst takes one cycle, and four for each word: the address is output in the first, the word is read in the
second and written in the fourth.  The read takes the value at its end, three cycles after the trigger: an ADCRESULT
that latches in that cycle is read with its old value (ERR, DMA read of stale result).  The return from channel 1 with
high priority takes one cycle.  Each word has two clock events; without a transfer there are none.
CHOICE, because no document at hand says it: PERINTSEL is the channel whose DMACHSRCSEL field counts.  A one-shot
channel keeps the bus until its transfer ends.  A level of a FIFO triggers again at the end of a burst if it is still
active.  With 32 bits an odd burst ends with a whole double word.  Addresses do not move after the last burst of a
transfer.  EALLOW protects against the CPU only.  A soft reset leaves PERINTFLG and OVRFLG.  A channel that lost its
clock continues where it was.  An overflow interrupts only if CHINTE is set too.
CHOICE: only the linker's command file says in which RAM a linked object is, so objects can always be reached.
Sources: TRM DMA; HDR F2837xS_dma.h, F2837xS_Dma_defines.h; ERR ADC: DMA read of stale result; DS memory map.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause, Findings
from emulator.clock import Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.dma_checks import CAUSES, Region, TransferChecks
from emulator.registers.cell import Cell
from emulator.registers.core import ALL
from emulator.registers.dma import DmaClaSrcSelRegs, DmaRegs

CHANNELS: Final = 6
# MODE
CHINTE: Final = 1 << 15
DATASIZE: Final = 1 << 14
CONTINUOUS: Final = 1 << 11
ONESHOT: Final = 1 << 10
CHINTMODE: Final = 1 << 9
PERINTE: Final = 1 << 8
OVRINTE: Final = 1 << 7
PERINTSEL: Final = 0x1F
# CONTROL
OVRFLG: Final = 1 << 14
RUNSTS: Final = 1 << 13
BURSTSTS: Final = 1 << 12
TRANSFERSTS: Final = 1 << 11
PERINTFLG: Final = 1 << 8
ERRCLR: Final = 1 << 7
PERINTCLR: Final = 1 << 4
PERINTFRC: Final = 1 << 3
SOFTRESET: Final = 1 << 2
HALT: Final = 1 << 1
RUN: Final = 1 << 0
# DMACTRL
PRIORITYRESET: Final = 1 << 1
HARDRESET: Final = 1 << 0

#: Cycles from the beginning of a word to its read, whose end samples what stood at its beginning, and from there until
#: the word is written.
READ_AT: Final = 1
WRITE_AFTER: Final = 3
#: Priority of a read: it sees all other changes of its cycle.
LATE: Final = 1
#: The cycle before a burst, and after an interruption by channel 1.
EXTRA: Final = 1

#: Memory that the DMA reaches without a bridge: global shared RAM, results of the ADCs (DS memory map).
REACHED: Final = ((0x0B00, 0x0B80), (0xC000, 0x1C000))
#: Modules behind bridge 1 (ePWM, eCAP, eQEP, DAC, CMPSS, SDFM) and 2 (McBSP, SPI, uPP): addresses, field of SECMSEL.
BRIDGES: Final = ((0x4000, 0x6000, "PF1SEL", 0), (0x6000, 0x7000, "PF2SEL", 2))
#: The value of SECMSEL.PFxSEL while the DMA has the bridge.
DMA_HAS_BRIDGE: Final = 1


def source_names() -> dict[int, str]:
    """Every trigger that a channel can select, by its number in DMACHSRCSEL (HDR F2837xS_Dma_defines.h)."""
    names = {n + 1 + 5 * x: f"ADC{letter}INT{n + 1}" for x, letter in enumerate("ABCD") for n in range(4)}
    names |= {5 + 5 * x: f"ADC{letter}EVT" for x, letter in enumerate("ABCD")}
    names |= {28 + n: f"XINT{n}" for n in range(1, 6)}
    names |= {36 + 2 * n + b: f"EPWM{n + 1}SOC{'AB'[b]}" for n in range(16) for b in range(2)}
    names |= {68 + n: f"TINT{n}" for n in range(3)}
    names |= {71 + n: f"{'MX' if n % 2 == 0 else 'MR'}EVT{'AB'[n // 2]}" for n in range(4)}
    names |= {95 + n: f"SD{n // 4 + 1}FLT{n % 4 + 1}" for n in range(8)}
    names |= {109 + n: f"SPI{'ABC'[n // 2]}{('TX', 'RX')[n % 2]}" for n in range(6)}
    names |= {127 + n: f"CLB{n + 1}INT" for n in range(4)}
    names |= {131 + n: f"USB{('RX', 'TX')[n % 2]}{n // 2 + 1}" for n in range(6)}
    return names


def signed16(word: int) -> int:
    """A 16-bit word in two's complement."""
    return (word & 0xFFFF ^ 0x8000) - 0x8000


class _Channel:
    """One channel: its registers by name, and the word that it is moving."""

    __slots__ = ("cause", "checks", "interrupt", "n", "name", "registers", "selected", "stopping", "word")

    def __init__(
        self, n: int, regs: DmaRegs, interrupt: Callable[[], None], findings: Findings,
        region: Callable[[int], Region | None],
    ) -> None:  # fmt: skip
        self.n, self.name, self.interrupt = n, f"CH{n}", interrupt
        prefix = f"{self.name}."
        self.registers: dict[str, Cell] = {
            name.removeprefix(prefix): cell for name, cell in regs.registers.items() if name.startswith(prefix)
        }
        #: The word that has been read and not yet written.
        self.word = 0
        #: Whether a halt or reset waits for the end of the present word.
        self.stopping = False
        #: The statement that switched the channel on.
        self.cause: Cause | None = None
        #: The statement that gave its field of DMACHSRCSEL the present value.
        self.selected: Cause | None = None
        self.checks = TransferChecks(f"{regs.name}.{self.name}", self.registers, findings, region)

    def value(self, name: str) -> int:
        """The stored word of a register."""
        return self.registers[name].value

    def step(self, side: str, name: str) -> None:
        """Add `name` (`BURST_STEP`, `TRANSFER_STEP`) of `side` (`SRC`, `DST`) to its active address."""
        address = self.registers[f"{side}_ADDR_ACTIVE"]
        address.value = address.value + signed16(self.value(f"{side}_{name}")) & ALL


class Dma:
    """DMA behaviour over its registers.

    `read(address, words)` and `write(address, words, value)` are the bus; a 32-bit register is one access.
    `region(address)` returns the object that the linker has placed there.  `bridges()` returns SECMSEL.  `interrupts`
    are the six pulses to the PIE.  `listen(sources)` is called with the numbers of all triggers that some channel waits
    for, whenever this set changes.  From then on, `trigger` must be called for their events, and `level` for their
    levels; `level_is_active(source)` tells whether a level is active.  `known` are the numbers of all triggers here.
    """

    def __init__(
        self, clock: Clock, cpu: Cpu, regs: DmaRegs, select: DmaClaSrcSelRegs, interrupts: Sequence[Callable[[], None]],
        *, read: Callable[[int, int], int], write: Callable[[int, int, int], None],
        region: Callable[[int], Region | None],
        bridges: Callable[[], int], listen: Callable[[frozenset[int]], None], level_is_active: Callable[[int], bool],
        known: Container[int],
    ) -> None:  # fmt: skip
        """Raises ValueError for a wrong number of interrupts."""
        if len(interrupts) != CHANNELS:
            raise ValueError(f"{regs.name}: {len(interrupts)} interrupts: expected the 6 pulses of the channels")
        self._clock, self._cpu, self._regs, self._select = clock, cpu, regs, select
        self._bus_read, self._bus_write, self._region = read, write, region
        self._bridges, self._listen, self._level_is_active, self._known = bridges, listen, level_is_active, known
        self._names = source_names()
        self._channels = tuple(
            _Channel(n, regs, pulse, cpu.findings, region) for n, pulse in enumerate(interrupts, 1)
        )  # fmt: skip
        #: Channels that move words now and were triggered only by the program.
        self.moving: list[TransferChecks] = []
        #: Trigger -> the channels that wait for it.
        self._channels_of_source: dict[int, list[_Channel]] = {}
        self._status, self._priority = regs.registers["PRIORITYSTAT"], regs.registers["PRIORITYCTRL1"]
        self._locks = select.registers["DMACHSRCSELLOCK"]
        regs.bind("DMACTRL", write=self._write_DMACTRL)
        for channel in self._channels:
            regs.bind(f"{channel.name}.MODE", write=partial(self._write_MODE, channel))
            regs.bind(f"{channel.name}.CONTROL", write=partial(self._write_CONTROL, channel))
            for name in CAUSES:
                regs.bind(f"{channel.name}.{name}", write=partial(channel.checks.write, name))
        for n in (1, 2):
            select.bind(f"DMACHSRCSEL{n}", write=partial(self._write_DMACHSRCSEL, n))
        self._event: ClockEvent | None = None
        #: The cycles that were left of the event when the clock was switched off.
        self._frozen: int | None = None
        self._clocked = regs.clocked
        self.reset()

    def reset(self) -> None:
        """Hard reset: reset the registers, and drop all transfers under way."""
        self._clock.cancel(self._event)
        self._event = self._frozen = None
        self._regs.reset()
        #: The channel that has the bus, and the one that channel 1 took it from in the middle of a burst.
        self._active: _Channel | None = None
        self._held: _Channel | None = None
        #: The channel that was served last in this round; 0: a round begins.
        self._last = 0
        self._round_ends = False
        self.moving.clear()
        for channel in self._channels:
            channel.stopping, channel.cause, channel.checks.moving = False, None, None
        self._configure()

    def set_clock(self, on: bool) -> None:
        """PCLKCR0.DMA switched the clock: off, triggers are not heard and a word on its way stands still."""
        if on == self._clocked:
            return
        self._clocked = on
        event = self._event
        if event is None:
            return
        if not on and event.waits:
            self._frozen = event.time - self._clock.now
            self._clock.cancel(event)
        elif on and self._frozen is not None:
            self._clock.start(event, self._clock.now + self._frozen)
            self._frozen = None

    @property
    def objects(self) -> dict[str, Cause | None]:
        """The objects that transfers began in, each with the statement that gave its address."""
        return {name: cause for channel in self._channels for name, cause in channel.checks.used.items()}

    def selected(self, source: int) -> Cause | None:
        """The statement that gave trigger `source` to a channel that listens to it; None if no channel does."""
        return next((channel.selected for channel in self._channels_of_source.get(source, ())), None)

    # --- triggers ----------------------------------------------------------------------------------------------------

    def trigger(self, source: int) -> None:
        """Trigger `source` (its number in DMACHSRCSEL) has come."""
        for channel in self._channels_of_source.get(source, ()) if self._clocked else ():
            control = channel.registers["CONTROL"]
            if control.value & PERINTFLG:
                self._overflow(channel, control)
            control.value |= PERINTFLG
        self._serve()

    def level(self, source: int) -> None:
        """The level of trigger `source` is active.  A channel with a burst under way reads it again after the burst."""
        for channel in self._channels_of_source.get(source, ()) if self._clocked else ():
            control = channel.registers["CONTROL"]
            if not control.value & BURSTSTS:
                control.value |= PERINTFLG
        self._serve()

    def _overflow(self, channel: _Channel, control: Cell) -> None:
        control.value |= OVRFLG
        mode = channel.value("MODE")
        if mode & OVRINTE and mode & CHINTE:
            channel.interrupt()
        if control.value & RUNSTS:
            path = f"{control.path}.OVRFLG"
            self._cpu.findings.report(
                "data-lost", f"{path}: a trigger came while the one before it waited: one burst is lost", object=path,
                otherwise=channel.cause,
            )  # fmt: skip

    def _source(self, channel: _Channel) -> int:
        """The trigger that a channel waits for; 0: software only."""
        selector = channel.value("MODE") & PERINTSEL
        if not 1 <= selector <= CHANNELS or not channel.value("MODE") & PERINTE:
            return 0
        register = self._select.registers["DMACHSRCSEL1" if selector <= 4 else "DMACHSRCSEL2"]
        return register.value >> 8 * ((selector - 1) % 4) & 0xFF

    def _configure(self) -> None:
        """Follow the registers that assign triggers to channels."""
        channels_of_source: dict[int, list[_Channel]] = {}
        for channel in self._channels:
            source = self._source(channel)
            if source:
                channels_of_source.setdefault(source, []).append(channel)
        changed = channels_of_source.keys() != self._channels_of_source.keys()
        self._channels_of_source = channels_of_source
        if changed:
            self._listen(frozenset(channels_of_source))

    # --- arbitration -------------------------------------------------------------------------------------------------

    def _waits(self, channel: _Channel) -> bool:
        """Whether a channel could use the bus.

        It is on; and it was triggered, or halted within a burst or a one-shot transfer.
        """
        control = channel.value("CONTROL")
        if not control & RUNSTS or channel is self._held:
            return False
        halted = BURSTSTS | TRANSFERSTS if channel.value("MODE") & ONESHOT else BURSTSTS
        return bool(control & (PERINTFLG | halted))

    def _first_has_priority(self) -> bool:
        return bool(self._priority.value & 1)

    def _serve(self) -> None:
        """Give the bus to a channel if it is free and one waits."""
        if self._active is not None or not self._clocked:
            return
        waiting = [channel for channel in self._channels if self._waits(channel)]
        first = self._channels[0]
        if self._first_has_priority() and first in waiting:
            self._take(first, EXTRA)
        elif self._held is not None:
            held, self._held = self._held, None
            self._take(held, EXTRA)
        elif waiting:
            later = [channel for channel in waiting if channel.n > self._last]
            chosen = (later or waiting)[0]
            self._last = chosen.n
            self._take(chosen, EXTRA)
        else:
            self._last = 0
            self._state()

    def _take(self, channel: _Channel, cycles: int) -> None:
        """A burst of `channel` begins, or goes on, after `cycles`."""
        self._active = channel
        self._state()
        control = channel.registers["CONTROL"]
        if not control.value & BURSTSTS:
            self._begin_burst(channel, control)
        self._event = self._clock.after(cycles + READ_AT, self._read, LATE)

    def _begin_burst(self, channel: _Channel, control: Cell) -> None:
        registers, value = channel.registers, channel.value
        control.value = control.value & ~PERINTFLG | BURSTSTS
        registers["BURST_COUNT"].value = value("BURST_SIZE")
        if not control.value & TRANSFERSTS:
            control.value |= TRANSFERSTS
            registers["TRANSFER_COUNT"].value = value("TRANSFER_SIZE")
            for side in ("SRC", "DST"):
                registers[f"{side}_WRAP_COUNT"].value = value(f"{side}_WRAP_SIZE")
                for address in ("ADDR", "BEG_ADDR"):
                    registers[f"{side}_{address}_ACTIVE"].value = value(f"{side}_{address}_SHADOW")
            if value("MODE") & (CHINTE | CHINTMODE) == CHINTE:
                channel.interrupt()
        channel.checks.begins(2 if value("MODE") & DATASIZE else 1, alone=not self._source(channel))
        if channel.checks.moving and channel.checks not in self.moving:
            self.moving.append(channel.checks)

    def _state(self) -> None:
        """Set PRIORITYSTAT: the channel that has the bus, and the channel that channel 1 took it from."""
        active = self._active.n if self._active is not None else 0
        self._status.value = active | (self._held.n if self._held is not None else 0) << 4

    # --- a word ------------------------------------------------------------------------------------------------------

    def _read(self) -> None:
        channel = self._active
        assert channel is not None
        words = 2 if channel.value("MODE") & DATASIZE else 1
        address = channel.value("SRC_ADDR_ACTIVE") & ~(words - 1)
        channel.word = self._access(channel, "SRC", address, words, None)
        self._event = self._clock.after(WRITE_AFTER, self._write)

    def _write(self) -> None:
        channel = self._active
        assert channel is not None
        self._event = None
        words = 2 if channel.value("MODE") & DATASIZE else 1
        address = channel.value("DST_ADDR_ACTIVE") & ~(words - 1)
        self._access(channel, "DST", address, words, channel.word)
        self._advance(channel, words)

    def _advance(self, channel: _Channel, words: int) -> None:
        """A word has been written: go on with the next word or burst, or end the transfer."""
        control, count = channel.registers["CONTROL"], channel.registers["BURST_COUNT"]
        if channel.stopping and not control.value & BURSTSTS:  # a soft reset has waited for the word
            channel.stopping = False
            self._release()
            return
        if count.value >= words:
            count.value -= words
            channel.step("SRC", "BURST_STEP")
            channel.step("DST", "BURST_STEP")
            if channel.stopping:
                channel.stopping = False
                self._release()
            elif self._interrupted(channel):
                self._held = channel
                self._release()
            else:
                self._event = self._clock.after(READ_AT, self._read, LATE)
            return
        count.value = 0
        channel.stopping = False
        self._end_burst(channel, control)

    def _interrupted(self, channel: _Channel) -> bool:
        """Whether channel 1 takes the bus from `channel` within a burst."""
        first = self._channels[0]
        return self._first_has_priority() and channel is not first and self._waits(first)

    def _end_burst(self, channel: _Channel, control: Cell) -> None:
        registers, value, mode = channel.registers, channel.value, channel.value("MODE")
        control.value &= ~BURSTSTS
        left = registers["TRANSFER_COUNT"]
        if left.value:
            left.value -= 1
            for side in ("SRC", "DST"):
                wrap = registers[f"{side}_WRAP_COUNT"]
                if wrap.value:
                    wrap.value -= 1
                    channel.step(side, "TRANSFER_STEP")
                else:
                    wrap.value = value(f"{side}_WRAP_SIZE")
                    begin = registers[f"{side}_BEG_ADDR_ACTIVE"]
                    begin.value = begin.value + signed16(value(f"{side}_WRAP_STEP")) & ALL
                    registers[f"{side}_ADDR_ACTIVE"].value = begin.value
        else:
            control.value &= ~TRANSFERSTS
            if not mode & CONTINUOUS:
                control.value &= ~RUNSTS
            if mode & (CHINTE | CHINTMODE) == CHINTE | CHINTMODE:
                channel.interrupt()
        source = self._source(channel)
        if source and self._level_is_active(source):
            control.value |= PERINTFLG
        if mode & ONESHOT and control.value & TRANSFERSTS and control.value & RUNSTS:
            if self._interrupted(channel):
                # The next burst of the transfer comes when channel 1 is through.
                control.value |= BURSTSTS
                registers["BURST_COUNT"].value = value("BURST_SIZE")
                self._held = channel
            else:
                waits = control.value & PERINTFLG
                self._begin_burst(channel, control)
                control.value |= waits
                self._event = self._clock.after(EXTRA + READ_AT, self._read, LATE)
                return
        self._release()

    def _release(self) -> None:
        """The bus is free."""
        if self._active is not None and self._active.checks.moving:
            self._active.checks.moving = None
            self.moving.remove(self._active.checks)
        self._active = None
        if self._round_ends and self._held is None:
            self._round_ends, self._last = False, 0
        self._serve()

    # --- the bus -----------------------------------------------------------------------------------------------------

    def _access(self, channel: _Channel, side: str, address: int, words: int, value: int | None) -> int:
        """A read (`value` None) or write.  An address that the DMA cannot reach reads 0, and writes there are lost."""
        findings = self._cpu.findings
        findings.cause = channel.cause
        try:
            why = self._unreachable(address)
            if channel.checks.check_object(side, address):
                if why:
                    return 0
            elif why:
                path = f"{self._regs.name}.{channel.name}.{side}_ADDR_ACTIVE"
                findings.report("dma-address", f"{path} = {address:#x}: {why}", object=path, value=address)
                return 0
            if value is None:
                return self._bus_read(address, words)
            self._bus_write(address, words, value)
            return 0
        finally:
            findings.cause = None

    def _unreachable(self, address: int) -> str:
        """Why the DMA cannot reach an address; empty if it can."""
        if self._region(address) is not None or any(low <= address < high for low, high in REACHED):
            return ""
        for low, high, field, shift in BRIDGES:
            if low <= address < high:
                if self._bridges() >> shift & 3 == DMA_HAS_BRIDGE:
                    return ""
                return f"CpuSysRegs.SECMSEL.{field} gives the bridge of that module to the CLA"
        return "no bus leads from the DMA there: it reaches global shared RAM, results of the ADCs, and the bridges"

    # --- register handlers -------------------------------------------------------------------------------------------

    def _write_DMACTRL(self, word: int, lanes: int = ALL) -> None:
        if word & HARDRESET:
            self.reset()
        elif word & PRIORITYRESET:
            if self._active is None:
                self._last = 0
            else:
                self._round_ends = True

    def _write_MODE(self, channel: _Channel, word: int, lanes: int = ALL) -> None:
        channel.registers["MODE"].store(word, lanes)
        channel.checks.configured()
        self._configure()
        self._check_level(channel)

    def _write_DMACHSRCSEL(self, n: int, word: int, lanes: int = ALL) -> None:
        register = self._select.registers[f"DMACHSRCSEL{n}"]
        if self._locks.value & 1 << n - 1:
            self._cpu.findings.report(
                "locked", f"{register.path} is locked by DMACHSRCSELLOCK: the write was dropped",
                object=register.path, value=word,
            )  # fmt: skip
            return
        before = register.value
        register.store(word, lanes)
        for channel in self._channels[4 * (n - 1) : 4 * n]:
            if (register.value ^ before) >> 8 * ((channel.n - 1) % 4) & 0xFF:
                channel.selected = self._cpu.findings.mark()
        self._configure()
        for channel in self._channels:
            self._check_level(channel)

    def _check_level(self, channel: _Channel) -> None:
        """Trigger a channel that begins to wait for a level, if the level is active already."""
        source = self._source(channel)
        if source and self._clocked and self._level_is_active(source) and not channel.value("CONTROL") & BURSTSTS:
            channel.registers["CONTROL"].value |= PERINTFLG
            self._serve()

    def _write_CONTROL(self, channel: _Channel, word: int, lanes: int = ALL) -> None:
        control = channel.registers["CONTROL"]
        if word & SOFTRESET:
            control.value &= ~(RUNSTS | TRANSFERSTS | BURSTSTS)
            for name in ("BURST_COUNT", "TRANSFER_COUNT", "SRC_WRAP_COUNT", "DST_WRAP_COUNT"):
                channel.registers[name].value = 0
            self._stop(channel)
        if word & PERINTCLR:
            control.value &= ~PERINTFLG
        if word & ERRCLR:
            control.value &= ~OVRFLG
        if word & HALT:
            control.value &= ~RUNSTS
            self._stop(channel)
        elif word & RUN:
            self._run(channel, control, alone=not word & PERINTFRC)
        if word & PERINTFRC:
            if channel.value("MODE") & PERINTE:
                control.value |= PERINTFLG
            else:
                path = f"{self._regs.name}.{channel.name}.MODE.PERINTE"
                self._cpu.findings.report(
                    "not-configured", f"{path} = 0: the channel takes no trigger, not even one by PERINTFRC",
                    object=path,
                )  # fmt: skip
        self._check_level(channel)
        self._serve()

    def _stop(self, channel: _Channel) -> None:
        """Stop a channel after its present word."""
        if channel is self._active:
            channel.stopping = True
        elif channel is self._held:
            self._held = None

    def _run(self, channel: _Channel, control: Cell, *, alone: bool) -> None:
        """RUN is set, `alone` without a trigger in the same write."""
        states = RUNSTS | TRANSFERSTS | BURSTSTS | PERINTFLG
        waiting = control.value & states == RUNSTS | TRANSFERSTS
        if alone and waiting and not self._source(channel) and not channel.value("MODE") & ONESHOT:
            channel.checks.started_again(channel.value("TRANSFER_COUNT") + 1)
        if control.value & BURSTSTS:
            channel.stopping = False
        channel.cause = self._cpu.findings.mark()
        control.value |= RUNSTS
        source = self._source(channel)
        if source and source not in self._known:
            path, name = f"{self._regs.name}.{channel.name}.MODE", self._names.get(source, "which is none")
            self._cpu.findings.report(
                "unmodelled", f"{path}: trigger {source} ({name}) is not modelled: it never occurs here",
                object=path, value=source,
            )  # fmt: skip
