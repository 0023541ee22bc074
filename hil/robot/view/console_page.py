"""The page of a robot behind a serial line: `hil console --view`."""

from __future__ import annotations

from nicegui import ui

from hil.robot.view.arena import FrameMap
from hil.robot.view.console_panel import ConsolePanel
from hil.robot.view.orders import KEYS, mission_and_stop
from hil.view.line import RobotLine
from hil.view.page import Page, Updates, hidden_heading


def console_page(line: RobotLine) -> None:
    """Build the page: the orders, and a map from the frames."""
    ui.page_title(f"Robot at {line.address} - c2000-hil")
    page = Page(KEYS, lambda name, down: console.key(name, down))
    with ui.element("section").classes("top").props('aria-label="orders"'):
        hidden_heading("Robot at a serial line", 1)
        mission_and_stop(lambda: console)
        ui.label(f"robot at {line.address}").classes("value")
        page.corner()
    with ui.element("div").classes("main"):  # within the main of the page
        with ui.element("section").classes("left").props('aria-label="picture"'):
            frames = FrameMap(line.log)
        with ui.element("section").classes("panel side console").props('aria-label="console"'):
            console = ConsolePanel(line, frames.show_loaded)
    page.actions |= console.actions

    def update() -> None:
        console.update()
        frames.update()

    Updates(update)
    ui.context.client.on_disconnect(console.leave_tele)
