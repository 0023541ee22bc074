"""The usual tools of a PC: how each is run on one C file, and whether it points at the marked line."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from hil.audit.compare.specimen import Specimen

#: A compiled specimen that has not ended after so much CPU time, in valgrind or not, waits for something that a PC does
#: not have.
CPU_LIMIT_S: Final = 5
#: What a command gets, however busy the machine is.
TIME_LIMIT_S: Final = 60.0


@dataclass(frozen=True, slots=True)
class Tool:
    """A tool.  `{source}` and `{program}` stand in the commands; all output of all of them counts.

    Where a tool also says of lines what it does there, `alarm` is what stands before the place of a diagnostic.
    """

    name: str
    #: What must be installed, and the package that brings it.
    needs: tuple[str, ...]
    package: str
    commands: tuple[tuple[str, ...], ...]
    environment: dict[str, str] = field(default_factory=dict)
    alarm: str = ""

    @property
    def missing(self) -> bool:
        """Whether something that it needs is not installed."""
        return any(shutil.which(name) is None for name in self.needs)

    def sees(self, specimen: Specimen, folder: Path) -> bool:
        """Whether any diagnostic names the specimen's marked line.  `folder` takes the compiled program."""
        source, program = specimen.c_file, folder / f"{specimen.name}-{self.name.replace(' ', '')}"
        pattern = re.compile(rf"{re.escape(self.alarm)}[^\s:]*{re.escape(source.name)}:{specimen.line('.c')}\b")
        for command in self.commands:
            words = [word.format(source=source, program=program) for word in command]
            runs_it = words[-1] == str(program) and "-o" not in words
            if runs_it:
                words = ["sh", "-c", f'ulimit -t {CPU_LIMIT_S}; exec "$@"', "sh", *words]
            if pattern.search(_output(words, folder, self.environment)):
                return True
        return False


def versions(tools: Iterable[Tool]) -> dict[str, str]:
    """The version of each program that these tools need, as it says itself."""
    programs = dict.fromkeys(program for tool in tools for program in tool.needs)
    found = {program: re.search(r"\d+(\.\d+)+", _output([program, "--version"], Path(), {})) for program in programs}
    return {program: match[0] if match else "?" for program, match in found.items()}


def _output(words: Sequence[str], folder: Path, environment: dict[str, str]) -> str:
    """What a command prints, on both streams, in English."""
    try:
        done = subprocess.run(
            words, cwd=folder, capture_output=True, text=True, errors="replace", timeout=TIME_LIMIT_S,
            env={**os.environ, "LC_ALL": "C", **environment}, stdin=subprocess.DEVNULL,
        )  # fmt: skip
    except subprocess.TimeoutExpired as late:
        parts = (late.stdout, late.stderr)
        return "".join(part.decode(errors="replace") for part in parts if isinstance(part, bytes))
    return done.stdout + done.stderr


def _sanitizer(compiler: str, *flags: str) -> tuple[tuple[str, ...], ...]:
    return (
        (compiler, "-g", "-O1", "-fno-omit-frame-pointer", *flags, "{source}", "-o", "{program}"),
        ("{program}",),
    )


TOOLS: Final = (
    Tool(
        "gcc -Wall -Wextra", ("gcc",), "gcc",
        (("gcc", "-O2", "-Wall", "-Wextra", "-c", "{source}", "-o", "{program}.o"),),
    ),
    Tool("gcc -fanalyzer", ("gcc",), "gcc", (("gcc", "-O1", "-fanalyzer", "-c", "{source}", "-o", "{program}.o"),)),
    Tool(
        "clang -Weverything", ("clang",), "clang",
        (("clang", "-O2", "-Weverything", "-c", "{source}", "-o", "{program}.o"),),
    ),
    Tool(
        "ASan", ("gcc",), "gcc", _sanitizer("gcc", "-fsanitize=address"),
        {"ASAN_OPTIONS": "detect_leaks=0"},
    ),
    Tool("UBSan", ("gcc",), "gcc", _sanitizer("gcc", "-fsanitize=undefined,float-cast-overflow,float-divide-by-zero")),
    Tool("MSan", ("clang",), "clang", _sanitizer("clang", "-fsanitize=memory")),
    Tool(
        "valgrind", ("gcc", "valgrind"), "valgrind",
        (("gcc", "-g", "-O0", "{source}", "-o", "{program}"), ("valgrind", "-q", "{program}")),
    ),
    Tool(
        "cppcheck", ("cppcheck",), "cppcheck",
        (("cppcheck", "--enable=warning,style,performance,portability", "--inconclusive", "-q",
          "--template={{file}}:{{line}}: {{id}}", "{source}"),),
    ),
    # Abstract interpretation of every run from main, with an int of 16 bits; its char has 8.
    Tool(
        "Frama-C Eva", ("frama-c", "gcc"), "frama-c-base",
        (("frama-c", "-machdep", "gcc_x86_16", "-eva", "-eva-precision", "2", "-warn-signed-overflow",
          "-warn-unsigned-overflow", "-warn-signed-downcast", "-warn-unsigned-downcast", "-warn-special-float",
          "non-finite", "-warn-invalid-pointer", "{source}"),),
        alarm="[eva:alarm] ",
    ),
)  # fmt: skip
