"""Compares the rates that a program states with those that its hardware has at the end of a run.

    EPwm1Regs.TBPRD = 9999;                          // 200 MHz / 10000 = 20 kHz
    EPwm2Regs.TBPRD = TBCLK_HZ / CARRIER_HZ - 1;

A comment beside the statement that sets a period, or beside a definition that it uses, states a rate; so does the name
of a constant in it.  The rate that counts is the one behind the last `=`.  It is told if it is none of those that the
hardware has then: that of the counter, of its interrupts and triggers, of a pin that toggles.

    // Servo: 62500 counts are 20 ms (50 Hz)
    #define SERVO_PERIOD 62500

A comment beside or above a definition may also say how long the defined number of counts lasts, or a period.

The clock of a program that makes it from a crystal can be slower on its board; then both rates are right.

So does a comment about a bit rate, beside the statements that set the divider of an SCI, above them, or above their
function.  A standard rate that is not the stated one can be meant, and the comment be old: then the other end of the
line must have another one, too.

TI's driverlib is told the frequency of a clock (`SCI_setConfig(base, lspclkHz, baud, ...)`): that is checked too.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from math import isclose
from operator import add, and_, floordiv, mul, rshift, sub
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    Const,
    Declare,
    Expr,
    For,
    Function,
    Load,
    LValue,
    RegisterRef,
    Stmt,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, bare, gives, own_nodes, parts, statements, without_end
from emulator.chip import Chip
from emulator.clock import SYSCLK_HZ
from emulator.peripherals.epwm_time_base import STOPPED, UP_DOWN
from emulator.registers.epwm import ETINTPS, ETPS, ETSEL, ETSOCPS, TBCTL
from emulator.registers.sci import SCIFFCT
from hil.drivers.clock_names import clock_by_name
from hil.drivers.hardware_counts import counter_at, field, tick_seconds
from hil.drivers.stated_units import as_written, defined_number
from hil.drivers.unit_names import unit_of_name, unit_of_text
from hil.drivers.units import LIBRARY_UNITS, UnitMismatch

#: A rate in a comment: a number with a unit of frequency or time.
_AMOUNT: Final = re.compile(r"(?<![\w.,])(\d+(?:\.\d+)?) ?([kM]?Hz|khz|hz|mhz|us|µs|ms|ns|s)\b(?!\w)")
#: A bit rate in a comment: a number with a unit, or one of those that everybody uses.
_BAUD: Final = re.compile(
    r"(?<![\w.,])(?:(\d{1,3}[,.' ]?\d{3}|\d+) ?(?:baud\w*|bd|bps|bits?(?:s| ?/ ?s\w*| (?:a|per|pro|por|je) s\w+))"
    r"|(9600|19200|38400|57600|115200|230400))\b(?![.,]\d)",
    re.IGNORECASE,
)  # fmt: skip
_TIME: Final = r"(?<![\w.,])(?P<{0}>\d+(?:\.\d+)?) ?(?P<{0}_unit>[kM]?Hz|khz|hz|mhz|us|µs|ms|ns|s)\b(?!\w)"
#: How long a number of counts, or a period, lasts, and the rate in parentheses behind it.
_LASTING: Final = re.compile(
    r"(?:(?<![\w.,])(?P<counts>\d+) (?:counts?|ticks?|cuentas|ciclos|takte|zählerschritte|zaehlerschritte) "
    rf"(?:are|is|=|make|last|take|son|duran|sind|dauern|ergeben) {_TIME.format('time')}"
    rf"|{_TIME.format('whole')} (?:per|each|por|pro|je) (?:period|periodo|periode)\b)"
    rf"(?: ?\(= ?{_TIME.format('equal')}\)| ?\({_TIME.format('rate')}\))?",
    re.IGNORECASE,
)
_OPERATORS: Final[dict[str, Callable[[int, int], int]]] = {
    "+": add, "-": sub, "*": mul, "/": floordiv, "&": and_, ">>": rshift,
}  # fmt: skip
#: The name of a bit rate: not that of a divider, of a limit, or of some times the rate.
_BAUD_NAME: Final = re.compile(
    r"^(?!.*(?:DIV|TEIL|REG(?![A-Z])|BRR|PRE|CLK|CLOCK|MAX|MIN|ERR|TOL|COUNT|TIMES|\d+X|X\d+|_\d+$))"
    r"(?:\w*_)?(?:BAUD(?:_?RATE|IOS|S)?|BIT_?RATE|BPS)(?:_\w*)?$",
    re.IGNORECASE,
)
#: Comments that speak of another rate than that of today.
_NOT_NOW: Final = re.compile(
    r"\b(?:was|old|instead|not|former\w*|before|früher|frueher|statt|nicht|antes|no)\b", re.IGNORECASE
)
#: Rates that somebody sets on purpose.
_RATES: Final = (
    1200, 2400, 4800, 9600, 10400, 14400, 19200, 28800, 31250, 38400, 57600, 62500, 76800, 100000, 115200, 125000,
    230400, 250000, 420000, 460800, 500000, 921600, 1000000, 1562500, 2000000, 3125000, 6250000,
)  # fmt: skip
#: Comments about something else than the period: a part of it, a limit, a length.
_ELSE: Final = re.compile(
    r"\b(?:counts?|steps?|ticks?|each|dead|delay|pulses?|high|low|width|until|longest|shortest|max\w*|min\w*|most|"
    r"least|resolution|per|of|about|than|window|filter\w*|every|or)\b|[<>~]",
    re.IGNORECASE,
)  # fmt: skip
#: A frequency from here on is that of a clock, and not of what it counts.
_CLOCK_HZ: Final = 1e6
#: Two rates are equal up to this; integer dividers round.
_EQUAL: Final = 0.03
#: A receiver takes a rate that differs by less.
_SAMPLED: Final = 0.05
#: Sender and receiver may differ by less.
_SENT: Final = 0.04
#: Between them lies what a divider that was forgotten, or a slip of the decimal point, makes.
_SLIPS: Final = tuple(2.0**n for n in (-4, -3, -2, -1, 1, 2, 3, 4)) + tuple(10.0**n for n in range(-6, 7) if n)
#: Numbers without a name beside which the name of a rate still states the rate: conversions, and clocks in MHz and Hz.
_CONVERTING: Final = frozenset({1, 1000, 1e6, 1e9, 50, 100, 200, 50e6, 100e6, 200e6})
#: The addresses of blocks, as driverlib passes them (DS table of peripheral registers): first one, words, first number.
_PERIODS: Final = {"EPWM_setTimeBasePeriod": "EPwm", "CPUTimer_setPeriod": "CpuTimer"}
#: Functions that take a time; the period of a timer is compared with what it counts.
_TAKING_A_TIME: Final = LIBRARY_UNITS.keys() - {"ConfigCpuTimer"}
#: Functions of driverlib that take the frequency of LSPCLK as their second argument.
_TOLD_LSPCLK: Final = frozenset({"SCI_setConfig", "SPI_setConfig"})
#: An interrupt or a trigger at both ends of an up-down period.
_BOTH_ENDS: Final = 3
_TOGGLES: Final = 3


@dataclass(frozen=True, slots=True)
class _Setting:
    """A statement that sets the period of a counter."""

    function: Function
    statement: Stmt
    #: `EPwm1`, `CpuTimer0`.
    counter: str
    value: Expr
    #: `value` is the count itself, which the register then holds, and not a time in microseconds.
    counted: bool


@dataclass(frozen=True, slots=True)
class _Rates:
    """The rates in Hz that a counter has; the first one is its own."""

    own: float
    others: frozenset[float]
    up_down: bool = False
    #: What the register of the period holds.
    period: int = 0

    @property
    def all(self) -> tuple[float, ...]:
        """Its own, and the others."""
        return (self.own, *self.others)

    def has(self, rate: float) -> bool:
        """Whether it is one of them."""
        return any(isclose(rate, each, rel_tol=_EQUAL) for each in self.all)


def wrong_rates(modules: Iterable[Module], chip: Chip, tick_us: int, *, peer_known: bool) -> Iterator[UnitMismatch]:
    """The statements beside which a rate or a time is stated that they do not set.

    `tick_us`: the kernel's tick in microseconds.  `peer_known`: the other ends of the lines are those of the
    program's own board.
    """
    functions = [function for module in modules for function in module.functions]
    passed = _passed(functions)
    settings = [found for function in functions for found in _settings(function, passed)]
    for each in settings:
        alone = sum(other.counter == each.counter and other.counted == each.counted for other in settings) == 1
        rates = _rates(chip, each.counter) if alone else None
        slower = chip.sysctrl.sysclk_shares
        if rates is None or not _holds(each, rates):
            continue
        stated = _stated(each, replace(rates, others=frozenset(r * x for r in rates.all for x in slower))) or (
            _lasting(each, rates, settings)
        )
        if stated is not None and any(isclose(stated[1] / rates.own, slip, rel_tol=_EQUAL) for slip in _SLIPS):
            text, rate = stated
            message = f"{text} states {_hz(rate)}, and {each.counter} counts its period {_hz(rates.own)}"
            yield UnitMismatch(_place(each.function, each.statement), message, each.counter, "stated-rate")
    yield from _wrong_clocks(functions, chip)
    yield from _wrong_waits(functions, tick_us)
    yield from _wrong_bit_rates(functions, chip, peer_known=peer_known)


def _hz(rate: float) -> str:
    """A rate as text."""
    for size, unit in ((1e6, "MHz"), (1e3, "kHz")):
        if rate >= size:
            return f"{rate / size:.4g} {unit}"
    return f"{rate:.4g} Hz"


def _place(function: Function, s: Stmt) -> Place:
    return Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)


def _passed(functions: Iterable[Function]) -> dict[Variable, list[Expr]]:
    """What calls pass to each parameter."""
    found: dict[Variable, list[Expr]] = {}
    for function in functions:
        for s in statements(function.body):
            for p in own_nodes(s):
                if isinstance(p, Call):
                    for parameter, value in zip(p.function.parameters, p.arguments, strict=False):
                        found.setdefault(parameter, []).append(bare(value))
    return found


def _settings(function: Function, passed: dict[Variable, list[Expr]]) -> Iterator[_Setting]:
    for s in statements(function.body):
        if isinstance(s, Assign) and isinstance(s.target, RegisterRef) and s.target.field is None:
            block = s.target.block.removesuffix("Regs")
            if (block[:4], s.target.register) == ("EPwm", "TBPRD") or (block[:8], s.target.register) == (
                "CpuTimer", "PRD",
            ):  # fmt: skip
                yield _Setting(function, s, block, s.value, counted=True)
        for p in own_nodes(s):
            match p:
                case Call(function=callee, arguments=[timer, _, period]) if callee.name == "ConfigCpuTimer":
                    for block in _timers(timer):
                        yield _Setting(function, s, block, period, counted=False)
                case Call(function=callee, arguments=[base, count]) if callee.name in _PERIODS:
                    for address in _constants(base, passed):
                        if block := counter_at(_PERIODS[callee.name], address):
                            yield _Setting(function, s, block, count, counted=True)


def _timers(e: Expr) -> Iterator[str]:
    """The CPU timer that an argument of `ConfigCpuTimer` means."""
    match bare(e):
        case AddressOf(lvalue=LValue(root=Variable() as structure)):
            yield structure.declaration.name
        case Const(value=int() as n):
            yield f"CpuTimer{n}"


def _constants(e: Expr, passed: dict[Variable, list[Expr]]) -> list[int]:
    """The constants that an argument can be; also those that calls pass to a parameter."""
    match bare(e):
        case Const(value=int() as value):
            return [value]
        case Load(lvalue=LValue(root=Variable(kind="parameter") as parameter, indices=[])):
            given = passed.get(parameter, [])
            return [c.value for c in given if isinstance(c, Const) and isinstance(c.value, int)]
    return []


def _rates(chip: Chip, counter: str) -> _Rates | None:
    """The rates of a counter; None: it stands."""
    block = f"{counter}Regs"
    tick = tick_seconds(chip, counter)
    if tick is None:
        return None
    if counter.startswith("CpuTimer"):
        period = chip.register(block, "PRD").value
        return _Rates(1 / (tick * (period + 1)), frozenset(), period=period)
    control, period = chip.register(block, "TBCTL").value, chip.register(block, "TBPRD").value
    mode = field(control, TBCTL.CTRMODE)
    if mode == STOPPED or not period:
        return None
    own = 1 / (tick * (2 * period if mode == UP_DOWN else period + 1))
    select, events = chip.register(block, "ETSEL").value, chip.register(block, "ETPS").value
    more, triggers = chip.register(block, "ETINTPS").value, chip.register(block, "ETSOCPS").value
    others: set[float] = set()
    for divider in (
        field(events, ETPS.INTPRD), field(events, ETPS.SOCAPRD), field(events, ETPS.SOCBPRD),
        field(more, ETINTPS.INTPRD2), field(triggers, ETSOCPS.SOCAPRD2), field(triggers, ETSOCPS.SOCBPRD2),
    ):  # fmt: skip
        others.add(own / max(1, divider))
    if _BOTH_ENDS in (field(select, ETSEL.INTSEL), field(select, ETSEL.SOCASEL), field(select, ETSEL.SOCBSEL)):
        others |= {2 * each for each in others}
    for name in ("AQCTLA", "AQCTLB"):
        actions = chip.register(block, name).value
        if any(actions >> bit & _TOGGLES == _TOGGLES for bit in range(0, 12, 2)):
            others.add(own / 2)
    return _Rates(own, frozenset(others), mode == UP_DOWN, period)


def _holds(each: _Setting, rates: _Rates) -> bool:
    """Whether the register still holds what the statement set."""
    value = bare(each.value)
    if not isinstance(value, Const):
        return False
    return int(value.value) == rates.period if each.counted else isclose(rates.own, 1e6 / value.value, rel_tol=_EQUAL)


def _stated(each: _Setting, rates: _Rates) -> tuple[str, float] | None:
    """A rate that is stated beside a setting and that the counter has not, with its text; None: there is none."""
    named = [p for p in _leaves(each.value) if isinstance(p, Const)]
    where = each.statement.where
    lines = lines_with_comments(where.file)
    comments = [lines[where.line - 1][1]] if 0 < where.line <= len(lines) else []
    comments += [comment for p in named if (comment := defined_number(p)[1])]
    said = [(f"the comment {comment!r}", rate) for comment in comments for rate in _in_comment(comment)]
    said += list(_by_names(each, named, rates))
    return said[0] if said and not any(rates.has(rate) for _, rate in said) else None


def _lasting(each: _Setting, rates: _Rates, settings: list[_Setting]) -> tuple[str, float] | None:
    """What a comment at the definition of a period says of its counts that they do not last, with its text."""
    for p in _leaves(each.value) if each.counted else ():
        if not isinstance(p, Const) or not defined_number(p)[0] or p.value not in (rates.period, rates.period + 1):
            continue
        counters = {other.counter for other in settings if p.where.macro in _macros(other.value)}
        for comment in _at_definition(p.where.macro) if p.where.macro is not None and len(counters) == 1 else ():
            for match in _LASTING.finditer(" ".join(comment.split())):
                rate = _rate(match["time"] or match["whole"], match["time_unit"] or match["whole_unit"])
                beside = _rate(match["rate"] or match["equal"], match["rate_unit"] or match["equal_unit"]) or rate
                other = match["counts"] is not None and int(match["counts"]) != p.value
                # Up and down, the counts of the number last half a period.
                real = [*rates.all, *([2 * rates.own] if rates.up_down else [])]
                if rate and isclose(rate, beside, rel_tol=_EQUAL) and not other and (
                    not any(isclose(rate, one, rel_tol=_EQUAL) for one in real)
                ):  # fmt: skip
                    return f"the comment {comment!r}", rate
    return None


def _macros(e: Expr) -> set[Where | None]:
    """The definitions that a value uses."""
    return {p.where.macro for p in _leaves(e)}


def _at_definition(where: Where) -> list[str]:
    """The comments beside a definition, and in the line above it."""
    lines = lines_with_comments(where.file)
    above = lines[where.line - 2] if 2 <= where.line <= len(lines) else ("", "")
    return [lines[where.line - 1][1], *([above[1]] if not above[0].strip() else [])]


def _rate(number: str | None, unit_text: str | None) -> float:
    """The rate in Hz that an amount is, or that a time has; 0: it is none."""
    unit = unit_of_text(unit_text) if unit_text else None
    amount = float(number) * unit.scale if number and unit is not None else 0.0
    if unit is None or not amount:
        return 0.0
    return amount if unit.quantity == "frequency" else 1 / amount


def _in_comment(comment: str) -> Iterator[float]:
    """The rates in Hz that a comment states of a period."""
    result = comment.rpartition("=")[2]
    if _ELSE.search(result):
        return
    for number, unit_text in _AMOUNT.findall(result):
        if 0 < (rate := _rate(number, unit_text)) < _CLOCK_HZ:
            yield rate


def _by_names(each: _Setting, named: list[Const], rates: _Rates) -> Iterator[tuple[str, float]]:
    """The rates in Hz that the names of constants state from which a count is computed, with the names."""
    found: list[tuple[str, float]] = []
    for p in named:
        name, _ = defined_number(p)
        unit = unit_of_name(name) if name else None
        own = p.where.file == each.function.where.file and (p.where.macro is None or p.where.macro.file == p.where.file)
        if unit is not None and unit.quantity in ("frequency", "time") and p.value > 0:
            amount = p.value * unit.scale
            rate = amount if unit.quantity == "frequency" else 1 / amount
            if clock_by_name(p) is None and rate < _CLOCK_HZ:
                found.append((name, rate))
        elif own and clock_by_name(p) is None and not (
            p.value in _CONVERTING or (rates.up_down and p.value in (2, 0.5))
        ):  # fmt: skip
            return  # a part or a multiple can be meant
    if len(found) == 1:
        yield from found


def _leaves(e: Expr) -> Iterator[Expr]:
    """The operands of a sum or product of constants, with those that a constant was folded from."""
    for p in parts(e):
        if isinstance(p, Const) and p.source is not None:
            yield from _leaves(p.source)
        elif isinstance(p, Const):
            yield p


def _wrong_clocks(functions: Iterable[Function], chip: Chip) -> Iterator[UnitMismatch]:
    """The calls of driverlib that are told another frequency of LSPCLK than it has."""
    real, slower = chip.sysctrl.lspclk_hz, chip.sysctrl.sysclk_shares
    for function in functions:
        for s in statements(function.body):
            for p in own_nodes(s):
                if isinstance(p, Call) and p.function.name in _TOLD_LSPCLK and len(p.arguments) > 1:
                    told = bare(p.arguments[1])
                    if isinstance(told, Const) and told.value > 0 and not any(
                        isclose(told.value, real * x, rel_tol=_EQUAL) for x in slower
                    ):  # fmt: skip
                        message = (
                            f"{p.function.name} is told that LSPCLK has {_hz(told.value)}, and it has {_hz(real)}: the "
                            f"bit rate is {real / told.value:.4g} times the wanted one"
                        )
                        yield UnitMismatch(_place(function, s), message, "LSPCLK", "stated-rate")



def _wrong_waits(functions: list[Function], tick_us: int) -> Iterator[UnitMismatch]:
    """The waits, and the periods of the kernel, beside which stands nothing but another time, by a power of ten.

    In a loop that ends the time can be that of all turns.
    """
    for function in functions:
        loops = [
            loop for loop in statements(function.body)
            if isinstance(loop, For) or (isinstance(loop, While) and not without_end(loop))
        ]  # fmt: skip
        turned = {id(s) for loop in loops for s in statements(loop.body)}
        for s in statements(function.body):
            calls = [p for p in own_nodes(s) if isinstance(p, Call) and p.function.name in _TAKING_A_TIME]
            for call in calls if id(s) not in turned and len(calls) == 1 else ():
                units = LIBRARY_UNITS[call.function.name]
                for unit, argument in zip(units, call.arguments, strict=False):
                    number = as_written(argument)
                    if unit not in ("us", "tick") or not isinstance(number, Const) or number.value <= 0:
                        continue
                    real = number.value * (tick_us if unit == "tick" else 1) * 1e-6
                    comments = _comments_about(function, [s], header=False, above=False)
                    for comment in (*comments, defined_number(number)[1]):
                        stated = _time(comment)
                        if stated and any(isclose(stated / real, 10.0**n, rel_tol=_EQUAL) for n in range(-6, 7) if n):
                            name = call.function.name
                            message = f"the comment {comment!r} states another time than {name} gets: {real:g} s"
                            yield UnitMismatch(_place(function, s), message, name, "stated-rate")


def _time(comment: str) -> float:
    """The time in seconds that a comment is, and nothing else; 0: it says something else."""
    match = _AMOUNT.fullmatch(comment.strip(" .="))
    unit = unit_of_text(match[2]) if match is not None else None
    return float(match[1]) * unit.scale if match is not None and unit is not None and unit.quantity == "time" else 0.0


def _wrong_bit_rates(functions: list[Function], chip: Chip, *, peer_known: bool) -> Iterator[UnitMismatch]:
    """The statements that set the divider of an SCI, where a comment states another bit rate than it gives."""
    set_: dict[str, dict[str, list[tuple[Function, Assign, int | None]]]] = {}
    for function in functions:
        for s in statements(function.body):
            match s:
                case Assign(target=RegisterRef(block=block, register="SCIHBAUD" | "SCILBAUD" as name), value=value):
                    number = _number(value, function)
                    byte = None if number is None else number & 0xFF
                    set_.setdefault(block, {}).setdefault(name, []).append((function, s, byte))
    differs = peer_known and bool(chip.findings.of("serial-rate"))
    for block, registers in set_.items():
        settings = [setting for settings in registers.values() for setting in settings]
        function, s, _ = settings[-1]
        alone = len(settings) == len(registers) and all(f is function for f, _, _ in settings)
        if not alone or any(chip.register(block, n).value != given[0][2] for n, given in registers.items()):
            continue
        real = SYSCLK_HZ / chip.sci[block.removesuffix("Regs")[-1].upper()].format().bit_cycles
        halves = {name: given[0][1] for name, given in registers.items()}
        if wrong := _wrong_by_name(block, function, halves, chip, real):
            s, message = wrong
            yield UnitMismatch(_place(function, s), message, f"{block}.SCILBAUD", "stated-rate")
            continue
        only = sum(any(f is function for given in each.values() for f, _, _ in given) for each in set_.values()) == 1
        stated = {rate: text for text in _comments_about(function, [s for _, s, _ in settings], header=only)
                  for rate in _bit_rates(text)}  # fmt: skip
        known = any(isclose(real, rate, rel_tol=_EQUAL) for rate in _RATES)
        if len(stated) != 1 or (known and not differs):
            continue
        (rate, text), = stated.items()
        if not any(isclose(rate, real * x, rel_tol=_SAMPLED) for x in chip.sysctrl.sysclk_shares):
            message = f"the comment {text!r} states {rate} baud, and {block} sends and receives {real:.0f}"
            yield UnitMismatch(_place(function, s), message, f"{block}.SCILBAUD", "stated-rate")


def _number(e: Expr, function: Function, deep: int = 4) -> int | None:
    """The integer that an expression of constants is, also through locals that get one value; None: it is another."""
    match bare(e):
        case Const(value=value):
            return int(value)
        case Load(lvalue=lvalue) if deep and (origin := _origin(lvalue, function)) is not None:
            return _number(origin, function, deep - 1)
        case Binary(op=op, left=left, right=right) if op in _OPERATORS:
            one, other = _number(left, function, deep), _number(right, function, deep)
            if one is not None and other is not None and not (op == "/" and (one < 0 or other <= 0)):
                return _OPERATORS[op](one, other)
    return None


def _origin(lvalue: LValue, function: Function) -> Expr | None:
    """The only value that a `const` object or a local of a function ever has."""
    match lvalue:
        case LValue(root=Variable(kind="global", constant=True, initial=[value]), indices=[], bits=None):
            return value
        case LValue(root=Variable(kind="local", in_memory=False) as variable, indices=[], bits=None):
            given = [gives(s) for s in statements(function.body) if assigned(s) == variable]
            values = [each for each in given if each is not None]
            declared_only = any(isinstance(s, Declare) and s.variable == variable and s.value is None
                                for s in statements(function.body))  # fmt: skip
            return values[0][1] if len(values) == len(given) - declared_only == 1 else None
    return None


def _baud_names(e: Expr, function: Function) -> Iterator[tuple[float, str]]:
    """The bit rates that names in an expression state, with the names."""
    for p in _leaves(e):
        name = defined_number(p)[0] if isinstance(p, Const) else ""
        if isinstance(p, Const) and _BAUD_NAME.search(name):
            yield p.value, name
    for p in parts(e):
        origin = _origin(p.lvalue, function) if isinstance(p, Load) else None
        value = _number(origin, function) if origin is not None else None
        if origin is None or value is None:
            continue
        if _BAUD_NAME.search(name := p.lvalue.root.declaration.name):
            yield value, name
        else:
            yield from _baud_names(origin, function)


def _wrong_by_name(
    block: str, function: Function, halves: dict[str, Assign], chip: Chip, real: float
) -> tuple[Assign, str] | None:  # fmt: skip
    """The statement with the wrong half of a divider that is computed from a named bit rate, and what is wrong.

    A rate that no divider gives any better is none, and so is that of a SCI that measures the rate itself.
    """
    named = {
        rate: name for s in halves.values() for rate, name in _baud_names(s.value, function) if rate >= _RATES[0]
    }  # fmt: skip
    if len(named) != 1 or field(chip.register(block, "SCIFFCT").value, SCIFFCT.CDC):
        return None
    (rate, name), = named.items()
    counts = chip.sysctrl.lspclk_hz / 8
    best = max(1, round(counts / rate)) - 1
    if isclose(counts / (best + 1), rate, rel_tol=_SENT) and not any(
        isclose(rate, real * x, rel_tol=_SENT) for x in chip.sysctrl.sysclk_shares
    ):  # fmt: skip
        low_is_right = abs(chip.register(block, "SCILBAUD").value - (best & 0xFF)) <= 1
        wrong = "SCIHBAUD" if low_is_right and "SCIHBAUD" in halves else "SCILBAUD"
        message = (
            f"{name} states {rate:g} baud, and {block} sends and receives {real:.0f}: the divider is "
            f"{round(counts / real) - 1}, for {name} it is {best}"
        )
        return halves.get(wrong, next(iter(halves.values()))), message
    return None


def _comments_about(function: Function, settings: list[Stmt], *, header: bool, above: bool = True) -> Iterator[str]:
    """The comments beside statements, above the first one, and above their function."""
    lines = lines_with_comments(function.where.file)
    for s in settings:
        yield lines[s.where.line - 1][1] if 0 < s.where.line <= len(lines) else ""
    first = min(s.where.line for s in settings)
    for line in (*((first,) if above else ()), *((function.where.line,) if header else ())):
        for code, comment in reversed(lines[: max(0, line - 1)]):
            if code.strip():
                break
            yield comment


def _bit_rates(comment: str) -> Iterator[int]:
    """The bit rates that a comment states; several are those that can be chosen."""
    text = " ".join(comment.split())
    for number, usual in _BAUD.findall(text) if not _NOT_NOW.search(text) else ():
        yield int(re.sub(r"\D", "", number or usual))
