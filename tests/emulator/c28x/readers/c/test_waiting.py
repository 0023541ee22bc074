"""A loop that waits on an object of another thread that is not `volatile` is a finding; where C is right there is none.

ISO C 5.1.2.3 p3: an implementation need not read an object again that the program does not change, unless it is
`volatile` (6.7.3 p6).  So whatever the loop itself writes, and whatever a function may write whose body the compiler
does not know, is read again.
"""

from __future__ import annotations

import pytest

from emulator.c28x.passes.checks import check
from emulator.c28x.passes.stamps import Stamps
from tests.emulator.c28x.readers.c.workshop import read

#: `isr` writes whatever may be waited for; the names of volatile objects begin with `v`.
HEAD = """\
#include "F28x_Project.h"
typedef volatile unsigned int vuint;
struct data { volatile int ready; int count, own; };
struct bits { unsigned done : 1; unsigned wrong : 1; };
int flag, mode, limit, enabled, lone, item[4], out[10], *pointer;
volatile int vflag, vitem[4]; vuint vnamed; struct data data; volatile struct data vdata;
struct bits bits; volatile struct bits vbits;
static int hidden;
extern int elsewhere(void);
int moving(void) { return flag; }
static int is_ready(int wanted) { return mode == wanted; }
int vmoving(void) { return vflag; }
int guarded(void) { int now; DINT; now = flag; EINT; return now; }
interrupt void isr(void)
{
    flag = mode = limit = enabled = hidden = item[2] = vflag = vitem[2] = *pointer = 1;
    vnamed = 1; data.ready = data.count = 1; vdata.count = 1; bits.done = vbits.done = 1;
}
static int twice(int x) { return 2 * x; }
static void clear(void) { flag = 0; }
"""


def waiting(files: str | dict[str, str]) -> list[tuple[str, int, int, str]]:
    """Each finding of the rule: file, line, column, object."""
    modules = read({"drv.c": files} if isinstance(files, str) else files).translate()
    found = check(modules, {v: v.initial for m in modules for v in m.variables}, Stamps(modules, frozenset()))
    return [
        (f.place.file.rsplit("/", 1)[-1], f.place.line, f.place.column, f.object)
        for f in found
        if f.rule == "poll-not-volatile"
    ]


@pytest.mark.parametrize(
    ("function", "variable"),
    [
        ("void wait(void) { while (!flag) ; }", "flag"),
        ("void wait(void) { while (flag == 0) { } }", "flag"),
        ("void wait(void) { do { } while (!flag); }", "flag"),
        ("void wait(void) { for (; !flag; ) { } }", "flag"),
        ("void wait(void) { while (1) { if (flag) break; } }", "flag"),
        ("int wait(void) { for (;;) { if (mode == 1) return 1; } }", "mode"),
        ("int wait(void) { int x; while ((x = flag) == 0) ; return x; }", "flag"),
        ("int wait(void) { int t = 1000; while (!flag && --t) ; return t; }", "flag"),
        ("int wait(void) { int t = 1000; do { t--; } while (!flag && t > 0); return t; }", "flag"),
        ("int wait(void) { int t; for (t = 0; t < 1000; t++) { if (flag) return 1; } return 0; }", "flag"),
        ("int wait(void) { int t; for (t = 0; t < 1000 && !flag; t++) { } return t; }", "flag"),
        ('void wait(void) { while (!flag) { asm(" NOP"); } }', "flag"),
        ("void wait(void) { while (!flag) { GpioDataRegs.GPATOGGLE.bit.GPIO31 = 1; } }", "flag"),
        ("void wait(void) { while (!flag) { EALLOW; EDIS; } }", "flag"),
        ("int wait(void) { int n = 1; while (!mode) { n = twice(n); } return n; }", "mode"),
        ("void wait(void) { while (!mode) { clear(); } }", "mode"),
        ("void wait(void) { while (!hidden) ; }", "hidden"),
        ("void wait(void) { while (!item[2]) ; }", "item[2]"),
        ("void wait(void) { while (data.count == 0) ; }", "data.count"),
        ("void wait(void) { while (!bits.done) ; }", "bits.done"),
        ("void wait(void) { while (!data.count) { data.own++; } }", "data.count"),  # the loop writes another member
        # Another function of this file returns it.
        ("void wait(void) { while (moving()) ; }", "flag"),
        ("void wait(void) { int now; do { now = moving(); } while (now); }", "flag"),
        ("void wait(void) { while (!is_ready(3)) { clear(); } }", "mode"),
    ],
)
def test_a_wait_on_what_an_interrupt_writes_is_found_where_the_loop_begins(function: str, variable: str) -> None:
    column = min(function.index(word) for word in ("while", "do {", "for (") if word in function) + 1
    assert waiting(HEAD + function) == [("drv.c", HEAD.count("\n") + 1, column, f"drv.{variable}")]


@pytest.mark.parametrize(
    "function",
    [
        "void wait(void) { while (!vflag) ; }",
        "void wait(void) { while (!vnamed) ; }",  # the type's name says volatile
        "void wait(void) { while (!vitem[2]) ; }",
        "void wait(void) { while (!data.ready) ; }",  # the member is
        "void wait(void) { while (!vdata.count) ; }",
        "void wait(void) { while (!vbits.done) ; }",
        "void wait(void) { while (!*(volatile int *)&flag) ; }",
        "void wait(void) { while (!*pointer) ; }",  # what it points to may be volatile
        "void wait(void) { while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0) ; }",
        "void wait(void) { while (flag == 0) { flag = GpioDataRegs.GPADAT.bit.GPIO3; } }",
        "void wait(void) { while (!flag) { DELAY_US(10); } }",
        "void wait(void) { while (!flag) { elsewhere(); } }",
        "void wait(void) { while (elsewhere() && !flag) ; }",
        "void wait(void) { while (flag) { clear(); } }",
        "void wait(void) { while (!flag) { *pointer = 0; } }",
        "void wait(void) { while (vmoving()) ; }",
        "void wait(void) { while (guarded()) ; }",  # more than a value is behind the call
        "void wait(void) { while (moving()) { DELAY_US(10); } }",
        "void wait(void) { while (moving()) { clear(); } }",
        "void count(void) { int i; for (i = 0; i < 10 && moving(); i++) { out[i] = i; } }",
        "void wait(void) { while (!lone) ; }",  # nobody writes it
        "void wait(void) { while (!data.own) ; }",  # nobody writes this member
        "void count(void) { int i; for (i = 0; i < limit; i++) { out[i % 10] = i; } }",
        "void count(void) { int i = 0; while (i < limit) i++; }",
        "void count(void) { int i = 0; while (i < 1000) i++; }",
        # Work that another thread may end early: it ends by itself, and need not know at once.
        "void count(void) { int i; for (i = 0; i < 10 && enabled; i++) { out[i] = i; } }",
        "int count(void) { int k = 10; while (--k && enabled) { out[k] = 0; } return k; }",
        "int count(void) { int i, s = 0; for (i = 0; i < 10 && enabled; i++) { s += out[i]; } return s; }",
        "int find(void) { int i; for (i = 0; i < 10 && out[i] != mode; i++) { } return i; }",
        "void once(void) { while (mode == 1) { out[0] = 1; break; } }",
    ],
)
def test_right_loops_are_silent(function: str) -> None:
    assert waiting(HEAD + function) == []


MAIN = "int flag;\nstatic void raise(void) { flag = 1; }\n%s\nint main(void) { %s while (!flag) ; return 0; }\n"


def test_the_statement_that_writes_the_member_is_named() -> None:
    source = (
        "struct { int level, done; long sum[2]; } state;\ninterrupt void isr(void)\n{\n    state.level = 1;\n"
        "    state.sum[1] = 2;\n    state.done = 1;\n}\nvoid wait(void) { while (!state.done) ; }\n"
    )
    modules = read({"drv.c": source}).translate()
    found = check(modules, {v: v.initial for m in modules for v in m.variables}, Stamps(modules, frozenset()))
    (told,) = (f.message for f in found if f.rule == "poll-not-volatile")
    assert "waits on drv.state.done, which drv.isr writes (drv.c:6)" in told


def test_with_a_main_only_what_runs_beside_it_counts() -> None:
    alone = MAIN % ("", "raise();")
    assert waiting(alone) == []
    vector = '#include "F28x_Project.h"\n' + MAIN % (
        "interrupt void isr(void) { raise(); }", "EALLOW; PieVectTable.TIMER0_INT = &isr; EDIS;"
    )  # fmt: skip
    assert [(line, name) for _, line, _, name in waiting(vector)] == [(5, "drv.flag")]


def test_volatile_at_any_declaration_counts_for_all_files() -> None:
    wait = "extern %sint flag;\nvoid wait(void)\n{\n    while (!flag) ;\n}\n"
    isr = "int flag;\ninterrupt void isr(void) { flag = 1; }\n"
    assert waiting({"wait.c": wait % "", "isr.c": isr}) == [("wait.c", 4, 5, "isr.flag")]
    assert waiting({"wait.c": wait % "volatile ", "isr.c": isr}) == []


def test_what_a_function_of_another_file_returns_is_read_each_time() -> None:
    get = "int flag;\ninterrupt void isr(void) { flag = 1; }\nint get(void) { return flag; }\n"
    wait = "int get(void);\nvoid wait(void) { while (!get()) ; }\n"
    assert waiting({"wait.c": wait, "isr.c": get}) == []
    assert [name for *_, name in waiting(get + wait)] == ["drv.flag"]


MAIN_LOOP = """int events, total; volatile int ticks;
void elsewhere(void);
interrupt void isr(void) { events++; ticks++; }
void main(void)
{
    for (;;) {
        %s
        if (ticks > 3) { ticks = 0; elsewhere(); }
    }
}
"""


@pytest.mark.parametrize(("loop", "told"), [
    ("if (events > 0) { events = 0; total++; }", True), ("if (events) { elsewhere(); events--; }", True),
    # A function that the compiler does not know runs in each turn, or a pointer writes.
    ("elsewhere(); if (events > 0) { events = 0; }", False),
    ("if (events > total) elsewhere(); *(int *)&total = 1;", False),
    # What is tested is volatile, or written in each turn, or by nobody else.
    ("if (ticks > 0) { ticks = 0; total++; }", False), ("events = total; if (events > 0) { total++; }", False),
    ("if (total > 0) { total = 0; }", False),
])  # fmt: skip
def test_a_test_in_the_last_loop_of_main_may_be_made_once(loop: str, told: bool) -> None:
    # As gcc 12 and clang 14 do with -O2: they read `events` once, and their loop is empty while it is 0.
    assert [(line, name) for _, line, _, name in waiting(MAIN_LOOP % loop)] == [(7, "drv.events")] * told


TAKE = """#include "F28x_Project.h"
int ready, other, data; volatile int vready;
void elsewhere(void);
interrupt void isr(void) { ready = other = vready = 1; data++; }
static int Take(int *to)
{
    %s
    *to = data;
    return 1;
}
void main(void)
{
    int x;
    for (;;) {
        %s
    }
}
"""


@pytest.mark.parametrize(("take", "loop", "told"), [
    ("if (ready == 0) return 0; ready = 0;", "if (!Take(&x)) continue; elsewhere();", True),
    ("if (!ready) return 0; DINT; ready = 0; EINT;", "if (!Take(&x)) continue; elsewhere();", True),
    ("if (!ready) return 0; ready = 0;", "if (Take(&x) == 0) continue; elsewhere();", True),
    ("if (!ready) return 0; ready = 0;", "while (!Take(&x)) { } elsewhere();", True),
    ("if (!ready) return 0; ready = 0;", "if (Take(&x)) elsewhere();", True),
    # Volatile; another function runs first; what is returned goes on; the test is of a parameter.
    ("if (vready == 0) return 0; vready = 0;", "if (!Take(&x)) continue; elsewhere();", False),
    ("elsewhere(); if (ready == 0) return 0; ready = 0;", "if (!Take(&x)) continue; elsewhere();", False),
    ("if (ready == 0) return 0; ready = 0;", "elsewhere(); if (!Take(&x)) continue;", False),
    ("if (ready == 0) return 1; ready = 0;", "if (!Take(&x)) continue; elsewhere();", False),
    ("if (*to == 0) return 0; ready = 0;", "if (!Take(&x)) continue; elsewhere();", False),
    ("if (ready == 0) return 0; ready = 0;", "Take(&x); elsewhere();", False),
])  # fmt: skip
def test_a_function_that_begins_with_a_test(take: str, loop: str, told: bool) -> None:
    # The loop, or that of `main` around it.
    found = waiting(TAKE % (take, loop))
    assert [name for *_, name in found] == ["drv.ready"] * told
