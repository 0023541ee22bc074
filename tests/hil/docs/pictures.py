"""The pictures of the pages for beginners, made anew: `python -m tests.hil.docs.pictures`.

A mission in the browser, a red test, its mend, and the program on its own board.  Needs Chromium and the extra `dev`.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from contextlib import chdir
from pathlib import Path
from typing import Any, Final

from playwright.sync_api import sync_playwright
from rich.console import Console
from rich.terminal_theme import DEFAULT_TERMINAL_THEME
from rich.text import Text

import hil
from tests.hil.view.conftest import CHROMIUM, View

FOLDER: Final = Path(hil.__file__).with_name("docs")
SIZE: Final = {"width": 1280, "height": 800}
WRONG: Final = re.compile(r"// (sum \+= Samples\[SAMPLES\];)")
MAIN: Final = """#include "ranger.h"

Uint16 Distance_Mm;

void main(void)
{
    InitSysCtrl();
    Ranger_Init();
    for (;;) {
        Distance_Mm = Ranger_Distance_Mm();
        DELAY_US(10000);
    }
}
"""


def terminal(browser: Any, folder: Path, name: str, *command: str) -> None:
    """What a command prints, as a picture of a terminal."""
    done = subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, text=True, check=False)
    console = Console(record=True, width=100, file=open("/dev/null", "w", encoding="utf-8"))  # noqa: SIM115
    console.print(Text.from_ansi(done.stdout.strip()))
    page = browser.new_page(viewport=SIZE)
    page.set_content(console.export_svg(title=" ".join(command), theme=DEFAULT_TERMINAL_THEME))
    page.locator("svg").first.screenshot(path=FOLDER / name)
    page.close()


def view(browser: Any, name: str, after_s: float, panel: str, *options: str, search: str = "") -> None:
    """The page of `hil run --view` once so much virtual time has passed, with registers that were searched."""
    run = View("--no-open", *options)
    page = browser.new_page(viewport=SIZE)
    page.goto(run.address)
    page.get_by_role("tab", name=panel, exact=True).click(timeout=90_000)
    page.wait_for_function(
        "least => parseFloat(document.querySelector('.tiles').innerText.split('\\n')[1]) >= least", arg=after_s,
        timeout=120_000,
    )  # fmt: skip
    if search:
        page.get_by_label("search all registers").fill(search)
        found = page.locator(".registers tbody tr").filter(has_text=search.split()[-1])
        page.wait_for_function("document.querySelectorAll('.registers tbody tr').length === 1", timeout=60_000)
        found.locator("button").click()
        page.locator(".fields tbody tr").first.wait_for(timeout=60_000)
    page.screenshot(path=FOLDER / name)
    page.close()
    run.end()


def main() -> None:
    """All of them."""
    with sync_playwright() as driver, tempfile.TemporaryDirectory() as folder:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        view(browser, "lab-mission.png", 12.0, "Findings", "--world", "corridor", "--order", "mission")
        subprocess.run([sys.executable, "-m", "hil", "new", "ranger"], cwd=folder, check=True, capture_output=True)
        project = Path(folder, "ranger")
        driver_file = project / "ranger.c"
        right = driver_file.read_text(encoding="utf-8")
        driver_file.write_text(WRONG.sub(r"\1", right), encoding="utf-8")
        terminal(browser, project, "tutorial-red.png", "pytest", "-q", "--color=yes", "-k", "0.5", "--tb=short")
        driver_file.write_text(right, encoding="utf-8")
        terminal(browser, project, "tutorial-green.png", "pytest", "-v", "--color=yes", "--no-header")
        (project / "main.c").write_text(MAIN, encoding="utf-8")
        with chdir(project):
            view(
                browser, "tutorial-board.png", 2.0, "Registers", "--board", "board.py", "--firmware", ".",
                "--put", "infrared.distance_m=0.5", search="AdcbRegs ADCSOC0CTL",
            )  # fmt: skip
        browser.close()


if __name__ == "__main__":
    main()
