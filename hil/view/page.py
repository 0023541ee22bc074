"""The page: what stands where, the keys, and the 20 Hz."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final

from nicegui import Client, events, ui

from hil.board import made
from hil.view.board_panel import BoardPanel
from hil.view.engine import Engine
from hil.view.faults_panel import FaultsPanel
from hil.view.findings_panel import FindingsPanel
from hil.view.line_panel import LinePanel
from hil.view.probes import labels
from hil.view.registers_panel import RegistersPanel
from hil.view.scope import ScopePanel
from hil.view.snapshot import Mode, Snapshot
from hil.view.stage import Panels, panels_of
from hil.view.style import CSS
from hil.view.time_panel import STEPS, TimeBar, TimePanel

UPDATE_S: Final = 0.05
_CHIP: Final = {Mode.RUNNING: "run", Mode.STOPPED: "bad"}
KEYS: Final = (
    ("p", "run, pause"), ("n", "step to the next statement"), ("r", "step to the next register access"),
    ("k", "step to the next task switch"), ("f", "step to the next frame"), ("1, 2, ...", "panels"),
)  # fmt: skip
#: Of these, a key that is held steps on and on.
_REPEATED: Final = "nrkf"


class Page:
    """What every page has: keys and their list, light and dark.  `actions` says what a key does.

    `take_first(key, down)` sees each key first, and says whether it took it.
    """

    def __init__(
        self, keys: Sequence[tuple[str, str]], take_first: Callable[[str, bool], bool] = lambda _name, _down: False
    ) -> None:
        self._take_first = take_first
        ui.add_css(CSS)
        ui.colors(primary="#2a6bd1", positive="#0a7d4a", negative="#c0271b")
        self._dark = False
        with ui.dialog() as self._help, ui.card():
            ui.label("Keys").classes("head")
            with ui.grid(columns=2).classes("gap-x-6 gap-y-1"):
                for key, text in (*keys, ("?", "this list")):
                    ui.label(key).classes("mono")
                    ui.label(text)
        self.actions: dict[str, Callable[[], Any]] = {"?": self._help.open}
        ui.keyboard(self._key, ignore=["input", "select", "textarea"])

    def corner(self) -> None:
        """Help and light."""
        ui.button("keys ?", on_click=self._help.open).props("no-caps dense flat").mark("keys")
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
        if self._take_first(name, down) or not down or (e.action.repeat and name not in _REPEATED):
            return
        action = self.actions.get(name)
        if action is not None:
            action()


async def machine_page(engine: Engine) -> None:
    """The page of an emulated board; of a robot, with what its stage has."""
    stage = panels_of(engine.kind.view, engine)
    page = Page(KEYS) if stage is None else Page((*stage.keys, *KEYS), stage.key)
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
        ui.label(f"it does not start: {engine.error}").style("color:var(--bad)")
        return
    names = await asyncio.wrap_future(engine.submit(labels))
    shown = Shown(page, engine, stage, names)
    # What is seldom changed is sent with the elements themselves: while the browser loads what some of them need, an
    # update that comes early is overtaken by the state that they were made with.
    shown.update()
    ui.timer(UPDATE_S, shown.update)
    if stage is not None:
        client.on_disconnect(stage.leave)


class Shown:
    """What stands on the page of an emulated board: of a robot its stage, of any other its parts; and the tabs."""

    def __init__(self, page: Page, engine: Engine, stage: Panels | None, names: dict[str, str]) -> None:
        self._engine, self._stage = engine, stage
        #: What is updated always, and what only while its tab is in sight.
        self._always: list[Callable[[Snapshot], None]] = []
        self._in_sight: dict[str, Callable[[Snapshot], None]] = {}
        with ui.row().classes("items-center no-wrap gap-3 w-full"):
            if stage is not None:
                stage.top()
            self._always.append(_Head(engine.kind.__name__, stage).update)
            page.corner()
        bar = TimeBar(engine)
        self._always.append(bar.update)
        with ui.row().classes("w-full no-wrap items-start gap-3"):
            with ui.column().classes("gap-1").style("flex:1 1 54%;min-width:0"):
                self._picture()
            with ui.column().classes("panel side gap-1").style("flex:1 1 46%;min-width:0"):
                titles = self._build_tabs(names)
        page.actions |= {"p": bar.toggle}
        page.actions |= {key: partial(bar.step, kind) for kind, _, key in STEPS}
        page.actions |= {str(n): partial(self._tabs.set_value, title) for n, title in enumerate(titles, 1)}
        if stage is not None:
            page.actions |= stage.actions

    def _picture(self) -> None:
        if self._stage is not None:
            self._stage.picture()
            self._always.append(self._stage.update)
            return
        board = _board_panel(self._engine)
        self._always.append(board.update)
        if board.has_pc:
            with ui.column().classes("panel w-full gap-1"):
                self._always.append(LinePanel(self._engine.line).update)

    def _build_tabs(self, names: dict[str, str]) -> list[str]:
        engine, stage = self._engine, self._stage
        tabs: dict[str, Callable[[], Any]] = {} if stage is None else dict(stage.tabs)
        tabs |= {
            "Time": lambda: TimePanel(engine), "Findings": lambda: FindingsPanel(engine),
            "Registers": lambda: RegistersPanel(engine, engine.blocks), "Scope": lambda: ScopePanel(engine, names),
            "Faults": lambda: FaultsPanel(engine),
        }  # fmt: skip
        if stage is not None:
            tabs["Board"] = lambda: _board_panel(engine)
        titles = list(tabs)
        with ui.tabs().props("dense no-caps align=left").classes("w-full") as self._tabs:
            for title in titles:
                ui.tab(title).mark(f"tab-{title.lower()}")
        with (
            ui.tab_panels(self._tabs, value=titles[0], animated=False)
            .classes("w-full bg-transparent")
            .props("keep-alive")
        ):
            for title, build in tabs.items():
                with ui.tab_panel(title).classes("p-1 gap-2"):
                    panel = build()
                    if panel is not None:
                        self._in_sight[title] = panel.update
        return titles

    def update(self) -> None:
        """20 times a second."""
        now = self._engine.snapshot
        for update in self._always:
            update(now)
        in_sight = self._in_sight.get(str(self._tabs.value))
        if in_sight is not None:
            in_sight(now)


def _board_panel(engine: Engine) -> BoardPanel:
    """Of a board made for it: the run's own belongs to the machine's thread."""
    return BoardPanel(engine, made(engine.kind, seed=engine.setup.seed, ideal=not engine.setup.realistic))


class _Head:
    """What it is doing, in one line."""

    def __init__(self, name: str, stage: Panels | None) -> None:
        self._name, self._stage = name, stage
        self._mode = ui.label().classes("chip").mark("mode")
        self._text = ui.label().classes("value one-line").mark("status")

    def update(self, now: Snapshot) -> None:
        """20 times a second."""
        status = f"board: {self._name}" if self._stage is None else self._stage.status(now)
        pace = f"  pace {now.reached:.2f}, {now.lag_ms:.0f} ms late" if now.mode is Mode.RUNNING else ""
        text = f"{now.time_s:.3f} s   {status}   {now.findings} findings{pace}"
        if self._text.text != text:
            self._text.text = text
        if self._mode.text != now.mode.value:
            self._mode.text = now.mode.value
            css = _CHIP.get(now.mode, "wait")
            self._mode.classes(add=css, remove=" ".join({"run", "wait", "bad"} - {css}))
