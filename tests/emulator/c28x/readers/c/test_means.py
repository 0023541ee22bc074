"""Sums of readings of the ADC that 16 bits do not hold, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
static Uint16 Sum, Count, Mean; static Uint32 Wide; static float Zero; static volatile Uint16 Taken;
{other}
static void f(void)
{{
    Uint16 code = AdcaResultRegs.ADCRESULT0, i, sum = 0;
    {body}
}}
void main(void)
{{
    InitSysCtrl();
    for (;;)
        f();
}}
"""


def told(tmp_path: Path, body: str, other: str = "") -> bool:
    """Whether a program is told that a sum does not fit."""
    file = tmp_path / "adc.c"
    file.write_text(PROGRAM.format(body=body, other=other), encoding="utf-8")
    return "unsigned-wrap" in {f.rule for f in Build([str(file)]).compiled.findings}


@pytest.mark.parametrize(
    "body",
    [
        "if (Taken < 256) { Sum += code; if (++Taken == 256) Zero = (float)Sum / 256.0f; }",
        "Sum += code; Count++; if (Count >= 64) { Mean = Sum / 64; Sum = 0; Count = 0; }",
        "Sum += code & 0x0FFF; if (++Count == 64) { Mean = Sum >> 6; Sum = 0; Count = 0; }",
        "Sum += code; if (++Count >= 64) { Wide = Sum; Sum = 0; Count = 0; } Mean = Wide * 3000 / (4096UL * 64);",
        "Sum += code; if (++Count >= 64) { Wide = Sum; Sum = 0; Count = 0; } Mean = Wide / 64;",
        "for (i = 0; i < 40; i++) { sum += AdcaResultRegs.ADCRESULT1; } Mean = sum / 40;",
    ],
)
def test_a_sum_that_does_not_fit(tmp_path: Path, body: str) -> None:
    assert told(tmp_path, body)


@pytest.mark.parametrize(
    ("body", "other"),
    [
        ("if (Taken < 256) { Wide += code; if (++Taken == 256) Zero = (float)Wide / 256.0f; }", ""),
        ("Sum += code; if (++Count == 16) { Mean = Sum >> 4; Sum = 0; Count = 0; }", ""),
        ("Sum += code >> 4; if (++Count == 64) { Mean = Sum / 64; Sum = 0; Count = 0; }", ""),
        ("code >>= 4; Sum += code; if (++Count == 64) { Mean = Sum / 64; Sum = 0; Count = 0; }", ""),
        ("Sum += code / 64; if (++Count == 64) { Mean = Sum; Sum = 0; Count = 0; }", ""),
        ("Sum += code; if (++Count == 64) { Mean = Sum & 63; Sum = Sum / 64; Count = 0; }", ""),
        ("Sum += code; if (Count % 16 == 0) { Mean = Sum / 16; Sum = 0; } if (++Count == 64) Count = 0;", ""),
        ("Sum += code; if (Count % 16 == 0) Sum = 0; if (++Count == 64) { Mean = Sum / 64; Count = 0; }", ""),
        ("Sum += code; if (++Count >= 64) { Wide = Sum; Sum = 0; Count = 0; } Mean = Wide & 63; Zero = Wide / 64;", ""),
        ("Sum += code; if (++Count >= 64) { Wide = Sum; Sum = 0; Count = 0; } Mean = Wide * 3000 / 4096UL / 10;", ""),
        ("Sum += code; Sum -= Mean; if (++Count == 64) Mean = Sum / 64;", ""),
        ("Sum += code; if (++Count == 64) { Count = 0; Mean = Sum ^ 0x5555; }", ""),
        ("for (i = 0; i < 64; i++) { sum = 0; sum += code; Mean = sum / 64; }", ""),
        ("for (i = 0; i < 64; i++) { sum += code; if (i == 15) break; } Mean = sum / 64;", ""),
        ("for (i = 0; i < 32; i++) { sum += code; } Mean = sum / 32;", ""),
        ("for (i = 0; i < 16; i++) { sum += code; } Mean = sum / 16;", ""),
        ("Sum += code; if (++Count == 64) { Mean = Sum / 64; Sum = 0; Count = 0; }", "void g(void) { Count += 8; }"),
    ],
)
def test_a_sum_that_fits(tmp_path: Path, body: str, other: str) -> None:
    assert not told(tmp_path, body, other)
