"""With all corrections the mission does what the thesis says: it goes through every built-in world.

Expected: no contact with anything, no finding of any detector, not even a note, and an odometry that is the driven
path within what the parts allow. A wheel loses up to 1 % of its way; the heading is the gyro's, which has 2 % of scale
(up to 1.8 degrees in a turn of 90) and an offset that the mean of 50 noisy samples leaves uncertain by some hundredths
of a degree a second (2 to 4 degrees in a minute). So the position is right within 1 % and the sine of some degrees of
heading, of which a path made of legs sees half: 5 % of the way, and 10 cm in any case.
"""

from __future__ import annotations

from math import cos, hypot, sin

import pytest

from firmware_model.corrections import ALL
from hil.audit.rig import robot
from hil.bench import Bench
from hil.world import builtin_maps

MISSION_S = 60.0
RUNS = [("ideal", 1), ("realistic", 1), ("realistic", 2), ("realistic", 3)]


def found(bench: Bench) -> list[str]:
    """All findings, notes included."""
    return [f"{finding.rule}: {finding.message}" for finding in bench.findings]


def odometry_error_m(bench: Bench) -> float:
    """How far apart odometry and true position are at the time of the last frame, in the frame of the start."""
    believed = bench.odometry_path()[-1]
    true = bench.true_path()
    start, now = true[0], min(true, key=lambda p: abs(p.time_s - believed.time_s))
    dx, dy = now.x_m - start.x_m, now.y_m - start.y_m
    ahead = cos(start.heading_rad) * dx + sin(start.heading_rad) * dy
    left = cos(start.heading_rad) * dy - sin(start.heading_rad) * dx
    return hypot(believed.x_m - ahead, believed.y_m - left)


@pytest.mark.slow
@pytest.mark.parametrize(("parts", "seed"), RUNS)
@pytest.mark.parametrize("world", sorted({*builtin_maps()} - {"paddock"}))  # that one: test_soak.py
def test_the_corrected_mission_goes_through(world: str, parts: str, seed: int) -> None:
    realistic = parts == "realistic"
    with robot({ALL}, world=world, realistic=realistic, seed=seed, watch=False, static=False) as bench:
        bench.feed(b"#MISN\r")
        bench.run_for(MISSION_S)
        assert bench.world.robot.collisions == 0
        assert found(bench) == []
        # The robot drives at 0.1 to 0.15 m/s and stands for some 6 s at each wall: half the time in the small box.
        assert bench.world.travelled_m > 4.0
        assert odometry_error_m(bench) < max(0.10, 0.05 * bench.world.travelled_m)


def test_the_corrected_tasks_share_nothing_unguarded_and_no_statement_is_dead() -> None:
    # Who touches what under which gate is the same in every world and costs time to watch: up to the first turn.
    with robot({ALL}, world="box") as bench:
        bench.feed(b"#MISN\r")
        bench.run_for(8.0)
        bench.feed(b"#CALB\r")
        bench.run_for(6.5)
        for order in (b"#INIT\r", b"#TELE\r", b"#SETR0.1,0.2\r", b"#STOP\r"):
            bench.feed(order)
            bench.run_for(0.3)
        assert found(bench) == []


def test_a_calibration_that_is_ordered_in_a_turn_measures_the_robot_at_rest() -> None:
    with robot({ALL}, world="room", watch=False, static=False) as bench:
        bench.feed(b"#TELE\r#SETR0.0,1.5\r")
        bench.run_for(1.5)
        assert bench.world.robot.w_rad_s > 1.0
        bench.firmware.main_robot.vZ_b = 999.0
        bench.feed(b"#CALB\r")
        bench.run_for(6.5)
        # An ideal gyro without an offset: a digit of 8.75 mdps is 0.5 degrees a minute.
        assert abs(bench.firmware.main_robot.vZ_b) < 1.0


def test_the_faithful_mission_does_not() -> None:
    with robot(world="box", watch=False, static=False) as bench:
        bench.feed(b"#MISN\r")
        bench.run_for(25.0)
        assert bench.world.robot.collisions > 0 or odometry_error_m(bench) > 0.05 * bench.world.travelled_m
        assert found(bench) != []
