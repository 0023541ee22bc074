"""How the view holds: memory and core load of `hil run --view` with an open page at 20 Hz.

    python -m tests.benchmarks.view_soak --minutes 60 [--panel Scope]

The robot drives circles by telemanipulation, Chromium (headless) has the page open.  Each line: resident memory and
core load of the process that emulates and serves, how often the robot was drawn anew in the browser, and what the page
holds there (script memory and nodes, after a collection of garbage).  At the end straight lines through the memories
after the first quarter, in MB an hour.

Needs Debian's chromium and the extra `view-test`.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

CHROMIUM = os.environ.get("HIL_CHROMIUM", "/usr/bin/chromium")
TICKS = os.sysconf("SC_CLK_TCK")
#: Counts how often the layer with the robot is drawn: an observer of the test, not of the page.
COUNT = """() => { window.drawn = 0;
  new MutationObserver(() => window.drawn++).observe(document.querySelector('.arena'),
    {subtree: true, childList: true, characterData: true}); }"""


def usage(pid: int) -> tuple[float, float]:
    """CPU seconds and resident MB of a process."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    status = Path(f"/proc/{pid}/status").read_text()
    resident = re.search(r"VmRSS:\s+(\d+)", status)
    assert resident is not None
    return (int(fields[11]) + int(fields[12])) / TICKS, int(resident[1]) / 1024


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--every", type=float, default=30.0, help="seconds between two lines")
    parser.add_argument("--panel", default="Console")
    given = parser.parse_args()
    from playwright.sync_api import sync_playwright

    command = [sys.executable, "-m", "hil", "run", "--view", "--view-port", "0", "--world", "room"]
    orders = ["--order", "0.5:tele", "--order", "1.2:set 0.1 0.3"]
    server = subprocess.Popen(command + orders, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    try:
        address = server.stdout.readline().split()[-1]
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = browser.new_page()
            page.goto(address)
            page.get_by_text("MISSION").first.wait_for(timeout=60_000)
            page.get_by_role("tab", name=given.panel).click()
            reloads = 0

            def drawn() -> int:
                nonlocal reloads
                count = page.evaluate("window.drawn ?? -1")
                if count < 0:  # the page began anew
                    reloads += 1
                    page.evaluate(COUNT)
                return max(0, int(count))

            browser_side = page.context.new_cdp_session(page)

            def held() -> tuple[float, int]:
                browser_side.send("HeapProfiler.collectGarbage")
                heap = browser_side.send("Runtime.getHeapUsage")["usedSize"]
                return float(heap) / 1e6, int(browser_side.send("Memory.getDOMCounters")["nodes"])

            page.evaluate(COUNT)
            rows = measure(server.pid, drawn, held, given.minutes * 60, given.every)
            print(f"the page began anew {reloads} times")
            browser.close()
        report(rows)
    finally:
        server.terminate()
        server.wait(20)


def measure(
    pid: int, drawn: Callable[[], int], held: Callable[[], tuple[float, int]], length_s: float, every_s: float
) -> list[tuple[float, float, float]]:
    """Lines while it runs; (seconds, MB of the server, MB of the page's script) of each."""
    began, rows = time.monotonic(), list[tuple[float, float, float]]()
    cpu, _ = usage(pid)
    count, at = drawn(), began
    while time.monotonic() - began < length_s:
        time.sleep(every_s)  # a line every so often: nothing is waited for
        now = time.monotonic()
        cpu_now, resident = usage(pid)
        count_now = drawn()
        load, rate = (cpu_now - cpu) / (now - at), (count_now - count) / (now - at)
        heap, nodes = held()
        print(
            f"{now - began:7.0f} s  {resident:7.1f} MB  {100 * load:5.1f} % of a core  {rate:5.1f} changes/s  "
            f"page {heap:6.1f} MB {nodes:6d} nodes", flush=True,
        )  # fmt: skip
        rows.append((now - began, resident, heap))
        cpu, count, at = cpu_now, count_now, now
    return rows


def report(rows: list[tuple[float, float, float]]) -> None:
    """The trends of the memories, without the first quarter."""
    settled = np.array(rows[len(rows) // 4 :])
    if len(settled) < 4:
        print("too short for a trend")
        return
    for column, what in ((1, "server"), (2, "page")):
        slope = np.polyfit(settled[:, 0] / 3600, settled[:, column], 1)[0]
        first, last = settled[0, column], settled[-1, column]
        print(f"{what}: {first:.1f} -> {last:.1f} MB, {slope:+.1f} MB an hour (straight line, {len(settled)} points)")


if __name__ == "__main__":
    main()
