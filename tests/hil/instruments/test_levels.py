"""Characters and words as levels, read again where a receiver looks: in the middle of each bit."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.signals import SerialFrame
from hil.instruments.levels import Levels, frame_levels, spi_levels


def level_at(levels: Levels, cycles: float) -> int:
    return [level for since, level in levels if since <= cycles][-1]


@given(
    st.integers(0, 255), st.sampled_from([None, "even", "odd"]), st.sampled_from([1, 2]), st.booleans(),
    st.floats(10, 25_000),
)
def test_a_receiver_finds_the_character(
    data: int, parity: str | None, stop_bits: int, framing_error: bool, bit_cycles: float
) -> None:
    length = 1 + 8 + (parity is not None) + stop_bits
    frame = SerialFrame(
        data, 5_000_000, 5_000_000 + round(length * bit_cycles), bit_cycles, 8, parity, stop_bits, framing_error
    )
    levels = frame_levels(frame)
    bits = [level_at(levels, frame.start + (n + 0.5) * bit_cycles) for n in range(length)]
    assert level_at(levels, frame.start - 1) == 1
    assert bits[0] == 0
    assert sum(bit << n for n, bit in enumerate(bits[1:9])) == data
    if parity is not None:
        assert sum(bits[1:10]) % 2 == (parity == "odd")
    assert bits[length - stop_bits] == (0 if framing_error else 1)
    assert level_at(levels, frame.end) == 1
    assert levels == sorted(levels)


@pytest.mark.parametrize(("cpol", "cpha"), [(0, 0), (0, 1), (1, 0), (1, 1)])
@given(st.integers(0, 255), st.integers(0, 255))
def test_a_device_of_each_mode_finds_the_word(cpol: int, cpha: int, simo: int, somi: int) -> None:
    clock, *lines = spi_levels(10_000, 8, 50, cpol, cpha, simo, somi)
    edges = [cycles for (_, before), (cycles, after) in pairwise(clock) if before != after]
    assert len(edges) == 16
    assert clock[0][1] == clock[-1][1] == cpol
    # CPHA 0: bits are taken at the edges that leave the resting level; 1: at those that come back to it.
    taken = edges[cpha::2]
    for levels, word in zip(lines, (simo, somi), strict=True):
        assert sum(level_at(levels, cycles) << (7 - n) for n, cycles in enumerate(taken)) == word
