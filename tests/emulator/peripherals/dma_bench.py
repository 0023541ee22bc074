"""A chip with its DMA on, for tests in register language; transfers go through RAMGS0 (0xC000) and on."""

from __future__ import annotations

from random import Random
from typing import Any

from emulator.chip import Chip
from emulator.registers.core import ALL

RAM = 0xC000
#: CONTROL
RUN, HALT, SOFTRESET, PERINTFRC, PERINTCLR, ERRCLR = 1, 2, 4, 8, 16, 128
OVRFLG, RUNSTS, BURSTSTS, TRANSFERSTS, PERINTFLG = 1 << 14, 1 << 13, 1 << 12, 1 << 11, 1 << 8
#: MODE
CHINTE, DATASIZE, CONTINUOUS, ONESHOT, CHINTMODE, PERINTE, OVRINTE = (1 << n for n in (15, 14, 11, 10, 9, 8, 7))


class DmaBench:
    """`chip`, and what channel `n` is told, by the names of its registers."""

    def __init__(self) -> None:
        self.chip = chip = Chip(rng=Random(0))
        self.write("CpuSysRegs", "PCLKCR0", 1 << 2)
        self.write("PieCtrlRegs", "PIECTRL", 1)
        self.clock, self.memory, self.findings = chip.clock, chip.memory, chip.findings

    def write(self, block: str, register: str, word: int) -> None:
        self.chip.cpu.eallow = True
        self.chip.register(block, register).write(word, ALL)
        self.chip.cpu.eallow = False

    def read(self, register: str, n: int = 1) -> int:
        return self.chip.register("DmaRegs", f"CH{n}.{register}").read()

    def control(self, word: int, n: int = 1) -> None:
        self.write("DmaRegs", f"CH{n}.CONTROL", word)

    def channel(self, n: int = 1, source: int = RAM, destination: int = RAM + 0x1000, **settings: Any) -> None:
        """Set the registers of a channel up; MODE gets PERINTE and PERINTSEL besides."""
        mode = settings.pop("MODE", 0) | PERINTE | n
        settings = {
            "SRC_BEG_ADDR_SHADOW": source, "SRC_ADDR_SHADOW": source,
            "DST_BEG_ADDR_SHADOW": destination, "DST_ADDR_SHADOW": destination,
        } | settings  # fmt: skip
        for name, word in settings.items():
            bits = self.chip.register("DmaRegs", f"CH{n}.{name}").bits
            self.write("DmaRegs", f"CH{n}.{name}", word & (1 << bits) - 1)
        self.write("DmaRegs", f"CH{n}.MODE", mode)

    def fill(self, base: int, words: list[int]) -> None:
        for i, word in enumerate(words):
            self.memory.write_word(base + i, word)

    def words(self, base: int, count: int) -> list[int]:
        return [self.memory.read_word(base + i) for i in range(count)]

    def pass_cycles(self, cycles: int) -> None:
        self.clock.advance_to(self.clock.now + cycles)

    def latched(self, n: int) -> bool:
        """Whether interrupt 7.`n` is latched in the PIE; it is cleared."""
        register = self.chip.register("PieCtrlRegs", "PIEIFR7")
        found = bool(register.value >> n - 1 & 1)
        register.value &= ~(1 << n - 1)
        return found
