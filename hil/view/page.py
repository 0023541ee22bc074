"""The page: its layout, its keys, and its updates, up to 20 a second."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from html import escape
from typing import Any, Final

from nicegui import Client, events, ui

from emulator.c28x.findings import Finding
from hil.board import made
from hil.view.board_panel import BoardPanel
from hil.view.engine import Engine
from hil.view.faults_panel import FaultsPanel
from hil.view.findings_panel import FindingsPanel
from hil.view.line_panel import LinePanel
from hil.view.live import LiveHtml
from hil.view.rated_finding import by_kind, counted, rated
from hil.view.registers_panel import RegistersPanel
from hil.view.scope import ScopePanel
from hil.view.scrub import ScrubBar
from hil.view.snapshot import Mode, Snapshot
from hil.view.stage import PanelsProtocol, panels_of
from hil.view.style import CSS, HEAD
from hil.view.time_panel import STEPS, TimeBar, TimePanel

UPDATE_S: Final = 0.05
#: A browser that does not say that it has drawn an update gets the next one after so long: a page out of sight draws
#: nothing.
UNDRAWN_S: Final = 1.0
#: A pace that is reached to this share is kept.
PACE_KEPT: Final = 0.95
#: So many updates more without the pace than with it, and it is said: a second.
MAX_LATE_UPDATES: Final = 20
_CHIP: Final = {Mode.RUNNING: "run", Mode.STOPPED: "bad"}
KEYS: Final = (
    ("p", "run, pause"), ("n", "step to the next statement"), ("r", "step to the next register access"),
    ("k", "step to the next task switch"), ("f", "step to the next frame"), ("g", "step to the next finding"),
    ("[, ]", "go to the finding before, after"), ("1, 2, ...", "panels"),
)  # fmt: skip
#: Of these, a key that is held steps on and on.
_REPEATED: Final = "nrkf"
#: JavaScript that puts the visible panel into the page's address.
_IN_ADDRESS: Final = (
    "const to = new URL(location); to.searchParams.set('{key}', '{title}'); history.replaceState(history.state, '', to)"
)


class Page:
    """The common parts of every page: keys and their list, light and dark.  `actions` maps keys to functions.

    `take_first(key, down)` gets each key first, and returns whether it has handled it.
    """

    def __init__(
        self, keys: Sequence[tuple[str, str]], take_first: Callable[[str, bool], bool] = lambda _name, _down: False
    ) -> None:
        self._take_first = take_first
        ui.add_head_html(HEAD)
        ui.add_css(CSS)
        ui.colors(primary="#2462c4", positive="#0a7d4a", negative="#c0271b")
        with ui.dialog().props('aria-label="keys"') as self._help, ui.card():
            ui.label("Keys").classes("head")
            with ui.grid(columns=2).classes("gap-x-6 gap-y-1"):
                for key, text in (*keys, ("?", "this list")):
                    ui.label(key).classes("mono")
                    ui.label(text)
        self.actions: dict[str, Callable[[], Any]] = {"?": self._help.open}
        ui.keyboard(self._key, ignore=["input", "select", "textarea"])

    def corner(self) -> None:
        """The buttons for help and for light or dark."""
        with ui.row().classes("corner no-wrap gap-1"):
            ui.button("keys ?", on_click=self._help.open).props("no-caps dense flat").mark("keys")
            ui.button("light / dark").props("no-caps dense flat").mark("light").on("click", js_handler="hilOtherLight")

    def _key(self, e: events.KeyEventArguments) -> None:
        name, down = str(e.key), bool(e.action.keydown)
        if e.modifiers.ctrl or e.modifiers.alt or e.modifiers.meta:
            return
        if self._take_first(name, down) or not down or (e.action.repeat and name not in _REPEATED):
            return
        action = self.actions.get(name)
        if action is not None:
            action()


class Updates:
    """Calls `update` 20 times a second, but not before the browser has drawn what the call before has changed.

    A browser that is too slow for 20 updates a second shows fewer.  It would queue them otherwise, show old ones, and
    have its user wait behind them.
    """

    #: What a browser says after its next paint.
    _SAY: Final = 'requestAnimationFrame(() => setTimeout(() => emitEvent("hil-drawn")))'

    def __init__(self, update: Callable[[], None]) -> None:
        self._update = update
        self._drawn = True
        #: Turns that came before the browser had drawn.
        self._late_turns = 0
        ui.on("hil-drawn", self._on_drawn)
        ui.timer(UPDATE_S, self._turn)

    def _on_drawn(self) -> None:
        self._drawn = True
        if self._late_turns:
            self._turn()

    def _turn(self) -> None:
        if not self._drawn and self._late_turns < UNDRAWN_S / UPDATE_S:
            self._late_turns += 1
            return
        self._late_turns = 0
        self._drawn = False
        self._update()
        ui.run_javascript(self._SAY)


async def machine_page(engine: Engine) -> None:
    """The page of an emulated board; of a robot, with what its stage has."""
    stage = panels_of(engine.kind.view, engine)
    page = Page(KEYS) if stage is None else Page((*stage.keys, *KEYS), stage.key)
    client = ui.context.client
    if not engine.ready.is_set():
        await client.connected()
        if client.id not in Client.instances:  # nobody came
            return
        ui.label("starting up: the firmware is translated, linked and booted ...").classes("head").props("role=status")
        while client.id in Client.instances and not engine.ready.is_set():
            await asyncio.sleep(0.1)
        # A page is whole from its first paint on, so it is asked for anew.
        if client.id in Client.instances:
            ui.navigate.reload()
        return
    if engine.error is not None:
        ui.label(f"it does not start: {engine.error}").style("color:var(--bad)")
        return
    ui.page_title(f"{engine.kind.__name__} - c2000-hil")
    shown = BoardPage(page, engine, stage)
    shown.update()
    Updates(shown.update)
    if stage is not None:
        client.on_disconnect(stage.leave)


class BoardPage:
    """The content of the page of an emulated board: the stage of a robot, or the parts of another board; and the
    tabs."""

    def __init__(self, page: Page, engine: Engine, stage: PanelsProtocol | None) -> None:
        self._engine, self._stage = engine, stage
        self._always: list[Callable[[Snapshot], None]] = []
        with ui.element("section").classes("top").props('aria-label="robot, state, findings"'):
            hidden_heading(f"{engine.kind.__name__}, emulated", 1)
            if stage is not None:
                stage.top()
            self._always.append(_Head(engine, stage, self._show_findings).update)
            page.corner()
        bar = TimeBar(engine)
        self._always.append(bar.update)
        with ui.element("div").classes("main"):  # within the main of the page
            with ui.element("section").classes("left").props('aria-label="picture"'):
                self._picture()
                self._scrub = ScrubBar(engine, self._show_finding)
                self._always.append(self._scrub.update)
            build = self._panels()
            self._tabs = Tabs(build, "panels", "panel")
            # A second set of panels, where there is room for it: of those that can stand there twice.
            self._second_panels = {
                title: make for title, make in build.items() if stage is None or title not in stage.tabs
            }
            self._second: Tabs | None = None
            self._beside = ui.element("div").classes("beside")
        ui.on("hil-wide", self._show_second)
        page.actions |= {"p": bar.toggle, "[": partial(self._scrub.jump, -1), "]": partial(self._scrub.jump, 1)}
        page.actions |= {key: partial(bar.step, kind) for kind, _, key in STEPS}
        page.actions |= {str(n): partial(self._tabs.show, title) for n, title in enumerate(build, 1)}
        if stage is not None:
            page.actions |= stage.actions

    def _picture(self) -> None:
        if self._stage is not None:
            self._stage.picture()
            self._always.append(self._stage.update)
            return
        with ui.column().classes("parts w-full gap-2"):
            board = _board_panel(self._engine)
            self._always.append(board.update)
            if board.has_pc:
                with ui.column().classes("panel w-full gap-1 fills"):
                    self._always.append(LinePanel(self._engine.line).update)

    def _panels(self) -> dict[str, Callable[[], Any]]:
        engine, stage = self._engine, self._stage
        panels: dict[str, Callable[[], Any]] = {} if stage is None else dict(stage.tabs)
        panels |= {
            "Time": lambda: TimePanel(engine), "Findings": lambda: FindingsPanel(engine, self._go_to),
            "Registers": lambda: RegistersPanel(engine, engine.blocks), "Scope": lambda: ScopePanel(engine),
            "Faults": lambda: FaultsPanel(engine),
        }  # fmt: skip
        if stage is not None:
            panels["Board"] = lambda: _board_panel(engine)
        return panels

    def _go_to(self, finding: Finding) -> None:
        self._scrub.go_to(finding)

    def _show_findings(self) -> None:
        self._tabs.show("Findings")

    def _show_finding(self, finding: Finding) -> None:
        for tabs in (self._tabs, self._second):
            panel = None if tabs is None else tabs.panels.get("Findings")
            if isinstance(panel, FindingsPanel):
                panel.show(finding)
        if self._second is None or self._second.chosen != "Findings":
            self._show_findings()

    def _show_second(self) -> None:
        """Build the second panel once there is room for it: elements out of sight would be updated too."""
        if self._second is None:
            with self._beside:
                self._second = Tabs(self._second_panels, "more panels", "beside", chosen="Findings").classed("second")

    def update(self) -> None:
        """Update the panel, up to 20 times a second."""
        now = self._engine.snapshot
        for update in self._always:
            update(now)
        self._tabs.update(now)
        if self._second is not None:
            self._second.update(now)


class Tabs:
    """Panels behind tabs; only the visible one is updated.  `panels` are those that have something to update.

    The visible one stands in the page's address under `key`: a page that is loaded again, by its user or because the
    browser lost the server for a while, has the same panel.
    """

    def __init__(self, build: dict[str, Callable[[], Any]], name: str, key: str, *, chosen: str | None = None) -> None:
        self.panels: dict[str, Any] = {}
        request = ui.context.client.request
        wanted = None if request is None else request.query_params.get(key)
        if wanted in build:
            chosen = wanted
        with ui.element("section").classes("panel side").props(f'aria-label="{name}"') as self._box:
            with ui.tabs().props("dense no-caps align=left").classes("w-full") as self._tabs:
                for title in build:
                    ui.tab(title).mark(f"tab-{title.lower()}")
            with (
                ui.tab_panels(self._tabs, value=chosen or next(iter(build)), animated=False)
                .classes("w-full bg-transparent in-sight")
                .props("keep-alive tabindex=0")
            ):
                for title, make in build.items():
                    with ui.tab_panel(title).classes("p-1 gap-2"):
                        hidden_heading(title)
                        panel = make()
                        if panel is not None:
                            self.panels[title] = panel
        self._tabs.on_value_change(lambda e: ui.run_javascript(_IN_ADDRESS.format(key=key, title=e.value)))

    def classed(self, name: str) -> Tabs:
        """With a class of the style sheet."""
        self._box.classes(name)
        return self

    @property
    def chosen(self) -> str:
        """The visible panel."""
        return str(self._tabs.value)

    def show(self, title: str) -> None:
        """Show a panel."""
        self._tabs.set_value(title)

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""
        panel = self.panels.get(self.chosen)
        if panel is not None:
            panel.update(now)


def hidden_heading(text: str, level: int = 2) -> None:
    """A heading for screen readers, where others see a tab, a picture or a window title."""
    ui.html(escape(text), sanitize=False, tag=f"h{level}").classes("heard")


def _board_panel(engine: Engine) -> BoardPanel:
    """The panel of the board, on a board made for it: the run's own belongs to the machine's thread."""
    return BoardPanel(engine, made(engine.kind, seed=engine.setup.seed, ideal=not engine.setup.realistic))


class _Head:
    """The status tiles: state, time, pose, distances, findings."""

    def __init__(self, engine: Engine, stage: PanelsProtocol | None, on_findings: Callable[[], None]) -> None:
        self._engine, self._stage = engine, stage
        self._counted = -1
        #: Of the last updates, how many more found the pace unkept than kept.
        self._late_updates = 0
        # Live as the time is: the page that says "paused" has the time of the pause.
        self._mode = LiveHtml().classes("chip").props("role=status").mark("mode")
        self._tiles: dict[str, LiveHtml] = {}
        with ui.element("div").classes("tiles").mark("status"):
            self._tile("time")
            for title in self._titles(engine.snapshot):
                self._tile(title)
            with ui.element("button").classes("tile").on("click", on_findings).mark("counts"):
                ui.label("findings").classes("title")
                self._found = ui.html("none", sanitize=False).classes("value")
            self._pace = self._tile("pace").classes("pace")
            self._pace.visible = False

    def _titles(self, now: Snapshot) -> Iterable[str]:
        return [title for title, _ in self._status(now)]

    def _status(self, now: Snapshot) -> Sequence[tuple[str, str]]:
        return (("board", self._engine.kind.__name__),) if self._stage is None else self._stage.status(now)

    def _tile(self, title: str) -> ui.element:
        with ui.element("div").classes("tile") as box:
            ui.label(title).classes("title")
            self._tiles[title] = LiveHtml().classes("value").mark(f"tile-{title}")
        return box

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""
        self._tiles["time"].content = f"{now.time_s:.3f} s"
        for title, value in self._status(now):
            self._tiles[title].content = escape(value)
        kept = now.mode is not Mode.RUNNING or now.pace is None or now.reached >= PACE_KEPT * now.pace
        # It comes and goes slowly: what stands beside it shall not jump at each hiccup.
        self._late_updates = max(self._late_updates - 1, 0) if kept else min(self._late_updates + 1, MAX_LATE_UPDATES)
        if self._late_updates in (0, MAX_LATE_UPDATES) and self._pace.visible is not bool(self._late_updates):
            self._pace.visible = bool(self._late_updates)
        if self._pace.visible:
            self._tiles["pace"].content = f"{now.reached:.2f}, {now.lag_ms:.0f} ms late"
        findings = self._engine.findings
        if len(findings) != self._counted:
            self._counted = len(findings)
            self._found.content = counted(by_kind(rated(findings, self._engine.policy)))
        if self._mode.content != now.mode.value:
            self._mode.content = now.mode.value
            css = _CHIP.get(now.mode, "wait")
            self._mode.classes(add=css, remove=" ".join({"run", "wait", "bad"} - {css}))
