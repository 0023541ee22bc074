"""A robot that is only a serial line: sends numbered frames every 250 ms, takes what it is fed at 9600 baud."""

from __future__ import annotations

import hashlib
from collections import deque
from collections.abc import Callable, Sequence

from emulator.c28x.findings import Findings
from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Clock, seconds
from emulator.signal import Signal
from hil.client.decode import OdometryFrame
from hil.machine import CpuUse, PathPoint, Setup, Status, TaskTimes, Wall

#: Ten bits at 9600 baud in cycles, rounded down: 200e6 * 10 / 9600 = 208333.3.
BYTE_CYCLES = SYSCLK_HZ * 10 // 9600
FRAME_PERIOD_CYCLES = 250 * CYCLES_PER_MS
BOOT_CYCLES = 2100 * CYCLES_PER_MS


def numbered_frame(number: int) -> OdometryFrame:
    """Frame number n has X = n."""
    return OdometryFrame(number, -2, 0, 1922, 300, 301)


class ScriptedMachine:
    """`hil.machine.Machine` with nothing behind the line."""

    def __init__(self, setup: Setup | None = None) -> None:
        self.setup = setup or Setup()
        if self.setup.world not in ("corridor", "room", "box"):
            raise ValueError(f"no world {self.setup.world!r}: there are corridor, room, box")
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.uart_sent: Signal[int, int] = Signal()
        self.posts: Sequence[tuple[float, float, float]] = ()
        self.walls: Sequence[Wall] = (((0.0, 0.0), (1.0, 0.0)),)
        #: (time, byte) of each byte at the end of its stop bit.
        self.taken: list[tuple[int, int]] = []
        self.frames_sent = 0
        self.closed = False
        self.measuring = False
        self._queue: deque[int] = deque()
        self._busy = False
        self._uart = hashlib.sha256()

    @property
    def pending_to_robot(self) -> int:
        return len(self._queue)

    @property
    def received(self) -> bytes:
        return bytes(byte for _, byte in self.taken)

    @property
    def uart_sha256(self) -> str:
        return self._uart.hexdigest()

    @property
    def trace_sha256(self) -> str:
        return hashlib.sha256(repr((self.setup.seed, self.taken)).encode()).hexdigest()

    def boot(self, progress: Callable[[float], None] | None = None) -> None:
        for tenth in range(1, 11):
            self.run_until(BOOT_CYCLES * tenth // 10)
            if progress is not None:
                progress(tenth / 10)
        self.findings.report("unwritten-read", "read before written", object="result", declaration="us.c")
        self.clock.after(FRAME_PERIOD_CYCLES, self._send_frame)

    def run_until(self, cycles: int) -> None:
        self.clock.advance_to(cycles)

    def pause(self) -> None:
        """It computes nothing that would take long."""

    def feed(self, data: bytes) -> None:
        self._queue.extend(data)
        if not self._busy and self._queue:
            self._start_bit()

    def status(self) -> Status:
        return Status(seconds(self.clock.now), "STOP", 1.0, 2.0, 0.5, (30.0, 20.0, 20.5), len(self.findings))

    def true_path(self) -> Sequence[PathPoint]:
        return (PathPoint(0.0, 1.0, 1.0, 0.0), PathPoint(1.0, 2.0, 1.0, 0.0))

    def odometry_path(self) -> Sequence[PathPoint]:
        return (PathPoint(0.0, 0.0, 0.0, 0.0), PathPoint(1.0, 1.0, 0.0, 0.0))

    def measure_tasks(self) -> None:
        self.measuring = True

    def task_statistics(self) -> CpuUse:
        if not self.measuring:
            return CpuUse()
        return CpuUse((TaskTimes("TaskUS", 6, 100, 105.0, 106.5, 108.0, 118.0),), 0.04)

    def close(self) -> None:
        self.closed = True

    def _start_bit(self) -> None:
        self._busy = True
        byte = self._queue.popleft()
        self.clock.after(BYTE_CYCLES, lambda: self._stop_bit(byte))

    def _stop_bit(self, byte: int) -> None:
        self.taken.append((self.clock.now, byte))
        self._busy = False
        if self._queue:
            self._start_bit()

    def _send_frame(self) -> None:
        self.frames_sent += 1
        self.clock.after(FRAME_PERIOD_CYCLES, self._send_frame)
        data = numbered_frame(self.frames_sent).encode()
        for index, byte in enumerate(data):
            self.clock.after((index + 1) * BYTE_CYCLES, lambda byte=byte: self._send_byte(byte))

    def _send_byte(self, byte: int) -> None:
        self._uart.update(bytes((byte,)))
        self.uart_sent.emit(byte, self.clock.now)
