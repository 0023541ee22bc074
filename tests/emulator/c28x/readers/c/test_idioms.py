"""One mistake in several idioms: each line that is told says so in a comment, and all other lines are right."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

_LEFT_ON = """#include "F2837xS_Device.h"
#define HIGH() (GpioDataRegs.GPBSET.all = 1UL << 2)
Uint16 In, Got;
static void Cs_Low(void) { GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1; }
static void Valve(Uint16 open)
{
    if (open) GpioDataRegs.GPASET.bit.GPIO7 = 1;
    else GpioDataRegs.GPACLEAR.bit.GPIO7 = 1;
}
static void Show(Uint16 on) { In += on; }
static void motor_einschalten(void) { EPwm2Regs.AQCSFRC.bit.CSFA = 0; }
static void motor_ausschalten(void) { EPwm2Regs.AQCSFRC.bit.CSFA = 1; }
static int By_Masks(Uint16 n)
{
    Cs_Low();
    if (n == 3) return 0;                               // told: not-undone
    if (n == 4) { HIGH(); return 0; }
    HIGH();
    GpioDataRegs.GPADAT.all |= 1UL << 21;
    if (n == 5) return 0;                               // told: not-undone
    if (n == 6) { GpioDataRegs.GPACLEAR.bit.GPIO21 = 1; return 0; }
    GpioDataRegs.GPADAT.all &= ~(1UL << 21);
    EALLOW;
    if (n == 7) return 0;                               // told: not-undone
    if (n == 8) { EDIS; return 0; }
    EDIS;
    return 1;
}
static int By_Calls(Uint16 n)
{
    Valve(1);
    if (n == 3) return 0;                               // told: not-undone
    if (n == 4) { Valve(0); return 0; }
    Valve(0);
    Show(1);
    if (n == 5) return 0;
    Show(0);
    motor_einschalten();
    switch (n) {
    case 6: return 0;                                   // told: not-undone
    case 7: motor_ausschalten(); return 0;
    default: break;
    }
    motor_ausschalten();
    return 1;
}
static int Masked(Uint16 n)
{
    IER &= ~M_INT9;
    if (n == 3) return 0;                               // told: not-undone
    IER |= M_INT9;
    // Nobody else lets this one through: it may be for good that it stays off.
    IER &= ~M_INT3;
    if (n == 4) return 0;
    IER |= M_INT3;
    return 1;
}
static int Busy(Uint16 *busy, Uint16 n)
{
    *busy = 1;
    if (n == 3) { *busy = 0; return 0; }
    if (n == 4) return 0;                               // told: not-undone
    *busy = 0;
    return 1;
}
int main(void)
{
    IER |= M_INT9;
    for (;;) { By_Masks(In); By_Calls(In); Masked(In); Busy(&Got, In); In++; }
}
"""

_STATES = """#include "F2837xS_Device.h"
typedef enum { REST, FILL, HEAT, FAULT } STATE;
static struct { STATE state; Uint16 ms; } Plant;
Uint16 In;
static void Pump_Off(void) { GpioDataRegs.GPACLEAR.bit.GPIO5 = 1; }
static void Enter(STATE next) { Plant.state = next; Plant.ms = 0; }
int main(void)
{
    for (;;) {
        In++;
        switch (Plant.state) {
        case REST: if (In == 1) Enter(FILL); break;
        case FILL: if (In == 2) { Pump_Off(); Enter(FAULT); } else if (In == 3) Enter(HEAT); break;
        case HEAT:
            if (In == 4) { Pump_Off(); Enter(FAULT); }
            if (In == 5) { Enter(FAULT); }              // told: entrance-differs
            if (In == 6) { Pump_Off(); Enter(FAULT); }
            break;
        case FAULT: if (Plant.ms++ > 900) Enter(REST); break;
        }
    }
}
"""

_MEMBERS = """#include "F2837xS_Device.h"
typedef struct { Uint16 lost, sent, late; } LINK;
static LINK Link, Copied, Pointed, Passed;
static struct { Uint16 on : 1; Uint16 bright : 4; } Lamp = { 1, 7 };
static Uint16 Errors[3];
Uint16 In, Out;
static void Count(LINK *link) { link->lost++; }
static Uint16 Of(const LINK *link) { return link->sent; }
int main(void)
{
    LINK here;
    for (;;) {
        In = (Uint16)GpioDataRegs.GPADAT.all;
        if (In == 1) Link.lost++; else Link.lost = 0;   // told: one-sided
        if (In == 2) ++Link.sent; else Link.sent = 0;
        if (Link.sent > 3) Out = 1;
        if (Link.late > 3) Out = 2;                     // told: one-sided
        Lamp.on = In == 4;
        if (Lamp.on && Lamp.bright > 3) Out = 3;
        if (In == 5) Errors[1]++; else Errors[1] = 0;   // told: one-sided
        if (In == 6) Errors[2]++;
        if (Errors[2] > 9) Out = 4;                     // told: one-sided
        if (In == 7) Copied.lost++; else Copied.lost = 0;
        here = Copied;
        Out = here.lost;
        if (In == 8) Pointed.sent++; else Pointed.sent = 0;   // told: one-sided
        Count(&Pointed);
        if (In == 9) Passed.sent++; else Passed.sent = 0;
        Out += Of(&Passed) + Of(&Copied);
    }
}
"""


_CONDITIONS = """#include "F2837xS_Device.h"
#define READY 0x10u
#define FAULT 0x20u
#define LEVEL 4
#define IN_RANGE(v, lo, hi) ((lo) <= (v) && (v) <= (hi))
enum { RUN = 1, HALT = 3 };
Uint16 Status, Mode, Hot, Out;
static Uint16 Pressed(Uint16 m) { return (GpioDataRegs.GPADAT.all & m) ? 1 : 0; }
static Uint16 Octet(void) { return SciaRegs.SCIRXBUF.all & 0xFF; }
static Uint16 Send(void) { return HALT; }
static void Work(void)
{
    if (Pressed(READY) == READY) Out++;                 // told: constant-condition
    if (Pressed(READY) == 1) Out++;
    if (Octet() == 0x1FF) Out++;                        // told: constant-condition
    if (Octet() == 0xFF || Octet() == -1) Out++;
    if (Send() == RUN) Out++;
    if ((GpioDataRegs.GPADAT.all & 0x0F00UL) == 0xFUL) Out++;   // told: constant-condition
    if ((GpioDataRegs.GPADAT.all >> 8 & 0xFUL) == 0xFUL) Out++;
    if (IN_RANGE(Hot, 90, 10)) Out++;                   // told: constant-condition
    if (IN_RANGE(Hot, 10, 90)) Out++;
    if (Status && FAULT) Out++;                         // told: constant-condition
    if (Status & FAULT) Out++;
    if (Mode == RUN || HALT) Out++;                     // told: constant-condition
    if (Mode == RUN && LEVEL) Out++;
    if (~(Status & READY)) Out++;                       // told: constant-condition
    if (!(Status & READY)) Out++;
    if (!Status & FAULT) Out++;                         // told: mixed-logic
    if (!Status & 1) Out++;
}
static void Choose(void)
{
    switch (Mode) {
    case RUN:
        Out = 1;
        break;
        Status = 0;                                     // told: unreachable
    case HALT: { Out = 2; break; }
        break;
    default:
        Out = 3;
        break;
    }
}
int main(void) { for (;;) { Status++; Mode++; Hot++; Work(); Choose(); } }
"""

_STATEMENTS = """#include "F2837xS_Device.h"
Uint16 a, b, c;
static void Trip(void) { c++; }
static void (*Call)(void);
int main(void)
{
    for (;;) {
        a++;
        Trip;                                           // told: idle-statement
        Trip();
        -a;                                             // told: idle-statement
        (void)a;
        b = (c = 0) ? 3 : 4;                            // told: assigned-condition
        b = (c = a) ? 3 : 4;
        if (a > 2 && (GpioDataRegs.GPADAT.bit.GPIO3 = 1)) b++;  // told: assigned-condition
        if (a > 2 && (c = a) != 0) b++;
        if (!(c = 2)) b++;                              // told: assigned-condition
        if (!(c = a)) b++;
        Call = Trip;
        Call();
    }
}
"""


@pytest.mark.parametrize(
    "text", [_LEFT_ON, _STATES, _MEMBERS, _CONDITIONS, _STATEMENTS],
    ids=["left on", "states", "members", "conditions", "statements"],
)  # fmt: skip
def test_a_mistake_is_told_in_each_idiom(tmp_path: Path, text: str) -> None:
    file = tmp_path / "a.c"
    file.write_text(text, encoding="utf-8")
    lines = text.splitlines()
    expected = {(n, line.split("// told: ")[1]) for n, line in enumerate(lines, 1) if "// told: " in line}
    rules = {rule for _, rule in expected}
    found = {(f.place.line, f.rule) for f in Build([str(file)]).compiled.findings}
    assert {each for each in found if each[1] in rules} == expected
