"""Scenario files as pytest sees them: a test a file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from hil.scenarios.running import SUFFIX, ScenarioOutcome, run_file


class ScenarioFailed(Exception):
    """Something is not as the file says."""

    def __init__(self, outcome: ScenarioOutcome) -> None:
        super().__init__("\n".join(outcome.failures))


class ScenarioFile(pytest.File):
    """A `*.scenario.toml`."""

    def collect(self) -> Iterator[pytest.Item]:
        """Its one test."""
        yield ScenarioItem.from_parent(self, name=self.path.name.removesuffix(SUFFIX))


class ScenarioItem(pytest.Item):
    """A scenario, run and judged."""

    def runtest(self) -> None:
        """Run it."""
        outcome = run_file(self.path)
        if not outcome.passed:
            raise ScenarioFailed(outcome)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """What is not as the file says, or what is wrong in the file; no traceback of ours."""
        if isinstance(excinfo.value, ScenarioFailed | ValueError | OSError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Any, int | None, str]:
        """Where it stands."""
        return self.path, None, f"scenario {self.name}"
