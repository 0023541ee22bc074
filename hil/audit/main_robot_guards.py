"""Demonstrations of faults that main_Robot.c should detect and does not, by id: the robot in a world, with a fault."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from math import cos, nan, radians, sin
from typing import Final

from hil.audit.evidence import Evidence, measured
from hil.audit.rig import Fixes, robot
from hil.audit.task_rig import TaskRig
from hil.faults import mount, parse
from hil.world.geometry import Segment
from hil.world.maps import WorldMap

PRESSED, FREE = 0, 1
PERIOD_S: Final = 0.05


def distance_despite(fixes: Fixes, fault: str, within_s: float, *, orders: bytes = b"#MISN\r") -> float:
    """Return the roll of the wheels (m) in the second that begins `within_s` after a fault; the robot then drives."""
    with robot(fixes, watch=False) as bench:
        bench.run_for(0.8)
        bench.feed(orders)
        bench.run_for(1.0)
        if fault:
            mount(parse(fault), bench, from_now=True)
        bench.run_for(within_s)
        bench.world.sync_now()
        before = bench.world.robot.left.angle_rad, bench.world.robot.right.angle_rad
        bench.run_for(1.0)
        bench.world.sync_now()
        after = bench.world.robot.left.angle_rad, bench.world.robot.right.angle_rad
    return 0.027 * max(abs(a - b) for a, b in zip(after, before, strict=True))


#: A wheel that is braked may still be pushed a little.
_STOPPED_M: Final = 0.005


def watchdog(fixes: Fixes) -> Evidence:
    """Hang TaskNAVIGATION for ten seconds.  It may be three periods late, the reset comes 105 ms later, and the wheels
    coast for about 0.3 s."""
    distance_m = distance_despite(fixes, "task-slow:task=TaskNAVIGATION,us=1e7", 0.9)
    return measured("way in a second, 0.9 s after TaskNAVIGATION hangs", distance_m, "m", high=_STOPPED_M)


def distance_unchecked(fixes: Fixes) -> Evidence:
    """Make the front distance NaN: the robot must not drive."""
    speeds: list[float] = []
    rig = TaskRig(
        fixes, Read_Bumper=lambda: FREE, getZ=lambda: 0,
        write_REF=lambda ref: speeds.append(float(ref.member("V").load())),
    )  # fmt: skip
    servers = rig.fw.servidores
    servers.ROBOT_Status = rig.fw.robot_types.STATUS.MISSION
    servers.ROBOT_df, servers.ROBOT_dl, servers.ROBOT_dr = nan, 100.0, 100.0
    rig.turns("TaskNAVIGATION", 2)
    return measured("speed of a mission whose front distance is no number", speeds[-1], "m/s", low=0.0, high=0.0)


def front_stuck(fixes: Fixes) -> Evidence:
    """Fix the front sonar at 2 m, whatever is there: 25 cm at 0.15 m/s take 1.7 s."""
    distance_m = distance_despite(fixes, "sonar-stuck:sensor=FRONT,range=2", 2.5)
    return measured("way in a second, 2.5 s after the front sonar is stuck", distance_m, "m", high=_STOPPED_M)


def link_silent(fixes: Fixes) -> Evidence:
    """Send SETR and nothing more; look 3 s later."""
    distance_m = distance_despite(fixes, "", 2.0, orders=b"#TELE\r#SETR0.1,0.0\r")
    return measured("way in a second, 3 s after the last order", distance_m, "m", high=_STOPPED_M)


def turn_unchecked(fixes: Fixes) -> Evidence:
    """Hold the gyro at the end of its range, 250 degrees/s: the robot must notice a difference of 0.4 rad/s within 0.5
    s."""
    distance_m = distance_despite(fixes, "gyro-saturation:sign=+", 0.5)
    return measured("way in a second, 0.5 s after the gyro is at its end", distance_m, "m", high=_STOPPED_M)


def actuator_limits(fixes: Fixes) -> Evidence:
    """Flip a bit of the reference, which becomes 100 m/s.  0.3 m/s are 11.2 rad/s of a wheel of 27 mm."""
    rig = TaskRig(fixes)
    rig.fw.servidores.ROBOT_Reference.V = 100.0
    rig.turns("TaskSERVO")
    return measured("reference of a wheel at 100 m/s", rig.fw.main_robot.Wl_ref, "rad/s", high=0.3 / 0.027 + 0.01)


def wheel_unchecked(fixes: Fixes) -> Evidence:
    """Hold the left wheel.  The right one must stop 0.4 s, a period of TaskNAVIGATION and one of TaskSERVO later."""
    distance_m = distance_despite(fixes, "wheel-blocked:side=left", 0.7)
    return measured("way of a wheel in a second, 0.7 s after the other is held", distance_m, "m", high=_STOPPED_M)


def _slanted() -> WorldMap:
    """A hall that is too wide for the sonars; the middle of a wall is 50 cm from the start, 50 degrees to the left."""
    hall = (-6.0, -6.0), (6.0, -6.0), (6.0, 6.0), (-6.0, 6.0), (-6.0, -6.0)
    x, y = 0.5 * cos(radians(50.0)), 0.5 * sin(radians(50.0))
    wall = Segment(x + 5 * y, y - 5 * x, x - 5 * y, y + 5 * x)
    return WorldMap("slanted wall", (wall, *(Segment(*a, *b) for a, b in pairwise(hall))))


_SLANTED: Final = _slanted()


def push_unnoticed(fixes: Fixes) -> Evidence:
    """Drive a mission towards a wall at 50 degrees, which the front sonar misses; it arrives after some 4 s."""
    with robot(fixes, world_map=_SLANTED, watch=False) as bench:
        bench.run_for(0.8)
        bench.feed(b"#MISN\r")
        bench.run_for(4.5)
        bench.world.sync_now()
        before = bench.world.travelled_m
        bench.run_for(2.5)
        bench.world.sync_now()
        distance_m = bench.world.travelled_m - before
    return measured("way of a mission in 2.5 s, 4.5 s after it began towards a slanted wall", distance_m, "m", low=0.05)


def bumper_stuck(fixes: Fixes) -> Evidence:
    """Press the bumper for 12 s; the safety distance is 40 cm."""
    rig = TaskRig(fixes)
    main = rig.fw.main_robot
    main.bumper, main.df, main.dl, main.dr = PRESSED, 300.0, 100.0, 100.0
    distance_m = 0.0
    for _ in range(240):
        main.MISION_4()
        distance_m -= min(0.0, float(main.Robot_Reference_N.V)) * PERIOD_S
    return measured("way backwards in 12 s with the bumper pressed", distance_m, "m", high=0.4)


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "MAIN-watchdog": watchdog,
    "MAIN-distance-unchecked": distance_unchecked,
    "MAIN-front-stuck": front_stuck,
    "MAIN-link-silent": link_silent,
    "MAIN-turn-unchecked": turn_unchecked,
    "MAIN-actuator-limits": actuator_limits,
    "MAIN-wheel-unchecked": wheel_unchecked,
    "MAIN-push-unnoticed": push_unnoticed,
    "MAIN-bumper-stuck": bumper_stuck,
}
