"""The plant: kinematics, dynamics, traction, collision."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.world import Pose, RobotParams
from hil.world.contact import ContactRow, solve
from hil.world.geometry import Post, Segment
from hil.world.robot import Robot
from hil.world.rolling import one_wheel, two_wheels
from tests.hil.world.rig import act, motor

S = 200_000_000
MS = S // 1000
R, TRACK = 0.027, 0.13


def robot(params: RobotParams | None = None, max_step_s: float = 0.005) -> Robot:
    one = Robot(motor(), motor(), params, max_step_s)
    one.surround((), [])
    act(one.left, 0.0)
    act(one.right, 0.0)
    return one


def drive(one: Robot, left: float, right: float, seconds: float, start: int = 0, step: int = 5 * MS) -> int:
    act(one.left, left)
    act(one.right, right)
    end = start + round(seconds * S)
    while start < end:
        one.advance(start, min(end, start + step))
        start += step
    return end


@given(
    left=st.floats(-15, 15),
    right=st.floats(-15, 15),
    heading=st.floats(-pi, pi),
    seconds=st.floats(0.001, 0.02),
)
def test_constant_wheel_speeds_draw_an_exact_arc(left: float, right: float, heading: float, seconds: float) -> None:
    """The circle's own formula: radius = v / w about a fixed centre."""
    one = robot()
    one.place(Pose(1.0, 2.0, heading))
    one.left.omega_rad_s, one.right.omega_rad_s = left, right
    one._move(0, round(seconds * S), left, right, left * seconds, right * seconds)
    v, w = R * (left + right) / 2, R * (right - left) / TRACK
    turned = w * seconds
    if abs(turned) > 1e-3:
        radius = v / w
        after = heading + turned
        want = (1 + radius * (sin(after) - sin(heading)), 2 - radius * (cos(after) - cos(heading)))
        tolerance = max(1e-12, 1e-14 * abs(radius) / abs(turned))  # cancellation in this formula, not in the plant
    else:
        want = (1 + v * seconds * cos(heading + turned / 2), 2 + v * seconds * sin(heading + turned / 2))
        tolerance = 1e-9  # chord for arc: turn^2 / 24 of at most 8 mm
    assert (one.x_m, one.y_m) == pytest.approx(want, abs=tolerance)
    assert one.heading_rad == pytest.approx(heading + turned)
    assert (one.v_m_s, one.w_rad_s) == pytest.approx((v, w))


@given(
    d1=st.floats(1e-4, 0.1),
    d2=st.floats(1e-4, 0.1),
    w1=st.floats(-20, 20),
    w2=st.floats(-20, 20),
    t1=st.floats(-0.3, 0.3),
    t2=st.floats(-0.3, 0.3),
    shared=st.floats(-5e-4, 5e-4),
    span=st.floats(1e-5, 0.05),
)
@settings(max_examples=60, deadline=None)
def test_two_coupled_wheels_follow_the_matrix_exponential(
    d1: float, d2: float, w1: float, w2: float, t1: float, t2: float, shared: float, span: float
) -> None:
    """M w' = t - D w against a Taylor series of the 4x4 matrix (speeds and angles), summed by numpy."""
    inertia = np.array([[1.6e-3, shared], [shared, 1.5e-3]])
    inverse = np.linalg.inv(inertia)
    p = inverse @ np.diag([d1, d2])
    acceleration = inverse @ (np.array([t1, t2]) - np.array([d1 * w1, d2 * w2]))
    full = np.zeros((5, 5))
    full[:2, :2] = -p
    full[:2, 4] = inverse @ np.array([t1, t2])
    full[2:4, :2] = np.eye(2)
    state = np.array([w1, w2, 0.0, 0.0, 1.0])
    halvings = 8
    step = full * span / 2**halvings
    exponential = np.eye(5)
    term = np.eye(5)
    for k in range(1, 20):
        term = term @ step / k
        exponential = exponential + term
    for _ in range(halvings):
        exponential = exponential @ exponential
    want = exponential @ state
    got = two_wheels(w1, w2, *(float(a) for a in acceleration), tuple(float(x) for x in p.reshape(4)), span)  # type: ignore[arg-type]
    assert got == pytest.approx(tuple(want[:4]), rel=1e-6, abs=1e-7)


def test_one_wheel_without_damping_is_uniformly_accelerated() -> None:
    # 2 rad/s, 0.01 N.m on 2 g.m2: 5 rad/s2; after 0.1 s 2.5 rad/s and 0.225 rad
    assert one_wheel(2.0, 0.01, 0.0, 2e-3, 0.1) == pytest.approx((2.5, 0.225))


def test_equal_actions_drive_straight_and_the_final_speed_is_that_of_the_motors() -> None:
    one = robot()
    drive(one, 0.6, 0.6, 2.0)
    assert (one.y_m, one.heading_rad) == (0.0, 0.0)
    # At rest in speed the torque equals dry friction: 7.2 V x 0.6 - 0.4 x 0.4 V - i 7 ohm = Kb w,
    # i = (0.016 + 0.02 x 0.4 x 0.75 x 9.81 x 0.027 + 3e-4 w) / 0.317
    dry = 0.016 + 0.02 * 0.4 * 0.75 * 9.81 * 0.027
    want = (7.2 * 0.6 - 0.16 - 7 * dry / 0.317) / (0.478 + 7 * 3e-4 / 0.317)
    assert one.left.omega_rad_s == pytest.approx(want, rel=1e-6)
    assert one.v_m_s == pytest.approx(want * R, rel=1e-6)


def test_the_robot_reaches_0_3_m_s() -> None:
    one = robot()
    drive(one, 1.0, 1.0, 1.0)
    assert one.v_m_s > 0.3


def test_opposite_actions_turn_on_the_spot_counter_clockwise_when_the_right_wheel_leads() -> None:
    one = robot()
    drive(one, -0.5, 0.5, 1.0)
    assert one.heading_rad > 1.0
    assert (one.x_m, one.y_m) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_the_encoders_count_the_way_of_each_wheel() -> None:
    one = robot()
    drive(one, 0.5, 0.7, 2.0)
    # way of a wheel = mean way -+ half the track times the turn; 720 edges a revolution of 2 pi 27 mm
    for which, side in ((one.left, -1), (one.right, 1)):
        edges = which.encoder.position
        assert edges / 720 * 2 * pi * R == pytest.approx(which.angle_rad * R, abs=2 * pi * R / 720)
        assert (which.angle_rad - 0.5 * 2 * pi / 720) * R - side * TRACK / 2 * one.heading_rad == pytest.approx(
            (one.left.angle_rad + one.right.angle_rad - 2 * pi / 720) / 2 * R, abs=1e-9
        )


def test_a_braked_robot_stays_where_it_is_and_a_dead_zone_action_does_not_move_it() -> None:
    one = robot()
    drive(one, 0.0, 0.0, 1.0)
    drive(one, 0.05, -0.05, 1.0, S)
    assert one.pose == (0.0, 0.0, 0.0)
    assert (one.left.encoder.position, one.right.encoder.position) == (0, 0)


def test_coming_to_rest_it_really_rests() -> None:
    one = robot()
    end = drive(one, 0.6, 0.5, 1.0)
    end = drive(one, 0.0, 0.0, 1.0, end)
    rest = one.pose
    assert (one.v_m_s, one.w_rad_s, one.left.omega_rad_s) == (0.0, 0.0, 0.0)
    drive(one, 0.0, 0.0, 1.0, end)
    assert one.pose == rest


@settings(deadline=None, max_examples=30)
@given(
    plan=st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.integers(20, 400)), min_size=1, max_size=5),
    cuts=st.lists(st.integers(1, 4999), max_size=3, unique=True),
)
def test_many_small_integrations_give_the_state_of_few_large_ones(
    plan: list[tuple[float, float, int]], cuts: list[int]
) -> None:
    """Stated tolerance: 2 mm, 20 mrad and 3 % of speed after up to 2 s of violent driving (the first-order contact
    step rules while the tyres slide, the knee of the bridge while it saturates)."""

    def run(fine: bool) -> Robot:
        one = robot()
        now = 0
        for left, right, length in plan:
            act(one.left, left)
            act(one.right, right)
            end = now + length * MS
            while now < end:
                after = min(end, now + 5 * MS)
                marks = [now + cut * MS // 1000 for cut in sorted(cuts)] if fine else []
                for mark in [m for m in marks if now < m < after] + [after]:
                    one.advance(now, mark)
                    now = mark
        return one

    once, often = run(False), run(True)
    assert (often.x_m, often.y_m) == pytest.approx((once.x_m, once.y_m), abs=2e-3)
    assert often.heading_rad == pytest.approx(once.heading_rad, abs=2e-2)
    assert often.v_m_s == pytest.approx(once.v_m_s, rel=0.03, abs=2e-3)
    assert run(True).pose == often.pose  # equal call times: bit-equal


def test_on_a_slippery_floor_a_hard_start_spins_the_wheels() -> None:
    dry, wet = robot(), robot()
    wet.surround((), [], grip=0.1)
    for one in (dry, wet):
        drive(one, 1.0, 1.0, 0.3)
    assert dry.slipped_m == 0.0
    assert wet.slipped_m > 0.01
    rolled = wet.left.angle_rad * R
    assert wet.x_m < rolled - 0.01
    # Newton: no faster than friction allows, 0.1 x 0.8 x 0.8 of the weight
    assert wet.x_m <= 0.5 * 0.1 * 0.8 * 0.8 * 9.81 * 0.3**2 + 1e-3
    drive(wet, 1.0, 1.0, 3.0, round(0.3 * S))
    assert wet.v_m_s == pytest.approx(wet.left.omega_rad_s * R, rel=1e-3)  # holds again in the end


def test_a_realistic_robot_loses_a_little_way_and_curves_a_little() -> None:
    params = RobotParams().individual(Random(5))
    assert params == RobotParams().individual(Random(5)) != RobotParams().individual(Random(6))
    one = robot(params)
    drive(one, 0.5, 0.5, 3.0)
    rolled = (one.left.angle_rad + one.right.angle_rad) / 2 * R
    way = hypot(one.x_m, one.y_m)
    assert 0.98 * rolled < way < rolled
    assert 0.0 < abs(one.heading_rad) < 0.1


WALL = Segment(0.5, -5.0, 0.5, 5.0)


def test_a_wall_stops_the_body_and_presses_the_bumper() -> None:
    one = robot()
    one.surround((WALL,), [])
    end = drive(one, 0.5, 0.5, 4.0)
    # body: 0.025 m ahead of the axle plus 0.095 m of radius
    assert one.x_m == pytest.approx(0.5 - 0.12, abs=5e-4)
    assert abs(one.v_m_s) < 1e-3
    assert one.bumper_pressed
    assert one.collisions >= 1
    end = drive(one, -0.5, -0.5, 0.5, end)
    assert not one.bumper_pressed
    assert one.x_m < 0.37


def test_pushing_hard_the_wheels_slip_on_the_spot() -> None:
    one = robot()
    one.surround((WALL,), [], grip=0.5)
    drive(one, 1.0, 1.0, 4.0)
    assert one.slipped_m > 0.1
    assert one.x_m == pytest.approx(0.38, abs=5e-4)


def test_backing_into_a_wall_does_not_press_the_bumper() -> None:
    one = robot()
    one.surround((Segment(-0.5, -5, -0.5, 5),), [])
    drive(one, -0.5, -0.5, 4.0)
    assert one.x_m == pytest.approx(-0.5 + 0.07, abs=5e-4)  # 0.095 - 0.025
    assert not one.bumper_pressed


@pytest.mark.parametrize(("aside_deg", "pressed"), [(0, True), (40, True), (50, False), (-40, True), (-50, False)])
def test_the_bumper_covers_45_degrees_to_each_side(aside_deg: float, pressed: bool) -> None:
    one = robot()
    middle, reach = 0.025, 0.095 + 0.02 + 1e-4
    away = radians(aside_deg)
    one.surround((), [Post(middle + reach * cos(away), reach * sin(away), 0.02)])
    assert one.bumper_pressed is pressed


@settings(deadline=None, max_examples=25)
@given(heading=st.floats(-1.2, 1.2), left=st.floats(0.3, 1.0), right=st.floats(0.3, 1.0))
def test_whatever_it_does_in_a_box_the_body_stays_inside(heading: float, left: float, right: float) -> None:
    corners = [(0.0, 0.0), (0.6, 0.0), (0.6, 0.5), (0.0, 0.5), (0.0, 0.0)]
    walls = tuple(Segment(*corners[k], *corners[k + 1]) for k in range(4))
    one = robot()
    one.surround(walls, [Post(0.5, 0.4, 0.02)])
    one.place(Pose(0.2, 0.25, heading))
    now = 0
    for _ in range(6):
        now = drive(one, left, right, 0.5, now)
        cx, cy = one.x_m + 0.025 * cos(one.heading_rad), one.y_m + 0.025 * sin(one.heading_rad)
        assert min(wall.distance(cx, cy) for wall in walls) > 0.095 - 1e-3
        assert hypot(cx - 0.5, cy - 0.4) > 0.115 - 1e-3


def test_a_glancing_hit_is_slowed_by_the_wall_and_never_gains_speed() -> None:
    one = robot()
    one.surround((Segment(-5, 0.5, 5, 0.5),), [])
    one.place(Pose(0.0, 0.35, radians(20)))
    drive(one, 0.5, 0.5, 3.0)
    assert one.y_m < 0.405 + 1e-3
    free = robot()
    drive(free, 0.5, 0.5, 3.0)
    assert one.v_m_s <= free.v_m_s + 1e-9


def test_impulses_conserve_momentum_and_stay_within_their_bounds() -> None:
    # Two masses of 1 and 3 kg, coupled by one row with at most 0.5 N.s: from 2 and 0 m/s to 1.5 and 1/6 m/s
    velocities = [2.0, 0.0, 0.0, 0.0]
    masses = (1.0, 1.0 / 3.0, 1.0, 1.0)
    row = ContactRow((1.0, -1.0, 0.0, 0.0), 0.0, -0.5, 0.5, masses)
    solve(velocities, [row], masses, 0.005)
    assert velocities == pytest.approx([1.5, 1.0 / 6.0, 0.0, 0.0])
    assert row.impulse == -0.5
    # without the bound both end at 0.5 m/s
    velocities = [2.0, 0.0, 0.0, 0.0]
    solve(velocities, [ContactRow((1.0, -1.0, 0.0, 0.0), 0.0, -9.0, 9.0, masses)], masses, 0.005)
    assert velocities[:2] == pytest.approx([0.5, 0.5])


def test_a_step_beyond_5_ms_is_refused() -> None:
    with pytest.raises(ValueError, match=r"max_step_s 0.01: must be above 0 and at most 0.005 s"):
        robot(max_step_s=0.01)


@given(
    weak=st.lists(st.tuples(st.floats(0, 0.03), st.floats(0, 0.03), st.floats(0.001, 0.05)), max_size=4),
    left=st.floats(-1, 1),
    right=st.floats(-1, 1),
)
@settings(max_examples=30, deadline=None)
def test_a_rest_leaves_no_trace(weak: list[tuple[float, float, float]], left: float, right: float) -> None:
    """Inputs too weak to start a wheel, looked at often, and then a drive: the same as the drive alone."""
    rested, fresh = robot(), robot()
    now = 0
    for a, b, seconds in weak:
        now = drive(rested, a, b, seconds, now, step=3 * MS)
        assert (rested.pose, rested.v_m_s, rested.w_rad_s) == (fresh.pose, 0.0, 0.0)
    drive(rested, left, right, 0.1, now)
    drive(fresh, left, right, 0.1, now)
    assert (rested.pose, rested.v_m_s, rested.w_rad_s) == (fresh.pose, fresh.v_m_s, fresh.w_rad_s)
    assert rested.left.encoder.position == fresh.left.encoder.position


def test_a_resting_robot_feels_its_supply_rise() -> None:
    """A tenth of the duty turns nothing at 2.5 V, and turns the wheels at 9 V (breakaway 8 to 12 %, NXT)."""
    one = robot()
    for which in (one.left, one.right):
        which.bridge.supply_v = 2.5
    now = drive(one, 0.15, 0.15, 0.05)
    assert one.pose == (0.0, 0.0, 0.0)
    for which in (one.left, one.right):
        which.bridge.supply_v = 9.0
    drive(one, 0.15, 0.15, 0.5, now)
    assert one.v_m_s > 0.0
