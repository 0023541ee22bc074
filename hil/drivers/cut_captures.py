"""Finds captures and counts of which 16 bits are kept, so that a test of what becomes of them has one outcome only.

    Uint16 echoTicks;
    echoTicks = ECap1Regs.CAP2;                 // 32 bits; the lower half wraps after 328 us
    ...
    if (millimetres(echoTicks) < 200) ...       // 65535 counts are 56 mm

Sixteen bits are enough for short pulses.  What says that they are not is the program: it compares what it makes of
the object with a limit that no 16 bits can reach, and that 32 bits can.  The bounds are followed through
assignments, parameters and results, whatever the order of statements.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.intervals import bounds
from emulator.c28x.passes.stamps import CAPTURES
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Compare,
    Const,
    Convert,
    Expr,
    Function,
    FunctionRef,
    Interval,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
)
from emulator.c28x.tree_queries import assigned, gives, own_nodes, source_text, statements
from hil.drivers.units import UnitMismatch

#: The registers of 32 bits: captures, and counters that run.
_COUNTS: Final = frozenset({*CAPTURES, "TSCTR", "TIM"})
#: All that 32 bits hold.
_WHOLE: Final = (0, 0xFFFF_FFFF)


class _Cut(NamedTuple):
    """A statement that gives the lower half of a count to an object."""

    function: Function
    statement: Stmt
    read: Expr


def cut_captures(modules: Iterable[Module]) -> Iterator[UnitMismatch]:
    """The statements that keep 16 bits of a count without a cast, where a test then has one outcome only."""
    functions = [function for module in modules for function in module.functions]
    given = _Given(functions)
    cuts = {variable: found for variable in given.values if (found := given.cut(variable)) is not None}
    tests = [
        (function, s, p) for function in functions if cuts
        for s in statements(function.body) for p in own_nodes(s) if isinstance(p, Compare)
    ]  # fmt: skip
    for variable, cut in cuts.items():
        for _, s, test in tests:
            now, whole = (given.outcome(test, known) for known in ({}, {variable: _WHOLE}))
            if now is None or whole is not None:
                continue
            name = variable.declaration.name
            message = (
                f"{name} keeps 16 bits of {source_text(cut.read)}, up to 65535: {source_text(test.left)} {test.op} "
                f"{source_text(test.right)} in line {s.where.line} is always {'true' if now else 'false'} then"
            )
            function, at = cut.function, cut.statement.where
            place = Place(function.where.file, at.line, function.name, function.c_file, at.column)
            yield UnitMismatch(place, message, name, "narrowed")
            break


class _Given:
    """What a program gives to its scalars, and what its functions return; the bounds that follow."""

    def __init__(self, functions: list[Function]) -> None:
        self.values: dict[Variable, list[tuple[Function, Stmt, Expr]]] = {}
        self._results: dict[str, list[Expr]] = {}
        #: Objects that something else changes too: a loop, a part of a statement, whoever has their address.
        self._open: set[Variable] = set()
        for function in functions:
            for s in statements(function.body):
                self._read(function, s)

    def _read(self, function: Function, s: Stmt) -> None:
        match gives(s):
            case LValue(root=Variable() as variable, indices=[], bits=None), Expr() as value:
                self.values.setdefault(variable, []).append((function, s, value))
            case _ if (changed := assigned(s)) is not None:
                self._open.add(changed)
        match s:
            case Assign(target=LValue(root=Variable() as root) as target) if target.indices or target.bits is not None:
                self._open.add(root)
        if isinstance(s, Return) and s.value is not None:
            self._results.setdefault(function.path, []).append(s.value)
        for p in own_nodes(s):
            if isinstance(p, Call):
                for parameter, argument in zip(p.function.parameters, p.arguments, strict=False):
                    self.values.setdefault(parameter, []).append((function, s, argument))
            elif isinstance(p, FunctionRef):
                self._open.update(p.function.parameters)

    def cut(self, variable: Variable) -> _Cut | None:
        """The statement that gives an object the lower half of a count; None: it gets something else too."""
        if not isinstance(variable.ctype, IntType) or variable.ctype.bits != 16 or self._is_open(variable):
            return None
        found: _Cut | None = None
        for function, s, value in self.values[variable]:
            match value:
                case Const():
                    continue
                case Convert(explicit=False, operand=RegisterLoad(register=RegisterRef(bits=32, field=None) as count)):
                    if count.register not in _COUNTS:
                        return None
                    found = found or _Cut(function, s, value.operand)
                case _:
                    return None
        return found

    def outcome(self, test: Compare, known: Mapping[Variable, Interval]) -> bool | None:
        """The only outcome of a comparison by order; None: it can have both, or it is another comparison."""
        if not isinstance(test.left.ctype, IntType):
            return None
        (a, b), (c, d) = self._bounds(test.left, known), self._bounds(test.right, known)
        match test.op:
            case "<" | ">=" if b < c or a >= d:
                return (b < c) == (test.op == "<")
            case "<=" | ">" if b <= c or a > d:
                return (b <= c) == (test.op == "<=")
        return None

    def _is_open(self, variable: Variable) -> bool:
        return variable in self._open or variable.escapes or variable not in self.values

    def _bounds(
        self, e: Expr, known: Mapping[Variable, Interval], within: frozenset[Variable | str] = frozenset()
    ) -> Interval:  # fmt: skip
        """The bounds of an integer; `within`: what they are being found for, which has those of its type."""
        ctype = e.ctype
        if not isinstance(ctype, IntType):
            return _WHOLE
        match e:
            case Load(lvalue=LValue(root=Variable() as variable, indices=[], bits=None)) if variable not in known:
                sources = [] if self._is_open(variable) else [value for _, _, value in self.values[variable]]
                sources += variable.initial or [] if sources else []
                start = [(0, 0)] if variable.kind == "global" and not variable.initial else []
                key: Variable | str = variable
            case Call(function=function) if not function.extern:
                sources, start, key = self._results.get(function.path, []), [], function.path
            case _:
                return bounds(e, known, lambda operand: self._bounds(operand, known, within))
        if not sources or key in within or not all(isinstance(value.ctype, IntType) for value in sources):
            return ctype.low, ctype.high
        found = [*start, *(self._bounds(value, known, within | {key}) for value in sources)]
        low, high = min(low for low, _ in found), max(high for _, high in found)
        return (low, high) if ctype.low <= low and high <= ctype.high else (ctype.low, ctype.high)
