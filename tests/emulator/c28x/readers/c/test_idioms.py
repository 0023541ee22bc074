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


_COPIES = """#include "F2837xS_Device.h"
typedef struct { int now, old, speed; } AXIS;
AXIS Axes[3], Main;
int Speed, Index;
volatile AXIS Shared;
#define KEEP(a) ((a).old = (a).now)
static void By_Pointer(AXIS *a) { a->old = a->now; a->speed = 1; Speed = a->now - a->old; }    // told: own-copy
static void Element(int i) { KEEP(Axes[i]); Axes[i].speed = Axes[i].now - Axes[i].old; }       // told: own-copy
static void Sign(unsigned u) { int s = u; Speed = u - s; }                                    // told: own-copy
static void Wide(unsigned u) { int s = u; Speed = ((long)u - (long)s) >> 8; }
static void Other(int i) { KEEP(Axes[i]); i++; Speed = Axes[i].now - Axes[i].old; }
static void Moved(int i) { KEEP(Axes[i]); Axes[Index].now = 3; Speed = Axes[i].now - Axes[i].old; }
static void Alias(AXIS *a, AXIS *b) { a->old = a->now; b->now = 3; Speed = a->now - a->old; }
static void Watched(volatile AXIS *a) { a->old = a->now; Speed = a->now - a->old; }
static void Right(AXIS *a, int now) { a->old = a->now; a->now = now; Speed = a->now - a->old; }
int main(void)
{
    for (;;) {
        By_Pointer(&Main); Element(Index); Sign(Speed); Wide(Speed); Other(0); Moved(1); Alias(&Main, &Axes[2]);
        Watched(&Shared); Right(&Main, Speed++); Index = Speed & 1;
    }
}
"""

_STORES = """#include "F2837xS_Device.h"
typedef struct { Uint16 raw, mean, most; } CHANNEL;
CHANNEL Channels[3];
Uint16 In, Out;
static void Level(Uint16 v) { DacaRegs.DACVALS.all = v; }
static void Twice(CHANNEL *c, Uint16 v)
{
    c->mean = (c->mean + v) >> 1;                       // told: dead-store
    c->mean = v;
    c->raw = v;
    c->raw = c->raw >> 1;
}
static void Limit(Uint16 i)
{
    CHANNEL c = Channels[i], d = Channels[i];
    if (c.raw > c.most) c.raw = c.most;                 // told: dead-store
    if (d.raw > d.most) d.raw = d.most;
    Channels[i] = d;
}
static void Choose(Uint16 kind, Uint16 *red, Uint16 *green)
{
    switch (kind) {
    case 1: *red = 100; *green = 0;                     // told: case-falls
    case 2: *red = 0; *green = 100; break;
    case 3: EPwm1Regs.CMPA.all = 300UL << 16;           // told: case-falls
    case 4: EPwm1Regs.CMPA.all = 900UL << 16; break;
    case 5: EPwm1Regs.CMPA.all = 0; // fall through
    case 6: EPwm1Regs.CMPA.all = 100; break;
    case 7: EPwm1Regs.TZCLR.all = 1;
    default: EPwm1Regs.TZCLR.all = 4; break;
    }
    switch (kind) {
    case 1: Level(100); break;
    case 2: Level(2000);                                // told: case-falls
    case 3: Level(4000); break;
    case 4: Level(4095); break;
    default: Level(0); break;
    }
}
int main(void) { for (;;) { Twice(&Channels[1], In++); Limit(In & 1); Choose(In & 7, &Out, &In); } }
"""

_LIKES = """#include "F2837xS_Device.h"
typedef struct { Uint16 kp, ki, most, sum; } PID;
static PID Pids[3], A, B, C;
static void Gains(PID *p, Uint16 kp) { p->kp = kp; p->ki = 1; }
static void Most(PID *p, Uint16 most) { p->most = most; }
static void Clear(PID *p) { p->sum = 0; }
static void Elements(void)
{
    Pids[0].kp = 3; Pids[0].ki = 1; Pids[0].most = 9;
    Pids[1].kp = 3; Pids[1].ki = 1; Pids[1].most = 9;
    Pids[2].kp = 3; Pids[2].ki = 1;                     // told: like-but-one
}
static void Calls(void)
{
    Gains(&A, 2); Most(&A, 5); Clear(&A);
    Gains(&B, 4); Most(&B, 5); Clear(&B);
    Gains(&C, 4); Clear(&C);                            // told: like-but-one
}
static void Blocks(void)
{
    volatile struct EPWM_REGS *p = &EPwm4Regs, *q = &EPwm5Regs, *r = &EPwm6Regs;
    p->TBPRD = 25; p->TBCTL.all = 0; p->AQCTLA.all = 18; p->DBCTL.all = 3;
    q->TBPRD = 25; q->TBCTL.all = 0; q->AQCTLA.all = 18; q->DBCTL.all = 3;
    r->TBPRD = 25; r->TBCTL.all = 0; r->AQCTLA.all = 18;    // told: like-but-one
}
int main(void)
{
    Elements(); Calls(); Blocks();
    for (;;) EPwm4Regs.TBPRD = Pids[2].most + Pids[1].sum;
}
"""

_INPUTS = """#include "F2837xS_Device.h"
static char Line[32];
static struct { char text[20]; Uint16 length; } Order, Limited;
static Uint16 At;
Uint16 Out;
static void Any(char c)
{
    switch (c) {
    case 13: Line[At] = 0; At = 0; Out = Line[0]; break;
    default: Line[At++] = c; break;                     // told: line-unlimited
    }
}
static void Member(Uint16 c)
{
    if (c == 13u) { Order.length = 0; Out = Order.text[0]; return; }
    Order.text[Order.length] = (char)c;                 // told: line-unlimited
    Order.length = Order.length + 1u;
}
static void Right(Uint16 c)
{
    if (c == 13u) { Limited.length = 0; Out = Limited.text[0]; return; }
    if (Limited.length < 20u) Limited.text[Limited.length++] = (char)c;
}
int main(void)
{
    EALLOW;
    GpioCtrlRegs.GPADIR.all &= ~(1UL << 13);            // told: input-unused
    GpioCtrlRegs.GPADIR.all &= ~(1UL << 14);
    GpioCtrlRegs.GPBDIR.all &= ~(1UL << 3);
    GpioCtrlRegs.GPADIR.all |= 1UL << 5;
    EDIS;
    for (;;) {
        Any((char)SciaRegs.SCIRXBUF.all); Member(SciaRegs.SCIRXBUF.all); Right(SciaRegs.SCIRXBUF.all);
        GpioDataRegs.GPADAT.all |= 1UL << 5;
        if (GpioDataRegs.GPADAT.all & (1UL << 14)) Out = 3;
        if (GpioDataRegs.GPBDAT.all == 8) Out = 4;
    }
}
"""


@pytest.mark.parametrize(
    "text", [_LEFT_ON, _STATES, _MEMBERS, _CONDITIONS, _STATEMENTS, _COPIES, _STORES, _LIKES, _INPUTS],
    ids=["left on", "states", "members", "conditions", "statements", "copies", "stores", "likes", "inputs"],
)  # fmt: skip
def test_a_mistake_is_told_in_each_idiom(tmp_path: Path, text: str) -> None:
    file = tmp_path / "a.c"
    code, marks = zip(*(line.partition("// told: ")[::2] for line in text.splitlines()), strict=True)
    file.write_text("\n".join(code) + "\n", encoding="utf-8")
    expected = {(n, mark) for n, mark in enumerate(marks, 1) if mark}
    rules = {rule for _, rule in expected}
    found = {(f.place.line, f.rule) for f in Build([str(file)]).compiled.findings}
    assert {each for each in found if each[1] in rules} == expected
