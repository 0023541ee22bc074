"""An emulated robot in a thread of its own, behind a port that the console opens like any other.

Built, booted, run and closed in that thread: the kernel's tasks are greenlets, and those never change their thread.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from typing import Final

from emulator.c28x.findings import Finding
from hil.machine import Machine, Setup
from hil.pacing import Pacer
from hil.serial_port import SerialPort, open_port
from hil.session import Session

#: Between two looks at the findings.
REFRESH_S: Final = 0.25
#: A robot that is told to end does so after its present slice.
GRACE_S: Final = 5.0


class _Ended(Exception):
    """The console left before start-up was over."""


def real_machine(setup: Setup) -> Machine:
    """The robot of a setup."""
    from hil.bench import Bench

    return Bench(setup)


class EmulatedRobot:
    """A robot that runs until `end`.  Its attributes are written by its thread and read by anybody."""

    def __init__(self, setup: Setup, *, machine: Callable[[Setup], Machine] = real_machine, pace: float = 1.0) -> None:
        """Start it.  Raises ValueError for a pace that cannot be."""
        #: Start-up, 0..1.
        self.progress = 0.0
        #: What a PC program opens, None during start-up.
        self.address: str | None = None
        #: What ended it, if nobody asked for the end.
        self.failure: Exception | None = None
        #: In order of first occurrence; counts go on growing.
        self.findings: tuple[Finding, ...] = ()
        self._setup = setup
        self._machine = machine
        self._pacer = Pacer(pace)
        self._refreshed_s = 0.0
        self._wanted = True
        self._thread = threading.Thread(target=self._live, name="emulated robot", daemon=True)
        self._thread.start()

    def end(self) -> None:
        """Switch the robot off.  Ending twice does nothing."""
        self._wanted = False
        self._thread.join(GRACE_S)

    def _live(self) -> None:
        try:
            machine = self._machine(self._setup)
            try:
                self._boot_and_run(machine)
            finally:
                self.findings = tuple(machine.findings)
                machine.close()
        except _Ended:
            pass
        except Exception as error:  # whatever it is, it is the console's to show: a thread has nobody else to tell
            self.failure = error

    def _boot_and_run(self, machine: Machine) -> None:
        machine.boot(self._boot_progress)
        port = _own_port()
        try:
            self.address = port.address
            Session(machine, port, self._pacer, tick=self._tick).run()
        except Exception as error:
            self.failure = error  # before the port closes, or the console would blame the line
            raise
        finally:
            port.close()

    def _boot_progress(self, fraction: float) -> None:
        self.progress = fraction
        if not self._wanted:
            raise _Ended

    def _tick(self, session: Session) -> None:
        if not self._wanted:
            session.stop()
        now_s = time.monotonic()
        if now_s >= self._refreshed_s:
            self._refreshed_s = now_s + REFRESH_S
            self.findings = tuple(session.machine.findings)


def _own_port() -> SerialPort:
    """A pseudo-terminal, or loopback where there are none."""
    return open_port() if os.name == "posix" else open_port(listen="tcp://127.0.0.1:0")
