"""The drivers of the page in a world: what they read is what the world is, by geometry and mechanics of this file."""

from __future__ import annotations

from math import cos, inf, pi, radians, sin
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hil.bench import Bench
from hil.machine import Setup
from hil.robot.board import RobotBoard
from hil.robot.mounting import mounted
from hil.world.maps import WorldMap, parse_map
from hil.world.world import World
from tests.hil.robot.options.page import FILES

pytest.importorskip("pycparser")

ALL = ["five-sonars", "accelerometer", "lidar"]

#: Half the distance of two opposite walls of an octagon, which looks at the robot from eight sides.
APOTHEM_M = 1.2
#: Its walls' directions as the middle sees them.
SIDES = [index * pi / 4.0 for index in range(8)]
X_M, Y_M, HEADING = 0.10, -0.15, radians(5.0)


def octagon() -> WorldMap:
    corner_m = APOTHEM_M / cos(pi / 8.0)
    points = [[corner_m * cos(side + pi / 8.0), corner_m * sin(side + pi / 8.0)] for side in SIDES]
    return parse_map(
        f'name = "octagon"\n[start]\nx_m = {X_M}\ny_m = {Y_M}\nheading_deg = 5.0\n'
        f"[[wall]]\npoints_m = {points}\nclosed = true\n"
    )


def one_wall(degrees: float) -> WorldMap:
    """A long wall 0.6 m away, whose perpendicular lies so far to the left of ahead."""
    angle = radians(degrees)
    x, y, ux, uy = 0.6 * cos(angle), 0.6 * sin(angle), -sin(angle), cos(angle)
    points = [[x - 5.0 * ux, y - 5.0 * uy], [x + 5.0 * ux, y + 5.0 * uy]]
    return parse_map(
        f'name = "wall"\n[start]\nx_m = 0.0\ny_m = 0.0\nheading_deg = 0.0\n[[wall]]\npoints_m = {points}\n'
    )


@pytest.fixture
def firmware_modules(request: pytest.FixtureRequest, tmp_path: Path) -> list[str]:
    """The driver of the page that a test names with the marker `driver`."""
    name = request.function.driver
    (tmp_path / name).write_text(FILES[name], encoding="utf-8")
    return [str(tmp_path / name)]


def driver(name: str) -> Any:
    """The test runs this file of the page on a board with every option."""

    def marked(function: Any) -> Any:
        function.driver = name
        return pytest.mark.board("robot", options=ALL)(function)

    return marked


@pytest.fixture
def world(board: RobotBoard) -> World:
    """The octagon with the robot in it, ideal as the test's parts are."""
    return mounted(board, octagon(), None if board.ideal else 1)


# Five sonars

#: Left, front, right, front left, front right: place on the robot, direction.
MOUNTS = [(0.055, 0.055, 90), (0.090, 0.0, 0), (0.055, -0.055, -90), (0.080, 0.040, 45), (0.080, -0.040, -45)]


@driver("five_us.c")
def test_five_sonars_read_the_walls(firmware: Any, world: World, advance: Any) -> None:
    firmware.five_us.Init_Five_US()
    advance(0.6)
    cm = firmware.array("float", [0] * 5)
    firmware.five_us.Read_Five_US(cm)
    for read_cm, (ahead_m, left_m, degrees) in zip(cm, MOUNTS, strict=True):
        x = X_M + ahead_m * cos(HEADING) - left_m * sin(HEADING)
        y = Y_M + ahead_m * sin(HEADING) + left_m * cos(HEADING)
        # The foot of the perpendicular on the wall that faces it, 5 degrees off.
        true_cm = 100.0 * (APOTHEM_M - x * cos(radians(degrees)) - y * sin(radians(degrees)))
        # The sheet: whole inches, cut off; half a count of the converter besides.
        assert true_cm - 2.54 - 0.2 <= read_cm <= true_cm + 0.2


@pytest.mark.parametrize("degrees", [40.0, 45.0, 50.0, -45.0])
def test_a_wall_that_three_sonars_lose_is_seen_by_five(degrees: float) -> None:
    seen = {}
    for options in ((), ("five-sonars",)):
        board = RobotBoard(options=options)
        world = mounted(board, one_wall(degrees), None)
        seen[options] = {name for name in board.sonars.sensors if world.range_source(name, 0) is not None}
    assert seen[()] == set(), "thesis 3.2.2: the blind spot"
    assert seen["five-sonars",] == {"FRONT_LEFT" if degrees > 0 else "FRONT_RIGHT"}


# Accelerometer


@driver("accelerometer.c")
def test_at_rest_it_feels_its_weight(firmware: Any, world: World) -> None:
    assert firmware.accelerometer.Init_Accelerometer() == 0x33
    m_s2 = firmware.array("float", [9.0] * 3)
    firmware.accelerometer.Read_Accelerometer(m_s2)
    assert list(m_s2) == pytest.approx([0.0, 0.0, 9.81], abs=0.005 + 1e-6)


@driver("accelerometer.c")
def test_a_drive_is_what_the_world_drives(firmware: Any, board: RobotBoard, world: World) -> None:
    """100 samples a second while the robot starts on a curve to the left, and is let go."""
    firmware.accelerometer.Init_Accelerometer()
    m_s2 = firmware.array("float", [0.0] * 3)
    firmware.accelerometer.Read_Accelerometer(m_s2)
    board.pwm_outputs["GPIO2"].set(0.55, 10_000)
    board.pwm_outputs["GPIO12"].set(0.85, 10_000)
    speed = turned = 0.0
    believed = 0.0
    peak = sideways = 0.0
    for index in range(80):
        if index == 50:
            board.pwm_outputs["GPIO2"].set(0.0, 0)
            board.pwm_outputs["GPIO12"].set(0.0, 0)
        x0, y0, heading0 = world.pose
        firmware.accelerometer.Read_Accelerometer(m_s2)
        world.sync_now()
        x1, y1, heading1 = world.pose
        # From the ways alone: speed along the robot's middle direction, and how fast that turns.
        middle = 0.5 * (heading0 + heading1)
        mean_speed = ((x1 - x0) * cos(middle) + (y1 - y0) * sin(middle)) / 0.01
        yaw_rate = (heading1 - heading0) / 0.01
        assert m_s2[1] == pytest.approx(mean_speed * yaw_rate, abs=0.03)
        assert m_s2[2] == pytest.approx(9.81, abs=0.005 + 1e-6)
        # Each sample is within half a digit of 9.8 mm/s2; the driver reads it 0.1 ms late.
        now = world.robot.v_m_s
        assert m_s2[0] == pytest.approx((now - speed) / 0.01, abs=0.06)
        believed += m_s2[0] * 0.01
        speed, turned = now, heading1
        assert believed == pytest.approx(speed, abs=0.008)
        peak, sideways = max(peak, speed), max(sideways, m_s2[1])
    assert peak > 0.1, "it has driven"
    assert turned > HEADING + 0.1, "to the left"
    assert sideways > 0.05


@pytest.mark.realistic
@driver("accelerometer.c")
def test_a_specimen_is_off_by_what_the_sheet_allows(firmware: Any, world: World) -> None:
    firmware.accelerometer.Init_Accelerometer()
    m_s2 = firmware.array("float", [0.0] * 3)
    seen = []
    for _ in range(30):
        firmware.accelerometer.Read_Accelerometer(m_s2)
        seen.append(list(m_s2))
    for values, true in zip(zip(*seen, strict=True), (0.0, 0.0, 9.81), strict=True):
        # 40 mg of zero-g level, five times 0.73 mg of noise, half a digit.
        assert all(abs(value - true) <= 9.81 * (0.040 + 0.0037 + 0.0005) for value in values)
        assert len(set(values)) > 1


# LiDAR


def to_the_walls_m(x: float, y: float, direction: float) -> float:
    """Along a ray to the octagon."""
    reaches = [
        (APOTHEM_M - x * cos(side) - y * sin(side)) / cos(direction - side)
        for side in SIDES
        if cos(direction - side) > 1e-9
    ]
    return min(reaches, default=inf)


def of_a_degree_m(degrees: int) -> list[float]:
    """The true distances within one whole degree, clockwise from ahead, from 25 mm ahead of the axle."""
    x, y = X_M + 0.025 * cos(HEADING), Y_M + 0.025 * sin(HEADING)
    return [to_the_walls_m(x, y, HEADING - radians(degrees + part / 20.0)) for part in range(-1, 22)]


@driver("lidar.c")
def test_a_scan_is_the_octagon(firmware: Any, world: World) -> None:
    firmware.lidar.Init_Lidar()
    firmware.lidar.Lidar_Request(0x20)
    firmware.lidar.Lidar_Listen(4000)
    for degrees, quarters in enumerate(firmware.lidar.Lidar_Distance):
        true = of_a_degree_m(degrees)
        # The sheet: steps below 0.5 mm.
        assert min(true) - 0.0005 <= quarters / 4000.0 <= max(true) + 0.0005, degrees
    assert firmware.lidar.Lidar_Turns == 2
    assert firmware.lidar.Lidar_Skipped == 0


@pytest.mark.realistic
@driver("lidar.c")
def test_a_scan_of_a_specimen_is_within_1_percent(firmware: Any, world: World) -> None:
    firmware.lidar.Init_Lidar()
    firmware.lidar.Lidar_Request(0x20)
    firmware.lidar.Lidar_Listen(4000)
    exact = 0
    for degrees, quarters in enumerate(firmware.lidar.Lidar_Distance):
        true = of_a_degree_m(degrees)
        assert 0.99 * min(true) - 0.0005 <= quarters / 4000.0 <= 1.01 * max(true) + 0.0005, degrees
        exact += min(true) - 0.0005 <= quarters / 4000.0 <= max(true) + 0.0005
    assert exact < 300


@driver("lidar.c")
def test_an_obstacle_on_the_right_is_seen_there(firmware: Any, world: World) -> None:
    """Clockwise is to the right: a post at 90 degrees, 0.5 m away."""
    x, y = X_M + 0.025 * cos(HEADING), Y_M + 0.025 * sin(HEADING)
    world.add_obstacle("post", x + 0.5 * sin(HEADING), y - 0.5 * cos(HEADING), 0.1)
    firmware.lidar.Init_Lidar()
    firmware.lidar.Lidar_Request(0x20)
    firmware.lidar.Lidar_Listen(4000)
    distances = list(firmware.lidar.Lidar_Distance)
    assert distances[90] / 4000.0 == pytest.approx(0.45, abs=0.002)
    assert distances[270] / 4000.0 > 0.6
    # It covers 5.7 degrees to each side, so the whole degrees 85 to 94, and a part of 84 and of 95.
    covered = {degrees for degrees in range(360) if distances[degrees] / 4000.0 < 0.51}
    assert set(range(85, 95)) <= covered <= set(range(84, 96))


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(bursts=st.lists(st.one_of(st.binary(max_size=200), st.just(bytes.fromhex("a55a0500004081"))), max_size=6))
@driver("lidar.c")
def test_no_bytes_upset_the_parser(firmware: Any, bursts: list[bytes]) -> None:
    """Whatever comes, at any place of a frame: no finding (they fail the test), and every byte is accounted for."""
    lidar = firmware.lidar
    for byte in b"".join(bursts):
        lidar.Lidar_Byte(byte)
    assert len(lidar.Lidar_Distance) == 360


# The rest of the robot


def test_the_robot_drives_its_mission_with_every_option() -> None:
    """Its own firmware asks for none of them: no finding is new, and it drives."""
    rules = []
    for options in ((), tuple(ALL)):
        bench = Bench(Setup(world="box", options=options, realistic=False), traced=False)
        bench.boot()
        bench.feed(b"#MISN\r")
        bench.run_for(3.0)
        rules.append({finding.rule for finding in bench.findings})
        assert bench.status().state == "MISSION"
        bench.close()
    assert rules[1] <= rules[0]


def test_an_option_that_nobody_asks_costs_no_event() -> None:
    """In power-down, and before a scan, the parts are silent."""
    plain, full = RobotBoard(), RobotBoard(options=("accelerometer", "lidar"))
    for board in (plain, full):
        board.clock.advance_to(20_000_000)
    assert full.clock.events_run == plain.clock.events_run
    assert len(full.clock.waiting()) == len(plain.clock.waiting())
