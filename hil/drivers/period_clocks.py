"""Finds periods that a program reckons with another clock than the one that their counter counts.

    CpuTimer1Regs.TPR.all = 1;
    CpuTimer1Regs.PRD.all = SYSCLK_HZ / speed - 1;      // every second tick of SYSCLK is counted

The name of the constant states a clock.  Only an object beside it makes the period: a frequency that divides it, or a
time in its unit.  Another number beside them may make up for the prescaler.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import frexp, isclose, log10
from typing import Final, NamedTuple

from emulator.c28x.passes.stamps import key_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Binary, Call, Const, Expr, Function, Load, RegisterRef, Stmt, Variable
from emulator.c28x.tree_queries import bare, own_nodes, statements
from emulator.chip import Chip
from hil.drivers.clock_names import clock_by_name
from hil.drivers.hardware_counts import HardwareCounts, TimeRegister, set_by_call, started_timers, time_register
from hil.drivers.stated_units import as_written, comment_beside, stated
from hil.drivers.unit_names import PhysicalUnit
from hil.drivers.units import UnitMismatch, product_of

#: The registers that hold the period of a counter.
_PERIODS: Final = frozenset({"PRD", "TBPRD"})
#: An integer divider rounds.
_ALMOST: Final = 0.05
#: CHOICE: from here on, a power of two or of ten may be the scale of an object: tenths, or bits of a fraction.
_LEAST_SCALE: Final = 4
_FRACTION: Final = 1e-6
#: So many steps back to what an object was given are looked at.
_DEPTH: Final = 3


class _ClockedPeriod(NamedTuple):
    """A period as the source reckons it: with which clock, and from what."""

    name: str
    clock_hz: float
    #: The unit of the other factor is known, so that no scale of its own can be meant.
    certain: bool


class _PeriodSetting(NamedTuple):
    """A statement that sets a period."""

    function: Function
    statement: Stmt
    register: TimeRegister
    value: Expr


def misreckoned_periods(modules: Iterable[Module], chip: Chip) -> Iterator[UnitMismatch]:
    """The statements that set a period that they reckon with a clock by its name, which its counter does not have."""
    modules = list(modules)
    settings = [found for module in modules for function in module.functions for found in _settings(function)]
    if not settings:
        return
    given = HardwareCounts(modules).given
    started = started_timers(modules)
    reckoned = [(each, found) for each in settings if (found := _reckoned(each.value, given)) is not None]
    for each, found in reckoned:
        tick = each.register.tick_seconds(chip, started)
        clocks = {other.clock_hz for setting, other in reckoned if setting.register == each.register}
        if tick is None or len(clocks) > 1:
            continue
        real = 1 / tick
        ratio = max(found.clock_hz / real, real / found.clock_hz)
        if isclose(ratio, 1.0, rel_tol=_ALMOST) or (not found.certain and _may_be_a_scale(ratio)):
            continue
        message = (
            f"{each.register.name} is reckoned with {found.name}, {found.clock_hz / 1e6:g} million counts a second, "
            f"and {each.register.counter} counts {real / 1e6:g} million times"
        )
        function, s = each.function, each.statement
        place = Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
        yield UnitMismatch(place, message, found.name, "count-by-name")


def _settings(function: Function) -> Iterator[_PeriodSetting]:
    for s in statements(function.body):
        if isinstance(s, Assign) and isinstance(s.target, RegisterRef):
            register = time_register(s.target)
            if register is not None and register.name in _PERIODS:
                yield _PeriodSetting(function, s, register, s.value)
        for p in own_nodes(s):
            register = set_by_call(p.function, p.arguments) if isinstance(p, Call) else None
            if isinstance(p, Call) and register is not None and register.name in _PERIODS:
                yield _PeriodSetting(function, s, register, p.arguments[-1])


_Given = list[tuple[tuple[object, ...], Expr]]


def _reckoned(e: Expr, given: _Given, deep: int = _DEPTH) -> _ClockedPeriod | None:
    """The clock from which an object makes a period; None: it is made of something else too."""
    e = _without_one(e)
    if isinstance(e, Load):
        values = [value for other, value in given if other == key_of(e.lvalue)]
        return _reckoned(values[0], given, deep - 1) if deep and len(values) == 1 else None
    clocks: list[tuple[str, float, float]] = []  # with the number itself
    objects: list[tuple[Load, bool]] = []
    for factor, divides in product_of(e):
        number = as_written(factor)
        clock = clock_by_name(number)
        if isinstance(number, Const) and clock is not None and not divides:
            clocks.append((*clock, float(number.value)))
        elif isinstance(number, Load):
            objects.append((number, divides))
        else:
            return None
    if len(clocks) != 1 or len(objects) != 1:
        return None
    (name, hz, stated_number), (load, divides) = clocks[0], objects[0]
    scale = hz / stated_number  # 1e6 of a clock in MHz
    unit = _unit(load)
    if unit is None:
        sources = [value for other, value in given if other == key_of(load.lvalue)]
        right = divides and scale == 1.0 and not any(map(_has_factor, sources))
    else:
        quantity, size = ("frequency", scale) if divides else ("time", 1 / scale)
        right = unit.quantity == quantity and isclose(unit.scale, size)
    return _ClockedPeriod(name, hz, unit is not None) if right else None


def _unit(load: Load) -> PhysicalUnit | None:
    """The unit of an object by its name or its comment."""
    root = load.lvalue.root
    if not isinstance(root, Variable) or load.lvalue.indices:
        return None
    declared = root.declaration
    found = stated(declared.name, comment_beside(declared.where, declared.name))
    return found.unit if found is not None else None


def _without_one(e: Expr) -> Expr:
    """A value without the 1 by which a period is less than its counts."""
    match bare(e):
        case Binary(op="-", left=left, right=right) if isinstance(one := bare(right), Const) and one.value == 1:
            return bare(left)
        case other:
            return other


def _has_factor(e: Expr) -> bool:
    """Whether a value is a product or a quotient with a constant, which may make up for a prescaler."""
    match bare(e):
        case Binary(op="*" | "/" | "<<" | ">>", left=left, right=right):
            return isinstance(bare(left), Const) or isinstance(bare(right), Const)
    return False


def _may_be_a_scale(ratio: float) -> bool:
    """Whether an object can be so many times what its counter makes of it."""
    power_of_two = isclose(frexp(ratio)[0], 0.5, rel_tol=_FRACTION)
    power_of_ten = isclose(log10(ratio), round(log10(ratio)), abs_tol=_FRACTION)
    return ratio >= _LEAST_SCALE * (1 - _FRACTION) and (power_of_two or power_of_ten)
