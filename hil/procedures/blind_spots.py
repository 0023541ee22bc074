"""Angles and distances at which the sonars of the robot lose a straight wall (thesis 3.2.2; five sonars: 4.1.1).

The wall's perpendicular through the middle between the wheels points `angle_deg` to the left of straight ahead, and the
wall is `distance_m` away there; it reaches `HALF_LENGTH_M` to both sides.  What a ping hears of it is what the world
tells the emulated sonars (`hil.world.sonar_rays`; the beam is a `CHOICE` in `emulator.devices.lv_maxsonar_beam`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import cos, pi, radians, sin
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from hil.client.plot import save
from hil.robot.options.in_world import sonar_mounts
from hil.robot.options.names import FIVE_SONARS
from hil.world.geometry import Segment
from hil.world.sonar_rays import SonarMount, SonarRays

#: The angles that the thesis names (3.2.2).
THESIS_DEG: Final = (40, 50)
#: Of the wall, to both sides of the foot of the perpendicular.
HALF_LENGTH_M: Final = 0.5
#: Distances from the middle between the wheels: from touching the wall to where the mission no longer minds it.
DISTANCES_M: Final = tuple(round(0.15 + 0.05 * n, 2) for n in range(18))
ANGLES_DEG: Final = tuple(range(-110, 111, 2))
_AT_ORIGIN: Final = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class BlindSpots:
    """How surely one turn of the ring hears the wall: 0..1, a row a distance, a column an angle."""

    name: str
    mounts: Mapping[str, SonarMount]
    heard: npt.NDArray[np.float64]

    def lost(self) -> list[tuple[int, int]]:
        """First and last angle of each range at which no sonar hears the wall at any distance, within the map."""
        blind = [(angle, not column.any()) for angle, column in zip(ANGLES_DEG, self.heard.T, strict=True)]
        runs = [[angle for angle, _ in run] for is_blind, run in groupby(blind, key=lambda item: item[1]) if is_blind]
        return [(run[0], run[-1]) for run in runs]

    def uncertain(self) -> list[tuple[int, int]]:
        """The same of angles at which some turn of the ring misses the wall at some distance."""
        missed = [(angle, bool((column < 1.0).any())) for angle, column in zip(ANGLES_DEG, self.heard.T, strict=True)]
        runs = [[angle for angle, _ in run] for misses, run in groupby(missed, key=lambda item: item[1]) if misses]
        return [(run[0], run[-1]) for run in runs]

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "sonars": {n: {"x_m": m.x_m, "y_m": m.y_m, "bearing_rad": m.bearing_rad} for n, m in self.mounts.items()},
            "angles_deg": ANGLES_DEG, "distances_m": DISTANCES_M, "heard": self.heard.tolist(),
            "lost_deg": self.lost(), "uncertain_deg": self.uncertain(),
        }  # fmt: skip


def wall(angle_deg: float, distance_m: float) -> Segment:
    """The wall of one point of the map."""
    x, y = cos(radians(angle_deg)), sin(radians(angle_deg))
    foot_x, foot_y = distance_m * x, distance_m * y
    return Segment(
        foot_x + HALF_LENGTH_M * y, foot_y - HALF_LENGTH_M * x, foot_x - HALF_LENGTH_M * y, foot_y + HALF_LENGTH_M * x
    )


def heard(mounts: Mapping[str, SonarMount], angle_deg: float, distance_m: float) -> float:
    """How surely one ping of each sonar, together, hears the wall at all: 0..1."""
    rays = SonarRays([wall(angle_deg, distance_m)], None, mounts)
    missed = 1.0
    for name in mounts:
        echo = rays.echo(name, _AT_ORIGIN)
        missed *= 1.0 - (echo[1] if echo else 0.0)
    return round(1.0 - missed, 9)  # at the very edge of a beam nothing is heard, whatever the sine rounds to


def blind_spots(options: Sequence[str] = ()) -> BlindSpots:
    """The map of a robot with these options."""
    mounts = sonar_mounts(options)
    rows = [[heard(mounts, angle, distance) for angle in ANGLES_DEG] for distance in DISTANCES_M]
    return BlindSpots(f"{len(mounts)} sonars", mounts, np.array(rows))


def both() -> list[BlindSpots]:
    """The robot of the thesis, and with the two sonars that it proposes."""
    return [blind_spots(), blind_spots([FIVE_SONARS])]


def sentence(found: Sequence[BlindSpots]) -> str:
    """What it means for the robot."""
    def line_of(one: BlindSpots) -> str:
        ahead = [(a, b) for a, b in one.lost() if max(abs(a), abs(b)) <= 90]
        if not ahead:
            return f"{one.name} lose none"
        return f"{one.name} lose every wall at {' and '.join(f'{a} to {b}' for a, b in ahead)} degrees"

    return f"Of walls whose perpendicular lies within 90 degrees of straight ahead, {'; '.join(map(line_of, found))}."


def plot(path: str | Path, found: Sequence[BlindSpots]) -> None:
    """A polar map for each robot: angle of the wall, its distance, how surely it is heard.  PNG, SVG or PDF."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.2 * len(found), 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.subplots(1, len(found), subplot_kw={"projection": "polar"}, squeeze=False)[0]
    for axis, one in zip(axes, found, strict=True):
        mesh = axis.pcolormesh(
            np.radians(ANGLES_DEG), np.array(DISTANCES_M), one.heard, cmap="RdYlGn", vmin=0.0, vmax=1.0,
            shading="nearest",
        )  # fmt: skip
        axis.set_theta_zero_location("N")
        axis.set_thetamin(ANGLES_DEG[0])
        axis.set_thetamax(ANGLES_DEG[-1])
        axis.set_rlim(0.0, DISTANCES_M[-1])
        axis.set_rlabel_position(ANGLES_DEG[0])
        for mount in one.mounts.values():
            axis.plot((mount.bearing_rad, mount.bearing_rad), (0.0, DISTANCES_M[-1]), ":", color="black", linewidth=0.8)
        for side in (-1, 1):
            for angle in THESIS_DEG:
                axis.plot((side * angle * pi / 180,) * 2, (0.0, DISTANCES_M[-1]), color="tab:blue", linewidth=1.0)
        axis.set_title(one.name)
    figure.colorbar(mesh, ax=list(axes), label="heard by one turn of the ring", shrink=0.8)
    title = "perpendicular of the wall (degrees left of ahead), its distance (m); blue: 40 and 50 degrees"
    figure.suptitle(title, fontsize=9)
    save(figure, path, dpi=100)
