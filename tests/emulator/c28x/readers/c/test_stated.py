"""Values that the source itself lets through and a result does not hold, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop

HEAD = """#include <stdlib.h>
typedef unsigned int Uint16; typedef unsigned long Uint32; typedef long int32; typedef int int16;
typedef struct { Uint16 rpm, s; } ORDER;
static ORDER Order; static Uint32 Out; volatile Uint16 in; static int32 wide; extern Uint16 Word(void);
static Uint16 Master = 10; static int16 small; static float Real;
"""


def told(body: str, other: str) -> set[str]:
    """What is told of a function with this body, which comes after `other`."""
    use = " Use(&Order);" if "Use(" in other else ""
    start = f'void main(void) {{ f("1", Word(), Word());{use} }}'
    text = f"{HEAD}{other}\nvoid f(const char *text, Uint16 n, Uint16 m)\n{{ {body} }}\n{start}\n"
    found = CWorkshop(text, static=True, externs={"Word": lambda: 0}).findings
    return {f.rule for f in found} & {"widened-late", "overflow", "unsigned-wrap"}


@pytest.mark.parametrize(
    ("body", "other"),
    [
        ("wide = (int32)((n & 0x0FFFU) << 12 | m >> 4);", ""),
        ("Out = (n & 0x0FFFU) << 12 | m >> 4;", ""),
        ("Uint16 high = n & 0x0FFF; Out = (Uint32)(high << 12) + (m >> 4);", ""),
        ("Uint16 high = n; high &= 0x0FFF; high <<= 12; Out = (Uint32)high | m >> 4;", ""),
        ("Uint16 high = (n & 0x3F) << 14; Out = ((Uint32)high << 1) | m;", ""),
        ("wide = ((n & 0xFF) << 10) + m;", ""),
        (
            "long v = strtol(text, 0, 10); if (v > 0 && v <= 3600) Order.s = (Uint16)v;",
            "void Use(const ORDER *o) { Out = o->s * 1000U; }",
        ),
        (
            "long v = strtol(text, 0, 10); if (v > 0 && v <= 3600) Order.s = (Uint16)v;",
            "void Use(const ORDER *o) { ORDER own = *o; Out = own.s * 1000U; }",
        ),
        ("int v = atoi(text); if (v < 0 || v > 3000) return; wide = v * 60;", ""),
        ("int v = atoi(text); if (v < 0 || v > 3000) return; small = v * 60;", ""),
        ("if (n > 1000) n = 1000; Out = n * 100U;", ""),
        # Clamped on both sides.
        ("int16 v = (int16)n - 1500; if (v > 500) v = 500; if (v < -500) v = -500; small = v * 1000 / 500;", ""),
        ("int16 v = (int16)n - 1500; if (v < -500) v = -500; if (v > 500) v = 500; small = v * 1000 / 500;", ""),
        ("int16 v = (int16)n - 1500; if (v > 500) v = 500; else if (v < -500) v = -500; small = v * 1000 / 500;", ""),
        ("int16 v = n; if (v > 0 && v < 2) return; if (v > 500) v = 500; if (v < -500) v = -500; wide = v * 1000;", ""),
        ("Uint16 x = n > 1000U ? 1000U : n; Out = x * 100U / 3;", ""),
        ("if (n > 1000) n = 1000; in = n * n / 20;", ""),
        ("if (n >= 1000) return; if (m >= 1000) return; Real = n * m;", ""),
        ("if (n > 50000U || m > 50000U) return; Out = n + m;", ""),
        ("Out = (n % 1000U) * 100U;", ""),
        ("if (n > 1000) n = 1000; if (n * 100U > 50000U) in = 1;", ""),
        ("if (n > 1000) n = 1000; Master = n;", "void Use(const ORDER *o) { Out = Master * 500U; }"),
        ("if (n > 5000) return; h(n);", "static void h(Uint16 v) { Out = v * 200U; }"),
        ("h(n);", "static void h(Uint16 v) { if (v > 5000) return; Out = v * 200U; }"),
        ("if (n < 5 || n > 5000) { small++; return; } wide += n * 20U;", ""),
        ("switch (n) { case 1: if (m <= 5000) { Out = m * 20U; } break; }", ""),
    ],
)
def test_what_a_result_does_not_hold_is_told(body: str, other: str) -> None:
    assert len(told(body, other)) == 1


@pytest.mark.parametrize(
    ("body", "other"),
    [
        ("wide = (int32)((Uint32)(n & 0x0FFFU) << 12 | m >> 4);", ""),
        ("wide = (n & 0xFF) << 8 | (m & 0xFF);", ""),
        ("Out = (n & 0x0F) << 12 | m;", ""),
        ("in = (n & 0x0FFF) << 12 | m;", ""),
        ("Out = (Uint16)((n & 0x0FFF) << 12) | m;", ""),
        ("Out = n << 12 | m;", ""),
        (
            "long v = strtol(text, 0, 10); if (v > 0 && v <= 60) Order.s = (Uint16)v;",
            "void Use(const ORDER *o) { Out = o->s * 1000U; }",
        ),
        (
            "long v = strtol(text, 0, 10); if (v > 0 && v <= 3600) Order.s = (Uint16)v;",
            "void Use(const ORDER *o) { if (o->s > 60) return; Out = o->s * 1000U; }",
        ),
        (
            "long v = strtol(text, 0, 10); if (v > 0 && v <= 3600) Order.s = (Uint16)v;",
            "void Use(const ORDER *o) { Out = o->s * 1000UL; }",
        ),
        (
            "long v = strtol(text, 0, 10); if (v > 0 && v <= 3600) Order.s = (Uint16)v;",
            "void Use(const ORDER *o) { Order.s /= 60; Out = o->s * 1000U; }",
        ),
        ("int v = atoi(text); if (v < 0 || v > 3000) return; if (v > 500) return; wide = v * 60;", ""),
        ("int v = atoi(text); if (v < 0 || v > 3000 || v > small) return; wide = v * 60;", ""),
        (
            "int v = atoi(text); if (v > 3000) return; if (!Word2(v)) return; wide = v * 60;",
            "static int Word2(int v) { return v < 100; }",
        ),
        ("if (n > 1000) n = 1000; in = n * 100U;", ""),
        ("if (n > 600) n = 600; Out = n * 100U;", ""),
        ("int16 v = n; if (v > 500) v = 500; if (v < -500) v = -500; small = (int16)((int32)v * 1000 / 500);", ""),
        ("int16 v = n; if (v > 500) v = 500; if (v < -500) v = -500; small = v * 60 / 500;", ""),
        ("int16 v = n; if (v > 500) v = 500; if (v < -500) v = -500; if (v > 30) v = 30; small = v * 1000 / 500;", ""),
        ("int16 v = n; if (v > 500) v = 500; if (v < -500) v = -500; v /= 20; small = v * 1000;", ""),
        ("int16 v = -1; if (m) v = n; if (v > 0) small = v * 1000;", ""),
        ("int16 v = n; if (v < -500) v = -500; small = v / 4 * 1000;", ""),
        ("if (n > 1000) n = 1000; n /= 10; Out = n * 100U;", ""),
        ("Uint16 v = in >> 4; if (v > 5000) return; Out = v * 16U;", ""),
        ("Out = (n % 600U) * 100U;", ""),
        ("Uint16 t; if (m) t = 1000; else t = 10; if (!m) Out = t * 1000U;", ""),
        (
            "if (n > 1000) n = 1000; Master = n;",
            "void Use(const ORDER *o) { if (Master > 100) Master = 100; Out = Master * 500U; }",
        ),
        ("if (n > 1000) { n = 0; } Out = (Uint16)(n * 100U);", ""),
        ("Out = ((n & 0xFFFF) << 4) & 0xFFF0;", ""),
        ("Out = ((n & 0x0FFF) << 12) & 0xFFFF;", ""),
        ("in = ((n & 0x7FFF) << 5) ^ (n >> 2);", ""),
        ("if (n > 5000) return; if (m == 1 && n > 5) return; if (m == 1) Out = n * 1000U;", ""),
        ("if (n > 5000) return; if (m == 1) { if (n > 5) return; } if (m == 1) Out = n * 1000U;", ""),
        ("if (n > 5000) return; if (m == 1) n = 5; Out = n * 12U;", ""),
        (
            "if (n > 5000) return; if (m == 1) Master = n; if (n > 50) return; Master = n;",
            "void Use(const ORDER *o) { Out = Master * 1000U; }",
        ),
        ("h(n & 0xFF);", "static void h(Uint16 v) { if (v > 5000) return; Out = v * 200U; }"),
        ("if (n > 50) return; h(n);", "static void h(Uint16 v) { if (v > 5000) return; Out = v * 200U; }"),
        ("h(50); h(60);", "static void h(Uint16 v) { if (v > 5000) return; Out = v * 200U; }"),
        ("Uint16 s = 0; while (n--) s = (s * 109 + 89) % 1000; Out = s;", ""),
        ("int16 t = (int16)((n & 0x3FFF) << 2); wide = t / 4;", ""),
        ("wide = ((n & 0x1FFF) << 4) >> 4;", ""),
    ],
)
def test_what_it_holds_or_another_test_limits_is_silent(body: str, other: str) -> None:
    assert told(body, other) == set()


TEXTS = """#include <stdio.h>
#include <stdlib.h>
typedef unsigned int Uint16; typedef unsigned long Uint32;
static char text[24]; static Uint16 Errors, Round; static Uint32 Ms; static Uint16 Limit; volatile Uint16 in;
struct COUNTS { Uint16 errors, other; } counts;
static const char *const names[] = {"OFF", "STANDBY", "ON"};
void Tick(void)
{
    Ms++; if (in) { Errors++; counts.errors += 1; } if (++Round >= 1000) Round = 0;
}
void Order(const char *line) { long v = strtol(line, 0, 10); if (v >= 0 && v <= 20000) Limit = (Uint16)v; }
"""


@pytest.mark.parametrize(
    ("call", "longer"),
    [
        ('sprintf(text, "0123456789 E=%u,%u\\r\\n", Errors, counts.errors)', True),  # 2 numbers of 5 digits: 27 words
        ('sprintf(text, "0123456789 1234 M=%u\\r\\n", Limit)', True),  # 5 digits: 26 words
        ('sprintf(text, "0123456789 state=%s", names[in])', True),  # 7 letters: 25 words
        ('sprintf(text, "0123456789 state %s", in ? "running" : "off")', True),
        ('sprintf(text, "0123456789 123456 t=%lu", Ms / 1000UL)', False),  # 2 digits: 22 words
        ('sprintf(text, "0123456789 123 M=%u\\n", Limit)', False),  # 24 words
        ('sprintf(text, "0123456789 12345 R=%u\\n", Round)', False),  # it begins again
        ('sprintf(text, "0123456789 123456 R=%u", in)', False),  # nothing says how large
        ('sprintf(text, "0123456789 state=%.4s", names[in])', False),
        ('sprintf(text, "E=%5u,%5u %s", Errors, counts.errors, names[in])', False),
    ],
)
def test_a_text_that_can_be_longer_than_its_array_is_told(call: str, *, longer: bool) -> None:
    end = 'void main(void) { Tick(); Order("1"); f(); }'
    found = CWorkshop(f"{TEXTS}void f(void)\n{{ {call}; }}\n{end}\n", static=True).findings
    assert ("memcpy-outside" in {f.rule for f in found}) == longer


CONVERTED = """#include "F28x_Project.h"
static int32 wide; static Uint32 Out; static float Real; static Uint16 in; static volatile Uint16 go;
static Uint16 Adc(void) {{ return AdcaResultRegs.ADCRESULT0; }}
static void f(void)
{{
    Uint16 r;
    {body}
}}
void main(void)
{{
    InitSysCtrl();
    for (;;)
        f();
}}
"""


def told_of_results(tmp_path: Path, body: str) -> list[str]:
    """What is told of a function with this body, which uses the results of an ADC."""
    file = tmp_path / "adc.c"
    file.write_text(CONVERTED.format(body=body), encoding="utf-8")
    told_there = (f.rule for f in Build([str(file)]).compiled.findings)
    return [rule for rule in told_there if rule in ("widened-late", "overflow", "unsigned-wrap")]


@pytest.mark.parametrize(
    "body",
    [
        "r = Adc(); if (r < 50 || r > 4045) return; wide = (int32)(r << 5) - 5;",
        "r = AdcaResultRegs.ADCRESULT0; if (r >= 50 && r <= 4045) wide = r << 5;",
        "r = Adc(); if (r < 50 || r > 4045) { in = 0; return; } Real = (r << 5) * 0.5f;",
        "for (;;) { r = Adc(); if (r < 50 || r > 4045) { in = 0; continue; } Real = (float)(r << 5); }",
        "for (;;) { r = Adc(); if (r > 4045) break; wide += r << 5; }",
        "for (;;) { Uint16 q; r = Adc(); if (r > 4045) break; q = r << 5; wide += q; }",
        "do { r = Adc(); } while (go); if (r > 4000) r = 4000; Out += (Uint32)(r << 5);",
        "r = 0; if (go) r = Adc(); if (r > 4045) return; wide = r * 20U;",
    ],
)
def test_a_shift_of_a_result_that_a_guard_lets_through_is_told(tmp_path: Path, body: str) -> None:
    assert told_of_results(tmp_path, body) == ["widened-late"]


@pytest.mark.parametrize(
    "body",
    [
        "r = Adc(); if (r < 50 || r > 4045) return; wide = (int32)(r << 4) - 5;",
        "r = Adc(); if (r < 50 || r > 4045) return; wide = ((int32)r << 5) - 5;",
        "r = Adc(); if (r < 50 || r > 2047) return; wide = (int32)(r << 5) - 5;",
        "r = Adc(); if (r < 50 || r > 4045) return; wide = (r << 5) & 0xFFFF;",
        "r = Adc(); if (r < 50 || r > 4045) return; wide = (Uint16)(r << 5);",
        "r = Adc(); if (r < 50 || r > 4045) return; wide = (int16)(r << 5);",
        "r = Adc(); if (r < 50 || r > 4045) return; in = (r << 5) ^ (r >> 3);",
        "r = Adc(); if (r > 5000) return; wide = r << 4;",  # 4095 at most
        "r = Adc() >> 4; if (r > 4045) return; wide = r << 5;",  # 255 at most
        "r = (Uint16)(Adc() * 5UL / 16); if (r > 2100) return; wide = r << 5;",  # 1279 at most
        "r = Adc(); if (r > 4045) return; if (r > 2000) return; wide = r << 5;",
        "r = Adc(); if (r > 4045) return; r -= 2048; wide = r << 5;",
        "r = Adc(); if (r < 50 || r > 4045 || r > in) return; wide = r << 5;",
        "r = Adc(); if (r > 4045) return; if (r < 2000) wide = r << 5; else wide = (int32)r << 5;",
        # Hashes, sums for a check, turned words.
        "Uint16 h = 5381; for (;;) { r = Adc(); if (r > 4045) continue; h = (h << 5) + h + r; Out = h; }",
        "r = Adc(); if (r > 4045) return; r = r << 8 | r >> 8; Out = r;",
        "r = Adc(); if (r > 4045) return; Out = (Uint16)(r << 8) | r >> 8;",
        "Uint16 k = 0; r = Adc(); if (r > 4045) return; k ^= r << 8; k = k & 0x8000 ? k << 1 ^ 33 : k << 1; Out = k;",
    ],
)
def test_a_shift_of_a_result_that_fits_or_is_cut_on_purpose_is_silent(tmp_path: Path, body: str) -> None:
    assert told_of_results(tmp_path, body) == []
