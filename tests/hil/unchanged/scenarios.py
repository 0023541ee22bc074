"""Runs of the port and of the specimens, each as plain data: digests, findings in order, task times.

Every run is in virtual time and seeded, so the data depend on nothing but the code.  A finding is a table:

    rule, how, object, declaration, message, value, details, task, count     as `Finding` has them
    cycles                                                                   time of the first occurrence, in cycles
    path                                                                     its places, innermost first

and a place is a list: file relative to the project's root with `/`, line, function, name of the C file.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any, Final

import emulator
from emulator.c28x.findings import Finding, Place
from emulator.clock import SYSCLK_HZ
from firmware_model.image import link
from hil.audit.compare.ours import PROPERTIES, RUN_S
from hil.audit.compare.specimen import SPECIMENS, Specimen
from hil.bench import Bench
from hil.client.orders import parse_order, parse_timed_order
from hil.machine import FirmwareStopped, Setup
from hil.pacing import Pacer
from hil.robot.board import RobotBoard
from hil.scenarios.scenario import Scenario
from hil.session import Session
from tests.emulator.c28x.specimens import Pair
from tests.emulator.c28x.test_specimens import PAIRS, run

#: The project that is tested: what the files of findings are relative to.
ROOT: Final = Path(emulator.__file__).resolve().parents[1]

#: What a scenario gives: nothing but dicts, lists, texts and numbers.
Data = dict[str, Any]


def place_data(place: Place) -> list[Any]:
    """A place as [file, line, function, C file]; a file outside the project keeps its name only."""
    file = Path(place.file)
    inside = file.is_absolute() and file.resolve().is_relative_to(ROOT)
    name = file.resolve().relative_to(ROOT).as_posix() if inside else file.name
    return [name, place.line, place.function, place.c_file]


def plain(text: str) -> str:
    """A text with the files that it names relative to the project's root."""
    return text.replace(f"{ROOT}{os.sep}", "")


def finding_data(finding: Finding) -> Data:
    """A finding with all that a reader of a report sees.  Its value is a text, so that nan equals nan."""
    return {
        "rule": finding.rule,
        "how": finding.how,
        "object": finding.object,
        "declaration": plain(finding.declaration),
        "message": plain(finding.message),
        "value": repr(finding.value) if isinstance(finding.value, int | float | str) else "",
        "details": [plain(text) for text in finding.details],
        "task": finding.task,
        "count": finding.count,
        "cycles": finding.time_cycles,
        "path": [place_data(place) for place in finding.call_path],
    }


def findings_data(findings: Iterable[Finding]) -> list[Data]:
    """Findings in their order."""
    return [finding_data(finding) for finding in findings]


class _Events:
    """A digest of the kernel's events of its own, beside the one that `hil run` prints."""

    def __init__(self, bench: Bench) -> None:
        self.count = 0
        self._sha = hashlib.sha256()
        bench.board.trace.listen(self._add)

    def _add(self, cycles: int, kind: str, name: str) -> None:
        self.count += 1
        self._sha.update(f"{cycles} {kind} {name}\n".encode())

    @property
    def sha256(self) -> str:
        return self._sha.hexdigest()


def _outcome(bench: Bench, events: _Events, stopped: str) -> Data:
    status = bench.status()
    return {
        "uart_sha256": bench.uart_sha256,
        "trace_sha256": bench.trace_sha256,
        "events": events.count,
        "events_sha256": events.sha256,
        "cycles": bench.clock.now,
        "state": status.state,
        "pose": repr((status.x_m, status.y_m, status.heading_rad)),
        "distances_cm": repr(status.distances_cm),
        "stopped": plain(stopped),
        "findings": findings_data(bench.findings),
    }


def robot(setup: Setup, length_s: int, *orders: str) -> Data:
    """What `hil run` runs: `orders` at the end of start-up, then `length_s` seconds with a short digest of each.

    `each_second` tells in which second two runs part.
    """
    bench = Bench(setup)
    events = _Events(bench)
    each_second, stopped = [], ""
    with closing(bench):
        try:
            bench.boot()
            for order in orders:
                bench.feed(parse_order(order))
            for _ in range(length_s):
                bench.run_for(1.0)
                each_second.append(f"{bench.uart_sha256[:8]} {events.sha256[:8]}")
        except FirmwareStopped as reason:
            stopped = str(reason)
        return {"each_second": each_second, **_outcome(bench, events, stopped)}


def checked(setup: Setup, length_s: float, *orders: str) -> Data:
    """What `hil check` runs: every detector on."""
    scenario = Scenario(setup, length_s, orders)
    bench = Bench(scenario.setup)
    events = _Events(bench)
    with closing(bench):
        stopped = scenario.run(bench)
        return _outcome(bench, events, stopped)


def task_times(length_s: float, *orders: str) -> Data:
    """What `hil tasks` prints, to the last digit."""
    bench = Bench(Setup())
    with closing(bench):
        bench.boot()
        bench.measure_tasks()
        Session(bench, None, Pacer(None), orders=[parse_timed_order(order) for order in orders]).run(length_s)
        use = bench.task_statistics()
    times = [asdict(task) for task in use.tasks]
    return {
        "cpu_load": repr(use.cpu_load),
        "tasks": {row["task"]: {key: repr(value) for key, value in row.items() if key != "task"} for row in times},
    }


class _Enough(Exception):
    """A specimen has come to where it would never end."""


def comparison_specimens() -> Data:
    """The specimens of `hil audit --compare`: findings up to the one they are there for, or their property."""
    return {specimen.name: _compared(specimen) for specimen in SPECIMENS}


def _compared(specimen: Specimen) -> Data:
    board = RobotBoard()
    firmware = link(board, modules=(specimen.module,), watch=True, static=True)
    line = specimen.line(".py")

    def look(finding: Finding) -> None:
        if finding.rule == specimen.rule and any(place.line == line for place in finding.call_path):
            raise _Enough

    result = ""
    if specimen.name in PROPERTIES:
        evidence = PROPERTIES[specimen.name](firmware)
        result = f"{evidence.line}, {'seen' if evidence.seen else 'not seen'}"
    elif specimen.kernel:
        board.kernel.start(firmware.function(f"{specimen.name}.run"))
        board.kernel.run_until(round(RUN_S * SYSCLK_HZ))
        board.kernel.shutdown()
    else:
        board.findings.found.connect(look)
        try:
            result = repr(getattr(firmware, specimen.name).run())
        except _Enough:
            result = "stopped at the finding"
    return {"result": result, "findings": findings_data(board.findings)}


#: Rules that are younger than the record: their specimens are not in it, and nothing else may break them.
YOUNGER: Final = frozenset({"called-as-another", "poll-not-volatile"})


def language_specimens() -> Data:
    """The specimens of `tests/emulator/c28x`: the defect with every detector, and as it runs without."""
    recorded = [pair for pair in PAIRS if pair.rule not in YOUNGER]
    return {pair.id: {"all": _specimen(pair, static=True, watch=True), "checked": _specimen(pair)} for pair in recorded}


def _specimen(pair: Pair, **options: bool) -> Data:
    shop, results = run(pair, pair.defect, **options)
    shown = [repr(result) if isinstance(result, int | float) else type(result).__name__ for result in results]
    return {"results": shown, "cycles": shop.clock.now, "findings": findings_data(shop.findings)}


#: The setup of `hil check`.
WATCHED: Final = Setup(watch=True, static=True)

#: By the name of the file that each is recorded in.
SCENARIOS: Final[Mapping[str, Callable[[], Data]]] = {
    **{
        f"mission {devices} {seed}": partial(robot, Setup(seed=seed, realistic=devices == "realistic"), 20, "mission")
        for seed in (0, 3)
        for devices in ("ideal", "realistic")
    },
    "standing ideal": partial(robot, Setup(realistic=False), 5),
    "standing realistic": partial(robot, Setup(), 5),
    "telemanipulation in the room": partial(robot, Setup(world="room", xbee=True), 5, "tele", "set 0.2 0.3"),
    "mission nr": partial(robot, Setup(divide="nr"), 3, "mission"),
    "mission fixed": partial(robot, Setup(fixes=("all",)), 5, "mission"),
    **{
        f"fill {fill.replace(':', ' ')}": partial(robot, Setup(fill=fill), 3, "mission")
        for fill in ("zero", "ones", "random:7", "stack", "nan", "trap")
    },
    "check mission": partial(checked, WATCHED, 3, "0:mission"),
    "check mission ideal": partial(checked, replace(WATCHED, realistic=False, seed=0), 3, "0:mission"),
    "check telemanipulation": partial(
        checked, replace(WATCHED, seed=3), 3, "0:tele", "0.5:set 0.2 0.3", "1.5:calibrate"
    ),
    "check stack": partial(checked, replace(WATCHED, fill="stack"), 2, "0:mission"),
    "check fixed": partial(checked, replace(WATCHED, fixes=("all",)), 3, "0:mission"),
    "task times standing": partial(task_times, 10),
    "task times mission": partial(task_times, 10, "0:mission"),
    "comparison specimens": comparison_specimens,
    "language specimens": language_specimens,
}
