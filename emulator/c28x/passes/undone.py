"""Static check of early returns that leave on what the function switches off at its end: `not-undone`.

    GPIO_WritePin(CHIP_SELECT, 0);
    if (!Ready()) return FALSE;
    ...
    GPIO_WritePin(CHIP_SELECT, 1);
    return TRUE;

A block does something and undoes it later: it sets a pin and clears it, calls `Motor_On` and `Motor_Off`, or `Valve(1)`
and `Valve(0)`, gives an object one constant and then another.  A `return` in between that does not undo it leaves it as
it is.  A function that does nothing else counts as what it does.

An object may get its later value only if all went well (`valid = 0; ... valid = 1;`).  So of objects it counts only if
another `return` in between undoes it.  An interrupt may be enabled only if all went well, too: it counts as well if
another function enables it.
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
    Binary,
    Call,
    Compare,
    Conditional,
    Evaluate,
    Expr,
    Function,
    If,
    Load,
    LValue,
    Not,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    all_blocks,
    bare,
    blocks,
    fixed_words,
    own_nodes,
    register_text,
    source_text,
    statements,
)

#: Functions that set a pin: the pin and the level.
_PIN: Final = re.compile(r"GPIO_[wW]ritePin$")
_PORT: Final = re.compile(r"(GP[A-F])(SET|CLEAR|DAT)$")
#: Registers whose bits let interrupts through.
_MASKS: Final = re.compile(r"\bIER$|\bPIEIER\d")
_PORTS: Final = "ABCDEF"
_WORD: Final = 0xFFFFFFFF
#: Ends of names of functions, and those that undo them.
_PAIRS: Final = (
    ("on", "off"), ("start", "stop"), ("select", "deselect"), ("select", "unselect"), ("select", "release"),
    ("lock", "unlock"), ("enable", "disable"), ("begin", "end"), ("open", "close"), ("acquire", "release"),
    ("eallow", "edis"), ("assert", "deassert"), ("activate", "deactivate"),
    ("einschalten", "ausschalten"), ("starten", "stoppen"), ("starten", "anhalten"), ("sperren", "freigeben"),
    ("sperren", "entsperren"), ("oeffnen", "schliessen"), ("ein", "aus"),
    ("encender", "apagar"), ("iniciar", "parar"), ("arrancar", "parar"), ("abrir", "cerrar"),
    ("activar", "desactivar"), ("habilitar", "deshabilitar"), ("bloquear", "desbloquear"),
)  # fmt: skip
#: What stands in front of the end of a name that means the opposite.
_OPPOSITES: Final = ("de", "un", "des", "ent")

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
    acts = _Acts(own)
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
                for act, between, end in _undone_later(block, acts):
                    ways = list(_returns(between, act, acts))
                    left = [s for s, undone in ways if not undone]
                    evidence = act.outside or len(left) < len(ways) or acts.enabled_elsewhere(act, function)
                    itself = frozenset({function.path})
                    around = (s for each in callers.get(function.path, ()) for s in statements(each))
                    outer = any(_undoes(s, act, acts, itself) for s in around)
                    if not evidence or outer:
                        continue
                    for s in left:
                        if id(s) not in told:
                            told.add(id(s))
                            message = f"{act.text} is not undone on this way; line {end.line} does it at the end"
                            reports[module].report(function, s.where, "not-undone", message, object=act.text)


class _Acts:
    """What the statements of a program do that others can undo."""

    def __init__(self, own: dict[str, Function]) -> None:
        self.own = own
        self._of_functions: dict[str, _Act | None] = {}
        #: Function -> whether its only parameter switches something.
        self._switches: dict[str, bool] = {}
        #: The functions that let an interrupt through.
        self._enables: dict[_Key, set[str]] = {}
        for function in own.values():
            for s in statements(function.body):
                act = _of_mask(s)
                if act is not None and act.value is True:
                    self._enables.setdefault(act.key, set()).add(function.path)

    def enabled_elsewhere(self, act: _Act, function: Function) -> bool:
        """Whether something lets through an interrupt that other functions let through, too."""
        return bool(self._enables.get(act.key, set()) - {function.path})

    def of(self, s: Stmt) -> _Act | None:
        """What a statement does that another one can undo."""
        match s:
            case Evaluate(value=Call(function=Function(name=name), arguments=[pin, level])) if _PIN.match(name):
                number, value = constant_of(pin), constant_of(level)
                if number is not None and value is not None and 0 <= number // 32 < len(_PORTS):
                    key = ("pin", f"GP{_PORTS[number // 32]}", 1 << number % 32)
                    return _Act(key, bool(value), f"pin {number} = {value}", outside=True)
            case Evaluate(value=Call(function=Function() as function, arguments=arguments)):
                return self._call(function, arguments)
            case Assign():
                return _of_pin(s) or _of_mask(s) or _of_object(s)
        return None

    def _call(self, function: Function, arguments: list[Expr]) -> _Act | None:
        given = tuple(source_text(each) for each in arguments)
        lower = function.name.lower()
        for first, second in _PAIRS:
            if lower.endswith(first) and not lower.endswith(tuple(each + first for each in _OPPOSITES)):
                return _Act(("call", lower.removesuffix(first), given), first, function.name, outside=True)
            if lower.endswith(second):
                return _Act(("call", lower.removesuffix(second), given), second, function.name, outside=True)
        value = constant_of(arguments[0]) if len(arguments) == 1 else None
        if value in (0, 1) and self._is_switch(function.path):
            return _Act(("call", function.path), value, f"{function.name}({value})", outside=True)
        return self._of_function(function.path) if not arguments else None

    def _of_function(self, path: str) -> _Act | None:
        """What a function does if that is all it does."""
        if path not in self._of_functions:
            self._of_functions[path] = None
            body = self.own[path].body if path in self.own else []
            done = [s for s in body if not (isinstance(s, Return) and s.value is None)]
            if len(done) == 1 and (act := self.of(done[0])) is not None and act.key[0] != "object":
                self._of_functions[path] = _Act(act.key, act.value, self.own[path].name, act.outside)
        return self._of_functions[path]

    def _is_switch(self, path: str) -> bool:
        """Whether all that a function does is to switch a pin or a register, as its only parameter says."""
        if path not in self._switches:
            function = self.own.get(path)
            self._switches[path] = function is not None and _switches(function)
        return self._switches[path]


def _switches(function: Function) -> bool:
    if len(function.parameters) != 1:
        return False
    parameter = function.parameters[0]
    done = [s for s in function.body if not (isinstance(s, Return) and s.value is None)]
    match done:
        case [If(test=test, then=[Assign() as a], otherwise=[Assign() as b])]:
            pins = _of_pin(a), _of_pin(b)
            same = isinstance(a.target, RegisterRef) and isinstance(b.target, RegisterRef) and a.target == b.target
            return _tells(test, parameter) and (same or None not in pins)
        case [Assign(target=RegisterRef(field=field), value=value)]:
            inner = bare(value)
            if isinstance(inner, Conditional):
                return _tells(inner.test, parameter)
            return field is not None and field.width == 1 and _tells(inner, parameter)
        case [Evaluate(value=Call(function=Function(name=name), arguments=[pin, level]))] if _PIN.match(name):
            inner = bare(level)
            test = inner.test if isinstance(inner, Conditional) else inner
            return constant_of(pin) is not None and _tells(test, parameter)
    return False


def _tells(test: Expr, parameter: Variable) -> bool:
    """Whether a test asks for a parameter and for nothing else."""
    match bare(test):
        case Not(operand=operand):
            return _tells(operand, parameter)
        case Compare(op="==" | "!=", left=left, right=right):
            return constant_of(right) in (0, 1) and _tells(left, parameter)
        case Load(lvalue=LValue(root=root, indices=[])):
            return root is parameter
    return False


def _of_pin(s: Assign) -> _Act | None:
    """The pins that a statement sets or clears: `GPADAT.bit.GPIO7 = 1`, `GPASET.all = 1UL << 7`, `GPADAT.all &= ~M`."""
    target = s.target
    if not isinstance(target, RegisterRef | RegisterAt):
        return None
    port = _PORT.match(target.register if isinstance(target, RegisterRef) else target.name)
    if port is None:
        return None
    changed = _changed_bits(s)
    if changed is None:
        return None
    mask, value = changed
    kind = port[2]
    if kind != "DAT" and (value is not True or mask <= 0):
        return None
    high = value if kind == "DAT" else kind == "SET"
    if target.field is not None:
        text = f"{target.field.name} = {int(high)}"
    else:
        text = f"{port[1]} {mask:#x} = {int(high)}"
    return _Act(("pin", port[1], mask), high, text, outside=True)


def _of_mask(s: Stmt) -> _Act | None:
    """The interrupts that a statement lets through (True) or holds back: `IER |= M_INT9`, `PIEIER9.bit.INTx1 = 0`."""
    if not isinstance(s, Assign) or not isinstance(s.target, RegisterRef) or not _MASKS.search(s.target.register):
        return None
    changed = _changed_bits(s)
    if changed is None or (s.target.field is None and not isinstance(bare(s.value), Binary)):
        return None
    mask, value = changed
    return _Act(("mask", s.target.register, mask), value, f"{register_text(s.target)} without {mask:#x}", outside=False)


def _changed_bits(s: Assign) -> tuple[int, bool] | None:
    """The bits of a register that a statement sets (True) or clears, if it says so by constants."""
    target = s.target
    if not isinstance(target, RegisterRef | RegisterAt):
        return None
    bits = (1 << target.bits) - 1 if target.field is None else _WORD
    value = bare(s.value)
    constant = constant_of(value)
    if target.field is not None:
        field = target.field
        return None if constant is None or field.width != 1 else (1 << field.lo, bool(constant))
    if constant is not None:
        return (constant & bits, True) if constant & bits else None
    if isinstance(value, Binary) and value.op in "|&" and (mask := constant_of(value.right)) is not None:
        same = bare(value.left)
        if isinstance(same, RegisterLoad) and same.register == target:
            return (mask & bits, True) if value.op == "|" else (~mask & bits, False)
    return None


def _of_object(s: Assign) -> _Act | None:
    """The constant that an object at file scope gets, or what a parameter points to."""
    match s.target:
        case LValue(ctype=IntType(), root=Variable(kind="global") as root) as target:
            pass
        case LValue(ctype=IntType(), root=Load(lvalue=LValue(root=Variable(kind="parameter") as root))) as target:
            if root.in_memory:
                return None
        case _:
            return None
    number, words = constant_of(s.value), fixed_words(target)
    if number is None or words is None:
        return None
    key = ("object", root, root is target.root, words, target.bits)
    return _Act(key, number, f"{target.text} = {number}", outside=False)


def _undone_later(block: list[Stmt], all_acts: _Acts) -> Iterator[tuple[_Act, list[Stmt], Stmt]]:
    """What a block does and undoes, with the statements in between and the one that undoes it."""
    acts = [all_acts.of(s) for s in block]
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
    if isinstance(act.value, str):
        return (act.value, other.value) in _PAIRS
    return act.value != other.value


def _undoes(s: Stmt, act: _Act, acts: _Acts, above: frozenset[str] = frozenset()) -> bool:
    """Whether a statement undoes something, or a function that it calls does."""
    other = acts.of(s)
    if other is not None and other.key == act.key and _opposite(act, other):
        return True
    for p in own_nodes(s):
        if isinstance(p, Call) and p.function.path in acts.own and p.function.path not in above:
            inner = acts.own[p.function.path]
            if any(_undoes(x, act, acts, above | {inner.path}) for x in statements(inner.body)):
                return True
    return False


def _returns(
    between: list[Stmt], act: _Act, acts: _Acts, undone: bool = False
) -> Iterator[tuple[Return, bool]]:  # fmt: skip
    """The returns among some statements, and whether it is undone on the way to each."""
    for s in between:
        if isinstance(s, Return):
            yield s, undone or _undoes(s, act, acts)
        undone = undone or _undoes(s, act, acts)
        for inner in blocks(s):
            yield from _returns(inner, act, acts, undone)
