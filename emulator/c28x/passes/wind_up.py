"""Pass `wind_up`: integrals of regulators that nothing limits, although their output is limited.

A regulator adds its error to an integral, and its output is a sum of the error, scaled, and of the integral, scaled:

    integral += ki * error;
    output = kp * error + integral;
    if (output > HIGH) output = HIGH;

The new integral may be in a local that is stored behind the limits, whether or not the output is at one of them.

While the output stands at its limit, such an integral goes on growing.  Whether it does is seen when the program runs:
the running code compares the integral's share of the output with the limit (`Guards`, `Runtime.regulator`).

None is an integral that a statement limits, that loses a part of itself (a filter), whose addend depends on the limited
output (back-calculation), or without a share of the same error beside it: an odometer, a clock, a meter of energy.

The result are the parts of regulators, by the identity of their expressions:

| kind | the value is |
|---|---|
| `sum` | the new integral |
| `share` | the integral's share of the output, before it is multiplied by `scale` |
| `output` | the output before it is limited |
| `limit` | the limited output |
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Set
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    Compare,
    Conditional,
    Const,
    Convert,
    Declare,
    Expr,
    Function,
    If,
    Jump,
    Load,
    LValue,
    Return,
    Stmt,
    Variable,
)
from emulator.c28x.tree_queries import assigned, bare, blocks, given_values, own_nodes, parts, statements, within

#: Functions of the libraries that limit a value, their first argument or any.
_LIMITERS: Final = frozenset({
    "fmin", "fmax", "fminf", "fmaxf", "fminl", "fmaxl", "__fmin", "__fmax", "__fsat", "_IQsat", "__IQsat", "__min",
    "__max", "__lmin", "__lmax",
})  # fmt: skip
#: Those that limit on both sides.
_BOTH: Final = frozenset({"__fsat", "_IQsat", "__IQsat"})
_ABOVE: Final = (">", ">=")
_SIDES: Final = frozenset({"high", "low"})


class RegulatorPart(NamedTuple):
    """A part of a regulator: its kind, the regulator, its integral's text, and the factor of a share.

    `side`: the sides on which nothing limits the integral.
    """

    kind: str
    regulator: str
    integral: str
    scale: float = 1.0
    side: str = ""


class IntegralSum(NamedTuple):
    """A statement that adds to an integral: its function, the integral, what is added, and the new value."""

    function: Function
    target: LValue
    key: Key
    addend: Expr
    value: Expr
    #: What holds the new value where the output is computed: the integral, or a local that is stored in it.
    held: Key


class OpenRegulator(NamedTuple):
    """A regulator whose integral nothing limits on some sides, although its output is limited."""

    added: IntegralSum
    #: `high` and `low`, as far as nothing limits the integral there.
    sides: frozenset[str]
    #: The values that the output gets at its limits.
    limited: list[Expr]
    parts: dict[int, RegulatorPart]


def wind_up(functions: Iterable[Function]) -> dict[int, RegulatorPart]:
    """The parts of the regulators whose integral nothing limits, by the identity of their expressions."""
    return {number: part for each in open_regulators(functions) for number, part in each.parts.items()}


def open_regulators(functions: Iterable[Function]) -> list[OpenRegulator]:
    """The regulators whose integral nothing limits, or not on both sides."""
    functions = list(functions)
    sums = [found for function in functions for found in integral_sums(function)]
    if not sums:
        return []
    keys = {key for found in sums for key in (found.key, found.held)}
    free = _unlimited(keys, functions, {id(found.value) for found in sums})
    sides = [(each, frozenset(free[each.key] & free[each.held])) for each in sums]
    found = [regulator_of(each, free_sides) for each, free_sides in sides if free_sides]
    return [each for each in found if each is not None]


def integral_sums(function: Function, lasting: Set[Variable] = frozenset()) -> Iterator[IntegralSum]:
    """The statements of a function that add to an object which outlasts it, also in a local that is stored there.

    `lasting`: locals that are taken for such objects.
    """
    stored = _stored_locals(function)
    for target, value in given_values(function.body):
        held, summed = key_of(target), bare(value)
        target = stored.get(held or (), target)
        key, ctype = key_of(target), target.ctype
        signed = isinstance(ctype, FloatType) or (isinstance(ctype, IntType) and ctype.signed)
        passing = isinstance(target.root, Variable) and target.root.plain and target.root not in lasting
        if not signed or target.indices or passing:
            continue
        if key is None or held is None or not isinstance(summed, Binary) or summed.op != "+":
            continue
        for old, addend in ((summed.left, summed.right), (summed.right, summed.left)):
            grown = bare(old)
            if isinstance(grown, Load) and grown.lvalue == target and not _mentions(addend, key):
                yield IntegralSum(function, target, key, addend, value, held)
                break


def _stored_locals(function: Function) -> dict[Key, LValue]:
    """The locals with one value that each way through a function stores in an object, each with the object."""
    given = Counter(variable for s in statements(function.body) if (variable := assigned(s)) is not None)
    given.subtract(s.variable for s in statements(function.body) if isinstance(s, Declare) and s.value is None)
    found: dict[Key, LValue] = {}
    for s in function.body:
        if any(isinstance(each, Return | Jump) for block in blocks(s) for each in statements(block)):
            break
        moved = bare(s.value) if isinstance(s, Assign) else None
        local = moved.lvalue.root if isinstance(moved, Load) and not moved.lvalue.indices else None
        if isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(local, Variable) and given[local] == 1:
            found[local, 0] = s.target
    return found


def _unlimited(keys: set[Key], functions: list[Function], added: set[int]) -> dict[Key, set[str]]:
    """On which sides no statement limits each integral; `added` are the values of the statements that add."""
    free = {key: set(_SIDES) for key in keys}
    for function in functions:
        for s in statements(function.body):
            if isinstance(s, Assign) and isinstance(s.target, LValue):
                key = key_of(s.target)
                taken_over = isinstance(bare(s.value), Load)  # from the same member of another regulator
                if key in free and id(s.value) not in added and not taken_over and _mentions(s.value, key):
                    free[key].clear()
            for p in own_nodes(s):
                match p:
                    case AddressOf(lvalue=lvalue) if (key := key_of(lvalue)) in free:
                        free[key].clear()
                    case Compare(op=op, left=left, right=right):
                        for side, above in ((left, op in _ABOVE), (right, op not in _ABOVE)):
                            plain = isinstance(bare(side), Load) and op not in ("==", "!=")
                            for key in keys & {key_of(p.lvalue) for p in parts(side) if isinstance(p, Load)}:
                                free[key] -= {"high" if above else "low"} if plain else _SIDES
    return free


def _mentions(e: Any, key: Key) -> bool:
    return any(isinstance(p, Load) and key_of(p.lvalue) == key for p in parts(e))


def regulator_of(added: IntegralSum, sides: frozenset[str]) -> OpenRegulator | None:
    """The regulator that has this integral."""
    function = added.function
    error = numbers_in(added.addend)
    for value, limited in _outputs(function):
        found = _share(value, added.held)
        if found is None:
            continue
        share, scale = found
        common = error & numbers_in(value, without=share)
        if scale <= 0 or error & numbers_in(share) or not common or not _differs(added, common):
            continue
        if any(_same(each, p) for each in limited for p in parts(added.addend)):
            continue
        text = added.target.text
        name = f"{function.path}: {text}"
        of = {
            id(added.value): RegulatorPart("sum", name, text),
            id(share): RegulatorPart("share", name, text, scale, "/".join(sorted(sides))),
            id(value): RegulatorPart("output", name, text),
        }
        if len(of) == 3:
            of |= {id(each): RegulatorPart("limit", name, text) for each in limited}
            return OpenRegulator(added, sides, limited, of)
    return None


def _outputs(function: Function) -> Iterator[tuple[Expr, list[Expr]]]:
    """The sums that a function limits, each with the limited values."""
    for p in within(function.body):
        operand = limited_operand(p)
        if operand is not None and _summed(operand):
            yield operand, [p]
    for target, value in given_values(function.body):
        if _summed(bare(value)):
            limited = [e for s in statements(function.body) for e in _limited(s, target)]
            if limited:
                yield value, limited


def _summed(e: Expr) -> bool:
    """Whether an expression has a sum."""
    return any(isinstance(p, Binary) and p.op in ("+", "-") for p in parts(e))


def limited_operand(e: Any) -> Expr | None:
    """What a call or a conditional expression limits; None: it limits nothing."""
    match e:
        case Call(function=function, arguments=arguments):
            if function.extern and function.name in _LIMITERS:
                candidates = list(arguments)
            else:
                at = _limiter(function)
                candidates = [arguments[at]] if at is not None and at < len(arguments) else []
            for argument in candidates:
                inner = bare(argument)
                if not isinstance(inner, Const):
                    return limited_operand(inner) or inner
        case Conditional(test=test, then=then, otherwise=otherwise):
            for p in parts(test):
                if isinstance(p, Compare) and p.op not in ("==", "!="):
                    for side in (p.left, p.right):
                        chosen = [*_choices(then), *_choices(otherwise)]
                        if any(_same(side, each) for each in chosen) and not isinstance(bare(side), Const):
                            return bare(side)
    return None


def limited_sides(e: Any) -> set[str]:
    """On which sides a call or a conditional expression limits a value for certain: `high`, `low`."""
    if isinstance(e, Conditional):
        operand = limited_operand(e)
        return set() if operand is None else _chosen_sides(e, operand)
    if not isinstance(e, Call):
        return set()
    function, at = e.function, _limiter(e.function)
    if function.extern:
        return set(_SIDES) if function.name in _BOTH else set()
    if at is None:
        return set()
    parameter, found = function.parameters[at], set[str]()
    for s in statements(function.body):
        match s:
            case If(test=Compare() as test, then=[Return(value=Expr() as value)]):
                pass
            case If(test=Compare() as test, then=[Assign(target=LValue(root=root), value=value)]) if root is parameter:
                pass
            case Return(value=Expr() as value):
                found |= _chosen_sides(value, parameter)
                continue
            case _:
                continue
        side = _beyond(test, parameter)
        if side and not any(isinstance(p, Load) and _is(p, parameter) for p in parts(value)):
            found.add(side)
    return found


def _chosen_sides(e: Expr, of: Expr | Variable) -> set[str]:
    """On which sides the conditional expressions in `e` replace a value."""
    found = set[str]()
    for p in parts(e):
        if isinstance(p, Conditional) and isinstance(p.test, Compare) and (side := _beyond(p.test, of)):
            then, otherwise = (any(_stands_for(of, q) for q in parts(each)) for each in (p.then, p.otherwise))
            if then != otherwise:
                found.add(side if otherwise else next(iter(_SIDES - {side})))
    return found


def _beyond(test: Compare, of: Expr | Variable) -> str:
    """The side on which a value is where a comparison by order is true; empty: it does not compare it."""
    if test.op not in ("==", "!="):
        for side, above in ((test.left, test.op in _ABOVE), (test.right, test.op not in _ABOVE)):
            if _stands_for(of, side):
                return "high" if above else "low"
    return ""


def _stands_for(of: Expr | Variable, e: Any) -> bool:
    return isinstance(e, Expr) and (_is(e, of) if isinstance(of, Variable) else _same(e, of))


def _choices(e: Expr) -> list[Expr]:
    """The values that a conditional expression, or one within it, can have."""
    inner = bare(e)
    return [*_choices(inner.then), *_choices(inner.otherwise)] if isinstance(inner, Conditional) else [inner]


def _limiter(function: Function) -> int | None:
    """Which parameter a function limits: it returns the parameter, or something else where that is beyond a limit."""
    body = list(statements(function.body))
    if function.extern or not body or not all(isinstance(s, If | Return | Assign | Declare) for s in body):
        return None
    returned = [each for s in body if isinstance(s, Return) and s.value is not None for each in _choices(s.value)]
    for n, parameter in enumerate(function.parameters):
        tests = [s.test for s in body if isinstance(s, If)]
        compared = any(
            isinstance(p, Compare) and p.op not in ("==", "!=") and (_is(p.left, parameter) or _is(p.right, parameter))
            for test in tests for p in parts(test)
        )  # fmt: skip
        if compared and any(_is(value, parameter) for value in returned):
            return n
    return None


def _limited(s: Stmt, target: LValue | Variable) -> Iterator[Expr]:
    """The values that a statement gives instead of `target` where that is beyond a limit."""
    match s:
        case If(test=test, then=then):
            for p in parts(test):
                if isinstance(p, Compare) and p.op not in ("==", "!="):
                    for side, limit in ((p.left, p.right), (p.right, p.left)):
                        if _is(side, target):
                            for inner in then:
                                value = getattr(inner, "value", None)
                                if not isinstance(inner, Assign | Return) or not isinstance(value, Expr):
                                    continue
                                if isinstance(bare(value), Const) or _same(value, limit):
                                    yield value
            return
    for p in own_nodes(s):
        operand = limited_operand(p)
        if operand is not None and _is(operand, target):
            yield p


def _is(e: Expr, target: LValue | Variable) -> bool:
    """Whether an expression is the value of an object."""
    load = bare(e)
    if not isinstance(load, Load):
        return False
    if isinstance(target, Variable):
        return load.lvalue.root is target and not load.lvalue.indices
    return load.lvalue == target


def _same(a: Any, b: Any) -> bool:
    """Whether two expressions are the same one, conversions apart."""
    return isinstance(a, Expr) and isinstance(b, Expr) and bare(a) == bare(b)


def _share(e: Expr, key: Key) -> tuple[Expr, float] | None:
    """The integral's share of a sum, and the factor of the sum behind it; None: it has no such share."""
    if not _mentions(e, key):
        return None
    match e:
        case Convert(operand=operand) if isinstance(operand.ctype, FloatType | IntType):
            return _share(operand, key)
        case Binary(op="+" | "-" as op, left=left, right=right):
            inside, outside = (left, right) if _mentions(left, key) else (right, left)
            if _mentions(outside, key):
                return None
            found = _share(inside, key)
            sign = -1.0 if op == "-" and inside is right else 1.0
            return None if found is None else (found[0], found[1] * sign)
        case Binary(op="*", left=left, right=Const(value=value)) | Binary(op="*", left=Const(value=value), right=left):
            return _scaled(left, key, float(value))
        case Binary(op="/", left=left, right=Const(value=value)) if value:
            return _scaled(left, key, 1.0 / value)
        case Binary(op=">>", left=left, right=Const(value=value)):
            return _scaled(left, key, 0.5 ** int(value))
    return e, 1.0


def _scaled(e: Expr, key: Key, factor: float) -> tuple[Expr, float] | None:
    found = _share(e, key)
    return None if found is None else (found[0], found[1] * factor)


def numbers_in(e: Any, without: Expr | None = None) -> set[Key]:
    """The numbers that an expression reads; `without`: a part that does not count."""
    aside = {id(p) for p in parts(without)} if without is not None else set()
    loads = (p for p in parts(e) if isinstance(p, Load) and isinstance(p.ctype, FloatType | IntType))
    keys = {key_of(load.lvalue) for load in loads if id(load) not in aside}
    return {key for key in keys if key is not None}


def _differs(added: IntegralSum, common: set[Key]) -> bool:
    """Whether what is added is an error: a difference, or a parameter."""
    if _subtracts(added.addend):
        return True
    for target, value in given_values(added.function.body):
        if key_of(target) in common and _subtracts(value):
            return True
    return any((parameter, 0) in common for parameter in added.function.parameters)


def _subtracts(e: Any) -> bool:
    return any(
        isinstance(p, Binary) and p.op == "-" and not any(isinstance(bare(side), Const) for side in (p.left, p.right))
        for p in parts(e)
    )  # fmt: skip
