"""The parts of the page that only the emulated robot has: arena, console, two buttons, keys, a status."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from hil.robot.view.arena import ArenaPanel
from hil.robot.view.console_panel import ConsolePanel
from hil.robot.view.orders import KEYS, mission_and_stop
from hil.robot.view.scene import Scene
from hil.view.engine import Engine
from hil.view.page import hidden_heading
from hil.view.snapshot import Snapshot


class Panels:
    """A robot's page: `hil.view.stage.PanelsProtocol`."""

    keys = KEYS

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._arena: ArenaPanel
        self._console: ConsolePanel
        self.tabs: Mapping[str, Callable[[], None]] = {"Console": self._build_console}

    @property
    def actions(self) -> Mapping[str, Callable[[], Any]]:
        """Key -> action."""
        return self._console.actions

    def top(self) -> None:
        """Add the two big buttons."""
        mission_and_stop(lambda: self._console)

    def picture(self) -> None:
        """Add the arena."""
        hidden_heading("Arena")
        self._arena = ArenaPanel(self._engine)

    def _build_console(self) -> None:
        self._console = ConsolePanel(self._engine.line, self._arena.show_loaded)

    def status(self, now: Snapshot) -> Sequence[tuple[str, str]]:
        """The state, the pose and the distances."""
        scene: Scene = now.scene
        status = scene.status
        front, right, left = status.distances_cm
        return (
            ("robot", status.state),
            ("x, y", f"{status.x_m:.2f}  {status.y_m:.2f} m"),
            ("heading", f"{status.heading_rad:+.2f} rad"),
            ("left", f"{left:.0f} cm"), ("front", f"{front:.0f} cm"), ("right", f"{right:.0f} cm"),
        )  # fmt: skip

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""
        self._arena.update(now)
        self._console.update()

    def key(self, name: str, down: bool) -> bool:
        """Handle a key.  During driving by hand, the arrow keys drive."""
        return self._console.key(name, down)

    def leave(self) -> None:
        """End driving by hand."""
        self._console.leave_tele()
