"""The fixture `fault`, as a project has it that tests a driver of its own."""

from __future__ import annotations

import pytest

from tests.hil.faults.drivers_in_c import VOLTS_C

TESTS = """
import pytest

pytestmark = [pytest.mark.board("bare"), pytest.mark.firmware("volts.c")]


def test_stuck(firmware, outside, fault):
    outside.adc_volts(3, 1.5)
    firmware.volts.Init()
    sound = firmware.volts.Convert()
    assert sound == 2048
    stuck = fault("adc-bit-stuck", input="A3", bit=4)
    assert firmware.volts.Convert() == 2048 + 16
    met = stuck.report().met
    assert met.function == "Convert"
    assert met.place.startswith("volts.c:10:")
    stuck.remove()
    assert firmware.volts.Convert() == 2048


def test_open_input(firmware, outside, fault, advance):
    outside.adc_volts(3, 1.5)
    firmware.volts.Init()
    opened = fault("adc-channel-open:input=A3,for=0.001")
    assert firmware.volts.Convert() == 0
    advance(0.002)
    assert firmware.volts.Convert() == 2048
    assert opened.report().count == 1


def test_silent(firmware, fault):
    fault("adc-bit-stuck", input="A5")


def test_wrong(firmware, fault):
    fault("gyro-reset")
"""


def test_fixture(pytester: pytest.Pytester) -> None:
    (pytester.path / "volts.c").write_text(VOLTS_C, encoding="utf-8")
    (pytester.path / "test_volts.py").write_text(TESTS, encoding="utf-8")
    result = pytester.runpytest_subprocess("-n0", "-p", "no:cacheprovider")
    result.stdout.fnmatch_lines(["*never fired: adc-bit-stuck:input=A5*", "*gyro-reset: Board must have one gyro*"])
    result.assert_outcomes(passed=3, failed=1, errors=1)
