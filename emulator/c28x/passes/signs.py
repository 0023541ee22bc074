"""Pass `signs`: words and octets without a sign that the source takes for signed numbers.

    int32_t rpm = data[0] | (data[1] << 8);       // 64636 for -900
    if (rpm >= -3000 && rpm <= 3000) ...

A word that is composed of octets, or read from a buffer or a union, is unsigned.  It has a sign for its reader if the
object that takes it, also as the result of a function, is compared by order with a negative number, and never gets
anything else.  A comparison with 0 or
-1 says nothing: it may belong to a test of the range.

The second form is a comparison by order in which a cast makes a signed number unsigned, and the other side is an object
that gets signed numbers by casts, too.  One of the two alone may be the test whether a subscript is within an array.

The third form is a shift register that is signed, a CRC: it is shifted to the right, and an exclusive or with a
constant that needs its highest bit says that its bits are no number.  A mask behind the shift takes the copies of the
sign away.

The fourth form is a word of three octets that becomes a signed number of 32 bits, as a converter of 24 bits sends it,
in a program that looks nowhere at bit 23.  Only a run shows whether there is a sign: the running code waits for a step
from just above 0 to just below 2 to the 24.

The result are the expressions that must not have their highest bit set.  The running code checks it.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, NamedTuple

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.intervals import bounds_of
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Convert,
    Expr,
    For,
    Function,
    Load,
    LValue,
    Return,
    Variable,
)
from emulator.c28x.tree_queries import (
    NamedScalar,
    addressed,
    bare,
    given_values,
    named_scalar,
    of_all,
    once,
    parts,
    source_text,
    statements,
    within,
)

#: Constants that say that a program knows bit 23: it, the bits below and above it, and what it counts twice.
_KNOWS_BIT_23: Final = frozenset((0x80_0000, 0x7F_FFFF, 0xFF00_0000, 0x100_0000, -0x80_0000, -0x100_0000))

#: By how many bits the three octets of a word are shifted.
_OCTETS: Final = frozenset((0, 8, 16))


class SignedWord(NamedTuple):
    """The largest value of an expression without a sign, how the source takes its highest bit, the kind of guard."""

    largest: int
    use: str
    kind: str = "signed-word"


def signed_words(functions: Iterable[Function]) -> dict[int, SignedWord]:
    """Identities of unsigned expressions whose highest bit is a sign for the source."""
    functions = list(functions)
    found = _widened(functions) | _compared(functions)
    for function in functions:
        found |= _shift_registers(function)
    words = [_words_of_24_bits(function) for function in functions]
    for of_function in words if None not in words else ():
        found |= of_function or {}
    return found


def _widened(functions: list[Function]) -> dict[int, SignedWord]:
    """Words and octets that are widened without their sign, for an object that is compared with a negative number."""
    asked = dict(found for function in functions for found in _asked(function))
    if not asked:
        return {}
    given: dict[NamedScalar, list[Expr]] = {}
    lost: set[NamedScalar] = {(variable, 0) for variable in _addressed(functions)}
    for function in functions:
        lost |= {(s.counter, 0) for s in statements(function.body) if isinstance(s, For)}
        for target, value in given_values(function.body):
            if (named := named_scalar(target)) is not None and named in asked:
                given.setdefault(named, []).append(value)
    found: dict[int, SignedWord] = {}
    for named, values in given.items():
        words = [_word(value) or _returned(value) for value in values if not isinstance(bare(value), Const)]
        if named in lost or None in words or (isinstance(named[0], Variable) and named[0].kind == "parameter"):
            continue
        for word in words:
            assert word is not None
            low, high = bounds_of(_results(word)[0] if isinstance(word, Call) else word)
            if low >= 0 and high > 0xFF:
                found[id(word)] = SignedWord(0x7FFF, asked[named])
            elif low >= 0 and high == 0xFF:
                found[id(word)] = SignedWord(0x7F, asked[named])
    return found


@of_all
def _addressed(function: Function) -> set[Variable]:
    return addressed(within(function.body))


@once
def _asked(function: Function) -> list[tuple[NamedScalar, str]]:
    """The signed scalars that a function compares by order with a number below -1, each with the comparison."""
    found: list[tuple[NamedScalar, str]] = []
    for p in within(function.body):
        if isinstance(p, Compare) and p.op not in ("==", "!="):
            for side, other in ((p.left, p.right), (p.right, p.left)):
                load, limit = bare(side), bare(other)
                if isinstance(load, Load) and isinstance(limit, Const) and limit.value < -1:
                    ctype, named = load.ctype, named_scalar(load.lvalue)
                    signed = isinstance(ctype, FloatType) or (isinstance(ctype, IntType) and ctype.signed)
                    if signed and named is not None:
                        found.append((named, f"{source_text(p)} expects negative ones"))
    return found


def _word(e: Expr) -> Expr | None:
    """The unsigned word or octet that an expression widens; None: it does something else."""
    while isinstance(e, Convert):
        if not isinstance(e.operand.ctype, IntType):
            return None
        if isinstance(e.ctype, IntType) and e.ctype.signed and e.ctype.bits == 16:
            low, high = bounds_of(e.operand)
            if low < 0 or high > e.ctype.high:
                return None  # here the highest bit becomes a sign
        e = e.operand
    ctype = e.ctype
    if not isinstance(ctype, IntType) or ctype.bits != 16:
        return None
    low, high = bounds_of(e)
    return e if not ctype.signed or (low >= 0 and high == 0xFF) else None


def _returned(e: Expr) -> Call | None:
    """The call that an expression is, without conversions, if its function returns nothing but words of one range.

    The running code looks at the result there, and not in the function: others may call it for words without a sign.
    """
    while isinstance(e, Convert):
        if isinstance(e.ctype, IntType) and e.ctype.bits == 16:
            return None  # here the highest bit may become a sign
        e = e.operand
    words = _results(e) if isinstance(e, Call) else []
    return e if isinstance(e, Call) and words and len({bounds_of(word) for word in words}) == 1 else None


def _results(call: Call) -> list[Expr]:
    """The words without a sign that the function of a call returns; none if it returns anything else."""
    body = call.function.body
    given: dict[Variable, list[Expr]] = {}
    for target, value in given_values(body):
        if isinstance(target.root, Variable) and target.root.kind != "parameter":
            given.setdefault(target.root, []).append(value)
    words: list[Expr | None] = []
    for s in statements(body):
        match s:
            case Return(value=Load(lvalue=LValue(root=Variable(in_memory=False) as variable, indices=[]))) if (
                variable in given
            ):
                words += [_word(value) for value in given[variable]]
            case Return(value=Expr() as value):
                words.append(_word(value))
    found = [word for word in words if word is not None]
    return found if len(found) == len(words) else []


def _compared(functions: list[Function]) -> dict[int, SignedWord]:
    """The sides of comparisons by order of two numbers that casts have made unsigned."""
    pairs = [pair for function in functions for pair in _pairs(function)]
    if not pairs:
        return {}
    keys = {key for _, _, _, key in pairs}
    cast: set[Key] = set()
    for function in functions:
        for s in statements(function.body):
            if isinstance(s, Assign) and isinstance(s.target, LValue) and _cast(s.value):
                key = key_of(s.target)
                if key in keys:
                    assert key is not None
                    cast.add(key)
    found: dict[int, SignedWord] = {}
    for compare, side, load, key in pairs:
        if key in cast:
            use = f"{source_text(compare)} compares it"
            found[id(side)] = found[id(load)] = SignedWord(0x7FFF, use)
    return found


@once
def _pairs(function: Function) -> list[tuple[Compare, Expr, Load, Key]]:
    """The comparisons by order of a function that have a cast on one side and an unsigned object on the other."""
    pairs: list[tuple[Compare, Expr, Load, Key]] = []
    for p in within(function.body):
        if isinstance(p, Compare) and p.op not in ("==", "!="):
            for side, other in ((p.left, p.right), (p.right, p.left)):
                key = key_of(other.lvalue) if isinstance(other, Load) else None
                if _cast(side) and isinstance(other, Load) and key is not None and _is_word(other):
                    pairs.append((p, side, other, key))
    return pairs


@once
def _shift_registers(function: Function) -> dict[int, SignedWord]:
    """The signed scalars, where they are shifted to the right, that an exclusive or shows to be shift registers."""
    found: dict[int, SignedWord] = {}
    mixed = {
        named: polynomial for s in statements(function.body)
        if isinstance(s, Assign) and isinstance(s.target, LValue) and (named := named_scalar(s.target)) is not None
        for p in parts(s.value) if (polynomial := _polynomial(p, s.target)) is not None
    }  # fmt: skip
    nodes = list(within(function.body)) if mixed else []
    masked = {id(bare(side)) for p in nodes if isinstance(p, Binary) and p.op == "&" for side in (p.left, p.right)}
    for p in nodes:
        match p:
            case Binary(
                op=">>", ctype=IntType(signed=True), left=Load(ctype=IntType() as ctype, lvalue=lvalue) as register
            ) if (named := named_scalar(lvalue)) in mixed and id(p) not in masked:
                assert named is not None
                use = f"{source_text(p)} copies its sign; {mixed[named]:#x} needs all {ctype.bits} bits"
                found[id(register)] = SignedWord(ctype.high, use, "shifted-sign")
    return found


def _polynomial(e: Expr, register: LValue) -> int | None:
    """The constant of an exclusive or with a signed object, or with it shifted to the right, if it needs the sign bit.

    All ones are none: they invert the result.
    """
    match e:
        case Binary(op="^", left=left, right=right):
            for side, other in ((bare(left), bare(right)), (bare(right), bare(left))):
                if isinstance(side, Binary) and side.op == ">>":
                    side = bare(side.left)
                match side, other:
                    case Load(lvalue=lvalue, ctype=IntType(signed=True, high=high)), Const(value=int(value)):
                        if lvalue == register and high < value < 2 * high + 1:
                            return value
    return None


@once
def _words_of_24_bits(function: Function) -> dict[int, SignedWord] | None:
    """The words of three octets where they become signed; None if a statement extends the sign of such a word."""
    found: dict[int, SignedWord] = {}
    nodes = list(within(function.body))
    for p in nodes:
        match p:
            case Const(value=constant) if constant in _KNOWS_BIT_23:
                return None
            case Binary(op="<<", left=Load(ctype=IntType(bits=32)), right=Const(value=8)):
                return None  # the sign comes to bit 31, and back by a shift to the right
    composed: dict[Variable, set[int]] = {}
    for target, value in given_values(function.body):
        if isinstance(target.root, Variable) and not target.indices:
            composed.setdefault(target.root, set()).update(_shifts(value))
    for p in nodes:
        match p:
            case Convert(ctype=IntType(signed=True, bits=32), operand=Expr(ctype=IntType(bits=32)) as whole):
                pass
            case Binary(op="|" | "+", ctype=IntType(signed=True, bits=32), left=left, right=right) as whole:
                if _OCTETS in (_shifts(left), _shifts(right)):
                    continue  # more than the word
            case _:
                continue
        shifts = _shifts(whole)
        match whole:
            case Load(lvalue=LValue(root=Variable(kind="local") as variable, indices=[])):
                shifts = composed.get(variable, set())
        if shifts == _OCTETS:
            found[id(whole)] = SignedWord(0xFF_FFFF, "becomes a number of 32 bits without it", "word-of-24")
    return found


def _shifts(e: Expr) -> set[int]:
    """By how many bits the octets of a composed word are shifted."""
    match bare(e):
        case Binary(op="|" | "+", left=left, right=right):
            return _shifts(left) | _shifts(right)
        case Binary(op="<<", right=Const(value=int(count))):
            return {count}
    return {0}


def _is_word(e: Expr) -> bool:
    return isinstance(e.ctype, IntType) and not e.ctype.signed and e.ctype.bits == 16


def _cast(e: Expr) -> bool:
    """Whether a cast makes a signed number of 16 bits, which may be negative, unsigned."""
    match e:
        case Convert(explicit=True, ctype=IntType(signed=False, bits=16), operand=operand):
            # The cast of a difference of unsigned numbers says how they wrap.
            signed = isinstance(operand.ctype, IntType) and operand.ctype.signed and operand.ctype.bits == 16
            return signed and bounds_of(operand)[0] < 0 and not isinstance(operand, Const | Binary)
    return False
