"""How an SCI receiver decodes a waveform: start bit, majority of three samples, stop bit.

Modelled: eight samples for each bit; a start bit is valid after four low samples; each bit is the majority of samples
4, 5 and 6; parity; one stop bit is checked; the search for the next falling edge after a stop bit.  So baud mismatch,
format mismatch, glitches and short low pulses give the bytes and errors that they give on a wire.
Not modelled: the jitter of up to one sample between an edge and the sample clock; a line that changes after the end of
the last known frame (it idles high until the next frame ends, because a frame becomes known at its end).
Time: none; a waveform is examined as a whole.
Sources: TRM SCI, asynchronous communication format.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from emulator.signals import SerialFrame

SAMPLES_PER_BIT: Final = 8
#: Consecutive low samples that make a start bit.
START_SAMPLES: Final = 4
#: The middle of each sample that votes on a bit, in bits.
VOTES: Final[tuple[float, ...]] = (3.5 / SAMPLES_PER_BIT, 4.5 / SAMPLES_PER_BIT, 5.5 / SAMPLES_PER_BIT)
#: If the drift over the frame is below this part of a bit, no two samples of a vote fall into a neighbouring bit.
HARMLESS_DRIFT: Final = 0.25


@dataclass(frozen=True, slots=True)
class Format:
    """A character as the receiver expects it.  `bit_cycles` is its own length of a bit."""

    data_bits: int
    parity: str | None
    stop_bits: int
    bit_cycles: float

    @property
    def frame_bits(self) -> int:
        """Bits from the start bit's edge to the end of the last stop bit."""
        return 1 + self.data_bits + (self.parity is not None) + self.stop_bits


@dataclass(frozen=True, slots=True)
class Character:
    """A decoded character.  The hunt for the next start bit begins at `end`, in cycles from the waveform's start."""

    data: int
    parity_error: bool
    framing_error: bool
    end: float


@dataclass(frozen=True, slots=True)
class LineWaveform:
    """A line that idles high before the first edge: `edges[0]` falls, `edges[1]` rises, and so on, in cycles."""

    edges: tuple[float, ...]

    def level(self, time: float) -> int:
        """The level at `time`."""
        return 1 - bisect_right(self.edges, time) % 2

    def falling_edge(self, time: float) -> float | None:
        """The first falling edge at or after `time`."""
        return next((edge for edge in self.edges[::2] if edge >= time), None)


def parity_bit(data: int, parity: str) -> int:
    """The bit that makes the number of ones even or odd."""
    ones = data.bit_count() & 1
    return ones if parity == "even" else ones ^ 1


def frame_waveform(frame: SerialFrame) -> LineWaveform:
    """`frame` as levels; a framing error is a low first stop bit."""
    levels = [0, *[frame.data >> i & 1 for i in range(frame.data_bits)]]
    if frame.parity is not None:
        levels.append(parity_bit(frame.data, frame.parity))
    levels.append(0 if frame.framing_error else 1)
    levels.append(1)
    edges = [i * frame.bit_cycles for i, level in enumerate(levels) if level != (levels[i - 1] if i else 1)]
    return LineWaveform(tuple(edges))


def low_pulse(width_cycles: float | None) -> LineWaveform:
    """A line that falls and rises again after `width_cycles`, or stays low (None)."""
    return LineWaveform((0.0,) if width_cycles is None else (0.0, width_cycles))


def matches(frame: SerialFrame, own: Format) -> bool:
    """Whether `frame` certainly arrives as sent: the same format, a harmless drift, a good stop bit."""
    return (
        abs(frame.bit_cycles - own.bit_cycles) * own.frame_bits < HARMLESS_DRIFT * frame.bit_cycles
        and frame.data_bits == own.data_bits
        and frame.parity == own.parity
        and not frame.framing_error
    )


def sample(waveform: LineWaveform, own: Format, start: float = 0.0) -> Iterator[Character]:
    """The characters that a receiver hunting from `start` on finds in `waveform`."""
    bit = own.bit_cycles
    hunt = start
    while (edge := waveform.falling_edge(hunt)) is not None:
        if any(waveform.level(edge + (k + 0.5) * bit / SAMPLES_PER_BIT) for k in range(START_SAMPLES)):
            hunt = edge + 0.5 * bit / SAMPLES_PER_BIT
            continue

        def vote(index: int, edge: float = edge) -> int:
            return sum(waveform.level(edge + (index + at) * bit) for at in VOTES) >= 2

        data = sum(vote(1 + i) << i for i in range(own.data_bits))
        stop = 1 + own.data_bits
        parity_error = False
        if own.parity is not None:
            parity_error = vote(stop) != parity_bit(data, own.parity)
            stop += 1
        # CHOICE: the middle vote ends the character, so that a start bit right after a short stop bit is not missed.
        hunt = edge + (stop + VOTES[1]) * bit
        yield Character(data, parity_error, not vote(stop), hunt)
