"""A corpus of drivers with seeded defects: correct drivers, and small damages with the lines of their findings.

A driver is a file in `drivers/`; the TOML file beside it contains its damages.  Most of the corpus was written before
the detectors that it measures, by people who did not write them (README.md names the exceptions).
"""

from __future__ import annotations

import re
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.rules import Severity
from hil.board import load
from hil.drivers.check import DriverFiles, check_files, source_findings
from hil.image import Build
from hil.reports.policy import Policy

DRIVERS: Final = Path(__file__).parent / "drivers"
#: Classes of defects, as the documentation lists them.
CLASSES: Final = (
    "race", "printf", "conversion", "object", "configuration", "kernel", "time-and-link", "unit",
)  # fmt: skip


@dataclass(frozen=True)
class Driver:
    """A correct driver: `seconds` of virtual time show what it does."""

    file: Path
    description: str
    seconds: float
    damages: tuple[Damage, ...]
    #: The value of `--board` for it; empty: none.  A file is one beside the driver.
    board: str = ""

    @property
    def name(self) -> str:
        """The name of its file, without the ending."""
        return self.file.stem

    @property
    def in_c(self) -> bool:
        """Whether it is written in C."""
        return self.file.suffix == ".c"

    @cached_property
    def text(self) -> str:
        """The text of its file."""
        return self.file.read_text(encoding="utf-8")


@dataclass(frozen=True)
class Damage:
    """A defect: the replacements in the driver, and the statements at which a finding counts."""

    id: str
    kind: str
    what: str
    replacements: tuple[tuple[str, str], ...]
    accepted: tuple[str, ...]

    def of(self, text: str) -> str:
        """The damaged driver.  Raises ValueError for a text that does not occur exactly once."""
        for old, new in self.replacements:
            if text.count(old) != 1:
                raise ValueError(f"{self.id}: {old!r} stands {text.count(old)} times in the driver")
            text = text.replace(old, new)
        return text

    def lines(self, damaged: str) -> frozenset[int]:
        """The accepted lines of the damaged text.  Raises ValueError for a statement that is not in it."""
        found: set[int] = set()
        for statement in self.accepted:
            here = {n for n, line in enumerate(damaged.splitlines(), 1) if statement in line}
            if not here:
                raise ValueError(f"{self.id}: {statement!r} does not stand in the damaged driver")
            found |= here
        return frozenset(found)


def drivers() -> list[Driver]:
    """All drivers, by name.  Raises ValueError or KeyError for a TOML file that does not follow the README."""
    return [_driver(file) for file in sorted(DRIVERS.glob("*.toml"))]


def _driver(file: Path) -> Driver:
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    (source,) = (path for path in (file.with_suffix(".c"), file.with_suffix(".py")) if path.is_file())
    damages = tuple(_damage(entry) for entry in table.pop("defect", ()))
    return Driver(source, table.pop("description"), float(table.pop("seconds")), damages, table.pop("board", ""))


def _damage(entry: dict[str, Any]) -> Damage:
    pairs = entry["with"] if isinstance(entry["with"], list) else [entry]
    if entry["class"] not in CLASSES:
        raise ValueError(f"{entry['id']}: class {entry['class']!r}: there are {', '.join(CLASSES)}")
    return Damage(
        entry["id"], entry["class"], entry["what"], tuple((pair["replace"], pair["with"]) for pair in pairs),
        tuple(entry["accepted"]),
    )  # fmt: skip


@dataclass(frozen=True)
class Result:
    """The findings of `hil check` for a text."""

    #: (line, rule, message) of errors and warnings; line 0: no place in the driver.
    told: tuple[tuple[int, str, str], ...]
    #: The same for notes.
    noted: tuple[tuple[int, str, str], ...]

    def at(self, lines: frozenset[int]) -> str:
        """How a defect with these accepted lines was found: "found", "noted", "elsewhere" or "missed"."""
        if any(line in lines for line, _, _ in self.told):
            return "found"
        if any(line in lines for line, _, _ in self.noted):
            return "noted"
        return "elsewhere" if self.told else "missed"


def check(driver: Driver, text: str, *, run: bool = True) -> Result:
    """Check a text as the driver's file; without `run`, only its source.  Raises what `check_files` raises."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / driver.file.name
        file.write_text(text, encoding="utf-8")
        beside = driver.file.parent / driver.board
        board = load(str(beside) if driver.board.endswith(".py") else driver.board or "robot")
        if run:
            wanted = DriverFiles(
                [file], seconds=driver.seconds, board=board, board_named=bool(driver.board), silence=True
            )  # fmt: skip
            findings = check_files(wanted).findings
        else:
            findings = source_findings(Build([str(file)], board=board))
    policy = Policy()
    rows: dict[bool, list[tuple[int, str, str]]] = {True: [], False: []}
    for finding in findings:
        severity = policy.severity_of(finding)
        if severity is not None:
            rows[severity is not Severity.NOTE].append((_line(finding, file), finding.rule, finding.message))
    return Result(tuple(rows[True]), tuple(rows[False]))


def _line(finding: Finding, file: Path) -> int:
    return finding.place.line if finding.place is not None and Path(finding.place.file).name == file.name else 0


def measured(wanted: Iterator[tuple[Driver, Damage]]) -> Iterator[tuple[Driver, Damage, frozenset[int], Result]]:
    """Each damage, its accepted lines and what `hil check` says of it."""
    for driver, damage in wanted:
        text = damage.of(driver.text)
        yield driver, damage, damage.lines(text), check(driver, text)


def chosen(*names: str) -> Iterator[tuple[Driver, Damage]]:
    """Damages of a class, of a driver, or with an id; all without names.  Raises ValueError for a name of nothing."""
    everything = [(driver, damage) for driver in drivers() for damage in driver.damages]
    known = {name for driver, damage in everything for name in (driver.name, damage.id, damage.kind)}
    for name in names:
        if name not in known:
            near = ", ".join(sorted(k for k in known if re.match(re.escape(name[:4]), k))) or ", ".join(CLASSES)
            raise ValueError(f"no class, driver or defect {name!r}: there are {near}")
    for driver, damage in everything:
        if not names or {driver.name, damage.id, damage.kind} & set(names):
            yield driver, damage
