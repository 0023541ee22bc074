"""Flags that hardware sets and only a statement clears, where the program acts on them, found in the source.

    if (SciaRegs.SCIRXST.bit.RXERROR)
        Errors++;                                   // RXERROR stays: it counts for ever after one bad character
    else
        c = SciaRegs.SCIRXBUF.bit.SAR;              // and none is taken any more

A test of the flag must lead to a count, or away from the received character: then an old flag is taken for a new event.
A program that stops at the flag, or that goes to another state for good, needs no clear.

COEF and CDEF of an eQEP are no errors: each standstill, each turn back sets them.  So a test that they are not set
(`if (QEPSTS.bit.UPEVNT && !QEPSTS.bit.COEF) period = QCPRDLAT;`) is never true again after the first one.

Sources: TRM SCI, SPI, eQEP, ADC, ePWM, CMPSS, I2C and CAN, status registers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from emulator.c28x.passes.begun_again import step_of
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Compare,
    Expr,
    Function,
    If,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    RegisterRef,
    Stmt,
    While,
)
from emulator.c28x.tree_queries import all_blocks, assigned, bare, below, leaves, own_nodes, statements, without_end

#: Register -> its flags, and what clears one: register, field ("": that of the flag), value.
CLEARED: Final[dict[str, tuple[tuple[str, ...], tuple[tuple[str, str, int], ...]]]] = {
    "SCIRXST": (("RXERROR", "BRKDT", "FE", "OE", "PE"), (("SCICTL1", "SWRESET", 0),)),
    "SCIFFRX": (("RXFFOVF",), (("SCIFFRX", "RXFFOVRCLR", 1), ("SCIFFTX", "SCIRST", 0))),
    "SPISTS": (("OVERRUN_FLAG",), (("SPISTS", "", 1), ("SPICCR", "SPISWRESET", 0))),
    "SPIFFRX": (("RXFFOVF",), (("SPIFFRX", "RXFFOVFCLR", 1), ("SPIFFTX", "SPIRST", 0))),
    "QEPSTS": (("COEF", "CDEF", "FIMF"), (("QEPSTS", "", 1),)),
    "QFLG": (("PCE", "PHE", "WTO", "PCU", "PCO"), (("QCLR", "", 1),)),
    "ADCINTOVF": (("ADCINT1", "ADCINT2", "ADCINT3", "ADCINT4"), (("ADCINTOVFCLR", "", 1),)),
    "TZFLG": (("OST",), (("TZCLR", "", 1),)),
    "COMPSTS": (("COMPHLATCH",), (("COMPSTSCLR", "HLATCHCLR", 1),)),
    "I2CSTR": (("NACK", "ARBL"), (("I2CSTR", "", 1), ("I2CMDR", "IRS", 0))),
    "CAN_ES": (("BOff",), (("CAN_CTL", "Init", 0), ("CAN_CTL", "ABO", 1))),
}
#: Flags of QEPSTS that come in each use, not only after an error.
USUAL: Final = frozenset(("COEF", "CDEF"))
#: What clears a flag from then on: it may be set once, at the start.
LASTING: Final = "ABO"
#: The register whose reading takes what came in.
_RECEIVED: Final = "SCIRXBUF"


class LatchedFlag(NamedTuple):
    """A test of a flag that stays set: the block, the register, the field, and the place."""

    block: str
    register: str
    field: str
    place: Place


def latched_flags(modules: Iterable[Module]) -> Iterator[LatchedFlag]:
    """The tests of flags that lead to a count, or away from what was received."""
    own = {function.path: function for module in modules for function in module.functions}
    for function in own.values():
        for block in all_blocks(function.body):
            for number, s in enumerate(block):
                if isinstance(s, If):
                    for load in _tested(s.test):
                        if _counts(s.then, own) or _passes_by(s, block[number + 1 :], own):
                            place = Place(
                                function.where.file, s.where.line, function.name, function.c_file, s.where.column
                            )
                            yield LatchedFlag(load.block, load.register, load.field.name if load.field else "", place)
                    for load in _not_set(s.test):
                        place = Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
                        yield LatchedFlag(load.block, load.register, load.field.name if load.field else "", place)


def _tested(test: Expr) -> Iterator[RegisterRef]:
    """The flags of `CLEARED` each of which alone makes a test true."""
    match bare(test):
        case Logic(op="or", operands=operands):
            for each in operands:
                yield from _tested(each)
        case Compare(op="==" | "!=" as op, left=left, right=right) if constant_of(right) == (op == "=="):
            yield from _tested(left)
        case RegisterLoad(register=RegisterRef(register=name, field=field) as found) if field is not None:
            if field.name in CLEARED.get(name, ((), ()))[0]:
                yield found


def _not_set(test: Expr) -> Iterator[RegisterRef]:
    """The flags of `USUAL` each of which alone makes a test false."""
    match bare(test):
        case Logic(op="and", operands=operands):
            for each in operands:
                yield from _not_set(each)
        case Not(operand=operand):
            yield from _usual(operand)
        case Compare(op="==", left=left, right=right) if constant_of(right) == 0:
            yield from _usual(left)


def _usual(e: Expr) -> Iterator[RegisterRef]:
    match bare(e):
        case RegisterLoad(register=RegisterRef(register="QEPSTS", field=field) as found) if field is not None:
            if field.name in USUAL:
                yield found


def _run(body: list[Stmt], own: dict[str, Function]) -> list[Stmt]:
    """The statements of a block, with those of the functions that it calls."""
    inner = statements(body)
    paths = [p.function.path for s in inner for p in own_nodes(s) if isinstance(p, Call)]
    return [*inner, *(s for function in below(paths, own) for s in statements(function.body))]


def _counts(body: list[Stmt], own: dict[str, Function]) -> bool:
    """Whether a block counts something that lasts, and goes on as before."""
    ran = _run(body, own)
    counted = False
    for s in ran:
        if isinstance(s, While) and without_end(s):
            return False
        variable = assigned(s)
        if not isinstance(s, Assign) or not isinstance(s.target, LValue) or (variable and variable.kind != "global"):
            continue
        if variable is not None and step_of(s, variable) is not None:
            counted = True
        elif constant_of(s.value) != 0:
            return False  # another state
    return counted


def _passes_by(s: If, behind: list[Stmt], own: dict[str, Function]) -> bool:
    """Whether a received character is taken only where a test is false."""
    if _stops(s.then, own) or _takes(s.then, own):
        return False
    return _takes(s.otherwise, own) or (leaves(s.then) and _takes(behind, own))


def _stops(body: list[Stmt], own: dict[str, Function]) -> bool:
    return any(isinstance(s, While) and without_end(s) for s in _run(body, own))


def _takes(body: list[Stmt], own: dict[str, Function]) -> bool:
    return any(
        isinstance(p, RegisterLoad) and isinstance(p.register, RegisterRef) and p.register.register == _RECEIVED
        for s in _run(body, own) for p in own_nodes(s)
    )  # fmt: skip
