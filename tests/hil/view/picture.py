"""Pictures of the view: ``python -m tests.hil.view.picture scope.png`` (or ``mission.png``, the whole page).

A mission, gone to one moment, so that a picture is the same every time.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, Final

from tests.hil.view.conftest import CHROMIUM, View, add_signal
from tests.hil.waiting import TIMEOUT_S

#: A signal's name, how the tree calls it, and what is typed to find it, if that is something else.
SIGNALS: Final = (
    ("gate US_server", "US_server", ""), ("main_robot.Wl_ref", "Wl_ref", ""),
    ("main_robot.Front_distance", "Front_distance", ""), ("GPIO61", "GPIO61 (gyro CS)", ""),
    ("SIMO SPI-A", "SIMO SPI-A", ""), ("duty GPIO2", "GPIO2", "duty GPIO2"),
)  # fmt: skip
#: The moment of the scope, and that of the page: there the robot has driven for a while.
MOMENT_S: Final = "3.016"
LATER_S: Final = "14.000"
SPAN: Final = "1 ms"


def go_to(page: Any, moment_s: str) -> None:
    page.get_by_role("tab", name="Time").click()
    page.get_by_label("time, s").fill(moment_s)
    page.get_by_role("button", name="Go to this time").click()
    page.locator(".tile .value").filter(has_text=re.compile(rf"^{moment_s} s$")).wait_for()


def mission(page: Any, target: Path) -> None:
    """The page, at a later moment: the run goes ahead to it at full speed."""
    go_to(page, LATER_S)
    page.get_by_role("tab", name="Console").click()
    page.mouse.move(0, 0)
    page.locator(".log", has_text="#MISN").wait_for()
    page.locator(".pace").wait_for(state="hidden")
    page.get_by_role("tooltip").wait_for(state="hidden")
    # How long it took to go there is another time each time.
    page.locator(".one-line").evaluate("message => { message.hidden = true; }")
    page.screenshot(path=str(target), animations="disabled")


def scope(page: Any, target: Path) -> None:
    """Choose signals, go to the moment, and keep the panel."""
    page.get_by_role("tab", name="Scope").click()
    for name, label, words in SIGNALS:
        add_signal(page, label, name, words)
    page.get_by_label("span").click()
    page.get_by_role("option", name=SPAN, exact=True).click()
    # The moment has passed, so that the view goes back to it.
    page.wait_for_function(f"parseFloat(document.querySelector('.tile .value').textContent) > {MOMENT_S}")
    go_to(page, MOMENT_S)
    page.get_by_role("tab", name="Scope").click()
    page.mouse.move(0, 0)
    # The lanes end at that moment, and so does the chart, which is sent with them.
    page.locator(".lanes .time", has_text=f"{MOMENT_S}000 s").wait_for()
    page.get_by_role("tooltip").wait_for(state="hidden")
    page.locator(".side").first.screenshot(path=str(target), animations="disabled")


def main() -> None:
    """The command."""
    from playwright.sync_api import sync_playwright

    target = Path(sys.argv[1])
    draw, size = {"scope": (scope, (1500, 1300)), "mission": (mission, (1440, 900))}[target.stem]
    view = View("--world", "room", "--seed", "3", "--order", "0.1:mission")
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": size[0], "height": size[1]})
            page.set_default_timeout(TIMEOUT_S * 1e3)
            page.goto(view.address)
            page.locator("g.robot").first.wait_for(state="attached")
            draw(page, target)
            browser.close()
    finally:
        view.end()


if __name__ == "__main__":
    main()
