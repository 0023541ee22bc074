"""Static check of digits of a text that are added with their codes, and not with their values: `digit-code`.

    while (*text >= '0' && *text <= '9') value = value * 10 + *text++;          // *text - '0'

The character is one that the function compares with '0' and with '9', so it is a digit; and it is added to a number
that is multiplied by 10.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import Binary, Compare, Function, Load, LValue
from emulator.c28x.tree_queries import bare, own_nodes, source_text, statements

_DIGITS: Final = (ord("0"), ord("9"))


def check_digits(function: Function, report: StaticReport) -> None:
    """Report the sums of ten times a number and a character that the function knows for a digit."""
    body = statements(function.body)
    tests = [p for s in body for p in own_nodes(s) if isinstance(p, Compare)]
    first, last = ([lvalue for test in tests if (lvalue := _compared(test, digit))] for digit in _DIGITS)
    known = [lvalue for lvalue in first if lvalue in last]
    if not known or any(_made_up_for(p, known) for s in body for p in own_nodes(s)):
        return
    for s in body:
        for p in own_nodes(s):
            match p:
                case Binary(op="+", left=left, right=right):
                    sums = [(left, right), (right, left)]
                case _:
                    continue
            for number, character in sums:
                match bare(number), bare(character):
                    case Binary(op="*", left=one, right=ten), Load(lvalue=lvalue) if lvalue in known and (
                        constant_of(ten) == 10 or constant_of(one) == 10
                    ):
                        text = source_text(character)
                        message = f"{text} is the code of a digit ('0' is {_DIGITS[0]}), and its value is {text} - '0'"
                        report.report(function, s.where, "digit-code", message, object=text)


def _made_up_for(node: object, known: list[LValue]) -> bool:
    """Whether '0' is subtracted from something else than a digit: `value * 10 + c - '0'`, `value -= '0'`."""
    match node:
        case Binary(op="-", left=left, right=right) if constant_of(right) == _DIGITS[0]:
            character = bare(left)
            return not (isinstance(character, Load) and character.lvalue in known)
    return False


def _compared(test: Compare, digit: int) -> LValue | None:
    """The character that a test compares with a digit."""
    for side, other in ((test.left, test.right), (test.right, test.left)):
        character = bare(side)
        if constant_of(other) == digit and isinstance(character, Load) and isinstance(character.ctype, IntType):
            return character.lvalue
    return None
