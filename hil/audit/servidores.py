"""Demonstrations of the defects of servidores.c, by id."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from hil.audit.evidence import Evidence, measured, reported
from hil.audit.rig import Fixes, Rig, robot, static_findings


def unused_object(fixes: Fixes) -> Evidence:
    """Look for the object in the typed tree of the image."""
    return reported(static_findings(fixes), "unused-object", object="ROBOT_Odometry")


def distances_apart(fixes: Fixes) -> Evidence:
    """Store a measurement of three times 2 cm when a reader of three times 1 cm has left the gate once."""
    arrived = False

    def measurement(distance_cm: float) -> None:
        servers = rig.fw.servidores
        servers.write_left_distance(distance_cm)
        servers.write_front_distance(distance_cm)
        servers.write_right_distance(distance_cm)

    def leave(_gate: object, _key: int) -> None:
        nonlocal arrived
        if reading and not arrived:
            arrived = True
            measurement(2.0)

    reading = False
    rig = Rig(fixes, externs={"GateMutexPri_enter": lambda _gate: 0, "GateMutexPri_leave": leave})
    measurement(1.0)
    reading = True
    servers = rig.fw.servidores
    read = [servers.read_front_distance(), servers.read_left_distance(), servers.read_right_distance()]
    return measured("measurements that a reader's three distances are of", len(set(read)), high=1)


def trayect_gate(fixes: Fixes) -> Evidence:
    """Run the robot for a second."""
    with robot(fixes) as bench:
        bench.run_for(1.0)
        bench.close()  # what was never used shows at the end
        return reported(bench.findings, "gate-unused")


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "SERV-unused-object": unused_object,
    "SERV-distances-apart": distances_apart,
    "SERV-trayect-gate": trayect_gate,
}
