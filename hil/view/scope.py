"""The scope: signals and tasks against virtual time, with two cursors.

Signals are drawn by ECharts, which comes with NiceGUI; tasks are drawn as lanes below, on the same span of time.
"""

from __future__ import annotations

import asyncio
from bisect import bisect_right
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from html import escape
from typing import Any, Final

from nicegui import ui

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, seconds
from emulator.sysbios.gate_mutex_pri import GateMutexPri
from hil.instruments.timeline import Span, State, spans
from hil.view.checkpoints import Run
from hil.view.engine import Engine
from hil.view.probes import Probes, Sample
from hil.view.snapshot import Snapshot

EVERY: Final = 5
#: Points that are drawn of a signal; more are thinned to the extremes of each column.
COLUMNS: Final = 400
WIDTH: Final = 1000
LANE: Final = 24
LEFT: Final = 150
#: Spans of one state nearer than this in the picture are drawn as one, paler.
MERGE: Final = 2.0
#: Longer spans of time than this have too many events to be sorted four times a second: once a second.
LIVE_S: Final = 1.0
SPANS_S: Final = {0.001: "1 ms", 0.01: "10 ms", 0.1: "100 ms", 1.0: "1 s", 5.0: "5 s", 20.0: "20 s", 60.0: "60 s"}
PERIODS_MS: Final = {0.1: "0.1 ms", 1.0: "1 ms", 5.0: "5 ms", 20.0: "20 ms"}


@dataclass(frozen=True, slots=True)
class Look:
    """What is in sight at one moment, in cycles."""

    begin: int
    end: int
    values: dict[str, list[Sample]]
    #: None: not asked for.
    spans: list[Span] | None
    owners: tuple[str, ...]


def look(run: Run, probes: Probes, end: int | None, span_cycles: int, *, with_spans: bool = True) -> Look:
    """The signals and tasks of the span that ends at `end` (None: now)."""
    until = run.clock.now if end is None else end
    begin = max(0, until - span_cycles)
    tasks = run.bench.board.kernel.tasks
    drawn = None
    if with_spans:
        every = spans(probes.events_between(begin, until), _base_priorities(run), until)
        drawn = [each for each in every if each.end >= begin]
    values = {name: _thinned([s for s in probes.values(name, begin) if s[0] <= until]) for name in probes.names}
    return Look(begin, until, values, drawn, tuple(task.name for task in tasks.all))


def _base_priorities(run: Run) -> dict[str, int]:
    """Each task's own priority: what it has while it holds no gate, or had before it inherited another."""
    base = {task.name: task.priority for task in run.bench.board.kernel.tasks.all}
    for obj in run.bench.firmware.linked.objects.values():
        gate = obj.data[0] if len(obj.data) == 1 else None
        if isinstance(gate, GateMutexPri) and gate.owner is not None:
            base[gate.owner.name] = min(base[gate.owner.name], gate.original_priority)
    return base


def _thinned(samples: list[Sample]) -> list[Sample]:
    """At most two values a column: its lowest and its highest, in order of time."""
    step = -(-len(samples) // COLUMNS)
    if step <= 2:
        return samples
    kept: list[Sample] = []
    for index in range(0, len(samples), step):
        part = samples[index : index + step]
        low, high = min(part, key=lambda s: s[1]), max(part, key=lambda s: s[1])
        kept += [low] if low is high else sorted((low, high))
    return kept


def value_at(samples: list[Sample], cycles: int) -> float | None:
    """What a signal was at a time: the last value before it."""
    index = bisect_right(samples, (cycles, float("inf")))
    return samples[index - 1][1] if index else None


def lanes(now: Look, every: list[Span], cursors: tuple[int, int]) -> tuple[str, int]:
    """Tasks, Swis and Hwis as SVG, and its height."""
    names = [*now.owners, *sorted({each.lane for each in every} - set(now.owners))]
    rows = {name: index for index, name in enumerate(names)}
    height = LANE * len(names) + 8
    width = max(1, now.end - now.begin)

    def x(cycles: int) -> float:
        return LEFT + (WIDTH - LEFT) * (min(max(cycles, now.begin), now.end) - now.begin) / width

    css = {State.RUNNING: "running", State.READY: "ready", State.WAITING: "waiting"}
    parts = []
    for name, row in rows.items():
        y = row * LANE + 4
        parts.append(f'<text x="2" y="{y + 15}">{escape(name)}</text><path class="axis" d="M{LEFT} {y + 20}H{WIDTH}"/>')
    drawn: dict[str, list[str]] = {}
    for each, a, b, many in _merged(every, x):
        inset = 0 if each.state is State.RUNNING else 5
        style = f"{css[each.state]}{' raised' if each.raised else ''}{' many' if many else ''}"
        y, wide, high = rows[each.lane] * LANE + 5 + inset, max(b - a, 0.4), 15 - inset
        shape = f"M{a:.1f} {y}h{wide:.1f}v{high}h-{wide:.1f}z"
        drawn.setdefault(style, []).append(shape)
    parts += [f'<path class="{style}" d="{"".join(shapes)}"/>' for style, shapes in drawn.items()]
    parts += [f'<path class="cursor" d="M{x(c):.1f} 0V{height}"/>' for c in cursors]
    return "".join(parts), height


def _merged(every: list[Span], x: Callable[[int], float]) -> list[tuple[Span, float, float, bool]]:
    """Spans with their places in the picture; those that nearly touch there as one, and whether it is several."""
    last: dict[tuple[str, State, bool], tuple[Span, float, float, bool]] = {}
    done: list[tuple[Span, float, float, bool]] = []
    for each in every:
        key, a, b = (each.lane, each.state, each.raised), x(each.begin), x(each.end)
        known = last.get(key)
        if known is not None and a - known[2] < MERGE:
            last[key] = (known[0], known[1], max(b, known[2]), True)
            continue
        if known is not None:
            done.append(known)
        last[key] = (each, a, b, False)
    return [*done, *last.values()]


class ScopePanel:
    """The panel."""

    def __init__(self, engine: Engine, names: dict[str, str]) -> None:
        self._engine = engine
        self._turn = self._round = 0
        self._waiting: Future[Look] | None = None
        self._look: Look | None = None
        self._names: list[str] = []
        self._end: int | None = None
        #: What chart and lanes show.
        self._charted: Any = None
        self._laned: Any = None
        with ui.row().classes("items-center gap-2"):
            self._signal = ui.select(names, label="add a signal", with_input=True, on_change=self._add).props(
                "dense options-dense clearable"
            ).classes("w-64").mark("signal")  # fmt: skip
            self._span = ui.select(SPANS_S, value=5.0, label="span").props("dense").classes("w-24").mark("span")
            ui.select(
                PERIODS_MS,
                value=probes_period(engine),
                label="sampled every",
                on_change=lambda e: self._period(e.value),
            ).props("dense").classes("w-28")
            self._still = ui.switch("hold the picture").props("dense").mark("still")
            ui.button("earlier", on_click=lambda: self._shift(-1)).props("no-caps dense flat")
            ui.button("later", on_click=lambda: self._shift(1)).props("no-caps dense flat")
        self._chosen = ui.row().classes("gap-1").mark("signals")
        self._chart = ui.echart(_options([], 0.0, 1.0)).classes("w-full").style("height:250px").mark("chart")
        with ui.row().classes("items-center gap-0 w-full no-wrap"):
            ui.label("cursors A, B").classes("soft").style(f"flex:0 0 {100 * LEFT / WIDTH:g}%")
            self._cursors = (
                ui.range(min=0, max=1000, step=1, value={"min": 250, "max": 750}).props("dense").mark("cursors")
            )
        self._reading = ui.label().classes("value mono").mark("reading")
        ui.label("Tasks, Swis, Hwis: the kernel's events of some 14 s are kept").classes("soft")
        with ui.element("div").classes("lanes w-full"):
            self._lanes = ui.interactive_image(size=(WIDTH, LANE * 8), sanitize=False).classes("w-full").mark("lanes")
        with ui.row().classes("gap-x-4 soft"):
            for css, text in (
                ("--run", "runs"), ("--wait", "ready, pre-empted"), ("--bad", "waits at a gate"),
                ("--real", "outlined: inherited priority"), ("--line", "pale: several, too near to be told apart"),
            ):  # fmt: skip
                ui.html(f'<span class="key" style="border-color:var({css})"></span>{text}', sanitize=False)
        self._show_names()

    def update(self, _now: Snapshot) -> None:
        """While the panel is in sight."""
        if self._waiting is not None and self._waiting.done():
            answer, self._waiting = self._waiting, None
            if not answer.cancelled() and answer.exception() is None:
                self._look = answer.result()
        self._draw()
        self._turn = (self._turn + 1) % EVERY
        if self._turn == 0 and self._waiting is None:
            engine, cycles = self._engine, round(float(self._span.value) * SYSCLK_HZ)
            if self._still.value and self._end is None and self._look is not None:
                self._end = self._look.end
            elif not self._still.value:
                self._end = None
            end = self._end
            self._round = (self._round + 1) % 4
            live = float(self._span.value) <= LIVE_S or self._round == 0
            self._waiting = engine.submit(lambda run: look(run, engine.probes, end, cycles, with_spans=live))

    def _draw(self) -> None:
        now = self._look
        if now is None:
            return
        at = self._cursors.value
        key = (now.begin, now.end, at["min"], at["max"], tuple(now.values))
        width = now.end - now.begin
        a, b = (now.begin + width * int(at[side]) // 1000 for side in ("min", "max"))
        # The lanes of a span may come later than its chart: to sort the events of a long one takes its time.
        if now.spans is not None and key != self._laned:
            self._laned = key
            self._draw_lanes(now, now.spans, (a, b))
        if key == self._charted:
            return
        self._charted = key
        options = _options(list(now.values.items()), seconds(now.begin), seconds(now.end), (seconds(a), seconds(b)))
        self._chart.options.clear()
        self._chart.options.update(options)
        self._chart.update()
        lines = [f"A {seconds(a):.6f} s   B {seconds(b):.6f} s   B - A {(b - a) / CYCLES_PER_MS:.4f} ms"]
        for name, samples in now.values.items():
            va, vb = value_at(samples, a), value_at(samples, b)
            lines.append(f"{name}:  A {_number(va)}   B {_number(vb)}")
        self._reading.text = "\n".join(lines)

    def _draw_lanes(self, now: Look, every: list[Span], cursors: tuple[int, int]) -> None:
        picture, height = lanes(now, every, cursors)
        if self._lanes.props["size"] != (WIDTH, height):
            self._lanes.props["size"] = (WIDTH, height)
            self._lanes.run_method("updateViewbox", WIDTH, height)
        self._lanes.content = picture

    async def _add(self) -> None:
        name = self._signal.value
        if not name:
            return
        self._signal.value = None
        await asyncio.wrap_future(self._engine.submit(lambda _run: self._engine.probes.add(str(name))))
        self._show_names()

    def _remove(self, name: str) -> None:
        self._engine.submit(lambda _run: self._engine.probes.remove(name))
        self._names = [each for each in self._names if each != name]
        self._show_names(self._names)

    def _show_names(self, names: list[str] | None = None) -> None:
        self._names = self._engine.probes.names if names is None else names
        self._chosen.clear()
        with self._chosen:
            for name in self._names:
                ui.button(f"{name}  x", on_click=lambda name=name: self._remove(name)).props(
                    "no-caps dense outline size=sm"
                ).tooltip("record it no more")

    def _period(self, period_ms: float) -> None:
        self._engine.submit(lambda _run: self._engine.probes.set_period(round(period_ms * CYCLES_PER_MS)))

    def _shift(self, way: int) -> None:
        now = self._look
        if now is None:
            return
        self._still.value = True
        self._end = max(0, now.end + way * (now.end - now.begin) // 2)


def probes_period(engine: Engine) -> float:
    """The present period in ms, as the list offers it."""
    period = engine.probes.period_cycles / CYCLES_PER_MS
    return min(PERIODS_MS, key=lambda each: abs(each - period))


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.6g}"


def _options(
    values: list[tuple[str, list[Sample]]], begin_s: float, end_s: float, cursors_s: tuple[float, float] | None = None
) -> dict[str, Any]:
    """What ECharts draws: one axis each for what is 0..1 and for everything else."""
    grey = "#8793a0"
    series: list[dict[str, Any]] = []
    for name, samples in values:
        data = [[round(seconds(cycles), 9), round(value, 6)] for cycles, value in samples]
        if samples:
            data.append([round(end_s, 9), data[-1][1]])
        series.append({
            "name": name, "type": "line", "step": "end", "showSymbol": False, "data": data, "animation": False,
            "yAxisIndex": 1 if is_level(name) else 0, "lineStyle": {"width": 1.6},
        })  # fmt: skip
    if cursors_s is not None:
        marks = [
            {"xAxis": at, "label": {"formatter": letter, "color": grey, "position": "insideEndTop"}}
            for at, letter in zip(cursors_s, "AB", strict=True)
        ]
        series.append({
            "type": "line", "data": [], "animation": False, "name": "cursors",
            "markLine": {
                "data": marks, "symbol": "none", "animation": False, "precision": 9, "lineStyle": {"color": grey},
            },
        })  # fmt: skip
    text = {"color": grey}
    return {
        "animation": False,
        "grid": {"left": f"{100 * LEFT / WIDTH:g}%", "right": 0, "top": 28, "bottom": 40, "outerBoundsMode": "none"},
        "legend": {"data": [name for name, _ in values], "textStyle": text, "top": 0, "type": "scroll"},
        "tooltip": {"trigger": "axis"},
        "xAxis": {"type": "value", "min": round(begin_s, 9), "max": round(end_s, 9), "name": "s",
                  "nameLocation": "center", "nameGap": 22,
                  "axisLabel": text | {"showMinLabel": False, "showMaxLabel": False},
                  "nameTextStyle": text, "splitLine": {"lineStyle": {"opacity": 0.25}}, "axisLine": {"onZero": False}},
        "yAxis": [
            {"type": "value", "scale": True, "axisLabel": text, "splitLine": {"lineStyle": {"opacity": 0.25}}},
            {"type": "value", "min": -0.1, "max": 1.1, "axisLabel": text | {"inside": True},
             "splitLine": {"show": False}, "show": any(is_level(name) for name, _ in values)},
        ],
        "series": series,
    }  # fmt: skip


def is_level(name: str) -> bool:
    """Whether a signal lies in 0..1."""
    return name.startswith(("gate ", "duty ")) or (name.startswith("GPIO") and "." not in name)
