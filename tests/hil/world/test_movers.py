"""Posts that move over virtual time."""

from __future__ import annotations

from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import SYSCLK_HZ, Clock
from hil.bench import Bench
from hil.machine import Setup
from hil.world.maps import MapError, parse_map
from hil.world.movers import Mover
from hil.world.world import World
from tests.hil.world.rig import motor

MAP = """
name = "m"
[start]
x_m = 0.5
y_m = 0.5
[[wall]]
points_m = [[0, 0], [4, 0], [4, 1], [0, 1]]
closed = true
[[post]]
x_m = 2.0
y_m = 0.5
diameter_m = 0.2
name = "cart"
"""
MOVING = MAP + "path_m = [[2.0, 0.5], [3.0, 0.5]]\nspeed_m_s = 0.5\nfrom_s = 2.5\nand_back = true\n"


def test_it_goes_along_its_path_and_back() -> None:
    there = Mover(0, ((0.0, 0.0), (3.0, 0.0), (3.0, 4.0)), 0.5, from_s=2.0)
    # 7 m at 0.5 m/s take 14 s; the corner after 6 s.
    assert [there.at(t) for t in (0.0, 2.0, 4.0, 8.0, 10.0, 16.0, 99.0)] == [
        (0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (3.0, 1.0), (3.0, 4.0), (3.0, 4.0),
    ]  # fmt: skip
    back = Mover(0, there.points, 0.5, and_back=True)
    assert back.at(15.0) == back.at(13.0)
    assert back.at(28.0) == (0.0, 0.0)


@given(st.floats(0.0, 1000.0), st.floats(0.0, 1.0), st.floats(0.01, 5.0), st.booleans())
def test_it_is_never_faster_than_its_speed(time_s: float, span_s: float, speed: float, and_back: bool) -> None:
    mover = Mover(0, ((0.0, 0.0), (1.0, 2.0), (-1.0, 2.0)), speed, 3.0, and_back)
    (ax, ay), (bx, by) = mover.at(time_s), mover.at(time_s + span_s)
    assert hypot(bx - ax, by - ay) <= speed * span_s + 1e-6


def test_it_is_slower_in_the_eyes_of_a_clock_that_is_fast() -> None:
    clock, one = Clock(), World(parse_map(MOVING), motor(), motor())
    one.attach(clock)
    clock.advance_to(3 * SYSCLK_HZ)
    one.set_second(1.25 * SYSCLK_HZ)
    clock.advance_to(4 * SYSCLK_HZ)
    # 3 s, and a second that counts for 1 / 1.25 = 0.8: 1.3 s after it has begun, at 0.5 m/s.
    assert one.posts[0].x_m == pytest.approx(2.0 + 1.3 * 0.5)


def test_the_world_carries_it_and_sonars_see_it() -> None:
    world_map = parse_map(MOVING)
    bench = Bench(Setup(realistic=False), traced=False, world_map=world_map)
    bench.boot()
    seen: list[tuple[float, float]] = []
    for time_s in (2.4, 4.5, 6.5):
        bench.run_until(round(time_s * SYSCLK_HZ))
        echo = bench.world.range_source("FRONT", bench.clock.now)
        assert echo is not None
        seen.append((round(bench.world.posts[0].x_m, 2), echo.range_m))
    bench.close()
    # 2.5 s: it leaves; at 4.5 s it stands at the far end, at 6.5 s back again (within the 10 ms of a look).
    assert [x for x, _ in seen] == [2.0, pytest.approx(3.0, abs=0.01), pytest.approx(2.0, abs=0.01)]
    # A metre further away at the far end (the end wall is further still).
    assert seen[1][1] - seen[0][1] == pytest.approx(1.0, abs=0.02)
    assert seen[2][1] == pytest.approx(seen[0][1], abs=0.02)


def test_a_world_without_them_carries_nothing() -> None:
    bench = Bench(Setup(realistic=False), traced=False, world_map=parse_map(MAP))
    posts = list(bench.world.posts)
    bench.boot()
    bench.close()
    assert all(a is b for a, b in zip(posts, bench.world.posts, strict=True))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (MAP + "speed_m_s = 1", "post[0].speed_m_s: the post does not move"),
        (MAP + "path_m = [[2.0, 0.5], [3.0, 0.5]]", "post[0].speed_m_s: missing"),
        (MAP + "path_m = [[1.0, 0.5], [3.0, 0.5]]\nspeed_m_s = 1", "post[0].path_m[0]: the path begins elsewhere"),
        (MAP + "path_m = [[2.0, 0.5], [2.0, 0.5]]\nspeed_m_s = 1", "post[0].path_m: the same point twice"),
        (MAP + "path_m = [[2.0, 0.5]]\nspeed_m_s = 1", "post[0].path_m: [[2.0, 0.5]] is not a polyline"),
        (MOVING.replace("true\n", "1\n").replace("closed = 1", "closed = true"), "post[0].and_back: 1 is not"),
        (MAP + "[floor]\nslip_left = 2", "floor.slip_left: 2 is out of range"),
    ],
)
def test_a_fault_of_a_map_is_one_line(text: str, expected: str) -> None:
    with pytest.raises(MapError) as caught:
        parse_map(text, "m.toml")
    assert expected in str(caught.value)


def test_a_floor_makes_a_wheel_lose_way() -> None:
    straight = Bench(Setup(realistic=False), traced=False, world_map=parse_map(MAP))
    slipping = Bench(Setup(realistic=False), traced=False, world_map=parse_map(MAP + "[floor]\nslip_left = 0.1"))
    assert (slipping.world.map.slip, slipping.world.map.grip) == ((0.1, 0.0), 1.0)
    assert slipping.world.robot.params.slip_left == straight.world.robot.params.slip_left + 0.1
