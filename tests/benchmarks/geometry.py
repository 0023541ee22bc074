"""Own plane geometry against shapely on the questions that the world asks.  Run by hand:

python -m tests.benchmarks.geometry

Wants `pip install -e '.[test]'` (shapely).  Prints microseconds per question and how far the answers differ.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin, tau
from random import Random
from time import perf_counter

import shapely
from shapely.geometry import LineString, MultiLineString, Point
from shapely.strtree import STRtree

from hil.world import SonarRays, load_map
from hil.world.geometry import Segment, cast, clearance


def _time(question: Callable[[tuple[float, float, float]], float], places: list[tuple[float, float, float]]) -> float:
    best = float("inf")
    for _ in range(5):
        start = perf_counter()
        for place in places:
            question(place)
        best = min(best, perf_counter() - start)
    return best / len(places) * 1e6


def _compare(name: str, walls: tuple[Segment, ...], places: list[tuple[float, float, float]]) -> None:
    lines = [LineString([(w.ax, w.ay), (w.bx, w.by)]) for w in walls]
    union = MultiLineString(lines)
    shapely.prepare(union)
    tree = STRtree(lines)

    def own_clearance(place: tuple[float, float, float]) -> float:
        return clearance(place[0], place[1], walls, ())

    def shapely_clearance(place: tuple[float, float, float]) -> float:
        return float(union.distance(Point(place[0], place[1])))

    def own_ray(place: tuple[float, float, float]) -> float:
        return cast(place[0], place[1], cos(place[2]), sin(place[2]), walls)[0]

    def shapely_ray(place: tuple[float, float, float]) -> float:
        x, y, course = place
        here = Point(x, y)
        ray = LineString([(x, y), (x + 100.0 * cos(course), y + 100.0 * sin(course))])
        hit = union.intersection(ray)
        return float("inf") if hit.is_empty else float(here.distance(hit))

    def tree_ray(place: tuple[float, float, float]) -> float:
        x, y, course = place
        here = Point(x, y)
        ray = LineString([(x, y), (x + 100.0 * cos(course), y + 100.0 * sin(course))])
        best = float("inf")
        for index in tree.query(ray):
            hit = lines[index].intersection(ray)
            if not hit.is_empty:
                best = min(best, here.distance(hit))
        return best

    for question, own, others in (
        ("clearance", own_clearance, {"shapely": shapely_clearance}),
        ("ray", own_ray, {"shapely": shapely_ray, "shapely STRtree": tree_ray}),
    ):
        mine = _time(own, places)
        print(f"{name:12} {len(walls):4} walls  {question:10} own {mine:8.2f} us", end="")
        for label, other in others.items():
            theirs = _time(other, places)
            worst = max(abs(a - b) for a, b in ((own(p), other(p)) for p in places) if a != b or a < 1e9)
            print(f"   {label} {theirs:8.2f} us ({theirs / mine:5.1f} times, differs by {worst:.1e} m)", end="")
        print()


def main() -> None:
    """Print the comparison for the built-in room and corridor, and for a large made-up hall."""
    random = Random(1)
    for name in ("corridor", "room"):
        world_map = load_map(name)
        x, y, _ = world_map.start
        places = [
            (x + random.uniform(0, 1.5), y + random.uniform(-0.2, 0.2), random.uniform(0, tau)) for _ in range(200)
        ]
        _compare(name, world_map.walls, places)
        rays = SonarRays(world_map.walls, list(world_map.posts))
        echo = _time(lambda place, rays=rays: float(len(rays.reflectors("FRONT", place))), places)  # type: ignore[misc]
        print(f"{name:12} sonar echo, own {echo:.1f} us")
    hall = []
    for _ in range(200):
        x, y, course = random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0, tau)
        hall.append(Segment(x, y, x + cos(course), y + sin(course)))
    places = [(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0, tau)) for _ in range(200)]
    _compare("hall", tuple(hall), places)


if __name__ == "__main__":
    main()
