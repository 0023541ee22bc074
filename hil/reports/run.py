"""Makes the `Run` of a report from a bench that has run."""

from __future__ import annotations

from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from emulator.clock import seconds
from hil.bench import Bench
from hil.reports.model import DrivenTrack, Run
from hil.scenarios.scenario import Scenario


def run_of(scenario: Scenario, bench: Bench, stopped: str) -> Run:
    """The run of `scenario` on `bench`, to its end or until it `stopped`."""
    outcome = {"uart_sha256": bench.uart_sha256}
    return Run(
        scenario.name, scenario.setup, seconds(bench.clock.now), scenario.orders, stopped, outcome,
        uncalibrated_factor=UNCALIBRATED_FACTOR if scenario.setup.firmware else None,
        faults=tuple(mounted.report() for mounted in bench.faults),
    )  # fmt: skip


def drive_of(bench: Bench) -> DrivenTrack:
    """The true path of the robot, and its odometry."""
    return DrivenTrack(bench.walls, bench.posts, bench.true_path(), bench.odometry_path())
