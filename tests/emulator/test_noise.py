"""Noise is what Python's `random` draws."""

from __future__ import annotations

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from emulator.noise import Gaussian


@given(seed=st.integers(0, 2**32), sigmas=st.lists(st.floats(0.1, 20.0), max_size=9))
def test_the_values_are_those_that_python_draws(seed: int, sigmas: list[float]) -> None:
    drawn, expected = Gaussian(Random(seed)), Random(seed)
    assert [drawn.value(sigma) for sigma in sigmas] == [expected.gauss(0.0, sigma) for sigma in sigmas]
