"""The page of a mission as a picture: ``python -m tests.hil.page.picture page.png``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from hil.bench import Bench
from hil.page.page import paged
from tests.hil.page.conftest import CHROMIUM


def main() -> None:
    """The command."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mission.html"
        bench = Bench("corridor", seed=1)
        with paged(file, bench, about={"title": "mission in corridor, seed 1"}):
            bench.boot()
            bench.feed("#MISN\r")
            bench.run_for(30.0)
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1280, "height": 860}, color_scheme="light")
            page.goto(f"{file.as_uri()}#t=25.19")
            page.locator(".finding", has_text="slew-read").last.get_by_role("button").click()
            page.locator(".finding .code").wait_for()
            page.wait_for_timeout(500)
            page.mouse.move(0, 0)
            page.screenshot(path=sys.argv[1])
            browser.close()


if __name__ == "__main__":
    main()
