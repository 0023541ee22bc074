"""Mutants: firmware that is broken as people break it, linked to the robot's board and run with its tasks.

A seed makes a case: one of the six drivers of the port, or the program in C beside this file, with one to three
mutations: another operator or constant, a statement left out, arguments swapped, another type, a name in the place of
another.  Allowed are an image that runs on and one that stops as `FirmwareStopped` and `Ran` say, with any findings,
and a ValueError that begins with file and line.  Everything else is a failure: another exception, one that the report
tells as an error of this tool, a summary or a report that is not written, a case that does not come back.

    python -m tests.hil.mutants.fuzz --cases 500 --language c
    python -m tests.hil.mutants.fuzz --seed 17 --language py --show
"""

from __future__ import annotations

import argparse
import json
import random
import re
import signal
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType
from typing import Final
from unittest.mock import patch

from rich.console import Console

from emulator.clock import SYSCLK_HZ
from firmware_model import c_files
from hil.bench import Bench
from hil.cli.run import summarize
from hil.cli.show import print_json
from hil.drivers.check import DriverFiles, check_files
from hil.machine import INTERNAL_ERROR, FirmwareStopped, Setup
from hil.pacing import Pacer
from hil.reports.html import html
from hil.reports.json_report import as_dict
from hil.reports.junit import junit
from hil.reports.model import Report, Run
from hil.reports.run import drive_of, run_of
from hil.reports.sarif import sarif
from hil.reports.terminal import print_report
from hil.scenarios.scenario import Scenario
from hil.session import Session

HERE: Final = Path(__file__).parent
REPOSITORY: Final = HERE.parents[2]
LANGUAGES: Final = ("py", "c")
#: The drivers of the port.
DRIVERS: Final = ("us", "gyro", "odometry", "protocol", "servidores", "main_robot")
PLACE: Final = re.compile(r"[^:\n]+:[1-9]\d*(:[1-9]\d*)?: \S")
#: Virtual time of a robot's run: its gyro's set-up takes 2 s.  Cycles that may be executed of it.
RUN_S: Final = 2.4
EXECUTED: Final = 12_000_000
#: Processor seconds that no case takes; a hang takes more.
TIMEOUT_S: Final = 120.0

_CONSTANTS: Final = ("0", "1", "-1", "2", "3", "7", "100", "255", "32767", "65535", "100000")
_SWAPPED: Final = {
    "py": (("+", "-", "*", "/", "%"), ("<", "<=", ">", ">=", "==", "!="), ("and", "or"), ("<<", ">>"), ("&", "|", "^"),
           ("=", "+=", "-=", "*=")),
    "c": (("+", "-", "*", "/", "%"), ("<", "<=", ">", ">=", "==", "!="), ("&&", "||"), ("<<", ">>"), ("&", "|", "^"),
          ("=", "+=", "-=", "*=")),
}  # fmt: skip
_TYPES: Final = {
    "py": ("uint16", "int16", "uint32", "int32", "float32", "char", "uchar"),
    "c": ("int", "unsigned int", "unsigned long", "long", "float", "char", "unsigned char"),
}
_TOKENS: Final = {
    "py": re.compile(r"[A-Za-z_]\w*|0x[0-9a-fA-F]+|\d+\.?\d*|->|<<|>>|[<>=!+\-*/%&|]=|\"[^\"]*\"|\S"),
    "c": re.compile(r"[A-Za-z_]\w*|0x[0-9a-fA-F]+|\d+\.?\d*|->|&&|\|\||<<|>>|\+\+|--|[<>=!+\-*/%&|]=|\"[^\"]*\"|\S"),
}


class TooLong(BaseException):
    """A case does not come back; no handler of ours may swallow it."""


@cache
def corpus(language: str) -> dict[str, str]:
    """The texts that are mutated, by name."""
    if language == "c":
        return {"program": (HERE / "program.c").read_text(encoding="utf-8")}
    folder = REPOSITORY / "firmware_model"
    return {name: (folder / f"{name}.py").read_text(encoding="utf-8") for name in DRIVERS}


def mutant(seed: int, language: str) -> tuple[str, str]:
    """The case of a seed: the name of the driver and its text."""
    rng = random.Random(f"{seed} of {language}")
    name = rng.choice(list(corpus(language)))
    text = corpus(language)[name]
    for _ in range(rng.choice((1, 1, 2, 3))):
        kind = rng.choice((_operator, _constant, _left_out, _left_out, _swapped_arguments, _type, _name))
        with suppress(IndexError):  # nothing of this kind is in the text
            text = kind(rng, text, language)
    return name, text


def _code(text: str, language: str) -> list[re.Match[str]]:
    """The tokens of a text behind its head: no comment, no import or include, nothing that only documents."""
    begins = text.find("static" if language == "c" else "\n# ")
    found = []
    at = max(begins, 0)
    for line in text[at:].splitlines(keepends=True):
        bare = line.strip()
        if not bare.startswith(("#", "/*", "import", "from", '"""')):
            found += list(_TOKENS[language].finditer(text, at, at + len(line)))
        at += len(line)
    return found


def _replaced(text: str, match: re.Match[str], by: str) -> str:
    return text[: match.start()] + by + text[match.end() :]


def _operator(rng: random.Random, text: str, language: str) -> str:
    groups = _SWAPPED[language]
    found = [(m, g) for m in _code(text, language) for g in groups if m[0] in g]
    match, group = rng.choice(found)
    return _replaced(text, match, rng.choice([o for o in group if o != match[0]]))


def _constant(rng: random.Random, text: str, language: str) -> str:
    match = rng.choice([m for m in _code(text, language) if m[0][0].isdigit()])
    return _replaced(text, match, rng.choice(_CONSTANTS))


def _type(rng: random.Random, text: str, language: str) -> str:
    known = [word for name in _TYPES[language] for word in name.split()]
    match = rng.choice([m for m in _code(text, language) if m[0] in known])
    return _replaced(text, match, rng.choice(_TYPES[language]))


def _name(rng: random.Random, text: str, language: str) -> str:
    """A name in the place of another of the same text, or NULL."""
    words = [m for m in _code(text, language) if m[0][0].isalpha() and m[0] not in ("def", "class", "return", "if")]
    match = rng.choice(words)
    return _replaced(text, match, rng.choice([rng.choice(words)[0], "NULL"]))


def _left_out(rng: random.Random, text: str, language: str) -> str:
    """A statement of one line left out: a handle is never created, a flag never cleared, a gate never left."""
    lines = text.splitlines(keepends=True)
    ends = ";" if language == "c" else (")", *"abcdefghijklmnopqrstuvwxyz0123456789]")
    begins = text[: max(text.find("\n# "), text.find("static"))].count("\n")
    whole = [i for i, line in enumerate(lines) if line[0] == " " and line.rstrip().endswith(ends)]
    at = rng.choice([i for i in whole if i > begins])
    indent = lines[at][: len(lines[at]) - len(lines[at].lstrip())]
    lines[at] = indent + (";\n" if language == "c" else "pass\n")
    return "".join(lines)


def _swapped_arguments(rng: random.Random, text: str, language: str) -> str:
    """Two arguments of a call change places."""
    calls = re.finditer(r"\w\(([^(),\n]+), ([^(),\n]+)", text)
    match = rng.choice([m for m in calls if m.start() > text.find("\n# ")])
    return f"{text[: match.start(1)]}{match[2]}, {match[1]}{text[match.end(2) :]}"


@contextmanager
def _time_limit() -> Iterator[None]:
    """TooLong for what takes `TIMEOUT_S` of the processor."""

    def over(_number: int, _frame: FrameType | None) -> None:
        raise TooLong

    before = signal.signal(signal.SIGVTALRM, over)
    signal.setitimer(signal.ITIMER_VIRTUAL, TIMEOUT_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def _robot(name: str, file: Path) -> list[str]:
    """Run the robot with a mutant in the place of one driver; summary and report as `hil run` and `hil check` write.

    Returns why it ended early.
    """
    setup = Setup(watch=True, static=True)
    own = c_files.UserFiles({f"firmware_model.{name}": str(file)})
    with patch.object(c_files, "own", lambda firmware: own):
        bench = Bench(setup)
    session = Session(bench, None, Pacer(None))
    stopped = ""
    try:
        bench.power_up()
        clock, slice_cycles = bench.clock, SYSCLK_HZ // 100
        bench.feed(b"#MISN\r")
        while clock.now < RUN_S * SYSCLK_HZ and clock.now - clock.waited < EXECUTED:
            bench.run_until(clock.now + slice_cycles)
    except FirmwareStopped as reason:
        stopped = str(reason)
    print_json(summarize(session, setup))
    scenario = Scenario(setup=setup)
    findings = list(bench.findings)
    write(Report.of(findings, run=run_of(scenario, bench, stopped), drive=drive_of(bench)))
    bench.close()
    return [stopped]


def _program(file: Path) -> list[str]:
    """Check a program as `hil check` does, but with few calls of its functions.

    Returns why it ended early, and what is said of its functions.
    """
    checked = check_files(DriverFiles([file], calls=2, seconds=0.05))
    stopped = "" if checked.ran is None else checked.ran.stopped
    write(Report.of(checked.findings, run=Run(file.name, stopped=stopped, functions=tuple(checked.functions))))
    return [stopped, *(function.note for function in checked.functions)]


def write(report: Report) -> None:
    """Every form of a report; what is JSON is read again."""
    json.loads(json.dumps(as_dict(report), allow_nan=False))
    json.loads(json.dumps(sarif(report), allow_nan=False))
    html(report)
    junit(report)
    print_report(report, Console(file=StringIO(), width=120), details=True)


def failure(seed: int, language: str) -> str:
    """What goes wrong with the case of a seed: the exception and its innermost place; "" if nothing does."""
    name, text = mutant(seed, language)
    with TemporaryDirectory() as folder, patch("sys.stdout", StringIO()), _time_limit():
        file = Path(folder) / f"{name}.{language}"
        file.write_text(text, encoding="utf-8")
        run: Callable[[], list[str]] = (lambda: _robot(name, file)) if language == "py" else (lambda: _program(file))
        try:
            said = run()
        except TooLong as error:
            return f"does not come back: {_where(error)}"
        except ValueError as error:
            return "" if PLACE.match(str(error)) else f"{type(error).__name__}: {error}: {_where(error)}"
        except Exception as error:
            return f"{type(error).__name__}: {error}: {_where(error)}"
    return next((text for text in said if INTERNAL_ERROR in text), "")


def _where(error: BaseException) -> str:
    """The innermost place of ours."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename.startswith(str(REPOSITORY))]
    return f"{Path(frames[-1].filename).relative_to(REPOSITORY)}:{frames[-1].lineno}" if frames else "nowhere"


def main() -> int:
    """Report every cause once, with how often it came."""
    parser = argparse.ArgumentParser(description="run mutated firmware")
    parser.add_argument("--cases", type=int, default=100, help="how many of each language")
    parser.add_argument("--from", dest="start", type=int, default=0, help="the first seed")
    parser.add_argument("--language", choices=LANGUAGES, action="append", help="default: both")
    parser.add_argument("--seed", type=int, help="this case only")
    parser.add_argument("--show", action="store_true", help="print what --seed changes")
    arguments = parser.parse_args()
    seeds = range(arguments.start, arguments.start + arguments.cases)
    if arguments.seed is not None:
        seeds = range(arguments.seed, arguments.seed + 1)
    causes: Counter[str] = Counter()
    for language in arguments.language or LANGUAGES:
        for seed in seeds:
            if arguments.show:
                name, text = mutant(seed, language)
                old = corpus(language)[name].splitlines()
                print(*(line for line in text.splitlines() if line not in old), sep="\n")
            found = failure(seed, language)
            if found:
                causes[found] += 1
                print(f"{language} {seed}: {found}", flush=True)
    print(f"{sum(causes.values())} failures, {len(causes)} kinds")
    return 1 if causes else 0


if __name__ == "__main__":
    raise SystemExit(main())
