"""A robot that keeps the rules of the thesis' mission finds its way through the corridor, in 60 s and from any seed.

The rules (TFG 3.2.1 and main_Robot.c): 0.15 m/s while at least 60 cm are free ahead, 0.1 below, stop below 45 cm;
after 60 periods of 50 ms turn towards the larger side; drift away from a wall nearer than 30 cm.
"""

from __future__ import annotations

from math import degrees

import pytest

from hil.world import load_map
from tests.hil.world.rig import Rover


@pytest.mark.parametrize("seed", [None, 1, 2, 3])
def test_the_mission_follows_the_corridor_turns_at_its_end_and_touches_nothing(seed: int | None) -> None:
    rover = Rover(load_map("corridor"), seed)
    rover.run(60.0)
    world = rover.world
    assert world.robot.collisions == 0
    assert rover.bumps == []
    # one turn, to the left: until 25 degrees lose the wall, and what it turns before it notices (up to 25 more)
    ((begin, end),) = rover.turned_at
    assert 25.0 < degrees(end - begin) < 60.0
    # beyond the end wall at x = 3.6 m and well into the second leg
    assert world.pose.x_m > 5.0
    assert world.pose.y_m > 2.0
    # 57 s of driving at 0.15 m/s and 3 s of waiting make 8.1 m; starting and the slow part cost some
    assert 7.5 < world.travelled_m < 8.6


def test_at_the_end_of_the_corridor_it_stops_45_cm_before_the_wall() -> None:
    rover = Rover(load_map("corridor"))
    rover.run(20.5)
    # 3.6 m less 0.45 m less the sonar's 0.09 m,
    # passed at 0.1 m/s and noticed up to 147 + 50 + 25 ms later; braking takes some mm
    assert 3.06 < rover.world.pose.x_m < 3.06 + 0.022 + 0.008
    assert abs(rover.world.robot.v_m_s) < 0.01
    assert rover.seen_m["LEFT"] > rover.seen_m["RIGHT"]
