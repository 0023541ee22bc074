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
DEGREES = "temperature = (int16)(raw * 150L / 4095);"
TENTHS = "temperature = (int16)(raw * 1500L / 4095);"


def told(
    folder: Path, use: str, *, comment: str = "tenths of a degree", first: float = 20.0,
    steps: tuple[tuple[int, float], ...] = ((60, 80.0),), more: str = "",
) -> list[tuple[str, int]]:  # fmt: skip
    """Object and line of each `scale-by-face`."""
    (folder / "bench.py").write_text(BOARD.format(first=first, steps=steps, more=more), encoding="utf-8")
    file = folder / "oven.c"
    file.write_text(PROGRAM.format(use=use, comment=comment), encoding="utf-8")
    board = load(str(folder / "bench.py"))
    found = check_files(DriverFiles([file], calls=1, board=board, board_named=True, seconds=0.2)).findings
    return [(f.object, f.place.line) for f in found if f.rule == "scale-by-face" and f.place is not None]


def test_degrees_in_an_object_of_tenths_are_told(tmp_path: Path) -> None:
    assert told(tmp_path, DEGREES) == [("temperature", 6)]


def test_tenths_in_an_object_of_degrees_are_told(tmp_path: Path) -> None:
    assert told(tmp_path, TENTHS, comment="degrees Celsius") == [("temperature", 6)]


def test_a_member_is_told_where_its_object_is_declared(tmp_path: Path) -> None:
    assert told(tmp_path, "seen.warmest = (int16)(raw * 150L / 4095);") == [("seen.warmest", 8)]


def test_two_steps_tell_it_behind_a_tare(tmp_path: Path) -> None:
    use = "if (zero == 0) zero = raw; temperature = (int16)((raw - zero) * 150L / 4095);"
    assert told(tmp_path, use) == []  # one step: an offset may be anything
    assert told(tmp_path, use, steps=((60, 80.0), (120, 50.0))) == [("temperature", 6)]


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


def test_nothing_is_told_where_no_face_changes(tmp_path: Path) -> None:
    assert told(tmp_path, DEGREES, steps=()) == []


def test_nothing_is_told_where_two_faces_have_the_quantity(tmp_path: Path) -> None:
    other = 'self.on_adc("room", Thermometer(), adc="A", channel=3, faces=[Face("celsius", "C", 0.0, 150.0)])'
    assert told(tmp_path, DEGREES, more=other) == []


def test_grams_are_a_unit(tmp_path: Path) -> None:
    assert told(tmp_path, DEGREES, comment="tenths of a gram") == []  # another quantity than that of the face
