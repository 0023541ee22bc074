"""What the author of firmware declares in its comments: ``hil: WORD ...``, in C and in Python.

    // hil: allow index, the table has a guard word behind it
    x = table[i];

    // hil: range -100..100
    int16_t limited(int16_t v) { ... }

A comment that stands behind code is about that line; one that stands alone is about the statement, or the function,
that begins on the next line of code.  A comment over several lines declares on each line that begins with ``hil:``.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

from emulator.c28x.tree import Where

#: The words that may follow ``hil:``, each with how it is written.
WORDS: Final = {
    "allow": "allow RULE, REASON",
    "range": "range [PARAMETER] LOW..HIGH",
    "unit": "unit [PARAMETER or OBJECT] UNIT",
    "monotone": "monotone [PARAMETER] rising|falling",
    "odd": "odd [PARAMETER]",
    "even": "even [PARAMETER]",
    "idempotent": "idempotent",
}
#: Literals and comments of C: what begins first counts.
_C: Final = re.compile(r"""(?P<comment>//[^\n]*|/\*.*?(?:\*/|\Z))|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL)
#: A line of a comment that declares; the comment's own marks are before it and behind it.
_DECLARES: Final = re.compile(r"^[\s/*#!<]*hil:\s*(?P<word>\S*)\s*(?P<text>.*?)\s*(?:\*/)?$")
#: How a statement of C ends, or the head of one that has a body.
_C_END: Final = re.compile(r"[;{}:]\s*$")


@dataclass(frozen=True, slots=True)
class UserDeclaration:
    """One declaration: its word, what follows, and which lines it is about."""

    file: str
    #: Where it stands.
    line: int
    word: str
    text: str
    #: The first and the last line that it is about.
    about: tuple[int, int]

    def is_about(self, where: Where) -> bool:
        """Whether it is about what stands at a place."""
        return where.file == self.file and self.about[0] <= where.line <= self.about[1]

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: hil: {self.word}"

    def wrong(self, why: str) -> ValueError:
        """What is wrong with it, in one line, and how it is written."""
        return ValueError(f"{self}: {why}: want hil: {WORDS[self.word]}")


def declarations(file: str) -> tuple[UserDeclaration, ...]:
    """What the comments of a file declare, in order; nothing of a file that cannot be read.

    Raises ValueError, one line with file and line, for a word that declares nothing.
    """
    try:
        status = Path(file).stat()
        return _declarations(file, status.st_mtime_ns, status.st_size)
    except OSError:
        return ()


@lru_cache
def _declarations(file: str, changed_ns: int, size: int) -> tuple[UserDeclaration, ...]:
    """Those of a file as it is now."""
    text = Path(file).read_text(encoding="utf-8", errors="replace")
    return tuple(_declared(file, text)) if "hil:" in text else ()


def _declared(file: str, text: str) -> Iterator[UserDeclaration]:
    python = file.endswith(".py")
    comments = list((_python_comments if python else _c_comments)(text))
    code = _code(text, comments)
    for offset, comment in comments:
        first = text.count("\n", 0, offset) + 1
        last = first + comment.count("\n")
        behind_code = bool(code[first - 1].strip())
        for number, line in enumerate(comment.split("\n")):
            match = _DECLARES.match(line)
            if match is None:
                continue
            word = match["word"]
            if word not in WORDS:
                raise ValueError(f"{file}:{first + number}: hil: {word}: there are {', '.join(WORDS)}")
            about = (first, first) if behind_code else _next(code, last, text if python else None)
            yield UserDeclaration(file, first + number, word, match["text"], about)


def _c_comments(text: str) -> Iterator[tuple[int, str]]:
    return ((match.start(), match.group()) for match in _C.finditer(text) if match["comment"])


def _python_comments(text: str) -> Iterator[tuple[int, str]]:
    starts = [0]
    for line in io.StringIO(text):
        starts.append(starts[-1] + len(line))
    try:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type == tokenize.COMMENT:
                yield starts[token.start[0] - 1] + token.start[1], token.string
    except (tokenize.TokenError, SyntaxError):
        return  # the translator says what is wrong with it


def _code(text: str, comments: list[tuple[int, str]]) -> list[str]:
    """The lines without their comments."""
    kept, last = [], 0
    for offset, comment in comments:
        kept += [text[last:offset], "\n" * comment.count("\n")]
        last = offset + len(comment)
    return "".join([*kept, text[last:]]).split("\n")


def _next(code: list[str], line: int, python: str | None) -> tuple[int, int]:
    """From the first line of code behind line number `line` to the end of the statement, or the head, there."""
    first = next((number for number in range(line + 1, len(code) + 1) if code[number - 1].strip()), line)
    if python is not None:
        return first, _python_end(python, first)
    for number in range(first, len(code) + 1):
        if _C_END.search(code[number - 1]):
            return first, number
    return first, first


def _python_end(text: str, first: int) -> int:
    try:
        statements = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.stmt) and node.lineno == first]
    except SyntaxError:
        return first
    if not statements:
        return first
    body = getattr(statements[0], "body", None)
    return body[0].lineno - 1 if body else statements[0].end_lineno or first
