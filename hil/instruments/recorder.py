"""Records the events of a running board in a trace file.  Channels that are not recorded cost nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from math import isfinite
from pathlib import Path
from typing import Any, Final, Protocol

from emulator.c28x.findings import Finding
from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, ClockEvent
from emulator.peripherals.spi import CLKPOLARITY
from emulator.pin_functions import PIN_FUNCTIONS
from emulator.registers.cell import Cell
from emulator.signals import SerialFrame
from hil.faces import face_values
from hil.feeds.inputs import inputs
from hil.files import GrowingFile, growing
from hil.instruments.levels import Levels, frame_levels, spi_levels
from hil.instruments.trace_file import FROM_PC, SAMPLE_CYCLES, TO_PC, TraceWriter
from hil.instruments.variables import variables
from hil.reports.accepted import why_accepted
from hil.reports.excerpt import excerpt
from hil.running import RunningBoard
from hil.view.stage import stage_of

#: The time between two samples of variables.
VARIABLE_CYCLES: Final = CYCLES_PER_MS


class EventSink(Protocol):
    """A receiver of events: a `hil.instruments.trace_file.TraceWriter`, or a `hil.page.replay.Replay`."""

    def event(self, cycles: int, channel: str, name: str, value: Any) -> None:
        """Take in an event.  The events of one channel come in the order of time."""


def about_of(machine: RunningBoard, about: Mapping[str, str]) -> dict[str, str]:
    """The head of a trace: what ran, and which pins lead to a PC."""
    pc = machine.board.pc
    pins = {} if pc is None else {TO_PC: f"GPIO{pc.tx_gpio}", FROM_PC: f"GPIO{pc.rx_gpio}"}
    return {**about, **pins}


@contextmanager
def recorded(
    path: str | Path, machine: RunningBoard, channels: tuple[str, ...], about: Mapping[str, str] | None = None
) -> Iterator[GrowingFile]:
    """Record into a file while the context lasts; `about` says what ran.

    If the file cannot be written, the run goes on, and OSError is raised at the end.
    """
    with growing(path, "utf-8") as file:
        recorder = Recorder(machine, TraceWriter(file, channels, about_of(machine, about or {})), channels)
        try:
            yield file
        finally:
            recorder.close()


class Recorder:
    """Listens to a board from now on, until `close`."""

    def __init__(self, machine: RunningBoard, taker: EventSink, channels: Iterable[str]) -> None:
        self._machine = machine
        self._clock = machine.clock
        self._event = taker.event
        self._stops: list[Callable[[], None]] = []
        for channel in channels:
            getattr(self, f"_begin_{channel}")()

    def close(self) -> None:
        """Stop listening."""
        for stop in self._stops:
            stop()
        self._stops.clear()

    def _begin_kernel(self) -> None:
        self._stops.append(self._machine.board.trace.read(self._kernel))

    def _begin_pins(self) -> None:
        names: dict[int, str] = {}
        for name, wire in self._soldered("GPIO"):
            self._event(self._clock.now, "pins", name, wire.level)
            self._stops.append(wire.changed.connect(partial(self._now, "pins", name)))
            names[int(name.partition(" ")[0].removeprefix("GPIO"))] = name
        board = self._machine.board
        for pin, line in board.serial_pins.items():
            if pin in names:
                self._stops.append(line.sent.connect(partial(self._frame_levels, names[pin])))
        for letter, bus in board.spi_bus.items():
            self._stops.append(bus.exchanged.connect(partial(self._word_levels, letter, names)))
            settings = board.blocks[f"Spi{letter.lower()}Regs"].registers["SPICCR"]
            rests = partial(self._clock_rests, letter, names)
            settings.tap(rests)
            self._stops.append(partial(settings.untap, rests))

    def _frame_levels(self, name: str, frame: SerialFrame) -> None:
        self._levels(name, frame_levels(frame))

    def _word_levels(self, letter: str, names: dict[int, str], simo: int, somi: int) -> None:
        board = self._machine.board
        spi = board.spi[letter]
        word = spi_levels(
            self._clock.now - spi.word_cycles, spi.word_bits, spi.bit_cycles(), *spi.clock_scheme, simo, somi
        )
        for line, levels in zip(("CLK", "SIMO", "SOMI"), word, strict=True):
            for pin, mux in PIN_FUNCTIONS[f"SPI{line}{letter}"].items():
                if pin in names and board.gpio.mux(pin) == mux:
                    self._levels(names[pin], levels)

    def _clock_rests(
        self, letter: str, names: dict[int, str], _register: Cell, access: str, word: int, _mask: int
    ) -> None:
        """Record the idle level of CLK when SPICCR is written.  A device sees it before it is selected."""
        if access == "write":
            for pin in PIN_FUNCTIONS[f"SPICLK{letter}"]:
                if pin in names:
                    self._now("pins", names[pin], 1 if word & CLKPOLARITY else 0)

    def _levels(self, name: str, levels: Levels) -> None:
        for cycles, level in levels:
            self._event(cycles, "pins", name, level)

    def _begin_adc(self) -> None:
        for name, wire in self._soldered("ADCIN"):
            self._stops.append(wire.sampled.connect(partial(self._sampled, name)))

    def _begin_sensors(self) -> None:
        for each in inputs(self._machine.board):
            stop = each.log(partial(self._seen, each.name))
            if stop is not None:
                self._stops.append(stop)

    def _begin_spi(self) -> None:
        for bus in self._machine.board.spi_bus.values():
            self._stops.append(bus.exchanged.connect(partial(self._exchanged, bus.name)))

    def _begin_serial(self) -> None:
        for line in self._machine.board.serial_pins.values():
            self._stops.append(line.sent.connect(partial(self._frame, line.name)))

    def _begin_registers(self) -> None:
        for block in self._machine.board.blocks.values():
            for register in block:
                register.tap(self._written)
                self._stops.append(partial(register.untap, self._written))

    def _begin_variables(self) -> None:
        looks = dict(variables(self._machine.firmware.linked))

        def look() -> Iterator[tuple[str, Any]]:
            for name, value in ((name, look()) for name, look in looks.items()):
                if value is not None and isfinite(value):
                    yield name, value

        self._regularly(VARIABLE_CYCLES, "variables", look)

    def _begin_faces(self) -> None:
        board = self._machine.board

        def look() -> Iterator[tuple[str, Any]]:
            for part, face, value in face_values(board):
                if value is not None and isfinite(value):
                    yield f"{part}.{face}", value

        def tell_the_end() -> None:
            for name, value in look():
                self._now("faces", name, value)

        self._regularly(SAMPLE_CYCLES, "faces", look)
        self._stops.append(tell_the_end)

    def _begin_scene(self) -> None:
        stage = stage_of(self._machine)
        if stage is None:
            return
        seen = 0

        def look() -> Iterable[tuple[str, Any]]:
            nonlocal seen
            for cycles, text in stage.happened[seen:]:
                self._event(cycles, "scene", "happened", text)
            seen = len(stage.happened)
            return stage.tell().items()

        self._regularly(SAMPLE_CYCLES, "scene", look)

    def _regularly(self, cycles: int, channel: str, look: Callable[[], Iterable[tuple[str, Any]]]) -> None:
        """Record the values that `look` gives, each `cycles` cycles, if they have changed."""
        known: dict[str, Any] = {}
        due: ClockEvent | None = None

        def tell() -> None:
            nonlocal due
            for name, value in look():
                if known.get(name) != value:
                    known[name] = value
                    self._now(channel, name, value)
            due = self._clock.after(cycles, tell)

        due = self._clock.after(0, tell)
        self._stops.append(lambda: self._clock.cancel(due))

    def _begin_findings(self) -> None:
        for finding in self._machine.findings:
            self._found(finding)
        self._stops.append(self._machine.findings.found.connect(self._found))

    def _now(self, channel: str, name: str, value: Any) -> None:
        self._event(self._clock.now, channel, name, value)

    def _kernel(self, cycles: int, kind: str, name: str) -> None:
        self._event(cycles, "kernel", kind, name)

    def _sampled(self, name: str, cycles: int, volts: float) -> None:
        self._event(cycles, "adc", name, volts)

    def _seen(self, name: str, cycles: int, value: float) -> None:
        self._event(cycles, "sensors", name, value)

    def _exchanged(self, name: str, sent: int, received: int) -> None:
        self._now("spi", name, [sent & 0xFFFF, received & 0xFFFF])

    def _frame(self, name: str, frame: SerialFrame) -> None:
        self._event(frame.end, "serial", name, frame.data & 0xFFFF)

    def _written(self, register: Cell, access: str, word: int, _mask: int) -> None:
        if access == "write":
            self._now("registers", f"{register.block.name}.{register.name}", word & 0xFFFFFFFF)

    def _found(self, finding: Finding) -> None:
        value: dict[str, Any] = {
            "message": finding.message, "object": finding.object, "place": str(finding.place or ""),
            "task": finding.task,
        }  # fmt: skip
        if finding.details:
            value["details"] = list(finding.details)
        if len(finding.call_path) > 1:
            value["called_from"] = [str(place) for place in finding.call_path[1:]]
        if finding.place is not None and (lines := excerpt(finding.place.file, finding.place.line)):
            # The source as it is now: when the trace is read, the file may have changed.
            texts = [line.text for line in lines]
            value["source"] = {"first": lines[0].number, "marked": finding.place.line, "lines": texts}
        if reason := why_accepted(finding):
            value["accepted"] = reason
        self._event(finding.time_cycles, "findings", finding.rule, value)

    def _soldered(self, kind: str) -> Iterator[tuple[str, Any]]:
        """The pins that are connected to parts: their names and wires."""
        board = self._machine.board
        for part in board.parts.values():
            for signal, pin in part.pins.items():
                if not pin.startswith(kind):
                    continue
                name = f"{pin} {part.name}.{signal}"
                if kind == "GPIO":
                    yield name, board.pins[int(pin.removeprefix(kind))]
                else:
                    yield name, board.analog[pin[5]][int(pin[6:])]

    def _begin_pose(self) -> None:
        world = getattr(self._machine, "world", None)
        if world is None:
            return
        for name, path in (("true", world.path), ("odometry", getattr(self._machine, "odometry"))):  # noqa: B009
            for point in path.points():
                self._point(name, *point)
            self._stops.append(path.added.connect(partial(self._point, name)))

    def _point(self, name: str, time_s: float, x_m: float, y_m: float, heading_rad: float) -> None:
        self._event(round(time_s * SYSCLK_HZ), "pose", name, [x_m, y_m, heading_rad])
