"""Buffers that `main` gives back before it reads them, objects that it clears too late, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
#define SIZE 16
volatile Uint16 Line[SIZE], Length, Ready, Order, Edges, Bad, Sum, Worst, Ms, Seen, Told, Mode;
static Uint16 kept[SIZE];
static Uint16 Received(void) {{ return SciaRegs.SCIRXBUF.all & 0xFF; }}
static void Send(Uint16 c) {{ while (SciaRegs.SCIFFTX.bit.TXFFST > 15); SciaRegs.SCITXBUF.all = c; }}
static void Report(Uint16 n) {{ Uint16 i; for (i = 0; i < 4; i++) {{ Told += n >> i; }} }}
static void Obey(Uint16 order) {{ Send(order); Told++; }}
static Uint16 Take(void) {{ Uint16 n; DINT; n = Edges; Edges = 0; EINT; return n; }}
static void Copy(Uint16 n) {{ Uint16 i; for (i = 0; i < n; i++) kept[i] = Line[i]; }}
{more}
interrupt void Tick(void) {{ Ms++; }}
interrupt void Comes(void)
{{
    Uint16 c = Received();
    {comes}
}}
static void Serve(void)
{{
    Uint16 i, n;
    {serve}
}}
void main(void)
{{
    Ready = 0;
    Length = 0;
    EINT;
    for (;;)
    {{
        if (Ms == Seen) continue;
        Seen = Ms;
        {turn}
    }}
}}
"""


def told(folder: Path, **given: str) -> list[tuple[str, str]]:
    """The rules of this page that are told, each with the object."""
    file = folder / "a.c"
    text = PROGRAM.format(**{"more": "", "turn": "Serve();", **given})
    file.write_text(text, encoding="utf-8")
    rules = ("released-early", "cleared-late", "read-in-time")
    return [(f.rule, f.object) for f in Build([str(file)]).compiled.findings if f.rule in rules]


FLAGGED = "if (Ready) return; if (c == 13) Ready = 1; else if (Length < SIZE) Line[Length++] = c;"
COUNTED = "if (Length < SIZE) Line[Length++] = c;"


@pytest.mark.parametrize(
    ("comes", "serve", "word"),
    [
        (FLAGGED, "if (!Ready) return; n = Length; Length = 0; Ready = 0; Copy(n);", "Ready"),
        (FLAGGED, "if (Ready) { n = Length; Length = 0; Ready = 0; for (i = 0; i < n; i++) Told += Line[i]; }",
         "Ready"),
        (FLAGGED, "if (Ready == 1) { Ready = 0; } else return; Told = Line[0]; Length = 0;", "Ready"),
        ("if (Ready == 0 && Length < SIZE) Line[Length++] = c; if (c == 13) Ready = 1;",
         "if (Ready) { Ready = 0; memcpy(kept, (const void *)Line, SIZE); Length = 0; }", "Ready"),
        ("if (Mode != 2) { Line[Length & 15] = c; Length++; if (c == 13) Mode = 2; }",
         "if (Mode == 2) { Mode = 1; Told = Line[1]; }", "Mode"),
        (FLAGGED, "if (Ready) { DINT; Length = 0; Ready = 0; EINT; Told = Line[0]; }", "Ready"),
        (COUNTED, "if (Length == 0) return; n = Length; Length = 0; Copy(n);", "Length"),
    ],
)  # fmt: skip
def test_a_buffer_that_is_read_after_its_release_is_told(comes: str, serve: str, word: str, tmp_path: Path) -> None:
    assert told(tmp_path, comes=comes, serve=serve) == [("released-early", word)]


def test_a_release_is_told_when_only_the_caller_has_asked(tmp_path: Path) -> None:
    serve = "n = Length; Length = 0; Ready = 0; Copy(n);"
    assert told(tmp_path, comes=FLAGGED, serve=serve, turn="if (Ready) Serve();") == [("released-early", "Ready")]
    masked = "if (Ready) { DINT; Serve(); EINT; }"
    assert told(tmp_path, comes=FLAGGED, serve=serve, turn=masked) == []


UNASKED = "Line[Length++] = c; if (Length == 5) { Length = 0; Ready = 1; }"
TAKES = "if (Ready) { for (i = 0; i < 5; i++) kept[i] = Line[i]; Ready = 0; }"


@pytest.mark.parametrize(("comes", "serve", "noted"), [
    (UNASKED, TAKES, True),
    (UNASKED, "if (!Ready) return; Copy(5); Ready = 0;", True),
    (UNASKED, "if (Ready) { memcpy(kept, (const void *)Line, 5); Ready = 0; }", True),
    ("if (Length > 0 || c == 2) " + UNASKED, TAKES, True),
    ("if (c == 2) Length = 0; if (Length < 5) Line[Length++] = c; if (Length == 5) Ready = 1;", TAKES, True),
    # The routine asks; a mask; the index is main's to set back, or known to it; the two halves of a buffer in turn.
    ("if (!Ready) { " + UNASKED + " }", TAKES, False),
    ("if (Ready) return; " + UNASKED, TAKES, False),
    (UNASKED, "DINT; " + TAKES + " EINT;", False),
    ("if (Length < 5) Line[Length++] = c; else Ready = 1;", TAKES + " if (Order) Length = 0;", False),
    (UNASKED, TAKES + " if (Length > 2) Bad++;", False),
    ("Line[Mode * 8 + Length++] = c; if (Length == 5) { Length = 0; Mode = !Mode; Ready = 1; }",
     "if (Ready) { for (i = 0; i < 5; i++) kept[i] = Line[(!Mode) * 8 + i]; Ready = 0; }", False),
    # Nothing tells that it is full.
    ("Line[Length++ & 15] = c;", "Told = Line[3];", False),
])  # fmt: skip
def test_a_buffer_that_nothing_keeps_is_noted(comes: str, serve: str, noted: bool, tmp_path: Path) -> None:
    assert told(tmp_path, comes=comes, serve=serve) == [("read-in-time", "Line")] * noted


@pytest.mark.parametrize(
    ("comes", "serve"),
    [
        (FLAGGED, "if (!Ready) return; Copy(Length); Length = 0; Ready = 0;"),
        (FLAGGED, "if (Ready) { DINT; n = Length; Length = 0; Ready = 0; Copy(n); EINT; }"),
        (FLAGGED, "if (Ready) { Copy(Length); Length = 0; Ready = 0; for (i = 0; i < SIZE; i++) Told += kept[i]; }"),
        (FLAGGED, "n = Length; Length = 0; Ready = 0; while (!Ready) ; Copy(n);"),  # filled on request
        (FLAGGED, "if (Ready) { Length = 0; Ready = 0; Send(1); } if (Ready) Copy(Length);"),
        (FLAGGED, "if (!Ready) { if (Ms == 5) Length = 0; return; } Copy(Length); Ready = 0;"),
        # Not the value that lets the routine write.
        (FLAGGED, "if (Length > 3) { Ready = 1; Told = Line[0]; }"),
        # The routine does not ask; it asks for something else.
        ("if (c == 13) Ready = 1; Line[c & 15] = c;", "if (Ready) { Ready = 0; Told = Line[0]; }"),
        ("if (!Mode) { Line[0] = c; Mode = 1; } Ready = 1;", "if (Ready) { Ready = 0; Told = Line[0]; Mode = 0; }"),
        (COUNTED, "if (Length == 0) return; Copy(Length); Length = 0;"),
        (COUNTED, "Length = 0; while (Length < 4) ; Copy(4);"),
        # The index alone releases nothing while a flag holds the routine off.
        ("if (!Ready && Length < SIZE) Line[Length++] = c; if (c == 13) Ready = 1;",
         "if (Ready) { n = Length; Length = 0; Copy(n); Ready = 0; }"),
    ],
)  # fmt: skip
def test_a_buffer_that_is_read_before_its_release_is_silent(comes: str, serve: str, tmp_path: Path) -> None:
    assert told(tmp_path, comes=comes, serve=serve) == []


@pytest.mark.parametrize(
    ("comes", "serve", "word"),
    [
        ("Order = c;", "if (Order) { Obey(Order); Order = 0; }", "Order"),
        ("Order = c;", "if (Order == 0) return; Obey(Order); Told++; Order = 0;", "Order"),
        ("Order = c;", "switch (Order) { case 'S': Send(1); break; case 'G': Send(2); break; } Order = 0;", "Order"),
        ("Order = c;", "n = Order; if (n) { DELAY_US(500); Order = 0; }", "Order"),
        ("Order = c;", "n = Order; i = Ms; while (Ms == i) ; Told = n; Order = 0;", "Order"),
        ("Order = c;", "DINT; n = Order; EINT; Obey(n); DINT; Order = 0; EINT;", "Order"),
        ("if (c & 1) Bad |= c;", "if (Bad & 1) Obey(Bad); Bad = 0;", "Bad"),
        ("if (c & 0x80) Bad++;", "n = Bad; Report(n); Bad = 0;", "Bad"),
        ("if (c & 0x80) Bad++;", "Report(Bad); Bad = 0;", "Bad"),
        ("Edges++;", "n = Edges; for (i = 0; i < 8; i++) Told += kept[i] * n; Edges = 0;", "Edges"),
        ("Sum += c;", "Told = Sum / 8; Report(Told); Sum = 0;", "Sum"),
        ("if (c > Worst) Worst = c;", "if (Worst > 3) { Obey(Worst); Worst = 0; }", "Worst"),
    ],
)  # fmt: skip
def test_what_is_cleared_after_the_work_is_told(comes: str, serve: str, word: str, tmp_path: Path) -> None:
    assert told(tmp_path, comes=comes, serve=serve) == [("cleared-late", word)]


def test_a_clear_in_another_function_is_told_once(tmp_path: Path) -> None:
    more = "static void Done(void) { Order = 0; }"
    turn = "if (Order) { Obey(Order); Done(); } Serve();"
    assert told(tmp_path, comes="Order = c;", serve="Told = 0;", more=more, turn=turn) == [("cleared-late", "Order")]


@pytest.mark.parametrize(
    ("comes", "serve"),
    [
        ("Order = c;", "DINT; n = Order; Order = 0; EINT; if (n) Obey(n);"),
        ("Order = c;", "n = Order; Order = 0; if (n) Obey(n);"),
        ("Order = c;", "if (Order) { DINT; Obey(Order); Order = 0; EINT; }"),
        ("Order = c;", "if (Order) { Told += Order; Order = 0; }"),  # no wait: long before the next one
        ("Order = c;", "if (Order) Report(Told); n = Order; Order = 0; Obey(n);"),
        # A handshake.
        ("if (!Order) Order = c;", "if (Order) { Obey(Order); Order = 0; }"),
        ("if (Order == 0 && c > 32) Order = c;", "if (Order) { Obey(Order); Order = 0; }"),
        ("if (Order != 0) return; Order = c;", "if (Order) { Obey(Order); Order = 0; }"),
        ("if (!Ready) { Order = c; Ready = 1; }", "if (Ready) { Obey(Order); Order = 0; Ready = 0; }"),
        ("Uint16 busy = Ready; if (busy) return; Order = c; Ready = 1;",
         "if (Ready) { Obey(Order); Order = 0; Ready = 0; }"),
        ("if (Mode) Edges++;", "Mode = 0; n = Edges; Report(n); Edges = 0; Mode = 1;"),
        # The routine holds itself off.
        ("Order = c; SciaRegs.SCICTL2.bit.RXBKINTENA = 0;",
         "if (Order) { Obey(Order); Order = 0; SciaRegs.SCICTL2.bit.RXBKINTENA = 1; }"),
        # A flag, a state, a clock, a count up to a limit, a count down.
        ("Order = 1;", "if (Order) { Obey(1); Order = 0; }"),
        ("if (c == 1) Mode = 3; else Mode = c;", "if (Mode == 3) { Obey(3); Mode = 0; } else Mode = 2;"),
        ("Edges++;", "if (Edges >= 10) { Report(1); Edges = 0; }"),
        ("Edges++;", "n = Edges; if (n >= 10) { Report(1); Edges = 0; }"),
        ("if (Edges) Edges--;", "if (Edges) { Report(Edges); Edges = 0; }"),
        ("Edges++;", "Report(Take());"),
        ("Edges++;", "DINT; n = Edges; Report(n); Edges = 0; EINT;"),
        ("Edges += c;", "Edges = 0; DELAY_US(100); Report(Edges);"),
        # How much of a buffer is full.
        (COUNTED, "if (Length < 4) return; Copy(Length); Length = 0;"),
    ],
)  # fmt: skip
def test_what_is_cleared_at_once_or_held_off_is_silent(comes: str, serve: str, tmp_path: Path) -> None:
    assert told(tmp_path, comes=comes, serve=serve) == []
