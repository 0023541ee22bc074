"""What translated firmware calls when a plain Python operation is not enough.

The generated code takes the fast path inline; it comes here for what must be watched or cannot be proven: a value that
was never written, an index outside, a pointer access, an overflow, a conversion.  One `Runtime` belongs to one linked
image.
"""

from __future__ import annotations

import random
from typing import Any, Final, Protocol

from emulator.c28x.arithmetic import DIVIDERS, FLOAT_TO_INT, divide_int, f32, modulo_int
from emulator.c28x.ctypes import CType, FloatType, IntType, PointerType
from emulator.c28x.findings import Finding, Findings
from emulator.c28x.memory import NULL, Memory, Object, Pointer, from_words
from emulator.c28x.tree import Declaration
from emulator.clock import CYCLES_PER_US, Clock

FILLS: Final = ("zero", "ones", "nan", "random:SEED", "stack", "trap")


class UninitialisedRead(Exception):
    """Raised by the fill policy `trap`."""


class IllegalCall(Exception):
    """A call through a function pointer that points to no function (on the chip an illegal instruction at best)."""


class EndlessPoll(Exception):
    """A loop polls a condition that nothing can change any more."""


def zero_of(ctype: CType) -> Any:
    """The value of a scalar whose words are 0."""
    return 0.0 if isinstance(ctype, FloatType) else (0 if isinstance(ctype, IntType) else NULL)


class Site:
    """One place in the source that may be reported: the object meant, its type, what was found so far."""

    __slots__ = (
        "bound", "ctype", "declaration", "empty_at", "generation", "initial", "name", "planted", "seen", "zero",
    )  # fmt: skip

    def __init__(self, ctype: CType, declaration: Declaration | None, name: str, bound: int = 0) -> None:
        self.ctype = ctype
        self.declaration = declaration
        self.name = name
        self.bound = bound
        self.seen: Finding | None = None
        self.generation = -1
        #: What a word that is 0 gives, and the address found last where nothing is and never will be.
        self.zero = zero_of(ctype)
        self.empty_at = -1
        #: Tests: the value this object starts from, shared by all sites of the object; cells outside it.
        self.initial: dict[str, Any] = {}
        self.planted: dict[int, Any] = {}


class StackPointer(Protocol):
    """What generated code needs of the core: where the stack is, and whether protected registers may be written."""

    sp: int
    stack_limit: int
    eallow: bool


def parse_fill(fill: str) -> tuple[str, int]:
    """A fill policy by name.  Raises ValueError for an unknown one."""
    name, colon, seed = fill.partition(":")
    if name == "random" and (not colon or seed.lstrip("-").isdecimal()):
        return name, int(seed or 0)
    if name in ("zero", "ones", "nan", "stack", "trap") and not seed:
        return name, 0
    raise ValueError(f"unknown fill policy {fill!r}: one of {', '.join(FILLS)}")


class Runtime:
    """Slow paths and policies of one image."""

    def __init__(
        self, clock: Clock, cpu: StackPointer, findings: Findings, memory: Memory, *,
        fill: str = "zero", divide: str = "ieee", float_to_int: str = "saturate", poll_limit_s: float = 5.0,
    ) -> None:  # fmt: skip
        if divide not in DIVIDERS:
            raise ValueError(f"unknown divider {divide!r}: one of {', '.join(DIVIDERS)}")
        if float_to_int not in FLOAT_TO_INT:
            raise ValueError(f"unknown float to int policy {float_to_int!r}: one of {', '.join(FLOAT_TO_INT)}")
        self.clock, self.cpu, self.findings, self.memory = clock, cpu, findings, memory
        self.fill, self.seed = parse_fill(fill)
        self.divide = DIVIDERS[divide]
        self.to_int = FLOAT_TO_INT[float_to_int]
        self.poll_limit = int(poll_limit_s * 1_000_000 * CYCLES_PER_US)

    # Reports

    def hit(self, site: Site, rule: str, message: str, value: Any = None) -> None:
        """Report at `site`; later passes of the same site only count."""
        if site.seen is not None and site.generation == self.findings.generation:
            site.seen.count += 1
            return
        shown = value if isinstance(value, int | float) else None
        site.seen = self.findings.report(
            rule, message, object=site.name, declaration=str(site.declaration or ""), value=shown
        )
        site.generation = self.findings.generation

    # What a never-written object holds

    def fill_word(self, addr: int) -> int:
        """A never-written word of plain RAM under the fill policy."""
        if self.fill == "ones":
            return 0xFFFF
        if self.fill == "nan":
            return 0x7FC0 if addr & 1 else 0x0000
        if self.fill == "random":
            return random.Random(self.seed << 24 ^ addr).getrandbits(16)
        return 0

    def fill_value(self, ctype: CType, key: str, addr: int | None = None) -> Any:
        """A never-written scalar of type `ctype`.  `addr` is where it lies, for the policy `stack`."""
        if self.fill == "zero" or not isinstance(ctype, IntType | FloatType):
            return zero_of(ctype)
        if self.fill == "stack" and addr is not None:
            return from_words([self.memory.words.get(addr + i, 0) for i in range(ctype.words)], ctype, self.memory)
        if self.fill == "random":
            bits = random.Random(f"{self.seed}:{key}").getrandbits(32)
        else:
            nan = 0x7FC07FC0 if isinstance(ctype, IntType) else 0x7FC00000
            bits = {"ones": 0xFFFFFFFF, "nan": nan}.get(self.fill, 0)
        return from_words((bits & 0xFFFF, bits >> 16), ctype, self.memory)

    def uninit(self, site: Site, addr: int | None = None) -> Any:
        """A read of an object that nobody has written."""
        seen = site.seen
        if seen is not None and site.generation == self.findings.generation and self.fill == "zero":
            seen.count += 1
            return site.initial.get("value", site.zero)
        if "value" in site.initial:
            value = site.initial["value"]
        else:
            if self.fill == "trap":
                self.hit(site, "uninitialised", f"{site.name} is read before anything was written to it")
                raise UninitialisedRead(f"{site.name} is read before anything was written to it ({site.declaration})")
            value = self.fill_value(site.ctype, site.name, addr)
        self.hit(site, "uninitialised", f"{site.name} is read before anything was written to it", value)
        return value

    # Indices outside an object

    def oob_load(self, site: Site, index: int, stride: int, base: int) -> Any:
        """Read element `index` of an array of `site.bound`; `base` is the address of element 0, `stride` in words."""
        addr = base + index * stride
        if site.seen is not None and site.generation == self.findings.generation:
            site.seen.count += 1
        else:
            where = self.memory.neighbour(addr)
            message = f"{site.name}[{index}] is read: the array has {site.bound} elements; this reads {where}"
            self.hit(site, "index", message, index)
        if index in site.planted:
            return site.planted[index]
        if addr == site.empty_at:
            return site.zero
        if self.memory.empty(site.ctype, addr):
            site.empty_at = addr
        return self.memory.load(site.ctype, addr)

    def oob_store(self, site: Site, index: int, stride: int, base: int, value: Any) -> None:
        """Write element `index` of an array of `site.bound`."""
        addr = base + index * stride
        if site.seen is None or site.generation != self.findings.generation:
            where = self.memory.neighbour(addr)
            message = f"{site.name}[{index}] is written: the array has {site.bound} elements; this hits {where}"
            self.hit(site, "index", message, index)
        else:
            site.seen.count += 1
        if index in site.planted:
            site.planted[index] = value
        else:
            self.memory.store(site.ctype, addr, value)

    # Pointers

    def load(self, p: Pointer, words: int, site: Site) -> Any:
        """`*(p + words)` as `site.ctype`."""
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and found[1] == site.ctype:
                value = obj.data[found[0]]
                if value is not None:
                    return value
                return self._unwritten(site, obj, p.offset + words)
        return self._load_slow(p, words, site)

    def _unwritten(self, site: Site, obj: Object, offset: int) -> Any:
        name = obj.declaration.path
        if obj.initial is not None:
            value = obj.initial
        else:
            value = self.fill_value(site.ctype, f"{name}+{offset}", obj.base + offset)
        message = f"{name} (word {offset}) is read through {site.name} before anything was written to it"
        if site.seen is None or site.generation != self.findings.generation:
            site.declaration = obj.declaration
        self.hit(site, "uninitialised", message, value)
        if self.fill == "trap" and obj.initial is None:
            raise UninitialisedRead(f"{message} ({obj.declaration})")
        return value

    def _load_slow(self, p: Pointer, words: int, site: Site) -> Any:
        self._examine(p, words, site, "read")
        obj = p.obj
        if obj is not None:
            covering = obj.leaf(p.offset + words)
            if covering is not None and obj.data[covering[0]] is None:
                return self._unwritten(site, obj, p.offset + words)
        return self.memory.load_through(p, words, site.ctype)

    def store(self, p: Pointer, words: int, value: Any, site: Site) -> None:
        """`*(p + words) = value` as `site.ctype`."""
        obj = p.obj
        if obj is not None and not obj.readonly:
            found = obj.leaf(p.offset + words)
            if found is not None and found[1] == site.ctype:
                obj.data[found[0]] = value
                return
        self._examine(p, words, site, "written")
        self.memory.store_through(p, words, site.ctype, value)

    def _examine(self, p: Pointer, words: int, site: Site, verb: str) -> None:
        obj, memory = p.obj, self.memory
        addr = p.addr + words
        if obj is None:
            if p.offset == 0:
                self.hit(
                    site, "null-dereference",
                    f"{site.name} is NULL and is {verb} through: address {addr:#x} is M0 RAM, which holds "
                    f"{memory.load(site.ctype, addr)!r} and is shared by every null pointer",
                )  # fmt: skip
        elif not 0 <= p.offset + words < obj.words:
            self.hit(
                site, "pointer-outside",
                f"{site.name} has left {obj.declaration.path} ({obj.words} words): word {p.offset + words} is {verb}, "
                f"which is {memory.neighbour(addr)}", p.offset + words,
            )  # fmt: skip
        elif obj.readonly and verb == "written":
            message = f"{site.name} points to the constant {obj.declaration.path}: the write is lost"
            self.hit(site, "write-to-constant", message)
        if site.ctype.words == 2 and addr & 1:
            self.hit(site, "odd-access", f"{site.name}: a 32-bit access at odd address {addr:#x} uses {addr & ~1:#x}")

    def copy_struct(self, target: Pointer, source: Pointer, words: int, site: Site) -> None:
        """`*target = *source` for whole structures; what was never written stays so."""
        for p, verb in ((source, "read"), (target, "written")):
            if p.obj is None or p.offset < 0 or p.offset + words > p.obj.words:
                self._examine(p, 0, site, verb)
        self.memory.copy(target, source, words)

    def callable(self, function: Any, site: Site) -> Any:
        """A function pointer about to be called.  NULL or never written: the CPU would run whatever stands there."""
        if callable(function):
            return function
        message = f"{site.name} is called, but it points to no function"
        self.hit(site, "null-dereference", message)
        raise IllegalCall(message)

    def address(self, p: Pointer, words: int, target: CType) -> Pointer:
        """A pointer `words` behind `p`, to another type."""
        return Pointer(self.memory, p.obj, p.offset + words, target)

    def cast(self, value: Any, target: CType) -> Any:
        """A pointer conversion."""
        if isinstance(value, Pointer) and isinstance(target, PointerType) and value.target != target.target and value:
            return Pointer(self.memory, value.obj, value.offset, target.target)
        return value

    def pointer_at(self, addr: int, target: PointerType) -> Pointer:
        """An integer converted to a pointer."""
        return Pointer(self.memory, None, addr & 0xFFFFFFFF, target.target)

    def enter(self, declaration: Declaration, data: list[Any], base: int) -> Pointer:
        """A local of the running function whose address is taken."""
        obj = Object(declaration, base, data)
        self.memory.live_locals.append(obj)
        return Pointer(self.memory, obj, 0, declaration.ctype)

    # Arithmetic

    def overflow(self, value: int, site: Site) -> int:
        """A signed result outside its type: reported, and wrapped as the hardware does (OVM = 0)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        wrapped = ctype.wrap(value)
        message = f"{site.name} is {value}, which does not fit a {ctype.bits}-bit {ctype}: it becomes {wrapped}"
        self.hit(site, "overflow", message, value)
        return wrapped

    def float_to_int(self, value: float, site: Site) -> int:
        """Truncation toward zero; outside the type's range the policy decides, and it is reported."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        low, high = ctype.low, ctype.high
        if low - 1.0 < value < high + 1.0:
            return int(value)
        result = self.to_int(value, low, high)
        message = f"{site.name} is {value!r}, outside the range of a {ctype}: it becomes {result}"
        self.hit(site, "float-to-int", message, value)
        return result

    def divide_floats(self, a: float, b: float, site: Site) -> float:
        """Float division by the selected divider."""
        if b == 0.0:
            self.hit(site, "division-by-zero", f"{site.name}: {a!r} is divided by zero", a)
        return self.divide(a, b)

    def divide_ints(self, a: int, b: int, site: Site) -> int:
        """Integer division; by zero it does not trap (CHOICE: all ones, as the SUBCU loop leaves)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        if b == 0:
            self.hit(site, "division-by-zero", f"{site.name}: {a} is divided by zero", a)
            return ctype.wrap(-1)
        quotient = divide_int(a, b)
        return quotient if quotient <= ctype.high else self.overflow(quotient, site)

    def modulo_ints(self, a: int, b: int, site: Site) -> int:
        """Remainder; by zero it is the dividend (CHOICE)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        if b == 0:
            self.hit(site, "division-by-zero", f"{site.name}: {a} modulo zero", a)
            return a
        return ctype.wrap(modulo_int(a, b))

    def shift(self, op: str, a: int, count: int, site: Site) -> int:
        """A shift by a variable count.  Outside 0..width-1 it is undefined: reported, and gives 0 (CHOICE)."""
        ctype = site.ctype
        assert isinstance(ctype, IntType)
        if not 0 <= count < ctype.bits:
            self.hit(site, "shift-range", f"{site.name} shifts a {ctype.bits}-bit value by {count}", count)
            return 0
        if op == ">>":
            return a >> count
        shifted = a << count
        if ctype.signed and not ctype.low <= shifted <= ctype.high:
            return self.overflow(shifted, site)
        return ctype.wrap(shifted)

    # Time

    def poll(self, site: Site, until: int) -> int:
        """A poll has run out of events, or of patience: raises, or reports and gives the next time to look again."""
        clock = self.clock
        if clock.now <= until:
            message = f"{site.name} is polled, but no event is left that could change it: the loop never ends"
            self.hit(site, "endless-poll", message)
            raise EndlessPoll(message)
        limit_s = self.poll_limit / CYCLES_PER_US / 1e6
        self.hit(site, "endless-poll", f"{site.name} has been polled for {limit_s:g} s without an end")
        return clock.now + self.poll_limit

    def stack_check(self, path: str) -> None:
        """The stack pointer has passed the end of the current stack."""
        self.findings.report(
            "stack-overflow",
            f"{path}: the stack pointer {self.cpu.sp:#x} has passed the end {self.cpu.stack_limit:#x} of the stack",
            object=self.findings.context(), value=self.cpu.sp,
        )  # fmt: skip

    f32 = staticmethod(f32)
