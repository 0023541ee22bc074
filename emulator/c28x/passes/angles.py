"""Static check of differences of two headings that are not brought back into one turn: `angle-unwrapped`.

    heading = wrap(heading + rate * PERIOD_S);
    error = wanted - heading;                   /* wrap(wanted - heading) */
    turn = KP * error;

A function of the file brings an angle back into -180 to 180 degrees, or -pi to pi, and the measured heading is what it
returns.  The error of a regulator is the difference of two such angles, and is multiplied as it is.

Silent where the error is compared, changed, divided, returned, or passed to any function: that may wrap it.  What has
its value from the error may go to a function, as the output of a regulator does, but not into an object of the file, a
whole number, or a function that calculates sines or rounds.  Silent too if the wanted angle is a constant, a copy of
the heading, or comes from a function; if the wanted angle is compared anywhere; and about angles that do not go round:
by their names only a heading or a yaw does, and it adds up by itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import isclose, pi
from typing import Final

from emulator.c28x.ctypes import FloatType
from emulator.c28x.passes.declared import words_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Convert,
    Declaration,
    Declare,
    Expr,
    Function,
    Load,
    LValue,
    Return,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    addressed,
    assigned,
    bare,
    gives,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
)

#: Half a turn in degrees and in radians.
_HALF: Final = (180.0, pi)
#: Words of angles that go round, and of the error of a regulator, in English, German and Spanish.
_ROUND: Final = frozenset(("heading", "yaw", "course", "compass", "kurs", "rumbo"))
_ERROR: Final = frozenset((
    "error", "err", "deviation", "diff", "difference", "fehler", "abweichung", "regelabweichung", "differenz",
    "desviacion", "diferencia",
))  # fmt: skip
#: Parts of the names of functions whose results are the same for a whole turn more, or that count whole turns.
_CIRCLE: Final = ("sin", "cos", "tan", "mod", "rem", "round", "rint", "floor", "ceil", "trunc")


def check_angles(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the differences of headings that are used as they are."""
    for module in modules:
        wraps = {function for function in module.functions if _wraps(function)}
        if not wraps or any(_turns(f) for f in module.functions if f not in wraps):
            continue
        kept, moving = _angles(module, wraps)
        for function in module.functions:
            for s in statements(function.body) if function not in wraps else ():
                found = _difference(s)
                if found is None:
                    continue
                target, value, sides = found
                names = [side.declaration for side in sides]
                if kept.keys() & set(names) and moving.issuperset(names) and _used_as_it_is(function, s, target, wraps):
                    name = next(name for name in names if name in kept)
                    text = source_text(value)
                    message = (
                        f"{text} is not brought back into one turn, as {kept[name].name} does with {name.name}: where "
                        "one of the two angles wraps, it is a whole turn too large"
                    )
                    reports[module].report(function, s.where, "angle-unwrapped", message, object=text)


def _wraps(function: Function) -> bool:
    """Whether a function adds or subtracts a turn where its only parameter is beyond half a turn."""
    if len(function.parameters) != 1 or not isinstance(function.ctype.result, FloatType):
        return False
    nodes = list(within(function.body))
    for half in _HALF:
        steps = {
            p.op for p in nodes
            if isinstance(p, Binary) and p.op in ("+", "-") and _is(p.right, 2 * half) and not _is(p.left, 2 * half)
        }  # fmt: skip
        ends = any(isinstance(p, Compare) and (_is(p.right, half) or _is(p.left, half)) for p in nodes)
        if steps == {"+", "-"} and ends:
            return True
    return False


def _turns(function: Function) -> bool:
    """Whether a turn or half of one is a floating constant in a function, or a floating number is compared with it.

    It may bring an angle back.  A whole number that is compared with 180 is an order whose range is tested.
    """
    for p in within(function.body):
        sides: tuple[Expr, ...] = ()
        match p:
            case Const(ctype=FloatType()):
                sides = (p,)
            case Binary(op="+" | "-", left=left, right=right):
                sides = (left, right)
            case Compare(left=left, right=right) if any(isinstance(bare(e).ctype, FloatType) for e in (left, right)):
                sides = (left, right)
        if any(_is(side, n * half) for side in sides for half in _HALF for n in (1, 2)):
            return True
    return False


def _is(e: Expr, number: float) -> bool:
    inner = bare(e)
    return isinstance(inner, Const) and isclose(abs(inner.value), number, rel_tol=1e-3)


def _angles(module: Module, wraps: set[Function]) -> tuple[dict[Declaration, Function], set[Declaration]]:
    """The headings that such a function keeps in one turn -> the function; what is set to anything but constants.

    What is set to a sum with a heading, or with a result of a function, may be near a heading beyond its range.  What
    is compared anywhere may have a range of its own.
    """
    kept: dict[Declaration, Function] = {}
    others: set[Declaration] = set()
    moving: set[Declaration] = set()
    near: set[Declaration] = set()
    compared: set[Declaration] = set()
    for function in module.functions:
        others |= {v.declaration for v in addressed(within(function.body))}
        for p in within(function.body) if function not in wraps else ():
            if isinstance(p, Compare):
                compared |= {v.declaration for e in (p.left, p.right) for v in _read(e)}
        for s in statements(function.body):
            if (v := assigned(s)) is None:
                continue
            value = bare(s.value) if isinstance(s, Assign | Declare) and isinstance(s.value, Expr) else None
            match value:
                case Call(function=called) as call if called in wraps:
                    if not _ROUND.intersection(words_of(v.declaration.name)) or v not in _read(call):
                        others.add(v.declaration)
                    kept[v.declaration] = called
                    moving.add(v.declaration)
                case Const():
                    pass
                case Load(lvalue=LValue(root=Variable() as root)) if _ROUND.intersection(
                    words_of(root.declaration.name)
                ):
                    others.add(v.declaration)  # a copy of a heading: that of the step before, or one to hold
                case Expr():
                    others.add(v.declaration)
                    moving.add(v.declaration)
                    calls = (p for p in parts(value) if isinstance(p, Call))
                    result = any(p.arguments or not p.function.extern for p in calls)
                    if result or any(_ROUND.intersection(words_of(r.declaration.name)) for r in _read(value)):
                        near.add(v.declaration)
    return {name: by for name, by in kept.items() if name not in others}, moving - near - compared


def _difference(s: Stmt) -> tuple[Variable, Expr, list[Variable]] | None:
    """The error that a statement gives the difference of two objects, with the two."""
    match gives(s):
        case LValue(root=Variable(kind="local", ctype=FloatType()) as target, indices=[]), value:
            named = _ERROR.intersection(words_of(target.declaration.name))
        case _:
            return None
    match bare(value):
        case Binary(op="-", left=left, right=right) as difference if named:
            sides = [v for v in map(_value_of, (left, right)) if v is not None]
            return (target, difference, sides) if len(sides) == 2 else None
    return None


def _value_of(e: Expr) -> Variable | None:
    """The floating object of which an expression is just the value."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(ctype=FloatType()) as v, indices=[])):
            return v
    return None


def _used_as_it_is(function: Function, given: Stmt, error: Variable, wraps: set[Function]) -> bool:
    """Whether a function multiplies an error, and does nothing with it that may bring it back into one turn."""
    multiplied = False
    sides = {p.root for p in own_nodes(given) if isinstance(p, LValue) and p.root is not error}
    #: What has its value from the error.
    after = {error}
    for s in statements(function.body):
        match gives(s):
            case LValue(root=Variable() as root), value if s is not given and not after.isdisjoint(_read(value)):
                if root is error or root.kind == "global":
                    return False
                after.add(root)
    for s in statements(function.body):
        if s is not given and isinstance(s, Assign) and assigned(s) is error:
            return False
        if isinstance(s, Return) and isinstance(s.value, Expr) and not after.isdisjoint(_read(s.value)):
            return False
        for p in own_nodes(s):
            match p:
                case AddressOf(lvalue=LValue(root=Variable() as taken)) if taken in after:
                    return False
                case Call(function=called, arguments=arguments, extra=extra):
                    if any(part in called.name.lower() for part in _CIRCLE):
                        return False
                    read = {v for e in (*arguments, *extra) for v in _read(e)}
                    if error in read or (called in wraps and not after.isdisjoint(read)):
                        return False
                case CallPointer(arguments=arguments) if any(not after.isdisjoint(_read(e)) for e in arguments):
                    return False
                case Compare(left=left, right=right) if error in {*_read(left), *_read(right)}:
                    return False
                case Conditional() if error in _read(p):
                    return False
                case Convert(ctype=ctype) if not isinstance(ctype, FloatType) and not after.isdisjoint(_read(p)):
                    return False
                case Binary(op="/") if error in _read(p):
                    return False
                case Binary(op="-", left=left, right=right) if s is not given:
                    if {_value_of(left), _value_of(right)} == sides:
                        return False
                case Binary(op="*", left=left, right=right) if error in {_value_of(left), _value_of(right)}:
                    multiplied = True
    return multiplied


def _read(e: Expr) -> Iterator[Variable]:
    """The objects that an expression reads."""
    return (p.lvalue.root for p in parts(e) if isinstance(p, Load) and isinstance(p.lvalue.root, Variable))
