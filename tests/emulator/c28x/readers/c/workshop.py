"""Translate a few lines of C and run them, without a board."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from emulator.c28x.coverage import Coverage
from emulator.c28x.findings import Findings
from emulator.c28x.memory import Memory
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.c28x.symbols import SourceError
from emulator.clock import Clock
from emulator.cpu import Cpu
from tests.emulator.c28x.linking import link

NAME = "drv.c"


class CWorkshop:
    """Linked C files: their functions by name, with clock, memory and findings.

    `files` is the text of `drv.c`, or texts by file name; they are linked in that order.
    """

    def __init__(
        self, files: str | Mapping[str, str], *, watch: bool = False, static: bool = False,
        registers: Callable[[str, str], Any] | None = None, externs: Mapping[str, Callable[..., Any]] | None = None,
        abi: str = "", coverage: Coverage | None = None, **policies: Any,
    ) -> None:  # fmt: skip
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.memory = Memory()
        self.runtime = Runtime(self.clock, self.cpu, self.findings, self.memory, **policies)
        implemented = library(self.runtime)
        files = {NAME: files} if isinstance(files, str) else files
        options = CompileOptions(
            residue=self.runtime.fill == "stack", watch=watch, static=static,
            ieee=policies.get("divide", "ieee") == "ieee", coverage=coverage is not None,
        )  # fmt: skip
        self.linked = link(
            read(files, **({"abi": abi} if abi else {})), self.runtime, options,
            registers=registers or (lambda block, name: None), externs=implemented | dict(externs or {}),
            coverage=coverage,
        )  # fmt: skip

    def call(self, function: str, *arguments: Any) -> Any:
        """Call a function that is visible outside of its file."""
        (found,) = (f for path, f in self.linked.functions.items() if path.rsplit(".", 1)[-1] == function)
        return found(*arguments)

    def rules(self) -> list[str]:
        """The rules of the findings so far, in order."""
        return [finding.rule for finding in self.findings]


def read(files: Mapping[str, str], **target: Any) -> Program:
    """The program that the files make, as `target` says (`abi`).

    Several files stand in a folder of their own, where they find their headers.
    """
    program = Program(**target)
    with tempfile.TemporaryDirectory() as folder:
        for file, text in files.items():
            (Path(folder) / file).write_text(text, encoding="utf-8")
        for file, text in files.items():
            if file.endswith(".c"):
                program.add(file.removesuffix(".c"), file if len(files) == 1 else str(Path(folder) / file), text)
    return program


def run_c(text: str, function: str, *arguments: Any) -> Any:
    """What a function of a C text returns."""
    return CWorkshop(text).call(function, *arguments)


def findings_of(text: str, function: str = "", *arguments: Any) -> list[tuple[str, int]]:
    """Rule and line of each finding: the static ones, and those of a call if a function is named."""
    shop = CWorkshop(text, static=True)
    if function:
        shop.call(function, *arguments)
    return [(finding.rule, finding.place.line if finding.place else 0) for finding in shop.findings]


def refused(files: str | Mapping[str, str], abi: str = "") -> tuple[int, int, str]:
    """Line, column and message of the error that refuses a text.  Raises AssertionError for one that is taken."""
    with pytest.raises(SourceError) as caught:
        CWorkshop(files, abi=abi)
    error = caught.value
    column: int = getattr(error, "column", 0)
    place = f"{error.file}:{error.line}:{column}: "
    assert str(error).startswith(place), "the error does not begin with its place"
    return error.line, column, str(error).removeprefix(place)
