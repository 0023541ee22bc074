"""A program compiled and linked without a system: what tests of the language do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from emulator.c28x.compile import compile_program
from emulator.c28x.coverage import Coverage
from emulator.c28x.link import Linked
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.runtime import Runtime


def link(
    program: Program, runtime: Runtime, options: CompileOptions, *, registers: Callable[[str, str], Any],
    externs: Mapping[str, Callable[..., Any]], replaced: Mapping[str, Callable[..., Any]] | None = None,
    coverage: Coverage | None = None,
) -> Linked:  # fmt: skip
    """Compile and link a program: `registers` gives what C calls `block.name`, `externs` implement the headers.

    `replaced` stands for firmware functions or externs, by name; `coverage` is where the image counts.  Raises
    SourceError and LinkError.
    """
    compiled = compile_program(program, options, lambda block, name: registers(block, name).looked_at)
    return Linked(
        compiled, runtime, registers=registers, externs=externs, replaced=replaced or {}, coverage=coverage
    )
