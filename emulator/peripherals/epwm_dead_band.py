"""The dead band of an ePWM module.  It lies between the action qualifier and the trip zone.

    A in --+-> S4 -> rising edge delay --> S2 (inverted?) -> S1 (delayed or A in) = A path --> S6 -> output A
           |              |                                                             \\/
           |              v                                                             /\\
    B in --+-> S5 -> S8 -> falling edge delay -> S3 (inverted?) -> S0 (delayed or B in) = B path --> S7 -> output B

    DBCTL     bits   switch
    OUT_MODE  1, 0   S1, S0: 1 delayed, 0 the input itself
    POLSEL    3, 2   S3, S2: 1 inverted
    IN_MODE   5, 4   S5, S4: 1 B in, 0 A in
    OUTSWAP   13, 12 S6: output A has the B path; S7: output B has the A path
    DEDB_MODE 14     S8: the falling edge delay gets what the rising edge delay gives

A delayed edge leaves the dead band DBRED or DBFED periods of TBCLK after the edge of the input.  If the input changes
back before that, the delayed edge never comes ("the falling edge has precedence").
CHOICE: an edge keeps the delay that was active when it began, even if another value is loaded meanwhile.  CHOICE: the
delays start to run when OUT_MODE is set; edges before that are not delayed.  CHOICE: a delay that runs goes on while
TBCLK stands.  CHOICE: with DEDB_MODE set, the A path has the rising edge delay; the manual calls this setting invalid.

Sources: TRM ePWM, dead-band submodule and its figure; HDR F2837xS_epwm.h.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from emulator.registers.epwm_output import DBCTL

_S0: Final = 1 << DBCTL.OUT_MODE.lo
_S1: Final = 2 << DBCTL.OUT_MODE.lo
_S2: Final = 1 << DBCTL.POLSEL.lo
_S3: Final = 2 << DBCTL.POLSEL.lo
_S4: Final = 1 << DBCTL.IN_MODE.lo
_S5: Final = 2 << DBCTL.IN_MODE.lo
_S6: Final = 2 << DBCTL.OUTSWAP.lo
_S7: Final = 1 << DBCTL.OUTSWAP.lo
_S8: Final = DBCTL.DEDB_MODE.mask
#: With none of these set the outputs are the inputs.
_ACTIVE: Final = DBCTL.OUT_MODE.mask | DBCTL.OUTSWAP.mask
#: The bits of DBCTL that decide the path of the signals.  The other bits decide when registers are loaded.
#: CHOICE: only these bits wait in the shadow of DBCTL.
SWITCHES: Final = (
    DBCTL.OUT_MODE.mask | DBCTL.POLSEL.mask | DBCTL.IN_MODE.mask | DBCTL.OUTSWAP.mask | DBCTL.DEDB_MODE.mask
)
#: Levels of A in and B in from a cycle on.
Edge = tuple[int, int, int]


class _Delay:
    """A delay for edges that lead to the level `slow`.  Other edges pass at once."""

    __slots__ = ("_input", "_slow", "cycles", "due", "level")

    def __init__(self, slow: int) -> None:
        self._slow = slow
        #: The delay in cycles of edges that come from now on.
        self.cycles = 0
        self._input = self.level = 0
        #: The cycle when the delayed edge comes out; -1 while none is under way.
        self.due = -1

    def begin(self, level: int) -> None:
        """Start with this level of the input, as if it had always been there."""
        self._input = self.level = level
        self.due = -1

    def feed(self, level: int, now: int) -> None:
        """Set the level of the input from the cycle `now` on."""
        if level == self._input:
            return
        self._input = level
        if level == self._slow and self.cycles and self.level != level:
            self.due = now + self.cycles
        else:
            self.level = level
            self.due = -1

    def pass_to(self, now: int) -> None:
        """Let out an edge that is due by `now`."""
        if 0 <= self.due <= now:
            self.level = self._slow
            self.due = -1

    def like(self, other: _Delay) -> None:
        """Copy the state of another delay."""
        self.cycles, self._input, self.level, self.due = other.cycles, other._input, other.level, other.due


class DeadBand:
    """The two delays and the switches around them.

    Cycles are those of the clock.  `on`: whether the outputs can differ from the inputs.
    """

    __slots__ = ("_a", "_b", "_falling", "_rising", "_switches", "on")

    def __init__(self) -> None:
        self._rising, self._falling = _Delay(1), _Delay(0)
        #: Levels of A in and B in.
        self._a = self._b = 0
        self._switches = 0
        self.on = False

    def configure(self, switches: int, rising_cycles: int, falling_cycles: int, a: int, b: int, now: int) -> None:
        """Set the bits of DBCTL and both delays from cycle `now` on; `a` and `b` are the levels of A in and B in."""
        was, self._switches = self._switches, switches
        self.on = bool(switches & _ACTIVE)
        self._rising.cycles, self._falling.cycles = rising_cycles, falling_cycles
        if switches & DBCTL.OUT_MODE.mask and not was & DBCTL.OUT_MODE.mask:
            self._a, self._b = a, b
            self._rising.begin(b if switches & _S4 else a)
            falling = b if switches & _S5 else a
            self._falling.begin(self._rising.level if switches & _S8 else falling)
        elif self.on:
            self.feed(a, b, now)
            self.pass_to(now)

    def feed(self, a: int, b: int, now: int) -> None:
        """Set the levels of A in and B in from cycle `now` on.  Edges that were due before `now` have left already."""
        self._a, self._b = a, b
        switches = self._switches
        self._rising.feed(b if switches & _S4 else a, now)
        if switches & _S8:
            self._falling.feed(self._rising.level, now)
        else:
            self._falling.feed(b if switches & _S5 else a, now)

    @property
    def due(self) -> int:
        """The cycle when the next delayed edge comes out; -1 if none is under way."""
        rising, falling = self._rising.due, self._falling.due
        if rising < 0 or falling < 0:
            return max(rising, falling)
        return min(rising, falling)

    def pass_to(self, now: int) -> None:
        """Let out every delayed edge that is due."""
        while 0 <= (due := self.due) <= now:
            self._rising.pass_to(due)
            if self._switches & _S8:
                self._falling.feed(self._rising.level, due)
            self._falling.pass_to(due)

    def course(self, edges: Iterator[Edge], until: int) -> Iterator[int]:
        """Run until the cycle `until` with these edges of the inputs.  Yields each cycle when something may change.

        An edge can undo a delayed edge up to the cycle in which this one would come out, that cycle included.
        """
        for time, a, b in edges:
            if time > until:
                break
            while 0 <= (due := self.due) < time:
                self.pass_to(due)
                yield due
            self.feed(a, b, time)
            yield time
        while 0 <= (due := self.due) <= until:
            self.pass_to(due)
            yield due

    def later(self, cycles: int) -> None:
        """Shift all times by `cycles`: the caller has left out whole periods that only repeat."""
        for delay in (self._rising, self._falling):
            if delay.due >= 0:
                delay.due += cycles

    def output(self, index: int) -> int:
        """The level of output A (0) or B (1)."""
        switches = self._switches
        if self.has_rising_path(index):
            return self._rising.level ^ bool(switches & _S2) if switches & _S1 else self._a
        return self._falling.level ^ bool(switches & _S3) if switches & _S0 else self._b

    def source(self, index: int) -> int:
        """The input, A (0) or B (1), that an output follows."""
        switches = self._switches
        if self.has_rising_path(index):
            return int(bool(switches & _S4)) if switches & _S1 else 0
        if not switches & _S0:
            return 1
        return int(bool(switches & (_S4 if switches & _S8 else _S5)))

    def has_rising_path(self, index: int) -> bool:
        """Whether an output comes from the path that delays rising edges."""
        return bool(self._switches & _S7) if index else not self._switches & _S6

    @property
    def memory_cycles(self) -> int:
        """The longest time for which an edge of an input has an effect, in cycles."""
        return self._rising.cycles + self._falling.cycles

    def copy(self) -> DeadBand:
        """A copy in the same state, to compute how it goes on."""
        other = DeadBand()
        other.on, other._switches, other._a, other._b = self.on, self._switches, self._a, self._b
        other._rising.like(self._rising)
        other._falling.like(self._falling)
        return other
