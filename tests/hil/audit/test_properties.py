"""The properties hold of the corrected firmware for every example, and not of the faithful one where the catalogue
says so.  Bounds and their sources stand at the properties; here is only what an example may be."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, find, given, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

from firmware_model.corrections import ALL
from hil.audit import properties
from hil.audit.evidence import Evidence
from hil.audit.properties import CONVERSIONS, COORDINATE_MM, MonitorValues, SpeedStep, Z
from hil.audit.rig import Rig
from hil.golden.scripted_gyro import ScriptedGyro
from hil.testing import strategies

CORRECTED = frozenset({ALL})
#: Of the sensor: 250 degrees/s of 8.75 mdps; a zero-rate level of up to 10 degrees/s (L3G4200D table 4).
FULL_SCALE = 28571
ZERO_RATE = 1143
#: XBee.c keeps 79 characters of a frame.
LONGEST = 79


def holds(evidence: Evidence) -> None:
    assert not evidence.seen, evidence.line


class Drivers:
    """One firmware on one board, for all examples."""

    def __init__(self, fixes: frozenset[str]) -> None:
        self.rig = Rig(fixes)
        self.gyro: ScriptedGyro = self.rig.scripted_gyro()


@pytest.fixture(scope="module")
def corrected() -> Drivers:
    return Drivers(CORRECTED)


@pytest.fixture(scope="module")
def faithful() -> Drivers:
    return Drivers(frozenset())


# Examples

codes = strategies.codes()
samples = st.one_of(
    strategies.steady_windows(CONVERSIONS, noise=4), strategies.slewing_windows(CONVERSIONS),
    st.lists(codes, min_size=CONVERSIONS, max_size=CONVERSIONS),
)  # fmt: skip
single = st.floats(-1e6, 1e6, width=32)
turns = st.integers(-FULL_SCALE, FULL_SCALE).filter(bool)
levels = st.integers(-ZERO_RATE, ZERO_RATE)
headings = st.floats(-6.25, 6.25, width=32)
drives = st.builds(SpeedStep, strategies.speeds(0.3), strategies.speeds(1.57), st.integers(1, 20))
rolling = drives.filter(lambda drive: drive.v_m_s != 0)
ends = st.floats(-60_000, 60_000, width=32)
#: 12 conversions of 4095 counts are 1217 cm with the greatest of the three calibrations.
distances = st.floats(0, 1217, width=32)
shown = st.builds(MonitorValues, ends, ends, st.floats(-3000, 3000, width=32), distances, distances, distances)
between_marks = st.binary(max_size=LONGEST - 2).map(lambda data: bytes(b for b in data if b not in b"#\r"))
almost_orders = st.builds(
    lambda order, at, byte: order[:at] + byte + order[at:-1] + b"\r", strategies.orders(), st.integers(1, 5),
    st.sampled_from([b"", b"0", b".", b",", b"-", b"x", b"\n", b"\0"]),
)  # fmt: skip
frames = st.one_of(
    strategies.orders(), almost_orders, strategies.malformed_orders().filter(lambda frame: len(frame) <= LONGEST),
    between_marks.map(lambda data: b"#" + data + b"\r"),
)  # fmt: skip


# The corrected drivers


@given(clean=samples, index=st.integers(0, CONVERSIONS - 1), wrong=codes)
def test_one_outlier_moves_a_distance_by_no_more_than_the_others_differ(
    corrected: Drivers, clean: list[int], index: int, wrong: int
) -> None:
    # A sonar that works: 6 inches are 52 counts; half of that is no reading, nor is more than its ceiling: 2300 counts.
    middle = sorted(clean)[CONVERSIONS // 2]
    assume(not 20 <= middle <= 32 and not 2294 <= middle <= 2306)
    holds(properties.outlier_bound(corrected.rig, clean, index, wrong))


@given(sensor=st.integers(0, 2), range_m=st.floats(0.16, 6.45))
def test_a_distance_read_back_is_the_true_one(corrected: Drivers, sensor: int, range_m: float) -> None:
    holds(properties.distance_scale(corrected.rig, sensor, range_m))


@given(values=st.lists(single, min_size=1, max_size=20))
def test_median_and_average_are_those_of_statistics(corrected: Drivers, values: list[float]) -> None:
    holds(properties.median(corrected.rig, values))
    holds(properties.average(corrected.rig, values))


@given(axis=st.integers(0, 2), digits=turns, level=levels)
def test_a_rotation_read_back_has_its_sign_and_its_scale(
    corrected: Drivers, axis: int, digits: int, level: int
) -> None:
    holds(properties.rotation_sign(corrected.rig, corrected.gyro, axis, digits, level))
    holds(properties.rotation_scale(corrected.rig, corrected.gyro, axis, digits, level))


@settings(max_examples=20)
@given(level=levels)
def test_a_robot_at_rest_does_not_turn(corrected: Drivers, level: int) -> None:
    holds(properties.rotation_bias(corrected.rig, corrected.gyro, level))


@given(heading=headings, path=st.lists(drives, min_size=1, max_size=6))
def test_odometry_of_a_driven_path_is_the_driven_path(
    corrected: Drivers, heading: float, path: list[SpeedStep]
) -> None:
    holds(properties.odometry_path(corrected.rig, heading, path))
    holds(properties.odometry_heading(corrected.rig, heading, path))


@given(heading=headings, drive=rolling)
def test_each_period_of_the_odometry_has_its_way_and_its_direction(
    corrected: Drivers, heading: float, drive: SpeedStep
) -> None:
    holds(properties.odometry_distance(corrected.rig, heading, drive))
    holds(properties.odometry_course(corrected.rig, heading, drive))


@given(frame=frames)
def test_a_frame_is_the_order_that_it_is_or_none(corrected: Drivers, frame: bytes) -> None:
    holds(properties.order_read(corrected.rig, frame))


@given(frame=strategies.references())
def test_a_reference_is_the_one_stated_held_within_the_robot(corrected: Drivers, frame: bytes) -> None:
    holds(properties.reference_read(corrected.rig, frame))


@given(example=shown)
def test_a_frame_carries_what_the_monitors_hold(corrected: Drivers, example: MonitorValues) -> None:
    holds(properties.frame_units(corrected.rig, example))


# The faithful drivers: Hypothesis finds the example that the catalogue names


def counterexample(strategy: st.SearchStrategy[Any], evidence: Callable[[Any], Evidence]) -> Any:
    quiet = settings(database=None, derandomize=True, max_examples=500, suppress_health_check=list(HealthCheck))
    return find(strategy, lambda example: evidence(example).seen, settings=quiet)


def test_an_outlier_goes_through_the_faithful_filter(faithful: Drivers) -> None:
    """US-correction-after-sum: a twelfth of the error; the 2 cm are 84 counts of 0.287 cm / 12."""
    clean = [400] * CONVERSIONS
    wrong = counterexample(codes, lambda code: properties.outlier_bound(faithful.rig, clean, 5, code))
    assert abs(wrong - 400) >= 84
    assert not properties.outlier_bound(faithful.rig, clean, 5, 400 + 83).seen


def test_the_faithful_median_fails_for_even_numbers_only(faithful: Drivers) -> None:
    """US-median-even."""
    small = st.lists(st.integers(0, 9).map(float), min_size=1, max_size=9)
    values = counterexample(small, partial(properties.median, faithful.rig))
    assert len(values) % 2 == 0
    odd = small.filter(lambda values: len(values) % 2 == 1)
    with pytest.raises(NoSuchExample):
        counterexample(odd, partial(properties.median, faithful.rig))


def test_what_the_stack_held_is_in_the_faithful_distance_and_average() -> None:
    """US-accumulator, US-average-accumulator."""
    rig = Rig(fill="ones")
    assert properties.distance_scale(rig, 0, 1.0).seen
    assert properties.average(rig, [1.0, 2.0]).seen


def test_the_faithful_gyro_loses_every_clockwise_turn(faithful: Drivers) -> None:
    """GYRO-clockwise-zero, GYRO-dead-band (0.01 rad/s are 65 digits, of 0.0174 x 250 / 32767: 76), GYRO-scale."""
    sign = partial(properties.rotation_sign, faithful.rig, faithful.gyro, Z)
    fast = st.integers(80, FULL_SCALE)
    with pytest.raises(NoSuchExample):
        counterexample(fast, sign)
    assert all(sign(-digits).seen for digits in (1, 80, 6548, FULL_SCALE))
    assert counterexample(st.integers(1, 79), sign) == 1
    scale = partial(properties.rotation_scale, faithful.rig, faithful.gyro, Z)
    assert all(scale(digits).seen for digits in (80, 6548, FULL_SCALE))


def test_the_faithful_offset_overflows_above_327_digits(faithful: Drivers) -> None:
    """GYRO-sum16: 100 samples of 328 digits are more than 32767."""
    bias = partial(properties.rotation_bias, faithful.rig, faithful.gyro)
    assert not bias(327).seen
    assert bias(328).seen
    assert bias(-ZERO_RATE).seen


@pytest.mark.parametrize(
    "drive",
    [SpeedStep(0.2, 0.009, 240), SpeedStep(0.3, 0.5), SpeedStep(0.3, 1.57, 20)],
    ids=["ODO-slow-turn-lost", "ODO-units-turning", "ODO-half-step"],
)
def test_faithful_odometry_leaves_the_path_in_a_turn(faithful: Drivers, drive: SpeedStep) -> None:
    assert properties.odometry_path(faithful.rig, 0.0, [drive]).seen


def test_faithful_odometry_keeps_only_the_direction_it_started_in(faithful: Drivers) -> None:
    """ODO-angle-factor: straight on at heading 0 nothing is wrong, at any other the direction is."""
    assert not properties.odometry_path(faithful.rig, 0.0, [SpeedStep(0.2, 0.0, 20)]).seen
    away = st.floats(0.0625, 3.0, width=32)
    assert counterexample(away, lambda h: properties.odometry_course(faithful.rig, h, SpeedStep(0.2, 0.0)))


def test_the_faithful_parser_obeys_what_is_no_order(faithful: Drivers) -> None:
    """PROTO-order-prefix, PROTO-numbers-unchecked."""
    behind = st.binary(min_size=1, max_size=3).filter(lambda data: not set(data) & set(b"#\r"))
    read = partial(properties.order_read, faithful.rig)
    assert len(counterexample(behind.map(lambda data: b"#STOP" + data + b"\r"), read)) == 7
    assert counterexample(st.sampled_from([b"", b"x,y", b"0.1;0.2"]).map(lambda text: b"#SETR" + text + b"\r"), read)


def test_faithful_references_and_frames_have_no_range_and_no_unit(faithful: Drivers) -> None:
    """PROTO-reference-range, PROTO-angle-unit."""
    found = counterexample(strategies.references(), partial(properties.reference_read, faithful.rig))
    v, w = (abs(float(text)) for text in found[5:-1].split(b","))
    assert v > 0.3 or w > 1.57
    assert properties.frame_units(faithful.rig, MonitorValues(heading_rad=1.5)).seen
    assert not properties.frame_units(faithful.rig, MonitorValues(heading_rad=2.0)).seen
    assert not properties.frame_units(faithful.rig, MonitorValues(x_mm=COORDINATE_MM, left_cm=50.0)).seen
