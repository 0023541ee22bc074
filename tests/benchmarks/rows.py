"""`python -m tests.benchmarks --rows`: what people wait for, as medians over rounds that take turns, and as ratios.

    python -m tests.benchmarks --rows
    python -m tests.benchmarks --rows --before ../older       # a column of that checkout, measured in the same rounds

Every round measures each row once, in a process of its own (`worker.py`), one checkout after the other; a ratio is
taken within a round, its median and its spread over the rounds are printed.  So a machine that is busy for a while
shows in the spread and hardly in the ratio.  All times are CPU time, in pure Python.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any, Final

from tests.benchmarks.worker import FIRMWARE, SAMPLE

HERE: Final = Path(__file__).resolve().parents[2]
WORKER: Final = Path(__file__).with_name("worker.py")
#: Where a checkout keeps what it has translated: each measurement names its own folder by these variables.
CACHES: Final = ("XDG_CACHE_HOME", "HIL_CACHE")
#: Stretches of each way of running in a round, and further robots.
STRETCHES: Final = 8
FURTHER: Final = 3
#: Stretches with each channel of a trace.
TRACED: Final = 4

Round = dict[str, float]


@dataclass(frozen=True, slots=True)
class Row:
    """One row: a measured time, or the ratio of two (in one checkout)."""

    label: str
    value: str
    #: What `value` is divided by; "" for a time.
    base: str = ""
    #: What is taken off the ratio: 1 turns "times" into "more than".
    less: float = 0.0
    #: The row is the reciprocal: virtual seconds a CPU second.
    rate: bool = False
    #: What is wanted of it.
    goal: str = ""

    def of(self, measured: Round) -> float | None:
        """The row's value in a round; None if the checkout does not have it."""
        value, base = measured.get(self.value), measured.get(self.base) if self.base else 1.0
        if value is None or base is None:
            return None
        return 1 / value if self.rate else value / base - self.less


ROWS: Final = (
    Row("mission, checked (virtual s / CPU s)", "checked", rate=True, goal="at least before"),
    Row("mission, watched (virtual s / CPU s)", "watched", rate=True),
    Row("mission, unchecked (virtual s / CPU s)", "unchecked", rate=True),
    Row("watched / checked", "watched", "checked", goal="at most 2.2"),
    Row("unchecked / checked", "unchecked", "checked", goal="below 1, or removed"),
    Row("trace digest, more than without", "traced", "checked", less=1.0, goal="below 0.1"),
    *(
        Row(f"trace, {name}, more than without", f"trace {name}", "trace none", less=1.0)
        for name in (
            "kernel", "pins", "adc", "sensors", "spi", "serial", "registers", "variables", "findings", "pose", "scene",
            "faces",
        )
    ),
    Row("link, first (s)", "link first"),
    Row("link, again (s)", "link again", goal="below 0.2 of before"),
    Row("link, again / first", "link again", "link first"),
    Row("link watched, first (s)", "link watched first"),
    Row("link watched, again (s)", "link watched again", goal="below 0.2 of before"),
    Row("link once more in a process (s)", "link once more first"),
    Row("link C / port, first", "link C first", "link first", goal="at most 2"),
    Row("link C / port, again", "link C again", "link again", goal="at most 1"),
    Row("further robot, booted (s)", "further robot"),
    Row("further robot / link and boot", "further robot", "link and boot"),
    Row("audit, a sample (s)", "audit", goal="below 0.33 of before"),
    Row("audit, all of it (s)", "whole audit", goal="below 0.33 of before"),
)


def measure_round(checkout: Path, *, firmware: Path | None, whole_audit: bool) -> Round:
    """Every measurement once.  Raises SystemExit with what the worker said if one fails."""
    result: Round = {}
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder)
        for which in ("first", "again"):
            for name in ("link", "link_watched", "link_c"):
                measured = _worker(checkout, cache / name, name, firmware=firmware)
                result |= {f"{key} {which}": _middle(value) for key, value in measured.items()}
        parts = (("speed", STRETCHES), ("trace", TRACED), ("further", FURTHER), ("audit", 0 if whole_audit else SAMPLE))
        for name, number in parts:
            measured = _worker(checkout, cache / "link", name, number)
            result |= {key: _middle(value) for key, value in measured.items()}
    return result


def _middle(value: Any) -> float:
    return median(value) if isinstance(value, list) else float(value)


def _worker(checkout: Path, cache: Path, name: str, number: int = 0, *, firmware: Path | None = None) -> dict[str, Any]:
    environment = os.environ | {"PYTHONPATH": str(checkout), "HIL_PURE": "1"} | {key: str(cache) for key in CACHES}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # a user's modules are compiled once, and kept
    if firmware is not None:
        environment[FIRMWARE] = str(firmware.resolve())
    command = [sys.executable, "-P", str(WORKER), name, str(number)]
    done = subprocess.run(command, env=environment, cwd=checkout, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{checkout}: {name}: {' / '.join(done.stderr.strip().splitlines()[-2:])}")
    measured: dict[str, Any] = json.loads(done.stdout)
    used = Path(measured.pop("checkout")).resolve()
    if used != checkout.resolve():
        raise SystemExit(f"{checkout} was to be measured, and {used} was: another one is installed before it")
    return measured


def measure(
    checkouts: Sequence[Path], rounds: int, *, firmware: Path | None = None, whole_audit: bool = False
) -> list[list[Round]]:
    """The rounds of each checkout; in every other round they come in the other order."""
    results: list[list[Round]] = [[] for _ in checkouts]
    for number in range(rounds):
        order = list(range(len(checkouts)))
        for index in order if number % 2 == 0 else reversed(order):
            results[index].append(measure_round(checkouts[index], firmware=firmware, whole_audit=whole_audit))
            print(f"round {number + 1} of {rounds}: {checkouts[index].name}", file=sys.stderr, flush=True)
    return results


def values(row: Row, rounds: Sequence[Round]) -> list[float]:
    """The row in each round that has it."""
    return [value for value in map(row.of, rounds) if value is not None]


def ratios(row: Row, now: Sequence[Round], before: Sequence[Round]) -> list[float]:
    """The row now by the row before, within each round."""
    pairs = [(row.of(a), row.of(b)) for a, b in zip(now, before, strict=True)]
    return [a / b for a, b in pairs if a is not None and b]


def table(now: Sequence[Round], before: Sequence[Round] | None = None) -> str:
    """The rows as text: median (smallest to largest), the same of `before`, and now / before."""
    heads = ["now", *(["before", "now / before"] if before is not None else [])]
    lines = [f"{'':40}" + "".join(f"{head:>26}" for head in heads) + "  wanted"]
    for row in ROWS:
        columns = [values(row, now)]
        if before is not None:
            columns += [values(row, before), ratios(row, now, before)]
        if any(columns):
            lines.append((f"{row.label:40}" + "".join(f"{_spread(c):>26}" for c in columns) + f"  {row.goal}").rstrip())
    return "\n".join(lines)


def _spread(column: Sequence[float]) -> str:
    return f"{median(column):.3f} ({min(column):.3f} - {max(column):.3f})" if column else "-"


def measured(options: argparse.Namespace) -> dict[str, list[Round]]:
    """The rounds of this checkout and of `--before`, by their folders."""
    checkouts = [HERE, *([options.before.resolve()] if options.before else [])]
    results = measure(checkouts, options.rounds, firmware=options.firmware, whole_audit=options.whole_audit)
    return {str(checkout): rounds for checkout, rounds in zip(checkouts, results, strict=True)}


def run(options: argparse.Namespace) -> None:
    """Measure as the options of the command say, and print."""
    results = measured(options)
    if options.json:
        print(json.dumps(results, indent=1))
    else:
        print(f"median (smallest - largest) of {options.rounds} rounds, CPU time, pure Python")
        print(table(*results.values()))
