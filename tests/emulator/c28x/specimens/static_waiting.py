"""Specimens of loops that wait: on what only an interrupt changes, which C must be told."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import static_pair

PAIRS: Final = (
    static_pair(
        "poll-not-volatile",
        "a main loop that begins anew until a tick has come",
        """
ticks: uint16 = 3
done: uint16 = 0
def Isr() -> void:
    ticks += 1
def Loop() -> int16:
    seen: uint16 = 0
    while 1:
        if ticks == seen:  # <-
            continue
        seen += 1
        Step()
        if done > 2:
            return done
def Step() -> void:
    done += 1
""",
        """
ticks: volatile[uint16] = 3
done: uint16 = 0
def Isr() -> void:
    ticks += 1
def Loop() -> int16:
    seen: uint16 = 0
    while 1:
        if ticks == seen:
            continue
        seen += 1
        Step()
        if done > 2:
            return done
def Step() -> void:
    done += 1
enabled: uint16 = 1
def Off() -> void:
    enabled = 0
def Some() -> void:
    i: int16
    for i in range(4):
        if enabled == 0:
            continue
        Step()
""",
        ("Loop", ()),
    ),
    static_pair(
        "poll-not-volatile",
        "the index of a queue, beside a tick and an index of its own that are volatile",
        """
ticks: volatile[uint16] = 3
head: uint16 = 2
tail: volatile[uint16] = 0
def Isr() -> void:
    ticks += 1
    head = (head + 1) % 8
def Loop() -> int16:
    seen: uint16 = 0
    while 1:
        if ticks == seen and tail == head:  # <-
            continue
        seen += 1
        tail = (tail + 1) % 8
        if tail > 1:
            return tail
""",
        """
ticks: volatile[uint16] = 3
head: volatile[uint16] = 2
tail: volatile[uint16] = 0
last: uint16 = 5
limit: uint16 = 2
def Isr() -> void:
    ticks += 1
    head = (head + 1) % 8
def Loop() -> int16:
    seen: uint16 = 0
    while 1:
        last = tail
        if ticks == seen and last == head:
            continue
        if limit == 3:
            continue
        seen += 1
        tail = (tail + 1) % 8
        if tail > 1:
            return tail
""",
        ("Loop", ()),
    ),
    static_pair(
        "poll-not-volatile",
        "a flag of an interrupt",
        """
done: uint16 = 1
def Isr() -> void:
    done = 1
def Wait() -> int16:
    while done == 0:  # <-
        pass
    return 1
""",
        """
done: volatile[uint16] = 1
def Isr() -> void:
    done = 1
def Wait() -> int16:
    while done == 0:
        pass
    return 1
""",
        ("Wait", ()),
    ),
    static_pair(
        "poll-not-volatile",
        "a wait with a limit",
        """
ready: uint16 = 0
def Isr() -> void:
    ready = 1
def Wait(limit: int16) -> int16:
    i: int16
    for i in range(limit):  # <-
        if ready:
            return 1
    return 0
""",
        """
class flags(struct):
    count: int16
    ready: volatile[uint16]
shared: flags = (0, 0)
def Isr() -> void:
    shared.ready = 1
def Wait(limit: int16) -> int16:
    i: int16
    for i in range(limit):
        if shared.ready:
            return 1
    return 0
""",
        ("Wait", (5,)),
    ),
    static_pair(
        "poll-not-volatile",
        "a wait that is given up, and says so in the same object",
        """
state: uint16 = 2
lost: volatile[uint16] = 0
ticks: volatile[uint16] = 9
def Isr() -> void:
    state = 2
def Tick() -> void:
    ticks += 1
def Wait() -> int16:
    while state == 1:  # <-
        if ticks >= 9:
            state = 0
            lost += 1
            return 0
    return state
""",
        """
state: uint16 = 2
lost: volatile[uint16] = 0
ticks: volatile[uint16] = 9
def Isr() -> void:
    state = 2
def Tick() -> void:
    ticks += 1
def Wait() -> int16:
    while state == 1:
        if ticks >= 9:
            state = 0
            lost += 1
    return state
""",
        ("Wait", ()),
    ),
    static_pair(
        "poll-not-volatile",
        "an endless loop with a way out",
        """
mode: uint16 = 2
def Set(x: uint16) -> void:
    mode = x
def Sum() -> int16:
    n: int16 = 0
    while 1:  # <-
        if mode == 2:
            return 4
        n += 1
""",
        """
mode: uint16 = 2
length: uint16 = 4
total: int16 = 0
def Set(x: uint16, n: uint16) -> void:
    mode = x
    length = n
def Sum() -> int16:
    n: uint16 = 0
    while n < length and mode == 2:
        total += 1
        n += 1
    return n
""",
        ("Sum", ()),
    ),
    static_pair(
        "dangling-pointer",
        "a function leaves the address of its local behind",
        """
used: ptr[int16] = NULL
def Defaults() -> void:
    gain: int16 = 4
    used = addressof(gain)  # <-
def Gain() -> int16:
    return 0 if used == NULL else used[0]
""",
        """
used: ptr[int16] = NULL
def Defaults() -> void:
    gain: static[int16] = 4
    used = addressof(gain)
def Gain() -> int16:
    return 0 if used == NULL else used[0]
""",
        ("Gain", ()),
    ),
)
