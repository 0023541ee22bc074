"""The scrub bar: the whole run with its findings, orders and bumps as ticks; dragging goes to another time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from html import escape
from typing import Final

from nicegui import events, ui

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ, seconds
from hil.view.engine import Engine
from hil.view.rated_finding import RatedFinding, rated
from hil.view.showing import Mark
from hil.view.snapshot import Mode, Snapshot

#: The bar ends at one of these, in seconds, or at whole hours.
ENDS_S: Final = (10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600)
#: Places that the bar tells apart, and the width of its ticks' picture.
STEPS: Final = 1000
#: Page updates between two looks at the ticks.
EVERY: Final = 10


def end_s(known_s: float) -> int:
    """The end of a bar that shows all that is known, with some room."""
    return next((end for end in ENDS_S if known_s <= end), 3600 * (1 + int(known_s // 3600)))


#: How far from a tick a click still is one on it, as a share of the bar; ticks are thin.
REACH: Final = 0.012
#: Where it was clicked, as a share of the width.
CLICKED: Final = """(e) => { const box = e.currentTarget.getBoundingClientRect();
  emit((e.clientX - box.left) / box.width); }"""


def ticks(findings: Iterable[RatedFinding], marks: Iterable[Mark], end: float, known_cycles: int = 0) -> str:
    """The ticks: findings above, inputs and events below, each with its text; and how far the run is known."""

    def x(cycles: int) -> float:
        return round(STEPS * min(1.0, seconds(cycles) / end), 1)

    drawn = [(x(each.finding.time_cycles), 0, f"finding {each.kind}", _in_words(each)) for each in findings]
    drawn += [(x(each.cycles), 9, each.kind.value, f"{each.text}, {seconds(each.cycles):.3f} s") for each in marks]
    known = f'<rect class="known" x="0" y="16" width="{x(known_cycles)}" height="1"/>'
    return known + "".join(
        f'<g><rect class="reach" x="{at - 5}" y="{top}" width="12" height="8"/>'
        f'<rect class="{css}" x="{at}" y="{top}" width="2" height="8"/><title>{escape(text)}</title></g>'
        for at, top, css, text in drawn
    )


def _in_words(rated_finding: RatedFinding) -> str:
    finding = rated_finding.finding
    accepted = f", accepted: {rated_finding.accepted}" if rated_finding.accepted else ""
    return f"{finding.rule}, {finding.time_us / 1e3:.3f} ms{accepted}"


def nearest(findings: Iterable[Finding], marks: Iterable[Mark], at_s: float, reach_s: float) -> Finding | Mark | None:
    """The tick under a click."""
    every = [(abs(seconds(cycles) - at_s), n, each) for n, (cycles, each) in enumerate(_timed(findings, marks))]
    far, _, found = min(every, default=(reach_s + 1.0, 0, None), key=lambda each: each[:2])
    return found if far <= reach_s else None


def _timed(findings: Iterable[Finding], marks: Iterable[Mark]) -> Iterator[tuple[int, Finding | Mark]]:
    for finding in findings:
        yield finding.time_cycles, finding
    for mark in marks:
        yield mark.cycles, mark


def neighbour(findings: Iterable[Finding], now_cycles: int, direction: int) -> Finding | None:
    """The finding next after (`direction` 1) or before (-1) a time."""
    later = [each for each in findings if (each.time_cycles - now_cycles) * direction > 0]
    return min(later, key=lambda each: direction * each.time_cycles, default=None)


class ScrubBar:
    """The bar; `on_finding(finding)` is called with the finding to which the run goes."""

    def __init__(self, engine: Engine, on_finding: Callable[[Finding], None]) -> None:
        self._engine = engine
        self._on_finding = on_finding
        self._turn = 0
        self._end_s = ENDS_S[0]
        self._dragging = False
        #: The cycle that was asked for, until the run is there.
        self._goal: int | None = None
        #: The finding at which it stands, or which it goes to.
        self._at: Finding | None = None
        with ui.row().classes("scrub items-center no-wrap gap-2 w-full"):
            before = self._jump_button("navigate_before", -1, "finding before this time")
            ui.label("finding").classes("soft wide")
            after = self._jump_button("navigate_next", 1, "finding after this time")
            self._jumps = {-1: before, 1: after}
            with ui.element("div").classes("bar"):
                self._ticks = ui.html(tag="svg", sanitize=False).mark("ticks").props(
                    f'viewBox="0 0 {STEPS} 17" preserveAspectRatio=none aria-hidden=true'
                ).on("click", self._clicked, js_handler=CLICKED)  # fmt: skip
                self._slider = (
                    ui.slider(min=0, max=self._end_s, step=self._end_s / STEPS, value=0)
                    .props('label dense aria-label="moment of the run"').mark("scrub")
                )  # fmt: skip
            self._slider.on("pan", self._panned)
            self._slider.on("change", self._chosen)
            self._end = ui.label(f"{self._end_s} s").classes("soft value")

    def _jump_button(self, icon: str, direction: int, meaning: str) -> ui.button:
        button = ui.button(icon=icon, on_click=lambda: self.jump(direction))
        with button.props(f'no-caps dense outline aria-label="{meaning}"'):
            ui.tooltip(meaning)
        return button

    @property
    def _findings(self) -> list[Finding]:
        engine = self._engine
        return [finding for finding, _ in engine.policy.with_severities(engine.known_findings)]

    def _neighbour(self, direction: int) -> Finding | None:
        at = self._at.time_cycles if self._at is not None else self._engine.snapshot.cycles
        return neighbour(self._findings, at, direction)

    def jump(self, direction: int) -> None:
        """Go to the statement of the next finding, or of the one before; if there is none, its button is disabled."""
        found = self._neighbour(direction)
        if found is not None:
            self.go_to(found)

    def go_to(self, finding: Finding) -> None:
        """Go to the statement of a finding."""
        self._at = finding
        self._goal = finding.time_cycles
        self._engine.go_to_finding(finding)
        self._on_finding(finding)

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""
        if now.mode is not Mode.REPLAYING:
            self._goal = None
        if now.mode is Mode.RUNNING:
            self._at = None
        self._turn = (self._turn + 1) % EVERY
        if self._turn % (EVERY // 2) == 0 and not self._dragging:
            shown = round(seconds(now.cycles if self._goal is None else self._goal), 3)
            if self._slider.value != shown:
                self._slider.value = shown
        if self._turn:
            return
        for direction, button in self._jumps.items():
            button.enabled = self._neighbour(direction) is not None
        end = end_s(seconds(self._engine.known_cycles))
        if end != self._end_s:
            self._end_s = end
            self._slider.props(f"max={end} step={end / STEPS}")
            self._end.text = f"{end} s"
        findings = rated(self._engine.known_findings, self._engine.policy)
        drawn = ticks(findings, self._engine.marks, end, self._engine.known_cycles)
        if drawn != self._ticks.content:
            self._ticks.content = drawn

    def _clicked(self, e: events.GenericEventArguments) -> None:
        at_s = float(e.args) * self._end_s
        found = nearest(self._findings, self._engine.marks, at_s, REACH * self._end_s)
        if isinstance(found, Finding):
            self.go_to(found)
        elif found is not None:
            self._go(found.cycles)

    def _panned(self, e: events.GenericEventArguments) -> None:
        self._dragging = e.args == "start"

    def _chosen(self, e: events.GenericEventArguments) -> None:
        self._dragging = False
        self._go(round(max(0.0, min(float(e.args), self._end_s)) * SYSCLK_HZ))

    def _go(self, cycles: int) -> None:
        self._at, self._goal = None, cycles
        self._engine.go_to(cycles)
