"""A window on a picture of layers: zoom, shift, follow, in the browser; hands on what is drawn, told to the page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

from nicegui import events, ui
from nicegui.element import Element

from hil.robot.view.arena_drawing import HEIGHT, NUMBERS_PX, TOOLS_PX, WIDTH, Point, VisibleArea


@dataclass(frozen=True, slots=True)
class PointerGestures:
    """Done with the mouse or a finger: `take`, `drag`, `drop`, `leave` of what has a grip, `tap` of anything else."""

    what: str
    x: float
    y: float
    shift: bool


class Window(Element, component="layers.js"):
    """Layers that fill it, each an SVG by itself: a robot that moves leaves the cloud unpainted.

    `on_hand(hand)`; `on_seen(seen)` after each zoom and shift; `on_shifted()` when somebody begins to shift it.
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

    def layer(self) -> ui.html:
        """One more, above all others."""
        with self:
            return ui.html(tag="svg", sanitize=False).classes("layer").props("aria-hidden=true")

    def show(self, extent: tuple[float, float, float, float]) -> None:
        """There is more to be seen; it is in sight unless somebody has zoomed or shifted."""
        self._props["extent"] = extent
        self.update()

    def fit(self) -> None:
        """Everything in sight."""
        self.run_method("fit")

    def zoom(self, factor: float) -> None:
        """About the middle."""
        self.run_method("zoom", factor)

    def centre(self, at: Point) -> None:
        """Have a point of the picture in the middle."""
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
