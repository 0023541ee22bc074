"""Triggers of faults: `frame 3`, `order MISN`, `finding RULE`, `pose x>500`.

Frames and orders are counted on the robot's line.  A pose is the true one, in millimetres and degrees.  It is sampled
every 10 ms, without moving the world.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from math import degrees
from typing import TYPE_CHECKING, Final

from emulator.clock import CYCLES_PER_MS

if TYPE_CHECKING:
    from emulator.c28x.findings import Finding
    from emulator.signals import SerialFrame
    from hil.faults.effect import FaultTarget

SAMPLE_CYCLES: Final = 10 * CYCLES_PER_MS
_POSE: Final = re.compile(r"(x|y|heading)\s*([<>])\s*(-?\d{1,9}(?:\.\d+)?)")
_WORDS: Final = "frame N, order NAME, finding RULE, pose x>MM (x, y in mm, heading in degrees; > or <)"
_CARRIAGE_RETURN: Final = 0x0D


def check(text: str) -> None:
    """Raise ValueError for a text that is no trigger; an empty text is no wait."""
    what, _, rest = text.strip().partition(" ")
    rest = rest.strip()
    good = {
        "": not rest, "frame": bool(re.fullmatch(r"0*[1-9]\d{0,8}", rest)),
        "order": bool(re.fullmatch(r"[A-Za-z]{4}", rest)), "finding": bool(rest), "pose": bool(_POSE.fullmatch(rest)),
    }  # fmt: skip
    if not good.get(what):
        raise ValueError(f"when: {text!r} is not one of {_WORDS}")


def wait_for(text: str, machine: FaultTarget, then: Callable[[], None]) -> Callable[[], None]:
    """Call `then` once, when the trigger occurs; the returned function ends the watch.

    Raises ValueError if the board lacks what the trigger needs.
    """
    what, _, rest = text.strip().partition(" ")
    rest = rest.strip()
    if what == "frame":
        return _Frames(machine, int(rest), then).stop
    if what == "order":
        return _Orders(machine, rest.upper(), then).stop
    if what == "finding":
        return _Found(machine, rest, then).stop
    return _Pose(machine, rest, then).stop


class _OneShot:
    """A trigger that is watched until it occurs."""

    def __init__(self, then: Callable[[], None]) -> None:
        self._then = then
        self._on = True
        self._disconnect: Callable[[], None] | None = None

    def happened(self) -> None:
        if self._on:
            self.stop()
            self._then()

    def stop(self) -> None:
        self._on = False
        if self._disconnect is not None:
            self._disconnect()


class _Frames(_OneShot):
    def __init__(self, machine: FaultTarget, number: int, then: Callable[[], None]) -> None:
        super().__init__(then)
        self._left = number
        self._disconnect = machine.uart_sent.connect(self._byte)

    def _byte(self, byte: int, _cycles: int) -> None:
        if byte == _CARRIAGE_RETURN:
            self._left -= 1
            if not self._left:
                self.happened()


class _Orders(_OneShot):
    def __init__(self, machine: FaultTarget, name: str, then: Callable[[], None]) -> None:
        super().__init__(then)
        pc = machine.board.pc
        if pc is None:
            raise ValueError(f"when: order {name}: {type(machine.board).__name__} has no line to a PC")
        self._name = name.encode("ascii")
        self._seen = b""
        self._disconnect = machine.board.serial_pins[pc.rx_gpio].sent.connect(self._frame)

    def _frame(self, frame: SerialFrame) -> None:
        if frame.data != _CARRIAGE_RETURN:
            self._seen = (self._seen + bytes((frame.data & 0xFF,)))[-80:]
            return
        told, self._seen = self._seen.rpartition(b"#")[2], b""
        if told.startswith(self._name):
            self.happened()


class _Found(_OneShot):
    def __init__(self, machine: FaultTarget, rule: str, then: Callable[[], None]) -> None:
        super().__init__(then)
        self._rule = rule
        self._disconnect = machine.findings.found.connect(self._found)

    def _found(self, finding: Finding) -> None:
        if finding.rule == self._rule:
            self.happened()


class _Pose(_OneShot):
    def __init__(self, machine: FaultTarget, text: str, then: Callable[[], None]) -> None:
        super().__init__(then)
        world = getattr(machine, "world", None)
        found = _POSE.fullmatch(text)
        if world is None or found is None:
            raise ValueError(f"when: pose {text}: {type(machine.board).__name__} is in no world")
        self._world = world
        self._clock = machine.clock
        self._what, self._limit = found[1], float(found[3])
        self._compare = operator.gt if found[2] == ">" else operator.lt
        self._event = self._clock.after(0, self._sample)

    def _sample(self) -> None:
        if not self._on:
            return
        pose = self._world.pose
        value = {"x": pose.x_m * 1e3, "y": pose.y_m * 1e3, "heading": degrees(pose.heading_rad)}[self._what]
        if self._compare(value, self._limit):
            self.happened()
        else:
            self._event = self._clock.after(SAMPLE_CYCLES, self._sample)
