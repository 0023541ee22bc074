"""A line in use, as it is written to a log."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import SYSCLK_HZ
from hil.client.orders import TimedOrder
from hil.machine import Setup
from hil.pacing import Pacer
from hil.recording.log import Direction, Recording, parse_log
from hil.recording.wire import PAUSE_NS, WireLog, header_of, record
from hil.session import Session
from tests.hil.scripted_machine import BYTE_CYCLES, ScriptedMachine, numbered_frame

MS = 1_000_000


def log_of(act: Callable[[WireLog], None]) -> Recording:
    file = io.StringIO()
    wire = WireLog(file, {})
    act(wire)
    wire.end(10**12)
    return parse_log(file.getvalue().encode("ascii"), "x")


def test_frames_are_gathered_and_orders_are_not() -> None:
    def act(wire: WireLog) -> None:
        for index, byte in enumerate(b"#ODO 1,2,3,4,5,6\n\r"):
            wire.from_robot(bytes((byte,)), index * MS)
            if index == 3:
                wire.to_robot(b"#SETR", index * MS)
                wire.to_robot(b"0.1", index * MS)

    recording = log_of(act)
    assert [(r.direction, r.time_ns, r.data) for r in recording.records] == [
        (Direction.TO_ROBOT, 3 * MS, b"#SETR"),
        (Direction.TO_ROBOT, 3 * MS, b"0.1"),
        (Direction.FROM_ROBOT, 17 * MS, b"#ODO 1,2,3,4,5,6\n\r"),
    ]


def test_silence_ends_a_stretch_and_its_time_is_that_of_its_last_byte() -> None:
    def act(wire: WireLog) -> None:
        wire.from_robot(b"noise", 5 * MS)
        wire.to_robot(b"a", 5 * MS + PAUSE_NS - 1)
        wire.to_robot(b"b", 5 * MS + PAUSE_NS)

    recording = log_of(act)
    assert [(record.time_ns, record.data) for record in recording.records] == [
        (5 * MS, b"noise"), (5 * MS + PAUSE_NS - 1, b"a"), (5 * MS + PAUSE_NS, b"b"),
    ]  # fmt: skip


@given(st.lists(st.tuples(st.booleans(), st.binary(max_size=600), st.integers(0, 100 * MS)), max_size=12))
def test_no_byte_is_lost_or_moved_between_directions(events: list[tuple[bool, bytes, int]]) -> None:
    def act(wire: WireLog) -> None:
        now = 0
        for to_robot, data, later in events:
            now += later
            (wire.to_robot if to_robot else wire.from_robot)(data, now)

    recording = log_of(act)
    for to_robot, direction in ((True, Direction.TO_ROBOT), (False, Direction.FROM_ROBOT)):
        assert recording.stream(direction) == b"".join(data for way, data, _ in events if way is to_robot)
    assert recording.problems == []


def test_what_was_recorded_before_a_crash_is_there(tmp_path: Path) -> None:
    path = tmp_path / "x.wire"
    with record(path, header_of(Setup())) as wire:
        wire.to_robot(b"#STOP\r", 1000)
        # Nothing was closed yet.
        recording = parse_log(path.read_bytes(), "x")
        assert [r.data for r in recording.records] == [b"#STOP\r"]
        assert recording.header["setup"]


def test_a_session_writes_times_to_the_cycle(tmp_path: Path) -> None:
    machine = ScriptedMachine()
    machine.boot()
    path = tmp_path / "x.wire"
    with record(path, {}) as wire:
        # 0.123456785 s are 24 691 357 cycles.
        session = Session(machine, None, Pacer(None), orders=[TimedOrder(0.123456785, b"#MISN\r")], wire=wire)
        session.run(1.0)
        wire.end(session.elapsed_ns)
    recording = parse_log(path.read_bytes(), "x")
    to_robot = [r for r in recording.records if r.direction is Direction.TO_ROBOT]
    assert [(r.time_ns, r.data) for r in to_robot] == [(123_456_785, b"#MISN\r")]
    frames = [r for r in recording.records if r.direction is Direction.FROM_ROBOT]
    # Frame n begins n times 250 ms after start-up; its last byte has ended as many byte times later.
    data = [numbered_frame(number).encode() for number in (1, 2, 3)]
    assert [r.data for r in frames] == data
    cycles = [number * SYSCLK_HZ // 4 + len(frame) * BYTE_CYCLES for number, frame in enumerate(data, 1)]
    assert [r.time_ns for r in frames] == [count * 5 for count in cycles]
    assert recording.end_ns == 1_000_000_000
