"""The two outputs of an ePWM module: from the action qualifier through dead band and trip zone to the wires.

Part of `epwm.py`.  A wire always has the duty.  The level is computed on demand, and edges exist only while a listener
wants them.  Then there is one event at the next cycle in which an output may change.  It runs after the module's other
work of that cycle (shadow loads), and before any part samples the pin.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

from emulator.clock import NEVER, Clock, ClockEvent
from emulator.peripherals.epwm_action_qualifier import USES_COMPARE_A, USES_COMPARE_B, OutputWaveform, act, waveform
from emulator.peripherals.epwm_dead_band import DeadBand, Edge
from emulator.peripherals.epwm_shadow import Shadow
from emulator.peripherals.epwm_time_base import TimeBase
from emulator.peripherals.epwm_trip_zone import HIGH, HIGH_IMPEDANCE, UNTOUCHED, TripZone
from emulator.registers.core import F
from emulator.signals import PwmWire

#: AQCSFRC.CSFA and CSFB less one are the level that is forced.
_FORCED: Final = (1, 2)
#: After shadow loads (0), before the samples of an input qualifier (2).
_EDGE_PRIORITY: Final = 1


class SwallowedPulse(NamedTuple):
    """A compare value whose pulses the dead band swallows; times in cycles."""

    output: str
    compare: str
    value: int
    #: The width of the pulse in front of the dead band, and the period.
    cycles: int
    period: int
    #: The register of the delay, and the delay.
    register: str
    delay: int


class Output:
    """EPWMxA or EPWMxB: the level that the action qualifier gave it when the counter was last set, and its waveform."""

    __slots__ = ("control", "forced", "index", "level", "waveform", "wire")

    def __init__(self, index: int, wire: PwmWire, control: Shadow, forced: F) -> None:
        self.index = index
        self.wire = wire
        self.control = control
        #: Its field of AQCSFRC.
        self.forced = forced
        self.level = 0
        self.waveform = OutputWaveform({}, 1, 0)


class _OnWire:
    """One output as the source of its wire: `emulator.signals.PwmSource`."""

    __slots__ = ("_output", "_outputs")

    def __init__(self, outputs: EpwmOutputs, output: Output) -> None:
        self._outputs = outputs
        self._output = output

    def __str__(self) -> str:
        return f"the ePWM of {self._output.wire.name}"

    def level(self) -> int | None:
        return self._outputs.level_now(self._output)

    def stays_until(self) -> int:
        return self._outputs.stays_until(self._output)

    def watch(self) -> None:
        self._outputs.watch()


class EpwmOutputs:
    """Output A and output B over the time base.

    `settled()` is called before a level is read: it must bring the module up to now.
    """

    __slots__ = (
        "_a", "_b", "_band", "_band_control", "_clock", "_compare_a", "_compare_b", "_csfrc", "_edge_event", "_falling",
        "_rising", "_settled", "_swallowed", "_swallowing", "_time_base", "_trip_zone", "both",
    )  # fmt: skip

    def __init__(self, clock: Clock, time_base: TimeBase, a: Output, b: Output, *, compare: tuple[Shadow, Shadow],
                 csfrc: Shadow, dead_band: tuple[Shadow, Shadow, Shadow], trip_zone: TripZone,
                 settled: Callable[[], None]) -> None:  # fmt: skip
        """`compare` are CMPA and CMPB, `dead_band` DBCTL, DBRED and DBFED."""
        self._clock = clock
        self._time_base = time_base
        self.both = (a, b)
        self._a, self._b = a, b
        self._compare_a, self._compare_b = compare
        self._csfrc = csfrc
        self._band_control, self._rising, self._falling = dead_band
        self._trip_zone = trip_zone
        self._settled = settled
        self._band = DeadBand()
        self._edge_event: ClockEvent | None = None
        #: Pulses that the dead band swallows now, each with the cycle since when; those that it did for over a period.
        self._swallowing: dict[SwallowedPulse, int] = {}
        self._swallowed: dict[SwallowedPulse, None] = {}
        for output in self.both:
            output.wire.follow(_OnWire(self, output))

    def reset(self) -> None:
        """Both outputs low, nothing delayed.  Listeners to edges stay."""
        for output in self.both:
            output.level = 0
        self._band = DeadBand()
        self._swallowing = {}

    # -- levels --------------------------------------------------------------------------------------------------

    def force_of(self, output: Output) -> int | None:
        """The level that AQCSFRC forces on an output."""
        force = (self._csfrc.active & output.forced.mask) >> output.forced.lo
        return force - 1 if force in _FORCED else None

    def settle(self, before_this_tick: bool = False) -> None:
        """Bring levels and dead band up to now.  The caller must set the time base next; levels count from there."""
        phase, arrivals = self._time_base.arrivals()
        if before_this_tick and arrivals:
            arrivals -= 1
        if self._band.on:
            self._pass_dead_band(phase, arrivals, self._clock.now - before_this_tick)
        for output in self.both:
            force = self.force_of(output)
            if force is not None:
                output.level = force
            elif arrivals:
                output.level = output.waveform.level_after(output.level, phase, arrivals)

    def arrange(self, arrived: bool) -> None:
        """The path of the counter or an active value has changed: compute waveforms and duties.

        `arrived`: the new values already decide what happens at the phase at which the counter stands.
        """
        time_base = self._time_base
        phase = time_base.phase()
        for output in self.both:
            control = output.control.active
            compare_a = self._compare_a.active if control & USES_COMPARE_A else 0
            compare_b = self._compare_b.active if control & USES_COMPARE_B else 0
            output.waveform = waveform(
                time_base.mode, time_base.period, time_base.length, compare_a, compare_b, control
            )  # fmt: skip
            force = self.force_of(output)
            if force is not None:
                output.level = force
            elif arrived:
                output.level = act(output.waveform.action_at(phase), output.level)
        if self._band.on or self._band_control.active:
            tick = time_base.tick
            self._band.configure(
                self._band_control.active, self._rising.active * tick, self._falling.active * tick,
                self._a.level, self._b.level, self._clock.now,
            )  # fmt: skip
        delayed = self._delayed_duties() if self._band.on else None
        if delayed is not None or self._swallowing:
            self._follow_swallowed(delayed)
        for output in self.both:
            self._drive(output, delayed and delayed[output.index])

    def level(self, output: Output) -> int | None:
        """The level of an output now, if everything is settled; None: high impedance."""
        action = self._trip_zone.action(output.index)
        if action == UNTOUCHED:
            if self._band.on:
                return self._band.output(output.index)
            return output.level
        return None if action == HIGH_IMPEDANCE else int(action == HIGH)

    def _drive(self, output: Output, delayed: tuple[float, int] | None) -> None:
        """Put the steady waveform on the wire; `delayed` is its duty and period if the dead band makes it."""
        action = self._trip_zone.action(output.index)
        wire = output.wire
        if action != UNTOUCHED:
            wire.put(float(action == HIGH), 0, action == HIGH_IMPEDANCE)
        elif delayed is not None:
            wire.put(delayed[0], delayed[1], False)
        elif self.force_of(output) is not None or not self._time_base.running:
            wire.put(float(output.level), 0, False)
        else:
            high, total = output.waveform.high_time(output.level, self._time_base.arrivals()[0])
            steady = high in (0, total)
            wire.put(high / total, 0 if steady else total * self._time_base.tick, False)

    # -- through the dead band -----------------------------------------------------------------------------------

    def _inputs(self, phase: int) -> Iterator[Edge]:
        """The edges of both action-qualifier levels since the counter was last set; there may be infinitely many."""
        time_base = self._time_base
        levels = [self._a.level, self._b.level]
        following = [self._next_arrival(output, output.level, phase) for output in self.both]
        while any(following):
            n = min(filter(None, following))
            for i, output in enumerate(self.both):
                if following[i] == n:
                    levels[i] ^= 1
                    step = output.waveform.next_change(levels[i], (phase + n) % output.waveform.length)
                    following[i] = n + step if step else 0
            yield time_base.arrival_time(n), levels[0], levels[1]

    def _next_arrival(self, output: Output, level: int, phase: int) -> int:
        """Which arrival after `phase` changes an output of the action qualifier; 0: none."""
        if not self._time_base.running or self.force_of(output) is not None:
            return 0
        return output.waveform.next_change(level, phase)

    def _repeats_after(self) -> int:
        """The number of arrivals, since the counter was last set, after which all repeats every two periods."""
        band, now, tick = self._band, self._time_base.arrival_time(0), self._time_base.tick
        under_way = max(band.due - now, 0) + 2 * band.memory_cycles
        return -(-under_way // tick) + 6 * self._time_base.length

    def _pass_dead_band(self, phase: int, arrivals: int, until: int) -> None:
        """Run the dead band from where the counter was last set, and skip periods that only repeat."""
        twice = 2 * self._time_base.length
        left_out = max(arrivals - self._repeats_after(), 0) // twice * twice * self._time_base.tick
        for _ in self._band.course(self._inputs(phase), until - left_out):
            pass
        self._band.later(left_out)

    def _delayed_duties(self) -> tuple[tuple[float, int], tuple[float, int]]:
        """Duty and period of both steady waveforms after the dead band."""
        time_base = self._time_base
        band, first = self._band.copy(), self._repeats_after()
        last = begin = time_base.arrival_time(first)
        total = 2 * time_base.length * time_base.tick
        a, b = band.output(0), band.output(1)
        high_a = high_b = 0
        for time in band.course(self._inputs(time_base.arrivals()[0]), begin + total):
            if time > begin:
                high_a += a * (time - last)
                high_b += b * (time - last)
                last = time
            a, b = band.output(0), band.output(1)
        left = begin + total - last
        return self._as_duty(0, high_a + a * left, total), self._as_duty(1, high_b + b * left, total)

    def _as_duty(self, index: int, high: int, two_periods: int) -> tuple[float, int]:
        if high in (0, two_periods):
            return high / two_periods, 0
        alternates = self.both[self._band.source(index)].waveform.alternates
        return high / two_periods, two_periods if alternates else two_periods // 2

    def _follow_swallowed(self, delayed: tuple[tuple[float, int], tuple[float, int]] | None) -> None:
        """Keep the pulses that have not come out for a period, and those that do not come out from now on."""
        now = self._clock.now
        self._swallowed |= self._for_a_period()
        found = [pulse for n, duty in enumerate(delayed or ()) if not duty[1] and (pulse := self._lost_pulse(n))]
        self._swallowing = {pulse: self._swallowing.get(pulse, now) for pulse in found}

    def _lost_pulse(self, index: int) -> SwallowedPulse | None:
        """The pulse that one compare value makes of an output whose level is steady behind the dead band."""
        time_base, source = self._time_base, self.both[self._band.source(index)]
        uses = source.control.active & (USES_COMPARE_A | USES_COMPARE_B)
        by_a, by_b = bool(uses & USES_COMPARE_A), bool(uses & USES_COMPARE_B)
        if by_a == by_b or not time_base.running or self.force_of(source) is not None:
            return None
        if self._trip_zone.action(index) != UNTOUCHED:
            return None
        high, total = source.waveform.high_time(source.level, time_base.arrivals()[0])
        if high in (0, total):
            return None
        compare, tick = self._compare_a if by_a else self._compare_b, time_base.tick
        register, delay = ("DBRED", self._rising) if self._band.has_rising_path(index) else ("DBFED", self._falling)
        return SwallowedPulse(
            self.both[index].wire.name, compare.register.name, compare.active, min(high, total - high) * tick,
            total * tick, register, delay.active * tick,
        )  # fmt: skip

    @property
    def swallowed(self) -> list[SwallowedPulse]:
        """The pulses that the dead band has swallowed for more than a period."""
        return list(self._swallowed | self._for_a_period())

    def _for_a_period(self) -> dict[SwallowedPulse, None]:
        now = self._clock.now
        return {pulse: None for pulse, since in self._swallowing.items() if now - since > pulse.period}

    # -- edges ---------------------------------------------------------------------------------------------------

    def level_now(self, output: Output) -> int | None:
        """The level that a pin set to this output shows; None: high impedance."""
        self._settled()
        return self.level(output)

    def watch(self) -> None:
        """A listener to the edges of an output has come, or the last one has gone."""
        self._settled()
        self.reschedule()

    def reschedule(self) -> None:
        """Schedule one event at the next cycle in which a watched output may change; none without a listener."""
        if self._edge_event is not None:
            self._clock.cancel(self._edge_event)
            self._edge_event = None
        time = min((self._next_edge(output) for output in self.both if output.wire.watched), default=NEVER)
        if time != NEVER:
            self._edge_event = self._clock.schedule(time, self._edge, priority=_EDGE_PRIORITY)

    def _next_edge(self, output: Output) -> int:
        """The next cycle at which an output may change, if everything is settled; NEVER: there is none."""
        if self._trip_zone.action(output.index) != UNTOUCHED:
            return NEVER
        phase = self._time_base.arrivals()[0]
        time = self._band.due if self._band.on and self._band.due >= 0 else NEVER
        for cause in self.both:
            n = self._next_arrival(cause, cause.level, phase) if cause is output or self._band.on else 0
            if n:
                time = min(time, self._time_base.arrival_time(n))
        return time

    def stays_until(self, output: Output) -> int:
        """The next cycle at which an output may change; NEVER: there is none."""
        self._settled()
        return self._next_edge(output)

    def report_levels(self) -> None:
        """Report the present levels to listeners that want edges."""
        for output in self.both:
            if output.wire.watched:
                output.wire.report_level(self.level(output))

    def _edge(self) -> None:
        self._edge_event = None
        self._settled()
        self.reschedule()
        self.report_levels()
