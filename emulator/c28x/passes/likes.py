"""Static check of like parts of a function of which one lacks a step: `like-but-one`.

A function sets up, or sets back, at least three like things: register blocks of one kind (`EPwm1Regs`, `EPwm2Regs`,
`EPwm3Regs`), structures of one type, what a library calls by a number (`EPWM_setX(EPWM1_BASE, ...)`).  Each gets the
same members, registers or calls, but for one that lacks one or two of them, and has none of its own.

What any other function does to the odd one counts as done.  What chains timers (phase and synchronisation) or triggers
other modules differs by design, and pins differ by their use.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, StructType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    Const,
    Evaluate,
    Field,
    Function,
    Load,
    LValue,
    RegisterAddress,
    RegisterAt,
    RegisterRef,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, given_values, statements

#: So many others must be alike, and have so many steps; so many may be missing.
_ALIKE: Final = 2
_STEPS: Final = 3
_MISSING: Final = 2
#: Steps that one of several like timers, or the one that begins a chain, has by design.
_BY_DESIGN: Final = re.compile(r"PHS|SYN|^ET|Phase|Sync|Trigger|SOC|^GPIO", re.IGNORECASE)

#: The kind of a thing, and which one it is.
_Thing = tuple[Any, Any]


def check_likes(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the one of several like things that a function treats otherwise."""
    modules = [module for module in modules if not module.brought]
    everywhere: dict[_Thing, set[str]] = {}
    by_function: list[tuple[Module, Function, dict[_Thing, dict[str, Stmt]]]] = []
    for module in modules:
        for function in module.functions:
            here: dict[_Thing, dict[str, Stmt]] = {}
            at_blocks = _pointers_to_blocks(function)
            for s in statements(function.body):
                for thing, step in _steps(s, at_blocks):
                    here.setdefault(thing, {})[step] = s
                    everywhere.setdefault(thing, set()).add(step)
            by_function.append((module, function, here))
    for module, function, here in by_function:
        for thing, lacking, other in _odd(here):
            missing = sorted(step for step in lacking if step not in everywhere[thing])
            if missing and not any(_BY_DESIGN.search(step) for step in missing):
                last = list(here[thing].values())[-1]
                message = (
                    f"{_name(thing)} is treated as {_name(other)} and the others of its kind are, but for "
                    f"{' and '.join(missing)}, which it does not get"
                )
                reports[module].report(function, last.where, "like-but-one", message, object=_name(thing))


def _pointers_to_blocks(function: Function) -> dict[Variable, str]:
    """The locals that always point to one register block: `volatile struct EPWM_REGS *p = &EPwm1Regs;`."""
    found: dict[Variable, str] = {}
    others: set[Variable] = set()
    for target, value in given_values(function.body):
        variable = target.root
        if not isinstance(variable, Variable) or variable.kind == "global" or target.indices:
            continue
        inner = bare(value)
        block = inner.block if isinstance(inner, RegisterAddress) and not inner.register else ""
        if block and found.get(variable, block) == block:
            found[variable] = block
        else:
            others.add(variable)
    return {variable: block for variable, block in found.items() if variable not in others}


def _steps(s: Stmt, at_blocks: dict[Variable, str]) -> Iterator[tuple[_Thing, str]]:
    """What a statement does to a thing that may have its like."""
    match s:
        case Assign(target=RegisterRef(block=block, register=register, field=field)):
            yield from _block_step(block, register, field)
        case Assign(target=RegisterAt(block=Load(lvalue=LValue(root=Variable() as p)), name=name, field=field)):
            if p in at_blocks:
                yield from _block_step(at_blocks[p], name, field)
        case Assign(target=LValue(root=Variable()) as target, value=value):
            thing = _structure(target)
            if thing is not None:
                # To get a constant is another step than to be computed with.
                computed = "" if constant_of(value) is not None else " = ..."
                yield thing, target.text.partition(".")[2] + computed
        case Evaluate(value=Call(function=Function(name=name), arguments=[first, *_])):
            number = bare(first)
            module = name.partition("_")[0]
            if isinstance(number, Const) and constant_of(number) and module != name and not name.startswith("GPIO"):
                yield (module, number.value), name
            if isinstance(number, AddressOf) and isinstance(number.lvalue.ctype, StructType):
                thing = _structure(number.lvalue)
                if thing is not None:
                    yield thing, name


def _block_step(block: str, register: str, field: Field | None) -> Iterator[tuple[_Thing, str]]:
    """A register that a block gets, if there are several of its kind."""
    kind = re.sub(r"\d+(?=Regs$)|(?<=[a-z])[a-dA-D](?=Regs$)", "", block)
    if kind != block and not kind.startswith("Gpio"):
        yield (kind, block), register + (f".{field.name}" if field else "")


def _structure(lvalue: LValue) -> _Thing | None:
    """The structure to which a member belongs: an object, or an element of an array with a constant subscript."""
    match lvalue:
        case LValue(root=Variable(ctype=StructType() as kind) as root, indices=[]):
            return kind.name, (root, None)
        case LValue(root=Variable(ctype=ArrayType(element=StructType() as kind)) as root, indices=[index]):
            number = constant_of(index.expr)
            return None if number is None else (kind.name, (root, number))
    return None


def _odd(here: dict[_Thing, dict[str, Stmt]]) -> Iterator[tuple[_Thing, set[str], _Thing]]:
    """The one thing of a kind that lacks steps, with these, and one of the others."""
    for kind in {thing[0] for thing in here}:
        things = [thing for thing in here if thing[0] == kind]
        for odd in things:
            others = [set(here[thing]) for thing in things if thing != odd]
            own = set(here[odd])
            if len(others) < _ALIKE or any(other != others[0] for other in others) or len(others[0]) < _STEPS:
                continue
            if own < others[0] and len(others[0] - own) <= _MISSING and len(own) >= _STEPS - 1:
                yield odd, others[0] - own, next(thing for thing in things if thing != odd)


def _name(thing: _Thing) -> str:
    match thing[1]:
        case (Variable(declaration=declaration), None):
            return declaration.name
        case (Variable(declaration=declaration), number):
            return f"{declaration.name}[{number}]"
    return str(thing[1])
