"""Finds the values that count the ticks of the chip's counters, and how long a tick lasts.

    uint32_t now = CpuTimer1Regs.TIM.all;       // counts of CPU timer 1
    uint32_t width = now - last;                // so is the difference of two of them

Which values those are, the source says (`HardwareCounts`).  How long one lasts, the registers say at the end of a run
(`tick_seconds`).  The same holds for the registers that make a time of a count (`TimeRegister`).  A CPU timer that the
program starts may stand at the end: a motor then waits for its next move.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final, NamedTuple

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.stamps import Key, Stamps, key_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Conditional,
    Const,
    Convert,
    Expr,
    Function,
    Load,
    RegisterLoad,
    RegisterRef,
    Unary,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, own_nodes, statements
from emulator.chip import Chip
from emulator.clock import SYSCLK_HZ
from emulator.peripherals.cpu_timer import TSS
from emulator.peripherals.epwm_time_base import STOPPED, UP_DOWN
from emulator.registers.core import F
from emulator.registers.epwm import TBCTL
from emulator.registers.epwm_output import DBCTL
from emulator.registers.eqep import QCAPCTL

#: Kind of block -> its registers that hold a count of its own counter, or a period of it.
_REGISTERS: Final = {
    "CpuTimer": frozenset({"TIM", "PRD"}), "ECap": frozenset({"TSCTR", "CAP1", "CAP2", "CAP3", "CAP4"}),
    "EQep": frozenset({"QCTMR", "QCPRD", "QCTMRLAT", "QCPRDLAT"}),
}  # fmt: skip
#: Kind of block -> the address of its first one, as TI's driverlib passes it, the words of each, and the first number
#: (DS table of peripheral registers).
BASES: Final = {
    "CpuTimer": (0x0C00, 8, 0), "ECap": (0x5000, 0x20, 1), "EPwm": (0x4000, 0x100, 1), "EQep": (0x5100, 0x40, 1),
}  # fmt: skip
#: Functions of driverlib that return a count of a kind of block.
_FUNCTIONS: Final = {
    "CPUTimer_getTimerCount": "CpuTimer", "ECAP_getEventTimeStamp": "ECap", "ECAP_getTimeBaseCounter": "ECap",
}  # fmt: skip
#: Kind of block -> its registers that make a time of a count.
_TIMES: Final = {
    "CpuTimer": frozenset({"PRD"}), "ECap": frozenset({"CAP1", "CAP2", "CAP3", "CAP4"}),
    "EPwm": frozenset({"TBPRD", "CMPA", "CMPB", "CMPC", "CMPD", "DBRED", "DBFED"}),
}  # fmt: skip
#: Functions of driverlib that set one of them to their last argument.
_SETTERS: Final = {
    "CPUTimer_setPeriod": ("CpuTimer", "PRD"), "EPWM_setTimeBasePeriod": ("EPwm", "TBPRD"),
    "EPWM_setCounterCompareValue": ("EPwm", "CMPA"), "EPWM_setRisingEdgeDelayCount": ("EPwm", "DBRED"),
    "EPWM_setFallingEdgeDelayCount": ("EPwm", "DBFED"), "ECAP_setAPWMPeriod": ("ECap", "CAP1"),
    "ECAP_setAPWMCompare": ("ECap", "CAP2"),
}  # fmt: skip
#: Functions of driverlib that start a CPU timer.
_STARTS: Final = frozenset({"CPUTimer_startTimer", "CPUTimer_resumeTimer"})
#: Something else than a count.
OTHER: Final = ""
_ECCTL1_PRESCALE: Final = 0x3E00


class HardwareCounts:
    """The values of a program that are counts of one hardware counter."""

    def __init__(
        self, modules: Iterable[Module], registers: Mapping[str, frozenset[str]] = _REGISTERS,
        functions: Mapping[str, str] = _FUNCTIONS,
    ) -> None:  # fmt: skip
        """`registers`: kind of block -> those that hold a count; `functions`: those of driverlib that return one."""
        self._registers, self._functions = registers, functions
        stamps = Stamps(modules, frozenset())
        for function in stamps.functions:
            stamps.read(function)
        #: Object or result -> the counters whose counts it holds, and `OTHER` for anything else.
        self.given, self.same = stamps.given, stamps.same
        self._holds: dict[Key, frozenset[str]] = {key: frozenset() for key, _ in stamps.given}
        grown = True
        while grown:
            grown = False
            for key, value in stamps.given:
                grown |= self._add(key, frozenset({OTHER}) if _is_number(value) else self._counters(value))
            for one, other in stamps.same:
                both = self._holds.get(one, frozenset()) | self._holds.get(other, frozenset())
                grown |= self._add(one, both) | self._add(other, both)

    def counter_of(self, e: Expr) -> str:
        """The counter whose counts a value is: `CpuTimer1`, `ECap2`; "": it is none, or not known."""
        found = self._counters(e)
        return next(iter(found)) if len(found) == 1 else ""

    def _add(self, key: Key, counters: frozenset[str]) -> bool:
        before = self._holds.get(key, frozenset())
        self._holds[key] = before | counters
        return self._holds[key] != before

    def _counters(self, e: Expr) -> frozenset[str]:
        match e:
            case Const():
                return frozenset()
            case Convert(operand=operand) | Unary(operand=operand) if isinstance(e.ctype, IntType | FloatType):
                return self._counters(operand)
            case RegisterLoad(register=RegisterRef() as register):
                return frozenset({self._counter_of_register(register)})
            case Call(function=function, arguments=arguments) if function.name in self._functions:
                return frozenset({_counter_of_call(self._functions[function.name], arguments)})
            case Call(function=function) if not function.extern:
                return self._holds.get(("result", function.path), frozenset({OTHER}))
            case Load(lvalue=lvalue):
                key = key_of(lvalue)
                return frozenset({OTHER}) if key is None else self._holds.get(key, frozenset({OTHER}))
            case Conditional(then=then, otherwise=otherwise):
                return self._counters(then) | self._counters(otherwise)
            case Binary(op="+" | "-", left=left, right=right):
                return self._counters(left) | self._counters(right)
        return frozenset({OTHER})

    def _counter_of_register(self, register: RegisterRef) -> str:
        block = register.block.removesuffix("Regs")
        counts = register.field is None and register.register in self._registers.get(block.rstrip("0123456789"), ())
        return block if counts else OTHER


def _is_number(value: Expr) -> bool:
    """Whether a value is a constant, and not one with which an object of counts begins."""
    constant = bare(value)
    return isinstance(constant, Const) and constant.value not in (0, -1, 0xFFFF, 0xFFFFFFFF)


def _counter_of_call(kind: str, arguments: list[Expr]) -> str:
    address = bare(arguments[0]) if arguments else None
    if not isinstance(address, Const) or not isinstance(address.value, int):
        return OTHER
    return counter_at(kind, address.value)


def counter_at(kind: str, address: int) -> str:
    """The counter of a kind whose block is at an address, as driverlib passes it."""
    base, words, first = BASES[kind]
    number, rest = divmod(address - base, words)
    return f"{kind}{first + number}" if 0 <= number < 16 and not rest else OTHER


class TimeRegister(NamedTuple):
    """A register that makes a time of a count: of the counter, and the register's name."""

    counter: str
    name: str

    def tick_seconds(self, chip: Chip, started: frozenset[str]) -> float | None:
        """How long one count of it lasts, in seconds; None: its counter stands, or it makes another time.

        Up and down, a compare value is half of a pulse, or of a pause.
        """
        if self.counter.startswith("EPwm"):
            mode = field(chip.register(f"{self.counter}Regs", "TBCTL").value, TBCTL.CTRMODE)
            band = chip.register(f"{self.counter}Regs", "DBCTL").value
            of_band = self.name in ("DBRED", "DBFED")
            if mode == STOPPED or (of_band and field(band, DBCTL.HALFCYCLE)) or (mode == UP_DOWN and not of_band):
                return None
        return tick_seconds(chip, self.counter, started)


def time_register(register: RegisterRef) -> TimeRegister | None:
    """What a statement sets that writes a register, or its field of the same name; None: something else."""
    counter = register.block.removesuffix("Regs")
    name = register.register
    if register.field is None:
        whole = name not in ("CMPA", "CMPB")  # which have the bits of the high resolution below those of the count
    else:
        whole = register.field.name == name
    named = name in _TIMES.get(counter.rstrip("0123456789"), ())
    return TimeRegister(counter, name) if named and whole else None


def set_by_call(function: Function, arguments: list[Expr]) -> TimeRegister | None:
    """What a call of driverlib sets to its last argument; None: something else, or it is not known which block's."""
    address = bare(arguments[0]) if len(arguments) > 1 else None
    if function.name not in _SETTERS or not isinstance(address, Const) or not isinstance(address.value, int):
        return None
    kind, name = _SETTERS[function.name]
    counter = counter_at(kind, address.value)
    return TimeRegister(counter, name) if counter else None


def started_timers(modules: Iterable[Module]) -> frozenset[str]:
    """The CPU timers that statements of a program start; one of them may only pause at the end of the run."""
    found: set[str] = set()
    for s in (s for module in modules for function in module.functions for s in statements(function.body)):
        match s:
            case Assign(target=RegisterRef(block=block, register="TCR", field=part), value=value):
                given = bare(value)
                starts = isinstance(given, Const) and not int(given.value) & (TSS if part is None else 1)
                if starts and (part is None or part.name == "TSS"):
                    found.add(block.removesuffix("Regs"))
        for p in own_nodes(s):
            if isinstance(p, Call) and p.function.name in _STARTS and p.arguments:
                address = bare(p.arguments[0])
                if isinstance(address, Const) and isinstance(address.value, int):
                    found.add(counter_at("CpuTimer", address.value))
    return frozenset(found)


def tick_seconds(chip: Chip, counter: str, started: frozenset[str] = frozenset()) -> float | None:
    """How long one count lasts, in seconds; None: the counter stands, or counts something else.

    `started`: timers that count whether they stand now or not.
    """
    block = f"{counter}Regs"
    if counter.startswith("CpuTimer"):
        if chip.register(block, "TCR").value & TSS and counter not in started:
            return None
        if counter == "CpuTimer2" and chip.register("CpuSysRegs", "TMR2CLKCTL").value:
            return None
        low, high = chip.register(block, "TPR").value & 0xFF, chip.register(block, "TPRH").value & 0xFF
        return ((high << 8 | low) + 1) / SYSCLK_HZ
    if counter.startswith("EPwm"):
        control = chip.register(block, "TBCTL").value
        tick = (2 * field(control, TBCTL.HSPCLKDIV) or 1) << field(control, TBCTL.CLKDIV)
        return chip.sysctrl.epwmclk_divider * tick / SYSCLK_HZ
    if counter.startswith("EQep"):
        control = chip.register(block, "QCAPCTL").value
        return (1 << field(control, QCAPCTL.CCPS)) / SYSCLK_HZ if field(control, QCAPCTL.CEN) else None
    if chip.register(block, "ECCTL1").value & _ECCTL1_PRESCALE:
        return None  # a capture is then one of several edges: the count is not that of one period
    return 1 / SYSCLK_HZ


def field(word: int, bits: F) -> int:
    """The value of a field of a register."""
    return (word & bits.mask) >> bits.lo
