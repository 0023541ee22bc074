"""Types that C names and no object has.  Apart from what reads them: a kept program needs no parser to be loaded."""

from __future__ import annotations

from dataclasses import dataclass

from emulator.c28x.ctypes import CType, FunctionType


@dataclass(frozen=True)
class Prototype(FunctionType):
    """The type of a function itself; a pointer to it is a `FunctionType`."""

    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class Unsized(CType):
    """`element x[]`, before its initialiser tells the length."""

    element: CType
