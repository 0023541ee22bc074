"""What authors declare in comments: properties, units, and findings that they accept."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.cli import invoke
from hil.drivers.check import DriverFiles, check_files

HEAD = "#include <stdint.h>\nuint16_t n = 0;\n"


def found(folder: Path, text: str, name: str = "a.c") -> list[Finding]:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return check_files(DriverFiles([file])).findings


def told(folder: Path, text: str, rule: str, name: str = "a.c") -> list[str]:
    return [finding.message for finding in found(folder, text, name) if finding.rule == rule]


# Each function with what is declared of it, and the smallest example against it; empty: it holds.
PROPERTIES = [
    ("range -100..100", "int16_t f(int16_t v) { return v > 100 ? 101 : v < -100 ? -100 : v; }", "f(101) is 101"),
    ("range -100..100", "int16_t f(int16_t v) { return v > 100 ? 100 : v < -100 ? -100 : v; }", ""),
    ("odd", "int16_t f(int16_t v) { return v >> 1; }", "f(1) is 0, f(-1) is -1"),
    ("odd", "int16_t f(int16_t v) { return v / 2; }", ""),
    ("even", "int16_t f(int16_t v) { return v < 0 ? v : v + 1; }", "f(1) is 2, f(-1) is -1"),
    ("even", "float f(float v) { return v * v; }", ""),
    ("monotone rising", "int16_t f(int16_t v) { return v == 3 ? 1 : v; }", "f(2) is 2, f(3) is 1"),
    ("monotone v falling", "int16_t f(int16_t v, int16_t w) { return w - (v >> 2); }", ""),
    ("idempotent", "int16_t f(int16_t v) { return v > 5 ? 5 : v - 1; }", "f(0) is -1, f(-1) is -2"),
    ("idempotent", "int16_t f(int16_t v) { return v > 5 ? 5 : v; }", ""),
    ("idempotent", "void f(void) { n++; }", "the second f() changes a.n"),
    ("idempotent", "void f(void) { n = 7; }", ""),
]


@pytest.mark.parametrize(("declared", "function", "example"), PROPERTIES)
def test_a_declared_property_holds_or_the_smallest_example_is_told(
    tmp_path: Path, declared: str, function: str, example: str
) -> None:
    messages = told(tmp_path, f"{HEAD}// hil: {declared}\n{function}\n", "declared-property")
    assert [message.partition(": ")[2] for message in messages] == ([example] if example else [])


def test_a_function_that_remembers_is_tried_on_fresh_boards(tmp_path: Path) -> None:
    # A mean of two: one after the other, f(-1) is (1 - 1) / 2; alone it is -(f(1)).
    text = (
        f"{HEAD}int16_t before = 0;\n// hil: odd\nint16_t f(int16_t v)\n{{\n    int16_t r = v / 4 + before / 4;\n"
        "    before = v;\n    return r;\n}\n"
    )
    assert told(tmp_path, text, "declared-property") == []


def test_a_contract_holds_for_generated_arguments_and_for_calls_of_the_text(tmp_path: Path) -> None:
    text = HEAD + (
        "int16_t t[4] = {1, 2, 3, 4};\n// hil: range k 0..3\nint16_t kth(int16_t k)\n{\n    return t[k];\n}\n"
        "int16_t right(void) { return kth(3); }\nint16_t wrong(void) { return kth(4); }\n"
    )
    findings = found(tmp_path, text)
    assert [(f.rule, f.place.line) for f in findings if f.place and f.how != "generated"] == [
        ("unused-object", 2), ("index", 7), ("declared-property", 10),
    ]  # fmt: skip
    assert not [f for f in findings if f.rule == "index" and any("called as kth(" in detail for detail in f.details)]


UNITS = """int16_t distance;     // hil: unit cm
int16_t speed;        // hil: unit mm/s
// hil: unit v mm/s
// hil: unit mm
int16_t braking(int16_t v)
{
    return v / 8 * v / 50;
}
"""


@pytest.mark.parametrize(
    ("body", "messages"),
    [
        ("return braking(speed) > 10;", []),
        ("return braking(distance);", ["distance is in cm, parameter v of braking in mm/s"]),
        ("distance = braking(speed);", ["braking(...) is in mm, distance in cm"]),
        ("distance = braking(speed) / 10;", []),
        ("return distance < braking(speed);", ["distance is in cm, braking(...) in mm"]),
        ("return distance < 3;", []),
        ("int16_t d = -distance; return d + speed;", ["d is in cm, speed in mm/s"]),
        ("int16_t d = distance; d = speed; return d + speed;", []),
    ],
)
def test_a_unit_goes_where_it_is_wanted(tmp_path: Path, body: str, messages: list[str]) -> None:
    text = f"{HEAD}{UNITS}int16_t use(void)\n{{\n    {body}\n    return 0;\n}}\n"
    assert told(tmp_path, text, "unit") == messages


ANGLES = """#include <math.h>
float tilt;      // hil: unit deg
float turned;    // hil: unit rad
float heading;   // hil: unit turns
float gone;      // hil: unit m
"""


@pytest.mark.parametrize(("body", "messages"), [
    ("tilt = atan2f(gone, 2.0f);", ["atan2(...) is in radians of the C library, tilt in deg"]),
    ("gone = sinf(tilt);", ["tilt is in deg, the angle of sin in radians of the C library"]),
    ("float a = atanf(gone); if (a > tilt) gone = 0.0f;", ["a is in radians of the C library, tilt in deg"]),
    # A unit that is declared by another name may be the same one; a factor converts it.
    ("turned = atan2f(gone, 2.0f); gone = cosf(turned); heading = asinf(gone);", []),
    ("tilt = atan2f(gone, 2.0f) * 57.29578f; gone = sinf(tilt * 0.01745329f);", []),
    # A mean keeps the unit of its parts, whose weights add up to 1; another sum of products need not.
    ("tilt = 0.98f * tilt + 0.02f * turned;", ["tilt is in deg, turned in rad"]),
    ("tilt = 0.98f * tilt + (1.0f - 0.98f) * turned;", ["tilt is in deg, turned in rad"]),
    ("tilt = turned * 0.25f + tilt * 0.75f;",
     ["turned is in rad, tilt in deg", "turned * 0.25 + tilt * 0.75 is in rad, tilt in deg"]),
    ("gone = 0.9f * gone + 0.1f * gone; tilt = 0.5f * tilt + 57.29578f * turned;", []),
    ("tilt = 0.5f * tilt + 0.25f * turned;", []),
])  # fmt: skip
def test_angles_and_means_have_a_unit_too(tmp_path: Path, body: str, messages: list[str]) -> None:
    text = f"{ANGLES}void f(void) {{ {body} }}\n"
    assert told(tmp_path, text, "unit") == messages



def test_python_declares_in_the_same_words(tmp_path: Path) -> None:
    text = (
        "from emulator.c28x.language import *\n\n"
        "level: int16 = 0  # hil: unit cm\nrate: int16 = 0  # hil: unit cm/s\n\n\n"
        "# hil: range 0..10\ndef clipped(v: int16) -> int16:\n    if v > 10:\n        return 11\n    if v < 0:\n"
        "        return 0\n    return v\n\n\ndef mixed() -> int16:\n    return level + rate\n"
    )
    assert told(tmp_path, text, "declared-property", "a.py") == [
        "clipped is declared to lie in 0..10: clipped(11) is 11"
    ]
    assert told(tmp_path, text, "unit", "a.py") == ["level is in cm, rate in cm/s"]


WRONG = [
    ("odd w", "int16_t f(int16_t v) { return v; }", "f has no parameter w"),
    ("odd", "int16_t f(int16_t v, int16_t w) { return v; }", "f has 2 numbers for parameters"),
    ("range 3..1", "int16_t f(int16_t v) { return v; }", "'3..1' is not a range"),
    ("range", "int16_t f(int16_t v) { return v; }", "expected hil: range [PARAMETER] LOW..HIGH"),
    ("monotone upwards", "int16_t f(int16_t v) { return v; }", "expected hil: monotone [PARAMETER] rising|falling"),
    ("unit a b c", "int16_t f(int16_t v) { return v; }", "'a b c' is not a unit"),
    ("unit w cm", "int16_t f(int16_t v) { return v; }", "no w is declared there"),
    ("allow indx, it is so", "int16_t f(int16_t v) { return v; }", "no rule 'indx': did you mean index"),
    ("allow index", "int16_t f(int16_t v) { return v; }", "why is missing: expected hil: allow RULE, REASON"),
    ("sometimes", "int16_t f(int16_t v) { return v; }", "there are allow, range"),
]


@pytest.mark.parametrize(("declared", "function", "message"), WRONG)
def test_what_is_not_written_so_is_one_line(
    tmp_path: Path, declared: str, function: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "a.c"
    file.write_text(f"{HEAD}// hil: {declared}\n{function}\n", encoding="utf-8")
    assert invoke(["check", str(file)]) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1
    assert "a.c:3: hil: " in lines[0]
    assert message in lines[0]
