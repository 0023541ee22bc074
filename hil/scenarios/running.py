"""Runs and judges a scenario: with its corrections, and again without those of the defects that it shows."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ, seconds
from hil.files import replacing
from hil.machine import FirmwareStopped
from hil.reports.excerpt import relative_path
from hil.reports.json_report import findings_of
from hil.reports.model import report_of
from hil.reports.policy import Policy
from hil.scenarios.expectation import Check, ExpectationWatch
from hil.scenarios.scenario import Scenario, load_scenario
from hil.scenarios.script import ScriptFailed
from hil.workers import workers

if TYPE_CHECKING:
    from hil.bench import Bench

SHIPPED: Final = Path(__file__).parent / "shipped"
SUFFIX: Final = ".scenario.toml"


@dataclass(frozen=True, slots=True)
class ScenarioRun:
    """One run: its corrections, the reason of an early end, the verdicts, and the digest of its line."""

    fixes: tuple[str, ...]
    stopped: str
    checks: tuple[Check, ...]
    virtual_s: float
    uart_sha256: str
    findings: tuple[Finding, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain data.  Raises ValueError for a wrong policy of the project."""
        return {
            "fixes": list(self.fixes), "stopped": self.stopped, "checks": [check.as_dict() for check in self.checks],
            "virtual_s": self.virtual_s, "uart_sha256": self.uart_sha256,
            "findings": findings_of(report_of(self.findings)),
        }  # fmt: skip


@dataclass(frozen=True, slots=True)
class ScenarioOutcome:
    """The outcome of a scenario."""

    name: str
    file: str
    description: str
    thesis: str
    legs: tuple[ScenarioRun, ...]
    #: Entries of the catalogue whose corrections the second leg is without; none: without any.
    defects: tuple[str, ...] = ()
    #: Names of what must fail in the second leg.
    faithful_fails: tuple[str, ...] = ()

    @property
    def failures(self) -> list[str]:
        """The differences from the file, each as a sentence."""
        found = []
        corrected = self.legs[0]
        if corrected.stopped:
            found.append(f"it stopped: {corrected.stopped}")
        found += [f"{check.name}: {check.seen}" for check in corrected.checks if not check.ok]
        for leg in self.legs[1:]:
            for check in leg.checks:
                if check.ok and check.name in self.faithful_fails:
                    found.append(f"{check.name}: came true without the corrections: {check.seen}")
                elif not check.ok and check.name not in self.faithful_fails:
                    found.append(f"{check.name}: fails without the corrections, which the file does not say: "
                                 f"{check.seen}")  # fmt: skip
            if leg.stopped and not self.faithful_fails:
                found.append(f"without the corrections, the firmware stopped: {leg.stopped}")
        return found

    @property
    def passed(self) -> bool:
        """Whether everything is as the file expects."""
        return not self.failures

    def as_dict(self) -> dict[str, Any]:
        """Plain data.  Raises ValueError for a wrong policy of the project."""
        return {
            "name": self.name, "file": relative_path(self.file), "passed": self.passed, "failures": self.failures,
            "description": self.description, "thesis": self.thesis, "defects": list(self.defects),
            "runs": [leg.as_dict() for leg in self.legs],
        }  # fmt: skip


def shipped() -> list[Path]:
    """The scenarios that come with the tool."""
    return sorted(SHIPPED.glob(f"*{SUFFIX}"))


def run_file(path: Path, *, progress: Callable[[float], None] = lambda fraction: None) -> ScenarioOutcome:
    """Run a scenario file.  Raises ValueError, OSError for a file that cannot be used."""
    scenario, _ = load_scenario(path, Policy())
    return run(scenario, str(path), progress=progress)


def run(
    scenario: Scenario, file: str = "", *, progress: Callable[[float], None] = lambda fraction: None
) -> ScenarioOutcome:
    """Run a scenario and judge it."""
    count = 2 if scenario.faithful_fails else 1
    legs = [_leg(scenario, lambda fraction: progress(fraction / count), scenario.outputs.plot, scenario.outputs.path)]
    if scenario.faithful_fails:
        legs.append(_leg(scenario.uncorrected(), lambda fraction: progress((1.0 + fraction) / 2)))
    outcome = ScenarioOutcome(
        scenario.name, file, scenario.description, scenario.thesis, tuple(legs), scenario.defects,
        scenario.faithful_fails,
    )  # fmt: skip
    if scenario.outputs.json:
        with replacing(scenario.outputs.json) as new:
            new.write_text(json.dumps(outcome.as_dict(), indent=2) + "\n", encoding="utf-8")
    return outcome


def _leg(scenario: Scenario, progress: Callable[[float], None], plot: str = "", path: str = "") -> ScenarioRun:
    with closing(scenario.bench()) as bench:
        stopped = ""
        watching = None
        failed: list[Check] = []
        try:
            bench.boot()
            watching = ExpectationWatch(bench, scenario.expectations)
            scenario.drive(bench, progress=progress)
        except FirmwareStopped as reason:
            stopped = f"{reason} at {seconds(bench.clock.now):.6f} s"
        except ScriptFailed as reason:
            failed.append(Check("script", False, str(reason)))
        # Without a start-up nothing can have come true.
        checks = watching.checks() if watching else [Check(e.name, False, stopped) for e in scenario.expectations]
        for mounted in bench.faults:
            fired = mounted.report()
            checks.append(Check(f"the fault {fired.fault.kind.name} fires", bool(fired.count), str(fired)))
        if plot:
            _plot(Path(plot), bench, scenario)
        if path:
            rows = (f"{p.time_s:.6f},{p.x_m:.6f},{p.y_m:.6f},{p.heading_rad:.6f}" for p in bench.true_path())
            with replacing(path) as new:
                new.write_text("\n".join(("time_s,x_m,y_m,heading_rad", *rows)) + "\n", encoding="utf-8")
        return ScenarioRun(
            scenario.setup.fixes, stopped, (*checks, *failed), bench.clock.now / SYSCLK_HZ, bench.uart_sha256,
            tuple(bench.findings),
        )  # fmt: skip


def _plot(path: Path, bench: Bench, scenario: Scenario) -> None:
    from hil.client.plot import check_plot_file, place, plot_drive

    check_plot_file(path)
    true_path = bench.true_path()
    start = true_path[0]
    believed = [(point.x_m, point.y_m) for point in bench.odometry_path()]
    plot_drive(
        path, odometry=place(believed, start.x_m, start.y_m, start.heading_rad), cloud=[],
        true_path=[(point.x_m, point.y_m) for point in true_path], walls=bench.walls, posts=bench.posts,
        title=scenario.name,
    )  # fmt: skip


def run_files(
    paths: Sequence[Path], *, jobs: int = 1, on_file: Callable[[int], None] = lambda index: None,
    progress: Callable[[int, float], None] = lambda index, fraction: None,
) -> Iterator[ScenarioOutcome]:  # fmt: skip
    """Run files, `jobs` at a time, each in a process of its own if there are several; outcomes have the files' order.

    `on_file` is called when a file has ended, in any order.  Raises ValueError, OSError as `run_file`.
    """
    if jobs <= 1 or len(paths) <= 1:
        for index, path in enumerate(paths):
            outcome = run_file(path, progress=lambda fraction, index=index: progress(index, fraction))  # type: ignore[misc]
            on_file(index)
            yield outcome
        return
    with workers(jobs) as pool:
        futures: list[Future[ScenarioOutcome]] = [pool.submit(run_file, path) for path in paths]
        for index, future in enumerate(futures):
            future.add_done_callback(lambda _future, index=index: on_file(index))  # type: ignore[misc]
        for future in futures:
            yield future.result()
