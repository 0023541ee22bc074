"""A soak: hours of virtual time with random faults and orders, one fault after the other.

It finds what a short run does not show: an error of this tool, memory that grows, a second run that differs, a robot
that does not recover when a fault is over.  Each round is a quiet drive, a fault of a random kind with random
parameters and orders meanwhile, its end, and the reaction of a person in the lab: stop, and drive on.  The robot is
switched off and on if it does not drive, if the fault has a lasting effect, or if the firmware has ended.
"""

from __future__ import annotations

import gc
import hashlib
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ, seconds
from hil.bench import Bench
from hil.client.orders import KEYWORDS, LONGEST_ORDER, order, set_reference
from hil.faults import Fault, mount
from hil.faults.all import FAULTS
from hil.faults.kinds import FaultParameter, Value
from hil.machine import FirmwareStopped, Setup
from hil.reports.json_report import findings_of
from hil.reports.model import merged, report_of

#: The world in which neither the firmware as in the C nor the corrected one gets stuck by itself.
WORLD: Final = "paddock"
#: How long a round drives before its fault, how long a fault lasts, and how long the robot has to come back, in s.
QUIET_S: Final = (4.0, 12.0)
FAULT_S: Final = (0.2, 6.0)
BACK_S: Final = 20
#: Less way than this after a fault, in BACK_S: it does not come back by itself.
BACK_M: Final = 0.5
#: How often objects are counted, in s.
EVERY_S: Final = 60.0
#: What they did outlives them: the firmware never sets the gyro up again, a flipped bit stays.
_LASTING: Final = ("brown-out", "gyro-reset", "ram-bit-flip")
_CHARACTERS: Final = b"#MISNTELOPCABR0123456789.,-\r\n\x00\xff"
_FRAME_BEGINS: Final = ord("#")


@dataclass
class SoakResult:
    """The result of a soak.  Times are virtual seconds."""

    seed: int
    corrections: tuple[str, ...]
    seconds: float = 0.0
    travelled_m: float = 0.0
    collisions: int = 0
    frames: int = 0
    orders: int = 0
    #: Kind of a fault -> how many there were; how many of them fired; how many the firmware met.
    mounted: Counter[str] = field(default_factory=Counter)
    fired: Counter[str] = field(default_factory=Counter)
    met: Counter[str] = field(default_factory=Counter)
    #: Kinds that this board cannot have.
    not_here: set[str] = field(default_factory=set)
    #: Each defect once, with how often it was found; its time is that of the soak.
    findings: list[Finding] = field(default_factory=list)
    #: Switched off and on because the firmware had ended: why; because the robot did not come back: after which fault.
    ended: list[str] = field(default_factory=list)
    stranded: list[str] = field(default_factory=list)
    switched_on: int = 0
    #: (time, objects of Python after a collection), every EVERY_S.
    objects: list[tuple[float, int]] = field(default_factory=list)
    #: Whether Ctrl-C ended it.
    interrupted: bool = False
    #: Of all bytes and of all kernel events, over every time that it was switched on.
    uart_sha256: str = ""
    trace_sha256: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON.  Raises ValueError for a wrong policy of the project."""
        return {
            name: dict(sorted(value.items())) if isinstance(value, Counter)
            else sorted(value) if isinstance(value, set) else value
            for name, value in (vars(self) | {"findings": findings_of(report_of(self.findings))}).items()
        }  # fmt: skip


def soak(
    most_s: float, *, seed: int = 1, fixes: tuple[str, ...] = ("all",), world: str = WORLD, xbee: bool = True,
    on_progress: Callable[[SoakResult], object] = lambda soaked: None,
) -> SoakResult:  # fmt: skip
    """Let a robot drive for a virtual time, or until Ctrl-C.  `on_progress` gets the present result after each round.

    The same arguments give the same result, to the byte.  Raises ValueError for an unknown setup; errors of this tool
    are raised, too.
    """
    return _Soak(Setup(world=world, seed=seed, fixes=fixes, xbee=xbee), most_s, on_progress).run()


class _Soak:
    def __init__(self, setup: Setup, most_s: float, on_progress: Callable[[SoakResult], object]) -> None:
        self._setup = setup
        self._most_s = most_s
        self._on_progress = on_progress
        self._over = False
        self._next_count_s = EVERY_S
        self._rng = Random(f"{setup.seed}:soak")
        self._result = SoakResult(setup.seed, setup.fixes)
        self._uart, self._trace = hashlib.sha256(), hashlib.sha256()

    def run(self) -> SoakResult:
        """Run until the time is over."""
        result, setup = self._result, self._setup
        try:
            while not self._over:
                result.switched_on += 1
                self._until_it_is_switched_off(setup)
                # Another robot: its noise is not the same again.
                setup = replace(setup, seed=setup.seed + 1)
        except KeyboardInterrupt:
            result.interrupted = True
        result.uart_sha256, result.trace_sha256 = self._uart.hexdigest(), self._trace.hexdigest()
        return result

    def _until_it_is_switched_off(self, setup: Setup) -> None:
        result, before_s = self._result, self._result.seconds
        bench = Bench(setup)
        bench.uart_sent.connect(self._sent)
        try:
            bench.boot()
            self._order(bench, order("mission"))
            back = True
            while back and not self._over:
                back = self._round(bench)
                result.seconds = before_s + seconds(bench.clock.now)
                self._count_objects()
                self._over = result.seconds >= self._most_s
                self._on_progress(result)
        except FirmwareStopped as reason:
            result.seconds = before_s + seconds(bench.clock.now)
            result.ended.append(f"{result.seconds:.3f} s: {reason}")
        except KeyboardInterrupt:
            result.seconds = before_s + seconds(bench.clock.now)
            result.interrupted = self._over = True
        finally:
            bench.close()
        result.travelled_m += bench.world.travelled_m
        result.collisions += bench.world.robot.collisions
        here = (replace(each, time_cycles=each.time_cycles + round(before_s * SYSCLK_HZ)) for each in bench.findings)
        result.findings = merged([*result.findings, *here])
        self._uart.update(bench.uart_sha256.encode("ascii"))
        self._trace.update(bench.trace_sha256.encode("ascii"))

    def _count_objects(self) -> None:
        if self._result.seconds >= self._next_count_s:
            self._next_count_s += EVERY_S
            gc.collect()
            self._result.objects.append((self._result.seconds, len(gc.get_objects())))

    def _sent(self, byte: int, _cycles: int) -> None:
        self._result.frames += byte == _FRAME_BEGINS

    def _order(self, bench: Bench, data: bytes) -> None:
        self._result.orders += 1
        bench.feed(data)

    def _round(self, bench: Bench) -> bool:
        """Drive, mount a fault, and check whether the robot recovers."""
        rng, result = self._rng, self._result
        bench.run_for(rng.uniform(*QUIET_S))
        fault = self._fault(bench)
        try:
            mounted = mount(fault, bench, from_now=True)
        except ValueError:
            result.not_here.add(fault.kind.name)
            return True
        result.mounted[fault.kind.name] += 1
        for _ in range(rng.randrange(4)):
            bench.run_for(fault.lasts_s / 4)
            self._order(bench, self._anything())
        bench.run_for(fault.lasts_s)
        mounted.remove()
        report = mounted.report()
        result.fired[fault.kind.name] += report.count > 0
        result.met[fault.kind.name] += report.met is not None
        if bench.ended:
            result.ended.append(f"{result.seconds:.3f} s: the watchdog has reset the chip, after {fault}")
            return False
        return self._comes_back(bench, fault) and fault.kind.name not in _LASTING

    def _fault(self, bench: Bench) -> Fault:
        rng = self._rng
        kind = FAULTS[rng.choice(list(FAULTS))]
        own = (*kind.own, *(() if kind.rate is None else (kind.rate,)))
        values = {parameter.name: _value(parameter, bench, rng) for parameter in own}
        return Fault.of(kind.name, {**values, "for": rng.uniform(*FAULT_S), "seed": rng.randrange(1000)})

    def _anything(self) -> bytes:
        """A random order, well-formed or not."""
        rng = self._rng
        match rng.randrange(3):
            case 0:
                return order(rng.choice(list(KEYWORDS)))
            case 1:
                return set_reference(rng.uniform(-0.3, 0.3), rng.uniform(-2.0, 2.0))
        return bytes(rng.choices(_CHARACTERS, k=rng.randrange(1, LONGEST_ORDER)))

    def _comes_back(self, bench: Bench, fault: Fault) -> bool:
        """Whether the robot drives again."""
        begin_m = bench.world.travelled_m
        for keyword in ("stop", "mission"):
            bench.run_for(0.5)
            self._order(bench, order(keyword))
        for _ in range(BACK_S):
            bench.run_for(1.0)
            if bench.world.travelled_m - begin_m > BACK_M:
                return True
        self._result.stranded.append(f"{self._result.seconds:.3f} s: after {fault}")
        return False


def _value(parameter: FaultParameter, bench: Bench, rng: Random) -> Value:
    """A random value of a parameter: one that this board has, or any permitted one."""
    match parameter.name:
        case "input":
            pins = [pin for part in bench.board.parts.values() for pin in part.pins.values()]
            return rng.choice(sorted(pin.removeprefix("ADCIN") for pin in pins if pin.startswith("ADCIN")))
        case "task":
            return rng.choice([task.name for task in bench.board.kernel.tasks.all])
        case "word":
            objects = bench.firmware.linked.objects
            return rng.choice([name for name, obj in objects.items() if not obj.readonly])
    return parameter.drawn(rng)
