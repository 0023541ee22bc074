"""A scenario's Python: where TOML ends.

The file has a function `scenario(bench)`.  It is called when start-up is over, with the running `hil.bench.Bench`, and
lets time pass itself (`bench.run_for(0.5)`, `bench.feed(b"#MISN\\r")`), waits for triggers of `hil.testing.triggers`
(`Timeline`, `When` below) and raises AssertionError where something did not come true.  When it returns, the rest of
the scenario's seconds pass.  It is run only because the scenario's file, which somebody named, names it.
"""

from __future__ import annotations

import runpy
from typing import TYPE_CHECKING

from hil.testing.timeline import Timeline
from hil.testing.triggers import When
from hil.testing.uart import Uart

if TYPE_CHECKING:
    from hil.bench import Bench


class ScriptFailed(Exception):
    """What a script expected did not come true."""


def timeline(bench: Bench) -> Timeline:
    """The time of a bench: `timeline(bench).until(trigger, within_s=3)`."""
    return Timeline(bench.board, bench.run_until)


def when(bench: Bench) -> When:
    """Makes triggers: `when(bench).frame("#ODO .*\\n\\r")`, `.holds(condition)`, `.finding(rule)`, `.rises(gpio)`."""
    pc = bench.board.pc
    assert pc is not None
    uart = Uart(bench.board, pc.tx_gpio, pc.rx_gpio, pc.baud)
    return When(bench.board, lambda: uart)


def run(path: str, bench: Bench) -> None:
    """Call the function of a script.  Raises ValueError for a file without it, ScriptFailed for a failed assertion."""
    function = runpy.run_path(path).get("scenario")
    if not callable(function):
        raise ValueError(f"{path}: there is no function scenario(bench)")
    try:
        function(bench)
    except AssertionError as error:
        raise ScriptFailed(str(error) or "an assertion of the script does not hold") from error
