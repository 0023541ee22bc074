"""Words on wires as levels: what a logic analyser sees of a serial character, or of a word on an SPI bus.

The emulator carries characters and words whole, at the end of their last bit.  When each bit was on the wire follows
from the length of a bit.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from emulator.signals import SerialFrame

#: Cycle and level, in the order of time: each level from its cycle on.
Levels: TypeAlias = list[tuple[int, int]]


def frame_levels(frame: SerialFrame) -> Levels:
    """A character: start bit low, data from the lowest bit on, parity, stop bits high.  The line rests high before."""
    bits = [0, *(frame.data >> n & 1 for n in range(frame.data_bits))]
    if frame.parity is not None:
        bits.append(sum(bits) % 2 ^ (frame.parity == "odd"))
    bits.append(0 if frame.framing_error else 1)
    edges = [(frame.start - round(frame.bit_cycles), 1)]
    edges += [(frame.start + round(n * frame.bit_cycles), bit) for n, bit in enumerate(bits)]
    return list(_changes([*edges, (frame.end, 1)]))


def spi_levels(
    begin: int, bits: int, bit_cycles: int, cpol: int, cpha: int, simo: int, somi: int
) -> tuple[Levels, Levels, Levels]:
    """CLK, SIMO and SOMI during a word of `bits` bits, the highest first.

    Data changes where a bit begins and is taken half a bit later; CPHA says whether CLK leaves its resting level there
    (0) or where the bit begins (1).
    """
    clock = [(begin - bit_cycles, cpol)]
    out: Levels = []
    back: Levels = []
    for n in range(bits):
        start = begin + n * bit_cycles
        middle, end = start + bit_cycles // 2, start + bit_cycles
        clock += [(start, 1 - cpol), (middle, cpol)] if cpha else [(middle, 1 - cpol), (end, cpol)]
        out.append((start, simo >> (bits - 1 - n) & 1))
        back.append((start, somi >> (bits - 1 - n) & 1))
    return clock, list(_changes(out)), list(_changes(back))


def _changes(levels: Levels) -> Iterator[tuple[int, int]]:
    """Without those that say what the one before said."""
    last: int | None = None
    for cycles, level in levels:
        if level != last:
            yield cycles, level
            last = level
