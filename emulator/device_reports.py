"""Turns reports of devices into findings of a board.

The place is the statement that executes, or the call that made both accesses."""

from __future__ import annotations

from typing import Any

from emulator.c28x.findings import Finding, Findings
from emulator.c28x.sites import Place
from emulator.devices.report import Mark, shared


class Reports:
    """Reports of devices as findings of a board."""

    __slots__ = ("_findings",)

    def __init__(self, findings: Findings) -> None:
        self._findings = findings

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None,
        cause: Any = None,
    ) -> Finding:  # fmt: skip
        """Record it at the statement that executes, at the one that made both accesses, or at its cause."""
        findings = self._findings
        if since:
            path = self._path_of_both(since)
            cause = findings.cause
            if cause is not None:
                begun = findings.path(cause.at, cause.calls)
                if len(begun) == len(path):
                    path = begun  # The statement before the wait in which the access ended.
            if path:
                return findings.report_at(
                    path[0], rule, message, object=object, value=value, how="dynamic", call_path=path
                )
        return findings.report(rule, message, object=object, value=value, cause=cause)

    def mark(self) -> Mark:
        """The calls of the firmware now."""
        return self._findings.position.calls or ()

    def _path_of_both(self, earlier: Mark) -> tuple[Place, ...]:
        """The call path from the innermost call that made both accesses outwards; empty if there is none."""
        position = self._findings.position
        both = shared(earlier, position.calls or ())
        if not both:
            return ()
        at, calls = position.at, position.calls
        while calls is not None and calls is not both:
            at, calls = calls[0], calls[1]
        return self._findings.path(at, calls)
