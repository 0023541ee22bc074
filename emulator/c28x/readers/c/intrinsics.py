"""Intrinsics of TI's compiler that C can say in other words (SPRU514, "Intrinsics"): accesses to memory, arithmetic.

Each becomes what it stands for: `__inc(m)` is `++*m`, `__addr32_read_uint16(a)` is `*(unsigned int *)a`.  Not modelled:
those whose result depends on the flags of the core (`__addcu`, `__rol`, `__subcu`, `__sat` and their kin).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from emulator.c28x import build
from emulator.c28x.build import Builder, Place
from emulator.c28x.ctypes import INT, LLONG, LONG, UINT, ULONG, VOID, CType, IntType
from emulator.c28x.tree import Const, Expr, Where

#: Name -> the operator, and the type of the object at the address: `*m = *m op b`.
_IN_PLACE: Final = {
    "__add": ("+", INT), "__sub": ("-", INT), "__and": ("&", INT), "__or": ("|", INT), "__xor": ("^", INT),
    "__addl": ("+", LONG), "__subl": ("-", LONG),
}  # fmt: skip
#: `*m = b - *m`.
_REVERSED: Final = {"__subr": INT, "__subrl": LONG}
_STEPS: Final = {"__inc": "+", "__dec": "-"}
#: Products of 16-bit factors: the types of the factors, and of the product.
_PRODUCTS: Final = {
    "__mpy": (INT, INT, LONG), "__mpyu": (UINT, UINT, ULONG), "__mpyxu": (INT, UINT, LONG), "__mpyb": (INT, UINT, LONG),
}  # fmt: skip
#: The larger or smaller of two numbers.
_CHOICES: Final = {
    "__max": (">", INT), "__min": ("<", INT), "__lmax": (">", LONG), "__lmin": ("<", LONG), "__llmax": (">", LLONG),
    "__llmin": ("<", LLONG),
}  # fmt: skip
#: Objects at an address beyond the 22 bits of a pointer.
_FAR: Final = {
    "__addr32_read_uint16": UINT, "__addr32_read_uint32": ULONG, "__addr32_write_uint16": UINT,
    "__addr32_write_uint32": ULONG,
}  # fmt: skip

#: The names of all of them.
PLAIN: Final = frozenset({
    *_IN_PLACE, *_REVERSED, *_STEPS, *_PRODUCTS, *_CHOICES, *_FAR, "__abs16_sat", "__mov_byte", "__tbit",
})  # fmt: skip


def plain(b: Builder, name: str, arguments: Sequence[Expr], where: Where) -> Expr | None:
    """A call of one of `PLAIN`; None for another name or number of arguments."""
    match name, list(arguments):
        case _, [address] if name in _FAR and "_read_" in name:
            return build.value_of(b, _at(b, address, _FAR[name], where))
        case _, [address, value] if name in _FAR and "_write_" in name:
            build.assign(b, _at(b, address, _FAR[name], where), build.convert(b, value, _FAR[name]), where)
        case _, [m, value] if name in _IN_PLACE:
            op, ctype = _IN_PLACE[name]
            build.combined(b, op, _at(b, m, ctype, where), build.convert(b, value, ctype), where)
        case _, [m, value] if name in _REVERSED:
            place = _at(b, m, _REVERSED[name], where)
            minuend = build.convert(b, value, _REVERSED[name])
            build.assign(b, place, build.binary(b, "-", minuend, build.value_of(b, place), where), where)
        case _, [m] if name in _STEPS:
            build.combined(b, _STEPS[name], _at(b, m, INT, where), Const(INT, 1, where=where), where)
        case _, [one, other] if name in _PRODUCTS:
            left, right, ctype = _PRODUCTS[name]
            factors = [
                build.convert(b, build.convert(b, given, taken), ctype, explicit=True)
                for given, taken in ((one, left), (other, right))
            ]
            return build.binary(b, "*", factors[0], factors[1], where)
        case _, [one, other] if name in _CHOICES:
            op, ctype = _CHOICES[name]
            return _chosen(b, op, _once(b, one, ctype), _once(b, other, ctype), where)
        case "__abs16_sat", [number]:
            once = _once(b, number, INT)
            least, most = Const(INT, INT.low, where=where), Const(INT, INT.high, where=where)
            return build.conditional(
                b, build.compare(b, "==", once, least, where), lambda: most,
                lambda: _chosen(b, ">", once, build.unary(b, "-", once, where), where), where,
            )  # fmt: skip
        case "__mov_byte", [words, number]:
            pointer = build.convert(b, words, UINT.pointer, explicit=True)
            return build.value_of(b, build.octet_of(pointer, build.promoted(b, number), where, name))
        case "__tbit", [bits, number]:
            shifted = build.binary(b, ">>", build.convert(b, bits, UINT), build.convert(b, number, UINT), where)
            return build.convert(b, build.binary(b, "&", shifted, Const(UINT, 1, where=where), where), INT)
        case _:
            return None
    return Const(VOID, 0, where=where)


def _at(b: Builder, address: Expr, ctype: CType, where: Where) -> Place:
    """`*(ctype *)address`."""
    place = build.dereference(b, build.convert(b, address, ctype.pointer, explicit=True), where, str(ctype))
    assert not isinstance(place, Expr)
    return place


def _once(b: Builder, value: Expr, ctype: IntType) -> Expr:
    """`value` as a number of this type, evaluated once."""
    converted = build.convert(b, value, ctype)
    return converted if isinstance(converted, Const) else b.saved(converted)


def _chosen(b: Builder, op: str, one: Expr, other: Expr, where: Where) -> Expr:
    """`one op other ? one : other`."""
    return build.conditional(b, build.compare(b, op, one, other, where), lambda: one, lambda: other, where)
