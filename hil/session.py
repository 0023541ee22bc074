"""A robot in use: machine, port, pace and scripted orders, turned slice by slice.

`Session.run` is the bench's only loop.  Each slice: wait for its deadline (or for a byte from the PC), run the
machine, hand over what it sent, take in what the line has room for.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from emulator.clock import SYSCLK_HZ, seconds
from hil.client.decode import FrameDecoder, OdometryFrame
from hil.client.orders import TimedOrder
from hil.machine import Machine
from hil.pacing import Pacer
from hil.recording.wire import WireListener
from hil.serial_port import SerialPort

NS_PER_CYCLE: Final = 1_000_000_000 // SYSCLK_HZ
#: Bytes that may wait for the line before the PC is held back: a real UART's FIFO is 16, its driver a little more.
HOLD_BACK_BYTES: Final = 64
#: CHOICE: how many decoded frames a run remembers for its plot (250 s of them are 1000).
REMEMBERED_FRAMES: Final = 20_000


@dataclass(frozen=True, slots=True)
class SeenFrame:
    """A decoded frame and the virtual time at which its last byte ended, in seconds since power-up."""

    time_s: float
    frame: OdometryFrame


class Session:
    """One robot driven through one port (or none)."""

    def __init__(
        self,
        machine: Machine,
        port: SerialPort | None,
        pacer: Pacer,
        *,
        orders: Iterable[TimedOrder] = (),
        remember_frames: bool = False,
        tick: Callable[[Session], None] | None = None,
        wire: WireListener | None = None,
    ) -> None:
        """`orders` are timed from the start of `run`; `tick` is called after every slice; `wire` sees what passes."""
        self.machine = machine
        self.port = port
        self.pacer = pacer
        self.decoder = FrameDecoder()
        self.frames: deque[SeenFrame] = deque(maxlen=REMEMBERED_FRAMES if remember_frames else 1)
        self.bytes_from_robot = 0
        self.bytes_to_robot = 0
        #: The cycle at which somebody wants a slice to end.
        self.wanted_cycles: int | None = None
        self.start_cycles = machine.clock.now
        self._orders = deque(sorted(orders, key=lambda order: order.time_s))
        self._tick = tick
        self._wire = wire
        self._stop = False
        self._stop_hearing = machine.uart_sent.connect(self._robot_byte)

    def stop(self) -> None:
        """End `run` after the present slice."""
        self._stop = True

    def interrupt(self) -> None:
        """End `run` at the CPU's next charge: a slice may take seconds of computing.  Safe in a signal handler."""
        self._stop = True
        self.machine.pause()

    def release(self) -> None:
        """Leave the machine to another session: hear the robot no more."""
        self._stop_hearing()

    @property
    def elapsed_virtual_s(self) -> float:
        """Virtual time since `run` began."""
        return seconds(self.machine.clock.now - self.start_cycles)

    @property
    def elapsed_ns(self) -> int:
        """The same, exact: a cycle is 5 ns."""
        return self._ns(self.machine.clock.now)

    def run(self, duration_s: float | None = None) -> None:
        """Run for `duration_s` of virtual time, or until `stop`."""
        clock = self.machine.clock
        self.start_cycles = clock.now
        end = None if duration_s is None else self.start_cycles + round(duration_s * SYSCLK_HZ)
        self.pacer.start(self.start_cycles)
        self._exchange()
        while not self._stop and (end is None or clock.now < end):
            self._send_due_orders()
            target = clock.now + self.pacer.slice_cycles
            if self._orders:
                target = min(target, self._order_cycles(self._orders[0]))
            for other in (end, self.wanted_cycles):
                if other is not None and other > clock.now:
                    target = min(target, other)
            self._wait_and_listen(target)
            self.machine.run_until(target)
            self._exchange()
            self.pacer.finished(target)
            if self._tick is not None:
                self._tick(self)

    def _wait_and_listen(self, target: int) -> None:
        """Wait until `target` is due; a byte from the PC is taken in at the virtual time of its arrival."""
        while self.pacer.wait_until(target, self._fds()):
            now = self.pacer.virtual_now()
            if now >= target:
                return
            if now > self.machine.clock.now:
                self.machine.run_until(now)
            if not self._exchange():
                # Readable without data: a connection that came or went.  Do not spin on it within this slice.
                self.pacer.wait_until(target, ())
                return

    def _fds(self) -> list[int]:
        if self.port is None or self.machine.pending_to_robot >= HOLD_BACK_BYTES:
            return []
        return list(self.port.wait_fds())

    def _exchange(self) -> bool:
        """Hand over what the robot sent and take in what the line has room for.  True if something came."""
        if self.port is None:
            return False
        data = self.port.receive(HOLD_BACK_BYTES - self.machine.pending_to_robot)
        if data:
            self.feed(data)
        self.port.transmit(self.machine.clock.now)
        return bool(data)

    def _send_due_orders(self) -> None:
        while self._orders and self._order_cycles(self._orders[0]) <= self.machine.clock.now:
            self.feed(self._orders.popleft().data)

    def _order_cycles(self, order: TimedOrder) -> int:
        return self.start_cycles + round(order.time_s * SYSCLK_HZ)

    def feed(self, data: bytes) -> None:
        """Give bytes to the line now."""
        self.bytes_to_robot += len(data)
        if self._wire is not None:
            self._wire.to_robot(data, self.elapsed_ns)
        self.machine.feed(data)

    def _robot_byte(self, byte: int, end_cycles: int) -> None:
        self.bytes_from_robot += 1
        for frame in self.decoder.feed(bytes((byte,))):
            self.frames.append(SeenFrame(seconds(end_cycles), frame))
        if self._wire is not None:
            self._wire.from_robot(bytes((byte,)), self._ns(end_cycles))
        if self.port is not None:
            self.port.robot_sent(byte, end_cycles)

    def _ns(self, cycles: int) -> int:
        """Nanoseconds since `run` began."""
        return (cycles - self.start_cycles) * NS_PER_CYCLE
