"""Static check of a SOC of an ADC that is set up twice, where the next one lacks what was set: `dead-store`.

    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 3;      // copied: of SOC1, CHSEL is set nowhere
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC1CTL.bit.TRIGSEL = 5;

Both results are then of other channels than meant.  The check needs a whole program, which sets another field of the
next SOC, and reads its result.  Only settings of registers may stand between the two.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Call, Field, RegisterAt, RegisterLoad, RegisterRef, Stmt
from emulator.c28x.tree_queries import all_blocks, statements, within

_CONTROL: Final = re.compile(r"ADCSOC(\d+)CTL$")
#: The ADC, its SOC, and the field.
_Setting = tuple[str, int, str]


def check_copied_socs(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the second setting of a field of a SOC where that of the next SOC is missing."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    if not any(function.name == "main" and function.body for function in owners):
        return
    every = [s for function in owners for s in statements(function.body)]
    given = {setting for s in every if (setting := _setting(s)) is not None}
    if not given or any(map(_by_other_ways, every)):
        return
    read = {
        (found[1], int(found[2])) for function in owners for p in within(function.body)
        if isinstance(p, RegisterLoad) and isinstance(p.register, RegisterRef)
        and (found := re.match(r"(Adc[a-d])ResultRegs ADCRESULT(\d+)$", f"{p.register.block} {p.register.register}"))
    }  # fmt: skip
    for function, report in owners.items():
        for block in all_blocks(function.body):
            for first, again, (adc, soc, field) in _twice(block):
                following = {name for one, number, name in given if (one, number) == (adc, soc + 1)}
                if following and not following & {field, ""} and (adc, soc + 1) in read:
                    name = f"{adc}Regs.ADCSOC{soc}CTL.{field}"
                    message = (
                        f"{name} was set in line {first.where.line}, and is set again; {field} of SOC{soc + 1}, whose "
                        "result the program reads, is set nowhere"
                    )
                    report.report(function, again.where, "dead-store", message, object=name)


def _setting(s: Stmt) -> _Setting | None:
    """The field of a SOC's control register that a statement sets; without a name, it is all of it."""
    match s:
        case Assign(target=RegisterRef(block=block, register=register, field=field)):
            found = _CONTROL.match(register)
            if found is not None:
                return block.removesuffix("Regs"), int(found[1]), field.name if isinstance(field, Field) else ""
    return None


def _by_other_ways(s: Stmt) -> bool:
    """Whether a statement may set up a SOC by a pointer, or by a function of driverlib."""
    if isinstance(s, Assign) and isinstance(s.target, RegisterAt) and _CONTROL.match(s.target.name):
        return True
    return any(isinstance(p, Call) and p.function.name == "ADC_setupSOC" for p in within([s]))


def _twice(block: list[Stmt]) -> Iterator[tuple[Stmt, Stmt, _Setting]]:
    """The settings of one field to two constants, with only settings of registers between them."""
    known: dict[_Setting, Assign] = {}
    for s in block:
        if not isinstance(s, Assign) or isinstance(s.target, RegisterAt) or not isinstance(s.target, RegisterRef):
            known = {}
            continue
        setting, value = _setting(s), constant_of(s.value)
        if setting is None or not setting[2] or value is None:
            continue
        before = known.get(setting)
        if before is not None and constant_of(before.value) != value:
            yield before, s, setting
        known[setting] = s
