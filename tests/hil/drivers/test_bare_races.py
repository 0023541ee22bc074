"""Races of programs without a kernel: `main` against a routine of the vector table."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files
from tests.emulator.drivers import with_ticks

HEAD = """#include "F28x_Project.h"
#include <string.h>
struct TIME { Uint16 hours; Uint16 minutes; };
volatile Uint16 Count, Waiting, Head, Tail, Ready, Flags, Bytes[8];
volatile struct { Uint16 head; Uint16 tail; Uint16 words[8]; } Ring;
volatile Uint32 Millis; volatile struct TIME Now; struct TIME Seen; Uint16 Words[8], Sum; Uint32 Copy;
Uint16 Halves[2][4], Half; volatile Uint16 Full[2] = {1, 1}; Uint16 * volatile Fill = Halves[0];
volatile struct { Uint16 running; int16 way; int32 togo, place, ramp; } Motor;
volatile long long Odometer; long long Total;
volatile struct ARM { Uint16 angle, speed, wanted, late; } Arm;
"""

#: A routine that works while a flag is up, in the same structure.
STEPPED = "Motor.place += Motor.way; Motor.ramp++; if (--Motor.togo <= 0) Motor.running = 0;"
STEP = f"if (Motor.running) {{ {STEPPED} }}"
RETURN = f"if (!Motor.running) {{ PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; return; }} {STEPPED}"
START = "Motor.way = Sum & 8 ? 1 : -1; Motor.togo = 30; Motor.ramp = 0; Motor.running = 1;"
#: A routine that sets some members of a structure with a name.
MOVE = "Arm.speed = Arm.wanted + 1; Arm.angle += Arm.speed;"

MAIN = """
void main(void)
{
""" + with_ticks(50) + """    for (;;) {
        DELAY_US(30);
        Turn();
    }
}
"""


def told(routine: str, turn: str, folder: Path) -> list[tuple[str, str]]:
    """Rule and object of races, with `routine` each 50 us and `turn` each 30 us."""
    text = (
        f"{HEAD}__interrupt void Tick(void)\n{{\n    {routine}\n    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;\n}}\n"
        f"static void Turn(void)\n{{\n    {turn}\n}}\n{MAIN}"
    )
    file = folder / "bare.c"
    file.write_text(text, encoding="utf-8")
    findings = check_files(DriverFiles([file], seconds=0.005)).findings
    return [
        (finding.rule, finding.object.partition(".")[2]) for finding in findings
        if finding.rule.startswith(("race", "unmasked")) and finding.how == "dynamic"
    ][-1:]  # fmt: skip


@pytest.mark.parametrize(
    ("routine", "turn", "found"),
    [
        ("Count++;", "Count--;", [("race", "Count")]),
        ("Flags |= 1;", "Flags &= ~2;", [("race", "Flags")]),
        ("Flags |= 1;", "Sum = Flags; Flags = 0;", [("race", "Flags")]),  # read and cleared, by two statements
        ("Count++;", "Uint16 n = Count; Count = 0; Sum += n;", [("race", "Count")]),
        ("Millis++;", "Millis = Millis + 1000;", [("race", "Millis")]),
        # Used and cleared, with others in between.
        ("Count++;", "Sum = Count * 6; Count = 0;", [("race", "Count")]),
        ("Count++; Millis++;", "Copy = Millis; Sum = Count; Millis = 0; Words[0] = Sum;", [("race", "Millis")]),
        ("Now.minutes++;", "Uint16 n; n = 60 * Now.minutes; Now.minutes = 0; Sum = n;", [("race", "Now")]),
        ("Now.minutes++; Now.hours++;", "Sum = Now.hours * 60 + Now.minutes;", [("race", "Now")]),
        ("Now.minutes++; Now.hours++;", "Seen.hours = Now.hours; Seen.minutes = Now.minutes;", [("race", "Now")]),
        ("Uint16 i; for (i = 0; i < 8; i++) Sum += Words[i];", "memset(Words, 1, 8);", [("race", "Words")]),
        # An hour ends in no run as short as this; the text of the routine says that both are carried.
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }", "Sum = Now.hours * 60 + Now.minutes;",
         [("race", "Now")]),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }",
         "Uint16 h = Now.hours, m = Now.minutes; Sum = h * 60 + m;", [("race", "Now")]),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }",
         "struct TIME t; t = Now; Sum = t.hours * 60 + t.minutes;", [("race", "Now")]),
        ("if (++Count == 9999) { Now.minutes = Sum; Now.hours = 3; }",
         "struct TIME *p = &Seen; p->hours = Now.hours; p->minutes = Now.minutes;", [("race", "Now")]),
        # Main comes right behind the run that tells it something; the routine goes on in the others.
        ("Now.minutes++; Now.hours += 2; if ((++Count & 3) == 0) Ready = 1;",
         "while (!Ready) ; Ready = 0; Sum = Now.hours * 60 + Now.minutes;", [("race", "Now")]),
        ("Now.minutes++;", "volatile struct TIME *p = &Now; Sum = p->minutes; p->minutes = 0;", [("race", "Now")]),
        # The ring is never full in this run.
        ("if (((Head + 1) & 7) == Tail && Count > 999) Tail = (Tail + 1) & 7;", "Tail = (Tail + 1) % 8;",
         [("race", "Tail")]),
        # The half that is played is filled: main does not ask the flags.
        ("Sum += Halves[Half][Head]; if (++Head == 4) { Head = 0; Full[Half] = 0; Half ^= 1; }",
         "Uint16 h, i; for (h = 0; h < 2; h++) { for (i = 0; i < 4; i++) Halves[h][i] = i; Full[h] = 1; }",
         [("race", "Halves")]),
        # Two halves: main uses the one that the routine uses too, or it is too slow.
        ("Halves[Half][Head] = Count; if (++Head == 4) { Head = 0; Half ^= 1; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Sum += Halves[Half][i]; }", [("race", "Halves")]),
        ("Fill[Head] = Count; if (++Head == 4) { Head = 0; Fill = Halves[Half ^= 1]; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Sum += Fill[i]; }", [("race", "Halves")]),
        ("Halves[Half][Head] = Count; if (++Head == 4) { Head = 0; Half ^= 1; Ready = 1; }",
         "Uint16 i, h; if (Ready) { Ready = 0; h = Half ^ 1;"
         " for (i = 0; i < 4; i++) { Sum += Halves[h][i]; DELAY_US(120); } }",
         [("race", "Halves")]),
        ("Sum += Halves[Half][Head]; if (++Head == 4) { Head = 0; Half ^= 1; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Halves[Half][i] = i; }", [("race", "Halves")]),
        # An array of data hands nothing over.
        ("Uint16 i; for (i = 0; i < 8; i++) Words[i] = Count;", "Uint16 i; for (i = 0; i < 8; i++) Sum += Words[i];",
         [("race", "Words")]),
        # Samples of which main adds up only some; or two in one run.
        ("Words[Head] = Count; Head = (Head + 1) & 7;",
         "Uint16 i; for (i = 0; i < 8; i++) if (Words[i] > 3) Sum += Words[i];", [("race", "Words")]),
        ("Words[Head] = Count; Words[Head ^ 1] = Count; Head = (Head + 2) & 7;",
         "Uint16 i; for (i = 0; i < 8; i++) Sum += Words[i];", [("race", "Words")]),
        # Shown in turn, but two in one run; or main sets which one comes next, so that it knows what is complete.
        ("static Uint16 digit; digit = (digit + 1) & 3; Sum = Words[digit] + Words[digit + 4];",
         "Uint16 i; for (i = 0; i < 8; i++) Words[i] = i;", [("race", "Words")]),
        ("Sum = Words[Head]; Head = (Head + 1) & 7;",
         "Uint16 i; for (i = 0; i < 8; i++) Words[i] = i; if (Sum == 3) Head = 0;", [("race", "Words")]),
        # What the routine goes on with is set anew, one object after the other.
        ("if (Ready) { Sum += Words[Head]; Head++; if (Head == 8) { Head = 0; Ready = 0; } }", "Head = 0; Ready = 1;",
         [("race", "Head")]),
        ("if (Ready) Head = 0; else { Words[Head & 7] = Count; Head++; if (Head == 8) Ready = 1; }",
         "if (Ready && ++Sum > 5) { Sum = 0; Ready = 0; Head = 0; }", [("race", "Head")]),
        # Handed back before it is copied; handed over before it is complete.
        ("if (!Ready) { Now.hours = Count++; Now.minutes = Count; Ready = 1; }",
         "if (Ready) { Ready = 0; Seen = Now; }", [("race", "Now")]),
        ("if (Ready) return; Now.hours = Count++; Now.minutes = Count; Ready = 1;",
         "struct TIME *p = &Now; if (Ready == 1) { Ready = 0; Sum = p->hours; Sum += p->minutes + Now.hours; }",
         [("race", "Now")]),
        ("if (Ready == 0) { Count = Millis++; Waiting = 2; Ready = 1; }",
         "if (Ready) { Ready = 0; Sum = Count + Waiting; }", [("race", "Count")]),
        ("if (Ready) { Seen = Now; Ready = 0; }", "if (!Ready) { Ready = 1; Now.hours++; Now.minutes++; }",
         [("race", "Now")]),
        # Only the routine sets members; `main` sets others, but computes with two at once.
        (MOVE, "if (Arm.speed > 1) Sum++; if (Arm.angle > 90) Sum += 2;", [("race", "Arm")]),
        (MOVE, "Arm.wanted = Sum & 3; Sum = Arm.angle * Arm.speed;", [("race", "Arm")]),
        # A structure that is copied as a whole; its words are set together.
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; }", "Seen = Now;", [("race", "Now")]),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; }",
         "struct TIME t; t = Now; if (t.hours == 5) Sum = t.minutes;", [("race", "Now")]),
        ("struct TIME t = {1, 2}; if (++Count == 9999) Now = t;",
         "struct TIME t = Now; Sum = t.hours; Sum ^= t.minutes;", [("race", "Now")]),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; }",
         "static Uint16 turns; if (++turns >= 3) { turns = 0; Seen = Now; }", [("race", "Now")]),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Ready = 1; }",
         "if (Ready) { Ready = 0; Sum++; } Seen = Now;", [("race", "Now")]),  # the flag stands for something else
        # Time alone keeps the two apart, and it fails: the routine writes again while main still copies.
        ("Uint16 i; for (i = 0; i < 8; i++) Words[i] = Count; Ready = 1;",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 8; i++) { DELAY_US(9); Sum += Words[i]; } }",
         [("race", "Words")]),
        # The routine may still be at work when main sets what it works with.
        (STEP, f"if (++Sum % 7 == 5) {{ {START} }}", [("race", "Motor")]),
        (RETURN, f"if (++Sum % 7 == 5) {{ {START} }}", [("race", "Motor")]),
        # The flag is another one than that which keeps the routine off; it comes too late; the routine opens it itself.
        ("Uint16 i; if (!Ready) for (i = 0; i < 8; i++) Words[i] = Count;",
         "Uint16 i; Waiting = 1; for (i = 0; i < 8; i++) Sum += Words[i]; Waiting = 0;", [("race", "Words")]),
        ("if (!Ready && ++Count == 9999) { Now.minutes++; Now.hours++; }",
         "Sum = Now.hours * 60; Ready = 1; Sum = Now.hours + Now.minutes; Ready = 0; Sum = Now.hours + Now.minutes;",
         [("race", "Now")]),
        ("Millis++;", "Copy = Millis;", [("unmasked-long", "Millis")]),
        ("Odometer += 3;", "Total = Odometer;", [("race", "Odometer")]),  # no instruction moves 64 bits
        # By halves, in two accesses.
        ("Millis++;", "volatile Uint16 *half = (volatile Uint16 *)&Millis; Copy = half[0] | (Uint32)half[1] << 16;",
         [("race", "Millis")]),
    ],
)
def test_what_an_interrupt_can_come_into_is_told(
    routine: str, turn: str, found: list[tuple[str, str]], tmp_path: Path
) -> None:
    assert told(routine, turn, tmp_path) == found


@pytest.mark.parametrize(
    ("routine", "turn"),
    [
        ("Count++;", "Sum = Count;"),  # one word, moved at once
        ("Count++;", "Sum = Count; if (Sum > 5) Count = 0;"),
        ("Count++;", "DINT; Count--; EINT;"),
        ("Count++;", "IER &= ~M_INT1; Count--; IER |= M_INT1;"),
        ("Count++;", "PieCtrlRegs.PIEIER1.bit.INTx7 = 0; Count--; PieCtrlRegs.PIEIER1.bit.INTx7 = 1;"),
        ("Count++;", "CpuTimer0Regs.TCR.bit.TIE = 0; Count--; CpuTimer0Regs.TCR.bit.TIE = 1;"),
        ("Count++;", "CpuTimer0Regs.TCR.bit.TSS = 1; Count--; CpuTimer0Regs.TCR.bit.TSS = 0;"),
        # The routine stands while its flag is down, or its timer: main sets what it works with.
        (STEP, f"Motor.running = 0; Motor.togo = 0; Sum++; {START}"),
        (RETURN, f"Motor.running = 0; Motor.togo = 0; Sum++; {START}"),
        (STEP, f"if (++Sum % 7 == 3) {{ Motor.running = 0; Motor.ramp = 0; }} if (!Motor.running) {{ {START} }}"),
        (STEP, f"CpuTimer0Regs.TCR.bit.TSS = 1; {START} Motor.togo = 7; Sum++; CpuTimer0Regs.TCR.bit.TSS = 0;"),
        ("Flags = 1;", "if (Flags) { Flags = 0; Sum++; }"),
        ("Flags = 1;", "if (Flags) { Sum = Flags; Flags = 0; }"),
        ("Flags |= 1;", "DINT; Sum = Flags; Flags = 0; EINT;"),
        ("Count++; Millis++;", "DINT; Copy = Millis; Sum = Count; Millis = 0; Count = 0; EINT;"),
        ("Odometer += 3;", "DINT; Total = Odometer; EINT;"),
        ("Millis++;", "do { Copy = Millis; } while (Copy != Millis);"),
        ("Odometer += 3;", "long long now; do { now = Odometer; } while (now != Odometer); Total = now;"),
        ("if (Ready) { Odometer += 3; Ready = 0; }", "if (!Ready) { Total = Odometer; Ready = 1; }"),
        ("Count++;", "Sum = Count * 6; while (Count) { Sum++; Count = 0; }"),
        ("Count++;", "Sum = Count; Count = Sum - Sum + Words[0];"),  # set, not cleared
        ("Count++;", "Sum = Count; Words[0] = 0;"),
        ("Now.minutes++; Now.hours++;", "DINT; Sum = Now.hours * 60 + Now.minutes; EINT;"),
        ("Now.minutes++;", "Sum = Now.minutes; Now.hours = Sum;"),  # each word has one writer
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }", "DINT; Sum = Now.hours * 60 + Now.minutes; EINT;"),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }", "Sum = Now.hours; Copy = Now.minutes;"),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }",
         "Uint16 h; do { h = Now.hours; Sum = h * 60 + Now.minutes; } while (h != Now.hours);"),
        # Copied member by member, one that the routine does not set, or again if it has been there.
        ("if (++Count == 9999) { Now.minutes = Sum; Now.hours = 3; }",
         "struct TIME *p = &Seen; DINT; p->hours = Now.hours; p->minutes = Now.minutes; EINT;"),
        ("if (++Count == 9999) { Now.minutes = Sum; Sum = 3; }",
         "struct TIME *p = &Seen; p->hours = Now.hours; p->minutes = Now.minutes;"),
        ("if (++Count == 9999) { Now.minutes = Sum; Now.hours = 3; }",
         "struct TIME *p = &Seen;"
         " do { p->hours = Now.hours; p->minutes = Now.minutes; } while (p->hours != Now.hours);"),
        ("if (++Count == 9999) { Now.minutes = Sum; Now.hours = 3; Ready = 1; }",
         "struct TIME *p = &Seen; if (Ready) { Ready = 0; p->hours = Now.hours; p->minutes = Now.minutes; }"),
        # Main comes right behind each run that writes.
        ("Now.minutes++; Now.hours += 2; Ready = 1;",
         "while (!Ready) ; Ready = 0; Sum = Now.hours * 60 + Now.minutes;"),
        ("if ((++Count & 3) == 0) { Now.minutes++; Now.hours += 2; Ready = 1; }",
         "while (!Ready) ; Ready = 0; Sum = Now.hours * 60 + Now.minutes;"),
        ("if (Flags) { Now.minutes++; Now.hours += 2; if ((++Count & 3) == 0) { Flags = 0; Ready = 1; } }",
         "Flags = 1; while (!Ready) ; Ready = 0; Sum = Now.hours * 60 + Now.minutes;"),
        # Set anew when the routine has said that it is done, or while it is held off; a count that decides nothing.
        ("if (Ready) { Sum += Words[Head]; Head++; if (Head == 8) Ready = 0; }",
         "if (!Ready) { Head = 0; Ready = 1; }"),
        ("if (Ready) { Sum += Words[Head]; Head++; if (Head == 8) { Head = 0; Ready = 0; } }",
         "DINT; Head = 0; Ready = 1; EINT;"),
        ("Count++; if (Ready) Waiting++;", "Count = 0; Waiting = 0; Ready = 1;"),
        # An index that the routine steps only while the flag is 0, and that it may set back at any time.
        ("if (Ready) Head = 0; else { Words[Head & 7] = Count; Head++; if (Head == 8) Ready = 1; }",
         "if (Ready && ++Sum > 5) { Sum = 0; Head = 0; Ready = 0; }"),
        # Looked at while interrupts are on, changed while they are off.
        ("Waiting++;", "while (Waiting == 0) ; DINT; Waiting--; EINT;"),
        # The routine comes only when it is asked for: what was read before is read.
        (
            "Uint16 i; CpuTimer0Regs.TCR.bit.TSS = 1; for (i = 0; i < 8; i++) Words[i] = Count; Ready = 1;",
            "Uint16 i; Ready = 0; CpuTimer0Regs.TCR.bit.TSS = 0; while (!Ready) ;"
            " for (i = 0; i < 8; i++) Sum += Words[i];",
        ),
        # A ring: the indices have one writer each, and say what of the buffer is whose.
        (
            "if (((Head + 1) & 7) != Tail) { Bytes[Head] = Count; Head = (Head + 1) & 7; }",
            "while (Tail != Head) { Sum += Bytes[Tail]; Tail = (Tail + 1) & 7; }",
        ),
        # Counters that are never set back, and the step of the index in the statement of the access.
        (
            "if ((Uint16)(Head - Tail) < 8) Bytes[Head++ % 8] = Count;",
            "while (Tail != Head) Sum += Bytes[Tail++ % 8];",
        ),
        # To main a routine is one step: in it the flag may come before what it stands for.
        ("if (!Ready) { Uint16 i; Ready = 1; for (i = 0; i < 8; i++) Words[i] = Count; }",
         "if (Ready) { Uint16 i; for (i = 0; i < 8; i++) Sum += Words[i]; Ready = 0; }"),
        # Two halves, and a flag in an array for each.
        (
            "Sum += Halves[Half][Head];"
            " if (++Head == 4) { Head = 0; Full[Half] = 0; Half ^= 1; if (!Full[Half]) Count++; }",
            "Uint16 h, i; for (h = 0; h < 2; h++)"
            " if (!Full[h]) { for (i = 0; i < 4; i++) Halves[h][i] = i; Full[h] = 1; }",
        ),
        # Two halves: main uses the one that the routine does not, by an index, by a pointer, by a test.
        ("Halves[Half][Head] = Count; if (++Head == 4) { Head = 0; Half ^= 1; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Sum += Halves[Half ^ 1][i]; }"),
        ("Halves[Half][Head] = Count; if (++Head == 4) { Head = 0; Waiting = Half; Half = 1 - Half; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Sum += Halves[Waiting][i]; }"),
        ("Fill[Head] = Count; if (++Head == 4) { Head = 0; Fill = Halves[Half ^= 1]; Ready = 1; }",
         "Uint16 i, *v; DINT; v = Fill == Halves[0] ? Halves[1] : Halves[0]; EINT; if (Ready) {"
         " Ready = 0; for (i = 0; i < 4; i++) Sum += v[i]; }"),
        ("if (Half) Words[Head] = Count; else Bytes[Head] = Count;"
         " if (++Head == 4) { Head = 0; Half = !Half; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Sum += Half ? Bytes[i] : Words[i]; }"),
        ("Sum += Halves[Half][Head]; if (++Head == 4) { Head = 0; Half ^= 1; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Halves[Half ^ 1][i] = i; }"),
        # A display: one digit in each interrupt, for ever.
        ("static Uint16 digit; digit = (digit + 1) & 3; Sum = Words[digit];",
         "Uint16 i; for (i = 0; i < 4; i++) Words[i] = i + Sum;"),
        ("static Uint16 digit; Sum = Words[digit]; if (++digit == 4) digit = 0;",
         "Uint16 i; for (i = 0; i < 4; i++) Words[i] = i + Sum;"),
        # The mean of the latest samples: it makes no difference which of them is replaced.
        ("Words[Head] = Count; Head = (Head + 1) & 7;", "Uint16 i; for (i = 0; i < 8; i++) Sum += Words[i];"),
        # A buffer that a flag hands over and back.
        (
            "if (Ready) { Uint16 i; for (i = 0; i < 8; i++) Sum += Words[i]; Ready = 0; }",
            "if (!Ready) { memset(Words, 1, 8); Ready = 1; }",
        ),
        # A version tells whether a pair was read whole.
        (
            "Now.minutes++; Now.hours++; Count++;",
            "Uint16 n; do { n = Count; Sum = Now.hours; Sum += Now.minutes; } while (n != Count);",
        ),
        # A module's state: `main` and the routine each have members of their own.
        (MOVE, "Arm.wanted = Sum & 3; if (Arm.speed > 1) Sum++; if (Arm.angle > 90) Arm.late++;"),
        (MOVE, "struct ARM *p = (struct ARM *)&Arm; if (p->speed > 1) p->late++; if (p->angle > 90) p->late += 2;"),
        # A ring in one structure, two words an interrupt.
        (
            "Uint16 i; for (i = 0; i < 2; i++) { Ring.words[Ring.head] = i; Ring.head = (Ring.head + 1) & 7; }",
            "while (Ring.tail != Ring.head) { Sum += Ring.words[Ring.tail]; Ring.tail = (Ring.tail + 1) & 7; }",
        ),
        ("if (!Ready) { Now.minutes++; Now.hours++; Ready = 1; }", "if (Ready) { Seen = Now; Ready = 0; }"),
        ("if (!Ready) { Now.minutes++; Now.hours++; Ready = 1; }",
         "if (Ready) { DINT; Ready = 0; Seen = Now; EINT; }"),
        # Several words that a flag hands over and back; one that is read at any time.
        ("if (!Ready) { Count = Millis++; Waiting = 2; Ready = 1; }",
         "if (Ready) { Sum = Count + Waiting; Ready = 0; }"),
        ("if (!Ready) { Count = Millis++; Waiting = 2; Ready = 1; }",
         "if (Ready) { Sum = Count + Waiting; Ready = 0; } Words[0] = Count;"),
        ("if (Ready) { Seen = Now; Ready = 0; }", "if (!Ready) { Now.hours++; Now.minutes++; Ready = 1; }"),
        ("Millis++;", "DINT; Copy = Millis; EINT;"),
        # Words that are used together while a flag keeps the routine off: it is raised by the routine, or by main.
        ("if (!Ready) { Now.minutes++; Now.hours++; Ready = 1; }",
         "if (Ready) { Sum = Now.hours * 60 + Now.minutes; Ready = 0; }"),
        ("if (Waiting && !Ready) { Now.minutes = Waiting; Now.hours++; Waiting = 0; Ready = 1; }",
         "if (!Waiting) Waiting = 5; if (Ready) { Sum = Now.hours * 60 + Now.minutes; Ready = 0; }"),
        ("if (!Ready && ++Count == 9999) { Now.minutes++; Now.hours++; }",
         "Ready = 1; Sum = Now.hours * 60 + Now.minutes; Ready = 0;"),
        ("if (Ready) { Count++; } else { Now.minutes++; Now.hours++; }",
         "Ready = 1; Sum = Now.hours * 60 + Now.minutes; Ready = 0;"),
        ("Uint16 i; if (!Ready) for (i = 0; i < 8; i++) Words[i] = Count;",
         "Uint16 i; Ready = 1; for (i = 0; i < 8; i++) Sum += Words[i]; Ready = 0;"),
        ("switch (Ready) { case 0: Now.minutes++; Now.hours++; Ready = 1; break; default: break; }",
         "if (Ready == 1) { Sum = Now.hours * 60 + Now.minutes; Ready = 2; Sum += Now.minutes; Ready = 0; }"),
        # The routine does not wait for main, which is quick enough; a half is played while the other one is filled.
        ("Uint16 i; for (i = 0; i < 8; i++) Words[i] = Count; Ready = 1;",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 8; i++) Sum += Words[i]; }"),
        ("Now.minutes++; Now.hours++; Ready = 1;", "if (Ready) { Ready = 0; Sum = Now.hours * 60 + Now.minutes; }"),
        ("Halves[Half][Head] = Count++; if (++Head == 4) { Head = 0; Half ^= 1; Ready = 1; }",
         "Uint16 i; if (Ready) { Ready = 0; for (i = 0; i < 4; i++) Sum += Halves[Half ^ 1][i]; }"),
        # Read again until nothing has come in between: the values are used behind the loop.
        ("Count++; Now.minutes++; Now.hours++; Count++;",
         "Uint16 n, h, m; do { n = Count; h = Now.hours; m = Now.minutes; } while (n != Count || (n & 1));"
         " Sum = h * 60 + m;"),
        ("Uint16 i; Count++; for (i = 0; i < 8; i++) Words[i] = Count;",
         "Uint16 n, i; for (;;) { n = Count; for (i = 0; i < 8; i++) { DELAY_US(1); Halves[0][i & 3] = Words[i]; }"
         " if (n == Count) break; }"),
        # A structure that is copied while the routine is held off; when a flag says so; until two copies are the same.
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; }", "DINT; Seen = Now; EINT;"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Ready = 1; }",
         "if (Ready) { Seen = Now; Ready = 0; }"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Ready = 1; }",
         "if (!Ready) return; Ready = 0; Seen = Now;"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Ready = 1; }",
         "Uint16 news = Ready; if (news) { Ready = 0; Seen = Now; }"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Waiting++; }",
         "Uint16 n; do { n = Waiting; Seen = Now; } while (n != Waiting);"),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; Waiting++; }",
         "Uint16 n; struct TIME t; do { n = Waiting; t = Now; } while (n != Waiting); Sum = t.hours * 60 + t.minutes;"),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }",
         "struct TIME t; DINT; t = Now; EINT; Sum = t.hours * 60 + t.minutes;"),
        ("Now.minutes++;", "volatile struct TIME *p = &Now; DINT; Sum = p->minutes; p->minutes = 0; EINT;"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; }",
         "struct TIME t; do { Seen = Now; t = Now; } while (t.minutes != Seen.minutes || t.hours != Seen.hours);"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Ready = 1; }",
         "Uint16 news = 0; if (Ready) { Ready = 0; news = 1; } if (news) Seen = Now;"),
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; Ready = 1; }",
         "if (Ready) { Ready = 0; Half = 1; } if (Half == 1) { Seen = Now; Half = 0; }"),
        # One word of the copy is used; two counters, each good for itself; words that are set at different times.
        ("if (++Count == 9999) { Now.minutes = Count; Now.hours++; }", "struct TIME t; t = Now; Sum = t.hours;"),
        ("if (++Count == 9999) { Now.minutes++; Now.hours++; }", "Seen = Now;"),
        ("if (++Count == 9999) Now.minutes = Count; if (Count == 5000) Now.hours = 3;", "Seen = Now;"),
    ],
)
def test_what_is_kept_apart_is_told_nothing(routine: str, turn: str, tmp_path: Path) -> None:
    assert told(routine, turn, tmp_path) == []


#: Timer 0 fills while Done is 0.  Timer 1 sets Done, and has not read what was filled.
TWO_ROUTINES = """#include "F28x_Project.h"
volatile Uint16 Words[8], Next, Done, Sum;
__interrupt void Fill(void)
{
    FILL
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
__interrupt void End(void)
{
    Done = 1;
}
void main(void)
{
    Uint16 i;
    InitSysCtrl();
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Fill;
    PieVectTable.TIMER1_INT = &End;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 20);
    ConfigCpuTimer(&CpuTimer1, 200, 330);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1 | M_INT13;
    EINT;
    StartCpuTimer0();
    StartCpuTimer1();
    for (;;) {
        TAKE
    }
}
"""
#: Not a mere sum: for a mean it would make no difference which of the words is replaced meanwhile.
TAKE = "if (Done) { for (i = 0; i < 8; i++) Sum = 3 * Sum + Words[i]; Done = 0; }"


@pytest.mark.parametrize(
    ("fill", "take", "races"),
    [
        ("if (!Done) Words[Next++ % 8] = Next;", TAKE, 0),
        ("if (Done) { PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; return; } Words[Next++ % 8] = Next;", TAKE, 0),
        ("if (!Done) Sum += Words[Next++ % 8];", TAKE.replace("Sum = 3 * Sum + Words[i]", "Words[i] = i"), 0),
        # Nothing keeps the routine off; main gives back too early, does not ask, or asks for nothing.
        ("Words[Next++ % 8] = Next;", TAKE, 1),
        ("if (!Done) Words[Next++ % 8] = Next;",
         "if (Done) { Done = 0; for (i = 0; i < 8; i++) Sum = 3 * Sum + Words[i]; }", 1),
        ("if (!Done) Words[Next++ % 8] = Next;",
         "for (i = 0; i < 8; i++) Sum = 3 * Sum + Words[i]; if (Done) Done = 0;", 1),
        ("if (Done) Sum++; Words[Next++ % 8] = Next;", TAKE, 1),
    ],
)
def test_a_flag_that_another_routine_sets_hands_over_too(fill: str, take: str, races: int, tmp_path: Path) -> None:
    file = tmp_path / "two.c"
    file.write_text(TWO_ROUTINES.replace("FILL", fill).replace("TAKE", take), encoding="utf-8")
    findings = check_files(DriverFiles([file], seconds=0.005)).findings
    assert [f.rule for f in findings if f.rule.startswith("race")] == ["race"] * races


def test_it_is_told_where_main_must_hold_the_interrupt_off(tmp_path: Path) -> None:
    told("Count++;", "Sum = 1;\n    Count--;", tmp_path)
    lines = (tmp_path / "bare.c").read_text().splitlines()
    findings = check_files(DriverFiles([tmp_path / "bare.c"], seconds=0.005)).findings
    (place,) = (finding.place for finding in findings if finding.rule == "race")
    assert place is not None
    assert lines[place.line - 1].strip() == "Count--;"


PYTHON = '''"""clock.c"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import *


class TIME(struct):
    hours: uint16
    minutes: uint16


Count: uint16 = 0
Sum: uint16 = 0
Now: volatile[TIME] = (0, 0)


@interrupt
def Tick() -> void:
    Count += 1
    if Count == 9999:
        Now.minutes += 1
        Now.hours += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


def main() -> void:
    InitSysCtrl()
    InitPieCtrl()
    InitPieVectTable()
    EALLOW()
    PieVectTable.TIMER0_INT = Tick
    EDIS()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200.0, 50.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER |= M_INT1
    EINT()
    StartCpuTimer0()
    while 1:
        DELAY_US(30)
        Sum = Now.hours * 60 + Now.minutes
'''


def test_a_routine_in_python_is_one_in_the_source_too(tmp_path: Path) -> None:
    """What no run as short as this shows."""
    (tmp_path / "clock.py").write_text(PYTHON)
    findings = check_files(DriverFiles([tmp_path / "clock.py"], seconds=0.005)).findings
    assert [(f.rule, f.object) for f in findings] == [("race", "clock.Now")]
