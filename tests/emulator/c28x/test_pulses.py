"""A time between two captures that 16 bits keep, and that is used as a wider number."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import CChip

WIDTH = """
TYPE Rise, Fall;
float Width(Uint32 rise, Uint32 fall)
{
    Uint16 width, upper = 0;
    start();
    ECap1Regs.CAP1 = rise;
    ECap1Regs.CAP2 = fall;
    Rise = ECap1Regs.CAP1;
    Fall = ECap1Regs.CAP2;
    width = Fall - Rise;
    USE
}
"""


def found(fall: int, *, times: int = 3, type_: str = "Uint32", use: str = "return width * 0.005f;") -> list[str]:
    """The rules that are reported after some measurements of pulses that begin at 1000."""
    chip = CChip(WIDTH.replace("TYPE", type_).replace("USE", use))
    for _ in range(times):
        chip.call("Width", 1000, fall)
    return [rule for rule, _ in chip.found()]


def test_a_long_pulse_that_is_cut_and_used_is_told_the_third_time() -> None:
    assert found(71_000) == ["widened-late"]
    assert not found(71_000, times=2)


@pytest.mark.parametrize("use", [
    # It is not used as a wider number, or both halves are kept.
    "return width > 500;", "upper = (Fall - Rise) >> 16; return (upper * 65536.0f + width) * 0.005f;",
    "width = 7; return width * 0.005f;",
])  # fmt: skip
def test_a_pulse_that_is_used_rightly_is_silent(use: str) -> None:
    assert not found(71_000, use=use)


def test_a_short_pulse_and_stamps_of_16_bits_are_silent() -> None:
    assert not found(66_000)
    assert not found(66_000, type_="Uint16")
