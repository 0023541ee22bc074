"""What the program does on most ways and leaves out on one: the one that is told, and right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build


def told(folder: Path, rule: str, text: str) -> list[str]:
    """The lines at which a rule is told."""
    file = folder / "a.c"
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == rule]


READS = """typedef unsigned int Uint16;
enum {{ FAILED, DONE }};
Uint16 In, Duty, Tries;
static int Read(Uint16 *x)
{{
    {read}
}}
static int Twice(void)
{{
    Uint16 v;
    if (!Read(&v)) {{
        {failed}
        return 0;
    }}
    return Read(&v);
}}
static void Drive(void)
{{
    Uint16 v = 0;
    {drive}
    Duty = v;
}}
{more}
int main(void)
{{
    for (;;) {{ Twice(); Drive(); }}
}}
"""
READ = "if (In == 3) return FAILED; *x = In; return DONE;"


def dropped(folder: Path, drive: str = "Read(&v);", **given: str) -> list[str]:
    parts = {"read": READ, "failed": "Duty = 0;", "more": "", "drive": drive, **given}
    return told(folder, "result-dropped", READS.format(**parts))


@pytest.mark.parametrize("given", [
    {}, {"read": "if (In == 3) return -1; *x = In; return 0;"}, {"read": "*x = In; return In != 3;"},
    {"read": "int ok = 0; if (In != 3) { *x = In; ok = 1; } return ok;"},
    {"read": "*x = In; return In > 3 ? DONE : FAILED;"}, {"read": "*x = In; return Sure();", "more": ""},
])  # fmt: skip
def test_a_result_that_the_other_calls_look_at_is_told(tmp_path: Path, given: dict[str, str]) -> None:
    if "Sure" in given.get("read", ""):
        sure = "static int Sure(void);\nstatic int Read"
        text = READS.replace("static int Read", sure, 1)
        text = text.replace("{more}", "static int Sure(void) {{ return In != 3; }}")
        parts = {"failed": "Duty = 0;", "drive": "Read(&v);", **given}
        assert told(tmp_path, "result-dropped", text.format(**parts)) == ["Read(&v);"]
    else:
        assert dropped(tmp_path, **given) == ["Read(&v);"]


@pytest.mark.parametrize(("drive", "given"), [
    ("if (!Read(&v)) v = 0;", {}), ("(void) Read(&v);", {}),
    # A branch that gives up anyway; two that drop it; a number, a function that cannot fail, one that is pointed to.
    ("if (Read(&v)) Tries++;", {"failed": "Read(&v);"}), ("Read(&v); Read(&v);", {}),
    ("Read(&v);", {"read": "*x = In; return In;"}), ("Read(&v);", {"read": "*x = In; return DONE;"}),
    ("Read(&v);", {"more": "int (*Reader)(Uint16 *) = Read; static void Set(void) { Reader = Read; }"}),
])  # fmt: skip
def test_a_result_that_is_looked_at_or_meant_is_silent(tmp_path: Path, drive: str, given: dict[str, str]) -> None:
    assert dropped(tmp_path, drive, **given) == []


STATES = """#include "F2837xS_Device.h"
typedef enum {{ REST, RUN, HOLD, FAULT }} STATE;
static STATE state = REST;
static Uint16 stateMs = 0, seenMs = 0, now = 0;
Uint16 In, Lamp;
volatile Uint16 Out;
static void Motor_Off(void) {{ Out = 0; }}
static void Fail(void) {{ {fail} }}
static void Step(void)
{{
    {first}
    {count}
    switch (state) {{
    case REST:
        if (In == 1) {{ state = RUN; {begin} }}
        if (In == 2) {{ state = HOLD; {begin} }}
        break;
    case RUN:
        if ({over}) {{ Motor_Off(); state = FAULT; {begin} }}
        if (In == 5) {{ Motor_Off(); state = FAULT; {begin} }}
        {way}
        break;
    case HOLD:
        {hold}
        if ({over}) {{ state = RUN; {begin} }}
        if (In == 6) {{ Motor_Off(); state = FAULT; {begin} }}
        break;
    default:
        {fault}
        if ({over}) {{ state = REST; {begin} }}
        break;
    }}
}}
int main(void)
{{
    {start}
    for (;;) {{ now++; Step(); {turn} }}
}}
"""
GIVEN = {
    "first": "", "count": "stateMs++;", "begin": "stateMs = 0;", "over": "stateMs > 300", "way": "", "hold": "",
    "fault": "Lamp = 1;", "start": "", "turn": "", "fail": "",
}  # fmt: skip
STAMP = {"count": "", "begin": "stateMs = now;", "over": "now - stateMs > 300"}


def differs(folder: Path, **given: str) -> list[str]:
    text = STATES.format(**{**GIVEN, **given})
    return told(folder, "entrance-differs", text) + told(folder, "not-begun-again", text)


@pytest.mark.parametrize(("way", "given"), [
    ("if (In == 7) { state = HOLD; }", {}),
    ("if (In == 7) { state = HOLD; }", STAMP),
    ("if (In == 9) { state = FAULT; stateMs = 0; }", {}),
    ("if (In == 9) { Lamp = 1; state = FAULT; stateMs = 0; }", {}),
    ("if (In == 7) { seenMs = 0; state = HOLD; }", {"turn": "if (seenMs) seenMs--;"}),
])  # fmt: skip
def test_an_entrance_that_leaves_something_out_is_told(tmp_path: Path, way: str, given: dict[str, str]) -> None:
    assert differs(tmp_path, way=way, **given) == [way]


@pytest.mark.parametrize("given", [
    {}, {"way": "if (In == 7) { state = HOLD; stateMs = 0; }"},
    {"way": "if (In == 7) { Motor_Off(); Lamp = 1; state = FAULT; stateMs = 0; }"},
    # On the way, in a function, in the state itself, by the caller, and a time that anything else begins.
    {"way": "if (In == 7) { if (Lamp) Motor_Off(); state = FAULT; stateMs = 0; }"},
    {"way": "if (In == 7) { Fail(); state = FAULT; stateMs = 0; }", "fail": "Motor_Off();"},
    {"way": "if (In == 7) { state = FAULT; stateMs = 0; }", "fault": "Motor_Off();"},
    {"way": "if (In == 7) { state = FAULT; stateMs = 0; }", "turn": "Motor_Off();"},
    {"way": "if (In == 7) { state = HOLD; }", "first": "if (In == 0) stateMs = 0;"},
    # The state has no time, and no other entrance; it is entered before the loop.
    {"way": "if (In == 7) { state = HOLD; }", "over": "In == 8"}, {"start": "state = FAULT;"},
])  # fmt: skip
def test_entrances_that_do_the_same_are_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert differs(tmp_path, **given) == []


UNDONE = """#include "F2837xS_Device.h"
static volatile Uint16 Busy = 0;
Uint16 In, Got;
static void Motor_On(void) {{ GpioDataRegs.GPASET.bit.GPIO5 = 1; }}
static void Motor_Off(void) {{ GpioDataRegs.GPACLEAR.bit.GPIO5 = 1; }}
static int GiveUp(void) {{ GPIO_WritePin(7, 1); Motor_Off(); Busy = 0; return 0; }}
static int Work(void)
{{
    {work}
    return 1;
}}
int main(void)
{{
    for (;;) {{ {turn} }}
}}
"""


def left_on(folder: Path, work: str, turn: str = "Work(); GiveUp();") -> list[str]:
    turn = turn.replace(" GiveUp();", "") + " if (In == 99) Motor_On();"
    return told(folder, "not-undone", UNDONE.format(work="\n    ".join(work.split("|")), turn=turn))


@pytest.mark.parametrize("work", [
    "GPIO_WritePin(7, 0);|if (In == 3)|return 0;|Got = In;|GPIO_WritePin(7, 1);",
    "GpioDataRegs.GPACLEAR.bit.GPIO7 = 1;|if (In == 3)|return 0;|GpioDataRegs.GPASET.bit.GPIO7 = 1;",
    "GpioDataRegs.GPADAT.bit.GPIO7 = 0;|if (In == 3)|return 0;|GpioDataRegs.GPADAT.bit.GPIO7 = 1;",
    "Motor_On();|while (In != 9) {|if (In == 8)|return 0;|}|Motor_Off();",
    "Busy = 1;|if (In == 4) { Busy = 0; return 1; }|if (In == 5)|return 0;|Busy = 0;",
])  # fmt: skip
def test_a_return_that_leaves_something_on_is_told(tmp_path: Path, work: str) -> None:
    assert left_on(tmp_path, work) == ["return 0;"]


@pytest.mark.parametrize(("work", "turn"), [
    ("GPIO_WritePin(7, 0);|if (In == 3) { GPIO_WritePin(7, 1); return 0; }|GPIO_WritePin(7, 1);", "Work();"),
    ("GPIO_WritePin(7, 0);|if (In == 3) return GiveUp();|GPIO_WritePin(7, 1);", "Work();"),
    ("GPIO_WritePin(7, 0);|if (In == 3) return 0;|GPIO_WritePin(7, 1);", "if (!Work()) GPIO_WritePin(7, 1);"),
    ("if (In == 3) return 0;|GPIO_WritePin(7, 0);|Got = In;|GPIO_WritePin(7, 1);", "Work();"),
    ("Motor_On();|if (In == 3) { Motor_Off(); return 0; }|Motor_Off();", "Work();"),
    # All went well: an object that says so only at the end.
    ("Busy = 1;|if (In == 3) return 0;|Got = In;|Busy = 0;", "Work();"),
])  # fmt: skip
def test_what_is_undone_on_every_way_is_silent(tmp_path: Path, work: str, turn: str) -> None:
    assert left_on(tmp_path, work, turn) == []


LIKES = """#include "F2837xS_Device.h"
typedef struct {{ Uint16 duty; Uint16 on; int integral; }} WHEEL;
static WHEEL a, b, c;
Uint16 Sum;
static void Off(void)
{{
    a.duty = 0; a.on = 0; a.integral = 0;
    {second}
    c.duty = 0; c.on = 0; c.integral = 0;
}}
static void Init(void)
{{
    EPwm1Regs.TBPRD = 100; EPwm1Regs.CMPA.bit.CMPA = 4; EPwm1Regs.AQCTLA.bit.ZRO = 2; EPwm1Regs.TBPHS.bit.TBPHS = 9;
    EPwm2Regs.TBPRD = 100; EPwm2Regs.CMPA.bit.CMPA = 4; EPwm2Regs.AQCTLA.bit.ZRO = 2; EPwm2Regs.TBPHS.bit.TBPHS = 9;
    {third}
}}
int main(void)
{{
    Init();
    {more}
    for (;;) {{ Off(); a.on = b.on = c.on = 2; Sum = a.duty + b.integral++; a.integral++; c.integral++; }}
}}
"""
SECOND = "b.duty = 0; b.on = 0; b.integral = 0;"
LACKS = "EPwm3Regs.TBPRD = 100; EPwm3Regs.AQCTLA.bit.ZRO = 2; EPwm3Regs.TBPHS.bit.TBPHS = 9;"
THIRD = LACKS + " EPwm3Regs.CMPA.bit.CMPA = 4;"


@pytest.mark.parametrize(("given", "line"), [
    ({"second": "b.duty = 0; b.on = 0;"}, "b.duty = 0; b.on = 0;"), ({"third": LACKS}, LACKS),
])  # fmt: skip
def test_the_one_of_several_that_lacks_a_step_is_told(tmp_path: Path, given: dict[str, str], line: str) -> None:
    text = LIKES.format(**{"second": SECOND, "third": THIRD, "more": "", **given})
    assert told(tmp_path, "like-but-one", text) == [line]


@pytest.mark.parametrize("given", [
    {}, {"third": LACKS, "more": "EPwm3Regs.CMPA.bit.CMPA = 7;"}, {"third": LACKS + " EPwm3Regs.DBRED.bit.DBRED = 2;"},
    {"third": "EPwm3Regs.TBPRD = 100; EPwm3Regs.CMPA.bit.CMPA = 4; EPwm3Regs.AQCTLA.bit.ZRO = 2;"},  # it has no phase
    {"third": "EPwm3Regs.TBPRD = 100;"}, {"second": "b.duty = 0;"}, {"second": ""},
])  # fmt: skip
def test_like_things_or_others_are_silent(tmp_path: Path, given: dict[str, str]) -> None:
    text = LIKES.format(**{"second": SECOND, "third": THIRD, "more": "", **given})
    assert told(tmp_path, "like-but-one", text) == []


SPAN = """typedef unsigned int Uint16;
static Uint16 passMs = 0;
int Position, Speed, Stuck;
int Go(void)
{{
    int watched = Position, last = 0;
    Uint16 ms = 0;
    for (;;)
    {{
        int now = Position;
        ms += 2;
        passMs++;
        {look}
    }}
}}
int main(void)
{{
    for (;;) {{ Go(); }}
}}
"""


@pytest.mark.parametrize("look", [
    "if (ms >= 100) { if (now - watched < 3) return 0; watched = now; }",
    "if (100 <= ms) { Speed = now - last; last = now; }",
    "if (passMs > 50) { Speed = now - last; last = now; }",
])  # fmt: skip
def test_a_difference_over_a_time_that_is_not_begun_again_is_told(tmp_path: Path, look: str) -> None:
    assert told(tmp_path, "not-begun-again", SPAN.format(look=look)) == [look]


@pytest.mark.parametrize("look", [
    "if (ms >= 100) { if (now - watched < 3) return 0; watched = now; ms = 0; }",
    "if (ms >= 100) { Speed = now - last; last = now; ms -= 100; }",
    "if (passMs > 50) { Speed = now - last; last = now; passMs = 0; }",
    # A limit that ends the loop, a start that is over, a difference that is not remembered.
    "if (ms >= 100) { Stuck = now - watched < 3; watched = now; return 0; }",
    "if (ms >= 100) { Speed = now - last; } last = now;", "if (ms < 100) { Speed = now - last; last = now; }",
])  # fmt: skip
def test_a_difference_over_a_time_that_begins_again_is_silent(tmp_path: Path, look: str) -> None:
    assert told(tmp_path, "not-begun-again", SPAN.format(look=look)) == []


RING = """typedef unsigned int Uint16;
#define SIZE 16
static volatile Uint16 ring[SIZE], in = 0, arrived = 0, held = 0;
static Uint16 out = 0;
Uint16 Reg, Last;
interrupt void Received(void)
{{
    ring[in] = Reg;
    in = (in + 1) {around};
    {flag}
}}
static void Take(void) {{ Last = ring[out]; out = (out + 1) {around}; }}
int main(void)
{{
    for (;;)
    {{
        {turn}
    }}
}}
"""
ONE = "if (arrived) { arrived = 0; Take(); }"


@pytest.mark.parametrize(("turn", "around"), [
    (ONE, "& (SIZE - 1)"), (ONE, "% SIZE"), ("if (arrived != 0) { Last = ring[out++]; arrived = 0; }", "& 15"),
    ("if (arrived == 1 ) { arrived = 0; if (Last != 3) { Take(); } }", "% 16"),
    ("while (!arrived) ; arrived = 0; Take();", "& 15"),
    ("if (arrived == 0) continue; arrived = 0; Take();", "& 15"),
])  # fmt: skip
def test_one_element_for_a_flag_is_told(tmp_path: Path, turn: str, around: str) -> None:
    text = RING.format(turn=turn, around=around, flag="arrived = 1;")
    assert told(tmp_path, "one-for-many", text) == [turn]


@pytest.mark.parametrize(("turn", "flag"), [
    ("if (arrived) { arrived = 0; while (out != in) Take(); }", "arrived = 1;"),
    ("if (out != in) Take();", "arrived = 1;"),
    ("if (arrived) { arrived = 0; Take(); } else if (((in - out) & 15) > 0) Take();", "arrived = 1;"),
    ("if (held) { held--; Take(); }", "held++;"),
    # It says itself that there is more; or the routine waits until the flag is cleared.
    ("if (arrived) { arrived = 0; Take(); if (held) arrived = 1; }", "arrived = 1;"),
    ("if (arrived) { arrived = 0; Take(); }", "if (arrived) return; arrived = 1;"),
    ("if (arrived) { Uint16 i; arrived = 0; for (i = 0; i < 8; i++) Take(); }", "if (in == 8) arrived = 1;"),
])  # fmt: skip
def test_a_ring_that_is_emptied_is_silent(tmp_path: Path, turn: str, flag: str) -> None:
    assert told(tmp_path, "one-for-many", RING.format(turn=turn, around="& 15", flag=flag)) == []
