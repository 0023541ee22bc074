"""Flags that keep the interrupt of a module back from the first one on, until a statement clears them.

    interrupt void Captured(void)
    {
        Width = ECap1Regs.CAP2 - ECap1Regs.CAP1;
        PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;      // ECFLG.INT stays set: this was the last interrupt
    }

A routine that only needs to run once is right without it: it stops the program, or it stores constants that nothing
takes back.

Sources: TRM eCAP, eQEP, ADC, SCI, SPI, I2C and CAN, interrupt flags; ePWM, event trigger and trip zone; PIE.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from emulator.blocks import BLOCKS
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Function, LValue, RegisterLoad, RegisterRef, Variable, While
from emulator.c28x.tree_queries import (
    NamedScalar,
    below,
    called,
    last_loop,
    named_scalar,
    parts,
    statements,
    within,
    without_end,
)


class InterruptFlag(NamedTuple):
    """A flag of one interrupt: its registers are those of `block`.  A field "" is the whole register."""

    block: str
    #: `ECFLG.INT`.
    flag: str
    #: Register, field and the value each of which clears it.  The first is the usual one.
    clears: tuple[tuple[str, str, int], ...]
    #: What has to be other than 0 for the interrupt.
    needs: tuple[tuple[str, str], ...]
    #: What has to be 0: with it the interrupt comes though the flag is set, or is the last one on purpose.
    without: tuple[tuple[str, str], ...] = ()


def _adc(k: int) -> tuple[InterruptFlag, ...]:
    select = "ADCINTSEL1N2" if k < 3 else "ADCINTSEL3N4"
    cleared = (("ADCINTFLGCLR", f"ADCINT{k}", 1),)
    return (InterruptFlag("", f"ADCINTFLG.ADCINT{k}", cleared, ((select, f"INT{k}E"),), ((select, f"INT{k}CONT"),)),)


def _fifo(module: str, way: str, enable: str, reset: str) -> InterruptFlag:
    register, on = f"{module}FF{way}", (f"{module}FFTX", enable)
    clears = ((register, f"{way}FFINTCLR", 1), (register, reset, 0), (*on, 0))
    return InterruptFlag("", f"{register}.{way}FFINT", clears, (on, (register, f"{way}FFIENA")))


def _can(line: int) -> tuple[InterruptFlag, ...]:
    needs = (("CAN_CTL", f"IE{line}"), ("CAN_GLB_INT_EN", f"GLBINT{line}_EN"))
    cleared = (("CAN_GLB_INT_CLR", f"INT{line}_FLG_CLR", 1),)
    return (InterruptFlag("", f"CAN_GLB_INT_FLG.INT{line}_FLG", cleared, needs),)


#: The first letters of a block -> for each of its interrupts (`pie` in `emulator/blocks.py`) the flags.
_KEPT: Final[dict[str, tuple[tuple[InterruptFlag, ...], ...]]] = {
    "ECap": ((InterruptFlag("", "ECFLG.INT", (("ECCLR", "INT", 1),), (("ECEINT", ""),)),),),
    "EPwm": (
        (InterruptFlag("", "ETFLG.INT", (("ETCLR", "INT", 1),), (("ETSEL", "INTEN"),)),),
        # A one-shot trip can be the end.
        (InterruptFlag("", "TZFLG.INT", (("TZCLR", "INT", 1),), (("TZEINT", "CBC"),), (
            ("TZEINT", "OST"), ("TZEINT", "DCAEVT1"), ("TZEINT", "DCBEVT1"),
        )),),
    ),
    "EQep": ((InterruptFlag("", "QFLG.INT", (("QCLR", "INT", 1),), (("QEINT", ""),)),),),
    "Adc": tuple(_adc(k) for k in range(1, 5)),
    "Sci": (
        (_fifo("SCI", "RX", "SCIFFENA", "RXFIFORESET"),),
        (_fifo("SCI", "TX", "SCIFFENA", "TXFIFORESET"),),
    ),
    "Spi": ((_fifo("SPI", "RX", "SPIFFENA", "RXFIFORESET"),), (_fifo("SPI", "TX", "SPIFFENA", "TXFIFO"),)),
    "I2c": ((), (_fifo("I2C", "RX", "I2CFFEN", "RXFFRST"), _fifo("I2C", "TX", "I2CFFEN", "TXFFRST"))),
    "Can": (_can(0), _can(1)),
}  # fmt: skip


def interrupt_flags() -> Iterator[tuple[int, int, InterruptFlag]]:
    """The flags of the modules' interrupts, each with the PIE group and number."""
    for name, block in BLOCKS.items():
        kept = next((flags for prefix, flags in _KEPT.items() if name.startswith(prefix)), ())
        for (group, n), flags in zip(block.pie, kept, strict=False):
            for flag in flags:
                yield group, n, flag._replace(block=name)


def acknowledged(group: int) -> InterruptFlag:
    """The bit of a PIE group that each of its routines has to acknowledge."""
    return InterruptFlag("PieCtrlRegs", f"PIEACK.ACK{group}", (("PIEACK", f"ACK{group}", 1),), ())


def routine_of(modules: Iterable[Module], begins: Place) -> Function | None:
    """The function that begins at a place."""
    for module in modules:
        for f in module.functions:
            if f.body and f.name == begins.function and f.where.file == begins.file:
                return f
    return None


def wanted_again(modules: Iterable[Module], routine: Function) -> bool:
    """Whether a routine of an interrupt does more than a first run has done: it counts, it takes values, or another
    statement takes back what it sets.
    """
    own = {f.path: f for module in modules for f in module.functions}
    ran = [s for f in below([routine.path], own) for s in statements(f.body)]
    if any(isinstance(s, While) and without_end(s) for s in ran):
        return False
    flags: dict[NamedScalar, set[int | None]] = {}
    for s in ran:
        match s:
            case Assign(target=LValue(root=Variable(kind="local" | "parameter"))):
                continue
            case Assign(target=RegisterRef(register=name)) if name.endswith("TOGGLE"):
                return True
            case Assign(target=LValue() as target, value=value) if constant_of(value) is not None:
                if (flag := named_scalar(target)) is not None:
                    flags.setdefault(flag, set()).add(constant_of(value))
            case Assign(target=target, value=value) if constant_of(value) is None:
                if isinstance(target, LValue) or not any(isinstance(p, RegisterLoad) for p in parts(value)):
                    return True
    main = next((f for f in own.values() if f.name == "main" and f.body), None)
    loop = last_loop(main) if main is not None else None
    behind = [loop] if loop is not None else []
    others = {f.path: f for f in below(called(within(behind)), own)}
    others |= {f.path: f for f in own.values() if f.interrupt}
    later = [*statements(behind), *(s for f in others.values() for s in statements(f.body))]
    return any(
        {constant_of(s.value)} != flags[flag]
        for s in later if isinstance(s, Assign) and isinstance(s.target, LValue)
        and (flag := named_scalar(s.target)) in flags
    )  # fmt: skip
