"""Finds least duties whose pulses the dead band of an ePWM swallows.

    #define DUTY_MIN    125u            // of 2500: 5 %
    ...
    EPwm2Regs.CMPA.bit.CMPA = DUTY_MIN;

A dead band delays one edge of a pulse.  A pulse that is shorter than the delay does not come out at all.  A controller
that goes through small duties may mean that.  But a constant that is the least duty by its name is one because the
pulses from there on come out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Const, Declare, Expr, Function, Load, LValue, RegisterRef, Stmt, Variable
from emulator.c28x.tree_queries import bare, statements
from emulator.chip import Chip
from emulator.clock import SYSCLK_HZ
from emulator.peripherals.epwm_outputs import SwallowedPulse
from hil.drivers.stated_units import defined_number
from hil.drivers.unit_names import words_of
from hil.drivers.units import UnitMismatch

#: The words of a name that say that it is a least value.
_LEAST: Final = frozenset({"min", "minimum", "minimal", "least", "lowest", "smallest"})
#: CHOICE: a pulse that is a smaller part of the period only keeps the compare value away from 0.
_PART: Final = 0.01

_Set = tuple[Function, Stmt, Expr]


def swallowed_pulses(modules: Iterable[Module], chip: Chip) -> Iterator[UnitMismatch]:
    """The statements that set a duty, the least one by the name of a constant, of which no pulse came out."""
    functions = [function for module in modules for function in module.functions]
    compares: dict[tuple[str, str], list[_Set]] = {}
    objects: dict[Variable, list[_Set]] = {}
    for function in functions:
        for s in statements(function.body):
            match s:
                case Assign(target=RegisterRef(block=block, register=register), value=value):
                    compares.setdefault((block, register), []).append((function, s, value))
                case Assign(target=LValue(root=Variable() as variable, indices=[]), value=value):
                    objects.setdefault(variable, []).append((function, s, value))
                case Declare(variable=variable, value=Expr() as value):
                    objects.setdefault(variable, []).append((function, s, value))
    for n, epwm in chip.epwm.items():
        for pulse in epwm.swallowed:
            direct = compares.get((f"EPwm{n}Regs", pulse.compare), [])
            given = [each for _, _, value in direct if (v := _variable(value)) for each in objects.get(v, ())]
            for function, s, value in (*direct, *given) if _PART * pulse.period < pulse.cycles else ():
                name, number = _constant(value)
                if number == pulse.value and _LEAST.intersection(words_of(name)):
                    place = Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
                    yield UnitMismatch(place, _message(name, n, pulse), pulse.output, "pulse-swallowed")
                    break


def _constant(e: Expr) -> tuple[str, float]:
    """The name of a constant, and its value; "" and 0: it is something else."""
    constant = bare(e)
    while isinstance(constant, Const) and constant.source is not None:
        constant = bare(constant.source)
    return (defined_number(constant)[0], constant.value) if isinstance(constant, Const) else ("", 0)


def _variable(e: Expr) -> Variable | None:
    match bare(e):
        case Load(lvalue=LValue(root=Variable() as variable, indices=[])):
            return variable
    return None


def _message(name: str, n: int, pulse: SwallowedPulse) -> str:
    width, delay = (cycles / SYSCLK_HZ * 1e6 for cycles in (pulse.cycles, pulse.delay))
    return (
        f"{name} is the least duty by its name, {pulse.value} counts in EPwm{n}Regs.{pulse.compare}: its pulses of "
        f"{width:.4g} us are shorter than the dead band, {pulse.register} of {delay:.4g} us, and none came out of "
        f"{pulse.output}"
    )
