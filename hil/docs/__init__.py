"""Pages for users, as they stand in the packages: `hil docs` lists them, shows one, or makes a site of all.

A page is Markdown, and its blocks are run by a test.  A new one is a file here (or a README) and a line in `PAGES`;
`package-data` in pyproject.toml takes it into the wheel.  A page that is made of data is a module with `page()`; a
notebook is shown as its cells.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from importlib.resources import files
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import Any, Final


@dataclass(frozen=True)
class DocPage:
    """A page: the section of the list that it stands in, its file within `package`, and what one learns there."""

    section: str
    package: str
    file: str
    about: str

    @property
    def path(self) -> PurePosixPath:
        """Its file from the root of the sources."""
        return PurePosixPath(self.package, self.file)

    def source(self) -> str:
        """Its file."""
        return files(self.package).joinpath(self.file).read_text(encoding="utf-8")

    def text(self) -> str:
        """Its Markdown."""
        if self.path.suffix == ".py":
            made: str = import_module(".".join(self.path.with_suffix("").parts)).page()
            return made
        text = self.source()
        return _cells(json.loads(text)) if self.path.suffix == ".ipynb" else text


def _cells(notebook: Mapping[str, Any]) -> str:
    """A notebook as Markdown."""
    shown = []
    for cell in notebook["cells"]:
        text = "".join(cell["source"])
        shown.append(text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
    return "\n\n".join(shown) + "\n"


BEGIN, TEST, ROBOT, LOOK_UP, INSIDE = "Begin", "Test your firmware", "Drive the robot", "Look up", "How it is made"

#: The pages, by the name that `hil docs` takes.
PAGES: Final[Mapping[str, DocPage]] = MappingProxyType({
    "tutorial": DocPage(BEGIN, "hil", "docs/tutorial.md", "ten minutes: a project, a board, a red test of your own driver"),
    "lab": DocPage(BEGIN, "hil", "docs/lab.md", "for students and teachers of a real-time lab: missions, defects, grading"),
    "engineer": DocPage(BEGIN, "hil", "docs/engineer.md", "for engineers with a board and drivers: from C files to CI"),
    "browser": DocPage(BEGIN, "hil", "docs/browser.md", "with only a browser: what you can see without an installation"),
    "mission": DocPage(BEGIN, "hil", "docs/mission.ipynb", "a notebook: the mission of the thesis, from Python"),
    "safe": DocPage(BEGIN, "hil", "docs/safe.md", "is it safe to link a stranger's driver: what runs, what is confined"),
    "testing": DocPage(TEST, "hil", "testing/README.md", "tests of your firmware with pytest: fixtures, findings, time, boards"),
    "check": DocPage(TEST, "hil", "drivers/README.md", "hil check: what it calls, with which arguments, and what counts"),
    "reports": DocPage(TEST, "hil", "reports/README.md", "findings in SARIF, JUnit and HTML; severities and baselines"),
    "debugging": DocPage(TEST, "hil", "docs/debugging.md", "breakpoints in drivers and tasks, in C and in Python, with VS Code"),
    "parts": DocPage(TEST, "emulator", "devices/README.md", "the parts around the chip, and how to add one"),
    "faults": DocPage(TEST, "hil", "faults/README.md", "faults that can be injected, and the proof that they fired"),
    "feeds": DocPage(TEST, "hil", "feeds/README.md", "what sensors see: numbers, CSV, arrays, generators, recorded runs"),
    "instruments": DocPage(TEST, "hil", "instruments/README.md", "the trace file of a run, for GTKWave, Perfetto, NumPy"),
    "rta": DocPage(TEST, "hil", "rta/README.md", "response times, computed and measured"),
    "bench": DocPage(ROBOT, "hil", "README.md", "the serial line, virtual time, the tolerance of times, the faster build"),
    "view": DocPage(ROBOT, "hil", "view/README.md", "a board or the robot in the browser: scope, registers, back in time"),
    "terminal": DocPage(ROBOT, "hil", "terminal/README.md", "the console in a terminal"),
    "console": DocPage(ROBOT, "hil", "console/README.md", "the Windows console of the thesis, unmodified"),
    "recording": DocPage(ROBOT, "hil", "recording/README.md", "record a drive, replay it to the byte, compare two"),
    "page": DocPage(ROBOT, "hil", "page/README.md", "a run as one HTML file that replays it; pages for a site"),
    "worlds": DocPage(ROBOT, "hil", "world/README.md", "the world of the robot, and how to make another"),
    "scenarios": DocPage(ROBOT, "hil", "scenarios/README.md", "scenarios as files: world, orders, faults, what must come true"),
    "options": DocPage(ROBOT, "hil", "robot/options/README.md", "optional parts of the robot: two sonars, accelerometer, LiDAR"),
    "procedures": DocPage(ROBOT, "hil", "procedures/README.md", "calibration and other procedures of the thesis"),
    "diff": DocPage(ROBOT, "hil", "diff/README.md", "the port and your own C of the same functions, compared"),
    "safety": DocPage(ROBOT, "hil", "safety/README.md", "what the corrected robot does when something breaks"),
    "language": DocPage(LOOK_UP, "hil", "docs/language.md", "how to write firmware: C, and C-shaped Python"),
    "rules": DocPage(LOOK_UP, "emulator", "rules/README.md", "the rules of findings, and how to add a detector"),
    "modelled": DocPage(LOOK_UP, "hil", "docs/modelled.py", "what of peripherals, parts, kernel and world is modelled, and what is not"),
    "audit": DocPage(LOOK_UP, "hil", "audit/README.md", "the known defects of the robot's firmware, and how each is demonstrated"),
    "emulator": DocPage(INSIDE, "emulator", "README.md", "the chip: its layers and modules"),
    "c28x": DocPage(INSIDE, "emulator", "c28x/README.md", "the C of this chip: readers, tree, passes"),
    "sysbios": DocPage(INSIDE, "emulator", "sysbios/README.md", "the kernel: tasks, gates, semaphores, what is left out"),
    "peripherals": DocPage(INSIDE, "emulator", "peripherals/README.md", "what the registers do, and how to add a block"),
    "registers": DocPage(INSIDE, "emulator", "registers/README.md", "registers and fields, as the manual lists them"),
    "firmware": DocPage(INSIDE, "firmware_model", "README.md", "the robot's firmware, line by line beside the C"),
    "board-support": DocPage(INSIDE, "firmware_model", "board_support/README.md", "the C files that the thesis uses and does not print"),
    "robot": DocPage(INSIDE, "hil", "robot/README.md", "the robot's schematic, and its connection to the world"),
    "robot-view": DocPage(INSIDE, "hil", "robot/view/README.md", "the robot's part of the page in the browser"),
    "client": DocPage(INSIDE, "hil", "client/README.md", "the PC's side of the serial line"),
    "serial-port": DocPage(INSIDE, "hil", "serial_port/README.md", "pseudo-terminal, TCP, RFC 2217, existing devices"),
    "golden": DocPage(INSIDE, "hil", "golden/README.md", "golden vectors, and how they are run"),
    "project": DocPage(INSIDE, "hil", "project/README.md", "what hil new writes"),
    "cli": DocPage(INSIDE, "hil", "cli/README.md", "the commands, and your own C files of the robot"),
})  # fmt: skip
