"""The grammar of System_sprintf (xdc/runtime/System.c 3.24): by the table of its rules, argument words included."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.sysbios.core import KernelError
from emulator.sysbios.costs import CYCLES
from tests.emulator.sysbios.bench import DOUBLE, INT, LONG, POINTER, Bench, Buffer, string


def sprintf(form: str, *arguments: tuple[Any, Any], bench: Bench | None = None) -> str:
    b = bench or Bench()
    buf = Buffer([0x55AA] * 200)
    count = b.kernel.System_sprintf(buf, string(form), *arguments)
    assert count == len(buf.text)
    return buf.text


@pytest.mark.parametrize(
    ("form", "arguments", "text"),
    [
        ("plain", [], "plain"),
        ("%d", [(INT, 0)], "0"),
        ("%d", [(INT, -32768)], "-32768"),
        ("%i|%d", [(INT, 7), (INT, -7)], "7|-7"),
        ("%d", [(INT, 0xFFFF)], "-1"),  # an unsigned word read as int
        ("%u", [(INT, -1)], "65535"),
        ("%x", [(INT, -1)], "ffff"),
        ("%lx", [(LONG, -1)], "ffffffff"),
        ("%o", [(INT, 8)], "10"),
        ("%ld", [(LONG, -2147483648)], "-2147483648"),
        ("%Lu", [(LONG, 4294967295)], "4294967295"),
        ("%5d|%-5d|", [(INT, 42), (INT, 42)], "   42|42   |"),
        ("%05d", [(INT, -42)], "-0042"),  # the minus counts against the zeros
        ("%05.3d", [(INT, 7)], "00007"),  # zeros: the greater of width and precision
        ("%.3d", [(INT, 7)], "007"),
        ("%.3d", [(INT, -7)], "-07"),
        ("%.0d", [(INT, 0)], "0"),
        ("%*d", [(INT, 4), (INT, 7)], "   7"),
        ("%*d|", [(INT, -4), (INT, 7)], "7   |"),  # a negative star width left-justifies
        ("%.*d", [(INT, -3), (INT, 7)], "7"),  # a negative star precision is 0
        ("%-05d|", [(INT, 7)], "00007|"),  # '-' before '0', in this order only
        ("%c%c", [(INT, 65), (INT, 98)], "Ab"),
        ("%s", [(POINTER, string("abc"))], "abc"),
        (
            "%.2s|%5s|%-5s|",
            [(POINTER, string("abc")), (POINTER, string("x")), (POINTER, string("y"))],
            "ab|    x|y    |",
        ),
        ("%s", [(POINTER, None)], "(null)"),
        ("%p", [(POINTER, Buffer([0], addr=0x8A3F))], "@00008a3f"),
        ("%%", [], "%"),
        ("100%% %d", [(INT, 5)], "100% 5"),
        # Not in the grammar: the character itself, and no argument taken.
        ("%X %d", [(INT, 255)], "X 255"),
        ("%h%d", [(INT, 3)], "h3"),
        ("%+d", [(INT, 3)], "+d"),
        ("%e%d", [(INT, 3)], "e3"),
        ("%lld", [(LONG, 1)], "ld"),  # the first l is read, the second is printed, d is text
        ("%0-5d", [(INT, 7)], "-5d"),  # '0' before '-' is not the order: '-' is no conversion
        # %f takes its double and prints f.
        ("%f %d", [(DOUBLE, 1.5), (INT, 9)], "f 9"),
        # $ formats
        ("%$S!", [(POINTER, string("<%d>")), (INT, 8)], "<8>!"),
        ("%$F.", [(POINTER, string("us.c")), (INT, 12)], '"us.c", line 12: .'),
        ("%$Q", [], "Q"),
    ],
)
def test_format(form: str, arguments: list[tuple[Any, Any]], text: str) -> None:
    assert sprintf(form, *arguments) == text


@pytest.mark.parametrize(
    ("form", "arguments", "text"),
    [
        # %d reads one word of the long 0x00010002: its low word 2, then its high word 1.
        ("%d %d %d", [(LONG, 0x00010002), (INT, 5)], "2 1 5"),
        # %ld over two ints: low word first.
        ("%ld", [(INT, 1), (INT, 1)], "65537"),
        # A double printed as two ints: 1.0f is 0x3F800000.
        ("%x %x", [(DOUBLE, 1.0)], "0 3f80"),
        # 32-bit items lie on even words: int, gap, long.
        ("%d %ld", [(INT, 3), (LONG, 70000)], "3 70000"),
        # int, gap, long, read as three ints: the gap comes as 0, then 70000 = 0x11170.
        ("%d %d %x", [(INT, 3), (LONG, 70000)], "3 0 1170"),
    ],
)
def test_width_mismatch_skews_later_arguments(form: str, arguments: list[tuple[Any, Any]], text: str) -> None:
    assert sprintf(form, *arguments) == text


@pytest.mark.parametrize(
    ("form", "value", "text"),
    [
        ("%f", 1.5, "1.5000"),
        ("%f", -2.25, "-2.2500"),
        ("%f", 0.99999, "0.9999"),  # cut off, not rounded: float32 0.99998999 * 10^4 = 9999.8999
        ("%.2f", 3.0, "03.0000"),  # precision is no number of decimals: it pads the integer part
        ("%f", 3e9, "(error)"),
        ("%10f", 1.5, "    1.5000"),
    ],
)
def test_optional_float_format(form: str, value: float, text: str) -> None:
    assert sprintf(form, (DOUBLE, value), bench=Bench(extended_formats="%f")) == text


@given(st.integers(-32768, 32767))
def test_percent_d_is_decimal(value: int) -> None:
    assert sprintf("%d", (INT, value)) == str(value)


@given(st.integers(-(2**31), 2**31 - 1), st.integers(0, 15))
def test_percent_ld_with_zero_padding_is_pythons(value: int, width: int) -> None:
    assert sprintf(f"%0{width}ld", (LONG, value)) == f"{value:0{width}d}"


@pytest.mark.parametrize(
    ("form", "arguments", "rule"),
    [
        ("%d %d", [(INT, 1)], "varargs-missing"),
        ("%s", [(LONG, 0x1234)], "varargs-type"),
        ("%X", [(INT, 1)], "printf-format"),
        ("%f", [(DOUBLE, 1.0)], "printf-format"),
        ("%020d", [(INT, 1)], "printf-outbuf"),  # 20 characters into a buffer of 16
    ],
)
def test_what_the_chip_does_silently_is_a_finding(form: str, arguments: list[tuple[Any, Any]], rule: str) -> None:
    b = Bench()
    sprintf(form, *arguments, bench=b)
    assert [finding.rule for finding in b.findings] == [rule]


def test_a_sound_call_has_no_finding() -> None:
    b = Bench()
    sprintf("%d%%%s", (INT, 1), (POINTER, string("x")), bench=b)
    assert len(b.findings) == 0


def test_a_null_format_writes_nothing() -> None:
    buf = Buffer([7] * 4)
    assert Bench().kernel.System_sprintf(buf, None) == 0
    assert buf.words == [7] * 4


@pytest.mark.parametrize(("room", "text"), [(10, "12345"), (4, "123"), (1, "")])
def test_snprintf_cuts_and_returns_the_full_length(room: int, text: str) -> None:
    buf = Buffer([7] * 20)
    assert Bench().kernel.System_snprintf(buf, room, string("%d"), (INT, 12345)) == 5
    assert buf.text == text
    assert buf.words[len(text) + 1] == 7


def test_printf_shows_at_a_flush_and_keeps_the_last_1024_characters() -> None:
    b = Bench()
    k = b.kernel
    assert k.System_printf(string("%d\n"), (INT, 1)) == 2
    assert k.system.flushed == ""
    k.System_flush()
    assert k.system.flushed == "1\n"
    for i in range(300):
        k.System_printf(string("%04d\n"), (INT, i))
    k.System_flush()
    # 1500 characters: the last 1024 begin within line 95 (1500 - 1024 = 476 = 95 * 5 + 1).
    assert k.system.flushed == "1\n" + "".join(f"{i:04d}\n" for i in range(300))[476:]


def test_time_goes_by_digits() -> None:
    """Each digit costs a digit and a character; nothing else grows with the number."""

    def cycles(value: int) -> int:
        b = Bench(cost_scale=1.0)
        sprintf("%d", (INT, value), bench=b)
        return b.clock.now

    assert cycles(12345) - cycles(1) == 4 * (CYCLES["print_digit"] + CYCLES["print_character"])


def test_abort_and_exit() -> None:
    b = Bench()
    with pytest.raises(KernelError, match="System_abort: no way"):
        b.boot(lambda: b.kernel.System_abort(string("no way")))
    b = Bench()
    b.boot(lambda: (b.kernel.System_printf(string("bye")), b.kernel.System_exit(3)))
    assert (b.kernel.exit_status, b.kernel.system.flushed) == (3, "bye")
