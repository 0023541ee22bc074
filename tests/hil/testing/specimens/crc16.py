"""crc16.c: CRC-16/CCITT of octets, each in a word of 16 bits, by a table that is made at start."""

from __future__ import annotations

from emulator.c28x.language import *

POLYNOMIAL = 0x1021

Table: array[uint16, 256]


# crc16.c: Init_Crc
def Init_Crc() -> void:
    n: uint16
    bit: uint16
    word: uint16
    for n in range(256):
        word = n << 8
        for bit in range(8):
            if word & 0x8000:
                word = word << 1 ^ POLYNOMIAL
            else:
                word = word << 1
        Table[n] = word


# crc16.c: Crc
def Crc(data: ptr[uint16], count: uint16) -> uint16:
    crc: uint16 = 0xFFFF
    i: uint16
    for i in range(count):
        crc = crc << 8 ^ Table[(crc >> 8 ^ data[i]) & 0xFF]
    return crc
