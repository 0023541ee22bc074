"""The line of a console: any serial port or URL, read and written in threads of its own, everything bounded.

A slow screen (a shell over a slow connection) does not slow the line down.  Frames wait for the screen in a short queue
that drops the oldest.  ``#SETR`` of telemanipulation and the dead man's timer run in the writer's thread.

When the process is killed the hard way (SIGKILL, power) no ``#STOP`` leaves: nothing here can help that.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import Final

import serial

from hil.client.decode import FrameDecoder, OdometryFrame
from hil.client.orders import order
from hil.serial_url import gone, open_url
from hil.terminal.tele import PERIOD_S, Arrow, TerminalTele

#: Reading returns after this even when less than a chunk came.
READ_TIMEOUT_S: Final = 0.05
#: A port that takes no byte for so long is not being read.
WRITE_TIMEOUT_S: Final = 1.0
#: With the pause after a full chunk: at most 100 kB/s are looked at, ten times what 115200 baud carry.
CHUNK: Final = 1024
FULL_CHUNK_PAUSE_S: Final = 0.01
#: Events that wait for the screen: a minute of frames.
MAX_EVENTS: Final = 240
#: Orders that wait for the line.
MAX_ORDERS: Final = 16
#: Between ``#TELE`` and the ``#SETR`` of a SET, as in the thesis console.
SET_DELAY_S: Final = 0.5
#: How long leaving waits for the last order: the write's own limit and some room.
FAREWELL_S: Final = 1.5
#: What reading and writing raise when the port is gone (pyserial's own error is an OSError); the last two when it was
#: closed meanwhile.
BROKEN: Final = (OSError, TypeError, ValueError)

#: What the screen is shown: a frame that came, or an order that went.
Event = OdometryFrame | bytes


@dataclass(frozen=True, slots=True)
class Traffic:
    """The counts of frames, orders and bytes so far."""

    frames: int
    malformed: int
    skipped_bytes: int
    #: Frames that came faster than the screen took them.
    unseen: int
    orders: int
    references: int
    #: Orders that the line did not take within its time limit.
    refused: int


@dataclass(frozen=True, slots=True)
class _Waiting:
    due_s: float
    data: bytes


class Link:
    """An open line.  Every method returns at once, except `close`, which waits a moment for the last order."""

    def __init__(self, port: str) -> None:
        """Open `port`.  Raises PortError."""
        self.port = port
        #: Why the line is gone, "" while it is there.
        self.failure = ""
        #: Whether `close` got its ``#STOP`` out.
        self.stop_sent = False
        self._line = open_url(port, read_timeout_s=READ_TIMEOUT_S, write_timeout_s=WRITE_TIMEOUT_S)
        self._decoder = FrameDecoder()
        self._changed = threading.Condition()
        self._events: deque[Event] = deque(maxlen=MAX_EVENTS)
        self._orders: deque[_Waiting] = deque()
        self._tele = TerminalTele()
        self._tick_s = 0.0
        self._unseen = self._sent_orders = self._references = self._refused = 0
        self._closing = False
        self._ended = threading.Event()
        self._reader = threading.Thread(target=self._read, name="line reader", daemon=True)
        self._writer = threading.Thread(target=self._write, name="line writer", daemon=True)
        self._reader.start()
        self._writer.start()

    # For the screen

    def take(self) -> list[Event]:
        """The events since the last call, the oldest first; at most `MAX_EVENTS`."""
        with self._changed:
            events = list(self._events)
            self._events.clear()
            return events

    @property
    def traffic(self) -> Traffic:
        """The counts so far."""
        decoder = self._decoder
        return Traffic(
            decoder.frames, decoder.malformed, decoder.skipped, self._unseen, self._sent_orders, self._references,
            self._refused,
        )  # fmt: skip

    @property
    def tele(self) -> tuple[float, float] | None:
        """The speeds of telemanipulation (m/s, rad/s), None when it is off."""
        with self._changed:
            return (self._tele.v_m_s, self._tele.w_rad_s) if self._tele.active else None

    # Orders

    def order(self, keyword: str) -> bool:
        """Send an order of `hil.client.orders.KEYWORDS`; telemanipulation ends.  False if the line takes no more."""
        return self._send(order(keyword))

    def stop(self) -> bool:
        """Send ``#STOP`` at once; what is queued is dropped."""
        with self._changed:
            self._orders.clear()
        return self._send(order("stop"))

    def set_reference(self, setr: bytes) -> bool:
        """``#TELE`` and then one ``#SETR``, which holds until another order: no dead man."""
        return self._send(order("tele"), setr)

    def begin_tele(self) -> bool:
        """Send ``#TELE``, and from then on a ``#SETR`` each period.  While it is on, this only resets the dead man's
        timer."""
        with self._changed:
            if self._tele.active:
                self._tele.begin(time.monotonic())
                return True
        if not self._send(order("tele")):
            return False
        with self._changed:
            self._tele.begin(time.monotonic())
            self._tick_s = time.monotonic() + PERIOD_S
            self._changed.notify()
        return True

    def press(self, arrow: Arrow) -> None:
        """Handle an arrow key in telemanipulation."""
        with self._changed:
            self._tele.press(arrow, time.monotonic())

    def rest(self) -> None:
        """Set V = W = 0, still in telemanipulation."""
        with self._changed:
            self._tele.rest(time.monotonic())

    def close(self) -> None:
        """Send ``#STOP``, wait until it was sent, and close the port.  Closing twice does nothing."""
        with self._changed:
            if self._closing:
                return
            self._tele.end()
            self._orders.clear()
            self._orders.append(_Waiting(0.0, order("stop")))
            self._closing = True
            self._changed.notify()
        self._writer.join(FAREWELL_S)
        self._ended.set()
        self._reader.join(FAREWELL_S)
        self._line.close()

    def _send(self, data: bytes, later: bytes | None = None) -> bool:
        now_s = time.monotonic()
        with self._changed:
            self._tele.end()
            # What was to follow an earlier order has been overtaken.
            self._orders = deque(waiting for waiting in self._orders if waiting.due_s <= now_s)
            if self.failure or self._closing or len(self._orders) >= MAX_ORDERS:
                return False
            self._orders.append(_Waiting(now_s, data))
            if later is not None:
                self._orders.append(_Waiting(now_s + SET_DELAY_S, later))
            self._changed.notify()
            return True

    # The two threads

    def _read(self) -> None:
        while not self._ended.is_set():
            try:
                data = self._line.read(CHUNK)
            except BROKEN as error:
                self._lose(error)
                return
            frames = self._decoder.feed(data)
            with self._changed:
                self._unseen += max(0, len(self._events) + len(frames) - MAX_EVENTS)
                self._events.extend(frames)
            if len(data) == CHUNK:
                self._ended.wait(FULL_CHUNK_PAUSE_S)

    def _write(self) -> None:
        while (waiting := self._next()) is not None:
            data, is_order = waiting
            try:
                self._line.write(data)
                if self._closing:
                    _drain(self._line)
            except serial.SerialTimeoutException:
                self._refused += 1
                continue
            except BROKEN as error:
                self._lose(error)
                return
            if not is_order:
                self._references += 1
                continue
            self._sent_orders += 1
            with self._changed:
                self._events.append(data)
                self.stop_sent = self._closing and not self._orders

    def _next(self) -> tuple[bytes, bool] | None:
        """Wait for the next bytes to send; returns also whether they are an order.  None when leaving."""
        with self._changed:
            while True:
                now_s = time.monotonic()
                if self._orders and self._orders[0].due_s <= now_s:
                    return self._orders.popleft().data, True
                if self._closing:
                    return None
                if self._tele.active and self._tick_s <= now_s:
                    self._tick_s = now_s + PERIOD_S
                    return self._tele.tick(now_s), False
                self._changed.wait(self._pause_s(now_s))

    def _pause_s(self, now_s: float) -> float | None:
        dues = [self._tick_s] if self._tele.active else []
        dues += [self._orders[0].due_s] if self._orders else []
        return min(dues) - now_s if dues else None

    def _lose(self, error: Exception) -> None:
        if not self._ended.is_set() and not self.failure:
            self.failure = str(gone(self.port, error))


def _drain(line: serial.Serial) -> None:
    """Wait until everything was sent.  Raises OSError if the port was closed."""
    try:
        line.flush()
    except Exception as error:  # termios.error is no OSError, and Windows has none
        raise OSError(*error.args) from error
