"""Faults: the kinds of this board, with their parameters; the mounted ones, with their count and first access.

A fault that is mounted or removed here is an input of the run like any other: it is repeated when the run is executed
again.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from hil.faults import FAULTS, FaultOutcome, FaultParameter, parse
from hil.faults.effect import Phase
from hil.view.engine import Engine
from hil.view.notice import Notice
from hil.view.snapshot import Snapshot

if TYPE_CHECKING:
    from nicegui.elements.mixins.value_element import ValueElement

HELP: Final = (
    "Times count from the end of start-up, as those of orders. A time that has passed means now. After you go back in "
    "time, the fault begins again at its time."
)
UNWATCHED: Final = "Which task reads it first is shown only for a run that starts with such a fault (--fault)."


class FaultsPanel:
    """The panel."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._fields: dict[str, ValueElement[Any]] = {}
        self._rows: list[FaultRow] = []
        unsuitable = engine.unsuitable
        offered = [name for name in FAULTS if name not in unsuitable]
        ui.label(HELP).classes("soft")
        with ui.row().classes("items-end gap-2"):
            self._kind = (
                ui.select(
                    offered, value=offered[0], label="what breaks", with_input=True, on_change=self._show_parameters,
                ).props("dense").classes("w-64").mark("fault")
            )  # fmt: skip
            ui.button("Break it", on_click=self._break).props("no-caps dense").mark("break")
        self._notice = Notice()
        self._parameters = ui.column().classes("w-full gap-1").mark("parameters")
        self._show_parameters()
        ui.label("Mounted").classes("head")
        self._none = ui.label("nothing is broken on purpose").classes("soft")
        self._mounted = ui.column().classes("w-full gap-1").mark("mounted")
        if unsuitable:
            with ui.expansion(f"{len(unsuitable)} kinds that this board cannot have").classes("w-full").props("dense"):
                for name, why in unsuitable.items():
                    ui.label(f"{name}: {why}").classes("soft")

    def _show_parameters(self) -> None:
        kind = FAULTS.get(str(self._kind.value))
        if kind is None:
            return
        self._parameters.clear()
        with self._parameters:
            watched = self._engine.setup.watch or not kind.watch
            ui.label(kind.sentence if watched else f"{kind.sentence} {UNWATCHED}")
            self._fields = {parameter.name: _field(parameter) for parameter in kind.parameters}

    async def _break(self) -> None:
        arguments = [f"{name}={field.value}" for name, field in self._fields.items() if field.value not in (None, "")]
        try:
            fault = parse(f"{self._kind.value}:{','.join(arguments)}")
            await asyncio.wrap_future(self._engine.act("break", str(fault)))
        except ValueError as error:
            self._notice.tell(str(error))
        else:
            self._notice.tell("")

    def update(self, now: Snapshot) -> None:
        """Update the panel while it is visible."""
        if [row.fault for row in self._rows] != [str(fired.fault) for fired, _ in now.faults]:
            self._mounted.clear()
            with self._mounted:
                self._rows = [FaultRow(self._engine, n, str(fired.fault)) for n, (fired, _) in enumerate(now.faults)]
        for row, (fired, phase) in zip(self._rows, now.faults, strict=True):
            row.show(fired, phase)
        if self._none.visible is bool(now.faults):
            self._none.visible = not now.faults


class FaultRow:
    """One mounted fault: its parameters, how often it fired, and the button that ends it."""

    def __init__(self, engine: Engine, index: int, fault: str) -> None:
        self.fault = fault
        self._text = ""
        with ui.row().classes("items-center gap-3 w-full no-wrap"):
            with ui.column().classes("gap-0").style("flex:1 1 auto;min-width:0"):
                ui.label(fault).classes("mono")
                self._outcome = ui.label().classes("soft").mark(f"fired-{index}")
            self._remove = (
                ui.button("Remove", on_click=lambda: engine.act("mend", float(index)))
                .props("no-caps dense outline").mark(f"mend-{index}")
            )  # fmt: skip

    def show(self, fired: FaultOutcome, phase: Phase) -> None:
        """Show how often it has fired, and its first access."""
        text = f"{phase.value}; {str(fired).removeprefix(f'{self.fault}: ')}"
        if text != self._text:
            self._text = self._outcome.text = text
        if self._remove.visible is (phase is Phase.REMOVED):
            self._remove.visible = phase is not Phase.REMOVED


def _field(parameter: FaultParameter) -> Any:
    """A parameter: its field with unit and default, and its description."""
    label = f"{parameter.name}, {parameter.unit}" if parameter.unit else parameter.name
    default = parameter.default
    with ui.row().classes("items-center gap-3 w-full no-wrap"):
        made: ui.select | ui.input
        if parameter.choices:
            made = ui.select(list(parameter.choices), value=default, label=label)
        else:
            shown = "" if default is None else f"{default:g}" if isinstance(default, float) else str(default)
            made = ui.input(label, value=shown, placeholder="must be given" if default is None else "")
        made.props("dense stack-label").style("flex:none;width:9em").mark(f"parameter-{parameter.name}")
        free_text = parameter.type is str and not parameter.choices
        range_text = "" if free_text else f" ({parameter.range})"
        ui.label(f"{parameter.what}{range_text}".replace("`", "")).classes("soft")
    return made
