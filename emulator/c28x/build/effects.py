"""Side effects within expressions, in order: an operand that a later operand would change goes to a temporary.

C leaves the order of operands open; here they are evaluated from left to right.  A program that depends on that order
within one expression (`a[i] = i++`) gets the remark `unsequenced`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from emulator.c28x.build.places import Place, RegisterPath
from emulator.c28x.build.scope import Builder
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CallPointer,
    Const,
    Convert,
    CopyStruct,
    Expr,
    FunctionRef,
    Load,
    LValue,
    Null,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    Stmt,
    String,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import parts, roots, statements

#: The result of building an operand.
Operand = Expr | Place
#: The identity of a place: the variable, or the key of the pointer that leads to it; the word within the object; the
#: subscripts; the lowest bit of a bit-field (-1: none).
Key = tuple[Any, int, tuple[int | float, ...], int]


def operands(b: Builder, *builds: Callable[[], Operand]) -> list[Operand]:
    """Build operands from left to right.  Each keeps the value that it has at its own turn."""
    values: list[Operand] = []
    written: list[Operand] = []
    effects: list[list[Stmt]] = []
    changeable = _Changeable()
    for build in builds:
        before, value = b.collect_effects(build)
        if before:
            for i in changeable.by(before):
                values[i] = unchanged(b, values[i], before)
            b.out.extend(before)
        changeable.add(len(values), value)
        values.append(value)
        written.append(value)
        effects.append(before)
    if any(effects):
        check_sequence(b, written, effects)
    return values


class _Changeable:
    """Finds the operands that an effect may change.  An index by variable saves a look at every operand."""

    def __init__(self) -> None:
        self.by_variable: dict[Variable, set[int]] = {}
        #: Operands with effects of their own, operands that read through a pointer, and operands that are places.
        self.acting: set[int] = set()
        self.pointing: set[int] = set()
        self.places: set[int] = set()

    def add(self, number: int, value: Operand) -> None:
        """Add operand `number`."""
        if not isinstance(value, Expr):
            self.places.add(number)
            return
        if _constant(value):
            return
        if _has_effects(value):
            self.acting.add(number)
        for part in parts(value):
            if isinstance(part, LValue) and isinstance(part.root, Variable):
                self.by_variable.setdefault(part.root, set()).add(number)
            elif isinstance(part, LValue):
                self.pointing.add(number)

    def by(self, effects: Sequence[Stmt]) -> list[int]:
        """The operands that `effects` may change, in order.  A value comes only once: then it is in a temporary."""
        written = {place.root for place in _written(effects) if isinstance(place.root, Variable)}
        wild = _wild(effects)
        seen = {v for v in self.by_variable if v.kind != "temporary"} if wild else written & self.by_variable.keys()
        found = set(self.acting)
        for variable in seen:
            found |= self.by_variable.pop(variable)
        if wild or any(variable.kind == "global" or variable.in_memory for variable in written):
            found |= self.pointing
            self.pointing = set()
        self.acting = set()
        return sorted(found | self.places)


def arguments(b: Builder, builds: Sequence[Callable[[], Expr]]) -> list[Expr]:
    """Build values from left to right: see `operands`."""
    return [value for value in operands(b, *builds) if isinstance(value, Expr)]


def unchanged(b: Builder, value: Operand, effects: Sequence[Stmt]) -> Operand:
    """`value` as it is before `effects`: the parts that they could change go to temporaries."""
    match value:
        case LValue():
            root = _unchanged_value(b, value.root, effects) if isinstance(value.root, Expr) else value.root
            indices = [replace(index, expr=_unchanged_value(b, index.expr, effects)) for index in value.indices]
            return replace(value, root=root, indices=indices)
        case RegisterAt():
            return replace(value, block=_unchanged_value(b, value.block, effects))
        case RegisterPath(pointer=Expr() as pointer):
            return replace(value, pointer=_unchanged_value(b, pointer, effects))
        case Expr():
            return _unchanged_value(b, value, effects)
    return value


def _unchanged_value(b: Builder, value: Expr, effects: Sequence[Stmt]) -> Expr:
    return b.saved(value) if disturbs(effects, value) else value


def evaluated_once(b: Builder, place: Place) -> Place:
    """A place that can be read and written, its parts evaluated once: parts with effects go to temporaries."""
    match place:
        case LValue(root=root, indices=indices) if _has_effects(root) or any(_has_effects(i.expr) for i in indices):
            saved = b.saved(root) if isinstance(root, Expr) and not _constant(root) else root
            fixed = [replace(i, expr=i.expr if _constant(i.expr) else b.saved(i.expr)) for i in indices]
            return replace(place, root=saved, indices=fixed)
        case RegisterAt(block=block) if _has_effects(block):
            return replace(place, block=b.saved(block))
    return place


def _has_effects(e: Variable | Expr) -> bool:
    """Whether evaluating `e` twice differs from evaluating it once."""
    return any(isinstance(part, Call | CallPointer | RegisterLoad) for part in parts(e))


def _constant(e: Expr) -> bool:
    while isinstance(e, Convert):
        e = e.operand
    return isinstance(e, Const | Null | String | FunctionRef | RegisterAddress) or (
        isinstance(e, AddressOf) and isinstance(e.lvalue.root, Variable) and not e.lvalue.indices
    )


def disturbs(effects: Sequence[Stmt], e: Expr) -> bool:
    """Whether `effects` could change the value of `e`, or whether `e` could see them."""
    if _constant(e):
        return False
    if _has_effects(e):
        return True
    written = {place.root for place in _written(effects) if isinstance(place.root, Variable)}
    wild = _wild(effects)
    for part in parts(e):
        if isinstance(part, LValue):
            if isinstance(part.root, Variable):
                if part.root in written or (wild and part.root.kind != "temporary"):
                    return True
            elif wild or any(variable.kind == "global" or variable.in_memory for variable in written):
                return True
    return False


def _written(effects: Sequence[Stmt]) -> list[LValue]:
    """The places that statements assign, except temporaries."""
    found: list[LValue] = []
    for s in statements(list(effects)):
        if isinstance(s, Assign | CopyStruct) and isinstance(s.target, LValue):
            root = s.target.root
            if not isinstance(root, Variable) or root.kind != "temporary":
                found.append(s.target)
    return found


def _wild(effects: Sequence[Stmt]) -> bool:
    """Whether statements call a function, or write a place that is not a named object."""
    for s in statements(list(effects)):
        if isinstance(s, Assign | CopyStruct) and (not isinstance(s.target, LValue) or isinstance(s.target.root, Expr)):
            return True
        for root in roots(s):
            if any(isinstance(part, Call | CallPointer) for part in parts(root)):
                return True
    return False


def check_sequence(b: Builder, values: Sequence[Operand], effects: Sequence[Sequence[Stmt]]) -> None:
    """Make a remark for each object that one operand writes and another one reads or writes."""
    first: dict[Key, LValue] = {}
    touching: dict[Key, set[int]] = {}
    for i, (value, before) in enumerate(zip(values, effects, strict=True)):
        for place in _written(before):
            key = _key(place)
            if key is not None:
                first.setdefault(key, place)
                touching.setdefault(key, set()).add(i)
        for place in _read(value, before):
            key = _key(place)
            if key is not None:
                touching.setdefault(key, set()).add(i)
    for key, place in first.items():
        if len(touching[key]) > 1:
            unsequenced(b, place)


def unsequenced(b: Builder, place: LValue) -> None:
    """Make the remark about an object that one expression changes and uses again, in an undefined order."""
    message = (
        f"{place.text} is changed and used again in one expression: C defines no order"
    )
    b.remark(place.where, "unsequenced", message, place.text)


def writes_itself(b: Builder, effects: Sequence[Stmt], place: Place) -> bool:
    """Whether the assigned value itself changes `place`, unsequenced with the assignment: `i = i++`."""
    if not isinstance(place, LValue) or _key(place) is None:
        return False
    open_effects = [s for s in effects if s not in b.sequenced]
    return any(_key(written) == _key(place) for written in _written(open_effects))


def _key(place: LValue) -> Key | None:
    """The identity of a place, from names, named pointers and constants; None if these do not determine it."""
    root: Any = place.root
    while isinstance(root, Convert):
        root = root.operand
    if isinstance(root, Load | AddressOf):
        way = _key(root.lvalue)
        root = None if way is None else (type(root), way)
    if root is None or isinstance(root, Expr) or (isinstance(root, Variable) and root.kind == "temporary"):
        return None
    constants = [index.expr.value for index in place.indices if isinstance(index.expr, Const)]
    bit = -1 if place.bits is None else place.bits.lo
    return (root, place.words, tuple(constants), bit) if len(constants) == len(place.indices) else None


def _read(value: Operand, effects: Sequence[Stmt]) -> list[LValue]:
    """The places that an operand reads, its effects included.  The target of an assignment is not read."""
    found = [part for part in parts(value) if isinstance(part, LValue) and part is not value]
    for s in statements(list(effects)):
        for root in roots(s):
            found += [p for p in parts(root) if isinstance(p, LValue) and not (isinstance(s, Assign) and p is s.target)]
    return found
