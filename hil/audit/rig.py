"""The rigs of demonstrations: one board with the firmware, or the whole robot, with or without corrections.

rig = Rig(fixes)                 # board and linked drivers, no kernel running: call functions of the firmware
with robot(fixes) as bench:      # the whole robot, booted, in a world
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final

from emulator.c28x.findings import Finding, Findings
from emulator.c28x.objects import Array
from emulator.c28x.runtime import EndlessPoll
from emulator.clock import SYSCLK_HZ
from emulator.image import Firmware
from firmware_model.corrections import ALL
from firmware_model.image import MODULES, link
from hil.audit import templates
from hil.bench import Bench
from hil.golden.scripted_gyro import ScriptedGyro
from hil.machine import Setup
from hil.robot.board import GYRO_CS_GPIO, RobotBoard
from hil.world.maps import WorldMap

#: A tick of the kernel's clock.
TICK_S: Final = 1e-3
#: The modules that many demonstrations link alone: `Rig(fixes, modules=ALONE["us"])`.
ALONE: Final = {name: (f"firmware_model.{name}",) for name in ("us", "gyro", "odometry", "protocol")}


@dataclass(frozen=True, slots=True)
class Variant:
    """The firmware of a demonstration: corrections by id (or "all"), and C files that replace modules."""

    fixes: frozenset[str] = frozenset()
    #: C files, folders of headers, macros: as in `Setup`.
    firmware: tuple[str, ...] = ()
    include: tuple[str, ...] = ()
    defines: tuple[str, ...] = ()

    @classmethod
    def of(cls, fixes: Variant | Iterable[str]) -> Variant:
        """The variant for `fixes`; corrections alone mean the port with these corrections."""
        return fixes if isinstance(fixes, Variant) else cls(frozenset(fixes))

    def __contains__(self, name: str) -> bool:
        return name in self.fixes

    @property
    def common(self) -> bool:
        """Whether it has no corrections, or all: every entry runs on these two."""
        return self.fixes in (frozenset(), frozenset({ALL}))


#: The argument of a demonstration: corrections by id (or "all"), or a whole variant.
Fixes = frozenset[str] | Variant


@dataclass(frozen=True, slots=True)
class BoardOrder:
    """A board without firmware."""

    ideal: bool
    seed: int
    sonars_powered_up: bool

    @property
    def common(self) -> bool:
        """True, because every rig has a board."""
        return True

    def make(self) -> RobotBoard:
        """Assemble it."""
        return RobotBoard(seed=self.seed, ideal=self.ideal, sonars_powered_up=self.sonars_powered_up)


@dataclass(frozen=True, slots=True)
class RigOrder:
    """A board with linked drivers: all options of the linking.  `replaced` are names that get other functions later."""

    variant: Variant
    fill: str
    modules: tuple[str, ...]
    replaced: frozenset[str]
    float_to_int: str
    room: frozenset[tuple[str, int]]
    keep_locals: bool
    static: bool
    board: BoardOrder

    @property
    def common(self) -> bool:
        """Whether other demonstrations will probably need the same: replaced functions are rarely shared."""
        return self.variant.common and len(self.replaced) == 1

    def make(self) -> tuple[RobotBoard, Firmware]:
        """Link it."""
        board = templates.take(self.board)
        fw = link(
            board, modules=self.modules, fill=self.fill, externs=dict.fromkeys(self.replaced, _not_there),
            fixes=self.variant.fixes, firmware=self.variant.firmware, include=self.variant.include,
            defines=self.variant.defines, float_to_int=self.float_to_int, room=dict(self.room),
            keep_locals=self.keep_locals, static=self.static,
        )  # fmt: skip
        return board, fw


def _not_there(*_arguments: Any) -> Any:
    raise RuntimeError("called before its stand-in was put in place")


@dataclass(frozen=True, slots=True)
class RobotOrder:
    """The whole robot; `boot`: run through its start-up."""

    setup: Setup
    boot: bool
    world_map: WorldMap | None = None

    @property
    def common(self) -> bool:
        """Whether other demonstrations will probably need the same robot."""
        return self.world_map is None and Variant(frozenset(self.setup.fixes)).common

    def make(self) -> Bench:
        """Link it and boot it."""
        bench = Bench(self.setup, traced=False, world_map=self.world_map)
        if self.boot:
            try:
                bench.boot()
            except BaseException:
                bench.close()
                raise
        return bench


class Rig:
    """One board with ideal devices and the linked firmware; its functions are called one by one.

    All detectors are on, but those that look for errors between threads, because there are none, and without `static`
    the static checks, which take half as long as all the rest.  Task_sleep waits.  Semaphores and gates need tasks: use
    `robot`, or replace them in `externs`.
    """

    def __init__(
        self, fixes: Variant | Iterable[str] = (), *, fill: str = "zero", modules: Sequence[str] = MODULES,
        externs: Mapping[str, Callable[..., Any]] | None = None, float_to_int: str = "saturate",
        room: Mapping[str, int] | None = None, keep_locals: bool = False, static: bool = False, ideal: bool = True,
        seed: int = 1, sonars_powered_up: bool = True,
    ) -> None:  # fmt: skip
        standing_in: dict[str, Callable[..., Any]] = {"Task_sleep": lambda ticks: self.wait(ticks * TICK_S)}
        standing_in |= dict(externs or {})
        self.board, self.fw = templates.take(RigOrder(
            Variant.of(fixes), fill, tuple(modules), frozenset(standing_in), float_to_int,
            frozenset((room or {}).items()), keep_locals, static, BoardOrder(ideal, seed, sonars_powered_up),
        ))  # fmt: skip
        for name, function in standing_in.items():
            self.fw.linked.replace(name, function)
        self.findings = self.board.findings
        self.findings.found.connect(self._found)

    def _found(self, finding: Finding) -> None:
        if finding.rule == "endless-poll":
            raise EndlessPoll(finding.message)

    def codes(self, codes: Iterable[int] | Callable[[int], int] | None) -> None:
        """Set the results of the next conversions, whatever the voltage."""
        self.board.adc["A"].force_codes(codes)

    def scripted_gyro(self) -> ScriptedGyro:
        """Replace the gyro by a slave whose registers the demonstration sets."""
        gyro = ScriptedGyro()
        self.board.spi_bus["A"].attach(self.board.pins[GYRO_CS_GPIO], gyro)
        return gyro

    def wait(self, duration_s: float) -> None:
        """Let virtual time pass with the CPU idle."""
        self.board.clock.delay(round(duration_s * SYSCLK_HZ))

    def frame(self, text: str, room: int = 200) -> Array:
        """A buffer that holds `text` and a NUL; the words after it were never written."""
        return self.fw.array("char", [*(ord(c) for c in text), 0, *[None] * max(0, room - len(text) - 1)])

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a firmware function.  A poll that nothing can end is a finding; the result is then None."""
        try:
            return function(*arguments)
        except EndlessPoll:
            return None


@contextmanager
def robot(
    fixes: Variant | Iterable[str] = (), *, world: str = "corridor", boot: bool = True,
    world_map: WorldMap | None = None, **setup: Any,
) -> Iterator[Bench]:  # fmt: skip
    """The whole robot in a world (a name, or a map), booted (2.2 s of virtual time); ideal, unless `realistic=True`.

    There are no static checks: a rig shows what they find.
    """
    options: dict[str, Any] = {"realistic": False, "watch": True} | setup
    variant = Variant.of(fixes)
    own: dict[str, Any] = {"firmware": variant.firmware, "include": variant.include, "defines": variant.defines}
    order = Setup(world=world, fixes=tuple(sorted(variant.fixes)), **own, **options)
    bench = templates.take(RobotOrder(order, boot, world_map))
    try:
        yield bench
    finally:
        bench.close()


def static_findings(fixes: Variant | Iterable[str]) -> Findings:
    """What the static checks find in the firmware with these corrections."""
    return Rig(fixes, static=True).findings


def of(findings: Iterable[Finding], rule: str) -> list[Finding]:
    """The findings of one rule."""
    return [finding for finding in findings if finding.rule == rule]
