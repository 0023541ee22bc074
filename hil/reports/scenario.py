"""A scenario: a robot in a world, told what to do for some seconds.

As a file (TOML), every key optional::

    world = "corridor"         # corridor, room, box, or a map beside this file
    seed = 1
    seconds = 10               # virtual time after start-up
    orders = ["0.5:mission", "8:stop"]
    fill = "zero"              # zero, ones, nan, random:SEED, stack, trap
    realistic = true           # devices and wheels with noise, bounce, slip, loss
    xbee = false               # an XBee pair between robot and PC
    options = ["lidar"]        # parts that the robot of the thesis has not (hil/robot/options)
    divide = "ieee"            # what dividing floats gives: ieee, nr
    float_division = "tmu"     # how long it takes, by how the C is built: calibrated, tmu, fast, standard
    fixes = ["all"]            # corrections that are linked in
    firmware = ["my_robot"]    # own C files of the robot, or folders with them, beside this file
    include = ["headers"]      # folders of C headers, beside this file
    defines = ["LAB=3"]        # macros for C files
    faults = ["gyro-reset:at=2"]   # what breaks on purpose; or tables [[faults]], each with kind and parameters
    baseline = "known.json"    # beside this file
    fail_on = "warning"        # error, warning, note, never

    [severity]                 # RULE = error, warning, note, off
    index = "note"
"""

from __future__ import annotations

import tomllib
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.coverage import Coverage
from emulator.clock import SYSCLK_HZ, seconds
from hil.client.orders import parse_timed_order
from hil.machine import FirmwareStopped, Setup
from hil.reports.policy import Policy
from hil.robot.options.names import checked

if TYPE_CHECKING:
    from hil.bench import Bench

#: Keys of a file that are the setup's, with the type of their value.
_SETUP: Final[dict[str, type]] = {
    "world": str, "seed": int, "fill": str, "realistic": bool, "xbee": bool, "divide": str,
    "float_division": str,
}  # fmt: skip
_POLICY: Final = ("baseline", "fail_on", "severity")
_TYPES: Final = {str: "a text", int: "a whole number", bool: "true or false"}
#: Every key of a file.
KEYS: Final = (*_SETUP, "options", "fixes", "firmware", "include", "defines", "faults", "orders", "seconds", *_POLICY)
DEFAULT_SECONDS: Final = 10.0


@dataclass(frozen=True, slots=True)
class Scenario:
    """What a run is to be.  `orders` as `hil run --order` takes them, with times after start-up."""

    setup: Setup = field(default_factory=lambda: Setup(watch=True, static=True))
    seconds: float = DEFAULT_SECONDS
    orders: tuple[str, ...] = ("mission",)
    name: str = "mission"

    def __post_init__(self) -> None:
        if not 0 < self.seconds < float("inf"):
            raise ValueError(f"seconds {self.seconds!r}: must be more than 0")
        for order in self.orders:
            parse_timed_order(order)

    def with_fill(self, fill: str) -> Scenario:
        """The same with another fill."""
        return replace(self, setup=replace(self.setup, fill=fill))

    def bench(self, coverage: Coverage | None = None) -> Bench:
        """The robot of this scenario, not booted yet; `coverage` takes up how often its statements are begun."""
        from hil.bench import Bench

        return Bench(self.setup, traced=False, coverage=coverage)

    def run(self, bench: Bench, *, progress: Callable[[float], None] = lambda fraction: None) -> str:
        """Boot `bench` and give it its orders for the scenario's time.  Returns why it ended early, or nothing."""
        try:
            bench.boot()
            start = bench.clock.now
            end = start + round(self.seconds * SYSCLK_HZ)
            orders = deque(sorted((parse_timed_order(order) for order in self.orders), key=lambda o: o.time_s))
            while bench.clock.now < end:
                while orders and start + round(orders[0].time_s * SYSCLK_HZ) <= bench.clock.now:
                    bench.feed(orders.popleft().data)
                due = start + round(orders[0].time_s * SYSCLK_HZ) if orders else end
                bench.run_until(min(end, due, bench.clock.now + SYSCLK_HZ // 5))
                progress((bench.clock.now - start) / (end - start))
        except FirmwareStopped as reason:
            return f"{reason} at {seconds(bench.clock.now):.6f} s"
        return ""


def load_scenario(path: Path, policy: Policy) -> tuple[Scenario, Policy]:
    """A scenario of a TOML file, and `policy` with what the file says of severities, baseline and threshold.

    Raises ValueError naming file and key for what it does not know; OSError if the file cannot be read.
    """
    try:
        with path.open("rb") as file:
            return _from_table(tomllib.load(file), path, policy)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _from_table(table: Mapping[str, Any], path: Path, policy: Policy) -> tuple[Scenario, Policy]:
    setup: dict[str, Any] = {"watch": True, "static": True}
    scenario: dict[str, Any] = {"name": path.stem}
    for key, value in table.items():
        if key in _SETUP:
            setup[key] = _typed(key, value, _SETUP[key])
        elif key == "options":
            setup[key] = checked(_texts(key, value))
        elif key in ("fixes", "defines"):
            setup[key] = _texts(key, value)
        elif key in ("firmware", "include"):
            setup[key] = tuple(str(path.parent / text) for text in _texts(key, value))
        elif key == "faults":
            setup[key] = _faults(value)
        elif key == "orders":
            scenario[key] = _texts(key, value)
        elif key == "seconds":
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise ValueError(f"{key}: {value!r} must be a number")
            scenario[key] = float(value)
        elif key not in _POLICY:
            raise ValueError(f"no key {key!r}: there are {', '.join(KEYS)}")
    world = setup.get("world", "")
    if (path.parent / world).is_file():
        setup["world"] = str(path.parent / world)
    return (
        Scenario(setup=Setup(**setup), **scenario),
        policy.changed({key: table[key] for key in _POLICY if key in table}, path.parent),
    )


def _typed(key: str, value: Any, kind: type) -> Any:
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise ValueError(f"{key}: {value!r} must be {_TYPES[kind]}")
    return value


def _faults(value: Any) -> tuple[str, ...]:
    """Texts as `hil run --fault` takes them, or tables."""
    from hil.faults import Fault, parse

    if not isinstance(value, list):
        raise ValueError(f"faults: {value!r} must be a list of texts or tables")
    found = []
    for number, each in enumerate(value, 1):
        try:
            found.append(str(Fault.from_table(each) if isinstance(each, dict) else parse(str(each))))
        except ValueError as error:
            raise ValueError(f"faults, number {number}: {error}") from None
    return tuple(found)


def _texts(key: str, value: Any) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
        raise ValueError(f"{key}: {value!r} must be a list of texts")
    return tuple(value)
