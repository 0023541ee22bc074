"""Maps: walls, posts, floor and start pose, from TOML files (format: README.md of this package).

Keys, and the ranges of their numbers, are those of `map-1.schema.json`, which editors read too.  Every fault of a map
is one `MapError` line: file, key, what is wrong, what would be right.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from math import hypot, isfinite, radians
from pathlib import Path
from typing import Any, Final

from hil.files import parse_toml, read_text
from hil.world.geometry import TOUCH_M, Post, Segment, clearance, within
from hil.world.movers import Mover

#: Posts of one fence.
MAX_OF_FENCE: Final = 1000
#: A start pose needs this much room around the middle between the wheels (robot.RobotParams reaches 0.12 m).
START_CLEARANCE_M: Final = 0.125

_FOLDER: Final = Path(__file__).parent / "maps"
#: Key -> its schema, of a whole map.
_KEYS: Final[Mapping[str, Any]] = json.loads(
    (Path(__file__).parent / "map-1.schema.json").read_text(encoding="utf-8")
)["properties"]
#: Table -> key -> its schema; "": the map.
_TABLES: Final[Mapping[str, Mapping[str, Any]]] = {
    "": _KEYS, **{name: _KEYS[name]["properties"] for name in ("start", "floor")},
    **{name: _KEYS[name]["items"]["properties"] for name in ("wall", "post", "fence")},
}  # fmt: skip
#: What walls can be made of.  Smooth: painted board, a mirror at 42 kHz.
_MATERIALS: Final[tuple[str, ...]] = tuple(_TABLES["wall"]["material"]["enum"])


class MapError(ValueError):
    """A map that cannot be used: `FILE: KEY: what is wrong; what would be right`."""


@dataclass(frozen=True, slots=True)
class WorldMap:
    """A plane world.  Lengths in metres, the start heading in radians counter-clockwise from +x."""

    name: str
    walls: tuple[Segment, ...]
    posts: tuple[Post, ...] = ()
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: Friction between tyre and floor as a factor of the tyre's own coefficient on a dry, clean floor.
    grip: float = 1.0
    #: Share of its way that each wheel loses on this floor, left and right, besides its own.
    slip: tuple[float, float] = (0.0, 0.0)
    #: Posts that move: which one, and along which path.
    movers: tuple[Mover, ...] = ()
    description: str = field(default="", compare=False)

    def room(self, x_m: float, y_m: float) -> float:
        """Distance from a point to the nearest wall or post in metres."""
        return clearance(x_m, y_m, self.walls, self.posts)

    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y of walls and posts."""
        xs = [x for wall in self.walls for x in (wall.ax, wall.bx)]
        ys = [y for wall in self.walls for y in (wall.ay, wall.by)]
        for post in self.posts:
            xs += [post.x_m - post.radius_m, post.x_m + post.radius_m]
            ys += [post.y_m - post.radius_m, post.y_m + post.radius_m]
        return min(xs), min(ys), max(xs), max(ys)


def builtin_maps() -> list[str]:
    """Names of the maps that come with the package."""
    return sorted(path.stem for path in _FOLDER.glob("*.toml"))


def load_map(name_or_path: str | Path) -> WorldMap:
    """A built-in map by name, or any file ending in `.toml` (or containing a path separator).

    Raises MapError, in one line, for anything that is not a usable map.
    """
    text = str(name_or_path)
    if text in builtin_maps():
        path = _FOLDER / f"{text}.toml"
    elif isinstance(name_or_path, Path) or text.endswith(".toml") or "/" in text or "\\" in text:
        path = Path(name_or_path)
    else:
        raise MapError(f"{text}: no built-in map of this name; use one of {', '.join(builtin_maps())} or a .toml file")
    try:
        content = read_text(path)
    except OSError as error:
        raise MapError(f"{path}: cannot be read ({error.strerror or error}); give an existing TOML file") from None
    except ValueError as error:
        raise MapError(str(error)) from None
    return parse_map(content, str(path))


def parse_map(content: str, file: str = "<text>") -> WorldMap:
    """A map from TOML text; `file` names it in errors."""
    try:
        table = parse_toml(content, file)
    except ValueError as error:
        raise MapError(f"{error}; see the map format in hil/world/README.md") from None
    return _MapReader(file).read(table)


class _MapReader:
    """Checks a parsed TOML table key by key."""

    def __init__(self, file: str) -> None:
        self.file = file

    def fail(self, key: str, wrong: str, right: str) -> MapError:
        return MapError(f"{self.file}: {key}: {wrong}; {right}")

    def read(self, table: Mapping[str, object]) -> WorldMap:
        self.known(table, "")
        name = self.text(table, "name", "name")
        description = self.text(table, "description", "description") if "description" in table else ""
        entries = self.tables(table, "wall")
        lines = [self.wall(entry, index) for index, entry in enumerate(entries)]
        walls = [wall for line in lines for wall in line]
        entries_of_posts = self.tables(table, "post")
        posts = [self.post(entry, index) for index, entry in enumerate(entries_of_posts)]
        for index, entry in enumerate(entries_of_posts):
            if "path_m" in entry and sum(post.name == posts[index].name for post in posts) > 1:
                raise self.fail(f"post[{index}].name", "a post that moves, of a name in use", "give it one of its own")
        movers = [
            self.mover(entry, index, posts[index]) for index, entry in enumerate(entries_of_posts) if "path_m" in entry
        ]
        for index, entry in enumerate(self.tables(table, "fence")):
            posts += self.fence(entry, index)
        if not walls and not posts:
            raise self.fail("wall", "the world is empty", "give at least one [[wall]], [[post]] or [[fence]]")
        start = self.start(table)
        room = clearance(start[0], start[1], walls, posts)
        if room < START_CLEARANCE_M:
            raise self.fail(
                "start",
                f"the robot would stand in a wall or post ({room:.3f} m away)",
                f"keep {START_CLEARANCE_M} m free around (x_m, y_m)",
            )
        world = WorldMap(
            name, tuple(walls), tuple(posts), start, self.grip(table), self.slip(table), tuple(movers), description
        )
        self.inside(world, [line for entry, line in zip(entries, lines, strict=True) if entry.get("closed")])
        return world

    def inside(self, world: WorldMap, closed: list[list[Segment]]) -> None:
        """Check that the robot starts inside, if one closed wall encloses all the rest."""
        x, y, _ = world.start
        for outline in closed:
            xs, ys = [wall.ax for wall in outline], [wall.ay for wall in outline]
            box = (min(xs), min(ys), max(xs), max(ys))
            if box == world.bounds() and not within(x, y, outline):
                raise self.fail(
                    "start",
                    f"({x:g}, {y:g}) lies outside the closed wall around the world",
                    f"give x_m from {box[0]:g} to {box[2]:g} and y_m from {box[1]:g} to {box[3]:g}, within the wall",
                )

    def start(self, table: Mapping[str, object]) -> tuple[float, float, float]:
        if "start" not in table:
            raise self.fail("start", "missing", "give [start] with x_m, y_m and heading_deg")
        start = self.table(table["start"], "start")
        self.known(start, "start")
        heading_deg = self.number(start, "heading_deg", "start") if "heading_deg" in start else 0.0
        return self.number(start, "x_m", "start"), self.number(start, "y_m", "start"), radians(heading_deg)

    def grip(self, table: Mapping[str, object]) -> float:
        if "floor" not in table:
            return 1.0
        floor = self.table(table["floor"], "floor")
        self.known(floor, "floor")
        return self.number(floor, "grip", "floor") if "grip" in floor or len(floor) == 0 else 1.0

    def slip(self, table: Mapping[str, object]) -> tuple[float, float]:
        floor = self.table(table.get("floor", {}), "floor")
        left, right = (
            self.number(floor, key, "floor") if key in floor else 0.0
            for key in ("slip_left", "slip_right")
        )
        return left, right

    def wall(self, entry: Mapping[str, object], index: int) -> list[Segment]:
        where = f"wall[{index}]"
        self.known(entry, where)
        points = self.points(entry, f"{where}.points_m")
        closed = entry.get("closed", False)
        if not isinstance(closed, bool):
            raise self.fail(f"{where}.closed", f"{closed!r} is not a truth value", "use true or false")
        material = self.text(entry, "material", f"{where}.material") if "material" in entry else "smooth"
        if material not in _MATERIALS:
            raise self.fail(f"{where}.material", f"{material!r} is unknown", f"use one of {', '.join(_MATERIALS)}")
        if closed:
            if len(points) < 3:
                raise self.fail(f"{where}.points_m", "a closed wall of two points", "give at least three points")
            points = [*points, points[0]]
        segments = []
        for place, (a, b) in enumerate(pairwise(points)):
            if hypot(b[0] - a[0], b[1] - a[1]) <= TOUCH_M:
                after = (place + 1) % (len(points) - 1) if closed else place + 1
                raise self.fail(f"{where}.points_m[{after}]", "the same point twice in a row", "remove one of them")
            segments.append(Segment(a[0], a[1], b[0], b[1], material))
        return segments

    def points(self, entry: Mapping[str, object], key: str, name: str = "points_m") -> list[tuple[float, float]]:
        right = "give a list of at least two [x, y] in metres"
        value = entry.get(name)
        if value is None:
            raise self.fail(key, "missing", right)
        if not isinstance(value, list) or len(value) < 2:
            raise self.fail(key, f"{_short(value)} is not a polyline", right)
        points = []
        for place, pair in enumerate(value):
            if not isinstance(pair, list) or len(pair) != 2:
                raise self.fail(f"{key}[{place}]", f"{_short(pair)} is not a point", "give [x, y] in metres")
            of = _TABLES["wall"]["points_m"]["items"]["items"]
            x, y = (self.finite(item, f"{key}[{place}][{axis}]", of) for axis, item in enumerate(pair))
            points.append((x, y))
        return points

    def post(self, entry: Mapping[str, object], index: int) -> Post:
        where = f"post[{index}]"
        self.known(entry, where)
        for key in ("speed_m_s", "from_s", "and_back"):
            if key in entry and "path_m" not in entry:
                raise self.fail(f"{where}.{key}", "the post does not move", "give path_m too, or leave it out")
        name = self.text(entry, "name", f"{where}.name") if "name" in entry else where
        return Post(
            self.number(entry, "x_m", where), self.number(entry, "y_m", where),
            self.number(entry, "diameter_m", where) / 2.0, name,
        )

    def fence(self, entry: Mapping[str, object], index: int) -> list[Post]:
        """Posts along a closed polyline, evenly spread on each side, one at each corner."""
        where = f"fence[{index}]"
        self.known(entry, where)
        points = self.points(entry, f"{where}.points_m")
        every_m = self.number(entry, "every_m", where)
        radius_m = self.number(entry, "diameter_m", where) / 2.0
        posts: list[Post] = []
        for a, b in pairwise([*points, points[0]]):
            count = max(1, round(hypot(b[0] - a[0], b[1] - a[1]) / every_m))
            if len(posts) + count > MAX_OF_FENCE:
                raise self.fail(f"{where}.every_m", f"more than {MAX_OF_FENCE} posts", "set them further apart")
            for step in range(count):
                part = step / count
                x_m, y_m = a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])
                posts.append(Post(x_m, y_m, radius_m, f"{where}[{len(posts)}]"))
        return posts

    def mover(self, entry: Mapping[str, object], index: int, post: Post) -> Mover:
        where = f"post[{index}]"
        points = self.points(entry, f"{where}.path_m", "path_m")
        if hypot(points[0][0] - post.x_m, points[0][1] - post.y_m) > TOUCH_M:
            raise self.fail(f"{where}.path_m[0]", "the path begins elsewhere than the post", "begin at (x_m, y_m)")
        if any(hypot(b[0] - a[0], b[1] - a[1]) <= TOUCH_M for a, b in pairwise(points)):
            raise self.fail(f"{where}.path_m", "the same point twice in a row", "remove one of them")
        and_back = entry.get("and_back", False)
        if not isinstance(and_back, bool):
            raise self.fail(f"{where}.and_back", f"{_short(and_back)} is not a truth value", "use true or false")
        from_s = self.number(entry, "from_s", where) if "from_s" in entry else 0.0
        return Mover(index, tuple(points), self.number(entry, "speed_m_s", where), from_s, and_back)

    def known(self, table: Mapping[str, object], where: str) -> None:
        keys = _TABLES[where.partition("[")[0]]
        for key in table:
            if key not in keys:
                path = f"{where}.{key}" if where else key
                raise self.fail(path, "unknown key", f"use {', '.join(keys)}")

    def tables(self, table: Mapping[str, object], key: str) -> list[Mapping[str, object]]:
        value = table.get(key, [])
        if not isinstance(value, list):
            raise self.fail(key, f"{_short(value)} is not a list of tables", f"write [[{key}]]")
        return [self.table(entry, f"{key}[{index}]") for index, entry in enumerate(value)]

    def table(self, value: object, key: str) -> Mapping[str, object]:
        if not isinstance(value, dict):
            bare = key.partition("[")[0]
            raise self.fail(key, f"{_short(value)} is not a table", f"write [{bare}] or [[{bare}]] and keys below it")
        return value

    def text(self, table: Mapping[str, object], key: str, path: str) -> str:
        value = table.get(key)
        if value is None:
            raise self.fail(path, "missing", f'give {key} = "..."')
        if not isinstance(value, str) or not value.strip():
            raise self.fail(path, f"{_short(value)} is not a text", f'give {key} = "..."')
        return value

    def number(self, table: Mapping[str, object], key: str, where: str) -> float:
        of, path = _TABLES[where.partition("[")[0]][key], f"{where}.{key}"
        if key not in table:
            raise self.fail(path, "missing", _right(of))
        return self.finite(table[key], path, of)

    def finite(self, value: object, path: str, of: Mapping[str, Any]) -> float:
        right = _right(of)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.fail(path, f"{_short(value)} is not a number", right)
        if not (of["minimum"] <= value <= of["maximum"]) or not isfinite(value):
            raise self.fail(path, f"{_short(value)} is out of range", right)
        return float(value)


def _right(of: Mapping[str, Any]) -> str:
    """The range of a number by its schema, in words."""
    return f"give a number from {of['minimum']:g} to {of['maximum']:g}"


def _short(value: object) -> str:
    """A value in an error message: one line, never long."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) > 10**30:
        return "a huge integer"
    text = " ".join(repr(value).split())
    return text if len(text) <= 40 else text[:37] + "..."
