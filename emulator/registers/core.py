"""The language in which registers are described, and the objects that it makes.

A register is a class whose fields stand in the manual's order; a block is a class whose registers stand at
their offsets::

    class ADCCTL2(Register, eallow=True):
        #             bits    type  reset  description
        SIGNALMODE = F( 7,     RW,  0,     "signal mode")
        PRESCALE   = F( 3, 0,  RW,  0,     "ADC clock prescaler")

    class AdcRegs(Block, struct="ADC_REGS"):
        ADCCTL2 = At(0x01, ADCCTL2)

so that `AdcaRegs.ADCCTL2.bit.PRESCALE = 6` and `AdcaRegs.ADCCTL2.all` mean what they mean in C: `.bit.F = v` is
the compiler's read-modify-write of the 16-bit word that holds the field (of the pair, where it straddles), through
the same access as `.all`, so that a write-1-to-clear neighbour is hit as on silicon.

Description never holds behaviour.  A peripheral binds `on_read` / `on_write` to the registers that have some; the
hook of a write gets the word written (and, for 32-bit registers, the mask of the bits that the access touched) and
calls `store` for the plain part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from typing import Any, ClassVar, Generic, Self, TypeVar, overload

from emulator.cpu import Cpu
from emulator.registers.cell import Cell, Source
from emulator.registers.fields import ALL, HIGH, LOW, R0W1, RSV, RW, W1C, W1S, Access, F, R, W
from emulator.registers.hook import Hook

__all__ = [
    "ALL",
    "HIGH",
    "LOW",
    "R0W1",
    "RSV",
    "RW",
    "W1C",
    "W1S",
    "Access",
    "At",
    "Block",
    "F",
    "R",
    "Register",
    "RegisterStruct",
    "Source",
    "W",
    "Word",
]  # fmt: skip


class _RegisterType(type):
    """Gives each register class empty `__slots__`: a misspelt field is an error, not a new attribute."""

    def __new__(mcs, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **kwargs: Any) -> _RegisterType:
        namespace.setdefault("__slots__", ())
        return super().__new__(mcs, name, bases, namespace, **kwargs)


class Register(Cell, metaclass=_RegisterType):
    """A register as the manual describes it; what an access does stands in `Cell`."""

    def __init_subclass__(
        cls, bits: int = 16, eallow: bool = False, data: bool = False, clears: str = "", **kwargs: Any
    ) -> None:  # fmt: skip
        super().__init_subclass__(**kwargs)
        cls.bits = bits
        cls.clears = clears
        cls.eallow = eallow
        cls.fields = {name: f for klass in reversed(cls.__mro__) for name, f in vars(klass).items() if isinstance(f, F)}
        every = (1 << bits) - 1
        taken = 0
        for name, f in cls.fields.items():
            if f.hi >= bits or taken & f.mask:
                raise TypeError(f"{cls.__name__}.{name}: bits {f.hi}:{f.lo} overlap or leave the register")
            taken |= f.mask

        def union(*access: Access) -> int:
            return sum(f.mask for f in cls.fields.values() if f.access in access)

        if cls.fields:
            cls.rw_mask = union(Access.RW)
            cls.read_mask = union(Access.RW, Access.R, Access.W1C, Access.W1S)
        else:
            cls.rw_mask = cls.read_mask = every
        cls.w1c_mask = union(Access.W1C)
        cls.w1s_mask = union(Access.W1S)
        acting = cls.w1c_mask | cls.w1s_mask | union(Access.R0W1)
        # Registers of flags are commonly written with all ones; data registers take any word.
        watched = cls.rw_mask and not acting and not data and cls.fields
        cls.reserved_mask = every & ~(taken & ~union(Access.RSV)) if watched else 0
        cls.write_only = any(f.access in (Access.W, Access.R0W1) for f in cls.fields.values())
        cls.unmodelled_mask = sum(f.mask for f in cls.fields.values() if not f.modelled)
        cls.reset_value = sum(f.reset << f.lo for f in cls.fields.values())

    def __repr__(self) -> str:
        return f"<{self.path} = {self.value:#x}>"

    @property
    def bit(self) -> Self:
        """The view by fields.  The same object: a separate one would cost time and add nothing."""
        return self

    @property
    def all(self) -> int:
        """The whole register."""
        return self.read()

    @all.setter
    def all(self, word: int) -> None:
        self.write(word & ((1 << self.bits) - 1), ALL)


R_co = TypeVar("R_co", bound=Register, covariant=True)


class At(Generic[R_co]):
    """A register with fields at a word offset of its block."""

    def __init__(self, offset: int, register: type[R_co]) -> None:
        self.offset = offset
        self.register = register
        self.name = ""
        #: The structure within the block that it stands in.
        self.part: object = None

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, block: None, owner: type) -> At[R_co]: ...
    @overload
    def __get__(self, block: Block, owner: type) -> R_co: ...
    def __get__(self, block: Block | None, owner: type) -> At[R_co] | R_co:
        if block is None:
            return self
        return block.registers[self.name]  # type: ignore[return-value]

    def __set__(self, block: Block, value: object) -> None:
        raise AttributeError(f"{block.name}.{self.name} has fields: assign .all or .bit.FIELD, as in C")


class Word:
    """A register without fields, which C accesses as a plain Uint16 or Uint32."""

    def __init__(self, offset: int, access: Access = RW, reset: int = 0, bits: int = 16, *, eallow: bool = False,
                 modelled: bool = True, text: str = "") -> None:  # fmt: skip
        self.offset = offset
        self.name = ""
        #: The structure within the block that it stands in.
        self.part: object = None
        field = F(bits - 1, 0, access, reset, text, modelled=modelled)
        field.name = "all"
        self.register: type[Register] = type(
            "PlainRegister", (Register,), {"VALUE": field, "__slots__": ()}, bits=bits, eallow=eallow
        )

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, block: None, owner: type) -> Word: ...
    @overload
    def __get__(self, block: Block, owner: type) -> int: ...
    def __get__(self, block: Block | None, owner: type) -> Word | int:
        if block is None:
            return self
        return block.registers[self.name].read()

    def __set__(self, block: Block, value: int) -> None:
        register = block.registers[self.name]
        register.write(value & ((1 << register.bits) - 1), ALL)


B_co = TypeVar("B_co", bound="Block", covariant=True)


class RegisterStruct(Generic[B_co]):
    """A structure of registers at a word offset of a block: with `CH1 = RegisterStruct(0x20, DmaChannelRegs)`, C writes
    `DmaRegs.CH1.MODE.all`."""

    def __init__(self, offset: int, kind: type[B_co]) -> None:
        self.offset = offset
        self.kind = kind
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def registers(self) -> dict[str, At[Any] | Word]:
        """What stands in the layout of the block around it: `PART.REGISTER` -> the register."""
        found: dict[str, At[Any] | Word] = {}
        for name, register in self.kind.layout.items():
            placed = copy(register)
            placed.name = full = f"{self.name}.{name}"
            placed.offset += self.offset
            placed.part = self
            found[full] = placed
        return found

    @overload
    def __get__(self, block: None, owner: type) -> RegisterStruct[B_co]: ...
    @overload
    def __get__(self, block: Block, owner: type) -> B_co: ...
    def __get__(self, block: Block | None, owner: type) -> RegisterStruct[B_co] | B_co:
        if block is None:
            return self
        part = object.__new__(self.kind)
        part.name, part.base = f"{block.name}.{self.name}", block.base + self.offset
        part.cpu, part.clocked = block.cpu, block.clocked
        part.registers = {name: block.registers[f"{self.name}.{name}"] for name in self.kind.layout}
        return part

    def __set__(self, block: Block, value: object) -> None:
        raise AttributeError(f"{block.name}.{self.name} is a structure: assign its registers, as in C")


class Block:
    """The registers of one peripheral instance, at its base address.

    A structure within it (`RegisterStruct`) has its registers in `layout` and `registers` as well, as `PART.REGISTER`.

    The class argument `struct` is the tag of the structure in TI's headers.
    With the class argument `byte_peripheral=True` it stands behind the bridge that takes an address for one of bytes:
    a register of 32 bits has four addresses, and a field of its upper half is accessed with the whole register (the
    compiler's `byte_peripheral`, SPRU514).
    """

    layout: ClassVar[dict[str, At[Any] | Word]] = {}
    parts: ClassVar[dict[str, RegisterStruct[Any]]] = {}
    byte_peripheral: ClassVar[bool] = False
    struct: ClassVar[str] = ""

    def __init_subclass__(cls, struct: str = "", byte_peripheral: bool = False, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        cls.layout, cls.parts = {}, {}
        cls.struct = struct
        cls.byte_peripheral = byte_peripheral
        for klass in reversed(cls.__mro__):
            for name, d in vars(klass).items():
                if isinstance(d, At | Word):
                    cls.layout[name] = d
                elif isinstance(d, RegisterStruct):
                    cls.parts[name] = d
                    cls.layout |= d.registers()
        if byte_peripheral:
            for placed in cls.layout.values():
                for f in placed.register.fields.values():
                    f.lane = LOW if f.hi < 16 else ALL

    def __init__(self, name: str, base: int, cpu: Cpu, *, clocked: bool = True) -> None:
        self.name = name
        self.base = base
        self.cpu = cpu
        self.clocked = clocked
        self.registers: dict[str, Cell] = {
            key: d.register(self, key, base + d.offset) for key, d in self.layout.items()
        }

    def __setattr__(self, name: str, value: object) -> None:
        # A misspelt register is an error, not a new attribute.
        if name not in ("name", "base", "cpu", "clocked", "registers") and name not in (*self.layout, *self.parts):
            raise AttributeError(f"{self.name} has no register {name}")
        super().__setattr__(name, value)

    def __iter__(self) -> Iterator[Cell]:
        return iter(self.registers.values())

    def set_clock(self, on: bool) -> None:
        """PCLKCRx switched the module's clock."""
        if on != self.clocked:
            self.clocked = on
            for register in self:
                register.bind()

    def bind(self, name: str, *, read: Callable[[], int] | Hook | None = None,
             write: Callable[[int, int], None] | Hook | None = None, steady: bool = False) -> None:  # fmt: skip
        """Give register `name` behaviour.  `write(word, lanes)` replaces the plain store.

        `steady`: `read` gives the same again, and does nothing else, as long as no event comes.
        """
        register = self.registers[name]
        register.read_hook = read if isinstance(read, Hook) else None
        register.write_hook = write if isinstance(write, Hook) else None
        register.on_read = read.read if isinstance(read, Hook) else read
        register.on_read_steady = steady
        register.on_write = write.write if isinstance(write, Hook) else write
        register.bind()

    def reset(self) -> None:
        """Every register back to its reset value."""
        for register in self:
            register.reset()
