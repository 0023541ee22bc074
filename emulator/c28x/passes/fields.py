"""Fields of one word: an OR of objects that constants shift to the left, whose bits must not meet.

A pair can meet if the bounds of its lower field leave it bits above its place.  No fields are: masks (`x & ~0xF0`),
flags (an object that some statement ORs into), registers, two terms at the same place, and two terms of the same object
(`x | x << 1`).  A constant is one only for a negative number that is widened below it.
"""

from __future__ import annotations

from collections.abc import Set
from typing import Any, Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.intervals import bounds_of
from emulator.c28x.tree import Assign, Binary, Call, Const, Convert, Expr, Function, Load, LValue
from emulator.c28x.tree_queries import NamedScalar, bare, children, named_scalar, of_all, source_text, statements

#: CHOICE: a word of two bitmaps that may meet (a picture, keys) shifts by less.  With three fields any shift counts.
_FIELD: Final = 4
_COMPUTED: Final = ("+", "-", "*", "/", "%", ">>")


@of_all
def flag_scalars(function: Function) -> set[NamedScalar]:
    """The scalars into which some statement ORs something: flags."""
    found: set[NamedScalar] = set()
    for s in statements(function.body):
        match s:
            case Assign(target=LValue() as target, value=value) if (named := named_scalar(target)) is not None:
                whole = bare(value)
                if isinstance(whole, Binary) and any(_loads(term, target) for term in or_terms(whole)):
                    found.add(named)
    return found


def or_terms(e: Binary) -> list[Expr]:
    """The terms of a chain of ORs of one type; `e` alone if it is none."""
    if e.op != "|":
        return [e]
    return [
        term for side in (e.left, e.right)
        for term in (or_terms(side) if isinstance(side, Binary) and side.ctype == e.ctype else [side])
    ]  # fmt: skip


def shift_of(term: Expr) -> int:
    """The constant by which a term is shifted to the left."""
    match bare(term):
        case Binary(op="<<", right=Const(value=int(count))):
            return count
    return 0


def meeting(e: Binary, flags: Set[NamedScalar], assigned: LValue | None) -> list[tuple[int, int]]:
    """The pairs of terms (lower, upper) of an OR that may have a bit in common and are not meant to.

    `assigned`: the object that gets the result.
    """
    terms = or_terms(e)
    shifts = [shift_of(term) for term in terms]
    several = len(set(shifts) - {0}) > 1
    shifts = [shift or _place(term) for shift, term in zip(shifts, terms, strict=True)]
    pairs: list[tuple[int, int]] = []
    for lower, low in enumerate(shifts):
        if not any(shift > low for shift in shifts) or not _number(terms[lower], flags, assigned):
            continue
        for upper, high in enumerate(shifts):
            if (
                high > low and (several or high >= _FIELD) and _bits(terms[lower]) & _bits(terms[upper])
                and (not isinstance(bare(terms[upper]), Const) or _extended(terms[lower], low, high))
                and not _objects(terms[lower]) & _objects(terms[upper])
            ):  # fmt: skip
                pairs.append((lower, upper))
    return pairs


def _place(term: Expr) -> int:
    """The lowest bit of a constant term above the lower word; 0: there is none."""
    match bare(term):
        case Const(value=int(value)) if value > 0 and not value & 0xFFFF:
            return (value & -value).bit_length() - 1
    return 0


def _extended(term: Expr, low: int, high: int) -> bool:
    """Whether only the sign of a number reaches from bit `low` to bit `high`, where a constant is.

    A number that is large enough may have that bit, so that an OR with a constant only makes sure of it.
    """
    number = bare(term)
    if low and isinstance(number, Binary):
        number = bare(number.left)
    ctype = number.ctype
    return isinstance(ctype, IntType) and ctype.signed and ctype.bits + low <= high and bounds_of(number)[0] < 0


def _loads(term: Expr, target: LValue) -> bool:
    inner = bare(term)
    return isinstance(inner, Load) and inner.lvalue == target


def _number(term: Expr, flags: Set[NamedScalar], assigned: LValue | None) -> bool:
    """Whether a term is a number in a place of its own, and neither flags nor a mask."""
    inner = bare(term)
    if isinstance(inner, Binary) and inner.op == "<<" and isinstance(inner.right, Const):
        inner = bare(inner.left)
        if not isinstance(inner, Load):
            return not isinstance(inner, Const)
    match inner:
        case Load(lvalue=lvalue):
            return lvalue != assigned and named_scalar(lvalue) not in flags
        case Binary(op=op):
            return op in _COMPUTED
        case Call():
            return True
    return False


def _bits(e: Expr) -> int:
    """A mask of all bits that an integer may have, as its type holds them."""
    if not isinstance(e.ctype, IntType):
        return -1
    whole = (1 << e.ctype.bits) - 1
    low, high = bounds_of(e)
    within = (1 << high.bit_length()) - 1 if low >= 0 else whole
    match e:
        case Convert(operand=Expr(ctype=IntType()) as operand) if bounds_of(operand)[0] >= 0:
            return _bits(operand) & within
        case Binary(op="<<", left=left, right=Const(value=int(count))) if bounds_of(left)[0] >= 0:
            return _bits(left) << count & whole
        case Binary(op="<<", right=Const(value=int(count))):
            return whole >> count << count
        case Binary(op="&", left=left, right=right):
            return _bits(left) & _bits(right) & within
    return within


def _objects(e: Any) -> set[str]:
    """The texts of what is read in a term, apart from subscripts and pointers."""
    if isinstance(e, LValue):
        return set()
    read = {source_text(e)} if isinstance(e, Load | Call) else set()
    return read.union(*(_objects(inner) for inner in children(e)))
