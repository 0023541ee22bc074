"""Static check of results that do not hold the values which the source itself lets through.

    if (seconds > 0 && seconds <= 3600) Order.seconds = (Uint16)seconds;
    ...
    rest_ms = order.seconds * 1000U;                    /* Uint32 rest_ms: 3600 * 1000 in 16 bits */
    counts = (Uint32)((high & 0x0FFFU) << 12 | low >> 4);

It is `widened-late` if the result is widened afterwards, `overflow` if it is signed, and else `unsigned-wrap` where it
is divided, shifted down or compared by order.

What the source states: the limit of a test behind which a value from outside is used (a text, a word that was received,
the result of an ADC as it is, what a pointer leads to), the limit that replaces a larger value, `% n`; for shifts a
mask or the width of a field.
With that, a text of `sprintf` may be longer than its array: `memcpy-outside`.
An object at file scope, a member or a parameter has the largest of what it gets, if the source states that of all.
Not looked at: values behind another test of them, members of structures of which there are several, casts of a result
to its own type.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import ArrayType, IntType, StructType
from emulator.c28x.passes.admitted import upper_limits
from emulator.c28x.passes.formats import format_of, longest, shortest
from emulator.c28x.passes.given import GivenValue, GivenValues
from emulator.c28x.passes.intervals import LONGEST, interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.passes.values import volatile
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    Compare,
    Conditional,
    Const,
    Convert,
    CopyStruct,
    Declare,
    Expr,
    Field,
    For,
    Function,
    If,
    Load,
    Logic,
    LValue,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Unary,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    bare,
    blocks,
    children,
    leaves,
    named_scalar,
    named_scalars,
    own_nodes,
    parts,
    roots,
    source_text,
    statements,
    within,
)

#: How often values are followed from one function to the next.
_ROUNDS: Final = 2
#: Through how many objects a value is followed to the outside.
_DEEPEST: Final = 8
#: More than any integer.
_ENDLESS: Final = 1 << LONGEST
#: CHOICE: what a count that nothing limits is taken to reach, also if it has 32 bits.
_COUNTED: Final = 65535
#: Blocks whose registers hold what somebody sent.
_RECEIVED: Final = ("Sci", "Spi", "I2c", "Mcb", "Can", "Lin", "Usb")
#: The largest result of an ADC with 12 bits: a test for more refuses none.
_LARGEST_RESULT: Final = 4095
#: What is done with a result that is converted to a wider type.
_WIDENED: Final = "is widened"
#: The operators in whose operands a wide result needs all bits.
_JOINS: Final = ("+", "-", "*", "<<", "|", "^")


class _Stated(NamedTuple):
    """The largest value that the source states.  Of a number below 0, only what joins two branches asks for it."""

    most: int
    #: It is reached: it comes from outside, or replaces larger values.
    reached: bool = True
    #: A test limits it.
    limited: bool = False
    #: It is a mask: all its bits may be set, but it need be no number that occurs.
    bits: bool = False
    #: What the operation that gave it did not hold.
    lost: str = ""


_Known = list[tuple[LValue, _Stated]]


def check_stated(reports: dict[Module, StaticReport], given: GivenValues) -> None:
    """Report the results of all functions that do not hold what the source lets through."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    program = _StatedValues(owners, given)
    waiting = list(owners)
    for _ in range(_ROUNDS):
        for function in waiting:
            _StatedWalk(function, program, None).block(function.body, [])
        changed = program.settle()
        waiting = [function for function in owners if not changed.isdisjoint(named_scalars(function))]
    for function, report in owners.items():
        _StatedWalk(function, program, report).block(function.body, [])


class _StatedValues:
    """What is known of the scalars of a program."""

    def __init__(self, functions: Iterable[Function], given: GivenValues) -> None:
        functions = list(functions)
        self.given = given
        #: Identity of a value that is given to a scalar -> what the source states.
        self.values: dict[int, _Stated] = {}
        self.scalars: dict[NamedScalar, _Stated] = {}
        #: What no value that a scalar gets is above.
        self.bounds: dict[NamedScalar, int] = {}
        #: The scalars that are only counted up, and that nothing limits.
        self.counters: set[NamedScalar] = set()
        self._whole = any(function.name == "main" and function.body for function in functions)
        self._tested: dict[NamedScalar, int] = {}
        #: Structure -> the objects at file scope that are one, or have one.
        self._objects: dict[Any, set[Variable]] = {}
        for p in chain.from_iterable(within(function.body) for function in functions):
            match p:
                case Compare(op=op, left=left, right=right):
                    for side, other in ((bare(left), right), (bare(right), left)):
                        if isinstance(side, Load) and (scalar := named_scalar(side.lvalue)) is not None:
                            limit = constant_of(other)
                            least = -1 if limit is None else limit if limit > 1 and op not in ("==", "!=") else None
                            if least is not None:
                                self._tested[scalar] = min(least, self._tested.get(scalar, least))
                case LValue(root=Variable(kind="global") as root):
                    self._objects.setdefault(root.ctype, set()).add(root)
        self.counters = {
            scalar for scalar, values in given.scalars.items()
            if self._whole and scalar not in self._tested and all(_counts_up(one, scalar) for one in values)
        }  # fmt: skip

    def settle(self) -> set[NamedScalar]:
        """Decide for the scalars from the values that were found.  Returns those whose answers are new."""
        scalars, bounds = self.scalars, self.bounds
        self.scalars, self.bounds = {}, {}
        for scalar, values in self.given.scalars.items():
            holder, _ = scalar
            local = isinstance(holder, Variable) and holder.kind == "local"
            if local or not self._whole or (isinstance(holder, StructType) and len(self._objects.get(holder, ())) != 1):
                continue
            found = [
                None if value is None
                else _Stated(number) if (number := constant_of(value)) is not None
                else self.values.get(id(value))
                for value, _ in values
            ]  # fmt: skip
            self.bounds[scalar] = max(
                interval(value, {})[1] if one is None and value is not None and isinstance(value.ctype, IntType)
                else one.most if one is not None else _ENDLESS
                for one, (value, _) in zip(found, values, strict=True)
            )  # fmt: skip
            limits = [one for one in found if one is not None and one.limited and one.reached and not one.bits]
            if limits and None not in found:
                least = min(limits)  # a larger one may belong to another mode
                if self._tested.get(scalar, least.most) >= least.most:
                    self.scalars[scalar] = least
        # A bound is asked for behind a test only.
        return {
            scalar for scalar in self.given.scalars
            if self.scalars.get(scalar) != scalars.get(scalar)
            or (scalar in self._tested and self.bounds.get(scalar) != bounds.get(scalar))
        }  # fmt: skip

    def from_outside(self, e: Expr, followed: frozenset[NamedScalar] = frozenset()) -> bool | None:
        """Whether somebody else decides a value: a text, a word that was received, what a pointer leads to.

        None: it says nothing, as a constant.  `followed`: the scalars on the way to it.
        """
        match e:
            case Const():
                return None
            case Convert(operand=operand) | Unary(operand=operand):
                return self.from_outside(operand, followed)
            case Binary(left=left, right=right) | Conditional(then=left, otherwise=right):
                sides = {self.from_outside(left, followed), self.from_outside(right, followed)} - {None}
                return all(sides) if sides else None
            case Call(function=function):
                if function.extern:
                    return isinstance(e.ctype, IntType)
                return self._any(self.given.results.get(function.path, ()), followed)
            case RegisterLoad(register=RegisterRef(block=block)):
                return block.startswith(_RECEIVED)
            case Load(lvalue=lvalue):
                scalar = named_scalar(lvalue)
                if scalar is None:
                    return isinstance(lvalue.root, Expr) or bool(lvalue.indices)
                if scalar in followed or len(followed) > _DEEPEST:
                    return None
                values = self.given.of(scalar)
                unknown = not values and isinstance(scalar[0], Variable) and scalar[0].kind == "parameter"
                return unknown or self._any(values, followed | {scalar})
        return False

    def converted(self, e: Expr, followed: frozenset[NamedScalar] = frozenset()) -> bool:
        """Whether a value that is no constant is the result of an ADC as it is; a computed one has another range."""
        match e:
            case Convert(operand=operand):
                return self.converted(operand, followed)
            case RegisterLoad(register=RegisterRef(block=block)):
                return block.startswith("Adc") and "Result" in block
            case Call(function=function):
                values: Iterable[GivenValue] = self.given.results.get(function.path, ())
            case Load(lvalue=lvalue) if (scalar := named_scalar(lvalue)) is not None and scalar not in followed:
                values, followed = self.given.of(scalar), followed | {scalar}
            case _:
                return False
        given = [one.value for one in values if one.value is None or constant_of(one.value) is None]
        return len(followed) <= _DEEPEST and bool(given) and all(
            one is not None and self.converted(one, followed) for one in given
        )  # fmt: skip

    def _any(self, values: Iterable[GivenValue], followed: frozenset[NamedScalar]) -> bool | None:
        """Whether one of some values is from outside; None: they all say nothing."""
        found = {
            not isinstance(one.by, For) if one.value is None else self.from_outside(one.value, followed)
            for one in values
        } - {None}  # fmt: skip
        return any(found) if found else None


class _StatedWalk:
    """One function from its start to its end, with what is known of its objects."""

    def __init__(self, function: Function, program: _StatedValues, report: StaticReport | None) -> None:
        self.function, self.program, self.report = function, program, report

    def block(self, body: list[Stmt], known: _Known) -> _Known:
        """What is known behind the statements of a block."""
        for s in body:
            known = self.statement(s, known)
        return known

    def statement(self, s: Stmt, known: _Known) -> _Known:
        """What is known behind a statement."""
        if isinstance(s, While | For):
            inside = _without(known, [s])
            self.look(s, inside)
            limits = self.limits(s.test, inside, holds=True) if isinstance(s, While) else []
            self.block(s.body, [*_except(_asked(inside, own_nodes(s)), limits), *limits])
            return inside
        self.look(s, known)
        if isinstance(s, If):
            known = _asked(known, own_nodes(s))
            branches = []
            for body, holds in ((s.then, True), (s.otherwise, False)):
                limits = self.limits(s.test, known, holds=holds)
                others = [one for one in known if not isinstance(s.test, Logic) or not _reads(s.test, one[0])]
                after = self.block(body, [*_except(others, limits), *limits])
                if not leaves(body):
                    branches.append(after)
            return _join(*branches) if len(branches) == 2 else branches[0] if branches else []
        if inner := blocks(s):
            for case in inner:
                self.block(case, _asked(known, own_nodes(s)))
            return _without(known, [s])
        value = s.value if isinstance(s, Assign | Declare) and isinstance(s.value, Expr) else None
        stated = self.most(value, known) if value is not None else None
        known = _without(known, [s])
        if stated is None and value is not None and (number := constant_of(value)) is not None and number < 0:
            stated = _Stated(number)
        match s:
            case Assign(target=LValue() as target) if stated is not None and _plain(target):
                return [*known, (target, stated)]
            case Declare(variable=variable) if stated is not None and variable.plain:
                return [*known, (LValue(variable.ctype, variable), stated)]
        return known

    def limits(self, test: Expr, known: _Known, *, holds: bool) -> _Known:
        """What a test says of the values that it compares."""
        found: _Known = []
        for value, limit, _ in upper_limits(test, holds=holds):
            scalar, ctype = named_scalar(value), value.ctype
            if scalar is None or volatile(value) or not isinstance(ctype, IntType):
                continue
            if not 1 < limit <= min(ctype.high - 1, self.program.bounds.get(scalar, limit)):
                continue
            before = _find(known, value)
            load = Load(value.ctype, value)
            reached = self.program.from_outside(load) or (limit <= _LARGEST_RESULT and self.program.converted(load))
            now = _Stated(limit, bool(reached), limited=True)
            found = [*_except(found, [(value, now)]), (value, before if before and before.most <= limit else now)]
        return _asked(found, parts(test))

    def most(self, e: Expr, known: _Known) -> _Stated | None:
        """The largest value of an expression, if the source states it."""
        match e:
            case Const(value=int(value)):
                return _Stated(value) if value >= 0 else None
            case Load(lvalue=lvalue):
                found = _find(known, lvalue)
                if found is None and (scalar := named_scalar(lvalue)) is not None:
                    found = self.program.scalars.get(scalar)
                if found is not None and found.most < 0:
                    return None
                width = lvalue.bits.width if lvalue.bits is not None else 0
                return _Stated((1 << width) - 1, bits=True) if found is None and width else found
            case RegisterLoad(register=RegisterRef(field=Field(width=width), bits=bits)) if width < bits:
                return _Stated((1 << width) - 1, bits=True)
            case Convert(ctype=IntType(high=high), operand=operand):
                found = self.most(operand, known)
                return found if found is not None and found.most <= high and not (found.lost and e.explicit) else None
            case Conditional(test=test, then=then, otherwise=otherwise):
                sides = []
                for side, holds in ((then, True), (otherwise, False)):
                    limits = self.limits(test, known, holds=holds)
                    sides.append(self.most(side, [*_except(known, limits), *limits]))
                return _either(*sides)
            case Binary(ctype=IntType(high=high)):
                found = self.exact(e, known)
                if found is None or found.most <= high:
                    return found
                return found._replace(most=high, lost=_lost(e, found)) if _loses(e, found) else None
        return None

    def exact(self, e: Binary, known: _Known) -> _Stated | None:
        """The largest result of an operation, before any wrap."""
        number = constant_of(e.right)
        if e.op == "&":
            mask = number if number is not None else constant_of(e.left)
            if mask is None or mask <= 0 or not isinstance(e.ctype, IntType):
                return None
            before = self.most(e.left if number is not None else e.right, known)
            kept = before is not None and before.most <= mask and not before.lost  # else the cut is meant
            return before if kept else _Stated(interval(e, {})[1], bits=True)
        if e.op == "%" and number is not None and number > 1:
            left = self.most(e.left, known)
            if left is not None and left.most < number:
                return left
            return _Stated(number - 1, limited=True) if interval(e.left, {})[1] >= number - 1 else None
        a, b = self.most(e.left, known), self.most(e.right, known)
        if a is None or a.lost or b is None or b.lost:
            return None
        merged = (a.reached and b.reached, a.limited or b.limited, a.bits or b.bits)
        match e.op:
            case "+":
                return _Stated(a.most + b.most, *merged)
            case "*":
                return _Stated(a.most * b.most, *merged)
            case "|" | "^":
                return _Stated((1 << (a.most | b.most).bit_length()) - 1, merged[0], merged[1], bits=True)
            case "-" if number is not None and 0 <= number <= a.most:
                return _Stated(a.most - number, *merged)
            case "/" if number:
                return _Stated(a.most // number, *merged)
            case ">>" if number is not None and number >= 0:
                return _Stated(a.most >> number, *merged)
            case "<<" if number is not None and 0 <= number < e.ctype.words * 16:
                return _Stated(a.most << number, *merged)
        return None

    def look(self, s: Stmt, known: _Known) -> None:
        """Remember what a statement gives to scalars, or report what it loses."""
        if self.report is None:
            for value in _given(s):
                if (stated := self.most(value, known)) is not None:
                    self.program.values[id(value)] = stated
            return
        for p in own_nodes(s):
            if isinstance(p, Call) and p.function.name in ("sprintf", "System_sprintf"):
                self.text(p, s, known, self.report)
        for e, use in chain.from_iterable(_needed(root) for root in roots(s) if isinstance(root, Expr | LValue)):
            found = self.most(e, known)
            kept = isinstance(e, Binary) and isinstance(e.ctype, IntType) and e.ctype.signed and e.op != "<<"
            if found is None or not found.lost or not (use == _WIDENED or ((use or kept) and not found.bits)):
                continue
            assert isinstance(e.ctype, IntType)
            signed, then = e.ctype.signed, f", and {use} afterwards" if use else ""
            self.report.report(
                self.function, s.where,
                "widened-late" if use == _WIDENED else "overflow" if signed else "unsigned-wrap",
                f"{found.lost}, which {e.ctype.bits} bits do not hold{then}", object=source_text(e),
            )  # fmt: skip
            return

    def text(self, e: Call, s: Stmt, known: _Known, report: StaticReport) -> None:
        """Report a text that is longer than its array once its numbers have the digits that they can have."""

        def most(value: Expr) -> int:
            match value:
                case Convert(operand=operand):
                    return most(operand)
                case Binary(op="/", left=left, right=Const(value=int(divisor))) if divisor > 0:
                    return most(left) // divisor
                case Load(lvalue=lvalue) if named_scalar(lvalue) in self.program.counters:
                    return _COUNTED
            stated = self.most(value, known)
            return stated.most if stated is not None and stated.reached and stated.limited and not stated.bits else 0

        match bare(e.arguments[0]):
            case AddressOf(lvalue=LValue(ctype=ArrayType(words=words), text=array)):
                form, room = format_of(e) or "", longest(e, most) + 1
                if form and shortest(form) < words < room:
                    message = f"{e.function.name} can write {room} words into {array}, an array of {words} words"
                    report.report(self.function, s.where, "memcpy-outside", message, object=array)


def _lost(e: Binary, found: _Stated) -> str:
    most = f"has bits up to {found.most:#x}" if found.bits else f"can be {found.most}"
    return f"{source_text(e)} {most}"


def _loses(e: Binary, found: _Stated) -> bool:
    """Whether an operation loses a part of a value that occurs: of a mask, by a shift; bit 15 may be a sign."""
    if e.op == "<<":
        return found.reached and (found.limited or found.bits) and found.most >> e.ctype.words * 16 > 0
    return e.op in ("+", "*") and found.reached and found.limited and not found.bits


def _counts_up(given: GivenValue, scalar: NamedScalar) -> bool:
    """Whether a statement counts a scalar up."""
    match bare(given.value) if given.value is not None else None:
        case Binary(op="+", left=left, right=right) if (constant_of(right) or 0) > 0:
            before = bare(left)
            return isinstance(before, Load) and named_scalar(before.lvalue) == scalar
    return False


def _given(s: Stmt) -> Iterator[Expr]:
    """The values that a statement gives to objects and parameters."""
    if isinstance(s, Assign | Declare) and isinstance(s.value, Expr):
        yield s.value
    for p in own_nodes(s):
        if isinstance(p, Call):
            yield from p.arguments


def _needed(e: Any, use: str = "") -> Iterator[tuple[Binary | Load, str]]:
    """The operations and objects in an expression, each with what is done with its result; empty: it is only kept."""
    match e:
        case Convert(ctype=to, operand=operand):
            kept = isinstance(to, IntType) and isinstance(operand.ctype, IntType) and to.bits <= operand.ctype.bits
            if not kept and isinstance(operand.ctype, IntType):
                yield from _needed(operand, _WIDENED)
            elif e.explicit and isinstance(to, IntType) and to.bits == getattr(operand.ctype, "bits", 0):
                yield from _needed_below(operand)  # the wrap is meant
            elif isinstance(to, IntType) and not to.signed:
                yield from _needed_below(operand)
            else:
                yield from _needed(operand, use)
        case Binary(op=op, left=left, right=right):
            yield e, use
            if op in _JOINS:
                yield from _needed(left, use)
                yield from _needed(right, use if op != "<<" else "")
            elif op in ("/", ">>", "%"):
                yield from _needed(left, "is divided" if op != "%" else "")
                yield from _needed(right, "")
            else:
                yield from _needed_below(e)
        case Compare(op=op, left=left, right=right):
            for side in (left, right):
                yield from _needed(side, "is compared" if op not in ("==", "!=") else "")
        case Conditional(test=test, then=then, otherwise=otherwise):
            yield from _needed(test)
            yield from _needed(then, use)
            yield from _needed(otherwise, use)
        case Load() if use:
            yield e, use
            yield from _needed_below(e)
        case _:
            yield from _needed_below(e)


def _needed_below(e: Any) -> Iterator[tuple[Binary | Load, str]]:
    """The operations in the parts of an expression whose own result keeps only its bits."""
    inner = children(e)
    for part in inner:
        yield from _needed(part)


def _plain(lvalue: LValue) -> bool:
    """Whether an lvalue is one scalar that only statements change."""
    return named_scalar(lvalue) is not None and not volatile(lvalue) and isinstance(lvalue.ctype, IntType)


def _find(known: _Known, lvalue: LValue) -> _Stated | None:
    return next((stated for of, stated in known if of == lvalue), None)


def _except(known: _Known, others: _Known) -> _Known:
    return [one for one in known if all(one[0] != other for other, _ in others)]


def _asked(known: _Known, test: list[Any]) -> _Known:
    """What is known behind a test: nothing of values that it does not just compare with numbers."""
    plainly = {
        id(bare(side)) for p in test if isinstance(p, Compare)
        for side, other in ((p.left, p.right), (p.right, p.left)) if constant_of(other) is not None
    }  # fmt: skip
    asked = [p.lvalue for p in test if isinstance(p, Load) and id(p) not in plainly]
    return [one for one in known if one[0] not in asked]


def _without(known: _Known, body: list[Stmt]) -> _Known:
    """What statements leave of what is known: nothing of objects that they, or the functions they call, may change."""
    if not known:
        return known
    changed: set[Any] = set()
    elsewhere = False
    for s in statements(body):
        match s:
            case Assign(target=LValue(root=root)) | CopyStruct(target=LValue(root=root)) | For(counter=root):
                elsewhere |= not isinstance(root, Variable) or not root.plain
                changed |= {root} if isinstance(root, Variable) else set()
            case Declare(variable=variable):
                changed.add(variable)
        elsewhere |= any(isinstance(p, Call) for p in own_nodes(s))
    return [
        one for one in known
        if isinstance(root := one[0].root, Variable) and root not in changed and (root.plain or not elsewhere)
    ]  # fmt: skip


def _reads(e: Expr, lvalue: LValue) -> bool:
    return any(isinstance(p, Load) and p.lvalue == lvalue for p in parts(e))


def _join(one: _Known, other: _Known) -> _Known:
    """What is known behind two branches."""
    both = [(lvalue, _either(stated, _find(other, lvalue))) for lvalue, stated in one]
    return [(lvalue, stated) for lvalue, stated in both if stated is not None]


def _either(a: _Stated | None, b: _Stated | None) -> _Stated | None:
    """What is known of a value that is one of two: a limited one, or what replaces it beyond the limit."""
    if a is None or b is None or a.lost or b.lost:
        return None
    if a.limited and b.limited:
        return min(a, b)  # the other one may belong to another mode
    for one, other in ((a, b), (b, a)):
        if one.most < 0:  # it replaces what is below
            return other if other.limited else None
    number, limited = (a, b) if b.limited else (b, a)
    if not limited.limited or number.most > limited.most + 1:
        return a if a == b else None
    return _Stated(number.most, number.reached, limited=True) if number.most >= limited.most else limited
