"""Declarations in comments of the firmware: ``hil: WORD ...``, in C and in Python.

    // hil: allow index, the table has a guard word behind it
    x = table[i];

    // hil: range -100..100
    int16_t limited(int16_t v) { ... }

A comment behind code applies to that line.  A comment on a line of its own applies to the statement, or the function,
that begins on the next line of code.  In a comment of several lines, each line that begins with ``hil:`` declares.
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

#: The words that may follow ``hil:``, each with its syntax.
WORDS: Final = {
    "allow": "allow RULE, REASON",
    "range": "range [PARAMETER] LOW..HIGH",
    "unit": "unit [PARAMETER or OBJECT] UNIT",
    "monotone": "monotone [PARAMETER] rising|falling",
    "odd": "odd [PARAMETER]",
    "even": "even [PARAMETER]",
    "idempotent": "idempotent",
}
#: Literals and comments of C: the one that begins first counts.
_C: Final = re.compile(r"""(?P<comment>//[^\n]*|/\*.*?(?:\*/|\Z))|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL)
#: A declaration in a line of a comment; the marks of the comment may surround it.
_DECLARES: Final = re.compile(r"^[\s/*#!<]*hil:\s*(?P<word>\S*)\s*(?P<text>.*?)\s*(?:\*/)?$")
#: The marks of a comment, with those of documentation generators.
_BARE: Final = re.compile(r"^(?:/\*+|//+|#+)[!<]*\s*|\s*\*+/$")
#: The end of a C statement, or of the head of one that has a body.
_C_END: Final = re.compile(r"[;{}:]\s*$")


@dataclass(frozen=True, slots=True)
class UserDeclaration:
    """One declaration: its word, the text after it, and the lines that it applies to."""

    file: str
    #: The line of the declaration.
    line: int
    word: str
    text: str
    #: The first and the last line that it applies to.
    about: tuple[int, int]

    def is_about(self, where: Where) -> bool:
        """Whether it applies to a place."""
        return where.file == self.file and self.about[0] <= where.line <= self.about[1]

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: hil: {self.word}"

    def wrong(self, why: str) -> ValueError:
        """The error about this declaration, in one line: what is wrong, and its syntax."""
        return ValueError(f"{self}: {why}: expected hil: {WORDS[self.word]}")


def declarations(file: str) -> tuple[UserDeclaration, ...]:
    """The declarations in the comments of a file, in order; none if the file cannot be read.

    Raises ValueError, one line with file and line, for an unknown word.
    """
    try:
        status = Path(file).stat()
        return _declarations(file, status.st_mtime_ns, status.st_size)
    except OSError:
        return ()


def lines_with_comments(file: str) -> tuple[tuple[str, str], ...]:
    """The lines of a file: the code of each, and the text of the comment that ends or begins behind it on this line.

    Nothing if the file cannot be read.
    """
    try:
        status = Path(file).stat()
        return _lines_with_comments(file, status.st_mtime_ns, status.st_size)
    except OSError:
        return ()


@lru_cache
def _lines_with_comments(file: str, changed_ns: int, size: int) -> tuple[tuple[str, str], ...]:
    """The lines of a file with their comments; cached by its time of change and size."""
    text = Path(file).read_text(encoding="utf-8", errors="replace")
    comments = list((_python_comments if file.endswith(".py") else _c_comments)(text))
    code = _code(text, comments)
    beside = dict.fromkeys(range(len(code)), "")
    line, last = 0, 0
    for offset, comment in comments:
        line, last = line + text.count("\n", last, offset), offset
        beside[line] = _BARE.sub("", comment).strip()
    return tuple((part, beside[number]) for number, part in enumerate(code))


@lru_cache
def _declarations(file: str, changed_ns: int, size: int) -> tuple[UserDeclaration, ...]:
    """The declarations of a file; cached by its time of change and size."""
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
        return  # the translator reports what is wrong with it


def _code(text: str, comments: list[tuple[int, str]]) -> list[str]:
    """The lines without their comments."""
    kept, last = [], 0
    for offset, comment in comments:
        kept += [text[last:offset], "\n" * comment.count("\n")]
        last = offset + len(comment)
    return "".join([*kept, text[last:]]).split("\n")


def _next(code: list[str], line: int, python: str | None) -> tuple[int, int]:
    """The lines of the next statement, or head, behind line `line`: first and last."""
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
