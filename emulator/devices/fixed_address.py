"""Transactions of a register file whose address does not move: finds drivers that expect the next one: `burst-repeats`.

Writing a register twice in one transaction has no use.  Reading one twice may have: a status that is polled, a byte of
padding.  So a read is reported only if the register is the first half of a value of two bytes, at the second such
transaction, and if no transaction in between has read the other half alone.
"""

from __future__ import annotations

from emulator.devices.report import DeviceReport, Mark


class FixedAddress:
    """The transactions without auto-increment of one bus.

    `bit` is the name of the bit that would increment; `names` are the registers by their addresses.
    """

    __slots__ = ("_bit", "_names", "_part", "_report", "_suspected")

    def __init__(self, names: dict[int, str], report: DeviceReport, part: str, bit: str) -> None:
        self._names = names
        self._report = report
        self._part = part
        self._bit = bit
        #: First halves that one transaction has read several times.
        self._suspected: set[int] = set()

    def byte(self, number: int, address: int, reading: bool, since: Mark) -> None:
        """Data byte `number` (from 1) of a transaction that began at `since`."""
        if number == 1:
            self._suspected.discard(address ^ 1)
        if number != 2:
            return
        if reading and address not in self._suspected:
            if self._is_first_half(address):
                self._suspected.add(address)
            return
        name = self._names.get(address, f"{address:#04x}")
        again = "read from" if reading else "written to"
        self._report(
            "burst-repeats",
            f"{self._part}: the second byte of a transaction is {again} {name} again: {self._bit} is 0, so the address "
            "does not increment",
            object=f"{self._part}.{name}", since=since,
        )  # fmt: skip

    def _is_first_half(self, address: int) -> bool:
        """Whether the register and the next one are the low and the high byte of one value, by their names."""
        low, high = self._names.get(address, ""), self._names.get(address + 1, "")
        return low.endswith("_L") and high == f"{low[:-1]}H"
