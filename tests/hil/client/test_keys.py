"""One table of keys: both consoles have each of them, none means two things, and `s` means nothing."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import pytest
from textual.binding import Binding

import hil.terminal
from hil.client.keys import KEYS, STOP, listed
from hil.terminal.app import TerminalApp

BOUND = [key for each in TerminalApp.BINDINGS for key in cast(Binding, each).key.split(",")]


def test_the_terminal_has_each_key_once_and_s_is_none() -> None:
    assert {key.terminal for key in KEYS} <= set(BOUND)
    assert len(BOUND) == len(set(BOUND))
    assert "s" not in BOUND


def test_space_stops_in_both() -> None:
    assert (STOP.terminal, STOP.browser) == ("space", " ")
    (binding,) = (cast(Binding, each) for each in TerminalApp.BINDINGS if cast(Binding, each).key == STOP.terminal)
    assert binding.action == "stop"
    assert binding.priority


def test_the_browser_has_each_key_and_its_own_ones_are_others() -> None:
    pytest.importorskip("nicegui", reason="pip install nicegui")
    from hil.robot.view.console_panel import ConsolePanel
    from hil.robot.view.orders import KEYS as HELP
    from hil.view.page import KEYS as OF_THE_PAGE
    from hil.view.time_panel import STEPS

    actions = ConsolePanel.actions.fget(_Standing())  # type: ignore[attr-defined]
    assert set(actions) == {key.browser for key in KEYS}
    own = {key for shown, _ in OF_THE_PAGE for key in shown.split(", ")} | {key for _, _, key in STEPS}
    assert own.isdisjoint({key.shown for key in KEYS})
    assert own.isdisjoint(set(BOUND) - {"1", "2"}), "a key of the terminal means something else in the browser"
    assert "s" not in own
    assert HELP == listed()


class _Standing:
    """Takes any attribute for what a key calls."""

    def __getattr__(self, name: str) -> _Standing:
        return self


def test_the_page_of_the_terminal_lists_each_key() -> None:
    page = Path(hil.terminal.__file__).with_name("README.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| ")]
    named = {key.strip() for row in rows for key in row.split(",")}
    assert {key.shown for key in KEYS} <= named
