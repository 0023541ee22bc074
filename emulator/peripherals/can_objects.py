"""The 32 message objects of a CAN controller.  Part of `can.py`.

Modelled: which object accepts a frame (identifier, Xtd, mask, FIFO), what the object stores of it, which object is sent
next, remote frames and their answers.
CHOICE: only receive objects store data frames, and remote frames concern only transmit objects, whatever MDir is.
CHOICE: a frame of 11 bits sets the lower 18 bits of the object's identifier to 0.
CHOICE: the bytes of an object beyond the length of the frame do not change (the manual: not specified).
Sources: TRM CAN, message objects, message handling; Bosch C_CAN user's manual.
"""

from __future__ import annotations

from typing import Final

from emulator.can_bus import MAX_DATA, CanFrame

OBJECTS: Final = 32
#: Bits of the mask word.
MXTD: Final = 1 << 31
#: Bits of the arbitration word.
MSGVAL: Final = 1 << 31
XTD: Final = 1 << 30
DIR: Final = 1 << 29
ID: Final = (1 << 29) - 1
#: The lowest bit of an identifier of 11 bits in the word.
STANDARD_SHIFT: Final = 18
STANDARD_ID: Final = 0x7FF << STANDARD_SHIFT
#: Bits of the control word.
NEWDAT: Final = 1 << 15
MSGLST: Final = 1 << 14
INTPND: Final = 1 << 13
UMASK: Final = 1 << 12
TXIE: Final = 1 << 11
RXIE: Final = 1 << 10
RMTEN: Final = 1 << 9
TXRQST: Final = 1 << 8
EOB: Final = 1 << 7
DLC: Final = 0xF


class MessageObject:
    """One message object, in the format of the interface registers."""

    __slots__ = ("arbitration", "control", "data", "fresh", "mask", "read_again", "taken", "used")

    def __init__(self) -> None:
        self.mask = 0
        self.arbitration = 0
        self.control = 0
        #: Bytes 0 to 3, and 4 to 7, as words.
        self.data = [0, 0]
        #: Whether its message is still unread, and how often a message was read again because NewDat was still set.
        self.fresh = False
        self.read_again = 0
        #: Whether it has ever taken a frame.
        self.taken = False
        #: Whether the program has ever read its message.
        self.used = False

    @property
    def extended(self) -> bool:
        """Whether its identifier has 29 bits."""
        return bool(self.arbitration & XTD)

    @property
    def identifier(self) -> int:
        """Its identifier, of 11 or 29 bits."""
        return self.arbitration & ID if self.extended else (self.arbitration & ID) >> STANDARD_SHIFT

    def matches(self, frame: CanFrame) -> bool:
        """Acceptance filtering: identifier and its length, each as far as the mask wants it."""
        if not self.arbitration & MSGVAL or frame.remote != bool(self.arbitration & DIR):
            return False
        masked = bool(self.control & UMASK)
        if frame.extended != self.extended and (not masked or self.mask & MXTD):
            return False
        bits = self.mask & ID if masked else ID
        # CHOICE: bits that a frame of 11 bits does not have are not compared.
        bits &= ID if frame.extended else STANDARD_ID
        return not (_placed(frame) ^ self.arbitration) & bits

    def frame(self) -> CanFrame:
        """The frame that it sends: a data frame from a transmit object, a remote frame from a receive object."""
        code = self.control & DLC
        if not self.arbitration & DIR:
            return CanFrame(self.identifier, b"", self.extended, remote=True, dlc=code)
        return CanFrame(self.identifier, self.bytes()[: min(code, MAX_DATA)], self.extended, dlc=code)

    def bytes(self) -> bytes:
        """Its eight bytes."""
        return b"".join(word.to_bytes(4, "little") for word in self.data)

    def take(self, frame: CanFrame) -> None:
        """Store a frame that matches."""
        lost = MSGLST if self.control & NEWDAT else 0
        self._take_head(frame)
        data = frame.data + self.bytes()[len(frame.data) :]
        self.data = [int.from_bytes(data[at : at + 4], "little") for at in (0, 4)]
        self.control |= NEWDAT | lost | (INTPND if self.control & RXIE else 0)
        self.fresh = self.taken = True

    def take_remote(self, frame: CanFrame) -> bool:
        """Take a remote frame for a transmit object.  Returns whether it changes anything."""
        if self.control & RMTEN:
            self.control |= TXRQST
        elif self.control & UMASK:
            lost = MSGLST if self.control & NEWDAT else 0
            self._take_head(frame)
            self.control |= NEWDAT | lost | (INTPND if self.control & RXIE else 0)
        else:
            return False
        return True

    def _take_head(self, frame: CanFrame) -> None:
        self.arbitration = self.arbitration & (MSGVAL | DIR) | (XTD if frame.extended else 0) | _placed(frame)
        self.control = self.control & ~(DLC | TXRQST) | frame.length_code


def _placed(frame: CanFrame) -> int:
    """The identifier of a frame, at its position in the arbitration word."""
    return frame.identifier if frame.extended else frame.identifier << STANDARD_SHIFT


class MessageRam:
    """All objects, by their numbers from 1."""

    def __init__(self) -> None:
        self._objects = [MessageObject() for _ in range(OBJECTS)]

    def clear(self) -> None:
        """Every word 0."""
        self._objects[:] = [MessageObject() for _ in range(OBJECTS)]

    def __getitem__(self, number: int) -> MessageObject:
        return self._objects[number - 1]

    @staticmethod
    def valid(number: int) -> int:
        """The object that a message number means: 0 is the last one, 0x21 the first."""
        return (number - 1) % OBJECTS + 1

    def next_request(self) -> int:
        """The first object that waits for its transmission; 0: none does."""
        for number, each in enumerate(self._objects, 1):
            if each.control & TXRQST and each.arbitration & MSGVAL:
                return number
        return 0

    def receive(self, frame: CanFrame) -> int:
        """Give a frame to the first object that takes it.  Returns the number of the object, or 0.

        An object of a FIFO takes no frame while its last frame is unread, unless it is the last object of the FIFO.
        """
        for number, each in enumerate(self._objects, 1):
            if not each.matches(frame):
                continue
            if frame.remote:
                return number if each.take_remote(frame) else 0
            if each.control & EOB or not each.control & NEWDAT:
                each.take(frame)
                return number
        return 0

    def idle_receiver(self) -> int:
        """The first valid receive object that has never taken a frame; 0: there is none."""
        for number, each in enumerate(self._objects, 1):
            if each.arbitration & MSGVAL and not each.arbitration & DIR and not each.taken:
                return number
        return 0

    def flags(self, bit: int) -> int:
        """A bit of the control word of every object, object 1 in bit 0."""
        return sum(1 << n for n, each in enumerate(self._objects) if each.control & bit)

    def valid_objects(self) -> int:
        """MsgVal of every object."""
        return sum(1 << n for n, each in enumerate(self._objects) if each.arbitration & MSGVAL)
