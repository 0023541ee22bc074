"""A table of single faults: how the corrected firmware notices each one, how soon it stops, and how it goes on.

Each row compares a run of the emulated robot, with all corrections, with the same run without the fault.  Only the
fault is written down, and the reason if nothing on board can notice it.  If a run with such a reason shows that the
firmware noticed the fault, the table is wrong; a test checks that there is no such row.

A run is `FAULT_S` of driving, `LASTS_S` with the fault, `BEYOND_S` without it, then the orders of a user: STOP, and the
order to drive again.  Times count from the begin or the end of the fault, in true milliseconds.

The firmware reports faults that it has detected by a number in its frames (`Seen` of the corrected main_Robot.c).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from math import cos, inf, radians, sin
from typing import Any, Final

from hil.bench import Bench
from hil.client.orders import order, set_reference
from hil.faults import parse
from hil.machine import Setup
from hil.world.geometry import Segment
from hil.world.maps import WorldMap

FAULT_S: Final = 3.0
LASTS_S: Final = 4.0
BEYOND_S: Final = 3.0
AGAIN_S: Final = 2.0
#: The time in s between two samples.
SAMPLE_S: Final = 0.01
#: The time in s between two references of a console.
REPEAT_S: Final = 0.1
#: The speed in m/s of a mission on a free way, which is also the console's order.
SPEED_M_S: Final = 0.15
#: A robot slower than this stands.
STOPPED_M_S: Final = 0.005
STOPPED_RAD_S: Final = 0.05
#: One that is faster than this backwards goes back; one below this share of its speed is slower.
BACKS_M_S: Final = 0.02
SLOWER: Final = 0.85
#: A behaviour that lasts less does not count.
HELD_S: Final = 0.1
#: The distance from the middle between the wheels to a wall at the start; the time that a mission before it is watched.
WALL_M: Final = 1.2
MISSION_S: Final = 25.0
#: It is on its way again at half of its speed.
DRIVES: Final = 0.5
#: The robot turns away if its heading differs by more than this from the heading without the fault.
ELSEWHERE_RAD: Final = 0.15
#: In place of a number: the watchdog has reset the chip, so no frames come any more.
RESET: Final = -1
#: The meaning of the numbers in the firmware's frames.
SEEN: Final = {
    RESET: "watchdog",
    1: "no distance", 2: "old distance", 3: "front distance stuck", 4: "gyro silent", 5: "gyro and wheels at odds",
    6: "a wheel does not follow", 7: "link silent", 8: "bumper stuck",
    9: "pushes",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class SingleFault:
    """A fault (as of `--fault`, without its time), what it hits, and a drive.

    `tele`: a console drives it, not a mission.  `blind`: why nothing on board can notice it.
    """

    of: str
    fault: str
    blind: str = ""
    tele: bool = False
    xbee: bool = False


_LIKELY: Final = "a distance that may be true"
_OPEN_WAY: Final = "an open way has no echo either"
_ALONGSIDE: Final = "a wall alongside gives the same"
_SMALL: Final = "no more than tyres slip"
_NO_ANSWER: Final = "it sends, and nobody answers"
ROWS: Final = (
    *(
        row
        for name, channel in (("front", 3), ("left", 2), ("right", 4))
        for row in (
            SingleFault(f"{name} sonar", f"adc-channel-open:input=A{channel}", "" if name == "left" else _LIKELY),
            SingleFault(f"{name} sonar", f"adc-input-shorted:input=A{channel},volts=0"),
            SingleFault(f"{name} sonar", f"adc-input-shorted:input=A{channel},volts=3"),
            SingleFault(f"{name} sonar", f"adc-input-held:input=A{channel}", "" if name == "front" else _ALONGSIDE),
            SingleFault(f"{name} sonar", f"adc-bit-stuck:input=A{channel},bit=11", "" if name == "front" else _LIKELY),
            SingleFault(f"{name} sonar", f"adc-bit-stuck:input=A{channel},bit=6", _LIKELY),
            SingleFault(f"{name} sonar", f"sonar-deaf:sensor={name.upper()}", _OPEN_WAY),
        )
    ),
    SingleFault("front sonar", "sonar-stuck:range=0.1524", _LIKELY),
    SingleFault("front sonar", "sonar-stuck:range=1.5"),
    SingleFault("front sonar", "sonar-cross-talk", _LIKELY),
    SingleFault("all sonars", "adc-dead"),
    SingleFault("all sonars", "adc-reference-drift:percent=10", "all distances shrink alike"),
    SingleFault("gyro", "gyro-miso-stuck:level=1"),
    SingleFault("gyro", "gyro-miso-stuck:level=0"),
    SingleFault("gyro", "gyro-select-lost"),
    SingleFault("gyro", "gyro-reset:for=0.01"),
    SingleFault("gyro", "gyro-bias-jump:dps=20", _SMALL),
    SingleFault("gyro", "gyro-bias-jump:dps=200"),
    SingleFault("gyro", "gyro-saturation"),
    *(
        row
        for side in ("left", "right")
        for row in (
            SingleFault(f"{side} wheel", f"encoder-edge-lost:side={side},rate=1"),
            SingleFault(f"{side} wheel", f"encoder-edge-lost:side={side},rate=0.05", _SMALL),
            SingleFault(f"{side} wheel", f"encoder-phases-swapped:side={side}"),
            SingleFault(f"{side} wheel", f"wheel-blocked:side={side}"),
            SingleFault(f"{side} wheel", f"wheel-slips:side={side}"),
        )
    ),
    SingleFault("supply", "supply-sag", "it keeps the speed by a greater duty"),
    SingleFault("supply", "brown-out:for=0.05"),
    SingleFault("bumper", "bumper-stuck"),
    SingleFault("bumper", "bumper-stuck:state=released", "an open contact is what no contact gives"),
    SingleFault("bumper", "bumper-bouncing"),
    SingleFault("link", "serial-break", tele=True),
    SingleFault("link", "serial-bit-flipped", tele=True),
    SingleFault("link", "serial-byte-lost", tele=True),
    SingleFault("link", "serial-byte-doubled", tele=True),
    SingleFault("link", "serial-stall", tele=True),
    SingleFault("link", "serial-wrong-baud", tele=True),
    SingleFault("link", "radio-loss", tele=True, xbee=True),
    SingleFault("link", "radio-latency:ms=500", "an order says not when it was given", tele=True, xbee=True),
    SingleFault("link", "serial-break:direction=from-chip", _NO_ANSWER, tele=True),
    SingleFault("link", "serial-bit-flipped:direction=from-chip", _NO_ANSWER, tele=True),
    SingleFault("chip", "oscillator-drift:percent=3", "there is no second clock"),
    SingleFault("chip", "task-slow:task=TaskNAVIGATION,us=20000", "it keeps its deadline"),
    *(SingleFault("chip", f"task-slow:task={task},us=1e7", tele=task == "TaskORD") for task in (
        "TaskGYRO", "TaskUS", "TaskORD", "TaskSERVO", "TaskNAVIGATION", "TaskODO",
    )),
)  # fmt: skip
#: Angles of a wall from square to the way, in degrees to the left.
WALLS_DEG: Final = (0, 15, 30, 40, 45, 50, 60, 75)


@dataclass(frozen=True, slots=True)
class RobotSample:
    """One sample of the robot's state; times in s after start-up."""

    time_s: float
    v_m_s: float
    w_rad_s: float
    seen: int
    bumper: bool
    x_m: float
    y_m: float
    heading_rad: float

    @property
    def is_still(self) -> bool:
        """Whether it neither drives nor turns."""
        return abs(self.v_m_s) < STOPPED_M_S and abs(self.w_rad_s) < STOPPED_RAD_S


@dataclass(frozen=True)
class FaultRun:
    """The outcome of a drive."""

    looks: tuple[RobotSample, ...]
    fired: int
    collisions: int

    def between(self, first_s: float, last_s: float) -> list[RobotSample]:
        """The samples between two times."""
        return [look for look in self.looks if first_s <= look.time_s < last_s]


def drive(row: SingleFault | None, *, tele: bool = False, xbee: bool = False, seed: int = 1) -> FaultRun:
    """The drive of a row; without a row, the drive without a fault."""
    faults: tuple[str, ...] = ()
    watch = False
    if row is not None:
        text = f"{row.fault}{',' if ':' in row.fault else ':'}at={FAULT_S:g}"
        faults = (text if "for=" in text else f"{text},for={LASTS_S:g}",)
        tele, xbee, watch = row.tele, row.xbee, parse(row.fault).kind.watch
    looks: list[RobotSample] = []
    with closing(Bench(Setup(seed=seed, fixes=("all",), faults=faults, xbee=xbee, watch=watch), traced=False)) as bench:
        bench.boot()
        begin = bench.world.pose
        for step in range(round((FAULT_S + LASTS_S + BEYOND_S + AGAIN_S) / SAMPLE_S)):
            for data in _orders(step, tele):
                bench.feed(data)
            bench.run_for(SAMPLE_S)
            robot, pose, firmware = bench.world.robot, bench.world.pose, bench.firmware.main_robot
            looks.append(RobotSample(
                (step + 1) * SAMPLE_S, robot.v_m_s, robot.w_rad_s, RESET if bench.ended else int(firmware.Seen),
                not firmware.bumper,
                pose.x_m - begin.x_m, pose.y_m - begin.y_m, pose.heading_rad,
            ))  # fmt: skip
        fired = sum(mounted.report().count for mounted in bench.faults)
        return FaultRun(tuple(looks), fired, bench.world.robot.collisions)


def _orders(step: int, tele: bool) -> list[bytes]:
    """The orders that the PC sends at a sample."""
    stop, again = (round(s / SAMPLE_S) for s in (FAULT_S + LASTS_S + BEYOND_S, FAULT_S + LASTS_S + BEYOND_S + 0.5))
    if step == stop:
        return [order("stop")]
    if step in (0, again):
        return [order("tele" if tele else "mission")]
    repeats = tele and step % round(REPEAT_S / SAMPLE_S) == 0 and not stop < step < again
    return [set_reference(SPEED_M_S, 0.0)] if repeats else []


@dataclass(frozen=True)
class MeasuredFault:
    """A measured row.  Times in ms after the begin or the end of the fault; None: it did not happen."""

    row: SingleFault
    fired: int
    #: How the firmware noticed the fault, and when.
    noticed: str
    noticed_ms: float | None
    #: What the robot did, and when.
    does: str
    does_ms: float | None
    #: How it went on after the fault, and when.
    goes_on: str
    goes_on_ms: float | None
    collisions: int

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "of": self.row.of, "fault": self.row.fault, "driven_by": "console" if self.row.tele else "mission",
            "fired": self.fired, "noticed": self.noticed, "noticed_ms": self.noticed_ms, "not_noticed": self.row.blind,
            "does": self.does, "does_ms": self.does_ms, "goes_on": self.goes_on, "goes_on_ms": self.goes_on_ms,
            "collisions": self.collisions,
        }  # fmt: skip


def table(
    rows: Sequence[SingleFault] = ROWS, *, progress: Callable[[int], None] = lambda done: None
) -> Iterator[MeasuredFault]:
    """Measure each row, in order.  `progress` is called with the number of rows that are done."""
    sound = cache(lambda tele, xbee: drive(None, tele=tele, xbee=xbee))
    for done, row in enumerate(rows, 1):
        yield measured(row, drive(row), sound(row.tele, row.xbee))
        progress(done)


def measured(row: SingleFault, run: FaultRun, sound: FaultRun) -> MeasuredFault:
    """Measure a row: compare its drive with the drive without a fault."""
    fault = parse(row.fault)
    end_s = FAULT_S + min(fault.lasts_s, LASTS_S)
    noticed, noticed_ms = _noticed(run, sound)
    does, does_ms = _does(run, sound)
    goes_on, goes_on_ms = _driving_after(run, does, does_ms, end_s)
    return MeasuredFault(row, run.fired, noticed, noticed_ms, does, does_ms, goes_on, goes_on_ms, run.collisions)


def _noticed(run: FaultRun, sound: FaultRun) -> tuple[str, float | None]:
    told: dict[str, float] = {}
    known = {(look.seen, look.bumper) for look in sound.between(FAULT_S, FAULT_S + LASTS_S)}
    for look in run.between(FAULT_S, FAULT_S + LASTS_S):
        if (look.seen, look.bumper) not in known:
            what = SEEN[look.seen] if look.seen else "bumper"
            told.setdefault(what, round(1000 * (look.time_s - FAULT_S)))
    return ", then ".join(told), next(iter(told.values()), None)


def _does(run: FaultRun, sound: FaultRun) -> tuple[str, float | None]:
    """How the robot's behaviour differs from the drive without a fault, while the fault lasts; and when."""
    looks, others = (each.between(FAULT_S, FAULT_S + LASTS_S) for each in (run, sound))
    speed = others[0].v_m_s
    held = round(HELD_S / SAMPLE_S)
    still = [look.is_still for look in looks]
    is_still = next((look for n, look in enumerate(looks) if all(still[n : n + held])), None)
    if is_still is not None:
        backs = any(look.v_m_s < -BACKS_M_S for look in looks if look.time_s > is_still.time_s)
        return "stops" + (", then goes back" if backs else ""), _after(is_still)
    seen: list[tuple[float, str]] = []
    slow = [look for look in looks if look.v_m_s < SLOWER * speed]
    if len(slow) > held:
        seen.append((_after(slow[0]), f"slows to {100 * min(look.v_m_s for look in slow) / speed:.0f} %"))
    for look, other in zip(looks, others, strict=True):
        if abs(look.heading_rad - other.heading_rad) > ELSEWHERE_RAD:
            seen.append((_after(look), "turns away"))
            break
    when, does = min(seen, default=(None, "drives on"))
    return does, when


def _after(look: RobotSample) -> float:
    return round(1000 * (look.time_s - FAULT_S))


def _driving_after(run: FaultRun, does: str, does_ms: float | None, end_s: float) -> tuple[str, float | None]:
    """How the robot drives after the fault, and when it does so."""
    if does_ms is None:
        return "", None
    if run.looks[-1].seen == RESET:
        return "starts anew, and stands", None
    speed = run.between(FAULT_S - 1.0, FAULT_S)[0].v_m_s
    enough = speed * (DRIVES if does.startswith("stops") else SLOWER)
    over_s = FAULT_S + LASTS_S + BEYOND_S
    by_itself = _drives(run, max(end_s, FAULT_S + does_ms / 1000), over_s, enough)
    if by_itself is not None:
        return "drives on", round(1000 * (by_itself - end_s))
    again = _drives(run, over_s + 0.5, run.looks[-1].time_s + SAMPLE_S, speed * DRIVES)
    return ("drives when told to stand and to drive", None) if again is not None else ("stands", None)


def _drives(run: FaultRun, first_s: float, last_s: float, speed_m_s: float) -> float | None:
    return next((look.time_s for look in run.between(first_s, last_s) if look.v_m_s > speed_m_s), None)


@dataclass(frozen=True)
class Mission:
    """A mission of `MISSION_S` where nothing is broken.  Lengths from the middle between the wheels."""

    place: str
    #: How far from the nearest wall it first slowed down; None: it never did.
    slows_m: float | None
    nearest_m: float
    touched: int
    bumps: int
    #: The reports of the firmware, in their order.
    noticed: tuple[str, ...]
    #: Its way in the last 5 s.
    goes_on_m: float

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {name: getattr(self, name) for name in Mission.__dataclass_fields__}


def places() -> dict[str, WorldMap]:
    """The maps of the missions: before a wall at several angles, in a dead end, on a slippery floor."""
    found = {}
    for angle_deg in WALLS_DEG:
        a = radians(angle_deg)
        foot, along = (WALL_M * cos(a), WALL_M * sin(a)), (-sin(a) * 2.5, cos(a) * 2.5)
        wall = Segment(foot[0] - along[0], foot[1] - along[1], foot[0] + along[0], foot[1] + along[1])
        name = f"wall at {angle_deg} degrees"
        found[name] = WorldMap(name, (wall, *_HALL))
    dead_end = _lines((-1.0, 0.4), (1.6, 0.4), (1.6, -0.4), (-1.0, -0.4))
    found["dead end, 80 cm wide"] = WorldMap("dead end", (*dead_end, *_HALL))
    wall = Segment(WALL_M, -2.5, WALL_M, 2.5)
    found["slippery floor, wall at 0 degrees"] = WorldMap("slippery floor", (wall, *_HALL), grip=0.2)
    return found


def _lines(*corners: tuple[float, float]) -> tuple[Segment, ...]:
    return tuple(Segment(*a, *b) for a, b in pairwise(corners))


_HALL: Final = _lines((-6.0, -6.0), (6.0, -6.0), (6.0, 6.0), (-6.0, 6.0), (-6.0, -6.0))


def missions(*, progress: Callable[[int], None] = lambda done: None) -> Iterator[Mission]:
    """Run a mission in each of the places."""
    for done, (name, world) in enumerate(places().items(), 1):
        yield mission(name, world)
        progress(done)


def mission(name: str, world: WorldMap, *, seed: int = 1) -> Mission:
    """A mission of the corrected robot in a world."""
    nearest, slows = inf, None
    seen: dict[str, None] = {}
    ways: list[float] = []
    pressed: list[bool] = []
    with closing(Bench(Setup(seed=seed, fixes=("all",)), traced=False, world_map=world)) as bench:
        bench.boot()
        bench.world.bumper_changed.connect(pressed.append)
        bench.feed(order("mission"))
        for step in range(round(MISSION_S / SAMPLE_S)):
            bench.run_for(SAMPLE_S)
            room = world.room(bench.world.pose.x_m, bench.world.pose.y_m)
            nearest = min(nearest, room)
            # It has its speed after a second.
            if slows is None and step * SAMPLE_S > 1.0 and bench.world.robot.v_m_s < SLOWER * SPEED_M_S:
                slows = room
            ways.append(bench.world.travelled_m)
            if number := int(bench.firmware.main_robot.Seen):
                seen[SEEN[number]] = None
        goes_on_m = ways[-1] - ways[-1 - round(5.0 / SAMPLE_S)]
        return Mission(name, slows, nearest, bench.world.robot.collisions, sum(pressed), tuple(seen), goes_on_m)
