"""door.c: a door: a table of handlers by state, a table of names, and a log of transitions."""

from __future__ import annotations

from emulator.c28x.language import *

LOG = 8


class DOOR(enum):
    SHUT = 0
    OPENING = 1
    OPEN = 2
    SHUTTING = 3
    STATES = 4


class EVENT(enum):
    BUTTON = 0
    END = 1
    TICK = 2


class ENTRY(struct):
    origin: DOOR
    target: DOOR
    tick: uint32


Now: DOOR = DOOR.SHUT
Ticks: uint32 = 0
Timeout: uint16 = 0
Log: array[ENTRY, LOG]
Logged: uint16 = 0


# door.c: Go
def Go(target: DOOR) -> void:
    entry: ptr[ENTRY] = addressof(Log[Logged % LOG])
    entry.origin = Now
    entry.target = target
    entry.tick = Ticks
    Logged += 1
    Now = target


# door.c: On_Shut
def On_Shut(event: EVENT) -> int16:
    if event == EVENT.BUTTON:
        Go(DOOR.OPENING)
        return 1
    return 0


# door.c: On_Opening
def On_Opening(event: EVENT) -> int16:
    if event == EVENT.END:
        Timeout = 3
        Go(DOOR.OPEN)
        return 1
    return 0


# door.c: On_Open
def On_Open(event: EVENT) -> int16:
    if event == EVENT.TICK:
        Timeout -= 1
        if Timeout == 0:
            Go(DOOR.SHUTTING)
            return 1
    return 0


# door.c: On_Shutting
def On_Shutting(event: EVENT) -> int16:
    match event:
        case EVENT.BUTTON:
            Go(DOOR.OPENING)
        case EVENT.END:
            Go(DOOR.SHUT)
        case _:
            return 0
    return 1


Handlers: array[funcptr[int16, EVENT], DOOR.STATES] = (On_Shut, On_Opening, On_Open, On_Shutting)
Names: array[ptr[char], DOOR.STATES] = ("shut", "opening", "open", "shutting")


# door.c: Dispatch
def Dispatch(event: EVENT) -> int16:
    if event == EVENT.TICK:
        Ticks += 1
    return Handlers[Now](event)


# door.c: Name_Length
def Name_Length() -> uint16:
    n: uint16 = 0
    name: ptr[char] = Names[Now]
    while name[n]:
        n += 1
    return n


# door.c: Last_Change
def Last_Change() -> uint32:
    if Logged == 0:
        return 0
    return Log[(Logged - 1) % LOG].tick
