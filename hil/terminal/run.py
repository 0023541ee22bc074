"""A session at the console: open the robot, show the screen, stop the robot however the screen ended."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hil.machine import Machine, Setup
from hil.reports.policy import Policy
from hil.terminal.app import TerminalApp
from hil.terminal.link import Link, Traffic
from hil.terminal.robot import EmulatedRobot, real_machine


@dataclass(frozen=True, slots=True)
class Summary:
    """The result of a session at the console."""

    port: str | None
    seconds: float
    traffic: Traffic
    stop_sent: bool
    #: Of an emulated robot.
    findings: int | None
    #: What went wrong, "" if nothing did.
    failure: str

    @property
    def line(self) -> str:
        """The result as a line for users."""
        traffic = self.traffic
        text = f"{self.seconds:.1f} s: {traffic.frames} frames, {traffic.malformed} malformed, {traffic.orders} orders"
        text += f" and {traffic.references} SETR sent" if traffic.references else " sent"
        text += "" if self.findings is None else f", {self.findings} findings"
        return f"{text}; {'robot stopped' if self.stop_sent else 'STOP NOT SENT'}"

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return asdict(self)


def run_terminal(
    port: str | None,
    setup: Setup | None = None,
    *,
    machine: Callable[[Setup], Machine] = real_machine,
    pace: float = 1.0,
    first: Sequence[str] = (),
) -> Summary:
    """Run the console until the user leaves: for the robot behind `port` (a device or any URL of pyserial), or without
    one for an emulated robot of `setup`, made by `machine`, at `pace` times real time, with the orders `first`.

    Raises ValueError, one line, for what the user can mend (no terminal, no such port or world, a wrong policy), and
    FirmwareStopped when the emulated firmware did not run on.
    """
    if not all(stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)):
        raise ValueError("this console needs a terminal; without one: hil drive PORT ORDER...")
    policy = Policy.load(Path.cwd())
    began_s = time.monotonic()
    link = Link(port) if port is not None else None
    robot = None if port is not None else EmulatedRobot(setup or Setup(), machine=machine, pace=pace)
    app = TerminalApp(link, robot, first, policy)
    try:
        app.run()
    finally:
        if app.link is not None:
            app.link.close()
        if robot is not None:
            robot.end()
    if robot is not None and robot.failure is not None:
        raise robot.failure
    if app.failure:
        raise ValueError(app.failure)
    return Summary(
        port,
        time.monotonic() - began_s,
        app.link.traffic if app.link is not None else Traffic(0, 0, 0, 0, 0, 0, 0),
        app.link is not None and app.link.stop_sent,
        None if robot is None else len(robot.findings),
        _failure(app),
    )


def _failure(app: TerminalApp) -> str:
    if app.return_code:  # it has shown its traceback
        return "the console failed: a defect of its own"
    return app.link.failure if app.link is not None else ""
