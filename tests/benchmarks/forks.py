"""Runs of half a virtual second that are copies of one booted robot (`hil/audit/forked.py`): how many a second."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any, Final

from hil.audit import forked
from hil.bench import Bench
from hil.machine import Setup

if sys.platform != "win32":  # no processes are forked there
    import resource

ORDER: Final = b"#MISN\r"
RUN_S: Final = 0.5
_PRIVATE: Final = re.compile(r"^Private_Dirty: +(\d+) kB", re.MULTILINE)


def measure(runs: int) -> dict[str, float]:
    """Runs a wall second on all cores, and what one costs; an empty answer where there is no fork."""
    if sys.platform == "win32" or not forked.possible():
        return {}
    bench = Bench(Setup(realistic=False), traced=False)
    bench.boot()

    def run() -> tuple[str, float]:
        bench.feed(ORDER)
        bench.run_for(RUN_S)
        return bench.uart_sha256, _private_mib()

    def cpu_s() -> float:
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    def of(function: Callable[[], Any], number: int) -> tuple[float, float, list[Any]]:
        """Wall and CPU seconds of `number` calls in children, and their results."""
        wall, cpu, calls = perf_counter(), cpu_s(), ((n, function) for n in range(number))
        results = [result for _, result in forked.in_children(calls, at_once=os.cpu_count() or 1)]
        return perf_counter() - wall, cpu_s() - cpu, results

    of(run, 1)  # what both import on their way
    wall, cpu, results = of(run, runs)
    _, alone, _ = of(lambda: None, runs)
    bench.close()
    if len({sha256 for sha256, _ in results}) != 1:
        raise SystemExit("copies of one robot differ")
    return {
        "runs_per_s": runs / wall, "cpu_ms": cpu / runs * 1e3, "fork_cpu_ms": alone / runs * 1e3,
        "private_mib": max(mib for _, mib in results),
    }  # fmt: skip


def _private_mib() -> float:
    """What this process has of its own, in MiB; 0 where the system does not say."""
    try:
        found = _PRIVATE.search(Path("/proc/self/smaps_rollup").read_text("ascii"))
    except OSError:
        return 0.0
    return int(found[1]) / 1024 if found else 0.0


def show(result: dict[str, float]) -> None:
    """A line for people."""
    if result:
        print(
            f"copies of a booted robot, {RUN_S} s each: {result['runs_per_s']:.0f} a second on {os.cpu_count()} cores; "
            f"CPU {result['cpu_ms']:.1f} ms, of which the fork {result['fork_cpu_ms']:.1f}; "
            f"memory of its own {result['private_mib']:.1f} MiB"
        )
