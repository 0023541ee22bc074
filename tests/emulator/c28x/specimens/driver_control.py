"""Correct drivers that decide: states, switches, flags, loops.  Results: published check values, or by hand."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Driver

DRIVERS: Final = (
    Driver(
        # 7 is pressed long enough at the third sample, released at the sixth
        "debouncer as a state machine",
        "Run",
        (((), 21),),
        """
class STATE(enum):
    IDLE = 0
    MAYBE = 1
    PRESSED = 2
State: STATE = 0
Count: uint16 = 0
Levels: const[array[int16, 10]] = (0, 1, 1, 1, 1, 0, 0, 1, 0, 0)
def Step(level: int16) -> int16:
    out: int16
    match State:
        case STATE.IDLE:
            out = 0
            if level:
                State = STATE.MAYBE
                Count = 1
        case STATE.MAYBE:
            out = 1
            if not level:
                State = STATE.IDLE
            elif Count >= 2:
                State = STATE.PRESSED
            else:
                Count += 1
        case STATE.PRESSED:
            out = 10
            if not level:
                State = STATE.IDLE
    return out
def Run() -> int16:
    i: int16
    sum: int16 = 0
    for i in range(10):
        sum += Step(Levels[i])
    return sum - 2
""",
    ),
    Driver(
        # 3 + 4, 3 - 4, 3 * 4
        "table of functions",
        "Apply",
        (((0, 3, 4), 7), ((1, 3, 4), -1), ((2, 3, 4), 12)),
        """
def Plus(a: int16, b: int16) -> int16:
    return a + b
def Minus(a: int16, b: int16) -> int16:
    return a - b
def Times(a: int16, b: int16) -> int16:
    return a * b
Table: array[funcptr[int16, int16, int16], 3] = (Plus, Minus, Times)
def Apply(what: uint16, a: int16, b: int16) -> int16:
    if what > 2:
        return 0
    return Table[what](a, b)
""",
    ),
    Driver(
        "a flag that guards a value",
        "Choose",
        (((0, 5), -1), ((1, 5), 5)),
        """
def Choose(valid: int16, x: int16) -> int16:
    best: int16
    if valid:
        best = x
    if valid:
        return best
    return -1
""",
    ),
    Driver(
        # at least one turn
        "a loop that turns at least once",
        "Digits",
        (((0,), 1), ((99,), 2), ((30000,), 5)),
        """
def Digits(x: int16) -> int16:
    n: int16 = 0
    last: int16
    more: int16 = 1
    while more:
        n += 1
        x = x / 10
        last = x
        more = x != 0
    return n + last
""",
    ),
    Driver(
        "a switch with every constant of its enumeration",
        "Gain",
        (((0,), 1.0), ((1,), 2.0), ((2,), 4.0)),
        """
class SENSOR(enum):
    LEFT = 0
    FRONT = 1
    RIGHT = 2
def Gain(s: SENSOR) -> float32:
    g: float32
    match s:
        case SENSOR.LEFT:
            g = 1.0
        case SENSOR.FRONT:
            g = 2.0
        case SENSOR.RIGHT:
            g = 4.0
    return g
""",
    ),
    Driver(
        # continue and break, a value from the first hit
        "continue and break",
        "First",
        (((2,), 4), ((50,), -1)),
        """
v: array[int16, 6] = (1, -1, 3, -5, 4, 6)
def First(limit: int16) -> int16:
    i: int16
    found: int16 = -1
    for i in range(6):
        if v[i] < 0 or v[i] % 2:
            continue
        if v[i] > limit:
            found = v[i]
            break
    return found
""",
    ),
)
