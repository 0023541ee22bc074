"""Static findings follow C's control flow: `do`, `for` at large, fall-through, `break` from within a switch.

The ways through each function are those of ISO C99 6.8.4.2 (switch), 6.8.5 (loops) and 6.8.6 (jumps).
"""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = (
    "volatile int port = 0; int other = 3; struct P { int x, y; } both; void take(struct P p) { port = p.x; }"
    " int flags(unsigned long base) { return *(volatile int *)(base + 2); }\n"
    "int f(int n)\n"
)


def told(body: str) -> set[str]:
    """The rules of what is seen in a function of this body, which is line 3."""
    return {rule for rule, line in findings_of(f"{HEAD}{body}\n") if line == 3}


#: Every way that reaches a use of `x` writes `x` before.
WRITTEN = [
    # A do's test comes behind its body (6.8.5.2), at `continue` too (6.8.6.2).
    "{ int x; do { x = port; } while (x != n); return x; }",
    "{ int x; do { if (n == 3) { x = 0; continue; } x = 2; } while (x == 0 && --n > 0); return x; }",
    "{ int x; do { if (n == 3) { x = 1; break; } x = 2; } while (--n > 0); return x; }",
    # case 0 goes on with case 1, which writes.
    "{ int x; switch (n) { case 0: port = 1; case 1: x = 2; break; default: x = 3; } return x; }",
    "{ int x; switch (n) { case 0: if (port) { x = 1; break; } x = 2; break; default: return 0; } return x; }",
    "{ int x; switch (n) { default: port = 3; case 1: x = 4; break; case 2: x = 9; } return x; }",
    # The break ends the while, not the switch.
    "{ int x; switch (n) { case 1: while (port) { if (n) break; } x = 2; break; default: x = 0; } return x; }",
    "{ int x; for (;; port++) { if (n) { x = 1; break; } if (port > 9) return 0; } return x; }",
    "{ int i, x; for (i = 0, x = 0; i < n && x < 9; i++, x += port) ; return x; }",
    # `ok` is not 0 only where x was written.
    "{ int x, ok; ok = n > 2 && (x = port, x > 1); if (ok) return x; return 0; }",
    # A bit is 0 or 1.
    "{ int x, bit = n & 1; if (bit == 0) x = port; else if (bit == 1) x = 4; return x; }",
    "{ int x, bit = n > 2; if (bit) x = 3; else if (!bit) x = 4; return x; }",
    "{ int x; unsigned two = n & 3u; if (two == 0 || two > 2) x = 3; else if (two < 2) x = 4; else if (two == 2) x = 5;"
    " return x; }",
    "{ struct P *at = &both; int x; at->x = n & 1; at->y = port; if (at->x == 0) x = 3; else if (at->x == 1) x = 4;"
    " return x; }",
    # A pointer to a structure does not lead to an int.
    "{ struct P *at = &both; int x; at->x = n & 1; other = 5; if (at->x == 0) x = 3; else if (at->x == 1) x = 4;"
    " return x; }",
    "{ int x, k; both.x = n & 1; for (k = 0; k < n; k++) port = k; both.x = n > 3; if (both.x == 1) x = 3;"
    " else if (both.x == 0) x = 4; return x; }",
]


@pytest.mark.parametrize("body", WRITTEN)
def test_what_every_way_writes_is_not_said_to_be_unwritten(body: str) -> None:
    assert "maybe-uninitialised" not in told(body)


#: Some way leads to a use of `x` without writing it.
UNWRITTEN = [
    # It may lead to another structure of the same type.
    "{ struct P *at = &both; int x; at->x = n & 1; both.x = 5; if (at->x == 0) x = 3; else if (at->x == 1) x = 4;"
    " return x; }",
    "{ int x; do { if (port) x = 1; } while (port); return x; }",
    "{ int x; do { if (n == 3) continue; x = 2; } while (x == 0 && --n > 0); return 1; }",
    "{ int x; do { port = 1; } while (x != n); return 1; }",
    "{ int x; switch (n) { case 0: if (port) break; x = 2; break; default: x = 3; } return x; }",
    "{ int x; switch (n) { case 0: x = 1; break; case 1: port = 2; default: port = x; } return 1; }",
    "{ int i, x; for (i = 0; i < n && i < 9; i++, x += port) ; return i; }",
    # There are other values, or another one by now.
    "{ int x, two = n & 3; if (two == 0) x = 3; else if (two == 1) x = 4; return x; }",
    "{ int x, bit = n & 1; bit = n; if (bit == 0) x = 3; else if (bit == 1) x = 4; return x; }",
    "{ int x, k, bit = n & 1; for (k = 0; k < n; k++) bit = port; if (bit == 0) x = 3; else if (bit == 1) x = 4;"
    " return x; }",
    "{ int x; volatile int bit = n & 1; if (bit == 0) x = 3; else if (bit == 1) x = 4; return x; }",
    "{ struct P *at = &both; int x; at->x = n & 1; take(both); if (at->x == 0) x = 3; else if (at->x == 1) x = 4;"
    " return x; }",
    "{ struct P *at = &both, *to = at + port; int x; at->x = n & 1; to->x = n; if (at->x == 0) x = 3;"
    " else if (at->x == 1) x = 4; return x; }",
    "{ struct P *at = &both; int x; at->x = n & 1; at = at + port; if (at->x == 0) x = 3; else if (at->x == 1) x = 4;"
    " return x; }",
    "{ int x, bit = -(n & 1); if (bit == 0) x = 3; else if (bit == 1) x = 4; return x; }",
]


@pytest.mark.parametrize("body", UNWRITTEN)
def test_a_way_without_a_write_is_found(body: str) -> None:
    assert "maybe-uninitialised" in told(body)


@pytest.mark.parametrize(
    "body",
    [
        "{ int bit = n & 1; if (bit == 0) return 1; else if (bit == 1) return 2; else port = 9; return 0; }",
        "{ int bit = n & 1; if (bit == 0) return 1; else if (bit == 1) return 2; }",
        "{ int bit = n & 1; if (bit > 1) port = 9; return bit; }",
        "{ int bit = n & 1; while (bit == 2) { port = 9; bit = port; } return bit; }",
    ],
)
def test_a_branch_that_is_there_to_be_safe_is_not_told(body: str) -> None:
    assert not told(body) & {"unreachable", "missing-return", "maybe-uninitialised"}


#: Every value of `x` is read on some way.
READ = [
    # case 0 goes on with case 1, which reads.
    "{ int x = n; switch (n) { case 0: x = n * 3; case 1: port = x; break; } return 0; }",
    "{ int x; switch (n) { case 0: x = n * 2; if (port) break; x = n * 3; break; default: x = n; } return x; }",
    # The step reads, at `continue` too.
    "{ int k, x = 1; for (k = 0; k < 9; port = x, k++) { x = n * k; if (n == 3) continue; x += port; } return k; }",
    # The test of a do reads.
    "{ int x = n * 2; do { if (port) { x = n * 3; continue; } port = 2; } while (x > 3); return 0; }",
    # The next turn of a do reads.
    "{ int x = n, y; do { y = x; x = y + port; } while (y < 100); return 0; }",
    "{ int x = 0; while (n-- > 0) x ^= n; return x; }",
    "{ int x = 0; while (n-- > 0) x ^= port; return 0; }",  # read for its effect
    "{ int x = 0; while (n-- > 0) x++; return 0; }",
    # It stops there, so that a debugger shows the number.
    "{ int x = n >> 1; if (n > 9) x += 128; for (;;) { ; } return 0; }",
]


@pytest.mark.parametrize("body", READ)
def test_a_value_that_some_way_reads_is_no_dead_store(body: str) -> None:
    assert "dead-store" not in told(body)


#: No way reads the first value of `x`.
DEAD = [
    "{ int x; switch (n) { case 0: x = n * 2; break; case 1: x = n * 3; port = x; break; } return 0; }",
    "{ int x; do { x = n * 2; } while (n-- > 0); return 0; }",
    "{ int x; for (x = n * 4; n > 3; n++) { x = n * 2; port = x; } return n; }",
    "{ int x = 0; while (n-- > 0) x ^= n; return n; }",
]


@pytest.mark.parametrize("body", DEAD)
def test_a_value_that_no_way_reads_is_a_dead_store(body: str) -> None:
    assert "dead-store" in told(body)


#: Some way reads a part of what is stored.
PARTS = [
    "{ int v[4], k; for (k = 0; k < 4; k++) v[k] = n * k; return v[n & 3]; }",
    "{ struct P p; p.x = n * 2; p.y = n * 3; return p.x; }",
    "{ struct P p, q; p.x = n * 2; p.y = n; q = p; return q.y; }",
    "{ struct P p; struct P *at = &p; p.x = n * 2; p.y = n; return at->x; }",
    "{ int v[2], k; v[0] = n * 2; for (k = 0; k < 3; k++) { port = v[0]; v[0] = n * k; } return 0; }",
    "{ volatile int v[2]; v[0] = n * 2; v[1] = n * 3; return 0; }",
    "{ struct P p; p.x = n * 2; p.y = n; take(p); return 0; }",
    "{ n = n; return 0; }",
    "{ int was = port; return 0; }",  # read for its effect
    "{ int was; was = *(volatile int *)0x5E00; was = port; return was; }",  # a register by its address
    "{ int was; was = flags(0x5E00); was = flags(0x5E80); return was; }",
    "{ volatile int seen; seen = n * 2; seen = n * 3; return n; }",  # a debugger shows each
]


@pytest.mark.parametrize("body", PARTS)
def test_a_part_that_some_way_reads_is_no_dead_store(body: str) -> None:
    assert "dead-store" not in told(body)


#: Nothing reads any part behind the store.
UNREAD = [
    "{ int v[4], k; for (k = 0; k < 4; k++) v[k] = other * k; return n; }",
    "{ struct P p; p.x = n * 2; return n; }",
    "{ struct P p = {1, 2}; if (p.x > n) p.x = n * 2; return n; }",
    "{ int was = other; return 0; }",
]


@pytest.mark.parametrize("body", UNREAD)
def test_a_part_that_no_way_reads_is_a_dead_store(body: str) -> None:
    assert "dead-store" in told(body)


#: An exchange of which one half is used: the other half belongs to it.
EXCHANGES = [
    "{ int t, x = port; if (n > x) { t = n; n = x; x = t; } return n; }",
    "{ int x = port; if (n > x) { int t = n; n = x; x = t; } return x; }",
    "{ int t, v[2] = {port, n}; t = v[0]; v[0] = v[1]; v[1] = t; return v[1]; }",
    "{ int v[2] = {port, n}, *a = v, *b = v + 1, t = *a; *a = *b; *b = t; return v[1]; }",
]


@pytest.mark.parametrize("body", EXCHANGES)
def test_an_exchange_of_which_one_half_is_used_is_no_dead_store(body: str) -> None:
    assert "dead-store" not in told(body)


#: Nothing uses either half, or it is no exchange.
USELESS = [
    "{ int t, x = port; t = n; n = x; x = t; return 0; }",
    "{ int t, x = port; t = n; n = x; x = n; return n; }",
    "{ int t, x = port; t = n; n = other; x = t; return n; }",
]


@pytest.mark.parametrize("body", USELESS)
def test_an_exchange_that_nothing_uses_is_a_dead_store(body: str) -> None:
    assert "dead-store" in told(body)


def test_a_structure_that_is_never_read_is_told_once_at_its_first_store() -> None:
    found = findings_of(f"{HEAD}{{ struct P p;\n p.x = n * 2;\n p.y = n * 3;\n return n; }}\n")
    assert [(rule, line) for rule, line in found if rule == "dead-store"] == [("dead-store", 4)]


def test_a_copy_of_a_structure_that_is_changed_and_not_given_back_is_a_dead_store() -> None:
    text = "struct P { int x, y; };\nvoid move(struct P p, int by)\n{\n    p.x += by;\n}\n"
    assert ("dead-store", 4) in findings_of(text)
    back = text.replace("void", "struct P").replace("    p.x += by;\n", "    p.x += by;\n    return p;\n")
    assert findings_of(back) == []


def test_cases_behind_the_default_are_taken() -> None:
    # 6.8.4.2: the place of default among the labels means nothing.
    assert "unreachable" not in told(
        "{ int x = 0; switch (n) { default: x = 3; case 1: x += 4; break; case 2: x = 9; } return x; }"
    )


#: Small functions that only compute, and some that do more.
COMPUTING = """#include <math.h>
volatile float out; volatile int port; float kept;
static float limit(float x, float low, float high) { if (x < low) return low; if (x > high) return high; return x; }
static float wrap(float x) { while (x > 180.0f) x -= 360.0f; return x; }
static int mean(const int *v, int n)
{ int k; long sum = 0; for (k = 0; k < n; k++) sum += v[k]; return (int)(sum / n); }
static float filtered(float x) { kept += 0.1f * (x - kept); return kept; }
static float slow(float x) { static float was; was += 0.1f * (x - was); return was; }
static float ask(float x) { return port ? x : 0.0f; }
static float wait(float x) { long k; for (k = 0; k < 1000; k++) ; return x; }
static int at(unsigned long base) { return *(volatile int *)(base + 2); }
#define LOG(x)
void f(float turn)
{
    float command = 0.0f;
%s
}
"""
#: The text of a body, in which line 17 makes a copy that nothing reads.
FORGOTTEN = [
    "    turn = 2.0f * turn;\n    command = limit(turn, -1.0f, 1.0f);\n    out = 1.0f - turn;",
    "    for (;;) {\n    command = limit(wrap(turn), -1.0f, 1.0f);\n    out = turn; turn = out; }",
    "    turn *= 2.0f;\n    command = 0.5f * wrap(turn);\n    if (turn > 3.0f) out = turn;",
    "    {\n    float soft = limit(turn, -1.0f, 1.0f);\n    out = turn; } out = command;",
    "    turn *= 2.0f;\n    command = fabs(turn);\n    out = turn;",
]
#: It is read, made for an effect or for a debugger, or what it was made of is not used later.
MEANT = [
    "    turn *= 2.0f;\n    command = limit(turn, -1.0f, 1.0f);\n    out = command;",
    "    turn *= 2.0f;\n    command = limit(turn, -1.0f, 1.0f);\n    (void)command; out = turn;",
    "    turn *= 2.0f;\n    command = limit(turn, -1.0f, 1.0f);   /* for the debugger */\n    out = turn;",
    "    turn *= 2.0f;\n    command = limit(turn, -1.0f, 1.0f);\n    LOG(command); out = turn;",
    "#if 0\n    out = command;\n#endif\n    command = limit(turn, -1.0f, 1.0f); out = turn;",
    "    turn *= 2.0f;\n    command = filtered(turn);\n    out = turn;",
    "    turn *= 2.0f;\n    command = ask(turn);\n    out = turn;",
    "    turn *= 2.0f;\n    command = wait(turn);\n    out = turn;",
    "    out = turn;\n    command = limit(turn, -1.0f, 1.0f);\n    out = 0;",
    "    turn *= 2.0f;\n    command = limit(turn, -1.0f, 1.0f);\n    out = turn; for (;;) ;",
    "    {\n    float dummy = limit(turn, -1.0f, 1.0f);\n    out = turn; } out = command;",
    "    {\n    volatile float seen = limit(turn, -1.0f, 1.0f);\n    out = turn; } out = command;",
    "    { int v[3] = {1, port, 2}, m;\n    m = mean(v, 3);\n    out = v[1]; } out = command;",
    "    { unsigned long base = 0x5E00; int was;\n    was = at(base);\n    out = base; } out = command;",
    "    { int k; for (k = 0; k < 9; k++)\n    command = wrap(k);\n    out = k; }",
    "    turn *= 2.0f;\n    command = slow(turn);\n    out = turn;",
]


def dead_stores(folder: Path, body: str) -> list[int]:
    """The lines of dead stores in a file: the check also looks at its text."""
    (folder / "a.c").write_text(COMPUTING % body, encoding="utf-8")
    found = Build([str(folder / "a.c")]).compiled.findings
    return [f.place.line for f in found if f.rule == "dead-store" and f.place is not None]


@pytest.mark.parametrize("body", FORGOTTEN)
def test_a_computed_copy_that_is_forgotten_is_a_dead_store(tmp_path: Path, body: str) -> None:
    assert dead_stores(tmp_path, body) == [17]


@pytest.mark.parametrize("body", MEANT)
def test_what_a_function_returns_may_be_left(tmp_path: Path, body: str) -> None:
    assert dead_stores(tmp_path, body) == []
