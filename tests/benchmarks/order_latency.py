"""`python -m tests.benchmarks.order_latency`: what the bench adds to the way of an order.

Another process writes orders to the port at irregular times; the whole robot runs at real time.  Measured from the
moment of `write` to the firmware's receive interrupt of the order's last byte, less the time the bytes need on the line
(10 bits at 9600 baud each): once when that interrupt was executed on this computer, once in the robot's own time.
The goal is a median below 5 ms; a busy computer shows in the 99th percentile first.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time

from emulator.clock import SYSCLK_HZ
from hil.bench import Bench
from hil.pacing import Pacer
from hil.serial_port.pty_port import PtyPort
from hil.session import Session

ORDER = b"#STOP\r"
LINE_S = len(ORDER) * 10 / 9600
#: The interrupt of main_Robot.c that takes bytes from the SCI.
INTERRUPT = "XBee_Receive"

_WRITER = """
import os, random, sys, time
device, count, order = sys.argv[1], int(sys.argv[2]), sys.argv[3].encode()
fd = os.open(device, os.O_RDWR | os.O_NOCTTY)
chance = random.Random(1)
for _ in range(count):
    time.sleep(chance.uniform(0.03, 0.09))  # at any moment of a slice: that is what is measured
    print(time.monotonic_ns(), flush=False)
    os.write(fd, order)
"""
#: Until the writer has begun, and for the last order on the line.
LEEWAY_S = 3.0


def measure(orders: int) -> dict[str, float]:
    """Added latencies in milliseconds."""
    bench = Bench(traced=False)
    bench.boot()
    port = PtyPort()
    pacer = Pacer(1.0)
    interrupts: list[tuple[float, int]] = []

    def traced(cycles: int, kind: str, name: str) -> None:
        if kind == "hwi" and name == INTERRUPT:
            interrupts.append((time.monotonic(), cycles))

    bench.board.trace.listen(traced)
    writer = subprocess.Popen(
        [sys.executable, "-c", _WRITER, port.device, str(orders), ORDER.decode()], stdout=subprocess.PIPE, text=True
    )

    def tick(session: Session) -> None:
        if len(interrupts) == orders * len(ORDER):
            session.stop()

    session = Session(bench, port, pacer, tick=tick)
    session.run(orders * 0.09 + LEEWAY_S)
    written_s = [int(line) / 1e9 for line in writer.communicate()[0].split()]
    port.close()
    bench.close()
    last_bytes = interrupts[len(ORDER) - 1 :: len(ORDER)]
    if len(last_bytes) != orders or pacer.lag.reanchors:
        raise SystemExit(f"{len(last_bytes)} of {orders} orders arrived, time given up {pacer.lag.reanchors} times")
    executed = sorted((wall - t - LINE_S) * 1e3 for t, (wall, _) in zip(written_s, last_bytes, strict=True))
    virtual = sorted(
        (pacer.deadline_s(cycles) - t - LINE_S) * 1e3 for t, (_, cycles) in zip(written_s, last_bytes, strict=True)
    )
    return {
        "orders": orders,
        "line_ms": LINE_S * 1e3,
        "executed_median_ms": _quantile(executed, 0.5),
        "executed_p99_ms": _quantile(executed, 0.99),
        "virtual_median_ms": _quantile(virtual, 0.5),
        "virtual_p99_ms": _quantile(virtual, 0.99),
        "slice_ms": pacer.slice_cycles / SYSCLK_HZ * 1e3,
    }


def _quantile(values: list[float], share: float) -> float:
    return values[min(int(share * len(values)), len(values) - 1)]


def show(result: dict[str, float]) -> None:
    """A few lines for people."""
    print(f"{'latency of an order, added (ms)':34} {'median':>8} {'99 %':>8}")
    for name, label in (("executed", "until it was executed"), ("virtual", "in the robot's own time")):
        print(f"  {label:32} {result[f'{name}_median_ms']:8.2f} {result[f'{name}_p99_ms']:8.2f}")


def main() -> None:
    """Print a table, or JSON."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.order_latency")
    parser.add_argument("--orders", type=int, default=300, help="orders to send (default 300)")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args()
    result = measure(options.orders)
    print(json.dumps(result, indent=2)) if options.json else show(result)


if __name__ == "__main__":
    main()
