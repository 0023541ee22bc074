"""Finds waits of an I2C driver for what the end of its message makes impossible.

A message that ended without a STOP holds the bus: BB stays 1 until the program sets STP or STT.  A message that ended
with a STOP brings no further byte: RRDY stays 0.  A driver that polls for these gives up after many polls, resets the
module, and begins again: it never works, and nothing tells why.  Both are reported when the module is reset, at the
statement that set STT.
Time: I2CSTR has a tap from the end of a message to the next command.
Sources: TRM I2C: I2CSTR, I2CCNT, bus activity by RM, STT and STP.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.findings import Cause, Findings
from emulator.clock import CYCLES_PER_MS, Clock
from emulator.registers.cell import Cell
from emulator.registers.i2c import I2CSTR, I2cRegs

#: CHOICE: so many reads of I2CSTR, over so long, are a wait for something.
MANY_READS: Final = 1000
LONG_CYCLES: Final = CYCLES_PER_MS // 2
_FAILED: Final = I2CSTR.NACK.mask | I2CSTR.ARBL.mask


class VainWaits:
    """What the program does between the end of a message and its next command."""

    __slots__ = (
        "_clock", "_findings", "_held", "_mdr", "_name", "_reads", "_receiver", "_since", "_started_by", "_str",
        "wanted",
    )  # fmt: skip

    def __init__(self, clock: Clock, findings: Findings, regs: I2cRegs) -> None:
        self._clock, self._findings, self._name = clock, findings, regs.name
        self._str, self._mdr = regs.registers["I2CSTR"], regs.registers["I2CMDR"]
        #: When the message ended; None: no message has ended since the last command.
        self._since: int | None = None
        self._reads = 0
        self._held = self._receiver = False
        #: The bytes of the message.
        self.wanted = 0
        #: The statement that set STT last.
        self._started_by: Cause | None = None

    def started(self) -> None:
        """The program has set STT."""
        self._started_by = self._findings.mark()
        self._forget()

    def ended(self, *, held: bool, receiver: bool) -> None:
        """A message is over; `held`: without a STOP."""
        self._forget()
        self._since, self._reads, self._held, self._receiver = self._clock.now, 0, held, receiver
        self._str.tap(self._seen, reads=True)

    def reset(self) -> None:
        """IRS was cleared."""
        since, reads = self._since, self._reads
        self._forget()
        if since is None or reads < MANY_READS or self._clock.now - since < LONG_CYCLES or self._str.value & _FAILED:
            return
        if self._held:
            self._findings.report(
                "i2c-left-busy",
                f"{self._name}: the message begins without STP, and nothing ends it: BB stays 1, and the program has "
                f"read {self._str.path} {reads} times before it reset the module",
                object=f"{self._mdr.path}.STP", cause=self._started_by,
            )  # fmt: skip
        elif self._receiver:
            self._findings.report(
                "i2c-count",
                f"{self._name}: this message ends after I2CCNT = {self.wanted}, so no further byte comes, and the "
                f"program has read {self._str.path} {reads} times after its end before it reset the module",
                object=f"{self._name}.I2CCNT", value=self.wanted, cause=self._started_by,
            )  # fmt: skip

    def _seen(self, _register: Cell, access: str, _word: int, _mask: int) -> None:
        if access == "read":
            self._reads += 1

    def _forget(self) -> None:
        if self._since is not None:
            self._since = None
            self._str.untap(self._seen)
