"""The depth of typed expressions: a part that is too deep for generated code goes to a temporary first.

A sum of thousands of terms is valid C, and so are deeply nested parentheses.  Python's parser takes 200 nested
parentheses, and a node of the tree needs up to five of them.
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

#: How deep the nodes of one generated expression may nest.
DEPTH: Final = 24


def shallow(b: Builder, value: Expr) -> Expr:
    """`value` if its tree is not too deep, else a temporary that holds it.  Raises SourceError at file scope."""
    if b.deep and not b.keeps and deeper(value, 2 * EXPRESSION_NESTING):
        raise SourceError.at(value.where, "a start value at file scope is a constant: this has too many operators")
    if not b.deep or not b.keeps or not isinstance(value.ctype, _SCALARS) or not deeper(value, DEPTH):
        return value
    return b.saved(value)


def shallow_place(b: Builder, place: Place) -> Place:
    """`place`, its pointer replaced by a temporary if that is too deep."""
    if isinstance(place, LValue) and isinstance(place.root, Expr):
        root = shallow(b, place.root)
        return place if root is place.root else replace(place, root=root)
    if isinstance(place, RegisterAt):
        block = shallow(b, place.block)
        return place if block is place.block else replace(place, block=block)
    return place


def deeper(e: Any, depth: int) -> bool:
    """Whether more than `depth` nodes are nested in `e`."""
    return not depth or any(deeper(inner, depth - 1) for inner in children(e))


_SCALARS: Final = (IntType, FloatType, PointerType, FunctionType, HandleType)
