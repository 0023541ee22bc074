"""Converts words to levels on wires, as a logic analyser shows a serial character or a word on an SPI bus.

The emulator transfers whole characters and words, at the end of their last bit.  The time of each bit is computed from
the length of a bit.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from emulator.signals import SerialFrame

#: Cycles and levels in the order of time.  Each level holds from its cycle on.
Levels: TypeAlias = list[tuple[int, int]]


def frame_levels(frame: SerialFrame) -> Levels:
    """The levels of a character: a low start bit, the data with the lowest bit first, the parity, high stop bits.

    Before the character, the line is high.
    """
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
    """The levels of CLK, SIMO and SOMI during a word of `bits` bits, the highest bit first.

    Data changes at the start of a bit and is sampled half a bit later.  CLK leaves its idle level when data is sampled
    (CPHA 0), or at the start of the bit (CPHA 1).
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
    """Drop each level that is the same as the one before."""
    last: int | None = None
    for cycles, level in levels:
        if level != last:
            yield cycles, level
            last = level
