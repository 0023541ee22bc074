"""One register of one instance at run time: its stored word, and the ways to it as they are right now.

`core` says what a register is; here is what an access does.  The ways are functions chosen once for the present state
of hooks, clock gate, protection and taps, so that an access tests nothing that cannot change.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol

from mypy_extensions import mypyc_attr

from emulator.cpu import Cpu, Eallow
from emulator.registers.checks import gated_read, gated_write, protecting, refusing_reserved, watching
from emulator.registers.fields import ALL
from emulator.registers.hook import Hook
from emulator.registers.taps import lay

if TYPE_CHECKING:
    from emulator.registers.fields import F
    from emulator.registers.taps import RegisterTap, Seen


class Owner(Protocol):
    """What a cell needs of the block that it stands in."""

    byte_peripheral: ClassVar[bool]
    name: str
    cpu: Cpu
    clocked: bool
    registers: dict[str, Cell]


#: They stand for the CPU where EALLOW does not decide.
OPEN: Final = Eallow(eallow=True)
CLOSED: Final = Eallow(eallow=False)


@mypyc_attr(allow_interpreted_subclasses=True)
class Cell:
    """The stored word of a register and its access.

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
    #: The register of the same block in which a one written here clears the bit.
    clears: ClassVar[str] = ""
    #: Whether some field does not read back what is stored.
    write_only: ClassVar[bool] = False

    __slots__ = (
        "_chosen", "_followers", "_plain", "_taps", "address", "block", "gate", "modify", "name", "on_read",
        "on_read_steady", "on_write", "read", "read_hook", "reads", "value", "write", "write_hook", "writes",
    )  # fmt: skip

    def __init__(self, block: Owner, name: str, address: int) -> None:
        self.block = block
        self.name = name
        self.address = address
        self.value = self.reset_value
        self.on_read: Callable[[], int] | None = None
        self.on_write: Callable[[int, int], None] | None = None
        #: Whether `on_read` gives the same again, and does nothing else, as long as no event comes.
        self.on_read_steady = False
        #: The objects of which those are methods, if they are.
        self.read_hook: Hook | None = None
        self.write_hook: Hook | None = None
        #: None, as long as nobody follows.  A chip has 2,500 registers, and a check makes a chip for each circumstance:
        #: what most of them never need is not made.
        self._followers: list[tuple[dict[str, Any], str, str]] | None = None
        self._taps: dict[RegisterTap | Seen, bool] | None = None
        #: Whether the access functions are those of the present state; else the first access chooses them.
        self._chosen = False
        #: Whether `read` only gives `value`.
        self._plain = False
        self.read: Callable[[], int] = self
        self.write: Callable[[int, int], None] = self
        #: `modify(keep, bits, lanes)`: the read-modify-write that a compiler makes of a field assignment.
        self.modify: Callable[[int, int, int], None] = self
        #: The objects of which `read` and `write` are the methods, while they are.
        self.reads: Hook | None = None
        self.writes: Hook | None = None
        #: While its `eallow` stands, `modify` does nothing but store the field in `value`; of a register that clears
        #: bits of another, `write` does nothing else.
        self.gate: Eallow = CLOSED

    @property
    def path(self) -> str:
        """The name that C uses, for instance `AdcaRegs.ADCCTL2`."""
        return f"{self.block.name}.{self.name}"

    def half_at(self, address: int) -> int:
        """The half of it that a word address names: 0 or 1.

        Of a byte peripheral, even and odd addresses of 16 bits are the same ones (SPRU514).
        """
        return address - self.address >> (1 if self.block.byte_peripheral else 0)

    def bind(self) -> None:
        """Choose the access functions for the present state of hooks, clock gate, protection and taps.

        At the first access, unless somebody follows: most registers of a chip are never used.
        """
        if self._taps or self._followers:
            self._choose()
        elif self._chosen:
            self._chosen = self._plain = False
            self.reads = self.writes = None
            self.read = self.write = self.modify = self

    def __call__(self, *words: Any) -> Any:
        """The first access: `read()`, `write(word, lanes)` or `modify(keep, bits, lanes)`."""
        self._choose()
        access: Callable[..., Any] = (self.read, self.write, self.write, self.modify)[len(words)]
        return access(*words)

    def _choose(self) -> None:
        self._chosen = True
        self.gate = CLOSED
        self.reads = self.writes = None
        if self.block.clocked:
            self._bind_clocked()
        else:
            self.read, self.write = gated_read(self), gated_write(self)
            self.modify = self._modify
        if self._taps:
            lay(self, self._taps)
            self.gate = CLOSED
        self._plain = self.read == self._read_plain
        for namespace, name, access in self._followers or ():
            namespace[name] = getattr(self, access)

    def follow(self, access: str, namespace: dict[str, Any], name: str) -> None:
        """Keep `namespace[name]` the present way of `access`.

        "read", "write" and "modify" are functions.  "source" is an object whose attribute `value` is what the CPU reads:
        the register itself, as long as reading is only looking.  "gate" is `gate`, "cleared" the register that it
        clears, "steady" is `steady`.
        """
        if self._followers is None:
            self._followers = []
        self._followers.append((namespace, name, access))
        self._choose()

    @property
    def is_read(self) -> bool:
        """Whether a function of a linked program reads it by its name."""
        return any(access in ("read", "source") for _, _, access in self._followers or ())

    def tap(self, seen: RegisterTap | Seen, *, reads: bool = False) -> None:
        """Have `seen` told of each write, with `reads` of each read too, right before it happens: `taps.Seen`."""
        if self._taps is None:
            self._taps = {}
        self._taps[seen] = reads
        self.bind()

    def untap(self, seen: RegisterTap | Seen) -> None:
        """Tell `seen` nothing more.  Raises KeyError if it was told nothing."""
        del (self._taps or {})[seen]
        self.bind()

    @property
    def looked_at(self) -> bool:
        """Whether reading is nothing but looking at the stored word, as long as the module's clock is on."""
        masked = self.read_mask != (1 << self.bits) - 1 and self.write_only
        return self.on_read is None and not masked

    @property
    def steady(self) -> bool:
        """Whether one read is as good as many, as long as no event comes: they give the same, and nobody notices them."""
        watched = self._taps is not None and any(self._taps.values())
        return self.block.clocked and not watched and (self.on_read is None or self.on_read_steady)

    @property
    def source(self) -> Cell | Source:
        """What has the word that the CPU reads as its `value`."""
        return self if self._plain else Source(self)

    @property
    def cleared(self) -> Cell:
        """The register of which it clears bits."""
        return self.block.registers[self.clears]

    def _bind_clocked(self) -> None:
        if self.on_read is not None:
            self.read, self.reads = self.on_read, self.read_hook
        else:
            self.read = self._read_plain if self.looked_at else self._read_masked
        hook = self.write_hook
        if self.on_write is not None:
            bare = self.on_write
        elif self.clears:
            hook = Clearing(self.cleared)
            bare = hook.write
            if not self.eallow:
                self.gate = OPEN
        else:
            bare = self._storing()
        write = watching(self, bare) if self.unmodelled_mask else bare
        self.write = protecting(self, write) if self.eallow else write
        # A field assignment leaves reserved bits as they are: only whole words are looked at.
        self.modify = self._modifying()
        if self.reserved_mask:
            self.write = refusing_reserved(self, self.write)
        if self.write == bare:
            self.writes = hook

    def _modify(self, keep: int, bits: int, lanes: int) -> None:
        self.write(self.read() & keep | bits, lanes)

    def _modifying(self) -> Callable[[int, int, int], None]:
        """`modify`, in one step where reading has no effect and the write is plain or known."""
        register, write = self, self.write
        if self.on_read is not None:
            return self._modify
        shown = self.read_mask
        if not shown:

            def modify_clear(keep: int, bits: int, lanes: int) -> None:
                write(bits, lanes)

            return modify_clear
        plain = self.on_write is None and not self.unmodelled_mask and self.rw_mask == shown and self.bits == 16
        if plain and not (self.eallow and self.write_only):
            gate = self.gate = self.block.cpu if self.eallow else OPEN

            def modify_in_place(keep: int, bits: int, lanes: int) -> None:
                if gate.eallow:
                    register.value = (register.value & keep | bits) & shown
                else:
                    write(register.value & keep | bits, lanes)

            return modify_in_place
        if self.write_only:
            return self._modify

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

    def bus_read(self) -> int:
        """What another master of the bus reads, the DMA: no access of the CPU, of which taps are told."""
        if not self.block.clocked:
            return gated_read(self)()
        return self.on_read() if self.on_read is not None else self.value & self.read_mask

    def bus_write(self, word: int, lanes: int) -> None:
        """Its write: EALLOW is the CPU's."""
        write = gated_write(self)
        if self.block.clocked:
            write = self.store if self.on_write is None else self.on_write
            if self.unmodelled_mask:
                write = watching(self, write)
        write(word, lanes)

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


def look(register: Cell) -> int:
    """What the CPU reads in `register` now.

    It is no method: compiled code calls those of `Cell` through Python, because registers are made at run time.
    """
    if register._plain:
        return register.value
    hook = register.reads
    return register.read() if hook is None else hook.read()


def put(register: Cell, word: int, lanes: int) -> None:
    """Do what the CPU's write to `register` does now."""
    hook = register.writes
    if hook is None:
        register.write(word, lanes)
    else:
        hook.write(word, lanes)


class Clearing(Hook):
    """The write of a register that clears bits of another."""

    __slots__ = ("_cleared",)

    def __init__(self, cleared: Cell) -> None:
        self._cleared = cleared

    def write(self, word: int, lanes: int = ALL) -> None:
        """A one clears the bit."""
        self._cleared.value &= ~word


class Source:
    """A register's word, where reading is more than looking."""

    __slots__ = ("_read",)

    def __init__(self, register: Cell) -> None:
        self._read = register.read

    @property
    def value(self) -> int:
        """What the CPU reads now."""
        return self._read()
