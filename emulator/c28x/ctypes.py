"""C types as the C28x compiler lays them out (COFF ABI), and C's rules for combining them.

Sizes are in 16-bit words, the addressable unit.  Sources: CC table 6-1 (types), ISO C 6.3.1 (promotions and usual
arithmetic conversions) applied to these widths: `unsigned char` is 16 bits wide and promotes to *unsigned* int.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Final


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
        """The alignment in 16-bit words: objects of 32 and 64 bits have even addresses."""
        return 2 if self.words > 1 else 1

    @cached_property
    def leaves(self) -> int:
        """How many scalars an object of this type consists of."""
        return 1

    @cached_property
    def pointer(self) -> PointerType:
        """A pointer to this type: `int *` of `int`."""
        return PointerType(f"{self} *", self)

    def __getstate__(self) -> dict[str, Any]:
        """The fields without cached properties: equal types are pickled as equal bytes."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class VoidType(CType):
    """`void`."""


@dataclass(frozen=True)
class IntType(CType):
    """An integer type of `bits` bits.  A bit-field that is narrower than int has its own width."""

    bits: int
    signed: bool
    rank: int

    @cached_property
    def words(self) -> int:
        """One word up to 16 bits, two for long, four for long long."""
        return 1 if self.bits <= 16 else 2 if self.bits <= 32 else 4

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
class Double64(FloatType):
    """IEEE double precision: `long double`, and `double` under the EABI.

    The FPU of this chip computes in single precision only: functions of the run-time library compute in this type.
    """

    @cached_property
    def words(self) -> int:
        """Four words."""
        return 4


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
    """An opaque pointer type of a kernel header.  Its values are objects of the emulator."""

    @cached_property
    def words(self) -> int:
        """Two words."""
        return 2


@dataclass(frozen=True)
class FunctionType(CType):
    """A function type.  A value of this type is a pointer to the function."""

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
        """The alignment of the element."""
        return self.element.align

    @cached_property
    def leaves(self) -> int:
        """The scalars of all elements."""
        return self.element.leaves * self.length


@dataclass(frozen=True)
class Member:
    """A structure member: its offset in words, and the index of its first scalar.

    A bit-field has a `width`.  It starts at bit `lo` of its declared type, counted from the lowest bit, at `offset`.
    """

    name: str
    ctype: CType
    offset: int
    leaf: int
    lo: int = 0
    width: int | None = None
    volatile: bool = False


#: Only in the name of a structure or union that has no tag.
UNNAMED: Final = "(line"


@dataclass(frozen=True)
class StructType(CType):
    """Members in order, 32-bit members on even words, size rounded to the alignment.

    A structure that is only declared has no members.  A structure that contains a union or a bit-field is
    *word-backed*: its scalars are its words.
    """

    members: tuple[Member, ...] = field(compare=False, default=())

    @cached_property
    def words(self) -> int:
        """The end of the last member, rounded up to the alignment."""
        return _round_up(max((m.offset + m.ctype.words for m in self.members), default=0), self.align)

    @cached_property
    def align(self) -> int:
        """The largest alignment of a member."""
        return max((m.ctype.align for m in self.members), default=1)

    @cached_property
    def leaves(self) -> int:
        """The scalars of all members; the words if the type is word-backed."""
        return self.words if self.word_backed else sum(m.ctype.leaves for m in self.members)

    @property
    def has_name(self) -> bool:
        """Whether it has a tag or a typedef.  Without one, only the objects of one declaration have this type."""
        return UNNAMED not in self.name

    @cached_property
    def word_backed(self) -> bool:
        """Whether its scalars overlap or share words."""
        return any(m.width is not None or is_word_backed(m.ctype) for m in self.members)

    def member(self, name: str) -> Member | None:
        """The member called `name`.

        Members of a structure or union without a name count as members of this one (C11 6.7.2.1 p13).
        """
        for m in self.members:
            if m.name == name:
                return m
            inner = m.ctype.member(name) if not m.name and isinstance(m.ctype, StructType) else None
            if inner is not None:
                volatile = m.volatile or inner.volatile
                return replace(inner, offset=m.offset + inner.offset, leaf=m.leaf + inner.leaf, volatile=volatile)
        return None

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all members, in order."""
        return tuple(
            name
            for m in self.members
            for name in ([m.name] if m.name or not isinstance(m.ctype, StructType) else m.ctype.names)
        )


@dataclass(frozen=True)
class UnionType(StructType):
    """Members that all begin at the first word; it is word-backed."""

    @cached_property
    def word_backed(self) -> bool:
        """Always true."""
        return True


@dataclass(frozen=True)
class BlockType(CType):
    """A register block as the device header declares it: `struct EPWM_REGS`; registers by name."""

    layout: dict[str, Any] = field(compare=False, repr=False)


def is_word_backed(ctype: CType) -> bool:
    """Whether the scalars of an object of this type are its words."""
    while isinstance(ctype, ArrayType):
        ctype = ctype.element
    return isinstance(ctype, StructType) and ctype.word_backed


def make_struct(name: str, members: list[tuple[str, CType]]) -> StructType:
    """Lay out a structure without bit-fields."""
    return complete(StructType(name), [(member, ctype, None) for member, ctype in members])


def complete(
    declared: StructType, members: Sequence[tuple[str, CType, int | None]], volatile: Collection[str] = ()
) -> StructType:  # fmt: skip
    """Add the members to a structure or union that was only declared: name, type, and width of a bit-field.

    `volatile` names the members that are declared volatile.

    The type is changed in place, because pointers to it exist.  A bit-field takes the next free bit.  If it would cross
    the end of a unit of its declared type, counted from the start of the structure, it starts the next unit.  A width
    of 0 ends a unit (SPRAC71 2.8; CC section "field/structure alignment": `Uint16 a:15; Uint32 b:4;` are 19 adjacent
    bits).
    """
    laid: list[Member] = []
    free = leaf = 0  # `free`: the first free bit
    for name, ctype, width in members:
        if isinstance(declared, UnionType):
            free = 0
        if width is None:
            offset = _round_up(-(-free // 16), ctype.align)
            laid.append(Member(name, ctype, offset, leaf, volatile=name in volatile))
            free = 16 * (offset + ctype.words)
            leaf += ctype.leaves
            continue
        bits = 16 * ctype.words
        if not width or free // bits != (free + width - 1) // bits:
            free = _round_up(free, bits)
        if width and name:
            laid.append(Member(name, ctype, free // bits * ctype.words, leaf, free % bits, width, name in volatile))
        free += width
    for known in ("words", "align", "leaves", "word_backed"):
        declared.__dict__.pop(known, None)
    object.__setattr__(declared, "members", tuple(laid))
    return declared


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
LLONG: Final = IntType("long long", 64, True, 4)
ULLONG: Final = IntType("unsigned long long", 64, False, 4)
#: `_Bool`: 0 or 1 in a word.
BOOL: Final = IntType("_Bool", 16, False, 0)
FLOAT: Final = FloatType("float")
LONG_DOUBLE: Final = Double64("long double")
#: `double` under the EABI.  (Under the COFF ABI it is `FLOAT`.)
DOUBLE: Final = Double64("double")

#: Names of the firmware language.
BASIC: Final[dict[str, CType]] = {
    "void": VOID, "char": CHAR, "schar": SCHAR, "uchar": UCHAR, "int16": INT, "uint16": UINT,
    "int32": LONG, "uint32": ULONG, "int64": LLONG, "uint64": ULLONG, "float32": FLOAT,
    "float64": LONG_DOUBLE,
}  # fmt: skip

#: Specifiers of a declaration in alphabetical order -> the type.  `int` beside another word is redundant.
_SPECIFIED: Final[dict[tuple[str, ...], CType]] = {
    ("void",): VOID, ("_Bool",): BOOL, ("char",): CHAR, ("char", "signed"): SCHAR, ("char", "unsigned"): UCHAR,
    ("short",): INT, ("short", "signed"): INT, ("short", "unsigned"): UINT,
    ("int",): INT, ("signed",): INT, ("unsigned",): UINT,
    ("long",): LONG, ("long", "signed"): LONG, ("long", "unsigned"): ULONG,
    ("long", "long"): LLONG, ("long", "long", "signed"): LLONG, ("long", "long", "unsigned"): ULLONG,
    ("float",): FLOAT, ("double", "long"): LONG_DOUBLE,
}  # fmt: skip


def specified(words: Iterable[str]) -> CType | None:
    """The basic type that these words name, in any order: `unsigned long int`; None if they name none."""
    said = sorted(words)
    if len(said) > 1 and "int" in said:
        said.remove("int")
    return _SPECIFIED.get(tuple(said))


def bit_field(width: int, *, signed: bool = False) -> IntType:
    """The type of a bit-field of `width` bits."""
    return IntType(f"{'int' if signed else 'unsigned'}:{width}", width, signed, 2 if width <= 16 else 3)


def pointed(ctype: CType) -> CType:
    """The target type of a pointer to an object of this type; for an array that is its element."""
    return ctype.element if isinstance(ctype, ArrayType) else ctype


def is_arithmetic(ctype: CType) -> bool:
    """Whether C does arithmetic on it."""
    return isinstance(ctype, IntType | FloatType)


def promote(ctype: IntType) -> IntType:
    """Integer promotion: to int if int holds every value, else to unsigned int; longs stay."""
    if ctype.bits > 32:
        return LLONG if ctype.signed else ULLONG
    if ctype.bits > 16:
        return LONG if ctype.signed else ULONG
    if ctype.signed or ctype.bits < 16 or ctype == BOOL:
        return INT
    return UINT


def usual(a: CType, b: CType) -> CType:
    """The usual arithmetic conversions: the type in which `a op b` is computed."""
    for widest in (LONG_DOUBLE, DOUBLE):
        if widest in (a, b):
            return widest
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


#: CHOICE: these values of an enumeration mean "none", whatever its constants are.
NOBODY: Final = (0xFF, 0x7FFF, 0xFFFF)


def counts_octets(length: int, left: int, element_words: int) -> bool:
    """Whether the length of a block seems to count octets, though sizes count words of 16 bits here.

    It is twice the words that are left of the object, or twice those of whole elements of 32 bits.
    """
    words, odd = divmod(length, 2)
    return not odd and (words == left or (element_words == 2 and words % 2 == 0 and 0 < words <= left))


def part_name(ctype: CType, offset: int) -> str:
    """The C name of the part at word `offset` of an object: `[3].X`; a later word of a scalar has its number."""
    if isinstance(ctype, ArrayType):
        index, rest = divmod(offset, max(1, ctype.element.words))
        return f"[{index}]{part_name(ctype.element, rest)}"
    if isinstance(ctype, StructType) and not ctype.word_backed:
        for member in ctype.members:
            if 0 <= offset - member.offset < member.ctype.words:
                return f"{member.name and '.'}{member.name}{part_name(member.ctype, offset - member.offset)}"
        return f" (padding at word {offset})"
    return f" (word {offset})" if offset else ""


def scalars(ctype: CType, offset: int = 0) -> list[tuple[int, CType]]:
    """Every scalar of `ctype` as (word offset, type), in leaf order."""
    if isinstance(ctype, ArrayType):
        inner = scalars(ctype.element)
        return [(offset + i * ctype.element.words + o, t) for i in range(ctype.length) for o, t in inner]
    if isinstance(ctype, StructType) and ctype.word_backed:
        return [(offset + word, UINT) for word in range(ctype.words)]
    if isinstance(ctype, StructType):
        return [leaf for m in ctype.members for leaf in scalars(m.ctype, offset + m.offset)]
    return [(offset, ctype)]
