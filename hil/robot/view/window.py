"""A window on a picture of layers.  The browser zooms, shifts and follows; the page gets the user's gestures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

from nicegui import events
from nicegui.element import Element

from hil.robot.view.arena_drawing import HEIGHT, NUMBERS_PX, TOOLS_PX, WIDTH, Point, VisibleArea
from hil.view.live import LiveHtml


@dataclass(frozen=True, slots=True)
class PointerGestures:
    """A gesture with the mouse or a finger: `take`, `drag`, `drop`, `leave` of an element with a grip, else `tap`."""

    what: str
    x: float
    y: float
    shift: bool


class Window(Element, component="layers.js"):
    """Layers that fill the window.  Each is an SVG of its own, so a moving robot does not repaint the cloud.

    It calls `on_hand(hand)` for each gesture, `on_seen(seen)` after each zoom and shift, and `on_shifted()` when the
    user begins to shift it.
    """

    def __init__(
        self,
        extent: tuple[float, float, float, float] = (0, 0, WIDTH, HEIGHT),
        on_hand: Callable[[PointerGestures], None] | None = None,
        on_seen: Callable[[VisibleArea], None] | None = None,
        on_shifted: Callable[[], None] | None = None,
    ) -> None:
        super().__init__()
        self.seen = VisibleArea(*extent)
        self._props["extent"] = extent
        self._props["above"] = TOOLS_PX
        self._props["left"], self._props["below"] = NUMBERS_PX
        self._on_hand = on_hand
        self._on_seen = on_seen
        self.classes("window")
        self.on("seen", self._looked)
        if on_hand is not None:
            self.on("hand", self._touched)
        if on_shifted is not None:
            self.on("shifted", lambda _: on_shifted())

    def layer(self) -> LiveHtml:
        """Add a layer above all others."""
        with self:
            return LiveHtml(tag="svg").classes("layer").props("aria-hidden=true")

    def show(self, extent: tuple[float, float, float, float]) -> None:
        """Set the extent of the picture.  All of it is visible, unless the user has zoomed or shifted."""
        self._props["extent"] = extent
        self.update()

    def fit(self) -> None:
        """Show the whole picture."""
        self.run_method("fit")

    def zoom(self, factor: float) -> None:
        """Zoom about the middle."""
        self.run_method("zoom", factor)

    def centre(self, at: Point) -> None:
        """Move a point of the picture to the middle."""
        self.run_method("centre", *at)

    def _looked(self, e: events.GenericEventArguments) -> None:
        values = [float(value) for value in (*e.args["box"], e.args["unit"])]
        if len(values) == 5 and all(map(isfinite, values)) and min(values[2:]) > 0.0:
            self.seen = VisibleArea(*values)
            if self._on_seen is not None:
                self._on_seen(self.seen)

    def _touched(self, e: events.GenericEventArguments) -> None:
        hand = PointerGestures(str(e.args["what"]), float(e.args["x"]), float(e.args["y"]), bool(e.args["shift"]))
        if self._on_hand is not None and isfinite(hand.x) and isfinite(hand.y):
            self._on_hand(hand)
