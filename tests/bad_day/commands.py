"""Every command with values that nobody means: one line that says so, exit 2; never a traceback, a hang, all memory.

The commands and what they take are read from the application, so a new option is walked as soon as it is there.
"""

from __future__ import annotations

import enum
import inspect
import os
import random
import signal
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from hil.cli import invoke
from hil.cli.commands import COMMANDS
from tests.bad_day.figure import Outcome, forked, short
from tests.hil.waiting import TIMEOUT_S

#: More memory than this, beyond what the tests themselves have, is a file without an end that somebody reads.
MAX_BYTES = 300 << 20
#: Of the processor, for a line that is refused.
MAX_CPU_S = 2.0

FILES = (
    "folder", "loop", "fifo", "huge", "empty", "binary", "nested.toml", "nested.json", "nested.c", "nested.py",
    "missing/deep", "/dev/zero", "/dev/full", "zero.toml", "zero.c", "/proc/self/mem", "nested.scenario.toml",
)  # fmt: skip
FLOATS = ("inf", "nan", "-inf", "-1", "1e303", "1e400", "9" * 400, "x", "", "0x10")
INTS = ("9" * 400, "-1", "1.5", "x", "", "nan")
TEXTS = ("[" * 5000, "9" * 400 + ":mission", "9" * 301 + ":bumper.pressed=1", "random:" + "9" * 400,
         "adc-bit-stuck:input=A5,at=1e303", "adc-bit-stuck:input=A5,for=1e303", "\x01", "=", "..", "huge",
         "/dev/zero", "zero.toml", "loop", "fifo", "folder")  # fmt: skip

#: What keeps a value that can be meant from running for long, and what must be given besides.
SHORT = {
    "run": ("--no-port", "--pace", "max", "--for", "0.01"),
    "check": ("--for", "0.01", "--calls", "1"),
    "tasks": ("--for", "0.01"),
    "rta": ("--phasings", "0"),
    "audit": ("PROTO-angle-unit",),
    "soak": ("--for", "1"),
    "campaign": ("--runs", "1"),
    "conformance": ("empty",), "drive": ("loop://", "stop"), "record": ("loop://", "-o", "new", "--for", "0.01"),
    "replay": ("empty",), "compare": ("empty", "empty"), "export": ("empty", "new.csv"), "diff": ("folder",),
    "new": ("empty",),
}  # fmt: skip
#: Commands that serve, or compute for minutes, whatever they are given: what they refuse, they refuse at once.
LONG = {"demo", "console", "tune", "blind-spots", "compare-filters", "calibrate", "audit", "campaign", "soak"}
#: Options with which others do.
LONG_OPTIONS = {"--scenario", "--site"}
#: Real time that they get.
LONG_S = 4.0


class Case(NamedTuple):
    """A command line with hostile values; `given` are those, `base` what stands before them."""

    command: str
    base: tuple[str, ...]
    given: tuple[str, ...]
    #: Whether one of them is nothing that any option of its kind takes.
    refused: bool = False

    @property
    def arguments(self) -> tuple[str, ...]:
        return (self.command, *self.base, *self.given)


def _kind(annotation: Any) -> Any:
    """The type of a parameter, without `Annotated`, `None` and `list`."""
    if typing.get_origin(annotation) is typing.Annotated:
        return _kind(typing.get_args(annotation)[0])
    parts = [part for part in typing.get_args(annotation) if part is not type(None)]
    return _kind(parts[0]) if parts else annotation


def parameters() -> Iterator[tuple[str, str, Any, str]]:
    """What the commands take: command, parameter, type, the option's name ("" for an argument)."""
    for command, unopened in COMMANDS.items():
        for name, parameter in inspect.signature(unopened.function, eval_str=True).parameters.items():
            (info,) = parameter.annotation.__metadata__[:1]
            declared = [each for each in info.param_decls or () if each.startswith("-")]
            argument = type(info).__name__ == "ArgumentInfo"
            option = "" if argument else (*declared, f"--{name}")[0].replace("_", "-")
            yield command, name, _kind(parameter.annotation), option


def _cases() -> Iterator[Case]:
    values: dict[Any, tuple[str, ...]] = {Path: FILES, float: FLOATS, int: INTS, str: TEXTS}
    for command, _, kind, option in parameters():
        if kind is bool or (isinstance(kind, type) and issubclass(kind, enum.Enum)):
            continue
        base = SHORT.get(command, ())
        for value in values[kind]:
            # An argument stands in the place of those that must be given.
            kept = base if option else tuple(each for each in base if command not in ("new", "conformance", "diff"))
            yield Case(command, kept, (option, value) if option else (value,), kind is int)


CASES = tuple(_cases())


def lay_out() -> None:
    """The hostile files, in the working directory."""
    Path("folder").mkdir()
    Path("loop").symlink_to("loop")
    os.mkfifo("fifo")
    with open("huge", "wb") as file:
        file.truncate(8 << 30)
    Path("empty").touch()
    Path("binary").write_bytes(bytes(range(256)) * 40)
    Path("nested.toml").write_text("x=" + "[" * 5000)
    Path("nested.scenario.toml").write_text("x=" + "[" * 5000)
    Path("nested.json").write_text("[" * 100_000)
    Path("nested.c").write_text("int x = " + "(" * 5000 + "1" + ")" * 5000 + ";")
    Path("nested.py").write_text("x=" + "(" * 5000)
    Path("zero.toml").symlink_to("/dev/zero")
    Path("zero.c").symlink_to("/dev/zero")


def chosen(seed: int) -> Case:
    """All cases in an order that mixes the commands; from then on two hostile values for one command."""
    if seed < len(CASES):
        return CASES[random.Random("order").sample(range(len(CASES)), len(CASES))[seed]]
    rng = random.Random(f"two {seed}")
    first = rng.choice(CASES)
    second = rng.choice([case for case in CASES if case.command == first.command])
    return first._replace(given=(*first.given, *second.given), refused=first.refused or second.refused)


def case(seed: int) -> str:
    """A command line in a child of its own."""
    lay_out()
    given = chosen(seed)
    long = given.command in LONG or not LONG_OPTIONS.isdisjoint(given.given)
    outcome = forked(lambda: invoke(list(given.arguments)), LONG_S if long else TIMEOUT_S)
    found = wrong(outcome, long=long, refused=given.refused)
    return f"{short(given.arguments)}: {', '.join(found)}: {outcome.error[-300:]}" if found else ""


def wrong(outcome: Outcome, *, long: bool = False, refused: bool = False) -> list[str]:
    """What of it no user should see."""
    lines = outcome.error.splitlines()
    found = [f"ended by signal {-outcome.status}"] if outcome.status < 0 else []
    if refused and outcome.status != 2:
        found.append("taken")
    elif long and outcome.status == -signal.SIGALRM:
        found = []  # the value was taken, and what it does takes long
    elif outcome.status not in (0, 1, 2):
        found.append(f"status {outcome.status}")
    if outcome.status == 2 and (len(lines) != 1 or not lines[0].startswith("hil: error: ")):
        found.append(f"{len(lines)} lines")
    if "Traceback" in outcome.error:
        found.append("a traceback")
    if lines and max(map(len, lines)) > 2000:
        found.append("an endless line")
    if outcome.grown_bytes > MAX_BYTES:
        found.append(f"{outcome.grown_bytes >> 20} MB")
    if outcome.status == 2 and outcome.cpu_s > MAX_CPU_S:
        found.append(f"{outcome.cpu_s:.1f} s of CPU")
    return found
