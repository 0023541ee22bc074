"""Static check of the entrances of a state: `entrance-differs`, and `not-begun-again` for its time.

A state is entered where a statement gives its constant to the object of the state, or to a function that gives its
parameter to that object.  What the entrances do besides is the same for a reason: they stop an output, begin a time,
clear a count.  One that leaves it out is most likely wrong.

* Its time: the state ends by a count or a stamp.  All other entrances begin it, this one does not.
* Its preparation: the same state has at least three entrances.  All others call the same function with the same
  constants, or give the same constant to the same object, and this one does not.

What is done on the way to an entrance or behind it, in the same function, in a function that is called there or by the
caller, or in the state itself counts as done.  Entrances before the loop of `main` are not looked at.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

from emulator.c28x.ctypes import IntType, StructType
from emulator.c28x.passes.interrupted import Place, place_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Evaluate,
    Expr,
    Function,
    FunctionRef,
    If,
    Load,
    LValue,
    RegisterRef,
    Stmt,
    Switch,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    bare,
    below,
    blocks,
    called,
    last_loop,
    own_nodes,
    parts,
    register_text,
    source_text,
    statements,
    within,
)

#: So many other entrances must agree.
_AGREE: Final = 2

#: What a statement does, so that two can be compared: an object or register with a constant, or a call.
_Deed = tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class _Entrance:
    """A statement that gives a constant to a state, in a block of a function."""

    function: Function
    state: Place
    #: The state's name in the source.
    name: str
    value: int
    s: Stmt
    #: The blocks around it, the innermost last.
    around: tuple[list[Stmt], ...]

    @property
    def block(self) -> list[Stmt]:
        """The innermost block."""
        return self.around[-1]


def check_entrances(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the entrances of states that leave out what the others do."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    own = {function.path: function for module in modules for function in module.functions if not module.brought}
    main = next((function for function in own.values() if function.name == "main" and function.body), None)
    if main is not None:
        _EntranceCheck(list(own.values()), main, owners).check()


class _EntranceCheck:
    """The states of a program, their entrances, and what happens at them."""

    def __init__(self, functions: list[Function], main: Function, reports: dict[Function, StaticReport]) -> None:
        self._functions = functions
        self._own = {function.path: function for function in functions}
        self._reports = reports
        self._later = self._run_later(main)
        #: Function -> the number of the parameter that it gives to a state, that state and its name.
        self._setters = {f.path: setter for f in functions if (setter := _setter(f)) is not None}
        #: Function -> the blocks around each call of it, with the caller.
        self._callers: dict[str, list[tuple[Function, tuple[list[Stmt], ...]]]] = {}
        self._handled: dict[tuple[Place, int], list[list[Stmt]]] = {}
        #: State -> the `default` of a switch over it, with the values that have a case.
        self._others: dict[Place, list[tuple[set[int], list[Stmt]]]] = {}
        entrances: list[_Entrance] = []
        loop = last_loop(main)
        for function in functions:
            body = loop.body if function is main and loop is not None else function.body
            for s, around in _with_blocks(body, ()):
                self._look(function, s, around, entrances)
        every = [(f, s) for f in functions for s in statements(f.body)]
        self._counted = {place for _, s in every if (place := _counted(s)) is not None}
        self._stamped = {place for _, s in every if (place := _stamped(s, self._counted)) is not None}
        #: Integer -> the statements that set it, and do not count it, while the program is under way.
        self._set: dict[Place, list[Stmt]] = {}
        for f, s in every:
            if f in self._later and (place := _written(s)) is not None and _counted(s) is None:
                self._set.setdefault(place, []).append(s)
        asked = {state for state, _ in self._handled}
        self._entrances = [each for each in entrances if each.state in asked and each.function in self._later]

    def _run_later(self, main: Function) -> set[Function]:
        """The functions that run when the program is under way, not only before the loop of `main`."""
        loop = last_loop(main)
        begin = [f.path for f in self._functions if f.interrupt]
        if loop is None:
            return set(self._functions) - {main}
        for function in self._functions:
            begin += [p.function.path for p in within(function.body) if isinstance(p, FunctionRef)]
        return {main, *below([*begin, *called(within(loop.body))], self._own)}

    def _look(
        self, function: Function, s: Stmt, around: tuple[list[Stmt], ...], entrances: list[_Entrance]
    ) -> None:  # fmt: skip
        match s:
            case Assign(target=LValue(ctype=IntType()) as target, value=value):
                state, number = _place(target), constant_of(value)
                if state is not None and number is not None:
                    name = source_text(Load(value.ctype, target))
                    entrances.append(_Entrance(function, state, name, number, s, around))
            case Evaluate(value=Call(function=Function(path=path), arguments=arguments)) if path in self._setters:
                which, state, name = self._setters[path]
                number = constant_of(arguments[which]) if which < len(arguments) else None
                if number is not None:
                    entrances.append(_Entrance(function, state, name, number, s, around))
            case Switch(subject=subject, cases=cases) if (state := _scalar(subject)) is not None:
                named = {label for labels, _ in cases for label in labels or ()}
                for labels, body in cases:
                    for label in labels or ():
                        self._handled.setdefault((state, label), []).append(body)
                    if labels is None:
                        self._others.setdefault(state, []).append((named, body))
            case If(test=test, then=then):
                for p in parts(test):
                    if isinstance(p, Compare) and p.op == "==":
                        for side, other in ((p.left, p.right), (p.right, p.left)):
                            state, number = _scalar(side), constant_of(other)
                            if state is not None and number is not None:
                                self._handled.setdefault((state, number), []).append([s, *then])
        for p in own_nodes(s):
            if isinstance(p, Call):
                self._callers.setdefault(p.function.path, []).append((function, around))

    def _in_state(self, entrance: _Entrance) -> Iterator[Stmt]:
        """The statements that run in the state which is entered."""
        for body in self._handled.get((entrance.state, entrance.value), ()):
            yield from statements(body)
        for named, body in self._others.get(entrance.state, ()):
            if entrance.value not in named:
                yield from statements(body)

    def check(self) -> None:
        """Report what differs."""
        for entrance in self._entrances:
            same = [
                each for each in self._entrances
                if each.state == entrance.state and each.value == entrance.value and each.s is not entrance.s
            ]  # fmt: skip
            others = [
                each for each in self._entrances
                if each.state == entrance.state and each.value != entrance.value
            ]  # fmt: skip
            for time, text in self._times(entrance):
                begins = [each for each in (*same, *others) if self._begins(each, time)]
                agree = begins == [*same, *others] and len(begins) >= _AGREE
                agree = agree or (bool(same) and all(each in begins for each in same) and len(begins) >= _AGREE)
                if agree and not self._is_begun(entrance, time):
                    message = f"{text}, by which this state ends, is begun at the other entrances, not here"
                    self._tell(entrance, "not-begun-again", message)
                    break
            else:
                self._prepared(entrance, same)

    def _tell(self, entrance: _Entrance, rule: str, message: str) -> None:
        self._reports[entrance.function].report(
            entrance.function, entrance.s.where, rule, message, object=entrance.name, value=entrance.value
        )

    # Its time

    def _times(self, entrance: _Entrance) -> Iterator[tuple[Place, str]]:
        """The counts and stamps that a state compares, with their text."""
        found: dict[Place, str] = {}
        for s in self._in_state(entrance):
            if isinstance(s, If):
                found.update(_compared_times(s))
        for place, text in found.items():
            if place != entrance.state and (place in self._counted or place in self._stamped):
                yield place, text

    def _begins(self, entrance: _Entrance, time: Place) -> bool:
        """Whether the block of an entrance sets a time."""
        return any(_written(s) == time and _counted(s) is None for s in entrance.block)

    def _is_begun(self, entrance: _Entrance, time: Place) -> bool:
        """Whether a time is set on the way, in the state, or anywhere but at entrances."""
        at_entrances = {id(s) for each in self._entrances if each.state == entrance.state for s in each.block}
        if any(id(s) not in at_entrances for s in self._set.get(time, ())):
            return True
        way = self._on_the_way(entrance.function, entrance.around)
        return any(_written(s) == time and _counted(s) is None for s in way)

    # Its preparation

    def _prepared(self, entrance: _Entrance, same: list[_Entrance]) -> None:
        """Report what all other entrances of the same state do, and this one does not."""
        if len(same) < _AGREE:
            return
        deeds = [{deed: s for s in each.block if s is not each.s and (deed := _deed(s)) is not None} for each in same]
        common = set(deeds[0]).intersection(*deeds[1:])
        here = {deed for s in self._on_the_way(entrance.function, entrance.around) if (deed := _deed(s)) is not None}
        here |= {deed for s in self._in_state(entrance) if (deed := _deed(s)) is not None}
        for deed, s in deeds[0].items():
            if deed not in common - here:
                continue
            message = f"the {len(same)} other entrances of this state do what line {s.line} does, this one does not"
            self._tell(entrance, "entrance-differs", message)
            return

    def _on_the_way(
        self, function: Function, around: tuple[list[Stmt], ...], above: frozenset[str] = frozenset()
    ) -> Iterator[Stmt]:  # fmt: skip
        """The statements that run with one in some blocks: those of the innermost, and what always runs around it."""
        yield from self._with_called(statements(around[-1]), frozenset())
        for block in around[:-1]:
            yield from self._with_called(block, frozenset())
        if function.path not in above:
            for caller, outer in self._callers.get(function.path, ()):
                yield from self._on_the_way(caller, outer, above | {function.path})

    def _with_called(self, body: Iterable[Stmt], above: frozenset[str]) -> Iterator[Stmt]:
        """Statements, and those that always run in the functions which they call."""
        for s in body:
            yield s
            for p in own_nodes(s):
                if isinstance(p, Call) and p.function.path in self._own and p.function.path not in above:
                    inner = self._own[p.function.path]
                    yield from self._with_called(inner.body, above | {inner.path})


def _with_blocks(
    body: list[Stmt], around: tuple[list[Stmt], ...]
) -> Iterator[tuple[Stmt, tuple[list[Stmt], ...]]]:  # fmt: skip
    """Every statement, with the blocks around it, the innermost last."""
    inside = (*around, body)
    for s in body:
        yield s, inside
        for block in blocks(s):
            yield from _with_blocks(block, inside)


def _setter(function: Function) -> tuple[int, Place, str] | None:
    """Which parameter a function gives to an object, that object and its name."""
    for s in function.body:
        match s:
            case Assign(target=LValue(ctype=IntType()) as target, value=value):
                given, place = bare(value), _place(target)
                root = given.lvalue.root if isinstance(given, Load) and not given.lvalue.indices else None
                if place is not None and isinstance(root, Variable) and root in function.parameters:
                    return function.parameters.index(root), place, source_text(Load(value.ctype, target))
    return None


def _place(lvalue: LValue) -> Place | None:
    """As `place_of`, but no element of an array at file scope: each has a state or a time of its own."""
    array = isinstance(lvalue.root, Variable) and not isinstance(lvalue.root.ctype, StructType)
    return None if lvalue.indices and (array or not isinstance(lvalue.ctype, IntType)) else place_of(lvalue)


def _scalar(e: Expr) -> Place | None:
    match bare(e):
        case Load(ctype=IntType(), lvalue=lvalue):
            return _place(lvalue)
    return None


def _written(s: Stmt) -> Place | None:
    return _place(s.target) if isinstance(s, Assign) and isinstance(s.target, LValue) else None


def _counted(s: Stmt) -> Place | None:
    """The integer to which a statement adds a constant."""
    place = _written(s)
    if place is not None and isinstance(s, Assign):
        match bare(s.value):
            case Binary(op="+" | "-", left=left, right=right) if constant_of(right) is not None:
                old = bare(left)
                root = old.lvalue.root if isinstance(old, Load) else None
                # `x++` in an expression: its old value is a temporary.
                if _scalar(left) == place or (isinstance(root, Variable) and root.kind == "temporary"):
                    return place
    return None


def _stamped(s: Stmt, clocks: set[Place]) -> Place | None:
    """The integer to which a statement gives the value of a count, or of a copy of one."""
    place = _written(s)
    if place is None or not isinstance(s, Assign):
        return None
    match bare(s.value):
        case Load(lvalue=LValue(root=Variable(kind="local" | "parameter"), indices=[])) | Call():
            return place
        case Load() as e if _scalar(e) in clocks:
            return place
    return None


def _compared_times(s: If) -> dict[Place, str]:
    """The integers that a test compares by order, each alone or subtracted from another one."""
    found: dict[Place, str] = {}
    for p in parts(s.test):
        if isinstance(p, Compare) and p.op not in ("==", "!="):
            for side in (bare(p.left), bare(p.right)):
                inner = bare(side.right) if isinstance(side, Binary) and side.op == "-" else side
                if (place := _scalar(inner)) is not None:
                    found[place] = source_text(inner)
    return found


def _deed(s: Stmt) -> _Deed | None:
    """What a statement does, if it does the same whenever it runs."""
    match s:
        case Assign(target=LValue() as target, value=value):
            place, given = _place(target), bare(value)
            if place is not None and isinstance(given, Const) and not target.indices:
                return place, target.text, given.value
        case Assign(target=RegisterRef() as target, value=value):
            given = bare(value)
            if isinstance(given, Const):
                return register_text(target), given.value
        case Evaluate(value=Call(function=Function(path=path), arguments=arguments)):
            given_ones = [bare(each) for each in arguments]
            if all(isinstance(each, Const) for each in given_ones):
                return path, tuple(each.value for each in given_ones if isinstance(each, Const))
    return None
