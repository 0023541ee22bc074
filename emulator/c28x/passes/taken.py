"""Pass `taken`: statements that clear an object whose value a statement just before has read.

    speed = Pulses * 6;
    mean = Sum / 8;
    Pulses = 0;

    speed = wheel->pulses * 6;
    wheel->pulses = 0;

Together they read and change the object, as `Pulses = 0 * Pulses` does: what an interrupt adds between them is lost.
Only assignments, declarations and calls stand between the two.  After a test of the object (`if (Flags)`) they
acknowledge a flag, which is right for a flag that is only set.
"""

from __future__ import annotations

from collections.abc import Iterator

from emulator.c28x.ctypes import PointerType
from emulator.c28x.tree import (
    Assign,
    Const,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    Load,
    LValue,
    Stmt,
    Switch,
    Variable,
    While,
)
from emulator.c28x.tree_queries import assigned, bare, blocks, calls, parts

#: An object at file scope, or a pointer, and the offset of a word in the object or behind the pointer.
_Word = tuple[Variable, int]


def mark_copy_and_clear(function: Function) -> None:
    """Mark the statements that clear an object which a statement just before has read."""
    _mark(function.body, frozenset())


def _mark(body: list[Stmt], tested: frozenset[Variable]) -> None:
    read: set[_Word] = set()
    for s in body:
        cleared = _cleared(s)
        if cleared in read:
            assert isinstance(s, Assign)
            s.takes = True
        values = _values(s)
        if values is None or any(map(calls, values)):
            read.clear()
        read |= {word for value in values or () for word in _words(value) if word[0] not in tested}
        moved = assigned(s)
        if cleared is not None:
            read.discard(cleared)
        elif moved is not None and isinstance(moved.ctype, PointerType):
            read = {word for word in read if word[0] is not moved}
    for s in body:
        if not (inner_blocks := blocks(s)):
            continue
        test = s.test if isinstance(s, If | While) else s.subject if isinstance(s, Switch) else None
        inner = tested | {p.root for p in parts(test) if isinstance(p, LValue) and isinstance(p.root, Variable)}
        for block in inner_blocks:
            _mark(block, inner)


def _values(s: Stmt) -> list[Expr] | None:
    """The values that an assignment, declaration or call uses; None for any other statement."""
    match s:
        case Assign(value=value) | Declare(value=Expr() as value) | Evaluate(value=value):
            return [value]
        case Declare(value=None):
            return []
    return None


def _words(value: Expr) -> Iterator[_Word]:
    """The words of objects at file scope that an expression reads."""
    for p in parts(value):
        if isinstance(p, Load) and (word := _word(p.lvalue)) is not None:
            yield word


def _cleared(s: Stmt) -> _Word | None:
    """The word of an object at file scope that a statement sets to a constant."""
    match s:
        case Assign(target=LValue() as target, value=value) if isinstance(bare(value), Const):
            return _word(target)
    return None


def _word(lvalue: LValue) -> _Word | None:
    match lvalue:
        case LValue(root=Variable(kind="global") as root, indices=[], words=words):
            return root, words
        case LValue(root=Expr() as pointer, indices=[], words=words):
            match bare(pointer):
                case Load(lvalue=LValue(root=Variable() as root, indices=[], words=0)):
                    return root, words
    return None
