"""What every slow path of generated code shares: places that report, policies, and what never-written objects hold."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Final, Protocol

from emulator.c28x.arithmetic import DIVIDERS, FLOAT_TO_INT
from emulator.c28x.ctypes import ArrayType, CType, FloatType, IntType, StructType, part_name, scalars
from emulator.c28x.findings import Finding, Findings
from emulator.c28x.memory import NULL, Memory, Object, Pointer, from_words
from emulator.c28x.tree import Declaration, Function
from emulator.clock import CYCLES_PER_US, Clock

#: A loop that only computes takes milliseconds; this is for those that never end.
LOOP_LIMIT_S: Final = 0.2
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
        "at", "bound", "ctype", "declaration", "difference", "dimensions", "empty_at", "filled", "frame", "generation",
        "initial", "kind", "name", "planted", "rule", "seen", "text", "widened", "word", "wraps", "zero",
    )  # fmt: skip

    def __init__(
        self, ctype: CType, declaration: Declaration | None, name: str, bound: int = 0, text: str = ""
    ) -> None:
        #: The number of the place; 0: where the firmware stands.
        self.at = 0
        self.ctype = ctype
        self.declaration = declaration
        self.name = name
        self.bound = bound
        #: As it stands in the source.
        self.text = text
        self.seen: Finding | None = None
        self.generation = -1
        #: What a word that is 0 gives, and the address found last where nothing is and never will be.
        self.zero = zero_of(ctype)
        self.empty_at = -1
        #: Tests: the value this object starts from, shared by all sites of the object; cells outside it.
        self.initial: dict[str, Any] = {}
        self.planted: dict[int, Any] = {}
        #: Element of an array: (length, stride in words) of each subscript, the word within the innermost element.
        self.dimensions: tuple[tuple[int, int], ...] = ()
        self.word = 0
        #: Element of a local: its function, and the word of its frame at which the array begins.
        self.frame: tuple[Function, int] | None = None
        #: The unsigned index expression, if it can have wrapped.
        self.wraps = ""
        #: Arithmetic: the wider type that the result is converted to; the rule that a wrap breaks.
        self.widened = ""
        self.rule = ""
        #: "shift" or "sign": what a result out of range is about.
        self.kind = ""
        #: An unsigned difference of two variables.
        self.difference = False
        #: What a never-written object holds here (the policies that do not depend on the place).
        self.filled: list[Any] | None = None


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


class RuntimeBase(ABC):
    """Policies and reports of one image."""

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
        #: Objects that hold what another policy says, by path: {"us.Read_Distance.result": parse_fill("ones")}.
        self.fill_of: dict[str, tuple[str, int]] = {}
        self.divide = DIVIDERS[divide]
        self.to_int = FLOAT_TO_INT[float_to_int]
        #: How long a loop may compute without calling anything, in cycles.
        self.loop_limit = int(LOOP_LIMIT_S * 1_000_000 * CYCLES_PER_US)
        self.poll_limit = int(poll_limit_s * 1_000_000 * CYCLES_PER_US)
        #: Told of every access in an image linked with `watch`: the object, the word within it, whether it is written.
        self.on_touch: Callable[[Object, int, bool], None] | None = None
        #: Places of library functions that read or write through a pointer.
        self.readers: dict[Any, Site] = {}
        #: Who has gone through a null pointer so far, and the findings that tell of it.
        self.null_users: set[str] = set()
        self.null_findings: list[Finding] = []
        self.null_generation = -1
        #: Where a NaN or an infinity has been seen to arrive.
        self.not_finite_at: set[str] = set()
        self.not_finite_generation = -1
        memory.fill_word, memory.fill_scalar = self.fill_word, self.fill_scalar
        memory.read_scalar, memory.write_scalar = self.read_scalar, self.write_scalar

    @abstractmethod
    def read_scalar(self, p: Pointer) -> Any:
        """`*p` for a function outside of the firmware."""

    @abstractmethod
    def write_scalar(self, p: Pointer, value: Any) -> None:
        """`*p = value` for a function outside of the firmware."""

    # Reports

    def again(self, site: Site) -> bool:
        """Whether `site` has been reported; if so, this pass counts."""
        if site.seen is None or site.generation != self.findings.generation:
            return False
        site.seen.count += 1
        return True

    def counted(self, site: Site, rule: str) -> bool:
        """Whether `rule` has been reported at `site`; if so, this pass counts."""
        seen = site.seen
        if seen is None or seen.rule != rule or site.generation != self.findings.generation:
            return False
        seen.count += 1
        return True

    def hit(self, site: Site, rule: str, message: str, value: Any = None, details: tuple[str, ...] = ()) -> None:
        """Report at `site`; later passes of the same site only count."""
        if self.counted(site, rule):
            return
        shown = value if isinstance(value, int | float) else None
        site.seen = self.findings.report(
            rule, message, object=site.name, declaration=str(site.declaration or ""), value=shown, details=details, at=site.at,
        )
        site.generation = self.findings.generation

    def not_finite(self, value: float, site: Site, where: str) -> None:
        """NaN or infinity has come to `where`: the first time there is reported."""
        if self.not_finite_generation != self.findings.generation:
            self.not_finite_at, self.not_finite_generation = set(), self.findings.generation
        if where not in self.not_finite_at:
            self.not_finite_at.add(where)
            self.hit(site, "nan-output", f"{value!r} reaches {where}", value)

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
        """A never-written scalar of type `ctype`; `key` is its object's path and `+word`.

        `addr` is where it lies, for the policy `stack`.
        """
        fill, seed = self.fill_of.get(key.partition("+")[0], (self.fill, self.seed))
        if fill == "zero" or not isinstance(ctype, IntType | FloatType):
            return zero_of(ctype)
        if fill == "stack" and addr is not None:
            return from_words([self.memory.words.get(addr + i, 0) for i in range(ctype.words)], ctype, self.memory)
        if fill == "random":
            bits = random.Random(f"{seed}:{key}").getrandbits(32)
        else:
            nan = 0x7FC07FC0 if isinstance(ctype, IntType) else 0x7FC00000
            bits = {"ones": 0xFFFFFFFF, "nan": nan}.get(fill, 0)
        return from_words((bits & 0xFFFF, bits >> 16), ctype, self.memory)

    def fill_scalar(self, obj: Object, offset: int, ctype: CType) -> Any:
        """What the never-written scalar at word `offset` of an object holds."""
        return self.fill_value(ctype, f"{obj.declaration.path}+{offset}", obj.base + offset)

    def filled(self, site: Site) -> list[Any]:
        """The scalars of a never-written object, for code that keeps no shadow."""
        if site.filled is None:
            site.filled = [self.fill_value(t, f"{site.name}+{o}") for o, t in scalars(site.ctype)]
        return site.filled[:]

    def uninit(self, site: Site, word: int = 0, addr: int | None = None) -> Any:
        """A read of an object that nobody has written; `word` is the place within it."""
        seen = site.seen
        if (
            seen is not None
            and site.generation == self.findings.generation
            and self.fill == "zero"
            and not self.fill_of
        ):
            seen.count += 1
            return site.initial.get("value", site.zero)
        declaration = site.declaration
        part = ""
        if declaration is not None and isinstance(declaration.ctype, ArrayType | StructType):
            part = part_name(declaration.ctype, word)
        message = f"{site.name}{part} is read before anything was written to it"
        if "value" in site.initial:
            value = site.initial["value"]
        else:
            if self.fill == "trap":
                self.hit(site, "uninitialised", message)
                raise UninitialisedRead(f"{message} ({declaration})")
            value = self.fill_value(site.ctype, f"{site.name}+{word}", addr)
        details = (f"it is read as {site.text}",) if part and site.text else ()
        self.hit(site, "uninitialised", message, value, details)
        return value

    def stale(self, site: Site, old: Any, word: int = 0, addr: int | None = None) -> Any:
        """A read of a local whose block has been entered again: its words are still those of the turn before."""
        value = self.uninit(site, word, addr)
        return value if old is None else old
