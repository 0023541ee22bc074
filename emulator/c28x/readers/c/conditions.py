"""The expressions of `#if`: integers of 64 bits, as C99 (6.10.1) has them."""

from __future__ import annotations

import re
from typing import Final

from emulator.c28x.readers.c.tokens import CHAR, NAME, NUMBER, Token

#: How deep brackets, signs and `?` may nest.
DEPTH: Final = 200

_MASK: Final = (1 << 64) - 1
_INTEGER: Final = re.compile(r"(0[xX][0-9a-fA-F]+|0[bB][01]+|[0-9]+)([uU]?(?:ll|LL|[lL])?|(?:ll|LL|[lL])[uU])")
_ESCAPES: Final = {"n": 10, "t": 9, "r": 13, "a": 7, "b": 8, "f": 12, "v": 11}
#: Operators with two operands -> how tight they bind (6.5.5 to 6.5.14).
PRECEDENCE: Final = {
    "||": 1, "&&": 2, "|": 3, "^": 4, "&": 5, "==": 6, "!=": 6, "<": 7, ">": 7, "<=": 7, ">=": 7, "<<": 8, ">>": 8,
    "+": 9, "-": 9, "*": 10, "/": 10, "%": 10,
}  # fmt: skip

#: A number and whether it is unsigned.
Value = tuple[int, bool]


def evaluate(tokens: list[Token], directive: Token) -> bool:
    """Whether the condition holds; macros are expanded, `defined` is replaced.  Raises SourceError."""
    reader = _ConditionReader(tokens, directive)
    value = reader.choice(live=True)
    if reader.index < len(tokens):
        raise tokens[reader.index].error(f"expected an operator in the condition, found {tokens[reader.index].text!r}")
    return value[0] != 0


def character(token: Token) -> int:
    """The value of a character constant, in 16 bits.  Of several characters, the last one counts (SPRU514, 6.1)."""
    body = token.text[token.text.index("'") + 1 : -1]
    found = re.findall(r"\\x([0-9a-fA-F]+)|\\([0-7]{1,3})|\\(.)|([^\\])", body)
    if not found:
        raise token.error(f"{token.text} is not a character constant")
    hexadecimal, octal, escape, plain = found[-1]
    if hexadecimal:
        value = int(hexadecimal[-4:], 16)
    elif octal:
        value = int(octal, 8)
    else:
        value = _ESCAPES.get(escape, ord(escape)) if escape else ord(plain)
    value &= 0xFFFF
    return value - 0x10000 if value & 0x8000 else value


def _number(token: Token) -> Value:
    match = _INTEGER.fullmatch(token.text)
    if match is None:
        raise token.error(f"{token.text[:40]} is not an integer: a condition has integers only")
    digits, suffix = match.groups()
    base = 16 if digits[:2] in ("0x", "0X") else 2 if digits[:2] in ("0b", "0B") else 8 if digits[0] == "0" else 10
    if len(digits) > 80:
        raise token.error("the integer has more than 64 bits")
    try:
        value = int(digits[2:] if base in (2, 16) else digits, base)
    except ValueError:
        raise token.error(f"{digits} has a digit that is not octal") from None
    if value > _MASK:
        raise token.error("the integer has more than 64 bits")
    return value, "u" in suffix.lower() or (value >> 63) != 0


def _wrap(value: int, unsigned: bool) -> Value:
    value &= _MASK
    return (value if unsigned or not value >> 63 else value - (1 << 64)), unsigned


class _ConditionReader:
    """Precedence climbing.  `live` is False where the value does not matter: there, arithmetic raises no error."""

    def __init__(self, tokens: list[Token], directive: Token) -> None:
        self.tokens = tokens
        self.directive = directive
        self.index = 0
        self.depth = 0

    def _peek(self) -> str:
        return self.tokens[self.index].text if self.index < len(self.tokens) else ""

    def _next(self) -> Token:
        if self.index >= len(self.tokens):
            last = self.tokens[-1] if self.tokens else self.directive
            raise last.error(f"the condition ends after {last.text!r}: a value is missing")
        self.index += 1
        return self.tokens[self.index - 1]

    def _expect(self, text: str) -> None:
        if self._peek() != text:
            token = self.tokens[self.index] if self.index < len(self.tokens) else self.directive
            found = repr(self._peek()) if self._peek() else "the end of the condition"
            raise token.error(f"expected {text!r} in the condition, found {found}")
        self.index += 1

    def _deeper(self) -> None:
        self.depth += 1
        if self.depth > DEPTH:
            token = self.tokens[min(self.index, len(self.tokens) - 1)]
            raise token.error(f"the condition is nested deeper than {DEPTH}")

    def choice(self, live: bool) -> Value:
        self._deeper()
        test = self.binary(1, live)
        if self._peek() == "?":
            self.index += 1
            yes = self.choice(live and test[0] != 0)
            self._expect(":")
            no = self.choice(live and test[0] == 0)
            test = _wrap((yes if test[0] else no)[0], yes[1] or no[1])
        self.depth -= 1
        return test

    def binary(self, lowest: int, live: bool) -> Value:
        left = self.unary(live)
        while (level := PRECEDENCE.get(self._peek(), 0)) >= lowest:
            operator = self._next()
            needed = live
            if operator.text == "&&":
                needed = live and left[0] != 0
            elif operator.text == "||":
                needed = live and left[0] == 0
            left = self._apply(operator, left, self.binary(level + 1, needed), needed)
        return left

    def unary(self, live: bool) -> Value:
        signs = []
        while self._peek() in ("-", "+", "~", "!"):
            signs.append(self._next().text)
        token = self._next()
        if token.text == "(":
            value = self.choice(live)
            self._expect(")")
        elif token.kind == NUMBER:
            value = _number(token)
        elif token.kind == CHAR:
            value = character(token), False
        elif token.kind == NAME:
            value = 0, False
        else:
            raise token.error(f"expected a value in the condition, found {token.text[:40]!r}")
        for sign in reversed(signs):
            if sign == "!":
                value = int(value[0] == 0), False
            elif sign == "-":
                value = _wrap(-value[0], value[1])
            elif sign == "~":
                value = _wrap(~value[0], value[1])
        return value

    def _apply(self, operator: Token, left: Value, right: Value, live: bool) -> Value:
        text = operator.text
        a, b = left[0], right[0]
        if text == "&&":
            return int(a != 0 and b != 0), False
        if text == "||":
            return int(a != 0 or b != 0), False
        if text in ("<<", ">>"):
            count = b if text == "<<" else -b
            count = max(-64, min(64, count))
            return _wrap(a << count if count >= 0 else a >> -count, left[1])
        unsigned = left[1] or right[1]
        if unsigned:
            a, b = a & _MASK, b & _MASK
        if text in ("==", "!=", "<", ">", "<=", ">="):
            order = (a > b) - (a < b)
            holds = {"==": order == 0, "!=": order != 0, "<": order < 0, ">": order > 0, "<=": order <= 0}
            return int(holds.get(text, order >= 0)), False
        if text in ("/", "%"):
            if b == 0:
                if live:
                    raise operator.error("the condition divides by zero")
                return 0, unsigned
            quotient = abs(a) // abs(b)
            quotient = -quotient if (a < 0) != (b < 0) else quotient
            return _wrap(quotient if text == "/" else a - b * quotient, unsigned)
        results = {"+": a + b, "-": a - b, "*": a * b, "&": a & b, "|": a | b, "^": a ^ b}
        return _wrap(results[text], unsigned)
