"""One eCAP: time stamps of the edges of a pin, or (APWM) a counter with period and compare value.

Modelled: TSCTR at SYSCLK, TSCTRSTOP, CTRPHS loaded by a sync (SWSYNC, and that of the module before in the chain);
    prescaler; polarity of each event, CAPLDEN, CTRRSTn (difference mode), continuous and one-shot with STOP_WRAP and
    REARM; APWM: period, compare value and their shadows, the output with its polarity (`ecap_output.py`); flags,
    gating of the interrupt, ECFRC; clock gate (`set_clock`), module reset.
Not modelled: CTR = PRD as sync-out and the sync-in from an ePWM, the cycles of synchronisation between pin and module.
    Before a program sets anything up, edges set no flag and count for no event: that is while CAPLDEN, CTRRSTn and the
    enables of CEVT1 to 4 are all 0, and ECFLG was not read.
Time: there is an event at an overflow, period or compare match only if its interrupt is enabled or its flag was read (a
    poll continues there); at an edge of an output that has a listener; and one cycle after TSCTR was read.  The module
    listens to the input only while its edges matter: a one-shot that has stopped leaves it at the next write.
CHOICE: with the prescaler n, the input rises with the first n / 2 rising edges of the pin, and falls with the next
    n / 2.  It is low at the start and after a change of PRESCALE.  In APWM mode the input has no effect.
CHOICE: a one-shot is armed out of reset and by every change to continuous.  While it is stopped it gives no event, sets
    no flag and resets no counter.  An event that is reached beyond STOP_WRAP continues up to event 4.
CHOICE: a match is an arrival by counting (a reset to 0 included), never a write or a load.
CHOICE: the output is active while TSCTR < CAP2, also while the counter is stopped.  It is low outside of APWM mode and
    without clock.
CHOICE: CAP3 and CAP4 are loaded at the end of the period in which they were written.  One that was not written after
    CAP1 or CAP2 is not loaded, so that CAP1 may be written before CAP_APWM is set.
Sources: TRM eCAP; HDR F2837xS_ecap.h.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.clock import Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.ecap_output import ApwmOutput
from emulator.registers.core import ALL
from emulator.registers.ecap import ECCTL1, ECCTL2, ECFLG, ECapRegs

TOP: Final = 0xFFFF_FFFF
_INT: Final = ECFLG.INT.mask
_CEVT: Final = ECFLG.CEVT1.mask | ECFLG.CEVT2.mask | ECFLG.CEVT3.mask | ECFLG.CEVT4.mask
_OVF: Final = ECFLG.CTROVF.mask
_PRD: Final = ECFLG.CTR_PRD.mask
_CMP: Final = ECFLG.CTR_CMP.mask
_SOURCES: Final = _CEVT | _OVF | _PRD | _CMP
#: Bits of ECCTL1 that give an event an effect besides its flag.
_ACTING: Final = (
    ECCTL1.CAPLDEN.mask | ECCTL1.CTRRST1.mask | ECCTL1.CTRRST2.mask | ECCTL1.CTRRST3.mask | ECCTL1.CTRRST4.mask
)  # fmt: skip
#: SYNCO_SEL
_PASS: Final = 0
_AT_PERIOD: Final = 1


class ECap:
    """One eCAP module.

    `interrupt` is pulsed on the module's PIE line.  `listen(on)` is called when the module begins (or ceases) to need
    the edges of its input.  `sync_out` is pulsed for the next module of the chain.  `on_blocked` is called for an
    enabled event that ECFLG.INT holds back.
    """

    __slots__ = (
        "_armed",
        "_caps",
        "_clock",
        "_control1",
        "_control2",
        "_counter",
        "_divided",
        "_edges_polled",
        "_enabled",
        "_event",
        "_findings",
        "_flags",
        "_interrupt",
        "_listen",
        "_listening",
        "_next",
        "_next_check",
        "_on_blocked",
        "_polled",
        "_regs",
        "_rises",
        "_shadows",
        "_since",
        "_sync_out",
        "captured_at",
        "cleared_in_vain",
        "output",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: ECapRegs, interrupt: Callable[[], None], *,
                 listen: Callable[[bool], None] = lambda _on: None,
                 sync_out: Callable[[], None] = lambda: None,
                 on_blocked: Callable[[], object] = lambda: None) -> None:  # fmt: skip
        self._clock, self._findings, self._regs = clock, cpu.findings, regs
        self._interrupt, self._listen, self._sync_out, self._on_blocked = interrupt, listen, sync_out, on_blocked
        registers = regs.registers
        self._counter = registers["TSCTR"]
        self._caps = [registers[f"CAP{n}"] for n in range(1, 5)]
        self._control1, self._control2 = registers["ECCTL1"], registers["ECCTL2"]
        self._enabled, self._flags = registers["ECEINT"], registers["ECFLG"]
        self._listening = False
        #: When an edge last loaded CAP1 to CAP4; 0: never.
        self.captured_at = 0
        self._event: ClockEvent | None = None
        self._next_check: ClockEvent | None = None
        #: ECAPn.OUT
        self.output = ApwmOutput(self._output_level, self._plan)
        self.reset()
        bind = regs.bind
        bind("TSCTR", read=self._read_TSCTR, write=self._write_TSCTR)
        for n in range(4):
            bind(f"CAP{n + 1}", read=partial(self._read_CAPx, n), write=partial(self._write_CAPx, n))
        bind("ECCTL1", write=self._write_ECCTL1)
        bind("ECCTL2", write=self._write_ECCTL2)
        bind("ECEINT", write=self._write_ECEINT)
        bind("ECFLG", read=self._read_ECFLG, steady=True)
        bind("ECCLR", write=self._write_ECCLR)
        bind("ECFRC", write=self._write_ECFRC)

    def reset(self) -> None:
        """Module reset (power-on or SOFTPRES3): every register and all internal state."""
        self._clock.cancel(self._next_check)
        self._next_check = None
        self._regs.reset()
        #: TSCTR and the flags of counting are up to date for this cycle.
        self._since = self._clock.now
        #: The number of the next event less 1, unless a one-shot has stopped.
        self._next, self._armed = 0, True
        #: After the prescaler: the level, and the rising edges of the pin since the level changed.
        self._divided = self._rises = 0
        #: Shadows of APWM mode that wait to be loaded: bit 0 the period, bit 1 the compare value.
        self._shadows = 0
        #: Whether ECFLG was read, maybe by a poll: since the last event; and at any time in capture mode.
        self._polled = self._edges_polled = False
        #: How often the program cleared flags of a one-shot that has stopped, none of which was set.
        self.cleared_in_vain = 0
        self._apply()

    # -- for the world -------------------------------------------------------------------------------------------

    @property
    def stopped(self) -> bool:
        """Whether a one-shot has stopped after its last event."""
        return not self._armed

    def set_clock(self, on: bool) -> None:
        """PCLKCR3 switched the module's clock: registers keep their state, the counter stands."""
        self._catch_up()
        self._regs.set_clock(on)
        self._apply()

    def sync_in(self) -> None:
        """A sync pulse from the module before."""
        if not self._regs.clocked:
            return
        control = self._control2.value
        if control & ECCTL2.SYNCI_EN.mask:
            self._catch_up()
            self._counter.value = self._regs.registers["CTRPHS"].value
            self._plan()
        if (control & ECCTL2.SYNCO_SEL.mask) >> ECCTL2.SYNCO_SEL.lo == _PASS:
            self._sync_out()

    def edge(self, level: int) -> None:
        """The input has changed to `level`."""
        control = self._control1.value
        half = (control & ECCTL1.PRESCALE.mask) >> ECCTL1.PRESCALE.lo
        if half:
            self._rises += level
            if not level or self._rises < half:
                return
            self._rises = 0
            self._divided = level = self._divided ^ 1
        n = self._next
        falling, resets = control >> 2 * n & 1, control >> 2 * n & 2
        if level == falling or not self._armed:
            return
        self._catch_up()
        if control & ECCTL1.CAPLDEN.mask:
            self._caps[n].value = self._counter.value
            self.captured_at = self._clock.now
        control2 = self._control2.value
        if n == (control2 & ECCTL2.STOP_WRAP.mask) >> ECCTL2.STOP_WRAP.lo:
            self._next = 0
            self._armed = not control2 & ECCTL2.CONT_ONESHT.mask
        else:
            self._next = n + 1 & 3
        self._raise(ECFLG.CEVT1.mask << n)
        if resets:
            # An overflow that was planned now comes too early.  It finds no overflow, and plans anew.
            self._counter.value = 0

    # -- counter -------------------------------------------------------------------------------------------------

    @property
    def _runs(self) -> bool:
        return self._regs.clocked and bool(self._control2.value & ECCTL2.TSCTRSTOP.mask)

    @property
    def _apwm(self) -> bool:
        return bool(self._control2.value & ECCTL2.CAP_APWM.mask)

    def _catch_up(self) -> None:
        """Count up to now, with the flags that this sets."""
        ticks = self._clock.now - self._since
        self._since = self._clock.now
        if not ticks or not self._runs:
            return
        if self._apwm:
            flags = self._count_periods(ticks)
        else:
            count = self._counter.value + ticks
            self._counter.value = count & TOP
            flags = _OVF if count > TOP else 0
        if flags & ~self._flags.value:
            self._raise(flags)

    def _count_periods(self, ticks: int) -> int:
        """Count in APWM mode: back to 0 after the period, or after all ones from beyond it."""
        count, flags = self._counter.value, 0
        period, compare = self._caps[0].value, self._caps[1].value
        while True:
            top = period if count <= period else TOP
            reached = min(count + ticks, top)
            flags |= (_PRD if count < period <= reached else 0) | (_CMP if count < compare <= reached else 0)
            ticks -= reached - count
            count = reached
            if not ticks:
                break
            ticks -= 1
            flags |= _OVF if top == TOP else 0
            if count == period:
                self._load_shadows()
                period, compare = self._caps[0].value, self._caps[1].value
            count = 0
            flags |= (0 if period else _PRD) | (0 if compare else _CMP)
            # Whole periods at once, unless the next one ends with a load.
            whole, rest = divmod(ticks, period + 1)
            if whole and not self._shadows:
                ticks = rest
                flags |= _PRD | (_CMP if compare <= period else 0) | (_OVF if period == TOP else 0)
        self._counter.value = count
        return flags

    def _load_shadows(self) -> None:
        for n in range(2):
            if self._shadows >> n & 1:
                self._caps[n].value = self._caps[n + 2].value
        self._shadows = 0

    def _plan(self) -> None:
        """Schedule an event at the counter's next flag or edge that is waited for, or earlier on the way to it."""
        self._clock.cancel(self._event)
        self._event = None
        if self.output.has_listeners:
            self.output.report_level()
        if self._event is None and self._runs:  # a listener may have written to the module
            ticks = self._until_flag()
            if self.output.has_listeners and self._apwm:
                edge = self._until_edge()
                ticks = edge if ticks == 0 else min(ticks, edge or ticks)
            if ticks:
                self._event = self._clock.after(ticks, self._due)

    def _until_flag(self) -> int:
        """Ticks to a flag that is waited for, or to the end of the period; 0: there is none."""
        wanted = (_SOURCES if self._polled else self._enabled.value) & ~self._flags.value
        if not wanted & (_OVF | _PRD | _CMP):
            return 0
        count = self._counter.value
        if not self._apwm:
            return TOP + 1 - count if wanted & _OVF else 0
        period, compare = self._caps[0].value, self._caps[1].value
        top = period if count <= period else TOP
        if not wanted & (_PRD | _CMP) and top != TOP and not self._shadows:
            return 0
        ticks = top + 1 - count
        if wanted & _PRD and count < period:
            ticks = period - count
        if wanted & _CMP and count < compare <= top:
            ticks = min(ticks, compare - count)
        return ticks

    def _until_edge(self) -> int:
        """The ticks to the next edge of the output, or to the end of the period if that loads; 0: there is none."""
        count, period, compare = self._counter.value, self._caps[0].value, self._caps[1].value
        top = period if count <= period else TOP
        if count < compare <= top:
            return compare - count
        return top + 1 - count if self._shadows or count >= compare > 0 else 0

    def _output_level(self) -> int:
        self._catch_up()
        if not self._apwm or not self._regs.clocked:
            return 0
        active = self._counter.value < self._caps[1].value
        return int(active != bool(self._control2.value & ECCTL2.APWMPOL.mask))

    def _due(self) -> None:
        self._event = None
        self._polled = False
        self._catch_up()
        self._plan()

    def _apply(self) -> None:
        """Listen to the input, and schedule the next event, as the registers and the clock gate now require."""
        control = self._control1.value
        set_up = control & _ACTING or self._enabled.value & _CEVT or self._edges_polled
        # The prescaler goes on while a one-shot has stopped.
        goes_on = self._armed or control & ECCTL1.PRESCALE.mask
        matters = bool(self._regs.clocked and not self._apwm and set_up and goes_on)
        if matters != self._listening:
            self._listening = matters
            self._listen(matters)
        self._plan()

    def _read_TSCTR(self) -> int:
        self._catch_up()
        if self._next_check is None and self._runs:
            # A poll of the counter goes on a cycle later.
            self._next_check = self._clock.after(1, self._check_again)
        return self._counter.value

    def _check_again(self) -> None:
        self._next_check = None

    def _write_TSCTR(self, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        self._counter.store(word, lanes)
        self._plan()

    def _read_CAPx(self, n: int) -> int:
        self._catch_up()
        return self._caps[n].value

    def _write_CAPx(self, n: int, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        self._caps[n].store(word, lanes)
        if self._apwm:
            if n >= 2:
                self._shadows |= 1 << n - 2
            else:
                # A shadow that waits is now the same value.
                self._caps[n + 2].value = self._caps[n].value
        self._plan()

    # -- control -------------------------------------------------------------------------------------------------

    def _write_ECCTL1(self, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        if (word ^ self._control1.value) & ECCTL1.PRESCALE.mask:
            self._divided = self._rises = 0
        self._control1.store(word, lanes)
        self._apply()

    def _write_ECCTL2(self, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        before = self._control2.value
        self._control2.store(word, lanes)
        sync_out = (word & ECCTL2.SYNCO_SEL.mask) >> ECCTL2.SYNCO_SEL.lo
        if sync_out == _AT_PERIOD and (word ^ before) & ECCTL2.SYNCO_SEL.mask:
            path = f"{self._control2.path}.SYNCO_SEL"
            self._findings.report(
                "unmodelled", f"{path} = 1 (CTR = PRD is the sync-out) is not modelled: it synchronises no module",
                object=path, value=sync_out,
            )  # fmt: skip
        if word & ECCTL2.REARM.mask:
            self._next, self._armed = 0, True
        elif not word & ECCTL2.CONT_ONESHT.mask:
            self._armed = True
        if not word & ECCTL2.CAP_APWM.mask:
            self._shadows = 0
        if word & ECCTL2.SWSYNC.mask:
            self.sync_in()
        self._apply()

    # -- flags and interrupt -------------------------------------------------------------------------------------

    def _raise(self, flags: int) -> None:
        if self._flags.value & _INT and flags & self._enabled.value:
            self._on_blocked()
        self._flags.value |= flags
        self._gate()

    def _gate(self) -> None:
        """One pulse while ECFLG.INT is clear and an enabled flag is set."""
        flags = self._flags.value
        if not flags & _INT and flags & self._enabled.value & _SOURCES:
            self._flags.value = flags | _INT
            self._interrupt()

    def _write_ECEINT(self, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        self._enabled.store(word, lanes)
        self._gate()
        self._apply()

    def _read_ECFLG(self) -> int:
        self._catch_up()
        if not self._polled:
            self._polled = True
            self._edges_polled = self._edges_polled or not self._apwm
            self._apply()
        return self._flags.value

    def _write_ECCLR(self, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        if not self._armed and not self._flags.value & word:
            self.cleared_in_vain += 1
        self._flags.value &= ~word
        self._gate()
        self._apply()

    def _write_ECFRC(self, word: int, lanes: int = ALL) -> None:
        self._catch_up()
        self._raise(word & _SOURCES)
        self._plan()
