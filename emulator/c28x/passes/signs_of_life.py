"""Static check of a watchdog that is serviced on signs of life that nothing takes back: `watchdog-in-vain`.

    void Control(void)  { ...; Alive |= CONTROL; }
    void Supervise(void)
    {
        if ((Alive & ALL) == ALL)        // true from the first time on, also if Control never runs again
            ServiceDog();
    }

The check needs a whole program.  It knows integers that several places of what runs again and again set, by `|=` or to
one value, while every other statement belongs to the start-up, and tests that then stay true.

One real sign of life is enough: anything else that the test, or one around it or around a call of the function, looks
at, but what the function alone counts, and the time.  A flag of the start-up is no sign of life.

So it tells a service beside which signs are taken back that others set, and that no statement reads.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from emulator.c28x.passes.begun_again import is_number
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of, start_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Expr,
    Function,
    FunctionRef,
    If,
    Load,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    addressed,
    all_blocks,
    assigned,
    bare,
    below,
    blocks,
    called,
    gives,
    leaves,
    own_nodes,
    parts,
    statements,
    variables,
    within,
    without_end,
)

_SERVICES: Final = frozenset({"ServiceDog", "KickDog", "SysCtl_serviceWatchdog"})
#: The second word of the key that services the watchdog.
_KEY: Final = 0xAA
#: Names of one sign of life; a mask of several needs none.
_ALIVE: Final = re.compile(r"alive|heart|life|health|check_?in|viv[oa]|vida|leben|laeuft", re.IGNORECASE)
#: Names of times, and of functions that return one.
_TIME: Final = re.compile(r"ms|milli|tick|time|clock|jiff|seg|zeit|tiempo", re.IGNORECASE)
#: Functions that wait for what others send.
_WAITS: Final = "_pend"


class _TestAround(NamedTuple):
    """A test around a statement, and whether it is true there.  No test: a loop or a `switch`."""

    s: Stmt
    test: Expr | None
    holds: bool = True


#: A statement, and the conditions around it.
_Guarded = tuple[Stmt, list[_TestAround]]


class _Sign(NamedTuple):
    """What statements of a program that run again and again do to an object: they set bits, or give a value."""

    bits: bool
    #: The bits that they can set, or the values; None: not all are known.
    values: frozenset[int] | None


def check_signs_of_life(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the tests of signs of life that stay true, around a service of the watchdog."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    if not any(function.name == "main" and function.body for function in functions):
        return
    program = _LifeSigns(modules, functions)
    for module in modules:
        for function in module.functions:
            for test, sign in program.in_vain(function):
                name = sign.declaration.name
                reports[module].report(
                    function, test.where, "watchdog-in-vain",
                    f"the watchdog is serviced also when what sets {name} runs no more: {name} is only set, and no "
                    "statement takes it back, so that this test stays true from the first time on",
                    object=sign.declaration.path, declaration=sign.declaration,
                )  # fmt: skip
            for service, sign in program.unread(function):
                name = sign.declaration.name
                reports[module].report(
                    function, service.where, "watchdog-in-vain",
                    f"the watchdog is serviced whatever {name} says: others set it, it is taken back here, and no "
                    "statement reads it",
                    object=sign.declaration.path, declaration=sign.declaration,
                )  # fmt: skip


class _LifeSigns:
    """The signs of life of a program, and its services of the watchdog."""

    def __init__(self, modules: list[Module], functions: list[Function]) -> None:
        self._functions = functions
        self._own = {function.path: function for function in functions}
        self._again = self._runs_again(modules)
        #: Object -> the statements that write it and run again and again, each with its function.
        self._writes: dict[Variable, list[tuple[Function, Stmt]]] = {}
        taken: set[Variable] = set()
        for function in functions:
            taken |= addressed(within(function.body))
            for s in statements(function.body):
                variable = assigned(s)
                if variable is not None and id(s) in self._again:
                    self._writes.setdefault(variable, []).append((function, s))
        #: The arguments of calls of each function.
        self._arguments: dict[Variable, list[Expr]] = {}
        for function in functions:
            for p in within(function.body):
                if isinstance(p, Call):
                    for parameter, value in zip(p.function.parameters, p.arguments, strict=False):
                        self._arguments.setdefault(parameter, []).append(value)
        self._signs = {
            v: sign for v in self._writes
            if is_number(v) and v not in taken and not v.escapes and (sign := self._sign(v)) is not None
        }  # fmt: skip
        self._services = self._serving()
        self._taken = taken
        #: What statements read but to change it.
        self._read = {
            p.lvalue.root for f in functions for s in statements(f.body) for p in own_nodes(s)
            if isinstance(p, Load) and isinstance(p.lvalue.root, Variable) and p.lvalue.root is not assigned(s)
        }  # fmt: skip

    def _runs_again(self, modules: list[Module]) -> set[int]:
        """The identities of the statements in loops without an end, in interrupt routines and in functions that
        something else than a call by name runs, and in what these call.
        """
        initial = [e for module in modules for v in module.variables for e in v.initial or ()]
        nodes = [*(p for e in initial for p in parts(e)), *(p for f in self._functions for p in within(f.body))]
        named = {p.function.path for p in nodes if isinstance(p, FunctionRef)}
        named |= {f.path for f in self._functions if f.interrupt}
        by_name = {p.function.path for p in nodes if isinstance(p, Call)}
        of_others = {f.path for f in self._functions if not f.static and f.path not in by_name}
        repeated: list[Stmt] = []
        for f in self._functions:
            loops = [s for s in statements(f.body) if isinstance(s, While) and without_end(s)]
            if loops or f.name == "main":
                repeated += [inner for loop in loops for inner in statements(loop.body)]
            elif f.path in named | of_others:
                repeated += statements(f.body)
        deeper = below(called(p for s in repeated for p in own_nodes(s)), self._own)
        return {id(s) for s in (*repeated, *(s for f in deeper for s in statements(f.body)))}

    def _sign(self, v: Variable) -> _Sign | None:
        """What sets an object; None: something else than that happens to it."""
        bits: set[int | None] = set()
        values: set[int | None] = set()
        straight = False
        for function, s in self._writes[v]:
            if not isinstance(s, Assign) or not _whole(s.target):
                return None
            added = _added(s, v)
            if added is None:
                values.add(constant_of(s.value))
                straight |= self._each_turn(function, s)
            else:
                bits |= self._constants(added)
        if values and (bits or None in values or len(values) > 1):
            return None
        if values and not (straight or _ALIVE.search(v.declaration.name)):
            return None
        if bits and len(bits) == 1 and None not in bits and not _ALIVE.search(v.declaration.name):
            return None
        known = bits or values
        return _Sign(bool(bits), None if None in known else frozenset(x for x in known if x is not None))

    @staticmethod
    def _each_turn(function: Function, s: Stmt) -> bool:
        """Whether a statement stands in the body of a loop without an end itself."""
        loops = [loop for loop in statements(function.body) if isinstance(loop, While) and without_end(loop)]
        return any(s is inner for loop in loops for inner in loop.body)

    def _constants(self, e: Expr) -> set[int | None]:
        """The constants that an expression can be, also those that calls pass to a parameter."""
        value = bare(e)
        match value:
            case Load(lvalue=LValue(root=Variable(kind="parameter") as parameter, indices=[])):
                return {constant_of(each) for each in self._arguments.get(parameter, [])} or {None}
        return {constant_of(value)}

    def _serving(self) -> set[str]:
        """The functions that service the watchdog whenever they are called."""
        found = set(_SERVICES)
        while True:
            more = {f.name for f in self._functions if any(_is_service(s, found) for s in f.body)} - found
            if not more:
                return found
            found |= more

    def in_vain(self, function: Function) -> Iterator[tuple[Stmt, Variable]]:
        """The tests around services in a function that stay true, each with its sign of life."""
        if any(isinstance(p, Call) and p.function.name.endswith(_WAITS) for p in within(function.body)):
            return
        told: set[int] = set()
        for s, conditions in _guarded(function.body, []):
            if not _is_service(s, self._services) or id(s) not in self._again:
                continue
            kept, real = self._judge(function, conditions)
            if not kept or real or id(kept[0][0]) in told or self._called_on_a_sign(function, {function.path}):
                continue
            told.add(id(kept[0][0]))
            yield kept[0]

    def unread(self, function: Function) -> Iterator[tuple[Stmt, Variable]]:
        """The services beside which a sign of life is taken back that others set and nothing reads: one for each."""
        for block in all_blocks(function.body):
            service = next((s for s in block if _is_service(s, self._services) and id(s) in self._again), None)
            for s in block if service is not None else ():
                v = assigned(s)
                if v is None or not isinstance(s, Assign) or constant_of(s.value) != 0 or not is_number(v):
                    continue
                others = [w for f, w in self._writes.get(v, ()) if f is not function]
                alive = any(isinstance(w, Assign) and (constant_of(w.value) or _added(w, v)) for w in others)
                if alive and v not in self._read and v not in self._taken and not v.escapes and service is not None:
                    yield service, v
                    break

    def _judge(self, function: Function, conditions: list[_TestAround]) -> tuple[list[tuple[Stmt, Variable]], bool]:
        """The tests that stay true, each with its sign of life, and whether another one looks at something else."""
        kept: list[tuple[Stmt, Variable]] = []
        real = False
        for s, test, holds in conditions:
            for part, true in _all_of(test, holds) if test is not None else ():
                sign = self._stays(function, part, true)
                if sign is not None:
                    kept.append((s, sign))
                else:
                    real = real or not self._is_time(function, part)
            real = real or test is None
        return kept, real

    def _called_on_a_sign(self, function: Function, seen: set[str]) -> bool:
        """Whether a function is called where a test looks at a sign of life, or behind a wait for others."""
        for caller in self._functions:
            for s, conditions in _guarded(caller.body, []):
                if function.path not in {p.function.path for p in own_nodes(s) if isinstance(p, Call)}:
                    continue
                if self._judge(caller, conditions)[1]:
                    return True
                if any(isinstance(p, Call) and p.function.name.endswith(_WAITS) for p in within(caller.body)):
                    return True
                if caller.path not in seen and self._called_on_a_sign(caller, seen | {caller.path}):
                    return True
        return False

    def _stays(self, function: Function, test: Expr, holds: bool) -> Variable | None:
        """The sign of life that a test looks at, if the test stays as it is once it has become so."""
        tested = {_origin(v, function) for v in variables(parts(test))}
        if len(tested) != 1 or any(isinstance(p, Call | CallPointer | RegisterLoad) for p in parts(test)):
            return None
        v = tested.pop()
        sign = self._signs.get(v) if v is not None else None
        if v is None or sign is None or _truth(test, start_of(v)) in (None, holds):
            return None
        if not sign.bits:
            return v if sign.values and all(_truth(test, x) == holds for x in sign.values) else None
        every = start_of(v)
        for x in sign.values or ():
            every |= x
        if sign.values is not None and _truth(test, every) != holds:
            return None
        return v if _needs_bits(test, holds, None if sign.values is None else every) else None

    def _is_time(self, function: Function, e: Expr, deep: int = 3, but: Variable | None = None) -> bool:
        """Whether an expression looks at the time, or at what its function alone writes, also through locals.

        `but`: the local whose old value it has.
        """
        if not deep or any(isinstance(p, CallPointer | RegisterLoad) for p in parts(e)):
            return False
        if any(isinstance(p, Call) and not _TIME.search(p.function.name) for p in parts(e)):
            return False
        return all(v is but or v.constant or self._is_of_time(function, v, deep) for v in variables(parts(e)))

    def _is_of_time(self, function: Function, v: Variable, deep: int) -> bool:
        if _TIME.search(v.declaration.name):
            return True
        if v.kind == "global":
            return all(writer is function for writer, _ in self._writes.get(v, ()))
        if v.kind == "parameter" or v.in_memory:
            return False
        given = [gives(s) for s in statements(function.body) if assigned(s) == v]
        return all(self._is_time(function, each[1], deep - 1, v) for each in given if each is not None)


def _whole(target: object) -> bool:
    return isinstance(target, LValue) and not target.indices and target.bits is None


def _added(s: Assign, v: Variable) -> Expr | None:
    """What `v |= x` adds."""
    match bare(s.value):
        case Binary(op="|", left=left, right=right):
            for this, other in ((left, right), (right, left)):
                loaded = bare(this)
                if isinstance(loaded, Load) and loaded.lvalue.root is v:
                    return other
    return None


def _is_service(s: Stmt, services: set[str]) -> bool:
    match s:
        case Assign(target=RegisterRef(register="WDKEY"), value=value):
            return constant_of(value) == _KEY
    return any(isinstance(p, Call) and p.function.name in services for p in own_nodes(s))


def _guarded(block: list[Stmt], conditions: list[_TestAround]) -> Iterator[_Guarded]:
    """The statements of a block and the conditions around each."""
    for s in block:
        yield s, conditions
        if isinstance(s, If):
            yield from _guarded(s.then, [*conditions, _TestAround(s, s.test)])
            yield from _guarded(s.otherwise, [*conditions, _TestAround(s, s.test, False)])
            if leaves(s.then) or leaves(s.otherwise):
                conditions = [*conditions, _TestAround(s, s.test, leaves(s.otherwise))]
        else:
            around = conditions if isinstance(s, While) and without_end(s) else [*conditions, _TestAround(s, None)]
            for inner in blocks(s):
                yield from _guarded(inner, around)


def _all_of(test: Expr, holds: bool) -> Iterator[tuple[Expr, bool]]:
    """The parts of a test that are all as it is: those of `a && b` if it is true."""
    match bare(test):
        case Not(operand=operand):
            yield from _all_of(operand, not holds)
        case Logic(op=op, operands=operands) if op == ("and" if holds else "or"):
            for operand in operands:
                yield from _all_of(operand, holds)
        case _:
            yield test, holds


def _origin(v: Variable, function: Function) -> Variable | None:
    """The object at file scope that a variable is, or of which a local is only ever a copy."""
    if v.kind == "global":
        return v
    found: set[Variable | None] = set()
    for s in statements(function.body):
        given = gives(s) if assigned(s) == v else None
        if given is not None:
            value = bare(given[1])
            root = value.lvalue.root if isinstance(value, Load) and not value.lvalue.indices else None
            found.add(root if isinstance(root, Variable) and root.kind == "global" else None)
    return found.pop() if len(found) == 1 and not v.in_memory else None


def _truth(test: Expr, of: int) -> bool | None:
    """Whether a test is true if the only object in it has this value; None: it is not known."""
    value = _value(test, of)
    return None if value is None else bool(value)


def _value(e: Expr, of: int) -> int | None:
    """The value of an expression if the only object in it has this one."""
    match bare(e):
        case Load():
            return of
        case Not(operand=operand):
            value = _value(operand, of)
            return None if value is None else int(not value)
        case Binary(op="&", left=left, right=right):
            one, other = _value(left, of), _value(right, of)
            return None if one is None or other is None else one & other
        case Compare(op="==" | "!=" as op, left=left, right=right):
            one, other = _value(left, of), _value(right, of)
            return None if one is None or other is None else int((one == other) == (op == "=="))
    return constant_of(e)


def _needs_bits(test: Expr, holds: bool, every: int | None) -> bool:
    """Whether a test only needs bits to be set.  `every`: all that can be; None: not known."""
    match bare(test):
        case Compare(op="==" | "!=" as op, left=left, right=right):
            wanted = constant_of(right)
            looked_at = bare(left)
            equal = (op == "==") == holds
            if wanted == 0:
                return not equal
            if isinstance(looked_at, Binary):
                return equal and wanted in (constant_of(looked_at.left), constant_of(looked_at.right))
            return equal and every is not None and wanted is not None and not every & ~wanted
        case Load() | Binary(op="&"):
            return holds
    return False
