"""One SCI at 9600 baud with its two lines, for the tests of both halves.

BRR 650, LSPCLK = SYSCLK/4, so a bit lasts 8 * 651 * 4 = 20 832 cycles and 8N1 208 320.
"""

from __future__ import annotations

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.sci import Sci
from emulator.registers.sci import SciRegs
from emulator.signals import SerialFrame, SerialLine

BIT = 20_832
FRAME = 10 * BIT
FIFO_ON = 0xE000


class Bench:
    def __init__(self, ccr: int = 7, brr: int = 650, *, fifo: bool = False) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.regs = SciRegs("ScicRegs", 0x7220, Cpu(self.clock, self.findings))
        self.tx_line, self.rx_line = SerialLine("tx"), SerialLine("rx")
        self.sent: list[SerialFrame] = []
        self.tx_line.sent.connect(self.sent.append)
        self.rx: list[int] = []
        self.tx: list[int] = []
        self.sci = Sci(
            self.clock, self.regs.cpu, self.regs, self.tx_line, self.rx_line,
            lambda: self.rx.append(self.clock.now), lambda: self.tx.append(self.clock.now),
        )  # fmt: skip
        self.regs.SCICCR.all = ccr
        self.regs.SCIHBAUD.all = brr >> 8
        self.regs.SCILBAUD.all = brr & 0xFF
        if fifo:
            self.regs.SCIFFTX.all = FIFO_ON
            self.regs.SCIFFRX.all = 0x2000 | 0x1F
        self.regs.SCICTL1.all = 0x23

    def put(self, data: int) -> None:
        self.regs.SCITXBUF.all = data

    def receive(self, data: int, bit: float = BIT, **other: object) -> None:
        """A peer sends one character, beginning now."""
        frame = SerialFrame(data, self.clock.now, self.clock.now + round(10 * bit), bit, **other)  # type: ignore[arg-type]
        self.clock.advance_to(frame.end)
        self.rx_line.send(frame)

    def pass_bits(self, bits: float) -> None:
        self.clock.advance_to(self.clock.now + round(bits * BIT))
