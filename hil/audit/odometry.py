"""Demonstrations of the defects of Odometry.c, by id."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from hil.audit import properties
from hil.audit.evidence import Evidence, reported
from hil.audit.properties import SpeedStep
from hil.audit.rig import ALONE, Fixes, Rig

#: A rig with Odometry.c and the modules that it needs.  It is built faster than the whole robot's program.
_rig: Final = partial(Rig, modules=ALONE["odometry"])


def slow_turn_lost(fixes: Fixes) -> Evidence:
    """Turn for a minute at 0.009 rad/s."""
    rig, drives = _rig(fixes), [SpeedStep(0.2, 0.009, periods=240)]
    picture = properties.odometry_picture(rig, "A minute at 0.2 m/s and 0.009 rad/s", 0.0, drives)
    return properties.odometry_heading(rig, 0.0, drives).shown(picture)


def units_turning(fixes: Fixes) -> Evidence:
    """Drive for a quarter of a second at 0.3 m/s and 0.5 rad/s."""
    rig = _rig(fixes)
    circle = properties.odometry_picture(
        rig, "A circle at 0.3 m/s and 0.5 rad/s", 0.0, [SpeedStep(0.3, 0.5, periods=50)]
    )
    return properties.odometry_distance(rig, 0.0, SpeedStep(0.3, 0.5)).shown(circle)


def angle_factor(fixes: Fixes) -> Evidence:
    """Drive 100 mm straight ahead at a heading of 1 rad."""
    rig, side = _rig(fixes), [SpeedStep(0.4, 0.0, periods=10), SpeedStep(0.0, math.tau / 4, periods=4)]
    square = properties.odometry_picture(rig, "A square of 1 m", 0.0, side * 4)
    return properties.odometry_course(rig, 1.0, SpeedStep(0.4, 0.0)).shown(square)


def half_step(fixes: Fixes) -> Evidence:
    """Drive the first step of an arc, 0.1 rad long."""
    return properties.odometry_course(_rig(fixes), 0.0, SpeedStep(0.3, 0.4))


def heading_unwrapped(fixes: Fixes) -> Evidence:
    """Send a frame after the next step of a robot that has turned by 40000 rad."""
    rig = Rig(fixes, modules=("firmware_model.odometry", "firmware_model.protocol"))
    odometry = rig.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=40000.0, df=0.0, dl=0.0, dr=0.0)
    rig.fw.odometry.Odom_Trayect(odometry, 0.0, 1.0, 0.0, 0.0, 0.0, 250.0)
    rig.fw.protocol.Send_ODO_Trayect(odometry)
    return reported(rig.findings, "float-to-int", function="Send_ODO_Trayect")


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "ODO-slow-turn-lost": slow_turn_lost,
    "ODO-units-turning": units_turning,
    "ODO-angle-factor": angle_factor,
    "ODO-half-step": half_step,
    "ODO-heading-unwrapped": heading_unwrapped,
}
