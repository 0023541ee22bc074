"""A campaign: short runs with random worlds, faults and orders, and requirements that must hold under every fault.

Each run is a scenario file, made from a seed and a number.  So `hil scenario` can repeat a failed run.  A failed run is
shortened before it is shown: orders, faults and seconds that the failure does not need are left out.

The requirements of the corrected robot, which depend on the faults:

* It never drives by a sensor that it can know to be dead, nor by orders of a silent link, and its frames say so
  (`HELD`).
* It stands when one of its tasks hangs: the watchdog has reset the chip.
* It stands when it was told to, if the order can arrive.
* No motor is driven against a wheel that is held, and a mission never hits an obstacle that its front sonar has heard.

Left out: a flipped bit of memory, which may do anything; and a gyro with a wrong identity, which the firmware does not
read.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Generator, Iterator, Mapping
from concurrent.futures import Future, as_completed
from contextlib import closing, suppress
from dataclasses import dataclass, replace
from math import degrees
from pathlib import Path
from random import Random
from typing import Any, Final

from emulator.c28x.findings import Finding
from hil.faults.all import FAULTS
from hil.reports.model import Report, merged_by, report_of
from hil.reports.policy import Policy
from hil.scenarios import running
from hil.scenarios.scenario import load_scenario
from hil.workers import workers
from hil.world.geometry import within
from hil.world.maps import START_CLEARANCE_M, WorldMap, builtin_maps, load_map

#: The length of a run in s, the time when its fault begins, and the duration of the fault.
SECONDS: Final = (5.0, 9.0)
BEGINS_S: Final = (0.3, 2.5)
LASTS_S: Final = (0.5, 6.0)
#: The time in s between two references of a console.
REPEAT_S: Final = 0.4
#: A sonar's input.
_INPUTS: Final = ("A2", "A3", "A4")
_LEFT_OUT: Final = ("ram-bit-flip", "gyro-who-am-i")
#: One of these tasks hangs for a second in each turn, for the rest of the run.  Each begins a turn in every period.
_TASKS: Final = ("TaskUS", "TaskGYRO", "TaskSERVO", "TaskNAVIGATION", "TaskODO")
_HANGS: Final = "task-slow"
_FOREVER_US: Final = 1e6
#: The robot is on its way, and the watchdog armed, by then; after a hang it is not driven when this has passed: the
#: longest period (250 ms), the longest wait of a release (500 ms and a look), the watchdog (105 ms).
_ARMED_S: Final = 1.0
HANG_S: Final = 1.1
#: Within this time a stop is received and the wheels stand.
STOPS_S: Final = 0.5
#: A motor is driven against a held wheel for no longer than this: 16 periods of 25 ms, plus the time to detect it.
STALLED_S: Final = 1.0
#: Free room around a start, so that the robot can turn.
_ROOM_M: Final = 0.3


@dataclass(frozen=True, slots=True)
class Requirement:
    """A requirement while a fault lasts: from `after_s` after its begin, a robot in `mode` stands and sends `number`.

    `after_s` is the period of the task that detects it, one of TaskNAVIGATION and TaskSERVO (75 ms), and the wheels'
    0.2 s.
    """

    mode: str
    after_s: float
    number: int


#: Kind of a fault -> its requirement.  1: no distance, 4: gyro silent, 7: link silent (`single_faults.SEEN`).
HELD: Final[Mapping[str, Requirement]] = {
    "adc-dead": Requirement("mission", 0.7, 1),
    "adc-input-shorted": Requirement("mission", 0.7, 1),
    "gyro-miso-stuck": Requirement("mission", 0.4, 4),
    "gyro-select-lost": Requirement("mission", 0.4, 4),
    "serial-break": Requirement("tele", 3.2, 7),
    "serial-stall": Requirement("tele", 3.2, 7),
    "serial-byte-lost": Requirement("tele", 3.2, 7),
    "serial-bit-flipped": Requirement("tele", 3.2, 7),
    "radio-loss": Requirement("tele", 3.2, 7),
}
#: Faults that can stop frames or orders.
_OF_LINE: Final = ("serial-", "radio-", "oscillator-drift")
#: Faults after which the firmware does not read what the front sonar hears.
_OF_SONAR: Final = ("adc-",)


@dataclass(frozen=True, slots=True)
class FailedRun:
    """A run that broke a requirement: its number, what was seen, and the text of the shortest scenario."""

    number: int
    broken: tuple[str, ...]
    text: str


@dataclass(frozen=True, slots=True)
class Campaign:
    """The outcome of all runs: how many ended, which failed, and all findings, each with the runs that show it.

    Findings are those without `watch` and without a search of the source.
    """

    runs: int
    failed: tuple[FailedRun, ...]
    findings: tuple[tuple[Finding, tuple[str, ...]], ...]

    @property
    def report(self) -> Report:
        """The findings as every command reports them.  Raises ValueError for a wrong policy of the project."""
        return report_of([finding for finding, _ in self.findings], "campaign", [runs for _, runs in self.findings])


Table = dict[str, Any]


def drawn(seed: int, number: int, *, faithful: bool = False) -> Table:
    """The scenario of a number, as the table of its file."""
    random = Random(f"{seed}:{number}:campaign")
    seconds = round(random.uniform(*SECONDS), 1)
    mode = random.choice(("mission", "mission", "tele"))
    faults = [_fault(random, mode) for _ in range(random.choice((1, 1, 1, 2)))]
    table: Table = {
        "description": f"Run {number} of the campaign with seed {seed}",
        "world": random.choice(sorted(builtin_maps())),
        "start": {},
        "fixes": [] if faithful else ["all"],
        "seed": random.randrange(1000),
        "realistic": random.random() < 0.5,
        "xbee": any(fault["kind"].startswith("radio-") for fault in faults),
        "seconds": seconds,
        "orders": _orders(random, mode, seconds),
        "faults": faults,
    }
    if random.random() < 0.7:
        table["start"] = _start(random, load_map(table["world"]))
    if not table["start"]:
        del table["start"]
    return table


def _fault(random: Random, mode: str) -> Table:
    kinds = [name for name in FAULTS if name not in _LEFT_OUT]
    # Those of which something is known are drawn more often.
    name = random.choice([*kinds, *3 * [name for name, held in HELD.items() if held.mode == mode]])
    kind = FAULTS[name]
    at_s, for_s = (round(random.uniform(*bounds), 2) for bounds in (BEGINS_S, LASTS_S))
    fault: Table = {"kind": name, "at": at_s, "for_s": for_s}
    for parameter in kind.own:
        if name == _HANGS:
            fault |= {"at": max(at_s, _ARMED_S), "task": random.choice(_TASKS), "us": _FOREVER_US}
        elif parameter.name == "input":
            fault["input"] = random.choice(_INPUTS)
        elif parameter.name == "adc":
            fault["adc"] = "A"  # the robot uses no other
        elif parameter.name == "volts" and name == "adc-input-shorted":
            fault["volts"] = random.choice((0.0, 3.0))
        elif parameter.name == "level":
            fault["level"] = random.randrange(2)
        else:
            value = parameter.drawn(random)
            if isinstance(value, float):
                value = min(max(round(value, 3), parameter.low), parameter.high)
            fault[parameter.name] = value
    return fault


def _orders(random: Random, mode: str, seconds: float) -> list[str]:
    orders = [f"0:{mode}"]
    stop_s = round(random.uniform(1.0, seconds), 2) if random.random() < 0.3 else seconds
    if mode == "tele":
        v, w = random.choice((0.08, 0.15, 0.25)), random.choice((0.0, 0.0, -0.3, 0.3))
        times = [0.1 + n * REPEAT_S for n in range(int(stop_s / REPEAT_S))]
        orders += [f"{time_s:.2f}:set {v:g} {w:g}" for time_s in times if time_s < stop_s - 0.05]
    return [*orders, f"{stop_s:g}:stop"] if stop_s < seconds else orders


def _start(random: Random, world: WorldMap) -> Table:
    """A start pose with room around it; the map's own pose if none is found."""
    left, low, right, high = world.bounds()
    for _ in range(50):
        x_m, y_m = round(random.uniform(left, right), 2), round(random.uniform(low, high), 2)
        inside = not world.walls or within(x_m, y_m, world.walls)
        if inside and world.room(x_m, y_m) > max(_ROOM_M, START_CLEARANCE_M):
            return {"x_m": x_m, "y_m": y_m, "heading_deg": float(random.randrange(-180, 180, 5))}
    x_m, y_m, heading_rad = world.start
    return {"x_m": x_m, "y_m": y_m, "heading_deg": degrees(heading_rad)}


def expectations(table: Table) -> list[Table]:
    """The requirements of a run, which follow from its orders and faults."""
    found: list[Table] = [{"name": "no motor is driven against a wheel that stands", "quantity": "stalled_s",
                           "most": STALLED_S}]  # fmt: skip
    faults, seconds = table.get("faults", []), table["seconds"]
    mode = "tele" if any("tele" in order for order in table["orders"]) else "mission"
    times = [order.partition(":") for order in table["orders"]]
    stops_s = [float(time_s) for time_s, _, what in times if what == "stop"]
    line = [fault for fault in faults if fault["kind"].startswith(_OF_LINE)]
    if not any(fault["kind"].startswith(_OF_SONAR) for fault in faults):
        found.append({"name": "it drives into nothing that it heard", "quantity": "seen_hits", "most": 0})
    for stop_s in stops_s:
        if stop_s + STOPS_S < seconds and not any(_toward(fault) for fault in line):
            found.append({"name": "told to stand, it stands", "quantity": "driving", "most": 0,
                          "during": [round(stop_s + STOPS_S, 2), seconds]})  # fmt: skip
    for n, fault in enumerate(faults):
        if fault["kind"] == _HANGS and fault["at"] + HANG_S < seconds:
            found.append({"name": f"it is not driven when a task hangs ({n})", "quantity": "driving", "most": 0,
                          "during": [round(fault["at"] + HANG_S, 2), seconds]})  # fmt: skip
        held = HELD.get(fault["kind"])
        if held is None or held.mode != mode or (held.number == 7 and not _toward(fault)):
            continue
        if fault.get("rate", 1.0) < 1.0:
            continue
        first, last = fault["at"] + held.after_s, min(fault["at"] + fault["for_s"], seconds)
        if first >= last:
            continue
        during = [round(first, 2), round(last, 2)]
        name = f"it does not drive on {fault['kind']} ({n})"
        found.append({"name": name, "quantity": "driving", "most": 0, "during": during})
        # A frame comes every 250 ms; the number of another fault may stand in the place of this one's.
        stop_s = min([last, *stops_s])
        if len(faults) == 1 and stop_s - first > 0.8 and fault["kind"] != "radio-loss":
            found.append({"name": f"it tells {fault['kind']} ({n})", "frame": _frame(fault, held),
                          "during": [during[0], round(stop_s, 2)], "least": 1})  # fmt: skip
    return found


def _toward(fault: Table) -> bool:
    """Whether a fault keeps orders from the robot."""
    return bool(fault.get("direction", "to-chip") == "to-chip")


def _frame(fault: Table, held: Requirement) -> str:
    """A pattern for the frames that report a fault.  "No distance" is at the place of the distance that is missing."""
    if held.number != 1 or fault["kind"] == "adc-dead":
        return f"^#ODO (-?[0-9]+,){{3}}-{10 * held.number},"
    place = {"A3": 3, "A4": 4, "A2": 5}[fault["input"]]
    return f"^#ODO (-?[0-9]+,){{{place}}}-10(,|$)"


# Running


def text_of(table: Table) -> str:
    """The text of a scenario file, with its requirements."""
    lines = [f"{key} = {_toml(value)}" for key, value in table.items() if not _is_tables(value)]
    tables = {key: value for key, value in table.items() if _is_tables(value)} | {"expect": expectations(table)}
    for key, value in tables.items():
        for each in [value] if isinstance(value, dict) else value:
            heading = f"[{key}]" if isinstance(value, dict) else f"[[{key}]]"
            lines += ["", heading, *(f"{name} = {_toml(one)}" for name, one in each.items())]
    return "\n".join(lines) + "\n"


def _is_tables(value: Any) -> bool:
    return isinstance(value, dict) or (isinstance(value, list) and bool(value) and isinstance(value[0], dict))


def _toml(value: Any) -> str:
    """A value as TOML has it; texts and lists of them are written as JSON has them."""
    return json.dumps(value)


def broken(table: Table) -> tuple[str, ...]:
    """The broken requirements of a run, one sentence each."""
    return _judged(table)[0]


def _judged(table: Table) -> tuple[tuple[str, ...], tuple[Finding, ...]]:
    """The broken requirements of a run, and its findings."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"campaign{running.SUFFIX}"
        file.write_text(text_of(table), encoding="utf-8")
        scenario, _ = load_scenario(file, Policy())
    # An image that is not watched is faster.
    plain = replace(scenario, setup=replace(scenario.setup, watch=False, static=False))
    outcome = running.run(plain)
    (leg,) = outcome.legs
    # That a fault changes nothing in a short run is no failure.
    wrong = [check for check in leg.checks if not check.ok and not check.name.startswith("the fault")]
    found = [f"{check.name}: {check.seen}" for check in wrong]
    return (*([f"it stopped: {leg.stopped}"] if leg.stopped else []), *found), leg.findings


def shortest(table: Table) -> Table:
    """The smallest scenario that fails in the same way."""
    names = {sentence.partition(":")[0].partition(" (")[0] for sentence in broken(table)}
    changed = True
    while changed:
        changed = False
        for less in _less(table):
            if names & {sentence.partition(":")[0].partition(" (")[0] for sentence in broken(less)}:
                table, changed = less, True
                break
    return table


def _less(table: Table) -> Iterator[Table]:
    """Tables with a part removed, the largest part first."""
    for key in ("faults", "orders"):
        for n in range(len(table[key]) - 1, -1, -1):
            if len(table[key]) > 1:
                yield {**table, key: [*table[key][:n], *table[key][n + 1 :]]}
    if "start" in table:
        yield {key: value for key, value in table.items() if key != "start"}
    if table["realistic"]:
        yield {**table, "realistic": False}
    if table["world"] != "corridor":
        yield {key: value for key, value in table.items() if key != "start"} | {"world": "corridor"}
    if table["seconds"] > 2.0:
        yield {**table, "seconds": round(table["seconds"] - 1.0, 1)}


#: The outcome of a run: its number, its failure if it failed, its findings.
_Ran = tuple[int, FailedRun | None, tuple[Finding, ...]]


def _run(seed: int, number: int, faithful: bool) -> _Ran:
    table = drawn(seed, number, faithful=faithful)
    wrong, findings = _judged(table)
    if not wrong:
        return number, None, findings
    table = shortest(table)
    return number, FailedRun(number, broken(table), text_of(table)), findings


def campaign(
    runs: int, *, seed: int = 1, jobs: int = 1, faithful: bool = False,
    on_run: Callable[[FailedRun | None], object] = lambda failed: None,
) -> Campaign:  # fmt: skip
    """Run `runs` runs, `jobs` at a time; after Ctrl-C return those that have ended.  `on_run` is called as one ends."""
    ended: list[_Ran] = []
    with suppress(KeyboardInterrupt), closing(_each(runs, seed, jobs, faithful)) as each:
        for ran in each:
            ended.append(ran)
            on_run(ran[1])
    ended.sort(key=lambda ran: ran[0])
    failed = tuple(failed for _, failed, _ in ended if failed is not None)
    found = merged_by((f"run {number}", finding) for number, _, findings in ended for finding in findings)
    return Campaign(len(ended), failed, tuple(found))


def _each(runs: int, seed: int, jobs: int, faithful: bool) -> Generator[_Ran, None, None]:
    if jobs <= 1:
        for number in range(runs):
            yield _run(seed, number, faithful)
        return
    with workers(jobs) as pool:
        futures: list[Future[_Ran]] = [pool.submit(_run, seed, n, faithful) for n in range(runs)]
        for future in as_completed(futures):
            yield future.result()
