"""Walls, corners, wall ends and posts against a robot that is driven, pressed, placed and pushed in every way.

What may never happen: energy from anything but the motors, a body in a wall or beyond it, a number that is none.
"""

from __future__ import annotations

from math import atan2, cos, hypot, isfinite, pi, radians, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.world import Pose, RobotParams, load_map
from hil.world.contact import ContactRow, pushed_out, solve
from hil.world.geometry import Post, Segment, within
from hil.world.robot import PUSH_M_S, Robot
from tests.hil.world.rig import act, motor

S = 200_000_000
MS = S // 1000
R, TRACK, BODY, AHEAD = 0.027, 0.13, 0.095, 0.025
ROOM = load_map("room")
OUTSIDE = ROOM.walls[:4]
#: 7.2 V against a back-EMF of 0.478 V.s: no motor turns its wheel faster.
TOP_RAD_S = 7.2 / 0.478
#: The bridge's 1 A at 0.317 N.m/A, and viscous friction, which only takes.
TOP_NM = 0.317

#: What is done next: both duties (None: as before), and for how many cycles; slices down to a single cycle.
DUTY = st.sampled_from([-1.0, -0.5, 0.0, 0.5, 1.0]) | st.floats(-1, 1)
SLICES = st.lists(
    st.integers(1, 100) | st.integers(100, 100_000) | st.integers(100_000, 5 * MS) | st.just(5 * MS),
    min_size=1, max_size=40,
)  # fmt: skip
PLAN = st.lists(st.tuples(DUTY, DUTY, SLICES), min_size=1, max_size=5)


def robot(walls: tuple[Segment, ...] = (), posts: list[Post] | None = None, grip: float = 1.0) -> Robot:
    one = Robot(motor(), motor())
    one.surround(walls, posts or [], grip)
    act(one.left, 0.0)
    act(one.right, 0.0)
    return one


def put(one: Robot, cx: float, cy: float, heading: float) -> None:
    """The body's middle here."""
    one.place(Pose(cx - AHEAD * cos(heading), cy - AHEAD * sin(heading), heading))


def middle(one: Robot) -> tuple[float, float]:
    return one.x_m + AHEAD * cos(one.heading_rad), one.y_m + AHEAD * sin(one.heading_rad)


def room(one: Robot, walls: tuple[Segment, ...] = ROOM.walls) -> float:
    """Between body and nearest wall, negative inside."""
    return min(wall.distance(*middle(one)) for wall in walls) - BODY


def energy_j(one: Robot) -> float:
    params: RobotParams = one.params
    wheels = sum(0.5 * which.params.inertia_kg_m2 * which.omega_rad_s**2 for which in (one.left, one.right))
    return wheels + 0.5 * params.mass_kg * one.v_m_s**2 + 0.5 * params.yaw_inertia_kg_m2 * one.w_rad_s**2


def fastest(one: Robot) -> float:
    return max(abs(one.left.omega_rad_s), abs(one.right.omega_rad_s))


def watched(one: Robot, start: int, cycles: int) -> int:
    """One slice under watch: energy, speed, place."""
    before, omega = energy_j(one), fastest(one)
    one.advance(start, start + cycles)
    assert all(isfinite(number) for number in (*one.pose, one.v_m_s, one.w_rad_s))
    work = 2.0 * 1.05 * TOP_NM * max(omega, fastest(one)) * cycles / S
    assert energy_j(one) <= before + work + 1e-12
    assert fastest(one) <= TOP_RAD_S
    assert abs(one.v_m_s) <= TOP_RAD_S * R
    assert abs(one.w_rad_s) <= 2.0 * TOP_RAD_S * R / TRACK
    return start + cycles


@st.composite
def against_a_wall(draw: st.DrawFn) -> tuple[float, float, float]:
    """Beside, at the end of, at, or a little into a wall of the room; heading anyhow, or almost along it."""
    wall = ROOM.walls[draw(st.integers(0, len(ROOM.walls) - 1))]
    along = wall.length_m * draw(st.sampled_from([0.0, 0.5, 1.0]) | st.floats(0, 1))
    away = BODY + draw(st.sampled_from([-1e-2, -1e-5, -1e-6, 0.0, 1e-6, 1e-3]) | st.floats(-0.09, 0.1))
    if draw(st.booleans()):
        away = -away
    course = atan2(wall.uy, wall.ux) + draw(st.sampled_from([0.0, pi / 2, pi, -pi / 2])) + draw(st.floats(-0.1, 0.1))
    heading = course if draw(st.booleans()) else draw(st.floats(-pi, pi))
    return (
        min(max(wall.ax + along * wall.ux + away * wall.nx, 0.005), 4.995),
        min(max(wall.ay + along * wall.uy + away * wall.ny, 0.005), 3.995),
        heading,
    )


@settings(deadline=None, max_examples=60)
@given(place=against_a_wall(), plan=PLAN, grip=st.sampled_from([1.0, 0.3, 0.05]))
def test_only_the_motors_give_energy_and_no_wall_is_entered_however_a_run_is_cut(
    place: tuple[float, float, float], plan: list[tuple[float, float, list[int]]], grip: float
) -> None:
    one = robot(ROOM.walls, list(ROOM.posts), grip)
    put(one, *place)
    now = 0
    for left, right, slices in plan:
        act(one.left, left)
        act(one.right, right)
        for cycles in slices:
            now = watched(one, now, cycles)
            assert room(one) > -1e-9
            assert within(*middle(one), OUTSIDE)


@settings(deadline=None, max_examples=40)
@given(
    place=against_a_wall(),
    plan=st.lists(st.tuples(DUTY, DUTY, SLICES, st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)), min_size=1, max_size=5),
    size=st.floats(0.005, 0.5),
)
def test_obstacles_thrown_at_the_robot_give_it_no_energy_and_push_it_through_no_wall(
    place: tuple[float, float, float], plan: list[tuple[float, float, list[int], float, float]], size: float
) -> None:
    one = robot(ROOM.walls)
    put(one, *place)
    now = 0
    for left, right, slices, dx, dy in plan:
        cx, cy = middle(one)
        one.surround(ROOM.walls, [Post(cx + dx, cy + dy, size)])
        act(one.left, left)
        act(one.right, right)
        for cycles in slices:
            now = watched(one, now, cycles)
            assert room(one) > -1e-9
            assert within(*middle(one), OUTSIDE)


@pytest.mark.parametrize("cycles", [1, 20, 500, 20_000])
def test_pressed_along_a_wall_while_it_turns_into_it_the_robot_keeps_its_speed_limits(cycles: int) -> None:
    """At x = 5 m, heading along it, 1 um too near, turning right at -1.57 rad/s and 0.15 m/s."""
    one = robot(ROOM.walls)
    put(one, 5.0 - BODY + 1e-6, 1.96, pi / 2)
    left, right = (0.15 + 1.57 * TRACK / 2) / R, (0.15 - 1.57 * TRACK / 2) / R
    act(one.left, left * 0.55 / 7.2)
    act(one.right, right * 0.55 / 7.2)
    now = 0
    for k in range(300):
        now = watched(one, now, cycles if k % 2 else 5 * MS)
        assert room(one) > -1e-9


@pytest.mark.parametrize("duty", [0.0, 1.0, -1.0])
def test_an_obstacle_dragged_over_the_robot_moves_it_no_faster_than_a_hand(duty: float) -> None:
    one = robot((Segment(-9, 0.3, 9, 0.3),))
    act(one.left, duty)
    act(one.right, duty)
    now = 0
    for k in range(200):  # 0.3 m/s from the right across the robot towards the wall, in hops of 10 ms
        one.surround((Segment(-9, 0.3, 9, 0.3),), [Post(0.025, -0.2 + 0.003 * k, 0.05)])
        x, y = middle(one)
        now = watched(one, now, 5 * MS)
        now = watched(one, now, 5 * MS)
        moved = hypot(middle(one)[0] - x, middle(one)[1] - y)
        assert moved <= (PUSH_M_S + TOP_RAD_S * R) * 0.01 + 1e-9
        assert room(one, (Segment(-9, 0.3, 9, 0.3),)) > -1e-9
    assert middle(one)[1] < 0.3 - BODY + 1e-9  # never on the other side of the wall
    if not duty:
        assert one.slipped_m == energy_j(one) == 0.0
        assert (one.left.encoder.position, one.right.encoder.position) == (0, 0)


def test_an_obstacle_put_into_a_resting_robot_moves_it_out_at_0_5_m_s_and_leaves_it_at_rest() -> None:
    one = robot()
    one.surround((), [Post(0.025 + 0.095, 0.0, 0.05)])  # 5 cm of overlap, in front
    one.advance(0, 40 * MS)
    assert one.pose == pytest.approx((-0.02, 0.0, 0.0), abs=1e-12)
    one.advance(40 * MS, 200 * MS)
    assert one.pose == pytest.approx((-0.05, 0.0, 0.0), abs=1e-12)
    assert one.bumper_pressed
    assert energy_j(one) == 0.0


@pytest.mark.parametrize("posts", [[], [Post(0.025, 0.0, 0.03)]])
def test_a_body_whose_middle_is_on_a_wall_or_in_the_middle_of_a_post_comes_out(posts: list[Post]) -> None:
    walls = () if posts else (Segment(0.025, -9.0, 0.025, 9.0),)
    one = robot(walls, posts)
    now = 0
    for _ in range(100):
        now = watched(one, now, 5 * MS)
    away = hypot(middle(one)[0] - 0.025, middle(one)[1])
    assert away == pytest.approx(BODY + (0.03 if posts else 0.0), abs=1e-9)


def test_a_robot_squeezed_between_a_post_and_a_wall_stays_out_of_the_wall_and_rests() -> None:
    walls = (Segment(-9, 0.1, 9, 0.1),)
    one = robot(walls)
    put(one, 0.0, 0.0, 0.0)
    one.surround(walls, [Post(0.0, -0.1, 0.05)])  # 0.15 m between them for a body of 0.19 m
    now = 0
    for _ in range(20):
        now = watched(one, now, 5 * MS)
        assert room(one, walls) > -1e-9
    rest = one.pose
    one.advance(now, now + S)
    assert one.pose == rest


@given(
    x=st.floats(-0.2, 0.2), y=st.floats(-0.2, 0.2), radius=st.floats(0.01, 0.15), course=st.floats(-pi, pi),
    push=st.floats(0.0, 0.01),
)  # fmt: skip
def test_pushed_out_goes_the_shortest_way_out_of_a_wall_and_the_way_allowed_from_a_post(
    x: float, y: float, radius: float, course: float, push: float
) -> None:
    wall = Segment(-0.1 * cos(course), -0.1 * sin(course), 0.1 * cos(course), 0.1 * sin(course))
    after = pushed_out(x, y, radius, 0.0, (wall,), [])
    overlap = max(0.0, radius - wall.distance(x, y))
    assert hypot(after[0] - x, after[1] - y) == pytest.approx(overlap, abs=1e-9)
    assert wall.distance(*after) >= radius - 1e-9
    post = Post(0.1, 0.0, 0.05)
    after = pushed_out(x, y, radius, push, (), [post])
    overlap = max(0.0, radius - post.distance(x, y))
    assert hypot(after[0] - x, after[1] - y) == pytest.approx(min(overlap, push), abs=1e-9)
    assert post.distance(*after) >= min(radius, post.distance(x, y) + push) - 1e-9


@settings(max_examples=300)
@given(
    velocities=st.lists(st.floats(-0.5, 0.5), min_size=4, max_size=4),
    touches=st.lists(st.tuples(st.floats(-pi, pi), st.sampled_from([0.0, -0.2, -1e3])), max_size=4),
    span=st.sampled_from([5e-9, 1e-6, 1e-4, 5e-3]),
)
def test_contacts_take_energy_and_never_give_any(
    velocities: list[float], touches: list[tuple[float, float]], span: float
) -> None:
    """Rest or approach is all they want, so that kinetic energy can only fall, settled or not.  Wheels in m/s at the
    rim here, to weigh alike."""
    masses = (1 / 1.8e-3, 1 / 1.8e-3, 1 / 0.75, 1 / 0.004)
    state = [velocities[0] / R, velocities[1] / R, velocities[2], velocities[3] / TRACK]
    grip, dry = span * 2.35, span * 0.016
    rows = [
        ContactRow((1.0, 0.0, 0.0, 0.0), 0.0, -dry, dry, masses),
        ContactRow((0.0, 1.0, 0.0, 0.0), 0.0, -dry, dry, masses),
        ContactRow((-R, 0.0, 1.0, -TRACK / 2), 0.0, -grip, grip, masses),
        ContactRow((0.0, -R, 1.0, TRACK / 2), 0.0, -grip, grip, masses),
    ]
    for aside, want in touches:
        toward, across = cos(aside), sin(aside)
        normal = ContactRow((0.0, 0.0, toward, AHEAD * across), want, 0.0, 1e9, masses)
        rub = (0.0, 0.0, -across, AHEAD * toward - BODY)
        rows += [normal, ContactRow(rub, 0.0, -0.2, 0.2, masses, normal)]

    def kinetic() -> float:
        return sum(0.5 * v * v / m for v, m in zip(state, masses, strict=True))

    before = kinetic()
    solve(state, rows, masses, span)
    assert kinetic() <= before * (1 + 1e-9) + 1e-15


@pytest.mark.parametrize("cycles", [1, 8, 200])
def test_friction_acts_in_the_shortest_slices_too(cycles: int) -> None:
    """0.2 ms of sliding, braked: 0.3 m/s forward over wheels at 2 rad/s (0.054 m/s), cut finely and not at all."""
    states = []
    for step in (cycles, 40_000):
        one = robot(grip=0.3)
        one.v_m_s, one.left.omega_rad_s, one.right.omega_rad_s, one._sliding = 0.3, 2.0, 2.0, True
        for start in range(0, 40_000, step):
            one.advance(start, start + step)
        states.append((one.v_m_s - 0.3, one.left.omega_rad_s - 2.0))
    assert states[0] == pytest.approx(states[1], rel=2e-3)
    # Newton: 0.3 x 0.8 of 0.8 of the weight for 0.2 ms
    assert states[1][0] == pytest.approx(-0.3 * 0.8 * 0.8 * 9.81 * 2e-4, rel=1e-6)


@settings(deadline=None, max_examples=12)
@given(
    side=st.sampled_from([-1.0, 1.0]),
    slow=st.floats(0.3, 0.6),
    more=st.floats(0.05, 0.3),
    cuts=st.lists(st.integers(1, 5 * MS - 1), max_size=4, unique=True),
)
def test_rubbing_along_a_wall_does_not_depend_on_how_the_run_is_cut(
    side: float, slow: float, more: float, cuts: list[int]
) -> None:
    """Stated tolerance: 3 mm and 20 mrad after a second of pressing into a wall beside it (first-order steps)."""

    def run(marks: list[int]) -> Robot:
        one = robot((Segment(-9, side * (BODY + 1e-4), 9, side * (BODY + 1e-4)),))
        act(one.left, slow - more if side > 0.0 else slow)
        act(one.right, slow - more if side < 0.0 else slow)
        for k in range(200):
            at = k * 5 * MS
            for mark in [*marks, 5 * MS]:
                one.advance(at, k * 5 * MS + mark)
                at = k * 5 * MS + mark
        return one

    once, often = run([]), run(sorted(cuts))
    assert (often.x_m, often.y_m) == pytest.approx((once.x_m, once.y_m), abs=3e-3)
    assert often.heading_rad == pytest.approx(once.heading_rad, abs=2e-2)
    assert run(sorted(cuts)).pose == often.pose


@pytest.mark.parametrize("aside_deg", [0.0, 20.0, 45.0, 70.0])
def test_a_hit_leaves_no_speed_into_the_wall(aside_deg: float) -> None:
    one = robot((Segment(0.5, -9, 0.5, 9),))
    one.place(Pose(0.2, 0.0, radians(aside_deg)))
    act(one.left, 0.8)
    act(one.right, 0.8)
    now = 0
    for _ in range(600):
        now = watched(one, now, 5 * MS)
    heading = one.heading_rad
    toward = one.v_m_s * cos(heading) - one.w_rad_s * AHEAD * sin(heading)
    assert room(one, one._walls) > -1e-9
    assert toward <= 1e-3
