"""Boards: a chip, and what is soldered to it.

    class Station(Board):
        \"\"\"A thermometer on SPI-B and an infrared distance sensor on ADC-B.\"\"\"

        vrefhi_v = 3.0
        spi_pins = {"B": (63, 64, 65)}

        def solder(self) -> None:
            self.thermometer = self.on_spi("thermometer", Thermometer(), bus="B", select=66)
            self.infrared = self.on_adc("infrared", Infrared(), adc="B", channel=3, faces=[Face("distance_m", "m")])

A board is a class, so that every run has a fresh one.  Whoever wants a part asks for it: by its name, or by its kind.
How to make a part of one's own: README.md, "A board of one's own".
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from math import inf
from pathlib import Path
from random import Random
from traceback import extract_tb
from typing import Any, ClassVar, Final, NamedTuple, Protocol, TypeVar

from emulator.can_bus import CanPart
from emulator.chip import GPIO_COUNT, I2C_PIE, SPI_PIE
from emulator.device_reports import Reports
from emulator.devices.wire_link import WireLink
from emulator.image import Firmware
from emulator.signal import Signal
from emulator.signals import I2cTarget, SpiSlave
from emulator.sysbios.heap_mem import HEAP_WORDS
from emulator.system import KERNEL_COST_SCALE, System

_SPI_SIGNALS: Final = ("SIMO", "SOMI", "CLK")
_I2C_SIGNALS: Final = ("SDA", "SCL")

T = TypeVar("T")
Slave = TypeVar("Slave", bound=SpiSlave)
Target = TypeVar("Target", bound=I2cTarget)
Node = TypeVar("Node", bound=CanPart)


class VoltageSource(Protocol):
    """A part at an analog input."""

    def volts(self, cycles: int) -> float:
        """Its voltage at a virtual time."""


Analog = TypeVar("Analog", bound=VoltageSource)
B = TypeVar("B", bound="Board")


class PcLine(Protocol):
    """The PC's end of a serial line: `WireLink`, `XBeeLink`."""

    @property
    def received(self) -> Signal[bytes, int]:
        """(data, cycles): the PC has bytes of the chip."""

    @property
    def pending_to_robot(self) -> int:
        """Bytes fed that the chip has not received yet."""

    def feed(self, data: bytes) -> None:
        """Bytes written by the PC now."""


class Pc(NamedTuple):
    """Where a PC is connected: pins of the chip's transmitter and receiver, bits a second, and the line."""

    tx_gpio: int
    rx_gpio: int
    baud: int
    line: PcLine


@dataclass(frozen=True)
class Face:
    """What the world does to a part, or sees of it: one number, an attribute of the part if nothing else is said."""

    name: str
    unit: str
    #: What it can be.
    low: float = -inf
    high: float = inf
    #: How it is set where it is no attribute.
    set: Callable[[float], None] | None = None
    #: What it is now, where it is no attribute, None if that is not known: it must not change anything to ask.
    get: Callable[[], float | None] | None = None

    def __str__(self) -> str:
        """Name, unit and range: `distance_m (m, 0.08 to 2)`."""
        said = ", ".join(filter(None, (self.unit, self.range)))
        return f"{self.name} ({said})" if said else self.name

    @property
    def range(self) -> str:
        """What it can be, in words; empty if that is anything."""
        if self.low == -inf and self.high == inf:
            return ""
        if self.low == -inf:
            return f"at most {self.high:g}"
        return f"at least {self.low:g}" if self.high == inf else f"{self.low:g} to {self.high:g}"


@dataclass(frozen=True)
class Part:
    """One part of a board: what it is, the chip's pins at its own, and its faces to the world."""

    name: str
    device: Any
    #: Its signal -> the pin of the chip: `GPIO61`, `ADCINB3`.
    pins: Mapping[str, str] = field(default_factory=dict)
    faces: Sequence[Face] = ()

    @property
    def kind(self) -> str:
        """The name of its class."""
        return type(self.device).__name__

    def face(self, name: str) -> Face:
        """The face called `name`.  Raises ValueError."""
        for face in self.faces:
            if face.name == name:
                return face
        known = ", ".join(map(str, self.faces)) or "none"
        raise ValueError(f"the part {self.name!r} has no face {name!r}: {known}")

    def check(self, name: str, value: float) -> None:
        """Raises ValueError for a face that there is not, that is only seen, and for a value that it cannot have."""
        face = self.face(name)
        if not face.low <= value <= face.high:
            unit = f"({face.unit})" if "=" in face.unit else face.unit  # what its numbers stand for
            raise ValueError(f"{self.name}.{name} = {value:g}: must be {face.range or 'a number of'} {unit}")
        if not self.is_set(name):
            raise ValueError(f"{self.name}.{name} can only be read: the part computes it")

    def put(self, name: str, value: float) -> None:
        """Set a face.  Raises ValueError as `check` does."""
        self.check(name, value)
        face = self.face(name)
        if face.set is not None:
            face.set(value)
        else:
            setattr(self.device, name, value)

    def is_set(self, name: str) -> bool:
        """Whether a face can be set: one that the part works out (a property, or `get` alone) is only seen."""
        face, attribute = self.face(name), getattr(type(self.device), name, None)
        if face.set is not None:
            return True
        return face.get is None and (not isinstance(attribute, property) or attribute.fset is not None)

    def value(self, name: str) -> float | None:
        """What a face is now; None if the part does not tell, or fails to: a look must not end a run."""
        face = self.face(name)
        try:
            if face.get is not None:
                value: Any = face.get()
                return None if value is None else float(value)
            value = None if face.set is not None else getattr(self.device, name, None)
        except Exception:
            return None
        return float(value) if isinstance(value, int | float) else None


@dataclass(frozen=True)
class Project:
    """The firmware that belongs to a board: a package with the modules `image`, `headers`, `c_files`, `catalogue`,
    `corrections`.

    It is imported when something of it is wanted.
    """

    package: str

    def has(self, module: str) -> bool:
        """Whether a module is one of its own."""
        return module.startswith(f"{self.package}.")

    def link(self, board: Board, modules: Sequence[str] | None = None, **options: Any) -> Firmware:
        """Link all of it to a board, or only these modules."""
        image: Any = import_module(f"{self.package}.image")
        linked: Firmware = image.link(board, **options, **({} if modules is None else {"modules": modules}))
        return linked

    def header(self, name: str) -> str | None:
        """The text of a header that its C files include, and that nobody else has."""
        text: str | None = import_module(f"{self.package}.headers").text(name)
        return text

    def library(self, function: str) -> str | None:
        """The module that defines a function which its C files only declare."""
        module: str | None = import_module(f"{self.package}.c_files").library(function)
        return module

    def corrects(self, defect: str) -> bool:
        """Whether its catalogue has a defect of this name, so that a correction can be asked for."""
        return defect in import_module(f"{self.package}.catalogue").CATALOGUE

    def corrections(self, fixes: Sequence[str]) -> frozenset[str]:
        """The corrections that `fixes` names, `all` expanded.  Raises ValueError for an unknown one."""
        chosen: frozenset[str] = import_module(f"{self.package}.corrections").resolve(fixes)
        return chosen


class Board(System):
    """A chip with its parts.  A board of one's own says in `solder` what is connected where.

    `seed` decides everything that varies between specimens and runs, `ideal` gives parts without noise, tolerance or
    bounce: `rng("infrared")` is a part's own source of chance.
    """

    #: The firmware that belongs to it; None: only what a user names.
    project: ClassVar[Project | None] = None
    #: The module whose `Bench` puts it into a world; None: it has no wheels, and its parts see what is put to them.
    bench: ClassVar[str | None] = None
    #: The package with what the browser shows of that world (`hil.view.stage`); None: the board is all there is.
    view: ClassVar[str | None] = None
    vrefhi_v: ClassVar[float] = 3.0
    #: Resistors to a supply or to ground: GPIO -> level.
    pulls: ClassVar[Mapping[int, int]] = {}
    #: The pins (SIMO, SOMI, CLK) of each SPI that has a bus; others take any pins that firmware chooses.
    spi_pins: ClassVar[Mapping[str, tuple[int, int, int]]] = {}
    #: The pins (SDA, SCL) of each I2C that has a bus, with its pull-ups; others take any pins.
    i2c_pins: ClassVar[Mapping[str, tuple[int, int]]] = {}
    #: Factor on what the kernel's calls cost.
    kernel_cost_scale: ClassVar[float] = KERNEL_COST_SCALE
    #: Words of the heap behind `malloc`: what the linker is told by `-heap` or `-heap_size`, SYS/BIOS by BIOS.heapSize.
    heap_words: ClassVar[int] = HEAP_WORDS

    def __init__(self, *, seed: int = 0, ideal: bool = True) -> None:
        self._check_pins()
        super().__init__(
            seed=seed, ideal=ideal, vrefhi_v=self.vrefhi_v, board_pulls=self.pulls, spi_pins=self.spi_pins,
            i2c_pins=self.i2c_pins, kernel_cost_scale=self.kernel_cost_scale,
            heap_words=self.heap_words,
        )  # fmt: skip
        #: What parts report becomes a finding at the driver's statement.
        self.reports = Reports(self.findings)
        self.parts: dict[str, Part] = {}
        #: Address or chip select of a bus -> the part there.
        self._places: dict[str, str] = {}
        #: Where a PC is connected, if one is.
        self.pc: Pc | None = None
        self.solder()

    def solder(self) -> None:
        """Connect every part; a board without any is a bare chip."""

    def rng(self, part: str) -> Random:
        """A part's own source of chance, from the board's seed."""
        return Random(f"{self.seed}:{part}")

    # Soldering

    def add(self, name: str, device: T, *, pins: Mapping[str, str] | None = None, faces: Sequence[Face] = ()) -> T:
        """Enter a part that has its wires already; gives the part.

        Raises ValueError for a name in use, and for a face that is no attribute of the part and says neither how it is
        set nor what it is.
        """
        if name in self.parts:
            raise ValueError(f"{type(self).__name__} has two parts called {name!r}")
        for face in faces:
            told = face.set is not None or face.get is not None
            # A property is there, whatever it says now.
            if not told and not hasattr(type(device), face.name) and not hasattr(device, face.name):
                raise ValueError(f"the part {name!r} has no attribute {face.name!r} for its face, which has no set=")
        self.parts[name] = Part(name, device, dict(pins or {}), tuple(faces))
        return device

    def on_spi(self, name: str, device: Slave, *, bus: str, select: int, faces: Sequence[Face] = ()) -> Slave:
        """Hang a part on SPI-`bus`, selected by a low GPIO`select`: it has `select(level)` and `exchange(...)`.

        Raises ValueError for a bus or a pin that there is not, and for a select that another part of the bus has.
        """
        if bus not in self.spi_bus:
            raise ValueError(f"{name} on SPI-{bus}: this chip has {', '.join(f'SPI-{x}' for x in self.spi_bus)}")
        pin = self.pins[self._gpio(name, select)]
        place = f"chip select GPIO{select} of SPI-{bus}"
        self._alone(place, name)
        self.spi_bus[bus].attach(pin, device)
        self._places[place] = name
        pins = _named(_SPI_SIGNALS, self.spi_pins.get(bus, ())) or {"bus": f"SPI-{bus}"}
        return self.add(name, device, pins={**pins, "CS": f"GPIO{select}"}, faces=faces)

    def on_i2c(self, name: str, device: Target, *, bus: str, address: int, faces: Sequence[Face] = ()) -> Target:
        """Hang a part on I2C-`bus` under its 7-bit `address`: it is an `emulator.signals.I2cTarget`.

        Raises ValueError for a bus or an address that there is not, and for an address where another part is.
        """
        if bus not in self.i2c_bus:
            raise ValueError(f"{name} on I2C-{bus}: this chip has {', '.join(f'I2C-{x}' for x in self.i2c_bus)}")
        place = f"address {address:#04x} of I2C-{bus}"
        self._alone(place, name)
        self.i2c_bus[bus].attach(address, device)
        self._places[place] = name
        pins = _named(_I2C_SIGNALS, self.i2c_pins.get(bus, ())) or {"bus": f"I2C-{bus}"}
        return self.add(name, device, pins=pins, faces=faces)

    def on_can(self, name: str, device: Node, *, bus: str, faces: Sequence[Face] = ()) -> Node:
        """Hang a part on the bus of CAN-`bus`: it is made from `emulator.can_bus.CanPart`."""
        if bus not in self.can_bus:
            raise ValueError(f"{name} on CAN-{bus}: this chip has {', '.join(f'CAN-{x}' for x in self.can_bus)}")
        device.connect(self.can_bus[bus])
        return self.add(name, device, pins={"bus": self.can_bus[bus].name}, faces=faces)

    def on_adc(self, name: str, device: Analog, *, adc: str, channel: int, faces: Sequence[Face] = ()) -> Analog:
        """Put a part at input `channel` of ADC-`adc`: it has `volts(cycles)`.

        Raises ValueError for an input that there is not, and for one where another part is.
        """
        inputs = self.analog.get(adc)
        if inputs is None:
            raise ValueError(f"{name} on ADC-{adc}: this chip has {', '.join(f'ADC-{x}' for x in self.analog)}")
        if not 0 <= channel < len(inputs):
            raise ValueError(f"{name} at ADCIN{adc}{channel}: ADC-{adc} has ADCIN{adc}0 to ADCIN{adc}{len(inputs) - 1}")
        inputs[channel].follow(name, device.volts)
        return self.add(name, device, pins={"OUT": f"ADCIN{adc}{channel}"}, faces=faces)

    @classmethod
    def _check_pins(cls) -> None:
        """Raise ValueError for a bus or a pin that the chip does not have."""
        wired = [("pulls", pin) for pin in cls.pulls]
        for what, bus, letters, signals in (
            ("spi_pins", "SPI", SPI_PIE, _SPI_SIGNALS), ("i2c_pins", "I2C", I2C_PIE, _I2C_SIGNALS),
        ):  # fmt: skip
            for letter, pins in getattr(cls, what).items():
                if letter not in letters:
                    known = ", ".join(f"{bus}-{x}" for x in letters)
                    raise ValueError(f"{cls.__name__}.{what}: no {bus}-{letter}: this chip has {known}")
                if len(pins) != len(signals):
                    raise ValueError(f"{cls.__name__}.{what}[{letter!r}]: expected the pins of {', '.join(signals)}")
                wired += [(what, pin) for pin in pins]
        for what, pin in wired:
            if not 0 <= pin < GPIO_COUNT:
                raise ValueError(f"{cls.__name__}.{what}: no GPIO{pin}: this chip has GPIO0 to GPIO{GPIO_COUNT - 1}")

    def _alone(self, place: str, name: str) -> None:
        if place in self._places:
            raise ValueError(f"{self._places[place]} and {name} are both at {place}")

    def to_pc(self, *, tx_gpio: int, rx_gpio: int, baud: int = 9600, name: str = "pc") -> WireLink:
        """Wire a PC's serial port to the pins of an SCI: the chip sends on `tx_gpio` and receives on `rx_gpio`."""
        for gpio in (tx_gpio, rx_gpio):
            if gpio not in self.serial_pins:
                reached = ", ".join(map(str, sorted(self.serial_pins)))
                raise ValueError(f"{name} at GPIO{gpio}: no SCI reaches this pin; it reaches GPIO {reached}")
        lines = self.serial_pins[tx_gpio], self.serial_pins[rx_gpio]
        line = WireLink(self.clock, *lines, baud=baud, report=self.reports)
        self.pc = Pc(tx_gpio, rx_gpio, baud, line)
        return self.add(name, line, pins={"RX": f"GPIO{tx_gpio}", "TX": f"GPIO{rx_gpio}"})

    def _gpio(self, name: str, number: int) -> int:
        if not 0 <= number < len(self.pins):
            raise ValueError(f"{name} at GPIO{number}: this chip has GPIO0 to GPIO{len(self.pins) - 1}")
        return number

    # Asking

    def part(self, name: str) -> Part:
        """The part called `name`.  Raises ValueError."""
        if name not in self.parts:
            raise ValueError(f"{type(self).__name__} has no part {name!r}: {', '.join(self.parts) or 'it has none'}")
        return self.parts[name]

    def find(self, kind: type[T]) -> dict[str, T]:
        """The parts of a kind, by name."""
        return {name: part.device for name, part in self.parts.items() if isinstance(part.device, kind)}

    def only(self, kind: type[T], what: str) -> T:
        """The one part of a kind.  Raises ValueError, which calls it `what`, if there is none or are several."""
        found = self.find(kind)
        if len(found) != 1:
            there = f"{len(found)}: {', '.join(found)}" if found else "none"
            raise ValueError(f"{type(self).__name__} must have one {what} for this, and has {there}")
        return next(iter(found.values()))


def _named(signals: Sequence[str], gpios: Sequence[int]) -> dict[str, str]:
    """The pins of a bus; none where the board leaves them to firmware."""
    return {signal: f"GPIO{gpio}" for signal, gpio in zip(signals, gpios, strict=True)} if gpios else {}


def made(kind: type[B], **options: Any) -> B:
    """A board of a kind.  Raises ValueError, in one line, for what goes wrong in its `solder`."""
    try:
        return kind(**options)
    except Exception as error:
        what = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
        frames = [frame for frame in extract_tb(error.__traceback__) if frame.filename == source_of(kind)]
        at = f" (line {frames[-1].lineno} of {frames[-1].filename})" if frames else ""
        raise ValueError(f"board {kind.__name__}: {what}{at}") from error


def optional(kind: type[Board], options: Sequence[str]) -> dict[str, Any]:
    """How a board of a kind is made with parts that it has on demand.  Raises ValueError if it has none such."""
    if not options:
        return {}
    if "options" not in inspect.signature(kind.__init__).parameters:
        raise ValueError(f"option {', '.join(options)}: {kind.__name__} has no parts on demand")
    return {"options": tuple(options)}


def source_of(kind: type[Board]) -> str:
    """The file where a board's `solder` is written."""
    return kind.solder.__code__.co_filename


#: Boards that come with the tool.
SHIPPED: Final = ("robot", "bare")


def load(name: str, folder: Path | None = None) -> type[Board]:
    """The board called `name`: `robot`, `bare`, or a Python file (relative to `folder`) with one class of a board.

    Raises ValueError, in one line, for a file that is not there, does not run or has no board, or more than one.
    """
    if name == "bare":
        return Board
    if name == "robot":
        from hil.robot.board import RobotBoard

        return RobotBoard
    if not name.endswith(".py"):
        raise ValueError(f"board {name!r}: {', '.join(SHIPPED)}, or a Python file")
    file = ((folder or Path()) / name).resolve()
    if not file.is_file():
        raise ValueError(f"board {file}: there is no such file")
    return _only_board(file)


def _only_board(file: Path) -> type[Board]:
    module_name = f"hil_board_{file.stem}"
    spec = spec_from_file_location(module_name, file)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[module_name] = module  # dataclasses of the file look themselves up there
    sys.path.insert(0, str(file.parent))  # parts of one's own may stand in a file beside it
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ValueError(f"board {file}: {type(error).__name__}: {error}") from error
    finally:
        sys.path.remove(str(file.parent))
        del sys.modules[module_name]
    found = [
        item
        for item in vars(module).values()
        if inspect.isclass(item) and issubclass(item, Board) and item.__module__ == module_name
    ]
    if len(found) != 1:
        names = ", ".join(item.__name__ for item in found) or "none"
        raise ValueError(f"board {file}: expected one class made from hil.board.Board, found {names}")
    return found[0]
