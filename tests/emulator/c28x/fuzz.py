"""Damaged firmware: whatever the text, the translator answers with an image or with one line that names the place.

A seed makes a case: a text of the corpus, damaged by characters, tokens, lines or by something grown out of measure.
Each case is translated and linked, never run.  Allowed are success and a ValueError (SourceError, LinkError) that
begins with file and line.  Everything else is a failure: another exception, an error without a place, more work or
memory than the size of the text explains.  Work is counted in calls, so that a case fails on every machine or on none.

    python -m tests.emulator.c28x.fuzz                      # 500 cases of every language
    python -m tests.emulator.c28x.fuzz --cases 20000 --from 500 --language py
    python -m tests.emulator.c28x.fuzz --seed 4711 --language c --show
"""

from __future__ import annotations

import argparse
import ast
import faulthandler
import random
import re
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any, Final

from emulator.c28x.findings import Findings
from emulator.c28x.memory import Memory
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.runtime import Runtime
from emulator.c28x.tree import Function
from emulator.clock import Clock
from emulator.cpu import Cpu
from tests.emulator.c28x.linking import link

HERE: Final = Path(__file__).parent
REPOSITORY: Final = HERE.parents[2]
LANGUAGES: Final = ("py", "c")
PLACE: Final = re.compile(r"[^:\n]+:[1-9]\d*(:[1-9]\d*)?: \S")
TOKEN: Final = re.compile(
    r"""[A-Za-z_]\w*|0[xX][0-9a-fA-F]+\w*|\d+\.?\d*(?:[eE][+-]?\d+)?\w*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'"""
    r"""|\n[ \t]*|[ \t]+|<<=|>>=|->|\+\+|--|<<|>>|[<>=!+\-*/%&|^]=|&&|\|\||##|\*\*|//|."""
)

#: Calls that a text may cost: those of an array that fills the memory, and a share for every character.
CALLS: Final = 15_000_000
CALLS_PER_CHARACTER: Final = 1_000
#: Octets that a text may cost.
MEMORY: Final = 1 << 29

_NUMBERS: Final = (
    "0", "1", "-1", "32767", "32768", "65535", "65536", "0x8000", "0xFFFFFFFF", "4294967296", "10000000000",
    "99999999999999999999", "1.5", "1e39", "1e400", "0.0", "'a'", "''", '"x"', '""',
)  # fmt: skip
_WORDS: Final = {
    "py": (
        *_NUMBERS, "1e400", "_cpu", "_range", "_c_load", "_g_drv_x", "lambda", "None", "True", "print", "len", "NULL",
        "addressof", "cast", "sizeof", "ptr", "array", "struct", "enum", "extern", "funcptr", "const", "char", "uint16",
        "int32", "float32", "int64", "void", "volatile", "static", "union", "Annotated", "bits", "do", "fallthrough",
        "interrupt", "point", "elif", "handle", "FIXED", "range", "and", "or", "not", "if", "else", "while", "for",
        "in",
        "return", "break", "continue", "pass", "match", "case", "_", "is", "await", "yield", "del", "global", "import",
        "from", "as", "with", "try", "raise", "class", "def", "async", ":", ";", ",", ".", "(", ")", "[", "]", "{", "}",
        "=", "==", "+", "-", "*", "/", "//", "%", "**", "<<", ">>", "&", "|", "^", "~", "@", ":=", "->", "\n", "\n    ",
        "\\", "#", "j", "1j", "f''", "b''", "...", "é", "\x00", "\f", "\u2028",
    ),
    "c": (
        *_NUMBERS, "0u", "1UL", "1LL", "08", "0x", "1.5f", "'\\x'", "'ab'", '"\\q"', "_cpu", "lambda", "None", "self",
        "int", "char", "unsigned", "long", "float", "double", "void", "struct", "union", "enum", "typedef", "static",
        "extern", "const", "volatile", "register", "inline", "sizeof", "if", "else", "while", "do", "for", "switch",
        "case", "default", "break", "continue", "return", "goto", "interrupt", "asm", "...", "{", "}", "(", ")", "[",
        "]", ";", ",", ":", "?", ".", "->", "=", "==", "+", "-", "*", "/", "%", "<<", ">>", "&", "|", "^", "~", "!",
        "&&", "||", "++", "--", "+=", "<<=", "#", "##", "\n#define M M\n", "\n#define F(x) F(x) F(x)\n", "\n#if 1\n",
        "\n#else\n", "\n#endif\n", '\n#include "drv.c"\n', "\n#include </etc/hostname>\n", "\n#include\n", "\\\n", "\\",
        "/*", "*/", "//", '"', "'", "??/", "@", "$", "`", "é", "\x00", "\f", "\r", "\u2028",
    ),
}  # fmt: skip
#: Text that is repeated, with what closes it.
_NESTS: Final = {
    "py": (("(", ")"), ("-", ""), ("not ", ""), ("~", ""), ("[", "]"), ("1 + ", ""), ("a.", ""), ("(1 and ", ")"),
           ("ptr[", "]"), ("array[", ", 2]"), ("addressof(", ")"), ("cast(int16, ", ")"), ("x[", "]"), ("1, ", "")),
    "c": (("(", ")"), ("- ", ""), ("!", ""), ("~", ""), ("{", "}"), ("[", "]"), ("1 + ", ""), ("(int)", ""), ("*", ""),
          ("&", ""), ("if (1) ", ""), ("do ", " while (0);"), ("for (;;) ", ""), ("1 ? 2 : ", ""), ("a.", ""),
          ("a->", ""), ("f(", ")"), ("int (*", ")"), ("sizeof ", ""), ("1, ", ""), ("\n#if 1\n", "\n#endif\n"),
          ("switch (1) case 1: ", ""), ("else if (1) ; ", ""), ("struct S { ", "}; "), ("x = ", "")),
}  # fmt: skip


class TooMuchWork(BaseException):
    """A case has used up its calls; no handler of the translator may swallow it."""


class _Register:
    """Any register of any block."""

    looked_at = False

    def follow(self, access: str, space: dict[str, Any], name: str) -> None:
        """Bind nothing that could be called: no case is run."""
        space[name] = None


@dataclass(frozen=True)
class Failure:
    """What went wrong with a case; equal failures have one cause."""

    kind: str
    what: str
    where: str
    #: The exception's own words, or the stack of the calls, not compared.
    detail: str

    @property
    def cause(self) -> tuple[str, str, str]:
        """What makes two failures one."""
        return self.kind, self.what, self.where

    def __str__(self) -> str:
        return f"{self.kind}: {self.what} in {self.where}: {self.detail}"


@cache
def corpus(language: str) -> tuple[str, ...]:
    """The texts that are damaged: the specimens and the robot's port, or the programs in C."""
    if language == "c":
        return tuple(p.read_text(encoding="utf-8") for p in sorted((HERE / "readers" / "c" / "programs").rglob("*.c")))
    from tests.emulator.c28x.test_specimens import DRIVERS, LIBRARY, PAIRS
    from tests.hil.diff.test_constructs import CONSTRUCTS, HEADER

    specimens = [LIBRARY + text for pair in PAIRS for text in (pair.defect, pair.correct)]
    specimens += [LIBRARY + driver.source for driver in DRIVERS]
    specimens += [HEADER + python for python, _, _ in CONSTRUCTS.values()]
    modules = sorted((REPOSITORY / "firmware_model").glob("*.py"))
    names = {"gyro.py", "main_robot.py", "odometry.py", "protocol.py", "robot_types.py", "servidores.py", "us.py"}
    return (*specimens, *(file.read_text(encoding="utf-8") for file in modules if file.name in names))


def case(seed: int, language: str) -> str:
    """The text number `seed`: the same on every machine."""
    rng = random.Random(f"{language} {seed}")
    whole = rng.choice(corpus(language))
    text = _damaged(rng, whole, language)
    if language == "py" and rng.random() < 0.8:  # most damage ends in Python's own parser: look for some that does not
        for _ in range(20):
            if _is_python(text):
                break
            text = _damaged(rng, whole, language)
    return text


def _damaged(rng: random.Random, text: str, language: str) -> str:
    for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
        text = rng.choice(_DAMAGES)(rng, text, language)
    return text


def _is_python(text: str) -> bool:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ast.parse(text)
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return False
    return True


def _characters(rng: random.Random, text: str, language: str) -> str:
    """Delete, double, swap or replace a few characters."""
    at = rng.randrange(len(text) + 1)
    length = rng.choice((1, 1, 2, 5, 40))
    piece = text[at : at + length]
    other = rng.choice((
        "", piece * 2, piece[::-1],
        chr(rng.choice((0, 9, 10, 12, 13, 34, 39, 40, 64, 92, 127, 160, 233, 8232, 128512))),
        rng.choice("()[]{}<>+-*/%&|^~!=,;:.?#\\'\"@$0123456789abcdefx_ \n"),
    ))  # fmt: skip
    return text[:at] + other + text[at + length :]


def _tokens(rng: random.Random, text: str, language: str) -> str:
    """Delete, double, swap or replace a token, by a word of the language or by another token of the text."""
    tokens = TOKEN.findall(text)
    if not tokens:
        return text
    solid = [i for i, token in enumerate(tokens) if token.strip()] or [0]
    at, other = rng.choice(solid), rng.choice(solid)
    match rng.randrange(6):
        case 0:
            tokens[at] = ""
        case 1:
            tokens[at] += " " + tokens[at]
        case 2:
            tokens[at], tokens[other] = tokens[other], tokens[at]
        case 3:
            tokens[at] = rng.choice(_WORDS[language])
        case 4:
            tokens[at] = tokens[other]
        case _:
            tokens[at] += " " + rng.choice(_WORDS[language])
    return "".join(tokens)


def _numbers(rng: random.Random, text: str, language: str) -> str:
    """Replace a number, by one at the edge of a type or beyond reason."""
    tokens = TOKEN.findall(text)
    numbers = [i for i, token in enumerate(tokens) if token[0].isdigit()]
    if not numbers:
        return text
    tokens[rng.choice(numbers)] = rng.choice((*_NUMBERS, "200000000", "1 << 10000000000", "-32768", "2 ** 99"))
    return "".join(tokens)


def _rename(rng: random.Random, text: str, language: str) -> str:
    """Give a name of the text the name of something else, everywhere."""
    names = sorted({token for token in TOKEN.findall(text) if token[0].isalpha() or token[0] == "_"})
    if not names:
        return text
    old, new = rng.choice(names), rng.choice((*names, *_WORDS[language]))
    return "".join(new if token == old else token for token in TOKEN.findall(text))


def _lines(rng: random.Random, text: str, language: str) -> str:
    """Delete, double, move or indent lines, or bring in some of another text."""
    lines = text.splitlines(keepends=True)
    if not lines:
        return text
    at, length, to = rng.randrange(len(lines)), rng.choice((1, 1, 2, 6)), rng.randrange(len(lines))
    piece = lines[at : at + length]
    match rng.randrange(5):
        case 0:
            del lines[at : at + length]
        case 1:
            lines[at:at] = piece
        case 2:
            del lines[at : at + length]
            lines[to:to] = piece
        case 3:
            lines[at : at + length] = ["    " + line for line in piece]
        case _:
            other = rng.choice(corpus(language)).splitlines(keepends=True)
            start = rng.randrange(max(1, len(other)))
            lines[at:at] = other[start : start + rng.choice((1, 3, 12))]
    return "".join(lines)


def _grown(rng: random.Random, text: str, language: str) -> str:
    """Put something nested or repeated before a token."""
    tokens = TOKEN.findall(text)
    solid = [i for i, token in enumerate(tokens) if token.strip()]
    if not solid:
        return text
    opening, closing = rng.choice(_NESTS[language])
    times = rng.choice((3, 20, 70, 150, 400, 900, 3000))
    at = rng.choice(solid)
    tokens[at] = opening * times + tokens[at] + closing * times
    return "".join(tokens)


_DAMAGES: Final[tuple[Callable[[random.Random, str, str], str], ...]] = (
    _characters, _characters, _tokens, _tokens, _tokens, _tokens, _numbers, _rename, _rename, _lines, _lines, _grown,
)  # fmt: skip


def translate(text: str, language: str) -> None:
    """Read and link a text as the module `drv`, on nothing.  Raises what the translator raises."""
    clock = Clock()
    findings = Findings(clock)
    cpu = Cpu(clock, findings)
    memory = Memory()
    program = Program()
    program.add("drv", f"drv.{language}", text)
    symbols = [symbol for module in program.modules.values() for symbol in module.symbols.values()]
    externs = {symbol.name: _nothing for symbol in symbols if isinstance(symbol, Function) and symbol.extern}
    link(
        program, Runtime(clock, cpu, findings, memory), CompileOptions(static=True),
        registers=lambda block, name: _Register(), externs=externs,
    )  # fmt: skip


@contextmanager
def _memory(size: int) -> Iterator[None]:
    """At most `size` octets more for this process, where the system has such a limit."""
    statm = Path("/proc/self/statm")
    if sys.platform == "win32" or not statm.exists():
        yield
        return
    import resource

    before = resource.getrlimit(resource.RLIMIT_AS)
    used = int(statm.read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def _nothing(*arguments: Any) -> int:
    return 0


def outcome(text: str, language: str, calls: int | None = None) -> Failure | None:
    """Translate a text: None if the answer is an image or an error with its place."""
    left = CALLS + CALLS_PER_CHARACTER * len(text) if calls is None else calls

    def count(frame: FrameType, event: str, argument: Any) -> None:
        nonlocal left
        left -= 1
        if left < 0:
            sys.setprofile(None)
            raise TooMuchWork

    before = sys.getprofile()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with _memory(MEMORY):
                sys.setprofile(count)
                translate(text, language)
    except TooMuchWork as error:
        sys.setprofile(before)
        return Failure("too much work", "TooMuchWork", _origin(error.__traceback__), "")
    except ValueError as error:
        sys.setprofile(before)
        if PLACE.match(str(error)) and "\n" not in str(error):
            return None
        kind = "no place" if type(error).__module__.startswith("emulator.") else "internal"
        return Failure(kind, type(error).__name__, _origin(error.__traceback__), str(error)[:120])
    except (Exception, RecursionError, MemoryError) as error:
        sys.setprofile(before)
        return Failure("internal", type(error).__name__, _origin(error.__traceback__), str(error)[:120])
    finally:
        sys.setprofile(before)
    return None


def _origin(trace: TracebackType | None) -> str:
    """File and function of the translator's last frame in a traceback; of a deep recursion, that of its middle."""
    frames = [f for f in traceback.extract_tb(trace) if f"{REPOSITORY}/emulator" in f.filename]
    if not frames:
        return "?"
    if len(frames) > 300:
        first = min(frames[100:200], key=lambda f: (f.filename, f.lineno or 0))
        return f"{Path(first.filename).name}: {first.name} (within itself)"
    return f"{Path(frames[-1].filename).name}: {frames[-1].name}"


def failures(seeds: range, language: str) -> Iterator[tuple[int, Failure]]:
    """The seeds whose text the translator does not answer as it should."""
    for seed in seeds:
        failure = outcome(case(seed, language), language)
        if failure is not None:
            yield seed, failure


def smallest(text: str, language: str, failure: Failure, max_tries: int = 600) -> str:
    """A shorter text with the same failure: lines, then tokens taken away as long as it stays."""
    tries = max_tries
    for split in (lambda t: t.splitlines(keepends=True), TOKEN.findall):
        parts = split(text)
        size = max(1, len(parts) // 2)
        while size and tries > 0:
            at = 0
            while at < len(parts) and tries > 0:
                shorter = parts[:at] + parts[at + size :]
                tries -= 1
                found = outcome("".join(shorter), language)
                if found is not None and found.cause == failure.cause:
                    parts = shorter
                else:
                    at += size
            size //= 2
        text = "".join(parts)
    return text


def main() -> int:
    """Report every cause once, with its seed and the smallest text that shows it."""
    parser = argparse.ArgumentParser(description="translate damaged firmware")
    parser.add_argument("--cases", type=int, default=500, help="how many texts of each language")
    parser.add_argument("--from", dest="start", type=int, default=0, help="the first seed")
    parser.add_argument("--language", choices=LANGUAGES, action="append", help="default: both")
    parser.add_argument("--seed", type=int, help="this case only")
    parser.add_argument("--show", action="store_true", help="print the text of --seed before it is translated")
    parser.add_argument("--as-is", action="store_true", help="do not look for a smaller text")
    arguments = parser.parse_args()
    seeds = range(arguments.start, arguments.start + arguments.cases)
    if arguments.seed is not None:
        seeds = range(arguments.seed, arguments.seed + 1)
    known: dict[tuple[str, str, str], int] = {}
    for language in arguments.language or LANGUAGES:
        for seed in seeds:
            faulthandler.dump_traceback_later(120, exit=True)
            text = case(seed, language)
            if arguments.show and arguments.seed is not None:
                print(text)
            failure = outcome(text, language)
            if failure is None:
                continue
            known[failure.cause] = known.get(failure.cause, 0) + 1
            if known[failure.cause] == 1:
                print(f"--- {language} {seed}: {failure}", flush=True)
                faulthandler.dump_traceback_later(600, exit=True)
                shown = text if arguments.as_is else smallest(text, language, failure)
                print(shown if len(shown) < 1500 else f"{shown[:700]}\n[... {len(shown)} characters]\n{shown[-300:]}")
    faulthandler.cancel_dump_traceback_later()
    for cause, times in sorted(known.items(), key=lambda item: -item[1]):
        print(f"{times:5}  {': '.join(cause)}")
    return 1 if known else 0


if __name__ == "__main__":
    raise SystemExit(main())
