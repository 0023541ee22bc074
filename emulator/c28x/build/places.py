"""The places that expressions designate: objects, members, elements, targets of pointers, registers, fields."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

from emulator.c28x.build.conversions import promoted
from emulator.c28x.build.scope import Builder
from emulator.c28x.ctypes import (
    INT,
    UINT,
    ULONG,
    VOID,
    ArrayType,
    BlockType,
    CType,
    FunctionType,
    IntType,
    Member,
    PointerType,
    StructType,
    bit_field,
)  # fmt: skip
from emulator.c28x.symbols import CoreRegister, RegisterBlock, SourceError, Unmodelled, nearest
from emulator.c28x.tree import (
    AddressOf,
    Bits,
    Const,
    Convert,
    Expr,
    Field,
    Function,
    FunctionRef,
    Index,
    Load,
    LValue,
    PointerAdd,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Variable,
    Where,
)  # fmt: skip

#: The type of an entry of the vector table: `typedef interrupt void (*PINT)(void)`.
PINT: Final = FunctionType("PINT", VOID, ())


@dataclass
class RegisterPath:
    """An incomplete access to a register block: the block alone, or a register without its `.all` or `.bit.FIELD`.

    The block is a named one of the chip, or the one that `pointer` points to.
    """

    block: str
    layout: dict[str, Any]
    ctype: BlockType
    pointer: Expr | None
    way: tuple[str, ...]
    where: Where
    text: str
    #: The block is not modelled: its registers are not known.
    unmodelled: bool = False


#: The places that an expression can designate.
Place = LValue | RegisterRef | RegisterAt | RegisterPath


def object_place(variable: Variable, where: Where) -> LValue:
    """A variable by its name."""
    return LValue(variable.ctype, variable, where=where, text=variable.declaration.name)


def register_block(registers: RegisterBlock, where: Where) -> RegisterPath:
    """A register block by its name."""
    return RegisterPath(registers.name, registers.layout, block_type(registers), None, (), where, registers.name)


def unmodelled_block(block: Unmodelled, where: Where) -> RegisterPath:
    """A register block that is not modelled, by its name.  Any register name is accepted in it."""
    return RegisterPath(block.name, {}, BlockType(block.name, {}), None, (), where, block.name, unmodelled=True)


def block_type(registers: RegisterBlock) -> BlockType:
    """The structure type of a register block."""
    return BlockType(registers.type_name or registers.name, registers.layout)


def core_register(register: CoreRegister, where: Where) -> RegisterRef:
    """A register of the core: IER, IFR."""
    return RegisterRef("CPU", register.name, None, 16, UINT, where=where)


def dereference(b: Builder, pointer: Expr, where: Where, text: str = "") -> Place | Expr:
    """`*pointer`; for a pointer to a function, the function."""
    if isinstance(pointer.ctype, FunctionType):
        return pointer
    if not isinstance(pointer.ctype, PointerType):
        raise SourceError.at(where, f"'{text}' is a {pointer.ctype}, not a pointer")
    target = pointer.ctype.target
    if isinstance(target, StructType | BlockType):
        return pointee(b, pointer, where, text)
    return element(b, pointer, Const(INT, 0, where=where), where, text)


def pointee(b: Builder, pointer: Expr, where: Where, text: str = "") -> Place:
    """The structure or register block that `pointer` points to: the left of `->`."""
    if not isinstance(pointer.ctype, PointerType):
        raise SourceError.at(where, f"'{text}' is a {pointer.ctype}, not a pointer")
    target = pointer.ctype.target
    match pointer:
        case AddressOf(lvalue=LValue(ctype=ArrayType())):
            return element(b, pointer, Const(INT, 0, where=where), where, text)
        case AddressOf(lvalue=lvalue) if lvalue.ctype == target:
            return lvalue
        case RegisterAddress(block=block, register="") if isinstance(target, BlockType):
            return RegisterPath(block, target.layout, target, None, (), where, text)
    if isinstance(target, BlockType):
        return RegisterPath("", target.layout, target, pointer, (), where, text)
    return LValue(target, pointer, where=where, text=text)


def member(b: Builder, base: Place | Expr, name: str, where: Where, *, text: str, base_text: str) -> Place:
    """`base.name`; for a pointer, `base->name`.  Raises SourceError where there is no such member or register."""
    if isinstance(base, LValue) and isinstance(base.ctype, PointerType):
        base = value_of(b, base)
    if isinstance(base, Expr):
        base = pointee(b, base, where, base_text)
    if isinstance(base, RegisterPath):
        return _register(base, name, where, text)
    if isinstance(base, RegisterRef | RegisterAt):
        raise SourceError.at(where, f"'{text}': C writes {base_text}")
    ctype = base.ctype
    if not isinstance(ctype, StructType):
        raise SourceError.at(where, f"'{base_text}' is a {ctype}, not a structure")
    if not ctype.members:
        why = "as a peripheral of the chip it is not modelled" if ctype.name.endswith("_REGS") else "include what does"
        raise SourceError.at(where, f"no file that is included says what {ctype} holds: {why}")
    found = ctype.member(name)
    if found is None:
        raise SourceError.at(where, f"{ctype} has no member {name}" + nearest(name, ctype.names))
    if ctype.word_backed:
        place = seen_by_words(base, found, where, text)
    else:
        leaf, words = base.leaf + found.leaf, base.words + found.offset
        place = LValue(found.ctype, base.root, leaf, words, base.indices, where, text)
    place.volatile = base.volatile or found.volatile
    return place


def seen_by_words(base: LValue, found: Member, where: Where, text: str) -> LValue:
    """A member of a word-backed object: the words of the object, read as the declared type of the member."""
    if isinstance(base.root, Variable):
        base.root.escapes = True
    word = LValue(UINT, base.root, base.leaf + found.offset, base.words + found.offset, base.indices, where, text)
    if isinstance(base.root, Variable):
        base.root.escapes = True  # it is reached through a pointer
    if found.width is not None:
        assert isinstance(found.ctype, IntType)
        whole = word if found.ctype.words == 1 else _seen_as(word, found.ctype)
        whole.ctype = bit_field(found.width, signed=found.ctype.signed)
        whole.bits = Bits(found.lo, found.width)
        return whole
    return word if found.ctype == UINT else _seen_as(word, found.ctype)


def octet_of(words: Expr, number: Expr, where: Where, text: str) -> LValue:
    """Octet `number` of the words at a pointer.  An even octet is the lower half of its word."""
    if not isinstance(number.ctype, IntType):
        raise SourceError.at(number.where, "the number of an octet must be an integer")
    index = Index(number, None, 1, 1)
    return LValue(bit_field(8), words, 0, 0, [index], where, text, bits=Bits(0, 8, octets=True))


def _seen_as(word: LValue, ctype: CType) -> LValue:
    """`*(ctype *)&word`."""
    address = AddressOf(UINT.pointer, word, where=word.where)
    return LValue(ctype, Convert(ctype.pointer, address, where=word.where), where=word.where, text=word.text)


def element(b: Builder, base: Place | Expr, index: Expr, where: Where, text: str = "", base_text: str = "") -> Place:
    """`base[index]`.  Raises SourceError if `base` is not an array or pointer, or `index` not an integer."""
    if not isinstance(index.ctype, IntType):
        raise SourceError.at(index.where, "an index must be an integer")
    index = promoted(b, index)
    if isinstance(base, LValue) and isinstance(base.ctype, PointerType):
        base = value_of(b, base)
    if isinstance(base, AddressOf) and isinstance(base.lvalue.ctype, ArrayType) and (
        base.ctype == base.lvalue.ctype.element.pointer
    ):
        base = base.lvalue
    if isinstance(base, Expr):
        if not isinstance(base.ctype, PointerType):
            raise SourceError.at(where, f"'{base_text}' is a {base.ctype}, not a pointer")
        target = base.ctype.target
        if isinstance(target, BlockType) and isinstance(index, Const) and index.value == 0:
            return pointee(b, base, where, text)
        if target == VOID or isinstance(target, BlockType) or (isinstance(target, StructType) and not target.members):
            raise SourceError.at(where, f"'{base_text}' is a {base.ctype}: what it points to has no size")
        return LValue(target, base, 0, 0, [Index(index, None, target.leaves, max(1, target.words))], where, text)
    if not isinstance(base, LValue):
        raise SourceError.at(where, f"'{base_text}' is a register: it cannot be indexed")
    if not isinstance(base.ctype, ArrayType):
        raise SourceError.at(where, f"'{base_text}' is a {base.ctype}: it cannot be indexed")
    inner = base.ctype.element
    step = Index(index, base.ctype.length, inner.leaves, inner.words)
    indices = [*base.indices, step]
    return LValue(inner, base.root, base.leaf, base.words, indices, where, text, volatile=base.volatile)


def _register(base: RegisterPath, name: str, where: Where, text: str) -> Place:
    """A step into a register block: `Regs.R`, `.all`, `.bit`, `.FIELD`, or `Regs.PART.R`."""
    way = (*base.way, name)
    if base.unmodelled:
        return _unmodelled_register(base, way, where, text)
    if _part(base, way[0]) is not None:
        if len(way) == 1:
            return RegisterPath(base.block, base.layout, base.ctype, base.pointer, way, where, text)
        way = (".".join(way[:2]), *way[2:])
    shown = base.block or f"struct {base.ctype}"
    entry = base.layout.get(way[0])
    if entry is None:
        raise SourceError.at(where, f"{shown} has no register {way[0]}" + nearest(way[0], base.layout))
    description = entry.register
    plain = description.__name__ == "PlainRegister"
    whole: CType = ULONG if description.bits == 32 else UINT
    if getattr(entry, "routine", False):
        whole = PINT
    match way[1:]:
        case [] | ["all"] as rest if plain == (not rest):
            return _made(base, entry, None, whole, where)
        case [] | ["bit"] if not plain:
            return RegisterPath(base.block, base.layout, base.ctype, base.pointer, way, where, text)
        case ["bit", field] if not plain:
            f = description.fields.get(field)
            if f is None:
                alike = nearest(field, description.fields)
                raise SourceError.at(where, f"{shown}.{way[0]} has no field {field}{alike}")
            made = Field(field, f.lo, f.width, f.mask, f.lane)
            return _made(base, entry, made, bit_field(f.width), where)
    wanted = f"{shown}.{way[0]}" + ("" if plain else ".all or .bit.FIELD")
    if way[1:2] == ("half",):
        wanted += " (.half is of the headers for older parts)"
    raise SourceError.at(where, f"'{text}': C writes {wanted}")


def _unmodelled_register(base: RegisterPath, way: tuple[str, ...], where: Where, text: str) -> Place:
    """A step into a block that is not modelled: `Regs.R`, `.all`, `.bit`, `.FIELD`."""
    match way:
        case (register, "all"):
            return RegisterRef(base.block, register, None, 32, ULONG, where=where, unmodelled=True)
        case (_,) | (_, "bit"):
            return replace(base, way=way, where=where, text=text)
        case (register, "bit", field):
            return RegisterRef(base.block, f"{register}.{field}", None, 16, UINT, where=where, unmodelled=True)
    raise _only_by_name(base.block, where)


def _only_by_name(block: str, where: Where) -> SourceError:
    """The error about an operation that a block which is not modelled does not have."""
    return SourceError.at(where, f"{Unmodelled(block).message}: only its registers by name are known")


def _part(base: RegisterPath, name: str) -> Any:
    """The structure `name` within a register block; None if there is no such structure."""
    return next((entry.part for entry in base.layout.values() if entry.part and entry.part.name == name), None)


def _made(
    base: RegisterPath, entry: Any, field: Field | None, ctype: CType, where: Where
) -> RegisterRef | RegisterAt:  # fmt: skip
    description = entry.register
    name = entry.name
    if base.pointer is not None:
        return RegisterAt(base.pointer, name, entry.offset, field, description.bits, ctype, where)
    reads_zero = field is not None and not description.read_mask
    plain = (
        field is not None and description.bits == 16 and description.rw_mask == description.read_mask
        and not field.mask & ~description.rw_mask
    )  # fmt: skip
    clears = bool(description.clears)
    return RegisterRef(base.block, name, field, description.bits, ctype, reads_zero, plain, clears, where)


def complete(place: Place) -> LValue | RegisterRef | RegisterAt:
    """A place that has a value.  Raises SourceError for a register block, or for a register without its `.all`."""
    if isinstance(place, RegisterPath):
        if place.unmodelled:
            if len(place.way) != 1:
                raise _only_by_name(place.block, place.where)
            return RegisterRef(place.block, place.way[0], None, 32, ULONG, where=place.where, unmodelled=True)
        shown = place.block or f"struct {place.ctype}"
        wanted = f"{shown}.{place.way[0] if place.way else 'REGISTER'}.all or .bit.FIELD"
        raise SourceError.at(place.where, f"'{place.text}': C writes {wanted}")
    return place


def value_of(b: Builder, place: Place) -> Expr:
    """The value of a place; an array decays to a pointer to its first element."""
    place = complete(place)
    if not isinstance(place, LValue):
        return RegisterLoad(place.ctype, place, where=place.where)
    if isinstance(place.ctype, ArrayType):
        if isinstance(place.root, Variable):
            place.root.escapes = True
        return AddressOf(place.ctype.element.pointer, place, where=place.where)
    return Load(place.ctype, place, where=place.where)


def function_value(b: Builder, function: Function, where: Where) -> Expr:
    """A function's name as a value: its address."""
    b.function.calls.add(function.path)
    return FunctionRef(function.ctype, function, where=where)


def address_of(b: Builder, place: Place, where: Where) -> Expr:
    """`&place`.  Raises SourceError for a bit-field."""
    match place:
        case RegisterPath(unmodelled=True) | RegisterRef(unmodelled=True):
            raise _only_by_name(place.block, where)
        case RegisterPath(pointer=None, way=()):
            return RegisterAddress(place.ctype.pointer, place.block, where=where)
        case RegisterPath(way=(name,)) if (part := _part(place, name)) is not None:
            ctype = BlockType(part.kind.__name__, part.kind.layout)
            if place.pointer is not None:
                return _register_after(place.pointer, part.offset, ctype, where)
            return RegisterAddress(ctype.pointer, place.block, f"{name}.{next(iter(ctype.layout))}", where=where)
        case RegisterPath(pointer=None, way=(name,)):
            return RegisterAddress(_width(place.layout[name]).pointer, place.block, name, where=where)
        case RegisterPath(pointer=Expr() as pointer, way=()):
            return pointer
        case RegisterPath(pointer=Expr() as pointer, way=(name,)):
            entry = place.layout[name]
            return _register_after(pointer, entry.offset, _width(entry), where)
        case RegisterRef(field=None):
            return RegisterAddress(place.ctype.pointer, place.block, place.register, where=where)
        case RegisterAt(field=None):
            return _register_after(place.block, place.words, place.ctype, where)
        case LValue(root=Expr(), indices=[*before, Index(expr=Const(value=past), bound=int(bound))]) if past == bound:
            # One behind the last element of an array: an address, never an access.
            array = ArrayType(f"{place.ctype}[{bound}]", place.ctype, bound)
            start = AddressOf(place.ctype.pointer, replace(place, ctype=array, indices=before), where=where)
            return PointerAdd(start.ctype, start, Const(INT, bound, where=where), where=where)
        case LValue(bits=None):
            if isinstance(place.root, Variable):
                if place.root.kind == "temporary":
                    raise SourceError.at(where, "this value has no address")
                place.root.escapes = True
                place.root.in_memory = place.root.in_memory or place.root.kind != "global"
            return AddressOf(place.ctype.pointer, place, where=where)
    raise SourceError.at(where, "a bit-field has no address")


def _width(entry: Any) -> CType:
    return ULONG if entry.register.bits == 32 else UINT


def _register_after(pointer: Expr, words: int, ctype: CType, where: Where) -> Expr:
    """The address `words` behind the beginning of the block that `pointer` points to."""
    start = Convert(UINT.pointer, pointer, where=where)
    moved: Expr = PointerAdd(start.ctype, start, Const(INT, words, where=where), where=where) if words else start
    return moved if ctype == UINT else Convert(ctype.pointer, moved, where=where)
