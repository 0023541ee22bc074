"""A picture of the tutorial: ``python -m tests.hil.docs.picture tutorial-red.png`` (or ``-new``, ``-mended``, ...)."""

from __future__ import annotations

import os
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

SIZE: Final = {"width": 1280, "height": 800}
OTHERWISE: Final = re.compile("CI$|BUILD_NUMBER$|COLUMNS$|PYTEST_")
WRONG: Final = re.compile(r"// (sum \+= Samples\[SAMPLES\];)")
#: The time that a session took, which is another each time.
TOOK: Final = re.compile(r" in [\d.]+s")
TUTORIAL: Final = Path(hil.__file__).with_name("docs") / "tutorial.md"


def printed(*command: str, folder: str = ".") -> str:
    """What a command prints in a terminal with 100 columns."""
    # pytest prints otherwise on a CI machine (CI, BUILD_NUMBER), at another width, and with options of the environment.
    at_a_desk = {name: value for name, value in os.environ.items() if not OTHERWISE.match(name)}
    done = subprocess.run(
        [sys.executable, "-m", *command], capture_output=True, text=True, check=False, cwd=folder,
        env=at_a_desk | {"COLUMNS": "100"},
    )  # fmt: skip
    return TOOK.sub("", done.stdout.strip())


def show_terminal(page: Any, title: str, text: str) -> None:
    with open("/dev/null", "w", encoding="utf-8") as nowhere:
        console = Console(record=True, width=100, file=nowhere)
        console.print(Text.from_ansi(text))
    page.set_content(console.export_svg(title=title, theme=DEFAULT_TERMINAL_THEME))


def new(page: Any) -> None:
    """What `hil new` prints, and the first pytest in its folder."""
    Path("again").mkdir()
    made = printed("hil", "new", "ranger", folder="again")
    passed = printed("pytest", "-q", "--color=yes", folder="again/ranger")
    show_terminal(page, "hil new ranger", f"$ hil new ranger\n{made}\n\n$ cd ranger\n$ pytest -q\n{passed}")


def red_test(page: Any) -> None:
    """What pytest prints when the commented line of the driver is a statement."""
    driver = Path("ranger.c")
    driver.write_text(WRONG.sub(r"\1", driver.read_text(encoding="utf-8")), encoding="utf-8")
    show_terminal(page, "pytest -k 0.5", printed("pytest", "-q", "--color=yes", "-k", "0.5"))


def mended(page: Any) -> None:
    """The function without that line, and what pytest prints then."""
    driver = Path("ranger.c")
    text = re.sub(rf"\n[^\n]*{WRONG.pattern}[^\n]*", "", driver.read_text(encoding="utf-8"))
    driver.write_text(text, encoding="utf-8")
    (function,) = re.findall(r"^Uint16 Ranger_Mean.*?^}", text, re.DOTALL | re.MULTILINE)
    passed = printed("pytest", "-q", "-rp", "--color=yes")
    asked = "$ sed -n '/^Uint16 Ranger_Mean/,/^}/p' ranger.c"
    show_terminal(page, "pytest -rp", f"{asked}\n{function}\n\n$ pytest -q -rp\n{passed}")


def board(page: Any) -> subprocess.Popen[str]:
    """The page of the program on its board: a register with its fields, and who wrote it.  Returns its process."""
    (main,) = re.findall(r"```c\n(/\* main\.c \*/.*?)```", TUTORIAL.read_text(encoding="utf-8"), re.DOTALL)
    Path("main.c").write_text(main, encoding="utf-8")
    run = View("--no-open", "--board", "board.py", "--firmware", ".", "--put", "infrared.distance_m=0.5")
    page.goto(run.address)
    page.get_by_role("tab", name="Registers", exact=True).click(timeout=90_000)
    page.get_by_label("search all registers").fill("AdcbRegs ADCSOC0CTL")
    page.wait_for_function("document.querySelectorAll('.registers tbody tr').length === 1", timeout=60_000)
    page.locator(".registers tbody button").click()
    page.locator(".fields tbody tr").first.wait_for(timeout=60_000)
    page.get_by_role("button", name="Pause", exact=True).click()
    page.locator(".chip", has_text="paused").wait_for()
    page.locator(".pace").wait_for(state="hidden")
    return run.process


def main() -> None:
    """The picture that is asked for, in the current folder."""
    (name,) = sys.argv[1:]
    made = Path(name).resolve()
    with sync_playwright() as driver, tempfile.TemporaryDirectory() as folder, chdir(folder):
        subprocess.run([sys.executable, "-m", "hil", "new", "ranger"], check=True, capture_output=True)
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport=SIZE)
        with chdir("ranger"):
            drawn = {"tutorial-new": new, "tutorial-red": red_test, "tutorial-mended": mended, "tutorial-board": board}
            running = drawn[made.stem](page)
            shown = page if running else page.locator("svg").first
            shown.screenshot(path=made, animations="disabled")
            if running is not None:
                running.terminate()
        browser.close()


if __name__ == "__main__":
    main()
