"""The action qualifier of an ePWM module.  It computes the waveform and its exact duty from compare values and actions.

In one period, at most six events set, clear or toggle an output.  If several events happen in one TBCLK, the event with
the highest priority wins.  An event whose action is "nothing" is ignored.

    up         PRD > CBU > CAU > ZRO
    down       ZRO > CBD > CAD > PRD
    up-down    CBU > CAU > ZRO while counting up, CBD > CAD > PRD > CBU > CAU at CTR = TBPRD, CBD > CAD counting down

In up-down mode, a compare value at or above TBPRD causes both its up event and its down event at CTR = TBPRD.  A value
of 0 causes no down event, because at 0 the counter counts up already.  In down mode, a compare value at or above TBPRD
causes its event at TBPRD.  In up mode, a compare value above TBPRD causes no event.

Sources: TRM ePWM, action-qualifier event priority, behaviour for compare values greater than the period.  CHOICE: the
priority at CTR = TBPRD in up-down mode is that of a decrementing counter (unconfirmed).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from emulator.peripherals.epwm_time_base import DOWN, UP, UP_DOWN
from emulator.registers.epwm import AQCTLA

CLEAR: Final = 1
SET: Final = 2
TOGGLE: Final = 3

Phases = tuple[int, ...]


def event_phases(mode: int, period: int, compare_a: int, compare_b: int) -> dict[str, Phases]:
    """The phases of the time base at which each event happens; the event of the lowest priority comes first."""
    if mode == UP:
        return {
            "ZRO": (0,),
            "CAU": (compare_a,) if compare_a <= period else (),
            "CBU": (compare_b,) if compare_b <= period else (),
            "PRD": (period,),
            "CAD": (),
            "CBD": (),
        }
    if mode == DOWN:
        return {
            "PRD": (0,),
            "CAD": (max(period - compare_a, 0),),
            "CBD": (max(period - compare_b, 0),),
            "ZRO": (period,),
            "CAU": (),
            "CBU": (),
        }
    if mode == UP_DOWN:
        a, b = min(compare_a, period), min(compare_b, period)
        return {
            "ZRO": (0,),
            "CAU": (a,),
            "CBU": (b,),
            "PRD": (period,) if period else (0,),
            "CAD": (2 * period - a,) if a else (),
            "CBD": (2 * period - b,) if b else (),
        }
    return {}


#: The bit position of each event's action in AQCTLA and AQCTLB.
_SHIFT: Final = {name: field.lo for name, field in AQCTLA.fields.items()}
#: The bits of AQCTLA and AQCTLB that assign an action to an event of CMPA or CMPB.
USES_COMPARE_A: Final = AQCTLA.CAU.mask | AQCTLA.CAD.mask
USES_COMPARE_B: Final = AQCTLA.CBU.mask | AQCTLA.CBD.mask


def act(action: int, level: int) -> int:
    """The level after an action: 0 is nothing, 1 is clear, 2 is set, 3 is toggle."""
    if action == TOGGLE:
        return 1 - level
    return action - 1 if action else level


class OutputWaveform:
    """One period of an output: the actions and their phases."""

    __slots__ = ("_actions", "_end", "_fixed", "_toggles", "length")

    def __init__(self, phases: dict[str, Phases], length: int, control: int) -> None:
        """`control` is the active AQCTLA or AQCTLB, `length` the period in TBCLK."""
        by_phase: dict[int, int] = {}
        if control:
            for name, at in phases.items():
                action = control >> _SHIFT[name] & 3
                if action:
                    for phase in at:
                        by_phase[phase] = action
        self.length = length
        self._actions = sorted(by_phase.items())
        self._toggles = 0
        #: The level at the end of a period that begins low.  If some event sets or clears, it is that of every period.
        self._end = 0
        for _, action in self._actions:
            self._end = act(action, self._end)
            self._toggles += action == TOGGLE
        #: Whether some event sets or clears the output, so that its former level does not matter.
        self._fixed = self._toggles < len(by_phase)

    def action_at(self, phase: int) -> int:
        """The action that wins at `phase`; 0 if there is none."""
        for at, action in self._actions:
            if at == phase:
                return action
        return 0

    def level_after(self, level: int, phase: int, arrivals: int) -> int:
        """The level after the counter arrived at the `arrivals` phases that follow `phase`."""
        if not self._actions:
            return level
        length = self.length
        if self._fixed and arrivals >= length:
            return self._walk(self._end, -1, (phase + arrivals) % length)
        whole, rest = divmod(arrivals, length)
        if self._toggles & whole & 1 and not self._fixed:
            level = 1 - level
        last = phase + rest
        level = self._walk(level, phase, last)
        return self._walk(level, -1, last - length) if last >= length else level

    def next_change(self, level: int, phase: int) -> int:
        """The number of arrivals after `phase` until an output with this level changes; 0 if it never does."""
        for at, action in self._actions:
            if at > phase and act(action, level) != level:
                return at - phase
        for at, action in self._actions:
            if at <= phase and act(action, level) != level:
                return at - phase + self.length
        return 0

    @property
    def alternates(self) -> bool:
        """Whether each period is the inverse of the one before."""
        return not self._fixed and bool(self._toggles & 1)

    def _walk(self, level: int, after: int, until: int) -> int:
        for at, action in self._actions:
            if after < at <= until:
                level = act(action, level)
        return level

    def high_time(self, level: int, phase: int) -> tuple[int, int]:
        """(periods of TBCLK high, periods of TBCLK in all) of the steady waveform, if the output is `level` at `phase`.

        If an output is only toggled, an odd number of times in a period, it repeats after two periods.  The second is
        the inverse of the first.
        """
        length = self.length
        if self._fixed:
            level = self._end
        elif self._toggles & 1:
            return length, 2 * length
        else:
            level = self._walk(level, phase, length)
        high = last = 0
        for at, action in self._actions:
            high += level * (at - last)
            last = at
            level = act(action, level)
        return high + level * (length - last), length


@lru_cache(maxsize=1024)
def waveform(mode: int, period: int, length: int, compare_a: int, compare_b: int, control: int) -> OutputWaveform:
    """The waveform of a time base.  It is cached, because a controller uses the same few hundred duties again."""
    return OutputWaveform(event_phases(mode, period, compare_a, compare_b), length, control)
