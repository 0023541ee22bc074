"""Units that names and comments state, steps of values that follow others, and programs that are right."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.cli import invoke
from hil.drivers.check import source_findings
from hil.drivers.unit_names import remark, unit_of_name, unit_of_text
from hil.image import Build


@pytest.mark.parametrize(("name", "unit"), [
    ("tickMs", "ms"), ("SAMPLE_US", "us"), ("supply_mV", "mV"), ("vMin_mV", "mV"), ("TiltDegrees", "degree"),
    ("rawRpm", "rpm"), ("f_kHz", "kHz"), ("battMilliVolts", "mV"), ("tempTenthsDeg", "1/10 degree"),
    ("angle_deg_x100", "1/100 degree"), ("setpointMilli", "thousandths of a unit"), ("mv", "mV"), ("adc_to_mV", "mV"),
    ("permille", "permille"),
    # Ends that mean other things too, with and without a word for the quantity.
    ("timeout_s", "s"), ("config_s", ""), ("temperatureDc", "decidegree Celsius"), ("BUS_DC", ""),
    ("motorCurrent_A", "A"), ("PORT_A", ""), ("heading_rad", "rad"), ("winkel_rad", "rad"), ("tiempo_s", "s"),
    # Products, and rates.
    ("rest_mA_ms", "mA ms"), ("CHARGE_MAS", "mAs"), ("capacity_mAh", "mAh"), ("uno_mas", ""), ("speed_mm_ms", ""),
    ("PULSE_JE_MS", ""), ("temp_sixteenths", "sixteenths of a unit"),
    ("wheel_rad", ""), ("chargeMa", "mA"), ("PHASE_MA", "mA"), ("ma", ""),
    ("current_mA", "mA"), ("temp_dC", "decidegree Celsius"), ("pack_mA", ""), ("HOT_C", "degree Celsius"),
    ("PHASE_C", ""), ("Millis", "ms"),
    # No units: other words, rates, amounts, mega or milli.
    ("items", ""), ("params", ""), ("VRMS", ""), ("motorRPMs", ""), ("max_min", ""), ("filterDegree", ""),
    ("powerMeter", ""), ("RAMP_RPM_PER_MS", ""), ("RATE_6400_HZ", ""),
    ("timeout500Ms", ""), ("power_MW", ""), ("speed_mm_s", ""), ("rate_deg_s", ""), ("", ""),
])  # fmt: skip
def test_the_end_of_a_name_states_a_unit(name: str, unit: str) -> None:
    found = unit_of_name(name)
    assert (found.name if found is not None else "") == unit


@pytest.mark.parametrize(("comment", "unit", "unclear", "amount"), [
    ("mm", "mm", False, None), ("rpm, filtered", "rpm", False, None), ("the set point [mV]", "mV", False, None),
    ("tenths of a degree", "1/10 degree", False, None), ("0.1 degree", "1/10 degree", False, None),
    ("in V", "V", False, None), ("°C", "degree Celsius", False, None), ("85 degrees", "degree", False, 85.0),
    ("85.0 degrees, in tenths", "degree", True, 85.0),
    # One letter can be a channel; a scale that is not understood says that the name is not to be trusted.
    ("A", "", False, None), ("last edge", "", False, None), ("mV per count", "", True, None),
    ("one tick is 1 ms", "", False, None), ("1 kernel tick = 1 ms", "", False, None),
    ("a tick of 1 ms", "", True, None),
    ("ms * 10", "", True, None), ("12 V in 48 ms", "", False, None), ("nothing", "", False, None),
])  # fmt: skip
def test_a_comment_states_a_unit(comment: str, unit: str, unclear: bool, amount: float | None) -> None:
    said = remark(comment)
    assert (said.unit.name if said.unit is not None else "", said.unclear, said.amount) == (unit, unclear, amount)


@pytest.mark.parametrize(("one", "other", "ratio"), [
    ("ms", "us", 1000.0), ("mm", "cm", 0.1), ("rpm", "hz", 0.0), ("deg", "degrees celsius", 1.0), ("ms", "mm", 0.0),
    ("0.1 degree", "degree", 0.1), ("permille", "percent", 0.1),
])  # fmt: skip
def test_units_of_one_quantity_have_a_ratio(one: str, other: str, ratio: float) -> None:
    first, second = unit_of_text(one), unit_of_text(other)
    assert first is not None
    assert second is not None
    assert first.ratio(second) == pytest.approx(ratio)


HEAD = """#include <math.h>
#include <stdint.h>
#define POLL_US     500L
#define POLL_MS     5
#define LIMIT_MV    3000
#define NOTHING_MS  0
#define RATE_6400_HZ 3
#define SIDES       10
#define PAUSE_US(n) pause((n) * 40L)
typedef struct {
    int16_t angle;          // 0.1 degree
    float   yaw_rad;        // after the filter
    int16_t pair[2];        // mV
} Pose;
Pose pose;
typedef struct { uint32_t from_us, to_ms; } Span;
int16_t gapMm, gapCm;
uint16_t tickMs;
uint32_t stamp_us, gone_s;
int16_t temperature;        /* tenths of a degree */
int16_t temp_c;
int16_t levelMv;            // mV per count
uint32_t age_us;
float tilt_deg, tilt_rad;
float bow = 0, rudder = 0, drift_dps = 0;
uint16_t rateKhz;
int16_t voltage_mV, duty_percent, permille;
void delay_ms(uint16_t n) { tickMs = n; }
void pause(int32_t loops) { stamp_us += loops; }
uint32_t elapsed_us(void) { return stamp_us; }
uint32_t period_hz(uint16_t n) { return 1000000UL / n; }
uint32_t Get_ms(uint16_t n) { return n; }
uint32_t rpmFromMs(uint16_t n) { return 60000UL / n; }
int16_t greater(int16_t a, int16_t b) { return a > b ? a : b; }
"""


def told(folder: Path, text: str, rule: str, name: str = "a.c") -> list[str]:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return [f.message for f in source_findings(Build([str(file)])) if f.rule == rule]


MIXED = [
    ("delay_ms(POLL_MS * 1000);",
     "5000 is POLL_MS (ms by its name) times 1000, and parameter n of delay_ms is in ms by its function's name, which "
     "is the same"),
    ("gapCm = gapMm;", "gapMm is in mm by its name, gapCm in cm by its name"),
    ("gapCm = gapMm * 10;",
     "gapMm * 10 is gapMm (mm by its name) times 10, gapCm is in cm by its name: from mm to cm the factor is 0.1"),
    ("gapMm = gapCm / 10;",
     "gapCm / 10 is gapCm (cm by its name) times 0.1, gapMm is in mm by its name: from cm to mm the factor is 10"),
    ("int16_t d = gapMm; gapCm = d;", "d is in mm by its value's name, gapCm in cm by its name"),
    ("Span s = { POLL_MS, POLL_MS }; stamp_us = s.from_us;", "POLL_MS is in ms by its name, from_us in us by its name"),
    ("static const Span s[2] = { { POLL_US, 3 }, { 7, POLL_MS } }; tickMs = s[1].to_ms;", ""),
    ("stamp_us = POLL_MS;", "POLL_MS is in ms by its name, stamp_us in us by its name"),
    ("stamp_us += tickMs;", "stamp_us is in us by its name, tickMs in ms by its name"),
    ("if (elapsed_us() > tickMs) tickMs = 0;", "elapsed_us(...) is in us by its name, tickMs in ms by its name"),
    ("delay_ms(POLL_US);", "POLL_US is in us by its name, parameter n of delay_ms in ms by its function's name"),
    ("PAUSE_US(POLL_MS);", "POLL_MS is in ms by its name, the argument of PAUSE_US in us by its macro's name"),
    ("PAUSE_US(tickMs);", "tickMs is in ms by its name, the argument of PAUSE_US in us by its macro's name"),
    ("stamp_us = Get_ms(3);", "Get_ms(...) is in ms by its name, stamp_us in us by its name"),
    ("if (pose.angle > temp_c) temp_c = 0;",
     "pose.angle is in 1/10 degree by its comment, temp_c in degree Celsius by its name"),
    ("if (temperature > temp_c) temp_c = 0;",
     "temperature is in 1/10 degree by its comment, temp_c in degree Celsius by its name"),
    ("if (pose.pair[1] > POLL_US) tickMs = POLL_US;", "POLL_US is in us by its name, tickMs in ms by its name"),
    ("tilt_deg = pose.yaw_rad;", "pose.yaw_rad is in rad by its name, tilt_deg in degree by its name"),
    ("tilt_deg = atan2f(1.0f, tilt_rad);", "atan2(...) is in radians of the C library, tilt_deg in degree by its name"),
    ("tilt_rad = sinf(tilt_deg);", "tilt_deg is in degree by its name, the angle of sin in radians of the C library"),
    ("tilt_deg = tilt_rad * 0.01745329f;",
     "tilt_rad * 0.0174533 is tilt_rad (rad by its name) times 0.01745, tilt_deg is in degree by its name: from rad to "
     "degree the factor is 57.3"),
    ("tilt_rad += 0.1f * bow * 57.29578f;",
     "tilt_rad is in rad by its name, 0.1 * bow * 57.2958 in degree by its factor 180/pi"),
    ("bow += rudder * (180.0f / 3.14159265f); if (bow > 180.0f) bow -= 360.0f; rudder = cosf(bow);",
     "bow is in degree by its factor 180/pi, the angle of cos in radians of the C library"),
    ("float a = rudder / 0.0174533f; bow = sinf(a);",
     "a is in degree by its value's factor 180/pi, the angle of sin in radians of the C library"),
    # A share of a value that is more than the value, or a thousandth of it.
    ("voltage_mV = (int16_t)(LIMIT_MV * permille / 100);",
     "voltage_mV is in mV by its name, and gets LIMIT_MV (mV by its name) times permille (permille by its name) times "
     "0.01: the factor of such a share is 0.001"),
    ("delay_ms(0.1f * duty_percent * tickMs);",
     "parameter n of delay_ms is in ms by its function's name, and gets tickMs (ms by its name) times duty_percent "
     "(percent by its name) times 0.1: the factor of such a share is 0.01"),
    ("stamp_us = tickMs * duty_percent / 100;",
     "stamp_us is in us by its name, and gets tickMs (ms by its name) times duty_percent (percent by its name) times "
     "0.01: the factor of such a share is 10"),
    # A number divided by a time, or by a rate.
    ("if (tickMs) rateKhz = 1000 / tickMs;",
     "1000 / tickMs is 1 / tickMs (1/(ms) by its name) times 1000, rateKhz is in kHz by its name: from 1/(ms) to kHz "
     "the factor is 1"),
    ("if (rateKhz) stamp_us = 1000000UL / rateKhz;",
     "1000000 / rateKhz is 1 / rateKhz (1/(kHz) by its name) times 1e+06, stamp_us is in us by its name: from 1/(kHz) "
     "to us the factor is 1000"),
]  # fmt: skip


@pytest.mark.parametrize(("body", "message"), MIXED)
def test_a_value_in_another_unit_is_told(tmp_path: Path, body: str, message: str) -> None:
    assert told(tmp_path, f"{HEAD}void f(void)\n{{\n    {body}\n}}\n", "unit-by-name") == ([message] if message else [])


@pytest.mark.parametrize("body", [
    "gapCm = gapMm / 10; gapMm = gapCm * 10;",
    "stamp_us = POLL_MS * 1000L; stamp_us = tickMs * 1000UL; stamp_us += 1000UL * tickMs;",
    "stamp_us = NOTHING_MS;",
    "tickMs = (uint16_t)(elapsed_us() / 1000); tickMs = (uint16_t)(stamp_us >> 10);",
    "delay_ms(POLL_MS); delay_ms((uint16_t)(POLL_US / 100)); delay_ms(POLL_MS * 100); tickMs = POLL_MS * 1000;",
    "tilt_deg = tilt_rad * 57.3f; tilt_rad = tilt_deg * (3.14159f / 180.0f);",
    # Half of it, a tenth of it in microseconds: it can be meant so.
    "stamp_us = tickMs * 500UL; stamp_us = tickMs * 100UL; gapMm = gapCm * 2;",
    # Converted where it is; a comment about a scale; an amount in the name; a function of any unit; another quantity.
    "age_us = stamp_us; age_us /= 1000; tickMs = (uint16_t)age_us;",
    "levelMv = POLL_MS; rateKhz = RATE_6400_HZ; gapCm = greater(gapMm, 3);",
    "temp_c = voltage_mV; duty_percent = voltage_mV; gapMm = POLL_MS;",
    "pose.angle = temperature; tilt_deg = temp_c;",
    # A factor with a name; a function that is named after what it takes; a macro that takes a product.
    "gapCm = gapMm * SIDES; stamp_us = period_hz(3); stamp_us = rpmFromMs(3);",
    "PAUSE_US(POLL_US); PAUSE_US(tickMs * 1000L); PAUSE_US(tickMs + POLL_MS);",
    # Degrees that go back to radians, or to something in degrees; a number that is no 180/pi; an object of both units.
    "bow = rudder * 57.3f; rudder = cosf(bow * 0.0174533f) + sinf(bow / 57.3f); tilt_deg = bow;",
    "drift_dps = tilt_rad * 57.3f; gapMm = (int16_t)(rudder * 57.3f); pose.angle = (int16_t)(rudder * 57.3f);",
    "bow = rudder * 57.3f; bow = tilt_rad; rudder = cosf(bow);",
    "if (tickMs && rateKhz) { rateKhz = 1 / tickMs; stamp_us = 1000 / rateKhz; rateKhz = 16 / tickMs; }",
    "if (stamp_us) { rateKhz = 1000 / stamp_us; gapMm = 1000 / stamp_us; rateKhz = 10000 / stamp_us; }",
    # Shares: right ones; a tenth of one; not scaled yet; of a divisor with a name; a gain; a value of no known unit.
    "voltage_mV = (int16_t)((int32_t)LIMIT_MV * permille / 1000); delay_ms(tickMs * duty_percent / 100);",
    "voltage_mV = (100 - duty_percent) * (int32_t)LIMIT_MV / 100; stamp_us = tickMs * 10UL * duty_percent;",
    "voltage_mV = permille * (int32_t)LIMIT_MV / 10000; stamp_us = stamp_us * permille;",
    "voltage_mV = LIMIT_MV * permille / SIDES; duty_percent = permille / 10; permille = 10 * duty_percent;",
    "temp_c = voltage_mV * duty_percent / 10; gapMm = gapMm + (permille * gapMm >> 7);",
    "bow = duty_percent * 30.0f; duty_percent = tickMs * 100UL / POLL_MS; permille = duty_percent * permille / 10;",
])  # fmt: skip
def test_a_converted_value_is_not_told(tmp_path: Path, body: str) -> None:
    assert told(tmp_path, f"{HEAD}void f(void)\n{{\n    {body}\n}}\n", "unit-by-name") == []


RAW = """#include "F28x_Project.h"
#define MOST_mV  5000
#define DEAD_mm  2
#define MOST_C   60
typedef struct {{ int32 samples[4]; int32 position; Uint16 gain, bus_mV, peak_mV; }} Axis;
Axis axis;
Uint16 bus, frame[2], raised;
int16 gap_mm, temp_C;
static Uint16 word(void) {{ return SpiaRegs.SPIRXBUF; }}
static Uint16 to_mV(Uint16 counts) {{ return (Uint16)((Uint32)counts * axis.gain >> 12); }}
static int32 mean(const Axis *a) {{ int32 sum = 0; Uint16 i; for (i = 0; i < 4; i++) sum += a->samples[i];
return sum / 4; }}
void f(Uint16 n)
{{
    int32 low, high = axis.samples[n];
    bus = AdcaResultRegs.ADCRESULT0;
    axis.bus_mV = to_mV(bus);
    axis.samples[n] = (int32)((Uint32)(word() & 0xFFF) << 12 | word() >> 4);
    gap_mm = (int16)(mean(&axis) * axis.gain >> 20);
    low = high;
    frame[0] = word();
    frame[1] = word();
    temp_C = frame[0] * 3 / 16;
    {use}
}}
"""


@pytest.mark.parametrize(("use", "message"), [
    ("if (high - low > DEAD_mm) raised = 1;",
     "high - low is as the hardware gave it, and meets DEAD_mm in mm by its name: line 19 converts such a value to mm "
     "by a factor"),
    ("axis.peak_mV = bus;",
     "bus is as the hardware gave it, and meets axis.peak_mV in mV by its name: line 10 converts such a value to mV by "
     "a factor"),
    ("if (AdcaResultRegs.ADCRESULT0 < MOST_mV) raised = 1;",
     "AdcaResultRegs.ADCRESULT0 is as the hardware gave it, and meets MOST_mV in mV by its name: line 10 converts such "
     "a value to mV by a factor"),
    # Converted; in counts; another channel; the integer part; a value that is converted before it is filtered.
    ("if (to_mV(bus) > MOST_mV || axis.bus_mV > MOST_mV || bus > MOST_mV * 4L / 3 || bus > 3000) raised = 1;", ""),
    ("if (frame[1] > MOST_C || frame[0] >> 4 > MOST_C || AdcbResultRegs.ADCRESULT0 > MOST_mV) raised = 1;", ""),
    ("high = gap_mm; low = mean(&axis) * axis.gain >> 20; if (high - low > DEAD_mm) raised = 1;", ""),
])  # fmt: skip
def test_a_raw_value_meets_one_in_a_unit(tmp_path: Path, use: str, message: str) -> None:
    assert told(tmp_path, RAW.format(use=use), "unit-by-name") == ([message] if message else [])


PRINTED = """#include <stdio.h>
char line[80];
unsigned pack_mV, current_mA, wait_ms, speed_mm_s, limit_mA; int temp_degC; unsigned long time_us;
void f(void)
{
    sprintf(line, %s);
}
"""


MEANT = """#include <stdint.h>
#include <stdio.h>
#define HOLD_S         900U
#define LATE_S         9       // steps of 10 ms
#define LOAD_A         30
#define LOAD_B         40
#define FULL_MBAR      6000
#define HOT_C          60
#define BLOCK_MS       10
#define STEPS_PER_MM   80
#define LENGTH_MM      50
#define TOP_A          7
#define TENTHS_PER_MM  800     // tenths of a step
typedef struct { uint16_t hold_s; int16_t load_A; } Stage;
Stage stage;
uint32_t now_ms, since_ms; int16_t load_mA, pack_cbar, temp_sixteenths, pos_tenths;
int32_t charge_mAs, rest_mA_ms, steps, at, way; int16_t direction;
uint16_t word;
char line[40];
void move(int16_t by) { steps += direction; at = steps; direction = by ? 1 : -1; if (by) direction = 0; }
void back(void) { if (word) direction = 1; else direction = -1; way = way + word; }
void f(void)
{
    int16_t temp, other;

    %s
}
"""


@pytest.mark.parametrize(("body", "message"), [
    ("if (now_ms - since_ms >= stage.hold_s) word = 0;",
     "now_ms - since_ms is in ms by its name, stage.hold_s in s by its name"),
    ("if (now_ms - since_ms > HOLD_S) word = 0;", "now_ms - since_ms is in ms by its name, HOLD_S in s by its name"),
    ("stage.hold_s = now_ms;", "now_ms is in ms by its name, stage.hold_s in s by its name"),
    ("if (pack_cbar > FULL_MBAR) word = 0;", "pack_cbar is in cbar by its name, FULL_MBAR in mbar by its name"),
    ("temp = (int16_t)word >> 3; temp_sixteenths = temp; if (temp > HOT_C) word = 0;",
     "temp is in sixteenths of a unit by its target's name, HOT_C in degree Celsius by its name"),
    ("charge_mAs += load_mA * (int32_t)BLOCK_MS;",
     "charge_mAs is in mAs by its name, load_mA * 10 in mA ms by its factors' names"),
    ("charge_mAs += rest_mA_ms;", "charge_mAs is in mAs by its name, rest_mA_ms in mA ms by its name"),
    ('sprintf(line, "%ld um", at / STEPS_PER_MM);', "at / 80 is in mm by its divisor's name, and is printed as um"),
    # Converted; a comment; one of two channels; a rate.
    ("if (now_ms - since_ms >= stage.hold_s * 1000UL || (now_ms - since_ms) / 1000 > HOLD_S) word = 0;", ""),
    ("if (now_ms > LATE_S || load_mA > LOAD_A || stage.load_A > load_mA) word = 0;", "stage.load_A is in A"),
    ("if (now_ms > LATE_S || load_mA > LOAD_A) word = 0;", ""),
    ("stage.hold_s = now_ms / 1000; since_ms = stage.hold_s * 1000UL; if (pack_cbar > FULL_MBAR / 10) word = 0;", ""),
    ("rest_mA_ms += load_mA * BLOCK_MS; charge_mAs += rest_mA_ms / 1000; rest_mA_ms %= 1000;", ""),
    # Tenths of a millimetre; tenths, and a letter that need not be a unit.
    ("pos_tenths = LENGTH_MM * 10; if (pos_tenths > LENGTH_MM * 10 || pos_tenths > TOP_A) word = 0;", ""),
    # A value of two units, or of another one later; one that also goes elsewhere.
    ("temp = word; temp_sixteenths = temp; temp = temp / 16; if (temp > HOT_C) word = 0;", ""),
    ("temp = word; temp_sixteenths = temp; pack_cbar = temp; if (temp > HOT_C) word = 0;", ""),
    ("temp = word; other = temp * 16; temp_sixteenths = other; if (temp > HOT_C) word = 0;", ""),
    ("temp = word; temp_sixteenths = temp; if (temp > HOT_C * 16) word = 0;", ""),
    # In thousandths of a step; counts that are something else; a part of a number.
    ('sprintf(line, "%ld um", at * 1000 / STEPS_PER_MM); sprintf(line, "%ld um", way / STEPS_PER_MM);', ""),
    ('sprintf(line, "%ld um", at / TENTHS_PER_MM); sprintf(line, "%ld.%ld mm", at / STEPS_PER_MM, at % 80);', ""),
])  # fmt: skip
def test_what_a_name_means_beside_another_unit(tmp_path: Path, body: str, message: str) -> None:
    found = told(tmp_path, MEANT.replace("%s", body, 1), "unit-by-name")
    assert [text[: len(message)] for text in found] == ([message] if message else [])


@pytest.mark.parametrize(("printed", "messages"), [
    ('"U=%u mV I=%u mA", current_mA, pack_mV',
     ["current_mA is in mA by its name, and is printed as mV", "pack_mV is in mV by its name, and is printed as mA"]),
    ('"%*u us", 3, wait_ms', ["wait_ms is in ms by its name, and is printed as us"]),
    ('"U=%u mV I=%umA", pack_mV, current_mA', []),
    # Converted, or a part of a number; a rate, a word, a scale.
    ('"%u.%03u V, %lu ms", pack_mV / 1000, pack_mV % 1000, time_us / 1000', []),
    ('"%u.%u ms %u mV/s", wait_ms, pack_mV, wait_ms', []),
    ('"%u mm/s, %u in the line, %u A", speed_mm_s, wait_ms, pack_mV', []),
    ('"%u mV (times 10)", current_mA', []),
])  # fmt: skip
def test_what_is_printed_in_front_of_a_unit(tmp_path: Path, printed: str, messages: list[str]) -> None:
    assert told(tmp_path, PRINTED % printed, "unit-by-name") == messages


CALLED = """#include <stdint.h>
#define GAP_US 500u
#define LATE_US 900u
uint16_t left_ms;
static uint16_t half(uint16_t number) { left_ms = number; return number; }
"""


@pytest.mark.parametrize(("calls", "messages"), [
    ("half(GAP_US); half(LATE_US);", ["number is in us by its value's name, left_ms in ms by its name"]),
    # Another unit, none, a product; two units.
    ("half(left_ms); half(left_ms);", []), ("half(GAP_US); half(3);", []), ("half(GAP_US / 1000);", []),
    ("half(GAP_US); half(left_ms);", []),
])  # fmt: skip
def test_a_parameter_has_the_unit_that_each_call_passes(tmp_path: Path, calls: str, messages: list[str]) -> None:
    assert told(tmp_path, f"{CALLED}void f(void) {{ {calls} }}\n", "unit-by-name") == messages


def test_python_states_units_in_the_same_way(tmp_path: Path) -> None:
    text = (
        "from emulator.c28x.language import *\n\nPOLL_US = 500\nlast: int16 = 0  # ms\nlevel_mV: int16 = 0\n\n\n"
        "def mixed() -> None:\n    global last\n    last = POLL_US\n\n\ndef right() -> None:\n    global last\n"
        "    last = POLL_US / 1000 + level_mV\n"
    )
    assert told(tmp_path, text, "unit-by-name", "a.py") == ["POLL_US is in us by its name, last in ms by its comment"]


KERNEL = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Task.h>
#define PERIOD_US   2000
#define PERIOD_MS   2
UInt16 calls = 0;
Void Tick(UArg a) { calls++; }
Void Work(UArg a, UArg b) { for (;;) Task_sleep(%s); }
Int main(void)
{
    Clock_Params params;
    Clock_Params_init(&params);
    params.period = %s;
    params.startFlag = TRUE;
    Clock_create(Tick, %s, &params, NULL);
    Task_create(Work, NULL, NULL);
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(("times", "messages"), [
    (("PERIOD_MS", "PERIOD_MS", "PERIOD_MS"), []),
    (("PERIOD_US / 1000", "PERIOD_US / 1000", "3"), []),
    (("PERIOD_US", "PERIOD_MS", "2"),
     ["PERIOD_US is in us by its name, parameter nticks of Task_sleep in ticks of 1 ms"]),
    (("1", "PERIOD_US", "PERIOD_US"), [
        "PERIOD_US is in us by its name, params.period in ticks of 1 ms",
        "PERIOD_US is in us by its name, parameter timeout of Clock_create in ticks of 1 ms",
    ]),
    # The tick is a millisecond, or so the program takes it elsewhere.
    (("PERIOD_MS * 1000UL", "PERIOD_MS", "2"),
     ["2000 is PERIOD_MS (ms by its name) times 1000, and parameter nticks of Task_sleep is in ticks of 1 ms, which is "
      "the same"]),
    (("PERIOD_MS", "1000 * PERIOD_MS", "PERIOD_MS * 10"),
     ["2000 is PERIOD_MS (ms by its name) times 1000, and params.period is in ticks of 1 ms, which is the same"]),
    (("PERIOD_MS * 1000UL", "PERIOD_MS * 1000UL", "1"), []),
    (("PERIOD_MS * 10", "PERIOD_MS", "PERIOD_MS * 100"), []),
])  # fmt: skip
def test_times_of_the_kernel_are_in_ticks(tmp_path: Path, times: tuple[str, str, str], messages: list[str]) -> None:
    assert told(tmp_path, KERNEL % times, "unit-by-name") == messages


@pytest.mark.parametrize(("line", "message"), [
    ("#define LIMIT_MS 5  // 5 s", "LIMIT_MS is 5 in ms by its name, and 5 s in its comment"),
    ("#define HOT_TEMP_DC (85)  /* 85 degrees */",
     "HOT_TEMP_DC is 85 in decidegree Celsius by its name, and 85 degree in its comment"),
    ("enum { LIMIT_MS = 5 }; // 5 s", "LIMIT_MS is 5 in ms by its name, and 5 s in its comment"),
    ("static const uint16_t LIMIT_MS = 5; // 5 s", "LIMIT_MS is 5 in ms by its name, and 5 s in its comment"),
    ("static const uint16_t LIMIT_MS = 5000; // 5 s", ""),
    ("#define LIMIT_MS 5000U // 5 s", ""),
    ("#define HOT_TEMP_DC 850 // 85.0 degrees, in tenths", ""),
    ("#define LIMIT_MS 5 // 20 ms, less the margin", ""),
    ("#define LIMIT_MS 5 // 5 V", ""),
    ("#define LIMIT_MS 5 // write cycle: 5 s at most", ""),
])  # fmt: skip
def test_a_name_and_a_comment_that_contradict_each_other_are_told(tmp_path: Path, line: str, message: str) -> None:
    name = next(word for word in ("LIMIT_MS", "HOT_TEMP_DC") if word in line)
    text = f"#include <stdint.h>\n{line}\nint limit(void) {{ return {name}; }}\n"
    assert told(tmp_path, text, "unit-in-comment") == ([message] if message else [])


RAMP = """typedef struct { float value, rise, fall; } Ramp;
int reference = 0;
int wanted = 0;
#define STEP 5
"""

WAYS = [
    ("void f(Ramp *r, float to) { if (to > r->value + r->rise) r->value += r->rise; "
     "else if (to < r->value - r->fall) r->value += r->fall; else r->value = to; }",
     "r->value follows to: where to < r->value - r->fall, r->value += r->fall goes away from it"),
    ("void f(void) { if (reference < wanted - STEP) reference -= STEP; else if (reference > wanted + STEP) "
     "reference -= STEP; else reference = wanted; }",
     "reference follows wanted: where reference < wanted - 5, reference -= 5 goes away from it"),
    ("void f(void) { if (reference + STEP < wanted) reference += STEP; else if (wanted <= reference - STEP) "
     "reference += STEP; else reference = wanted; }",
     "reference follows wanted: where wanted <= reference - 5, reference += 5 goes away from it"),
    ("void f(Ramp *r, float to) { if (to > r->value + r->rise) r->value += r->rise; "
     "else if (to < r->value - r->fall) r->value -= r->fall; else r->value = to; }", ""),
    ("void f(void) { if (reference < wanted - STEP) reference += STEP; else if (reference > wanted + STEP) "
     "reference -= STEP; else reference = wanted; }", ""),
    # A threshold that is lowered when it is passed follows nothing; nor does a value that turns at its limit.
    ("void f(void) { if (wanted > reference + STEP) reference -= STEP; else wanted = 0; }", ""),
    ("void f(void) { if (reference > wanted + STEP) reference += STEP; else if (wanted > 3) reference = 0; }", ""),
    # A share of the difference.
    ("void f(void) { reference -= (wanted - reference) / 8; }",
     "reference follows wanted: reference -= (wanted - reference) / 8 goes away from it"),
    ("int Read(void) { return wanted; } void f(void) { if (wanted < 9) reference += (reference - Read()) >> 3; }",
     "reference follows Read(...): reference += reference - Read(...) >> 3 goes away from it"),
    ("void f(Ramp *r, float to) { float error = to - r->value; r->value -= 0.1f * error; }",
     "r->value follows to: r->value -= 0.1 * error goes away from it"),
    ("void f(void) { reference += (wanted - reference) / 8; }", ""),
    ("void f(void) { reference -= (reference - wanted) / 8; }", ""),
    ("void f(Ramp *r, float to) { float error = r->value - to; r->value -= 0.1f * error; }", ""),
    # A local is computed once; a constant is not followed; an extrapolation takes what it is compared with along.
    ("int f(int y) { y += (y - wanted) / 2; return y; }", ""),
    ("void f(void) { reference += (reference - 100) / 2; }", ""),
    ("void f(void) { int now = reference; reference += (reference - wanted) / 2; wanted = now; }", ""),
    ("void f(Ramp *r) { r->value -= (r->rise - r->value) * 2; }", ""),
]  # fmt: skip


@pytest.mark.parametrize(("function", "message"), WAYS)
def test_a_step_away_from_what_a_value_follows_is_told(tmp_path: Path, function: str, message: str) -> None:
    assert told(tmp_path, f"{RAMP}{function}\n", "step-away") == ([message] if message else [])


def test_a_unit_can_be_accepted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = "#include <stdint.h>\nuint16_t tickMs = 0;\nuint32_t stamp_us = 0;\nvoid f(void)\n{\n"
    file = tmp_path / "a.c"
    line = "stamp_us = tickMs;  // hil: allow unit-by-name, the register counts halves"
    file.write_text(f"{text}    {line}\n}}\n", encoding="utf-8")
    assert invoke(["check", "--calls", "1", str(file), "--fail-on", "warning"]) == 0
    assert "the register counts halves" in capsys.readouterr().out
