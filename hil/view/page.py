"""The page: what stands where, the keys, and the 20 Hz."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any, Final

from nicegui import Client, events, ui

from hil.view.arena import Arena, FrameMap
from hil.view.console_panel import ConsolePanel
from hil.view.engine import Engine
from hil.view.findings_panel import FindingsPanel
from hil.view.line import Line
from hil.view.probes import signals
from hil.view.registers_panel import RegistersPanel
from hil.view.scope import ScopePanel
from hil.view.snapshot import Mode, Snapshot
from hil.view.style import CSS
from hil.view.time_panel import STEPS, TimeBar, TimePanel

UPDATE_S: Final = 0.05
_CHIP: Final = {Mode.RUNNING: "run", Mode.STOPPED: "bad"}
KEYS: Final = (
    ("m", "mission"), ("s", "STOP"), ("t", "telemanipulation on, off"), ("arrows", "drive, in telemanipulation"),
    ("0", "V = W = 0, in telemanipulation"), ("Esc", "end telemanipulation"), ("p", "run, pause"),
    ("n", "step to the next statement"),
    ("r", "step to the next register access"), ("k", "step to the next task switch"), ("f", "step to the next frame"),
    ("1 ... 5", "panels"), ("?", "this list"),
)  # fmt: skip


class Page:
    """What every page has: orders on top, console panel, keys."""

    def __init__(self, line: Line) -> None:
        self.line = line
        self.console: ConsolePanel
        self.more_keys: dict[str, Callable[[], Any]] = {}
        ui.add_css(CSS)
        ui.colors(primary="#2a6bd1", positive="#0a7d4a", negative="#c0271b")
        self._dark = False
        with ui.dialog() as self.help, ui.card():
            ui.label("Keys").classes("head")
            with ui.grid(columns=2).classes("gap-x-6 gap-y-1"):
                for key, text in KEYS:
                    ui.label(key).classes("mono")
                    ui.label(text)
        ui.keyboard(self._key, ignore=["input", "select", "textarea"])

    def orders(self) -> None:
        """The two buttons that everybody must find."""
        ui.button("MISSION", color="positive", on_click=lambda: self.console.mission()).classes("big").mark("mission")
        ui.button("STOP", color="negative", on_click=lambda: self.console.stop()).classes("big").mark("stop")

    def corner(self) -> None:
        """Help and light."""
        ui.button("keys ?", on_click=self.help.open).props("no-caps dense flat").mark("keys")
        ui.button("light / dark", on_click=self._other_light).props("no-caps dense flat").mark("light")

    def _other_light(self) -> None:
        self._dark = not self._dark
        # While this element is there, each change of the page has the browser style the whole of it anew.
        switch = ui.dark_mode(self._dark)
        ui.timer(1.0, switch.delete, once=True)

    def _key(self, e: events.KeyEventArguments) -> None:
        name, down = str(e.key), bool(e.action.keydown)
        if e.modifiers.ctrl or e.modifiers.alt or e.modifiers.meta:
            return
        if self.console.key(name, down) or not down or (e.action.repeat and name not in "nrkf"):
            return
        actions: dict[str, Callable[[], Any]] = {
            "m": self.console.mission, "s": self.console.stop, "t": self.console.toggle_tele,
            "0": self.console.tele.rest, "Escape": self.console.end_tele, "?": self.help.open, **self.more_keys,
        }  # fmt: skip
        action = actions.get(name)
        if action is not None:
            action()


async def robot_page(engine: Engine) -> None:
    """The page of an emulated robot."""
    page = Page(engine.line)
    client = ui.context.client
    await client.connected()
    starting: ui.label | None = None
    while client.id in Client.instances and not engine.ready.is_set():
        if starting is None:
            starting = ui.label("starting up: the firmware is translated, linked and booted ...").classes("head")
        await asyncio.sleep(0.1)
    if client.id not in Client.instances:
        return  # whoever asked was no browser, or has gone
    if starting is not None:
        starting.delete()
    if engine.error is not None:
        ui.label(f"the robot does not start: {engine.error}").style("color:var(--bad)")
        return
    names_of_signals = await asyncio.wrap_future(engine.submit(lambda run: signals(run.bench)))
    with ui.row().classes("items-center no-wrap gap-3 w-full"):
        page.orders()
        head = _Head()
        page.corner()
    bar = TimeBar(engine)
    with ui.row().classes("w-full no-wrap items-start gap-3"):
        with ui.column().classes("gap-1").style("flex:1 1 54%;min-width:0"):
            arena = Arena(engine)
        with ui.column().classes("panel side gap-1").style("flex:1 1 46%;min-width:0"):
            with ui.tabs().props("dense no-caps align=left").classes("w-full") as tabs:
                names = ["Console", "Time", "Findings", "Registers", "Scope"]
                for name in names:
                    ui.tab(name).mark(f"tab-{name.lower()}")
            with (
                ui.tab_panels(tabs, value="Console", animated=False)
                .classes("w-full bg-transparent")
                .props("keep-alive")
            ):
                with ui.tab_panel("Console").classes("p-1 gap-2"):
                    page.console = ConsolePanel(engine.line, arena.show_loaded)
                with ui.tab_panel("Time").classes("p-1 gap-2"):
                    time_panel = TimePanel(engine)
                with ui.tab_panel("Findings").classes("p-1 gap-2"):
                    findings = FindingsPanel(engine)
                with ui.tab_panel("Registers").classes("p-1 gap-2"):
                    registers = RegistersPanel(engine, engine.blocks)
                with ui.tab_panel("Scope").classes("p-1 gap-2"):
                    scope = ScopePanel(engine, names_of_signals)
    panels: dict[str, Callable[[Snapshot], None]] = {
        "Time": time_panel.update, "Findings": findings.update, "Registers": registers.update, "Scope": scope.update,
    }  # fmt: skip
    page.more_keys = {"p": bar.toggle}
    page.more_keys |= {key: partial(bar.step, kind) for kind, _, key in STEPS}
    page.more_keys |= {str(index): partial(tabs.set_value, name) for index, name in enumerate(names, 1)}

    def update() -> None:
        now = engine.snapshot
        head.update(now)
        bar.update(now)
        arena.update(now)
        page.console.update()
        shown = panels.get(str(tabs.value))
        if shown is not None:
            shown(now)

    ui.timer(UPDATE_S, update)
    client.on_disconnect(page.console.leave_tele)


class _Head:
    """What the robot is doing, in one line."""

    def __init__(self) -> None:
        self._mode = ui.label().classes("chip").mark("mode")
        self._css = ""
        self._text = ui.label().classes("value one-line").mark("status")

    def update(self, now: Snapshot) -> None:
        """20 times a second."""
        status = now.status
        front, right, left = status.distances_cm
        pace = f"  pace {now.reached:.2f}, {now.lag_ms:.0f} ms late" if now.mode is Mode.RUNNING else ""
        text = (
            f"{now.time_s:.3f} s   robot: {status.state}   x {status.x_m:.2f} m  y {status.y_m:.2f} m  "
            f"heading {status.heading_rad:+.2f} rad   front {front:.0f}  right {right:.0f}  left {left:.0f} cm   "
            f"{now.findings} findings{pace}"
        )
        if self._text.text != text:
            self._text.text = text
        if self._mode.text != now.mode.value:
            self._mode.text = now.mode.value
            css = _CHIP.get(now.mode, "wait")
            self._mode.classes(add=css, remove=" ".join({"run", "wait", "bad"} - {css}))


def console_page(line: Line) -> None:
    """The page of a robot that is only a serial line."""
    page = Page(line)
    with ui.row().classes("items-center gap-3 w-full"):
        page.orders()
        ui.label(f"robot at {line.address}").classes("value")
        ui.space()
        page.corner()
    with ui.row().classes("w-full no-wrap items-start gap-3"):
        with ui.column().classes("gap-1").style("flex:1 1 54%;min-width:0"):
            frames = FrameMap(line.log)
        with ui.column().classes("panel gap-2").style("flex:1 1 46%;min-width:0"):
            page.console = ConsolePanel(line, frames.show_loaded)

    def update() -> None:
        page.console.update()
        frames.update()

    ui.timer(UPDATE_S, update)
    ui.context.client.on_disconnect(page.console.leave_tele)
