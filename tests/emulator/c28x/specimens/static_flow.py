"""Specimens of what `static_flow` shows: ways without a value, without a return, to nowhere."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import static_pair

PAIRS: Final = (
    static_pair(
        "maybe-uninitialised",
        "one branch sets no value",
        """
def Limit(x: int16) -> int16:
    y: int16
    if x > 10:
        y = 10
    elif x > 0:
        y = x
    return y  # <-
""",
        """
def Limit(x: int16) -> int16:
    y: int16
    if x > 10:
        y = 10
    elif x > 0:
        y = x
    else:
        y = 0
    return y
""",
        ("Limit", (5,)),
    ),
    static_pair(
        "maybe-uninitialised",
        "a search that may find nothing",
        """
v: array[int16, 4] = (1, 2, 3, 4)
def Find(x: int16) -> int16:
    i: int16
    place: int16
    for i in range(4):
        if v[i] == x:
            place = i
    return place  # <-
""",
        """
v: array[int16, 4] = (1, 2, 3, 4)
def Find(x: int16) -> int16:
    i: int16
    place: int16
    found: int16 = 0
    for i in range(4):
        if v[i] == x:
            place = i
            found = 1
    if found:
        return place
    return -1
""",
        ("Find", (3,)),
    ),
    static_pair(
        "maybe-uninitialised",
        "a loop that may not turn",
        """
def Last(n: int16) -> int16:
    i: int16
    x: int16
    for i in range(n):
        x = i * 2
    return x  # <-
""",
        """
def Last(n: int16) -> int16:
    i: int16
    x: int16
    x = 0
    for i in range(n):
        x = i * 2
    return x
""",
        ("Last", (3,)),
    ),
    static_pair(
        "missing-return",
        "the last case returns nothing",
        """
def Sign(x: int16) -> int16:
    if x > 0:
        return 1
    if x < 0:
        return -1  # <-
""",
        """
def Sign(x: int16) -> int16:
    if x > 0:
        return 1
    if x < 0:
        return -1
    return 0
""",
        ("Sign", (5,)),
    ),
    static_pair(
        "switch-no-default",
        "a mode that no case knows",
        """
def Speed(mode: int16) -> float32:
    v: float32
    match mode:  # <-
        case 0:
            v = 0.0
        case 1:
            v = 0.5
    return v
""",
        """
def Speed(mode: int16) -> float32:
    v: float32
    match mode:
        case 0:
            v = 0.0
        case 1:
            v = 0.5
        case _:
            v = 0.0
    return v
""",
        ("Speed", (1,)),
    ),
    static_pair(
        "unreachable",
        "a statement behind the return",
        """
Busy: int16 = 1
def Stop() -> int16:
    return 1
    Busy = 0  # <-
""",
        """
Busy: int16 = 1
def Stop() -> int16:
    Busy = 0
    return 1
""",
        ("Stop", ()),
    ),
    static_pair(
        "unreachable",
        "a case that stands there twice",
        """
def Turn(order: int16) -> int16:
    r: int16
    match order:
        case 1:
            r = 10
        case 2:
            r = 20
        case 1:
            r = 30  # <-
        case _:
            r = 0
    return r
""",
        """
def Turn(order: int16) -> int16:
    r: int16
    match order:
        case 1:
            r = 10
        case 2:
            r = 20
        case 3:
            r = 30
        case _:
            r = 0
    return r
""",
        ("Turn", (1,)),
    ),
    static_pair(
        "case-falls",
        "slow is as fast as fast",
        """
Speed: uint16 = 0
def Choose(mode: int16) -> void:
    match mode:
        case 0:
            Speed = 0
        case 1:
            Speed = 100  # <-
            fallthrough()
        case _:
            Speed = 400
""",
        """
Speed: uint16 = 0
def Choose(mode: int16) -> void:
    match mode:
        case 0:
            Speed = 0
        case 1:
            Speed = 100
        case _:
            Speed = 400
""",
        ("Choose", (1,)),
    ),
    static_pair(
        "case-falls",
        "the local of a case",
        """
def Gain(mode: int16) -> int16:
    gain: int16 = 0
    shift: int16 = 0
    match mode:
        case 1:
            gain = 3  # <-
            shift = 1
            fallthrough()
        case 2:
            shift += 4
            gain = 9
    return gain + shift
""",
        """
def Gain(mode: int16) -> int16:
    gain: int16 = 0
    shift: int16 = 0
    match mode:
        case 1:
            gain = 3
            shift = 1
            fallthrough()
        case 2:
            shift += 4
            gain = gain * 2 + shift
    return gain + shift
""",
        ("Gain", (1,)),
    ),
    static_pair(
        "dead-store",
        "a limit that nobody looks at",
        """
def Duty(wanted: uint16) -> uint16:
    limited: uint16 = wanted
    if limited > 300:
        limited = 300  # <-
    return wanted
""",
        """
def Duty(wanted: uint16) -> uint16:
    limited: uint16 = wanted
    if limited > 300:
        limited = 300
    return limited
""",
        ("Duty", (500,)),
    ),
    static_pair(
        "dead-store",
        "an object of the file is set twice",
        """
Speed: uint16 = 0
def Turn(number: uint16) -> void:
    Speed = number / 2  # <-
    Speed = number
""",
        """
Speed: uint16 = 0
Before: uint16 = 0
def Turn(number: uint16) -> uint16:
    Speed = 0
    Speed = number / 2
    Before = Speed
    Speed = number
    return Before
""",
        ("Turn", (9,)),
    ),
    static_pair(
        "never-updated",
        "an edge that nothing remembers",
        """
Last: uint16 = 1
Presses: uint16 = 0
def Step(now: uint16) -> uint16:
    if now == 0 and Last == 1:  # <-
        Presses += 1
    return Presses
def main() -> int16:
    Step(0)
    return 0
""",
        """
Last: uint16 = 1
Presses: uint16 = 0
def Step(now: uint16) -> uint16:
    if now == 0 and Last == 1:
        Presses += 1
    Last = now
    return Presses
def main() -> int16:
    Step(0)
    return 0
""",
        ("Step", (1,)),
    ),
    static_pair(
        "not-begun-again",
        "the time in a state is the time since the start",
        """
State: uint16 = 0
Stay: uint16 = 0
Button: uint16 = 0
def Step() -> uint16:
    Stay += 1
    match State:
        case 0:
            if Button:
                State = 1
        case 1:
            if Stay > 100:  # <-
                State = 2
        case 2:
            if not Button:
                State = 0
    return State
def main() -> int16:
    i: int16
    for i in range(3):
        Step()
    return 0
""",
        """
State: uint16 = 0
Stay: uint16 = 0
Button: uint16 = 0
def Step() -> uint16:
    Stay += 1
    match State:
        case 0:
            if Button:
                State = 1
                Stay = 0
        case 1:
            if Stay > 100:
                State = 2
        case 2:
            if not Button:
                State = 0
    return State
def main() -> int16:
    i: int16
    for i in range(3):
        Step()
    return 0
""",
        ("main", ()),
    ),
)
