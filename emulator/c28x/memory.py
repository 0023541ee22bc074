"""Memory of the chip as a C program uses it: objects with bounds, and plain words between them.

An object keeps one Python value per scalar; None means never written (the shadow).  A pointer of the object's own type
reaches it directly.  Any other access (a wild pointer, another type, an index outside) goes by address, word by word,
and hits what is there: another object, a register, RAM, or nothing.  Address 0 is M0 RAM.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, Protocol

from emulator.c28x.arithmetic import bits_double, bits_float, double_bits, float_bits
from emulator.c28x.ctypes import (
    BASIC,
    UINT,
    VOID,
    ArrayType,
    CType,
    Double64,
    FloatType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    StructType,
    VoidType,
    part_name,
    scalars,
)  # fmt: skip
from emulator.c28x.tree import Declaration

#: RAM of the F28377S by word address (HDR linker command files): M0/M1, LS0-5 with D0/D1, GS0-15.
RAM: Final = ((0x0000, 0x0800), (0x8000, 0xC000), (0xC000, 0x1C000))
#: The number of its words: a larger object cannot be linked.
RAM_WORDS: Final = sum(high - low for low, high in RAM)
FLASH: Final = (0x80000, 0x100000)
#: System control registers.  Above RAM there are only these, the byte peripherals and flash.
SYSTEM: Final = (0x5D000, 0x5D400)
NOTHING_ABOVE: Final = 0x1C000
#: Memory with code that no file defines: TI's and the user's one-time programmable memory, and the boot ROM.
ROM: Final = ((0x70000, 0x70400), (0x78000, 0x78400), (0x3F0000, 0x400000))
#: Functions there that only load what TI measured of this very chip: Device_cal, and those of the ADCs' trims (HDR
#: F2837xS_Examples.h).  Here oscillators and ADCs are exact, so that there is nothing to load.
TRIMS: Final = (0x70282, *range(0x703AC, 0x703B6))
#: The address of the first function whose address is taken, and the distance between two of them: CHOICE.
CODE_BASE: Final = 0xC0000
_CODE_STEP: Final = 16
#: The start of file-scope objects (.ebss) and of constants (.econst): CHOICE of this linker.
EBSS_BASE: Final = 0xA000
#: The start of the default heap of the kernel, in GS RAM: CHOICE.
HEAP_BASE: Final = 0x14000
ECONST_BASE: Final = 0x82000


class Pointer:
    """A C pointer: the object it was made from (None: only an address), the offset in words, the target type."""

    __slots__ = ("memory", "obj", "offset", "target")

    def __init__(self, memory: Memory | None, obj: Object | None, offset: int, target: CType) -> None:
        self.memory = memory
        self.obj = obj
        self.offset = offset
        self.target = target

    @property
    def addr(self) -> int:
        """The word address."""
        return self.offset if self.obj is None else self.obj.base + self.offset

    def at(self, index: int) -> Pointer:
        """`p + index`."""
        return Pointer(self.memory, self.obj, self.offset + index * max(1, self.target.words), self.target)

    def member(self, name: str) -> Pointer:
        """`&p->name`.  Raises ValueError if the structure has no such member."""
        member = self.target.member(name) if isinstance(self.target, StructType) else None
        if member is None:
            raise ValueError(f"{self.target} has no member {name}")
        return Pointer(self.memory, self.obj, self.offset + member.offset, member.ctype)

    def load(self) -> Any:
        """`*p`.  A value that was never written gives no finding: the fill decides."""
        assert self.memory is not None
        return self.memory.load_through(self, 0, self.target)

    def read(self) -> Any:
        """`*p` for a function that the firmware calls.  A value that was never written is reported."""
        assert self.memory is not None
        return self.memory.policy.read_scalar(self)

    def store(self, value: Any) -> None:
        """`*p = value`; the value is not converted."""
        assert self.memory is not None
        self.memory.store_through(self, 0, self.target, value)

    def write(self, value: Any) -> None:
        """`*p = value` for a function that the firmware calls.  A place outside of the object is reported."""
        assert self.memory is not None
        self.memory.policy.write_scalar(self, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Pointer) and self.addr == other.addr

    def __hash__(self) -> int:
        return hash(self.addr)

    def __bool__(self) -> bool:
        return self.obj is not None or self.offset != 0

    def __repr__(self) -> str:
        where = f"{self.obj.declaration.path}+{self.offset}" if self.obj else f"{self.offset:#x}"
        return f"<{self.target} *{where}>"


NULL: Final = Pointer(None, None, 0, VOID)


class Object:
    """Storage of one declared object: `data[leaf]` for every scalar, None while never written."""

    __slots__ = ("_map", "base", "data", "declaration", "element", "ended", "initial", "readonly", "words")

    def __init__(self, declaration: Declaration, base: int, data: list[Any] | None = None) -> None:
        ctype = declaration.ctype
        self.declaration = declaration
        self.base = base
        self.words = ctype.words
        self.data: list[Any] = [None] * ctype.leaves if data is None else data
        element = ctype.element if isinstance(ctype, ArrayType) else ctype
        #: The type of the scalars if all have the same type, else None.
        self.element: CType | None = None if isinstance(element, StructType | ArrayType) else element
        self._map: dict[int, tuple[int, CType]] | None = None
        self.readonly = False
        #: The function of this local has returned: none of its words is reached as an object any more.
        self.ended = False
        #: A value that overrides the fill for this object's never-written scalars.
        self.initial: Any = None

    def end(self) -> None:
        """The function of this local has returned."""
        self.ended = True
        self.element, self._map = None, {}

    def last(self, offset: int, ctype: CType) -> Any:
        """The last value of a scalar of an ended local; the stack still holds it until another local lies there."""
        leaves = enumerate(scalars(self.declaration.ctype))
        return next((self.data[i] for i, (o, t) in leaves if o == offset and t == ctype), None)

    def leaf(self, offset: int) -> tuple[int, CType] | None:
        """The scalar that starts at word `offset`, as (leaf, type)."""
        if self.element is not None:
            words = self.element.words
            return (offset // words, self.element) if 0 <= offset < self.words and not offset % words else None
        if self._map is None:
            self._map = {o: (i, t) for i, (o, t) in enumerate(scalars(self.declaration.ctype))}
        return self._map.get(offset)

    def claim(self, offset: int, ctype: CType) -> tuple[int, CType] | None:
        """The scalar at word `offset` for a write of type `ctype`.  An object without a declared type creates it."""
        return self.leaf(offset)

    def unwritten_as(self, offset: int, ctype: CType) -> tuple[int, CType] | None:
        """A never-written scalar of this type at `offset`; only an object without a declared type has one."""
        return None

    def covering(self, offset: int) -> tuple[int, CType, int] | None:
        """The scalar that covers word `offset`, as (leaf, type, word within it); None for padding."""
        for back in range(4):
            found = self.leaf(offset - back)
            if found is not None and back < found[1].words:
                return (*found, back)
        return None


def to_words(value: Any, ctype: CType) -> tuple[int, ...]:
    """The words of a scalar, low word first (CPU: little-endian within 32 bits, and so are 64 bits)."""
    if isinstance(ctype, FloatType):
        bits = double_bits(value) if isinstance(ctype, Double64) else float_bits(value)
    else:
        bits = value.addr & 0xFFFFFFFF if isinstance(value, Pointer) else int(value)
    return tuple(bits >> 16 * i & 0xFFFF for i in range(ctype.words))


def from_words(words: Iterable[int], ctype: CType, memory: Memory) -> Any:
    """The scalar that words represent."""
    bits = sum(word << 16 * i for i, word in enumerate(words))
    if isinstance(ctype, FloatType):
        return bits_double(bits) if isinstance(ctype, Double64) else bits_float(bits)
    if isinstance(ctype, IntType):
        return ctype.wrap(bits)
    target = ctype.target if isinstance(ctype, PointerType) else VOID
    code = memory.code_at(bits) if target == VOID else None
    if code is not None:
        return code
    return Pointer(memory, None, bits, target) if bits else NULL


def zero_of(ctype: CType) -> Any:
    """The value of a scalar whose words are 0; for a structure, scalars that were never written."""
    if isinstance(ctype, StructType):
        return [None] * ctype.leaves
    return 0.0 if isinstance(ctype, FloatType) else (0 if isinstance(ctype, IntType) else NULL)


def compatible(a: CType, b: CType) -> bool:
    """Whether a value stored as type `a` can be read as type `b` without a conversion through its words."""
    if isinstance(a, IntType) and isinstance(b, IntType):
        return a.words == b.words
    if isinstance(a, FloatType) and isinstance(b, FloatType):
        return a.words == b.words
    if isinstance(a, PointerType | HandleType | FunctionType | VoidType):
        return isinstance(b, PointerType | HandleType | FunctionType)
    return a == b


def _base(obj: Object) -> int:
    return obj.base


class ByteRegister(Protocol):
    """A 32-bit register of a byte peripheral."""

    value: int
    read: Callable[[], int]
    write: Callable[[int, int], None]


class MemoryPolicy(Protocol):
    """The decisions of an image about its memory: see `Runtime`."""

    def fill_word(self, addr: int) -> int:
        """The value of a never-written word of plain RAM."""

    def fill_scalar(self, obj: Object, offset: int, ctype: CType) -> Any:
        """The value of the never-written scalar of type `ctype` at word `offset` of `obj`."""

    def read_scalar(self, p: Pointer) -> Any:
        """Read through a pointer for a function outside of the firmware."""

    def write_scalar(self, p: Pointer, value: Any) -> None:
        """Write through a pointer for a function outside of the firmware."""


class Unlinked:
    """The policy of a memory without an image: a value that was never written is 0."""

    def fill_word(self, addr: int) -> int:
        """Always 0."""
        return 0

    def fill_scalar(self, obj: Object, offset: int, ctype: CType) -> Any:
        """The zero of the type."""
        return zero_of(ctype)

    def read_scalar(self, p: Pointer) -> Any:
        """The value at the pointer."""
        return p.load()

    def write_scalar(self, p: Pointer, value: Any) -> None:
        """Store it."""
        p.store(value)


def _no_register(addr: int) -> int | None:
    return None


def _no_register_to_write(addr: int, word: int) -> bool:
    return False


class Memory:
    """The address space of one board.

    `register_read(addr)` returns a word of a register, None if there is no register.  `register_write(addr, word)`
    returns whether a register took the word.  `byte_registers` are the registers of byte peripherals by first address:
    each has four addresses, one per byte.
    """

    def __init__(
        self, register_read: Callable[[int], int | None] = _no_register,
        register_write: Callable[[int, int], bool] = _no_register_to_write,
        byte_registers: Mapping[int, ByteRegister] | None = None,
    ) -> None:  # fmt: skip
        self._objects: list[Object] = []
        self._bases: list[int] = []
        #: Locals whose address was taken and whose function has not returned, innermost last.
        self.live_locals: list[Object] = []
        #: Allocated heap blocks, in order of their address.
        self._blocks: list[Object] = []
        self._longest_block = 0
        self.words: dict[int, int] = {}
        #: The policy of the image in this memory.
        self.policy: MemoryPolicy = Unlinked()
        self._register_read, self._register_write = register_read, register_write
        self.byte_registers: dict[int, ByteRegister] = dict(byte_registers or {})
        self._next = {"ebss": EBSS_BASE, "econst": ECONST_BASE, "heap": HEAP_BASE}
        #: Functions (and objects of the kernel) whose address was taken, in order.
        self._code: list[Any] = []

    def take_policy_from(self, image: MemoryPolicy) -> None:
        """Use the policy of `image`, which is linked into this memory."""
        self.policy = image

    # Placement

    def place(self, declaration: Declaration, section: str = "ebss", data: list[Any] | None = None) -> Object:
        """Give a file-scope object its address."""
        align = max(declaration.ctype.align, 1)
        base = -(-self._next[section] // align) * align
        self._next[section] = base + max(1, declaration.ctype.words)
        obj = Object(declaration, base, data)
        obj.readonly = section == "econst"
        at = bisect_right(self._bases, base)
        self._bases.insert(at, base)
        self._objects.insert(at, obj)
        return obj

    def name_address(self, declaration: Declaration, address: int) -> Object:
        """An object that only names an address, as a linker symbol does.  `find` does not return it."""
        return Object(declaration, address)

    def place_block(self, block: Object) -> None:
        """Add an allocated heap block: it covers the objects that the heap is made of."""
        self._longest_block = max(self._longest_block, block.words)
        self._blocks.insert(bisect_right(self._blocks, block.base, key=_base), block)

    def remove_block(self, block: Object) -> None:
        """Remove a freed heap block."""
        self._blocks.remove(block)

    def find(self, addr: int) -> Object | None:
        """The object that covers a word address."""
        for obj in reversed(self.live_locals):
            if obj.base <= addr < obj.base + obj.words:
                return obj
        if self._blocks:
            # A heap can lie in a block of another heap, so the last block before the address need not cover it.
            for at in range(bisect_right(self._blocks, addr, key=_base) - 1, -1, -1):
                obj = self._blocks[at]
                if addr < obj.base + obj.words:
                    return obj
                if addr >= obj.base + self._longest_block:
                    break
        at = bisect_right(self._bases, addr) - 1
        if at >= 0:
            obj = self._objects[at]
            if addr < obj.base + obj.words:
                return obj
        return None

    def string_at(self, addr: int) -> str | None:
        """The text of the constant at a word address, from there to its NUL; None if there is no constant."""
        obj = self.find(addr)
        if obj is None or not obj.readonly or not all(isinstance(code, int) for code in obj.data):
            return None
        return "".join(chr(code & 0xFFFF) for code in obj.data[addr - obj.base :]).partition("\0")[0]

    def _covered(self, addr: int) -> bool:
        """Whether there is anything at an address above RAM: system registers, flash, or a byte peripheral."""
        return SYSTEM[0] <= addr < SYSTEM[1] or FLASH[0] <= addr < FLASH[1] or addr & ~3 in self.byte_registers

    def empty(self, ctype: CType, addr: int) -> bool:
        """Whether a scalar at `addr` would lie where there is never any memory, at an address aligned for it."""
        return addr >= NOTHING_ABOVE and not self._covered(addr) and not (ctype.words > 1 and addr & 1)

    def neighbour(self, addr: int) -> str:
        """What is at an address, as text for a message."""
        obj = self.find(addr)
        if obj is not None:
            return obj.declaration.path + part_name(obj.declaration.ctype, addr - obj.base)
        if any(low <= addr < high for low, high in RAM):
            return f"RAM word {addr:#x}, where nothing is linked"
        return f"address {addr:#x}, where nothing is"

    # Code

    def code_address(self, function: Any) -> int:
        """The address of a function, or of an object of the kernel."""
        if function not in self._code:
            self._code.append(function)
        return CODE_BASE + _CODE_STEP * self._code.index(function)

    def code_at(self, address: int) -> Any:
        """The function at an address; None if no function whose address was taken is there."""
        number, rest = divmod(address - CODE_BASE, _CODE_STEP)
        return self._code[number] if not rest and 0 <= number < len(self._code) else None

    def words_of(self, value: Any, ctype: CType) -> tuple[int, ...]:
        """The words of a scalar; a function or an object of the kernel is its address."""
        return to_words(value if isinstance(value, int | float | Pointer) else self.code_address(value), ctype)

    # By word

    def read_word(self, addr: int) -> int:
        """Read one word of an object, a register or plain RAM."""
        obj = self.find(addr)
        if obj is not None:
            found = obj.covering(addr - obj.base)
            if found is not None:
                leaf, ctype, part = found
                value = obj.data[leaf]
                if value is None:
                    value = self.policy.fill_scalar(obj, addr - part - obj.base, ctype)
                return self.words_of(value, ctype)[part]
        word = self.words.get(addr)
        if word is not None:
            return word
        register = self._register_read(addr)
        if register is not None:
            return register
        if any(low <= addr < high for low, high in RAM):
            return self.policy.fill_word(addr)
        return 0  # CHOICE: an address without memory reads 0.

    def write_word(self, addr: int, word: int) -> None:
        """Write one word of an object, a register or plain RAM."""
        obj = self.find(addr)
        if obj is not None:
            found = obj.covering(addr - obj.base)
            if found is not None:
                whole = obj.claim(addr - obj.base, UINT)
                if whole is not None and whole[1] is UINT and not obj.readonly:
                    obj.data[whole[0]] = word & 0xFFFF
                elif not obj.readonly:
                    leaf, ctype, part = found
                    value = obj.data[leaf]
                    if value is None:
                        value = self.policy.fill_scalar(obj, addr - part - obj.base, ctype)
                    words = list(self.words_of(value, ctype))
                    words[part] = word & 0xFFFF
                    obj.data[leaf] = from_words(words, ctype, self)
                return
        if self._register_write(addr, word):
            return
        if any(low <= addr < high for low, high in RAM):
            self.words[addr] = word & 0xFFFF

    def fill(self, base: int, words: int, value: int) -> None:
        """Set plain words to one value, as a start-up routine does (the fill pattern of a stack)."""
        for addr in range(base, base + words):
            self.words[addr] = value

    # By type

    def load(self, ctype: CType | str, addr: int) -> Any:
        """A scalar at a word address.  32-bit accesses ignore the address' lowest bit (CPU 2.2.5)."""
        ctype = BASIC[ctype] if isinstance(ctype, str) else ctype
        if ctype.words > 1 and addr & 1:
            addr &= ~1
        if ctype.words == 2 and addr & ~3 in self.byte_registers and isinstance(ctype, IntType):
            return ctype.wrap(self.byte_registers[addr & ~3].read())
        if addr >= NOTHING_ABOVE and not self._covered(addr):
            return 0.0 if isinstance(ctype, FloatType) else from_words((0,) * ctype.words, ctype, self)
        return from_words([self.read_word(addr + i) for i in range(ctype.words)], ctype, self)

    def store(self, ctype: CType | str, addr: int, value: Any) -> None:
        """Store a scalar at a word address."""
        ctype = BASIC[ctype] if isinstance(ctype, str) else ctype
        if ctype.words > 1 and addr & 1:
            addr &= ~1
        if ctype.words == 2 and addr & ~3 in self.byte_registers and isinstance(ctype, IntType):
            self.byte_registers[addr & ~3].write(value & 0xFFFFFFFF, 0xFFFFFFFF)
            return
        for i, word in enumerate(self.words_of(value, ctype)):
            self.write_word(addr + i, word)

    def load_byte(self, addr: int) -> int | None:
        """The byte of a byte peripheral at an address; None if there is none."""
        register = self.byte_registers.get(addr & ~3)
        return None if register is None else register.read() >> 8 * (addr & 3) & 0xFF

    def store_byte(self, addr: int, byte: int) -> bool:
        """Store a byte of a byte peripheral.  Returns whether there is one at `addr`."""
        register = self.byte_registers.get(addr & ~3)
        if register is None:
            return False
        mask = 0xFF << 8 * (addr & 3)
        register.write(register.value & ~mask | (byte & 0xFF) << 8 * (addr & 3), mask)
        return True

    def load_through(self, p: Pointer, words: int, ctype: CType) -> Any:
        """`*(ctype *)(p + words)`: directly from the object if type and place match, else by address."""
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and compatible(found[1], ctype):
                value = obj.data[found[0]]
                if value is None:
                    value = self.policy.fill_scalar(obj, p.offset + words, found[1])
                return ctype.wrap(value) if isinstance(ctype, IntType) and found[1] != ctype else value
        return self.load(ctype, p.addr + words)

    def store_through(self, p: Pointer, words: int, ctype: CType, value: Any) -> None:
        """`*(ctype *)(p + words) = value`."""
        obj = p.obj
        if obj is not None and not obj.readonly:
            found = obj.claim(p.offset + words, ctype)
            if found is not None and (found[1] is ctype or compatible(found[1], ctype)):
                leaf_type = found[1]
                if leaf_type is not ctype and isinstance(leaf_type, IntType) and leaf_type != ctype:
                    value = leaf_type.wrap(value)
                obj.data[found[0]] = value
                return
        self.store(ctype, p.addr + words, value)

    def copy(self, target: Pointer, source: Pointer, words: int) -> None:
        """`memcpy`: whole scalars where source and target match, else single words.  Never-written values stay so."""
        i = 0
        while i < words:
            s, t = source.obj, target.obj
            from_leaf = s.leaf(source.offset + i) if s is not None else None
            if s is not None and t is not None and from_leaf is not None and i + from_leaf[1].words <= words:
                value = s.data[from_leaf[0]]
                to_leaf = t.claim(target.offset + i, from_leaf[1])
                if to_leaf is not None and to_leaf[1] != from_leaf[1] and i + to_leaf[1].words <= words:
                    from_leaf = s.unwritten_as(source.offset + i, to_leaf[1]) or from_leaf
                if to_leaf is not None and from_leaf[1] == to_leaf[1] and not t.readonly:
                    t.data[to_leaf[0]] = value
                    i += from_leaf[1].words
                    continue
            self.write_word(target.addr + i, self.read_word(source.addr + i))
            i += 1
