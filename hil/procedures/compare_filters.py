"""What the ways to make a distance of several samples do with the same pings of the front sonar.

| filter | what |
|---|---|
| `sum` | `Read_Distance` of us.c as it is: twelve samples are summed |
| `median` | `median` of us.c over thirteen samples |
| `text` | what the text describes (2.4.1): a sample more than 8.5 from the one before is left out; median of the rest |
| `corrected` | `Read_Distance` with all corrections of the catalogue |

All read the emulated robot's sonar before a wall, at the distances of annex A.3.2 and at the same moments, with one
slope and offset: those that `hil calibrate --emulate` gives for this robot.

CHOICE: the thirteen samples are taken at once, as us.c takes its twelve; the text says every 5 ms, the period of the
task.  CHOICE: the 8.5 of the text are units of the calibrated raw value, of which a centimetre has
16.5.  CHOICE: of an even number of samples the last is left out, since `median` takes a wrong pair then.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from emulator.image import Firmware
from firmware_model.corrections import ALL, resolve
from hil.client.plot import save
from hil.procedures.calibrate import FRONT, LinearFit, Numbers, WallRig, calibrate, emulate, parse

#: The distances of annex A.3.2.
DISTANCES_CM: Final = (20.0, 25.0, 40.0, 50.0)
READINGS: Final = 30
SAMPLES: Final = 13
#: How far a sample may lie from the one before, as the text says.
WINDOW: Final = 8.5
#: us.c: twelve samples, divided by 2.3, are a raw value.
RAW_PER_COUNT: Final = 12 / 2.3


@dataclass(frozen=True, slots=True)
class FilterErrors:
    """Read minus real distance, in cm: mean, standard deviation, root of the mean square, largest."""

    mean_cm: float
    deviation_cm: float
    rms_cm: float
    worst_cm: float


@dataclass(frozen=True, slots=True)
class Filter:
    """What one filter read: a distance in cm a reading, and the real one beside it."""

    name: str
    distance_cm: Numbers
    read_cm: Numbers

    @property
    def errors(self) -> FilterErrors:
        """Over all distances."""
        return errors(self.read_cm - self.distance_cm)

    def at(self, distance_cm: float) -> FilterErrors:
        """At one distance."""
        there = self.distance_cm == distance_cm
        return errors(self.read_cm[there] - distance_cm)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        by_distance = {f"{d:g}": asdict(self.at(d)) for d in np.unique(self.distance_cm)}
        return {"filter": self.name, "all": asdict(self.errors), "by_distance_cm": by_distance}


def errors(off_cm: Numbers) -> FilterErrors:
    """What a series of errors amounts to."""
    return FilterErrors(
        float(np.mean(off_cm)), float(np.std(off_cm)), float(np.sqrt(np.mean(off_cm**2))),
        float(off_cm[np.argmax(np.abs(off_cm))]),
    )  # fmt: skip


def of_the_thesis() -> list[Filter]:
    """Annex A.3.2: 24 readings of the front sonar by the algorithms that it calls OLD and NEW."""
    table = parse(files("hil.procedures").joinpath("thesis_a32.csv").read_text(encoding="utf-8"), "annex A.3.2")
    return [Filter(f"thesis {name}", table.distance_cm, read) for name, read in table.raw.items()]


# A filter takes the firmware and gives a raw value.


def _sum(firmware: Firmware) -> float:
    us = firmware.us
    return float(us.Read_Distance(us.US_SENSOR.FRONT))


def _samples(firmware: Firmware) -> list[float]:
    return [float(firmware.us.Read_Channel(1)) * RAW_PER_COUNT for _ in range(SAMPLES)]


def _median(firmware: Firmware, samples: Sequence[float]) -> float:
    return float(firmware.us.median(firmware.array("float", samples), len(samples)))


def _median_of_all(firmware: Firmware) -> float:
    return _median(firmware, _samples(firmware))


def _text(firmware: Firmware) -> float:
    samples = _samples(firmware)
    kept = [samples[0], *(b for a, b in pairwise(samples) if abs(b - a) <= WINDOW)]
    return _median(firmware, kept if len(kept) % 2 else kept[:-1])  # us.c takes a wrong pair of an even number


#: Every correction of us.c but one: it waits for the sonars with `Task_sleep`, and here is no task.
_CORRECTIONS: Final = tuple(sorted(f for f in resolve([ALL]) if f.startswith("US-") and f != "US-start-before-ready"))
FILTERS: Final[dict[str, tuple[Callable[[Firmware], float], tuple[str, ...]]]] = {
    "sum": (_sum, ()),
    "median": (_median_of_all, ()),
    "text": (_text, ()),
    "corrected": (_sum, _CORRECTIONS),
}


def compare(
    *, seed: int = 1, readings: int = READINGS, progress: Callable[[float], None] = lambda fraction: None
) -> list[Filter]:
    """What each filter reads of the same pings."""
    line = _line(seed)
    found = []
    for n, (name, (read, fixes)) in enumerate(FILTERS.items()):
        rows = []
        robot = WallRig(seed, fixes)
        for m, distance in enumerate(DISTANCES_CM):
            robot.stand(distance)
            rows += [(distance, line.slope_cm * robot.next(read) + line.offset_cm) for _ in range(readings)]
            progress((n + (m + 1) / len(DISTANCES_CM)) / len(FILTERS))
        columns = np.array(rows).T
        found.append(Filter(name, columns[0], columns[1]))
    return found


def _line(seed: int) -> LinearFit:
    """Slope and offset of this robot's front sonar, measured as `hil calibrate --emulate` does."""
    return next(one.line for one in calibrate(emulate(seed=seed)) if one.sonar == FRONT)


def sentence(found: Sequence[Filter]) -> str:
    """What it means for the robot."""
    rms = {one.name: one.errors.rms_cm for one in found}
    best, worst = min(rms, key=rms.__getitem__), max(rms, key=rms.__getitem__)
    return (
        f"Over the same pings the filters are {rms[best]:.1f} ({best}) to {rms[worst]:.1f} cm ({worst}) off (rms): all "
        "samples are taken at once, of one ping, which the sonar tells in whole inches, and no filter mends that."
    )


def plot(path: str | Path, found: Sequence[Filter], thesis: Sequence[Filter]) -> None:
    """The errors of each filter over the distance, beside those of the thesis.  PNG, SVG or PDF by the suffix."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    every = [*thesis, *found]
    figure = Figure(figsize=(2.2 * len(every), 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.subplots(1, len(every), sharey=True)
    for axis, one in zip(axes, every, strict=True):
        off = one.read_cm - one.distance_cm
        # Beside each other, in their order, around the distance.
        order = np.array([np.sum(one.distance_cm[:n] == d) for n, d in enumerate(one.distance_cm)])
        color = "tab:gray" if one in thesis else "tab:blue"
        axis.plot(one.distance_cm + 2.4 * (order / max(order.max(), 1) - 0.5), off, ".", markersize=4, color=color)
        total = one.errors
        axis.axhline(total.mean_cm, color="tab:red", linewidth=1)
        axis.set_title(f"{one.name}\nrms {total.rms_cm:.2f} cm", fontsize="medium")
        axis.set_xlabel("distance (cm)")
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("read minus distance (cm)")
    save(figure, path, dpi=100)
