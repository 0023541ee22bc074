"""I2C-A alone on a bus with targets that keep what they see, and what drivers do with it."""

from __future__ import annotations

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.i2c import I2c
from emulator.registers.i2c import I2cRegs
from emulator.signals import I2cBus

STT, STP, MST, TRX, RM, DLB, IRS = 0x2000, 0x0800, 0x0400, 0x0200, 0x0080, 0x0040, 0x0020
SEND = STT | MST | TRX | IRS
RECEIVE = STT | MST | IRS
NACKMOD = 0x8000
ARBL, NACK, ARDY, RRDY, XRDY, SCD = (1 << n for n in range(6))
XSMT, RSFULL, BB, NACKSNT = 0x0400, 0x0800, 0x1000, 0x2000

#: IPSC 19: the module's clock is 200/20 = 10 MHz; SCL 10 + 5 module clocks low and 5 + 5 high, with d = 5.
IPSC, ICCL, ICCH = 19, 10, 5
MODULE = IPSC + 1
BIT = MODULE * (ICCL + ICCH + 2 * 5)
BYTE = 9 * BIT
#: From the write of STT to the end of the START: a module clock, then SCL high for ICCH + d.
START = MODULE + MODULE * (ICCH + 5)


class Target:
    """Notes what it sees, with the time; answers with `answers`, refuses from its byte number `refuses` on."""

    def __init__(self, clock: Clock, address: int, *, answers: bytes = b"", refuses: int = 1 << 30) -> None:
        self.clock, self.address, self.refuses = clock, address, refuses
        self.present = True
        self.answers = list(answers)
        self.seen: list[str] = []
        self.times: list[int] = []

    def _note(self, what: str) -> None:
        self.seen.append(what)
        self.times.append(self.clock.now)

    def start(self) -> None:
        self._note("S")

    def addressed(self, reading: bool) -> bool:
        self._note("R" if reading else "W")
        return self.present

    def write(self, byte: int) -> bool:
        self._note(f"{byte:02x}")
        self.refuses -= 1
        return self.refuses >= 0

    def read(self) -> int:
        byte = self.answers.pop(0) if self.answers else 0xFF
        self._note(f"<{byte:02x}")
        return byte

    def stop(self) -> None:
        self._note("P")

    @property
    def text(self) -> str:
        return " ".join(self.seen)


class Bench:
    def __init__(self, *, ipsc: int = IPSC, iccl: int = ICCL, icch: int = ICCH, answers: bytes = b"") -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        cpu = Cpu(self.clock, self.findings)
        self.regs = I2cRegs("I2caRegs", 0x7300, cpu)
        self.bus = I2cBus("I2C-A")
        self.target = Target(self.clock, 0x50, answers=answers)
        self.bus.attach(0x50, self.target)
        #: Times of the basic interrupt, and of that of the FIFOs.
        self.basic: list[int] = []
        self.fifo: list[int] = []
        self.i2c = I2c(
            self.clock, cpu, self.regs, self.bus,
            lambda: self.basic.append(self.clock.now), lambda: self.fifo.append(self.clock.now),
        )  # fmt: skip
        self.regs.I2CPSC.all = ipsc
        self.regs.I2CCLKL = iccl
        self.regs.I2CCLKH = icch
        self.regs.I2CSAR.all = 0x50
        self.regs.I2CMDR.all = IRS

    def run(self, cycles: int = 1_000_000) -> None:
        """Let time pass."""
        self.clock.advance_to(self.clock.now + cycles)

    def has(self, flag: int) -> bool:
        """Whether a flag of I2CSTR is set."""
        return bool(self.regs.I2CSTR.all & flag)

    def send(self, *data: int, stop: bool = True) -> None:
        """A message by the polling of XRDY, as drivers do it."""
        regs = self.regs
        regs.I2CCNT = len(data)
        regs.I2CMDR.all = SEND | (STP if stop else 0)
        for byte in data:
            self.until(XRDY)
            regs.I2CDXR.all = byte
        self.run()

    def until(self, flag: int) -> None:
        """Wait for a flag."""
        while not self.has(flag):
            assert self.clock.pending, "nothing is left that could set the flag"
            self.clock.advance_to(self.clock.next)

    def rules(self) -> list[str]:
        return [finding.rule for finding in self.findings]
