"""What is used as a number: a sum or a count that must not have lost its upper bits.

A number is divided, shifted to the right by a few bits, or becomes a float; or it is copied to an object that is.  A
check sum, a hash and a stamp are masked, turned over, compared for equality or subtracted.  A phase that wraps on
purpose may become a float, too, but nobody takes it and then begins again at 0, as with a sum.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Any, Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.tree import (
    Assign,
    Binary,
    Compare,
    Const,
    Convert,
    Declare,
    Evaluate,
    Expr,
    Function,
    Load,
    LValue,
    Stmt,
    Unary,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    bare,
    blocks,
    given_values,
    named_scalar,
    once,
    own_nodes,
    statements,
    within,
)

#: The quotient that takes a word's octets apart.
_OCTET: Final = 256
#: CHOICE: a shift by more divides no sum, but selects the upper bits of a phase or a check sum.
_MEAN: Final = 4


def used_as_numbers(functions: Sequence[Function]) -> set[NamedScalar]:
    """The scalars whose value is a number wherever it goes."""
    uses = [_uses(function) for function in functions]
    found = set[NamedScalar]().union(*(numbers for numbers, _, _ in uses))
    bits = set[NamedScalar]().union(*(bits for _, bits, _ in uses))
    copies = [copy for _, _, own in uses for copy in own]
    grown = True
    while grown:
        more = {read for to, read in copies if to in found} - found
        found |= more
        grown = bool(more)
    return found - bits


@once
def _uses(function: Function) -> tuple[set[NamedScalar], set[NamedScalar], list[tuple[NamedScalar, NamedScalar]]]:
    """The scalars that a function takes for numbers, and for bits; its copies of one scalar to another."""
    numbers: set[NamedScalar] = set()
    bits: set[NamedScalar] = set()
    for p in within(function.body):
        _use(p, numbers, bits)
    copies = [
        (to, read) for target, value in given_values(function.body)
        if (to := named_scalar(target)) is not None and (read := _scalar(value)) is not None
    ]  # fmt: skip
    return numbers, bits, copies


def sums_of_samples(functions: Sequence[Function], numbers: Set[NamedScalar]) -> set[int]:
    """The assignments that add a sample to an unsigned sum of 16 bits: a number that is taken and then begins again."""
    sums = [_sums(function) for function in functions]
    again = set[NamedScalar]().union(*(taken for taken, _ in sums))
    return {identity for _, added in sums for identity, named in added.items() if named in numbers and named in again}


@once
def _sums(function: Function) -> tuple[set[NamedScalar], dict[int, NamedScalar]]:
    """The scalars that a function takes and sets to 0; the assignments in it that add to a scalar."""
    every = statements(function.body)
    again = set[NamedScalar]().union(*map(_taken, [function.body, *(b for s in every for b in blocks(s))]))
    added: dict[int, NamedScalar] = {}
    for s in every:
        match s:
            case Assign(
                target=LValue(ctype=IntType(signed=False, bits=16)) as target,
                value=Binary(op="+", left=Load(lvalue=before), right=right),
            ) if before == target and not _signed(right) and (named := named_scalar(target)):
                added[id(s)] = named
    return again, added


def _taken(block: list[Stmt]) -> set[NamedScalar]:
    """The scalars that a block reads, and then sets to 0."""
    read: set[NamedScalar] = set()
    found: set[NamedScalar] = set()
    for s in block:
        match s:
            case Assign(target=LValue() as target, value=Const(value=0)):
                named = named_scalar(target)
                if named is not None and named in read:
                    found.add(named)
            case Assign(target=LValue() as target):
                own = named_scalar(target)
                read |= {n for n in _read(s) if n is not None and n != own}
            case Assign() | Declare() | Evaluate():
                read |= {n for n in _read(s) if n is not None}
    return found


def _read(s: Stmt) -> set[NamedScalar | None]:
    return {named_scalar(p.lvalue) for p in own_nodes(s) if isinstance(p, Load)}


def _signed(e: Expr) -> bool:
    """Whether a step is a constant, or a signed number that a cast made unsigned: it may go back."""
    while isinstance(e, Convert):
        if e.explicit and isinstance(e.operand.ctype, IntType) and e.operand.ctype.signed:
            return True
        e = e.operand
    return isinstance(e, Const)


def _scalar(e: Expr) -> NamedScalar | None:
    """The scalar that an expression reads and nothing else."""
    inner = bare(e)
    return named_scalar(inner.lvalue) if isinstance(inner, Load) else None


def _use(p: Any, numbers: set[NamedScalar], bits: set[NamedScalar]) -> None:
    """Note what an expression says of the scalars that it takes."""
    match p:
        case Binary(op="/", left=left, right=right):
            _note(bits if isinstance(right, Const) and right.value == _OCTET else numbers, left)
        case Binary(op=">>", left=left, right=Const(value=count)):
            _note(numbers if count <= _MEAN else bits, left)
        case Convert(ctype=FloatType(), operand=operand):
            _note(numbers, operand)
        case Binary(op="&" | "|" | "^", left=left, right=right):
            _note(bits, left, right)
        case Unary(op="~", operand=operand):
            _note(bits, operand)
        case Compare(op="==" | "!=", left=left, right=right) if not (
            isinstance(left, Const) or isinstance(right, Const)
        ):  # fmt: skip
            _note(bits, left, right)


def _note(found: set[NamedScalar], *operands: Expr) -> None:
    found.update(named for named in map(_scalar, operands) if named is not None)
