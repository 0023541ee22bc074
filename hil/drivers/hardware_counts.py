"""Finds the values that count the ticks of the chip's counters, and how long a tick lasts.

    uint32_t now = CpuTimer1Regs.TIM.all;       // counts of CPU timer 1
    uint32_t width = now - last;                // so is the difference of two of them

Which values those are, the source says (`HardwareCounts`).  How long one lasts, the registers say at the end of a run
(`tick_seconds`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.stamps import Key, Stamps, key_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
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
from emulator.c28x.tree_queries import bare
from emulator.chip import Chip
from emulator.clock import SYSCLK_HZ
from emulator.peripherals.cpu_timer import TSS
from emulator.registers.core import F
from emulator.registers.epwm import TBCTL
from emulator.registers.eqep import QCAPCTL

#: Kind of block -> its registers that hold a count of its own counter, or a period of it.
_REGISTERS: Final = {
    "CpuTimer": frozenset({"TIM", "PRD"}), "ECap": frozenset({"TSCTR", "CAP1", "CAP2", "CAP3", "CAP4"}),
    "EQep": frozenset({"QCTMR", "QCPRD", "QCTMRLAT", "QCPRDLAT"}),
}  # fmt: skip
#: The addresses of blocks, as TI's driverlib passes them (DS table of peripheral registers).
_TIMER_BASE, _TIMER_WORDS = 0x0C00, 8
_CAPTURE_BASE, _CAPTURE_WORDS = 0x5000, 0x20
#: Functions of driverlib that return a count, and the first address and the words of their blocks.
_FUNCTIONS: Final = {
    "CPUTimer_getTimerCount": ("CpuTimer", 0, _TIMER_BASE, _TIMER_WORDS),
    "ECAP_getEventTimeStamp": ("ECap", 1, _CAPTURE_BASE, _CAPTURE_WORDS),
    "ECAP_getTimeBaseCounter": ("ECap", 1, _CAPTURE_BASE, _CAPTURE_WORDS),
}
#: Something else than a count.
OTHER: Final = ""
_ECCTL1_PRESCALE: Final = 0x3E00


class HardwareCounts:
    """The values of a program that are counts of one hardware counter."""

    def __init__(self, modules: Iterable[Module]) -> None:
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
                return frozenset({_counter_of_register(register)})
            case Call(function=function, arguments=arguments) if function.name in _FUNCTIONS:
                return frozenset({_counter_of_call(function, arguments)})
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


def _is_number(value: Expr) -> bool:
    """Whether a value is a constant, and not one with which an object of counts begins."""
    constant = bare(value)
    return isinstance(constant, Const) and constant.value not in (0, -1, 0xFFFF, 0xFFFFFFFF)


def _counter_of_register(register: RegisterRef) -> str:
    block = register.block.removesuffix("Regs")
    counts = register.field is None and register.register in _REGISTERS.get(block.rstrip("0123456789"), ())
    return block if counts else OTHER


def _counter_of_call(function: Function, arguments: list[Expr]) -> str:
    kind, first, base, words = _FUNCTIONS[function.name]
    address = bare(arguments[0]) if arguments else None
    if not isinstance(address, Const) or not isinstance(address.value, int):
        return OTHER
    number, rest = divmod(address.value - base, words)
    return f"{kind}{first + number}" if 0 <= number <= 5 and not rest else OTHER


def tick_seconds(chip: Chip, counter: str) -> float | None:
    """How long one count lasts, in seconds; None: the counter stands, or counts something else."""
    block = f"{counter}Regs"
    if counter.startswith("CpuTimer"):
        if chip.register(block, "TCR").value & TSS:
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
