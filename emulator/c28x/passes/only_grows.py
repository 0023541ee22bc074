"""Static check of indices that only grow: `table-short`.

    ring[head] = c;
    head++;                     // in an interrupt routine that comes again and again, and nothing sets head back

In a program with `main`, each statement that changes the index adds a constant, besides a start value that `main` sets
before its last loop.  The function that adds is `main` in this loop, or the routine of an interrupt that no statement
has to ask for.  So the index leaves the array sooner or later.

Silent if anything else reads the index (it may test, mask or hand it on), and if a test in the function depends on an
object of the program, which may limit the index.  One such test is known: `head + 1 != tail`, where `tail` stays within
the array.  It holds behind the end of the array too.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import IntType
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
    Declare,
    Expr,
    For,
    Function,
    FunctionRef,
    If,
    Load,
    LValue,
    RegisterRef,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, last_loop, own_nodes, parts, statements, without_end

#: The vectors of interrupts that come by themselves: those of a bus come for what the program sends.
_BY_ITSELF: Final = re.compile(r"(TIMER[012]|EPWM\d+|XINT\d|SCI[A-D]_RX)_INT")
#: Functions that may keep an interrupt from coming again; DINT does so until the next EINT only.
_STOPS: Final = re.compile(r"disable[A-Z]|[a-z]_?disable|stop", re.IGNORECASE)
#: The registers that let an interrupt come.
_LETS: Final = re.compile(r"TCR|I[EF]R|PIEIER\d+|ETSEL|XINT\dCR|SCIFFRX|SCICTL2")


def check_only_grows(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the elements of arrays that are accessed by an index that only grows."""
    functions = [function for module in modules for function in module.functions]
    main = next((f for f in functions if f.name == "main"), None)
    loop = last_loop(main) if main is not None else None
    if main is None or loop is None:
        return
    repeated = {main: list(statements(loop.body))} if without_end(loop) else {}
    for routine in _routines(functions):
        repeated[routine] = list(statements(routine.body))
    if any(_lets(s) for s in _run_by(repeated.values(), functions)):
        return
    uses = _IndexUses(functions, main, loop)
    for module, report in reports.items():
        for function in module.functions:
            for variable in uses.grown_in(repeated.get(function, [])):
                _check(function, repeated[function], variable, uses, report)


class _Advanced(NamedTuple):
    """The value of an object, and a constant; `reads`: the identities of the reads that lead to it."""

    variable: Variable
    by: int
    reads: frozenset[int]


class _IndexUses:
    """How a program uses its integers at file scope."""

    def __init__(self, functions: list[Function], main: Function, last: While) -> None:
        self._before = {id(s) for s in main.body[: next(n for n, s in enumerate(main.body) if s is last)]}
        #: The values that a variable gets; the objects whose address is taken, or that a loop counts.
        self.values: dict[Variable, list[Expr]] = {}
        self.open: set[Variable] = set()
        #: Identity of a statement -> the object that it steps.
        self._steps: dict[int, Variable] = {}
        self._reads: dict[Variable, list[Load]] = {}
        #: The reads for a step or a subscript.
        self._known: set[int] = set()
        self.compares: dict[Variable, list[Compare]] = {}
        found = [s for function in functions for s in statements(function.body)]
        self._copies = _copies(found)
        for s in found:
            self._take(s)

    def _take(self, s: Stmt) -> None:
        match s:
            case Assign(target=LValue(root=Variable() as variable, indices=[]), value=value):
                old = self.advanced(value)
                if old is not None and old.variable is variable and old.by > 0:
                    self._steps[id(s)] = variable
                    self._known |= old.reads
                elif id(s) not in self._before or not isinstance(bare(value), Const):
                    self.values.setdefault(variable, []).append(value)
            case Assign(target=LValue(root=Variable() as variable)):  # through a pointer, or an element
                self.open.add(variable)
            case For(counter=counter):
                self.open.add(counter)
        for p in own_nodes(s):
            match p:
                case AddressOf(lvalue=LValue(root=Variable() as root)):
                    self.open.add(root)
                case Load(lvalue=LValue(root=Variable() as root)):
                    self._reads.setdefault(root, []).append(p)
                case Compare(op="!=" | "=="):
                    for side in (p.left, p.right):
                        if (read := self.advanced(side)) is not None:
                            self.compares.setdefault(read.variable, []).append(p)
            if isinstance(p, LValue):
                for index in p.indices:
                    if (read := self.advanced(index.expr)) is not None:
                        self._known |= read.reads

    def advanced(self, e: Expr) -> _Advanced | None:
        """What an expression adds to an object at file scope, which it may read from a local copy."""
        match bare(e):
            case Binary(op="+", left=left, right=right):
                for old, step in ((left, bare(right)), (right, bare(left))):
                    if isinstance(step, Const) and isinstance(step.value, int) and step.value > 0:
                        read = self.advanced(old)
                        return None if read is None else read._replace(by=read.by + step.value)
            case Load(lvalue=LValue(root=Variable(kind="global") as root, indices=[])) as load:
                return _Advanced(root, 0, frozenset({id(load)}))
            case Load(lvalue=LValue(root=Variable() as root, indices=[])) as load if root in self._copies:
                read = self.advanced(self._copies[root])
                return None if read is None else read._replace(reads=read.reads | {id(load)})
        return None

    def grown_in(self, body: list[Stmt]) -> list[Variable]:
        """The objects that statements step, and that nothing else in the program changes."""
        grown = dict.fromkeys(self._steps[id(s)] for s in body if id(s) in self._steps)
        return [
            v for v in grown
            if v.kind == "global" and isinstance(v.ctype, IntType) and v not in self.open and v not in self.values
        ]  # fmt: skip

    def only_indexes(self, variable: Variable, bound: int) -> bool:
        """Whether an object is read as an index only, and compared with what stays within so many elements."""
        known = {*self._known}
        for compare in self.compares.get(variable, []):
            left, right = self.advanced(compare.left), self.advanced(compare.right)
            if left is None or right is None:
                return False
            other = right if left.variable is variable else left
            if other.by or not self._stays_within(other.variable, bound):
                return False
            known |= left.reads | right.reads
        copies = (
            local for local, value in self._copies.items()
            if (read := self.advanced(value)) is not None and read.variable is variable
        )  # fmt: skip
        return not any(
            id(read) not in known for each in (variable, *copies) for read in self._reads.get(each, [])
        )  # fmt: skip

    def _stays_within(self, variable: Variable, bound: int) -> bool:
        """Whether statements give an object only indices of so many elements, at least one of them a step around."""
        values = [bare(value) for value in self.values.get(variable, [])]
        if variable.kind != "global" or variable in self.open or variable in self._steps.values() or not values:
            return False
        for value in values:
            match value:
                case Const(value=int() as number) if 0 <= number < bound:
                    pass
                case Binary(op="&", right=Const(value=int() as mask)) if 0 <= mask < bound:
                    pass
                case Binary(op="%", right=Const(value=int() as length)) if 0 < length <= bound:
                    pass
                case _:
                    return False
        return any(isinstance(value, Binary) for value in values)


def _check(function: Function, body: list[Stmt], variable: Variable, uses: _IndexUses, report: StaticReport) -> None:
    if _limited(function, body, variable, uses):
        return
    for s in body:
        for lvalue in own_nodes(s):
            if not isinstance(lvalue, LValue) or not isinstance(lvalue.root, Variable):
                continue
            for index in lvalue.indices:
                at = uses.advanced(index.expr)
                if at is None or at.variable is not variable or index.bound is None:
                    continue
                reaches = isinstance(variable.ctype, IntType) and index.bound <= variable.ctype.high
                if reaches and uses.only_indexes(variable, index.bound):
                    name = variable.declaration.name
                    array = lvalue.root.declaration
                    message = (
                        f"{name} only grows: no statement sets it back, so {array.name}[{name}] is behind the end of "
                        f"{array.name}, which has {index.bound} elements, after so many steps"
                    )
                    report.report(
                        function, s.where, "table-short", message, object=array.path, declaration=array
                    )  # fmt: skip
                    return


def _limited(function: Function, body: list[Stmt], variable: Variable, uses: _IndexUses) -> bool:
    """Whether a test in the function may depend on what the program does."""
    known = [compare for compare in uses.compares.get(variable, []) if compare.op == "!="]
    for s in body:
        for test in _tests(s):
            if not any(bare(test) is compare for compare in known) and not _of_hardware(test, function, ()):
                return True
    return False


def _tests(s: Stmt) -> Iterator[Expr]:
    yield from (p.test for p in own_nodes(s) if isinstance(p, Conditional))
    match s:
        case If(test=test) | While(test=test) | Switch(subject=test):
            yield test


def _of_hardware(e: Expr, function: Function, through: tuple[Variable, ...]) -> bool:
    """Whether a value comes from registers and constants only."""
    for p in parts(e):
        match p:
            case Call() | CallPointer() | LValue(root=Expr()):
                return False
            case Load(lvalue=LValue(root=Variable() as root)):
                if root.kind == "global" or root in function.parameters or root in through:
                    return False
                for s in statements(function.body):
                    match s:
                        case Assign(target=LValue(root=target), value=value) if target is root:
                            pass
                        case Declare(variable=target, value=Expr() as value) if target is root:
                            pass
                        case _:
                            continue
                    if not _of_hardware(value, function, (*through, root)):
                        return False
    return True


def _copies(found: list[Stmt]) -> dict[Variable, Expr]:
    """The locals that get one value only, which does not depend on them, with this value."""
    values: dict[Variable, list[Expr]] = {}
    for s in found:
        match s:
            case Assign(target=LValue(root=Variable() as variable, indices=[]), value=value) | Declare(
                variable=variable, value=Expr() as value
            ) if variable.kind != "global":  # fmt: skip
                values.setdefault(variable, []).append(value)
    return {
        variable: first for variable, (first, *more) in values.items()
        if not more and not any(isinstance(p, Variable | LValue) and _local(p) for p in parts(first))
    }  # fmt: skip


def _local(p: Variable | LValue) -> bool:
    root = p.root if isinstance(p, LValue) else p
    return not isinstance(root, Variable) or root.kind != "global"


def _routines(functions: list[Function]) -> Iterator[Function]:
    """The routines of interrupts that come by themselves."""
    by_path = {function.path: function for function in functions}
    for function in functions:
        for s in statements(function.body):
            match s:
                case Assign(target=RegisterRef(block="PieVectTable", register=vector), value=value):
                    if _BY_ITSELF.fullmatch(vector):
                        for p in parts(value):
                            if isinstance(p, FunctionRef) and p.function.path in by_path:
                                yield by_path[p.function.path]


def _run_by(bodies: Iterable[list[Stmt]], functions: list[Function]) -> Iterator[Stmt]:
    """The statements of bodies, and of the functions that these call, or that anything calls by a pointer."""
    by_path = {function.path: function for function in functions}
    waiting = [*bodies, [s for f in functions for s in statements(f.body) if _names_functions(s)]]
    met: set[str] = set()
    while waiting:
        for s in waiting.pop():
            if not _names_functions(s):
                yield s
            for p in own_nodes(s):
                if isinstance(p, Call | FunctionRef) and p.function.path not in met:
                    met.add(p.function.path)
                    if p.function.path in by_path:
                        waiting.append(list(statements(by_path[p.function.path].body)))


def _names_functions(s: Stmt) -> bool:
    return any(isinstance(p, FunctionRef) for p in own_nodes(s))


def _lets(s: Stmt) -> bool:
    """Whether a statement may keep an interrupt from coming again."""
    if any(isinstance(p, Call) and _STOPS.search(p.function.name) for p in own_nodes(s)):
        return True
    target: Any = s.target if isinstance(s, Assign) else None
    return isinstance(target, RegisterRef) and _LETS.fullmatch(target.register) is not None
