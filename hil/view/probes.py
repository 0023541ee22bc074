"""Records for the scope: signals against time, and the events of the kernel.

The names of signals are those of the list:

| name | what | recorded |
|---|---|---|
| `servidores.ROBOT_Reference.V` | a scalar of the firmware at file scope | every `period_cycles` |
| `AdcaRegs.ADCCTL2`, `AdcaRegs.ADCCTL2.PRESCALE` | a register's stored word, a field of it | every `period_cycles` |
| `GPIO69` | a wire: 0 or 1 | at every edge |
| `ADCIN0` | a voltage | whenever the ADC samples it |
| `duty GPIO2` | a PWM output: 0..1 | at every change |
| `byte GPIO89` | a character on a serial line | each, from its start bit to its stop bit |
| `SIMO SPI-A`, `SOMI SPI-A` | a word on the SPI, to and from the device | each, from its first to its last bit |
| `edges GPIO20/21` | an encoder's pair A/B: its edges so far | as the shaft is moved |
| `gate US_server` | 1 while a task owns it | at every enter and leave |
| `face infrared.distance_m` | the value of a face of a part, if the part shows it | every `period_cycles` |
| `world v_m_s` | a quantity of the world around the board, if there is one | every `period_cycles` |

Recording does not change the run: it reads no register and does not integrate the world.  The buffers are bounded; the
oldest values are dropped.

Not recorded: voltages between the samples of the ADC (because reading one may change the device), locals of functions.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.c28x.ctypes import part_name, scalars
from emulator.clock import CYCLES_PER_MS
from emulator.sysbios.gate_mutex_pri import GateMutexPri
from hil.board import Board, Part
from hil.instruments.variables import VariableReader, variable
from hil.running import RunningBoard
from hil.view.checkpoints import RewindableRun
from hil.view.words import DecodedWord, SpiTransfer, character

#: CHOICE: 5 ms between two samples show tasks with a period of 20 ms.  The user can change it.
PERIOD_CYCLES: Final = 5 * CYCLES_PER_MS
#: The values that are kept of each signal (100 s at 5 ms), and the events of the kernel (about 14 s of a mission).
MAX_VALUES: Final = 20_000
MAX_EVENTS: Final = 100_000

Sample = tuple[int, float]


class Probes:
    """The recorded signals of the present run.  Only the machine's thread may use it."""

    def __init__(self) -> None:
        self.period_cycles = PERIOD_CYCLES
        self.events: deque[tuple[int, str, str]] = deque(maxlen=MAX_EVENTS)
        self._values: dict[str, deque[Sample]] = {}
        #: The words of signals that are words, with their times and meanings.
        self._words: dict[str, deque[DecodedWord]] = {}
        self._looks: dict[str, VariableReader] = {}
        #: The functions that stop listening to a wire.
        self._stops: dict[str, Callable[[], None]] = {}
        self._run: RewindableRun | None = None
        self._sampling = False
        self._gates: dict[str, str] = {}

    def attach(self, run: RewindableRun) -> None:
        """Record the same signals of another machine, from its beginning."""
        self._run = run
        self._looks.clear()
        for stop in self._stops.values():
            stop()
        self._stops.clear()
        self._gates.clear()
        self._sampling = False
        self.events.clear()
        run.bench.board.trace.listen(self._event)
        for name in list(self._values):
            self._values[name].clear()
            if name in self._words:
                self._words[name].clear()
            self._connect(name)

    @property
    def names(self) -> list[str]:
        """The recorded signals."""
        return list(self._values)

    def add(self, name: str) -> None:
        """Record a signal from now on.  Raises ValueError for an unknown name."""
        if name not in self._values:
            self._values[name] = deque(maxlen=MAX_VALUES)
            if is_words(name):
                self._words[name] = deque(maxlen=MAX_VALUES)
            try:
                self._connect(name)
            except ValueError:
                del self._values[name]
                self._words.pop(name, None)
                raise

    def remove(self, name: str) -> None:
        """Stop recording a signal."""
        self._values.pop(name, None)
        self._words.pop(name, None)
        self._looks.pop(name, None)
        stop = self._stops.pop(name, None)
        if stop is not None:
            stop()

    def set_period(self, cycles: int) -> None:
        """Set the sampling period from the next sample on.  Raises ValueError for less than a cycle."""
        if cycles < 1:
            raise ValueError(f"a period of {cycles} cycles: must be 1 or more")
        self.period_cycles = cycles

    def values(self, name: str, since: int) -> list[Sample]:
        """The samples of a signal from a time on, and the one before, whose value is still valid at that time."""
        found: list[Sample] = []
        for sample in reversed(self._values.get(name, ())):
            found.append(sample)
            if sample[0] < since:
                break
        return found[::-1]

    def words(self, name: str, begin: int, end: int) -> list[DecodedWord]:
        """The words of a line that are visible between two times."""
        found: list[DecodedWord] = []
        for word in reversed(self._words.get(name, ())):
            if word.end < begin:
                break
            if word.begin <= end:
                found.append(word)
        return found[::-1]

    def events_between(self, begin: int, end: int) -> list[tuple[int, str, str]]:
        """The kept events of the kernel up to `end`, from the last task switch before `begin` on."""
        found: list[tuple[int, str, str]] = []
        for event in reversed(self.events):
            if event[0] > end:
                continue
            found.append(event)
            if event[0] < begin and event[1] == "switch":
                break
        return found[::-1]

    # Connecting

    def _connect(self, name: str) -> None:
        run = self._run
        if run is None:
            return
        bench, board = run.bench, run.bench.board
        if name.startswith("gate "):
            # Before power-up, a machine has no gates.
            if bench.clock.now and name.removeprefix("gate ") not in gates(bench).values():
                raise ValueError(f"no gate {name.removeprefix('gate ')!r}")
            self._put(name, 0.0)
        elif name.startswith("duty "):
            wire = board.pwm_outputs.get(name.removeprefix("duty "))
            if wire is None:
                raise ValueError(f"no PWM output {name.removeprefix('duty ')!r}")
            self._put(name, wire.duty)
            self._stops[name] = wire.duty_changed.connect(lambda: self._put(name, wire.duty))
        elif name.startswith("byte "):
            line = board.serial_pins.get(pin_number(name.removeprefix("byte ")))
            if line is None:
                raise ValueError(f"no serial line {name.removeprefix('byte ')!r}")
            self._stops[name] = line.sent.connect(
                lambda frame: self._put_word(
                    name, DecodedWord(frame.start, frame.end, frame.data, character(frame.data))
                )
            )
        elif name in (lines := _spi_lines(board)):
            self._stops[name] = self._on_spi_word(name, board, *lines[name])
        elif name.startswith("edges "):
            pairs = {wire.name: wire for wire in board.encoder_pins.values()}
            pair = pairs.get(name.removeprefix("edges "))
            if pair is None:
                raise ValueError(f"no encoder's pair {name.removeprefix('edges ')!r}")
            self._put(name, float(pair.position))
            self._stops[name] = pair.moved.connect(lambda *_: self._put(name, float(pair.position)))
        elif name in (wires := {wire.name: wire for inputs in board.analog.values() for wire in inputs}):
            self._stops[name] = wires[name].sampled.connect(lambda cycles, volts: self._put(name, volts, cycles))
        elif (number := pin_number(name)) >= 0:
            if number >= len(board.pins):
                raise ValueError(f"no pin {name}: GPIO0 to GPIO{len(board.pins) - 1}")
            pin = board.pins[number]
            self._put(name, float(pin.level))
            self._stops[name] = pin.changed.connect(lambda level: self._put(name, float(level)))
        else:
            self._looks[name] = look_at(run, name)
            if not self._sampling:
                self._sampling = True
                self._sample()

    def _put(self, name: str, value: float, cycles: int | None = None) -> None:
        values = self._values.get(name)
        if values is not None and self._run is not None:
            values.append((self._run.clock.now if cycles is None else cycles, value))

    def _put_word(self, name: str, word: DecodedWord) -> None:
        words = self._words.get(name)
        if words is not None:
            words.append(word)
            self._put(name, float(word.value))

    def _on_spi_word(self, name: str, board: Board, letter: str, line_index: int) -> Callable[[], None]:
        bus, spi = board.spi_bus[letter], board.spi[letter]
        devices = {pin: part.device for part in board.parts.values() if (pin := part.pins.get("CS"))}
        transfer = SpiTransfer(
            (select, devices[select.name])
            for select in bus.selects
            if hasattr(devices.get(select.name), "register_names")
        )

        def exchanged(simo: int, somi: int) -> None:
            meaning = transfer.meanings(simo, spi.word_bits)[line_index]
            now = board.clock.now
            self._put_word(name, DecodedWord(now - spi.word_cycles, now, (simo, somi)[line_index], meaning))

        stops = bus.exchanged.connect(exchanged), bus.deselected.connect(lambda _select: transfer.end())

        def stop() -> None:
            for each in stops:
                each()

        return stop

    def _sample(self) -> None:
        run = self._run
        assert run is not None
        if not self._looks:
            self._sampling = False
            return
        now = run.clock.now
        for name, look in self._looks.items():
            value = look()
            if value is not None:
                self._values[name].append((now, value))
        run.clock.after(self.period_cycles, self._sample_of(run))

    def _sample_of(self, run: RewindableRun) -> Callable[[], None]:
        def sample() -> None:
            if self._run is run:
                self._sample()

        return sample

    def _event(self, cycles: int, kind: str, name: str) -> None:
        self.events.append((cycles, kind, name))
        if kind in ("gate enter", "gate leave") and self._run is not None and self._values:
            if name not in self._gates:
                self._gates = gates(self._run.bench)
            signal = f"gate {self._gates.get(name, name)}"
            if signal in self._values:
                self._put(signal, 1.0 if kind == "gate enter" else 0.0)


def gates(bench: RunningBoard) -> dict[str, str]:
    """The name of a gate in the trace -> the object of the firmware with its handle."""
    found: dict[str, str] = {}
    for path, obj in bench.firmware.linked.objects.items():
        value = obj.data[0] if len(obj.data) == 1 else None
        if isinstance(value, GateMutexPri):
            found[value.name] = path.partition(".")[2]
    return found


def is_words(name: str) -> bool:
    """Whether a signal consists of words, which have a begin and an end, and not of values."""
    return name.startswith(("byte ", "SIMO ", "SOMI "))


def pin_number(name: str) -> int:
    """The number of `GPIOn`; -1 for another name."""
    digits = name.removeprefix("GPIO")
    return int(digits) if digits != name and digits.isdecimal() else -1


def look_at(run: RewindableRun, name: str) -> VariableReader:
    """The function that reads a variable, register, field, face or quantity of the world.  Raises ValueError."""
    bench = run.bench
    world = {} if run.stage is None else run.stage.signals
    if name in world:
        return world[name]
    faces = faces_of(bench.board)
    if name in faces:
        part, face = faces[name]
        return partial(part.value, face)
    first, _, rest = name.partition(".")
    block = bench.board.blocks.get(first)
    if block is not None:
        register_name, field_name = rest, ""
        if rest not in block.registers and "." in rest:
            register_name, _, field_name = rest.rpartition(".")
        register = block.registers.get(register_name)
        if register is None:
            raise ValueError(f"{first} has no register {register_name!r}")
        if not field_name:
            return lambda: float(register.value)
        field = register.fields.get(field_name)
        if field is None:
            raise ValueError(f"{first}.{register_name} has no field {field_name!r}")
        return lambda: float((register.value & field.mask) >> field.lo)
    look = variable(bench.firmware.linked, name)
    if look is None:
        raise ValueError(f"no signal {name!r}")
    return look


def _spi_lines(board: Board) -> dict[str, tuple[str, int]]:
    """The name of each line of the SPI buses -> the letter of its bus, and which of a word's two values it has."""
    lines = ("SIMO", "SOMI")
    return {f"{line} {bus.name}": (x, i) for x, bus in board.spi_bus.items() for i, line in enumerate(lines)}


def faces_of(board: Board) -> dict[str, tuple[Part, str]]:
    """The name of each signal that is a face -> its part, and the face.  Only faces whose values a part shows."""
    return {
        f"face {part.name}.{face.name}": (part, face.name)
        for part in board.parts.values()
        for face in part.faces
        if part.value(face.name) is not None
    }


def soldered(board: Board) -> dict[str, str]:
    """The name of a signal -> the part that is connected there: `GPIO66` -> `thermometer CS`."""
    inputs = {f"ADCIN{adc}{n}": wire.name for adc, wires in board.analog.items() for n, wire in enumerate(wires)}
    found: dict[str, list[str]] = {}
    for part in board.parts.values():
        for signal, pin in part.pins.items():
            found.setdefault(inputs.get(pin, pin), []).append(f"{part.name} {signal}")
    return {name: ", ".join(parts) for name, parts in found.items()}


def labels(run: RewindableRun) -> dict[str, str]:
    """All names that can be recorded -> their labels in the list, with the parts of the board."""
    there = soldered(run.bench.board)
    return {name: f"{name} ({there[name]})" if name in there else name for name in signals(run)}


def signals(run: RewindableRun) -> list[str]:
    """All names that can be recorded: first those of the board, then those of the chip."""
    bench = run.bench
    names: list[str] = list(faces_of(bench.board))
    for path, obj in bench.firmware.linked.objects.items():
        ctype = obj.declaration.ctype
        parts = scalars(ctype)
        if any(isinstance(value, int | float) or value is None for value in obj.data):
            names += [path + part_name(ctype, offset) for offset, _ in parts]
    names += [f"gate {name}" for name in gates(bench).values()]
    names += [] if run.stage is None else run.stage.signals
    names += [f"duty {name}" for name in bench.board.pwm_outputs]
    names += [pin.name for pin in bench.board.pins]
    names += dict.fromkeys(wire.name for inputs in bench.board.analog.values() for wire in inputs)
    names += [f"byte GPIO{pin}" for pin in bench.board.serial_pins]
    names += _spi_lines(bench.board)
    names += [f"edges {wire.name}" for wire in bench.board.encoder_pins.values()]
    for block in bench.board.blocks.values():
        for register in block:
            names.append(register.path)
            names += [f"{register.path}.{field}" for field in register.fields if len(register.fields) > 1]
    return names
