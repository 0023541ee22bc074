"""From distances and raw values to the slope and offset of `Calibrate_US`.

A tape measure gives the distance, the firmware the raw value: what `Read_Distance` computes before slope and offset.  A
straight line through the rows by least squares gives both, as in the thesis (2.4.1; tables in annex A.3.1).

A row is *suspect* if it lies further from the robust line (Theil-Sen, through the medians of the distances) than the
sonar's resolution, an inch (LV-MaxSonar data sheet), and than 3.5 robust deviations of the rows of one distance
(B. Iglewicz, D. Hoaglin, How to Detect and Handle Outliers, 1993).  The line is then computed again without these rows.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from itertools import combinations
from math import isfinite
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
import numpy.typing as npt

from emulator.clock import SYSCLK_HZ
from emulator.image import Firmware
from firmware_model.image import link
from hil.client.plot import save
from hil.files import read_text
from hil.robot.board import RobotBoard
from hil.world.geometry import Segment
from hil.world.sonar_rays import DEFAULT_MOUNTS, SonarRays

#: The constants that `main_Robot.c` hands to `Calibrate_US`: slope in cm, offset in cm (TFG annex 1).
FIRMWARE: Final = {"LEFT": (0.0551, 4.3516), "FRONT": (0.0564, 2.3776), "RIGHT": (0.0569, 1.5336)}
#: The distances of annex A.3.1, and how often each was measured.
DISTANCES_CM: Final = (20.0, 25.0, 40.0, 50.0, 60.0)
READINGS: Final = 10
#: Resolution of the sonar in cm: it reports whole inches.
RESOLUTION_CM: Final = 2.54
DEVIATIONS: Final = 3.5
#: Largest table that is read.
_MAX_BYTES: Final = 1_000_000
#: Longer than the sonars of the ring take to range one after the other: each reading is of a new ping.
_BETWEEN_READINGS_CYCLES: Final = SYSCLK_HZ // 5

FRONT: Final = "FRONT"

Numbers = npt.NDArray[np.float64]
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of a measurement: the distance of each, and the raw value of each sonar (NaN: not measured)."""

    distance_cm: Numbers
    raw: dict[str, Numbers]
    #: Line of the file that each row stands in.
    lines: tuple[int, ...]

    def text(self) -> str:
        """The table as CSV."""
        rows = [["distance_cm", *self.raw]]
        for i, distance in enumerate(self.distance_cm):
            rows.append([f"{distance:g}", *(f"{raw[i]:g}" if isfinite(raw[i]) else "" for raw in self.raw.values())])
        return "".join(",".join(row) + "\n" for row in rows)


@dataclass(frozen=True, slots=True)
class LinearFit:
    """`distance = slope * raw + offset`, both in cm, and how far the rows lie from it."""

    slope_cm: float
    offset_cm: float
    rms_cm: float


@dataclass(frozen=True, slots=True)
class OutlierRow:
    """A row that does not fit: the line of the file, what it says, and how far it is from the robust line."""

    line: int
    distance_cm: float
    raw: float
    off_cm: float


@dataclass(frozen=True, slots=True)
class Calibration:
    """What a table says of one sonar."""

    sonar: str
    distance_cm: Numbers
    raw: Numbers
    line: LinearFit
    suspects: tuple[OutlierRow, ...]
    #: The line without the suspects; None if there are none.
    without: LinearFit | None

    @property
    def best(self) -> LinearFit:
        """The line to use."""
        return self.without or self.line

    @property
    def residuals_cm(self) -> Numbers:
        """What the line says minus the tape measure, of each row."""
        return self.line.slope_cm * self.raw + self.line.offset_cm - self.distance_cm

    def sentence(self) -> str:
        """What it means for the robot."""
        middle = float(np.median(self.distance_cm))
        raw = (middle - self.best.offset_cm) / self.best.slope_cm
        read = self.line.slope_cm * raw + self.line.offset_cm
        if self.without is None:
            return f"{self.sonar}: no row is suspect; distances are right to {self.line.rms_cm:.1f} cm (rms)."
        rows = "one row is" if len(self.suspects) == 1 else f"{len(self.suspects)} rows are"
        return (
            f"{self.sonar}: {rows} suspect; with them the robot takes {middle:g} cm for {read:.1f} cm and is "
            f"{self.line.rms_cm:.1f} cm off (rms), without them {self.without.rms_cm:.1f} cm."
        )

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        def line(found: LinearFit | None) -> dict[str, float] | None:
            return None if found is None else {name: getattr(found, name) for name in LinearFit.__slots__}

        return {
            "sonar": self.sonar,
            "line": line(self.line),
            "without_suspects": line(self.without),
            "suspects": [{name: getattr(s, name) for name in OutlierRow.__slots__} for s in self.suspects],
            "residuals_cm": [round(float(r), 4) for r in self.residuals_cm],
            "sentence": self.sentence(),
        }


# The table


def read(path: str | Path) -> Table:
    """A table from a CSV file: `distance_cm`, then a column a sonar.  Raises ValueError, OSError."""
    return parse(read_text(path, _MAX_BYTES), str(path))


def of_the_thesis() -> Table:
    """Annex A.3.1: 54 rows."""
    return parse(files("hil.procedures").joinpath("thesis_a31.csv").read_text(encoding="utf-8"), "annex A.3.1")


def parse(text: str, file: str) -> Table:
    """The table in a text.  Raises ValueError with the file, line and column of what is wrong."""
    reader = csv.reader(io.StringIO(text), strict=True)
    try:
        rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if any(map(str.strip, row))]
    except csv.Error as error:
        raise ValueError(f"{file}:{reader.line_num}: {error}: expected CSV") from None
    if not rows or rows[0][1][0] != "distance_cm" or len(rows[0][1]) < 2:
        raise ValueError(f"{file}:1: expected a header like distance_cm,LEFT,FRONT,RIGHT")
    names = rows[0][1][1:]
    if len(set(names)) != len(names) or not all(names):
        raise ValueError(f"{file}:{rows[0][0]}: expected a name of its own for each sonar, not {', '.join(names)}")
    distances: list[float] = []
    raw: dict[str, list[float]] = {name: [] for name in names}
    for line, cells in rows[1:]:
        if len(cells) != len(names) + 1:
            raise ValueError(f"{file}:{line}: {len(cells)} values: expected {len(names) + 1}, as in the header")
        distances.append(_number(cells[0], 1e4, f"{file}:{line}: distance_cm"))
        for name, cell in zip(names, cells[1:], strict=True):
            raw[name].append(_number(cell, 1e7, f"{file}:{line}: {name}") if cell else float("nan"))
    table = Table(np.array(distances), {n: np.array(v) for n, v in raw.items()}, tuple(line for line, _ in rows[1:]))
    for name, values in table.raw.items():
        known = np.isfinite(values)
        if len(set(table.distance_cm[known])) < 2 or len(set(values[known])) < 2:
            raise ValueError(f"{file}: {name}: expected at least two distances with different raw values")
    return table


def _number(text: str, most: float, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0.0 <= value <= most:
        raise ValueError(f"{where} = {text[:40]}: expected a number from 0 to {most:g}")
    return value


# The lines


def calibrate(table: Table) -> list[Calibration]:
    """Slope and offset of each sonar, with and without its suspect rows."""
    return [_calibration(table, name) for name in table.raw]


def _calibration(table: Table, sonar: str) -> Calibration:
    known = np.isfinite(table.raw[sonar])
    raw, distance = table.raw[sonar][known], table.distance_cm[known]
    lines = [line for line, there in zip(table.lines, known, strict=True) if there]
    off, allowed = _off_the_robust_line(raw, distance)
    bad = np.abs(off) > allowed
    suspects = tuple(
        OutlierRow(lines[i], float(distance[i]), float(raw[i]), float(off[i])) for i in np.flatnonzero(bad)
    )  # fmt: skip
    rest_counts = len(set(distance[~bad])) > 1 and len(set(raw[~bad])) > 1
    without = _least_squares(raw[~bad], distance[~bad]) if suspects and rest_counts else None
    return Calibration(sonar, distance, raw, _least_squares(raw, distance), suspects, without)


def _least_squares(raw: Numbers, distance: Numbers) -> LinearFit:
    slope, offset = np.polyfit(raw, distance, 1)
    residuals = slope * raw + offset - distance
    return LinearFit(float(slope), float(offset), float(np.sqrt(np.mean(residuals**2))))


def _off_the_robust_line(raw: Numbers, distance: Numbers) -> tuple[Numbers, float]:
    """How far each row lies from the robust line, in cm, and how far is allowed."""
    steps = np.unique(distance)
    medians = np.array([np.median(raw[distance == step]) for step in steps])
    slopes = [
        (steps[j] - steps[i]) / (medians[j] - medians[i])
        for i, j in combinations(range(len(steps)), 2) if medians[i] != medians[j]
    ]  # fmt: skip
    slope = float(np.median(slopes)) if slopes else 0.0
    off = slope * raw + float(np.median(steps - slope * medians)) - distance
    scatter = slope * (raw - medians[np.searchsorted(steps, distance)])
    return off, max(RESOLUTION_CM, DEVIATIONS * 1.4826 * float(np.median(np.abs(scatter))))


# The emulated robot


def emulate(
    *, seed: int | None = 1, distances_cm: Sequence[float] = DISTANCES_CM, readings: int = READINGS,
    fixes: Sequence[str] = (), progress: Callable[[float], None] = lambda fraction: None,
) -> Table:  # fmt: skip
    """The same table, measured with the emulated robot: a wall at each distance before each sonar.

    The firmware reads it: `Calibrate_US(sonar, 1, 0)`, then `Read_Distance(sonar)`.  `seed` None: ideal sonars.
    """
    rows: list[tuple[float, ...]] = []
    robot = WallRig(seed, fixes)
    for distance in distances_cm:
        robot.stand(distance)
        for _ in range(readings):
            rows.append((distance, *robot.next(_read_all)))
            progress(len(rows) / (len(distances_cm) * readings))
    columns = np.array(rows).T
    raw = dict(zip(DEFAULT_MOUNTS, columns[1:], strict=True))
    return Table(columns[0], raw, tuple(range(2, len(rows) + 2)))


def _read_all(firmware: Firmware) -> tuple[float, ...]:
    us = firmware.us
    return tuple(float(us.Read_Distance(getattr(us.US_SENSOR, name))) for name in DEFAULT_MOUNTS)


class WallRig:
    """One robot, with us.c linked to it, and walls before its sonars.  `seed` None: ideal sonars.

    Its sonars range from the first reading on; slope and offset are 1 and 0.
    """

    def __init__(self, seed: int | None, fixes: Sequence[str] = ()) -> None:
        self.board = RobotBoard(seed=seed or 0, ideal=seed is None)
        self._firmware = link(self.board, modules=["firmware_model.us"], fixes=fixes)
        self._ranging = False

    def stand(self, distance_cm: float) -> None:
        """Walls at this distance from the sonars on the left, in front and on the right, from now on."""
        walls, sonars = SonarRays(_walls(distance_cm / 100)), self.board.sonars
        pose = (0.0, 0.0, 0.0)
        sonars.set_range_source(lambda name, cycles: walls.echoes(name, pose))
        if not self.board.ideal:
            sonars.air.set_cross_source(lambda source, listener, cycles: walls.cross_path(source, listener, pose))

    def next(self, read: Callable[[Firmware], T]) -> T:
        """What `read(firmware)` gives, once every sonar has ranged anew."""
        if not self._ranging:
            us = self._firmware.us
            us.Init_US()
            for name in DEFAULT_MOUNTS:
                us.Calibrate_US(getattr(us.US_SENSOR, name), 1.0, 0.0)
            self._ranging = True
        self.board.clock.advance_to(self.board.clock.now + _BETWEEN_READINGS_CYCLES)
        return read(self._firmware)


def _walls(range_m: float) -> list[Segment]:
    """Walls at the same distance before the sonars on the left, in front and on the right; one far behind."""
    front, left = DEFAULT_MOUNTS["FRONT"].x_m + range_m, DEFAULT_MOUNTS["LEFT"].y_m + range_m
    right, behind = DEFAULT_MOUNTS["RIGHT"].y_m - range_m, -3.0
    corners = ((behind, right), (front, right), (front, left), (behind, left))
    return [Segment(*a, *b) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)]


# The picture


def plot(path: str | Path, found: Sequence[Calibration], title: str) -> None:
    """Rows, lines and suspects of each sonar, and below how far each row is off.  PNG, SVG or PDF by the suffix."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.2 * len(found), 6.5), layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.subplots(2, len(found), squeeze=False, height_ratios=(3, 2))
    for column, one in enumerate(found):
        above, below = axes[0][column], axes[1][column]
        bad = np.isin(one.raw, [s.raw for s in one.suspects]) & np.isin(
            one.distance_cm, [s.distance_cm for s in one.suspects]
        )
        ends = np.array([one.raw.min(), one.raw.max()])
        for line, style, label in ((one.line, "-", "all rows"), (one.without, "--", "without suspects")):
            if line is not None:
                text = f"{label}: {line.slope_cm:.4f}, {line.offset_cm:.4f}"
                above.plot(ends, line.slope_cm * ends + line.offset_cm, style, label=text, linewidth=1.2)
        above.plot(one.raw[~bad], one.distance_cm[~bad], ".", color="black", markersize=4)
        above.plot(one.raw[bad], one.distance_cm[bad], "x", color="tab:red", label="suspect" if bad.any() else None)
        above.set_title(one.sonar)
        above.set_xlabel("raw value (counts)")
        above.legend(fontsize="x-small", loc="lower right")
        best = one.best
        off = best.slope_cm * one.raw + best.offset_cm - one.distance_cm
        below.axhspan(-RESOLUTION_CM, RESOLUTION_CM, color="tab:green", alpha=0.12, label="an inch")
        below.plot(one.distance_cm[~bad], off[~bad], ".", color="black", markersize=4)
        below.plot(one.distance_cm[bad], off[bad], "x", color="tab:red")
        below.set_xlabel("distance (cm)")
        below.legend(fontsize="x-small", loc="best")
        for axis in (above, below):
            axis.grid(alpha=0.3)
    axes[0][0].set_ylabel("distance (cm)")
    axes[1][0].set_ylabel("read minus distance (cm)")
    figure.suptitle(title, fontsize="medium")
    save(figure, path)
