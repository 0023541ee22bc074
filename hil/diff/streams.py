"""Two recordings, stream by stream: order and payload are compared, cycles are reported."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from typing import Final

from emulator.clock import CYCLES_PER_MS, us
from hil.diff.difference import OWN, PORT, Difference
from hil.diff.recorder import RecordedEvent, RunRecording

#: Events of each side that are looked at to find where two streams go on alike.
_WINDOW: Final = 100
#: After so many differences the rest of a stream is one.
_ENOUGH: Final = 100
#: Differences of a stream that are told.
_MOST: Final = 5
#: What happens so close to the end of a run, or of a lead of one of the two, may be missing on the other side.
_END: Final = CYCLES_PER_MS


@dataclass
class Skew:
    """How far the cycles of events that are alike lie apart: (cycles, thread, place of the port) each."""

    first: tuple[int, str, str] | None = None
    largest: tuple[int, str, str] | None = None

    def take(self, cycles: int, thread: str, place: str) -> None:
        """Two events that are alike are `cycles` apart, the C's being later."""
        if not cycles:
            return
        if self.first is None:
            self.first = cycles, thread, place
        if self.largest is None or abs(cycles) > abs(self.largest[0]):
            self.largest = cycles, thread, place


@dataclass
class Streams:
    """What two recordings come to."""

    #: Thread -> events that are alike, in order.
    alike: dict[str, int] = field(default_factory=dict)
    differences: list[Difference] = field(default_factory=list)
    skew: Skew = field(default_factory=Skew)


def compare_recordings(port: RunRecording, own: RunRecording, end: int) -> Streams:
    """Compare stream by stream; both runs ended at `end` cycles."""
    found = Streams()
    firsts: list[tuple[int, int, str, str]] = []
    for thread in dict.fromkeys([*port.streams, *own.streams]):
        ours, theirs = port.streams.get(thread, []), own.streams.get(thread, [])
        pairs, unequal = align([e.what for e in ours], [e.what for e in theirs])
        found.alike[thread] = len(pairs)
        for i, j in pairs:
            apart = theirs[j].cycles - ours[i].cycles
            if apart:
                if not any(known[2] == thread for known in firsts):
                    firsts.append((ours[i].cycles, apart, thread, port.place(ours[i])))
                found.skew.take(apart, thread, port.place(ours[i]))
        told = [
            (a, b)
            for a, b in unequal
            if not (_at_end(ours[a.start : a.stop], end) and _at_end(theirs[b.start : b.stop], end))
        ]
        for a, b in told[:_MOST]:
            followed = sum(1 for i, _ in pairs if i >= a.stop)
            found.differences.append(_difference(thread, port, own, ours, theirs, (a, b), followed))
        if len(told) > _MOST:
            message = f"{len(told) - _MOST} more differences of this thread"
            found.differences.append(Difference(thread, "", "", message))
    if firsts:
        _, cycles, thread, place = min(firsts)
        found.skew.first = cycles, thread, place
    return found


def align(port: Sequence[str], own: Sequence[str]) -> tuple[list[tuple[int, int]], list[tuple[range, range]]]:
    """Indices of events that belong together, and the stretches that have no counterpart.

    Behind a difference both are taken up again where they go on alike.
    """
    pairs: list[tuple[int, int]] = []
    unequal: list[tuple[range, range]] = []
    i = j = 0
    while i < len(port) or j < len(own):
        while i < len(port) and j < len(own) and port[i] == own[j]:
            pairs.append((i, j))
            i, j = i + 1, j + 1
        if i == len(port) and j == len(own):
            break
        if len(unequal) >= _ENOUGH:
            unequal.append((range(i, len(port)), range(j, len(own))))
            break
        window = port[i : i + _WINDOW], own[j : j + _WINDOW]
        match = SequenceMatcher(None, *window, autojunk=False)
        whole = i + _WINDOW >= len(port) and j + _WINDOW >= len(own)
        blocks = [block for block in match.get_matching_blocks() if block.size]
        if not blocks:
            unequal.append((range(i, i + len(window[0])), range(j, j + len(window[1]))))
            i, j = i + len(window[0]), j + len(window[1])
            continue
        base_i, base_j = i, j
        for block in blocks if whole else blocks[:1]:
            a, b = base_i + block.a, base_j + block.b
            if (a, b) != (i, j):
                unequal.append((range(i, a), range(j, b)))
            pairs += [(a + n, b + n) for n in range(block.size)]
            i, j = a + block.size, b + block.size
        if whole and (i < len(port) or j < len(own)):
            unequal.append((range(i, len(port)), range(j, len(own))))
            break
    return pairs, unequal


def _at_end(events: Sequence[RecordedEvent], end: int) -> bool:
    return all(event.cycles > end - _END for event in events)


def _difference(
    thread: str, port: RunRecording, own: RunRecording, ours: list[RecordedEvent], theirs: list[RecordedEvent],
    where: tuple[range, range], followed: int,
) -> Difference:  # fmt: skip
    a, b = where
    mine = ours[a.start] if a else None
    other = theirs[b.start] if b else None
    if mine is not None and other is not None:
        cause = f"{mine.what} in {PORT}, {other.what} in {OWN}"
    elif mine is not None:
        cause = f"only {PORT} does {mine.what}"
    else:
        assert other is not None
        cause = f"only {OWN} does {other.what}"
    more = max(len(a), len(b)) - 1
    first = mine or other
    assert first is not None
    cause += f", at {us(first.cycles) / 1e6:.6f} s" + (f" and {more} more" if more else "")
    cause += f"; {followed} events alike follow"
    place = port.place(mine) if mine is not None else ""
    return Difference(thread, place, own.place(other) if other is not None else "", cause)
