"""C objects and values in Python: what a test reads, writes, and passes to a function.

| C | in Python |
|---|---|
| a number, an enumeration | a number |
| a structure or union, and the target of a pointer to one | `Structure`: members are attributes |
| an array | `Array`: elements by index, slices as lists; equal to a list of its values, of characters to its text |
| a pointer to anything else | `emulator.c28x.memory.Pointer`; NULL is None |
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final

from emulator.c28x.ctypes import (
    VOID,
    ArrayType,
    CType,
    FunctionType,
    HandleType,
    IntType,
    Member,
    PointerType,
    StructType,
    VoidType,
)  # fmt: skip
from emulator.c28x.link import to_c
from emulator.c28x.memory import NULL, Memory, Pointer, compatible
from emulator.c28x.symbols import EnumType
from emulator.c28x.tree import Declaration

#: How many elements of an array a repr shows.
_SHOWN: Final = 8


class Structure:
    """A structure or union of the firmware: its members are attributes."""

    __slots__ = ("_pointer",)
    _pointer: Pointer

    def __init__(self, pointer: Pointer) -> None:
        object.__setattr__(self, "_pointer", pointer)

    def __getattr__(self, name: str) -> Any:
        member = self._member(name)
        place = self._pointer.member(name)
        if member.width is None:
            return read(place)
        value = (_unsigned(place) >> member.lo) & ((1 << member.width) - 1)
        return IntType("", member.width, _signed(member.ctype), 0).wrap(value)

    def __setattr__(self, name: str, value: Any) -> None:
        member = self._member(name)
        place = self._pointer.member(name)
        with named_error(f"{_type(self)}.{name}"):
            if member.width is None:
                write(place, value)
                return
            field = to_c(value, IntType(f"{member.ctype}:{member.width}", member.width, _signed(member.ctype), 0))
        mask = (1 << member.width) - 1
        others = _unsigned(place) & ~(mask << member.lo)
        assert isinstance(place.target, IntType)
        place.store(place.target.wrap(others | (field & mask) << member.lo))

    def __dir__(self) -> list[str]:
        return [*_type(self).names]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Structure) and self._pointer == other._pointer

    def __hash__(self) -> int:
        return hash(self._pointer)

    def __repr__(self) -> str:
        values = (f"{name}={getattr(self, name)!r}" for name in _type(self).names)
        return f"{self._pointer.target}({', '.join(values)})"

    def _member(self, name: str) -> Member:
        ctype = _type(self)
        member = ctype.member(name)
        if member is None:
            raise AttributeError(f"{ctype} has no member {name}: it has {', '.join(dir(self))}")
        return member


def _type(structure: Structure) -> StructType:
    ctype = structure._pointer.target
    assert isinstance(ctype, StructType)
    return ctype


def _signed(ctype: CType) -> bool:
    return isinstance(ctype, IntType) and ctype.signed


def _unsigned(place: Pointer) -> int:
    return int(place.load()) & ((1 << 16 * place.target.words) - 1)


class Array:
    """An array of the firmware: elements by index, slices as lists.  `at(i)` is C's `&array[i]`, end included."""

    __slots__ = ("_pointer", "element", "length")

    def __init__(self, pointer: Pointer) -> None:
        assert isinstance(pointer.target, ArrayType)
        self._pointer = pointer
        self.element = pointer.target.element
        self.length = pointer.target.length

    def at(self, index: int) -> Pointer:
        """`&array[index]`; the index is not checked, as in C."""
        p = self._pointer
        return Pointer(p.memory, p.obj, p.offset + index * self.element.words, self.element)

    def __len__(self) -> int:
        return self.length

    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return [read(self.at(i)) for i in range(*index.indices(self.length))]
        return read(self.at(self._inside(index)))

    def __setitem__(self, index: int | slice, value: Any) -> None:
        if not isinstance(index, slice):
            write(self.at(self._inside(index)), value)
            return
        places = range(*index.indices(self.length))
        values = list(value)
        if len(values) != len(places):
            raise ValueError(f"{len(values)} values for {len(places)} elements of {self._pointer.target}")
        for i, each in zip(places, values, strict=True):
            write(self.at(i), each)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, str | bytes | bytearray):
            codes = characters(other)
            return len(codes) - 1 <= self.length and bool(self[: len(codes)] == codes[: self.length])
        if isinstance(other, list | tuple):
            return bool(self[:] == list(other))
        return isinstance(other, Array) and self._pointer == other._pointer

    def __hash__(self) -> int:
        return hash(self._pointer)

    def __repr__(self) -> str:
        ctype, lengths = self._pointer.target, ""
        while isinstance(ctype, ArrayType):
            lengths += f"[{ctype.length}]"
            ctype = ctype.element
        return f"{ctype}{lengths}{_braced(self)}"

    def _inside(self, index: int) -> int:
        if not 0 <= index < self.length:
            raise IndexError(f"index {index} of {self._pointer.target}: 0..{self.length - 1}")
        return index


def _braced(value: Any) -> str:
    """An array, written as an initialiser."""
    if not isinstance(value, Array):
        return repr(value)
    more = ", ..." if value.length > _SHOWN else ""
    return f"{{{', '.join(map(_braced, value[:_SHOWN]))}{more}}}"


class Enumeration:
    """The constants of a C enumeration as attributes."""

    def __init__(self, ctype: EnumType) -> None:
        self.__dict__.update(ctype.constants)
        self._names = {value: name for name, value in ctype.constants.items()}

    def __getattr__(self, name: str) -> int:
        raise AttributeError(f"the enumeration has no constant {name}")

    def name(self, value: int) -> str:
        """The constant's name, or the number."""
        return self._names.get(value, str(value))


@contextmanager
def named_error(where: str) -> Iterator[None]:
    """Add to an error about a value what the value was meant for."""
    try:
        yield
    except (TypeError, ValueError) as error:
        message = str(error)
        raise type(error)(f"{where}: {message}") from None


def make(memory: Memory, ctype: CType, name: str, values: Sequence[Any] | None = None) -> Pointer:
    """A pointer to a new object: never written, or with a C value for each of its scalars."""
    obj = memory.place(Declaration(name, ctype, "test", "", 0))
    if values is not None:
        obj.data[:] = values
    return Pointer(memory, obj, 0, ctype)


def read(place: Pointer) -> Any:
    """The object at `place` as a Python value.  For scalars that were never written, the fill decides."""
    if isinstance(place.target, StructType):
        return Structure(place)
    return Array(place) if isinstance(place.target, ArrayType) else to_python(place.load(), place.target, place.memory)


def to_python(value: Any, ctype: CType, memory: Memory | None) -> Any:
    """A C value as a Python value.  A structure by value becomes an object of its own."""
    if isinstance(ctype, StructType):
        assert memory is not None
        return Structure(make(memory, ctype, str(ctype), value))
    if isinstance(value, Pointer):
        if not value:
            return None
        if isinstance(value.target, ArrayType) and isinstance(ctype, PointerType) and ctype.target != VOID:
            return Pointer(value.memory, value.obj, value.offset, ctype.target)  # an array was returned: `return name;`
        return Structure(value) if isinstance(value.target, StructType) else value
    return value


def write(place: Pointer, value: Any) -> None:
    """Store a Python value as C would.

    A structure takes a structure of its type, or a mapping of members.  An array takes as many values as it has
    elements.  An array of characters takes a text as an initialiser does: the rest is 0, and the NUL may be cut off.

    Raises ValueError for a value that the C type cannot hold, and TypeError for a value of another kind.
    """
    memory, target = place.memory, place.target
    assert memory is not None
    if isinstance(target, StructType):
        if isinstance(value, Mapping):
            structure = Structure(place)
            for name, member in value.items():
                setattr(structure, name, member)
            return
        if not isinstance(value, Structure) or _type(value) != target:
            raise TypeError(f"{value!r} is no {target}: give one, or a mapping of its members")
        memory.copy(place, value._pointer, target.words)
    elif isinstance(target, ArrayType):
        if isinstance(value, str | bytes | bytearray) and _of_words(target.element):
            Array(place)[:] = _padded(value, target)
        elif isinstance(value, Iterable) and not isinstance(value, Mapping | str):
            Array(place)[:] = value
        else:
            raise TypeError(f"{value!r} is no {target}: give its {target.length} values")
    elif place.obj is not None and place.obj.readonly:  # what the chip cannot change, a programmer of its flash can
        place.obj.readonly = False
        place.store(c_value(value, target, memory))
        place.obj.readonly = True
    else:
        place.store(c_value(value, target, memory))


def c_value(value: Any, ctype: CType, memory: Memory) -> Any:
    """A Python value as a C value of type `ctype`, such as an argument.

    For a pointer to characters, a `str` or `bytes` becomes a new constant with its NUL.  Raises what `write` raises.
    """
    match ctype:
        case PointerType(target=target):
            return _pointer(value, target, memory)
        case StructType():
            place = make(memory, ctype, str(ctype))
            write(place, value)
            assert place.obj is not None
            return place.obj.data
        case FunctionType():
            if value is None:
                return NULL
            if not isinstance(value, Callable | Pointer):  # type: ignore[arg-type]
                raise TypeError(f"{value!r} is no function")
            return getattr(value, "translated", value)
        case HandleType():
            return NULL if value is None else value
    return to_c(value, ctype)


def _pointer(value: Any, target: CType, memory: Memory) -> Pointer:
    match value:
        case None:
            return NULL
        case Structure():
            pointer = value._pointer
        case Array():
            pointer = value.at(0)
        case str() | bytes() | bytearray() if _of_words(target):
            codes = characters(value)
            return Array(make(memory, ArrayType(f"char[{len(codes)}]", target, len(codes)), "string", codes)).at(0)
        case Pointer():
            return value
        case int() if not isinstance(value, bool):
            return Pointer(memory, None, value, target)
        case _:
            raise TypeError(f"{value!r} is no {target} *: make the object with array(...) or new(...)")
    if not isinstance(target, VoidType) and not compatible(pointer.target, target):
        raise TypeError(f"a pointer to {pointer.target} is given where one to {target} is wanted")
    return pointer


def _of_words(ctype: CType) -> bool:
    """Whether characters fit into the type: characters of the C28x have 16 bits, as its int has."""
    return isinstance(ctype, IntType) and ctype.bits == 16


def characters(text: str | bytes | bytearray) -> list[int]:
    """The codes of a string, and its NUL."""
    return [*(map(ord, text) if isinstance(text, str) else text), 0]


def _padded(text: str | bytes | bytearray, array: ArrayType) -> list[int]:
    """The codes of a string, and 0 up to the end of the array."""
    codes = characters(text)[:-1]
    if len(codes) > array.length:
        raise ValueError(f"{text!r} has {len(codes)} characters, which do not fit {array}")
    return codes + [0] * (array.length - len(codes))


def text(value: Array | Pointer) -> str:
    """The characters up to the NUL.  Raises ValueError if there is no NUL within 65536 words."""
    place = value.at(0)
    characters: list[str] = []
    for i in range(1 << 16):
        code = int(place.at(i).load()) & 0xFFFF
        if code == 0:
            return "".join(characters)
        characters.append(chr(code))
    raise ValueError(f"no NUL follows {place!r}")
