"""Demonstrations of the defects of protocol.c, by id."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from hil.audit import properties
from hil.audit.evidence import Evidence, Picture, Series, measured, reported
from hil.audit.properties import MonitorValues
from hil.audit.rig import ALONE, Fixes, Rig, robot
from hil.client.orders import checked, set_reference

#: A rig with protocol.c and the modules that it needs.  It is built faster than the whole robot's program.
_rig: Final = partial(Rig, modules=ALONE["protocol"])

COMMA: Final = ord(",")


def frame_rewritten(fixes: Fixes) -> Evidence:
    """Run the robot's start-up."""
    with robot(fixes) as bench:
        return reported(bench.findings, "buffer-rewritten", function="Send_ODO_Trayect")


def coordinate_range(fixes: Fixes) -> Evidence:
    """Send a frame 40 m from the robot's start."""
    rig = _rig(fixes)
    properties.frame_sent(rig, MonitorValues(x_mm=40000.0))
    return reported(rig.findings, "float-to-int", function="Send_ODO_Trayect")


def angle_unit(fixes: Fixes) -> Evidence:
    """Send a heading of 1.5 rad."""
    rig, headings = _rig(fixes), [math.tau * i / 100 for i in range(100)]
    sent = [float(properties.frame_sent(rig, MonitorValues(heading_rad=heading)).split(",")[2]) for heading in headings]
    lines = [
        Series("sent, but for whole turns", headings, [heading % math.tau for heading in sent]),
        Series("true", headings, headings),
    ]
    picture = Picture("The heading in a frame", "heading in rad", "third field in rad", lines)
    return properties.frame_units(rig, MonitorValues(heading_rad=1.5)).shown(picture)


def order_prefix(fixes: Fixes) -> Evidence:
    """Send a word that begins like an order."""
    return properties.order_read(_rig(fixes), b"#STOPWATCH\r")


def numbers_unchecked(fixes: Fixes) -> Evidence:
    """Send letters in place of numbers."""
    return properties.order_read(_rig(fixes), b"#SETRabc,def\r")


def reference_range(fixes: Fixes) -> Evidence:
    """Send a number whose decimal point has slipped."""
    return properties.reference_read(_rig(fixes), b"#SETR9.9,0.0\r")


def damage_unseen(fixes: Fixes) -> Evidence:
    """Flip each bit of each character of a reference once.  If the robot understands a check, the reference has one."""
    rig = _rig(fixes)
    protocol, orders = rig.fw.protocol, rig.fw.protocol.ORDER

    def taken(data: bytes) -> tuple[float, float] | None:
        frame = rig.frame(data.decode("latin-1"))
        if protocol.Interpret_Order(frame) != orders.O_SETR:
            return None
        reference = rig.fw.new("REFERENCE", V=0.0, W=0.0)
        rig.call(protocol.Obtain_Reference, frame, reference)
        return reference.V, reference.W

    plain = set_reference(0.1, 0.2)
    right = taken(plain)
    sent = next(data for data in (checked(plain), plain) if taken(data) == right)
    flipped = [
        bytes((*sent[:place], sent[place] ^ 1 << bit, *sent[place + 1 :]))
        # Without # or the end mark it is no frame, and the comma is another entry's.
        for place in range(1, len(sent) - 1) if sent[place] != COMMA
        for bit in range(7)
    ]  # fmt: skip
    others = sum(taken(data) not in (None, right) for data in flipped if b"\r" not in data[:-1])
    return measured("orders with one flipped bit that are taken for another reference", others, high=0)


def comma_missing(fixes: Fixes) -> Evidence:
    """Send one number, in a frame buffer of 80 characters with a comma somewhere after it."""
    rig = _rig(fixes)
    frame = rig.frame("#SETR0.2\r", room=80)
    rig.fw.array("char", [COMMA])
    rig.call(rig.fw.protocol.Obtain_Reference, frame, rig.fw.new("REFERENCE", V=0.0, W=0.0))
    return reported(rig.findings, "pointer-outside", function="Move_to_comma")


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "PROTO-frame-rewritten": frame_rewritten,
    "PROTO-coordinate-range": coordinate_range,
    "PROTO-angle-unit": angle_unit,
    "PROTO-order-prefix": order_prefix,
    "PROTO-numbers-unchecked": numbers_unchecked,
    "PROTO-reference-range": reference_range,
    "PROTO-damage-unseen": damage_unseen,
    "PROTO-comma-missing": comma_missing,
}
