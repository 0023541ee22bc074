"""The arena: the world, the robot and its odometry, the sonars.  The user can move the robot and obstacles.

The picture has layers, and a layer is sent only when it changes: grid and walls once, the robot 20 times a second,
paths four times a second.  Of a long path, only the end is sent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import atan2, hypot, pi
from typing import Final

from nicegui import ui

from hil.client.decode import OdometryFrame
from hil.client.plot import place, sonar_points
from hil.robot.view import arena_drawing as draw
from hil.robot.view.arena_drawing import Obstacle, Point, Viewport
from hil.robot.view.scene import Scene, Trails
from hil.robot.view.window import PointerGestures, Window
from hil.view.engine import Engine
from hil.view.line import LineLog
from hil.view.snapshot import Snapshot
from hil.world.robot_params import Pose

#: The most points of a path that are sent again when it grows.
OPEN_POINTS: Final = 200
#: CHOICE: the most points of a cloud that are still readable as a picture.
MAX_POINTS: Final = 6000
#: Page updates (20 a second) between two updates of paths and clouds.
PATH_UPDATES: Final = 5
TURN_RAD: Final = pi / 12.0
TOOLS_HELP: Final = "drag the robot or an obstacle; add or remove an obstacle"


class GrowingPath:
    """A growing path in two layers.  The layer of the finished part is sent only when that part grows."""

    def __init__(self, window: Window, shape: Callable[[Viewport, Sequence[Point]], str]) -> None:
        self._shape = shape
        self._finished = window.layer()
        self._growing = window.layer()
        self._finished_count = 0
        self._finished_end: Point | None = None
        self._shown: tuple[int, Point | None] = (0, None)

    def show(self, view: Viewport, points: Sequence[Point]) -> None:
        """Draw the new points."""
        now = (len(points), points[-1] if points else None)
        if now == self._shown:
            return
        self._shown = now
        if self._finished_count and (
            len(points) < self._finished_count or points[self._finished_count - 1] != self._finished_end
        ):
            self._finished_count = 0
            self._finished.content = ""
        tail = points[max(0, self._finished_count - 1) :]
        if len(tail) > OPEN_POINTS:
            self._finished_count, self._finished_end = len(points), points[-1]
            self._finished.content = self._shape(view, points)
            tail = points[-1:]
        self._growing.content = self._shape(view, tail)


class PointCloud:
    """The points that the frames show, in the robot's own frame.  Headings are whole radians, as in the console."""

    def __init__(self, log: LineLog) -> None:
        self._log = log
        self._epoch = log.epoch
        self._next = log.frame_count - MAX_POINTS // 3  # of a long run, only the points that are drawn
        self.points: list[Point] = []
        self.way: list[Point] = []

    def update(self) -> None:
        """Take in new frames."""
        if self._log.epoch != self._epoch:
            self._epoch = self._log.epoch
            self._next = 0
            self.points, self.way = [], []
        frames, self._next = self._log.frames_from(self._next)
        for frame in frames:
            self.points += sonar_points(frame)
            at = (frame.x_mm / 1e3, frame.y_mm / 1e3)
            if not self.way or self.way[-1] != at:
                self.way.append(at)
        # Drop many points at once, because the others must then be drawn again.
        for points in (self.points, self.way):
            if len(points) > MAX_POINTS:
                del points[: -MAX_POINTS // 2]


def believed_path(frames: Sequence[OdometryFrame]) -> list[Point]:
    """The positions of the robot in the frames."""
    return [(frame.x_mm / 1e3, frame.y_mm / 1e3) for frame in frames]


def loaded(view: Viewport, frames: Sequence[OdometryFrame], pose: Pose) -> str:
    """Draw a trajectory from a file, which begins at `pose`.  Of a long one, frames are left out evenly."""
    some = frames[:: 1 + 3 * len(frames) // MAX_POINTS]
    points = [point for frame in some for point in sonar_points(frame)]
    return draw.dots(view, place(points, *pose), "cloud-loaded") + draw.path(
        view, place(believed_path(some), *pose), "trail-loaded"
    )


class ArenaPanel:
    """The panel of an emulated robot."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._changes = -1
        self._turn = 0
        self._grip: Obstacle | None = None
        self._moving = ""
        self._added = 0
        self._target = (0.0, 0.0)
        self._tool = "drag"
        self._following = False
        corners = [point for wall in self._scene.walls for point in wall]
        self._view = view = Viewport.around(corners)
        self._cloud = PointCloud(engine.line.log)
        self._newest: list[Point] = []
        with ui.element("div").classes("arena w-full hand-drag").mark("arena") as self._box:
            self._window = window = Window(
                view.extent(corners), self._on_gesture, self._draw_grid, self._follow_no_more
            )
            self._grid = window.layer()
            window.layer().content = draw.walls(view, self._scene.walls)
            self._beams = window.layer()
            self._dots = GrowingPath(window, lambda view, points: draw.dots(view, points, "cloud"))
            self._old_dots = window.layer()
            self._true = GrowingPath(window, lambda view, points: draw.path(view, points, "trail-true"))
            self._believed = GrowingPath(window, lambda view, points: draw.path(view, points, "trail-odo"))
            self._posts = window.layer()
            self._robot = window.layer()
            self._held_layer = window.layer()
            self._add_tools()
            with ui.row().classes("tools no-wrap gap-1"):
                tool("+", "nearer", lambda: window.zoom(1.4))
                tool("\N{MINUS SIGN}", "farther", lambda: window.zoom(1 / 1.4))
                tool("fit", "everything in sight", self._fit)
                self._follow = tool("follow", "keep the robot in the middle", self._follow_or_not).mark("follow")
        self._draw_grid(window.seen)
        legend()

    def _add_tools(self) -> None:
        """Add the buttons that move the robot and change obstacles."""
        with ui.row().classes("tools hands no-wrap items-center gap-1"):
            self._choice = ui.toggle(
                ["drag", "add", "remove"], value="drag", on_change=lambda e: self._choose(str(e.value))
            ).props(f'dense no-caps size=sm aria-label="{TOOLS_HELP}"').mark("tool")  # fmt: skip
            with self._choice:
                ui.tooltip(TOOLS_HELP)
            tool("\N{ANTICLOCKWISE OPEN CIRCLE ARROW}", "turn the robot left by 15°", lambda: self._rotate(TURN_RAD))
            tool("\N{CLOCKWISE OPEN CIRCLE ARROW}", "turn the robot right by 15°", lambda: self._rotate(-TURN_RAD))
            self._diameter = (
                ui.number("diameter, m", value=0.2, min=0.02, max=1.0, step=0.05).props("dense").classes("w-20")
            )
            self._diameter.visible = False

    def _choose(self, tool: str) -> None:
        self._box.classes(remove=f"hand-{self._tool}", add=f"hand-{tool}")
        self._tool = tool
        self._diameter.visible = tool == "add"

    def show_loaded(self, frames: list[OdometryFrame]) -> None:
        """Show a trajectory from a file, below the present one."""
        self._old_dots.content = loaded(self._view, frames, self._trails.start)

    @property
    def _scene(self) -> Scene:
        """The latest scene."""
        scene: Scene = self._engine.snapshot.scene
        return scene

    @property
    def _trails(self) -> Trails:
        trails: Trails = self._engine.trails
        return trails

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""
        view = self._view
        scene: Scene = now.scene
        if now.changes != self._changes:
            self._changes = now.changes
            self._posts.content = draw.obstacles(view, scene.obstacles)
        seen = self._window.seen
        self._beams.content = draw.beams(view, scene.beams, seen.unit)
        pose = Pose(scene.status.x_m, scene.status.y_m, scene.status.heading_rad)
        shown = draw.robot(view, pose, "robot", bumper=scene.bumper, unit=seen.unit)
        if scene.believed is not None:
            shown = draw.robot(view, scene.believed, "ghost", unit=seen.unit) + shown
            shown += draw.out_of_sight(view, scene.believed, seen, "odometry")
        shown += draw.out_of_sight(view, pose, seen, "robot")
        if shown != self._robot.content:
            self._robot.content = shown
            if self._following:
                self._window.centre(view.to_picture(pose.x_m, pose.y_m))
        self._turn = (self._turn + 1) % PATH_UPDATES
        if self._turn == 0:
            self._update_paths()

    def _update_paths(self) -> None:
        trails = self._trails
        self._true.show(self._view, trails.true)
        self._believed.show(self._view, trails.believed)
        self._cloud.update()
        start = trails.start
        points = self._cloud.points
        if points[-1:] != self._newest:
            self._newest = points[-1:]
            self._dots.show(self._view, place(points, start.x_m, start.y_m, start.heading_rad))

    # The window

    def _draw_grid(self, seen: draw.VisibleArea) -> None:
        self._grid.content = draw.grid(self._view, seen)

    def _fit(self) -> None:
        self._follow_no_more()
        self._window.fit()

    def _follow_or_not(self) -> None:
        self._following = not self._following
        self._follow.props("outline=false" if self._following else "outline")
        if self._following:
            status = self._scene.status
            self._window.centre(self._view.to_picture(status.x_m, status.y_m))

    def _follow_no_more(self) -> None:
        if self._following:
            self._follow_or_not()

    # Hands

    def _on_gesture(self, hand: PointerGestures) -> None:
        x, y = self._view.to_world(hand.x, hand.y)
        if hand.what == "take":
            self._press(x, y)
        elif hand.what == "tap":
            if self._tool == "add":
                self._add(x, y)
        elif not self._moving:
            return
        elif hand.what == "leave":
            self._let_go()
        else:
            self._drag(x, y, turning=hand.shift)
            if hand.what == "drop":
                self._drop()

    def _press(self, x: float, y: float) -> None:
        now = self._scene
        near = min(now.obstacles, key=lambda o: hypot(o.x_m - x, o.y_m - y) - o.radius_m, default=None)
        if near is not None and hypot(near.x_m - x, near.y_m - y) > near.radius_m + draw.GRIP_M:
            near = None
        if self._tool == "add":
            self._add(x, y)
        elif self._tool == "remove":
            if near is not None:
                self._act("remove", near.name)
        elif near is not None:
            self._grip, self._moving = near, "obstacle"
        else:
            self._moving = "robot"
            self._heading = now.status.heading_rad

    def _drag(self, x: float, y: float, *, turning: bool) -> None:
        self._target = (x, y)
        if self._moving == "obstacle" and self._grip is not None:
            self._held_layer.content = draw.obstacles(self._view, [Obstacle("", x, y, self._grip.radius_m)])
        else:
            status = self._scene.status
            if turning:  # with Shift, the robot turns towards the mouse
                self._heading = atan2(y - status.y_m, x - status.x_m)
                self._target = (status.x_m, status.y_m)
            held = Pose(*self._target, self._heading)
            self._held_layer.content = draw.robot(self._view, held, "held", unit=self._window.seen.unit)

    def _drop(self) -> None:
        x, y = self._target
        if self._moving == "robot":
            self._act("place", x, y, self._heading)
        elif self._grip is not None:
            self._act("move", self._grip.name, x, y)
        self._let_go()

    def _let_go(self) -> None:
        self._moving, self._grip = "", None
        self._held_layer.content = ""

    def _add(self, x: float, y: float) -> None:
        taken = {post.name for post in self._scene.obstacles}
        number = next(n for n in range(1, 10_000) if f"obstacle {n}" not in taken)
        self._act("add", f"obstacle {number}", x, y, float(self._diameter.value or 0.2))
        self._choice.value = "drag"

    def _rotate(self, by_rad: float) -> None:
        status = self._scene.status
        self._act("place", status.x_m, status.y_m, status.heading_rad + by_rad)

    def _act(self, what: str, *values: str | float) -> None:
        self._engine.act(what, *values)


class FrameMap:
    """The map of a robot of which only the serial line is known.  It is drawn from the frames."""

    def __init__(self, log: LineLog) -> None:
        self._cloud = PointCloud(log)
        self._log = log
        corners = [(-1.0, -1.0), (2.0, 1.0)]
        self._view = view = Viewport.around(corners)
        self._held = view.extent(corners)
        self._loaded: list[OdometryFrame] = []
        self._turn = 0
        with ui.element("div").classes("arena w-full").mark("map"):
            self._window = window = Window(self._held, on_seen=self._draw_grid)
            self._grid = window.layer()
            self._dots = GrowingPath(window, lambda view, points: draw.dots(view, points, "cloud"))
            self._way = GrowingPath(window, lambda view, points: draw.path(view, points, "trail-odo"))
            self._old = window.layer()
            self._robot = window.layer()
            with ui.row().classes("tools no-wrap gap-1"):
                tool("+", "nearer", lambda: window.zoom(1.4))
                tool("\N{MINUS SIGN}", "farther", lambda: window.zoom(1 / 1.4))
                tool("fit", "everything in sight", window.fit)
        self._draw_grid(window.seen)

    def show_loaded(self, frames: list[OdometryFrame]) -> None:
        """Show a trajectory from a file."""
        self._loaded = frames
        self._fit([*believed_path(frames), *(point for frame in frames for point in sonar_points(frame))])
        self._draw_loaded()

    def update(self) -> None:
        """Update the panel, up to 20 times a second."""
        self._turn = (self._turn + 1) % PATH_UPDATES
        if self._turn:
            return
        self._cloud.update()
        self._fit([*self._cloud.points[-3:], *self._cloud.way[-1:]])
        self._dots.show(self._view, self._cloud.points)
        self._way.show(self._view, self._cloud.way)
        last = self._log.last_frame()
        if last is not None:
            pose = Pose(last.x_mm / 1e3, last.y_mm / 1e3, float(last.theta_rad))
            seen = self._window.seen
            shown = draw.robot(self._view, pose, "ghost", unit=seen.unit)
            self._robot.content = shown + draw.out_of_sight(self._view, pose, seen, "robot")

    def _draw_grid(self, seen: draw.VisibleArea) -> None:
        self._grid.content = draw.grid(self._view, seen)

    def _fit(self, points: Sequence[Point]) -> None:
        """Extend the map so that it contains all points."""
        left, top, width, height = self._held
        inner = [self._view.to_picture(*point) for point in points]
        if all(left <= x <= left + width and top <= y <= top + height for x, y in inner):
            return
        corners = [self._view.to_world(left, top), self._view.to_world(left + width, top + height)]
        self._held = self._view.extent([*corners, *points])
        self._window.show(self._held)

    def _draw_loaded(self) -> None:
        self._old.content = loaded(self._view, self._loaded, Pose(0.0, 0.0, 0.0))


def tool(text: str, meaning: str, do: Callable[[], None]) -> ui.button:
    """Add a small button on the picture."""
    button = ui.button(text, on_click=do).props(f'no-caps dense outline size=sm aria-label="{meaning}"')
    with button:
        ui.tooltip(meaning)
    return button


def legend() -> None:
    """Add the legend of the colours."""
    with ui.row().classes("gap-x-4 gap-y-0 soft legend"):
        for colour, text in draw.LEGEND:
            ui.html(f'<span class="key" style="border-color:var({colour})"></span>{text}', sanitize=False)
