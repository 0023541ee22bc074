"""Operands that the text of a macro tears apart: an operator beside them binds tighter than their own.

    #define SCALE(x)  x * 2 + 1
    out = SCALE(ticks + 3);         // ticks + 3 * 2 + 1: only the 3 is multiplied
    out = SCALE(ticks) * 2;         // ticks * 2 + 1 * 2

Tokens are all there is: no types are known yet, so what could be a cast leaves an operand unjudged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from emulator.c28x.readers.c.conditions import PRECEDENCE
from emulator.c28x.readers.c.tokens import CHAR, NAME, NUMBER, PUNCT, STRING, Token

#: Operators with a left and a right operand -> how tight they bind.
_BINDS: Final = PRECEDENCE | {"?": 0}
#: Unary operators that take less than a sum, or than any operand with an operator.
_UNARY: Final = {"-": 9, "~": 10, "!": 10, "*": 10}
#: Operators -> those of the same strength behind which the operand on their right is another one without parentheses.
_ANOTHER: Final = {
    "-": ("+", "-"), **dict.fromkeys(("/", "%"), ("*", "/", "%")), **dict.fromkeys(("<<", ">>"), ("<<", ">>")),
    **dict.fromkeys(("<", ">", "<=", ">="), ("<", ">", "<=", ">=")), **dict.fromkeys(("==", "!="), ("==", "!=")),
}  # fmt: skip
_OPENING: Final = {"(": ")", "[": "]", "{": "}"}
#: A text with one of these is a statement, or something else that is no operand.
_NO_OPERAND: Final = frozenset((
    ";", ",", "{", "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=", "#", "...",
))  # fmt: skip
#: Words behind which an operator has no left operand, and words of types.
_WORDS: Final = frozenset((
    "return", "case", "sizeof", "else", "do", "goto", "const", "volatile", "unsigned", "signed", "int", "long", "short",
    "char", "float", "double", "struct", "union", "enum", "void", "static", "extern", "register", "typedef",
))  # fmt: skip


class Loosest(NamedTuple):
    """The operator of an operand that binds loosest: its text, and how tight it binds."""

    text: str
    binds: int


def loosest(tokens: Sequence[Token]) -> Loosest | None:
    """The loosest binary operator outside of brackets; None: there is none, or the tokens may be no operand."""
    found: Loosest | None = None
    closing: list[str] = []
    opened = 0
    for index, token in enumerate(tokens):
        text = token.text
        if token.kind != PUNCT:
            if not closing and text in _WORDS and text != "sizeof":
                return None
        elif text in _OPENING:
            if text == "{":
                return None
            if not closing:
                opened = index
            closing.append(_OPENING[text])
        elif closing and text == closing[-1]:
            closing.pop()
            if not closing and text == ")" and _may_be_cast(tokens, opened, index):
                return None
        elif closing:
            continue
        elif text in _NO_OPERAND or text in (")", "]"):
            return None
        elif text in _BINDS and index and _ends_operand(tokens[index - 1]):
            if index + 1 == len(tokens):
                return None
            if found is None or _BINDS[text] < found.binds:
                found = Loosest(text, _BINDS[text])
    return None if closing else found


def torn_by(before: Sequence[Token], own: Loosest, behind: Token | None) -> str:
    """The operator beside an operand that takes only a part of it; "": none does.

    `before`: the tokens before the operand, of which the last two count.
    """
    if behind is not None and behind.kind == PUNCT and 0 < _BINDS.get(behind.text, -1) > own.binds:
        return behind.text
    operator = before[-1] if before and before[-1].kind == PUNCT else None
    if operator is None:
        return ""
    if len(before) > 1 and _ends_operand(before[-2]):
        if before[-2].text == ")" and operator.text in _UNARY:
            return ""  # what is in the parentheses may be a type
        another = own.text in _ANOTHER.get(operator.text, ())
        return operator.text if 0 < _BINDS.get(operator.text, -1) > own.binds or another else ""
    return operator.text if own.binds <= _UNARY.get(operator.text, -1) else ""


def _ends_operand(token: Token) -> bool:
    if token.kind == PUNCT:
        return token.text in (")", "]")
    return token.kind in (NUMBER, STRING, CHAR) or (token.kind == NAME and token.text not in _WORDS)


def _may_be_cast(tokens: Sequence[Token], opened: int, closed: int) -> bool:
    """Whether parentheses can contain a type, and an operator follows that could be unary."""
    inner = tokens[opened + 1 : closed]
    behind = tokens[closed + 1].text if closed + 1 < len(tokens) else ""
    alone = not opened or not _ends_operand(tokens[opened - 1])
    return alone and behind in ("-", "+", "*", "&") and all(t.kind == NAME or t.text == "*" for t in inner)
