"""The robot's two big buttons and its keys."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from nicegui import ui

from hil.client.keys import listed
from hil.robot.view.console_panel import ConsolePanel

KEYS: Final = listed()


def mission_and_stop(console: Callable[[], ConsolePanel]) -> None:
    """Add the two big buttons."""
    with ui.row().classes("orders no-wrap gap-2"):
        ui.button("MISSION", color="positive", on_click=lambda: console().mission()).classes("big").mark("mission")
        ui.button("STOP", color="negative", on_click=lambda: console().stop()).classes("big").mark("stop")
