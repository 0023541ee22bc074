"""Objects that follow a face of the board in the wrong scale, and right ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

BOARD = """from hil.board import Board, Face

class Thermometer:
    celsius = {first}

    def volts(self, cycles):
        return 0.02 * self.celsius

class Bench(Board):
    vrefhi_v = 3.0

    def solder(self):
        sensor = self.on_adc("oven", Thermometer(), adc="A", channel=2, faces=[Face("celsius", "C", 0.0, 150.0)])
        {more}
        for ms, celsius in {steps}:
            self.clock.after(ms * 200_000, lambda celsius=celsius: setattr(sensor, "celsius", celsius))
"""

PROGRAM = """#include "F28x_Project.h"
typedef struct {{
    Uint16 count;
    int16 warmest;          // tenths of a degree
}} Seen;
int16 temperature = 0;      // {comment}
int16 limit_dc = 450, temp_c = 0;
Seen seen = {{0, 0}};
static int32 zero = 0;
static int16 oven_tenths = 0;
static void Measure(int32 raw, int16 *degrees)
{{
    *degrees = (int16)(raw * 150L / 4095);
}}
static Uint16 Convert(void)
{{
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    return AdcaResultRegs.ADCRESULT0;
}}
void main(void)
{{
    int32 raw;
    int16 now;
    InitSysCtrl();
    EALLOW;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    for (;;)
    {{
        raw = Convert();
        {use}
        DELAY_US(500);
    }}
}}
"""
FAN = """from hil.board import Board

class Fan:
    \"\"\"Its tachometer gives 0.02 V for a turn a minute.\"\"\"

    {number} = 20.0

    def volts(self, cycles):
        return 0.02 * self.{number}

class Bench(Board):
    vrefhi_v = 3.0

    def solder(self):
        fan = self.on_adc("fan", Fan(), adc="A", channel=2)
        for ms, rpm in ((60, 80.0), (120, 50.0)):
            self.clock.after(ms * 200_000, lambda rpm=rpm: setattr(fan, "{number}", rpm))
"""
DEGREES = "temperature = (int16)(raw * 150L / 4095);"
TENTHS = "temperature = (int16)(raw * 1500L / 4095);"


def told(
    folder: Path, use: str, *, comment: str = "tenths of a degree", first: float = 20.0,
    steps: tuple[tuple[int, float], ...] = ((60, 80.0),), more: str = "", rule: str = "scale-by-face",
) -> list[tuple[str, str]]:  # fmt: skip
    """Object and statement of each finding of the rule."""
    (folder / "bench.py").write_text(BOARD.format(first=first, steps=steps, more=more), encoding="utf-8")
    file = folder / "oven.c"
    text = PROGRAM.format(use=use, comment=comment)
    file.write_text(text, encoding="utf-8")
    board = load(str(folder / "bench.py"))
    found = check_files(DriverFiles([file], calls=1, board=board, board_named=True, seconds=0.2)).findings
    lines = text.splitlines()
    return [(f.object, lines[f.place.line - 1].strip()) for f in found if f.rule == rule and f.place is not None]


def test_degrees_in_an_object_of_tenths_are_told(tmp_path: Path) -> None:
    assert told(tmp_path, DEGREES) == [("temperature", DEGREES)]


def test_tenths_in_an_object_of_degrees_are_told(tmp_path: Path) -> None:
    assert told(tmp_path, TENTHS, comment="degrees Celsius") == [("temperature", TENTHS)]


def test_a_member_is_told_where_it_is_scaled(tmp_path: Path) -> None:
    use = "seen.warmest = (int16)(raw * 150L / 4095);"
    assert told(tmp_path, use) == [("seen.warmest", use)]


def test_the_scale_is_found_behind_a_filter_and_a_call(tmp_path: Path) -> None:
    use = "Measure(raw, &now);\nif (raw > 9) temperature += (now - temperature) / 2;"
    assert told(tmp_path, use) == [("temperature", "*degrees = (int16)(raw * 150L / 4095);")]


def test_two_steps_tell_it_behind_a_tare(tmp_path: Path) -> None:
    use = "if (zero == 0) zero = raw; temperature = (int16)((raw - zero) * 150L / 4095);"
    assert told(tmp_path, use) == []  # one step: an offset may be anything
    assert told(tmp_path, use, steps=((60, 80.0), (120, 50.0))) == [("temperature", use)]


@pytest.mark.parametrize("use", [
    TENTHS,
    # A mean of two, half of it; an object that does not follow; one of two is right.
    "temperature = (int16)(raw * 750L / 4095);",
    "temperature = (int16)(limit_dc - 25); limit_dc = 450;",
    f"{TENTHS} seen.warmest = temperature / 10;",
    # What has no unit, and what follows the other way.
    f"seen.count = (Uint16)raw; {TENTHS}",
    "temperature = (int16)(1000 - raw * 150L / 4095);",
])  # fmt: skip
def test_a_right_object_is_not_told(tmp_path: Path, use: str) -> None:
    assert told(tmp_path, use, steps=((60, 80.0), (120, 50.0))) == []


def test_a_face_that_never_changes_is_compared_with_what_came_to_its_value(tmp_path: Path) -> None:
    assert told(tmp_path, DEGREES, steps=()) == [("temperature", DEGREES)]
    assert told(tmp_path, TENTHS, steps=()) == []
    # A limit that was there from the start, and what only comes near.
    assert told(tmp_path, "limit_dc = 450;", steps=(), first=4.5) == []
    # A set point that comes later: nothing scales it, so it is no measurement.
    assert told(tmp_path, "limit_dc = 450; if (zero == 9) temp_c = 450; else zero++;", steps=(), first=45.0) == []
    assert told(tmp_path, "temperature = (int16)(raw * 158L / 4095);", steps=()) == []


def test_steps_show_which_of_two_faces_an_object_follows(tmp_path: Path) -> None:
    other = 'other = self.on_adc("room", Thermometer(), adc="A", channel=3, faces=[Face("celsius", "C", 0.0, 150.0)])'
    both = "; ".join((
        other, "self.clock.after(60 * 200_000, lambda: setattr(other, 'celsius', 80.0))",
    ))  # fmt: skip
    assert told(tmp_path, DEGREES, more=other) == [("temperature", DEGREES)]
    assert told(tmp_path, DEGREES, more=both) == []
    assert told(tmp_path, DEGREES, more=other, steps=()) == []


def test_tenths_are_those_of_the_face(tmp_path: Path) -> None:
    use = "oven_tenths = (int16)(raw * 150L / 4095);"
    assert told(tmp_path, use) == [("oven_tenths", use)]
    assert told(tmp_path, "oven_tenths = (int16)(raw * 1500L / 4095);") == []


@pytest.mark.parametrize(("use", "objects"), [
    ("temp_c = (int16)(zero - raw) * 150L / 4095;", ["temp_c"]),
    ("temp_c = (int16)(raw - zero) * 150L / 4095;", []),
    # What is left up to a limit grows when the temperature falls.
    ("temp_c = 150 - (int16)(raw * 150L / 4095);", []),
])  # fmt: skip
def test_the_other_sign_is_told(tmp_path: Path, use: str, objects: list[str]) -> None:
    found = told(tmp_path, use, steps=((60, 80.0), (120, 50.0)), rule="sign-by-face")
    assert found == [(each, use) for each in objects]


@pytest.mark.parametrize(("number", "factor", "objects"), [
    ("rpm", 4, ["speedRpm"]), ("rpm", 60, ["speedRpm"]), ("rpm", 1, []), ("rpm", 3, []), ("_rpm", 4, []),
    ("percent", 4, []),
])  # fmt: skip
def test_a_number_of_a_part_is_like_a_face(tmp_path: Path, number: str, factor: int, objects: list[str]) -> None:
    (tmp_path / "bench.py").write_text(FAN.format(number=number), encoding="utf-8")
    file = tmp_path / "fan.c"
    use = f"speedRpm = {factor} * raw * 150L / 4095;"
    text = PROGRAM.format(use=use, comment="none").replace("temp_c", "speedRpm")
    file.write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "bench.py"))
    found = check_files(DriverFiles([file], calls=1, board=board, board_named=True, seconds=0.2)).findings
    assert [f.object for f in found if f.rule == "scale-by-face"] == objects


def test_grams_are_a_unit(tmp_path: Path) -> None:
    assert told(tmp_path, DEGREES, comment="tenths of a gram") == []  # another quantity than that of the face
