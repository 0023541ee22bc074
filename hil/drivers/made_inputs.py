"""A run with inputs where the board has none: buttons are pressed, voltages and shafts move, characters come.

Without a board, nothing happens at the inputs of a program: a button is never pressed, an ADC reads 0, no character
comes.  What the program does with its inputs is then not seen.  So it runs once more, and gets at each input that
nothing drives, and that it uses:

    a pin, read or routed by the Input X-BAR: presses of 40 to 200 ms that bounce; at a capture, pulses of 0.2 to 12 ms;
    an input of an ADC: a voltage that goes slowly over the whole range and back;
    a shaft at an eQEP: turns forwards, stands, and turns backwards;
    a SCI: lines of the words that the program compares with, of numbers, and one line that is far too long.

What must not happen whatever comes, is certain: an element outside of an array, a race.  A wrong result is certain if
it came before the first character and pulse: each code of an ADC can come, each press and turn.  The numbers of a text,
and the lengths of pulses, may be what no partner sends: what those show is not told.

Modelled
    Programs with a `main`.  The times are those of a generator with a fixed seed.
Not modelled
    Parts on an I2C, an SPI or a CAN.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from random import Random
from typing import Final

from emulator.c28x.findings import Finding
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Call, Const, Load, LValue, RegisterLoad, RegisterRef, String, Variable
from emulator.c28x.tree_queries import bare, within
from emulator.chip import ECAP_INPUT, XINT_INPUT
from emulator.clock import CYCLES_PER_MS
from emulator.connections import ADC_PINS
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.peripherals.sci import Sci
from emulator.registers.sci import SCICCR, SCICTL1
from emulator.signals import QuadratureWire, SerialFrame
from hil.drivers.other_messages import OUTSIDE, WRONG
from hil.image import Build, Image

_WHO: Final = "made input"
_SEED: Final = 1
#: Inputs begin to move after this time, when most programs have started up.
_BEGIN: Final = 20 * CYCLES_PER_MS
#: A press and the pause behind it, in ms; a contact bounces so long before it is closed, in cycles.
_PRESSED: Final = (40, 200)
_RELEASED: Final = (60, 300)
_BOUNCE: Final = CYCLES_PER_MS // 5
#: A pulse at a capture in cycles, and the pause behind it in ms.
_PULSE: Final = (CYCLES_PER_MS // 5, 12 * CYCLES_PER_MS)
_BETWEEN: Final = (25, 60)
#: A voltage goes up, and down again, in this time.
_RAMP: Final = 700 * CYCLES_PER_MS
_FULL_V: Final = 3.05
#: A shaft moves in steps of this time, with so many edges each; so many steps forwards, none, and backwards.
_STEP: Final = CYCLES_PER_MS
_EDGES: Final = 4
_TURNS: Final = (1,) * 250 + (0,) * 60 + (-1,) * 300
#: The pause behind a line of text, and the characters of one that is too long.
_PAUSE: Final = 15 * CYCLES_PER_MS
_LONG: Final = 300
#: At most so many words of the program, of at most this length.
_WORDS: Final = 12
_WORD: Final = re.compile(r"[!-~][ -~]{0,23}")
#: What is certain, whatever comes.
_ALWAYS: Final = OUTSIDE | {"race"}
#: What is certain before the first character or pulse.
_COMPUTED: Final = _ALWAYS | WRONG | {"remainder-lost"}
_RECEIVES: Final = SCICTL1.RXENA.mask | SCICTL1.SWRESET.mask
#: The ports of pins in the order of their numbers, and the number of pins of each.
_PORT: Final = re.compile(r"GP([A-F])DAT$")
_PINS: Final = 32
#: Registers with what an ADC, an eQEP, a SCI and a capture bring.
_ANALOG: Final = re.compile(r"ADC(?:PPB\d)?RESULT\d+$")
_SHAFT: Final = re.compile(r"QPOS(?:CNT|LAT|ILAT|SLAT)$|QCPRD(?:LAT)?$")
#: Functions of TI's that choose a pin for an input of the Input X-BAR.
_ROUTES: Final = re.compile(r"SetupXINT\dGpio|XBAR_setInputPin|GPIO_setInterruptPin")
#: Functions of TI's that read a pin.
_READ_PIN: Final = frozenset({"GPIO_ReadPin", "GPIO_readPin"})
#: Functions of driverlib that read the same, and those by which an ADC converts, perhaps for a DMA.
_ANALOG_CALL: Final = re.compile(r"ADC_(?:setupSOC|read(?:PPB)?Result)$")
_SHAFT_CALL: Final = re.compile(r"EQEP_get(?:(?:Index|Strobe)?Position(?:Latch)?|Capture\w+)$")
_CHARACTER_CALL: Final = re.compile(r"SCI_readChar\w*$")


@dataclass
class Uses:
    """What inputs a program reads: pins by their numbers, and whether ADCs, shafts, characters, routed pins."""

    pins: set[int] = field(default_factory=set)
    analog: bool = False
    shafts: bool = False
    characters: bool = False
    routed: bool = False

    def __bool__(self) -> bool:
        return bool(self.pins) or self.analog or self.shafts or self.characters or self.routed


def uses(modules: Iterable[Module]) -> Uses:
    """The inputs that the functions of a program read, by registers or by functions of driverlib."""
    found = Uses()
    for node in (node for module in modules for function in module.functions for node in within(function.body)):
        match node:
            case RegisterLoad(register=RegisterRef(register=name, field=bits)):
                port = _PORT.match(name)
                if port is not None:
                    first = _PINS * (ord(port[1]) - ord("A"))
                    found.pins |= {first + bits.lo} if bits is not None else set(range(first, first + _PINS))
                found.analog |= _ANALOG.match(name) is not None
                found.shafts |= _SHAFT.match(name) is not None
                found.characters |= name == "SCIRXBUF"
            case RegisterRef(block="InputXbarRegs"):
                found.routed = True
            case Call(function=function) if _ROUTES.search(function.name):
                found.routed = True
            case Call(function=function) if _ANALOG_CALL.match(function.name):
                found.analog = True
            case Call(function=function) if _SHAFT_CALL.match(function.name):
                found.shafts = True
            case Call(function=function) if _CHARACTER_CALL.match(function.name):
                found.characters = True
            case Call(function=function, arguments=[at, *_]) if function.name in _READ_PIN:
                match bare(at):
                    case Const(value=int() as number):
                        found.pins.add(number)
                    case Load(lvalue=LValue(root=Variable(constant=True) as table)) if table.initial:
                        found.pins |= {pin for value in table.initial if (pin := constant_of(value)) is not None}
                    case _:
                        found.pins |= set(range(_PINS * 6))
    return found


def _words(modules: Iterable[Module]) -> Iterator[str]:
    """Words of a program's texts: what it may compare a command with."""
    texts = dict.fromkeys(
        node.text.rstrip("\0") for module in modules for function in module.functions
        for node in within(function.body) if isinstance(node, String)
    )  # fmt: skip
    yield from [text for text in texts if _WORD.fullmatch(text)][:_WORDS]


def _ramp(phase: int, cycles: int) -> float:
    """A voltage that goes over the range of an ADC and back, in volts."""
    part = (cycles + phase) % _RAMP / _RAMP
    return _FULL_V * (2 * part if part < 0.5 else 2 - 2 * part)


class MadeInputs:
    """The inputs of one image that nothing drives and that its program uses, and what moves them."""

    def __init__(self, image: Image, build: Build, usual: int, *, board_named: bool) -> None:
        """`usual`: how long the program runs, in cycles.  In the second half pulses and characters come, too.

        `board_named`: the program is meant for this board.  CHOICE: else the parts of the robot at the ADCs are not on
        its board, and do not count, unless the program starts sonars.
        """
        self._board_named = board_named
        self._board = image.board
        self._random = Random(_SEED)
        self._uses = uses(build.modules)
        self._words = list(_words(build.modules))
        #: What has moved, in the order of the first time.
        self.moved: dict[str, None] = {}
        #: The SCIs that somebody on the board sends to.
        self._heard: set[str] = set()
        self._typing: set[str] = set()
        for letter, sci in image.board.sci.items():
            sci.receiver.line.sent.connect(partial(self._hear, letter))
        #: When the first pulse or character came, in cycles.
        self._doubtful: int | None = None
        image.board.clock.after(_BEGIN, self._start)
        image.board.clock.after(max(_BEGIN, usual // 2), self._go_on)

    def found(self, known: Iterable[Finding]) -> Iterator[Finding]:
        """What is certain of that which the run has shown, and another run has not."""
        before = {(finding.rule, finding.place) for finding in known}
        moved = ", ".join(self.moved)
        detail = f"no known part of its board drives {moved}: a further run moved what the program reads"
        for finding in self._board.findings:
            late = self._doubtful is not None and finding.time_cycles >= self._doubtful
            certain = finding.rule in (_ALWAYS if late else _COMPUTED)
            if certain and finding.how != "static" and (finding.rule, finding.place) not in before:
                yield replace(finding, details=(*finding.details, detail))

    def _start(self) -> None:
        board = self._board
        if self._uses.analog:
            sonars = any(ring.start.driven() for ring in board.find(SonarRing).values())
            for inputs in board.analog.values():
                for number in (n for n in ADC_PINS if n < len(inputs)):
                    if not inputs[number].driven or not (self._board_named or sonars):
                        inputs[number].replace(_WHO, partial(_ramp, self._random.randrange(_RAMP)))
                        self.moved["the ADCs"] = None
        if self._uses.shafts:
            for pair in board.encoder_pins.values():
                if not pair.looked_at.listeners:
                    self._turn(pair, 0)
        pins = self._uses.pins | self._routed(XINT_INPUT.values())
        for pin in sorted(pins - self._routed(ECAP_INPUT.values())):
            self._later(self._press, pin, _RELEASED)

    def _go_on(self) -> None:
        for pin in sorted(self._routed(ECAP_INPUT.values())):
            self._later(self._pulse, pin, _BETWEEN)
        for letter, sci in self._board.sci.items() if self._uses.characters else ():
            self._type(letter, sci, self._texts())

    def _routed(self, inputs: Iterable[int]) -> set[int]:
        """The pins that the program has chosen for inputs of the Input X-BAR."""
        if not self._uses.routed:
            return set()
        return {self._board.register("InputXbarRegs", f"INPUT{n}SELECT").value for n in inputs} - {0}

    def _hear(self, letter: str, _frame: SerialFrame) -> None:
        if letter not in self._typing:
            self._heard.add(letter)

    def _later(self, move: Callable[[int], None], pin: int, pause_ms: tuple[int, int]) -> None:
        self._board.clock.after(self._random.randint(*pause_ms) * CYCLES_PER_MS, partial(move, pin))

    def _is_free(self, pin: int) -> bool:
        """Whether a pin is an input that nothing drives, and no module has it."""
        pins = self._board.pins
        return pin < len(pins) and pins[pin].drivers() <= {_WHO} and not self._board.signal_of(pin)

    def _press(self, pin: int) -> None:
        """A button is pressed, with bounces, and let go."""
        if self._is_free(pin):
            wire, clock = self._board.pins[pin], self._board.clock
            self.moved[wire.name] = None
            pressed = 1 - wire.pull
            for n in range(5):
                clock.after(n * _BOUNCE, partial(wire.drive, _WHO, wire.pull if n % 2 else pressed))
            clock.after(self._random.randint(*_PRESSED) * CYCLES_PER_MS, partial(wire.drive, _WHO, None))
        self._later(self._press, pin, (_PRESSED[1] + _RELEASED[0], _PRESSED[1] + _RELEASED[1]))

    def _pulse(self, pin: int) -> None:
        """A pulse at the input of a capture."""
        if self._is_free(pin):
            wire, clock = self._board.pins[pin], self._board.clock
            self.moved[wire.name] = None
            self._doubtful = self._doubtful or clock.now
            wire.drive(_WHO, 1 - wire.pull)
            clock.after(self._random.randint(*_PULSE), partial(wire.drive, _WHO, None))
        self._later(self._pulse, pin, _BETWEEN)

    def _turn(self, pair: QuadratureWire, step: int) -> None:
        """A shaft turns by one step."""
        now = self._board.clock.now
        way = _TURNS[step % len(_TURNS)]
        if way:
            self.moved.setdefault("the eQEPs", None)
            pair.move(way * _EDGES, now - _STEP, now)
        self._board.clock.after(_STEP, partial(self._turn, pair, step + 1))

    def _texts(self) -> Iterator[bytes]:
        """The lines that come: first short ones, then one that is too long, then short ones again for ever."""
        while True:
            for word in self._words:
                for more in ("", " 7", " 123", "=45"):
                    yield f"{word}{more}\r\n".encode("latin-1")
            yield b"0\r1\n9999\r\n-5\r\n"
            yield bytes(ord("A") + n % 26 for n in range(_LONG)) + b"\r\n"

    def _type(self, letter: str, sci: Sci, texts: Iterator[bytes]) -> None:
        """One line of text comes, if the receiver is on and nobody else sends to it."""
        clock, own = self._board.clock, sci.format()
        length = round(own.frame_bits * own.bit_cycles)
        text = b""
        block = f"Sci{letter.lower()}Regs"
        receives = self._board.register(block, "SCICTL1").value & _RECEIVES == _RECEIVES
        looped = self._board.register(block, "SCICCR").value & SCICCR.LOOPBKENA.mask
        if receives and not looped and letter not in self._heard:
            text = next(texts)
            self._typing.add(letter)
            self.moved[f"the receiver of SCI{letter}"] = None
            self._doubtful = self._doubtful or clock.now
        for n, character in enumerate(text):
            frame = SerialFrame(
                character, clock.now + n * length, clock.now + (n + 1) * length, own.bit_cycles, own.data_bits,
                own.parity, own.stop_bits,
            )  # fmt: skip
            clock.schedule(frame.end, partial(sci.receiver.line.send, frame))
        clock.after(len(text) * length + _PAUSE, partial(self._type, letter, sci, texts))
