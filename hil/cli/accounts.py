"""The status line of `hil run` while it runs, and its summary at the end, for a board and for a robot."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ
from emulator.compiled import BUILDS, MODE
from emulator.rules import Severity
from hil.client.plot import MOVING, save
from hil.machine import START_UP, Machine, RobotMachine, Setup
from hil.reports.json_report import findings_of
from hil.reports.model import report_of
from hil.reports.policy import Policy
from hil.robot.moving_picture import FEW, save_moving
from hil.robot.picture import drive_of
from hil.session import Session

if TYPE_CHECKING:
    from hil.running import RunningBoard

#: Of a setup, what says nothing about a board without wheels.
OF_ROBOTS: Final = ("world", "xbee", "fixes")
#: The time of an order before it.
_AT: Final = re.compile(r"^[\d.]+:")


def status_line(session: Session, policy: Policy) -> str:
    """What a run is at, in one line short enough for 100 columns; what matters least stands last."""
    machine, pacer = session.machine, session.pacer
    lag = pacer.lag
    time = f"{machine.clock.now / SYSCLK_HZ:.1f}s x{pacer.ratio(machine.clock.now):.2f} lag {lag.last_s * 1e3:.0f}ms"
    found = _findings(policy.with_severities(machine.findings))
    traffic = f"in {session.bytes_to_robot} out {session.bytes_from_robot}B findings {found}"
    counters = session.port.counters if session.port else None
    if isinstance(machine, RobotMachine):
        dropped = f"dropped {counters.frames_dropped if counters else 0}"
        return f"{time} {_robot(machine)} {traffic} {dropped} lag max {lag.max_s * 1e3:.0f}ms"
    dropped = f"dropped {counters.bytes_dropped if counters else 0}B"
    return f"{time} {traffic} {dropped} lag max {lag.max_s * 1e3:.0f}ms"


def _findings(rated: Iterable[tuple[Finding, Severity]]) -> str:
    """The number of findings, and how many of them are errors."""
    severities = [severity for _, severity in rated]
    errors = severities.count(Severity.ERROR)
    return f"{len(severities)} ({errors} error{'s' * (errors != 1)})" if errors else str(len(severities))


def _robot(machine: RobotMachine) -> str:
    """The robot's state, pose and distances, for the status line."""
    status = machine.status()
    front, right, left = status.distances_cm
    return (
        f"{status.state[:7]} x{status.x_m:.2f} y{status.y_m:.2f}m {status.heading_rad:.2f}rad"
        f" F{front:.0f} R{right:.0f} L{left:.0f}cm"
    )


def summarize(session: Session, setup: Setup) -> dict[str, Any]:
    """The summary of a run as plain data."""
    machine, pacer, port = session.machine, session.pacer, session.port
    began = {
        "virtual_s": session.elapsed_virtual_s,
        "wall_s": pacer.elapsed_s(),
        "pace": {
            "asked": "max" if pacer.pace is None else pacer.pace,
            "reached": pacer.ratio(machine.clock.now),
            "lag": pacer.lag.as_dict(),
        },
        "setup": settings(setup, machine),
        "port": None if port is None else {"address": port.address, **port.counters.as_dict()},
    }
    if isinstance(machine, RobotMachine):
        came_to = _of_robot(session, machine)
    else:
        came_to = _of_board(session, cast("RunningBoard", machine))
    mounted = getattr(machine, "faults", ())
    faults = {"faults": [each.report().as_dict() for each in mounted]} if mounted else {}
    return began | came_to | faults | {
        "findings": findings_of(report_of(machine.findings)),
        "uart_sha256": machine.uart_sha256,
        "trace_sha256": machine.trace_sha256,
    }


def settings(setup: Setup, machine: Machine) -> dict[str, Any]:
    """The setup by its names, as far as it says something about this machine."""
    every = setup.as_dict()
    robot = isinstance(machine, RobotMachine)
    return {name: value for name, value in every.items() if robot or name not in OF_ROBOTS}


def about(setup: Setup, machine: Machine, orders: Sequence[str] = (), name: str = "") -> dict[str, str]:
    """What ran, as the head of a trace and of a page says it; `name` is that of a scenario.

    Of the setup what is not as always, and the seed.
    """
    robot = isinstance(machine, RobotMachine)
    where = Path(setup.world if robot else setup.board).stem
    said = [_AT.sub("", order) for order in orders]
    doing = f"{', '.join(said)} in {where}" if said else where
    # What is watched follows from what else was asked for.
    usual = Setup().as_dict() | {"seed": None, "world": None}
    unusual = {k: v for k, v in settings(setup, machine).items() if v != usual.get(k) and k not in ("watch", "static")}
    told = {"title": name.replace("_", " ") or f"{doing}, seed {setup.seed}", "orders": orders, **unusual}
    return {
        what: ", ".join(value) if isinstance(value, list | tuple) else str(value)
        for what, value in told.items()
        if value or value is False
    }


def _of_robot(session: Session, machine: RobotMachine) -> dict[str, Any]:
    status = machine.status()
    return {
        "bytes_from_robot": session.bytes_from_robot,
        "bytes_to_robot": session.bytes_to_robot,
        "frames": session.decoder.frames,
        "frames_malformed": session.decoder.malformed,
        "status": {
            "virtual_s": status.virtual_s,
            "state": status.state,
            "x_m": status.x_m,
            "y_m": status.y_m,
            "heading_rad": status.heading_rad,
            "distances_cm": dict(zip(("front", "right", "left"), status.distances_cm, strict=True)),
        },
    }


def _of_board(session: Session, machine: RunningBoard) -> dict[str, Any]:
    parts = machine.board.parts.values()
    return {
        "bytes_from_board": session.bytes_from_robot,
        "bytes_to_board": session.bytes_to_robot,
        "ended": machine.ended,
        "parts": {part.name: {face.name: part.value(face.name) for face in part.faces} for part in parts},
    }


def lines(summary: dict[str, Any], session: Session) -> list[str]:
    """The summary for people, without its findings."""
    lag, reached = summary["pace"]["lag"], summary["pace"]["reached"]
    time = f"virtual time {summary['virtual_s']:.3f} s in {summary['wall_s']:.3f} s"
    told = [f"{time}: pace {reached:.3f}, {which_build(session.machine)}"]
    if "status" in summary and summary["status"]["state"] == START_UP:
        told.append("start-up has not ended: main has not reached BIOS_start")
    if session.pacer.pace is not None:
        told.append(
            f"lag median {lag['median_ms']:.1f} ms, 99 % {lag['p99_ms']:.1f} ms, max {lag['max_ms']:.1f} ms, "
            f"time given up {lag['reanchors']} times ({lag['lost_ms']:.0f} ms)"
        )
    if "frames" in summary:
        dropped = summary["port"]["frames_dropped"] if summary["port"] else 0
        told.append(
            f"{summary['frames']} frames, {summary['bytes_from_robot']} bytes from the robot ({dropped} frames dropped "
            f"unread), {summary['bytes_to_robot']} bytes to it"
        )
    else:
        told += _lines_of_board(summary)
    told += [f"fault {each.report()}" for each in getattr(session.machine, "faults", ())]
    told += [f"incomplete: {log}" for log in summary.get("incomplete", ())]
    return [*told, f"uart {summary['uart_sha256']}", f"trace {summary['trace_sha256']}"]


def which_build(machine: Machine) -> str:
    """Which build runs, and where it is the compiled one, how the firmware does."""
    firmware = getattr(machine, "firmware", None)
    if MODE != "compiled" or firmware is None:
        return BUILDS[MODE]
    return f"{BUILDS[MODE]}, {'interpreted' if firmware.linked.interpreted else 'compiled'} firmware"


def _lines_of_board(summary: dict[str, Any]) -> list[str]:
    dropped = summary["port"]["bytes_dropped"] if summary["port"] else 0
    told = [
        f"{summary['bytes_from_board']} bytes from the board ({dropped} dropped unread), "
        f"{summary['bytes_to_board']} bytes to it"
    ]
    if summary["ended"]:
        told.append("the program has ended: main has returned or called BIOS_exit, or the watchdog reset the chip")
    return told


def plot(path: Path, session: Session, robot: RobotMachine, setup: Setup, *, hurried: bool) -> str:
    """Draw true path, odometry and point cloud of a robot in the world's frame; `hurried`: within a second of CPU.

    Returns one line about it.
    """
    frames = [(seen.time_s, seen.frame) for seen in session.frames]
    if path.suffix.lower() == MOVING:
        whole = save_moving(path, robot, frames, setup.world, hurried=hurried)
        return f"plot {path}" + ("" if whole else f": only {FEW} pictures after Ctrl-C; --for SECONDS draws all")
    save(drive_of(robot, frames, f"{setup.world}, {session.elapsed_virtual_s:.1f} s, seed {setup.seed}"), path)
    return f"plot {path}"
