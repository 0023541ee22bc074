"""Runs that pages are made of, and Debian's Chromium without a window.

`HIL_CHROMIUM` names another Chromium, `HIL_SCREENSHOTS` a folder for pictures of the page.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from hil.bench import Bench
from hil.instruments.recorder import recorded
from hil.instruments.trace_file import DEFAULT, RecordedTrace, read
from hil.page.page import paged

CHROMIUM = os.environ.get("HIL_CHROMIUM", "/usr/bin/chromium")
ABOUT = {"title": "mission in corridor, seed 3", "world": "corridor", "seed": "3"}


@pytest.fixture(scope="session")
def drive(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Bench]:
    """Two seconds of a mission with a post in the world: its trace, its page, and the robot afterwards."""
    folder = tmp_path_factory.mktemp("drive")
    bench = Bench("corridor", seed=3)
    bench.world.add_obstacle("post", 1.6, 0.9, 0.1)
    trace, page = folder / "drive.trace", folder / "drive.html"
    with recorded(trace, bench, DEFAULT, ABOUT), paged(page, bench, DEFAULT, ABOUT):
        bench.boot()
        bench.feed("#MISN\r")
        bench.run_for(2.0)
    return trace, page, bench


@pytest.fixture(scope="session")
def trace(drive: tuple[Path, Path, Bench]) -> RecordedTrace:
    return read(drive[0])


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Not for the whole session: while its driver runs, no test in this process can run an event loop of its own."""
    playwright = pytest.importorskip("playwright.sync_api", reason="needs the extra view-test (playwright)")
    if not Path(CHROMIUM).is_file():
        pytest.skip(f"needs Debian's package chromium ({CHROMIUM} is not there)")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()
