"""The time: run, pause, step, pace, the place of the last step, and going back to an earlier moment."""

from __future__ import annotations

from typing import Final

from nicegui import ui

from emulator.clock import SYSCLK_HZ, seconds
from hil.reports.excerpt import shown
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.notice import Notice
from hil.view.rows import Rows, TableCell, TableRow
from hil.view.snapshot import Mode, Snapshot
from hil.view.stepping import Step, StepEnd

PACES: Final = {
    "0.1": "0.1 x", "0.25": "0.25 x", "0.5": "0.5 x", "1": "1 x real time", "2": "2 x", "5": "5 x",
    "max": "as fast as possible",
}  # fmt: skip
STEPS: Final = (
    (Step.STATEMENT, "statement", "n"), (Step.ACCESS, "register access", "r"), (Step.SWITCH, "task switch", "k"),
    (Step.FRAME, "frame", "f"), (Step.FINDING, "finding", "g"),
)  # fmt: skip
#: CHOICE: the latest time to which one can go, in seconds: a day.
MAX_S: Final = 86_400
NOWHERE: Final = "Not inside a statement. Step, or go to a finding: its source, locals and registers stand here then."


class TimeBar:
    """The buttons for the time, at the top of the page."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        with ui.row().classes("items-center gap-2 timebar"):
            self._run = ui.button("Pause", on_click=self.toggle).props("no-caps dense").classes("w-20").mark("run")
            ui.label("step to next").classes("soft hint")
            for kind, text, key in STEPS:
                ui.button(text, on_click=lambda kind=kind: self.step(kind)).props("no-caps dense outline").mark(
                    f"step-{kind.name.lower()}"
                ).classes("wide").tooltip(f"key {key}")
            with (
                ui.button("Step").props("no-caps dense outline icon-right=arrow_drop_down").classes("narrow"),
                ui.menu(),
            ):
                for kind, text, _ in STEPS:
                    ui.menu_item(f"to the next {text}", on_click=lambda kind=kind: self.step(kind))
            paces, chosen = _paces(engine.pace)
            ui.select(paces, value=chosen, on_change=lambda e: self._pace(e.value)).props(
                'dense aria-label="pace"'
            ).mark("pace")
            self._progress = ui.linear_progress(value=0.0, show_value=False).classes("w-40").mark("progress")
            self._message = ui.label().classes("soft one-line").props("role=status").mark("message")

    def toggle(self) -> None:
        """Run or pause."""
        (self._engine.pause if self._engine.snapshot.mode is Mode.RUNNING else self._engine.resume)()

    def step(self, kind: Step) -> None:
        """Make a step."""
        self._engine.step(kind)

    def _pace(self, key: str) -> None:
        self._engine.set_pace(None if key == "max" else float(key))

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""
        label = "Pause" if now.mode is Mode.RUNNING else "Run"
        if self._run.text != label:
            self._run.text = label
        busy = now.progress < 1.0
        if self._progress.visible != busy:
            self._progress.visible = busy
        if busy:
            self._progress.value = round(now.progress, 2)
        if self._message.text != now.message:
            self._message.text = now.message


class TimePanel:
    """The place of the last step, and the moments to which one can go back."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        with ui.row().classes("items-end gap-2"):
            self._to = (
                ui.number("time, s", value=engine.moments.all[0].time_s, step=0.1, format="%.6f")
                .props("dense")
                .classes("w-32")
                .mark("to")
            )
            ui.button("Go to this time", on_click=self._go).props("no-caps dense").mark("go")
            self._label = ui.input("name of this moment").props("dense stack-label maxlength=60").classes("w-40")
            ui.button("Remember", on_click=self._remember).props("no-caps dense outline").mark("remember")
        self._notice = Notice()
        ui.label(
            "An earlier moment is executed again from power-up with the same inputs at the same cycles: the same run, "
            "byte for byte. What was done later is done again, until you do something else."
        ).classes("soft")
        self._ahead = ui.label().classes("soft")
        ui.label("Where the last step stopped").classes("head")
        self._where = WherePanel(NOWHERE)
        ui.label("Moments").classes("head")
        with ui.element("div").classes("scrolled w-full"):
            self._moments = Rows(("time", "what follows, or its name"), self._go_to).classes("moments").mark("moments")

    def _go(self) -> None:
        time_s = self._to.value
        if time_s is None or not 0.0 <= time_s <= MAX_S:
            self._notice.tell(f"the time must be from 0 to {MAX_S} s")
            return
        self._notice.tell("")
        self._engine.go_to(round(float(time_s) * SYSCLK_HZ))

    def _remember(self) -> None:
        self._engine.note(str(self._label.value or "remembered"))

    def update(self, now: Snapshot) -> None:
        """Update the panel while it is visible."""
        text = f"{now.ahead} inputs of the earlier run lie ahead and will be done again" if now.ahead else ""
        if self._ahead.text != text:
            self._ahead.text = text
        self._where.update(now)
        moments = [
            TableRow(str(each.cycles), (TableCell(f"{each.time_s:.3f} s", css="whole"), TableCell(each.label)))
            for each in reversed(self._engine.moments.all)
        ]
        self._moments.show(moments)

    def _go_to(self, cycles: str) -> None:
        self._engine.go_to(int(cycles))


class WherePanel:
    """The place of the last step: statement, callers, locals, and the registers that were written last.

    `text_before` is shown while there is no such place.
    """

    def __init__(self, text_before: str = "") -> None:
        self._shown: StepEnd | None = None
        self._text_before = text_before
        self._box = ui.column().classes("w-full gap-1").mark("where")
        with self._box:
            ui.label(text_before).classes("soft")

    def update(self, now: Snapshot) -> None:
        """Update the panel while it is visible."""
        if now.where != self._shown:
            self._shown = now.where
            self._box.clear()
            with self._box:
                if now.where is None:
                    ui.label(self._text_before).classes("soft")
                else:
                    self._show(now.where)

    def _show(self, where: StepEnd) -> None:
        at = f"{seconds(where.cycles):.9f} s (cycle {where.cycles})"
        ui.label(f"{at}, {where.task}: {where.text}").classes("value")
        if where.place is not None:
            called = "".join(f"\ncalled from {shown(caller)}" for caller in where.callers)
            ui.label(shown(where.place) + called).classes("soft whitespace-pre-line")
            show_code(where.place)
        if where.locals:
            _values("locals", [f"{name} = {value}" for name, value in where.locals])
        if where.registers:
            written = [f"{path} = {word:#06x}, {before:.2f} us before" for path, word, before in where.registers]
            _values("registers written last", written)


def _values(title: str, lines: list[str]) -> None:
    ui.label(title).classes("soft")
    ui.label("\n".join(lines)).classes("mono whitespace-pre-line")


def _paces(pace: float | None) -> tuple[dict[str, str], str]:
    """The paces of the list, and the present pace, which may be any number of the command line."""
    key = "max" if pace is None else f"{pace:g}"
    return ({key: f"{key} x"} if key not in PACES else {}) | PACES, key
