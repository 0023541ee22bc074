"""`string.h` and `stdio.h` on a machine of 16-bit words: values by ISO C, sizes in words."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.emulator.c28x.workshop import Workshop

HEADER = "from emulator.c28x.language import *\nfrom emulator.c28x.rts import *\n"
TEXT = "buf: array[char, {room}]\n\ndef run() -> int16:\n    {statement}\n"


def run(statement: str, room: int = 40, **more: object) -> tuple[Workshop, int]:
    shop = Workshop(TEXT.format(room=room, statement=statement), header=HEADER, **more)
    return shop, shop.run()


def text(shop: Workshop) -> str:
    data = shop.linked.objects["drv.buf"].data
    return "".join(chr(c) for c in data[: data.index(0)])


def printed(form: str, arguments: str) -> str:
    shop, count = run(f'return sprintf(buf, "{form}", {arguments})')
    assert shop.rules() == []
    assert count == len(text(shop))
    return text(shop)


@pytest.mark.parametrize(
    ("form", "arguments", "wanted"),
    [
        ("%d %u", "-1, 0xFFFF", "-1 65535"),
        ("%5d|%-5d|%05d|%+d|% d", "42, 42, 42, 42, 42", "   42|42   |00042|+42| 42"),
        ("% 05d|%+05d", "42, 42", " 0042|+0042"),
        ("%.3d|%08.3d|%.0d|", "7, 7, 0", "007|     007||"),
        ("%x|%X|%#x|%#08x|%#o|%o", "255, 255, 255, 255, 8, 8", "ff|FF|0xff|0x0000ff|010|10"),
        ("%ld %lu %lx", "int32(-70000), uint32(3000000000), uint32(0xABCDEF01)", "-70000 3000000000 abcdef01"),
        ("%*d|%-*d|%.*f", "4, 7, 4, 7, 2, 1.5", "   7|7   |1.50"),
        ("%c%c|%3c", "'a', 'b', 'c'", "ab|  c"),
        ("%s|%.2s|%6s|%-6s|", "'abc', 'abc', 'abc', 'abc'", "abc|ab|   abc|abc   |"),
        ("%f|%.2f|%8.3f|%08.3f|%+.1f", "0.5, -2.25, 3.14159, -3.14159, 1.0", "0.500000|-2.25|   3.142|-003.142|+1.0"),
        ("%e|%.2E|%g|%G", "1234.5, 0.001, 0.0001, 1.0e10", "1.234500e+03|1.00E-03|0.0001|1E+10"),
        ("100%%|%d", "3", "100%|3"),
    ],
)
def test_sprintf_prints_as_ISO_C_says(form: str, arguments: str, wanted: str) -> None:
    # A text of one character would be a character constant: the arguments of %s are longer.
    assert printed(form, arguments) == wanted


@given(value=st.floats(-30000.0, 30000.0, width=32), digits=st.integers(0, 4))
@settings(max_examples=40, deadline=None)
def test_a_float_prints_the_value_that_it_has(value: float, digits: int) -> None:
    shop = Workshop(
        f'buf: array[char, 40]\n\ndef run(x: float32) -> int16:\n    return sprintf(buf, "%.{digits}f", x)\n',
        header=HEADER,
    )
    shop.run(value)
    # A denormal argument is the one that the FPU flushes.
    exact = value if abs(value) >= 2.0**-126 else math.copysign(0.0, value)
    assert float(text(shop)) == float(f"{struct.unpack('<f', struct.pack('<f', exact))[0]:.{digits}f}")


def test_a_conversion_that_there_is_not_is_told() -> None:
    shop, _ = run('return sprintf(buf, "%d%n", 1)')
    assert shop.rules() == ["printf-format"]
    assert text(shop) == "1%n"


def test_a_long_read_as_int_shifts_what_comes_behind() -> None:
    shop, _ = run('return sprintf(buf, "%d %d", int32(0x00020001), 7)')
    assert text(shop) == "1 2"


@pytest.mark.parametrize(
    ("call", "result"), [('printf("%d of %s", 3, "xy")', 7), ('puts("abc")', 0), ("putchar(65)", 65)]
)
def test_what_goes_to_a_console_is_nobody_s_here(call: str, result: int) -> None:
    # "3 of xy" has 7 characters.
    shop, value = run(f"return {call}")
    assert value == result
    assert shop.rules() == ["unmodelled"]


def test_printf_looks_at_its_arguments() -> None:
    shop, _ = run('return printf("%d %d", 1)')
    assert shop.rules() == ["varargs-missing", "unmodelled"]


def test_an_argument_that_is_not_there_is_told() -> None:
    shop, _ = run('return sprintf(buf, "%d %d", 1)')
    assert shop.rules() == ["varargs-missing"]


def test_sprintf_writes_beyond_its_buffer_and_snprintf_does_not() -> None:
    shop, count = run('return sprintf(buf, "%s", "abcdef")', room=4)
    assert (shop.rules(), count) == (["memcpy-outside"], 6)
    shop, count = run('return snprintf(buf, sizeof(buf), "%s", "abcdef")', room=4)
    assert (shop.rules(), count, text(shop)) == ([], 6, "abc")


@pytest.mark.parametrize(
    ("statement", "wanted", "result"),
    [
        ("strcpy(buf, 'abc')\n    strncpy(buf, 'xy', 2)\n    return 0", "xyc", 0),
        ("strncpy(buf, 'xy', 5)\n    return buf[4]", "xy", 0),
        ("strcpy(buf, 'abc')\n    strncat(buf, 'defg', 2)\n    return strlen(buf)", "abcde", 5),
        ("strcpy(buf, 'abcdef')\n    memmove(buf + 2, buf, 4)\n    return 0", "ababcd", 0),
        ("strcpy(buf, 'abcdef')\n    memmove(buf, buf + 2, 5)\n    return 0", "cdef", 0),
        ("strcpy(buf, 'a,b,c')\n    return strchr(buf, ',') - buf", "a,b,c", 1),
        ("strcpy(buf, 'a,b,c')\n    return strrchr(buf, ',') - buf", "a,b,c", 3),
        ("strcpy(buf, 'a,b,c')\n    return strchr(buf, 0) - buf", "a,b,c", 5),
        ("strcpy(buf, 'a,b,c')\n    return strchr(buf, 'x') == NULL", "a,b,c", 1),
        ("strcpy(buf, '#SPD 12')\n    return strstr(buf, 'PD') - buf", "#SPD 12", 2),
        ("strcpy(buf, '#SPD 12')\n    return strstr(buf, 'PX') == NULL", "#SPD 12", 1),
        ("strcpy(buf, '#SPD 12')\n    return strncmp(buf, '#SPX', 3)", "#SPD 12", 0),
        ("strcpy(buf, '#SPD 12')\n    return strncmp(buf, '#SPX', 4)", "#SPD 12", -1),
    ],
)
def test_texts(statement: str, wanted: str, result: int) -> None:
    shop, returned = run(statement)
    assert (text(shop), returned) == (wanted, result)
    assert shop.rules() == []


def test_strncpy_that_fills_its_buffer_leaves_a_text_without_an_end() -> None:
    shop, _ = run("strncpy(buf, 'abcdef', sizeof(buf))\n    return strlen(buf)", room=4)
    assert shop.rules() != []


def test_memmove_takes_words_not_octets() -> None:
    source = (
        "v: array[int32, 4] = (1, 2, 3, 4)\n\ndef run(n: uint16) -> int32:\n"
        "    memmove(v, addressof(v[1]), n)\n    return v[2]\n"
    )
    shop = Workshop(source, header=HEADER)
    assert shop.run(6) == 4
    assert shop.rules() == []
    shop = Workshop(source, header=HEADER)
    shop.run(12)
    assert set(shop.rules()) == {"memcpy-octets"}


@pytest.mark.parametrize(
    ("form", "arguments", "wrong"),
    [
        ("V%d.%d,%u", "-70, -1, 5", True),
        ("%d.%d C", "0, -5", True),
        ("%d.%s", "0, '-5'", True),
        ("%d.%02d", "0, -5", True),
        ("%d.%d", "3, -5", False),  # two numbers
        ("%d. %d", "0, -5", False),
        ("0.-9: %d", "1", False),  # what the format says itself
        ("%d.-%d. level", "0, 3", False),
        ("CH%d.%d", "0, -5", False),
    ],
)
def test_a_number_with_a_sign_behind_its_point_is_told(form: str, arguments: str, *, wrong: bool) -> None:
    shop, _ = run(f'return sprintf(buf, "{form}", {arguments})')
    assert shop.rules() == ["fraction-text"] * wrong
