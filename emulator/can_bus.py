"""A CAN bus: frames as bits, arbitration, and whether a frame arrives or ends in an error.

    bus = CanBus(clock, "CAN-A")
    node = CanPart(bit_rate=500_000)
    bus.attach(node)
    node.send(CanFrame(0x123, b"\\x01\\x02"))

Modelled: standard and extended frames, data and remote; the length of each frame with its own stuff bits; arbitration
by the wired AND of the identifiers; acknowledgement; nodes of another bit rate; error frames; intermission, and the
suspended transmission of an error passive node.  `disturb` destroys frames, for tests of what a driver does then.
Not modelled: propagation and sampling within a bit, overload frames, CAN FD, a bit that one node sees differently from
the others: all nodes see an error.
Time: a receiver gets a frame at the last but one bit of the end of frame, the sender its confirmation at the last bit.
CHOICE: nodes whose bit times differ by more than 1 % do not understand each other.  Such a node finds its error in bit
13, and destroys the frame there if it is error active.
Sources: ISO 11898-1 (frame format, stuffing, CRC, fault confinement, bus idle).
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, Protocol

from emulator.clock import NEVER, SYSCLK_HZ, Clock, ClockEvent
from emulator.signal import Signal

#: Generator of the CRC: x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1.
CRC_POLYNOMIAL: Final = 0x4599
CRC_BITS: Final = 15
#: A stuff bit follows after this many equal bits.
STUFF_AFTER: Final = 5
#: Bits after the CRC: its delimiter, acknowledge slot and delimiter, end of frame.
EOF_BITS: Final = 7
TAIL_BITS: Final = 3 + EOF_BITS
INTERMISSION_BITS: Final = 3
#: Bits that an error passive node waits longer after it has sent.
SUSPEND_BITS: Final = 8
#: After this many recessive bits a node takes part in the traffic.
IDLE_BITS: Final = 11
#: Bits of an error flag, of the flags of the other nodes after it, and of the delimiter.
ERROR_FLAG_BITS: Final = 6
ERROR_DELIMITER_BITS: Final = 8
#: The bit at which a node of another bit rate detects its error.
FOREIGN_BIT: Final = 13
#: Two nodes understand each other if their bit times differ by no more than this part.
TOLERANCE: Final = 100
MAX_DATA: Final = 8
STANDARD_BITS: Final = 11
EXTENDED_BITS: Final = 29
#: After everything that makes a node want to send in the same cycle.
_ARBITRATION_PRIORITY: Final = 4


class CanError(enum.IntEnum):
    """The error of a frame, with the number that controllers use for it."""

    STUFF = 1
    FORM = 2
    ACK = 3
    BIT1 = 4
    BIT0 = 5
    CRC = 6


@dataclass(frozen=True)
class CanFrame:
    """A frame: of 11 bits of identifier, or of 29; a remote frame asks for `dlc` bytes and has none."""

    identifier: int
    data: bytes = b""
    extended: bool = False
    remote: bool = False
    #: The length code; None: that of the data.  9 to 15 mean 8 bytes too.
    dlc: int | None = None

    def __post_init__(self) -> None:
        bits = EXTENDED_BITS if self.extended else STANDARD_BITS
        if not 0 <= self.identifier < 1 << bits:
            raise ValueError(f"identifier {self.identifier:#x}: expected {bits} bits")
        if self.dlc is None:
            object.__setattr__(self, "dlc", len(self.data))
        code = self.length_code
        if not 0 <= code <= 15 or len(self.data) != (0 if self.remote else min(code, MAX_DATA)):
            raise ValueError(f"{len(self.data)} bytes of data with length code {code}")

    @property
    def length_code(self) -> int:
        """The four bits of the DLC."""
        return len(self.data) if self.dlc is None else self.dlc

    @property
    def arbitration(self) -> tuple[int, ...]:
        """The bits that decide the arbitration, RTR (SRR) and IDE included.  The least tuple wins."""
        rtr = int(self.remote)
        if not self.extended:
            return (*_bits(self.identifier, STANDARD_BITS), rtr, 0)
        low = EXTENDED_BITS - STANDARD_BITS
        return (*_bits(self.identifier >> low, STANDARD_BITS), 1, 1, *_bits(self.identifier & (1 << low) - 1, low), rtr)


def _bits(value: int, width: int) -> Iterator[int]:
    return (value >> bit & 1 for bit in range(width - 1, -1, -1))


def crc15(bits: Sequence[int]) -> int:
    """The CRC of bits without stuff bits."""
    crc = 0
    for bit in bits:
        turned = bit ^ crc >> CRC_BITS - 1
        crc = crc << 1 & (1 << CRC_BITS) - 1
        if turned & 1:
            crc ^= CRC_POLYNOMIAL
    return crc


def stuffed(bits: Sequence[int]) -> list[int]:
    """Insert a bit of the other level after every five equal bits; stuff bits count among the five."""
    out: list[int] = []
    last, run = -1, 0
    for bit in bits:
        run = run + 1 if bit == last else 1
        last = bit
        out.append(bit)
        if run == STUFF_AFTER:
            last, run = 1 - bit, 1
            out.append(last)
    return out


@lru_cache(maxsize=256)
def frame_bits(frame: CanFrame) -> tuple[int, ...]:
    """The levels of a frame as its sender sends them, from start of frame to end of frame; 0 is dominant."""
    head = [0, *frame.arbitration]
    # r0 behind IDE, or r1 and r0 behind RTR.
    head += [0, 0] if frame.extended else [0]
    head += _bits(frame.length_code, 4)
    for byte in frame.data:
        head += _bits(byte, 8)
    head += _bits(crc15(head), CRC_BITS)
    return (*stuffed(head), *[1] * TAIL_BITS)


class CanNode(Protocol):
    """A node of a bus."""

    @property
    def bit_cycles(self) -> int:
        """Its bit time in cycles."""

    @property
    def error_passive(self) -> bool:
        """Whether its error flags are recessive: they destroy nothing."""

    @property
    def acknowledges(self) -> bool:
        """Whether it sends the dominant bit of an acknowledgement."""

    @property
    def in_loopback(self) -> bool:
        """Whether it is in loopback: it takes its own frames as received and acknowledged."""

    @property
    def unconnected(self) -> bool:
        """Whether its pins are not connected.  Then it does not even see its own bits."""

    def follows_bus(self, now: int) -> bool:
        """Whether it follows a frame that begins now."""

    def earliest_start(self) -> int:
        """The first cycle at which it may begin its next frame; NEVER: it has none."""

    def offer(self) -> CanFrame:
        """The frame that it begins now."""

    def lost(self) -> None:
        """Another frame has won the arbitration."""

    def sent(self) -> None:
        """Its frame has arrived."""

    def received(self, frame: CanFrame) -> None:
        """A frame of another has arrived, or of itself if it hears itself."""

    def failed(self, error: CanError, sending: bool) -> None:
        """The frame that it was sending (`sending`) or receiving has ended in an error frame."""


class CanPort:
    """The pins of a controller: `connected` while a pin carries each of its lines, else `missing` says why not."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.missing = ""
        self._connected = True
        #: (): pins were connected to it or disconnected from it.
        self.changed: Signal[[]] = Signal()

    @property
    def connected(self) -> bool:
        """Whether frames pass."""
        return self._connected

    @connected.setter
    def connected(self, connected: bool) -> None:
        changed, self._connected = connected != self._connected, connected
        if changed:
            self.changed.emit()


class CanBus:
    """CANH and CANL with their terminators, and the nodes on them."""

    def __init__(self, clock: Clock, name: str) -> None:
        self.name = name
        self._clock = clock
        self._nodes: list[CanNode] = []
        #: (frame): at the end of every frame that arrives.
        self.arrived: Signal[CanFrame] = Signal()
        #: The nodes that send the present frame (several if they send the same one), and those that follow it.
        self._senders: list[CanNode] = []
        self._receivers: list[CanNode] = []
        self._frame: CanFrame | None = None
        self._begun = 0
        self._bit = 1
        self._event: ClockEvent | None = None
        self._attempt: ClockEvent | None = None
        #: The first cycle at which a frame may begin.
        self.free_at = 0
        self._disturbed: list[int] = []
        #: The error in which the present frame will end, if it does not arrive.
        self._failure = CanError.STUFF

    # Nodes

    def attach(self, node: CanNode) -> None:
        """Connect a node to the bus."""
        if node not in self._nodes:
            self._nodes.append(node)
            self.request()

    def detach(self, node: CanNode) -> None:
        """Disconnect a node.  A frame that it alone was sending breaks off, and the other nodes see an error."""
        if node not in self._nodes:
            return
        self._nodes.remove(node)
        self._receivers = [other for other in self._receivers if other is not node]
        if node in self._senders:
            self._senders.remove(node)
            if not self._senders:
                self._clock.cancel(self._event)
                self._end_badly(CanError.STUFF)

    def join(self, other: CanBus) -> None:
        """Join this bus to another one: its nodes and listeners are on the other bus from now on."""
        for node in self.nodes:
            self.detach(node)
            if isinstance(node, CanPart):
                node.connect(other)
            else:
                other.attach(node)
        other.arrived.connect(self.arrived.emit)

    @property
    def nodes(self) -> tuple[CanNode, ...]:
        """The nodes that are on the bus now."""
        return tuple(self._nodes)

    def report_loopback(self, frame: CanFrame) -> None:
        """Report a frame to listeners that a controller in loopback has put on its pin.  No node takes it."""
        self.arrived.emit(frame)

    def disturb(self, frames: int = 1, bit: int = 20) -> None:
        """Invert bit number `bit` of each of the next `frames` frames, as a disturbance on the line does."""
        if bit < 1 or frames < 0:
            raise ValueError(f"disturb bit {bit} of {frames} frames: expected a bit behind the start of frame")
        self._disturbed += [bit] * frames

    @property
    def busy(self) -> bool:
        """Whether a frame is on the bus."""
        return self._frame is not None

    def level(self, now: int) -> int:
        """The level at a time within the present frame, or between frames: 1 is recessive."""
        if self._frame is None:
            return 1
        at = (now - self._begun) // self._bit
        bits = frame_bits(self._frame)
        if at == len(bits) - TAIL_BITS + 1:  # the acknowledge slot
            return 0 if self._acknowledged() else 1
        return bits[at] if at < len(bits) else 1

    # Arbitration

    def request(self) -> None:
        """A node may have a frame to send, or its next frame may be due earlier than before."""
        if self._frame is not None:
            return
        first = min((node.earliest_start() for node in self._nodes), default=NEVER)
        self._clock.cancel(self._attempt)
        self._attempt = None
        if first < NEVER:
            at = max(first, self.free_at, self._clock.now)
            self._attempt = self._clock.schedule(at, self._arbitrate, _ARBITRATION_PRIORITY)

    def _arbitrate(self) -> None:
        self._attempt = None
        now = self._clock.now
        offers = [(node, node.offer()) for node in self._nodes if node.earliest_start() <= now]
        if not offers:
            self.request()
            return
        best = min(frame.arbitration for _, frame in offers)
        winners = [(node, frame) for node, frame in offers if frame.arbitration == best]
        losers = [node for node, frame in offers if frame.arbitration != best]
        self._senders = [node for node, _ in winners]
        first, self._frame = winners[0]
        self._begun, self._bit = now, first.bit_cycles
        self._receivers = [node for node in self._nodes if node not in self._senders and node.follows_bus(now)]
        for node in losers:
            node.lost()
        at, error = self._outcome([frame for _, frame in winners])
        if error is None:
            self._after_bits(at - 1, self._arrive)
        else:
            self._failure = error
            self._after_bits(at, self._fail)

    def _outcome(self, frames: Sequence[CanFrame]) -> tuple[int, CanError | None]:
        """How many bits pass until the frame has arrived or its error shows, and the error (None: it arrives)."""
        assert self._frame is not None
        bits = frame_bits(self._frame)
        ends: list[tuple[int, CanError]] = []
        spoilt = self._disturbed.pop(0) if self._disturbed else 0
        if spoilt:
            at = min(spoilt, len(bits) - 1)
            ends.append((at + 1, CanError.BIT1 if bits[at] else CanError.BIT0))
        if any(node.unconnected for node in self._senders):
            ends.append((1, CanError.BIT0))
        if any(not self._understands(node) and not node.error_passive for node in self._receivers):
            ends.append((FOREIGN_BIT, CanError.BIT1))
        for other in frames:
            mine = frame_bits(other)
            differ = next((n for n, (a, b) in enumerate(zip(bits, mine, strict=False)) if a != b), None)
            if differ is not None:
                ends.append((differ + 1, CanError.BIT1))
        if not self._acknowledged():
            ends.append((len(bits) - TAIL_BITS + 2, CanError.ACK))
        return min(ends) if ends else (len(bits), None)

    def _understands(self, node: CanNode) -> bool:
        return abs(node.bit_cycles - self._bit) * TOLERANCE <= self._bit

    def _acknowledged(self) -> bool:
        return len(self._senders) > 1 or any(node.in_loopback for node in self._senders) or any(
            node.acknowledges and self._understands(node) for node in self._receivers
        )

    def _after_bits(self, bits: int, callback: Callable[[], None]) -> None:
        self._event = self._clock.schedule(self._begun + bits * self._bit, callback)

    # The end of a frame

    def _arrive(self) -> None:
        """The last but one bit of the end of frame is over: the receivers have the frame."""
        frame = self._frame
        assert frame is not None
        self._event = self._clock.after(self._bit, self._complete)
        for node in [*self._receivers, *(sender for sender in self._senders if sender.in_loopback)]:
            if self._understands(node):
                node.received(frame)

    def _complete(self) -> None:
        frame, senders = self._frame, self._senders
        assert frame is not None
        self._release(INTERMISSION_BITS)
        for node in senders:
            node.sent()
        self.report_loopback(frame)
        self.request()

    def _fail(self) -> None:
        self._end_badly(self._failure)

    def _end_badly(self, error: CanError) -> None:
        senders, receivers = self._senders, self._receivers
        # The others see six equal bits when the flag of the first is over, and add theirs.
        echo = ERROR_FLAG_BITS if any(not node.error_passive for node in receivers) else 0
        self._release(ERROR_FLAG_BITS + echo + ERROR_DELIMITER_BITS + INTERMISSION_BITS)
        for node in senders:
            node.failed(error, True)
        for node in receivers:
            node.failed(CanError.FORM if error is CanError.ACK else CanError.STUFF, False)
        self.request()

    def _release(self, bits: int) -> None:
        self._frame, self._senders, self._receivers, self._event = None, [], [], None
        self.free_at = self._clock.now + bits * self._bit


class CanPart:
    """A node for boards and tests: sends what it is given, keeps what it receives in `frames`.

    To build your own node, override `received(frame)`.  It has no error counters: it is always error active, and
    repeats a frame until it has arrived.
    """

    error_passive: bool = False
    in_loopback: bool = False
    unconnected: bool = False

    def __init__(self, bit_rate: int = 500_000, *, acknowledges: bool = True) -> None:
        if not 0 < bit_rate <= 1_000_000:
            raise ValueError(f"{bit_rate} bits a second: expected 1 to 1000000")
        self.bit_cycles = round(SYSCLK_HZ / bit_rate)
        self.acknowledges = acknowledges
        self.frames: list[CanFrame] = []
        self.errors: list[CanError] = []
        self.waiting: list[CanFrame] = []
        self._bus: CanBus | None = None

    def connect(self, bus: CanBus) -> None:
        """Connect it to a bus, and disconnect it from any other."""
        if self._bus is not None:
            self._bus.detach(self)
        self._bus = bus
        bus.attach(self)

    def send(self, frame: CanFrame) -> None:
        """Send a frame as soon as the bus lets it."""
        if self._bus is None:
            raise ValueError("this node is on no bus")
        self.waiting.append(frame)
        self._bus.request()

    def follows_bus(self, now: int) -> bool:
        """It always follows."""
        return True

    def earliest_start(self) -> int:
        """At once, if there is a frame to send."""
        return 0 if self.waiting else NEVER

    def offer(self) -> CanFrame:
        """The frame that was given first."""
        return self.waiting[0]

    def lost(self) -> None:
        """It tries again."""

    def sent(self) -> None:
        """The next one."""
        self.waiting.pop(0)

    def received(self, frame: CanFrame) -> None:
        """Keep it."""
        self.frames.append(frame)

    def failed(self, error: CanError, sending: bool) -> None:
        """Keep the error; it tries again."""
        self.errors.append(error)
