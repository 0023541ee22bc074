"""Plays a recording again: its orders to an emulated robot, or its frames to a console.

Orders reach the line at their times, exact to the cycle.  A log of the emulated robot contains the setup of its run, so
the same robot runs again and must send the same bytes.  A `Verdict` says whether it did, and where not.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, Final

from hil.client.orders import TimedOrder
from hil.machine import Machine, Setup
from hil.pacing import Pacer
from hil.recording.log import Direction, Recording
from hil.recording.wire import WireListener
from hil.serial_port import SerialPort
from hil.session import NS_PER_CYCLE, Session

_NS_PER_S: Final = 1_000_000_000
#: The longest time between two reads of the console's bytes.
LISTEN_NS: Final = 50_000_000


def setup_of(recording: Recording) -> Setup | None:
    """The setup of the recorded run; None if the log has none.  Raises ValueError if this version cannot read it."""
    text = recording.header.get("setup")
    if text is None:
        return None
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError(f"{recording.name}: its setup is damaged") from None
    if not isinstance(data, dict):
        raise ValueError(f"{recording.name}: its setup is damaged")
    defaults = {field.name: field.default for field in fields(Setup)}
    values: dict[str, Any] = {}
    for name, value in data.items():
        if name not in defaults:
            raise ValueError(f"{recording.name}: its setup has {name!r}, which this version does not know")
        plain = tuple(value) if isinstance(value, list) else value
        if type(plain) is not type(defaults[name]):
            raise ValueError(f"{recording.name}: in its setup, {name} is {json.dumps(value)}")
        values[name] = plain
    try:
        return Setup.of(**values)
    except ValueError as error:
        raise ValueError(f"{recording.name}: in its setup, {error}") from None


def orders_of(recording: Recording) -> list[TimedOrder]:
    """The bytes that went to the robot, with their times."""
    return [
        TimedOrder(record.time_ns / _NS_PER_S, record.data)
        for record in recording.records
        if record.direction is Direction.TO_ROBOT
    ]


@dataclass(frozen=True, slots=True)
class Verdict:
    """The comparison of the robot's bytes, recorded and played again."""

    equal: bool
    recorded_bytes: int
    replayed_bytes: int
    recorded_frames: int
    replayed_frames: int
    #: The index of the first frame that differs, or that only one of them has; None if they are equal.
    first_difference: int | None
    recorded: bytes
    replayed: bytes


def judge(recorded: bytes, replayed: bytes) -> Verdict:
    """Compare two streams of frames."""
    mine, theirs = recorded.split(b"\r"), replayed.split(b"\r")
    pairs = zip(mine, theirs, strict=False)
    first = next((index for index, (one, other) in enumerate(pairs) if one != other), min(len(mine), len(theirs)))
    equal = recorded == replayed
    return Verdict(
        equal, len(recorded), len(replayed), len(mine) - 1, len(theirs) - 1,
        None if equal else first,
        b"" if equal else b"".join(mine[first : first + 1]),
        b"" if equal else b"".join(theirs[first : first + 1]),
    )  # fmt: skip


class _Received:
    """Collects the bytes that the robot sends in a replay."""

    def __init__(self, then: WireListener | None) -> None:
        self.data = bytearray()
        self._then = then

    def to_robot(self, data: bytes, time_ns: int) -> None:
        if self._then is not None:
            self._then.to_robot(data, time_ns)

    def from_robot(self, data: bytes, time_ns: int) -> None:
        self.data += data
        if self._then is not None:
            self._then.from_robot(data, time_ns)


def replay_orders(
    recording: Recording,
    machine: Machine,
    *,
    wire: WireListener | None = None,
    on_session: Callable[[Session], None] = lambda _session: None,
    progress: Callable[[float], None] = lambda _part: None,
) -> Verdict:
    """Give a booted robot the recorded orders, and compare the bytes that it sends.

    `progress` gets the part that was played, 0 to 1.  Raises FirmwareStopped.
    """
    received = _Received(wire)
    seconds = recording.duration_ns / _NS_PER_S
    session = Session(
        machine, None, Pacer(None), orders=orders_of(recording), wire=received,
        tick=lambda ran: progress(ran.elapsed_virtual_s / seconds if seconds else 1.0),
    )  # fmt: skip
    on_session(session)
    session.run(seconds)
    recorded = recording.stream(Direction.FROM_ROBOT)
    # A log that was cut lacks the frame that was being sent.
    replayed = received.data[: len(recorded)] if recording.end_ns is None else received.data
    return judge(recorded, bytes(replayed))


class Player:
    """Plays the robot's side of a recording on a port.  Each frame appears at the end of its last byte.

    Bytes of the console go to `wire`, and have no other effect.
    """

    def __init__(
        self, recording: Recording, port: SerialPort, pacer: Pacer, *, wire: WireListener | None = None
    ) -> None:
        self.port = port
        self.bytes_from_console = 0
        #: The time up to which it has played, in nanoseconds.
        self.played_ns = 0
        self._records = [record for record in recording.records if record.direction is Direction.FROM_ROBOT]
        self._end_ns = recording.duration_ns
        self._pacer = pacer
        self._wire = wire
        self._stop = False

    def stop(self) -> None:
        """End `run` soon.  Safe in a signal handler."""
        self._stop = True

    def wait_for_console(self) -> None:
        """Wait until the console has sent a byte."""
        while not self._stop and not self._listen(0):
            self._pacer.start(0)
            self._wait(LISTEN_NS)

    def run(self) -> None:
        """Play to the end, or until `stop` is called."""
        self._pacer.start(0)
        for record in self._records:
            self._play_until(record.time_ns)
            if self._stop:
                return
            cycles = record.time_ns // NS_PER_CYCLE
            for byte in record.data:
                self.port.robot_sent(byte, cycles)
            if self._wire is not None:
                self._wire.from_robot(record.data, record.time_ns)
            self.port.transmit(cycles)
        self._play_until(self._end_ns)

    def _play_until(self, time_ns: int) -> None:
        now_ns = self._now_ns()
        while not self._stop and now_ns < time_ns:
            self._wait(min(time_ns, now_ns + LISTEN_NS))
            now_ns = self._now_ns()
            self.played_ns = min(now_ns, time_ns)
            self._listen(now_ns)
            self.port.transmit(now_ns // NS_PER_CYCLE)

    def _now_ns(self) -> int:
        return self._pacer.virtual_now() * NS_PER_CYCLE

    def _wait(self, until_ns: int) -> None:
        self._pacer.wait_until(until_ns // NS_PER_CYCLE + 1, self.port.wait_fds())

    def _listen(self, now_ns: int) -> bool:
        data = self.port.receive(4096)
        self.bytes_from_console += len(data)
        if data and self._wire is not None:
            self._wire.to_robot(data, now_ns)
        return bool(data)
