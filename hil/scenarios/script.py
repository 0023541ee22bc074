"""A scenario's Python: where TOML ends.

The file has a function `scenario(bench)`.  It is called when start-up is over, with the running `hil.bench.Bench`, and
lets time pass itself (`bench.run_for(0.5)`, `bench.feed(b"#MISN\\r")`), waits for triggers of `hil.testing.triggers`
(`Timeline`, `When` below) and raises AssertionError where something did not come true.  When it returns, the rest of
the scenario's seconds pass.  It is run only because the scenario's file, which somebody named, names it.
"""

from __future__ import annotations

import runpy
import traceback
from typing import TYPE_CHECKING, Any

from greenlet import greenlet

from emulator.clock import SYSCLK_HZ
from hil.machine import FirmwareStopped
from hil.session import Session
from hil.testing.timeline import Timeline
from hil.testing.triggers import When
from hil.testing.uart import Uart

if TYPE_CHECKING:
    from hil.bench import Bench


class ScriptFailed(Exception):
    """An expectation of a script failed."""


def timeline(bench: Bench) -> Timeline:
    """The time of a bench: `timeline(bench).until(trigger, within_s=3)`."""
    return Timeline(bench.board, bench.run_slice if isinstance(bench, LiveBench) else bench.run_until)


def when(bench: Bench) -> When:
    """Makes triggers: `when(bench).frame("#ODO .*\\n\\r")`, `.holds(condition)`, `.finding(rule)`, `.rises(gpio)`."""
    pc = bench.board.pc
    assert pc is not None
    uart = Uart(bench.board, pc.tx_gpio, pc.rx_gpio, pc.baud)
    return When(bench.board, lambda: uart)


def run(path: str, bench: Bench) -> None:
    """Call the function of a script.

    Raises ValueError for a file without it, ScriptFailed for an assertion or anything else that fails in it.
    """
    function = runpy.run_path(path).get("scenario")
    if not callable(function):
        raise ValueError(f"{path}: there is no function scenario(bench)")
    try:
        function(bench)
    except FirmwareStopped:
        raise
    except AssertionError as error:
        raise ScriptFailed(str(error) or "an assertion of the script does not hold") from error
    except Exception as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == path]
        raise ScriptFailed(f"{path}:{lines[-1]}: {type(error).__name__}: {error}") from error


class LiveScript:
    """A script of a live session.  The session lets the time pass that the script waits for, and ends with it."""

    def __init__(self, path: str, seconds: float) -> None:
        """`seconds` of virtual time pass at least."""
        self._path = path
        self._seconds = seconds

    def begin(self, session: Session) -> None:
        """Call the script, until it lets time pass.  Raises what `run` raises."""
        self._session = session
        self._greenlet = greenlet(self._run)
        self._greenlet.switch()

    def _run(self) -> None:
        bench = LiveBench(self, self._session)
        end = bench.clock.now + round(self._seconds * SYSCLK_HZ)
        run(self._path, bench)  # type: ignore[arg-type]
        bench.run_until(end)
        self._session.stop()

    def tick(self) -> None:
        """Continue the script after a slice, until it lets time pass again.  Raises what `run` raises."""
        if self._greenlet:
            self._greenlet.switch()

    def wait(self, cycles: int) -> None:
        """Let a slice pass for the script, which ends at `cycles` at the latest."""
        self._session.wanted_cycles = cycles
        caller = self._greenlet.parent
        assert caller is not None
        caller.switch()


class LiveBench:
    """The `bench` of a live script: the robot, whose time passes in the session, at its pace."""

    def __init__(self, script: LiveScript, session: Session) -> None:
        self._script = script
        self._session = session

    def __getattr__(self, name: str) -> Any:
        return getattr(self._session.machine, name)

    def feed(self, data: bytes) -> None:
        """Give bytes to the line, as the session does."""
        self._session.feed(data)

    def run_slice(self, cycles: int) -> None:
        """Let time pass until `cycles`, or less."""
        self._script.wait(cycles)

    def run_until(self, cycles: int) -> None:
        """Let time pass until `cycles`."""
        while self._session.machine.clock.now < cycles:
            self._script.wait(cycles)

    def run_for(self, duration_s: float) -> None:
        """Let `duration_s` seconds of virtual time pass."""
        self.run_until(self._session.machine.clock.now + round(duration_s * SYSCLK_HZ))
