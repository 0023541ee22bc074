"""Finds steps of an eQEP that become a huge number when the shaft turns back.

    Uint32 steps = position - last;         // one step back is 4294967295
    speed = steps * 0.3f;

The position goes up and down where the eQEP decodes two signals in quadrature.  A difference without a sign is right
as long as it stays one: added to a position, or cast to a signed type.  It is wrong as a float, and where it is
divided.  A program that compares steps or positions by order, or asks for the direction, may take care of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Call, Compare, Const, Convert, Expr, Load, RegisterLoad, RegisterRef
from emulator.c28x.tree_queries import bare, own_nodes, parts, source_text, statements
from emulator.chip import Chip
from emulator.registers.eqep import QDECCTL
from hil.drivers.hardware_counts import HardwareCounts, field
from hil.drivers.units import UnitMismatch

#: The registers that hold a position.
_POSITIONS: Final = {"EQep": frozenset({"QPOSCNT", "QPOSLAT"})}
#: Functions of driverlib that return one; and those that say which way the shaft turns.
_FUNCTIONS: Final = {"EQEP_getPosition": "EQep", "EQEP_getPositionLatch": "EQep"}
_DIRECTION: Final = frozenset({"EQEP_getDirection", "EQEP_getStatus"})
_ORDERS: Final = frozenset({"<", "<=", ">", ">="})
#: So many copies back steps are followed.
_DEPTH: Final = 4


def huge_steps(modules: Iterable[Module], chip: Chip) -> Iterator[UnitMismatch]:
    """The statements in which steps without a sign become a float or are divided."""
    modules = list(modules)
    nodes = [
        (function, s, p) for module in modules for function in module.functions
        for s in statements(function.body) for p in own_nodes(s)
    ]  # fmt: skip
    read = [p.register for _, _, p in nodes if isinstance(p, RegisterLoad) and isinstance(p.register, RegisterRef)]
    called = {p.function.name for _, _, p in nodes if isinstance(p, Call)}
    by_name = any(register.register in _POSITIONS["EQep"] for register in read)
    if not (by_name or called & _FUNCTIONS.keys()) or called & _DIRECTION:
        return
    positions = HardwareCounts(modules, _POSITIONS, _FUNCTIONS)
    steps = _Steps(positions)
    directed = {register.block for register in read if register.register == "QEPSTS"}
    compared = {
        steps.counter_of(e) or positions.counter_of(e)
        for _, _, p in nodes if isinstance(p, Compare) and p.op in _ORDERS
        for e in parts(p) if isinstance(e, Expr)
    }  # fmt: skip
    for function, s, p in nodes:
        match p:
            case Convert(ctype=FloatType(), operand=value):
                then = "becomes a float"
            case Binary(op="/", ctype=IntType(), left=value, right=by) if isinstance(bare(by), Const):
                then = "is divided"
            case _:
                continue
        value = _first(value)
        counter = steps.counter_of(value)
        if not counter or counter in compared or f"{counter}Regs" in directed:
            continue
        if field(chip.register(f"{counter}Regs", "QDECCTL").value, QDECCTL.QSRC):
            continue
        text = source_text(value)
        message = f"{text} has no sign, and {then}: a step back of {counter} is not -1, but {2**32 - 1}"
        place = Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
        yield UnitMismatch(place, message, text, "unsigned-wrap")


def _first(e: Expr) -> Expr:
    """The first factor of a product."""
    while isinstance(e, Binary) and e.op == "*":
        e = e.left
    return e


class _Steps:
    """The differences of two positions of one eQEP that have 32 bits and no sign."""

    def __init__(self, positions: HardwareCounts) -> None:
        self._positions = positions
        self._given: dict[Key, list[Expr]] = {}
        for key, value in positions.given:
            self._given.setdefault(key, []).append(value)

    def counter_of(self, e: Expr, deep: int = _DEPTH) -> str:
        """The eQEP whose steps a value is, also by copies; "": it is another value."""
        while isinstance(e, Convert) and isinstance(e.ctype, IntType) and not e.ctype.signed and e.ctype.bits == 32:
            e = e.operand
        if not isinstance(e.ctype, IntType) or e.ctype.signed or e.ctype.bits != 32:
            return ""
        match e:
            case Binary(op="-", left=left, right=right) if not isinstance(bare(right), Const):
                one, other = self._positions.counter_of(left), self._positions.counter_of(right)
                return one if one == other else ""
            case Load(lvalue=lvalue) if deep:
                values = [value for value in self._given.get(key_of(lvalue) or (), []) if not isinstance(value, Const)]
                found = {self.counter_of(value, deep - 1) for value in values}
                return next(iter(found)) if len(found) == 1 else ""
        return ""
