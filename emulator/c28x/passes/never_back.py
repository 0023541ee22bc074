"""Static check of marks that received data are valid, which nothing takes back: `one-sided`.

    limit.torque = word;
    limit.valid = 1;

The sender falls silent, and the last data hold for ever.  The check needs a whole program.  It knows members of
structures whose name says that the others are valid, that all statements only set to one value, beside data, where the
program comes again and again, and that are tested elsewhere.

A mark may also mean "at least once", if the age of the data is known by something else: a stamp, a count, a call, or
anything that is set back beside the data.  So then nothing is reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, CType, PointerType, StructType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    CallPointer,
    Conditional,
    CopyStruct,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    bare,
    below,
    blocks,
    called,
    calls,
    last_loop,
    named_scalar,
    own_nodes,
    parts,
    statements,
    within,
)

#: Names of members that say that the others hold.
_MARKS: Final = re.compile(r"valid|fresh|alive|online|present|connected", re.IGNORECASE)
#: Names of structures and members that are meant to stay.
_STAYS: Final = re.compile(
    r"latch|trip|fault|fail|lock|sticky|perman|init|once|first|calib|config|setting", re.IGNORECASE
)

#: A statement that sets a mark: its function, the statements of its block, and the tests around it.
_Setting = tuple[Function, Assign, list[Stmt], list[Expr]]


def check_never_back(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the marks of a whole program that are only set."""
    functions = [function for module in modules for function in module.functions]
    if any(function.name == "main" and function.body for function in functions):
        owners = {function: report for module, report in reports.items() for function in module.functions}
        _Marks([v for module in modules for v in module.variables], functions).check(owners)


class _Marks:
    """The members of structures that are only set to one value, and what speaks against their report."""

    def __init__(self, variables: list[Variable], functions: list[Function]) -> None:
        self._functions = functions
        self._by_path = {function.path: function for function in functions}
        self._settings: dict[NamedScalar, list[_Setting]] = {}
        for function in functions:
            self._walk(function, function.body, [])
        #: Structures that something else may write, or whose age is known.
        self._left_out: set[CType] = set()
        every = [*variables, *(v for f in functions for v in (*f.locals, *f.parameters))]
        for variable in every:
            self._left_out |= set(_inside(variable.ctype))
        for variable in variables:
            if isinstance(variable.ctype, StructType) and any(constant_of(x) != 0 for x in variable.initial or ()):
                self._left_out.add(variable.ctype)
        for function in functions:
            for s in statements(function.body):
                self._look(s)

    def _walk(self, function: Function, block: list[Stmt], tests: list[Expr]) -> None:
        for s in block:
            match s:
                case Assign(target=LValue() as target) if (scalar := named_scalar(target)) is not None:
                    if isinstance(scalar[0], StructType):
                        self._settings.setdefault(scalar, []).append((function, s, block, tests))
            around = [*tests, s.test] if isinstance(s, If | While) else tests
            for inner in blocks(s):
                self._walk(function, inner, around)

    def _look(self, s: Stmt) -> None:
        """Take note of copies into objects at file scope, pointers that leave the program, and of ages."""
        if isinstance(s, CopyStruct) and not (isinstance(s.target.root, Variable) and s.target.root.kind == "local"):
            self._left_out.add(s.target.ctype)
        for p in own_nodes(s):
            match p:
                case Binary(op="-", left=left, right=right):
                    self._left_out |= _holders([left, right])  # an age, or a count down
                case Binary(op="+", left=left) if isinstance(s, Assign) and _same_place(s.target, left):
                    self._left_out |= _holders([left])  # a count
                case Call(function=Function(extern=True), arguments=arguments, extra=extra):
                    self._left_out |= {target for a in (*arguments, *extra) if (target := _pointed(a)) is not None}
                case CallPointer(arguments=arguments):
                    self._left_out |= {target for a in arguments if (target := _pointed(a)) is not None}
                case AddressOf(lvalue=LValue(ctype=ctype) as lvalue) if not isinstance(ctype, StructType):
                    self._left_out |= _holders([Load(ctype, lvalue)])  # a pointer to a member

    def check(self, reports: dict[Function, StaticReport]) -> None:
        again = self._again()
        for mark, settings in self._settings.items():
            function, first, _, _ = settings[0]
            name = re.split(r"\.|->", getattr(first.target, "text", ""))[-1]
            values = {constant_of(s.value) for _, s, _, _ in settings}
            text = getattr(first.target, "text", "")
            if mark[0] in self._left_out or not _MARKS.search(name) or _STAYS.search(text):
                continue
            if len(values) != 1 or values & {None, 0} or not self._tested(mark, {f.path for f, _, _, _ in settings}):
                continue
            comes_again = all(f.path in again[0] or id(s) in again[1] for f, s, _, _ in settings)
            if comes_again and all(self._beside_data(mark, s, block, tests) for _, s, block, tests in settings):
                message = f"nothing takes {text} back: when no more data come, the last ones hold for ever"
                reports[function].report(function, first.where, "one-sided", message, object=text)

    def _again(self) -> tuple[set[str], set[int]]:
        """The functions that run again and again, and the identities of the statements of `main` that do."""
        loops = [loop for f in self._functions if f.name == "main" and (loop := last_loop(f)) is not None]
        inner = [s for loop in loops for s in loop.body]
        begin = [f.path for f in self._functions if f.interrupt]
        found = below([*begin, *called(within(inner))], self._by_path)
        return {f.path for f in found}, {id(s) for s in statements(inner)}

    @staticmethod
    def _beside_data(mark: NamedScalar, s: Assign, block: list[Stmt], tests: list[Expr]) -> bool:
        """Whether a mark is set beside other members, which get data, and nothing there tells their age."""
        if any(mark in _scalars(test) for test in tests):
            return False  # the first time only
        data = False
        for other in block:
            if other is s or isinstance(other, If | For):
                continue
            if calls(getattr(other, "value", None)) or (isinstance(other, Assign) and constant_of(other.value) == 0):
                return False
            if isinstance(other, Assign) and isinstance(other.target, LValue):
                value, scalar = bare(other.value), named_scalar(other.target)
                source = value.lvalue if isinstance(value, Load) else None
                root = source.root if source is not None and not source.indices else None
                if isinstance(root, Variable) and root.kind == "global":
                    return False  # perhaps the time
                data |= scalar is not None and scalar[0] is mark[0] and constant_of(other.value) is None
        return data

    def _tested(self, mark: NamedScalar, writers: set[str]) -> bool:
        """Whether a function tests a mark that does not set it."""
        for function in self._functions:
            if function.path not in writers:
                for s in statements(function.body):
                    tests = [s.test] if isinstance(s, If | While) else []
                    tests += [p.test for p in own_nodes(s) if isinstance(p, Conditional)]
                    if any(mark in _scalars(test) for test in tests):
                        return True
        return False


def _scalars(e: Any) -> set[NamedScalar]:
    return {scalar for p in parts(e) if isinstance(p, LValue) and (scalar := named_scalar(p)) is not None}


def _holders(found: Iterable[Expr]) -> set[CType]:
    """The structures of which expressions are just a member."""
    named = [named_scalar(e.lvalue) for e in map(bare, found) if isinstance(e, Load)]
    return {scalar[0] for scalar in named if scalar is not None and isinstance(scalar[0], StructType)}


def _same_place(target: Any, e: Expr) -> bool:
    inner = bare(e)
    return isinstance(inner, Load) and inner.lvalue == target


def _pointed(e: Expr) -> CType | None:
    """The structure that a pointer points to."""
    ctype = bare(e).ctype
    return ctype.target if isinstance(ctype, PointerType) else None


def _inside(ctype: CType) -> Iterator[CType]:
    """The types of the elements and members of an aggregate, inwards."""
    inner = [ctype.element] if isinstance(ctype, ArrayType) else []
    if isinstance(ctype, StructType):
        inner = [member.ctype for member in ctype.members]
    for each in inner:
        yield each
        yield from _inside(each)
