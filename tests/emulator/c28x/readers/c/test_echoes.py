"""Times of echoes that become distances and are not halved: wrong programs, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop

PROGRAM = """/* {subject} */
#include <stdint.h>
#define SOUND_M_S 343
uint32_t captured(void);
uint16_t range_mm;
float range_m;
static uint32_t Halved(uint32_t v) {{ return v {halved}; }}
uint16_t Range(void)
{{
    uint32_t echo_us = captured(), n = 0;
    float us = echo_us, time_s = us * 1e-6f;
    {body}
    n = Halved(n);
    return range_mm;
}}
int main(void) {{ for (;;) {{ Range(); }} }}
"""


def told(body: str, subject: str = "the sonar measures the time of an echo", halved: str = "+ 1") -> list[str]:
    """The products that are told of."""
    shop = CWorkshop(
        PROGRAM.format(body=body, subject=subject, halved=halved), static=True, externs={"captured": lambda: 1000}
    )
    return [f.object for f in shop.findings if f.rule == "echo-not-halved"]


@pytest.mark.parametrize(("body", "text"), [
    ("range_mm = echo_us * 343UL / 1000UL;", "echo_us * 343 / 1000"),
    ("range_mm = (uint16_t)(echo_us * SOUND_M_S / 1000);", "echo_us * 343 / 1000"),
    ("range_m = us * 0.000343f;", "us * 0.000343"),
    ("range_m = 340.0f * time_s;", "340 * time_s"),
    ("range_mm = (uint16_t)(us * 0.0343f * 10.0f);", "us * 0.0343 * 10"),
    ("range_mm = 10 * echo_us / 29;", "10 * echo_us / 29"),
])  # fmt: skip
def test_the_way_there_and_back_is_no_distance(body: str, text: str) -> None:
    assert told(body) == [text]


@pytest.mark.parametrize("body", [
    "range_mm = echo_us * 343UL / 2000UL;",
    "range_mm = echo_us * 343UL / 1000UL / 2;",
    "range_mm = echo_us * 172UL / 1000UL;",
    "range_m = us * 0.0001715f;",
    "range_m = us * 0.000343f / 2.0f;",
    "range_m = us * 0.5f * 0.000343f;",
    "range_mm = echo_us / 2 * 343UL / 1000UL;",
    "echo_us >>= 1; range_mm = echo_us * 343UL / 1000UL;",
    "echo_us /= 2; range_mm = echo_us * 343UL / 1000UL;",
    "range_mm = echo_us * 343UL / 1000UL; range_mm = range_mm / 2;",
    "range_mm = 10 * echo_us / 58;",
    "range_mm = Halved(echo_us) * 343UL / 1000UL; range_mm = Halved(echo_us) / 2;",
    "range_mm = echo_us * 3300UL / 4096UL;",
    "n = n * 343 / 1000; range_mm = n;",
    "range_mm = echo_us * 343UL / 4000UL;",
])  # fmt: skip
def test_half_of_it_is(body: str) -> None:
    assert told(body) == []


@pytest.mark.parametrize("subject", [
    "an echo: the beacon sends at a known time, the sound goes one way", "wind meter with ultrasound",
])  # fmt: skip
def test_other_sounds_go_one_way(subject: str) -> None:
    assert told("range_mm = echo_us * 343UL / 1000UL;", subject) == []


def test_a_function_may_halve_it() -> None:
    assert told("range_mm = echo_us * 343UL / 1000UL;", halved="* 2") != []
    assert told("range_mm = Halved(echo_us) * 343UL / 1000UL;", halved="/ 2") == []
