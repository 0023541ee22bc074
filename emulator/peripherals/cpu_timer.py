"""A 32-bit CPU timer with its 16-bit prescaler.

Modelled: TIM, PRD, TDDR, PSC, TSS, TRB, TIF, TIE, the interrupt pulse, the ADC trigger, clock gating; a clock other
than SYSCLK, which timer 2 can have (`set_tick`).
Not modelled: FREE and SOFT (nothing halts).
Time: the prescaler counts SYSCLK down from TDDRH:TDDR, and TIM counts its underflows; the period is (PRD+1)*(TDDR+1)
cycles.  Counters are computed when they are read.  An underflow is a clock event only where it changes something: TIF
is clear, TIE is set, a trigger has a listener, or the program has seen TIF and may see it again.  A caller that knows
that the next interrupts only take CPU time can handle them together (`skip`).
Reported: TIF that is read as 1, and again as 1 after an underflow, without a clear in between (`flag-not-cleared`).
Sources: TRM CPU timers; HDR F2837xS_cputimer.h.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import CYCLES_PER_US, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.registers.core import ALL, LOW
from emulator.registers.cpu_timer import CpuTimerRegs

TIF: Final = 0x8000
TIE: Final = 0x4000
TRB: Final = 0x0020
TSS: Final = 0x0010
#: Who reads TIM so often wants to know a time.
_READS: Final = 3
#: Between the statements that set it up, a timer may run for a moment: TSS is 0 until it is written.
_MOMENT_CYCLES: Final = 10 * CYCLES_PER_US


class CpuTimer:
    """One timer over its registers.  `interrupt` is the pulse of TINT; `trigger` its pulse to the ADC."""

    def __init__(self, clock: Clock, cpu: Cpu, regs: CpuTimerRegs, interrupt: Callable[[], None], *,
                 trigger: Callable[[], None] | None = None, trigger_needs_tie: bool = True) -> None:  # fmt: skip
        """CHOICE: the trigger to the ADC follows TIE (`trigger_needs_tie`); the manual is silent."""
        self._clock, self._cpu, self._regs = clock, cpu, regs
        self._interrupt, self._trigger, self._trigger_needs_tie = interrupt, trigger, trigger_needs_tie
        registers = regs.registers
        self._tim, self._prd, self._tcr = registers["TIM"], registers["PRD"], registers["TCR"]
        self._tpr, self._tprh = registers["TPR"], registers["TPRH"]
        for name, read, write in (
            ("TIM", self._read_TIM, self._write_TIM),
            ("PRD", None, self._write_PRD),
            ("TCR", self._read_TCR, self._write_TCR),
            ("TPR", self._read_TPR, self._write_TPR),
            ("TPRH", self._read_TPRH, self._write_TPRH),
        ):
            regs.bind(name, read=read, write=write, steady=name == "TCR")
        #: The event at `_next_underflow`: a poll of TCR goes on there.
        self._next_check: ClockEvent | None = None
        self._event: ClockEvent | None = None
        #: SYSCLK cycles of one period of the clock that is counted.
        self._tick = 1
        #: The statement that has set the period; None: none.
        self.period_by: Cause | None = None
        #: Whether it has run for the program; when it was started; the times of the first reads of TIM before that.
        self._used = False
        self._started: int | None = None
        self._read_standing: list[int] = []
        #: The statement that has read TIM again and again, of a timer that has never run for the program.
        self.read_in_vain: Cause | None = None
        self.reset()

    def reset(self) -> None:
        """Reset of the device.  CHOICE: the timer runs right away, as TSS resets to 0 (unconfirmed)."""
        self._regs.reset()
        self._psc = 0
        self._since = self._clock.now  # the counters stood at (TIM, PSC) at this time
        #: The first underflow after the read that first saw TIF set.  A read that sees TIF set after that is stale.
        self._next_underflow: int | None = None
        self._clocked = self._regs.clocked
        self._plan()

    def set_clock(self, on: bool) -> None:
        """PCLKCR0 switched the clock: off freezes the counters."""
        self._sync()
        self._clocked = on
        self._plan()

    def set_tick(self, cycles: int) -> None:
        """A period of the clock that is counted has `cycles` SYSCLK cycles from now on.

        CHOICE: the present period of it begins anew.
        """
        if cycles != self._tick:
            self._sync()
            self._psc = (self._psc // self._tick + 1) * cycles - 1
            self._tick = cycles
            self._plan()

    @property
    def period_cycles(self) -> int:
        """SYSCLK cycles between two underflows; 0: the timer stands."""
        return (self._prd.value + 1) * (self._reload() + 1) if self._running() else 0

    # --- counters ----------------------------------------------------------------------------------------------------

    def _running(self) -> bool:
        return self._clocked and not self._tcr.value & TSS

    def _reload(self) -> int:
        """The reload value of the prescaler, in SYSCLK cycles."""
        return (((self._tprh.value & 0xFF) << 8 | self._tpr.value & 0xFF) + 1) * self._tick - 1

    def _sync(self) -> None:
        """Bring TIM and PSC up to now."""
        now = self._clock.now
        elapsed = now - self._since
        self._since = now
        if not elapsed or not self._running():
            return
        if elapsed <= self._psc:
            self._psc -= elapsed
            return
        prescale = self._reload() + 1
        decrements, rest = divmod(elapsed - self._psc - 1, prescale)
        self._psc = prescale - 1 - rest
        decrements += 1
        if decrements <= self._tim.value:
            self._tim.value -= decrements
        else:
            period = self._prd.value + 1
            self._tim.value = period - 1 - (decrements - self._tim.value - 1) % period

    def _plan(self) -> None:
        """Schedule the next underflow, if it changes anything.  The counters must be up to date."""
        self._clock.cancel(self._event)
        self._event = None
        if not self._running():
            return
        tcr = self._tcr.value
        triggers = self._trigger is not None and not self._trigger_needs_tie
        if tcr & TIE or not tcr & TIF or triggers:
            cycles = self._psc + 1 + self._tim.value * (self._reload() + 1)
            self._event = self._clock.after(cycles, self._underflow)

    def _restart(self) -> None:
        """An underflow now: both counters start again from their reload values."""
        clock = self._clock
        self._since = clock.now
        self._psc = prescale = self._reload()
        self._tim.value = period = self._prd.value
        self._tcr.value = tcr = self._tcr.value | TIF
        self._event = None
        if tcr & TIE or (self._trigger is not None and not self._trigger_needs_tie):
            self._event = clock.after((period + 1) * (prescale + 1), self._underflow)

    def _underflow(self) -> None:
        self._restart()
        enabled = self._tcr.value & TIE
        if enabled:
            self._interrupt()
        if self._trigger is not None and (enabled or not self._trigger_needs_tie):
            self._trigger()

    def skip(self, most: int, cycles: int) -> range:
        """Take up to `most` underflows in one step and return when they were (cycles).

        The interrupt of each must do nothing but occupy an idle CPU for `cycles`.  An underflow is taken only if
        nothing else happens for `cycles` after it; none is taken unless the next underflow is the next event.
        Afterwards the clock is at the end of the last interrupt.

        A trigger that starts a conversion ends the step: the clock is at its underflow, and its interrupt is pulsed.
        """
        clock, event = self._clock, self._event
        if event is None or event.time != clock.next or not self._tcr.value & TIE:
            return range(0)
        first = event.time
        period = (self._prd.value + 1) * (self._reload() + 1)
        if cycles >= period:
            return range(0)
        most = min(most, (clock.next_besides(event) - cycles - 1 - first) // period + 1)
        if most <= 0:
            return range(0)
        clock.cancel(event)
        last = first + (most - 1) * period
        trigger = self._trigger
        if trigger is not None:
            following = clock.next
            for at in range(first, last + 1, period):
                clock.now = at
                trigger()
                if clock.next != following or clock.need_attention:
                    self._restart()
                    self._interrupt()
                    return range(first, at, period)
        clock.now = last
        self._restart()
        clock.now = last + cycles
        return range(first, last + 1, period)

    # --- register handlers -------------------------------------------------------------------------------------------

    def _read_TIM(self) -> int:
        self._sync()
        if self._running():
            self._use()
        elif not self._used and self._clock.now not in self._read_standing[-1:] and self.read_in_vain is None:
            self._read_standing.append(self._clock.now)
            if len(self._read_standing) == _READS:
                self.read_in_vain = self._cpu.findings.mark()
        return self._tim.value

    def _use(self) -> None:
        """It runs, or has run, for the program."""
        self._used, self.read_in_vain = True, None

    def _write_TIM(self, word: int, lanes: int = ALL) -> None:
        self._sync()
        self._tim.store(word, lanes)
        self._plan()

    def _write_PRD(self, word: int, lanes: int = ALL) -> None:
        # Takes effect at the next reload.
        self._sync()
        self._prd.store(word, lanes)
        self.period_by = self._cpu.findings.mark()

    def _read_TCR(self) -> int:
        tcr = self._tcr.value
        if not tcr & TIF or not self._running():
            self._next_underflow = None
        elif self._next_underflow is None:
            self._sync()
            self._next_underflow = self._clock.now + self._psc + 1 + self._tim.value * (self._reload() + 1)
            self._clock.cancel(self._next_check)
            self._next_check = self._clock.schedule(self._next_underflow, self._check_again)
        elif self._clock.now >= self._next_underflow:
            path = f"{self._tcr.path}.TIF"
            self._cpu.findings.report(
                "flag-not-cleared",
                f"{path} was read as 1, the timer reached 0 again, and it was read as 1 again without being cleared: "
                "a wait for it passes at once",
                object=path,
            )  # fmt: skip
        return tcr

    def _check_again(self) -> None:
        self._next_check = None

    def _write_TCR(self, word: int, lanes: int = ALL) -> None:
        self._sync()
        running = self._running()
        self._tcr.store(word, lanes & LOW)
        if self._started is not None and self._clock.now - self._started > _MOMENT_CYCLES:
            self._use()
        self._started = None if self._tcr.value & TSS else self._clock.now
        if word & TRB or not self._tcr.value & TIF or self._running() is not running:
            # Else TIF is still the one that was seen: `TCR &= ~TIF` clears nothing.
            self._clock.cancel(self._next_check)
            self._next_check = None
            self._next_underflow = None
        if word & TRB:
            self._tim.value = self._prd.value
            self._psc = self._reload()
        self._plan()

    def _read_TPR(self) -> int:
        self._sync()
        return (self._psc // self._tick & 0xFF) << 8 | self._tpr.value & 0xFF

    def _write_TPR(self, word: int, lanes: int = ALL) -> None:
        self._sync()
        self._tpr.store(word, lanes)
        self._plan()

    def _read_TPRH(self) -> int:
        self._sync()
        return self._psc // self._tick & 0xFF00 | self._tprh.value & 0xFF

    def _write_TPRH(self, word: int, lanes: int = ALL) -> None:
        self._sync()
        self._tprh.store(word, lanes)
        self._plan()
