"""Specimens: small drivers with one defect each, each beside the same driver without it.

The line where the finding must stand carries the mark `# <-`.  A correct specimen must be silent, notes included, and
must give the same results checked, fast, watched, and under every fill.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

MARK: Final = "# <-"


@dataclass(frozen=True)
class Pair:
    """One defect: `rule` must be found at the marked line of `defect`, and nothing in `correct`."""

    rule: str
    name: str
    calls: tuple[tuple[str, tuple[float, ...]], ...]
    defect: str
    correct: str
    how: str = "dynamic"
    #: Whether the rule needs an image that is watched.
    watch: bool = False

    @property
    def id(self) -> str:
        """Name of the test."""
        return f"{self.rule}: {self.name}"


def static_pair(rule: str, name: str, defect: str, correct: str, *calls: tuple[str, tuple[float, ...]]) -> Pair:
    """A pair whose finding is static."""
    return Pair(rule, name, calls, defect, correct, how="static")


@dataclass(frozen=True)
class Driver:
    """A correct driver: what `function` returns for each tuple of arguments."""

    name: str
    function: str
    results: tuple[tuple[tuple[float, ...], float], ...]
    source: str
