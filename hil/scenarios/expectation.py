"""Expectations: a `[[expect]]` table, and its verdict on a run."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, degrees, hypot, inf, nan, sin
from typing import TYPE_CHECKING, Any, Final

from emulator.clock import SYSCLK_HZ
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.devices.nxt_motor import NxtMotor
from hil.client.decode import FrameDecoder
from hil.reports.excerpt import shown
from hil.world.geometry import clearance

if TYPE_CHECKING:
    from hil.bench import Bench

#: How often something is looked at that must hold for a time.
SAMPLE_S: Final = 0.05
#: How often is looked for a hit, and what counts as one: forward, with something within 40 cm for so long in the front
#: sonar.  Its next reading comes within 147 ms, TaskNAVIGATION within 50 ms, TaskSERVO within 25 ms; then the wheels
#: brake within 0.2 s.
_HIT_SAMPLE_S: Final = 0.01
_HIT_IN: Final = 40.0 / 2.54
_HIT_SEEN_S: Final = 0.5
_HIT_M_S: Final = 0.02
#: A wheel slower than this stands; a motor that is driven by less than this share may be held by friction alone
#: (`NxtMotorParams.static_nm`: 0.08 to 0.12 without a load).
_STOPPED_RAD_S: Final = 0.2
_DRIVEN: Final = 0.3


@dataclass(frozen=True, slots=True)
class Check:
    """A verdict: what was expected, whether it came true, and what was seen."""

    name: str
    ok: bool
    seen: str

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {"name": self.name, "ok": self.ok, "seen": self.seen}


@dataclass(frozen=True, slots=True)
class Expectation:
    """An expectation; `kind` is quantity, finding, frame, state or deadline, `of` the name of that."""

    name: str
    kind: str
    of: str
    least: float = -inf
    most: float = inf
    #: From and to which second after start-up; both inf: at the end.
    during: tuple[float, float] = (inf, inf)
    once: bool = False
    absent: bool = False
    place: str = ""

    @classmethod
    def of_kind(cls, kind: str, table: Mapping[str, Any]) -> Expectation:
        """Create it from a checked table.  Raises ValueError for a contradiction."""
        allowed = {
            "quantity": ("at", "during", "once", "least", "most"), "state": ("at", "during", "once"),
            "finding": ("absent", "place"), "frame": ("during", "least", "most"), "deadline": ("most",),
        }[kind]  # fmt: skip
        for key in table:
            if key not in ("name", kind, *allowed):
                raise ValueError(f"{key} is no key of {kind}: there are {', '.join(allowed)}")
        if "at" in table and "during" in table:
            raise ValueError("give at or during, not both")
        least, most = float(table.get("least", -inf)), float(table.get("most", inf))
        if kind == "quantity" and least == -inf and most == inf:
            raise ValueError("least or most must be given")
        if kind == "deadline" and most == inf:
            raise ValueError("most must be given, in ms")
        if kind == "frame":
            if "least" not in table and "most" not in table:
                least = 1.0
            re.compile(table["frame"])
        if least > most:
            raise ValueError(f"least {least:g} is more than most {most:g}")
        if "during" in table:
            first, last = map(float, table["during"])
            if not 0 <= first <= last:
                raise ValueError(f"during [{first:g}, {last:g}]: expected 0 or more, and the end after the start")
        else:
            first = last = float(table.get("at", inf))
        return cls(
            table["name"], kind, table[kind], least, most, (first, last), table.get("once", False),
            table.get("absent", False), table.get("place", ""),
        )  # fmt: skip

    @classmethod
    def of_table(cls, table: Mapping[str, Any]) -> Expectation:
        """Create it from a table that has one of the kinds."""
        kind = next(kind for kind in ("quantity", "finding", "frame", "state", "deadline") if kind in table)
        try:
            return cls.of_kind(kind, table)
        except re.error as error:
            raise ValueError(f"frame: not a regular expression ({error})") from None

    @property
    def bounds(self) -> str:
        """The bounds in words."""
        if self.least == -inf:
            return f"at most {self.most:g}"
        if self.most == inf:
            return f"at least {self.least:g}"
        return f"{self.least:g} to {self.most:g}"


class ExpectationWatch:
    """Watches a bench while it runs, and gives the verdicts at the end.  Create it when start-up is over.

    It only reads: a run is the same with it.
    """

    def __init__(self, bench: Bench, expectations: Sequence[Expectation]) -> None:
        self._bench = bench
        self._start = bench.clock.now
        self._start_pose = bench.world.pose
        self._expectations = expectations
        self._decoder = FrameDecoder()
        self._frames: list[tuple[float, str]] = []
        self._line = bytearray()
        self._decoded = 0
        self._bumps = 0
        #: By place of the expectation: whether each look was right, and what was seen first that was not (or was).
        self._looks: dict[int, list[tuple[float, float | str]]] = {}
        self._told: set[int] = set()
        bench.uart_sent.connect(self._byte)
        bench.world.bumper_changed.connect(self._bump)
        if any(each.kind == "deadline" for each in expectations):
            bench.measure_tasks()
        self._hits = _HitCounter(bench) if any(each.of == "seen_hits" for each in expectations) else None
        self._stalls = _StallCounter(bench) if any(each.of == "stalled_s" for each in expectations) else None
        for index, each in enumerate(expectations):
            if each.kind in ("quantity", "state") and each.during[0] < inf:
                self._looks[index] = []
                bench.clock.schedule(self._start + round(each.during[0] * SYSCLK_HZ), _SampledCheck(self, index))

    def look(self, index: int) -> None:
        """Sample an expectation now, and again until its time is over."""
        each, clock = self._expectations[index], self._bench.clock
        now_s = (clock.now - self._start) / SYSCLK_HZ
        self._looks[index].append((now_s, self._value(each)))
        if now_s + SAMPLE_S <= each.during[1]:
            clock.after(round(SAMPLE_S * SYSCLK_HZ), _SampledCheck(self, index))

    def _byte(self, byte: int, cycles: int) -> None:
        self._decoded += len(list(self._decoder.feed(bytes((byte,)))))
        self._line.append(byte)
        if byte == 0x0D:
            self._frames.append(((cycles - self._start) / SYSCLK_HZ, self._line.decode("latin-1").strip("\r\n")))
            self._line.clear()

    def _bump(self, pressed: bool) -> None:
        self._bumps += pressed

    # Verdicts

    def checks(self) -> list[Check]:
        """The verdicts, in the order of the file."""
        return [self._check(index, each) for index, each in enumerate(self._expectations)]

    def decided(self, *, ended: bool = False) -> list[Check]:
        """The new verdicts that nothing can change any more, each returned once; `ended`: the run is over."""
        found = []
        for index, each in enumerate(self._expectations):
            if index not in self._told and (ended or self._is_decided(index, each)):
                self._told.add(index)
                found.append(self._check(index, each))
        return found

    def _is_decided(self, index: int, each: Expectation) -> bool:
        over = (self._bench.clock.now - self._start) / SYSCLK_HZ > each.during[1]
        match each.kind:
            case "quantity" | "state":
                looks = self._looks.get(index, [])
                return bool(looks) and (over or any(_right(each, value) is each.once for _, value in looks))
            case "finding":
                return self._check(index, each).ok is not each.absent
            case "frame":
                count = self._count(each)
                return over or count > each.most or (each.most == inf and count >= each.least)
            case _:
                return False

    def _check(self, index: int, each: Expectation) -> Check:
        if each.kind in ("quantity", "state"):
            return self._measured(each, self._looks.get(index))
        verdict: Callable[[Expectation], Check] = {
            "finding": self._finding, "frame": self._frame, "deadline": self._deadline,
        }[each.kind]  # fmt: skip
        return verdict(each)

    def _measured(self, each: Expectation, looks: list[tuple[float, float | str]] | None) -> Check:
        if looks is None:
            looks = [((self._bench.clock.now - self._start) / SYSCLK_HZ, self._value(each))]
        if not looks:
            return Check(each.name, False, f"{each.of}: the run ended before {each.during[0]:g} s")
        right = [_right(each, value) for _, value in looks]
        ok = any(right) if each.once else all(right)
        # What decides: the first that is right or wrong; else the last one.
        deciding = looks[right.index(each.once)] if each.once in right else looks[-1]
        value = f"{deciding[1]:.4g}" if isinstance(deciding[1], float) else deciding[1]
        wanted = f"expected {each.bounds}" if each.kind == "quantity" else f"expected {each.of}"
        what = each.of if each.kind == "quantity" else "state"
        return Check(each.name, ok, f"{what} {value} at {deciding[0]:.2f} s; {wanted}")

    def _finding(self, each: Expectation) -> Check:
        found = [
            finding for finding in self._bench.findings
            if finding.rule == each.of
            and each.place.lower() in f"{shown(finding.place) if finding.place else ''} {finding.object}".lower()
        ]  # fmt: skip
        seen = f"{each.of}: {found[0].message}" if found else f"no finding {each.of}"
        return Check(each.name, bool(found) is not each.absent, seen)

    def _frame(self, each: Expectation) -> Check:
        count = self._count(each)
        return Check(each.name, each.least <= count <= each.most, f"{count} frames match; expected {each.bounds}")

    def _count(self, each: Expectation) -> int:
        """Count the frames that match."""
        first, last = each.during if each.during[0] < inf else (-inf, inf)
        return sum(bool(re.search(each.of, text)) for time_s, text in self._frames if first <= time_s <= last)

    def _deadline(self, each: Expectation) -> Check:
        rows = {row.task: row for row in self._bench.task_statistics().tasks}
        row = rows.get(each.of)
        if row is None:
            return Check(each.name, False, f"{each.of} never ran: {', '.join(rows)} did")
        response_ms = row.response_max_us / 1000.0
        return Check(each.name, response_ms <= each.most, f"{response_ms:.3f} ms; expected {each.bounds}")

    # Values

    def _value(self, each: Expectation) -> float | str:
        if each.kind == "state":
            return self._bench.status().state
        return self._quantity(each.of)

    def _quantity(self, name: str) -> float:
        bench = self._bench
        world, robot, pose = bench.world, bench.world.robot, bench.world.pose
        if name in ("front_cm", "right_cm", "left_cm"):
            return float(bench.status().distances_cm[("front_cm", "right_cm", "left_cm").index(name)])
        if name.startswith(("believed_", "drift_")):
            return self._believed(name)
        values: dict[str, Callable[[], float]] = {
            "x_m": lambda: pose.x_m, "y_m": lambda: pose.y_m, "heading_deg": lambda: degrees(pose.heading_rad),
            "clearance_m": lambda: clearance(pose.x_m, pose.y_m, world.map.walls, world.posts),
            "travelled_m": lambda: world.travelled_m, "slipped_m": lambda: robot.slipped_m,
            "collisions": lambda: float(robot.collisions), "bumps": lambda: float(self._bumps),
            "driving": lambda: max(_driven(motor) for motor in bench.board.find(NxtMotor).values()),
            "stalled_s": lambda: self._stalls.longest_s if self._stalls else nan,
            "seen_hits": lambda: float(self._hits.count) if self._hits else nan,
            "frames": lambda: float(self._decoded), "malformed_frames": lambda: float(self._decoder.malformed),
        }  # fmt: skip
        return values[name]()

    def _believed(self, name: str) -> float:
        points = self._bench.odometry_path()
        if not points:
            return float("nan")
        believed, start, pose = points[-1], self._start_pose, self._bench.world.pose
        if name == "believed_x_m":
            return believed.x_m
        if name == "believed_y_m":
            return believed.y_m
        if name == "believed_heading_deg":
            return degrees(believed.heading_rad)
        if name == "drift_deg":
            return abs(degrees(believed.heading_rad - (pose.heading_rad - start.heading_rad)))
        # Where the robot is, seen from where it started.
        dx, dy = pose.x_m - start.x_m, pose.y_m - start.y_m
        c, s = cos(start.heading_rad), sin(start.heading_rad)
        return hypot(believed.x_m - (c * dx + s * dy), believed.y_m - (c * dy - s * dx))


class _SampledCheck:
    """An event that samples one expectation."""

    def __init__(self, watching: ExpectationWatch, index: int) -> None:
        self._watching = watching
        self._index = index

    def __call__(self) -> None:
        self._watching.look(self._index)


class _HitCounter:
    """Counts the obstacles that a mission drove into, forward, although the front sonar had measured them in time."""

    def __init__(self, bench: Bench) -> None:
        self.count = 0
        self._bench = bench
        self._front = next(ring.sensors["FRONT"] for ring in bench.board.find(SonarRing).values())
        self._collisions = bench.world.robot.collisions
        self._speed_m_s = 0.0
        self._near_since: int | None = None
        self()

    def __call__(self) -> None:
        """Sample, and schedule the next sample."""
        bench, robot, now = self._bench, self._bench.world.robot, self._bench.clock.now
        if self._front.last_reading_in > _HIT_IN:
            self._near_since = None
        elif self._near_since is None:
            self._near_since = now
        if robot.collisions > self._collisions:
            seen = self._near_since is not None and int(now - self._near_since) > _HIT_SEEN_S * SYSCLK_HZ
            self.count += seen and self._speed_m_s > _HIT_M_S and bench.status().state == "MISSION"
            self._collisions = robot.collisions
        self._speed_m_s = robot.v_m_s
        bench.clock.after(round(_HIT_SAMPLE_S * SYSCLK_HZ), self)


class _StallCounter:
    """Measures how long a motor is driven, by more than friction needs, while its wheel is at rest."""

    def __init__(self, bench: Bench) -> None:
        self.longest_s = 0.0
        self._bench = bench
        self._since = dict.fromkeys(bench.board.find(NxtMotor).values(), bench.clock.now)
        self()

    def __call__(self) -> None:
        """Sample, and schedule the next sample."""
        clock, _ = self._bench.clock, self._bench.world.pose  # the plant is moved up to now
        for motor, since in self._since.items():
            if _driven(motor) < _DRIVEN or abs(motor.omega_rad_s) > _STOPPED_RAD_S:
                self._since[motor] = clock.now
            else:
                self.longest_s = max(self.longest_s, (clock.now - since) / SYSCLK_HZ)
        clock.after(round(_HIT_SAMPLE_S * SYSCLK_HZ), self)


def _driven(motor: NxtMotor) -> float:
    """The share of the period in which a motor is driven."""
    return abs(motor.bridge.in1.duty - motor.bridge.in2.duty)


def _right(each: Expectation, value: float | str) -> bool:
    return value == each.of if isinstance(value, str) else each.least <= value <= each.most
