"""ring.c: a ring buffer of words."""

from __future__ import annotations

from emulator.c28x.language import *

SIZE = 8


class RING(struct):
    data: array[uint16, SIZE]
    head: uint16
    tail: uint16


Ring: RING


# ring.c: Ring_Init
def Ring_Init(r: ptr[RING]) -> void:
    r.head = 0
    r.tail = 0


# ring.c: Ring_Put
def Ring_Put(r: ptr[RING], word: uint16) -> int16:
    next: uint16
    next = (r.head + 1) % SIZE
    if next == r.tail:
        return 0
    r.data[r.head] = word
    r.head = next
    return 1


# ring.c: Ring_Get
def Ring_Get(r: ptr[RING], word: ptr[uint16]) -> int16:
    if r.head == r.tail:
        return 0
    word[0] = r.data[r.tail]
    r.tail = (r.tail + 1) % SIZE
    return 1


# ring.c: Put
def Put(word: uint16) -> int16:
    return Ring_Put(addressof(Ring), word)


# ring.c: Get
def Get() -> int16:
    word: uint16
    if Ring_Get(addressof(Ring), addressof(word)):
        return word
    return -1


# ring.c: Init
def Init() -> void:
    Ring_Init(addressof(Ring))
