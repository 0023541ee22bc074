"""The tolerance of computation times: which code is calibrated, and which is not.

The tasks of the port were fitted to the times measured on the robot; what remains of them is a residual that can be
stated.  Any other code is computed from a table of cycles without a measurement: `UNCALIBRATED_FACTOR` says how far
such a time has been off where it could be compared.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Final

from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Function

#: In a table, beside a time of code that was not calibrated.
OFF_BY: Final = f"x {1 / UNCALIBRATED_FACTOR:.2g} to x {UNCALIBRATED_FACTOR:g}"
#: Under a table of times.
EXPLANATION: Final = (
    "C off by: of a calibrated task, its C mean against the highest and the lowest time of the thesis. "
    f"'{OFF_BY}': code that was not calibrated, on the chip up to {UNCALIBRATED_FACTOR:g} times shorter or longer; the "
    "worst of predicting each calibrated task by constants fitted without it, and of what nothing was fitted to."
)


def residual_percent(time_us: float, measured_us: Iterable[float]) -> tuple[float, float]:
    """How far a time lies from the longest and from the shortest of those measured, in percent of them."""
    measured = sorted(measured_us)
    return (time_us / measured[-1] - 1) * 100, (time_us / measured[0] - 1) * 100


def tasks_of(files: Iterable[str | Path], modules: Collection[Module], tasks: Iterable[str]) -> frozenset[str]:
    """Those of `tasks` that run a function of `files`, as far as calls by name lead.

    A task is known by the name of its function; one whose function is not found counts as one of these.
    """
    theirs = {str(Path(file).resolve()) for file in files}
    if not theirs:
        return frozenset()
    functions = {function.path: function for module in modules for function in module.functions}
    own = {
        function.path
        for module in modules
        for function in module.functions
        if str(Path(module.unit(function.name).file).resolve()) in theirs
    }
    named = {function.name: function for function in functions.values()}
    found = set()
    for task in tasks:
        entry = named.get(task.partition("#")[0])  # a second task of the same function: TaskUS#2
        if entry is None or own & _reached(entry, functions):
            found.add(task)
    return frozenset(found)


def _reached(entry: Function, functions: Mapping[str, Function]) -> set[str]:
    """A function and all that it calls by name."""
    reached: set[str] = set()
    ahead = [entry.path]
    while ahead:
        path = ahead.pop()
        if path in functions and path not in reached:
            reached.add(path)
            ahead += functions[path].calls
    return reached
