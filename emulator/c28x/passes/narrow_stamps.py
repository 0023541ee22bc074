"""Static check of stamps that are narrower than their clock: `narrowed`.

    Uint32 millis;  Uint16 last;
    if (millis - last >= PERIOD_MS) { last = millis; ... }

The difference is one of 32 bits, and `last` has lost the upper ones: from 65536 on it is far too large.  A difference
that goes to 16 bits again (`(Uint16)(millis - last)`, `& 0xFFFF`) is right.  The clock is an object that the
program only counts up: one that it sets back may never need its upper bits.

The position of an eQEP (`QPOSCNT`, `QPOSLAT`) is one too, if it begins at 0 and goes on to a QPOSMAX above 65535, and
if neither the program, an index nor a unit time-out sets it back.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Const,
    Convert,
    Declare,
    Expr,
    Field,
    Function,
    Load,
    LValue,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
)
from emulator.c28x.tree_queries import (
    NamedScalar,
    added,
    addressed,
    assigned,
    bare,
    given_values,
    named_scalar,
    own_nodes,
    statements,
    within,
)

#: Clocks: objects, the paths of functions that return their time, and the blocks of eQEPs with a long position.
_Clocks = set[Variable | str]
#: All that 16 bits hold.
_HALF: Final = 0xFFFF
#: The registers that hold a position, and all that decide how far it goes.
_POSITIONS: Final = ("QPOSCNT", "QPOSLAT")
_COUNTER: Final = ("QPOSCNT", "QPOSMAX", "QEPCTL")
#: The values of PCRM with which a position goes on: it begins again at QPOSMAX, or only at the first index.
_GOES_ON: Final = (1, 2)
#: The fields of QEPCTL by which an index, a strobe or the program sets the position, and their bits.
_SETS: Final = ("IEI", "SEI", "SWI")
_SETS_BITS: Final = 0x0F80


def check_narrow_stamps(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the stamps of a program that keep a part of their clock and are subtracted from all of it."""
    functions = [(function, reports[module]) for module in modules for function in module.functions]
    alone = [function for function, _ in functions]
    _check(functions, set(_counters(alone)), "time")
    _check(functions, set(_long_positions(alone)), "position")


def _check(functions: list[tuple[Function, StaticReport]], clocks: _Clocks, what: str) -> None:
    clocks |= {function.path for function, _ in functions if clocks and _gives_time(function, clocks)}
    ages: dict[NamedScalar, Stmt] = {}
    for function, _ in functions if clocks else ():
        seen = clocks | _copies(function, clocks)
        ages |= {stamp: s for s in statements(function.body) for stamp in _ages(s, seen)}
    for function, report in functions if ages else ():
        seen = clocks | _copies(function, clocks)
        for s in statements(function.body):
            match s:
                case Assign(target=LValue(ctype=IntType(bits=16)) as target, value=value):
                    use = ages.get(stamp) if (stamp := _stamp(target)) is not None else None
                    if use is not None and (_reads(value, seen) or added(s) is not None):
                        message = (
                            f"{target.text} keeps 16 bits of a {what}, and line {use.where.line} subtracts it from one "
                            f"of 32: the difference is wrong once the {what} is above 65535"
                        )
                        report.report(function, s.where, "narrowed", message, object=target.text)


def _gives_time(function: Function, clocks: _Clocks) -> bool:
    """Whether a function returns the time of a clock."""
    returned = [s.value for s in statements(function.body) if isinstance(s, Return)]
    seen = clocks | _copies(function, clocks)
    return bool(returned) and all(value is not None and _reads(value, seen) for value in returned)


def _copies(function: Function, clocks: _Clocks) -> set[Variable]:
    """The locals of a function that get the time of a clock, and nothing else."""
    given: dict[Variable, list[Expr]] = {}
    for target, value in given_values(function.body):
        if isinstance(target.root, Variable) and target.root.kind != "global" and not target.indices:
            given.setdefault(target.root, []).append(value)
    return {
        local for local, values in given.items()
        if isinstance(local.ctype, IntType) and local.ctype.bits == 32 and all(_reads(v, clocks) for v in values)
    }  # fmt: skip


def _counters(functions: Iterable[Function]) -> set[Variable]:
    """The objects of 32 bits at file scope to which statements add constants, and which nothing else changes."""
    counted: set[Variable] = set()
    others: set[Variable] = set()
    for function in functions:
        others |= addressed(within(function.body))
        for s in statements(function.body):
            variable, step = assigned(s), added(s)
            if variable is not None:
                (counted if step is not None and isinstance(bare(step), Const) else others).add(variable)
    return {
        v for v in counted - others if v.kind == "global" and isinstance(v.ctype, IntType) and v.ctype.bits == 32
    }  # fmt: skip


def _long_positions(functions: Iterable[Function]) -> set[str]:
    """The blocks of the eQEPs whose position goes on beyond 65535."""
    most: dict[str, list[bool]] = {}
    control: dict[str, list[bool]] = {}
    for function in functions:
        written = [s for s in statements(function.body) if isinstance(s, Assign)]
        registers = [s.target for s in written if isinstance(s.target, RegisterRef)]
        starts = {target.block for target in registers if target.register == "QPOSMAX"}
        for s in written:
            number = constant_of(s.value)
            match s.target:
                case RegisterAt(name=name) if name in _COUNTER:
                    return set()  # of any eQEP
                case RegisterRef(block=block, register="QPOSMAX"):
                    most.setdefault(block, []).append(number is not None and number > _HALF)
                case RegisterRef(block=block, register="QPOSCNT"):
                    most.setdefault(block, []).append(number == 0 and block in starts)
                case RegisterRef(block=block, register="QEPCTL", field=Field(name="PCRM")):
                    control.setdefault(block, []).append(number in _GOES_ON)
                case RegisterRef(block=block, register="QEPCTL", field=Field(name=name)) if name in _SETS:
                    control.setdefault(block, []).append(number == 0)
                case RegisterRef(block=block, register="QEPCTL", field=None):
                    goes_on = number is not None and not number & _SETS_BITS
                    control.setdefault(block, []).append(goes_on and (number or 0) >> 12 & 3 in _GOES_ON)
    return {block for block, long in most.items() if all(long) and all(control.get(block, [False]))}


def _reads(e: Expr, clocks: _Clocks) -> bool:
    """Whether an expression is the time of a clock."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable() as root, indices=[])):
            return root in clocks
        case Call(function=function):
            return function.path in clocks
        case RegisterLoad(register=RegisterRef(block=block, register=register)):
            return register in _POSITIONS and block in clocks
    return False


def _stamp(lvalue: LValue) -> NamedScalar | None:
    """The scalar that an lvalue names; of an array of structures, the member of all of them."""
    if isinstance(lvalue.root, Variable) and lvalue.indices:
        return lvalue.root, lvalue.words
    return named_scalar(lvalue)


def _ages(s: Stmt, clocks: _Clocks) -> Iterator[NamedScalar]:
    """The stamps of 16 bits that a statement subtracts from a time, where the difference keeps 32."""
    nodes = own_nodes(s)
    cut = {id(e.operand) for e in nodes if isinstance(e, Convert) and _is_word(e)}
    for e in nodes:
        match e:
            case Binary(op="&", left=left, right=right):
                masks = [m for m in map(constant_of, (left, right)) if m is not None and m <= _HALF]
                cut |= {id(bare(side)) for side in (left, right) if masks}
    match s:
        case Assign(target=LValue(ctype=IntType(bits=16)), value=value) | Declare(
            variable=Variable(ctype=IntType(bits=16)), value=Expr() as value
        ):  # fmt: skip
            cut.add(id(value))
    for e in nodes:
        match e:
            case Binary(op="-", left=left, right=right, ctype=IntType(bits=32)) if id(e) not in cut:
                match bare(right):
                    case Load(lvalue=LValue(ctype=IntType(bits=16)) as lvalue) if _reads(left, clocks):
                        if (stamp := _stamp(lvalue)) is not None:
                            yield stamp


def _is_word(e: Expr) -> bool:
    return isinstance(e.ctype, IntType) and e.ctype.bits == 16
