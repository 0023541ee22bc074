"""Faults of time: an oscillator with a wrong frequency, a task that takes longer.

The chip's cycles are the emulator's time.  So a faster oscillator shows in all parts with a clock of their own: the
bits of the PC are longer in both directions, the world moves less in a cycle, the periods of gyro and sonars have more
cycles.
Not modelled: the clocks of other parts (accelerometer, LiDAR, XBee, the bounce of a contact), the carrier's ripple.
A task's extra time is executed at the first instruction of each activation; a higher task may preempt it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial

from emulator.clock import CYCLES_PER_US, SYSCLK_HZ
from emulator.signals import SerialFrame
from hil.faults.effect import Effect
from hil.faults.kinds import FaultKind, FaultParameter
from hil.faults.serial import OfLine


class OscillatorDrift(OfLine):
    """The oscillator of the chip has a wrong frequency."""

    def begin(self) -> None:
        """Begin the fault."""
        super().begin()
        devices = [part.device for part in self.board.parts.values()]
        own_time = [each for each in (getattr(self.machine, "world", None), *devices) if hasattr(each, "set_second")]
        for each in own_time:
            each.set_second(SYSCLK_HZ * (1.0 + self.number("percent") / 100.0))
            self.on_end(partial(each.set_second, float(SYSCLK_HZ)))
        if own_time:
            self.fired()
        pc = self.board.pc
        assert pc is not None
        self.on_end(self.board.serial_pins[pc.tx_gpio].disturb(self._stretched_frames))

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return a frame from the PC with longer bits, as a faster chip sees it."""
        self.hit()
        return (self._stretched(frame, 1.0 + self.number("percent") / 100.0),)

    def _stretched_frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        self.fired()
        return (self._stretched(frame, 1.0 / (1.0 + self.number("percent") / 100.0)),)

    @staticmethod
    def _stretched(frame: SerialFrame, factor: float) -> SerialFrame:
        return replace(
            frame, bit_cycles=frame.bit_cycles * factor, drift=frame.drift * factor,
            start=frame.end - round((frame.end - frame.start) * factor),
        )  # fmt: skip


class TaskSlow(Effect):
    """Each activation of a task takes longer."""

    def begin(self) -> None:
        """Begin the fault."""
        self._ready = self._due = False
        trace, clock = self.board.trace, self.clock
        self.on_end(trace.listen(self._scheduled, "ready", "switch", each_tick=False))
        self._kernel = clock.server
        clock.serve_with(self._serve)
        self.on_end(self._restore)

    def _restore(self) -> None:
        # Somebody else may have taken the CPU over meanwhile: the program has ended.
        if self.clock.server == self._serve:
            self.clock.serve_with(self._kernel)

    def _scheduled(self, _cycles: int, kind: str, name: str) -> None:
        if name != self.text("task"):
            return
        if kind == "ready":
            self._ready = True
        elif self._ready:
            self._ready, self._due = False, True
            self.clock.request_attention()

    def _serve(self) -> None:
        self._kernel()
        if not self._due or self.board.cpu.in_interrupt:
            return
        current = self.board.kernel.tasks.current
        if current is None or current.name != self.text("task"):
            return
        self._due = False
        self.fired()
        self.mounted.note_access()
        self.clock.delay(round(self.number("us") * CYCLES_PER_US))


KINDS = (
    FaultKind("oscillator-drift", "The chip's oscillator is faster or slower than the PC's.", "a line to a PC",
              OscillatorDrift, (FaultParameter("percent", "%", "how much faster", 3.0, -20.0, 20.0),)),
    FaultKind("task-slow", "Each activation of a task takes longer.", "a program with tasks", TaskSlow,
              (FaultParameter("task", "", "its name", type=str),
               FaultParameter("us", "us", "how much longer", 1000.0, 0.0, 1e7))),
)  # fmt: skip
