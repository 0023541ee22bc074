"""Pacing against a clock that the test turns."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import SYSCLK_HZ
from hil.pacing import REANCHOR_S, SLICE_S, Lag, Pacer


class WallClock:
    """Time passes only in `wait`, and by what the machine is said to take."""

    def __init__(self) -> None:
        self.now = 1000.0
        self.waits: list[float] = []
        #: Absolute times at which the PC writes a byte.
        self.arrivals: list[float] = []

    def monotonic(self) -> float:
        return self.now

    def wait(self, fds: Sequence[int], seconds: float) -> bool:
        self.waits.append(seconds)
        if fds and self.arrivals and self.arrivals[0] < self.now + seconds:
            self.now = max(self.now, self.arrivals.pop(0))
            return True
        self.now += seconds
        return False


def pacer(wall: WallClock, pace: float | None) -> Pacer:
    return Pacer(pace, monotonic=wall.monotonic, wait=wall.wait)


@pytest.mark.parametrize(("pace", "wall_s"), [(1.0, 2.0), (0.25, 8.0), (4.0, 0.5)])
def test_two_virtual_seconds_take_two_over_pace_real_ones(pace: float, wall_s: float) -> None:
    wall = WallClock()
    pace_maker = pacer(wall, pace)
    pace_maker.start(0)
    now = 0
    while now < 2 * SYSCLK_HZ:
        now += pace_maker.slice_cycles
        pace_maker.wait_until(now, ())
        pace_maker.finished(now)
    assert wall.now - 1000.0 == pytest.approx(wall_s, abs=1e-6)
    assert pace_maker.ratio(now) == pytest.approx(pace)
    assert pace_maker.lag.max_s == pytest.approx(0.0, abs=1e-9)


def test_pace_max_never_waits() -> None:
    wall = WallClock()
    pace_maker = pacer(wall, None)
    pace_maker.start(0)
    assert not pace_maker.wait_until(SYSCLK_HZ, (0,))
    pace_maker.finished(SYSCLK_HZ)
    assert wall.waits == []
    assert pace_maker.lag.slices == 0


def test_deadlines_are_absolute_so_slow_slices_do_not_add_up() -> None:
    wall = WallClock()
    pace_maker = pacer(wall, 1.0)
    pace_maker.start(0)
    now = 0
    for index in range(100):
        now += pace_maker.slice_cycles
        pace_maker.wait_until(now, ())
        wall.now += 0.020 if index % 10 == 0 else 0.0001  # a hiccup of four slices now and then
        pace_maker.finished(now)
    # 100 slices of 5 ms; the last hiccup is 9 slices back and made up for; only the last execution is late.
    assert wall.now - 1000.0 == pytest.approx(100 * SLICE_S + 0.0001)
    assert pace_maker.lag.max_s == pytest.approx(0.020)
    assert pace_maker.lag.reanchors == 0


def test_a_lag_beyond_half_a_second_is_given_up_and_counted() -> None:
    wall = WallClock()
    pace_maker = pacer(wall, 1.0)
    pace_maker.start(0)
    now = pace_maker.slice_cycles
    pace_maker.wait_until(now, ())
    wall.now += 2.0
    pace_maker.finished(now)
    assert pace_maker.lag.reanchors == 1
    assert pace_maker.lag.lost_s == pytest.approx(2.0)
    assert pace_maker.lag.max_s == pytest.approx(2.0)
    # Not made up: the next slice is due one slice after now.
    assert pace_maker.deadline_s(now + pace_maker.slice_cycles) == pytest.approx(wall.now + SLICE_S)


def test_a_byte_ends_the_wait_at_the_virtual_time_of_its_arrival() -> None:
    wall = WallClock()
    pace_maker = pacer(wall, 0.5)
    pace_maker.start(1000)
    wall.arrivals = [1000.002]
    assert pace_maker.wait_until(1000 + pace_maker.slice_cycles, (3,))
    # 2 ms at pace 0.5 are 1 ms: 200,000 cycles.
    assert pace_maker.virtual_now() == pytest.approx(1000 + 200_000, abs=2)


def test_quantiles_are_never_below_the_lag_they_speak_of() -> None:
    lag = Lag()
    for value in (0.0001, 0.0002, 0.0003, 0.2):
        lag.note(value)
    assert 0.0002 <= lag.quantile_s(0.5) <= 0.00031
    assert lag.quantile_s(1.0) == 0.2


@given(st.lists(st.floats(0, 1), min_size=1, max_size=50), st.floats(0, 1))
def test_a_quantile_lies_between_the_true_one_and_one_step_above(lags: list[float], share: float) -> None:
    lag = Lag()
    for value in lags:
        lag.note(value)
    covered = sum(value <= lag.quantile_s(share) + 1e-12 for value in lags)
    # Beyond the last bin all are alike and the largest is not claimed to be smaller than it is.
    if max(lags) < REANCHOR_S:
        assert covered >= share * len(lags) - 1e-9
    assert lag.quantile_s(share) <= max(lags)


@pytest.mark.parametrize("pace", [0.0, -1.0, 1e9, float("nan"), float("inf")])
def test_an_impossible_pace_is_refused(pace: float) -> None:
    with pytest.raises(ValueError, match="pace"):
        Pacer(pace)
