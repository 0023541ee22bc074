"""What parameters, locals and objects of a program can be set to, as its source shows it.

A pointer to a register block is passed to a function, kept in a structure or in a table, or chosen by a function that
returns it.  Which blocks it can point to follows from all values that are put there: initial values, assignments, and
arguments.  What is copied or converted on the way is not followed: then the answer is that nothing is known.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, PointerType, StructType, is_word_backed
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    Conditional,
    Const,
    Convert,
    CopyStruct,
    Declare,
    Expr,
    For,
    Function,
    FunctionRef,
    Load,
    LValue,
    Null,
    PointerAdd,
    RegisterAddress,
    Return,
    Variable,
)
from emulator.c28x.tree_queries import bare, own_nodes, statements

#: A value is followed through so many objects and calls.
_DEEPEST: Final = 6
#: An object at file scope or in a function, and the number of a scalar in it.
Spot = tuple[Variable, int]
#: Functions that only make pointers null, or only read what they are given.
_HARMLESS: Final = ("memset", "memcmp")


class ObjectValues:
    """The values of the objects of some functions.  Arguments count only if they come from a function in `reached`."""

    def __init__(self, functions: Iterable[Function], reached: Iterable[Function]) -> None:
        #: Parameter -> the arguments that calls pass.  Parameters of functions that are also called through pointers,
        #: and counters of loops.
        self.given: dict[Variable, list[Expr]] = {}
        self.free: set[Variable] = set()
        self._set_to: dict[Variable, list[Expr]] = {}
        #: Assignments of pointers to objects at file scope and to members, and copies of whole structures.
        self._stores: list[tuple[LValue, Expr]] = []
        self._copies: list[LValue] = []
        #: Pointers that become pointers to something else: what they point to may be changed unseen.
        self._recast: list[Expr] = []
        self._unseen: set[Variable] | None = set()
        self._unseen_known = False
        self._looked_up = 0
        #: The identity of an lvalue of the source -> its scalars.
        self._spots_of: dict[int, frozenset[Spot] | None] = {}
        for f in functions:
            self._read_stores(f)
        for f in reached:
            self._read_calls(f)

    def _read_stores(self, f: Function) -> None:
        for s in statements(f.body):
            match s:
                case Declare(variable=variable, value=Expr() as value):
                    self._set_to.setdefault(variable, []).append(value)
                case Assign(target=LValue() as target, value=value):
                    if isinstance(target.root, Variable) and target.root.plain:
                        self._set_to.setdefault(target.root, []).append(value)
                    elif isinstance(target.ctype, PointerType):
                        self._stores.append((target, value))
                case For(variable=LValue(root=Variable() as counter)):
                    self.free.add(counter)
                case CopyStruct(target=target) if _holds_pointers(target.ctype):
                    self._copies.append(target)
            nodes = own_nodes(s)
            harmless = {
                id(argument) for part in nodes if isinstance(part, Call) and part.function.name in _HARMLESS
                for argument in part.arguments
            }  # fmt: skip
            for part in nodes:
                if isinstance(part, Convert) and id(part) not in harmless and _is_recast(part):
                    self._recast.append(part.operand)

    def _read_calls(self, f: Function) -> None:
        for s in statements(f.body):
            for part in own_nodes(s):
                if isinstance(part, FunctionRef):
                    self.free |= set(part.function.parameters)
                elif isinstance(part, Call):
                    for parameter, value in zip(part.function.parameters, part.arguments, strict=False):
                        self.given.setdefault(parameter, []).append(value)

    def in_memory(self, pointer: Expr) -> bool:
        """Whether a pointer is kept in an object: then an access means one of those there, and which is not known."""
        before = self._looked_up
        self.blocks(pointer)
        return self._looked_up != before

    def blocks(self, pointer: Expr, deep: int = _DEEPEST) -> list[str] | None:
        """The register blocks that a pointer can point to; None if that is not known."""
        pointer = bare(pointer)
        if isinstance(pointer, RegisterAddress):
            return None if pointer.register else [pointer.block]
        found: list[str] = []
        for value in self._of(pointer, deep) or ():
            named = self.blocks(value, deep - 1)
            if named is None:
                return None
            found += [block for block in named if block not in found]
        return found or None

    def of_plain(self, variable: Variable) -> list[Expr]:
        """What a parameter or local is set to, by calls and by statements; nothing if that is not all."""
        if variable in self.free or not variable.plain:
            return []
        return [*self.given.get(variable, ()), *self._set_to.get(variable, ())]

    def known(self, pointer: Expr) -> bool:
        """Whether all is known that a pointer can point to, and no register is among it."""
        return self._locations(pointer, _DEEPEST) is not None

    def contents(self, lvalue: LValue, deep: int = _DEEPEST) -> list[Expr] | None:
        """The values of a pointer in memory, or of an element of a constant table; None if they are not known."""
        spots = self._spots(lvalue, deep)
        self._looked_up += 1
        if spots is None:
            return None
        found: list[Expr] = []
        for variable, leaf in sorted(spots, key=lambda spot: (spot[0].name, spot[1])):
            if variable.kind == "global" and variable.initial is not None:
                found += variable.initial[leaf : leaf + 1]
        if all(variable.constant for variable, _ in spots):
            return found
        changed = {variable for variable, _ in spots}
        if not isinstance(lvalue.ctype, PointerType) or any(is_word_backed(variable.ctype) for variable in changed):
            return None
        for target in self._copies:
            into = self._known_spots(target, deep)
            if into is None or any(variable in changed for variable, _ in into):
                return None
        unseen = self._changed_unseen()
        if unseen is None or not changed.isdisjoint(unseen):
            return None
        for target, value in self._stores:
            if target.ctype == lvalue.ctype:
                into = self._known_spots(target, deep)
                if into is None:
                    return None
                if not spots.isdisjoint(into):
                    found.append(value)
        return found

    def _changed_unseen(self) -> set[Variable] | None:
        """The objects that a converted pointer points to; None if that is not known."""
        if not self._unseen_known:
            self._unseen_known = True  # for objects that these pointers themselves are kept in
            for pointer in self._recast:
                spots = self._locations(pointer, _DEEPEST)
                if spots is None:
                    self._unseen = None
                    break
                if self._unseen is not None:
                    self._unseen |= {variable for variable, _ in spots}
        return self._unseen

    def _of(self, pointer: Expr, deep: int) -> list[Expr] | None:
        """The expressions whose values a pointer can have."""
        values: list[Expr] | None = None
        match pointer:
            case _ if deep <= 0:
                return None
            case Load(lvalue=LValue(root=Variable() as variable, indices=[])) if variable.plain:
                values = _stepped(variable, self.of_plain(variable)) or None
            case Load(lvalue=lvalue):
                values = self.contents(lvalue, deep - 1)
            case Conditional(then=then, otherwise=otherwise):
                values = [then, otherwise]
            case Call(function=function) if function.body:
                returned = [s.value for s in statements(function.body) if isinstance(s, Return)]
                values = [value for value in returned if value is not None]
        return None if values is None else [value for value in values if not _is_null(value)]

    def _known_spots(self, lvalue: LValue, deep: int) -> frozenset[Spot] | None:
        """As `_spots`, once for each place in the source; unknown for one that depends on itself."""
        if id(lvalue) not in self._spots_of:
            self._spots_of[id(lvalue)] = None
            self._spots_of[id(lvalue)] = self._spots(lvalue, deep)
        return self._spots_of[id(lvalue)]

    def _spots(self, lvalue: LValue, deep: int) -> frozenset[Spot] | None:
        """The scalars that an lvalue can mean, whatever its subscripts are; None if they are not known."""
        if isinstance(lvalue.root, Variable):
            starts: frozenset[Spot] | None = frozenset(((lvalue.root, 0),))
        else:
            starts = self._locations(lvalue.root, deep - 1)
        if starts is None:
            return None
        found = {(variable, first + lvalue.leaf) for variable, first in starts}
        for index in lvalue.indices:
            found = {
                (variable, at) for variable, first in found for at in range(first, variable.ctype.leaves, index.leaves)
            }  # fmt: skip
        return frozenset(found)

    def _locations(self, pointer: Expr, deep: int) -> frozenset[Spot] | None:
        """The scalars at which what a pointer points to can begin; None if they are not known."""
        pointer = bare(pointer)
        match pointer:
            case _ if deep <= 0:
                return None
            case AddressOf(lvalue=lvalue):
                return self._spots(lvalue, deep)
            case PointerAdd(pointer=inner, ctype=PointerType(target=target)):
                spots, step = self._locations(inner, deep - 1), max(1, target.leaves)
                return None if spots is None else frozenset(
                    (variable, at) for variable, first in spots
                    for at in range(first % step, variable.ctype.leaves, step)
                )  # fmt: skip
        values = self._of(pointer, deep)
        if values is None:
            return None
        found: set[Spot] = set()
        for value in values:
            spots = self._locations(value, deep - 1)
            if spots is None:
                return None
            found |= spots
        return frozenset(found)


def _stepped(variable: Variable, values: list[Expr]) -> list[Expr]:
    """The values of a pointer that is also stepped through an array: `p++` is a step from each other value."""
    steps = {
        id(value): step for value in values
        if isinstance(step := bare(value), PointerAdd) and isinstance(from_ := bare(step.pointer), Load)
        and from_.lvalue.root is variable
    }  # fmt: skip
    others = [value for value in values if id(value) not in steps]
    return others + [replace(step, pointer=other) for step in steps.values() for other in others]


def _is_null(value: Expr) -> bool:
    inner = bare(value)
    return isinstance(inner, Null) or (isinstance(inner, Const) and inner.value == 0)


def _holds_pointers(ctype: CType) -> bool:
    """Whether an object of this type has pointers in it."""
    match ctype:
        case ArrayType(element=element):
            return _holds_pointers(element)
        case StructType(members=members):
            return is_word_backed(ctype) or any(_holds_pointers(member.ctype) for member in members)
    return isinstance(ctype, PointerType)


def _is_recast(part: Convert) -> bool:
    """Whether a pointer to a structure is converted to a pointer to something else, or to a number."""
    before = part.operand.ctype
    if not isinstance(before, PointerType) or not _holds_pointers(before.target):
        return False
    after = part.ctype.target if isinstance(part.ctype, PointerType) else None
    return after != before.target
