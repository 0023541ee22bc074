"""The page of a robot that is only a serial line: `hil console --view`."""

from __future__ import annotations

from nicegui import ui

from hil.robot.view.arena import FrameMap
from hil.robot.view.console_panel import ConsolePanel
from hil.robot.view.orders import KEYS, mission_and_stop
from hil.view.line import Line
from hil.view.page import UPDATE_S, Page


def console_page(line: Line) -> None:
    """Orders and what the frames say."""
    page = Page(KEYS, lambda name, down: console.key(name, down))
    with ui.row().classes("items-center gap-3 w-full"):
        mission_and_stop(lambda: console)
        ui.label(f"robot at {line.address}").classes("value")
        ui.space()
        page.corner()
    with ui.row().classes("w-full no-wrap items-start gap-3"):
        with ui.column().classes("gap-1").style("flex:1 1 54%;min-width:0"):
            frames = FrameMap(line.log)
        with ui.column().classes("panel gap-2").style("flex:1 1 46%;min-width:0"):
            console = ConsolePanel(line, frames.show_loaded)
    page.actions |= console.actions

    def update() -> None:
        console.update()
        frames.update()

    ui.timer(UPDATE_S, update)
    ui.context.client.on_disconnect(console.leave_tele)
