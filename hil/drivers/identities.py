"""Finds identities of parts that are compared with those of other parts.

    if (Read_Register(WHO_AM_I) != I_AM)        // 0xD4, and the part answers 0xD3
        return 0;

A program that does not find its part may be right: the part may be missing, or another one.  So the part must have been
asked again and again and never been set up, and the program must be meant for it: the board was named, or the text of
the program names the part.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Call, Compare, Const, Declare, Expr, Function, Load, LValue, Variable, Where
from emulator.c28x.tree_queries import bare, parts, roots, source_text, statements
from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.l3g4200d_registers import WHO_AM_I, WHO_AM_I_VALUE
from hil.board import Board
from hil.drivers.units import UnitMismatch

#: CHOICE: who asks so often waits for the answer.
_AGAIN: Final = 3
_PART: Final = "L3G4200D"
#: The register, without and with the bits that a program sets in the address to read, and to read on.
_ADDRESSES: Final = frozenset(WHO_AM_I | bits for bits in (0, 0x40, 0x80, 0xC0))


def wrong_identities(modules: Iterable[Module], board: Board, *, board_named: bool) -> Iterator[UnitMismatch]:
    """The comparisons with a wrong identity, after a run in which nothing else was done with the part."""
    gyros = board.find(L3G4200D).values()
    if not any(gyro.asked >= _AGAIN and not gyro.written for gyro in gyros):
        return
    functions = [function for module in modules for function in module.functions]
    lines = [line for file in {function.where.file for function in functions} for line in lines_with_comments(file)]
    if not board_named and not any(_PART in f"{code} {comment}".upper() for code, comment in lines):
        return
    found = list(_compared(functions))
    if any(constant == WHO_AM_I_VALUE for _, _, _, constant in found):
        return
    for function, where, text, constant in found:
        place = Place(function.where.file, where.line, function.name, function.c_file, where.column)
        times = max(gyro.asked for gyro in gyros)
        message = (
            f"{text} is {WHO_AM_I_VALUE:#x} of the {_PART}, and is compared with {constant:#x}: the part was asked "
            f"{times} times who it is, and never set up"
        )
        yield UnitMismatch(place, message, text, "wrong-identity")


def _compared(functions: list[Function]) -> Iterator[tuple[Function, Where, str, int]]:
    """The comparisons of an identity with a constant: function, place, text of the identity, and constant."""
    set_to: dict[Variable, list[Expr]] = {}
    for function in functions:
        for s in statements(function.body):
            match s:
                case Assign(target=LValue(root=Variable() as v), value=value):
                    set_to.setdefault(v, []).append(value)
                case Declare(variable=v, value=Expr() as value):
                    set_to.setdefault(v, []).append(value)
    for function in functions:
        for s in statements(function.body):
            for root in roots(s):
                for p in parts(root):
                    if not isinstance(p, Compare) or p.op not in ("==", "!="):
                        continue
                    for side, other in ((p.left, p.right), (p.right, p.left)):
                        constant = bare(other)
                        # 0 and 0xFF are what a part that is missing answers.
                        if isinstance(constant, Const) and 0 < constant.value < 0xFF and _is_identity(side, set_to):
                            yield function, p.where if p.where.line else s.where, source_text(side), int(constant.value)


def _is_identity(e: Expr, set_to: dict[Variable, list[Expr]]) -> bool:
    """Whether a value is what a call for the register of the identity has given."""
    match bare(e):
        case Call(arguments=arguments):
            given = [bare(argument) for argument in arguments]
            return any(isinstance(c, Const) and c.value in _ADDRESSES for c in given)
        case Load(lvalue=LValue(root=Variable() as v, indices=[], words=0)):
            values = [value for value in set_to.get(v, []) if not isinstance(bare(value), Const)]
            return bool(values) and all(isinstance(bare(x), Call) and _is_identity(x, set_to) for x in values)
    return False
