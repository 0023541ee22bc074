"""`python -m tests.benchmarks`: simulated seconds per wall second of the whole robot; then the rows
of `rows.py`: what people wait for, as ratios.

Everything takes part: world, devices, peripherals, kernel, six tasks, the serial line.  A wall-clock figure depends
on the machine, so each run is bracketed by a plain Python loop, and the cost is given in iterations of it too: that
figure can be compared between machines and days.  For scale, the drivers alone and an AVR instruction simulator at the
same work (`drivers.py`).
"""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time

from emulator import compiled
from hil.bench import Bench
from hil.machine import Setup
from tests.benchmarks import drivers, forks, order_latency, rows


def loop_ns(iterations: int = 300_000) -> float:
    """CPU time of one iteration of a trivial loop, in nanoseconds."""
    start = process_time()
    x = 0
    for i in range(iterations):
        x += i & 3
    return (process_time() - start) / iterations * 1e9


def measure(order: bytes, setup: Setup, *, seconds: float, rounds: int) -> dict[str, float]:
    """The best of `rounds` stretches of `seconds` virtual seconds after `order`."""
    bench = Bench(setup, traced=False)
    bench.boot()
    bench.feed(order)
    bench.run_for(1.0)
    best = {"pace_wall": 0.0, "pace_cpu": 0.0, "loops_per_simulated_s": float("inf")}
    for _ in range(rounds):
        before = loop_ns()
        wall, cpu = perf_counter(), process_time()
        bench.run_for(seconds)
        cpu, wall = process_time() - cpu, perf_counter() - wall
        loop = (before + loop_ns()) / 2
        best["pace_wall"] = max(best["pace_wall"], seconds / wall)
        best["pace_cpu"] = max(best["pace_cpu"], seconds / cpu)
        best["loops_per_simulated_s"] = min(best["loops_per_simulated_s"], cpu / seconds * 1e9 / loop)
    bench.close()
    return best


def main() -> None:
    """Print a table, or JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmarks", description=__doc__.splitlines()[0] if __doc__ else ""
    )
    parser.add_argument("--seconds", type=float, default=5.0, help="virtual seconds a stretch (default 5)")
    parser.add_argument("--rounds", type=int, default=5, help="stretches, the best counts (default 5)")
    parser.add_argument("--orders", type=int, default=100, help="orders whose latency is measured (default 100)")
    parser.add_argument("--rows", action="store_true", help="only the rows of ratios")
    parser.add_argument("--no-rows", action="store_true", help="all but the rows of ratios")
    parser.add_argument("--before", type=Path, metavar="DIR", help="rows: another checkout, in the same rounds")
    parser.add_argument("--firmware", type=Path, metavar="DIR", help="rows: the robot's C files")
    parser.add_argument("--whole-audit", action="store_true", help="rows: every entry of the audit, not a sample")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args()
    if options.rows:
        rows.run(options)
        return
    ideal = Setup(realistic=False)
    cases = {
        "standing": (b"", ideal), "mission": (forks.ORDER, ideal),
        "mission, realistic": (forks.ORDER, Setup(realistic=True)),
        "mission, watched": (forks.ORDER, replace(ideal, watch=True, static=True)),
    }  # fmt: skip
    results = {
        name: measure(order, setup, seconds=options.seconds, rounds=options.rounds)
        for name, (order, setup) in cases.items()
    }
    alone = drivers.measure(math.ceil(options.seconds), options.rounds)
    copies = forks.measure(math.ceil(20 * options.seconds))
    latency = order_latency.measure(options.orders)
    if options.json:
        whole = {"mode": compiled.MODE, **results, "drivers": alone, "copies": copies, "order latency": latency}
        print(json.dumps(whole if options.no_rows else {**whole, "rows": rows.measured(options)}, indent=2))
        return
    print(f"{'whole robot, ' + compiled.MODE:30} {'x real time':>12} {'x CPU time':>12} {'loops / simulated s':>21}")
    for name, result in results.items():
        print(
            f"{name:30} {result['pace_wall']:12.1f} {result['pace_cpu']:12.1f} {result['loops_per_simulated_s']:21,.0f}"
        )
    drivers.show(alone)
    forks.show(copies)
    order_latency.show(latency)
    if not options.no_rows:
        rows.run(options)


if __name__ == "__main__":
    main()
