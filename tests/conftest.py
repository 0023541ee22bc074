"""Hypothesis profiles: `ci` is derandomised and short, `dev` explores, `thorough` explores for long.

Chosen by `HYPOTHESIS_PROFILE`; in CI (the variable `CI` is set) the default is `ci`.
"""

from __future__ import annotations

import os

import pytest
from hypothesis import HealthCheck, settings

from hil.collector import collect_rarely

collect_rarely()

#: Runs of pytest within a test, for the plugin of this project.
pytest_plugins = ["pytester"]

settings.register_profile(
    "ci", derandomize=True, deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("dev", deadline=None)
settings.register_profile("thorough", deadline=None, max_examples=2000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci" if os.environ.get("CI") else "dev"))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--bad-day", type=float, default=0.0, metavar="SECONDS", help="each test of tests/bad_day goes on for so long"
    )


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The tests with a browser come first: they take longest, and in the end one process would be alone with them."""
    items.sort(key=lambda item: "browser" not in getattr(item, "fixturenames", ()))
