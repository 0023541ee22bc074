"""text_numbers.c: numbers to text and back, tokens, and a report built with sprintf."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import atof, strlen
from emulator.sysbios.headers import System_sprintf

DIGITS = 7
FIELDS = 4

Report: array[char, 40]
Fields: array[ptr[char], FIELDS]
Hex: array[const[char], 17] = "0123456789ABCDEF"


# text_numbers.c: Decimal
def Decimal(value: int16, out: ptr[char]) -> uint16:
    digits: array[char, DIGITS]
    n: uint16 = 0
    length: uint16 = 0
    left: uint16
    if value < 0:
        out[length] = "-"
        length += 1
        left = uint16(0) - uint16(value)
    else:
        left = value
    while 1:
        digits[n] = "0" + left % 10
        n += 1
        left /= 10
        if left == 0:
            break
    while n > 0:
        n -= 1
        out[length] = digits[n]
        length += 1
    out[length] = 0
    return length


# text_numbers.c: Hexadecimal
def Hexadecimal(value: uint16, out: ptr[char]) -> void:
    i: int16
    for i in range(4):
        out[i] = Hex[value >> (12 - 4 * i) & 0xF]
    out[4] = 0


# text_numbers.c: Parse
def Parse(text: ptr[char], value: ptr[int16]) -> int16:
    result: int32 = 0
    negative: uint16 = 0
    if text[0] == "-":
        negative = 1
        text += 1
    if text[0] == 0:
        return -1
    while text[0] >= "0" and text[0] <= "9":
        result = result * 10 + (text[0] - "0")
        if result > 32767:
            return -2
        text += 1
    if text[0] != 0:
        return -3
    value[0] = int16(-result if negative else result)
    return 0


# text_numbers.c: Split
def Split(text: ptr[char], separator: char) -> uint16:
    n: uint16 = 0
    while n < FIELDS:
        Fields[n] = text
        n += 1
        while text[0] != 0 and text[0] != separator:
            text += 1
        if text[0] == 0:
            return n
        text[0] = 0
        text += 1
    return n


# text_numbers.c: Field_Number
def Field_Number(i: uint16, count: uint16) -> float32:
    if i >= count:
        return 0.0
    return atof(Fields[i])


# text_numbers.c: Make_Report
def Make_Report(left: int16, right: int16) -> uint16:
    System_sprintf(Report, "#ODO %d,%d\r", left, right)
    return uint16(strlen(Report))
