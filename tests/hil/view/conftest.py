"""A view in a process of its own, and Debian's Chromium without a window.

`HIL_CHROMIUM` names another Chromium, `HIL_SCREENSHOTS` a folder for pictures of every panel.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.hil.waiting import TIMEOUT_S, eventually

CHROMIUM = os.environ.get("HIL_CHROMIUM", "/usr/bin/chromium")
Shot = Callable[[Any, str], None]


def needs_view() -> None:
    pytest.importorskip("nicegui", reason="needs the extra view: pip install 'c2000-hil[view]' (NiceGUI)")


class View:
    """`hil run --view` as a user starts it."""

    def __init__(self, *options: str) -> None:
        command = [sys.executable, "-m", "hil", "run", "--view", "--view-port", "0", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        self.value_text = self.process.stdout.readline()
        self.address = self.value_text.removeprefix("view: ").strip()

    def end(self) -> tuple[int, str, str]:
        """Ctrl-C; the exit status, what it came to, and what was said on stderr."""
        self.process.send_signal(signal.SIGINT)
        summary, errors = self.process.communicate(timeout=TIMEOUT_S)
        return self.process.returncode, summary, errors


@pytest.fixture(scope="module")
def view() -> Iterator[View]:
    """One robot for the tests of a module."""
    needs_view()
    view = View("--world", "room", "--seed", "3")
    yield view
    if view.process.poll() is None:
        view.end()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Not for the whole session: while its driver runs, no test in this process can run an event loop of its own."""
    needs_view()
    playwright = pytest.importorskip("playwright.sync_api", reason="needs the extra view-test (playwright)")
    if not Path(CHROMIUM).is_file():
        pytest.skip(f"needs Debian's package chromium ({CHROMIUM} is not there)")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def page(browser: Any, view: View) -> Iterator[Any]:
    """The page of the robot, ready; whatever it asks of another computer, or complains about, fails the test."""
    page = browser.new_page(viewport={"width": 1500, "height": 950})
    page.set_default_timeout(TIMEOUT_S * 1e3)
    troubles: list[str] = []
    page.on("pageerror", lambda error: troubles.append(f"page error: {error}"))

    def said(message: Any) -> None:
        # Pages that were left within the last 20 s count: a page too many is itself a 503, waits, and asks again.
        waits = "status of 503" in message.text and message.location["url"].partition("?")[0] == view.address
        if message.type == "error" and not waits:
            troubles.append(message.text)

    page.on("console", said)
    page.on(
        "request",
        lambda request: (
            None
            if request.url.startswith((view.address, "data:", "blob:"))
            else troubles.append(f"asked {request.url}")
        ),
    )
    page.goto(view.address)
    page.locator("g.robot").first.wait_for(state="attached")
    yield page
    page.close()
    assert troubles == []


@pytest.fixture(autouse=True)
def _running(request: pytest.FixtureRequest) -> None:
    """Each test with a page finds a run that goes on, whichever tests of its module's view came before it."""
    if "page" not in request.fixturenames:
        return
    page = request.getfixturevalue("page")
    chip, run = page.locator(".chip"), page.get_by_role("button", name="Run", exact=True)
    # The button may say "Pause" by the time of the click.
    while chip.count() and chip.inner_text() != "running":
        if run.count():
            run.click()
        page.wait_for_timeout(200)


def sees(page: Any, condition: Callable[[], bool], what: str) -> None:
    """Wait until a page shows something, and let the page work meanwhile."""
    eventually(condition, lambda: page.wait_for_timeout(100), what=what)


def add_signal(page: Any, label: str, name: str | None = None, words: str = "") -> None:
    """Record a signal: search the tree for its label, or for some words; choose it."""
    box = page.get_by_label("add a signal").first
    box.fill(words or label)
    page.locator(".signals:visible .q-tree__node-header").filter(has_text=re.compile(f"^{re.escape(label)}$")).click()
    page.get_by_role("button", name=f"{name or label}  x", exact=True).first.wait_for()
    box.fill("")
    page.locator(".signals:visible").first.wait_for(state="hidden")


@pytest.fixture
def shot() -> Shot:
    """Keep a picture, if somebody wants pictures."""
    folder = os.environ.get("HIL_SCREENSHOTS")

    def take(page: Any, name: str) -> None:
        if folder:
            Path(folder).mkdir(parents=True, exist_ok=True)
            page.screenshot(path=str(Path(folder) / f"{name}.png"))

    return take
