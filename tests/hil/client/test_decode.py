"""The frame decoder on good, cut, split and hostile input."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.client.decode import LONGEST_FRAME, FrameDecoder, OdometryFrame

INT16 = st.integers(-32768, 32767)
FRAMES = st.builds(OdometryFrame, INT16, INT16, INT16, INT16, INT16, INT16)


def test_the_fields_are_x_y_theta_front_right_left() -> None:
    (frame,) = FrameDecoder().feed(b"#ODO 220,-5,1,1922,301,299\n\r")
    assert (frame.x_mm, frame.y_mm, frame.theta_rad) == (220, -5, 1)
    assert (frame.front_mm, frame.right_mm, frame.left_mm) == (1922, 301, 299)


@given(st.lists(FRAMES, max_size=6), st.data())
def test_frames_come_back_however_they_are_cut(frames: list[OdometryFrame], choices: st.DataObject) -> None:
    wire = b"".join(frame.encode() for frame in frames)
    decoder = FrameDecoder()
    got = []
    while wire:
        cut = choices.draw(st.integers(1, len(wire)))
        got += decoder.feed(wire[:cut])
        wire = wire[cut:]
    assert got == frames
    assert decoder.malformed == decoder.skipped == 0


def test_the_longest_frame_fits() -> None:
    frame = OdometryFrame(*[-32768] * 6)
    assert len(frame.encode()) == LONGEST_FRAME == 48
    assert FrameDecoder().feed(frame.encode()) == [frame]


@pytest.mark.parametrize(
    "wire",
    [
        b"#ODO 1,2,3,4,5\n\r",  # five fields
        b"#ODO 1,2,3,4,5,6,7\n\r",  # seven
        b"#ODO 1,2,3,4,5,6\r",  # no line feed: the console cuts a digit off
        b"#ODO1,2,3,4,5,6\n\r",  # no space
        b"#ODO 1.0,2,3,4,5,6\n\r",  # not integers
        b"#ODO 40000,2,3,4,5,6\n\r",  # not 16 bits
        b"#ODO 1,2,3,4,5,\xff\n\r",
        b"#\r",
    ],
)
def test_what_is_no_frame_is_counted_and_the_next_frame_is_seen(wire: bytes) -> None:
    decoder = FrameDecoder()
    good = OdometryFrame(1, 2, 3, 4, 5, 6)
    assert decoder.feed(wire + good.encode()) == [good]
    assert decoder.malformed == 1
    assert decoder.skipped == len(wire)


def test_a_beginning_that_was_cut_off_does_not_hide_the_next_frame() -> None:
    good = OdometryFrame(1, 2, 3, 4, 5, 6)
    decoder = FrameDecoder()
    assert decoder.feed(good.encode()[:9] + good.encode()) == [good]
    assert decoder.malformed == 1


@given(st.lists(st.one_of(st.binary(max_size=80), FRAMES.map(OdometryFrame.encode)), max_size=30))
def test_every_byte_is_part_of_a_frame_or_skipped_or_waits(pieces: list[bytes]) -> None:
    decoder = FrameDecoder()
    frames = [frame for piece in pieces for frame in decoder.feed(piece)]
    waiting = len(decoder._buffer)
    assert waiting <= LONGEST_FRAME
    total = sum(len(piece) for piece in pieces)
    # A number may be written with leading zeros or as -0, so a frame is at least as long as its canonical form.
    assert sum(len(frame.encode()) for frame in frames) <= total - decoder.skipped - waiting
