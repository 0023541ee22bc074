"""Switches that fall through or are left from within, and chains of `else if`: what static checks say, what runs."""

from __future__ import annotations

import pytest

from emulator.c28x.symbols import SourceError
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of, refused
from tests.emulator.c28x.workshop import Workshop

FALLS_INTO_RETURN = """int f(int a, int b)
{
    int x = b;
    switch (a) {
    case 1:
        x = 4;
    case 2:
        return x + b;
    default:
        return 3;
    }
}
"""
LEFT_FROM_WITHIN = """int f(int a, int b)
{
    int i, x = 0;
    for (i = 0; i < 4; i++) {
        switch (a) {
        case 1:
            if (b) {
                x += i;
                break;
            }
            x = 3;
            continue;
        default:
            x = x + 9;
        }
        a++;
    }
    return x;
}
"""


@pytest.mark.parametrize("text", [FALLS_INTO_RETURN, LEFT_FROM_WITHIN])
def test_a_right_switch_is_told_nothing(text: str) -> None:
    assert findings_of(text) == []


def test_a_case_that_falls_out_of_the_last_one_lacks_a_return() -> None:
    text = FALLS_INTO_RETURN.replace("        return x + b;", "        x = x + b;\n        break;")
    assert ("missing-return", 11) in findings_of(text)  # at the last statement


def test_a_value_that_every_way_out_of_a_switch_replaces_is_never_used() -> None:
    text = LEFT_FROM_WITHIN.replace("x += i;", "x = i;").replace("        a++;", "        x = 0;\n        a++;")
    assert ("dead-store", 8) in findings_of(text)


def test_a_value_that_a_case_hands_on_is_used() -> None:
    # x = 5 of case 1 is read in case 2 only.
    text = (
        "int f(int a)\n{\n    int x = 1;\n    switch (a) {\n    case 1:\n        x = 5;\n    case 2:\n"
        "        a = a + x;\n        break;\n    default:\n        a = 3;\n    }\n    return a;\n}\n"
    )
    assert findings_of(text, "f", 1) == []
    assert CWorkshop(text).call("f", 1) == 6


@pytest.mark.parametrize("loop", ["for i in range(0, 10):", "while i < 10:"])
@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
def test_break_in_a_case_ends_the_loop_around_and_continue_goes_on_with_it(loop: str, watched: bool) -> None:
    step = "" if loop.startswith("for") else "        i += 1\n"
    text = (
        f"def f(stop: int16) -> int16:\n    i: int16 = 0\n    r: int16 = 0\n    {loop}\n{step}        match stop - i:\n"
        "            case 0:\n                break\n            case 1:\n                r += 100\n"
        "                fallthrough()\n            case 2:\n                r += 10\n                continue\n"
        "            case _:\n                pass\n        r += 1\n    return r\n"
    )
    # stop = 5: as a for, i = 0, 1, 2 add 1 each, i = 3 adds 10, i = 4 adds 110, i = 5 ends it: 123.
    # As a while, i is stepped first: i = 1, 2 add 1 each, then 10, 110, and the end: 122.
    assert Workshop(text, watch=watched).f(5) == (123 if loop.startswith("for") else 122)


def python_chain(links: int) -> str:
    body = "".join(f"    elif a == {i}:\n        b = {i}\n        g()\n" for i in range(1, links))
    return (
        "n: int16 = 0\ndef g() -> void:\n    global n\n    n += 1\ndef f(a: int16) -> int16:\n    b: int16\n"
        f"    if a == 0:\n        b = 7\n{body}    else:\n        b = -1\n    return b\n"
    )


def c_chain(links: int, inner: str = "") -> str:
    body = "".join(f"    else if (a == {i}) {{ b = {i}; g(); {inner} }}\n" for i in range(1, links))
    return (
        "int n = 0;\nvoid g(void) { n++; }\nint f(int a)\n{\n    int b;\n"
        f"    if (a == 0) b = 7;\n{body}    else b = -1;\n    return b;\n}}\n"
    )


@pytest.mark.parametrize("links", [2, 48, 49, 200, 1000])
@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
def test_a_chain_of_else_if_of_any_length_is_taken_and_takes_the_same_time_for_each_test(
    links: int, watched: bool
) -> None:
    texts = Workshop(python_chain(links), watch=watched, static=True), CWorkshop(
        c_chain(links), watch=watched, static=True
    )
    for w in texts:
        call = w.f if isinstance(w, Workshop) else lambda a, w=w: w.call("f", a)
        assert (call(0), call(links // 2), call(links - 1), call(links)) == (7, links // 2 or 7, links - 1, -1)
        assert w.rules() == []
    assert texts[0].clock.now == texts[1].clock.now
    # A link costs what it costs in a short chain: the last one of 48 and of 49 differ by one test.
    if links == 49:
        before, after = (Workshop(python_chain(n)) for n in (48, 49))
        one, two = (Workshop(python_chain(n)) for n in (46, 47))
        times = []
        for w, n in ((before, 47), (after, 48), (one, 45), (two, 46)):
            w.f(n)
            times.append(w.clock.now)
        assert times[1] - times[0] == times[3] - times[2]


def test_a_long_chain_within_a_loop_ends_and_continues_it() -> None:
    links = "".join(f"            else if (a == {i}) {{ r += {i}; continue; }}\n" for i in range(2, 80))
    text = (
        "int f(int a)\n{\n    int r = 0;\n    while (a < 200) {\n        a++;\n"
        f"            if (a == 1) break;\n{links}            else if (a == 90) break;\n"
        "            r++;\n    }\n    return r;\n}\n"
    )
    # from 76: 77, 78 and 79 are added and go on, 80 to 89 add 1 each, 90 ends it: 234 + 10
    assert CWorkshop(text).call("f", 76) == 244
    assert CWorkshop(text).call("f", 0) == 0


def test_a_long_chain_with_a_break_of_a_switch_around_it_is_refused_with_its_place() -> None:
    links = "".join(f"        else if (a == {i}) break;\n" for i in range(2, 80))
    head = "int f(int a)\n{\n    switch (a) {\n    default:\n        if (a == 1) a = 5;\n"
    text = f"{head}{links}    }}\n    return a;\n}}\n"
    line, column, message = refused(text)
    assert (line, column) == (5, 9)
    assert "write a function for it" in message


@pytest.mark.parametrize("links", [1002, 20000])
def test_a_chain_that_python_cannot_parse_names_the_line(links: int) -> None:
    with pytest.raises(SourceError, match="more than 1000 elif: write a match, or a table and a loop") as caught:
        Workshop(python_chain(links))
    # two lines of the header, eight up to the first elif, three each: the 1001st begins in line 2 + 8 + 3000 + 1
    assert caught.value.line == 3011


def test_a_function_of_too_many_statements_names_the_first_one_too_many() -> None:
    line, column, message = refused("int f(int a)\n{\n" + "    a = a + 1;\n" * 20_001 + "    return a;\n}\n")
    assert (line, column) == (20_003, 5)
    assert message == "f has more than 20,000 statements: write several functions"


OBEY = """int kp, ki, stops, rests;
int limited(int v) { return v > 100 ? 100 : v; }
void obey(int what, int value)
{
    switch (what) {
    case 'P':
        kp = value;
        break;
    case 'I':
        ki = value;
        break;
    case 'L':
        kp = limited(value);
        rests = 0;
        break;
    case 'R':
        rests++;
        kp = limited(value);
        break;
    default:
        stops++;
        break;
    }
}
"""


@pytest.mark.parametrize(("was", "now", "line"), [
    ("", "", 0),
    # The one case of many without a break, and it does what the next one does to another object.
    ("kp = value;\n        break;", "kp = value;", 7),
    # The next case calls the same again.
    ("rests = 0;\n        break;", "rests = 0;", 14),
    # A comment says so; the value is another one; another case goes on too; nothing is done twice.
    ("kp = value;\n        break;", "kp = value;\n        /* falls through */", 0),
    ("kp = value;\n        break;", "kp = value; // no break", 0),
    ("rests = 0;\n        break;", "rests = 0; /* fallthrough */", 0),
    ("kp = value;\n        break;", "kp = 2 * value;", 0),
    ("kp = limited(value);\n        rests = 0;\n        break;", "kp++;", 0),
])  # fmt: skip
def test_a_case_that_goes_on_without_a_word(was: str, now: str, line: int) -> None:
    assert not was or OBEY.count(was) == 1
    findings = findings_of(OBEY.replace(was, now) if was else OBEY)
    assert [found for found in findings if found[0] == "case-falls"] == [("case-falls", line)] * bool(line)


@pytest.mark.parametrize(("now", "line"), [
    ("kp = 2 * value;", 7),
    ("kp = 2 * value; /* falls through */", 0),
    ("kp = value;", 0),  # told: case-falls
    ("return;", 0),
])  # fmt: skip
def test_the_one_case_that_goes_on_is_noted(now: str, line: int) -> None:
    findings = findings_of(OBEY.replace("kp = value;\n        break;", now))
    assert [found for found in findings if found[0] == "case-goes-on"] == [("case-goes-on", line)] * bool(line)


def test_several_cases_that_go_on_add_up() -> None:
    text = OBEY.replace("kp = value;\n        break;", "kp = value;").replace("ki = value;\n        break;", "ki++;")
    assert not {"case-falls", "case-goes-on"} & {rule for rule, _ in findings_of(text)}
