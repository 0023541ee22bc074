"""Finds widths of pulses that an eCAP does not measure as it is set up.

    ECap1Regs.ECCTL1.bit.CAP1POL = 0;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;
    ECap1Regs.ECCTL1.bit.CAP2POL = 0;       // falling: it is 1 that means so
    ...
    width = ECap1Regs.CAP2;                 // from one rising edge to the next: a period

Without `CTRRST1`, CAP2 alone is no time between two edges either: it is the count since the counter began.

What a program wants, names say (`echoTicks`, `ancho`, `pulseWidth`), or a comment beside `CAP1POL` and `CAP2POL` that
says the other edge.  Only CAP1 and CAP2 are followed: a program that takes CAP3 or CAP4 too can reckon otherwise.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.passes.stamps import CAPTURES, Key, Stamps, key_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Const,
    Expr,
    Function,
    Load,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
)
from emulator.c28x.tree_queries import bare, gives, own_nodes, statements
from emulator.chip import Chip
from emulator.registers.ecap import ECCTL1, ECCTL2
from hil.drivers.hardware_counts import counter_at, field
from hil.drivers.unit_names import words_of
from hil.drivers.units import UnitMismatch

#: Words of names that are the width of a pulse, or what has one.
_WIDTH: Final = re.compile(
    r"width|ancho|anchura|breite|weite|echo|eco|high|alto|(?:pulse?|impuls|echo)(?:breite|weite|dauer|laenge|zeit)"
)
#: Of these a name has one of both lists: the time between two pulses is one of a pulse, too.
_PULSES: Final = re.compile(r"pulse?|pulso|impulso?|impuls")
_LASTS: Final = re.compile(r"duration|length|len|dauer|laenge|duracion|longitud|largo")
#: Words of names that are the time from an edge to the next one like it.
_PERIODS: Final = re.compile(r"period.*|freq.*|.*periode|interval.*|between|entre|zwischen|rate|hz|rpm")
#: What a comment says of an edge, each with the value of the field that sets it.
_EDGES: Final = (
    (0, re.compile(r"\b(?:rising|subida|steigend\w*|ascendente|positive?|positiva?)\b", re.IGNORECASE)),
    (1, re.compile(r"\b(?:falling|bajada|fallend\w*|descendente|negative?|negativa?)\b", re.IGNORECASE)),
)
#: Comments that speak of what is not so.
_NOT: Final = re.compile(r"\b(?:not|nicht|no|instead|statt|was|old|later|spaeter|unused)\b", re.IGNORECASE)
_EDGE_NAMES: Final = ("rising", "falling")
_POLARITIES: Final = {"CAP1POL": ECCTL1.CAP1POL, "CAP2POL": ECCTL1.CAP2POL}
_RESETS: Final = (ECCTL1.CTRRST1, ECCTL1.CTRRST2, ECCTL1.CTRRST3, ECCTL1.CTRRST4)
#: So many copies back a value is followed.
_DEPTH: Final = 4


class _Taken(NamedTuple):
    """A value that a statement gives to something, with the names of what gets it."""

    function: Function
    statement: Stmt
    names: tuple[str, ...]
    value: Expr


class _Polarity(NamedTuple):
    """A statement that sets the edge of an event."""

    function: Function
    statement: Stmt
    #: `CAP1POL`, `CAP2POL`; "": all of them.
    field: str
    #: None: it is not a constant.
    value: int | None


def wrong_capture_edges(modules: Iterable[Module], chip: Chip) -> Iterator[UnitMismatch]:
    """The statements by which a program takes for the width of a pulse what is none."""
    stamps = Stamps(modules, frozenset())
    nodes = [p for function in stamps.functions for s in statements(function.body) for p in own_nodes(s)]
    captures = {found for p in nodes if (found := _capture(p)) is not None}
    for counter in sorted({counter for counter, _ in captures}):
        registers = {name for owner, name in captures if owner == counter}
        if "CAP2" in registers and registers <= {"CAP1", "CAP2"} and _captures(chip, counter):
            if not stamps.given:
                for function in stamps.functions:
                    stamps.read(function)
            wrong = _Captured(stamps, counter, registers, chip).wrong()
            yield from [wrong] if wrong is not None else []


def _captures(chip: Chip, counter: str) -> bool:
    """Whether an eCAP captures each edge of two events or more at least, by a counter that only it resets."""
    edges, mode = (chip.register(f"{counter}Regs", name).value for name in ("ECCTL1", "ECCTL2"))
    runs = field(mode, ECCTL2.TSCTRSTOP) and field(mode, ECCTL2.STOP_WRAP) and field(edges, ECCTL1.CAPLDEN)
    other = (mode & (ECCTL2.CAP_APWM.mask | ECCTL2.SYNCI_EN.mask)) | (edges & ECCTL1.PRESCALE.mask)
    return bool(runs) and not other


def _capture(e: object) -> tuple[str, str] | None:
    """The eCAP and the register that an expression reads (`ECap1`, `CAP2`); None: it is another one."""
    match e:
        case RegisterLoad(register=RegisterRef(block=block, register=name, field=None)) if name in CAPTURES:
            return block.removesuffix("Regs"), name
        case Call(function=Function(name="ECAP_getEventTimeStamp"), arguments=[base, event]):
            address, number = _number(base), _number(event)
            if address is not None and number is not None:
                return counter_at("ECap", address), f"CAP{number + 1}"
    return None


class _Captured:
    """What a program takes of the first two events of one eCAP, with the registers at the end of the run."""

    def __init__(self, stamps: Stamps, counter: str, registers: set[str], chip: Chip) -> None:
        self._functions = stamps.functions
        self._counter = counter
        self._registers = registers
        self._edges = chip.register(f"{counter}Regs", "ECCTL1").value
        self._given: dict[Key, list[Expr]] = {}
        for key, value in stamps.given:
            self._given.setdefault(key, []).append(value)

    def wrong(self) -> UnitMismatch | None:
        """The statement that takes a time for a width that is none; None: there is none."""
        taken = [each for function in self._functions for each in _taken(function)]
        resets = any(self._edges & bits.mask for bits in _RESETS)
        alone = [each for each in taken if self._is(each.value, "CAP2")]
        if not resets:
            between = [each for each in taken if self._difference(each.value)]
            return self._same_edges(between) or self._absolute(alone)
        return self._same_edges(alone) if self._edges & ECCTL1.CTRRST1.mask else None

    def _is(self, e: Expr, register: str, deep: int = _DEPTH) -> bool:
        """Whether a value is that of a capture register, also by copies."""
        inner = bare(e)
        if _capture(inner) == (self._counter, register):
            return True
        sources = self._given.get(key_of(inner.lvalue) or (), []) if isinstance(inner, Load) and deep else []
        return len(sources) == 1 and self._is(sources[0], register, deep - 1)

    def _difference(self, e: Expr, deep: int = _DEPTH) -> bool:
        """Whether a value is the time between the two events, also by copies."""
        match bare(e):
            case Binary(op="-", left=left, right=right):
                return self._is(left, "CAP2") and self._is(right, "CAP1")
            case Load(lvalue=lvalue) if deep:
                sources = self._given.get(key_of(lvalue) or (), [])
                return len(sources) == 1 and self._difference(sources[0], deep - 1)
        return False

    def _same_edges(self, taken: list[_Taken]) -> UnitMismatch | None:
        """The time between two events that are the same edge, and which a name or a comment says to be a width."""
        first, second = (field(self._edges, bits) for bits in _POLARITIES.values())
        set_ = [each for function in self._functions for each in _set(function, f"{self._counter}Regs")]
        if not taken or first != second or any(self._changes(each) for each in set_):
            return None
        between = f"the time from one {_EDGE_NAMES[first]} edge to the next, a period"
        for each in set_:
            if each.field and (comment := _other_edge(each, first)):
                message = (
                    f"{each.field} is {first}, a {_EDGE_NAMES[first]} edge, and the comment {comment!r} says a "
                    f"{_EDGE_NAMES[1 - first]} one: the program takes {between}"
                )
                return self._told(each.function, each.statement, message)
        for use in taken:
            if name := _width(use.names):
                at = next((each for each in reversed(set_) if each.field == "CAP2POL"), use)
                message = (
                    f"CAP1 and CAP2 of {self._counter} capture the same edge: {name} is a width by its name, and gets "
                    f"{between}"
                )
                return self._told(at.function, at.statement, message)
        return None

    def _changes(self, each: _Polarity) -> bool:
        """Whether a statement sets an edge that is not that of the end, so that it may be so for a time only."""
        fields = {name: bits for name, bits in _POLARITIES.items() if each.field in (name, "")}
        if each.field:
            return each.value != field(self._edges, fields[each.field])
        return each.value is None or (each.value != 0 and any(
            field(each.value, bits) != field(self._edges, bits) for bits in fields.values()
        ))  # fmt: skip

    def _absolute(self, alone: list[_Taken]) -> UnitMismatch | None:
        """A stamp that is taken for a width: nothing resets the counter, and nothing is subtracted from the stamp."""
        if self._registers != {"CAP2"} or self._subtracted():
            return None
        for use in alone:
            if name := _width(use.names):
                message = (
                    f"{name} is a width by its name, and gets CAP2 of {self._counter}, the count since the counter "
                    "began: no event resets it (CTRRST1), and nothing is subtracted"
                )
                return self._told(use.function, use.statement, message)
        return None

    def _subtracted(self) -> bool:
        """Whether the program subtracts one of its stamps, or sets the counter itself."""
        for function in self._functions:
            for s in statements(function.body):
                if isinstance(s, Assign) and isinstance(s.target, RegisterRef) and (
                    (s.target.block, s.target.register) == (f"{self._counter}Regs", "TSCTR")
                ):  # fmt: skip
                    return True
                for p in own_nodes(s):
                    if isinstance(p, Binary) and p.op == "-" and any(self._holds(side) for side in (p.left, p.right)):
                        return True
        return False

    def _holds(self, e: Expr, deep: int = _DEPTH) -> bool:
        """Whether a value can be a stamp, also by copies, beside others."""
        inner = bare(e)
        if _capture(inner) == (self._counter, "CAP2"):
            return True
        sources = self._given.get(key_of(inner.lvalue) or (), []) if isinstance(inner, Load) and deep else []
        return any(self._holds(source, deep - 1) for source in sources)

    def _told(self, function: Function, s: Stmt, message: str) -> UnitMismatch:
        place = Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
        return UnitMismatch(place, message, f"{self._counter}Regs.CAP2", "capture-edge")


def _taken(function: Function) -> Iterator[_Taken]:
    """What a function gives to objects and parameters, and returns."""
    for s in statements(function.body):
        given = gives(s)
        if given is not None:
            name = re.findall(r"\w+", given[0].text)[-1:]
            yield _Taken(function, s, tuple(name), given[1])
        elif isinstance(s, Return) and s.value is not None:
            yield _Taken(function, s, (function.name,), s.value)
        for call in (p for p in own_nodes(s) if isinstance(p, Call)):
            names = [parameter.declaration.name for parameter in call.function.parameters]
            for n, argument in enumerate(call.arguments):
                yield _Taken(function, s, (*names[n : n + 1], call.function.name), argument)


def _set(function: Function, block: str) -> Iterator[_Polarity]:
    """The statements of a function that set the edges of the first two events of a block."""
    for s in statements(function.body):
        match s:
            case Assign(target=RegisterRef(register="ECCTL1", field=part) as target, value=value) if (
                target.block == block and (part is None or part.name in _POLARITIES)
            ):
                yield _Polarity(function, s, part.name if part is not None else "", _number(value))
        for p in own_nodes(s):
            match p:
                case Call(function=Function(name="ECAP_setEventPolarity"), arguments=[base, event, polarity]):
                    of_block = counter_at("ECap", _number(base) or 0) == block.removesuffix("Regs")
                    if of_block and (name := f"CAP{(_number(event) or 0) + 1}POL") in _POLARITIES:
                        yield _Polarity(function, s, name, _number(polarity))


def _number(e: Expr) -> int | None:
    number = bare(e)
    return int(number.value) if isinstance(number, Const) else None


def _other_edge(each: _Polarity, edge: int) -> str:
    """The comment beside a statement that says the other edge than it sets, and only this one; "": it does not."""
    lines = lines_with_comments(each.function.where.file)
    line = each.statement.where.line
    comment = lines[line - 1][1] if 0 < line <= len(lines) else ""
    said = {value for value, text in _EDGES if text.search(comment)}
    return comment if said == {1 - edge} and not _NOT.search(comment) else ""


def _width(names: tuple[str, ...]) -> str:
    """The name that says that something is the width of a pulse, and no period; "": none does."""
    for name in names:
        words = words_of(name)
        if any(map(_PERIODS.fullmatch, words)):
            return ""
        both = any(map(_PULSES.fullmatch, words)) and any(map(_LASTS.fullmatch, words))
        if both or any(map(_WIDTH.fullmatch, words)):
            return name
    return ""
