"""A scenario: a robot in a world, its orders for some seconds, and the expectations (keys: `keys.py`)."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.coverage import Coverage
from emulator.clock import SYSCLK_HZ, seconds
from hil.board import load
from hil.client.orders import parse_order, parse_timed_order
from hil.faults import Fault, parse
from hil.faults.when import check as check_when
from hil.files import parse_toml, read_text
from hil.machine import FirmwareStopped, Machine, Setup
from hil.reports.policy import Policy
from hil.robot.options.names import OPTIONS
from hil.scenarios import lines, script
from hil.scenarios.expectation import Expectation, ExpectationWatch
from hil.scenarios.keys import Problem, check
from hil.world.maps import START_CLEARANCE_M, WorldMap, load_map

if TYPE_CHECKING:
    from hil.bench import Bench

#: Keys of a file that are the setup's.
_SETUP: Final = ("world", "seed", "fill", "realistic", "xbee", "divide", "float_division")
_LISTS: Final = ("fixes", "defines", "options", "put")
#: No scenario that somebody writes is larger.
_MAX_BYTES: Final = 1 << 20
_POLICY: Final = ("baseline", "fail_on", "severity")
DEFAULT_SECONDS: Final = 10.0


@dataclass(frozen=True, slots=True)
class GroundOptions:
    """Properties of the world that a scenario sets in place of its map; None: as in the map."""

    start: tuple[float, float, float] | None = None
    grip: float | None = None
    slip: tuple[float, float] | None = None

    def of(self, world: WorldMap) -> WorldMap:
        """A map with these properties."""
        if self.start is not None:
            room = world.room(self.start[0], self.start[1])
            if room < START_CLEARANCE_M:
                raise Problem(("start",), f"{room:.3f} m from a wall or post, {START_CLEARANCE_M} m must be free")
        return replace(
            world, start=self.start or world.start, grip=world.grip if self.grip is None else self.grip,
            slip=world.slip if self.slip is None else self.slip,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class OutputFiles:
    """The files that a run writes."""

    plot: str = ""
    json: str = ""
    path: str = ""


@dataclass(frozen=True, slots=True)
class Scenario:
    """The declaration of a run.  `orders` have the form of `hil run --order`, with times after start-up."""

    setup: Setup = field(default_factory=lambda: Setup(watch=True, static=True))
    seconds: float = DEFAULT_SECONDS
    orders: tuple[str, ...] = ("mission",)
    name: str = "mission"
    #: Orders that are given when something has happened: what (`hil.faults.when`), and the order.
    when: tuple[tuple[str, str], ...] = ()
    ground: GroundOptions = GroundOptions()
    #: Path of the Python file that drives it too.
    script: str = ""
    expectations: tuple[Expectation, ...] = ()
    #: Entries of the catalogue that it shows.
    defects: tuple[str, ...] = ()
    #: Names of expectations that do not come true without their corrections.
    faithful_fails: tuple[str, ...] = ()
    outputs: OutputFiles = OutputFiles()
    description: str = ""
    thesis: str = ""

    def __post_init__(self) -> None:
        if not 0 < self.seconds < float("inf"):
            raise ValueError(f"seconds {self.seconds!r}: must be more than 0")
        for order in self.orders:
            parse_timed_order(order)
        for trigger, order in self.when:
            check_when(trigger)
            parse_order(order)

    def with_fill(self, fill: str) -> Scenario:
        """The same scenario with another fill."""
        return replace(self, setup=replace(self.setup, fill=fill))

    def uncorrected(self) -> Scenario:
        """The same scenario without the corrections of `defects`; without any if it names none."""
        left: frozenset[str] = frozenset()
        project = load(self.setup.board).project
        if self.defects and project is not None:
            left = project.corrections(self.setup.fixes) - set(self.defects)
        return replace(self, setup=replace(self.setup, fixes=tuple(sorted(left))))

    def world_map(self) -> WorldMap:
        """The world's map, with the properties that the scenario sets."""
        return self.ground.of(load_map(self.setup.world))

    def bench(self, coverage: Coverage | None = None, *, traced: bool = False, replaceable: bool = False) -> Bench:
        """The robot of this scenario, not booted yet; the arguments are those of `Bench`."""
        from hil.bench import Bench

        return Bench(self.setup, traced=traced, coverage=coverage, replaceable=replaceable, **self.read())

    def read(self) -> dict[str, Any]:
        """The options of `Bench` for its robot, besides the setup."""
        return {
            "world_map": self.world_map(),
            "awaited": [(trigger, parse_order(order)) for trigger, order in self.when],
        }

    def run(self, bench: Bench, *, progress: Callable[[float], None] = lambda fraction: None) -> str:
        """Boot `bench` and give it its orders for the scenario's time.  Returns the reason of an early end, or an
        empty text."""
        try:
            bench.boot()
            self.drive(bench, progress=progress)
        except FirmwareStopped as reason:
            return f"{reason} at {seconds(bench.clock.now):.6f} s"
        return ""

    def watched(self, bench: Machine) -> ExpectationWatch:
        """Begin to watch a bench that has booted; the caller drives it."""
        from hil.bench import Bench

        assert isinstance(bench, Bench)
        return ExpectationWatch(bench, self.expectations)

    def drive(self, bench: Bench, *, progress: Callable[[float], None] = lambda fraction: None) -> None:
        """Give a bench that has booted its orders for the scenario's time.  Raises FirmwareStopped."""
        start = bench.clock.now
        end = start + round(self.seconds * SYSCLK_HZ)
        orders = deque(sorted((parse_timed_order(order) for order in self.orders), key=lambda o: o.time_s))
        if self.script:
            # A script lets time pass itself: orders come when they are due, whoever runs the bench.
            for timed in orders:
                bench.clock.schedule(start + round(timed.time_s * SYSCLK_HZ), partial(bench.feed, timed.data))
            orders.clear()
            script.run(self.script, bench)
        while bench.clock.now < end:
            while orders and start + round(orders[0].time_s * SYSCLK_HZ) <= bench.clock.now:
                bench.feed(orders.popleft().data)
            due = start + round(orders[0].time_s * SYSCLK_HZ) if orders else end
            bench.run_until(min(end, due, bench.clock.now + SYSCLK_HZ // 5))
            progress(int(bench.clock.now - start) / int(end - start))


def load_scenario(path: Path, policy: Policy) -> tuple[Scenario, Policy]:
    """Load a scenario from a TOML file, and `policy` with the severities, baseline and threshold of the file.

    Raises ValueError with file, line and key for an unknown key or value; OSError if the file cannot be read.
    """
    content = read_text(path, most=_MAX_BYTES)
    table = parse_toml(content, str(path))
    try:
        check(table)
        return _from_table(table, path), _policy(table, path, policy)
    except Problem as problem:
        raise lines.located(problem, content, str(path)) from None


def _policy(table: Mapping[str, Any], path: Path, policy: Policy) -> Policy:
    return policy.changed({key: table[key] for key in _POLICY if key in table}, path.parent)


def _from_table(table: Mapping[str, Any], path: Path) -> Scenario:
    """Create the scenario of a checked table.  Raises Problem for errors that only loading shows."""
    setup: dict[str, Any] = {"watch": True, "static": True}
    scenario: dict[str, Any] = {"name": path.name.removesuffix(".toml").removesuffix(".scenario")}
    for key, value in table.items():
        if key in _SETUP:
            setup[key] = int(value) if key == "seed" else value
        elif key in _LISTS:
            setup[key] = tuple(value)
        elif key in ("firmware", "include"):
            setup[key] = tuple(str(path.parent / text) for text in value)
        elif key == "orders":
            scenario[key] = _orders(value)
        elif key in ("defects", "faithful_fails"):
            scenario[key] = tuple(value)
        elif key == "faults":
            setup[key] = _faults(value)
        elif key == "feed":
            setup["feeds"] = tuple(_feed(entry, path.parent, index) for index, entry in enumerate(value))
        elif key == "order":
            scenario["when"] = tuple(_when(entry, index) for index, entry in enumerate(value))
        elif key == "seconds":
            scenario[key] = float(value)
        elif key in ("description", "thesis"):
            scenario[key] = value
    for key, value in (("world", table.get("world", "")), ("board", table.get("board", ""))):
        if (path.parent / value).is_file():
            setup[key] = str(path.parent / value)
    scenario["ground"] = _ground(table)
    scenario["outputs"] = OutputFiles(**table.get("outputs", {}))
    if "script" in table:
        scenario["script"] = str(path.parent / table["script"])
        if not Path(scenario["script"]).is_file():
            raise Problem(("script",), f"there is no file {scenario['script']}")
    expectations = []
    for index, entry in enumerate(table.get("expect", [])):
        try:
            expectations.append(Expectation.of_table(entry))
        except ValueError as error:
            raise Problem(("expect", index), str(error)) from None
        if expectations[-1].name in {each.name for each in expectations[:-1]}:
            raise Problem(("expect", index, "name"), f"{expectations[-1].name!r} is the name of another one")
    names = [each.name for each in expectations]
    for name in scenario.get("faithful_fails", ()):
        if name not in names:
            raise Problem(("faithful_fails",), f"no expectation {name!r}: there are {', '.join(names) or 'none'}")
    made = Scenario(setup=Setup(**setup), expectations=tuple(expectations), **scenario)
    _check_setup(made)
    return made


def _orders(value: list[str]) -> tuple[str, ...]:
    for index, text in enumerate(value):
        try:
            parse_timed_order(text)
        except ValueError as error:
            raise Problem(("orders", index), str(error)) from None
    return tuple(value)


def _faults(value: list[Any]) -> tuple[str, ...]:
    """Faults from texts as in `hil run --fault`, or from tables."""
    found = []
    for index, each in enumerate(value):
        try:
            found.append(str(Fault.from_table(each) if isinstance(each, dict) else parse(each)))
        except ValueError as error:
            raise Problem(("faults", index), str(error)) from None
    return tuple(found)


def _feed(entry: Mapping[str, Any], folder: Path, index: int) -> str:
    """A feed as a text of `hil run --feed`."""
    name, column = entry.get("input", ""), entry.get("column", "")
    what = next((key for key in ("value", "values", "column") if key in entry), None)
    if not name and what:
        raise Problem(("feed", index), f"input is missing: name the input that sees the {what}")
    if "value" in entry:
        return f"{name}={float(entry['value'])!r}"
    if "values" in entry:
        values = entry["values"]
        for place, (before, after) in enumerate(pairwise(values), 1):
            if after[0] < before[0]:
                raise Problem(("feed", index, "values", place), f"{after} after {before}: the time decreases")
        return f"{name}={json.dumps(values)},{entry.get('how', 'hold')}"
    file = folder / entry["file"]
    if not file.is_file():
        raise Problem(("feed", index, "file"), f"there is no file {file}")
    source = f"{file}{f'#{column}' if column else ''},{entry.get('how', 'hold')}"
    return f"{name}={source}" if name else source


def _when(entry: Mapping[str, str], index: int) -> tuple[str, str]:
    try:
        check_when(entry["when"])
        if not entry["when"].strip():
            raise ValueError("nothing to wait for: ")
    except ValueError as error:
        raise Problem(("order", index, "when"), str(error).removeprefix("when: ")) from None
    return entry["when"], entry["send"]


def _ground(table: Mapping[str, Any]) -> GroundOptions:
    start, floor = table.get("start"), table.get("floor", {})
    pose = None
    if start is not None:
        pose = (float(start["x_m"]), float(start["y_m"]), radians(start.get("heading_deg", 0.0)))
    slip = None
    if "slip_left" in floor or "slip_right" in floor:
        slip = (float(floor.get("slip_left", 0.0)), float(floor.get("slip_right", 0.0)))
    return GroundOptions(pose, floor.get("grip"), slip)


def _check_setup(scenario: Scenario) -> None:
    """Raise Problem for an unknown world, start or correction."""
    for option in scenario.setup.options:
        if option not in OPTIONS:
            raise Problem(("options",), f"option {option!r}: must be {', '.join(OPTIONS)}")
    project = load(scenario.setup.board).project
    for fix in scenario.setup.fixes:
        if fix != "all" and (project is None or not project.corrects(fix)):
            raise Problem(("fixes",), f"no correction {fix!r}: hil audit lists them")
    for defect in scenario.defects:
        if project is None or not project.corrects(defect):
            raise Problem(("defects",), f"no entry {defect!r} of the catalogue: hil audit lists them")
        if defect not in project.corrections(scenario.setup.fixes):
            raise Problem(("defects",), f"{defect} is not corrected: fixes must name it, or all")
    if scenario.defects and not scenario.faithful_fails:
        raise Problem(("defects",), "faithful_fails is missing: name what fails without the corrections")
    if scenario.faithful_fails and not scenario.setup.fixes:
        raise Problem(("faithful_fails",), "fixes is missing: without fixes, the run is the faithful one")
    if scenario.ground != GroundOptions():
        scenario.world_map()
