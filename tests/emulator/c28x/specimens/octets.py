"""Specimens of characters that are taken to have eight bits."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
    Pair(
        "octet",
        "a checksum that never wraps at 256",
        (("Sum", ()),),
        """
Frame: array[uchar, 4] = (200, 100, 50, 25)
def Sum() -> int16:
    sum: uchar = 0
    i: int16
    for i in range(4):
        sum += Frame[i]  # <-
    return sum
""",
        """
Frame: array[uchar, 4] = (200, 100, 50, 25)
def Sum() -> int16:
    sum: uchar = 0
    i: int16
    for i in range(4):
        sum = (sum + Frame[i]) & 0xFF
    return sum
""",
    ),
    Pair(
        "octet",
        "a cast is meant to cut the high half",
        (("Low", (0x1234,)),),
        """
def Low(w: uint16) -> uint16:
    return uchar(w)  # <-
""",
        """
def Low(w: uint16) -> uint16:
    return w & 0xFF
""",
    ),
    Pair(
        "octet",
        "a register of eight bits with a sign",
        (("Degrees", (0xF6,)),),
        """
def Degrees(raw: uint16) -> int16:
    t: schar
    t = schar(raw)  # <-
    return 25 + t
""",
        """
def Degrees(raw: uint16) -> int16:
    t: int16
    t = int16(raw & 0xFF)
    if t > 127:
        t -= 256
    return 25 + t
""",
    ),
    Pair(
        "octet",
        "CRC-8 shifts out of the octet",
        (("Crc", ()),),
        """
Message: array[uchar, 3] = (1, 2, 3)
def Crc() -> int16:
    crc: uchar = 0
    i: int16
    k: int16
    for i in range(3):
        crc = crc ^ Message[i]
        for k in range(8):
            if crc & 0x80:
                crc = (crc << 1) ^ 0x07  # <-
            else:
                crc = crc << 1
    return crc
""",
        """
Message: array[uchar, 3] = (1, 2, 3)
def Crc() -> int16:
    crc: uchar = 0
    i: int16
    k: int16
    for i in range(3):
        crc = crc ^ Message[i]
        for k in range(8):
            if crc & 0x80:
                crc = ((crc << 1) ^ 0x07) & 0xFF
            else:
                crc = (crc << 1) & 0xFF
    return crc
""",
    ),
    Pair(
        "octet",
        "the complement of an octet",
        (("Inverted", (0x0F,)),),
        """
def Inverted(b: uchar) -> int16:
    c: uchar
    c = ~b  # <-
    return c
""",
        """
def Inverted(b: uchar) -> int16:
    c: uchar
    c = ~b & 0xFF
    return c
""",
    ),
    Pair(
        "octet",
        "a received character asked for its sign",
        (("Step", (0xFE,)),),
        """
def Step(c: char) -> int16:
    if c < 0:  # <-
        return -1
    return 1
""",
        """
def Step(c: char) -> int16:
    if c & 0x80:
        return -1
    return 1
""",
    ),
    Pair(
        "octet",
        "a sequence number that is to begin anew at 256",
        (("Next", ()),),
        """
Sequence: uchar = 255
def Next() -> int16:
    Sequence += 1  # <-
    return Sequence
""",
        """
Sequence: uchar = 255
def Next() -> int16:
    Sequence = (Sequence + 1) & 0xFF
    return Sequence
""",
    ),
)
