"""Types that C names but no object has.  Apart from the reader, so that loading a kept program needs no parser."""

from __future__ import annotations

from dataclasses import dataclass

from emulator.c28x.ctypes import CType, FunctionType


@dataclass(frozen=True)
class Prototype(FunctionType):
    """The type of a function itself.  (A `FunctionType` is a pointer to a function.)"""

    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class Unsized(CType):
    """The type of `element x[]`, before its initialiser gives the length."""

    element: CType
