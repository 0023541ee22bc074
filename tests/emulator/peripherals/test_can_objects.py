"""Message objects of the CAN against a second model: which object takes a frame, and what it holds then."""

from __future__ import annotations

from dataclasses import dataclass

from hypothesis import given
from hypothesis import strategies as st

from emulator.can_bus import CanFrame
from emulator.peripherals.can_objects import MessageRam


@dataclass
class Mailbox:
    """An object as a reader of the manual sees it: every field by itself."""

    valid: bool = False
    transmit: bool = False
    extended: bool = False
    identifier: int = 0
    use_mask: bool = False
    mask: int = 0
    mask_extended: bool = False
    last: bool = True
    remote_enable: bool = False
    new: bool = False
    lost: bool = False
    request: bool = False
    receive_interrupt: bool = False
    pending: bool = False
    length: int = 0
    data: bytes = bytes(8)

    @property
    def words(self) -> tuple[int, int, int]:
        """Mask, arbitration and control as the interface registers have them (TRM)."""
        # An identifier or mask of 11 bits stands in 28:18.
        shift = 0 if self.extended else 18
        return (
            self.mask_extended << 31 | self.mask << shift,
            self.valid << 31 | self.extended << 30 | self.transmit << 29 | self.identifier << shift,
            self.new << 15 | self.lost << 14 | self.pending << 13 | self.use_mask << 12 | self.receive_interrupt << 10
            | self.remote_enable << 9 | self.request << 8 | self.last << 7 | self.length,
        )  # fmt: skip

    def would_take(self, frame: CanFrame) -> bool:
        """Acceptance filtering, bit by bit from the top of the identifier."""
        if not self.valid or self.transmit != frame.remote:
            return False
        if self.extended != frame.extended and (not self.use_mask or self.mask_extended):
            return False
        mine = f"{self.identifier:029b}" if self.extended else f"{self.identifier:011b}" + 18 * "0"
        wanted = 29 * "1" if not self.use_mask else (
            f"{self.mask:029b}" if self.extended else f"{self.mask:011b}" + 18 * "0"
        )
        its = f"{frame.identifier:0{29 if frame.extended else 11}b}"
        return all(m == i for m, i, w in zip(mine, its, wanted, strict=False) if w == "1")

    def take(self, frame: CanFrame) -> None:
        """What a frame leaves in it."""
        if frame.remote and self.remote_enable:
            self.request = True
            return
        if frame.remote and not self.use_mask:
            return
        if self.extended != frame.extended:
            # The mask keeps its place in the register when the object's identifier changes its length.
            self.mask = self.mask >> 18 if self.extended else self.mask << 18
        self.extended, self.identifier, self.length = frame.extended, frame.identifier, frame.length_code
        self.lost |= self.new
        self.new = True
        self.request = False
        self.pending |= self.receive_interrupt
        self.data = frame.data + self.data[len(frame.data) :]


@st.composite
def mailboxes(draw: st.DrawFn) -> Mailbox:
    extended = draw(st.booleans())
    # Few bits, so that frames and objects meet.
    top = 18 if extended else 0
    flags = [draw(st.booleans()) for _ in range(7)]
    return Mailbox(
        valid=draw(st.integers(0, 4)) > 0, transmit=draw(st.booleans()), extended=extended,
        identifier=draw(st.integers(0, 3)) << top, use_mask=flags[0],
        mask=draw(st.sampled_from([0, 1, 2, 3, 0x7FF])) << top, mask_extended=flags[1], last=flags[2],
        remote_enable=flags[3], new=flags[4], receive_interrupt=flags[5], request=flags[6],
        data=draw(st.binary(min_size=8, max_size=8)),
    )  # fmt: skip


@st.composite
def arriving(draw: st.DrawFn) -> CanFrame:
    extended = draw(st.booleans())
    identifier = draw(st.integers(0, 3)) << (18 if extended else 0)
    if draw(st.booleans()):
        return CanFrame(identifier, b"", extended, remote=True, dlc=draw(st.integers(0, 8)))
    return CanFrame(identifier, draw(st.binary(max_size=8)), extended)


@given(boxes=st.lists(mailboxes(), min_size=1, max_size=6), frames=st.lists(arriving(), max_size=8))
def test_frames_end_in_the_objects_of_the_model(boxes: list[Mailbox], frames: list[CanFrame]) -> None:
    ram = MessageRam()
    for number, box in enumerate(boxes, 1):
        ram[number].mask, ram[number].arbitration, ram[number].control = box.words
        ram[number].data = [int.from_bytes(box.data[at : at + 4], "little") for at in (0, 4)]
    for frame in frames:
        ram.receive(frame)
        for box in boxes:
            # A remote frame is for the first transmit object that matches; of a FIFO the first object that is free.
            if box.would_take(frame) and (frame.remote or box.last or not box.new):
                box.take(frame)
                break
    for number, box in enumerate(boxes, 1):
        each = ram[number]
        assert (each.mask & 0x9FFF_FFFF, each.arbitration, each.control) == box.words, number
        assert each.bytes() == box.data, number


def test_a_message_number_that_does_not_exist_means_one_that_does() -> None:
    # 0 is taken for 32, 33 (0x21) for 1.
    assert [MessageRam.valid(number) for number in (0, 1, 32, 33, 63)] == [32, 1, 32, 1, 31]


def test_the_lowest_number_is_sent_first_and_only_a_valid_object_is() -> None:
    ram = MessageRam()
    for number in (3, 5, 9):
        ram[number].control = 1 << 8
    assert ram.next_request() == 0
    for number in (9, 5):
        ram[number].arbitration = 1 << 31
    assert ram.next_request() == 5
