"""Pages for users, as they stand in the packages: `hil docs` lists them and shows one.

A page is Markdown, and its blocks are run by a test.  A new one is a file here (or a README) and a line in `PAGES`;
`package-data` in pyproject.toml takes it into the wheel.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True)
class Page:
    """A page: the package in which it lies, and its file there."""

    package: str
    file: str
    #: What one learns there.
    about: str

    def text(self) -> str:
        """Its Markdown."""
        return files(self.package).joinpath(self.file).read_text(encoding="utf-8")


#: The pages, by the name that `hil docs` takes.
PAGES: Final[Mapping[str, Page]] = MappingProxyType({
    "tutorial": Page("hil", "docs/tutorial.md", "ten minutes: a project, a board, a red test of a driver of one's own"),
    "language": Page("hil", "docs/language.md", "how firmware is written: C, and C in Python's clothes"),
    "debugging": Page("hil", "docs/debugging.md", "breakpoints in drivers and tasks, in C and in Python, with VS Code"),
    "testing": Page("hil", "testing/README.md", "tests of your firmware with pytest: fixtures, findings, time, boards"),
    "check": Page("hil", "drivers/README.md", "hil check: what it calls, with which arguments, and what counts"),
    "reports": Page("hil", "reports/README.md", "findings in SARIF, JUnit and HTML; severities and baselines"),
    "options": Page("hil", "robot/options/README.md", "more parts for the robot: two sonars, accelerometer, LiDAR"),
    "worlds": Page("hil", "world/README.md", "the world of the robot, and how to make another"),
    "parts": Page("emulator", "devices/README.md", "the parts around the chip, and how to add one"),
    "instruments": Page("hil", "instruments/README.md", "the trace file of a run, for GTKWave, Perfetto, NumPy"),
    "page": Page("hil", "page/README.md", "a run as one HTML file that plays it again; pages for a site"),
    "scenarios": Page("hil", "scenarios/README.md", "situations as files: world, orders, faults, what must come true"),
    "faults": Page("hil", "faults/README.md", "what breaks on purpose, and the proof that it did"),
    "feeds": Page("hil", "feeds/README.md", "what sensors see: numbers, CSV, arrays, generators, recorded runs"),
    "rta": Page("hil", "rta/README.md", "response times, computed and seen"),
    "procedures": Page("hil", "procedures/README.md", "calibration and other procedures of the thesis, run"),
    "rules": Page("emulator", "rules/README.md", "what a finding can name, and how to add a detector"),
})  # fmt: skip
