"""What is written where the disk is full: whole or not at all, and the message names it; a log ends, not its run."""

from __future__ import annotations

import random
import resource
from functools import cache
from pathlib import Path

from hil.cli import invoke
from hil.instruments.export import FORMATS
from tests.bad_day.figure import forked, short

RUN = ("run", "--no-port", "--pace", "max", "--for", "0.2", "--order", "mission")
#: What writes a file, whose name comes last.
OUTPUTS = (
    (*RUN, "--plot", "out.png"), (*RUN, "--plot", "out.svg"), (*RUN, "--page", "out.html"),
    (*RUN, "--lcov", "out.info"),
    *(("check", "driver.c", *option, f"out.{option[-1][2:]}") for option in (
        ("--sarif",), ("--html",), ("--junit",), ("--lcov",), ("--update-baseline", "--baseline"),
    )),
    *(("export", "run.trace", f"out{suffix}") for suffix in FORMATS),
    ("rta", "--phasings", "0", "--plot", "out.png"), ("calibrate", "--thesis", "--plot", "out.png"),
    ("calibrate", "--thesis", "--write", "out.csv"), ("compare", "run.wire", "run.wire", "--plot", "out.png"),
    ("scenario", "run.scenario.toml", "--junit", "out.xml"), ("audit", "PROTO-angle-unit", "--plot", "out.svg"),
)  # fmt: skip
#: What writes a log.
LOGS = ((*RUN, "--wire", "out.wire"), (*RUN, "--trace", "out.trace"))
DRIVER = "int f(int i) { int a[2] = {1, 2}; int n; return a[i] + n; }\n"
SCENARIO = 'world = "box"\nseconds = 0.1\n[[expect]]\nname = "none"\nquantity = "collisions"\nmost = 0\n'


@cache
def _recorded() -> dict[str, bytes]:
    """A trace and a log of a run, made once."""
    outcome = forked(lambda: invoke([*RUN, "--trace", "run.trace", "--wire", "run.wire"]))
    assert outcome.status == 0, outcome.error
    return {name: Path(name).read_bytes() for name in ("run.trace", "run.wire")}


def case(seed: int) -> str:
    """An output, and a disk that takes some bytes of it."""
    rng = random.Random(f"files {seed}")
    for name, data in _recorded().items():
        Path(name).write_bytes(data)
    Path("driver.c").write_text(DRIVER)
    Path("run.scenario.toml").write_text(SCENARIO)
    commands = (*OUTPUTS, *LOGS)
    command = commands[seed % len(commands)]
    log = command in LOGS
    out = Path(command[-1])
    if there := rng.random() < 0.5:
        out.write_text("mine")
    most = rng.choice((0, 1, 100, 300, 1000))
    before = set(Path().iterdir())

    def limited() -> int:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        return invoke(list(command))

    outcome = forked(limited)
    found = []
    if outcome.status == 2:
        line = outcome.error.strip()
        if not (line.startswith("hil: error: ") and line.count("\n") == 0 and str(out) in line):
            found.append("the message does not name the file")
        if not log and (out.read_text() != "mine" if there else out.exists()):
            found.append("written in part")
    elif outcome.status not in (0, 1) or (most < 100 and log):
        found.append(f"status {outcome.status}")
    elif not log and not out.exists():
        found.append("not written, and nothing said")
    elif not log and out.stat().st_size == most:
        found.append("written in part, and nothing said")
    if left := set(Path().iterdir()) - before - {out}:
        found.append(f"left {', '.join(path.name for path in left)}")
    return f"{short(command)} with {most} bytes: {', '.join(found)}: {outcome.error[-300:]}" if found else ""
