"""Demonstrations of the defects of us.c, by id."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from hil.audit import properties
from hil.audit.evidence import Evidence, Picture, Series, measured, reported
from hil.audit.rig import ALONE, Fixes, Rig, static_findings

#: A rig with us.c and the modules that it needs.  It is built faster than the whole robot's program.
_rig: Final = partial(Rig, modules=ALONE["us"])

#: Counts of a wall at 1.2 m, where the window of the C applies, and at 50 cm, where the robot navigates.
FAR, NEAR, OUTLIER = 400, 160, 300


def _reading(fixes: Fixes, codes: list[int], **options: object) -> tuple[Rig, float]:
    """Return one calibrated reading of the left sensor over these conversions, which repeat."""
    rig = _rig(fixes, keep_locals=True, **options)  # type: ignore[arg-type]
    rig.fw.us.Init_US()
    rig.codes(iter((codes * 2)[: len(codes) + 1]))
    rig.fw.us.Calibrate_US(rig.fw.us.US_SENSOR.LEFT, 0.0551, 4.3516)
    return rig, rig.fw.us.Read_Distance(rig.fw.us.US_SENSOR.LEFT)


def start_before_ready(fixes: Fixes) -> Evidence:
    """Switch board and sonars on together; do the sonars range within the second after Init_US?"""
    rig = _rig(fixes, sonars_powered_up=False)
    rig.fw.us.Init_US()
    rig.wait(1.0)
    readings = sum(sensor.readings for sensor in rig.board.sonars.sensors.values())
    return measured("sonar readings in the second after the start, switched on with the board", readings, low=1)


def channel_unchecked(fixes: Fixes) -> Evidence:
    """Read a channel that us.h does not have."""
    rig = _rig(fixes)
    rig.fw.us.Init_US()
    rig.call(rig.fw.us.Read_Channel, 3)
    return reported(rig.findings, "adc-window", function="Read_Channel")


def poll_forever(fixes: Fixes) -> Evidence:
    """Read a converter that does not answer."""
    rig = _rig(fixes)
    rig.fw.us.Init_US()
    rig.board.adc["A"].stopped_by_fault = True
    rig.call(rig.fw.us.Read_Channel, 0)
    return reported(rig.findings, "endless-poll", function="Read_Channel")


def implausible(fixes: Fixes) -> Evidence:
    """Read a broken wire that is pulled up: all codes are the largest of the converter."""
    _, distance = _reading(fixes, [4095] * 13)
    return measured("distance of an input at the converter's end", distance, "cm", high=0.0)


def _conversions(fixes: Fixes) -> int:
    """Return the number of conversions of one reading."""
    rig = _rig(fixes)
    rig.fw.us.Init_US()
    count = 0

    def convert(_soc: int) -> int:
        nonlocal count
        count += 1
        return NEAR

    rig.codes(convert)
    rig.fw.us.Read_Distance(rig.fw.us.US_SENSOR.LEFT)
    return count


def samples_12(fixes: Fixes) -> Evidence:
    """Count the conversions of one reading."""
    return measured("conversions in a reading", _conversions(fixes), low=13, high=13)


def accumulator(fixes: Fixes) -> Evidence:
    """Read the left sensor repeatedly; it always sees the same wall."""
    rig, first = _reading(fixes, [NEAR] * 12, fill="stack")
    rig.codes(lambda _soc: NEAR)
    distances = [first, *(rig.fw.us.Read_Distance(rig.fw.us.US_SENSOR.LEFT) for _ in range(19))]
    picture = Picture("A wall that stays where it is", "reading", "distance in cm",
                      [Series("Read_Distance", range(1, 21), distances)])  # fmt: skip
    functions = ("Read_Distance", "Measure")
    hits = [reported(rig.findings, "uninitialised", function=name, object="result") for name in functions]
    return next((hit for hit in hits if hit.seen), hits[0]).shown(picture)


def index_before_start(fixes: Fixes) -> Evidence:
    """Read the left sensor once."""
    rig, _ = _reading(fixes, [NEAR] * 12)
    hits = [reported(rig.findings, "index", function=name) for name in ("Read_Distance", "Measure")]
    return next((hit for hit in hits if hit.seen), hits[0])


def _outlier(fixes: Fixes, index: int) -> Evidence:
    """Put one wrong sample among samples of a wall at 1.2 m."""
    rig, clean = _rig(fixes), [FAR] * properties.CONVERSIONS
    wrong = range(FAR - OUTLIER, FAR + OUTLIER + 1, 20)
    distances = [properties.distance_read(rig, [*clean[:index], code, *clean[index + 1 :]]) for code in wrong]
    right = Series("without it", [wrong[0], wrong[-1]], [properties.distance_read(rig, clean)] * 2)
    picture = Picture(f"Sample {index} is wrong, the others are {FAR}", "sample in counts", "distance in cm",
                      [Series("Read_Distance", wrong, distances), right])  # fmt: skip
    return properties.outlier_bound(rig, clean, index, FAR + OUTLIER).shown(picture)


def correction_after_sum(fixes: Fixes) -> Evidence:
    """Give one long echo at a distance where the window applies."""
    return _outlier(fixes, 5)


def window_one_sided(fixes: Fixes) -> Evidence:
    """Let the last sample rise, so that no fall follows."""
    return _outlier(fixes, _conversions(fixes) - 1)


def _window(fixes: Fixes, codes: list[int]) -> list[float]:
    """Return the samples of a reading after the window."""
    rig, _ = _reading(fixes, codes)
    path = next(p for p in ("us.Measure", "us.Read_Distance") if p in rig.fw.linked.last_locals)
    return [value for value in rig.fw.last_locals(path)["v"] if value is not None]


def window_far_only(fixes: Fixes) -> Evidence:
    """Let a sample fall back to 50 cm: is it limited there too?  The samples show it, because the sum comes before."""
    codes = [NEAR] * 13
    codes[5] = NEAR + OUTLIER
    window = _window(fixes, codes)
    lines = [Series(name, range(len(v)), v) for name, v in (("behind the window", window), ("converted", codes))]
    picture = Picture("The samples of a reading", "sample", "counts", lines)
    # TFG 3.1.1: 8.5 to either side, in units of annex A.3.1: the sum of 12 counts divided by 2.3.
    what = f"spread of a window of {NEAR} counts with one sample of {NEAR + OUTLIER}"
    return measured(what, max(window) - min(window), "counts", high=2 * 8.5 * 2.3 / 12).shown(picture)


def median_unused(fixes: Fixes) -> Evidence:
    """Look for calls in the call graph of the image."""
    return reported(static_findings(fixes), "never-called", object="median")


def _median(fixes: Fixes, values: list[float]) -> Rig:
    rig = _rig(fixes)
    rig.fw.us.median(rig.fw.array("float32", [*values, *[0.0] * (64 - len(values))]), len(values))
    return rig


def median_octets(fixes: Fixes) -> Evidence:
    """Take the median of thirteen values, as the text does."""
    rig = _median(fixes, [float(i) for i in range(13)])
    return reported(rig.findings, "memcpy-octets", function="median")


def median_many(fixes: Fixes) -> Evidence:
    """Take the median of thirty values."""
    rig = _median(fixes, [float(i) for i in range(30)])
    return reported(rig.findings, "index", function="median", object="aux")


def median_empty(fixes: Fixes) -> Evidence:
    """Take the median of no values."""
    rig = _median(fixes, [])
    return reported(rig.findings, "uninitialised", function="median")


def median_even(fixes: Fixes) -> Evidence:
    """Take the median of four values."""
    return properties.median(_rig(fixes), [1.0, 2.0, 3.0, 4.0])


def average_unused(fixes: Fixes) -> Evidence:
    """Look for calls in the call graph of the image."""
    return reported(static_findings(fixes), "never-called", object="average")


def average_accumulator(fixes: Fixes) -> Evidence:
    """Take the average of two values."""
    rig = _rig(fixes)
    rig.fw.us.average(rig.fw.array("float32", [1.0, 2.0]), 2)
    return reported(rig.findings, "uninitialised", function="average")


def average_empty(fixes: Fixes) -> Evidence:
    """Take the average of no values."""
    rig = _rig(fixes)
    rig.fw.us.average(rig.fw.array("float32", [1.0]), 0)
    return reported(rig.findings, "division-by-zero", function="average")


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "US-start-before-ready": start_before_ready,
    "US-channel-unchecked": channel_unchecked,
    "US-poll-forever": poll_forever,
    "US-implausible": implausible,
    "US-samples-12": samples_12,
    "US-accumulator": accumulator,
    "US-index-before-start": index_before_start,
    "US-correction-after-sum": correction_after_sum,
    "US-window-one-sided": window_one_sided,
    "US-window-far-only": window_far_only,
    "US-median-unused": median_unused,
    "US-median-octets": median_octets,
    "US-median-many": median_many,
    "US-median-empty": median_empty,
    "US-median-even": median_even,
    "US-average-unused": average_unused,
    "US-average-accumulator": average_accumulator,
    "US-average-empty": average_empty,
}
