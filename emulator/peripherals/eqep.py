"""eQEP: quadrature decoder, position counter, unit timer, edge capture, watchdog, interrupts.

Modelled: QSRC 0-3 with XCR, SWAP, QAP, QBP; QPOSCNT with wrap at QPOSMAX in every mode, reset modes PCRM 0-3,
    QPOSINIT by SWI, index and strobe, index and strobe latches, PCEF; unit timer with QPOSLAT and QCLM; capture with
    QCTMR, QCPRD, UPEVNT, COEF, CDEF; watchdog; position compare with shadow; flags and interrupt gating; QPEN as
    software reset; clock gate (`set_clock`).
    Edges of the levels of the pins (a jumper from an ePWM) come one by one, after inversion and QSEL.  Edges of both
    lines in one cycle are a phase error, which trip zones see as TZ4 (`error`).  Index and strobe come from their pins
    as well; CHOICE: in one cycle they act before the edges of the pair.
Not modelled: the sync output (SPSEL, SOEN, PCSPW, PCPOL), index gating (IGATE), the extra edge of a change of SWAP, QAP
    or QBP while the lines are at rest, the quadrature edge that TI's index marker waits for (IEL = 3 latches at the
    index edge itself), input qualification (GPIO QSEL) of edges that come in batches.
Time: an edge is no event.  The wire brings whole batches of edges, and every access that could see them first makes the
    wire move up to now.  QUTMR, QWDTMR and QCTMR are computed when they are read.  Events exist only for a unit
    time-out (UTE) and a watchdog time-out (WDE).  So flags of edges, and their interrupts, appear when the wire moves:
    at the latest at the next access or event.
Sources: TRM eQEP; HDR F2837xS_eqep.h.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.eqep_checks import EQepChecks
from emulator.peripherals.eqep_position import distance, move
from emulator.peripherals.eqep_timers import Capture, EqepWatchdog, UnitTimer
from emulator.registers.core import F
from emulator.registers.eqep import QCAPCTL, QDECCTL, QEPCTL, QEPSTS, QFLG, QPOSCTL, EQepRegs
from emulator.signals import QuadratureWire

_INT: Final = QFLG.INT.mask
_QDF: Final = QEPSTS.QDF.mask
_QCLM: Final = QEPCTL.QCLM.mask
_SOURCES: Final = 0x0FFE
_LATCHED: Final = ("QPOSILAT", "QPOSSLAT", "QPOSLAT", "QFLG", "QEPSTS", "QCTMRLAT", "QCPRDLAT")


def _field(word: int, field: F) -> int:
    return (word & field.mask) >> field.lo


class EQep:
    """One eQEP module.

    `interrupt` is pulsed on the module's PIE line.  `error(on)` is called when QFLG.PHE is set or cleared.
    `unit_period_extra` is added to QUPRD for the length of a unit: CHOICE: 0, so that QUPRD = 2,000,000 is 100 Hz as in
    TI's examples; whether silicon adds 1 is unconfirmed.  `sticky_direction_error` is the CHOICE of `Capture` about a
    change of direction.  `on_blocked()` is called for events while QFLG.INT is set.  It returns whether it has reported
    the routine that left the flag.
    """

    __slots__ = (
        "_capture",
        "_checks",
        "_compare_active",
        "_compare_on",
        "_compare_pending",
        "_control",
        "_error",
        "_flags",
        "_in_error",
        "_index_seen",
        "_interrupt",
        "_maximum",
        "_on",
        "_position",
        "_reversed",
        "_source",
        "_status",
        "_unit",
        "_watchdog",
        "clock",
        "cpu",
        "quadrature",
        "regs",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: EQepRegs, quadrature: QuadratureWire,
                 interrupt: Callable[[], None], *, error: Callable[[bool], None] = lambda _on: None,
                 unit_period_extra: int = 0, sticky_direction_error: bool = False,
                 on_blocked: Callable[[], bool] = lambda: False) -> None:  # fmt: skip
        self.clock = clock
        self.cpu = cpu
        self.regs = regs
        self.quadrature = quadrature
        self._interrupt = interrupt
        self._error, self._in_error = error, False
        registers = regs.registers
        self._position = registers["QPOSCNT"]
        self._maximum = registers["QPOSMAX"]
        self._control = registers["QEPCTL"]
        self._status = registers["QEPSTS"]
        self._flags = registers["QFLG"]
        self._unit = UnitTimer(clock, regs, self._unit_timeout, unit_period_extra)
        # `sync` is read at each call, because the plant sets it after the chip is built.
        self._watchdog = EqepWatchdog(clock, regs, lambda: quadrature.sync(), lambda: self._raise(QFLG.WTO.mask))
        self._capture = Capture(clock, regs, lambda: quadrature.sync(), sticky=sticky_direction_error)
        self._checks = EQepChecks(cpu, regs, quadrature, on_blocked)
        quadrature.moved.connect(self._on_edges)
        quadrature.clashed.connect(self._on_clash)
        self.reset()
        bind = regs.bind
        bind("QPOSCNT", read=self._read_QPOSCNT, write=self._write_QPOSCNT)
        bind("QPOSMAX", write=self._write_QPOSMAX)
        bind("QPOSCMP", write=self._write_QPOSCMP)
        bind("QPOSLAT", read=self._read_QPOSLAT)
        bind("QDECCTL", write=self._write_QDECCTL)
        bind("QEPCTL", write=self._write_QEPCTL)
        bind("QCAPCTL", write=self._write_QCAPCTL)
        bind("QPOSCTL", write=self._write_QPOSCTL)
        bind("QEINT", write=self._write_QEINT)
        bind("QFLG", read=self._read_QFLG)
        bind("QCLR", write=self._write_QCLR)
        bind("QFRC", write=self._write_QFRC)
        bind("QEPSTS", read=self._read_QEPSTS, write=self._write_QEPSTS)

    def reset(self) -> None:
        """Module reset (power-on or SOFTPRES4): every register and all internal state."""
        for part in (self._unit, self._watchdog, self._capture):
            part.run(False)
        self.regs.reset()
        self._on = self._reversed = False
        self._source = 0
        self._compare_on = self._compare_pending = False
        self._compare_active = 0
        self._index_seen = False
        self._tell_error()

    # -- for the world -------------------------------------------------------------------------------------------

    @property
    def captured_at(self) -> int:
        """When the capture unit last measured a period."""
        self.quadrature.sync()
        return self._capture.captured_at

    def set_clock(self, on: bool) -> None:
        """PCLKCR4 switched the module's clock: registers keep their state, counters freeze."""
        self.quadrature.sync()
        self.regs.set_clock(on)
        self._apply()

    def index_edge(self, rising: bool = True) -> None:
        """The index input changed now (`rising` as seen at the pin, before QDECCTL.QIP)."""
        if not self._on:
            return
        self.quadrature.sync()
        rising ^= bool(self.regs.QDECCTL.value & QDECCTL.QIP.mask)
        control = self._control.value
        mode, latch, init = _field(control, QEPCTL.PCRM), _field(control, QEPCTL.IEL), _field(control, QEPCTL.IEI)
        status = self._status.value
        forward = bool(status & _QDF)
        position, start = self._position.value, 0 if forward else self._maximum.value
        flags = 0
        # In PCRM 0 every index latches, whatever IEL says (TRM, reset on index event).
        if rising if mode == 0 else (latch in (1, 3) and rising) or (latch == 2 and not rising):
            self.regs.registers["QPOSILAT"].value = position
            flags |= QFLG.IEL.mask
        if rising:
            first, self._index_seen = not self._index_seen, True
            status &= ~QEPSTS.QDLF.mask
            if forward:
                status |= QEPSTS.QDLF.mask
            if first:
                status = (status | QEPSTS.FIMF.mask) & ~QEPSTS.FIDF.mask | (QEPSTS.FIDF.mask if forward else 0)
            if mode == 0:
                status &= ~QEPSTS.PCEF.mask
                if position not in (0, self._maximum.value):
                    status |= QEPSTS.PCEF.mask
                    flags |= QFLG.PCE.mask
            if mode == 0 or (mode == 2 and first):
                self._position.value = start
            self._status.value = status
        if (init == 2 and rising) or (init == 3 and not rising):
            self._position.value = self.regs.registers["QPOSINIT"].value
        self._raise(flags)

    def index_level(self, level: int) -> None:
        """The pin of the index has changed to `level`."""
        self.index_edge(rising=level == 1)

    def strobe_level(self, level: int) -> None:
        """The pin of the strobe has changed to `level`."""
        self.strobe_edge(rising=level == 1)

    def strobe_edge(self, rising: bool = True) -> None:
        """The strobe input changed now (`rising` as seen at the pin, before QDECCTL.QSP)."""
        if not self._on:
            return
        self.quadrature.sync()
        rising ^= bool(self.regs.QDECCTL.value & QDECCTL.QSP.mask)
        control = self._control.value
        by_direction = rising == bool(self._status.value & _QDF)
        if by_direction if control & QEPCTL.SEL.mask else rising:
            self.regs.registers["QPOSSLAT"].value = self._position.value
            self._raise(QFLG.SEL.mask)
        init = _field(control, QEPCTL.SEI)
        if (init == 2 and rising) or (init == 3 and by_direction):
            self._position.value = self.regs.registers["QPOSINIT"].value

    def phase_error(self) -> None:
        """A and B changed at once: nothing is counted, and QFLG.PHE is set.  A test or the bench injects this fault."""
        if self._on:
            self._raise(QFLG.PHE.mask)
            self._tell_error()

    def _on_clash(self, cycles: int) -> None:
        """Both lines changed at once.  Only the quadrature decoder takes this for an error."""
        if not self._source:
            self.phase_error()
        elif self._on:
            # CHOICE: if A and B change together, they count as two edges in the forward direction.
            self._derive(2, cycles, cycles)

    def _tell_error(self) -> None:
        on = bool(self._flags.value & QFLG.PHE.mask)
        if on != self._in_error:
            self._in_error = on
            self._error(on)

    # -- edges ---------------------------------------------------------------------------------------------------

    def _on_edges(self, edges: int, start: int, end: int) -> None:
        if not self._on:
            return
        if self._source:
            self._derive(edges, start, end)
        else:
            self._count(-edges if self._reversed else edges, start, end)

    def _derive(self, edges: int, start: int, end: int) -> None:
        """QSRC 1-3: the clock is A, the direction is B or fixed.  Each edge is counted singly: the shaft gives both."""
        decoder = self.regs.QDECCTL.value
        step = 1 if edges > 0 else -1
        shaft = self.quadrature.position - edges
        swap = bool(decoder & QDECCTL.SWAP.mask)
        invert_a, invert_b = _field(decoder, QDECCTL.QAP), _field(decoder, QDECCTL.QBP)
        rising_only = decoder & QDECCTL.XCR.mask
        clock_before = self._levels(shaft, swap, invert_a, invert_b)[0]
        for i in range(1, abs(edges) + 1):
            shaft += step
            clock, direction = self._levels(shaft, swap, invert_a, invert_b)
            if clock != clock_before and (clock or not rising_only):
                up = direction if self._source == 1 else self._source == 2
                when = start + (end - start) * i // abs(edges)
                self._count(1 if up else -1, when, when)
            clock_before = clock

    @staticmethod
    def _levels(shaft: int, swap: bool, invert_a: int, invert_b: int) -> tuple[int, int]:
        # A leads B going forward: 00, 10, 11, 01 as (A, B).
        a, b = ((0, 0), (1, 0), (1, 1), (0, 1))[shaft & 3]
        a, b = a ^ invert_a, b ^ invert_b
        return (b, a) if swap else (a, b)

    def _count(self, edges: int, start: int, end: int) -> None:
        forward = edges > 0
        steps = edges if forward else -edges
        status = self._status
        flags = 0
        if forward != bool(status.value & _QDF):
            status.value ^= _QDF
            flags = QFLG.QDC.mask
            self._capture.direction_changed()
        position, maximum = self._position.value, self._maximum.value
        if self._compare_on:
            flags |= self._compare(position, steps, forward, maximum)
        if 0 <= position + edges <= maximum:
            self._position.value = position + edges
        else:
            self._position.value, wrapped = move(position, steps, forward, maximum)
            if wrapped:
                flags |= QFLG.PCO.mask if forward else QFLG.PCU.mask
        if self._capture.running:
            self._capture.edges(steps, start, end)
        self._watchdog.zero = end
        if flags:
            self._raise(flags)

    def _compare(self, position: int, steps: int, forward: bool, maximum: int) -> int:
        """QFLG.PCM and PCR of a movement.  CHOICE: a match is an arrival by counting, never a write or a reset."""
        flags = 0
        shadowed = bool(self.regs.QPOSCTL.value & QPOSCTL.PCSHDW.mask)
        at_match = bool(self.regs.QPOSCTL.value & QPOSCTL.PCLOAD.mask)
        while True:
            match = distance(position, self._compare_active, forward, maximum)
            if not (shadowed and self._compare_pending):
                return flags | (QFLG.PCM.mask if match is not None and match <= steps else 0)
            load = match if at_match else distance(position, 0, forward, maximum)
            if match is not None and match <= steps and (load is None or match <= load):
                flags |= QFLG.PCM.mask
            if load is None or load > steps:
                return flags | (QFLG.PCM.mask if match is not None and match <= steps else 0)
            self._compare_active = self.regs.registers["QPOSCMP"].value
            self._compare_pending = False
            flags |= QFLG.PCR.mask
            if load == steps:
                return flags
            position, steps = move(position, load, forward, maximum)[0], steps - load

    # -- flags and interrupt -------------------------------------------------------------------------------------

    def _raise(self, flags: int) -> None:
        if self._flags.value & _INT and flags & self.regs.QEINT.value & _SOURCES:
            self._checks.event(flags)
        self._flags.value |= flags
        self._gate()

    def _gate(self) -> None:
        """One pulse while QFLG.INT is clear and an enabled flag is set."""
        flags = self._flags.value
        if not flags & _INT and flags & self.regs.QEINT.value & _SOURCES:
            self._flags.value = flags | _INT
            self._interrupt()

    def _read_QPOSLAT(self) -> int:
        self.quadrature.sync()
        self._checks.latch_read()
        return self.regs.registers["QPOSLAT"].value

    def _read_QFLG(self) -> int:
        self.quadrature.sync()
        self._checks.flags_read(self._flags.value)
        return self._flags.value

    def _write_QEINT(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self.regs.QEINT.store(word)
        self._gate()

    def _write_QCLR(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self._flags.value &= ~word
        self._tell_error()
        self._checks.cleared(word)
        self._gate()

    def _write_QFRC(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self._raise(word & _SOURCES)
        self._tell_error()

    def _read_QEPSTS(self) -> int:
        self.quadrature.sync()
        self._capture.count()
        return self._status.value

    def _write_QEPSTS(self, word: int, lanes: int) -> None:
        self._read_QEPSTS()
        self._status.store(word)

    # -- position ------------------------------------------------------------------------------------------------

    def _read_QPOSCNT(self) -> int:
        quadrature = self.quadrature
        quadrature.sync()
        missing = quadrature.missing_a or quadrature.missing_b
        if not self._on or not self._maximum.value or (missing and self._checks.missing):
            self._checks.position_read()
        if not self._control.value & _QCLM:
            self._capture.latch()
        return self._position.value

    def _write_QPOSCNT(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self._position.store(word, lanes)

    def _write_QPOSMAX(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self._maximum.store(word, lanes)

    def _write_QPOSCMP(self, word: int, lanes: int) -> None:
        # CHOICE: QPOSCMP reads back what was written, also while the active value is an older one.
        self.quadrature.sync()
        register = self.regs.registers["QPOSCMP"]
        register.store(word, lanes)
        if self.regs.QPOSCTL.value & QPOSCTL.PCSHDW.mask:
            self._compare_pending = True
        else:
            self._compare_active = register.value

    # -- control -------------------------------------------------------------------------------------------------

    def _write_QDECCTL(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self.regs.QDECCTL.store(word)
        self._source = _field(word, QDECCTL.QSRC)
        # Swapping the lines reverses the direction, and so does inverting one of them.
        turns = _field(word, QDECCTL.SWAP) + _field(word, QDECCTL.QAP) + _field(word, QDECCTL.QBP)
        self._reversed = bool(turns & 1)

    def _write_QEPCTL(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self._control.store(word)
        if word & QEPCTL.SWI.mask:
            self._position.value = self.regs.registers["QPOSINIT"].value
        self._apply()
        if not word & QEPCTL.QPEN.mask:
            for name in _LATCHED:
                self.regs.registers[name].value = 0
            self._index_seen = False
            self._tell_error()

    def _write_QPOSCTL(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        self.regs.QPOSCTL.store(word)
        self._compare_on = bool(word & QPOSCTL.PCE.mask)
        if not word & QPOSCTL.PCSHDW.mask:
            self._compare_active = self.regs.registers["QPOSCMP"].value
            self._compare_pending = False

    def _write_QCAPCTL(self, word: int, lanes: int) -> None:
        self.quadrature.sync()
        register = self.regs.QCAPCTL
        prescalers = QCAPCTL.UPPS.mask | QCAPCTL.CCPS.mask
        if self._capture.running and (word ^ register.value) & prescalers:
            self.cpu.findings.report(
                "eqep-prescaler",
                f"{register.path}: UPPS or CCPS was changed while CEN is set: the period under way is wrong",
                object=register.path, value=word,
            )  # fmt: skip
            # Restart the unit, so that it takes the new prescalers.
            self._capture.run(False)
        register.store(word)
        self._apply()

    def _apply(self) -> None:
        """Start and stop the timers as the control registers and the clock gate now require.

        CHOICE: with QPEN = 0 nothing counts, the timers included ("resets internal operation").
        """
        control = self._control.value
        self._on = on = self.regs.clocked and bool(control & QEPCTL.QPEN.mask)
        self._unit.run(on and bool(control & QEPCTL.UTE.mask))
        self._watchdog.run(on and bool(control & QEPCTL.WDE.mask))
        self._capture.run(on and bool(self.regs.QCAPCTL.value & QCAPCTL.CEN.mask))

    def _unit_timeout(self) -> None:
        self.quadrature.sync()
        self.regs.registers["QPOSLAT"].value = self._position.value
        control = self._control.value
        if control & QEPCTL.QCLM.mask:
            self._capture.latch()
        if _field(control, QEPCTL.PCRM) == 3:
            # CHOICE: QSRC decides where the count starts again (TRM): at the top when it only counts down, else at 0.
            self._position.value = self._maximum.value if self._source == 3 else 0
        self._checks.unit_timeout(self._flags.value)
        self._raise(QFLG.UTO.mask)
