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
    with ui.element("header").classes("top"):
        with ui.element("h1").classes("heard"):
            ui.label("Robot at a serial line")
        mission_and_stop(lambda: console)
        ui.label(f"robot at {line.address}").classes("value")
        page.corner()
    with ui.element("main").classes("main"):
        with ui.element("section").classes("left").props('aria-label="picture"'):
            frames = FrameMap(line.log)
        with ui.element("section").classes("panel side console").props('aria-label="console"'):
            console = ConsolePanel(line, frames.show_loaded)
    page.actions |= console.actions

    def update() -> None:
        console.update()
        frames.update()

    ui.timer(UPDATE_S, update)
    ui.context.client.on_disconnect(console.leave_tele)
