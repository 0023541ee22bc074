"""Regulators whose integral runs beyond the limits of their output, or whose error is backwards, beside right ones."""

from __future__ import annotations

from tests.emulator.c28x.specimens import Pair

#: The error stays for 200 passes.
_HOLD = (("Hold", (40, 200)), ("Hold", (-30, 5)))


def _regulator(name: str, defect: str, correct: str) -> Pair:
    return Pair("wind-up", name, _HOLD, defect, correct, watch=True)



def _feedback(name: str, defect: str, correct: str) -> Pair:
    return Pair("feedback-reversed", name, (("Drive", (50,)),), defect, correct)


PAIRS = (
    _regulator(
        "a local that becomes the integral behind the limits",
        """
LIMIT = 900.0
total: float32 = 0.0
def Step(target: float32, value: float32) -> float32:
    error: float32 = target - value
    after: float32 = total + 0.5 * error  # <-
    duty: float32 = 2.0 * error + after
    if duty > LIMIT:
        duty = LIMIT
    elif duty < 0.0:
        duty = 0.0
    total = after
    return duty
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error * 10.0, 0.0)
    return last
""",
        """
LIMIT = 900.0
total: float32 = 0.0
def Step(target: float32, value: float32) -> float32:
    error: float32 = target - value
    after: float32 = total + 0.5 * error
    duty: float32 = 2.0 * error + after
    if duty > LIMIT:
        duty = LIMIT
    elif duty < 0.0:
        duty = 0.0
    else:
        total = after
    return duty
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error * 10.0, 0.0)
    return last
""",
    ),
    _regulator(
        "an integral in fixed point",
        """
LIMIT = 900
total: int32 = 0
def Step(target: int16, value: int16) -> int16:
    error: int32 = int32(target) - value
    duty: int32
    total += error * 24  # <-
    duty = (error * 180 + total) / 256
    if duty > LIMIT:
        duty = LIMIT
    elif duty < -LIMIT:
        duty = -LIMIT
    return int16(duty)
def Hold(error: int16, passes: int16) -> int16:
    i: int16
    last: int16 = 0
    for i in range(passes):
        last = Step(error * 10, 0)
    return last
""",
        """
LIMIT = 900
total: int32 = 0
def Step(target: int16, value: int16) -> int16:
    error: int32 = int32(target) - value
    duty: int32
    total += error * 24
    if total > LIMIT * int32(256):
        total = LIMIT * int32(256)
    if total < -LIMIT * int32(256):
        total = -LIMIT * int32(256)
    duty = (error * 180 + total) / 256
    if duty > LIMIT:
        duty = LIMIT
    elif duty < -LIMIT:
        duty = -LIMIT
    return int16(duty)
def Hold(error: int16, passes: int16) -> int16:
    i: int16
    last: int16 = 0
    for i in range(passes):
        last = Step(error * 10, 0)
    return last
""",
    ),
    _regulator(
        "an integral of a structure, and a function that limits",
        """
class Loop(struct):
    kp: float32
    ki: float32
    total: float32
heat: Loop = (0.5, 0.2, 0.0)
def Within(value: float32, low: float32, high: float32) -> float32:
    if value < low:
        return low
    if value > high:
        return high
    return value
def Step(loop: ptr[Loop], error: float32) -> float32:
    loop.total = loop.total + loop.ki * error  # <-
    return Within(loop.kp * error + loop.total, 0.0, 100.0)
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(addressof(heat), error)
    return last
""",
        """
class Loop(struct):
    kp: float32
    ki: float32
    total: float32
heat: Loop = (0.5, 0.2, 0.0)
def Within(value: float32, low: float32, high: float32) -> float32:
    if value < low:
        return low
    if value > high:
        return high
    return value
def Step(loop: ptr[Loop], error: float32) -> float32:
    output: float32 = loop.kp * error + loop.total
    if (output < 100.0 or error < 0.0) and (output > 0.0 or error > 0.0):
        loop.total = loop.total + loop.ki * error
    return Within(output, 0.0, 100.0)
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(addressof(heat), error)
    return last
""",
    ),
    _regulator(
        "an integral that is taken back by what the limit cut off",
        """
total: float32 = 0.0
def Step(error: float32) -> float32:
    output: float32
    limited: float32
    total += 0.2 * error  # <-
    output = 0.5 * error + total
    limited = 100.0 if output > 100.0 else 0.0 if output < 0.0 else output
    return limited
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error)
    return last
""",
        """
total: float32 = 0.0
def Step(error: float32) -> float32:
    output: float32
    limited: float32
    output = 0.5 * error + total
    limited = 100.0 if output > 100.0 else 0.0 if output < 0.0 else output
    total += 0.2 * error + 0.5 * (limited - output)
    return limited
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error)
    return last
""",
    ),
    _regulator(
        "sums that are no integrals of a regulator",
        """
total: float32 = 0.0
def Step(target: float32, value: float32) -> float32:
    output: float32
    total = total + (target - value) * 0.3  # <-
    output = (target - value) * 0.5 + total
    if output > 100.0:
        output = 100.0
    return output
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error, 0.0)
    return last
""",
        """
way: float32 = 0.0
before: float32 = 0.0
mean: float32 = 0.0
elapsed: int32 = 0
def Step(place: float32, value: float32) -> float32:
    shown: float32
    output: float32
    smooth: float32
    way += place - before
    before = place
    shown = way * 2.0
    if shown > 100.0:
        shown = 100.0
    elapsed += 3
    output = elapsed * 0.25
    if output > 100.0:
        output = 100.0
    mean += (value - mean) * 0.1
    smooth = mean + 0.2 * value
    if smooth > 100.0:
        smooth = 100.0
    return shown + output + smooth
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(float32(i) * error, error)
    return last
""",
    ),
    _regulator(
        "an output whose steps are limited",
        """
total: float32 = 0.0
def Step(error: float32) -> float32:
    output: float32
    total += 0.2 * error  # <-
    output = 0.5 * error + total
    if output > 100.0:
        output = 100.0
    return output
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error)
    return last
""",
        """
total: float32 = 0.0
before: float32 = 0.0
def Step(error: float32) -> float32:
    output: float32
    total += 0.02 * error
    output = 0.5 * error + total
    if output > before + 0.25:
        output = before + 0.25
    before = output
    return output
def Hold(error: int16, passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step(error)
    return last
""",
    ),
    _feedback(
        "an error in fixed point",
        """
speed_rpm: int16 = 0
target_rpm: int16 = 900
total: int32 = 0
def Step() -> int16:
    error: int32 = int32(speed_rpm) - target_rpm  # <-
    duty: int32
    total += error * 24
    if total > 230400:
        total = 230400
    elif total < 0:
        total = 0
    duty = (error * 180 + total) / 256
    if duty > 900:
        duty = 900
    elif duty < 0:
        duty = 0
    return int16(duty)
def Drive(passes: int16) -> int16:
    global speed_rpm
    i: int16
    for i in range(passes):
        speed_rpm = (speed_rpm * 7 + Step()) / 8
    return speed_rpm
""",
        """
speed_rpm: int16 = 0
target_rpm: int16 = 900
total: int32 = 0
def Step() -> int16:
    error: int32 = int32(target_rpm) - speed_rpm
    duty: int32
    total += error * 24
    if total > 230400:
        total = 230400
    elif total < 0:
        total = 0
    duty = (error * 180 + total) / 256
    if duty > 900:
        duty = 900
    elif duty < 0:
        duty = 0
    return int16(duty)
def Drive(passes: int16) -> int16:
    global speed_rpm
    i: int16
    for i in range(passes):
        speed_rpm = (speed_rpm * 7 + Step()) / 8
    return speed_rpm
""",
    ),
    _feedback(
        "an integral of a structure, and its twin that subtracts the error",
        """
class Loop(struct):
    integral: float32
    setpoint: float32
loop: Loop = (0.0, 3.5)
pressure: float32 = 0.0
def Within(value: float32, high: float32) -> float32:
    if value < 0.0:
        return 0.0
    return high if value > high else value
def Step() -> float32:
    error: float32 = pressure - loop.setpoint  # <-
    loop.integral = Within(loop.integral + error * 0.05, 10.0)
    return Within(error * 0.5 + loop.integral, 10.0)
def Drive(passes: int16) -> float32:
    global pressure
    i: int16
    for i in range(passes):
        pressure = pressure * 0.875 + Step() * 0.125
    return pressure
""",
        """
class Loop(struct):
    integral: float32
    setpoint: float32
loop: Loop = (0.0, 3.5)
pressure: float32 = 0.0
def Within(value: float32, high: float32) -> float32:
    if value < 0.0:
        return 0.0
    return high if value > high else value
def Step() -> float32:
    error: float32 = pressure - loop.setpoint
    loop.integral = Within(loop.integral - error * 0.05, 10.0)
    return Within(loop.integral - error * 0.5, 10.0)
def Drive(passes: int16) -> float32:
    global pressure
    i: int16
    for i in range(passes):
        pressure = pressure * 0.875 + Step() * 0.125
    return pressure
""",
    ),
    _feedback(
        "an output that another statement turns round",
        """
pressure: float32 = 0.0
wanted: float32 = 3.5
total: float32 = 0.0
duty: float32 = 0.0
def Step() -> float32:
    error: float32 = pressure - wanted  # <-
    total += error * 0.05
    if total < -10.0:
        total = -10.0
    elif total > 0.0:
        total = 0.0
    duty = error * 0.5 + total
    return duty
def Drive(passes: int16) -> float32:
    global pressure
    i: int16
    for i in range(passes):
        pressure = pressure * 0.875 + Step() * 0.125
    return pressure
""",
        """
pressure: float32 = 0.0
wanted: float32 = 3.5
total: float32 = 0.0
duty: float32 = 0.0
def Step() -> float32:
    error: float32 = pressure - wanted
    total += error * 0.05
    if total < -10.0:
        total = -10.0
    elif total > 0.0:
        total = 0.0
    duty = error * 0.5 + total
    return -duty
def Drive(passes: int16) -> float32:
    global pressure
    i: int16
    for i in range(passes):
        pressure = pressure * 0.875 + Step() * 0.125
    return pressure
""",
    ),
    _feedback(
        "a fan that cools has the other sign",
        """
flow: float32 = 18.0
flow_target: float32 = 22.0
total: float32 = 0.0
def Step() -> float32:
    error: float32 = flow - flow_target  # <-
    total += error * 0.05
    if total < 0.0:
        total = 0.0
    return error * 0.5 + total
def Drive(passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step()
    return last
""",
        """
current_temperature: float32 = 18.0
temperature_target: float32 = 22.0
total: float32 = 0.0
def Step() -> float32:
    error: float32 = current_temperature - temperature_target
    total += error * 0.05
    if total < 0.0:
        total = 0.0
    return error * 0.5 + total
def Drive(passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step()
    return last
""",
    ),
    _feedback(
        "an error that is written twice, and a gain below 0",
        """
flow: float32 = 0.0
flow_target: float32 = 4.0
ki: float32 = 0.05
total: float32 = 0.0
def Step() -> float32:
    total += (flow - flow_target) * ki  # <-
    if total < 0.0:
        total = 0.0
    return (flow - flow_target) * 0.5 + total
def Drive(passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step()
    return last
""",
        """
flow: float32 = 0.0
flow_target: float32 = 4.0
ki: float32 = -0.05
total: float32 = 0.0
def Step() -> float32:
    total += (flow - flow_target) * ki
    if total < 0.0:
        total = 0.0
    return (flow - flow_target) * 0.5 + total
def Drive(passes: int16) -> float32:
    i: int16
    last: float32 = 0.0
    for i in range(passes):
        last = Step()
    return last
""",
    ),
    _feedback(
        "a motor that turns both ways",
        """
out_speed: int16 = 0
goal_speed: int16 = -900
total: int32 = 0
way: int16 = 0
def Turn(duty: int16) -> None:
    global out_speed
    global way
    if duty < 0:
        way = -1
        out_speed = (out_speed * 7 + duty) / 8
    else:
        way = 1
        out_speed = (out_speed * 7 + duty) / 8
def Drive(passes: int16) -> int16:
    error: int32
    i: int16
    for i in range(passes):
        error = int32(out_speed) - goal_speed  # <-
        total += error * 24
        if total > 230400:
            total = 230400
        elif total < -230400:
            total = -230400
        Turn(int16((error * 180 + total) / 256))
    return out_speed
""",
        """
out_speed: int16 = 0
goal_speed: int16 = -900
total: int32 = 0
way: int16 = 0
def Turn(duty: int16) -> None:
    global out_speed
    global way
    if duty < 0:
        way = -1
        out_speed = (out_speed * 7 + duty) / 8
    else:
        way = 1
        out_speed = (out_speed * 7 + duty) / 8
def Drive(passes: int16) -> int16:
    error: int32
    i: int16
    for i in range(passes):
        error = int32(out_speed) - goal_speed
        total += error * 24
        if total > 230400:
            total = 230400
        elif total < -230400:
            total = -230400
        Turn(int16((error * -180 - total) / 256))
    return out_speed
""",
    ),
)
