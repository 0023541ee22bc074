"""Lanes below the chart of the scope, as SVG: levels as in a logic analyser, words of buses, tasks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from typing import Final

from emulator.clock import seconds
from hil.instruments.timeline import Span, TaskState
from hil.view.kinds import Draw, SignalKind
from hil.view.probes import Sample
from hil.view.words import DecodedWord, text_lines

#: In pixels: the width of the picture until the browser reports it, the left edge of the lanes, the heights of a lane
#: and of the line of times.
WIDTH: Final = 720
LEFT: Final = 144
LANE: Final = 24
TIMES: Final = 18
#: Edges with less than this distance, in pixels, cannot be distinguished; they are drawn as one paler block.
MERGE: Final = 2.0
#: The width of a character of the words, in pixels.
CHARACTER: Final = 6.7
_CSS: Final = {TaskState.RUNNING: "running", TaskState.READY: "ready", TaskState.WAITING: "waiting"}

#: A function from cycles to the x coordinate in the picture.
Place = Callable[[int], float]


def place(begin: int, end: int, width: int = WIDTH) -> Place:
    """The x coordinate of a time within the visible span, in a picture of `width` pixels."""
    span = max(1, end - begin)
    return lambda cycles: LEFT + (width - LEFT) * (min(max(cycles, begin), end) - begin) / span


def picture(
    lanes: Sequence[tuple[str, str]], places: Iterable[float], begin: int, end: int, width: int = WIDTH
) -> tuple[str, int]:  # fmt: skip
    """The picture of lanes with their names, cursors at `places`, and the times of both ends; and its height."""
    height = LANE * len(lanes) + 8
    parts = []
    for row, (title, drawn) in enumerate(lanes):
        axis = f'<path class="axis" d="M{LEFT} 20H{width}"/>'
        parts.append(f'<g transform="translate(0 {row * LANE + 4})"><text x="2" y="15">{title}</text>{axis}{drawn}</g>')
    parts += [f'<path class="cursor" d="M{x:.1f} 0V{height}"/>' for x in places]
    for x, anchor, cycles in ((LEFT, "start", begin), (width, "end", end)):
        time = f"{seconds(cycles):.{3 if seconds(end - begin) >= 0.1 else 6}f} s"
        parts.append(f'<text class="time" x="{x}" y="{height + 12}" text-anchor="{anchor}">{time}</text>')
    return "".join(parts), height + TIMES


def signal_lanes(
    kinds: Mapping[str, SignalKind],
    values: Mapping[str, list[Sample]],
    words: Mapping[str, list[DecodedWord]],
    begin: int,
    end: int,
    width: int = WIDTH,
) -> list[tuple[str, str]]:
    """Name and drawing of each signal that is a level or words."""
    x = place(begin, end, width)
    found = []
    for name, kind in kinds.items():
        if kind.draw is Draw.SQUARE:
            found.append((_title(name, kind), _square(values.get(name, []), x, end)))
        elif kind.draw is not Draw.LINE:
            found.append((_title(name, kind), _words(words.get(name, []), x, as_text=kind.draw is Draw.BYTES)))
    return found


def task_lanes(
    owners: Iterable[str], every: list[Span], begin: int, end: int, width: int = WIDTH
) -> list[tuple[str, str]]:  # fmt: skip
    """Name and drawing of each task, Swi and Hwi.

    Spans that are too short to be drawn one by one become a block whose height is their share of the time.
    """
    x = place(begin, end, width)
    names = list(dict.fromkeys(owners))
    drawn: dict[str, dict[str, list[str]]] = {name: {} for name in names}
    drawn |= {name: {} for name in sorted({each.lane for each in every} - drawn.keys())}
    for each, a, b, busy, many in _joined(every, x):
        inset = 0 if each.state is TaskState.RUNNING else 5
        full = 15 - inset
        high = max(1.0, full * busy / max(b - a, 0.4)) if many else full
        style = f"{_CSS[each.state]}{' raised' if each.raised else ''}{' many' if many else ''}"
        drawn[each.lane].setdefault(style, []).append(_box(a, b, 1 + inset + full - high, high))
    return [
        (escape(name), "".join(f'<path class="{style}" d="{"".join(boxes)}"/>' for style, boxes in styles.items()))
        for name, styles in drawn.items()
    ]


def _title(name: str, kind: SignalKind) -> str:
    """The part that is connected to a signal, and the name of the signal if there is room."""
    if not kind.part:
        return escape(name)
    pin = name.removeprefix("byte ")
    small = f' <tspan class="small">{escape(pin)}</tspan>' if len(kind.part) + len(pin) < 22 else ""
    return escape(kind.part) + small


def _box(a: float, b: float, y: float, high: float) -> str:
    wide = max(b - a, 0.4)
    return f"M{a:.1f} {y:.4g}h{wide:.1f}v{high:.4g}h-{wide:.1f}z"


def _square(samples: list[Sample], x: Place, end: int) -> str:
    """A level; a block where edges are too close together."""
    line: list[str] = []
    blocks: list[tuple[float, float]] = []
    ends = [cycles for cycles, _ in samples[1:]] + [end]
    # Pieces that are too close to be distinguished: begin, end, and their path.
    close_pieces: list[tuple[float, float, str]] = []

    def draw_close_pieces() -> None:
        if len(close_pieces) > 2:
            blocks.append((close_pieces[0][0], close_pieces[-1][1]))
        else:
            line.extend(piece for _, _, piece in close_pieces)
        close_pieces.clear()

    for (cycles, value), until in zip(samples, ends, strict=False):
        a, b, y = x(cycles), x(until), 4 if value else 17
        piece = f"{'V' if line or close_pieces else f'M{a:.1f} '}{y}H{b:.1f}"
        if b - a < MERGE:
            close_pieces.append((a, b, piece))
            continue
        many = len(close_pieces) > 2
        draw_close_pieces()
        # After a block the line begins anew.
        line.append(f"M{a:.1f} {y}H{b:.1f}" if many else piece)
    draw_close_pieces()
    shaded = f'<path class="level many" d="{"".join(_box(a, b, 4, 13) for a, b in blocks)}"/>' if blocks else ""
    return shaded + (f'<path class="level" d="{"".join(line)}"/>' if line else "")


def _words(words: list[DecodedWord], x: Place, *, as_text: bool) -> str:
    """Words as boxes with their meanings, as far as there is room; bytes close together as the text of their line."""
    labelled: list[tuple[float, float, tuple[str, ...]]]
    if as_text and words and x(words[0].end) - x(words[0].begin) < 2 * CHARACTER:
        labelled = [(x(line.begin), x(line.end), (line.meaning,)) for line in text_lines(words)]
    elif as_text:
        labelled = [(x(word.begin), x(word.end), (word.meaning, f"{word.value:02X}")) for word in words]
    else:
        labelled = [(x(word.begin), x(word.end), _texts_of_word(word)) for word in words]
    boxes: list[str] = []
    close_pieces: list[tuple[float, float]] = []
    texts: list[str] = []
    for a, b, versions in labelled:
        if b - a < MERGE:
            if close_pieces and a - close_pieces[-1][1] < MERGE:
                close_pieces[-1] = close_pieces[-1][0], b
            else:
                close_pieces.append((a, b))
            continue
        slant = min(3.0, (b - a) / 4)
        boxes.append(f"M{a:.1f} 10.5l{slant:.1f} -7H{b - slant:.1f}l{slant:.1f} 7l-{slant:.1f} 7H{a + slant:.1f}z")
        text = _first_fitting(versions, int((b - a - 6) / CHARACTER))
        if text:
            texts.append(f'<text class="word" x="{a + 4:.1f}" y="14.5">{escape(text)}</text>')
    parts = [f'<path class="busy" d="{"".join(_box(a, b, 4, 13) for a, b in close_pieces)}"/>'] if close_pieces else []
    if boxes:
        parts.append(f'<path class="bus" d="{"".join(boxes)}"/>')
    return "".join([*parts, *texts])


def _texts_of_word(word: DecodedWord) -> tuple[str, ...]:
    """The texts for a word of a bus, the longest first."""
    value = f"{word.value:02X}"
    return (f"{value} {word.meaning}", word.meaning, value) if word.meaning else (value,)


def _first_fitting(versions: Sequence[str], room: int) -> str:
    """The first text that fits; of a text that is too long its beginning."""
    for text in versions:
        if len(text) <= room:
            return text
    longest = versions[0]
    return f"{longest[: room - 1]}\N{HORIZONTAL ELLIPSIS}" if len(versions) == 1 and room > 3 else ""


def _joined(every: list[Span], x: Place) -> list[tuple[Span, float, float, float, bool]]:
    """The spans with their coordinates in the picture.  Spans that nearly touch are joined to one.

    With each comes the filled part of its width, and whether several spans were joined.
    """
    last: dict[tuple[str, TaskState, bool], tuple[Span, float, float, float, bool]] = {}
    done: list[tuple[Span, float, float, float, bool]] = []
    for each in every:
        key, a, b = (each.lane, each.state, each.raised), x(each.begin), x(each.end)
        known = last.get(key)
        if known is not None and a - known[2] < MERGE:
            last[key] = (known[0], known[1], max(b, known[2]), known[3] + b - a, True)
            continue
        if known is not None:
            done.append(known)
        last[key] = (each, a, b, b - a, False)
    return [*done, *last.values()]
