"""Translate a few lines of firmware source and run them, without a board."""

from __future__ import annotations

from typing import Any

from emulator.c28x.coverage import Coverage
from emulator.c28x.findings import Findings
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.memory import Memory
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.clock import Clock
from emulator.cpu import Cpu
from tests.emulator.c28x.linking import link

HEADER = (
    "from emulator.c28x.language import *\n"
    "from emulator.c28x.rts import memcpy, memset, strcpy, strlen, strncpy, atof, sin, cos, fabs\n"
)


class Workshop:
    """A linked piece of source: functions by name, with its clock, memory and findings."""

    def __init__(
        self, source: str, *, header: str = HEADER, registers: Any = None,
        externs: dict[str, Any] | None = None, keep_locals: bool = False, watch: bool = False, static: bool = False,
        coverage: Coverage | None = None, steps: bool = False, float_division: str = DEFAULT_FLOAT_DIVISION,
        **policies: Any,
    ) -> None:  # fmt: skip
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.memory = Memory()
        self.runtime = Runtime(self.clock, self.cpu, self.findings, self.memory, **policies)
        program = Program()
        program.add("drv", "drv.py", header + source)
        implemented = library(self.runtime) | (externs or {})
        options = CompileOptions(
            residue=self.runtime.fill == "stack", keep_locals=keep_locals, watch=watch, static=static,
            ieee=policies.get("divide", "ieee") == "ieee", coverage=coverage is not None, steps=steps,
            float_division=float_division,
        )  # fmt: skip
        registers = registers or (lambda block, name: None)
        self.linked = link(
            program, self.runtime, options, registers=registers, externs=implemented, coverage=coverage
        )

    def __getattr__(self, name: str) -> Any:
        function, position = self.linked.functions[f"drv.{name}"], self.findings.position

        def call(*arguments: Any) -> Any:
            at, calls = position.at, position.calls
            try:
                return function(*arguments)
            finally:  # an exception leaves the firmware in the middle of a statement
                position.at, position.calls = at, calls

        return call

    def rules(self) -> list[str]:
        """The rules of the findings so far, in order."""
        return [finding.rule for finding in self.findings]

    def value(self, name: str) -> Any:
        """The first scalar of a file-scope object."""
        return self.linked.objects[f"drv.{name}"].data[0]
