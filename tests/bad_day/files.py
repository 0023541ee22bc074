"""What is written where the disk is full, no folder is there, or the process is killed: whole, or as it was before.

A message names the file.  A log ends, not its run.  Which options write is read from the application: a new one that is
neither here nor among those that read is told by a test.
"""

from __future__ import annotations

import random
import resource
import signal
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Final, NamedTuple

from hil.cli import invoke
from hil.client.plot import MOVING, SUFFIXES
from hil.instruments.export import FORMATS
from tests.bad_day.commands import parameters
from tests.bad_day.figure import forked, short

#: Parameters of the type of a path that are read, whatever the command.
READ: Final = frozenset({"app", "file", "files", "first", "firmware", "include", "log", "project", "scenario", "second",
                         "sheet", "trace argument"})  # fmt: skip
#: What is not tried here, and why.
LEFT_OUT: Final = MappingProxyType({
    ("build", "--wheel"): "takes a compiled build; a file that is moved into its place when it is whole",
    ("console", "--wire"): "takes a console program; the log is that of `hil run --wire`",
    ("console", "--folder"): "takes a console program, whose files they are",
    ("docs", "--site"): "takes minutes; a folder that is moved into its place when it is whole",
})  # fmt: skip
RUN = ("run", "--no-port", "--pace", "max", "--for", "0.2", "--order", "mission")
_PICTURES: Final = tuple(f"out{suffix}" for suffix in SUFFIXES)


class Output(NamedTuple):
    """How to have something written: what stands before its name, and the names that it may have."""

    before: tuple[str, ...]
    names: tuple[str, ...]
    #: It grows while something runs.
    log: bool = False


def _check(option: str, name: str) -> Output:
    return Output(("check", "driver.c", option), (name,))


#: By command and option ("" and the parameter for an argument).
OUTPUTS: Final = MappingProxyType({
    ("run", "--plot"): Output((*RUN, "--plot"), (*_PICTURES, f"out{MOVING}")),
    ("run", "--page"): Output((*RUN, "--page"), ("out.html",)),
    ("run", "--lcov"): Output((*RUN, "--lcov"), ("out.info",)),
    ("run", "--wire"): Output((*RUN, "--wire"), ("out.wire",), log=True),
    ("run", "--trace"): Output((*RUN, "--trace"), ("out.trace",), log=True),
    ("drive", "--png"): Output(("drive", "loop://", "stop", "--png"), _PICTURES),
    ("rta", "--plot"): Output(("rta", "--phasings", "0", "--plot"), _PICTURES),
    ("check", "--baseline"): Output(("check", "driver.c", "--update-baseline", "--baseline"), ("out.json",)),
    ("check", "--sarif"): _check("--sarif", "out.sarif"), ("check", "--html"): _check("--html", "out.html"),
    ("check", "--junit"): _check("--junit", "out.xml"), ("check", "--lcov"): _check("--lcov", "out.info"),
    ("new", "folder"): Output(("new",), ("out",)),
    ("export", "target"): Output(("export", "run.trace"), tuple(f"out{suffix}" for suffix in FORMATS)),
    ("record", "-o"): Output(("record", "loop://", "--for", "0.1", "-o"), ("out.wire",), log=True),
    ("replay", "-o"): Output(("replay", "run.wire", "-o"), ("out.wire",), log=True),
    ("compare", "--plot"): Output(("compare", "run.wire", "run.wire", "--plot"), _PICTURES),
    ("scenario", "--junit"): Output(("scenario", "run.scenario.toml", "--junit"), ("out.xml",)),
    # One that fails.
    ("campaign", "--keep"): Output(("campaign", "-j", "1", "--faithful", "--runs", "1", "--keep"), ("out",)),
    ("calibrate", "--write"): Output(("calibrate", "--thesis", "--write"), ("out.csv",)),
    ("calibrate", "--plot"): Output(("calibrate", "--thesis", "--plot"), _PICTURES),
    ("compare-filters", "--plot"): Output(("compare-filters", "--readings", "1", "--plot"), _PICTURES),
    ("blind-spots", "--plot"): Output(("blind-spots", "--plot"), _PICTURES),
    ("tune", "--plot"): Output(("tune", "1,10", "--for", "0.1", "--plot"), _PICTURES),
    ("audit", "--plot"): Output(("audit", "PROTO-angle-unit", "--plot"), _PICTURES),
})  # fmt: skip
DRIVER = "int f(int i) { int a[2] = {1, 2}; int n; return a[i] + n; }\n"
SCENARIO = 'world = "box"\nseconds = 0.1\n[[expect]]\nname = "none"\nquantity = "collisions"\nmost = 0\n'


def writing() -> Iterator[tuple[str, str]]:
    """What the commands have that takes a path and does not read it: command and option, or argument."""
    for command, name, kind, option in parameters():
        if kind is Path and name not in READ and (option or f"{name} argument" not in READ):
            yield command, option or name


@cache
def _recorded() -> dict[str, bytes]:
    """A trace and a log of a run, made once."""
    outcome = forked(lambda: invoke([*RUN, "--trace", "run.trace", "--wire", "run.wire"]))
    assert outcome.status == 0, outcome.error
    return {name: Path(name).read_bytes() for name in ("run.trace", "run.wire")}


def case(seed: int) -> str:
    """An output, and what happens to it."""
    rng = random.Random(f"files {seed}")
    for name, data in _recorded().items():
        Path(name).write_bytes(data)
    Path("driver.c").write_text(DRIVER)
    Path("run.scenario.toml").write_text(SCENARIO)
    output = list(OUTPUTS.values())[seed % len(OUTPUTS)]
    name = rng.choice(output.names)
    if rng.random() < 0.2:
        return _no_folder(output, name)
    most = rng.choice((0, 1, 100, 300, 1000))
    there = rng.random() < 0.5 and Path(name).suffix != ""
    if there:
        Path(name).write_text("mine")
    return _killed(output, name, most) if not output.log and rng.random() < 0.3 else _full(output, name, most)


def _content(path: Path) -> dict[Path, bytes]:
    """Of a file, or all files of a folder; {} if there is none."""
    return {file: file.read_bytes() for file in (path, *path.rglob("*")) if file.is_file()}


def _no_folder(output: Output, name: str) -> str:
    """It says so, names the file, and makes nothing.  A project's folders are made, as `mkdir -p` does."""
    command, before = (*output.before, f"missing/{name}"), set(Path().iterdir())
    outcome = forked(lambda: invoke(list(command)))
    if output.before == ("new",):
        return "" if outcome.status == 0 else f"{short(command)}: status {outcome.status}: {outcome.error[-300:]}"
    found = [] if outcome.status == 2 else [f"status {outcome.status}"]
    found += _unnamed(outcome.error, f"missing/{name}")
    found += [f"left {path.name}" for path in set(Path().iterdir()) - before]
    return f"{short(command)}: {', '.join(found)}: {outcome.error[-300:]}" if found else ""


def _limit(most: int) -> None:
    """Files of this process have at most `most` bytes: those that it writes, not compiled ones that others read."""
    sys.dont_write_bytecode = True
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))


def _killed(output: Output, name: str, most: int) -> str:
    """The system ends it at the byte: what was there is there."""
    command, before = (*output.before, name), _content(Path(name))

    def limited() -> int:
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python ignores it
        _limit(most)
        return invoke(list(command))

    outcome = forked(limited)
    if outcome.status != -signal.SIGXFSZ or _content(Path(name)) == before:
        return ""
    return f"{short(command)} killed at byte {most}: {', '.join(map(str, _content(Path(name))))} is not as it was"


def _full(output: Output, name: str, most: int) -> str:
    """A disk that takes some bytes."""
    command, out, there = (*output.before, name), Path(name), _content(Path(name))
    before = set(Path().iterdir())

    def limited() -> int:
        _limit(most)
        return invoke(list(command))

    outcome = forked(limited)
    found = []
    if outcome.status == 2:
        found += _unnamed(outcome.error, name)
        if not output.log and _content(out) != there:
            found.append("written in part")
    elif outcome.status not in (0, 1) or (most < 100 and output.log):
        found.append(f"status {outcome.status}")
    elif not output.log and not out.exists():
        found.append("not written, and nothing said")
    elif not output.log and any(len(content) == most for content in _content(out).values()):
        found.append("written in part, and nothing said")
    if left := set(Path().iterdir()) - before - {out}:
        found.append(f"left {', '.join(path.name for path in left)}")
    return f"{short(command)} with {most} bytes: {', '.join(found)}: {outcome.error[-300:]}" if found else ""


def _unnamed(error: str, name: str) -> list[str]:
    """What is wrong with the message."""
    lines = error.splitlines()
    good = lines and lines[-1].startswith("hil: error: ") and name in lines[-1]
    return [] if good and sum(line.startswith("hil: error: ") for line in lines) == 1 else ["it does not name the file"]
