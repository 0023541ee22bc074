"""C types as the C28x compiler lays them out (COFF ABI), and C's rules for combining them.

Sizes are in 16-bit words, the addressable unit.  Sources: CC table 6-1 (types), ISO C 6.3.1 (promotions and usual
arithmetic conversions) applied to these widths: `unsigned char` is 16 bits wide and promotes to *unsigned* int.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Final


@dataclass(frozen=True)
class CType:
    """Base of all types.  `words` is sizeof, `align` the alignment, both in 16-bit words."""

    name: str

    @cached_property
    def words(self) -> int:
        """The size in 16-bit words."""
        return 0

    @cached_property
    def align(self) -> int:
        """The alignment in 16-bit words: 32-bit objects stand at even addresses."""
        return 2 if self.words > 1 else 1

    @cached_property
    def leaves(self) -> int:
        """How many scalars an object of this type consists of."""
        return 1

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class VoidType(CType):
    """`void`."""


@dataclass(frozen=True)
class IntType(CType):
    """An integer of `bits` bits.  A bit-field narrower than int has its own width."""

    bits: int
    signed: bool
    rank: int

    @cached_property
    def words(self) -> int:
        """One word up to 16 bits, two for long."""
        return 2 if self.bits > 16 else 1

    @cached_property
    def low(self) -> int:
        """The smallest value."""
        return -(1 << self.bits - 1) if self.signed else 0

    @cached_property
    def high(self) -> int:
        """The largest value."""
        return (1 << self.bits - 1) - 1 if self.signed else (1 << self.bits) - 1

    def wrap(self, value: int) -> int:
        """`value` modulo 2**bits, in range."""
        value &= (1 << self.bits) - 1
        return value - (1 << self.bits) if self.signed and value > self.high else value


@dataclass(frozen=True)
class FloatType(CType):
    """IEEE single precision: float, and double under the COFF ABI."""

    @cached_property
    def words(self) -> int:
        """Two words."""
        return 2


@dataclass(frozen=True)
class PointerType(CType):
    """A data pointer: 32 bits, of which 22 are significant."""

    target: CType

    @cached_property
    def words(self) -> int:
        """Two words."""
        return 2


@dataclass(frozen=True)
class HandleType(CType):
    """An opaque pointer of a kernel header, whose value is an object of the emulator."""

    @cached_property
    def words(self) -> int:
        """Two words."""
        return 2


@dataclass(frozen=True)
class FunctionType(CType):
    """A function; as a value, a pointer to it."""

    result: CType
    parameters: tuple[CType, ...]
    variadic: bool = False

    @cached_property
    def words(self) -> int:
        """A code pointer takes two words."""
        return 2


@dataclass(frozen=True)
class ArrayType(CType):
    """`length` elements, one after the other."""

    element: CType
    length: int

    @cached_property
    def words(self) -> int:
        """Elements are never padded."""
        return self.element.words * self.length

    @cached_property
    def align(self) -> int:
        """That of the element."""
        return self.element.align

    @cached_property
    def leaves(self) -> int:
        """Scalars of all elements."""
        return self.element.leaves * self.length


@dataclass(frozen=True)
class Member:
    """A structure member: its offset in words, and the index of its first scalar."""

    name: str
    ctype: CType
    offset: int
    leaf: int


@dataclass(frozen=True)
class StructType(CType):
    """Members in order, 32-bit members on even words, size rounded to the alignment."""

    members: tuple[Member, ...] = field(compare=False, default=())

    @cached_property
    def words(self) -> int:
        """End of the last member, rounded up."""
        if not self.members:
            return 0
        last = self.members[-1]
        return _round_up(last.offset + last.ctype.words, self.align)

    @cached_property
    def align(self) -> int:
        """That of the most demanding member."""
        return max((m.ctype.align for m in self.members), default=1)

    @cached_property
    def leaves(self) -> int:
        """Scalars of all members."""
        return sum(m.ctype.leaves for m in self.members)

    def member(self, name: str) -> Member | None:
        """The member called `name`."""
        return next((m for m in self.members if m.name == name), None)


def make_struct(name: str, members: list[tuple[str, CType]]) -> StructType:
    """Lay out a structure."""
    laid: list[Member] = []
    offset = leaf = 0
    for member_name, ctype in members:
        offset = _round_up(offset, ctype.align)
        laid.append(Member(member_name, ctype, offset, leaf))
        offset += ctype.words
        leaf += ctype.leaves
    return StructType(name, tuple(laid))


def _round_up(value: int, align: int) -> int:
    return -(-value // align) * align


VOID: Final = VoidType("void")
CHAR: Final = IntType("char", 16, True, 1)
SCHAR: Final = IntType("signed char", 16, True, 1)
UCHAR: Final = IntType("unsigned char", 16, False, 1)
INT: Final = IntType("int", 16, True, 2)
UINT: Final = IntType("unsigned int", 16, False, 2)
LONG: Final = IntType("long", 32, True, 3)
ULONG: Final = IntType("unsigned long", 32, False, 3)
FLOAT: Final = FloatType("float")

#: Names of the firmware language.
BASIC: Final[dict[str, CType]] = {
    "void": VOID, "char": CHAR, "schar": SCHAR, "uchar": UCHAR, "int16": INT, "uint16": UINT,
    "int32": LONG, "uint32": ULONG, "float32": FLOAT,
}  # fmt: skip


def bit_field(width: int) -> IntType:
    """The type of an unsigned bit-field of `width` bits."""
    return IntType(f"unsigned:{width}", width, False, 2 if width <= 16 else 3)


def is_arithmetic(ctype: CType) -> bool:
    """Whether C does arithmetic on it."""
    return isinstance(ctype, IntType | FloatType)


def promote(ctype: IntType) -> IntType:
    """Integer promotion: to int if int holds every value, else to unsigned int; longs stay."""
    if ctype.bits > 16:
        return LONG if ctype.signed else ULONG
    if ctype.signed or ctype.bits < 16:
        return INT
    return UINT


def usual(a: CType, b: CType) -> CType:
    """The usual arithmetic conversions: the type in which `a op b` is computed."""
    if isinstance(a, FloatType) or isinstance(b, FloatType):
        return FLOAT
    assert isinstance(a, IntType)
    assert isinstance(b, IntType)
    a, b = promote(a), promote(b)
    if a.signed == b.signed:
        return a if a.rank >= b.rank else b
    unsigned, signed = (b, a) if a.signed else (a, b)
    # long holds every unsigned int, so the value is kept; otherwise unsigned wins.
    return signed if signed.rank > unsigned.rank else unsigned


def part_name(ctype: CType, offset: int) -> str:
    """How C names what lies at word `offset` of an object: `[3].X`; the odd word of a scalar has its number."""
    if isinstance(ctype, ArrayType):
        index, rest = divmod(offset, max(1, ctype.element.words))
        return f"[{index}]{part_name(ctype.element, rest)}"
    if isinstance(ctype, StructType):
        for member in ctype.members:
            if 0 <= offset - member.offset < member.ctype.words:
                return f".{member.name}{part_name(member.ctype, offset - member.offset)}"
        return f" (padding at word {offset})"
    return f" (word {offset})" if offset else ""


def scalars(ctype: CType, offset: int = 0) -> list[tuple[int, CType]]:
    """Every scalar of `ctype` as (word offset, type), in leaf order."""
    if isinstance(ctype, ArrayType):
        inner = scalars(ctype.element)
        return [(offset + i * ctype.element.words + o, t) for i in range(ctype.length) for o, t in inner]
    if isinstance(ctype, StructType):
        return [leaf for m in ctype.members for leaf in scalars(m.ctype, offset + m.offset)]
    return [(offset, ctype)]
