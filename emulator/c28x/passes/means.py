"""Static check of sums of readings of the ADC that 16 bits do not hold: `unsigned-wrap`.

    static Uint16 sum;
    sum += AdcaResultRegs.ADCRESULT0;
    if (++count == 256)
        zero = (float)sum / 256.0f;

The number of readings that ends the count, or the loop, is also what the sum, or a copy of it, is divided by; the sum
times a number (`block.sum * VREF_MV / (4096 * 64)`) by a multiple of it.  Each reading has up to 12
bits.  Silent up to 32 readings: then only voltages in the upper half of the range do not fit.  Silent if a statement
does anything else with the sum than to add readings, to set it to a constant and to read it, or takes its bits.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Compare,
    Const,
    Continue,
    Declare,
    Expr,
    For,
    Function,
    If,
    Jump,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Unary,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    added,
    all_blocks,
    bare,
    given_values,
    gives,
    named_scalar,
    own_nodes,
    parts,
    statements,
    within,
)

_RESULT: Final = re.compile(r"ADCRESULT\d+")
#: The block in which the 12 bits of a reading are the upper ones (TMS320x2833x).
_LEFT: Final = "AdcRegs"
#: The largest reading.
_MOST: Final = 4095
#: Divisors that only make a voltage of a reading, or of a sum.
_SCALES: Final = (4096, 65536)
#: CHOICE: with so many readings, less than half of the range is enough to wrap.
_LEAST: Final = 33
#: CHOICE: how often a sum is copied on: to a structure, from there to the caller's, from there to a local.
_COPIES: Final = 3


class _Sum(NamedTuple):
    """A statement that adds a reading to a sum, and how often it does so."""

    function: Function
    statement: Stmt
    total: NamedScalar
    readings: int
    #: What counts the readings; None: the loop.
    counter: NamedScalar | None


def check_means(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the sums of as many readings as they are divided by, if 16 bits do not hold them."""
    owners = {function: reports[module] for module in modules for function in module.functions}
    whole = any(function.name == "main" and function.body for function in owners)
    for one in [found for function in owners for found in _sums(function)]:
        holder, _ = one.total
        counted = one.counter is None or (isinstance(one.counter[0], Variable) and one.counter[0].static)
        alone = isinstance(holder, Variable) and (holder.kind != "global" or (holder.static and counted))
        if one.readings < _LEAST or not (alone or whole):
            continue
        kept = _kept(one, owners)
        if not _only_adds(one, owners, kept):
            continue
        at = next((s for function in owners for s in statements(function.body) if _divides(s, one, kept)), None)
        if at is not None and isinstance(one.statement, Assign) and isinstance(one.statement.target, LValue):
            name = one.statement.target.text
            message = (
                f"{name} adds {one.readings} readings of up to {_MOST}, which line {at.where.line} divides by as "
                f"many: 16 bits hold a mean of {0xFFFF // one.readings} at most"
            )
            owners[one.function].report(one.function, one.statement.where, "unsigned-wrap", message, object=name)


def _sums(function: Function) -> Iterator[_Sum]:
    """The statements of a function that add a reading to a word, as often as a constant says."""
    loops = {id(s.body): s for s in statements(function.body) if isinstance(s, For)}
    for block in all_blocks(function.body):
        for s in block:
            value = added(s)
            target = s.target if isinstance(s, Assign) else None
            if value is None or not isinstance(target, LValue) or not _is_reading(value, function):
                continue
            total = named_scalar(target)
            if total is None or not isinstance(target.ctype, IntType) or target.ctype.signed or target.ctype.bits != 16:
                continue
            loop = loops.get(id(block))
            if loop is not None:
                start, stop = constant_of(loop.start), constant_of(loop.stop)
                if start == 0 and stop is not None and loop.step == 1 and not any(map(_jumps, statements(block))):
                    yield _Sum(function, s, total, stop, None)
                continue
            counted = _counted(block)
            if counted is not None:
                yield _Sum(function, s, total, counted[1], counted[0])


def _jumps(s: Stmt) -> bool:
    return isinstance(s, Break | Continue | Jump | Return)


def _is_reading(e: Expr, function: Function) -> bool:
    """Whether an expression is all of a result of the ADC, or a local that gets nothing else."""
    match bare(e):
        case RegisterLoad(register=RegisterRef(block=block, register=register)):
            return block.startswith("Adc") and _RESULT.fullmatch(register) is not None
        case Binary(op="&", left=left, right=right):
            mask = constant_of(right)
            return mask is not None and mask & _MOST == _MOST and _is_reading(left, function)
        case Binary(op=">>", left=left, right=right):
            match bare(left):
                case RegisterLoad(register=RegisterRef(block=block)):
                    return block == _LEFT and constant_of(right) == 4 and _is_reading(left, function)
        case Load(lvalue=LValue(root=Variable(kind="local" | "temporary") as local, indices=[])):
            values = [value for target, value in given_values(function.body) if target.root is local]
            pointed = any(isinstance(p, AddressOf) and p.lvalue.root is local for p in within(function.body))
            own = any(isinstance(p, Load) and p.lvalue.root is local for value in values for p in parts(value))
            return bool(values) and not pointed and not own and all(_is_reading(value, function) for value in values)
    return False


def _counted(block: list[Stmt]) -> tuple[NamedScalar, int] | None:
    """The scalar that a block counts up by 1, and the number at which a test in the block ends the count."""
    steps: dict[NamedScalar, NamedScalar] = {}
    for s in block:
        match gives(s):
            case LValue() as target, Expr() as value:
                match bare(value):
                    case Binary(op="+", left=left, right=right) if constant_of(right) == 1:
                        before, to = bare(left), named_scalar(target)
                        count = named_scalar(before.lvalue) if isinstance(before, Load) else None
                        if count is not None and to is not None:
                            steps[to] = count
        match s:
            case If(test=Compare(op="==" | ">=", left=left, right=right)):
                side, limit = bare(left), constant_of(right)
                named = named_scalar(side.lvalue) if isinstance(side, Load) else None
                if named in steps and limit is not None:
                    return steps[named], limit
    return None


def _kept(one: _Sum, functions: Iterable[Function]) -> set[NamedScalar]:
    """The sum, and the scalars that get it as it is."""
    kept = {one.total}
    copies = [(named_scalar(target), bare(value)) for f in functions for target, value in given_values(f.body)]
    for _ in range(_COPIES):
        kept |= {
            to for to, value in copies
            if to is not None and isinstance(value, Load) and named_scalar(value.lvalue) in kept
        }  # fmt: skip
    return kept


def _only_adds(one: _Sum, functions: Iterable[Function], kept: set[NamedScalar]) -> bool:
    """Whether a program only adds to a sum, sets it back with its count, and does not take its bits."""
    for function in functions:
        for block in all_blocks(function.body):
            cleared = [s for s in block if _target(s) == one.total and s is not one.statement]
            if any(not isinstance(s, Assign | Declare) or constant_of(s.value) is None for s in cleared):
                return False
            if cleared and one.counter is not None and not any(_target(s) == one.counter for s in block):
                return False
            inside = block if one.counter is None and one.statement in block else []
            if any(_target(s) == one.total for s in statements(inside) if s is not one.statement):
                return False
            if one.counter is not None and any(_changes_count(s, one.counter) for s in block):
                return False
        for p in within(function.body):
            match p:
                case AddressOf(lvalue=lvalue) if named_scalar(lvalue) in (one.total, one.counter):
                    return False
                case Binary(op="&" | "|" | "^", left=left, right=right) if _is(left, kept) or _is(right, kept):
                    return False
                case Unary(op="~", operand=operand) if _is(operand, kept):
                    return False
    return True


def _target(s: Stmt) -> NamedScalar | None:
    given = gives(s)
    return named_scalar(given[0]) if given is not None else None


def _changes_count(s: Stmt, count: NamedScalar) -> bool:
    """Whether a statement gives a count anything but a constant, or the next number."""
    match gives(s):
        case LValue() as target, value if named_scalar(target) == count:
            step = added(s)
            kept = bare(value)
            root = kept.lvalue.root if isinstance(kept, Load) else None
            temporary = isinstance(root, Variable) and root.kind == "temporary"
            return not (constant_of(value) is not None or temporary or (step is not None and constant_of(step) == 1))
    return False


def _divides(s: Stmt, one: _Sum, kept: set[NamedScalar]) -> bool:
    """Whether a statement divides a sum by the number of its readings; or the sum times a number by a multiple."""
    for p in own_nodes(s):
        match p:
            case Binary(op="/", left=left, right=right) if _is(left, kept):
                by = bare(right)
                if isinstance(by, Const) and by.value == one.readings:
                    return True
            case Binary(op="/", left=left, right=right) if _is_scaled(left, kept):
                by = bare(right)
                if isinstance(by, Const) and by.value not in _SCALES and by.value and by.value % one.readings == 0:
                    return True
            case Binary(op=">>", left=left, right=right) if _is(left, kept):
                if 1 << (constant_of(right) or 0) == one.readings:
                    return True
            case Binary(op="*", left=left, right=right) if _is(left, kept):
                by = bare(right)
                if isinstance(by, Const) and abs(by.value * one.readings - 1) < 1e-6:
                    return True
    return False


def _is_scaled(e: Expr, kept: set[NamedScalar]) -> bool:
    """Whether an expression is a sum times a number."""
    match bare(e):
        case Binary(op="*", left=left, right=right):
            return (_is(left, kept) and isinstance(bare(right), Const)) or (
                _is(right, kept) and isinstance(bare(left), Const)
            )
    return False


def _is(e: Expr, kept: set[NamedScalar]) -> bool:
    inner = bare(e)
    return isinstance(inner, Load) and named_scalar(inner.lvalue) in kept
