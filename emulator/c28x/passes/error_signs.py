"""Static check of errors of regulators that are taken without a sign and then widened: `widened-late`.

    long error = SET - measured;    /* with a Uint16 `measured`: below 0 it becomes up to 65535 */

The name says that the result may be negative (`error`, `deviation`, in English, German and Spanish).  Silent if the
function compares the two sides anywhere, and if the left one is the end of a range (`4095 - code`, `100 - percent`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from emulator.c28x.ctypes import CType, FloatType, IntType
from emulator.c28x.passes.declared import words_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Compare, Const, Convert, Expr, Function, Load, LValue, Variable
from emulator.c28x.tree_queries import bare, gives, parts, source_text, statements, within

#: Words of names whose values have both signs.
_SIGNED: Final = frozenset((
    "error", "err", "fehler", "deviation", "abweichung", "regelabweichung", "desviacion", "desvio",
))  # fmt: skip
#: These too, if one side is a constant.  That of two variables may be an elapsed count.
_FROM_CONSTANT: Final = frozenset(("diff", "difference", "differenz", "diferencia"))
#: Ends of a range, from which the rest is not below 0: per cent and the like; full scales are one less than these.
_ENDS: Final = frozenset((100, 1000, 10000, 180, 360, *(1 << n for n in range(17))))


def check_error_signs(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the unsigned differences that become a wider or a floating number with the name of one with a sign."""
    for module in modules:
        for function in module.functions:
            for s in statements(function.body):
                given = gives(s)
                if given is None:
                    continue
                target, value = given
                words = words_of(_name(target))
                found = _widened(value) if (_SIGNED | _FROM_CONSTANT).intersection(words) else None
                if found is None or _compared(function, found):
                    continue
                left = bare(found.left)
                if isinstance(left, Const) and not _ENDS.isdisjoint((left.value, left.value + 1)):
                    continue
                if _SIGNED.intersection(words) or isinstance(left, Const):
                    text = source_text(found)
                    message = (
                        f"{text} is unsigned and has {_bits(found.ctype)} bits: below 0 it wraps, before it becomes "
                        f"{value.ctype}"
                    )
                    reports[module].report(function, s.where, "widened-late", message, object=text)


def _name(target: LValue) -> str:
    return target.text.rsplit(".", 1)[-1].rsplit("->", 1)[-1] or (
        target.root.declaration.name if isinstance(target.root, Variable) else ""
    )


def _bits(ctype: CType) -> int:
    return ctype.bits if isinstance(ctype, IntType) else 0


def _widened(value: Expr) -> Binary | None:
    """The difference of unsigned numbers, one of them read, that is all of a value of a wider type with a sign."""
    match value:
        case Convert(
            ctype=FloatType() | IntType(signed=True) as to, operand=Binary(op="-", ctype=IntType(signed=False)) as e
        ) if isinstance(to, FloatType) or to.bits > _bits(e.ctype):  # fmt: skip
            pass
        case _:
            return None
    sides = (bare(e.left), bare(e.right))
    plain = all(isinstance(side, Const | Load) for side in sides)
    return e if plain and isinstance(sides[1], Load) else None


def _compared(function: Function, difference: Binary) -> bool:
    """Whether a function compares the two sides, or the read one with any number: then it may know which is greater."""
    sides = {source_text(side) for side in (bare(difference.left), bare(difference.right))}
    for p in within(function.body):
        if isinstance(p, Compare):
            texts = {source_text(q) for e in (p.left, p.right) for q in parts(e) if isinstance(q, Const | Load)}
            if source_text(bare(difference.right)) in texts and (sides <= texts or p.op not in ("==", "!=")):
                return True
    return False
