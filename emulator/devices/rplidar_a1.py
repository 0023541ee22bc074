"""RPLIDAR A1M8: a turning laser scanner that sends the distances all around over a serial line.

Modelled: requests STOP, RESET, SCAN, FORCE_SCAN, GET_INFO, GET_HEALTH with response descriptors and data; requests with
a payload and a checksum; the 5 s in which a request must be complete; the pauses after STOP and RESET; 2000 samples
a second while the motor turns at 5.5 Hz, each with quality, angle and distance at its own time; nothing nearer than
0.15 m or farther than 6 m; distance error and motor speed of a specimen.
CHOICE: an early specimen, hardware 0 with firmware 1.15.  It has none of the requests of 1.17 and later, and its range
is the 6 m of the first drivers; data sheets since 2016 give 12 m for later specimens.
Not modelled: those requests (EXPRESS_SCAN, GET_SAMPLERATE, GET_LIDAR_CONF and others): it does not answer them, and
that is reported as `unmodelled`.  Not modelled either: protection stop; the motor's control input and start (MOTOCTL is
connected to the motor's supply, so the motor turns from power-up on); text at start-up; ambient light, glass, mirrors.
Time: one event for each sample while it scans, and one for each character on the line; none while it is idle.
Sources: RPLIDAR interface protocol and application notes (request packets' format: XOR, 5 s; response packets' format;
STOP: 1 ms, RESET: 2 ms; SCAN, GET_INFO, GET_HEALTH); A1M8 data sheet (measurement performance, figure 2-1: 0.15 m, less
than 1 % of the distance, 5.5 Hz, 0.5 ms a sample; communication interface: 115200 baud, 8N1).  Commands, headers and
nodes are also those of Slamtec's SDK (Slamtec/rplidar_sdk, `sl_lidar_cmd.h`, `sl_lidar_protocol.h`), which takes 1.17
for the first firmware with EXPRESS_SCAN.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from math import inf, tau
from typing import Final

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, SYSCLK_HZ, Clock, ClockEvent
from emulator.devices.report import DeviceReport, DiscardedReports
from emulator.devices.serial_pacing import LinePacer, received
from emulator.signals import SerialFrame, SerialLine

BAUD: Final = 115_200
SAMPLE_CYCLES: Final = 500 * CYCLES_PER_US
TURNS_HZ: Final = 5.5
NEAREST_M: Final = 0.15
#: CHOICE: an early specimen; see the head of this file.
FARTHEST_M: Final = 6.0
#: All bytes of a request must have come within this time.
REQUEST_CYCLES: Final = 5000 * CYCLES_PER_MS
#: CHOICE: in the pause that a host must leave after STOP and RESET, it accepts no bytes.
STOP_PAUSE_CYCLES: Final = 1 * CYCLES_PER_MS
RESET_PAUSE_CYCLES: Final = 2 * CYCLES_PER_MS

START: Final = 0xA5
STOP: Final = 0x25
RESET: Final = 0x40
SCAN: Final = 0x20
FORCE_SCAN: Final = 0x21
GET_INFO: Final = 0x50
GET_HEALTH: Final = 0x52
#: Further requests of newer firmware, other models or an accessory board (`sl_lidar_cmd.h`).
_NEWER: Final = {
    0x59: "GET_SAMPLERATE", 0x82: "EXPRESS_SCAN", 0x83: "HQ_SCAN", 0x84: "GET_LIDAR_CONF", 0x85: "SET_LIDAR_CONF",
    0x90: "NEW_BAUDRATE_CONFIRM", 0xA8: "HQ_MOTOR_SPEED_CTRL", 0xF0: "SET_MOTOR_PWM", 0xFF: "GET_ACC_BOARD_FLAG",
}  # fmt: skip

#: Model (1 and 8: A1M8), firmware 1.15 (minor, major), hardware.
_INFO: Final = bytes((0x18, 15, 1, 0))
SCAN_DESCRIPTOR: Final = bytes.fromhex("a55a0500004081")
INFO_DESCRIPTOR: Final = bytes.fromhex("a55a1400000004")
HEALTH_DESCRIPTOR: Final = bytes.fromhex("a55a0300000006")

#: CHOICE: the quality of a sample that hit something; a sample without an echo has 0.
QUALITY: Final = 15
#: The sheet says less than 1 % of the distance.  CHOICE: that is three standard deviations, and never more.
ERROR_LIMIT: Final = 0.01
#: CHOICE: the motor of a specimen is within 3 % of its speed.
MOTOR_SPREAD: Final = 0.03


class RplidarA1:
    """The device.  For the bus: two serial lines; `line_in` carries the bytes of the host.  For the world:
    `set_distance_source`.

    `distance_source(clockwise_rad, cycles)` returns the distance in metres in this direction, inf for nothing; 0 is
    straight ahead.
    """

    def __init__(
        self,
        clock: Clock,
        line_in: SerialLine,
        line_out: SerialLine,
        *,
        rng: random.Random,
        ideal: bool = True,
        distance_source: Callable[[float, int], float] | None = None,
        report: DeviceReport | None = None,
    ) -> None:
        self._clock = clock
        self._rng = rng
        self._ideal = ideal
        self._report: DeviceReport = report or DiscardedReports()
        self.distance_source = distance_source or _nothing
        turns_hz = TURNS_HZ if ideal else TURNS_HZ * (1.0 + rng.uniform(-MOTOR_SPREAD, MOTOR_SPREAD))
        self.turn_cycles = round(SYSCLK_HZ / turns_hz)
        self._serial = bytes(range(16)) if ideal else rng.randbytes(16)
        self._pacer = LinePacer(clock, line_out, BAUD)
        self._bit_cycles = SYSCLK_HZ / BAUD
        self._request: list[int] = []
        self._began = 0
        self._busy_until = 0
        self._event: ClockEvent | None = None
        self._turn = 0
        #: The number of requests carried out; that of requests given up, and of bytes outside of requests or broken.
        self.obeyed = 0
        self.discarded = 0
        line_in.sent.connect(self._frame)

    @property
    def scanning(self) -> bool:
        """Whether samples are being sent."""
        return self._event is not None

    def set_distance_source(self, source: Callable[[float, int], float]) -> None:
        """Set the source of distances from now on."""
        self.distance_source = source

    def angle_rad(self, cycles: int) -> float:
        """The direction of the laser, clockwise from straight ahead."""
        return tau * (cycles % self.turn_cycles) / self.turn_cycles

    # Requests

    def _frame(self, frame: SerialFrame) -> None:
        byte, stop = received(frame, self._bit_cycles)
        if stop and frame.end >= self._busy_until:
            self.receive(byte)
        else:
            self.discarded += 1

    def receive(self, byte: int) -> None:
        """Take one byte from the host."""
        request, now = self._request, self._clock.now
        if request and now - self._began > REQUEST_CYCLES:
            request.clear()
            self.discarded += 1
        if not request:
            if byte != START:
                self.discarded += 1
                return
            self._began = now
        request.append(byte)
        if len(request) < 2:
            return
        command = request[1]
        if command & 0x80:
            # Command, length, payload, checksum over all before it.
            if len(request) < 3 or len(request) < 4 + request[2]:
                return
            check = 0
            for part in request:
                check ^= part
            if check:
                request.clear()
                self.discarded += 1
                return
        request.clear()
        self._execute(command)

    def _execute(self, command: int) -> None:
        now = self._clock.now
        if command in (STOP, RESET):
            self._stop_scan()
            self._busy_until = now + (STOP_PAUSE_CYCLES if command == STOP else RESET_PAUSE_CYCLES)
            if command == RESET:
                self._pacer.clear()
        elif command in (SCAN, FORCE_SCAN):
            self._stop_scan()
            self._answer(SCAN_DESCRIPTOR)
            self._turn = now // self.turn_cycles
            self._event = self._clock.schedule(self._pacer.idle_at + SAMPLE_CYCLES, self._sample)
        elif command == GET_INFO:
            self._stop_scan()
            self._answer(INFO_DESCRIPTOR + _INFO + self._serial)
        elif command == GET_HEALTH:
            self._stop_scan()
            self._answer(HEALTH_DESCRIPTOR + bytes(3))
        else:
            self.discarded += 1
            if command in _NEWER:
                self._report("unmodelled", f"RPLIDAR A1: {_NEWER[command]} ({command:#04x}) is not modelled: silence")
            return
        self.obeyed += 1

    def _answer(self, data: bytes) -> None:
        """CHOICE: it accepts no other request until an answer is sent: by the sheet a host must wait for the answer."""
        self._pacer.send(data)
        self._busy_until = self._pacer.idle_at

    # Samples

    def _stop_scan(self) -> None:
        self._clock.cancel(self._event)
        self._event = None

    def _sample(self) -> None:
        now = self._clock.now
        self._event = self._clock.schedule(now + SAMPLE_CYCLES, self._sample)
        turn = now // self.turn_cycles
        begins = turn != self._turn
        self._turn = turn
        angle = self.angle_rad(now)
        self._pacer.send(sample(angle, self._measured_m(self.distance_source(angle, now)), begins))

    def _measured_m(self, distance_m: float) -> float:
        """The distance that it measures; 0 without an echo."""
        if not NEAREST_M <= distance_m <= FARTHEST_M:
            return 0.0
        if self._ideal:
            return distance_m
        error = self._rng.gauss(0.0, ERROR_LIMIT / 3.0)
        return distance_m * (1.0 + min(max(error, -ERROR_LIMIT), ERROR_LIMIT))


def sample(angle_rad: float, distance_m: float, begins: bool) -> bytes:
    """The five bytes of a sample: quality, two bits that say whether a turn begins, angle and distance.

    The angle is in 64ths of a degree, with a bit below that is always 1, the distance in quarters of a millimetre.
    """
    angle_q6 = round(angle_rad / tau * 360.0 * 64.0) % (360 * 64)
    distance_q2 = round(distance_m * 4000.0)
    quality = QUALITY if distance_q2 else 0
    first = quality << 2 | (1 if begins else 2)
    return bytes((first, angle_q6 << 1 & 0xFE | 1, angle_q6 >> 7, distance_q2 & 0xFF, distance_q2 >> 8))


def _nothing(_clockwise_rad: float, _cycles: int) -> float:
    return inf
