"""The language in which registers are described, and the objects that it makes.

A register is a class whose fields stand in the manual's order; a block is a class whose registers stand at
their offsets::

    class ADCCTL2(Register, eallow=True):
        #             bits    type  reset  description
        SIGNALMODE = F( 7,     RW,  0,     "signal mode")
        PRESCALE   = F( 3, 0,  RW,  0,     "ADC clock prescaler")

    class AdcRegs(Block):
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
from typing import Any, ClassVar, Generic, Self, TypeVar, overload

from emulator.cpu import Cpu
from emulator.registers.checks import gated_read, gated_write, protecting, refusing_reserved, watching
from emulator.registers.fields import ALL, HIGH, LOW, R0W1, RSV, RW, W1C, W1S, Access, F, R, W

__all__ = [
    "ALL", "HIGH", "LOW", "R0W1", "RSV", "RW", "W1C", "W1S", "Access", "At", "Block", "F", "R",
    "Register", "Source", "W", "Word",
]  # fmt: skip


class _RegisterType(type):
    """Gives each register class empty `__slots__`: a misspelt field is an error, not a new attribute."""

    def __new__(mcs, name: str, bases: tuple[type, ...], namespace: dict[str, Any], **kwargs: Any) -> _RegisterType:
        namespace.setdefault("__slots__", ())
        return super().__new__(mcs, name, bases, namespace, **kwargs)


class Register(metaclass=_RegisterType):
    """One register of one instance: its stored word, and its access as it is right now.

    `read()` and `write(word, lanes)` are what the CPU does (`lanes`: the bits accessed, `ALL` for a whole access);
    `value` is what is stored, which peripherals use.
    """

    bits: ClassVar[int] = 16
    eallow: ClassVar[bool] = False
    fields: ClassVar[dict[str, F]] = {}
    reset_value: ClassVar[int] = 0
    rw_mask: ClassVar[int] = 0xFFFF
    w1c_mask: ClassVar[int] = 0
    w1s_mask: ClassVar[int] = 0
    #: Bits that read as stored (write-only and write-1-to-act fields read 0).
    read_mask: ClassVar[int] = 0xFFFF
    unmodelled_mask: ClassVar[int] = 0
    #: Bits that the manual reserves, where a one written to them is told.
    reserved_mask: ClassVar[int] = 0

    __slots__ = ("_followers", "address", "block", "modify", "name", "on_read", "on_write", "read", "value", "write")

    def __init_subclass__(cls, bits: int = 16, eallow: bool = False, data: bool = False, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        cls.bits = bits
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
        cls.unmodelled_mask = sum(f.mask for f in cls.fields.values() if not f.modelled)
        cls.reset_value = sum(f.reset << f.lo for f in cls.fields.values())

    def __init__(self, block: Block, name: str, address: int) -> None:
        self.block = block
        self.name = name
        self.address = address
        self.value = self.reset_value
        self.on_read: Callable[[], int] | None = None
        self.on_write: Callable[[int, int], None] | None = None
        self._followers: list[tuple[dict[str, Any], str, str]] = []
        self.read: Callable[[], int]
        self.write: Callable[[int, int], None]
        #: `modify(keep, bits, lanes)`: the read-modify-write that a compiler makes of a field assignment.
        self.modify: Callable[[int, int, int], None]
        self.bind()

    def __repr__(self) -> str:
        return f"<{self.path} = {self.value:#x}>"

    @property
    def path(self) -> str:
        """The name that C uses, for instance `AdcaRegs.ADCCTL2`."""
        return f"{self.block.name}.{self.name}"

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

    def bind(self) -> None:
        """Choose the access functions for the present state of hooks, clock gate and protection."""
        if self.block.clocked:
            self._bind_clocked()
        else:
            self.read, self.write = gated_read(self), gated_write(self)
            self.modify = self._modify
        self._tell()

    def follow(self, access: str, namespace: dict[str, Any], name: str) -> None:
        """Keep `namespace[name]` the present way of `access`.

        "read", "write" and "modify" are functions.  "source" is an object whose attribute `value` is what the CPU reads:
        the register itself, as long as reading is only looking.
        """
        self._followers.append((namespace, name, access))
        self._tell()

    def intercept(self, read: Callable[[], int], write: Callable[[int, int], None]) -> None:
        """Put a test's functions before those of the register, until `bind`.  A plain `modify` passes them by."""
        self.read, self.write = read, write
        self._tell()

    @property
    def looked_at(self) -> bool:
        """Whether reading is nothing but looking at the stored word, as long as the module's clock is on."""
        masked = self.read_mask != (1 << self.bits) - 1 and self.write_only()
        return self.on_read is None and not masked

    @property
    def source(self) -> Register | Source:
        """What has the word that the CPU reads as its `value`."""
        return self if self.read == self._read_plain else Source(self)

    def _tell(self) -> None:
        for namespace, name, access in self._followers:
            namespace[name] = getattr(self, access)

    def _bind_clocked(self) -> None:
        if self.on_read is not None:
            self.read = self.on_read
        else:
            self.read = self._read_plain if self.looked_at else self._read_masked
        write = self._storing() if self.on_write is None else self.on_write
        if self.unmodelled_mask:
            write = watching(self, write)
        self.write = protecting(self, write) if self.eallow else write
        # A field assignment leaves reserved bits as they are: only whole words are looked at.
        self.modify = self._modifying()
        if self.reserved_mask:
            self.write = refusing_reserved(self, self.write)

    def _modify(self, keep: int, bits: int, lanes: int) -> None:
        self.write(self.read() & keep | bits, lanes)

    def _modifying(self) -> Callable[[int, int, int], None]:
        """`modify`, in one step where reading has no effect and the write is plain or known."""
        register, write = self, self.write
        if self.on_read is not None:
            return self._modify
        if self.on_write is None and not self.eallow and not self.unmodelled_mask:
            writable = self.rw_mask
            if not self.w1c_mask and not self.w1s_mask and writable == self.read_mask and self.bits == 16:

                def modify_plain(keep: int, bits: int, lanes: int) -> None:
                    register.value = (register.value & keep | bits) & writable

                return modify_plain
        shown = self.read_mask
        if not shown:

            def modify_clear(keep: int, bits: int, lanes: int) -> None:
                write(bits, lanes)

            return modify_clear
        if self.write_only():
            return self._modify
        if self.eallow and self.on_write is None and not self.unmodelled_mask and self.bits == 16 and (
            self.rw_mask == shown
        ):
            cpu, inner = self.block.cpu, self.rw_mask

            def modify_protected(keep: int, bits: int, lanes: int) -> None:
                if cpu.eallow:
                    register.value = (register.value & keep | bits) & inner
                else:
                    write(register.value & keep | bits, lanes)

            return modify_protected

        def modify_stored(keep: int, bits: int, lanes: int) -> None:
            write(register.value & keep | bits, lanes)

        return modify_stored

    def _storing(self) -> Callable[[int, int], None]:
        """`store`, made for this register where its fields are plain."""
        if self.w1c_mask or self.w1s_mask or self.bits == 32:
            return self.store
        register, writable = self, self.rw_mask
        if writable == self.read_mask:

            def write_whole(word: int, lanes: int = ALL) -> None:
                register.value = word & writable

            return write_whole
        fixed = ~writable

        def write_part(word: int, lanes: int = ALL) -> None:
            register.value = register.value & fixed | word & writable

        return write_part

    def write_only(self) -> bool:
        """Whether some field does not read back what is stored."""
        return any(f.access in (Access.W, Access.R0W1) for f in self.fields.values())

    def reset(self) -> None:
        """Back to the reset value, without side effects."""
        self.value = self.reset_value

    def store(self, word: int, lanes: int = ALL) -> None:
        """What a write does to the stored word, by the types of the fields; `lanes` are the bits accessed."""
        writable = self.rw_mask & lanes
        self.value = (self.value & ~writable | word & writable) & ~(word & self.w1c_mask & lanes) | (
            word & self.w1s_mask & lanes
        )

    def _read_plain(self) -> int:
        return self.value

    def _read_masked(self) -> int:
        return self.value & self.read_mask


class Source:
    """A register's word, where reading is more than looking."""

    __slots__ = ("_read",)

    def __init__(self, register: Register) -> None:
        self._read = register.read

    @property
    def value(self) -> int:
        """What the CPU reads now."""
        return self._read()


R_co = TypeVar("R_co", bound=Register, covariant=True)


class At(Generic[R_co]):
    """A register with fields at a word offset of its block."""

    def __init__(self, offset: int, register: type[R_co]) -> None:
        self.offset = offset
        self.register = register
        self.name = ""

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


class Block:
    """The registers of one peripheral instance, at its base address."""

    layout: ClassVar[dict[str, At[Any] | Word]] = {}

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        cls.layout = {
            name: d for klass in reversed(cls.__mro__) for name, d in vars(klass).items() if isinstance(d, At | Word)
        }

    def __init__(self, name: str, base: int, cpu: Cpu, *, clocked: bool = True) -> None:
        self.name = name
        self.base = base
        self.cpu = cpu
        self.clocked = clocked
        self.registers: dict[str, Register] = {
            key: d.register(self, key, base + d.offset) for key, d in self.layout.items()
        }

    def __setattr__(self, name: str, value: object) -> None:
        # A misspelt register is an error, not a new attribute.
        if name not in ("name", "base", "cpu", "clocked", "registers") and name not in self.layout:
            raise AttributeError(f"{self.name} has no register {name}")
        super().__setattr__(name, value)

    def __iter__(self) -> Iterator[Register]:
        return iter(self.registers.values())

    def set_clock(self, on: bool) -> None:
        """PCLKCRx switched the module's clock."""
        if on != self.clocked:
            self.clocked = on
            for register in self:
                register.bind()

    def bind(self, name: str, *, read: Callable[[], int] | None = None,
             write: Callable[[int, int], None] | None = None) -> None:  # fmt: skip
        """Give register `name` behaviour.  `write(word, lanes)` replaces the plain store."""
        register = self.registers[name]
        register.on_read = read
        register.on_write = write
        register.bind()

    def reset(self) -> None:
        """Every register back to its reset value."""
        for register in self:
            register.reset()
