"""The functions that translated firmware calls when a plain Python operation is not enough.

Generated code has the fast path inline.  It calls this module for operations that must be watched or cannot be proven
right: a value that was never written, an index outside, a pointer access, an overflow, a conversion.  It passes the
number of its place.  One `Runtime` belongs to one linked image.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from math import isfinite
from typing import Any, Final, Protocol

from emulator.c28x.arithmetic import COMPARE, DIVIDERS, FLOAT_TO_INT, divide_double, divide_int, modulo_int
from emulator.c28x.called_as import fitted, misfit
from emulator.c28x.ctypes import (
    CHAR,
    FLOAT,
    NOBODY,
    UINT,
    ULONG,
    VOID,
    ArrayType,
    CType,
    Double64,
    FloatType,
    FunctionType,
    IntType,
    PointerType,
    StructType,
    part_name,
    scalars,
)  # fmt: skip
from emulator.c28x.findings import Finding, Findings
from emulator.c28x.heap_block import HeapBlock
from emulator.c28x.memory import ROM, TRIMS, Memory, Object, Pointer, from_words, zero_of
from emulator.c28x.sites import Site
from emulator.c28x.tree import NOWHERE, Declaration, Where
from emulator.c28x.varargs import ArgumentBlock
from emulator.c28x.watcher import Watcher
from emulator.clock import CYCLES_PER_US, NEVER, Clock
from emulator.seed import parse_seed

#: The time limit of a loop that only computes.  Such a loop takes milliseconds; the limit catches those that never end.
LOOP_LIMIT_S: Final = 0.2
#: CHOICE: hardware answers within microseconds.  What another processor answers, the emulator cannot know.
_UNMODELLED_WAIT_S: Final = 1e-3
#: How many awaited stamps are remembered for one comparison.
_STAMPS: Final = 64
#: A longer time between two captures is reported at the third use.  One may come from an edge that was missed.
WRONG_PULSES: Final = 3
#: CHOICE: a number from -1 down to this one counts as a small negative one (`sign_lost`).
SMALL: Final = -4096
#: CHOICE: what an integer quotient of this size loses is less than a hundredth, and its author may not need that.
_FINE: Final = 100
#: The greatest word of 24 bits.  CHOICE: so near to 0 a step below it is one, after so many values just above it.
_ALL_24: Final = 0xFF_FFFF
_NEAR: Final = 1 << 20
_BEFORE: Final = 3
#: CHOICE: for so many passes the error of a regulator stays on one side of 0 only if it cannot get away.
_ONE_SIDE: Final = 40
#: It runs away if it is so many times what it was, and so many times the wanted value.
_AWAY: Final = 1.5
_BEYOND: Final = 1.2
#: A float above this one has hardly a fraction.
_WHOLE: Final = 1e6
#: CHOICE: a float passed for an integer parameter that never reaches this value was not meant as an integer.
_FEW: Final = 10
#: CHOICE: after so many limited outputs it is known whether their limit moves.
_MET: Final = 20
#: CHOICE: an integral has wound up if its share is beyond the limit by a part of the output's whole range: one of this.
_SPANS: Final = 4.0
#: What many take for an error of the tool, because start-up code of a PC, and that of the EABI, clears these objects.
_UNCLEARED: Final = " (COFF start-up code does not clear it)"
FILLS: Final = ("zero", "ones", "nan", "random:SEED", "stack", "trap")
#: The words at the start of a frame that hold the return address.
RETURN_ADDRESS_WORDS: Final = 2


class UninitialisedRead(Exception):
    """Raised by the fill policy `trap`."""


class IllegalCall(Exception):
    """A call through a function pointer that points to no function (on the chip an illegal instruction at best)."""


class EndlessPoll(Exception):
    """A loop polls a condition that nothing can change any more."""


class Idling(EndlessPoll):
    """A function idles in an endless loop while its caller waits for its return: this is not a defect of the loop."""


class RuntimeSite:
    """One check of a running image: what the program says of it (`check`), its number, and what it has found so far.

    It is compiled, and `Site` is not: type and name, which are asked often, stand here too.
    """

    __slots__ = (
        "ahead", "check", "ctype", "empty_at", "fine", "first", "generation", "greatest", "initial", "last", "least",
        "name", "number", "passes", "planted", "seen", "turned", "turns", "wanted", "zero",
    )  # fmt: skip

    def __init__(self, site: Site, number: int) -> None:
        self.check, self.ctype, self.name = site, site.ctype, site.name
        self.number = number
        self.seen: Finding | None = None
        self.generation = -1
        #: A quotient here was so large that its remainder did not matter: then smaller ones are measured as coarsely.
        self.fine = False
        #: The largest float that was passed for an integer here.
        self.greatest = 0.0
        #: The error of a regulator when it came to its side of 0, and the number of passes since.
        self.first = 0.0
        self.passes = 0
        #: The error of a regulator that has not been smaller for so many passes, in which the wanted value stood.
        self.least = 0.0
        self.wanted = 0.0
        self.turns = 0
        #: The stamps compared here last; whether one of them has wrapped; awaited stamp -> how far it was ahead.
        self.last = (0, 0)
        self.turned = False
        self.ahead: dict[int, int] = {}
        #: The value of words that are 0; the last address found at which there is no memory at all.
        self.zero = zero_of(site.ctype)
        self.empty_at = -1
        #: Tests: the initial value of this object, shared by all its sites; values of cells outside of it.
        self.initial: dict[str, Any] = {}
        self.planted: dict[int, Any] = {}

    @property
    def integer(self) -> IntType:
        """Its type, where that is an integer's."""
        assert isinstance(self.ctype, IntType)
        return self.ctype


class RegulatorState:
    """What was seen last of a regulator: the place of its sum, the integral's share of the output, the output."""

    __slots__ = ("limits", "met", "moving", "output", "share", "side", "sum_at")

    def __init__(self) -> None:
        self.sum_at = 0
        self.share = 0.0
        #: The sides on which no statement limits the integral.
        self.side = ""
        #: The output before it is limited; None: there is none yet.
        self.output: float | None = None
        #: The limits that the output has met, by side, and how often it has met one; whether a limit has moved (it
        #: limits the steps of the output then, or follows another value).
        self.limits: dict[str, float] = {}
        self.met = 0
        self.moving = False


class RuntimeSites(dict[int, RuntimeSite]):
    """The checks of one image by number, each created at its first use."""

    def __init__(self, runtime: Runtime) -> None:
        super().__init__()
        self._runtime = runtime

    def __missing__(self, number: int) -> RuntimeSite:
        runtime = self._runtime
        self[number] = site = RuntimeSite(runtime.findings.places.site(number), number)
        if site.check.declaration is not None:
            path = site.check.declaration.path
            site.initial = runtime.initials.setdefault(path, {})
            site.planted = runtime.planted.setdefault(path, {})
        return site


def _wrap(site: RuntimeSite, index: int) -> list[str]:
    """The detail that an unsigned subscript has wrapped below 0, as a list; empty if it has not."""
    if not site.check.wraps or index <= 0x7FFF:
        return []
    return [f"the unsigned {site.check.wraps} went below 0 and wrapped: {index - 0x10000} became {index}"]


class StackPointer(Protocol):
    """The part of the core that generated code uses: the stack, and whether protected registers can be written."""

    sp: int
    stack_limit: int
    eallow: bool
    #: How many interrupts were ever taken.
    taken: int


def parse_fill(fill: str) -> tuple[str, int]:
    """A fill policy as (name, seed).  Raises ValueError for an unknown policy or a wrong seed."""
    name, colon, seed = fill.partition(":")
    if name == "random":
        return name, parse_seed(seed, "fill random:SEED") if colon else 0
    if name in ("zero", "ones", "nan", "stack", "trap") and not seed:
        return name, 0
    raise ValueError(f"unknown fill policy {fill!r}: one of {', '.join(FILLS)}")


class _BlockWord:
    """A word of memory that is accessed through a pointer to a register block, but is no register."""

    def __init__(self, runtime: Runtime, p: Pointer, words: int, ctype: IntType, site: RuntimeSite) -> None:
        self._runtime, self._p, self._words, self._ctype, self._site = runtime, p, words, ctype, site

    def read(self) -> int:
        """Read the word."""
        self._runtime.examine(self._p, self._words, self._site, "read", self._ctype)
        value: int = self._runtime.memory.load_through(self._p, self._words, self._ctype)
        return value

    def write(self, word: int, lanes: int) -> None:
        """Write the whole word."""
        self._runtime.examine(self._p, self._words, self._site, "written", self._ctype)
        self._runtime.memory.store_through(self._p, self._words, self._ctype, word)

    def modify(self, keep: int, bits: int, lanes: int) -> None:
        """Write some of its bits."""
        self.write(self.read() & keep | bits, lanes)


def _nothing(*_arguments: Any) -> int:
    """Replaces a function of the ROM."""
    return 0


class Runtime:
    """Slow paths, policies and reports of one image."""

    def __init__(
        self, clock: Clock, cpu: StackPointer, findings: Findings, memory: Memory, *,
        fill: str = "zero", divide: str = "ieee", float_to_int: str = "saturate", poll_limit_s: float = 5.0,
        register_at: Callable[[int], Any] = lambda address: None,
        blames_unmodelled: Callable[[str], bool] = lambda name: False, driven: Callable[[], bool] = lambda: False,
    ) -> None:  # fmt: skip
        """`register_at(address)` returns the register at an address, for accesses by a pointer to its block.

        `blames_unmodelled(name)` is called when a wait for an object was in vain; it returns whether the wait ends now.
        `driven()` returns whether the host runs the firmware in slices of time, so that nobody waits for the end of its
        `main`.
        """
        if divide not in DIVIDERS:
            raise ValueError(f"unknown divider {divide!r}: one of {', '.join(DIVIDERS)}")
        if float_to_int not in FLOAT_TO_INT:
            raise ValueError(f"unknown float to int policy {float_to_int!r}: one of {', '.join(FLOAT_TO_INT)}")
        self.clock, self.cpu, self.findings, self.memory = clock, cpu, findings, memory
        self.fill, self.seed = parse_fill(fill)
        #: Fill policies of single objects, by path: {"us.Read_Distance.result": parse_fill("ones")}.
        self.fill_of: dict[str, tuple[str, int]] = {}
        self.divide = DIVIDERS[divide]
        self.to_int = FLOAT_TO_INT[float_to_int]
        #: What the program calls `double`; the linker sets it.
        self.double: FloatType = FLOAT
        #: How long a loop may compute without a call, in cycles.
        self.loop_limit = int(LOOP_LIMIT_S * 1_000_000 * CYCLES_PER_US)
        self.poll_limit = int(poll_limit_s * 1_000_000 * CYCLES_PER_US)
        #: How long a wait for a register that is not modelled may last until `blames_unmodelled` is called, in cycles.
        self.unmodelled_wait = int(_UNMODELLED_WAIT_S * 1_000_000 * CYCLES_PER_US)
        #: The sites of such waits that nothing ended.
        self._in_vain: set[int] = set()
        self.watcher: Watcher | None = None
        self.sites = RuntimeSites(self)
        #: Tests, by the path of an object: the value of a never-written object; values of cells outside of an array.
        self.initials: dict[str, dict[str, Any]] = {}
        self.planted: dict[str, dict[int, Any]] = {}
        #: The types of functions; (function, number of the call) -> what a call through a pointer runs.
        self.signatures: dict[Any, FunctionType] = {}
        self.called_as: dict[tuple[Any, int], Any] = {}
        self._register_at, self._blames_unmodelled, self._driven = register_at, blames_unmodelled, driven
        #: An object -> the site at which it has kept 16 bits of a longer time between two captures, and that time.
        self.cut_pulses: dict[str, tuple[RuntimeSite, int]] = {}
        #: The regulators that have run, by name.
        self.regulators: dict[str, RegulatorState] = {}
        #: How many of them were used as a wider number.
        self.wrong_pulses = 0
        #: The number in the text that `atoi` has read last.
        self.parsed_number = 0
        #: Checks of library functions that read or write through a pointer.
        self.readers: dict[Any, RuntimeSite] = {}
        #: The users of null pointers so far, their call paths, and the findings about them.
        self.null_users: set[str] = set()
        self.null_ways: set[tuple[RuntimeSite, Any]] = set()
        self.null_findings: list[Finding] = []
        self.null_generation = -1
        #: Where a NaN or an infinity has arrived so far.
        self.not_finite_at: set[str] = set()
        self.not_finite_generation = -1
        #: Switches with a finding that a value has no case -> the generation of that finding.
        self.caseless: dict[Where, int] = {}
        #: Whether time skips the turns of a loop that change nothing.
        self.skips_turns = False
        #: After the last such turn: the time, the time of the next event, how many events were ever scheduled,
        #: the interrupts that were taken, and the occurrences of findings.
        self._idle_turn = (-1, -1, -1, -1, -1)
        #: When a function last did what no idle turn does.
        self._busy = -1
        memory.take_policy_from(self)

    # Reports

    def counted(self, site: RuntimeSite, rule: str = "") -> bool:
        """Whether `rule` (or any rule) has been reported at `site`; if so, count this occurrence."""
        seen = site.seen
        if seen is None or site.generation != self.findings.generation or (rule and seen.rule != rule):
            return False
        self.findings.count(seen)
        return True

    def hit(self, site: RuntimeSite, rule: str, message: str, value: Any = None, details: tuple[str, ...] = ()) -> None:
        """Report at `site`; later occurrences at the same site only count."""
        if self.counted(site, rule):
            return
        shown = value if isinstance(value, int | float) else None
        site.seen = self.findings.report(
            rule, message, object=site.name, declaration=str(site.check.declaration or ""), value=shown,
            details=details, at=site.number,
        )  # fmt: skip
        site.generation = self.findings.generation

    def not_finite(self, value: float, site: RuntimeSite, where: str) -> None:
        """A NaN or an infinity has arrived at `where`: report it the first time."""
        if self.not_finite_generation != self.findings.generation:
            self.not_finite_at, self.not_finite_generation = set(), self.findings.generation
        if where not in self.not_finite_at:
            self.not_finite_at.add(where)
            self.hit(site, "nan-output", f"{value!r} reaches {where}", value)

    # Values of objects that were never written

    def fill_word(self, addr: int) -> int:
        """The value of a never-written word of plain RAM, by the fill policy."""
        if self.fill == "ones":
            return 0xFFFF
        if self.fill == "nan":
            return 0x7FC0 if addr & 1 else 0x0000
        if self.fill == "random":
            return random.Random(self.seed << 24 ^ addr).getrandbits(16)
        return 0

    def fill_value(self, ctype: CType, key: str, addr: int | None = None) -> Any:
        """The value of a never-written scalar of type `ctype`; `key` is the path of its object and `+word`.

        `addr` is its address, for the policy `stack`.
        """
        fill, seed = self.fill_of.get(key.partition("+")[0], (self.fill, self.seed))
        if fill == "zero" or not isinstance(ctype, IntType | FloatType):
            return zero_of(ctype)
        if fill == "stack" and addr is not None:
            return from_words([self.memory.words.get(addr + i, 0) for i in range(ctype.words)], ctype, self.memory)
        if isinstance(ctype, Double64):
            chosen = {"ones": (1 << 64) - 1, "nan": 0x7FF8 << 48}.get(fill, 0)
            bits = random.Random(f"{seed}:{key}").getrandbits(64) if fill == "random" else chosen
            return from_words([bits >> 16 * i & 0xFFFF for i in range(4)], ctype, self.memory)
        if fill == "random":
            bits = random.Random(f"{seed}:{key}").getrandbits(32)
        else:
            nan = 0x7FC07FC0 if isinstance(ctype, IntType) else 0x7FC00000
            bits = {"ones": 0xFFFFFFFF, "nan": nan}.get(fill, 0)
        return from_words((bits & 0xFFFF, bits >> 16), ctype, self.memory)

    def fill_scalar(self, obj: Object, offset: int, ctype: CType) -> Any:
        """The value of the never-written scalar at word `offset` of an object."""
        return self.fill_value(ctype, f"{obj.declaration.path}+{offset}", obj.base + offset)

    def uninit(self, number: int, word: int = 0, addr: int | None = None) -> Any:
        """Read an object that was never written: report it and return its fill; `word` is the word within it."""
        site = self.sites[number]
        seen = site.seen
        known = seen is not None and site.generation == self.findings.generation
        if known and self.fill == "zero" and not self.fill_of:
            assert seen is not None
            self.findings.count(seen)
            return site.initial.get("value", site.zero)
        declaration = site.check.declaration
        part = ""
        if declaration is not None and isinstance(declaration.ctype, ArrayType | StructType):
            part = part_name(declaration.ctype, word)
        message = f"{site.name}{part} is read before anything was written to it"
        if site.check.kind == "static":
            message += _UNCLEARED
        # One defect, one finding: if a switch has no case for a value, `no-case` was reported at the switch, where it
        # must be corrected; that nothing was written is only the consequence.  For a value that `no-case` does not
        # report (one that means "none"), the finding is made here.
        told = any(self.caseless.get(where) == self.findings.generation for where in site.check.caseless)
        if "value" in site.initial:
            value = site.initial["value"]
        else:
            if self.fill == "trap":
                if not told:
                    self.hit(site, "uninitialised", message)
                raise UninitialisedRead(f"{message} ({declaration})")
            value = self.fill_value(site.ctype, f"{site.name}+{word}", addr)
        if not told:
            details = (f"it is read as {site.check.text}",) if part and site.check.text else ()
            self.hit(site, "uninitialised", message, value, details)
        return value

    def stale(self, number: int, old: Any, word: int = 0, addr: int | None = None) -> Any:
        """Read a local whose block has been entered again: its words still hold the value of the previous turn."""
        value = self.uninit(number, word, addr)
        return value if old is None else old

    # Indices outside an object

    def oob_load(self, number: int, index: int, stride: int, base: int) -> Any:
        """Read element `index` of an array of `bound`; `base` is the address of element 0, `stride` in words."""
        site = self.sites[number]
        addr = base + index * stride
        if not self.counted(site):
            self._report_index(site, f"[{index}]", "read", "reads", index, index * stride, addr)
        if index in site.planted:
            return site.planted[index]
        if addr == site.empty_at:
            return site.zero
        if self.memory.empty(site.ctype, addr):
            site.empty_at = addr
        return self.strayed_load(site.ctype, addr)

    def oob_store(self, number: int, index: int, stride: int, base: int, value: Any) -> None:
        """Write element `index` of an array of `bound`."""
        site = self.sites[number]
        addr = base + index * stride
        if not self.counted(site):
            self._report_index(site, f"[{index}]", "written", "hits", index, index * stride, addr)
        if index in site.planted:
            site.planted[index] = value
        else:
            self.strayed_store(site.ctype, addr, value)

    def _report_index(
        self, site: RuntimeSite, subscripts: str, done: str, does: str, index: int, words: int, addr: int
    ) -> None:  # fmt: skip
        where = self.neighbour(site, words, addr)
        name, obj = site.name, self.memory.find(addr - words)
        declaration = site.check.declaration
        if obj is not None and obj.declaration is declaration and isinstance(declaration.ctype, StructType):
            name += part_name(declaration.ctype, addr - words - obj.base).removesuffix("[0]")
        of = f"the array has {site.check.bound} elements"
        details = [f"what is {done} instead: {where}", *_wrap(site, index)]
        self.hit(site, "index", f"{name}{subscripts} is {done}: {of}; this {does} {where}", index, tuple(details))

    def neighbour(self, site: RuntimeSite, words: int, addr: int) -> str:
        """What is `words` from the start of the array at `site`, or at `addr`, as text."""
        if site.check.frame is None:
            return self.memory.neighbour(addr)
        function, place = site.check.frame.function, site.check.frame_start + words
        for offset, declaration in site.check.frame.objects:
            if 0 <= place - offset < declaration.ctype.words:
                part = part_name(declaration.ctype, place - offset)
                return f"{declaration.path}{part}, a local of the same function"
        if 0 <= place < RETURN_ADDRESS_WORDS:
            return f"the return address of {function}"
        if -0x100 < place < 0:
            return f"the frame of the function that called {function}"
        return self.memory.neighbour(addr)

    def oob_deep_load(self, number: int, data: list[Any], indices: tuple[int, ...], base: int) -> Any:
        """Read an element by several subscripts, one of which is outside its own dimension."""
        site = self.sites[number]
        offset, leaf = self._deep(site, indices, base, "read", "reads")
        if leaf is None:
            return self.strayed_load(site.ctype, base + offset)
        value = data[leaf]
        return self.uninit(number, offset) if value is None else value

    def oob_deep_store(self, number: int, data: list[Any], indices: tuple[int, ...], base: int, value: Any) -> None:
        """Write an element by several subscripts, one of which is outside its own dimension."""
        site = self.sites[number]
        offset, leaf = self._deep(site, indices, base, "written", "hits")
        if leaf is None:
            self.strayed_store(site.ctype, base + offset, value)
        else:
            data[leaf] = value

    def _deep(
        self, site: RuntimeSite, indices: tuple[int, ...], base: int, done: str, does: str
    ) -> tuple[int, int | None]:
        """The word that the subscripts designate, and the number of the scalar there (None: outside of the object)."""
        check, dimensions = site.check, site.check.dimensions
        assert check.declaration is not None
        ctype = check.declaration.ctype
        offset = check.word + sum(i * stride for i, (_, stride) in zip(indices, dimensions, strict=True))
        leaf = next((n for n, (o, t) in enumerate(scalars(ctype)) if o == offset and t == site.ctype), None)
        if not self.counted(site):
            wrong, (limit, _) = next((i, d) for i, d in zip(indices, dimensions, strict=True) if not 0 <= i < d[0])
            where = self.neighbour(site, offset, base + offset)
            if leaf is not None:
                where = f"{check.declaration.path}{part_name(ctype, offset)}, within the same object"
            subscripts = "".join(f"[{i}]" for i in indices) if isinstance(ctype, ArrayType) else ""
            message = (
                f"{check.text or site.name}: index {wrong} is {done}, but this dimension has {limit} elements; "
                f"this {does} {where}"
            )
            details = [f"what is {done} instead: {where}"]
            if subscripts:
                details.append(f"the subscripts are {subscripts}")
            self.hit(site, "index", message, wrong, tuple(details))
        return offset, leaf

    # Pointers

    def member_index(self, index: int, number: int) -> int:
        """Check and return the subscript of an array of `bound`, a member behind a pointer."""
        site = self.sites[number]
        bound = site.check.bound
        behind = index == bound and site.check.kind == "address"
        if not 0 <= index < bound and not behind and not self.counted(site):
            message = f"{site.check.text or site.name}: index {index} is outside: the array has {bound} elements"
            behind_it = f"the access goes to the next member, or behind the object that {site.name} points to"
            self.hit(site, "index", message, index, (behind_it, *_wrap(site, index)))
        return index

    def load(self, p: Pointer, words: int, number: int) -> Any:
        """`*(p + words)` as `site.ctype`."""
        site = self.sites[number]
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and (found[1] is site.ctype or found[1] == site.ctype):
                value = obj.data[found[0]]
                if value is not None:
                    return value
                return self._unwritten(site, obj, p.offset + words)
        return self._load_slow(p, words, site)

    def _unwritten(self, site: RuntimeSite, obj: Object, offset: int) -> Any:
        name = obj.declaration.path
        if obj.initial is not None:
            value = obj.initial
        else:
            value = self.fill_value(site.ctype, f"{name}+{offset}", obj.base + offset)
        part = part_name(obj.declaration.ctype, offset)
        message = f"{name}{part} is read through {site.name} before anything was written to it"
        if obj.declaration.line and not obj.declaration.function:
            message += _UNCLEARED
        if site.seen is None or site.generation != self.findings.generation:
            site.check.declaration = obj.declaration
        self.hit(site, "uninitialised", message, value)
        if self.fill == "trap" and obj.initial is None:
            raise UninitialisedRead(f"{message} ({obj.declaration})")
        return value

    def _load_slow(self, p: Pointer, words: int, site: RuntimeSite, ctype: CType | None = None) -> Any:
        ctype = ctype or site.ctype
        self.examine(p, words, site, "read", ctype)
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and obj.data[found[0]] is None:
                return self._unwritten(site, obj, p.offset + words)
            if obj.ended and self.memory.find(p.addr + words) is None and p.addr + words not in self.memory.words:
                value = obj.last(p.offset + words, ctype)
                if value is not None:
                    return value
        if obj is not None and not 0 <= p.offset + words < obj.words:
            return self.strayed_load(ctype, p.addr + words)
        return self.memory.load_through(p, words, ctype)

    def store(self, p: Pointer, words: int, value: Any, number: int) -> None:
        """`*(p + words) = value` as the type of the site."""
        site = self.sites[number]
        obj = p.obj
        if obj is not None and not obj.readonly:
            found = obj.leaf(p.offset + words)
            if found is not None and (found[1] is site.ctype or found[1] == site.ctype):
                obj.data[found[0]] = value
                return
        self._store(p, words, value, site)

    def _store(self, p: Pointer, words: int, value: Any, site: RuntimeSite) -> None:
        """Write something else than a plain scalar of the object that `p` was made from."""
        self.examine(p, words, site, "written")
        if p.obj is not None and not 0 <= p.offset + words < p.obj.words:
            self.strayed_store(site.ctype, p.addr + words, value)
        else:
            self.memory.store_through(p, words, site.ctype, value)

    def strayed_load(self, ctype: CType, addr: int) -> Any:
        """The value that an access outside of its object reads.  Findings of a register about it are muted."""
        muted, self.findings.muted = self.findings.muted, True
        try:
            return self.memory.load(ctype, addr)
        finally:
            self.findings.muted = muted

    def strayed_store(self, ctype: CType, addr: int, value: Any) -> None:
        """Write for an access outside of its object.  Findings of a register about it are muted."""
        muted, self.findings.muted = self.findings.muted, True
        try:
            self.memory.store(ctype, addr, value)
        finally:
            self.findings.muted = muted

    def examine(
        self, p: Pointer, words: int, site: RuntimeSite, verb: str, ctype: CType | None = None
    ) -> None:  # fmt: skip
        """Report an access through a pointer that is null, dangling, outside, read-only or odd."""
        ctype = ctype or site.ctype
        obj, addr = p.obj, p.addr + words
        if obj is None:
            if p.offset == 0:
                self._report_null(site, addr, verb)
        elif obj.ended and isinstance(obj, HeapBlock):
            self._report_freed(site, obj, addr, verb)
        elif obj.ended:
            where = obj.declaration
            message = f"{site.name} points to {where.path}, whose function has returned, and is {verb} through"
            lives = self.memory.find(addr)
            now = f"{lives.declaration.path} lies there now" if lives else "no local lies there at the moment"
            self.hit(site, "dangling-pointer", message, None, (f"address {addr:#x} of the stack: {now}",))
        elif not 0 <= p.offset + words < obj.words:
            if not self.counted(site, "pointer-outside"):
                self._report_outside(site, p, words, verb)
        elif isinstance(obj, HeapBlock) and p.offset + words + ctype.words > obj.words:
            if not self.counted(site, "pointer-outside"):  # it begins within a block and ends outside
                self._report_outside(site, p, obj.words - p.offset, verb)
        elif obj.readonly and verb == "written":
            message = f"{site.name} points to the constant {obj.declaration.path}: the write is lost"
            self.hit(site, "write-to-constant", message)
        if ctype.words == 2 and addr & 1:
            self.hit(site, "odd-access", f"{site.name}: a 32-bit access at odd address {addr:#x} uses {addr & ~1:#x}")

    def _report_freed(self, site: RuntimeSite, block: HeapBlock, addr: int, verb: str) -> None:
        """Report the use of a heap block after it was freed."""
        lies = self.memory.neighbour(addr)
        path = block.declaration.path
        message = f"{site.name} points to {path} ({block.words} words), given back {block.freed}, and is {verb} through"
        self.hit(site, "use-after-free", message, None, (f"what is {verb} instead: {lies}",))

    def examine_block(self, p: Pointer, function: str, verb: str) -> None:
        """Report a library function that reads or writes a block of an object that no longer exists."""
        if p.obj is None or not p.obj.ended:
            return
        key = (function, verb, p.obj)
        site = self.readers.get(key)
        if site is None:
            site = self.readers[key] = RuntimeSite(Site(NOWHERE, CHAR, f"what {function} is given"), 0)
        self.examine(p, 0, site, verb)

    def _report_null(self, site: RuntimeSite, addr: int, verb: str) -> None:
        """Report the use of a null pointer.  Every such finding lists all users of that cell so far."""
        calls = self.findings.position.calls
        way = (site, calls and calls[0])
        if way in self.null_ways and self.null_generation == self.findings.generation and self.counted(site):
            return  # this place was already reported for this caller
        self.null_ways.add(way)
        held = f"address {addr:#x} is M0 RAM, which holds {self.memory.load(site.ctype, addr)!r} as {site.ctype} now"
        self.hit(site, "null-dereference", f"{site.name} is NULL and is {verb} through: {held}", None, (held,))
        found = site.seen
        assert found is not None
        if self.null_generation != self.findings.generation:
            self.null_users, self.null_findings, self.null_generation = set(), [], self.findings.generation
        path = self.findings.here(2)
        caller = f", called in line {path[1].line} of {path[1].function}" if len(path) > 1 else ""
        user = f"{site.name}{caller}"
        if user in self.null_users and found in self.null_findings:
            return
        self.null_users.add(user)
        if found not in self.null_findings:
            self.null_findings.append(found)
        if len(self.null_users) > 1:
            users = "; ".join(sorted(self.null_users))
            for finding in self.null_findings:
                finding.details = (finding.details[0], f"null pointers that share this cell so far: {users}")

    def _report_outside(self, site: RuntimeSite, p: Pointer, words: int, verb: str) -> None:
        """Report the use of a pointer outside of the object that it was made from."""
        obj = p.obj
        assert obj is not None
        where = self.memory.neighbour(p.addr + words)
        distance = p.offset + words
        details = [f"what is {verb} instead: {where}"]
        if site.check.wraps and distance >= 0x7FFF:
            details.append(f"the unsigned {site.check.wraps} went below 0 and wrapped")
        found = obj.leaf(0)
        if site.ctype.name.endswith("char") and found is not None and not found[1].name.endswith("char"):
            details.append(f"a char is a word of 16 bits here: a {found[1]} is {found[1].words} of them, not octets")
        self.hit(
            site, "pointer-outside",
            f"{site.name} has left {obj.declaration.path} ({obj.words} words): word {distance} is {verb}, "
            f"which is {where}", distance, tuple(details),
        )  # fmt: skip

    def read_through(self, p: Pointer, index: int, ctype: CType, reader: str) -> Any:
        """Element `index` at `p`, for the library function `reader`.  A value that was never written is reported."""
        words = index * max(1, ctype.words)
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset + words)
            if found is not None and obj.data[found[0]] is not None:
                return self.memory.load_through(p, words, ctype)
        return self._load_slow(p, words, self._library_site(p, ctype, reader))

    def _library_site(self, p: Pointer, ctype: CType, function: str) -> RuntimeSite:
        site = self.readers.get((function, p.obj, p.target))
        if site is None:
            name = p.obj.declaration.path if p.obj is not None else f"the argument of {function}"
            site = self.readers[function, p.obj, p.target] = RuntimeSite(Site(NOWHERE, ctype, name), 0)
        return site

    def read_scalar(self, p: Pointer) -> Any:
        """`*p` for a function outside of the firmware."""
        obj = p.obj
        if obj is not None:
            found = obj.leaf(p.offset)
            if found is not None and (found[1] is p.target or found[1] == p.target):
                value = obj.data[found[0]]
                if value is not None:
                    return value
        return self.read_through(p, 0, p.target, "a library function")

    def write_scalar(self, p: Pointer, value: Any) -> None:
        """`*p = value` for a function outside of the firmware."""
        self._store(p, 0, value, self._library_site(p, p.target, "a library function"))

    def copy_struct(self, target: Pointer, source: Pointer, words: int, number: int) -> None:
        """`*target = *source` for whole structures.  Scalars that were never written stay so."""
        site = self.sites[number]
        for p, verb in ((source, "read"), (target, "written")):
            if p.obj is None or p.obj.ended or p.offset < 0 or p.offset + words > p.obj.words:
                self.examine(p, 0, site, verb)
        obj = source.obj
        local = obj is not None and obj.declaration.function and site.check.kind != "parameter"
        if obj is not None and local and obj.data and all(value is None for value in obj.data):
            path = obj.declaration.path
            self.hit(site, "uninitialised", f"{path} is copied before anything was written to it")
        self.memory.copy(target, source, words)

    def load_struct(self, p: Pointer, ctype: StructType, number: int) -> list[Any]:
        """The scalars of `*p`, a structure.  Scalars that were never written stay so."""
        if p.obj is None or p.obj.ended or p.offset < 0 or p.offset + ctype.words > p.obj.words:
            self.examine(p, 0, self.sites[number], "read")
        if self.watcher is not None:
            self.touch_block(p, ctype.words, False)
        copy = Object(Declaration("copy", ctype, "", "", 0), 0)
        self.memory.copy(Pointer(self.memory, copy, 0, ctype), p, ctype.words)
        return copy.data

    def store_struct(self, p: Pointer, values: list[Any], number: int) -> None:
        """Store these scalars as the structure `*p`."""
        ctype = p.target
        if p.obj is None or p.obj.ended or p.offset < 0 or p.offset + ctype.words > p.obj.words:
            self.examine(p, 0, self.sites[number], "written")
        if self.watcher is not None:
            self.touch_block(p, ctype.words, True)
        source = Object(Declaration("copy", ctype, "", "", 0), 0, values)
        self.memory.copy(p, Pointer(self.memory, source, 0, ctype), ctype.words)

    def load_bits(self, p: Pointer, words: int, lo: int, width: int, signed: bool, number: int) -> int:
        """Read a bit-field of the word (or pair of words) at `p + words`."""
        wide = ULONG if lo + width > 16 else UINT
        site = self.sites[number]
        value = self._load_slow(p, words, site, wide) >> lo & (1 << width) - 1
        return int(value - (1 << width) if signed and value >> width - 1 else value)

    def store_bits(self, p: Pointer, words: int, value: int, lo: int, width: int, number: int) -> None:
        """Write a bit-field; the other bits of its word do not change."""
        wide = ULONG if lo + width > 16 else UINT
        mask = (1 << width) - 1 << lo
        self.examine(p, words, self.sites[number], "written", wide)
        known = self.memory.load_through(p, words, wide)
        self.memory.store_through(p, words, wide, known & ~mask | value << lo & mask)

    def load_octet(self, p: Pointer, octet: int, number: int) -> int:
        """Read an octet of the words at `p`.  A byte peripheral has one address per octet."""
        if p.obj is None and self.memory.byte_registers:
            byte = self.memory.load_byte(p.addr + (octet >> 1) + (octet & 1))
            if byte is not None:
                return byte
        return self.load_bits(p, octet >> 1, 8 * (octet & 1), 8, False, number)

    def store_octet(self, p: Pointer, octet: int, value: int, number: int) -> None:
        """Write an octet; the other octet of its word does not change."""
        addr = p.addr + (octet >> 1) + (octet & 1)
        if p.obj is None and self.memory.byte_registers and self.memory.store_byte(addr, value):
            return
        self.store_bits(p, octet >> 1, value & 0xFF, 8 * (octet & 1), 8, number)

    def register(self, p: Pointer, words: int, bits: int, number: int) -> Any:
        """The register at word `words` of the block that `p` points to."""
        found = self._register_at(p.addr + words)
        if found is None:
            found = _BlockWord(self, p, words, ULONG if bits == 32 else UINT, self.sites[number])
        return found

    def callable(self, function: Any, number: int) -> Any:
        """The function that a pointer points to.  If it points to no function: report it and raise IllegalCall."""
        known = self.called_as.get((function, number))
        if known is not None:
            return known
        site = self.sites[number]
        if callable(function):
            return self._called(function, site)
        if isinstance(function, Pointer) and any(low <= function.addr < high for low, high in ROM):
            if function.addr not in TRIMS:
                message = f"the function at {function.addr:#x} of the ROM is not modelled: it does nothing here"
                self.hit(site, "unmodelled", message)
            return _nothing
        message = f"{site.name} is called, but it points to no function"
        self.hit(site, "null-dereference", message)
        raise IllegalCall(message)

    def _called(self, function: Any, site: RuntimeSite) -> Any:
        """A function, adapted to the type through which it is called."""
        known, wanted = self.signatures.get(function), site.ctype
        assert isinstance(wanted, FunctionType)
        if known is None or known.variadic or (known.parameters, known.result) == (wanted.parameters, wanted.result):
            self.called_as[function, site.number] = function
            return function
        why = misfit(known, wanted)
        if why:
            message = f"{site.name} points to {known.name}, which has another type: {why}"
            self.hit(site, "called-as-another", message)
            return fitted(function, known, wanted)
        self.called_as[function, site.number] = made = fitted(function, known, wanted)
        return made

    def address(self, p: Pointer, words: int, target: CType) -> Pointer:
        """The pointer `p + words` with the target type `target`."""
        return Pointer(self.memory, p.obj, p.offset + words, target)

    def code(self, value: Any) -> int:
        """A pointer to a function, or the value of a `void *`, as a number."""
        return value.addr if isinstance(value, Pointer) else self.memory.code_address(value)

    def function_at(self, value: Any) -> Any:
        """A number or a pointer, converted to a pointer to a function."""
        if not isinstance(value, int | Pointer):
            return value
        address = value if isinstance(value, int) else value.addr
        return self.memory.code_at(address) or Pointer(self.memory, None, address & 0xFFFFFFFF, VOID)

    def cast(self, value: Any, target: CType) -> Any:
        """A pointer conversion."""
        if not isinstance(value, Pointer) and isinstance(target, PointerType) and target.target != VOID:
            return Pointer(self.memory, None, self.memory.code_address(value), target.target)
        if isinstance(value, Pointer) and isinstance(target, PointerType) and value.target != target.target and value:
            return Pointer(self.memory, value.obj, value.offset, target.target)
        return value

    def pointer_at(self, addr: int, target: PointerType) -> Pointer:
        """An integer converted to a pointer."""
        return Pointer(self.memory, None, addr & 0xFFFFFFFF, target.target)

    def enter(self, declaration: Declaration, data: list[Any], base: int) -> Pointer:
        """Make a pointer to a local of the running function; its address is taken."""
        obj = Object(declaration, base, data)
        self.memory.live_locals.append(obj)
        ctype = declaration.ctype
        return Pointer(self.memory, obj, 0, ctype.element if isinstance(ctype, ArrayType) else ctype)

    def retire(self, p: Pointer) -> None:
        """The function of a local returns: pointers to the local dangle from now on."""
        obj = p.obj
        assert obj is not None
        self.memory.live_locals.remove(obj)
        obj.end()

    def given(self, *arguments: tuple[CType, Any]) -> Pointer:
        """Push the extra arguments of a call of a variadic function: (type, value) of each."""
        block = ArgumentBlock(self.memory, self.cpu.sp + 1 & ~1, arguments)
        self.memory.place_block(block)
        return Pointer(self.memory, block, 0, CHAR)

    def taken(self, result: Any, given: Pointer) -> Any:
        """The call has returned: remove its extra arguments."""
        assert given.obj is not None
        given.obj.end()
        return result

    def unwind(self, sp: int) -> None:
        """Clean up after an exception that has ended the functions above `sp` on the stack without their epilogues."""
        live = self.memory.live_locals
        ended = [obj for obj in live if sp <= obj.base < self.cpu.sp]
        live[:] = [obj for obj in live if obj not in ended]
        for obj in ended:
            obj.end()
        self.cpu.sp = sp

    # Accesses for a watcher (only in images linked with `watch`)

    def touch(self, obj: Object, offset_words: int, write: bool) -> None:
        """The running function is about to read or write the scalar at word `offset_words` of `obj`.

        `obj` is a file-scope object, or a local whose address was taken.
        """
        if self.watcher is not None:
            self.watcher.touch(obj, offset_words, write)

    def touch_block(self, p: Pointer, words: int, write: bool) -> None:
        """`touch` for every scalar that begins in the `words` words at `p` (a structure, `memcpy`)."""
        obj, watcher = p.obj, self.watcher
        if obj is None or watcher is None:
            return
        for offset in range(max(p.offset, 0), min(p.offset + words, obj.words)):
            if obj.leaf(offset) is not None:
                watcher.touch(obj, offset, write)

    def watched_load(self, p: Pointer, words: int, number: int) -> Any:
        """`load`, with a call of the watcher."""
        if p.obj is not None:
            self.touch(p.obj, p.offset + words, False)
        return self.load(p, words, number)

    def watched_store(self, p: Pointer, words: int, value: Any, number: int) -> None:
        """`store`, with a call of the watcher."""
        site = self.sites[number]
        obj = p.obj
        if obj is not None:
            self.touch(obj, p.offset + words, True)
            if isinstance(value, float) and not isfinite(value) and not obj.declaration.function:
                self.not_finite(value, site, obj.declaration.path)
        self.store(p, words, value, number)

    def watched_copy_struct(self, target: Pointer, source: Pointer, words: int, number: int) -> None:
        """`copy_struct`, with calls of the watcher."""
        self.touch_block(source, words, False)
        self.touch_block(target, words, True)
        self.copy_struct(target, source, words, number)

    # Arithmetic

    def overflow(self, value: int, number: int) -> int:
        """A signed result that does not fit its type: report it, and wrap it as the hardware does (OVM = 0)."""
        site = self.sites[number]
        ctype = site.integer
        wrapped = ctype.wrap(value)
        if site.check.kind == "shift" and not site.check.widened and 0 <= value <= 2 * ctype.high + 1:
            return wrapped  # a bit was shifted into the sign bit, as in every mask for bit 15; no bit is lost
        message = f"{site.name} is {value}, which does not fit a {ctype.bits}-bit {ctype}: it becomes {wrapped}"
        details: tuple[str, ...] = ()
        if site.check.widened:
            wider = site.check.widened
            late = f"{site.name} is computed in {ctype.bits} bits and widened to {wider} afterwards: {wrapped}"
            details = (f"the result is converted to {wider} only after it lost its upper bits",)
            if not self.counted(site):
                self.findings.report(
                    "widened-late", f"{late} instead of {value}", object=site.name, value=value,
                    declaration=str(site.check.declaration or ""), at=site.number,
                )  # fmt: skip
        self.hit(site, "overflow", message, value, details)
        return wrapped

    def wrapped(self, value: int, number: int) -> int:
        """An unsigned result that wrapped where no wrap is intended; `value` is the mathematical result.

        A difference of two variables that wraps to a small number gives no finding: elapsed counts are computed so.
        """
        site = self.sites[number]
        ctype = site.integer
        result = ctype.wrap(value)
        if site.check.difference and value < -(ctype.high // 2 + 1):
            return result
        if site.check.kind == "stamps" and value >= -0x8000:
            return result  # less than half of the range of 16 bits: the number has decreased
        became = f"the unsigned {site.name} is {value}, which wraps to {result}"
        match site.check.rule:
            case "widened-late":
                message = f"{became} in {ctype.bits} bits before it is converted to {site.check.widened}"
            case "sign-compare":
                message = f"{site.name} is {value} and is compared as unsigned: it counts as {result}"
            case "unsigned-wrap-index":
                message = f"{became} and then selects an element"
            case _:
                message = f"{became} and then {site.check.widened}"
        self.hit(site, site.check.rule, message, value)
        return result

    def stamps(self, a: int, op: str, b: int, number: int) -> bool:
        """Compare two stamps of a free-running counter directly; report it once the counter has wrapped."""
        site = self.sites[number]
        ctype = site.integer
        half = ctype.high // 2 + 1
        outcome = COMPARE[op](a, b)
        if site.check.kind == "equal, left":
            a, b = b, a
        apart = (a - b + half) % (2 * half) - half
        if site.check.kind != "order":
            # By awaited stamp: whether it was still in the future at the previous test.
            before = site.ahead.get(b)
            if before is not None and before < 0 < apart < half // 2:
                message = f"{site.name}: they were equal {apart} counts ago, between two tests"
                self.hit(site, "stamp-compare", f"{message}; the next time is {2 * half} counts later", a)
            if len(site.ahead) > _STAMPS:
                site.ahead.clear()
            site.ahead[b] = apart
            return bool(outcome)
        last_a, last_b = site.last
        site.turned = site.turned or last_a - a > half or last_b - b > half
        site.last = (a, b)
        if site.turned and outcome != COMPARE[op](apart, 0):
            message = f"{site.name}: {a} {op} {b} is {'true' if outcome else 'false'}, but the counter has wrapped"
            self.hit(site, "stamp-compare", f"{message} between the two, which are {apart} counts apart", a)
        return bool(outcome)

    def extended(self, left: int, right: int, op: str, number: int) -> bool:
        """Compare a 32-bit number with one that is cut to an `int` first; report it if that makes it negative."""
        site = self.sites[number]
        ctype = site.integer
        whole, other = (left, right) if site.check.kind == "left" else (right, left)
        cut = ctype.wrap(whole)
        outcome = bool(COMPARE[op](cut, other))
        if cut != whole == other:
            taken = f"is {str(outcome).lower()} for {whole}, which as an {ctype} is {cut}"
            self.hit(site, "sign-extended", f"{site.name} {taken}: the other side is {other}", whole)
        return outcome

    def past(self, value: int, number: int) -> int:
        """The signed time since a stamp is below 0: more than half of the counter's range has passed."""
        site = self.sites[number]
        ctype = site.integer
        if value < ctype.low // 8:  # a smaller difference may be a stamp that an interrupt has just renewed
            message = f"{site.name} is {value % (2 * ctype.high + 2)} counts, which a signed {ctype} takes for {value}"
            self.hit(site, "stamp-compare", message, value)
        return value

    def narrowed(self, value: int, number: int) -> int:
        """A `long` that is converted to an `int` without a cast and does not fit."""
        site = self.sites[number]
        ctype = site.integer
        kept = ctype.wrap(value)
        message = f"{site.name} is {value}, which does not fit a {ctype.bits}-bit {ctype}: it becomes {kept}"
        self.hit(site, "narrowed", message, value)
        return kept

    def fields(self, value: int, terms: list[int], number: int) -> int:
        """An OR of shifted fields, of which two have a bit in common."""
        site = self.sites[number]
        ctype = site.integer
        mask = (1 << ctype.bits) - 1
        for lower, upper in site.check.dimensions:
            common = terms[lower] & terms[upper] & mask
            if common:
                low, high = site.check.constants[lower][1], site.check.constants[upper][1]
                message = f"{low} is {terms[lower] & mask:#x}: its bits {common:#x} are also those of {high}"
                self.hit(site, "fields-overlap", f"{message}, which is {terms[upper] & mask:#x}", value)
                break
        return value

    def parsed(self, value: int, number: int) -> int:
        """The result of an `atoi` that is widened: the text may hold a larger number."""
        whole = self.parsed_number
        if whole != value:
            site = self.sites[number]
            message = f"{site.name} has read {whole}, which does not fit an int: it becomes {value}, and then"
            self.hit(site, "widened-late", f"{message} a {site.check.widened}", whole)
        return value

    def pulse(self, value: int, number: int) -> int:
        """A time between two captures, of which an object keeps 16 bits, or that object where it is used wider."""
        site = self.sites[number]
        if site.check.kind == "cut":
            self.cut_pulses.pop(site.check.text, None)
            if value > 0xFFFF:
                self.cut_pulses[site.check.text] = site, value
        elif site.check.text in self.cut_pulses:
            cut, whole = self.cut_pulses.pop(site.check.text)
            self.wrong_pulses += value == whole & 0xFFFF  # else it has another value by now
            if value == whole & 0xFFFF and self.wrong_pulses >= WRONG_PULSES:
                kept = f"{site.check.text} keeps {value} of it, which is used as a wider number then"
                self.hit(cut, "widened-late", f"{cut.name} is {whole}: {kept}", whole)
        return value

    def regulated(self, value: int, number: int) -> int:
        """A part of a regulator that computes with integers."""
        self._regulate(float(value), number)
        return value

    def regulated_float(self, value: float, number: int) -> float:
        """A part of a regulator that computes with floats."""
        self._regulate(value, number)
        return value

    def _regulate(self, value: float, number: int) -> None:
        """Report an integral that goes on growing while the output stands at its limit."""
        site = self.sites[number]
        state = self.regulators.get(site.check.regulator)
        if state is None:
            state = self.regulators[site.check.regulator] = RegulatorState()
        if site.check.kind == "sum":
            state.sum_at = number
        elif site.check.kind == "share":
            state.share, state.side = value * site.check.scale, site.check.side
        elif site.check.kind == "output":
            state.output = value
        elif state.output is not None:
            output, state.output = state.output, None
            if output == value or not state.sum_at:
                return
            side = "high" if output > value else "low"
            state.moving = state.moving or state.limits.get(side, value) != value
            state.limits[side] = value
            state.met += 1
            if state.moving or state.met < _MET:
                return
            span = abs(state.limits.get("high", 0.0) - state.limits.get("low", 0.0))
            beyond = state.share - value if side == "high" else value - state.share
            if side in state.side and 0.0 < span < beyond * _SPANS:
                at = self.sites[state.sum_at]
                message = f"{at.name} goes on while the output stands at its limit {value:g}"
                share = f"its share is {state.share:g}, and must come back before the output moves"
                self.hit(at, "wind-up", f"{message}: {share}", value)

    def quantity(self, value: int, number: int) -> int:
        """A number that does not fit the register field to which it is written."""
        site = self.sites[number]
        bound = site.check.bound
        message = f"{site.check.text} holds 0 to {bound}: {site.name} is {value}, and arrives as {value & bound}"
        self.hit(site, "register-value", message, value)
        return value

    def sign_lost(self, value: int, number: int) -> int:
        """A negative number that is converted to unsigned."""
        site = self.sites[number]
        if site.check.kind == "small" and value < SMALL:
            return value
        ctype = site.integer
        taken = value & (1 << ctype.bits) - 1
        message = f"{site.name} is {value}: taken as unsigned it is {taken}, which {site.check.widened}"
        self.hit(site, "sign-lost", message, value)
        return value

    def signed_word(self, value: int, number: int) -> int:
        """An unsigned word or octet whose highest bit is set, which the source takes for a sign."""
        site = self.sites[number]
        meant = value - 2 * (site.check.bound + 1)
        message = f"{site.name} is {value}, as its highest bit is no sign here: {meant} is meant, {site.check.widened}"
        self.hit(site, "sign-lost", message, value)
        return value

    def gone_back(self, value: int, number: int) -> int:
        """A difference of 32 bits that is just below 0, and of which 16 bits without a sign are kept."""
        site = self.sites[number]
        gone, kept = value - 0x1_0000_0000, value & 0xFFFF
        message = f"{site.name} is {gone}: as 16 bits without a sign it is {kept}, which {site.check.widened}"
        self.hit(site, "sign-lost", message, gone)
        return value

    def shifted_sign(self, value: int, number: int) -> int:
        """A signed shift register whose highest bit is set, where it is shifted to the right."""
        site = self.sites[number]
        ctype = site.integer
        bits = f"{value & 2 * ctype.high + 1:#x}"
        message = f"{site.name} holds the bits {bits}, as an {ctype} {value}: {site.check.widened}"
        self.hit(site, "sign-extended", message, value)
        return value

    def word_of_24(self, value: int, number: int) -> int:
        """A word of three octets that becomes signed: report the second value just below 0 after three just above it.

        All ones are what a line without a part reads.  A counter that counts up never steps so.
        """
        site = self.sites[number]
        above, below = site.last
        site.turned = site.turned or not 0 <= value <= _ALL_24
        if value < _NEAR:
            above, below = above + 1, 0
        elif _ALL_24 - _NEAR < value < _ALL_24 and above >= _BEFORE:
            below += 1
        else:
            above = below = 0
        site.last = above, below
        if below > 1 and not site.turned:
            meant = value - _ALL_24 - 1
            message = f"{site.name} is {value}: bit 23 is its sign, {meant} is meant, and it {site.check.widened}"
            self.hit(site, "sign-lost", message, value)
        return value

    def error_side(self, value: int, wanted: int, number: int) -> int:
        """An error of a regulator that may have the wrong sign, an integer, and the wanted value."""
        self._follow_error(float(value), float(wanted), number)
        return value

    def error_side_float(self, value: float, wanted: float, number: int) -> float:
        """An error of a regulator that may have the wrong sign, a float, and the wanted value."""
        self._follow_error(value, wanted, number)
        return value

    def _follow_error(self, value: float, wanted: float, number: int) -> None:
        """Report an error that has stayed on one side of 0, and has not become smaller since it came there."""
        self._follow_away(value, wanted, self.sites[number])
        site = self.sites[number]
        passes = site.passes + 1 if value * site.first > 0 else 0
        if not passes:
            site.first = value
        site.passes = passes
        if passes >= _ONE_SIDE and abs(value) >= abs(site.first):
            same = f"{site.name} has had the same sign for {passes} passes, now {value:.7g}"
            message = f"{same}: it is {site.check.widened}"
            self.hit(site, "feedback-reversed", message, value)

    def _follow_away(self, value: float, wanted: float, site: RuntimeSite) -> None:
        """Report an error that has grown while the wanted value stood, and is greater than this value by far."""
        away = value * site.least > 0 and abs(value) >= abs(site.least) and wanted == site.wanted
        site.turns = site.turns + 1 if away else 0
        if not away:
            site.least, site.wanted = value, wanted
        far = max(_AWAY * abs(site.least), _BEYOND * abs(wanted))
        if site.turns >= _ONE_SIDE and wanted and abs(value) >= far:
            grown = f"{site.name} has grown from {site.least:.7g} to {value:.7g} in {site.turns} passes"
            message = f"{grown}, while the wanted value stood at {wanted:.7g}: it is {site.check.widened}"
            self.hit(site, "runs-away", message, value)

    def fraction(self, value: float, number: int) -> float:
        """A float that a cast makes an integer before it is multiplied by a scale."""
        site = self.sites[number]
        if abs(value) < _WHOLE and int(value * site.check.scale) != int(value) * int(site.check.scale):
            message = f"{site.name} is {value:.7g}, and {int(value)} in front of the factor {site.check.scale:g}"
            became = f"{int(value) * int(site.check.scale)} instead of {int(value * site.check.scale)}"
            self.hit(site, "remainder-lost", f"{message}: {became}", value)
        return value

    def no_case(self, value: int, number: int) -> None:
        """A switch over an enumeration, without default, has no case for a value."""
        site = self.sites[number]
        name = dict(site.check.constants).get(value)
        if name is not None:
            self.hit(site, "no-case", f"{site.name} is {name}, which has no case: {site.check.text}", value)
        elif (not site.check.constants or site.check.word) and value > site.check.word and value not in NOBODY:
            least, most = site.check.word, site.check.bound
            named = f"{least} to {most}" if least != most else f"up to {most - 1}"
            message = f"{site.name} is {value}, no constant of its enumeration ({named}): it has no case"
            self.hit(site, "no-case", message, value)
            self.caseless[site.check.where] = self.findings.generation

    def octet(self, value: int, number: int) -> int:
        """A value that does not fit an octet is converted to a character, which has 16 bits here."""
        site = self.sites[number]
        ctype = site.integer
        kept = ctype.wrap(value)
        octet = value & 0xFF
        if site.check.kind == "sign" or ctype.name == "signed char":
            octet -= 0x100 if octet > 0x7F else 0
            message = f"{site.name} is {value}: a 16-bit {ctype} has no sign there, where 8 bits would give {octet}"
        else:
            message = f"{site.name} is {value}: a 16-bit {ctype} holds {kept}, where 8 bits would hold {octet}"
        self.hit(site, "octet", message, value)
        return kept

    def quotient(self, a: int, b: int, number: int) -> int:
        """An integer quotient that is converted to float, or scaled, only after its remainder was lost."""
        site = self.sites[number]
        result = self.divide_ints(a, b, number)
        site.fine = site.fine or abs(result) >= _FINE
        if b and a % b and not site.fine:
            then = "is scaled" if site.check.widened == "scaled" else "is converted to float"
            message = f"{site.name}: {a} / {b} is {result} in integers, and {then} only afterwards"
            self.hit(site, "remainder-lost", message, a)
        return result

    # Floats (the first two only in watched images)

    def float_result(self, a: float, b: float, result: float, number: int) -> float:
        """A NaN or an infinity as the result of an operation on finite floats: report it where it arises."""
        if isfinite(a) and isfinite(b):
            site = self.sites[number]
            self.hit(site, "nan", f"{site.name} gives {result!r} for {a!r} and {b!r}", result)
        return result

    def float_out(self, value: float, number: int) -> float:
        """A float that goes to a file-scope object or to an external function: report a NaN or an infinity."""
        site = self.sites[number]
        if not isfinite(value):
            self.not_finite(value, site, site.name)
        return value

    def float_to_int(self, value: float, number: int) -> int:
        """Truncate toward zero.  Outside of the range of the type, report it; the policy decides the result."""
        site = self.sites[number]
        ctype = site.integer
        low, high = ctype.low, ctype.high
        if low - 1.0 < value < high + 1.0 or value == low:  # `low - 1.0` is `low` for 64 bits
            return int(value)
        result = self.to_int(value, low, high)
        message = f"{site.name} is {value!r}, outside the range of a {ctype}: it becomes {result}"
        self.hit(site, "float-to-int", message, value)
        return result

    def float_argument(self, value: float, number: int) -> int:
        """A float that is passed for an integer parameter.  The largest one is kept for `finish`."""
        site = self.sites[number]
        if abs(value) > abs(site.greatest):
            site.greatest = value
        return self.float_to_int(value, number)

    def finish(self) -> None:
        """At the end of a run, report calls where the largest float passed for an integer lost more than a tenth."""
        for number, site in list(self.sites.items()):
            value = site.greatest
            if 1 <= abs(value) < _FEW and abs(value - int(value)) > abs(value) / _FEW:
                message = f"{site.name} is passed for an integer: at most {value:g} came, of which {int(value)} arrives"
                place = self.findings.places[number]
                self.findings.report_at(
                    place, "float-argument", message, how="dynamic", object=site.name, value=value
                )  # fmt: skip

    def divide_floats(self, a: float, b: float, number: int) -> float:
        """Float division by the selected divider."""
        site = self.sites[number]
        if b == 0.0:
            self.hit(site, "division-by-zero", f"{site.name}: {a!r} is divided by zero", a)
        return self.divide(a, b)

    def divide_doubles(self, a: float, b: float, number: int) -> float:
        """Division of floats of 64 bits: always that of the run-time library, which is IEEE's."""
        site = self.sites[number]
        if b == 0.0:
            self.hit(site, "division-by-zero", f"{site.name}: {a!r} is divided by zero", a)
        return divide_double(a, b)

    def divide_ints(self, a: int, b: int, number: int) -> int:
        """Integer division.  By zero it does not trap (CHOICE: all ones, the result of the SUBCU loop)."""
        site = self.sites[number]
        ctype = site.integer
        if b == 0:
            self.hit(site, "division-by-zero", f"{site.name}: {a} is divided by zero", a)
            return ctype.wrap(-1)
        quotient = divide_int(a, b)
        return quotient if quotient <= ctype.high else self.overflow(quotient, number)

    def modulo_ints(self, a: int, b: int, number: int) -> int:
        """Remainder.  By zero it is the dividend (CHOICE)."""
        site = self.sites[number]
        ctype = site.integer
        if b == 0:
            self.hit(site, "division-by-zero", f"{site.name}: {a} modulo zero", a)
            return a
        return ctype.wrap(modulo_int(a, b))

    def shift(self, op: str, a: int, count: int, number: int) -> int:
        """A shift by a variable count.  A count outside 0..width-1 is undefined: report it; the result is 0.

        CHOICE: the golden vectors of Read_Channel require 0 (`1 << 16`).  If the compiler uses the shift instructions,
        they take the lowest bits of the count, T(3:0) or T(4:0) (SPRU430 table 2-11).
        """
        site = self.sites[number]
        ctype = site.integer
        if not 0 <= count < ctype.bits:
            self.hit(site, "shift-range", f"{site.name} shifts a {ctype.bits}-bit value by {count}", count)
            return 0
        if op == ">>":
            return a >> count
        shifted = a << count
        if ctype.signed and not ctype.low <= shifted <= ctype.high:
            return self.overflow(shifted, number)
        return ctype.wrap(shifted)

    # Time

    def poll(self, number: int, until: int) -> int:
        """A poll has no more events, or lasts too long: raise, or report it and return the next time limit."""
        site = self.sites[number]
        clock = self.clock
        if self._blames_unmodelled(site.name):
            self._in_vain.add(number)
            return clock.now + self.unmodelled_wait
        if number in self._in_vain and clock.now > until:
            self._in_vain.remove(number)
            return clock.now + self.poll_limit  # something else may end it
        if clock.now <= until:
            message = f"{site.name} is polled, but no event is left that could change it: the loop never ends"
            self.hit(site, "endless-poll", message)
            raise EndlessPoll(message)
        limit_s = self.poll_limit / CYCLES_PER_US / 1e6
        self.hit(site, "endless-poll", f"{site.name} has been polled for {limit_s:g} s without an end")
        return clock.now + self.poll_limit

    def busy(self) -> None:
        """A function that an idle turn may call does what none does."""
        self._busy = self.clock.now

    def turn(self, began: int, until: int) -> None:
        """A turn of a loop that began at `began` has changed nothing (pass `idle_turns`).

        If no event came in it or was scheduled, no interrupt was taken, and the turn before it was such a one too, the
        next ones are the same.
        Time skips those that end before the next event, and before `until`: behind that time each turn begins with
        `endless`.  If this one did, and went on without a word, so do the next ones.
        """
        if not self.skips_turns or self._busy >= began:
            return
        clock = self.clock
        same = int(clock.next), int(clock.scheduled), self.cpu.taken, self.findings.occurrences
        if self._idle_turn == (began, *same):
            clock.skip_turns(clock.now - began, NEVER if began > until else until)
        self._idle_turn = (clock.now, *same)

    def idle(self, number: int) -> None:
        """An endless loop without a body has no more events to wait for: raises Idling."""
        place = self.findings.places[number]
        raise Idling(f"{place} idles for ever, and no event is left that could interrupt it")

    def endless(self, number: int) -> None:
        """A loop that reads no register, and calls nothing that does, has computed for too long.

        A task continues, as on the chip, because other tasks still run.  An endless loop of a `main` that the host runs
        in slices of time also continues: the program runs it between its interrupts.  Elsewhere outside of tasks, the
        call would never return: raises EndlessPoll.
        """
        site = self.sites[number]
        context = self.findings.context()
        if site.check.kind == "idle" and context == "main" and self._driven():
            return
        alone = context.startswith(("main", "Isr:"))
        if not alone and self.counted(site, "endless-loop"):
            return
        limit_s = self.loop_limit / CYCLES_PER_US / 1e6
        message = f"the loop over '{site.name}' has run for {limit_s:g} s, and nothing that it does can end it"
        self.hit(site, "endless-loop", message)
        if alone:
            raise EndlessPoll(message)

    def stack_check(self, number: int) -> None:
        """Report a stack pointer beyond the part of the current stack that functions may use."""
        place = self.findings.places[number]
        self.findings.report(
            "stack-overflow",
            f"{place.function}: the stack pointer {self.cpu.sp:#x} has passed {self.cpu.stack_limit:#x}: "
            "behind that this stack ends, or has no room left for an interrupt", at=number,
            object=self.findings.context(), value=self.cpu.sp,
        )  # fmt: skip


def called_names(*, watch: bool) -> dict[str, str]:
    """The names that generated code has for the methods of `Runtime`, with these; `watch`: accesses are watched."""
    methods = [name for name, value in vars(Runtime).items() if callable(value) and not name.startswith("_")]
    return {f"_c_{name}": f"watched_{name}" if watch and f"watched_{name}" in methods else name for name in methods}
