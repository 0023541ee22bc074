"""GPIO ports A to F: latches, pins, pin functions.

Modelled: DAT, which reads pins and writes latches (only the words of the access, so a bit-field write is the 16-bit
read, modify, write of the compiler, with its effect on the neighbours); SET, CLEAR, TOGGLE, direction, open drain,
pull-ups, input inversion, qualification by 3 or 6 samples (`gpio_qualifier.py`), pin function (MUX, GMUX) with a hook
for the board, LOCK and CR, EALLOW (by the register core).  The level of a pin that is computed (an ePWM drives it) is
computed when DAT is read.  Its edges are produced only while the pin has a listener, or QSEL counts its samples.
Not modelled: the owner of a pin (CSEL) and the analog mode of GPIO42 and 43 (setting one is reported), the few cycles
of synchronisation between a pin and DAT, edge times.  The Input X-BAR (`input_xbar.py`) follows inputs of pins.
Time: everything but qualification happens in the cycle of the access.  A read of DAT of a port with computed levels
schedules one event, at the next change of one of them.  A poll of DAT continues there.
Sources: TRM GPIO chapter; HDR F2837xS_gpio.h; DS table of GPIO muxed pins.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import NEVER, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.gpio_qualifier import InputQualifier
from emulator.registers.cell import Cell
from emulator.registers.gpio import PIN_COUNT, PORTS, GpioCtrlRegs, GpioDataRegs
from emulator.signal import Signal
from emulator.signals import Wire

DRIVER: Final = "gpio"
PINS_A_PORT: Final = 32
#: GPxQSEL value -> samples; 0 (synchronous) and 3 (asynchronous) pass at once.
QUALIFIED_SAMPLES: Final = {1: 3, 2: 6}


def set_bits(mask: int) -> Iterator[int]:
    """The positions of the ones of `mask`, lowest first."""
    while mask:
        lowest = mask & -mask
        yield lowest.bit_length() - 1
        mask ^= lowest


class _Pin:
    """Pin `i` of a port, as its wire's listener."""

    __slots__ = ("_i", "_mask", "_port")

    def __init__(self, port: GpioPort, i: int) -> None:
        self._port, self._i, self._mask = port, i, 1 << i

    def changed(self, level: int) -> None:
        self._port.wire_changed(self._i, self._mask, level)

    def computed(self, on: bool) -> None:
        self._port.wire_computed(self._mask, on)

    def followed(self, on: bool) -> None:
        self._port.follow(self._i, on)


class GpioPort:
    """One port of up to 32 pins; pin 0 of the port is GPIO`first`."""

    def __init__(
        self,
        clock: Clock,
        cpu: Cpu,
        letter: str,
        first: int,
        ctrl: GpioCtrlRegs,
        data: GpioDataRegs,
        wires: Sequence[Wire],
        mux_changed: Signal[int, int],
    ) -> None:
        self._clock = clock
        self._cpu = cpu
        self._first = first
        self._wires = wires
        self._muxed = mux_changed
        self._every = (1 << len(wires)) - 1
        #: The board's own pull on each wire, which counts while the pull-up is off.
        self._floating = [wire.pull for wire in wires]
        self._latch = 0
        #: Levels as DAT sees them, before inversion.
        self._levels = sum(wire.level << i for i, wire in enumerate(wires))
        #: Pins whose function is GPIO, and those of them that are outputs.
        self._plain = self._every
        self._outputs = 0
        self._qualifiers: dict[int, InputQualifier] = {}
        #: The statement that read DAT last; inputs whose level a read and write of DAT copied to the latch, by pin.
        self._read_at = 0
        self._copied: dict[int, Cause] = {}
        #: A signal for each pin, (level): every change that DAT shows; and the mask of the pins with listeners.
        pins = [_Pin(self, i) for i in range(len(wires))]
        self.input_changed: list[Signal[int]] = [Signal(pin.followed) for pin in pins]
        self._followed = 0
        #: Pins with a computed level.  It is computed when DAT is read.
        self._computed = 0
        self._next_check: ClockEvent | None = None
        for pin, wire in zip(pins, wires, strict=True):
            wire.noticed.connect(pin.changed)
            wire.computed.connect(pin.computed)

        prefix = f"GP{letter}"
        self._ctrl: dict[str, Cell] = {
            name.removeprefix(prefix): register for name, register in ctrl.registers.items() if name.startswith(prefix)
        }
        #: GMUX and MUX of each pin, and the position of its two bits in them.
        self._muxes = [
            (self._ctrl[f"GMUX{i // 16 + 1}"], self._ctrl[f"MUX{i // 16 + 1}"], i % 16 * 2) for i in range(len(wires))
        ]
        self._dir = self._ctrl["DIR"]
        self._odr = self._ctrl["ODR"]
        self._inv = self._ctrl["INV"]
        self._lock = self._ctrl["LOCK"]
        data.bind(f"{prefix}DAT", read=self._read_DAT, write=self._write_DAT, steady=True)
        data.bind(f"{prefix}SET", write=self._write_SET)
        data.bind(f"{prefix}CLEAR", write=self._write_CLEAR)
        data.bind(f"{prefix}TOGGLE", write=self._write_TOGGLE)
        # CHOICE: LOCK freezes the registers that decide function and output; CTRL, QSEL and PUD stay free.
        handlers: dict[str, tuple[Callable[[str, int], None] | None, bool]] = {
            "DIR": (self._outputs_changed, True),
            "ODR": (self._outputs_changed, True),
            "INV": (self._inversion_changed, True),
            "MUX1": (self._mux_changed, True),
            "MUX2": (self._mux_changed, True),
            "GMUX1": (self._mux_changed, True),
            "GMUX2": (self._mux_changed, True),
            "CSEL1": (None, True),
            "CSEL2": (None, True),
            "CSEL3": (None, True),
            "CSEL4": (None, True),
            "AMSEL": (None, True),
            "PUD": (self._pull_changed, False),
            "QSEL1": (self._qualification_changed, False),
            "QSEL2": (self._qualification_changed, False),
        }
        for name, (effect, lockable) in handlers.items():
            if name in self._ctrl:
                ctrl.bind(f"{prefix}{name}", write=partial(self._write_control, name, effect, lockable))
        ctrl.bind(f"{prefix}LOCK", write=self._write_LOCK)

    def reset(self) -> None:
        """Device reset; the owner has reset the registers."""
        self._latch = 0
        for i in list(self._qualifiers):
            self._unqualify(i)
        self._levels = sum(wire.level << i for i, wire in enumerate(self._wires))
        moved = self._every & ~self._plain
        self._plain = self._every
        self._drive(self._every)
        for i, wire in enumerate(self._wires):
            wire.set_pull(self._floating[i])
        for i in set_bits(moved):
            self._emit_mux(i)

    def mux(self, i: int) -> int:
        """The function of pin `i` of the port: GMUX << 2 | MUX."""
        gmux, mux, shift = self._muxes[i]
        return (gmux.value >> shift & 3) << 2 | mux.value >> shift & 3

    def qualifier(self, i: int) -> InputQualifier | None:
        """The qualifier of pin `i` of the port; None: its level counts at once."""
        return self._qualifiers.get(i)

    def input(self, i: int) -> int:
        """The level of pin `i` in DAT."""
        return self._read_DAT() >> i & 1

    # --- data registers --------------------------------------------------------------------------------------------

    def _read_DAT(self) -> int:
        if self._computed:
            self._read_computed()
        self._read_at = self._cpu.findings.position.at
        return self._levels ^ self._inv.value

    def _write_DAT(self, word: int, lanes: int) -> None:
        changed = (word ^ self._latch) & lanes
        findings = self._cpu.findings
        # A statement that writes back what it has read copies the pin's level to the latch.
        copied = changed & ~self._outputs & self._plain & ~(word ^ self._levels ^ self._inv.value)
        if copied and self._read_at and self._read_at == findings.position.at and (cause := findings.mark()):
            for i in set_bits(copied & self._every):
                self._copied.setdefault(i, cause)
        self._change_latch(changed)

    def _given(self, pins: int) -> None:
        """Note that the program has written the latches of `pins` on purpose."""
        if self._copied:
            self._copied = {i: cause for i, cause in self._copied.items() if not pins >> i & 1}

    def _write_SET(self, word: int, lanes: int) -> None:
        self._given(word & lanes)
        self._change_latch(word & lanes & ~self._latch)

    def _write_CLEAR(self, word: int, lanes: int) -> None:
        self._given(word & lanes)
        self._change_latch(word & lanes & self._latch)

    def _write_TOGGLE(self, word: int, lanes: int) -> None:
        self._change_latch(word & lanes)

    def _change_latch(self, changed: int) -> None:
        self._latch ^= changed & self._every
        self._show(changed & self._outputs)

    # --- control registers -----------------------------------------------------------------------------------------

    def _write_control(
        self, name: str, effect: Callable[[str, int], None] | None, lockable: bool, word: int, lanes: int
    ) -> None:
        register = self._ctrl[name]
        if lockable and self._lock.value:
            frozen = self._locked_bits(register) & lanes
            if (word ^ register.value) & frozen & register.rw_mask:
                self._cpu.findings.report(
                    "locked", f"{register.path}: the configuration of a pin is locked, the write was dropped silently",
                    object=register.path, value=word,
                )  # fmt: skip
            lanes &= ~frozen
        before = register.value
        register.store(word, lanes)
        changed = before ^ register.value
        if changed and effect is not None:
            effect(name, changed)

    def _locked_bits(self, register: Cell) -> int:
        lock = self._lock.value
        return sum(field.mask for field in register.fields.values() if lock >> (int(field.name[4:]) - self._first) & 1)

    def _write_LOCK(self, word: int, lanes: int) -> None:
        self._lock.store(word, lanes & ~self._ctrl["CR"].value)

    def _outputs_changed(self, name: str, changed: int) -> None:
        if self._copied and name == "DIR":
            self._tell_copied(changed & self._dir.value & self._plain)
        self._drive(changed)

    def _tell_copied(self, pins: int) -> None:
        """Report inputs that become outputs while their latch is a copy of their level."""
        findings = self._cpu.findings
        for i in [i for i in self._copied if pins >> i & 1]:
            cause, level = self._copied.pop(i), self._latch >> i & 1
            path = findings.path(cause.at, cause.calls)
            name = f"GPIO{self._first + i}"
            if path:
                findings.report_at(
                    path[0], "latch-copied",
                    f"{name} becomes an output and drives {level}: this statement read the levels of all pins of the "
                    f"port and wrote them back, so that the latch of {name}, an input then, became {level}",
                    how="dynamic", object=name, value=level, call_path=path, task=cause.who,
                )  # fmt: skip

    def _inversion_changed(self, _name: str, changed: int) -> None:
        for i in set_bits(changed & self._followed):
            self._tell_input(i)

    def _mux_changed(self, name: str, changed: int) -> None:
        half = int(name[-1])
        base = 16 * (half - 1)
        pins = {base + bit // 2 for bit in set_bits(changed)}
        # GMUX changes nothing for a pin with MUX = 0: functions 0, 4, 8 and 12 are all GPIO (DS muxed pins).
        mux = self._ctrl[f"MUX{half}"].value
        for i in sorted(pins):
            if mux >> (i - base) * 2 & 3:
                self._plain &= ~(1 << i)
            else:
                self._plain |= 1 << i
            self._drive(1 << i)
            self._emit_mux(i)

    def _pull_changed(self, _name: str, changed: int) -> None:
        disabled = self._ctrl["PUD"].value
        for i in set_bits(changed):
            self._wires[i].set_pull(self._floating[i] if disabled >> i & 1 else 1)

    def _qualification_changed(self, name: str, changed: int) -> None:
        base = 16 * (int(name[-1]) - 1)
        select = self._ctrl[name].value
        for i in sorted({base + bit // 2 for bit in set_bits(changed)}):
            self._unqualify(i)
            samples = QUALIFIED_SAMPLES.get(select >> (i - base) * 2 & 3)
            if samples is None:
                self._accept(1 << i, self._wires[i].level)
                continue
            self._wires[i].attend()
            accepted = self._levels >> i & 1
            qualifier = InputQualifier(
                self._clock, accepted, samples, partial(self._period_cycles, i), partial(self._accept, 1 << i)
            )
            self._qualifiers[i] = qualifier
            if self._wires[i].level != accepted:
                qualifier.change(self._wires[i].level)

    def _unqualify(self, i: int) -> None:
        qualifier = self._qualifiers.pop(i, None)
        if qualifier is not None:
            qualifier.stop()
            self._wires[i].leave()

    def _period_cycles(self, i: int) -> int:
        quarter = self._ctrl["CTRL"].value >> (i // 8 * 8) & 0xFF
        return 2 * quarter if quarter else 1

    # --- pins ------------------------------------------------------------------------------------------------------

    def follow(self, i: int, wanted: bool) -> None:
        """A first listener connects to `input_changed` of a pin (`wanted`), or the last one has gone."""
        if wanted:
            self._wires[i].attend()
            self._followed |= 1 << i
        else:
            self._followed &= ~(1 << i)
            self._wires[i].leave()

    def _drive(self, pins: int) -> None:
        """Function, direction or kind of output of `pins` has changed."""
        self._outputs = self._dir.value & self._plain
        self._show(pins)

    def _show(self, pins: int) -> None:
        """Put the latches of `pins` on their wires, or release them."""
        outputs = self._outputs
        while pins:
            bit = pins & -pins
            pins ^= bit
            i = bit.bit_length() - 1
            wire = self._wires[i]
            level: int | None = None
            if outputs & bit:
                if not self._latch & bit:
                    level = 0
                elif not self._odr.value & bit:
                    level = 1
            wire.drive(DRIVER, level)
            if wire.contention and level is not None:
                others = " and ".join(sorted(wire.drivers() - {DRIVER}))
                self._cpu.findings.report(
                    "contention", f"GPIO{self._first + i} drives {level} against {others}",
                    object=wire.name, value=level,
                )  # fmt: skip

    def wire_changed(self, i: int, mask: int, level: int) -> None:
        """The wire of pin `i` has another level."""
        if self._qualifiers and i in self._qualifiers:
            self._qualifiers[i].change(level)
        else:
            self._accept(mask, level)

    def wire_computed(self, mask: int, computed: bool) -> None:
        """The level of a pin is a computed one from now on, or no longer."""
        self._computed = self._computed | mask if computed else self._computed & ~mask

    def _read_computed(self) -> None:
        """Read the wires with a computed level; `wire_changed` gets their changes.

        An event at the next change of one of them lets a poll of DAT go on there.
        """
        until = NEVER
        for i in set_bits(self._computed):
            _ = self._wires[i].level
            until = min(until, self._wires[i].stays_until())
        if until != NEVER and (self._next_check is None or self._next_check.time > until):
            self._clock.cancel(self._next_check)
            self._next_check = self._clock.schedule(until, self._check_again)

    def _check_again(self) -> None:
        self._next_check = None

    def _accept(self, mask: int, level: int) -> None:
        before = self._levels
        self._levels = before | mask if level else before & ~mask
        if mask & self._followed and before != self._levels:
            self._tell_input(mask.bit_length() - 1)

    def _tell_input(self, i: int) -> None:
        level = self.input(i)
        for listener in self.input_changed[i].listeners:
            listener(level)

    def _emit_mux(self, i: int) -> None:
        self._muxed.emit(self._first + i, self.mux(i))


class Gpio:
    """All ports.  `pins[n]` is the wire of GPIOn; its pull at construction is what the board does to it.

    CHOICE: an internal pull-up wins over the board's pull; with the pull-up off the board's pull decides, and a wire
    without one reads its `pull` (0 by default).
    """

    def __init__(self, clock: Clock, cpu: Cpu, ctrl: GpioCtrlRegs, data: GpioDataRegs, pins: Sequence[Wire]) -> None:
        if len(pins) != PIN_COUNT:
            raise ValueError(f"GPIO wants the wires of GPIO0 to GPIO{PIN_COUNT - 1}, got {len(pins)} of {PIN_COUNT}")
        self._ctrl = ctrl
        self._data = data
        #: (pin, mux): after every change of a pin's function, also of one that lasts only until the next write.
        self.mux_changed: Signal[int, int] = Signal()
        self._ports = [
            GpioPort(clock, cpu, letter, first, ctrl, data, pins[first : first + PINS_A_PORT], self.mux_changed)
            for letter, first in zip(PORTS, range(0, PIN_COUNT, PINS_A_PORT), strict=True)
        ]
        #: A signal for each GPIO, (level): every change that DAT shows.
        self.input_changed: list[Signal[int]] = [changed for port in self._ports for changed in port.input_changed]

    def reset(self) -> None:
        """Device reset: every pin an input with function GPIO."""
        self._ctrl.reset()
        self._data.reset()
        for port in self._ports:
            port.reset()

    def mux(self, pin: int) -> int:
        """The function of GPIO`pin`, GMUX << 2 | MUX.  0, 4, 8 and 12 are GPIO.  ValueError for a pin that is none."""
        if not 0 <= pin < PIN_COUNT:
            raise ValueError(f"GPIO{pin} does not exist: pins are 0 to {PIN_COUNT - 1}")
        return self._ports[pin // PINS_A_PORT].mux(pin % PINS_A_PORT)

    def qualifier(self, pin: int) -> InputQualifier | None:
        """The qualifier of the input of GPIO`pin`; None: its level counts at once."""
        return self._ports[pin // PINS_A_PORT].qualifier(pin % PINS_A_PORT)

    def input(self, pin: int) -> int:
        """The level of GPIO`pin` in DAT."""
        return self._ports[pin // PINS_A_PORT].input(pin % PINS_A_PORT)
