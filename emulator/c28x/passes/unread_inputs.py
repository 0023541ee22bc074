"""Static check of inputs that a program sets up and never looks at: `input-unused`.

A pin is made an input, or a conversion of the ADC is set up, and no statement reads it: the door switch, the stop
button or the voltage that it is for has no effect.

Pins: a read of the pin or of its whole port, an input of the X-BAR, a function of a peripheral, and any call that gets
the number of the pin is a use.  A pin that is an output at times may be released only.  Conversions: a read of the
result, a post-processing block, any pointer to the results.  The check needs a whole program (one with a `main`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Final

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Expr,
    Function,
    Load,
    LValue,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, own_nodes, statements

#: Functions that set up a pin, and no more: what they get is no use of it.
_SETS_UP: Final = re.compile(r"GPIO_(SetupPinOptions|set(DirectionMode|PadConfig|Qualification\w*|\w*Core\w*))$")
#: Functions that make a pin an input, if their second argument is 0.
_DIRECTION: Final = re.compile(r"GPIO_(SetupPinOptions|setDirectionMode)$")
_READS: Final = re.compile(r"GPIO_[rR]eadPin$")
_PORTS: Final = re.compile(r"GPIO_[rR]eadPort\w*$")
#: Registers that give a pin to a peripheral, or to the wake-up.
_LENDS: Final = re.compile(r"MUX|LPMSEL")
_DRIVES: Final = re.compile(r"GP[A-F](DIR|DAT|SET|CLEAR|TOGGLE)$")
#: All pins of a port.
_WHOLE: Final = 0xFFFFFFFF
_PIN_FIELD: Final = re.compile(r"GPIO(\d+)$")
_SOC: Final = re.compile(r"Adc([a-d])Regs\.ADCSOC(\d+)CTL$")
_RESULT: Final = re.compile(r"Adc([a-d])ResultRegs\.ADCRESULT(\d+)$")
#: Address of ADC-A and of its results, with the distances to the next (TRM, memory map).
_ADC: Final = (0x7400, 0x80)
_RESULTS: Final = (0x0B00, 0x20)


@dataclass(eq=False)
class _Inputs:
    """The inputs of one kind: where each is set up, which are used, and whether all may be."""

    set_up: dict[int | str, tuple[Function, Stmt]] = field(default_factory=dict)
    used: set[int | str] = field(default_factory=set)
    all_used: bool = False


def check_unread_inputs(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report inputs that are set up and never looked at."""
    owners = {f: report for module, report in reports.items() if not module.brought for f in module.functions}
    if not any(function.name == "main" and function.body for function in owners):
        return
    pins, conversions = _Inputs(), _Inputs()
    for function in owners:
        for s in statements(function.body):
            _pins(function, s, pins)
            _conversions(function, s, conversions)
    for inputs, what in ((pins, "GPIO{} is made an input"), (conversions, "ADC-{} is set up")):
        for name, (function, s) in inputs.set_up.items():
            if name not in inputs.used and not inputs.all_used:
                message = f"{what.format(name)}, and no statement looks at it: what it is for has no effect"
                owners[function].report(function, s.where, "input-unused", message, object=what.format(name).split()[0])


def _pins(function: Function, s: Stmt, pins: _Inputs) -> None:
    """Note what a statement does with pins."""
    target = s.target if isinstance(s, Assign) else None
    number = constant_of(s.value) if isinstance(s, Assign) else None
    if isinstance(target, RegisterRef):
        pin = _pin(target)
        if isinstance(s, Assign) and target.field is None:
            _port(function, s, target, pins)
        if pin is not None and number == 0 and target.register.endswith("DIR"):
            pins.set_up.setdefault(pin, (function, s))
        elif pin is not None and (number != 0 if _LENDS.search(target.register) else _DRIVES.match(target.register)):
            pins.used.add(pin)  # another function, or an output that is released
        elif re.fullmatch(r"INPUT\d+SELECT", target.register):
            pins.used |= {number} if number is not None else set()
            pins.all_used |= number is None
    changes = isinstance(s, Assign) and isinstance(s.target, RegisterRef) and _changed_pins(s, s.target) is not None
    masked = {id(side): mask for p in own_nodes(s) for side, mask in _masked(p)}
    for p in own_nodes(s):
        match p:
            case RegisterLoad(register=RegisterRef() as ref) if re.fullmatch(r"GP[A-F]DAT", ref.register):
                pin = _pin(ref)
                if pin is not None:
                    pins.used.add(pin)
                elif not changes:
                    pins.used |= _pins_of(ref.register, masked.get(id(p), _WHOLE))
            case RegisterAddress(block=block) if block.startswith("Gpio"):
                pins.all_used = True
            case RegisterLoad(register=RegisterAt(name=name)) if re.fullmatch(r"GP[A-F]DAT", name):
                pins.all_used = True
            case Call(function=Function(name=name), arguments=arguments):
                given = [constant_of(each) for each in arguments]
                if _DIRECTION.match(name) and len(given) > 1 and given[0] is not None and given[1] == 0:
                    pins.set_up.setdefault(given[0], (function, s))
                elif _DIRECTION.match(name) and given[0] is not None:
                    pins.used.add(given[0])
                elif name == "GPIO_setPinConfig" and given[0] is not None:
                    pins.used |= {_configured(given[0])} if given[0] & 0xF else set()
                elif name == "GPIO_SetupPinMux" and len(given) > 2 and given[2] == 0:
                    pass
                elif _PORTS.match(name) or (_READS.match(name) and not _known(arguments[0], function)):
                    pins.all_used = True
                elif not _SETS_UP.match(name):
                    pins.used |= {each for each in given if each is not None}


def _port(function: Function, s: Assign, target: RegisterRef, pins: _Inputs) -> None:
    """Note what a write of a whole register does with pins: `GPADIR.all &= ~(1UL << 5)`, `GPASET.all = 1UL << 5`."""
    if _LENDS.search(target.register):
        pins.all_used |= constant_of(s.value) != 0
        return
    if not _DRIVES.match(target.register):
        return
    changed = _changed_pins(s, target)
    if changed is None:
        given = constant_of(s.value)
        pins.used |= _pins_of(target.register, _WHOLE if given is None else given)
    elif changed[1] or not target.register.endswith("DIR"):
        pins.used |= _pins_of(target.register, changed[0])
    else:
        for pin in sorted(_pins_of(target.register, changed[0])):
            pins.set_up.setdefault(pin, (function, s))


def _changed_pins(s: Assign, target: RegisterRef) -> tuple[int, bool] | None:
    """The bits of a register that a statement sets (True) or clears in it; None: it gives it another value."""
    match bare(s.value):
        case Binary(op="|" | "&" as op, left=left, right=right):
            old, mask = bare(left), constant_of(right)
            if isinstance(old, RegisterLoad) and old.register == target and mask is not None:
                return (mask & _WHOLE, True) if op == "|" else (~mask & _WHOLE, False)
    return None


def _masked(p: object) -> Iterator[tuple[Expr, int]]:
    """The operands of an expression that it masks with a constant, each with the mask."""
    if isinstance(p, Binary) and p.op == "&":
        for side, other in ((p.left, p.right), (p.right, p.left)):
            mask = constant_of(other)
            if mask is not None:
                yield bare(side), mask


def _pins_of(register: str, mask: int) -> set[int | str]:
    """The pins of a port whose bits are in a mask: of `GPBDAT`, GPIO32 to GPIO63."""
    first = 32 * "ABCDEF".index(register[2])
    return {first + bit for bit in range(32) if mask >> bit & 1}


def _pin(ref: RegisterRef) -> int | None:
    """The pin that a field of a register of the GPIOs is for."""
    match = _PIN_FIELD.match(ref.field.name) if ref.field is not None else None
    return int(match[1]) if match is not None else None


def _known(pin: Expr, function: Function) -> bool:
    """Whether the pin that is read is known here, or where the function is called."""
    match bare(pin):
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in function.parameters:
            return True
    return constant_of(pin) is not None


def _configured(config: int) -> int:
    """The pin of a number that driverlib's `GPIO_setPinConfig` gets: offset of GPxMUX1 or 2, shift, function."""
    offset, shift = config >> 16, config >> 8 & 0xFF
    return 32 * (offset // 0x40) + 16 * (offset % 0x40 >= 8) + shift // 2


def _conversions(function: Function, s: Stmt, conversions: _Inputs) -> None:
    """Note what a statement does with conversions of the ADC; each is its letter and SOC, as `A, SOC 2`."""
    target = s.target if isinstance(s, Assign) else None
    chooses = isinstance(target, RegisterRef) and (target.field is None or target.field.name == "CHSEL")
    named = _SOC.match(f"{target.block}.{target.register}") if chooses and isinstance(target, RegisterRef) else None
    if named is not None:
        conversions.set_up.setdefault(f"{named[1].upper()}, SOC {named[2]},", (function, s))
    for p in own_nodes(s):
        match p:
            case RegisterLoad(register=RegisterRef(block=block, register=register)):
                if (read := _RESULT.match(f"{block}.{register}")) is not None:
                    conversions.used.add(f"{read[1].upper()}, SOC {read[2]},")
                elif register.startswith("ADCPPB"):
                    conversions.all_used = True
            case RegisterRef(register=register) if register.startswith("ADCPPB"):
                conversions.all_used = True
            case RegisterAddress(block=block) if re.match(r"Adc\wResult", block):
                conversions.all_used = True
            case RegisterLoad(register=RegisterAt(name=name)) if name.startswith("ADCRESULT"):
                conversions.all_used = True
            case Call(function=Function(name="ADC_setupSOC"), arguments=[base, soc, *_]):
                name = _of_library(base, soc, _ADC)
                conversions.set_up.setdefault(name, (function, s)) if name else None
            case Call(function=Function(name="ADC_readResult"), arguments=[base, soc]):
                name = _of_library(base, soc, _RESULTS)
                conversions.used |= {name} if name else set()
                conversions.all_used |= not name
            case Call(function=Function(name=name)) if re.match(r"ADC_\w*PPB|DMA_config|DMACH\dAddrConfig", name):
                conversions.all_used = True


def _of_library(base: Expr, soc: Expr, at: tuple[int, int]) -> str:
    """The conversion that driverlib names by the address of a block and a number; empty: it is not known."""
    address, number = constant_of(base), constant_of(soc)
    if address is None or number is None or (address - at[0]) % at[1] or not 0 <= (address - at[0]) // at[1] < 4:
        return ""
    return f"{'ABCD'[(address - at[0]) // at[1]]}, SOC {number},"
