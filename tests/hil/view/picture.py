"""The scope of the view as a picture: ``python -m tests.hil.view.picture scope.png``.

A mission, gone back in to one moment, so that the picture is the same every time.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, Final

from tests.hil.view.conftest import CHROMIUM, View, add_signal

#: A signal's name, how the tree calls it, and what is typed to find it, if that is something else.
SIGNALS: Final = (
    ("gate US_server", "US_server", ""), ("main_robot.Wl_ref", "Wl_ref", ""),
    ("main_robot.Front_distance", "Front_distance", ""), ("GPIO61", "GPIO61 (gyro CS)", ""),
    ("SIMO SPI-A", "SIMO SPI-A", ""), ("duty GPIO2", "GPIO2", "duty GPIO2"),
)  # fmt: skip
MOMENT_S: Final = "3.016"
SPAN: Final = "1 ms"


def draw(page: Any, target: Path) -> None:
    """Choose signals, go to the moment, and keep the panel."""
    page.get_by_role("tab", name="Scope").click()
    for name, label, words in SIGNALS:
        add_signal(page, label, name, words)
    page.get_by_label("span").click()
    page.get_by_role("option", name=SPAN, exact=True).click()
    page.get_by_role("tab", name="Time").click()
    page.get_by_label("time, s").fill(MOMENT_S)
    page.get_by_role("button", name="Go to this time").click()
    page.locator(".tile .value").filter(has_text=re.compile(rf"^{MOMENT_S} s$")).wait_for(timeout=60_000)
    page.get_by_role("tab", name="Scope").click()
    page.mouse.move(0, 0)
    # The lanes end at that moment, and so does the chart, which is sent with them.
    page.locator(".lanes .time", has_text=f"{MOMENT_S}000 s").wait_for(timeout=60_000)
    page.get_by_role("tooltip").wait_for(state="hidden")
    page.locator(".side").first.screenshot(path=str(target), animations="disabled")


def main() -> None:
    """The command."""
    from playwright.sync_api import sync_playwright

    view = View("--world", "room", "--seed", "3", "--order", "0.1:mission")
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1500, "height": 1300})
            page.set_default_timeout(30_000)
            page.goto(view.address)
            page.locator("g.robot").first.wait_for(state="attached", timeout=90_000)
            # The moment has passed, so that the view goes back to it.
            page.wait_for_function(f"parseFloat(document.querySelector('.tile .value').textContent) > {MOMENT_S}")
            draw(page, Path(sys.argv[1]))
            browser.close()
    finally:
        view.end()


if __name__ == "__main__":
    main()
