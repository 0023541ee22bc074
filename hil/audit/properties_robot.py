"""Properties of the whole robot: orders, stops, odometry.  They are the rules of `emulator.rules.behaviour`.

A property is a function of a bench and one example, like those of the drivers (`hil.audit.properties`).  A bench is
used many times; a property runs it from its present state.  If not said otherwise, it has booted and its parts are
ideal.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, Final, NamedTuple

from emulator.clock import CYCLES_PER_US, SYSCLK_HZ
from hil.audit.evidence import Evidence, measured
from hil.bench import Bench
from hil.world.robot_params import Pose

#: The time of a character, 8N1 at 9600 baud.
CHARACTER_S: Final = 10 / 9600
#: TFG figure 39: an order is executed before the next one can have arrived; then it waits for TaskNAVIGATION, and that
#: for TaskSERVO, a period each.  All tasks together compute for 1.1 ms.
ORDER_S: Final = 6.25e-3
WHEELS_S: Final = ORDER_S + 50e-3 + 25e-3 + 1.1e-3
#: TFG 3.2.3: the fastest it drives.  It goes on until the wheels are told, then brakes with the motor's time constant
#: (0.085 s, `servos.c`).
STOPPING_M: Final = 0.3 * (WHEELS_S + 0.085)
_SAMPLE_CYCLES: Final = 250 * CYCLES_PER_US
#: The time without an effect after which an order counts as lost.
_TIMEOUT_S: Final = 0.25
_STATES: Final = {
    b"STOP": "STOP", b"MISN": "MISSION", b"TELE": "TELEMANIPULATION", b"CALB": "CALIBRATION", b"INIT": "INITIALITATION",
}  # fmt: skip


class OrderEffect(NamedTuple):
    """The values that orders change: the state, and the reference of the telemanipulation (m/s, rad/s)."""

    state: str
    v_m_s: float
    w_rad_s: float

    def after(self, order: bytes) -> OrderEffect:
        """The values after a well-formed order.  SETR sets both references in TELE; they are 0 in other states (TFG
        3.3.1)."""
        if order[1:5] == b"SETR":
            if self.state != _STATES[b"TELE"]:
                return self
            v, w = (float(text) for text in re.findall(rb"[-+0-9.]+", order))
            return self._replace(v_m_s=v, w_rad_s=w)
        if order[1:5] == b"TELE":
            return self._replace(state=_STATES[b"TELE"])
        return OrderEffect(_STATES[order[1:5]], 0.0, 0.0)


def understood(bench: Bench) -> OrderEffect:
    """The effect of the orders that the robot has understood so far."""
    reference = bench.firmware.servidores.Telemanipulation_Reference
    return OrderEffect(bench.status().state, round(reference.V, 5), round(reference.W, 5))


def drive(bench: Bench) -> float:
    """The greater of the two motors' duties (0 to 1); 0 is neutral."""
    bridges = (bench.board.left_motor.bridge, bench.board.right_motor.bridge)
    return max(abs(bridge.in1.duty - bridge.in2.duty) for bridge in bridges)


def _sampled(bench: Bench, look: Callable[[], Any], duration_s: float) -> list[tuple[float, Any]]:
    """Run, and call `look` each 0.25 ms.  Returns its changes: the times in s from now, and the new values."""
    start = bench.clock.now
    end = start + round(duration_s * SYSCLK_HZ)
    seen = [(0.0, look())]

    def sample() -> None:
        now = look()
        if now != seen[-1][1]:
            seen.append(((bench.clock.now - start) / SYSCLK_HZ, now))
        if bench.clock.now < end:
            bench.clock.after(_SAMPLE_CYCLES, sample)

    bench.clock.after(_SAMPLE_CYCLES, sample)
    if start == 0:
        bench.boot()
    bench.run_until(max(end, bench.clock.now))
    return seen


def _fed(bench: Bench, orders: bytes, after_s: float, timeout_s: float) -> list[tuple[float, OrderEffect]]:
    """The effects of `orders`, which begin in `after_s`, with the times in s since their last character."""
    bench.clock.after(round(after_s * SYSCLK_HZ) + 1, lambda: bench.feed(orders))
    on_line_s = after_s + len(orders) * CHARACTER_S
    changes = _sampled(bench, lambda: understood(bench), on_line_s + timeout_s)
    return [(time_s - on_line_s, what) for time_s, what in changes]


def order_latency(bench: Bench, order: bytes, after_s: float) -> Evidence:
    """`order-latency`: an order that has an effect and begins in `after_s` is executed within 6.25 ms after its last
    character (TFG 3.4.3: before the next one can be complete), also during the start-up of a bench."""
    changes = _fed(bench, order, after_s, _TIMEOUT_S if bench.clock.now else 2.5)
    right = changes[0][1].after(order)
    latency_s = next((time_s for time_s, what in changes[1:] if what == right), math.inf)
    return measured(f"{order!r} is executed after", 1e3 * latency_s, "ms", high=1e3 * ORDER_S)


def two_orders(bench: Bench, first: bytes, second: bytes, after_s: float) -> Evidence:
    """`order-latency`: of two orders without a pause, the robot obeys the first and then the second (count)."""
    changes = [what for _, what in _fed(bench, first + second, after_s, _TIMEOUT_S if bench.clock.now else 2.5)]
    obeyed, expected = 0, changes[0]
    for order in (first, second):
        expected = expected.after(order)
        with suppress(ValueError):
            changes = changes[changes.index(expected) :]
            obeyed += 1
    return measured(f"orders obeyed of {first!r} and {second!r}", obeyed, low=2)


def wheels_obey(bench: Bench, v_m_s: float, w_rad_s: float, after_s: float) -> Evidence:
    """`order-latency`: if the robot is at rest in TELE, the PWM of a wheel changes within 82 ms after the end of a SETR
    that is not 0.  This is the time of an order, a period of TaskNAVIGATION and one of TaskSERVO."""
    bench.feed(b"#TELE\r#SETR0.0,0.0\r")
    bench.run_for(0.5)
    order = f"#SETR{v_m_s:.3f},{w_rad_s:.3f}\r".encode()
    bench.clock.after(round(after_s * SYSCLK_HZ) + 1, lambda: bench.feed(order))
    on_line_s = after_s + len(order) * CHARACTER_S
    changes = _sampled(bench, lambda: drive(bench), on_line_s + _TIMEOUT_S)
    latency_s = changes[1][0] - on_line_s if len(changes) > 1 else math.inf
    return measured(f"{order!r} moves a wheel after", 1e3 * latency_s, "ms", high=1e3 * WHEELS_S)


def malformed_bytes(bench: Bench, data: bytes, good: bytes) -> Evidence:
    """`malformed-frame`: bytes without a complete order change neither state nor reference and cause no finding, and
    the `good` order after them is obeyed (count of violations)."""
    before, findings = understood(bench), len(bench.findings)
    bench.feed(data)
    bench.run_for(len(data) * CHARACTER_S + 0.02)
    wrong = sum(a != b for a, b in zip(before, understood(bench), strict=True)) + len(bench.findings) - findings
    bench.feed(good)
    bench.run_for(len(good) * CHARACTER_S + 0.02)
    wrong += understood(bench) != before.after(good)
    return measured(f"what {data!r} changes, and {good!r} behind it not obeyed", wrong, high=0)


def _driving(bench: Bench, orders: Sequence[bytes], for_s: float) -> None:
    for order in orders:
        bench.feed(order)
        bench.run_for(0.05)
    bench.run_for(for_s)


def stop_is_neutral(bench: Bench, orders: Sequence[bytes], after_s: float) -> Evidence:
    """`stop-stops`: with STOP, `after_s` after any orders, both motors are neutral (duty) 82 ms after its last
    character (an order, a period of TaskNAVIGATION, one of TaskSERVO), and stay so for a second."""
    _driving(bench, orders, after_s)
    bench.feed(b"#STOP\r")
    bench.run_for(6 * CHARACTER_S + WHEELS_S)
    greatest = max(share for _, share in _sampled(bench, lambda: drive(bench), 1.0))
    return measured(f"drive of a motor after {b''.join(orders)!r} and STOP", greatest, high=0.0)


def stopping_distance(bench: Bench, orders: Sequence[bytes], after_s: float) -> Evidence:
    """`stop-stops`: with STOP, `after_s` after any orders, the robot is at rest within 5 cm (m).  It may drive at
    0.3 m/s (TFG 3.2.3) for the 82 ms until the wheels get the stop, and for the motor's time constant of 85 ms."""
    _driving(bench, orders, after_s)
    bench.feed(b"#STOP\r")
    bench.run_for(6 * CHARACTER_S)
    begin = bench.world.pose
    bench.run_for(2.0)
    bench.world.sync_now()
    way = math.dist(begin[:2], bench.world.pose[:2])
    return measured(f"way after {b''.join(orders)!r} and STOP", way, "m", high=STOPPING_M)


def stop_forgets(bench: Bench, v_m_s: float, w_rad_s: float) -> Evidence:
    """`stop-stops`: a reference from before a STOP, which sets it to 0 (TFG 3.3.1), has no effect in the next TELE."""
    order = f"#SETR{v_m_s:.3f},{w_rad_s:.3f}\r".encode()
    _driving(bench, (b"#TELE\r", order), 0.2)
    _driving(bench, (b"#STOP\r",), 0.5)
    bench.feed(b"#TELE\r")
    greatest = max(share for _, share in _sampled(bench, lambda: drive(bench), 0.3))
    _driving(bench, (b"#STOP\r",), 0.5)
    return measured(f"drive of a motor in TELE after {order!r} and STOP", greatest, high=0.0)


class ReferenceStep(NamedTuple):
    """Constant references for some seconds."""

    v_m_s: float
    w_rad_s: float
    duration_s: float


#: Heading of the odometry: 2 % of scale (L3G4200D table 4), an offset known to 0.03 degrees/s, and 5 degrees a minute
#: of ripple that an ideal gyro without its low-pass aliases.
_HEADING_SHARE: Final = 0.02
_HEADING_RAD_S: Final = math.radians(0.03 + 5 / 60)
#: The share of its distance that a wheel may lose: 1 %.
_DISTANCE_SHARE: Final = 0.01


def odometry_follows(bench: Bench, start: Pose, legs: Sequence[ReferenceStep]) -> Evidence:
    """`odometry-path`: after a drive of several legs from `start` without a contact, the odometry has moved like the
    robot (m), within the tolerance of the parts: 1 % of the distance; half the distance times the error of the heading,
    which grows evenly; and, if a leg begins or ends within a period of TaskODO, half the distance of that period times
    its turn."""
    _driving(bench, (b"#STOP\r",), 0.5)
    bench.world.place(start)
    bench.run_for(0.5)
    odometry = bench.firmware.servidores.ROBOT_Odometry_T
    believed0 = Pose(odometry.X / 1000, odometry.Y / 1000, odometry.tita)
    bench.feed(b"#TELE\r")
    for leg in legs:
        bench.feed(f"#SETR{leg.v_m_s:.3f},{leg.w_rad_s:.3f}\r".encode())
        bench.run_for(leg.duration_s)
    _driving(bench, (b"#STOP\r",), 0.8)
    bench.world.sync_now()
    believed = _from(believed0, Pose(odometry.X / 1000, odometry.Y / 1000, odometry.tita))
    true = _from(start, bench.world.pose)
    way = bench.world.travelled_m
    turned = sum(abs(leg.w_rad_s) * leg.duration_s for leg in legs)
    time_s = sum(leg.duration_s for leg in legs) + 1.0
    ends = sum(abs(leg.v_m_s * leg.w_rad_s) for leg in legs) * 0.25**2 / 2
    bound = 0.002 + _DISTANCE_SHARE * way + way / 2 * (_HEADING_SHARE * turned + _HEADING_RAD_S * time_s) + 2 * ends
    error = math.dist(believed[:2], true[:2])
    return measured(f"error of the odometry after {way:.2f} m", error, "m", high=bound)


def _from(start: Pose, pose: Pose) -> Pose:
    """`pose` in the frame of `start`."""
    dx, dy = pose.x_m - start.x_m, pose.y_m - start.y_m
    c, s = math.cos(start.heading_rad), math.sin(start.heading_rad)
    return Pose(c * dx + s * dy, c * dy - s * dx, pose.heading_rad - start.heading_rad)
