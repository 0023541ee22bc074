"""Functions that are called through a pointer of another type.

TI's compiler hands over the first arguments in registers, chosen by the class of each (CC section "how a function is
called": 16-bit values in AL and AH, 32-bit ones in ACC, pointers in XAR4 and XAR5, floats in R0H to R3H).  An argument
that the function does not take is harmless.  A parameter that was not passed, or was passed in a register of another
class, holds whatever is in its register: 0 here (CHOICE).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from emulator.c28x.ctypes import VOID, CType, FloatType, FunctionType, IntType, StructType
from emulator.c28x.memory import zero_of


def misfit(known: FunctionType, wanted: FunctionType) -> str:
    """Why a function of type `known` does not work when it is called as `wanted`; empty if it works."""
    takes, given = len(known.parameters), len(wanted.parameters)
    if takes > given:
        return f"it takes {takes} argument{'s' * (takes > 1)}, {given or 'none'} {'are' if given > 1 else 'is'} passed"
    for i, (mine, passed) in enumerate(zip(known.parameters, wanted.parameters, strict=False), 1):
        if _class(mine) != _class(passed):
            return f"argument {i} is passed as {passed} and taken as {mine}"
    if wanted.result != VOID and _class(known.result) != _class(wanted.result):
        return f"it gives {'no result' if known.result == VOID else known.result}, {wanted.result} is taken"
    return ""


def fitted(function: Callable[..., Any], known: FunctionType, wanted: FunctionType) -> Callable[..., Any]:
    """An adapter that calls `function`, of type `known`, with the arguments and result of type `wanted`."""
    passed = (*wanted.parameters, *(VOID for _ in known.parameters))

    def call(*values: Any) -> Any:
        given = zip((*values, *(0 for _ in known.parameters)), passed, known.parameters, strict=False)
        result = function(*(_seen_as(value, ctype, mine) for value, ctype, mine in given))
        return _seen_as(result, known.result, wanted.result)

    return call


def _class(ctype: CType) -> object:
    """The class of a type: it decides in which register a value is passed."""
    if isinstance(ctype, StructType):
        return ctype
    if isinstance(ctype, IntType | FloatType):
        return type(ctype), ctype.words
    return None if ctype == VOID else "pointer"


def _seen_as(value: Any, ctype: CType, wanted: CType) -> Any:
    """The `wanted` value that a function reads where a value of type `ctype` was passed."""
    if _class(ctype) != _class(wanted):
        return zero_of(wanted)
    return wanted.wrap(value) if isinstance(wanted, IntType) else value
