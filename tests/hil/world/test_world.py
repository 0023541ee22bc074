"""The world on a clock: lazy integration, sensors that ask, obstacles, bumper, the logged path."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import pi

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Clock
from hil.world import Pose, World, load_map
from hil.world.maps import parse_map
from tests.hil.world.rig import Rover, act, motor

MS = CYCLES_PER_MS
S = 1000 * MS

HALL = parse_map('name = "hall"\n[start]\nx_m = 0\ny_m = 0\n[[wall]]\npoints_m = [[3, -9], [3, 9]]')


def world(attached: bool = False, seed: int | None = None) -> tuple[World, Clock]:
    clock = Clock()
    one = World(HALL, motor(), motor(), seed=seed)
    if attached:
        one.attach(clock)
    act(one.robot.left, 0.0)
    act(one.robot.right, 0.0)
    return one, clock


def go(one: World, left: float, right: float) -> None:
    act(one.robot.left, left)
    act(one.robot.right, right)


def test_nothing_moves_until_somebody_looks_and_then_up_to_exactly_now() -> None:
    one, _ = world()
    go(one, 0.5, 0.5)
    one.sync(100 * MS)
    there = one.pose.x_m
    assert there > 0.0
    one.sync(100 * MS)
    one.sync(50 * MS)  # a time that has passed
    assert (one.pose.x_m, one.time_cycles) == (there, 100 * MS)


def test_a_longer_second_moves_it_less_in_a_cycle() -> None:
    one, clock = world(attached=True)
    slow, slow_clock = world(attached=True)
    for each in (one, slow):
        go(each, 0.6, 0.5)
    clock.advance_to(S)
    slow_clock.advance_to(S // 2)
    slow.set_second(1.1 * SYSCLK_HZ)
    # Half a second, and half a second of 1.1 times as many cycles.
    slow_clock.advance_to(S // 2 + 11 * S // 20)
    for each in (one, slow):
        each.sync_now()
    assert slow.pose.x_m == pytest.approx(one.pose.x_m, rel=1e-5)
    assert slow.pose.heading_rad == pytest.approx(one.pose.heading_rad, rel=1e-5)
    assert slow.robot.v_m_s == pytest.approx(one.robot.v_m_s, rel=1e-5)
    # Between two looks the rate is that of true seconds, too.
    assert slow.yaw_rate_rad_s(slow_clock.now - 5 * MS) == pytest.approx(one.yaw_rate_rad_s(clock.now), rel=1e-3)


def test_a_new_duty_works_from_its_own_time_on() -> None:
    one, clock = world(attached=True)
    clock.advance_to(4 * MS)  # before the first periodic look
    go(one, 0.8, 0.8)
    clock.advance_to(7 * MS)
    one.sync_now()
    late = one.robot.left.omega_rad_s

    direct, _ = world()
    go(direct, 0.8, 0.8)
    direct.sync(3 * MS)
    assert late == direct.robot.left.omega_rad_s > 0.0


def test_an_encoder_reader_brings_the_plant_up_to_date() -> None:
    one, clock = world(attached=True)
    go(one, 0.8, 0.8)
    clock.advance_to(8 * MS)
    encoder = one.robot.left.encoder
    assert encoder.position == 0
    clock.advance_to(205 * MS)
    before = encoder.position
    encoder.sync()
    assert encoder.position > before > 0
    assert one.time_cycles == 205 * MS


def test_the_plant_is_looked_at_every_10_ms() -> None:
    one, clock = world(attached=True)
    seen = []
    for k in range(1, 6):
        clock.advance_to(k * 10 * MS)
        seen.append(one.time_cycles)
    assert seen == [k * 10 * MS for k in range(1, 6)]


def test_a_world_lives_on_one_clock_only() -> None:
    one, _ = world(attached=True)
    with pytest.raises(ValueError, match="attached already"):
        one.attach(Clock())


@settings(deadline=None, max_examples=20)
@given(
    actions=st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=4),
    extra=st.lists(st.integers(1, 999), max_size=30, unique=True),
)
def test_looking_more_often_does_not_change_the_run(actions: list[tuple[float, float]], extra: list[int]) -> None:
    """Stated tolerance: 2 mm and 20 mrad; equal times of looking are bit-equal."""

    def run(looks: list[int]) -> World:
        one, clock = world(attached=True)
        for k, (left, right) in enumerate(actions):
            clock.advance_to(k * 250 * MS)
            go(one, left, right)
            for look in looks:
                clock.advance_to(k * 250 * MS + look * MS // 4)
                one.sync_now()
        clock.advance_to(len(actions) * 250 * MS)
        one.sync_now()
        return one

    few, many = run([]), run(sorted(extra))
    assert (many.pose.x_m, many.pose.y_m) == pytest.approx((few.pose.x_m, few.pose.y_m), abs=2e-3)
    assert many.pose.heading_rad == pytest.approx(few.pose.heading_rad, abs=2e-2)
    assert run(sorted(extra)).pose == many.pose


def test_the_yaw_rate_is_exact_now_and_at_each_look_and_lies_between_for_the_past() -> None:
    one, _ = world()
    go(one, -0.6, 0.6)
    rates = {}
    for k in range(1, 61):
        one.sync(k * 5 * MS)
        rates[k] = one.robot.w_rad_s
    assert one.yaw_rate_rad_s(300 * MS) == rates[60] > 1.0
    assert one.rate_source(300 * MS) == (0.0, 0.0, rates[60])
    assert one.yaw_rate_rad_s(250 * MS) == rates[50]
    # While it gathers speed the rate bends down: above the chord, by 1/8 of the second difference
    middle = one.yaw_rate_rad_s(22 * MS + MS // 2)
    bend = (rates[4] + rates[5] - (rates[3] + rates[6])) / 2 / 8
    assert middle == pytest.approx((rates[4] + rates[5]) / 2 + bend, rel=1e-4)
    assert one.yaw_rate_rad_s(305 * MS) > rates[60] * 0.99  # later than known: integrates
    assert one.time_cycles == 305 * MS


BOX = parse_map(
    'name = "box"\n[start]\nx_m = 0.3\ny_m = 0.3\n[[wall]]\npoints_m = [[0, 0], [0.6, 0], [0.6, 0.5], [0, 0.5]]\n'
    "closed = true\n[[post]]\nx_m = 0.5\ny_m = 0.4\ndiameter_m = 0.04\n"
)


@settings(deadline=None, max_examples=40)
@given(
    actions=st.lists(
        st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.lists(st.integers(1, 500_000), min_size=1, max_size=25)),
        min_size=1, max_size=6,
    ),
    heading=st.floats(-pi, pi),
    grip=st.sampled_from([1.0, 0.1]),
)  # fmt: skip
def test_the_yaw_rate_of_the_past_adds_up_to_the_turn_between_any_two_looks(
    actions: list[tuple[float, float, list[int]]], heading: float, grip: float
) -> None:
    """In a box with a post, so that it hits and slides.  Milne's rule, open and exact up to the third degree, over each
    gap of a multiple of 4 cycles; the first gap begins where the robot was put down, turned from where it started."""
    one = World(replace(BOX, grip=grip), motor(), motor())
    one.sync(2 * MS)
    one.place(Pose(0.3, 0.3, heading))
    looks = [(2 * MS, one.pose.heading_rad)]
    for left, right, gaps in actions:
        go(one, left, right)
        for quarter in gaps:  # up to 10 ms
            one.sync(looks[-1][0] + 4 * quarter)
            looks.append((one.time_cycles, one.pose.heading_rad))
    turned = 0.0
    for (before, _), (after, then) in pairwise(looks):
        quarter = (after - before) // 4
        rates = [one.yaw_rate_rad_s(before + k * quarter) for k in (1, 2, 3)]
        turned += (after - before) / S * (2.0 * rates[0] - rates[1] + 2.0 * rates[2]) / 3.0
        assert looks[0][1] + turned == pytest.approx(then, rel=1e-12, abs=1e-12)
        assert all(abs(rate) < 6.3 for rate in rates)  # 2 x 0.027 m / 0.13 m x 7.2 V / 0.478 V.s, nowhere overshot


def test_a_robot_that_is_put_down_elsewhere_has_not_turned() -> None:
    one, clock = world(attached=True)
    clock.advance_to(14 * MS)
    one.place(Pose(0.0, 0.0, 2.0))
    clock.advance_to(50 * MS)
    assert [one.yaw_rate_rad_s(k * MS // 2) for k in range(100)] == [0.0] * 100


def test_putting_the_robot_down_ends_what_it_did_until_then() -> None:
    one, clock = world(attached=True)
    go(one, 0.8, 0.8)
    clock.advance_to(307 * MS)
    before = one.robot.left.encoder.position
    one.place(Pose(1.0, 1.0, 0.0))
    assert one.time_cycles == 307 * MS
    assert one.robot.left.encoder.position > before  # the 7 ms since the last look
    assert one.path.points() == [(0.307, 1.0, 1.0, 0.0)]


def test_the_memory_of_yaw_rates_is_bounded_and_old_questions_get_the_oldest() -> None:
    one, _ = world()
    go(one, -0.6, 0.6)
    for k in range(1, 3000):
        one.sync(k * MS)
    assert len(one._past) <= 512
    assert one.yaw_rate_rad_s(0) == one._past[0][2] > 0.0
    assert one.yaw_rate_rad_s(2990 * MS) == pytest.approx(one.robot.w_rad_s, rel=1e-3)


def test_a_sonar_ping_sees_the_pose_of_its_own_time() -> None:
    one, _ = world()
    go(one, 0.5, 0.5)
    echo = one.range_source("FRONT", 2 * S)
    assert echo is not None
    # the wall at 3 m less the robot's way and the sonar's place, 0.09 m ahead of the axle
    assert echo.range_m == pytest.approx(3.0 - one.pose.x_m - 0.09)
    assert one.time_cycles == 2 * S
    assert one.range_source("LEFT", 2 * S) is None
    assert one.cross_source("FRONT", "LEFT", 2 * S) is None


def test_obstacles_come_move_and_go_and_are_heard() -> None:
    one, _ = world()
    one.add_obstacle("person", 1.09, 0.0, 0.2)
    echo = one.range_source("FRONT", MS)
    assert echo is not None
    assert echo.range_m == pytest.approx(0.9)
    one.move_obstacle("person", 1.09, 3.0)
    echo = one.range_source("FRONT", 2 * MS)
    assert echo is not None
    assert echo.range_m == pytest.approx(2.91)
    with pytest.raises(ValueError, match="there is an obstacle 'person' already"):
        one.add_obstacle("person", 0.0, 1.0, 0.1)
    one.remove_obstacle("person")
    with pytest.raises(ValueError, match="no obstacle 'person'; there are: none"):
        one.remove_obstacle("person")
    with pytest.raises(ValueError, match="must be finite, radius above 0"):
        one.add_obstacle("ghost", float("nan"), 0.0, 0.1)


def test_the_map_itself_keeps_its_posts() -> None:
    room = load_map("room")
    one = World(room, motor(), motor())
    before = [(post.x_m, post.y_m) for post in room.posts]
    one.move_obstacle("lamp", 1.0, 2.0)
    assert [(post.x_m, post.y_m) for post in room.posts] == before
    assert World(room, motor(), motor()).posts[1].x_m == before[1][0]


def test_an_obstacle_put_against_the_bumper_presses_it_at_once_and_releases_it() -> None:
    one, clock = world(attached=True)
    events: list[tuple[int, bool]] = []
    one.bumper_changed.connect(lambda pressed: events.append((clock.now, pressed)))
    clock.advance_to(33 * MS)
    one.add_obstacle("hand", 0.12 + 0.05, 0.0, 0.1)  # touches the front of the body
    clock.advance_to(50 * MS)
    one.remove_obstacle("hand")
    assert events == [(33 * MS, True), (50 * MS, False)]


def test_a_bump_is_told_within_10_ms_and_once() -> None:
    rover_world, clock = world(attached=True)
    events: list[tuple[int, bool]] = []
    rover_world.bumper_changed.connect(lambda pressed: events.append((clock.now, pressed)))
    rover_world.place(Pose(2.5, 0.0, 0.0))
    go(rover_world, 0.5, 0.5)
    clock.advance_to(5 * S)
    assert [pressed for _, pressed in events] == [True]
    # 0.38 m to go at 0.15..0.2 m/s after the start
    assert 1.9 * S < events[0][0] < 2.8 * S
    assert rover_world.bumper_pressed


def test_the_logged_path_is_a_point_each_centimetre() -> None:
    one, _ = world()
    go(one, 0.5, 0.5)
    for k in range(1, 401):
        one.sync(k * 5 * MS)
    way = one.pose.x_m
    assert one.path.points()[0] == (0.0, 0.0, 0.0, 0.0)
    assert len(one.path) == pytest.approx(way / 0.0105, rel=0.1)
    assert one.travelled_m == pytest.approx(way, abs=0.02)
    one.place(Pose(1.0, 1.0, pi))
    assert one.path.points() == [(one.time_cycles / 200e6, 1.0, 1.0, pi)]


def test_a_seed_draws_the_same_realistic_robot_and_None_the_ideal_one() -> None:
    assert world(seed=4)[0].robot.params == world(seed=4)[0].robot.params != world(seed=5)[0].robot.params
    assert world()[0].robot.params.slip_left == 0.0


def test_two_runs_of_one_seed_are_the_same_run() -> None:
    def run() -> tuple[object, ...]:
        rover = Rover(load_map("room"), seed=3)
        rover.run(20.0)
        one = rover.world
        return one.pose, one.path.points(), one.robot.left.encoder.position, rover.bumps, rover.seen_m

    assert run() == run()
