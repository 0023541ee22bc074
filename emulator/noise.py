"""Normally distributed noise."""

from __future__ import annotations

from math import cos, log, sin, sqrt, tau
from random import Random


class Gaussian:
    """Draws the values of `random.gauss(0.0, sigma)`, in half its time."""

    __slots__ = ("_drawn", "_second", "_uniform")

    def __init__(self, random: Random) -> None:
        self._uniform = random.random
        #: Values are drawn in pairs: the second one for a sigma of 1, and whether it is still to come.
        self._second = 0.0
        self._drawn = False

    def value(self, sigma: float) -> float:
        """The next value."""
        if self._drawn:
            self._drawn = False
            return self._second * sigma
        turn = self._uniform() * tau
        radius = sqrt(-2.0 * log(1.0 - self._uniform()))
        self._second = sin(turn) * radius
        self._drawn = True
        return cos(turn) * radius * sigma
