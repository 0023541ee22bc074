"""C source as tokens with their places: the real line and column in the file, and both places of a macro text.

Source is C99 (ISO/IEC 9899:1999, 6.4) without trigraphs.  A backslash at the end of a line joins two lines, but the
places of tokens are those of the file on disk.  A tab counts as one column.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from sys import intern
from typing import Final

from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Where

#: The kinds of tokens.  OTHER is a character with which no C token starts, BAD a quote that is not closed in its line,
#: PLACE the empty operand of `##`, END the end of the input.
NAME: Final = "name"
NUMBER: Final = "number"
STRING: Final = "string"
CHAR: Final = "char"
PUNCT: Final = "punct"
OTHER: Final = "other"
BAD: Final = "bad"
PLACE: Final = "place"
END: Final = "end"

_PUNCTUATORS = (
    r"%:%:|\.\.\.|<<=|>>=|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&^|]=|\#\#|<:|:>|<%|%>|%:"
    r"|[\[\](){}.&*+\-~!/%<>^|?:;=,\#]"
)
_STRING = r'L?"(?:[^"\\\n]|\\.)*+"'
_CHAR = r"L?'(?:[^'\\\n]|\\.)++'"
_NUMBER = r"\.?[0-9](?:[eEpP][+-]|[0-9A-Za-z_.$])*+"
_NAME = r"[A-Za-z_$][0-9A-Za-z_$]*+"

#: One alternative per kind.  Their order matters (a number may start with a point, a string with a letter).
_TOKEN: Final = re.compile(
    r"((?:[ \t\f\v\r]++|//[^\n]*+|/\*(?s:.*?)\*/)++)"  # 1: blank
    r"|(\n)"  # 2: end of line
    rf"|({_STRING})|({_CHAR})|({_NAME})|({_NUMBER})"  # 3 4 5 6
    r"|(/\*(?s:.*))"  # 7: a comment without end
    rf"|({_PUNCTUATORS})"  # 8
    r"|([\"'][^\n]*+)"  # 9: a quote without end
    r"|(.)"  # 10
)
_BLANK, _NEWLINE, _OPEN_COMMENT = 1, 2, 7
_KINDS: Final = ("", "", "", STRING, CHAR, NAME, NUMBER, "", PUNCT, BAD, OTHER)
_COMMENT: Final = re.compile(r"//[^\n]*+|/\*(?s:.*?)\*/")
_SPLICE: Final = re.compile(r"\\\r?\n")
_ONE: Final = re.compile(rf"(?:({_STRING})|({_CHAR})|({_NAME})|({_NUMBER})|({_PUNCTUATORS}))")
_ONE_KINDS: Final = ("", STRING, CHAR, NAME, NUMBER, PUNCT)


def error_at(where: Where, message: str) -> SourceError:
    """The error at `where`; within a macro, it names both places."""
    if where.macro is not None:
        message += f" (out of the macro text at {where.macro})"
    return SourceError(where.file, where.line, message, where.column)


@dataclass(frozen=True, slots=True)
class SourceRemark:
    """Something in the source that deserves a remark, but is not an error."""

    where: Where
    message: str
    rule: str = "preprocessor"
    #: The macro that it is about.
    name: str = ""


def kind_of(text: str) -> str | None:
    """The kind of `text` if it is exactly one token, else None."""
    match = _ONE.fullmatch(text)
    return _ONE_KINDS[match.lastindex or 0] if match else None


def _swallowing(blank: str) -> Iterator[int]:
    """Where comments begin whose end is that of another one, with code between the two beginnings."""
    for comment in _COMMENT.finditer(blank):
        before, _, _ = comment.group().rpartition("/*")
        if any(line.rstrip().endswith((";", "{", "}")) for line in before.split("\n")[1:]):
            yield comment.start()


class SourceText:
    """The text of one file with joined lines, and the map from an offset in it to line and column on disk."""

    __slots__ = ("_joints", "_kept", "_removed", "_starts", "file", "folder", "swallowing", "text")

    def __init__(self, file: str, text: str, folder: str | None = None, *, keep: bool = False) -> None:
        """`file`: the name in places.  `folder`: searched first for its own `#include "..."`.

        `keep`: store its tokens, because many files include it.
        """
        self._kept: list[list[Token]] | None = [] if keep else None
        #: Where comments begin that contain code and the beginning of another comment.  Scanning fills it.
        self.swallowing: list[int] = []
        if "\r" in text and "\n" not in text:
            text = text.replace("\r", "\n")
        text = text.removeprefix("\ufeff")
        self.file = file
        self.folder = folder
        self._starts = [0, *(match.end() for match in re.finditer("\n", text))]
        self._joints: list[int] = []
        self._removed: list[int] = []
        pieces = []
        last = removed = 0
        for match in _SPLICE.finditer(text):
            pieces.append(text[last : match.start()])
            self._joints.append(match.start() - removed)
            last = match.end()
            removed += match.end() - match.start()
            self._removed.append(removed)
        self.text = "".join([*pieces, text[last:]]) if pieces else text

    def where(self, at: int, macro: Where | None = None) -> Where:
        """The place on disk of offset `at` of `text`."""
        joint = bisect_right(self._joints, at)
        if joint:
            at += self._removed[joint - 1]
        line = bisect_right(self._starts, at)
        return Where(self.file, line, at - self._starts[line - 1] + 1, macro)

    def lines(self, budget: TokenBudget) -> Iterator[list[Token]]:
        """The tokens of each line that has any.  Raises SourceError for an unclosed comment, and beyond `budget`."""
        if self._kept is None:
            yield from self._scanned(budget)
            return
        if not self._kept:
            self._kept += self._scanned(TokenBudget(budget.limit))
        for line in self._kept:
            budget.spend(len(line), line[0])
            yield line

    def _scanned(self, budget: TokenBudget) -> Iterator[list[Token]]:
        line: list[Token] = []
        room = budget.left
        space = True
        for match in _TOKEN.finditer(self.text):
            index = match.lastindex or 0
            if index == _BLANK:
                space = True
                if "\n" in (blank := match.group()):
                    self.swallowing += (match.start() + at for at in _swallowing(blank))
            elif index == _NEWLINE:
                if line:
                    budget.spend(len(line), line[0])
                    yield line
                    line = []
                    room = budget.left
                space = True
            elif index == _OPEN_COMMENT:
                raise error_at(self.where(match.start()), "the comment has no end: */ is missing")
            else:
                line.append(Token(_KINDS[index], intern(match.group()), self, match.start(), space))
                space = False
                if len(line) > room:
                    budget.spend(len(line), line[-1])
        if line:
            budget.spend(len(line), line[0])
            yield line


class Token:
    """One token: its kind, its text, and its place.

    A token from a macro has its place in the macro's definition (`source`, `at`); `use` is the token in the file that
    named the macro.  A token of an argument is in the file itself: it has no `use`.
    """

    __slots__ = ("at", "kind", "painted", "source", "space", "text", "use")

    def __init__(
        self, kind: str, text: str, source: SourceText, at: int, space: bool = False, use: Token | None = None,
        painted: bool = False,
    ) -> None:  # fmt: skip
        """`space`: a blank is before it.  `painted`: a macro's name in its own expansion, never expanded again."""
        self.kind = kind
        self.text = text
        self.source = source
        self.at = at
        self.space = space
        self.use = use
        self.painted = painted

    @property
    def where(self) -> Where:
        """Its place in the file; for text from a macro, `macro` is the place in the macro's definition."""
        if self.use is None:
            return self.source.where(self.at)
        return self.use.source.where(self.use.at, self.source.where(self.at))

    def error(self, message: str) -> SourceError:
        """The error at this token."""
        return error_at(self.where, message)

    def __repr__(self) -> str:
        return f"Token({self.kind}, {self.text!r}, {self.where})"


class TokenBudget:
    """The limit for tokens of one translation unit: read, written by macros, and read again."""

    __slots__ = ("left", "limit")

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.left = limit

    def spend(self, tokens: int, at: Token) -> None:
        """Use up `tokens`.  Raises SourceError at `at` if none are left."""
        self.left -= tokens
        if self.left < 0:
            raise at.error(f"more than {self.limit:,} tokens with all headers and macros: the file is not read further")


def spelled(tokens: list[Token]) -> str:
    """The tokens as text; any white space becomes one blank."""
    return "".join(" " * token.space + token.text for token in tokens).strip()
