"""A recording played again: the same robot sends the same bytes, a console gets them at their times."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import SYSCLK_HZ
from hil.bench import Bench
from hil.machine import Setup
from hil.pacing import Pacer
from hil.recording.log import Direction, Record, Recording, read_log
from hil.recording.replay import Player, judge, orders_of, replay_orders, setup_of
from hil.recording.wire import header_of, record
from hil.session import Session
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.test_pacing import WallClock
from tests.hil.test_session import MemoryPort

SETUP = Setup(world="room", seed=7)


def booted(setup: Setup) -> Bench:
    bench = Bench(setup, traced=False)
    bench.boot()
    return bench


@pytest.fixture(scope="module")
def mission(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Eight seconds of a drive whose orders come from a port, in pieces and at odd times, as from a console."""
    path = tmp_path_factory.mktemp("mission") / "run.wire"
    bench = booted(SETUP)
    port = MemoryPort()
    pieces = {7: b"#MI", 8: b"SN\r", 120: b"#STOP\r#TELE\r", 200: b"#SETR", 201: b"0.2,", 203: b"0.3\r"}
    slices = 0

    def tick(_session: Session) -> None:
        nonlocal slices
        slices += 1
        port.from_pc += pieces.get(slices, b"")

    with record(path, header_of(SETUP)) as wire:
        session = Session(bench, port, Pacer(None), wire=wire, tick=tick)
        session.run(8.0123)
        wire.end(session.elapsed_ns)
    bench.close()
    return path


def test_a_recorded_mission_replays_to_byte_equal_frames(mission: Path) -> None:
    recording = read_log(mission)
    assert setup_of(recording) == SETUP
    bench = booted(SETUP)
    verdict = replay_orders(recording, bench)
    bench.close()
    assert verdict.equal
    # A frame begins every 250 ms.
    assert verdict.recorded_frames == verdict.replayed_frames >= 31
    assert verdict.recorded_bytes == len(recording.stream(Direction.FROM_ROBOT)) > 0
    assert verdict.first_difference is None


def test_another_seed_another_order_or_another_time_shows(mission: Path) -> None:
    recording = read_log(mission)
    bench = booted(dataclasses.replace(SETUP, seed=8))
    assert not replay_orders(recording, bench).equal
    bench.close()
    setr = next(index for index, r in enumerate(recording.records) if r.data == b"#SETR")
    time_ns = recording.records[setr].time_ns
    recording.records[setr + 1] = Record(recording.records[setr + 1].time_ns, Direction.TO_ROBOT, b"0.1,")
    bench = booted(SETUP)
    verdict = replay_orders(recording, bench)
    bench.close()
    assert not verdict.equal
    # The frames before that order are the same.
    before = sum(r.direction is Direction.FROM_ROBOT and r.time_ns < time_ns for r in recording.records)
    assert verdict.first_difference is not None
    assert verdict.first_difference >= before
    assert verdict.recorded != verdict.replayed


def test_a_log_that_was_cut_replays_as_far_as_it_goes(mission: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.wire"
    cut.write_bytes(mission.read_bytes()[:900])
    recording = read_log(cut)
    assert recording.problems
    bench = booted(SETUP)
    verdict = replay_orders(recording, bench)
    bench.close()
    assert verdict.equal
    assert verdict.recorded_frames > 5


@given(st.lists(st.integers(0, 10**11), max_size=5))
def test_orders_keep_their_cycle(cycles: list[int]) -> None:
    recording = Recording(records=[Record(count * 5, Direction.TO_ROBOT, b"x") for count in cycles])
    assert [round(order.time_s * SYSCLK_HZ) for order in orders_of(recording)] == cycles


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("{", "damaged"),
        ("[1]", "damaged"),
        ('{"seed": "1"}', 'seed is "1"'),
        ('{"seed": true}', "seed is true"),
        (f'{{"seed": {"9" * 400}}}', "x.log: in its setup, seed: expected a whole number from 0 to 999999999999999"),
        (f'{{"seed": {"9" * 5000}}}', "x.log: its setup is damaged"),
        ('{"colour": 1}', "'colour', which this version does not know"),
    ],
)
def test_a_damaged_setup_is_one_line(text: str, complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        setup_of(Recording("x.log", {"setup": text}))


def test_every_setup_comes_back() -> None:
    setup = Setup(world="maps/ñ.toml", seed=5, fill="nan", realistic=False, xbee=True, fixes=("a", "b"))
    assert setup_of(Recording(header=header_of(setup))) == setup
    assert setup_of(Recording()) is None
    assert json.loads(header_of(setup)["setup"])["seed"] == 5


@given(
    st.lists(st.sampled_from([b"#ODO 1\n\r", b"#ODO 2\n\r", b"x"])), st.lists(st.sampled_from([b"#ODO 1\n\r", b"x"]))
)
def test_a_verdict_is_equality_of_the_bytes(one: list[bytes], other: list[bytes]) -> None:
    recorded, replayed = b"".join(one), b"".join(other)
    verdict = judge(recorded, replayed)
    assert verdict.equal == (recorded == replayed)
    if verdict.first_difference is not None:
        first = verdict.first_difference
        assert recorded.split(b"\r")[:first] == replayed.split(b"\r")[:first]
        assert recorded.split(b"\r")[first : first + 1] != replayed.split(b"\r")[first : first + 1]


class TestToAConsole:
    """The player: frames at their times, orders taken in."""

    def play(self, recording: Recording, *, wait: bool = False) -> tuple[list[tuple[float, bytes]], Player]:
        wall, port = WallClock(), MemoryPort()
        pieces: list[tuple[float, bytes]] = []
        port.on_write = lambda data: pieces.append((wall.now, data))
        began = wall.now

        def pass_time(fds: Sequence[int], seconds: float) -> bool:
            if wait and wall.now >= began + 1.5 and not port.counters.bytes_to_robot:
                port.from_pc += b"#STOP\r"
            return wall.wait(fds, seconds)

        player = Player(recording, port, Pacer(1.0, monotonic=wall.monotonic, wait=pass_time))
        if wait:
            player.wait_for_console()
            began = wall.now
            assert began >= 1001.5
        player.run()
        return [(time - began, data) for time, data in pieces], player

    def test_frames_come_at_their_times(self) -> None:
        records = [
            Record(250_000_000, Direction.FROM_ROBOT, b"#ODO 1,0,0,0,0,0\n\r"),
            Record(300_000_000, Direction.TO_ROBOT, b"#MISN\r"),
            Record(500_000_000, Direction.FROM_ROBOT, b"#ODO 2,0,0,0,0,0\n\r"),
        ]
        pieces, _ = self.play(Recording(records=records, end_ns=600_000_000))
        assert [data for _, data in pieces] == [records[0].data, records[2].data]
        assert [time for time, _ in pieces] == pytest.approx([0.25, 0.5], abs=1e-6)

    def test_it_can_wait_for_the_console(self) -> None:
        records = [Record(0, Direction.FROM_ROBOT, b"#ODO 1,0,0,0,0,0\n\r")]
        pieces, player = self.play(Recording(records=records), wait=True)
        assert [data for _, data in pieces] == [records[0].data]
        assert player.bytes_from_console == len(b"#STOP\r")


def test_a_scripted_machine_shows_that_orders_arrive_at_their_cycle() -> None:
    machine = ScriptedMachine()
    machine.boot()
    start = machine.clock.now
    recording = Recording(records=[Record(123_456_785, Direction.TO_ROBOT, b"ab")], end_ns=10**9)
    replay_orders(recording, machine)
    # 24 691 357 cycles after the start, and one byte time of 208 333 cycles each.
    assert machine.taken == [(start + 24_691_357 + n * 208_333, byte) for n, byte in ((1, 0x61), (2, 0x62))]
