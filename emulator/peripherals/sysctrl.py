"""System control: clock gates, software resets, clock dividers, locks, reset cause.

Modelled: PCLKCRx, which switch the registers of the modules that the board attaches, and inform the modules;
TBCLKSYNC; CPUSYSLOCK1 for PCLKCRx; SOFTPRESx; LSPCLK and EPWMCLK dividers; the bit clocks of the CAN modules; RESC; the
wait for the PLL's lock; the clock of CPU timer 2, with AUXPLLCLK as one.
Not modelled: a SYSCLK other than 200 MHz.  SYSCLK is 200 MHz from the first instruction; if PLL, divider and oscillator
are set to another frequency for `_SETTLED`, that is reported.  Not modelled either: the 5 cycles that a module takes to
answer after its gate opens, low-power modes, trims, a clock at AUXCLKIN.
Time: everything takes effect at the write, except LOCKS, which comes `PLL_LOCK` after a multiplier was written.
CHOICE: the crystal of the CAN has 10 MHz, as on the LaunchPad.
CHOICE: for CPU timer 2 an oscillator has the frequency from which PLL and divider, as they are set, make SYSCLK; it has
10 MHz while the PLL is off.  So code that compares SYSCLK with its oscillator, as TI's start-up code does, finds the
ratio that it has set.  Once a right program has set the PLL up, an oscillator has its true frequency.
Sources: TRM system control; HDR F2837xS_sysctrl.h, F2837xS_analogsubsys.h.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import CYCLES_PER_US, SYSCLK_HZ, ClockEvent
from emulator.cpu import Cpu
from emulator.registers.cell import Cell
from emulator.registers.core import ALL, Block
from emulator.registers.sysctrl import (
    AUXPLLCTL1,
    CPUSYSLOCK1,
    SYSPLLCTL1,
    SYSPLLSTS,
    AnalogSubsysRegs,
    ClkCfgRegs,
    CpuSysRegs,
    DevCfgRegs,
)
from emulator.signal import Signal

GATES: Final = tuple(name for name in CpuSysRegs.layout if name.startswith("PCLKCR"))
RESETS: Final = tuple(name for name in DevCfgRegs.layout if name.startswith("SOFTPRES"))
#: The position of a CAN module's bit clock field in CLKSRCCTL2, and the SYSCLK cycles of its two clocks.
CAN_SOURCE: Final = {"A": 2, "B": 4}
XTAL_HZ: Final = 10_000_000
CAN_CLOCKS: Final = {0: 1, 1: SYSCLK_HZ // XTAL_HZ}
#: CHOICE: 50 us and 2500 periods of an oscillator of 10 MHz (as remembered from the data sheet, not confirmed).
PLL_LOCK: Final = (50 + 2500 // 10) * CYCLES_PER_US
#: SYSCLK cycles of one period of an oscillator of 10 MHz.
_WITHOUT_PLL: Final = 20
#: The internal oscillators, and the crystals that the part takes (DS).
_OSC_HZ: Final = 10_000_000
_CRYSTALS_HZ: Final = (10_000_000, 20_000_000)
_XTAL: Final = 1
#: Start-up code lets SYSCLK run slower for a while before it sets the last divider.
_SETTLED: Final = 1000 * CYCLES_PER_US
#: TMR2CLKSRCSEL: SYSCLK; AUXPLLCLK; INTOSC1, INTOSC2, XTAL and AUXPLLCLK (HDR cputimer.h of driverlib).
_SYSCLK: Final = 0
_AUXPLL: Final = 6
_OTHER_CLOCKS: Final = (1, 2, 3, 6)
#: TMR2CLKPRESCALE: /1 to /16.
_MAX_PRESCALE: Final = 4


class SysCtrl:
    """Clock gates and dividers of one device."""

    def __init__(self, cpu: Cpu, cpusys: CpuSysRegs, clkcfg: ClkCfgRegs, devcfg: DevCfgRegs,
                 analog: AnalogSubsysRegs) -> None:  # fmt: skip
        self._cpu = cpu
        self._cpusys, self._clkcfg, self._devcfg, self._analog = cpusys, clkcfg, devcfg, analog
        self._gates: dict[str, list[tuple[int, Callable[[bool], None]]]] = {name: [] for name in GATES}
        self._resets: dict[str, list[tuple[int, Callable[[], None]]]] = {name: [] for name in RESETS}
        #: (): LSPCLK, EPWMCLK or a bit clock of CAN changes.
        self.dividers_changed: Signal[[]] = Signal()
        #: (cycles): CPU timer 2 counts every so many SYSCLK cycles from now on.
        self.timer2_changed: Signal[int] = Signal()
        self._locking: ClockEvent | None = None
        #: The event when PLL, divider and oscillator are checked for 200 MHz, and the statement that set them last.
        self._settling: ClockEvent | None = None
        self._set_by: Cause | None = None
        for name in GATES:
            cpusys.bind(name, write=partial(self._write_PCLKCRx, name, CPUSYSLOCK1.fields[name].mask))
        for name in RESETS:
            devcfg.bind(name, write=partial(self._write_SOFTPRESx, name))
        for name in ("LOSPCP", "PERCLKDIVSEL", "CLKSRCCTL2"):
            clkcfg.bind(name, write=partial(self._write_divider, name))
        clkcfg.bind("SYSPLLMULT", write=self._write_SYSPLLMULT)
        clkcfg.bind("SYSCLKDIVSEL", write=self._write_SYSCLKDIVSEL)
        for name in ("CLKSRCCTL1", "SYSPLLCTL1"):
            clkcfg.bind(name, write=partial(self._write_source, clkcfg.registers[name]))
        for name in ("AUXPLLCTL1", "AUXPLLMULT", "AUXCLKDIVSEL"):
            clkcfg.bind(name, write=partial(self._write_aux, clkcfg.registers[name]))
        cpusys.bind("TMR2CLKCTL", write=self._write_TMR2CLKCTL)

    def reset(self, cause: str = "POR") -> None:
        """Reset of the device.  `cause` is a field of RESC; any other than POR leaves earlier causes set."""
        resc = self._cpusys.registers["RESC"]
        causes = type(resc).fields
        if cause not in causes:
            raise ValueError(f"reset cause {cause}: expected a field of RESC, such as {', '.join(causes)}")
        before = resc.value
        for block in (self._cpusys, self._clkcfg, self._devcfg, self._analog):
            block.reset()
        if cause != "POR":
            resc.value = before | causes[cause].mask
        for name in GATES:
            self._switch(name, -1)
        self.dividers_changed.emit()
        self._cpu.clock.cancel(self._locking)
        self._cpu.clock.cancel(self._settling)
        self._tell_timer2()

    # --- for the board -----------------------------------------------------------------------------------------------

    def gate(self, register: str, field: str, *blocks: Block, on_clock: Callable[[bool], None] | None = None) -> None:
        """Let `register`.`field` (`PCLKCR13`, `ADC_A`) call `on_clock(on)`, and switch the clock of `blocks`.

        Both get the present state at once.  Raises ValueError for a gate that does not exist.
        """
        mask = self._mask(self._cpusys, self._gates.keys(), register, field)

        def switch(on: bool) -> None:
            if on_clock is not None:
                on_clock(on)
            for block in blocks:
                block.set_clock(on)

        self._gates[register].append((mask, switch))
        switch(bool(self._cpusys.registers[register].value & mask))

    def soft_reset(self, register: str, field: str, reset: Callable[[], None]) -> None:
        """Call `reset` when software writes 1 to `register`.`field` (`SOFTPRES13`, `ADC_A`)."""
        self._resets[register].append((self._mask(self._devcfg, self._resets.keys(), register, field), reset))

    def start_pll(self, multiplier: int) -> None:
        """Act as software that writes SYSPLLMULT, without a report that the PLL is not modelled."""
        self._write_SYSPLLMULT(multiplier)

    def run_pll(self, divider: int) -> None:
        """Act as software that writes PLLSYSCLKDIV and sets PLLCLKEN, also without a report."""
        self._clkcfg.registers["SYSPLLCTL1"].value |= SYSPLLCTL1.PLLCLKEN.mask
        self._write_SYSCLKDIVSEL(divider)

    def check_sysclk(self) -> None:
        """Report a SYSCLK that is set to another frequency than the 200 MHz that it has here.

        CHOICE: the board's crystal is not known.  Any crystal that would give 200 MHz is taken as right.
        """
        self._cpu.clock.cancel(self._settling)
        clkcfg = self._clkcfg.registers
        divider = 2 * (clkcfg["SYSCLKDIVSEL"].value & 0x3F) or 1
        on = clkcfg["SYSPLLCTL1"].value & SYSPLLCTL1.PLLCLKEN.mask
        factor = (_quarters(clkcfg["SYSPLLMULT"]) if on else 4) / 4 / divider
        crystal = clkcfg["CLKSRCCTL1"].value & 3 == _XTAL
        low, high = _CRYSTALS_HZ if crystal else (_OSC_HZ, _OSC_HZ)
        if not low * factor <= SYSCLK_HZ <= high * factor:
            made = f"{low * factor / 1e6:g} MHz" + (f" with a crystal of {low / 1e6:g} MHz" if crystal else "")
            self._cpu.findings.report(
                "unmodelled", f"SYSCLK is set to {made}, which is not modelled: it is {SYSCLK_HZ / 1e6:g} MHz here",
                object=clkcfg["SYSPLLMULT"].path, value=clkcfg["SYSPLLMULT"].value, cause=self._set_by,
            )  # fmt: skip

    @property
    def sysclk_shares(self) -> frozenset[float]:
        """The frequencies that SYSCLK can have on the user's board, as shares of the 200 MHz that it has here.

        They are more than one if the program makes it from a crystal, and if both crystals of TI's boards are allowed:
        10 MHz (LaunchPads) and 20 MHz (controlCARDs).
        """
        clkcfg = self._clkcfg.registers
        if clkcfg["CLKSRCCTL1"].value & 3 != _XTAL or not clkcfg["SYSPLLCTL1"].value & SYSPLLCTL1.PLLCLKEN.mask:
            return frozenset({1.0})
        factor = _quarters(clkcfg["SYSPLLMULT"]) / 4 / (2 * (clkcfg["SYSCLKDIVSEL"].value & 0x3F) or 1)
        return frozenset({1.0} | {hz * factor / SYSCLK_HZ for hz in _CRYSTALS_HZ if 0 < hz * factor < SYSCLK_HZ})

    @property
    def timer2_cycles(self) -> int:
        """SYSCLK cycles between two counts of CPU timer 2's input.  CHOICE: whole ones."""
        control = self._cpusys.registers["TMR2CLKCTL"].value
        source = control & 7
        if source not in _OTHER_CLOCKS:
            return 1
        clkcfg = self._clkcfg.registers
        quarters = _quarters(clkcfg["SYSPLLMULT"])
        divider = 2 * (clkcfg["SYSCLKDIVSEL"].value & 0x3F) or 1
        cycles = quarters / (4 * divider) if quarters > 3 else _WITHOUT_PLL
        if source == _AUXPLL:
            on = clkcfg["AUXPLLCTL1"].value & AUXPLLCTL1.PLLCLKEN.mask
            factor = _quarters(clkcfg["AUXPLLMULT"]) / 4 if on else 1.0
            cycles = cycles * (1 << (clkcfg["AUXCLKDIVSEL"].value & 3)) / max(factor, 1.0)
        return max(1, round(cycles)) << min(control >> 3 & 7, _MAX_PRESCALE)

    @property
    def lspclk_divider(self) -> int:
        """SYSCLK cycles of one LSPCLK: LSPCLKDIV 0 is /1, n is /2n."""
        return 2 * (self._clkcfg.registers["LOSPCP"].value & 7) or 1

    @property
    def lspclk_hz(self) -> float:
        """Frequency of LSPCLK."""
        return SYSCLK_HZ / self.lspclk_divider

    @property
    def epwmclk_divider(self) -> int:
        """SYSCLK cycles of one EPWMCLK: 1 or 2.  CHOICE: the reserved codes 2 and 3 divide as their low bit."""
        return 1 + (self._clkcfg.registers["PERCLKDIVSEL"].value & 1)

    def can_cycles(self, letter: str) -> int:
        """SYSCLK cycles of one bit clock of a CAN module: SYSCLK or the crystal's; 0: it has none."""
        source = self._clkcfg.registers["CLKSRCCTL2"].value >> CAN_SOURCE[letter] & 3
        return CAN_CLOCKS.get(source, 0)

    @property
    def tbclksync(self) -> bool:
        """Whether the time bases of the ePWM modules run."""
        return bool(self._cpusys.registers["PCLKCR0"].value & 1 << 18)

    @staticmethod
    def _mask(block: Block, names: Container[str], register: str, field: str) -> int:
        fields = type(block.registers[register]).fields if register in block.registers else {}
        if field not in fields or register not in names:
            raise ValueError(f"{block.name}.{register}.{field} is no gate or reset: expected one of the header's names")
        return fields[field].mask

    # --- register handlers -------------------------------------------------------------------------------------------

    def _write_PCLKCRx(self, name: str, lock: int, word: int, lanes: int = ALL) -> None:
        if self._cpusys.registers["CPUSYSLOCK1"].value & lock:
            self._cpu.findings.report("locked", f"{self._cpusys.name}.{name} is locked by CPUSYSLOCK1: the write was "
                                      "dropped", object=f"{self._cpusys.name}.{name}", value=word)  # fmt: skip
            return
        register = self._cpusys.registers[name]
        before = register.value
        register.store(word, lanes)
        self._switch(name, before ^ register.value)

    def _switch(self, name: str, changed: int) -> None:
        value = self._cpusys.registers[name].value
        for mask, switch in self._gates[name]:
            if changed & mask:
                switch(bool(value & mask))

    def _write_SOFTPRESx(self, name: str, word: int, lanes: int = ALL) -> None:
        # CHOICE: the reset acts when its bit rises; a module held in reset still takes accesses.
        register = self._devcfg.registers[name]
        before = register.value
        register.store(word, lanes)
        for mask, reset in self._resets[name]:
            if register.value & ~before & mask:
                reset()

    def _write_divider(self, name: str, word: int, lanes: int = ALL) -> None:
        self._clkcfg.registers[name].store(word, lanes)
        if name == "CLKSRCCTL2":
            for letter in CAN_SOURCE:
                self._check_can_clock(letter)
        self.dividers_changed.emit()

    def _check_can_clock(self, letter: str) -> None:
        if not self.can_cycles(letter):
            field = f"{self._clkcfg.registers['CLKSRCCTL2'].path}.CAN{letter}BCLKSEL"
            self._cpu.findings.report(
                "unmodelled", f"{field} chooses AUXCLKIN, or is reserved: CAN-{letter} has no bit clock here",
                object=field,
            )  # fmt: skip
    def _write_SYSPLLMULT(self, word: int, lanes: int = ALL) -> None:
        # A multiplier turns the PLL on, which locks anew.
        clkcfg, clock = self._clkcfg.registers, self._cpu.clock
        clkcfg["SYSPLLMULT"].store(word, lanes)
        clkcfg["SYSPLLCTL1"].value |= SYSPLLCTL1.PLLEN.mask
        clkcfg["SYSPLLSTS"].value &= ~SYSPLLSTS.LOCKS.mask
        clock.cancel(self._locking)
        self._locking = clock.after(PLL_LOCK, self._lock)
        self._settle()
        self._tell_timer2()

    def _lock(self) -> None:
        self._locking = None
        self._clkcfg.registers["SYSPLLSTS"].value |= SYSPLLSTS.LOCKS.mask

    def _write_SYSCLKDIVSEL(self, word: int, lanes: int = ALL) -> None:
        self._clkcfg.registers["SYSCLKDIVSEL"].store(word, lanes)
        self._settle()
        self._tell_timer2()

    def _write_source(self, register: Cell, word: int, lanes: int = ALL) -> None:
        register.store(word, lanes)
        self._settle()

    def _settle(self) -> None:
        """A setting of SYSCLK was written.  Check SYSCLK once its settings have not changed for a while."""
        clock = self._cpu.clock
        self._set_by = self._cpu.findings.mark()
        clock.cancel(self._settling)
        self._settling = clock.after(_SETTLED, self.check_sysclk)

    def _write_TMR2CLKCTL(self, word: int, lanes: int = ALL) -> None:
        register = self._cpusys.registers["TMR2CLKCTL"]
        register.store(word, lanes)
        source = register.value & 7
        if source != _SYSCLK and source not in _OTHER_CLOCKS:
            path = f"{register.path}.TMR2CLKSRCSEL"
            message = f"{path} = {source} is reserved: CPU timer 2 counts SYSCLK here"
            self._cpu.findings.report("unmodelled", message, object=path, value=source)
        self._tell_timer2()

    def _write_aux(self, register: Cell, word: int, lanes: int = ALL) -> None:
        register.store(word, lanes)
        self._tell_timer2()

    def _tell_timer2(self) -> None:
        self.timer2_changed.emit(self.timer2_cycles)


def _quarters(register: Cell) -> int:
    """The multiplier of a PLL, in quarters."""
    return 4 * (register.value & 0x7F) + (register.value >> 8 & 3)
