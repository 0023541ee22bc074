"""Every command with values that nobody means: one line that says so, exit 2; never a traceback, a hang, all memory.

Each case runs in a child of its own.  A run of the tests takes some of them; `HIL_HOSTILE=all` takes all.
"""

from __future__ import annotations

import enum
import inspect
import os
import resource
import signal
import sys
import tempfile
import typing
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import hil.cli
from hil.cli import app, invoke
from tests.hil.waiting import PATIENCE_S

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="wants a system that forks")

EVERY = 1 if os.environ.get("HIL_HOSTILE") == "all" else 17
#: More memory than this, beyond what the tests themselves have, is a file without an end that somebody reads.
MOST_BYTES = 300 << 20

FILES = (
    "folder", "loop", "fifo", "huge", "empty", "binary", "nested.toml", "nested.json", "nested.c", "nested.py",
    "missing/deep", "/dev/zero", "/dev/full", "zero.toml", "zero.c", "/proc/self/mem",
)  # fmt: skip
FLOATS = ("inf", "nan", "-inf", "-1", "1e400", "9" * 400, "x", "", "0x10")
INTS = ("9" * 400, "-1", "1.5", "x", "", "nan")
TEXTS = ("[" * 5000, "9" * 400 + ":mission", "\x01", "=", "..")

#: What keeps a value that can be meant from running for long.
SHORT = {
    "run": ("--no-port", "--pace", "max", "--for", "0.01"),
    "check": ("--for", "0.01", "--calls", "1"),
    "tasks": ("--for", "0.01"),
    "rta": ("--phasings", "0"),
    "audit": ("PROTO-angle-unit",),
    "calibrate": (), "scenario": (), "diff": (),
}  # fmt: skip
#: Commands that serve, compile or drive for minutes whatever they are given.
LONG = {"demo", "console", "soak", "campaign", "build", "tune", "blind-spots", "compare-filters"}


class Case(NamedTuple):
    """A command line with one hostile value."""

    command: str
    parameter: str
    arguments: tuple[str, ...]


def _kind(annotation: Any) -> Any:
    """The type of a parameter, without `Annotated`, `None` and `list`."""
    if typing.get_origin(annotation) is typing.Annotated:
        return _kind(typing.get_args(annotation)[0])
    parts = [part for part in typing.get_args(annotation) if part is not type(None)]
    return _kind(parts[0]) if parts else annotation


def _cases() -> Iterator[Case]:
    values: dict[Any, tuple[str, ...]] = {Path: FILES, float: FLOATS, int: INTS, str: TEXTS}
    for registered in app.registered_commands:
        function = registered.callback
        assert function is not None
        command = registered.name or function.__name__.replace("_", "-")
        if command in LONG:
            continue
        for name, parameter in inspect.signature(function, eval_str=True).parameters.items():
            kind = _kind(parameter.annotation)
            if kind is bool or (isinstance(kind, type) and issubclass(kind, enum.Enum)):
                continue
            (info,) = parameter.annotation.__metadata__[:1]
            declared = [each for each in info.param_decls or () if each.startswith("--")]
            option = () if type(info).__name__ == "ArgumentInfo" else (*declared, f"--{name.replace('_', '-')}")[:1]
            for value in values[kind]:
                yield Case(command, name, (command, *SHORT.get(command, ()), *option, value))


CASES = list(_cases())


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("loop").symlink_to("loop")
    os.mkfifo("fifo")
    with open("huge", "wb") as file:
        file.truncate(8 << 30)
    Path("empty").touch()
    Path("binary").write_bytes(bytes(range(256)) * 40)
    Path("nested.toml").write_text("x=" + "[" * 5000)
    Path("nested.json").write_text("[" * 100_000)
    Path("nested.c").write_text("int x = " + "(" * 5000 + "1" + ")" * 5000 + ";")
    Path("nested.py").write_text("x=" + "(" * 5000)
    Path("zero.toml").symlink_to("/dev/zero")
    Path("zero.c").symlink_to("/dev/zero")
    return tmp_path


class Outcome(NamedTuple):
    """What a command line came to: `status` is negative for a signal."""

    status: int
    error: str
    grown_bytes: int


def forked(command: Callable[[], int]) -> Outcome:
    """Run something in a child that has no input and a limited time."""
    before = int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if not child:
            status = 99
            try:
                os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
                os.dup2(out.fileno(), 1)
                os.dup2(err.fileno(), 2)
                sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
                signal.signal(signal.SIGALRM, signal.SIG_DFL)
                signal.alarm(int(PATIENCE_S))
                status = command()
                sys.stdout.flush()
                sys.stderr.flush()
            finally:
                os._exit(status)
        _, waited, used = os.wait4(child, 0)
        err.seek(0)
        text = err.read().decode("utf-8", "replace")
    return Outcome(os.waitstatus_to_exitcode(waited), text, used.ru_maxrss * 1024 - before)


def wrong(outcome: Outcome) -> list[str]:
    """What of it no user should see."""
    lines = outcome.error.splitlines()
    found = [f"ended by signal {-outcome.status}"] if outcome.status < 0 else []
    if outcome.status == 2 and (len(lines) != 1 or not lines[0].startswith("hil: error: ")):
        found.append(f"{len(lines)} lines")
    if "Traceback" in outcome.error or outcome.status not in (0, 1, 2):
        found.append(f"status {outcome.status}")
    if lines and max(map(len, lines)) > 2000:
        found.append("an endless line")
    if outcome.grown_bytes > MOST_BYTES:
        found.append(f"{outcome.grown_bytes >> 20} MB")
    return found


def test_the_walk_meets_all_that_the_commands_take() -> None:
    assert len({case.command for case in CASES}) >= 15
    assert len({(case.command, case.parameter) for case in CASES}) > 100


@pytest.mark.parametrize("part", range(8))
def test_a_value_that_nobody_means_is_one_line(part: int, folder: Path) -> None:
    failures = []
    for case in CASES[part * EVERY :: 8 * EVERY] if EVERY > 1 else CASES[part::8]:
        outcome = forked(lambda case=case: invoke(list(case.arguments)))  # type: ignore[misc]
        if found := wrong(outcome):
            shown = [argument if len(argument) < 40 else f"{argument[:20]}..." for argument in case.arguments]
            failures.append((" ".join(shown), found, outcome.error[-300:]))
    assert not failures, "\n".join(map(str, failures))


@pytest.mark.parametrize(
    ("does", "found"),
    [
        (lambda: 2, "0 lines"),
        (lambda: int("x"), "status 99"),
        (lambda: os.kill(os.getpid(), signal.SIGKILL), "signal 9"),
        (lambda: len(bytearray(400 << 20)) * 0, "MB"),
        (lambda: hil.cli.complain("x y " * 2000) or 2, "endless"),
    ],
)
def test_the_walk_sees_what_is_wrong(does: Callable[[], int], found: str) -> None:
    assert any(found in each for each in wrong(forked(does)))
