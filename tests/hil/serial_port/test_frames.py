"""Gathering frames and dropping the oldest whole ones."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.serial_port.frames import LONGEST_UNIT, PAUSE_CYCLES, Counters, Delivery, OutboundQueue, split_units
from tests.hil.scripted_machine import BYTE_CYCLES
from tests.hil.serial_port.lines import frame


def outbound(keep: int = 3, deliver: Delivery = Delivery.FRAMES) -> OutboundQueue:
    return OutboundQueue(Counters(), keep=keep, deliver=deliver)


def push(out: OutboundQueue, data: bytes, start: int = 0) -> int:
    for byte in data:
        start += BYTE_CYCLES
        out.push(byte, start)
    return start


def test_a_frame_becomes_visible_with_its_last_byte() -> None:
    out = outbound()
    now = push(out, frame(1)[:-1])
    assert out.take() == b""
    out.push(0x0D, now + BYTE_CYCLES)
    assert out.take() == frame(1)
    assert out.take() == b""


def test_byte_delivery_makes_each_byte_visible_by_itself() -> None:
    out = outbound(deliver=Delivery.BYTES)
    seen = []
    for index, byte in enumerate(frame(1)):
        out.push(byte, (index + 1) * BYTE_CYCLES)
        seen.append(out.take())
    assert seen == [bytes((byte,)) for byte in frame(1)]


def test_the_oldest_whole_frames_give_way() -> None:
    out = outbound(keep=3)
    now = 0
    for number in range(10):
        now = push(out, frame(number), now)
    # Ten came, three are kept: 7, 8, 9.
    assert [out.take() for _ in range(4)] == [frame(7), frame(8), frame(9), b""]
    assert out.counters.frames_dropped == 7
    assert out.counters.bytes_dropped == sum(len(frame(number)) for number in range(7))


def test_a_frame_that_has_begun_to_leave_is_never_torn() -> None:
    out = outbound(keep=1, deliver=Delivery.BYTES)
    now = push(out, frame(0)[:5])
    begun = out.take()
    now = push(out, frame(0)[5:], now)
    for number in range(1, 5):
        now = push(out, frame(number), now)
    # One unit is kept: the rest of frame 0, because its beginning is out already.
    assert begun + out.take() == frame(0)
    assert out.counters.frames_dropped == 4


def test_bytes_outside_a_frame_leave_after_a_pause() -> None:
    out = outbound()
    now = push(out, b"noise")
    out.settle(now + PAUSE_CYCLES - 1)
    assert out.take() == b""
    out.settle(now + PAUSE_CYCLES)
    assert out.take() == b"noise"


def test_a_cut_frame_does_not_swallow_the_next() -> None:
    out = outbound()
    push(out, b"#ODO 1,2" + frame(7))
    assert [out.take(), out.take()] == [b"#ODO 1,2", frame(7)]


def test_a_new_listener_does_not_get_the_rest_of_a_frame_it_did_not_hear_begin() -> None:
    out = outbound(deliver=Delivery.BYTES)
    now = push(out, frame(0)[:4])
    out.take()
    out.discard()
    now = push(out, frame(0)[4:], now)
    assert out.take() == b""
    push(out, frame(1), now)
    assert out.take() == frame(1)


def test_keep_outside_1_to_64_is_refused() -> None:
    for keep in (0, 65):
        with pytest.raises(ValueError, match=r"must be 1\.\.64"):
            outbound(keep=keep)


@given(st.binary(max_size=2000), st.integers(1, 8), st.sampled_from(Delivery), st.data())
def test_whatever_comes_memory_is_bounded_and_no_byte_is_lost_uncounted(
    data: bytes, keep: int, deliver: Delivery, choices: st.DataObject
) -> None:
    out = outbound(keep, deliver)
    taken = b""
    now = 0
    for start in range(0, len(data), 97):
        now = push(out, data[start : start + 97], now)
        assert len(out) <= keep
        for _ in range(choices.draw(st.integers(0, 3))):
            taken += out.take()
    out.settle(now + PAUSE_CYCLES)
    while piece := out.take():
        taken += piece
    assert len(taken) + out.counters.bytes_dropped == len(data) == out.counters.bytes_from_robot
    if out.counters.frames_dropped == 0:
        assert taken == data


@given(st.binary(max_size=600))
def test_units_are_a_partition_of_the_line(data: bytes) -> None:
    units = split_units(data)
    assert b"".join(units) == data
    assert all(unit.endswith(b"\r") and unit.count(b"\r") == 1 for unit in units[:-1])


def test_a_unit_without_end_is_cut_at_its_longest() -> None:
    out = outbound()
    push(out, b"x" * LONGEST_UNIT)
    assert out.take() == b"x" * LONGEST_UNIT
