"""What a page knows of a run: events of a trace, taken one by one, as columns of whole numbers.

Times are cycles, lengths tenths of a millimetre, angles tenths of a milliradian.  A column is written as differences
(`differences`), which is what makes it small once it is compressed: a robot does the same thing again and again.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping
from operator import sub
from typing import Any, Final

from emulator.clock import SYSCLK_HZ
from emulator.devices.lv_maxsonar_beam import OBJECT_HALF_ANGLE_RAD
from emulator.rules import Severity
from hil.client.decode import FrameDecoder
from hil.client.plot import place, sonar_points
from hil.instruments.serial_lines import Lines, ReceivedLine
from hil.instruments.timeline import Span, TaskState, TaskTimeline
from hil.instruments.trace_file import FROM_PC, SAMPLE_CYCLES, TO_PC
from hil.reports.excerpt import readable
from hil.reports.html import markdown
from hil.reports.model import rule_of
from hil.reports.policy import Policy
from hil.world.robot_params import RobotParams

#: Units a metre, and a radian.
UNITS: Final = 10_000
#: CHOICE: as many as are written within a second of CPU after Ctrl-C.  Two million spans are ten minutes of the robot.
MAX_SPANS: Final = 2_000_000
MAX_SAMPLES: Final = 100_000
MAX_LINES: Final = 100_000
#: The lane of what is left of the time.
IDLE: Final = "Idle"
_STATES: Final = {TaskState.RUNNING: "running", TaskState.READY: "ready", TaskState.WAITING: "waiting"}
_SIGNALS: Final = ("faces", "sensors", "adc", "pins", "variables")


def differences(values: Iterable[float]) -> list[int]:
    """The first value, then what each one is more than the one before."""
    whole = values if isinstance(values, array) and values.typecode == "q" else list(map(round, values))
    return [*whole[:1], *map(sub, whole[1:], whole)]


class _Series:
    """Moments, and some numbers of each."""

    def __init__(self, *names: str) -> None:
        self.times = array("q")
        self._columns = {name: array("d") for name in names}

    def add(self, cycles: int, values: Iterable[float]) -> None:
        self.times.append(cycles)
        for column, value in zip(self._columns.values(), values, strict=True):
            column.append(value)

    def placed(self, x_m: float, y_m: float, heading_rad: float) -> _Series:
        """The same poses, seen from where the frame that they are in lies."""
        placed = _Series("x", "y", "h")
        for cycles, x, y, h in zip(self.times, *self._columns.values(), strict=True):
            ((px, py),) = place([(x, y)], x_m, y_m, heading_rad)
            placed.add(cycles, (px, py, h + heading_rad))
        return placed

    def data(self) -> dict[str, list[int]]:
        """Columns by name, with `t` in cycles."""
        scaled = {name: differences(UNITS * value for value in column) for name, column in self._columns.items()}
        return {"t": differences(self.times), **scaled}


class _Signal:
    """A number that changes now and then."""

    def __init__(self) -> None:
        self.times = array("q")
        self.values: list[float] = []

    def data(self) -> dict[str, Any]:
        return {"t": differences(self.times), "v": self.values}


class Replay:
    """A run for a page.  A `hil.instruments.recorder.EventSink`: events of one channel come in the order of time."""

    def __init__(self, about: Mapping[str, str], policy: Policy | None = None) -> None:
        """`about` says what ran; `policy` weighs the findings (None: by their rules)."""
        self.about = dict(about)
        self._policy = policy or Policy()
        self._end = 0
        self._tasks = TaskTimeline({})
        self._lanes: dict[str, dict[str, tuple[array[int], array[int]]]] = {}
        self._spans = 0
        self._lines = Lines()
        self._line_rows: list[ReceivedLine] = []
        self._findings: list[tuple[int, str, Mapping[str, Any]]] = []
        self._signals: dict[tuple[str, str], _Signal] = {}
        self._paths = {name: _Series("x", "y", "h") for name in ("true", "odometry", "robot", "believed")}
        self._sonars: dict[str, _Series] = {}
        self._scene: dict[str, Any] = {}
        #: Of what is told as a whole each time: moments and values.
        self._sampled: dict[str, list[tuple[int, Any]]] = {"posts": [], "state": [], "bumper": [], "happened": []}
        #: What there was too much of for a page, and when that was.
        self._full: dict[str, int] = {}

    def event(self, cycles: int, channel: str, name: str, value: Any) -> None:
        """One event."""
        self._end = max(self._end, cycles)
        match channel:
            case "kernel":
                self._kernel(cycles, name, value)
            case "serial":
                line = self._lines.take(cycles, name, value)
                if line is not None:
                    self._add_line(line)
            case "findings":
                self._findings.append((cycles, name, value))
            case "pose":
                if name in ("true", "odometry"):
                    self._paths[name].add(cycles, value)
            case "scene":
                self._look(cycles, name, value)
            case "faces" | "sensors" | "adc" | "pins" | "variables":
                self._sample(cycles, channel, name, value)

    def _kernel(self, cycles: int, kind: str, name: str) -> None:
        if self._spans >= MAX_SPANS:
            self._full.setdefault("what tasks do", cycles)
            return
        self._tasks.take(cycles, kind, name)
        if self._tasks.spans:
            self._keep(self._tasks.spans)

    def _keep(self, spans: list[Span]) -> None:
        for span in spans:
            begins, ends = self._lanes.setdefault(span.lane, {}).setdefault(
                _STATES[span.state], (array("q"), array("q"))
            )
            begins.append(span.begin)
            ends.append(span.end)
        self._spans += len(spans)
        spans.clear()

    def _add_line(self, line: ReceivedLine) -> None:
        if len(self._line_rows) < MAX_LINES:
            if line.content.strip():
                self._line_rows.append(line)
        else:
            self._full.setdefault("lines of the serial pins", line.end)

    def _look(self, cycles: int, name: str, value: Any) -> None:
        what, _, which = name.partition(" ")
        if what in ("robot", "believed"):
            self._paths[what].add(cycles, value)
        elif what == "sonar":
            series = self._sonars.setdefault(which, _Series("measured", "ray", "echo"))
            series.add(cycles, (-1.0 / UNITS if each is None else each for each in value))
        elif what == "mount":
            self._scene.setdefault("mounts", {})[which] = value
        elif what in self._sampled:
            self._sampled[what].append((cycles, value))
        else:
            self._scene[what] = value

    def _sample(self, cycles: int, channel: str, name: str, value: float) -> None:
        signal = self._signals.setdefault((channel, name), _Signal())
        if len(signal.values) >= MAX_SAMPLES:
            self._full.setdefault(name, cycles)
        elif not signal.values or signal.values[-1] != value:
            signal.times.append(cycles)
            # More digits are seen by nobody, and fill the page.
            signal.values.append(value if isinstance(value, int) else float(f"{value:.6g}"))

    # What the page is given

    def data(self) -> dict[str, Any]:
        """All of it, as JSON has it.  Nothing can be taken afterwards."""
        if "what tasks do" not in self._full:
            self._tasks.end(self._end)
            self._keep(self._tasks.spans)
        for line in self._lines.rest():
            self._add_line(line)
        findings = self._listed()
        rules = {rule.id: rule for rule in (rule_of(found["rule"]) for found in findings)}
        return {
            "hz": SYSCLK_HZ,
            "units": UNITS,
            "look": SAMPLE_CYCLES,
            "end": self._end,
            "about": {name: text for name, text in self.about.items() if name not in (TO_PC, FROM_PC)},
            "full": [[what, cycles] for what, cycles in self._full.items()],
            "findings": findings,
            "rules": {
                rule.id: {"title": rule.title, "page": str(markdown(rule.page)), "source": rule.source}
                for rule in rules.values()
            },
            "lanes": self._task_lanes(),
            "lines": self._spoken(),
            "scene": self._seen(),
            "signals": [
                {"name": name, "channel": channel, **signal.data()}
                for channel in _SIGNALS
                for (of, name), signal in sorted(self._signals.items())
                if of == channel
            ],
        }

    def _listed(self) -> list[dict[str, Any]]:
        """The findings, the worst first, those of one severity in the order in which they came."""
        return [
            {
                "t": cycles, "rule": name, "severity": severity.value,
                "message": readable(value["message"]), "object": _text(value.get("object")), "task": value["task"],
                "where": readable(value["place"]), "accepted": readable(_text(value.get("accepted"))),
                "details": [readable(text) for text in _texts(value.get("details"))],
                "from": [readable(text) for text in _texts(value.get("called_from"))],
                **_source(value.get("source")),
            }
            for severity in reversed(Severity)
            for cycles, name, value in self._findings
            if self._policy.severity(name) is severity
        ]  # fmt: skip

    def _task_lanes(self) -> list[dict[str, Any]]:
        """Interrupts, Swis, tasks by when they first did something, what is left of the time."""
        first = {
            lane: min(begins[0] for begins, _ in states.values()) for lane, states in self._lanes.items() if states
        }

        kinds = ("Hwi ", "Swi ", "", IDLE)

        def kind_of(lane: str) -> str:
            return lane if lane == IDLE else lane[:4] if lane.startswith(kinds[:2]) else ""

        lanes = []
        for lane in sorted(first, key=lambda lane: (kinds.index(kind_of(lane)), first[lane])):
            columns = {}
            for state, (begins, ends) in self._lanes[lane].items():
                if lane != IDLE or state == "running":
                    edges = array("q", bytes(2 * len(begins) * begins.itemsize))
                    edges[::2], edges[1::2] = begins, ends
                    columns[state] = differences(edges)
            lanes.append({"name": lane, **columns})
        return lanes

    def _spoken(self) -> dict[str, Any]:
        """Lines on serial pins: when each ended, which way it went, what it says."""
        pins = list(dict.fromkeys(line.pin for line in self._line_rows))
        said = sorted(self._line_rows, key=lambda line: line.end)
        return {
            "t": differences(line.end for line in said),
            "pin": [pins.index(line.pin) for line in said],
            "text": [_readable(line.content) for line in said],
            "pins": pins,
            "sent": [pin == self.about.get(TO_PC) for pin in pins],
            "received": [pin == self.about.get(FROM_PC) for pin in pins],
        }

    def _seen(self) -> dict[str, Any] | None:
        """The robot and what stands around it; None: there is only a board."""
        start = self._scene.get("start", (0.0, 0.0, 0.0))
        robot, believed = (self._paths[name] for name in ("robot", "believed"))
        if not robot.times:  # only the paths were recorded
            robot, believed = self._paths["true"], self._paths["odometry"].placed(*start)
        if not robot.times:
            return None
        body = RobotParams()
        return {
            "walls": self._scene.get("walls", []),
            "mounts": self._scene.get("mounts", {}),
            "robot": robot.data(),
            "believed": believed.data(),
            "sonars": {name: series.data() for name, series in self._sonars.items()},
            "cloud": self._cloud(*start).data(),
            "half_angle": OBJECT_HALF_ANGLE_RAD,
            "body": {
                "ahead": body.body_ahead_m, "radius": body.body_radius_m, "track": body.track_m,
                "wheel": body.wheel_radius_m,
            },
            **{what: [list(each) for each in told] for what, told in self._sampled.items()},
        }  # fmt: skip

    def _cloud(self, x_m: float, y_m: float, heading_rad: float) -> _Series:
        """What the frames to the PC say that the sonars saw, in the world's frame."""
        cloud, decoder = _Series("x", "y"), FrameDecoder()
        for line in self._line_rows:
            if line.pin == self.about.get(TO_PC):
                for frame in decoder.feed(line.content):
                    for point in place(sonar_points(frame), x_m, y_m, heading_rad):
                        cloud.add(line.end, point)
        return cloud


def _text(value: Any) -> str:
    return value if isinstance(value, str) else ""


def _texts(value: Any) -> list[str]:
    return [each for each in value if isinstance(each, str)] if isinstance(value, list) else []


def _source(value: Any) -> dict[str, Any]:
    """The lines around a finding's statement, as they were when it was found."""
    match value:
        case {"first": int() as first, "marked": int() as marked, "lines": list() as lines}:
            return {"source": {"first": first, "marked": marked, "lines": _texts(lines)}}
    return {}


def _readable(content: bytes) -> str:
    """A line as text: a dot for what nobody can read."""
    return "".join(chr(byte) if 0x20 <= byte < 0x7F else "\N{MIDDLE DOT}" for byte in content.strip(b"\r\n"))
