"""Applies feeds and faults to the board of a test, which has no start-up and no world."""

from __future__ import annotations

from collections.abc import Callable

from emulator.image import Firmware
from emulator.signal import Signal
from hil.board import Board


class BoardTarget:
    """A test's board as a `hil.faults.FaultTarget` and a `hil.feeds.feeding.FeedTarget`."""

    start_up_cycles = 0

    def __init__(self, board: Board, firmware: Callable[[], Firmware]) -> None:
        self.board = board
        self.clock = board.clock
        self.findings = board.findings
        #: (byte, end_cycles): the PC has a byte of the board.
        self.uart_sent: Signal[int, int] = Signal()
        #: The fed inputs, each with the function that ends the feed.
        self.feeds: dict[str, Callable[[], None]] = {}
        self._firmware = firmware
        if board.pc is not None:
            board.pc.line.received.connect(self._received)

    @property
    def firmware(self) -> Firmware:
        """The linked image of the test."""
        return self._firmware()

    def _received(self, data: bytes, cycles: int) -> None:
        for byte in data:
            self.uart_sent.emit(byte, cycles)
