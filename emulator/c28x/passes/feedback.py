"""Pass `feedback`: regulators whose error has the wrong sign, by the names of what they compare.

    error = speed - target;                 // target - speed
    integral += error * KI;
    duty = error * KP + integral;

The error is the measured value less the wanted one, and the output grows with it: the further the speed is above the
target, the more the motor gets.  Whether it does any harm is seen when the program runs: the running code counts how
long the error stays on one side of 0, and whether it becomes smaller (`Runtime.error_side`).

Names say which operand is the wanted value, and that the other one is of a quantity that an output raises: a speed, a
voltage, a current, a pressure.  A temperature can be lowered by a fan, a level by a valve: they are not judged, nor is
what a name calls a brake, a sink or a panel.

None is a regulator without an integral, or one whose error, integral or output is subtracted anywhere behind, in
functions that it is passed to and in those that call the regulator.

The result are the differences, by the identity of their expressions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.declared import words_of
from emulator.c28x.passes.signs import SignedWord
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.passes.wind_up import limited_operand
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Convert,
    Declare,
    Expr,
    Function,
    Load,
    LValue,
    Return,
    Stmt,
    Unary,
    Variable,
)
from emulator.c28x.tree_queries import all_blocks, bare, gives, once, own_nodes, parts, source_text, statements, within

#: Words that say that a value is the wanted one; `set` and `point` count together.
_WANTED: Final = frozenset((
    "ref", "reference", "setpoint", "target", "wanted", "desired", "demand", "demanded", "command", "commanded", "cmd",
    "goal",
))  # fmt: skip
#: Quantities, and their units, that the output of a regulator raises.
_RAISED: Final = frozenset((
    "speed", "velocity", "omega", "rpm", "voltage", "volt", "volts", "vout", "mv", "current", "amps", "iout", "ma",
    "torque", "force", "pressure", "mbar", "bar", "kpa", "flow",
))  # fmt: skip
#: Words of what lowers a quantity: the regulator of which one is a name may have this error.
_LOWERING: Final = frozenset((
    "cool", "cooler", "cooling", "brake", "braking", "chopper", "bleed", "sink", "drain", "discharge", "exhaust",
    "vent", "relief", "vacuum", "suction", "regen", "dump", "shunt", "inverse", "inverted", "reverse",
))  # fmt: skip
#: Words for what an output may lower, or for other meanings of the words above (the current temperature).
_LOWERED: Final = frozenset((
    "temp", "temperature", "celsius", "degc", "level", "humidity", "light", "position", "angle", "pos", "phase",
    "load", "panel", "solar", "pv", "mppt", "vin", "vpv", "input", "in", "droop", "field", "weakening", "mode", "state",
))  # fmt: skip

_Is = Callable[[Any], bool]


class _Error(NamedTuple):
    """The difference of a regulator, what its value is in the function, and the statements that can have it."""

    difference: Binary
    is_error: _Is
    scope: list[Stmt]


def reversed_errors(functions: Iterable[Function]) -> dict[int, SignedWord]:
    """The differences that are the measured value less the wanted one, of regulators whose output grows with them."""
    functions = list(functions)
    found: dict[int, SignedWord] = {}
    for function in functions:
        for error in _errors(function):
            if (integral := _integral(function, error)) and not _turned(functions, error):
                use = f"the measured value less the wanted one, and {integral} grows with it"
                found[id(error.difference)] = SignedWord(0, use, "error-side")
    return found


@once
def _has_errors(function: Function) -> bool:
    return any(isinstance(p, Binary) and p.op == "-" and _is_backwards(p) for p in within(function.body))


def _errors(function: Function) -> Iterator[_Error]:
    """The differences in a function whose names say that they are the measured value less the wanted one."""
    if not _has_errors(function):
        return
    body = list(statements(function.body))
    names = [function.name, *(target.text for s in body if (target := _target(s)) is not None)]
    names += [p.function.name for s in body for p in own_nodes(s) if isinstance(p, Call)]
    falls = (_LOWERED | _LOWERING).intersection(words_of(function.name))
    if falls or _LOWERING.intersection(words_of(" ".join(names))):
        return
    for n, s in enumerate(body):
        for p in own_nodes(s):
            if not isinstance(p, Binary) or p.op != "-" or not _is_backwards(p):
                continue
            if isinstance(p.ctype, IntType) and not p.ctype.signed:
                continue
            target, value = _target(s), getattr(s, "value", None)
            if target is not None and isinstance(value, Expr) and bare(value) is p:
                # Up to where the object takes something else, as the error of another regulator.
                end = next((m for m in range(n + 1, len(body)) if _target(body[m]) == target), len(body))
                yield _Error(p, _reads(target), body[n + 1 : end])
            else:
                yield _Error(p, _equal(p), body)


def _is_backwards(e: Binary) -> bool:
    measured, wanted = _named(e.left), _named(e.right)
    if not _is_wanted(wanted) or _is_wanted(measured) or not _RAISED.intersection(measured):
        return False
    return not (_LOWERED | _LOWERING).intersection((*measured, *wanted))


def _named(e: Expr) -> list[str]:
    """The words of the names of one object or member; empty: it is something else."""
    load = bare(e)
    return words_of(source_text(load)) if isinstance(load, Load) else []


def _is_wanted(words: list[str]) -> bool:
    return bool(_WANTED.intersection(words)) or {"set", "point"} <= set(words)


def _integral(function: Function, error: _Error) -> str:
    """The integral of the regulator that adds the error to it, and it to the scaled error; "": there is none."""
    values = [(_target(s), s, value) for s in error.scope for value in _values(s)]
    everywhere = [value for s in statements(function.body) for value in _values(s)]
    if any(-1 in _ways(value, error.is_error) for _, _, value in values):
        return ""
    for target, added, value in values:
        if target is None or isinstance(added, Declare):
            continue
        is_sum = _reads(target)
        if _ways(value, error.is_error) != {1} or _ways(value, is_sum) != {1}:
            continue
        if any(-1 in _ways(other, is_sum) for other in everywhere):
            return ""
        for _, s, other in values:
            if s is not added and _ways(other, error.is_error) == {1} == _ways(other, is_sum):
                return source_text(Load(target.ctype, target))
    return ""


def _target(s: Stmt) -> LValue | None:
    """The number that a statement assigns to or declares."""
    given = gives(s)
    return given[0] if given is not None and isinstance(given[0].ctype, FloatType | IntType) else None


def _values(s: Stmt) -> Iterator[Expr]:
    """The values that a statement gives to an object, a register, a function or its caller."""
    match s:
        case Assign(value=value) | Declare(value=Expr() as value) | Return(value=Expr() as value):
            yield value
    for p in own_nodes(s):
        if isinstance(p, Call):
            yield from p.arguments


def _nothing(_: Any) -> bool:
    return False


def _equal(difference: Binary) -> _Is:
    """Whether an expression is the same difference, wherever it is written."""
    return lambda e: isinstance(e, Binary) and e == difference


def _reads(target: LValue) -> _Is:
    """Whether an expression is the value of an object."""
    return lambda e: isinstance(e, Load) and e.lvalue == target


def _ways(e: Expr, is_it: _Is) -> set[int]:
    """With which signs a value depends on another one: 1, -1, or 0 if it is not known.

    Factors without a sign of their own, such as gains, count as positive.
    """
    if is_it(e):
        return {1}
    match e:
        case Convert(operand=operand):
            return _ways(operand, is_it)
        case Unary(op="-", operand=operand):
            return {-way for way in _ways(operand, is_it)}
        case Binary(op="+", left=left, right=right):
            return _ways(left, is_it) | _ways(right, is_it)
        case Binary(op="-", left=left, right=right):
            return _ways(left, is_it) | {-way for way in _ways(right, is_it)}
        case Binary(op="*" | "/" | "<<" | ">>" as op, left=left, right=right):
            for value, factor in ((left, right), (right, left)) if op == "*" else ((left, right),):
                if ways := _ways(value, is_it):
                    if _ways(factor, is_it):
                        return {0}
                    return {way * _sign(bare(factor)) for way in ways}
    limited = limited_operand(e)
    if limited is not None:
        return _ways(limited, is_it)
    return {0} if any(is_it(p) for p in parts(e)) else set()


def _sign(factor: Expr) -> int:
    """The sign of a constant; 1 for an object, 0 if it begins with a negative value."""
    match factor:
        case Const(value=value):
            return -1 if value < 0 else 1
        case Load(lvalue=LValue(root=Variable(initial=list() as initial), leaf=leaf)) if leaf < len(initial):
            start = bare(initial[leaf])
            return 0 if isinstance(start, Const | Unary) and (isinstance(start, Unary) or start.value < 0) else 1
    return 1


def _turned(functions: list[Function], error: _Error) -> bool:
    """Whether anything that depends on the error is subtracted from something: this may turn the sign."""
    keys: set[Key] = set()
    returning: set[str] = set()
    constant = {number for function in functions for number in _constants(function)}

    def depends(e: Any) -> bool:
        match e:
            case Load(lvalue=lvalue):
                return key_of(lvalue) in keys
            case Call(function=function):
                return function.path in returning
        return False

    for s in error.scope:
        for value in _values(s):
            if any(error.is_error(p) for p in parts(value)) and (target := _target(s)) is not None:
                own = key_of(target)
                keys |= {own} if own is not None else set()
    while True:
        before = len(keys), len(returning)
        for function in functions:
            for s in statements(function.body):
                direct = error.is_error if any(s is each for each in error.scope) else _nothing
                for p in own_nodes(s):
                    if isinstance(p, Call) and limited_operand(p) is None:  # else it is what it limits
                        given = zip(p.function.parameters, p.arguments, strict=False)
                        passed = [v for v, a in given if any(depends(x) or direct(x) for x in parts(a))]
                        keys |= {(v, 0) for v in passed}
                taken = getattr(s, "value", None)
                if id(s) in constant or not isinstance(taken, Expr) or not any(depends(x) for x in parts(taken)):
                    continue
                if isinstance(s, Return):
                    returning.add(function.path)
                elif (found := gives(s)) is not None and (key := key_of(found[0])) is not None:
                    keys.add(key)
        if (len(keys), len(returning)) == before:
            break
    for function in functions:
        values = [value for s in statements(function.body) for value in _values(s)]
        if any(any(depends(x) for x in parts(value)) for value in values):
            sizes = _taken_by_sign(function)
            if any(_negated(value, depends, sizes) for value in values):
                return True
    return False


def _constants(function: Function) -> Iterator[int]:
    """The identities of the statements that hand a constant on: the second of `a = 0; b = a;`, for `b = a = 0`."""
    for block in all_blocks(function.body):
        given: LValue | None = None
        for s in block:
            if not isinstance(s, Assign) or not isinstance(s.target, LValue):
                given = None
                continue
            value = bare(s.value)
            handed_on = given is not None and isinstance(value, Load) and value.lvalue == given
            if handed_on:
                yield id(s)
            given = s.target if handed_on or isinstance(value, Const) else None


def _taken_by_sign(function: Function) -> list[Expr]:
    """What a function compares with 0: it takes its size, or looks which way a motor has to turn."""
    compared = (
        (bare(p.left), bare(p.right)) for s in statements(function.body) for p in own_nodes(s)
        if isinstance(p, Compare)
    )  # fmt: skip
    return [left for left, right in compared if isinstance(right, Const) and right.value == 0]


def _negated(e: Expr, is_it: _Is, sizes: list[Expr]) -> bool:
    """Whether a part of a value is the negative, the complement or a difference of what depends on the error."""
    for p in parts(e):
        match p:
            case Binary(op="-", right=operand):
                pass
            case Binary(op="*", left=operand, right=Const(value=factor)) if factor < 0:
                pass
            case Unary(operand=operand) if bare(operand) not in sizes:
                pass
            case _:
                continue
        if any(is_it(x) for x in parts(operand)):
            return True
    return False
