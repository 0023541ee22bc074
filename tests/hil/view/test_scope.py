"""The scope's picture: chart and lanes of one span of time."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from emulator.clock import SYSCLK_HZ
from hil.instruments.timeline import Span, State
from tests.hil.view.conftest import needs_view


@pytest.fixture
def panel() -> Any:
    """The panel's drawing without a browser: what it would send stays in its elements."""
    needs_view()
    from hil.view.scope import ScopePanel

    panel: Any = object.__new__(ScopePanel)
    panel._cursors = SimpleNamespace(value={"min": 250, "max": 750})
    panel._chart = SimpleNamespace(options={}, update=lambda: None)
    panel._lanes = SimpleNamespace(props={"size": None}, run_method=lambda *_: None, content="")
    panel._reading = SimpleNamespace(text="")
    panel._charted = panel._laned = None
    return panel


def test_lanes_that_come_after_their_chart_are_drawn(panel: Any) -> None:
    from hil.view.scope import Look

    at = SYSCLK_HZ
    panel._look = Look(0, at, {}, None, ("TaskUS",))
    panel._draw()
    assert panel._chart.options["xAxis"]["max"] == 1.0
    assert panel._lanes.content == ""
    panel._look = Look(0, at, {}, [Span("TaskUS", 0, at // 2, State.RUNNING)], ("TaskUS",))
    panel._draw()
    assert 'class="running"' in panel._lanes.content
    # A span without a single event is drawn too: nothing of an earlier one stays.
    panel._look = Look(at, 2 * at, {}, [], ("TaskUS",))
    panel._draw()
    assert 'class="running"' not in panel._lanes.content
