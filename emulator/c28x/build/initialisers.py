"""Initialisers: lists (nested, flat, with designators) become one value per scalar; missing values are zero."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from emulator.c28x.build.constants import constant_value
from emulator.c28x.build.conversions import convert
from emulator.c28x.build.scope import Builder
from emulator.c28x.ctypes import (
    INT,
    UINT,
    ULONG,
    ArrayType,
    CType,
    IntType,
    Member,
    StructType,
    UnionType,
    is_arithmetic,
    is_word_backed,
)  # fmt: skip
from emulator.c28x.memory import RAM_WORDS, to_words
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    AddressOf,
    Binary,
    Const,
    Convert,
    Expr,
    FunctionRef,
    Load,
    LValue,
    Null,
    PointerAdd,
    RegisterAddress,
    String,
    Where,
)  # fmt: skip


@dataclass
class Item:
    """One value of a list.  `way`: its designators, members and indices; `build`: its value for an object of a type."""

    where: Where
    build: Callable[[CType], Expr]
    way: Sequence[str | int] = ()


@dataclass
class Braces:
    """A list in braces; `ctype` is the type written with it, if the language has one there."""

    where: Where
    items: list[Item | Braces]
    way: Sequence[str | int] = ()
    ctype: CType | None = None


@dataclass
class _Cursor:
    """The items of one list, taken one after the other."""

    items: list[Item | Braces]
    at: int = 0

    def peek(self) -> Item | Braces | None:
        return self.items[self.at] if self.at < len(self.items) else None


@dataclass(frozen=True)
class _Offsets:
    """Where a part of the whole object begins: the number of its first scalar and of its first word."""

    leaf: int = 0
    word: int = 0

    def part(self, ctype: CType, number: int) -> tuple[CType, _Offsets, Member | None]:
        """The type of part `number`, where it begins, and its member (None: not a member)."""
        if isinstance(ctype, ArrayType):
            element = ctype.element
            return element, _Offsets(self.leaf + number * element.leaves, self.word + number * element.words), None
        assert isinstance(ctype, StructType)
        m = ctype.members[number]
        return m.ctype, _Offsets(self.leaf + m.leaf, self.word + m.offset), m


@dataclass(frozen=True)
class _Scalar:
    """A scalar with a given value, and where it lies."""

    at: _Offsets
    member: Member | None
    value: Expr

    @property
    def part(self) -> Member:
        """The scalar as a member of the whole object."""
        if self.member is None:
            return Member("", self.value.ctype, self.at.word, self.at.word)
        return replace(self.member, offset=self.at.word)


def array_of(element: CType, length: int, where: Where) -> ArrayType:
    """An array.  Raises SourceError for one that is empty, or larger than the chip's RAM."""
    if length < 1:
        raise SourceError.at(where, "an array needs at least one element")
    if element.words * length > RAM_WORDS:
        words = element.words * length
        message = f"an array of {words} words does not fit into the memory"
        raise SourceError.at(where, f"{message}: the chip has {RAM_WORDS} words of RAM")
    return ArrayType(f"{element}[{length}]", element, length)


def values(
    b: Builder, ctype: CType, given: Item | Braces, later: list[tuple[Member, Expr]] | None = None
) -> list[Expr]:  # fmt: skip
    """The initial value of every scalar of an object of type `ctype`.

    In a word-backed object, a value that is not known as words at translation time is appended to `later`; its words
    are 0.  Without `later`, only addresses may be such values.  Raises SourceError.
    """
    if not isinstance(ctype, ArrayType | StructType):
        return [_scalar(b, ctype, given)]
    found = _whole(b, ctype, given, _Offsets())
    if found is None:
        raise SourceError.at(given.where, f"a {ctype} is initialised by a list in braces")
    if is_word_backed(ctype):
        return _words(b, ctype, found, later)
    by_leaf = {scalar.at.leaf: scalar.value for scalar in found}
    return [by_leaf.get(i, zero) for i, zero in enumerate(_zeros(ctype, given.where))]


def _scalar(b: Builder, ctype: CType, given: Item | Braces) -> Expr:
    """The value of a scalar; braces around it are allowed."""
    while isinstance(given, Braces):
        if given.ctype is not None:
            raise SourceError.at(given.where, f"a {ctype} is initialised by a {given.ctype}")
        if len(given.items) != 1:
            raise SourceError.at(given.where, f"a {ctype} takes one value")
        given = given.items[0]
    return convert(b, given.build(ctype), ctype)


def _whole(b: Builder, ctype: ArrayType | StructType, given: Item | Braces, at: _Offsets) -> list[_Scalar] | None:
    """The scalars of an aggregate that one item initialises: a list, a string, a structure; None: it does not."""
    if isinstance(given, Braces):
        if given.ctype is not None and given.ctype != ctype:
            raise SourceError.at(given.where, f"a {ctype} is initialised by a {given.ctype}")
        if isinstance(ctype, ArrayType) and _is_characters(ctype) and len(given.items) == 1:
            only = given.items[0]
            if isinstance(only, Item) and not only.way and (text := _string(only, ctype)) is not None:
                return _characters(ctype, text, at)
        return _list(b, ctype, given, at)
    if isinstance(ctype, ArrayType):
        text = _string(given, ctype) if _is_characters(ctype) else None
        return None if text is None else _characters(ctype, text, at)
    value = _built(given, ctype)
    return _copied(ctype, value.lvalue, at) if isinstance(value, Load) and value.ctype == ctype else None


def _built(given: Item, ctype: CType) -> Expr:
    """The value of an item.  It is built only once, because it may have effects."""
    value = given.build(ctype)
    given.build = lambda wanted: value
    return value


def _string(given: Item, ctype: CType) -> String | None:
    """The string literal that an item is; None for another item."""
    value = _built(given, ctype)
    return value if isinstance(value, String) else None


def _is_characters(ctype: ArrayType) -> bool:
    return isinstance(ctype.element, IntType) and ctype.element.bits == 16


def _characters(ctype: ArrayType, value: String, at: _Offsets) -> list[_Scalar]:
    """The characters of a string, then zeros up to the length of the array."""
    if len(value.text) > ctype.length:
        raise SourceError.at(value.where, f"a text of {len(value.text)} characters does not fit into a {ctype}")
    text = [ord(c) for c in value.text]
    given = [
        _Scalar(at.part(ctype, i)[1], None, Const(ctype.element, c, where=value.where)) for i, c in enumerate(text)
    ]
    if ctype.leaves != ctype.words:
        return given
    zero = Const(ctype.element, 0, where=value.where)
    return given + [_Scalar(_Offsets(at.leaf + i, at.word + i), None, zero) for i in range(len(text), ctype.length)]


def _copied(ctype: CType, source: LValue, at: _Offsets) -> list[_Scalar]:
    """The scalars of another object."""
    if not isinstance(ctype, ArrayType | StructType):
        return [_Scalar(at, None, Load(ctype, source, where=source.where))]
    found: list[_Scalar] = []
    for i in range(_parts(ctype)):
        part, inner, _ = at.part(ctype, i)
        leaf, word = inner.leaf - at.leaf, inner.word - at.word
        found += _copied(part, replace(source, ctype=part, leaf=source.leaf + leaf, words=source.words + word), inner)
    return found


def _list(b: Builder, ctype: CType, given: Braces, at: _Offsets) -> list[_Scalar]:
    """An aggregate from its list."""
    cursor = _Cursor(list(given.items))
    result: list[_Scalar] = []
    _fill(b, ctype, cursor, at, result, top=True)
    rest = cursor.peek()
    if rest is not None:
        raise SourceError.at(
            rest.where, f"too many initialisers for a {ctype}: {len(given.items)} for {_parts(ctype)}"
        )  # fmt: skip
    return result


def _parts(ctype: CType) -> int:
    """How many parts a list without designators initialises: of a union only the first member."""
    if isinstance(ctype, ArrayType):
        return ctype.length
    return (
        len(ctype.members[:1] if isinstance(ctype, UnionType) else ctype.members)
        if (isinstance(ctype, StructType))
        else 1
    )


def _step(ctype: CType, way: Sequence[str | int], where: Where) -> tuple[int, Sequence[str | int]]:
    """Which part the first of some designators leads to, and the designators that are left within it."""
    designator = way[0]
    if isinstance(ctype, ArrayType) and isinstance(designator, int):
        if not 0 <= designator < ctype.length:
            raise SourceError.at(where, f"[{designator}] is outside of a {ctype}")
        return designator, way[1:]
    if isinstance(ctype, StructType) and isinstance(designator, str):
        for i, m in enumerate(ctype.members):
            if m.name == designator:
                return i, way[1:]
            if not m.name and isinstance(m.ctype, StructType) and m.ctype.member(designator) is not None:
                return i, way
        raise SourceError.at(where, f"{ctype} has no member {designator}")
    raise SourceError.at(where, f"this designator does not fit a {ctype}")


def _fill(
    b: Builder, ctype: CType, cursor: _Cursor, at: _Offsets, result: list[_Scalar], *, top: bool, led: bool = False
) -> None:  # fmt: skip
    """Fill an aggregate from the items at the cursor: from its own list (`top`), or from an outer list.

    `led`: designators of the first item have led into it (ISO C99 6.7.8 p17: the list goes on behind that part).
    """
    number = 0
    while (item := cursor.peek()) is not None:
        if item.way:
            if not top and not led:
                return
            led = False
            number, way = _step(ctype, item.way, item.where)
            cursor.items[cursor.at] = replace(item, way=way)
        elif number >= _parts(ctype):
            return
        _next(b, ctype, number, cursor, at, result)
        number += 1


def _next(b: Builder, ctype: CType, number: int, cursor: _Cursor, at: _Offsets, result: list[_Scalar]) -> None:
    """Fill part `number` of an aggregate from the item at the cursor."""
    item = cursor.items[cursor.at]
    part, inner, member = at.part(ctype, number)
    if item.way:  # `.a.b[1] = x`: further designators lead into the part
        _fill(b, part, cursor, inner, result, top=False, led=True)
    elif isinstance(part, ArrayType | StructType):
        found = _whole(b, part, item, inner)
        if found is None:  # no braces of its own: it takes as many items as it has scalars
            _fill(b, part, cursor, inner, result, top=False)
            return
        cursor.at += 1
        result += found
    else:
        cursor.at += 1
        result.append(_Scalar(inner, member, _scalar(b, part, item)))


def _zeros(ctype: CType, where: Where) -> list[Expr]:
    """Zero for every scalar."""
    if isinstance(ctype, ArrayType):
        return _zeros(ctype.element, where) * ctype.length
    if isinstance(ctype, StructType):
        return [zero for m in ctype.members for zero in _zeros(m.ctype, where)]
    return [Const(ctype, 0, where=where) if is_arithmetic(ctype) else Null(ctype, where=where)]


def length_given(element: CType, given: Item | Braces) -> int:
    """The length of `element x[] = ...`, from its initialiser."""
    items = given.items if isinstance(given, Braces) else [given]
    if len(items) == 1 and isinstance(items[0], Item) and not items[0].way and isinstance(element, IntType):
        text = _string(items[0], ArrayType(f"{element}[]", element, 1))
        if text is not None:
            return len(text.text) + 1
    if isinstance(given, Item):
        raise SourceError.at(given.where, "an array without a length takes it from a list or a string")
    if isinstance(element, ArrayType | StructType) and not any(isinstance(i, Braces) or i.way for i in items):
        return -(-len(items) // element.leaves)
    length = at = 0
    for item in items:
        if item.way and isinstance(item.way[0], int):
            at = item.way[0]
        at += 1
        length = max(length, at)
    return length


def _words(
    b: Builder, ctype: CType, found: Sequence[_Scalar], later: list[tuple[Member, Expr]] | None
) -> list[Expr]:  # fmt: skip
    """The initial words of a word-backed object."""
    words: list[Expr] = [Const(UINT, 0)] * ctype.words
    for scalar in found:
        value, word, member = scalar.value, scalar.at.word, scalar.member
        field = member is not None and member.width is not None
        if later is None and not isinstance(value, Const) and (known := constant_value(value)) is not None:
            value = Const(value.ctype, known, where=value.where)
        if not isinstance(value, Const):
            if isinstance(value.ctype, IntType) and value.ctype.words == 1 and not field:
                words[word] = convert(b, value, UINT, explicit=True)
            elif later is not None:
                later.append((scalar.part, value))
            elif is_constant(value):
                number = convert(b, value, ULONG, explicit=True)
                halves = (number, Binary(ULONG, ">>", number, Const(INT, 16), where=value.where))
                words[word : word + 2] = [convert(b, half, UINT, explicit=True) for half in halves]
            else:
                raise SourceError.at(value.where, "the initial value of an object of the file is not a constant")
            continue
        if member is not None and member.width is not None:
            mask = (1 << member.width) - 1 << member.lo
            bits = int(value.value) << member.lo & mask
            parts = [bits >> 16 * i & 0xFFFF for i in range(member.ctype.words)]
            masks = [mask >> 16 * i & 0xFFFF for i in range(member.ctype.words)]
        else:
            parts = list(to_words(value.value, value.ctype))
            masks = [0xFFFF] * len(parts)
        for i, (part, mask) in enumerate(zip(parts, masks, strict=True)):
            before = words[word + i]
            saved = int(before.value) & ~mask if isinstance(before, Const) else 0
            words[word + i] = Const(UINT, saved | part & mask, where=value.where)
    return words


def is_constant(value: Expr) -> bool:
    """Whether a value is known before the program runs: a number, or the address of an object or function."""
    match value:
        case Const() | Null() | String() | FunctionRef() | RegisterAddress():
            return True
        case Convert(operand=operand):
            return is_constant(operand)
        case Binary(op=">>", left=left, right=Const()):
            return is_constant(left)
        case PointerAdd(pointer=pointer, index=index):
            return is_constant(pointer) and isinstance(index, Const)
        case AddressOf(lvalue=LValue(root=root, indices=indices)):
            steady = is_constant(root) if isinstance(root, Expr) else root.kind == "global"
            return steady and all(isinstance(index.expr, Const) for index in indices)
    return False
