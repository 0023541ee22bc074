"""Finds mistakes of DMA drivers: steps that leave words out, transfers beyond an object, data that is read too early.

Part of `dma.py`.  An object is one that the linker has placed; the memory after it belongs to other objects.  Nothing
here changes the words that are moved.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

from emulator.c28x.findings import Cause, Findings
from emulator.registers.cell import Cell
from emulator.registers.core import ALL

#: Registers whose last write is the place of findings about them.
CAUSES: Final = (
    "BURST_SIZE", "TRANSFER_SIZE", "SRC_BURST_STEP", "DST_BURST_STEP", "SRC_TRANSFER_STEP", "DST_TRANSFER_STEP",
    "SRC_ADDR_SHADOW", "DST_ADDR_SHADOW",
)  # fmt: skip
SIDES: Final = ("SRC", "DST")
#: The kind of a statement that only polls.
POLL: Final = "poll"


class Region(NamedTuple):
    """An object of the firmware: its first word address, how many words, and its name."""

    base: int
    words: int
    name: str

    def holds(self, address: int) -> bool:
        """Whether an address lies in it."""
        return self.base <= address < self.base + self.words


class TransferChecks:
    """The findings of one channel.  `region(address)` is the object there, None: there is none."""

    __slots__ = ("_causes", "_findings", "_mode", "_path", "_region", "_regions", "_registers", "moving", "used")

    def __init__(
        self, path: str, registers: dict[str, Cell], findings: Findings, region: Callable[[int], Region | None]
    ) -> None:
        self._path, self._registers, self._findings, self._region = path, registers, findings, region
        self._causes: dict[str, Cause | None] = {}
        self._mode: Cause | None = None
        #: The source and destination object of the transfer under way.
        self._regions: dict[str, Region | None] = {}
        #: The objects that transfers began in, each with the statement that gave its address.
        self.used: dict[str, Cause | None] = {}
        #: The objects of the transfer under way, while words move that only the program has triggered.
        self.moving: tuple[Region | None, Region | None] | None = None

    def write(self, name: str, word: int, lanes: int = ALL) -> None:
        """A register of `CAUSES` is written."""
        self._registers[name].store(word, lanes)
        self._causes[name] = self._findings.mark()

    def configured(self) -> None:
        """MODE was written."""
        self._mode = self._findings.mark()

    def started_again(self, left: int) -> None:
        """RUN was set within a transfer without ONESHOT that only the program triggers; `left` bursts still follow."""
        bursts = self._registers["TRANSFER_SIZE"].value + 1
        self._findings.report(
            "dma-unfinished",
            f"{self._path} is started again after {bursts - left} of {bursts} bursts: MODE.ONESHOT = 0, and each "
            "PERINTFRC moves one burst", object=f"{self._path}.MODE.ONESHOT", cause=self._mode,
        )  # fmt: skip

    # A transfer

    def begins(self, words: int, *, alone: bool) -> None:
        """A burst begins, in accesses of 1 or 2 `words`; `alone`: no module triggers the channel."""
        registers = self._registers
        if registers["TRANSFER_COUNT"].value == registers["TRANSFER_SIZE"].value:
            self._regions = {side: self._region(registers[f"{side}_ADDR_ACTIVE"].value) for side in SIDES}
            for side, region in self._regions.items():
                if region is not None:
                    self.used[region.name] = self._causes.get(f"{side}_ADDR_SHADOW")
                self._steps(side, words)
        if alone:
            self.moving = self._regions.get("SRC"), self._regions.get("DST")

    def _steps(self, side: str, words: int) -> None:
        """Report steps that do not fit accesses of so many words to a whole object."""
        region, value = self._regions[side], self._signed
        if region is None or region.words <= words or self._registers["BURST_SIZE"].value < words:
            return
        within, between = f"{side}_BURST_STEP", f"{side}_TRANSFER_STEP"
        steps = self._registers["TRANSFER_SIZE"].value and self._registers[f"{side}_WRAP_SIZE"].value
        # One word that is read again and again fills a block.
        fills = side == "SRC" and not value(within) and not (steps and value(between))
        verb = "reads" if side == "SRC" else "writes"
        if abs(value(within)) < words and not fills:
            self._step(within, f"each burst {verb} the same words of {region.name} again", words)
        elif steps and abs(value(between)) < words and not fills:
            self._step(between, f"each burst {verb} the last word of the burst before it again", words)

    def _step(self, name: str, what: str, words: int) -> None:
        self._findings.report(
            "dma-step",
            f"{self._path}.{name} = {self._signed(name)}: {what}; an access moves {16 * words} bits",
            object=f"{self._path}.{name}", cause=self._causes.get(name),
        )  # fmt: skip

    def check_object(self, side: str, address: int) -> bool:
        """Whether an access has left the object in which its transfer began.  Then report it."""
        region = self._regions.get(side)
        if region is None or region.holds(address):
            return False
        moved = (self._registers["BURST_SIZE"].value + 1) * (self._registers["TRANSFER_SIZE"].value + 1)
        verb = "reads" if side == "SRC" else "writes"
        sizes = (self._causes.get("TRANSFER_SIZE"), self._causes.get("BURST_SIZE"))
        self._findings.report(
            "dma-range",
            f"{self._path} {verb} {address:#x}, outside of {region.name}: a transfer has {moved} words, the object "
            f"{region.words}", object=f"{self._path}.{side}_ADDR_ACTIVE", cause=sizes[0] or sizes[1],
        )  # fmt: skip
        return True

    def touched(self, base: int, *, write: bool) -> None:
        """The CPU reads or writes an object, at its `base`, while words move (`moving`)."""
        assert self.moving is not None
        source, target = self.moving
        region = source if write else target
        findings = self._findings
        if region is None or region.base != base or findings.places[findings.position.innermost()].kind == POLL:
            return
        does = f"writes {region.name}, which the transfer reads" if write else f"reads {region.name}, which it writes"
        findings.report("dma-race", f"{self._path} is still moving words, and the program {does}", object=region.name)

    def _signed(self, name: str) -> int:
        word = self._registers[name].value
        return (word & 0xFFFF ^ 0x8000) - 0x8000
