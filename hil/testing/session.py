"""A session of tests: the project's policy, and the findings of all tests in one report."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from emulator.c28x.coverage import Coverage
from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from emulator.rules import Severity
from hil.reports.baseline import Baseline
from hil.reports.html import write_html
from hil.reports.lcov import write_lcov
from hil.reports.model import Report, Run, merged_by
from hil.reports.policy import Policy
from hil.reports.sarif import write_sarif
from hil.testing import settings
from hil.testing.carrying import unpack
from hil.testing.case import Case, Key
from hil.testing.stash import SESSION


class ProjectSession:
    """The policy and baseline of the project in `folder`.  With `strict`, notes fail, too.

    `counted`: the coverage of the firmware in all tests is measured, in `coverage`.  Raises ValueError and OSError.
    """

    def __init__(self, folder: Path, *, strict: bool, counted: bool) -> None:
        policy = Policy.load(folder)
        self.policy = replace(policy, fail_on=Severity.NOTE) if strict else policy
        known = policy.baseline
        self.baseline = Baseline.read(known) if known is not None and known.is_file() else None
        self.coverage = Coverage() if counted else None
        #: The static findings that belong to an earlier test of this process.
        self.reported: set[Key] = set()

    def case(self, name: str) -> Case:
        """Begin a test."""
        return Case(name, self.policy, self.baseline, self.reported)

    def report(self, carried: Iterable[tuple[str, dict[str, Any]]]) -> Report:
        """The findings of all tests.  Each place comes once, with its count in all tests.

        `carried`: pairs of the test that showed a finding, and the finding as converted by `pack`.
        """
        found = merged_by((test, unpack(data)) for test, data in carried)
        return Report.of(
            [finding for finding, _ in found], run=Run("pytest", uncalibrated_factor=UNCALIBRATED_FACTOR),
            policy=self.policy, baseline=self.baseline, by=[tests for _, tests in found],
        )  # fmt: skip


def session_of(config: pytest.Config) -> ProjectSession:
    """The session of a pytest run.  It is created at its first use.  Raises ValueError and OSError."""
    if SESSION not in config.stash:
        counted = config.getoption("hil_lcov") is not None
        config.stash[SESSION] = ProjectSession(config.rootpath, strict=settings.strict(config), counted=counted)
    return config.stash[SESSION]


def write(
    report: Report, coverage: Coverage | None, *, sarif: Path | None, html: Path | None, lcov: Path | None
) -> list[str]:
    """Write the requested files.  Returns a line about each.  Raises OSError."""
    lines = []
    for path, writer in ((sarif, write_sarif), (html, write_html)):
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            writer(path, report)
            lines.append(f"{len(report.entries)} findings in {path}")
    if lcov is not None and coverage is not None:
        lcov.parent.mkdir(parents=True, exist_ok=True)
        write_lcov(lcov, coverage)
        count = len(coverage.files())
        lines.append(f"coverage of {count} file{'s' * (count != 1)} in {lcov}")
    return lines
