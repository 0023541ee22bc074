"""The scope: signals and tasks against virtual time, with two cursors.

Quantities are drawn by ECharts, which comes with NiceGUI, on an axis for each unit; levels, words of buses and tasks
are drawn as lanes below, on the same span of time.  The wheel zooms about the pointer, dragging shifts.
"""

from __future__ import annotations

import time
from bisect import bisect_right
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from html import escape
from math import ceil, floor, log10
from typing import Any, Final

from nicegui import events, ui

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, seconds
from emulator.sysbios.gate_mutex_pri import GateMutexPri
from hil.instruments.timeline import Span, spans
from hil.view.checkpoints import RewindableRun
from hil.view.engine import Engine
from hil.view.kinds import Draw, SignalKind, kind_of
from hil.view.lanes import LEFT, WIDTH, picture, place, signal_lanes, task_lanes
from hil.view.probes import Probes, Sample, labels
from hil.view.signal_tree import SignalTree
from hil.view.snapshot import Snapshot
from hil.view.style import LINES
from hil.view.words import DecodedWord

EVERY: Final = 5
#: The tasks of a long span are looked at once in so many times.
LOOKS_PER_TASK_LOOK: Final = 4
#: A panel that was not updated for so long was out of sight.
HIDDEN_S: Final = 0.5
#: Points that are drawn of a signal; more are thinned to the extremes of each column.
COLUMNS: Final = 400
#: Height of an axis in the picture, if there are several, and of what stands above and below.
AXIS: Final = 96
ABOVE: Final = 28
#: Width of a digit on the time axis, and the least gap between two numbers, in pixels.
DIGIT: Final = 7
GAP: Final = 24
BELOW: Final = 40
#: Longer spans of time than this have too many events to be sorted four times a second: once a second.
LIVE_S: Final = 1.0
SPANS_S: Final = {0.001: "1 ms", 0.01: "10 ms", 0.1: "100 ms", 1.0: "1 s", 5.0: "5 s", 20.0: "20 s", 60.0: "60 s"}
#: What the wheel can make of a span: from some words of an SPI to a minute.
SHORTEST_S: Final = 10e-6
LONGEST_S: Final = 60.0
#: What the wheel makes of a span at each click.
ZOOM: Final = 1.5
#: Where the pointer is, as a share of the picture's width; its buttons; how far the wheel was turned.
POINTED: Final = """(e) => { if (e.type === "wheel") e.preventDefault();
  const box = e.currentTarget.getBoundingClientRect();
  emit((e.clientX - box.left) / box.width, e.buttons, e.deltaY || 0); }"""
#: Of the lines on the axes.
COLOURS: Final = [f"var(--line-{n})" for n in range(LINES)]
PERIODS_MS: Final = {0.1: "0.1 ms", 1.0: "1 ms", 5.0: "5 ms", 20.0: "20 ms"}


@dataclass(frozen=True, slots=True)
class ScopeSpan:
    """The content of the visible span, in cycles."""

    begin: int
    end: int
    values: dict[str, list[Sample]]
    #: None: not asked for.
    spans: list[Span] | None
    owners: tuple[str, ...]
    kinds: dict[str, SignalKind] = field(default_factory=dict)
    words: dict[str, list[DecodedWord]] = field(default_factory=dict)


def look(
    run: RewindableRun, probes: Probes, end: int | None, span_cycles: int, *, with_spans: bool = True
) -> ScopeSpan:
    """The signals and tasks of the span that ends at `end` (None: now)."""
    until = run.clock.now if end is None else end
    begin = max(0, until - span_cycles)
    tasks = run.bench.board.kernel.tasks
    drawn = None
    if with_spans:
        every = spans(probes.events_between(begin, until), _base_priorities(run), until)
        drawn = [each for each in every if each.end >= begin]
    kinds = {name: kind_of(run, name) for name in probes.names}
    values = {name: [s for s in probes.values(name, begin) if s[0] <= until] for name in kinds}
    values |= {name: _thinned(values[name]) for name, kind in kinds.items() if kind.draw is Draw.LINE}
    words = {name: probes.words(name, begin, until) for name in kinds}
    return ScopeSpan(begin, until, values, drawn, tuple(task.name for task in tasks.all), kinds, words)


def _base_priorities(run: RewindableRun) -> dict[str, int]:
    """The own priority of each task: the one that it has without a gate, or had before it inherited another."""
    base = {task.name: task.priority for task in run.bench.board.kernel.tasks.all}
    for obj in run.bench.firmware.linked.objects.values():
        gate = obj.data[0] if len(obj.data) == 1 else None
        if isinstance(gate, GateMutexPri) and gate.owner is not None:
            base[gate.owner.name] = min(base[gate.owner.name], gate.original_priority)
    return base


def _thinned(samples: list[Sample]) -> list[Sample]:
    """At most two values for each column: its lowest and its highest, in order of time."""
    step = -(-len(samples) // COLUMNS)
    if step <= 2:
        return samples
    kept: list[Sample] = []
    for index in range(0, len(samples), step):
        part = samples[index : index + step]
        low, high = min(part, key=lambda s: s[1]), max(part, key=lambda s: s[1])
        kept += [low] if low is high else sorted((low, high))
    return kept


def shown_at(now: ScopeSpan, name: str, cycles: int) -> str:
    """The value of a signal at a time, with its unit."""
    kind = now.kinds.get(name, SignalKind(Draw.LINE))
    if kind.draw in (Draw.BYTES, Draw.WORDS):
        word = next((word for word in now.words[name] if word.begin <= cycles <= word.end), None)
        return "-" if word is None else f"0x{word.value:02X} {word.meaning}".strip()
    value = value_at(now.values[name], cycles)
    if value is None:
        return "-"
    return f"{value:.0f}" if kind.draw is Draw.SQUARE else f"{value:.6g} {kind.unit}".strip()


def reading(now: ScopeSpan, times: Mapping[str, int]) -> str:
    """An HTML table of the values of each signal at some named times."""
    head = "".join(f"<th>{name}<div>{seconds(cycles):.6f} s</div></th>" for name, cycles in times.items())
    rows = [
        f"<tr><th>{escape(name)}</th>"
        + "".join(f"<td>{escape(shown_at(now, name, cycles))}</td>" for cycles in times.values())
        + "</tr>"
        for name in now.values
    ]
    apart = f"B - A {(times['B'] - times['A']) / CYCLES_PER_MS:.4f} ms"
    return f"<table><tr><th>{apart}</th>{head}</tr>{''.join(rows)}</table>"


def value_at(samples: list[Sample], cycles: int) -> float | None:
    """The value of a signal at a time: the last value before it."""
    index = bisect_right(samples, (cycles, float("inf")))
    return samples[index - 1][1] if index else None


class ScopePanel:
    """The panel."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._turn = self._look_count = 0
        self._pending_look: Future[ScopeSpan] | None = None
        self._look: ScopeSpan | None = None
        self._names: list[str] = []
        self._end: int | None = None
        #: The latest span with tasks: the lanes show it.
        self._lanes_look: ScopeSpan | None = None
        #: When the panel was updated last, on the monotonic clock: out of sight it is not.
        self._updated_s = 0.0
        #: What chart and lanes show.
        self._chart_key: Any = None
        self._drawn_key: Any = None
        self._lanes_key: Any = None
        #: Where the pointer is in the picture, 0..1; where it took hold, and the end of the picture then.
        self._pointer: float | None = None
        self._grip: tuple[float, int] | None = None
        #: Of the lanes, in pixels.
        self._width = WIDTH
        self._tree = SignalTree(self._tick)
        self._labels: Future[dict[str, str]] | None = None
        self._offered = False
        with ui.row().classes("items-center gap-2"):
            self._span = ui.select(SPANS_S, value=5.0, label="span").props("dense").classes("w-24").mark("span")
            ui.select(
                PERIODS_MS,
                value=probes_period(engine),
                label="sampled every",
                on_change=lambda e: self._period(e.value),
            ).props("dense").classes("w-28")
            with ui.row().classes("items-center gap-1 no-wrap"):
                self._hold = ui.switch("hold").props("dense").mark("still").tooltip("hold the picture")
                ui.button("earlier", on_click=lambda: self._shift(-1)).props("no-caps dense flat")
                ui.button("later", on_click=lambda: self._shift(1)).props("no-caps dense flat")
        self._chosen = ui.row().classes("gap-1").mark("signals")
        self._chart = ui.echart(_options({}, {}, 0.0, 1.0), renderer="svg").classes("w-full").mark("chart")
        self._chart.visible = False
        with ui.row().classes("items-center gap-0 w-full no-wrap"):
            ui.label("cursors A, B").classes("soft").style(f"flex:0 0 {LEFT}px")
            self._cursors = (
                ui.range(min=0, max=1000, step=1, value={"min": 250, "max": 750})
                .props('dense aria-label="cursors A and B"')
                .mark("cursors")
            )
        ui.label(
            "Levels, words on buses, tasks, Swis and Hwis. The events of the last 14 s or so are kept. The wheel "
            "zooms, dragging shifts."
        ).classes("soft")
        with ui.element("div").classes("lanes w-full") as lanes:
            ui.element("q-resize-observer").on("resize", self._resized, args=["width"])
            self._lanes = ui.html(tag="svg", sanitize=False).mark("lanes").props("aria-hidden=true")
        for shown in (self._chart, lanes):
            for kind in ("wheel", "pointerdown", "pointermove", "pointerleave"):
                throttle = 0.05 if kind == "pointermove" else 0.0
                shown.on(kind, getattr(self, f"_{kind}"), js_handler=POINTED, throttle=throttle)
        with ui.row().classes("gap-x-4 soft"):
            for css, text in (
                ("--run", "runs"), ("--wait", "ready, pre-empted"), ("--bad", "waits at a gate"),
                ("--real", "outlined: inherited priority"), ("--line", "pale: several, too close to be drawn"),
            ):  # fmt: skip
                ui.html(f'<span class="key" style="border-color:var({css})"></span>{text}', sanitize=False)
        self._reading = ui.html("", sanitize=False).classes("w-full reading").props("tabindex=0").mark("reading")
        self._show_names(engine.probes.names)

    def update(self, _now: Snapshot) -> None:
        """Update the panel while it is visible."""
        if self._labels is None:
            self._labels = self._engine.submit(labels)
        elif not self._offered and self._labels.done() and not self._labels.cancelled():
            self._offered = True
            self._tree.offer(self._labels.result(), self._engine.blocks)
        if self._pending_look is not None and self._pending_look.done():
            answer, self._pending_look = self._pending_look, None
            if not answer.cancelled() and answer.exception() is None:
                self._look = answer.result()
                if list(self._look.kinds) != self._names:  # another page has chosen
                    self._show_names(list(self._look.kinds))
        self._draw()
        now_s, before_s = time.monotonic(), self._updated_s
        self._updated_s = now_s
        if now_s - before_s > HIDDEN_S:  # it comes into sight: what it showed then is old
            self._turn, self._look_count = EVERY - 1, LOOKS_PER_TASK_LOOK - 1
        self._turn = (self._turn + 1) % EVERY
        if self._turn == 0 and self._pending_look is None:
            engine, cycles = self._engine, round(float(self._span.value) * SYSCLK_HZ)
            if self._hold.value and self._end is None and self._look is not None:
                self._end = self._look.end
            elif not self._hold.value:
                self._end = None
            end = self._end
            self._look_count = (self._look_count + 1) % LOOKS_PER_TASK_LOOK
            live = float(self._span.value) <= LIVE_S or self._look_count == 0
            self._pending_look = engine.submit(lambda run: look(run, engine.probes, end, cycles, with_spans=live))

    def _draw(self) -> None:
        now = self._look
        if now is None:
            return
        # The tasks of a long span come later than its chart: sorting their events takes time.
        if now.spans is not None:
            self._lanes_look = now
        if self._lanes_look is not None:
            self._draw_lanes(self._lanes_look)
        a, b = cursors = self._cursor_cycles(now)
        drawn = (now.begin, now.end, cursors, tuple(now.values), self._width)
        if (drawn, self._pointer) == self._chart_key:
            return
        self._chart_key = drawn, self._pointer
        if drawn != self._drawn_key:
            self._drawn_key = drawn
            self._draw_chart(now, cursors)
        times = {"A": a, "B": b}
        if self._pointer is not None:
            times["pointer"] = now.begin + round((now.end - now.begin) * self._pointer)
        self._reading.content = reading(now, times)

    def _cursor_cycles(self, now: ScopeSpan) -> tuple[int, int]:
        """The times of the cursors in a span."""
        at, span = self._cursors.value, now.end - now.begin
        return now.begin + span * int(at["min"]) // 1000, now.begin + span * int(at["max"]) // 1000

    def _draw_chart(self, now: ScopeSpan, cursors: tuple[int, int]) -> None:
        on_axes = {name: kind.unit for name, kind in now.kinds.items() if kind.draw is Draw.LINE}
        a, b = cursors
        options = _options(
            on_axes, now.values, seconds(now.begin), seconds(now.end), (seconds(a), seconds(b)), self._width
        )
        self._chart.set_visibility(bool(on_axes))
        self._chart.style(f"height:{_height(len(set(on_axes.values())))}px")
        self._chart.options.clear()
        self._chart.options.update(options)
        self._chart.update()

    def _draw_lanes(self, now: ScopeSpan) -> None:
        cursors = self._cursor_cycles(now)
        key = (now.begin, now.end, cursors, tuple(now.values), self._width)
        if key == self._lanes_key:
            return
        self._lanes_key = key
        rows = [
            *signal_lanes(now.kinds, now.values, now.words, now.begin, now.end, self._width),
            *task_lanes(now.owners, now.spans or [], now.begin, now.end, self._width),
        ]
        at = place(now.begin, now.end, self._width)
        drawn, height = picture(rows, [at(cycles) for cycles in cursors], now.begin, now.end, self._width)
        # In pixels: nothing in it is stretched until it is drawn for another width.
        self._lanes.props["width"], self._lanes.props["height"] = self._width, height
        self._lanes.content = drawn

    def _tick(self, name: str, on: bool) -> None:
        probes = self._engine.probes
        self._engine.submit(lambda _run: probes.add(name) if on else probes.remove(name))
        self._pending_look = None  # it would tell what was recorded before
        self._show_names([*self._names, name] if on else [each for each in self._names if each != name])

    def _show_names(self, names: list[str]) -> None:
        self._names = names
        self._chosen.clear()
        with self._chosen:
            for name in self._names:
                ui.button(f"{name}  x", on_click=lambda name=name: self._tick(name, False)).props(
                    "no-caps dense outline size=sm"
                ).tooltip("stop recording it")
        self._tree.show(self._names)

    def _period(self, period_ms: float) -> None:
        self._engine.submit(lambda _run: self._engine.probes.set_period(round(period_ms * CYCLES_PER_MS)))

    def _shift(self, way: int) -> None:
        now = self._look
        if now is None:
            return
        self._hold.value = True
        self._end = max(0, now.end + way * (now.end - now.begin) // 2)

    # Mouse or finger, on chart and lanes

    def _wheel(self, e: events.GenericEventArguments) -> None:
        now, share = self._look, self._share(e.args[0])
        if now is None:
            return
        before_s, end = float(self._span.value), now.end if self._end is None else self._end
        span_s = min(max(before_s * (ZOOM if e.args[2] > 0 else 1 / ZOOM), SHORTEST_S), LONGEST_S)
        # What is under the pointer stays there.
        self._show(round(end - (1 - share) * (before_s - span_s) * SYSCLK_HZ))
        self._span.set_options(SPANS_S | {span_s: SPANS_S.get(span_s, _in_words(span_s))}, value=span_s)

    def _pointerdown(self, e: events.GenericEventArguments) -> None:
        if self._look is not None:
            self._grip = self._share(e.args[0]), self._look.end

    def _pointermove(self, e: events.GenericEventArguments) -> None:
        self._pointer = self._share(e.args[0])
        if e.args[1] & 1 and self._grip is not None:
            share, end = self._grip
            self._show(round(end - (self._pointer - share) * float(self._span.value) * SYSCLK_HZ))

    def _pointerleave(self, _e: events.GenericEventArguments) -> None:
        self._pointer = self._grip = None

    def _resized(self, e: events.GenericEventArguments) -> None:
        # Drawn in its own pixels, its names can be read at any width.  Out of sight it has none.
        if width := round(float(e.args["width"])):
            self._width = max(LEFT + 1, width)

    def _share(self, of_the_width: float) -> float:
        """The position of the pointer between the left and the right end of the lanes, 0..1."""
        return min(max((of_the_width * self._width - LEFT) / (self._width - LEFT), 0.0), 1.0)

    def _show(self, end: int) -> None:
        """Freeze the picture at a span that ends at a time, and draw it at once."""
        self._hold.value = True
        self._end = min(max(0, end), self._engine.snapshot.cycles)
        self._turn = EVERY - 1


def _in_words(span_s: float) -> str:
    """A span as the list shows it."""
    unit, per_s = ("s", 1.0) if span_s >= 1 else ("ms", 1e3) if span_s >= 1e-3 else ("us", 1e6)
    return f"{span_s * per_s:.3g} {unit}"


def probes_period(engine: Engine) -> float:
    """The present period in ms, as the list shows it."""
    period = engine.probes.period_cycles / CYCLES_PER_MS
    return min(PERIODS_MS, key=lambda each: abs(each - period))


def _height(axes: int) -> int:
    """The height of the chart in pixels."""
    return 250 if axes <= 1 else ABOVE + BELOW + AXIS * axes


def tick_times(begin_s: float, end_s: float, width: int) -> list[float]:
    """Round times for an axis of `width` pixels, as many as have room; none whose number would be cut at an end."""
    span_s = end_s - begin_s
    if span_s <= 0 or width <= 0:
        return []
    for exponent in range(floor(log10(span_s / width)), floor(log10(span_s)) + 1):
        digits = len(f"{end_s:.{max(0, -exponent)}f}")
        for factor in (1, 2, 5):
            step = factor * 10.0**exponent
            if step * width / span_s >= digits * DIGIT + GAP:
                margin = span_s / width * digits * DIGIT / 2
                first, last = ceil((begin_s + margin) / step), floor((end_s - margin) / step)
                return [round(n * step, 9) for n in range(first, last + 1)]
    return []


def _options(
    units: dict[str, str], values: dict[str, list[Sample]], begin_s: float, end_s: float,
    cursors_s: tuple[float, float] | None = None, width: int = WIDTH,
) -> dict[str, Any]:  # fmt: skip
    """The options of ECharts: an axis for each unit, one below the other; `units` are those of the signals to be
    drawn."""
    grey = "var(--soft)"
    text = {"color": grey}
    axes = list(dict.fromkeys(units.values())) or [""]
    titles = {name: f"{name}, {unit}" if unit else name for name, unit in units.items()}
    series: list[dict[str, Any]] = []
    for name, unit in units.items():
        samples = values[name]
        data = [[round(seconds(cycles), 9), round(value, 6)] for cycles, value in samples]
        if samples:
            data.append([round(end_s, 9), data[-1][1]])
        series.append({
            "name": titles[name], "type": "line", "step": "end", "showSymbol": False, "data": data, "animation": False,
            "xAxisIndex": axes.index(unit), "yAxisIndex": axes.index(unit), "lineStyle": {"width": 1.6},
        })  # fmt: skip
    if cursors_s is not None:
        marks = [
            {"xAxis": at, "label": {"formatter": letter, "color": grey, "position": "insideEndTop"}}
            for at, letter in zip(cursors_s, "AB", strict=True)
        ]
        series += [{
            "type": "line", "data": [], "animation": False, "name": f"cursors {n}", "xAxisIndex": n, "yAxisIndex": n,
            "markLine": {
                "data": marks, "symbol": "none", "animation": False, "precision": 9, "lineStyle": {"color": grey},
            },
        } for n in range(len(axes))]  # fmt: skip
    ticks = {"customValues": tick_times(begin_s, end_s, width - LEFT)}
    each = (_height(len(axes)) - ABOVE - BELOW) // len(axes)
    last = len(axes) - 1
    return {
        "animation": False, "color": COLOURS,
        "grid": [
            {"left": LEFT, "right": 0, "top": ABOVE + n * each, "height": each - (16 if last else 0),
             "outerBoundsMode": "none"}
            for n in range(len(axes))
        ],
        "legend": {"data": list(titles.values()), "textStyle": text, "top": 0, "type": "scroll"},
        "tooltip": {"trigger": "axis", "showContent": False},
        "axisPointer": {"link": [{"xAxisIndex": "all"}]},
        "xAxis": [
            {"type": "value", "gridIndex": n, "min": round(begin_s, 9), "max": round(end_s, 9),
             "name": "s" if n == last else "", "nameLocation": "center", "nameGap": 22,
             "axisLabel": text | ticks | {"show": n == last}, "axisTick": ticks,
             "nameTextStyle": text, "splitLine": ticks | {"lineStyle": {"color": "var(--line)"}},
             "axisLine": {"onZero": False}}
            for n in range(len(axes))
        ],
        "yAxis": [
            {"type": "value", "gridIndex": n, "scale": True, "name": unit, "nameLocation": "middle", "nameGap": 52,
             "nameTextStyle": text, "axisLabel": text, "splitNumber": 5 if not last else 3,
             "splitLine": {"lineStyle": {"color": "var(--line)"}}}
            for n, unit in enumerate(axes)
        ],
        "series": series,
    }  # fmt: skip
