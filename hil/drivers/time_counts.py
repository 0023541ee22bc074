"""Checks objects that count time by constant steps: do the steps go with the time between them?

    motor.still_ms += 1;            // each 20 ms
    if (motor.still_ms >= STILL_MAX_MS)

The name states the unit.  A run shows how long it lasts from step to step, whatever statement makes it, and on which
condition.  The usual time between two steps decides, and all of these times together: a program may catch up, or
pause.  An object counts time if it only gets a constant added, or 0; or, counted down, if it is compared only with 0.
One that goes to a register or a function is a setting that somebody moves: a pulse width, a delay.  A step of more than
1 may be the length of something that was done; it counts if the statement names none, or a period of the program.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from statistics import quantiles
from typing import Final

from emulator.c28x.ctypes import ArrayType, IntType, StructType
from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.memory import Object
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Declare,
    Expr,
    For,
    Function,
    Load,
    LValue,
    RegisterAt,
    RegisterRef,
    Return,
    Stmt,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, own_nodes, parts, statements, within, without_end
from emulator.c28x.watcher import CallingWatcher
from emulator.clock import CYCLES_PER_US, SYSCLK_HZ
from hil.drivers.periods import PERIOD_WORDS
from hil.drivers.stated_units import comment_beside, members, stated
from hil.drivers.unit_names import PhysicalUnit, UnitRemark, words_of
from hil.drivers.units import UnitMismatch
from hil.image import Build, Image

#: So many times from step to step are enough, and not more are kept.
_ENOUGH: Final = 12
_MOST: Final = 2000
#: The count is wrong by this factor at least.  CHOICE: a loop that waits 1 ms and works beside it counts roughly.
_WRONG: Final = 1.8
_WRONG_IN_ALL: Final = 1.5
#: In microseconds, it is off by more than what a loop itself takes.
_OVERHEAD_US: Final = 5.0
#: A step after more than so many usual times comes after a pause.  So many of the times are multiples of the usual one,
#: up to this part of it: what runs steadily may pass a step over.
_PAUSE: Final = 3.4
_ALIKE: Final = 0.8
_JITTER: Final = 0.25
#: Functions that take time.
_WAITS: Final = re.compile(r"delay|sleep|wait|pend", re.IGNORECASE)
_CONSTANT: Final = re.compile(r"\b[A-Z][A-Z0-9]*_\w+\b")


@dataclass
class _TimeCount:
    """An object that counts time: its name, its unit, what one step adds."""

    name: str
    unit: PhysicalUnit
    step: int
    #: The place of the first step.
    place: Place
    #: By word: the value before the last write, when that was, and when the last step was.
    before: dict[tuple[int, int], tuple[int, int, int]] = field(default_factory=dict)
    #: The times from step to step, in cycles.
    times: list[int] = field(default_factory=list)


class TimeCounts:
    """Measures the counts of time in a run."""

    def __init__(self, image: Image, build: Build) -> None:
        self._clock = image.board.clock
        counts = dict(_counts(build.modules, set(build.files)))
        self._counts = list(counts.values())
        #: Object -> the scalars (numbers) of it that count time.
        self._of: dict[Object, dict[int, _TimeCount]] = {}
        for obj in image.linked.objects.values() if counts else ():
            ctype = obj.declaration.ctype
            while isinstance(ctype, ArrayType):
                ctype = ctype.element
            for key, count in counts.items():
                of_it = range(0)
                if key[0] == "member" and isinstance(ctype, StructType) and ctype.name == key[1]:
                    of_it = range(key[2], len(obj.data), max(1, ctype.leaves))
                elif isinstance(key[0], Variable) and key[0].declaration == obj.declaration:
                    of_it = range(len(obj.data))
                self._of.setdefault(obj, {}).update((leaf, count) for leaf in of_it)
        watcher = image.linked.runtime.watcher
        if any(self._of.values()) and watcher is not None:
            touch = watcher.touch

            def told(obj: Object, word: int, write: bool) -> None:
                if write and obj in self._of:
                    self._written(obj, word)
                touch(obj, word, write)

            image.linked.watch_with(CallingWatcher(told))

    def _written(self, obj: Object, word: int) -> None:
        """A scalar of an object is about to be written."""
        scalar = obj.leaf(word)
        count = self._of[obj].get(scalar[0]) if scalar is not None else None
        value = obj.data[scalar[0]] if scalar is not None else None
        if count is None or len(count.times) >= _MOST or not isinstance(value, int):
            return
        now, key = self._clock.now, (obj.base, word)
        was, then, last = count.before.get(key, (value, -1, -1))
        if value - was == count.step and then >= 0:  # the write before this one was a step
            if last >= 0:
                count.times.append(then - last)
            last = then
        count.before[key] = value, now, last

    def wrong(self) -> Iterator[UnitMismatch]:
        """The counts whose steps do not go with the time."""
        for count in self._counts:
            if len(count.times) < _ENOUGH or not min(count.times):
                continue
            usual = quantiles(count.times, n=5)[0]
            going = [t for t in count.times if t <= _PAUSE * usual]
            regular = sum(abs(t / usual - max(1, round(t / usual))) <= _JITTER for t in going)
            step = abs(count.step) * count.unit.scale * SYSCLK_HZ
            factor, in_all = step / usual, step * len(going) / max(1, sum(going))
            off = max(factor, 1 / factor) >= _WRONG and max(in_all, 1 / in_all) >= _WRONG_IN_ALL
            if not off or (factor > 1) != (in_all > 1) or regular < _ALIKE * len(count.times):
                continue
            if abs(usual - step) > _OVERHEAD_US * CYCLES_PER_US:
                message = (
                    f"{count.name} counts {count.unit.name} by its name, and {abs(count.step)} is "
                    f"{'added' if count.step > 0 else 'taken'} every {usual / SYSCLK_HZ:.4g} s"
                )
                yield UnitMismatch(count.place, message, count.name, "period-by-name")


def _counts(modules: Iterable[Module], files: set[str]) -> Iterator[tuple[Key, _TimeCount]]:
    """The objects that count time, by their keys."""
    functions = [function for module in modules for function in module.functions]
    writes: dict[Key, list[tuple[Function, Assign]]] = {}
    for function in functions:
        for s in statements(function.body):
            if isinstance(s, Assign) and isinstance(s.target, LValue) and (key := key_of(s.target)) is not None:
                writes.setdefault(key, []).append((function, s))
    said = members(files, silent_agrees=True)
    settings: set[Key] | None = None
    for key, assigns in writes.items():
        steps = [(f, s, by) for f, s in assigns if (by := _step(s)) is not None]
        unit = _unit(steps[0][1], said) if steps else None
        if unit is None or len({by for _, _, by in steps}) > 1 or any(_alone(f, s) for f, s, _ in steps):
            continue
        by = steps[0][2]
        others = [s for _, s in assigns if _step(s) is None]
        if settings is None:
            settings = _settings(functions)
        fits = all(constant_of(s.value) == 0 for s in others) if by > 0 else _only_to_zero(functions, key)
        if fits and key not in settings and (abs(by) == 1 or all(_periodic(f, s) for f, s, _ in steps)):
            f, s, _ = steps[0]
            place = Place(f.where.file, s.where.line, f.name, f.c_file, s.where.column)
            yield key, _TimeCount(_name(s), unit, by, place)


def _step(s: Assign) -> int | None:
    """The constant that a statement adds to an integer; None: it does something else."""
    match bare(s.value):
        case Binary(op="+" | "-" as op, left=left, right=right) if (by := constant_of(right)) and isinstance(
            s.target, LValue
        ):
            was = bare(left)
            if not isinstance(was, Load) or not isinstance(s.target.ctype, IntType):
                return None
            root, own = was.lvalue.root, s.target.root
            # `v++` in an expression: its old value is a temporary of the same declaration.
            old = isinstance(root, Variable) and isinstance(own, Variable) and root.declaration == own.declaration
            if was.lvalue == s.target or (old and isinstance(root, Variable) and root.kind == "temporary"):
                return by if op == "+" else -by
    return None


def _name(s: Assign) -> str:
    assert isinstance(s.target, LValue)
    return re.sub(r"\[.*\]$", "", s.target.text.rpartition(".")[2].rpartition("->")[2])


def _unit(s: Assign, said: dict[str, UnitRemark]) -> PhysicalUnit | None:
    """The unit of time that the name of what a statement counts states."""
    name = _name(s)
    root = s.target.root if isinstance(s.target, LValue) else None
    remark = said.get(name, UnitRemark())
    if isinstance(root, Variable) and root.declaration.name == name:
        if root.kind != "global":
            return None
        remark = comment_beside(Where(root.declaration.file, root.declaration.line), name)
    found = stated(name, remark) if not re.search(r"\d", name) else None
    return found.unit if found is not None and found.unit.quantity == "time" and found.by == "name" else None


def _alone(function: Function, s: Stmt) -> bool:
    """Whether a statement is in a loop that only computes: what it counts there is no time that passes."""
    return any(
        isinstance(loop, For | While) and not (isinstance(loop, While) and without_end(loop))
        and any(s is inner for inner in statements(loop.body))
        and not any(isinstance(p, Call) and _WAITS.search(p.function.name) for p in within(loop.body))
        for loop in statements(function.body)
    )  # fmt: skip


def _periodic(function: Function, s: Stmt) -> bool:
    """Whether the line of a statement names no constant, or one that is a period of the program."""
    lines = lines_with_comments(function.where.file)
    line = lines[s.where.line - 1][0] if 0 < s.where.line <= len(lines) else ""
    return all(PERIOD_WORDS.intersection(word.upper() for word in words_of(name)) for name in _CONSTANT.findall(line))


def _settings(functions: list[Function]) -> set[Key]:
    """What goes to a register or a function, or is returned, itself or by copies; what a pointer may point to."""
    copies: list[tuple[Key, Key]] = []
    found: set[Key] = set()

    def keys(e: object) -> set[Key]:
        nodes = parts(e)
        tested = {id(inner) for p in nodes if isinstance(p, Compare) for inner in parts(p)}
        loads = (p for p in nodes if isinstance(p, Load) and id(p) not in tested)
        return {key for load in loads if (key := key_of(load.lvalue)) is not None}

    for function in functions:
        for s in statements(function.body):
            for p in own_nodes(s):
                if isinstance(p, AddressOf) and isinstance(p.lvalue.ctype, IntType):
                    found |= {key_of(p.lvalue) or ()}
                elif isinstance(p, CallPointer) or (isinstance(p, Call) and "printf" not in p.function.name):
                    found |= {key for argument in p.arguments for key in keys(argument)}
            match s:
                case Assign(target=RegisterRef() | RegisterAt(), value=value) | Return(value=value):
                    found |= keys(value)
                case Assign(target=LValue() as target, value=value) if (to := key_of(target)) is not None:
                    copies += ((to, key) for key in keys(value) if isinstance(bare(value), Load))
                case Declare(variable=variable, value=Expr() as value):
                    copies += (((variable, 0), key) for key in keys(value) if isinstance(bare(value), Load))
    grown = True
    while grown:
        more = {key for to, key in copies if to in found} - found
        found |= more
        grown = bool(more)
    return found


def _only_to_zero(functions: list[Function], key: Key) -> bool:
    """Whether an object is compared with nothing but 0, or 1."""
    return all(
        constant_of(other) in (0, 1)
        for function in functions for p in within(function.body) if isinstance(p, Compare)
        for side, other in ((p.left, p.right), (p.right, p.left))
        if isinstance(bare(side), Load) and key_of(bare(side).lvalue) == key  # type: ignore[attr-defined]
    )  # fmt: skip
