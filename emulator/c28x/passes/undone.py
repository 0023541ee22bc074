"""Static check of early returns that leave on what the function switches off at its end: `not-undone`.

    GPIO_WritePin(CHIP_SELECT, 0);
    if (!Ready()) return FALSE;
    ...
    GPIO_WritePin(CHIP_SELECT, 1);
    return TRUE;

A block does something and undoes it later: it sets a pin and clears it, calls `Motor_On` and `Motor_Off`, gives an
object one constant and then another.  A `return` in between that does not undo it leaves it as it is.

An object may get its later value only if all went well (`valid = 0; ... valid = 1;`).  So of objects it counts only if
another `return` in between undoes it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Evaluate,
    Function,
    LValue,
    RegisterRef,
    Return,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import all_blocks, blocks, own_nodes, source_text, statements

#: Functions that set a pin: the pin and the level.
_PIN: Final = re.compile(r"GPIO_[wW]ritePin$")
_PORT: Final = re.compile(r"GP[A-F](SET|CLEAR|DAT)$")
#: Ends of names of functions, and those that undo them.
_PAIRS: Final = (
    ("on", "off"), ("start", "stop"), ("select", "deselect"), ("select", "unselect"), ("select", "release"),
    ("lock", "unlock"), ("enable", "disable"), ("begin", "end"), ("open", "close"), ("acquire", "release"),
)  # fmt: skip

_Key = tuple[Any, ...]


@dataclass(frozen=True)
class _Act:
    """What a statement does, and what undoes it: the same with another value."""

    key: _Key
    value: object
    text: str
    #: It acts on the outside.
    outside: bool


def check_undone(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the returns that leave on what the function switches off later."""
    modules = list(modules)
    own = {function.path: function for module in modules for function in module.functions}
    callers: dict[str, list[list[Stmt]]] = {}
    for function in own.values():
        for block in all_blocks(function.body):
            for s in block:
                for p in own_nodes(s):
                    if isinstance(p, Call):
                        callers.setdefault(p.function.path, []).append(block)
    for module in modules:
        if module.brought:
            continue
        for function in module.functions:
            told: set[int] = set()
            for block in all_blocks(function.body):
                for act, between, end in _undone_later(block):
                    ways = list(_returns(between, act, own))
                    left = [s for s, undone in ways if not undone]
                    evidence = act.outside or len(left) < len(ways)
                    itself = frozenset({function.path})
                    around = (s for each in callers.get(function.path, ()) for s in statements(each))
                    outer = any(_undoes(s, act, own, itself) for s in around)
                    if not evidence or outer:
                        continue
                    for s in left:
                        if id(s) not in told:
                            told.add(id(s))
                            message = f"{act.text} is not undone on this way; line {end.line} does it at the end"
                            reports[module].report(function, s.where, "not-undone", message, object=act.text)



def _act(s: Stmt) -> _Act | None:
    """What a statement does that another one can undo."""
    match s:
        case Evaluate(value=Call(function=Function(name=name), arguments=[pin, level])) if _PIN.match(name):
            number, value = constant_of(pin), constant_of(level)
            if number is not None and value is not None:
                return _Act(("pin", number), bool(value), f"pin {number} = {value}", outside=True)
        case Evaluate(value=Call(function=Function(name=name), arguments=arguments)):
            given = tuple(source_text(each) for each in arguments)
            lower = name.lower()
            for first, second in _PAIRS:
                if lower.endswith(first) and not lower.endswith(("de" + first, "un" + first)):
                    return _Act(("call", lower.removesuffix(first), given), first, name, outside=True)
                if lower.endswith(second):
                    return _Act(("call", lower.removesuffix(second), given), second, name, outside=True)
        case Assign(target=RegisterRef(register=register, field=field) as target, value=value):
            port = _PORT.match(register)
            bit = constant_of(value)
            if port is not None and field is not None and bit is not None and (bit or port[1] == "DAT"):
                high = bool(bit) if port[1] == "DAT" else port[1] == "SET"
                return _Act(("pin", register[:3], field.name), high, f"{field.name} = {int(high)}", outside=True)
        case Assign(target=LValue(ctype=IntType(), root=Variable(kind="global") as root, indices=[]) as target):
            number = constant_of(s.value)
            if number is not None:
                return _Act(("object", root, target.words, target.bits), number, f"{target.text} = {number}", False)
    return None


def _undone_later(block: list[Stmt]) -> Iterator[tuple[_Act, list[Stmt], Stmt]]:
    """What a block does and undoes, with the statements in between and the one that undoes it."""
    acts = [_act(s) for s in block]
    for i, act in enumerate(acts):
        if act is None:
            continue
        for k in range(i + 1, len(block)):
            other = acts[k]
            if other is not None and other.key == act.key:
                if _opposite(act, other):
                    yield act, block[i + 1 : k], block[k]
                break


def _opposite(act: _Act, other: _Act) -> bool:
    if act.key[0] == "call":
        return (act.value, other.value) in _PAIRS
    return act.value != other.value


def _undoes(s: Stmt, act: _Act, own: dict[str, Function], above: frozenset[str] = frozenset()) -> bool:
    """Whether a statement undoes something, or a function that it calls does."""
    other = _act(s)
    if other is not None and other.key == act.key and _opposite(act, other):
        return True
    for p in own_nodes(s):
        if isinstance(p, Call) and p.function.path in own and p.function.path not in above:
            inner = own[p.function.path]
            if any(_undoes(x, act, own, above | {inner.path}) for x in statements(inner.body)):
                return True
    return False


def _returns(
    between: list[Stmt], act: _Act, own: dict[str, Function], undone: bool = False
) -> Iterator[tuple[Return, bool]]:  # fmt: skip
    """The returns among some statements, and whether it is undone on the way to each."""
    for s in between:
        if isinstance(s, Return):
            yield s, undone or _undoes(s, act, own)
        undone = undone or _undoes(s, act, own)
        for inner in blocks(s):
            yield from _returns(inner, act, own, undone)
