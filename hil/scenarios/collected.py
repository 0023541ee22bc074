"""Scenario files as pytest items: each file is a test."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from hil.scenarios.running import SUFFIX, ScenarioOutcome, run_file


class ScenarioFailed(Exception):
    """A run does not give what the file expects."""

    def __init__(self, outcome: ScenarioOutcome) -> None:
        super().__init__("\n".join(outcome.failures))


class ScenarioFile(pytest.File):
    """A `*.scenario.toml` file."""

    def collect(self) -> Iterator[pytest.Item]:
        """Collect its one test."""
        yield ScenarioItem.from_parent(self, name=self.path.name.removesuffix(SUFFIX))


class ScenarioItem(pytest.Item):
    """A scenario, which is run and judged."""

    def runtest(self) -> None:
        """Run the scenario."""
        outcome = run_file(self.path)
        if not outcome.passed:
            raise ScenarioFailed(outcome)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Say what differs from the file, or what is wrong in it, without a traceback."""
        if isinstance(excinfo.value, ScenarioFailed | ValueError | OSError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Any, int | None, str]:
        """The path of the file."""
        return self.path, None, f"scenario {self.name}"
