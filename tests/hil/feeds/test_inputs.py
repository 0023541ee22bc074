"""What of a board is fed, when it is taken, and how it is given back."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

from emulator.clock import SYSCLK_HZ
from emulator.devices.l3g4200d import L3G4200D
from hil.bench import Bench
from hil.board import Board, Face
from hil.feeds import Source, feed, inputs, load
from hil.machine import Setup
from hil.reports.policy import Policy
from hil.running import running
from hil.scenarios.scenario import load_scenario
from hil.testing.faults import BoardTarget
from hil.view.checkpoints import RewindableRun


class Thing:
    """A part with one face, which counts how often it is set."""

    times = 0

    def __init__(self) -> None:
        self._level = 7.0

    @property
    def level(self) -> float:
        return self._level

    @level.setter
    def level(self, value: float) -> None:
        self._level = value
        self.times += 1

    def volts(self, cycles: int) -> float:
        return 2.5


class Own(Board):
    """A board of one's own."""

    def solder(self) -> None:
        self.thing = self.on_adc("thing", Thing(), adc="B", channel=3, faces=[Face("level", "m", 0.0, 10.0)])


def machine(board: Board) -> BoardTarget:
    def none() -> object:
        raise AssertionError("a feed needs no firmware")

    return BoardTarget(board, none)  # type: ignore[arg-type]


@pytest.fixture
def own() -> BoardTarget:
    return machine(Own())


@pytest.fixture
def robot() -> Bench:
    return Bench(Setup(realistic=False, fixes=("all",)), traced=False)


def volts(on: BoardTarget, pin: int = 3) -> float:
    return on.board.analog["B"][pin].source.volts(on.clock.now)


def to(on: BoardTarget, time_s: float) -> None:
    on.clock.advance_to(round(time_s * SYSCLK_HZ))


@pytest.mark.parametrize(
    ("source", "how", "wanted"),
    [
        (1.25, "hold", [1.25, 1.25, 1.25]),
        (([0.0, 1.0], [1, 2]), "hold", [1.0, 1.0, 2.0]),
        ((np.array([0.0, 1.0]), np.array([1.0, 2.0])), "linear", [1.0, 1.5, 2.0]),
        (lambda time_s: time_s * 2.0, "hold", [0.0, 1.0, 2.0]),
        (iter([(0.0, 1.0), (0.5, 3.0)]), "hold", [1.0, 3.0, 3.0]),
    ],
    ids=["number", "arrays", "NumPy", "function", "generator"],
)  # fmt: skip
def test_an_adc_input_of_any_board_sees_it(own: BoardTarget, source: Source, how: str, wanted: list[float]) -> None:
    feed(own, "ADCINB3", source, how=how)
    seen = []
    for time_s in (0.0, 0.5, 1.0):
        to(own, time_s)
        seen.append(volts(own))
    assert seen == wanted
    feed(own, "ADCINB3", "physics")
    assert volts(own) == 2.5
    assert not own.feeds


def test_arrays_of_a_text_are_those_of_python(own: BoardTarget) -> None:
    load("ADCINB3=[[0.5, 1], [1.5, 2.5]],linear").feed(own)
    seen = []
    for time_s in (0.0, 1.0, 2.0):
        to(own, time_s)
        seen.append(volts(own))
    # Before the first the first, half-way between two their mean, after the last the last.
    assert seen == [1.0, 1.75, 2.5]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("ADCINB3=[[0, 1], [1]]", r"feed of ADCINB3: expected \[\[SECONDS,VALUE\],...\]"),
        ("ADCINB3=[[0, 1]", r"feed of ADCINB3: expected \[\[SECONDS,VALUE\],...\]"),
        ("ADCINB3=[1, 2]", r"feed of ADCINB3: expected \[\[SECONDS,VALUE\],...\]"),
        ("thing.level=[[0, 1], [2, 11]]", "thing.level: feed at 2 s: 11: thing.level must be 0 to 10 m"),
        ("thing.level=[[1, 1], [0, 1]]", "thing.level: .* the time decreases"),
        ("thing.level=[]", "thing.level: .* 0 times, 0 values"),
    ],
)  # fmt: skip
def test_a_text_without_right_arrays_is_one_line(own: BoardTarget, text: str, told: str) -> None:
    with pytest.raises(ValueError, match=told) as caught:
        load(text).feed(own)
    assert "\n" not in str(caught.value)
    assert not own.feeds


def test_units_are_converted(own: BoardTarget) -> None:
    feed(own, "ADCINB3", 1500, unit="mV")
    assert volts(own) == 1.5


def test_nobody_asks_before_the_sensor_looks(own: BoardTarget) -> None:
    asked: list[float] = []
    feed(own, "ADCINB3", lambda time_s: asked.append(time_s) or 1.0)  # type: ignore[func-returns-value]
    to(own, 1.0)
    assert asked == []
    volts(own)
    assert asked == [1.0]


def test_a_face_is_set_when_it_changes(own: BoardTarget) -> None:
    thing: Thing = own.board.part("thing").device
    feed(own, "thing.level", ([0.0, 0.5, 1.0], [1.0, 2.0, 3.0]))
    to(own, 0.75)
    assert (thing.level, thing.times) == (2.0, 2)
    feed(own, "thing.level", ([0.0, 1.0], [0.0, 1.0]), how="linear")
    to(own, 0.8)
    assert thing.level == pytest.approx(0.8)
    feed(own, "thing.level", "physics")
    # What it was before it was fed at all.
    assert thing.level == 7.0
    before = thing.times
    to(own, 2.0)
    assert thing.times == before


@pytest.mark.parametrize(
    ("name", "source", "how", "told"),
    [
        ("thing.size", 1, "hold", r"no input 'thing.size': Own has thing.level, and its pins ADCIN\.\."),
        ("ADCINE0", 1, "hold", "no input 'ADCINE0': this chip has ADCINA0 to 15"),
        ("thing.level", 11, "hold", "feed at 0 s: 11: thing.level must be 0 to 10 m"),
        ("thing.level", ([0, 1], [1, -1]), "hold", "feed at 1 s: -1: thing.level must be 0 to 10 m"),
        ("thing.level", ([0, 1], [1, float("nan")]), "hold", "feed at 1 s: nan"),
        ("thing.level", ([1, 0], [1, 1]), "hold", "the time decreases"),
        ("thing.level", ([0, 1], [1]), "hold", "2 times, 1 values: expected as many"),
        ("thing.level", ([], []), "hold", "0 times, 0 values: expected as many"),
        ("thing.level", [1, 2], "hold", "feed of thing.level: "),
        ("thing.level", 1, "spline", "how 'spline': must be hold or linear"),
        ("thing.level", lambda time_s: -1, "hold", "feed at 0 s: -1: thing.level must be 0 to 10 m"),
    ],
)  # fmt: skip
def test_what_cannot_be_fed_says_what_can(own: BoardTarget, name: str, source: Source, how: str, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        feed(own, name, source, how=how)
    assert not own.feeds


def test_the_robot_has_these(robot: Bench) -> None:
    assert [each.name for each in inputs(robot.board)] == [
        "gyro.yaw_rate_rad_s", "gyro.yaw_digits", "gyro.temperature_c", "sonars.LEFT_range_m", "sonars.FRONT_range_m",
        "sonars.RIGHT_range_m", "left motor.angle_rad", "right motor.angle_rad", "bumper.pressed",
    ]  # fmt: skip


def edges(bench: Bench) -> list[int]:
    """The times of the edges of the left encoder from now on, in cycles."""
    found: list[int] = []

    def moved(count: int, start: int, end: int) -> None:
        found.extend(start + (end - start) * index // abs(count) for index in range(1, abs(count) + 1))

    bench.board.encoder_pins[10, 11].moved.connect(moved)
    return found


@pytest.mark.parametrize(
    # Counts are the middles between edges.  90.125 degrees are 180.25 edges, so the first is 0.75 of one away.
    ("unit", "begin", "turn", "first"), [("edges", 0.0, 720, 0.5), ("deg", 90.125, 360.0, 0.75)],
)  # fmt: skip
def test_edges_of_a_steady_turn_come_at_their_times(
    robot: Bench, unit: str, begin: float, turn: float, first: float
) -> None:
    robot.boot()
    found, told, began = edges(robot), list[tuple[int, float]](), robot.clock.now
    left = next(each for each in inputs(robot.board) if each.name == "left motor.angle_rad")
    left.log(lambda cycles, angle_rad: told.append((cycles, angle_rad)))
    # A turn in 0.72 s is an edge a millisecond.
    feed(robot, left.name, ([0.0, 0.72], [begin, begin + turn]), how="linear", unit=unit, from_now=True)
    robot.run_for(1.0)
    assert len(found) == 720
    for index, cycles in enumerate(found):
        assert cycles - began == pytest.approx((index + first) * 200_000, abs=2)
    # A trace has each of them, and counts from where it began.
    assert [cycles for cycles, _ in told[1:]] == found
    assert told[-1][1] - told[0][1] == pytest.approx(2 * pi)


def test_a_trace_has_each_edge_of_a_longer_movement(robot: Bench) -> None:
    told: list[int] = []
    left = next(each for each in inputs(robot.board) if each.name == "left motor.angle_rad")
    left.log(lambda cycles, angle_rad: told.append(cycles))
    robot.board.encoder_pins[10, 11].move(-4, 1000, 2000)
    assert told == [0, 1250, 1500, 1750, 2000]


def test_what_the_shaft_does_is_nothing_to_a_fed_encoder_and_comes_back(robot: Bench) -> None:
    robot.boot()
    pins = robot.board.encoder_pins[10, 11]
    feed(robot, "left motor.angle_rad", 0.0)
    robot.feed(b"#TELE\r#SETR0.3,0.0\r")
    robot.run_for(1.5)
    stood = pins.position
    assert robot.world.travelled_m > 0.05
    assert robot.board.encoder_pins[62, 63].position > 100
    feed(robot, "left motor.angle_rad", "physics")
    assert pins.position == stood, "no jump"
    # The corrected robot stopped because a wheel did not follow, and drives again once it was told to stand.
    robot.feed(b"#SETR0.0,0.0\r")
    robot.run_for(0.1)
    robot.feed(b"#SETR0.3,0.0\r")
    robot.run_for(0.5)
    assert pins.position > stood + 50


def test_a_gyro_is_fed_with_digits(robot: Bench) -> None:
    robot.boot()
    feed(robot, "gyro.yaw_digits", ([0.0, 0.5], [-321, 1234]), from_now=True)
    gyro = robot.board.only(L3G4200D, "gyro")

    def z() -> int:
        low, high = (gyro.read_register(address) for address in (0x2C, 0x2D))
        return (high << 8 | low) - (0x10000 if high & 0x80 else 0)

    robot.run_for(0.4)
    assert z() == -321
    robot.run_for(0.2)
    assert z() == 1234
    feed(robot, "gyro.yaw_digits", "physics")
    robot.run_for(0.1)
    assert z() == 0


def test_a_sonar_and_the_gyro_come_back_to_the_world(robot: Bench) -> None:
    robot.boot()
    sensor = robot.board.sonars.sensors["FRONT"]
    was, rates = sensor.last_reading_in, robot.board.gyro.rate_source
    feed(robot, "sonars.FRONT_range_m", 1.0)
    feed(robot, "gyro.yaw_rate_rad_s", 90, unit="dps")
    robot.run_for(0.4)
    # 1 m is 39.37 inches; the part below a whole one is dropped.
    assert sensor.last_reading_in == 39 != was
    assert robot.board.gyro.rate_source(0) == (0.0, 0.0, radians(90))
    for name in list(robot.feeds):
        feed(robot, name, "physics")
    robot.run_for(0.4)
    assert sensor.last_reading_in == was
    assert robot.board.gyro.rate_source == rates


def test_a_bumper_that_is_fed_hears_its_world_afterwards(robot: Bench) -> None:
    robot.boot()
    bumper, changes = robot.board.bumper, []
    bumper.pressed_changed.connect(lambda pressed: changes.append((robot.clock.now - began, pressed)))
    began = robot.clock.now
    feed(robot, "bumper.pressed", ([0.0, 0.25, 0.5], [0, 1, 0]), from_now=True)
    bumper.press(True)
    robot.run_for(1.0)
    assert changes == [(50_000_000, True), (100_000_000, False)]
    feed(robot, "bumper.pressed", "physics")
    assert bumper.pressed


def test_without_a_feed_nothing_is_in_the_way(robot: Bench) -> None:
    board = robot.board
    assert board.gyro.rate_source == robot.world.rate_source
    assert all(each.range_source == robot.world.range_source for each in board.sonars.sensors.values())
    assert board.left_motor.encoder is board.encoder_pins[10, 11]
    assert robot.feeds == {}
    assert "feeds" not in robot.setup.as_dict()


def csv(tmp_path: Path) -> Path:
    file = tmp_path / "t.csv"
    text = "time_s,gyro.yaw_rate_rad_s [deg/s],sonars.FRONT_range_m\n-2,0,1\n0,0,1\n1,90,2\n"
    file.write_text(text, encoding="utf-8")
    return file


def test_going_back_feeds_the_same_whatever_the_file_holds_by_now(tmp_path: Path) -> None:
    file = csv(tmp_path)
    first = RewindableRun(Setup(feeds=(f"{file},linear",), fixes=("all",)))
    first.boot()
    first.run_until(first.clock.now + SYSCLK_HZ)
    file.write_text("nothing", encoding="utf-8")
    again = first.again()
    again.boot()
    again.run_until(first.clock.now)
    assert again.trace_sha256 == first.trace_sha256
    assert again.uart_sha256 == first.uart_sha256
    assert again.bench.board.gyro.rate_source(first.clock.now)[2] == pytest.approx(pi / 2)
    for run in (first, again):
        run.close()


def test_texts_are_taken_one_after_the_other(tmp_path: Path) -> None:
    file = csv(tmp_path)
    feeds = (str(file), f"gyro.yaw_rate_rad_s={file}#sonars.FRONT_range_m", "sonars.FRONT_range_m=physics")
    with pytest.raises(ValueError, match=r"t.csv: no column 'no': there are gyro"):
        running(Setup(feeds=(f"ADCINA3={file}#no",)))
    bench = running(Setup(feeds=feeds))
    assert list(bench.feeds) == ["gyro.yaw_rate_rad_s"]


SCENARIO = """seconds = 1
orders = []
[[feed]]
file = "t.csv"
how = "linear"
[[feed]]
input = "ADCINA2"
value = 0.25
[[feed]]
input = "bumper.pressed"
values = [
  [0, 0],
  [0.25, 1],
]
"""


def test_a_scenario_has_feeds_from_files_beside_it(tmp_path: Path) -> None:
    csv(tmp_path)
    path = tmp_path / "a.scenario.toml"
    path.write_text(SCENARIO, encoding="utf-8")
    scenario, _ = load_scenario(path, Policy())
    assert scenario.setup.feeds == (
        f"{tmp_path / 't.csv'},linear", "ADCINA2=0.25", "bumper.pressed=[[0, 0], [0.25, 1]],hold",
    )  # fmt: skip
    bench = scenario.bench()
    assert set(bench.feeds) == {"gyro.yaw_rate_rad_s", "sonars.FRONT_range_m", "ADCINA2", "bumper.pressed"}
    bench.close()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('file = "t.csv"', 'file = "u.csv"', r":4: feed\[0\].file: there is no file .*u.csv"),
        ('input = "ADCINA2"\n', "", r":6: feed\[1\]: input is missing: name the input that sees the value"),
        ('how = "linear"', 'how = "cubic"', r":5: feed\[0\].how: 'cubic' must be one of hold, linear"),
        ('file = "t.csv"\n', "", r":3: feed\[0\]: one of value, values, file must be given"),
        ('input = "bumper.pressed"\n', "", r":9: feed\[2\]: input is missing: name the input that sees the values"),
        ("[0, 0]", "[0]", r":11: feed\[2\].values\[0\]: \[0\] must be a pair of numbers"),
        ("[0, 0]", "[0.5, 0]", r":11: feed\[2\].values\[1\]: \[0.25, 1\] after \[0.5, 0\]: the time decreases"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_scenario_is_told_with_its_line(tmp_path: Path, old: str, new: str, told: str) -> None:
    csv(tmp_path)
    path = tmp_path / "a.scenario.toml"
    path.write_text(SCENARIO.replace(old, new), encoding="utf-8")
    with pytest.raises(ValueError, match=told):
        load_scenario(path, Policy())


def test_the_fixture_takes_time_from_now(
    board: Board, feed: Callable[..., None], advance: Callable[[float], None]
) -> None:
    advance(0.5)
    feed("ADCINA3", ([0.0, 0.1], [1.0, 2.0]), how="linear")
    advance(0.05)
    assert board.analog["A"][3].source.volts(board.clock.now) == pytest.approx(1.5)
