"""The CAN bus: bits of a frame against a second model, arbitration, acknowledgement, errors, and their times."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.can_bus import CanBus, CanError, CanFrame, CanPart, frame_bits
from emulator.clock import Clock

#: 500 kbit/s at 200 MHz.
BIT = 400


@st.composite
def frames(draw: st.DrawFn) -> CanFrame:
    extended = draw(st.booleans())
    identifier = draw(st.integers(0, (1 << (29 if extended else 11)) - 1))
    if draw(st.booleans()):
        return CanFrame(identifier, b"", extended, remote=True, dlc=draw(st.integers(0, 15)))
    data = draw(st.binary(max_size=8))
    return CanFrame(identifier, data, extended, dlc=draw(st.integers(8, 15)) if len(data) == 8 else None)


def head(frame: CanFrame) -> str:
    """From start of frame to the data, written down field by field (ISO 11898-1)."""
    rtr = "1" if frame.remote else "0"
    data = "".join(f"{byte:08b}" for byte in frame.data)
    if frame.extended:
        # SOF, 11 bits of base identifier, SRR, IDE, 18 bits, RTR, r1, r0
        front = f"0{frame.identifier >> 18:011b}11{frame.identifier & 0x3FFFF:018b}{rtr}00"
    else:
        # SOF, 11 bits, RTR, IDE, r0
        front = f"0{frame.identifier:011b}{rtr}00"
    return f"{front}{frame.length_code:04b}{data}"


def remainder(bits: str) -> str:
    """The CRC by long division of the polynomials."""
    generator = 0b1100010110011001
    value = int(bits, 2) << 15
    while value.bit_length() > 15:
        value ^= generator << value.bit_length() - 16
    return f"{value:015b}"


@given(frame=frames())
def test_the_bits_of_a_frame_are_those_of_a_second_model(frame: CanFrame) -> None:
    plain = head(frame) + remainder(head(frame))
    bits = "".join(map(str, frame_bits(frame)))
    # Behind the CRC: its delimiter, two bits of acknowledge, seven of end of frame, as the sender sends them.
    assert bits.endswith("1" * 10)
    stuffed = bits[:-10]
    assert not re.search("000000|111111", stuffed)
    # Whoever receives drops the bit behind five equal ones, and gets the frame back.
    received, run, last, skip = "", 0, "", False
    for bit in stuffed:
        run = run + 1 if bit == last else 1
        last = bit
        if not skip:
            received += bit
        else:
            assert run == 1
        skip = run == 5
    assert received == plain


@pytest.mark.parametrize("count", range(9))
@pytest.mark.parametrize(("extended", "fixed", "stuffable"), [(False, 44, 34), (True, 64, 54)])
def test_a_frame_is_never_longer_than_the_known_bound(count: int, extended: bool, fixed: int, stuffable: int) -> None:
    # 44 + 8n bits (64 + 8n extended), and at most one stuff bit for each four bits that are stuffed, but the first.
    bound = fixed + 8 * count + (stuffable + 8 * count - 1) // 4
    lengths = [len(frame_bits(CanFrame(n, bytes([byte]) * count, extended))) for n in (0, 1, 0x2AA, 0x7FF) for byte in
               (0x00, 0x55, 0x78, 0xFF)]  # fmt: skip
    assert max(lengths) <= bound
    assert min(lengths) >= fixed + 8 * count


def test_a_frame_by_hand() -> None:
    # 0x555 alternates, so that nothing is stuffed there; RTR, IDE, r0 and DLC 0001 are 000 0001, behind a last 1:
    # five zeros come in a row (RTR, IDE, r0 and two of the DLC), one stuff bit 1 behind them.
    bits = "".join(map(str, frame_bits(CanFrame(0x555, b"\xaa"))))
    assert bits.startswith("0" + "10101010101" + "00000" + "1" + "01" + "10101010")


def bus_of(*nodes: CanPart) -> tuple[Clock, CanBus]:
    clock = Clock()
    bus = CanBus(clock, "CAN")
    for node in nodes:
        node.connect(bus)
    return clock, bus


def test_a_frame_takes_its_bits_and_the_next_one_waits_for_the_intermission() -> None:
    sender, receiver = CanPart(), CanPart()
    clock, bus = bus_of(sender, receiver)
    ends: list[int] = []
    bus.arrived.connect(lambda _frame: ends.append(clock.now))
    first, second = CanFrame(0x123, b"\x00" * 8), CanFrame(0x124)
    sender.send(first)
    sender.send(second)
    one, two = len(frame_bits(first)), len(frame_bits(second))
    clock.advance_to(BIT * (one - 1) - 1)
    assert receiver.frames == []
    clock.advance_to(BIT * (one - 1))
    # Receivers have it at the last but one bit of the end of frame.
    assert receiver.frames == [first]
    clock.advance_to(1_000_000)
    assert ends == [BIT * one, BIT * (one + 3 + two)]
    assert receiver.frames == [first, second]


@given(identifiers=st.lists(st.integers(0, 0x7FF), min_size=2, max_size=5, unique=True))
def test_the_lowest_identifier_wins_whoever_sends_it(identifiers: list[int]) -> None:
    listener, *senders = nodes = [CanPart() for _ in range(len(identifiers) + 1)]
    clock, _ = bus_of(*nodes)
    for node, identifier in zip(senders, identifiers, strict=True):
        node.send(CanFrame(identifier, b"x"))
    clock.advance_to(10_000_000)
    assert [frame.identifier for frame in listener.frames] == sorted(identifiers)


def test_a_data_frame_wins_over_a_remote_one_and_eleven_bits_over_the_same_eleven_of_29() -> None:
    listener, *senders = nodes = [CanPart() for _ in range(4)]
    clock, _ = bus_of(*nodes)
    order = [CanFrame(0x100, b"a"), CanFrame(0x100, remote=True, dlc=1), CanFrame(0x100 << 18, b"b", extended=True)]
    for node, frame in zip(senders, reversed(order), strict=True):
        node.send(frame)
    clock.advance_to(1_000_000)
    assert listener.frames == order


def test_two_that_send_one_identifier_with_other_data_destroy_both() -> None:
    a, b, listener = CanPart(), CanPart(), CanPart()
    clock, _ = bus_of(a, b, listener)
    a.send(CanFrame(0x55, b"\x01"))
    b.send(CanFrame(0x55, b"\x02"))
    clock.advance_to(1_000_000)
    assert listener.frames == []
    assert a.errors[0] is b.errors[0] is CanError.BIT1


def test_without_an_acknowledgement_a_frame_is_repeated() -> None:
    sender, silent = CanPart(), CanPart(acknowledges=False)
    clock, bus = bus_of(sender, silent)
    frame = CanFrame(1)
    sender.send(frame)
    # The error shows in the acknowledge slot, nine bits before the end; flags of 6 + 6 (the silent node is no
    # controller in silent mode and sends one), delimiter 8, intermission 3.
    attempt = BIT * (len(frame_bits(frame)) - 8 + 6 + 6 + 8 + 3)
    clock.advance_to(3 * attempt - 1)
    assert sender.errors == [CanError.ACK] * 3
    CanPart().connect(bus)
    clock.advance_to(4 * attempt + 1_000)
    assert sender.waiting == []


def test_a_node_of_another_bit_rate_destroys_every_frame() -> None:
    sender, listener, foreign = CanPart(500_000), CanPart(500_000), CanPart(250_000)
    clock, _ = bus_of(sender, listener, foreign)
    sender.send(CanFrame(7))
    clock.advance_to(200_000)
    assert listener.frames == foreign.frames == []
    assert sender.errors[0] is CanError.BIT1
    assert foreign.errors[0] is CanError.STUFF


def test_a_spoilt_frame_is_sent_again() -> None:
    sender, listener = CanPart(), CanPart()
    clock, bus = bus_of(sender, listener)
    # Bits 1 to 5 of identifier 0 are its zeros behind the start of frame (0): bit 5 is the stuff bit, recessive.
    bus.disturb(frames=1, bit=5)
    bus.disturb(frames=1, bit=2)
    sender.send(CanFrame(0, b"z"))
    clock.advance_to(1_000_000)
    assert sender.errors == [CanError.BIT1, CanError.BIT0]
    assert listener.frames == [CanFrame(0, b"z")]
    with pytest.raises(ValueError, match="disturb bit 0"):
        bus.disturb(bit=0)


def test_the_level_of_the_bus_is_the_frame_bit_by_bit() -> None:
    sender, listener = CanPart(), CanPart()
    clock, bus = bus_of(sender, listener)
    frame = CanFrame(0x5A5, b"\x12\x34")
    bits = list(frame_bits(frame))
    bits[-9] = 0  # the acknowledge slot, which the listener drives
    sender.send(frame)
    seen = []
    for n in range(len(bits)):
        clock.advance_to(n * BIT + BIT // 2)
        seen.append(bus.level(clock.now))
    assert seen == bits
    clock.advance_to(1_000_000)
    assert bus.level(clock.now) == 1


def test_a_sender_that_leaves_breaks_its_frame_off() -> None:
    sender, listener = CanPart(), CanPart()
    clock, bus = bus_of(sender, listener)
    sender.send(CanFrame(3, b"abc"))
    clock.advance_to(10 * BIT)
    bus.detach(sender)
    clock.advance_to(1_000_000)
    assert listener.frames == []
    assert listener.errors == [CanError.STUFF]
    assert bus.busy is False


@pytest.mark.parametrize(
    ("arguments", "message"),
    [((0x800,), "expected 11 bits"), ((1 << 29, b"", True), "expected 29 bits"), ((1, b"123456789"), "9 bytes")],
)
def test_what_is_no_frame_is_refused(arguments: tuple[object, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        CanFrame(*arguments)  # type: ignore[arg-type]


def test_a_part_that_is_on_no_bus_cannot_send() -> None:
    with pytest.raises(ValueError, match="no bus"):
        CanPart().send(CanFrame(1))
    with pytest.raises(ValueError, match="expected 1 to 1000000"):
        CanPart(2_000_000)
