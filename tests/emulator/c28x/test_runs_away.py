"""`runs-away`: a regulator whose error is backwards, and what happens to the value; right ones beside it."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.workshop import Workshop

#: A motor that follows `Step() * GAIN`; nothing moves it in passes that are blocked.
_REGULATOR = """
speed_rpm: int16 = 0
target_rpm: int16 = 0
total: int32 = 0
gain: int16 = 1
def Step() -> int16:
    error: int32 = int32(speed_rpm) - target_rpm
    duty: int32
    total += error * 8
    if total > 230400:
        total = 230400
    elif total < -230400:
        total = -230400
    duty = (error * 180 + total) / 256
    if duty > 3000:
        duty = 3000
    elif duty < -3000:
        duty = -3000
    return int16(duty) * gain
def Drive(sign: int16, passes: int16, first: int16, rise: int16, blocked: int16) -> int16:
    global speed_rpm, target_rpm, gain
    i: int16
    gain = sign
    target_rpm = first
    for i in range(passes):
        target_rpm += rise
        speed_rpm = 0 if i < blocked else (speed_rpm * 7 + Step()) / 8
        if i < blocked:
            Step()
    return speed_rpm
"""
_TOLD = "it is the measured value less the wanted one, and total grows with it"


def _found(*runs: tuple[int, int, int, int, int]) -> list[str]:
    shop = Workshop(_REGULATOR)
    for run in runs:
        shop.Drive(*run)
    shop.runtime.finish()
    return [f.message for f in shop.findings if f.rule == "runs-away"]


@pytest.mark.parametrize("target", [500, -500])
def test_a_value_that_is_driven_away_is_told(target: int) -> None:
    (message,) = _found((1, 400, target, 0, 0))
    assert message.startswith(f"speed_rpm - target_rpm has grown from {-target} to ")
    assert message.endswith(f"in 40 passes, while the wanted value stood at {target}: {_TOLD}")


@pytest.mark.parametrize("runs", [
    ((-1, 400, 500, 0, 0),),                          # an output that is active low
    ((-1, 400, 500, 0, 100),),                        # a motor that is blocked, and then runs
    ((-1, 200, 0, 9, 200),),                          # a ramp of orders to a blocked motor
    ((-1, 100, 500, 0, 0), (-1, 100, -900, 0, 0)),    # an order to turn back
    ((1, 400, 0, 0, 0),),                             # nothing is wanted
    ((1, 30, 500, 0, 0),),                            # too short to say
])  # fmt: skip
def test_a_value_that_comes_back_or_stands_is_not_told(runs: tuple[tuple[int, int, int, int, int], ...]) -> None:
    assert _found(*runs) == []


def test_a_constant_that_an_output_hands_on_does_not_depend_on_the_error() -> None:
    """C's `target_rpm = last = 0`."""
    text = _REGULATOR.replace("    target_rpm = first", "    last = 0\n    target_rpm = last\n    target_rpm = first")
    text = text.replace("        speed_rpm = 0 if i < blocked else (speed_rpm * 7 + Step()) / 8\n", """
        last = Step()
        speed_rpm = (speed_rpm * 7 + last) / 8
""").replace("global ", "global last, ").replace("gain: int16 = 1\n", "gain: int16 = 1\nlast: int16 = 0\n")  # fmt: skip
    shop = Workshop(text)
    shop.Drive(1, 400, 500, 0, 0)
    shop.runtime.finish()
    assert [f.rule for f in shop.findings if f.rule == "runs-away"] == ["runs-away"]
