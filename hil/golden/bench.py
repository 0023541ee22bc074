"""The bench of a golden vector: a board, the firmware linked to it, and what stands in for the rest of the robot.

The drivers run on the real peripherals: conversions go through the ADC, bytes of the gyro through SPI-A to a scripted
slave.  Replaced are only those functions that the vectors replaced too: DelayUs is recorded, gates are logged by
number, Semaphore_pend releases a task a given number of times, Send_Frame and Read_Frame exchange frames with the
adapter, the wheels' controllers subtract.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.findings import Finding
from emulator.c28x.memory import NULL, Pointer
from emulator.c28x.objects import Structure
from emulator.c28x.runtime import EndlessPoll
from emulator.clock import CYCLES_PER_US
from emulator.image import Firmware
from emulator.registers.cell import Cell
from firmware_model.image import link
from hil.golden.scripted_gyro import ScriptedGyro
from hil.robot.board import GYRO_CS_GPIO, RobotBoard

#: `servidores.c` creates its gates in this order; vectors call them 1..6.
GATES: Final = (
    "Status_server", "US_server", "GYRO_server", "Reference_server", "Odometry_server", "Odometry_Trayect_server",
)  # fmt: skip
#: Words in front of the comma that ends a search which has left its frame (meta.note of Obtain_Reference).
GUARD_COMMA: Final = 300
#: Longer delays are recorded, not waited for: nothing that a vector states happens in them.
LONGEST_WAIT_US: Final = 5000


class EndOfReleases(Exception):
    """Leaves a task's endless loop when its releases are used up."""


class LastAccess:
    """Notes the last access to the registers whose names begin as given: `name`, and `word` if it was a write."""

    def __init__(self, bench: VectorBench, *watched: tuple[str, str]) -> None:
        self.name, self.word = "", 0
        self._registers = [
            register
            for block, prefix in watched
            for name, register in bench.board.blocks[block].registers.items()
            if name.startswith(prefix)
        ]

    def __enter__(self) -> LastAccess:
        for register in self._registers:
            register.tap(self._seen, reads=True)
        return self

    def __exit__(self, *_: object) -> None:
        for register in self._registers:
            register.untap(self._seen)

    def _seen(self, register: Cell, _access: str, word: int, _mask: int) -> None:
        self.name, self.word = register.name, word


class VectorBench:
    """One board with linked firmware, reused for all vectors of a file.

    `high_byte` is what an SPI driver that does not mask would leave above each byte; 0 runs the driver of this project.
    `firmware`, `include`, `defines`: the robot's own C files (see `firmware_model.image.link`).
    """

    def __init__(
        self, high_byte: int = 0, *, firmware: Sequence[str | Path] = (), include: Sequence[str | Path] = (),
        defines: Sequence[str] = (),
    ) -> None:  # fmt: skip
        self.board = RobotBoard()
        self.gyro = ScriptedGyro()
        self.board.spi_bus["A"].attach(self.board.pins[GYRO_CS_GPIO], self.gyro)  # the slave attached last answers
        self.high_byte = high_byte
        #: DelayUs: microseconds, and what `on_delay` saw.
        self.delays: list[Any] = []
        #: The SOC of every conversion since `convert`.
        self.converted: list[int] = []
        self.on_delay: Callable[[int], Any] = lambda us: us
        self.locks: list[int] = []
        self.frames: list[str] = []
        self.frame_in: list[int] = []
        self.on_pend: Callable[[], None] = self._end
        self.bumper = 1
        self.wheel_speed = {"left": 0.0, "right": 0.0}
        self.actions: list[float] = []
        externs: dict[str, Callable[..., Any]] = {
            "DelayUs": self._delay_us, "GateMutexPri_enter": self._enter, "GateMutexPri_leave": lambda gate, key: None,
            "Semaphore_pend": self._pend, "Log_write1": lambda *arguments: None,
            "Send_Frame": self._send_frame, "Read_Frame": self._read_frame, "Received_Frame": lambda: 0,
            "Read_Bumper": lambda: self.bumper,
            "Init_Encoder_left": lambda: None, "Init_Encoder_right": lambda: None,
            "Init_EPWM2": lambda: None, "Init_EPWM7": lambda: None, "Init_Servos": lambda period: None,
            "left_velocity": lambda: self.wheel_speed["left"], "right_velocity": lambda: self.wheel_speed["right"],
            "Rl": lambda reference, w: f32(reference - w), "Rr": lambda reference, w: f32(reference - w),
            "left_action": self.actions.append, "right_action": self.actions.append,
        }  # fmt: skip
        if high_byte:
            externs["SPI_transfer"] = lambda data: self.gyro.exchange(data & 0xFF, 8, 1, 0) | high_byte
        self.board.findings.found.connect(self._found)
        self.fw: Firmware = link(
            self.board, float_to_int="low16", divide="ieee", keep_locals=True, externs=externs,
            room={"us.median.aux": 128, "main_robot.TaskORD.Order_frame": GUARD_COMMA + 100},
            firmware=firmware, include=include, defines=defines,
        )  # fmt: skip
        for number, gate in enumerate(GATES, 1):
            if hasattr(self.fw.servidores, gate):
                setattr(self.fw.servidores, gate, number)
        self._start = {path: list(obj.data) for path, obj in self.fw.linked.objects.items()}
        self._buffers: dict[str, Pointer] = {}
        self._structures: dict[str, Structure] = {}
        self._unmasked: dict[int, VectorBench] = {}
        self._again = partial(VectorBench, firmware=firmware, include=include, defines=defines)

    def reset(self) -> None:
        """File-scope objects as at start-up, recorders empty."""
        for path, obj in self.fw.linked.objects.items():
            obj.data[:] = self._start[path]
        for path in self.fw.runtime.initials:
            self.fw.initial(path, None)
        self.fw.memory.store("float32", 0, 0.0)
        self.on_delay = lambda us: us
        self.on_pend = self._end
        self.bumper = 1
        self.board.adc["A"].reset()
        self.convert([])
        self.gyro.reset()
        self.board.findings.clear()
        for record in (self.delays, self.converted, self.locks, self.frames, self.frame_in, self.actions):
            record.clear()

    def unmasked(self, high_byte: int) -> VectorBench:
        """A bench whose SPI driver returns all 16 bits, `high_byte` above each byte."""
        if not high_byte:
            return self
        if high_byte not in self._unmasked:
            self._unmasked[high_byte] = self._again(high_byte)
        self._unmasked[high_byte].reset()
        return self._unmasked[high_byte]

    def convert(self, codes: list[int]) -> None:
        """The next conversions yield `codes` in order, then 0."""
        self.converted.clear()
        source = iter(codes)

        def take(soc: int) -> int:
            self.converted.append(soc)
            return next(source, 0)

        self.board.adc["A"].force_codes(take)

    # Objects

    def array(self, ctype: str, values: list[Any], room: int = 1024) -> Pointer:
        """A C array that holds `values`, never written behind them; the same storage each time."""
        pointer = self._buffers.get(ctype)
        if pointer is None:
            pointer = self._buffers[ctype] = self.fw.array(ctype, [None] * room).at(0)
        assert pointer.obj is not None
        pointer.obj.data[:] = [*values, *[None] * (room - len(values))]
        return pointer

    def structure(self, ctype: str, **members: float) -> Structure:
        """A C structure with these members; the same storage each time."""
        structure = self._structures.get(ctype)
        if structure is None:
            structure = self._structures[ctype] = self.fw.new(ctype)
        for name, value in members.items():
            setattr(structure, name, value)
        return structure

    def cells(self, pointers: str, content: float = 0.0) -> list[Pointer]:
        """Where the integrators Ix, Iw, Iv point: a cell each ("distinct", filled), or all to address 0 ("null")."""
        names = ("Ix", "Iw", "Iv")
        if pointers == "null":
            for name in names:
                setattr(self.fw.main_robot, name, NULL)
            return []
        if pointers != "distinct":
            raise ValueError(f'pointers is {pointers!r}: expected "distinct" or "null"')
        base = self.array("float32", [content] * len(names))
        for i, name in enumerate(names):
            setattr(self.fw.main_robot, name, base.at(i))
        return [base.at(i) for i in range(len(names))]

    def cell_values(self, cells: list[Pointer]) -> list[float]:
        """What the integrators hold: three cells, or the one at address 0."""
        return [cell.load() for cell in cells] or [self.fw.memory.load("float32", 0)]

    def run_releases(
        self, task: str, releases: int, before: Callable[[int], None], after: Callable[[int], None]
    ) -> None:
        """Run task `task` of main_Robot.c for `releases` passes of its loop."""
        done = 0

        def pend() -> None:
            nonlocal done
            if done:
                after(done - 1)
            if done == releases:
                raise EndOfReleases
            before(done)
            done += 1

        self.on_pend = pend
        try:
            getattr(self.fw.main_robot, task)(0, 0)
        except EndOfReleases:
            return

    # What stands in

    def _found(self, finding: Finding) -> None:
        if finding.rule == "endless-poll":  # reported, and polled on for as long as the board has any event left
            raise EndlessPoll(finding.message)

    def _end(self) -> None:
        raise EndOfReleases

    def _delay_us(self, us: int) -> None:
        self.delays.append(self.on_delay(us))
        if us <= LONGEST_WAIT_US:
            self.board.clock.delay(us * CYCLES_PER_US)

    def _enter(self, gate: int) -> int:
        self.locks.append(gate)
        return 0

    def _pend(self, _semaphore: object, _timeout: int) -> int:
        self.on_pend()
        return 1

    def _send_frame(self, data: Pointer, length: int) -> None:
        self.frames.append("".join(chr(data.at(i).load() & 0xFF) for i in range(length)))

    def _read_frame(self, data: Pointer) -> None:
        data.at(GUARD_COMMA).store(ord(","))
        for i, character in enumerate([*self.frame_in, 0]):
            data.at(i).store(character)
