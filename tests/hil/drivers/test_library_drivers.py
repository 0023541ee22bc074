"""Drivers on a library that reaches registers by numbers: what is not connected is told at the user's own calls."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.drivers.check import DriverFiles, check_files
from hil.reports.model import rule_of

#: Addresses and offsets: TRM of the F2837xS, tables of the registers of ADC, ePWM, PIE and CPU timers.
HEADER = """#ifndef PORTS_H
#define PORTS_H
#include "F28x_Project.h"
#define WORD(x) (*((volatile unsigned int *)(unsigned long)(x)))
#define LONG(x) (*((volatile unsigned long *)(unsigned long)(x)))
#define ADC_A 0x7400ul
#define EPWM_1 0x4000ul
#define TIMER_0 0x0C00ul
#define PIE 0x0CE0ul
#define ON_ADC_1 0x0101u
#define ON_TIMER_0 0x0107u
enum Input { FIRST_INPUT, SECOND_INPUT };

static inline void Adc_powerUp(unsigned long base)
{
    EALLOW;
    WORD(base + 1) = (WORD(base + 1) & 0xFFF0u) | 6u;
    WORD(base) |= 0x84u;
    EDIS;
}

static inline void Adc_setClock(unsigned long base, unsigned int divider)
{
    EALLOW;
    WORD(base + 1) = (WORD(base + 1) & 0xFFF0u) | divider;
    EDIS;
}

static inline void Adc_convertAt(unsigned long base, int soc, int trigger, enum Input input)
{
    unsigned long at = base + 0x10 + 2 * soc;
    unsigned long mask = 0x1F781FFul;

    EALLOW;
    LONG(at) = (LONG(at) & ~mask) | ((unsigned long)trigger << 20) | ((unsigned long)input << 15) | 14u;
    EDIS;
}

static inline void Adc_enableInterrupt(unsigned long base, unsigned int number)
{
    unsigned long at = base + 7 + (number >> 1);

    EALLOW;
    WORD(at) |= 0x20u << 8 * (number & 1u);
    EDIS;
}

static inline void Pwm_start(unsigned long base, unsigned int period)
{
    WORD(base + 0x63) = period;
    WORD(base) = (WORD(base) & ~0x1F83u) | 0u;
}

static inline void Pwm_trigger(unsigned long base, unsigned int event)
{
    if (event == 0u)
        return;
    WORD(base + 0xA4) = (WORD(base + 0xA4) & ~0x0700u) | event << 8;
    WORD(base + 0xA6) = (WORD(base + 0xA6) & ~0x0300u) | 1u << 8;
}

static inline void Pwm_compare(unsigned long base, unsigned int value) { WORD(base + 0x6B) = value; }

static inline void Pwm_switch(unsigned long base, unsigned int actions) { WORD(base + 0x40) = actions; }

static inline void Pwm_enableTrigger(unsigned long base) { WORD(base + 0xA4) |= 0x0800u; }

static inline void Timer_start(unsigned long base, unsigned long period)
{
    LONG(base + 2) = period;
    WORD(base + 4) = (WORD(base + 4) & ~0x0010u) | 0x0020u;
}

static inline void Timer_enableInterrupt(unsigned long base) { WORD(base + 4) |= 0x4000u; }

static inline unsigned int Share(unsigned int whole, unsigned int parts) { return whole / parts; }

void Irq_begin(void);
void Irq_enable(unsigned int line);
void Irq_route(unsigned int line, void (*routine)(void));
#endif
"""
#: The library's own file.
SOURCE = """#include "ports.h"
static __interrupt void Nothing(void) { for (;;) { } }

void Irq_begin(void)
{
    unsigned int i;

    EALLOW;
    for (i = 32; i < 128; i++)
        LONG(0x0D00ul + 2 * i) = (unsigned long)&Nothing;
    EDIS;
    WORD(PIE) |= 1u;
}

void Irq_enable(unsigned int line)
{
    unsigned int group = (line >> 8) - 1u, mask;

    mask = 1u << group;
    WORD(PIE + 2 + 2 * group) |= 1u << ((line & 0xFFu) - 1u);
    IER |= mask;
}

void Irq_route(unsigned int line, void (*routine)(void))
{
    unsigned long at = 0x0D00ul + 2 * (32 + 8 * ((line >> 8) - 1) + (line & 0xFF) - 1);

    EALLOW;
    LONG(at) = (unsigned long)routine;
    EDIS;
}
"""
PROGRAM = """#include "ports.h"
unsigned int Sample = 0, Ticks = 0;
struct Converter { unsigned long base; int soc; };
struct Converter Converters[2] = {{ADC_A, 0}, {ADC_A, 1}};

__interrupt void Converted(void)
{
    Sample = WORD(0x0B00ul);
    WORD(ADC_A + 4) = 1u;
    WORD(PIE + 1) = 1u;
}

__interrupt void Tick(void)
{
    Ticks++;
    WORD(PIE + 1) = 1u;
}

static void start(void)
{
    Adc_powerUp(ADC_A);
    DELAY_US(1000);
    Adc_convertAt(ADC_A, 0, 5, FIRST_INPUT);   // SOCA of ePWM1
    Adc_enableInterrupt(ADC_A, 0);
    Pwm_trigger(EPWM_1, 2);
    Pwm_enableTrigger(EPWM_1);
    Pwm_start(EPWM_1, 4999);
    Timer_enableInterrupt(TIMER_0);
    Timer_start(TIMER_0, 20000);
}

void main(void)
{
    InitSysCtrl();
    DINT;
    Irq_begin();
    Irq_route(ON_ADC_1, &Converted);
    Irq_route(ON_TIMER_0, &Tick);
    start();
    Irq_enable(ON_ADC_1);
    Irq_enable(ON_TIMER_0);
    EINT;
    for (;;) {
        TURN
    }
}
"""


def found(tmp_path: Path, program: str, layout: str = "") -> list[Finding]:
    """The errors and warnings of a program on that library.

    `layout` says where the library's header is: beside its C file, there behind a link ("link"), or in `include` beside
    `source` ("include").
    """
    folder = tmp_path / ("far" if layout == "link" else "ports")
    here, there = (folder / "include", folder / "source") if layout == "include" else (folder, folder)
    here.mkdir(parents=True)
    there.mkdir(exist_ok=True)
    (here / "ports.h").write_text(HEADER, encoding="utf-8")
    (there / "ports.c").write_text(SOURCE, encoding="utf-8")
    if layout == "link":
        here = tmp_path / "ports"
        here.symlink_to(folder, target_is_directory=True)
    (tmp_path / "program.c").write_text(program.replace("TURN", ";"), encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "program.c"], include=[here], seconds=0.004))
    return [finding for finding in checked.findings if rule_of(finding.rule).severity.value != "note"]


def line_of(program: str, text: str) -> int:
    """The number of the first line that contains `text`."""
    return next(n for n, line in enumerate(program.splitlines(), 1) if text in line)


def test_the_right_program_is_silent(tmp_path: Path) -> None:
    assert found(tmp_path, PROGRAM) == []


@pytest.mark.parametrize(
    ("taken", "instead", "place", "words"),
    [
        ("Pwm_enableTrigger(EPWM_1);", "", "Pwm_trigger(EPWM_1, 2)", "SOCAEN = 0"),
        ("Pwm_trigger(EPWM_1, 2)", "Pwm_trigger(EPWM_1, 0)", "Adc_convertAt(ADC_A", "SOCAPRD = 0"),
        ("Adc_convertAt(ADC_A, 0, 5,", "Adc_convertAt(ADC_A, 0, 7,", "Adc_convertAt(ADC_A", "SOCA of ePWM2"),
        ("Timer_enableInterrupt(TIMER_0);", "", "Timer_start(TIMER_0", "interrupt 1.7 is enabled but never occurs"),
        ("    Irq_enable(ON_TIMER_0);\n", "", "Irq_route(ON_TIMER_0", "Tick never runs for interrupt 1.7"),
        ("    EINT;\n", "", "Irq_enable(ON_TIMER_0)", "no statement executes EINT"),
        ("Adc_enableInterrupt(ADC_A, 0)", "Adc_enableInterrupt(ADC_A, 1)", "Adc_enableInterrupt(ADC_A", "INT1E = 0"),
    ],
)  # fmt: skip
def test_what_is_missing_is_told_at_the_call(
    tmp_path: Path, taken: str, instead: str, place: str, words: str
) -> None:  # fmt: skip
    assert taken in PROGRAM
    program = PROGRAM.replace(taken, instead)
    told = [(f.rule, f.place.line) for f in found(tmp_path, program) if f.place and words in f.message]
    assert told == [("not-connected", line_of(program, place))]


@pytest.mark.parametrize(
    "later",
    [
        "if (Ticks > 60000u) Pwm_enableTrigger(EPWM_1);",   # a call that could still come
        "if (Ticks > 60000u) WORD(Converters[Ticks & 1].base + 0xA4) |= 0x0800u;",   # of which only the offset is known
        "if (Ticks > 60000u) WORD(EPWM_1 + Ticks) |= 0x0800u;",   # of which only the block is known
        "if (Ticks > 60000u) WORD(Converters[0].base + Ticks) |= 0x0800u;",   # of which nothing is known
    ],
)  # fmt: skip
def test_a_write_that_could_still_come_is_none_that_is_missing(tmp_path: Path, later: str) -> None:
    program = PROGRAM.replace("Pwm_enableTrigger(EPWM_1);", "").replace("TURN", later)
    assert [f for f in found(tmp_path, program) if "SOCAEN" in f.message] == []


def test_a_loop_over_the_instances_sets_up_each_of_them(tmp_path: Path) -> None:
    each = "{ int soc; for (soc = 0; soc < 3; soc++) Adc_convertAt(ADC_A, soc, 5, FIRST_INPUT); }"
    program = PROGRAM.replace("Adc_convertAt(ADC_A, 0, 5, FIRST_INPUT);", each)
    assert found(tmp_path, program) == []
    (tmp_path / "again").mkdir()
    told = found(tmp_path / "again", program.replace("Pwm_enableTrigger(EPWM_1);", ""))
    assert sorted(f.object for f in told) == [f"AdcaRegs.ADCSOC{n}CTL.TRIGSEL" for n in range(3)]


def test_a_compare_value_beyond_the_period_is_told_at_the_call(tmp_path: Path) -> None:
    program = PROGRAM.replace("    Pwm_start(", "    Pwm_switch(EPWM_1, 0x12u);\n    Pwm_start(")
    program = program.replace("TURN", "Pwm_compare(EPWM_1, (unsigned int)(5 - (int)(Ticks & 7u)));")
    (finding,) = found(tmp_path, program)
    assert finding.place is not None
    assert (finding.rule, finding.place.line) == ("compare-above-period", line_of(program, "Pwm_compare("))


@pytest.mark.parametrize("layout", ["", "link", "include"])
def test_what_happens_in_a_header_of_a_library_is_told_at_the_call(tmp_path: Path, layout: str) -> None:
    program = PROGRAM.replace("TURN", "if (Sample < 5000u) Ticks = Share(Ticks, Sample - Sample);")
    (finding,) = [f for f in found(tmp_path, program, layout) if f.rule == "division-by-zero"]
    assert finding.place is not None
    assert finding.place.file == str(tmp_path / "program.c")
    assert finding.place.line == line_of(program, "Share(Ticks")
    assert finding.call_path[0] == finding.place
    assert any("ports.h" in detail for detail in finding.details)


def test_a_header_of_ones_own_is_no_library(tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    header = """#include "ports.h"
static inline unsigned int Part(unsigned int all, unsigned int of)
{
    return Share(all, of);
}
"""
    (tmp_path / "own" / "own.h").write_text(header, encoding="utf-8")
    program = PROGRAM.replace('"ports.h"', '"own/own.h"').replace("TURN", "Ticks = Part(Ticks, Sample - Sample);")
    (finding,) = [f for f in found(tmp_path, program) if f.rule == "division-by-zero"]
    assert finding.place is not None
    assert (Path(finding.place.file).name, finding.place.line) == ("own.h", line_of(header, "Share("))


def test_a_wrong_clock_of_the_adc_is_told_where_it_is_set(tmp_path: Path) -> None:
    program = PROGRAM.replace("    Adc_convertAt(", "    Adc_setClock(ADC_A, 2u);\n    Adc_convertAt(")
    (finding,) = found(tmp_path, program)
    assert finding.place is not None
    assert (finding.rule, finding.place.line) == ("adc-clock", line_of(program, "Adc_setClock("))


ELSEWHERE = """#include "F28x_Project.h"
#define WORD(x) (*((volatile unsigned int *)(unsigned long)(x)))
unsigned int Received = 0;

void main(void)
{
    InitSysCtrl();
    WORD(AT) |= 1u;
    WORD(AT + 1) = 3u;
    for (;;) {
        Received += WORD(AT);
        DELAY_US(10);
    }
}
"""


@pytest.mark.parametrize(
    ("at", "whose"),
    [
        ("0x6004ul", "0x6004 belongs to McbspaRegs, which"), ("0x5E90ul", "0x5e90 belongs to Sdfm2Regs, which"),
        ("0x47008ul", "0x47008 belongs to Emif1Regs, which"), ("0x100000ul", "0x100000 belongs to memory at the EMIF1"),
        ("0x4048ul", ""), ("0x5000ul", ""),
    ],
)  # fmt: skip
def test_what_is_not_modelled_and_reached_by_a_number_is_told_once(tmp_path: Path, at: str, whose: str) -> None:
    (tmp_path / "program.c").write_text(ELSEWHERE.replace("AT", at), encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "program.c"], seconds=0.002))
    told = [finding.message for finding in checked.findings if " belongs to " in finding.message]
    assert [message.startswith(whose) for message in told] == ([True] if whose else [])
