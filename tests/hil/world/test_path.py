"""Where something was, in bounded memory."""

from __future__ import annotations

import itertools

from hypothesis import given
from hypothesis import strategies as st

from hil.world.path import Path


def walked(count: int, most: int) -> Path:
    path = Path(most)
    for k in range(count):
        path.add(float(k), 2.0 * k, 3.0 * k, 4.0 * k)
    return path


def test_a_short_path_has_every_point() -> None:
    path = walked(30, 30)
    assert path.points() == [(float(k), 2.0 * k, 3.0 * k, 4.0 * k) for k in range(30)]
    assert [t for t, *_ in path.points(every=7)] == [0.0, 7.0, 14.0, 21.0, 28.0]


@given(st.integers(0, 2000), st.integers(2, 50))
def test_a_long_one_is_thinned_evenly_and_keeps_its_beginning(count: int, most: int) -> None:
    times = [t for t, *_ in walked(count, most).points()]
    assert len(times) == len(walked(count, most)) <= most
    assert times[:1] == [0.0][:count]
    gaps = {b - a for a, b in itertools.pairwise(times)}
    assert len(gaps) <= 1
    # Half of what fits is there at least, and its end is not far behind.
    assert len(times) >= min(count, most // 2)
    assert all(count - 1 - times[-1] < gap for gap in gaps)


def test_cleared_it_begins_anew() -> None:
    path = walked(100, 10)
    path.clear()
    path.add(5.0, 1.0, 2.0, 3.0)
    path.add(6.0, 1.0, 2.0, 3.0)
    assert path.points() == [(5.0, 1.0, 2.0, 3.0), (6.0, 1.0, 2.0, 3.0)]
