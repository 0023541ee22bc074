"""System control: clock gates, software resets, clock dividers, locks, reset cause.

Modelled: PCLKCRx switch the registers of the modules that the board attaches, and tell their behaviour; TBCLKSYNC;
CPUSYSLOCK1 for PCLKCRx; SOFTPRESx; LSPCLK and EPWMCLK dividers; the bit clocks of the CAN modules; RESC.
Not modelled: PLL and oscillators (SYSCLK is 200 MHz from the first instruction), the 5 cycles that a module takes to
answer after its gate opens, low-power modes, trims; a clock at AUXCLKIN.
CHOICE: the crystal has 10 MHz, as on the LaunchPad.
Time: none; everything acts in the store.
Sources: TRM system control; HDR F2837xS_sysctrl.h, F2837xS_analogsubsys.h.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from functools import partial
from typing import Final

from emulator.clock import SYSCLK_HZ
from emulator.cpu import Cpu
from emulator.registers.core import ALL, Block
from emulator.registers.sysctrl import CPUSYSLOCK1, AnalogSubsysRegs, ClkCfgRegs, CpuSysRegs, DevCfgRegs
from emulator.signal import Signal

GATES: Final = ("PCLKCR0", "PCLKCR1", "PCLKCR2", "PCLKCR3", "PCLKCR4", "PCLKCR6", "PCLKCR7", "PCLKCR8", "PCLKCR9",
                "PCLKCR10", "PCLKCR11", "PCLKCR12", "PCLKCR13", "PCLKCR14", "PCLKCR16")  # fmt: skip
RESETS: Final = ("SOFTPRES2", "SOFTPRES3", "SOFTPRES4", "SOFTPRES7", "SOFTPRES8", "SOFTPRES9", "SOFTPRES13",
                 "SOFTPRES14", "SOFTPRES16")  # fmt: skip
#: Where CLKSRCCTL2 has the bit clock of a CAN module, and the cycles of SYSCLK and of the crystal.
CAN_SOURCE: Final = {"A": 2, "B": 4}
XTAL_HZ: Final = 10_000_000
CAN_CLOCKS: Final = {0: 1, 1: SYSCLK_HZ // XTAL_HZ}


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
        for name in GATES:
            cpusys.bind(name, write=partial(self._write_PCLKCRx, name, CPUSYSLOCK1.fields[name].mask))
        for name in RESETS:
            devcfg.bind(name, write=partial(self._write_SOFTPRESx, name))
        for name in ("LOSPCP", "PERCLKDIVSEL", "CLKSRCCTL2"):
            clkcfg.bind(name, write=partial(self._write_divider, name))

    def reset(self, cause: str = "POR") -> None:
        """Reset of the device.  `cause` is a field of RESC; any other than POR leaves earlier causes set."""
        resc = self._cpusys.registers["RESC"]
        causes = type(resc).fields
        if cause not in causes:
            raise ValueError(f"reset cause {cause}: want a field of RESC, such as {', '.join(causes)}")
        before = resc.value
        for block in (self._cpusys, self._clkcfg, self._devcfg, self._analog):
            block.reset()
        if cause != "POR":
            resc.value = before | causes[cause].mask
        for name in GATES:
            self._switch(name, -1)
        self.dividers_changed.emit()

    # --- what the board attaches -------------------------------------------------------------------------------------

    def gate(self, register: str, field: str, *blocks: Block, on_clock: Callable[[bool], None] | None = None) -> None:
        """Let `register`.`field` (`PCLKCR13`, `ADC_A`) switch the clock of `blocks`, and tell `on_clock(on)`.

        Both get the present state at once.  Raises ValueError for a gate that does not exist.
        """
        mask = self._mask(self._cpusys, self._gates.keys(), register, field)

        def switch(on: bool) -> None:
            for block in blocks:
                block.set_clock(on)
            if on_clock is not None:
                on_clock(on)

        self._gates[register].append((mask, switch))
        switch(bool(self._cpusys.registers[register].value & mask))

    def soft_reset(self, register: str, field: str, reset: Callable[[], None]) -> None:
        """Call `reset` when software writes 1 to `register`.`field` (`SOFTPRES13`, `ADC_A`)."""
        self._resets[register].append((self._mask(self._devcfg, self._resets.keys(), register, field), reset))

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
            raise ValueError(f"{block.name}.{register}.{field} is no gate or reset: want one of the header's names")
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
                self._doubt_can_clock(letter)
        self.dividers_changed.emit()

    def _doubt_can_clock(self, letter: str) -> None:
        if not self.can_cycles(letter):
            field = f"{self._clkcfg.registers['CLKSRCCTL2'].path}.CAN{letter}BCLKSEL"
            self._cpu.findings.report(
                "unmodelled", f"{field} chooses AUXCLKIN, or is reserved: CAN-{letter} has no bit clock here",
                object=field,
            )  # fmt: skip
