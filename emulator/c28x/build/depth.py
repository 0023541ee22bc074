"""How deep a typed expression is: what is too deep for generated code is kept in a temporary before.

A sum of thousands of terms, or parentheses within parentheses, is right C; Python's parser takes 200 parentheses within
each other, and a node of the tree needs up to five of them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from emulator.c28x.build.places import Place
from emulator.c28x.build.scope import EXPRESSION_NESTING, Builder
from emulator.c28x.ctypes import FloatType, FunctionType, HandleType, IntType, PointerType
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Expr, LValue, RegisterAt
from emulator.c28x.tree_queries import children

#: Nodes within each other that one expression may have.
DEPTH: Final = 24


def shallow(b: Builder, value: Expr) -> Expr:
    """A value whose tree is not too deep: this one, or the temporary that keeps it from here on."""
    if b.deep and not b.keeps and deeper(value, 2 * EXPRESSION_NESTING):
        raise SourceError.at(value.where, "a start value at file scope is a constant: this has too many operators")
    if not b.deep or not b.keeps or not isinstance(value.ctype, _SCALARS) or not deeper(value, DEPTH):
        return value
    return b.kept(value)


def shallow_place(b: Builder, place: Place) -> Place:
    """A place whose pointer is not too deep."""
    if isinstance(place, LValue) and isinstance(place.root, Expr):
        root = shallow(b, place.root)
        return place if root is place.root else replace(place, root=root)
    if isinstance(place, RegisterAt):
        block = shallow(b, place.block)
        return place if block is place.block else replace(place, block=block)
    return place


def deeper(e: Any, depth: int) -> bool:
    """Whether more than `depth` nodes stand within each other."""
    return not depth or any(deeper(inner, depth - 1) for inner in children(e))


_SCALARS: Final = (IntType, FloatType, PointerType, FunctionType, HandleType)
