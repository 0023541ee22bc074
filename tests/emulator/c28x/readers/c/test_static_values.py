"""Static findings about values, in C: conditions that no value of what they compare can change."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of


def told(test: str) -> bool:
    """Whether a condition is said to be constant."""
    head = "volatile float level = 0.0f;\nint f(int n, unsigned int u, float x)\n{\n"
    return ("constant-condition", 4) in findings_of(f"{head}    if ({test}) return 1;\n    return 0;\n}}\n")


@pytest.mark.parametrize(
    "test",
    [
        "x > 9.4f && x < 9.6f",  # 9.5
        "x > 0.25f && x < 0.5f",  # 0.3
        "x < -1.0f || x > 1.0f",  # both of 0 and 2
        "x > 1e20f || x < -1e20f",  # 0, and 2e20
        "n > 3 && n < 5",  # 4
        "n > 1.5f && n < 2.5f",  # 2
        "u >= 65535u || u == 0",  # 1
        "level > 0.5f && level < 0.1f",  # a volatile object is read twice, and may change between
    ],
)
def test_a_condition_that_some_value_changes_is_not_constant(test: str) -> None:
    assert not told(test)


@pytest.mark.parametrize(
    "test", ["x > 9.6f && x < 9.4f", "n < 3 || n > 1", "n > 3 && n < 4", "n > 1.5f && n < 1.75f", "u < 0u"]
)
def test_a_condition_that_no_value_changes_is_constant(test: str) -> None:
    # The third: no integer lies between 3 and 4.  The fourth: none between 1.5 and 1.75.
    assert told(test)


def counted(body: str) -> bool:
    """Whether a condition of a function that counts is said to be constant."""
    found = findings_of(f"volatile int line = 0;\nint f(int n)\n{{\n    int i, hits = 0, tries = 5;\n{body}\n}}\n")
    return ("constant-condition", 5) in found


@pytest.mark.parametrize(
    "body",
    [
        "for (i = 0; i < 10; i++) { if (line) hits++; } return hits == 10;",
        "for (i = 0; i < 10; i++) { if (line) break; } return i == 10;",
        "for (i = 0; i < 10; i++) { if (line) break; } if (i >= 10) return 1; return 0;",
        "for (i = 0; i < 10; i++) { if (i < 20) hits += line; } return hits;",  # the build may choose
        "for (i = 0; i < 10; i++) { } i = n; if (i == 10) return 1; return 0;",
        "for (i = 0; i < 10; i++) { } while (i > 3) i -= line; return 0;",
        "while (line) { hits = 0; for (i = 0; i < 4; i++) hits++; if (hits == 4) return 1; } return 0;",
        "while (line) hits++; if (hits > 10) return 1; return 0;",  # as often as it likes
        "for (i = 0; i < n; i++) hits++; if (hits > 10) return 1; return 0;",
        "for (i = 0; i < 3; i++) { for (n = 0; n < 4; n++) hits++; } if (hits > 11) return 1; return 0;",
        "do { for (i = 0; i < 4; i++) hits++; } while (line); if (hits > 4) return 1; return 0;",
        "for (i = 0; i < 9; i += 4) hits++; if (hits > 2) return 1; return 0;",  # three turns
        "while (tries > 0) { if (line) break; tries--; } if (tries == 0) return 1; return 0;",
        "while (tries-- > 0) { if (line) break; } if (tries < 0) return 1; return 0;",
        "while (tries-- > 0) { tries += line; if (line) break; } if (tries == 0) return 1; return 0;",
        "while (--tries > 0) { if (line) break; } if (tries == 0) return 1; return 0;",
    ],
)
def test_what_counting_may_bring_is_not_constant(body: str) -> None:
    assert not counted(body)


@pytest.mark.parametrize(
    "body",
    [
        "for (i = 0; i < 10; i++) { if (line) hits++; } if (hits > 10) return 1; return 0;",
        "for (i = 0; i < 10; i++) { if (line) break; } if (i > 10) return 1; return 0;",
        "for (i = 0; i < 10; i++) { if (line) hits++; } if (i == 10) return 1; return 0;",
        "for (i = 9; i > 0; i -= 2) { if (line) hits++; } if (i == 0) return 1; return 0;",  # 9, 7, 5, 3, 1, -1
        "for (i = 0; i < 3; i++) { for (n = 0; n < 4; n++) hits++; } if (hits > 12) return 1; return 0;",
        "while (line) { hits = 0; for (i = 0; i < 4; i++) hits++; if (hits > 4) return 1; } return 0;",
        "while (tries-- > 0) { if (line) break; } if (tries == 0) return 1; return 0;",  # -1 when all have failed
        "while (tries--) { if (line) break; } if (!tries) return 1; return 0;",
        "while (tries-- > 0) { hits += line; } if (tries == 0) return 1; return 0;",
    ],
)
def test_what_no_counting_brings_is_constant(body: str) -> None:
    assert counted(body)


def test_what_a_header_defines_is_looked_at_in_the_header() -> None:
    header = "static const int table[2] = { 1, 70000L };\nstatic int unused = 3;\n"
    header += "static inline int next(void)\n{\n    static int n = 0;\n    return n++;\n}\n"
    text = '#include "table.h"\nint f(void)\n{\n    return next() + table[0];\n}\n'
    workshop = CWorkshop({"table.h": header, "drv.c": text}, static=True)
    assert [workshop.call("f"), workshop.call("f")] == [1, 2]  # 0 + 1, 1 + 1
    assert [(f.rule, f.place.file.rsplit("/", 1)[-1], f.place.line) for f in workshop.findings if f.place] == [
        ("assignment-loses", "table.h", 1)
    ]


@pytest.mark.parametrize(
    ("text", "octets"),
    [
        ("sizeof table / sizeof table[0]", False),  # 16 words by 8: the number of elements
        ("sizeof table / sizeof(struct eight)", False),
        ("n + (int)(sizeof table / sizeof *table)", False),
        ("sizeof table * 8", True),  # bits, counted as if a word had 8
        ("sizeof table / 8", True),
    ],
)
def test_a_quotient_of_sizes_is_a_number_of_elements_whatever_the_size_of_one(text: str, octets: bool) -> None:
    source = f"struct eight {{ int v[8]; }};\nstruct eight table[2];\nint f(int n)\n{{\n    return {text};\n}}\n"
    assert (("octet", 5) in findings_of(source)) == octets


@pytest.mark.parametrize(
    ("statement", "wrong"),
    [
        ("x &= !MASK;", True),
        ("x = x & !(MASK | 1);", True),
        ("x |= !MASK;", True),
        ("x &= ~MASK;", False),
        ("x &= !x;", False),
        ("x &= !ON;", False),
        ("x &= !OFF;", False),
        ("if (x && !MASK) x = 1;", False),
    ],
)
def test_the_not_of_a_mask_is_told(statement: str, wrong: bool) -> None:
    head = "#define MASK 0x10u\n#define ON 1\n#define OFF 0\nunsigned f(unsigned x)\n{\n"
    assert (("mixed-logic", 6) in findings_of(f"{head}    {statement}\n    return x;\n}}\n")) == wrong


@pytest.mark.parametrize(
    ("shared", "wrong"), [("Flags |= OTHER;", True), ("Flags |= MASK;", False), ("Flags = OTHER | !Flags;", False)]
)
def test_the_not_of_bit_0_is_told_of_a_word_with_other_flags(shared: str, wrong: bool) -> None:
    head = "#define MASK 1u\n#define OTHER 2u\nvolatile unsigned Flags = 0;\nvoid f(void)\n{\n"
    text = f"{head}    Flags &= !MASK;\n}}\nvoid g(void)\n{{\n    {shared}\n}}\n"
    assert (("mixed-logic", 6) in findings_of(text)) == wrong


@pytest.mark.parametrize(
    ("size", "statement", "wrong"),
    [
        ("60u", "x = (x + 1u) & MASK;", True),
        ("60u", "x &= ~MASK;", True),
        ("3", "return x & (SIZE - 1);", True),
        ("100u", "if ((MASK & x) == 0) x = 1;", True),
        ("64u", "x = (x + 1u) & MASK;", False),
        ("60u", "x = (x + 1u) % SIZE;", False),
        ("1u", "x &= MASK;", False),
        ("0x3Bu", "x &= SIZE;", False),  # written as a mask
        ("60u", "x = x < MASK ? x + 1 : 0;", False),
        ("60u", "x |= MASK;", False),
        ("60u", "x &= x - 1;", False),
    ],
)
def test_a_mask_of_a_number_that_is_no_power_of_two_is_told(size: str, statement: str, wrong: bool) -> None:
    head = f"#define SIZE {size}\n#define MASK (SIZE - 1u)\n\nunsigned f(unsigned x)\n{{\n"
    assert (("mask-gaps", 6) in findings_of(f"{head}    {statement}\n    return x;\n}}\n")) == wrong


def test_a_fraction_that_was_cut_to_an_integer_has_its_sign() -> None:
    text = "int f(float x)\n{\n    int whole = (int)(x * 2.0f);\n    return whole < -5 ? -5 : whole;\n}\n"
    shop = CWorkshop(text, static=True)
    assert (shop.call("f", -1.6), shop.call("f", -8.0)) == (-3, -5)
    assert shop.rules() == []


def chain(first: str, second: str) -> list[int]:
    """The lines of an `if` and its `else if` that are said to be constant."""
    head = "typedef unsigned int Uint16;\nint t, s;\nfloat x;\nUint16 u;\nvolatile int v;\nint f(void)\n{\n"
    text = f"{head}    if ({first}) return 1;\n    else if ({second}) return 2;\n    return 0;\n}}\n"
    return [line for rule, line in findings_of(text) if rule == "constant-condition"]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("t > s - 5", "t < s + 5"),
        ("t < s + 5", "t > s - 5"),
        ("s - 5 < t", "s + 5 > t"),
        ("t - s >= 0", "s - t >= -2"),  # t - s is below 0 here, and so not above 2
        ("t > 10", "t > 20"),
        ("t > 10", "t > 10"),
        ("t < 10 || s < 3", "t < 9"),
        ("x > 1.0f", "x < 1.5f"),
        ("x >= 1.0f", "x >= 1.0f"),
        ("u < 10", "u < 5"),
    ],
)
def test_a_test_that_the_failed_one_before_decides_is_constant(first: str, second: str) -> None:
    assert chain(first, second) == [9]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("t > s + 5", "t < s - 5"),
        ("t > s - 5", "t <= s - 5"),  # the exact complement
        ("t > s - 5", "t < s - 4"),  # the same, of integers
        ("x > 1.0f", "x <= 1.0f"),
        ("x > 1.0f", "x >= 1.0f"),  # 1
        ("x >= 1.0f", "x < 1.0f"),
        ("t > 20", "t > 10"),
        ("t > 10 && s > 3", "t > 20"),
        ("v > 10", "v > 20"),  # read twice
        ("u > u * 2 - 5", "u < u * 2 + 5"),  # it wraps
        ("t == 10", "t > 20"),
        ("t > s", "t < u"),
    ],
)
def test_a_test_that_the_failed_one_before_leaves_open_is_not_constant(first: str, second: str) -> None:
    assert chain(first, second) == []


@pytest.mark.parametrize(
    ("test", "told"),
    [
        ("u >= -250 && t", True),
        ("-20 < u && t", True),
        ("w > -250L && t", True),
        ("u < -1", False),  # all ones
        ("u >= ~7", False),  # a mask
        ("u > (unsigned int) -9", False),  # a cast says so
        ("u > 0xFF00u", False),
        ("u == -250", False),
        ("t >= -250", False),
    ],
)
def test_an_unsigned_object_held_against_a_negative_constant(test: str, told: bool) -> None:
    text = f"int f(int t, unsigned int u, unsigned long w)\n{{\n    if ({test}) return 1;\n    return 0;\n}}\n"
    assert (("sign-compare", 3) in findings_of(text)) == told


@pytest.mark.parametrize(
    ("value", "rules"),
    [
        ("1800 * 1000", ["overflow"]),
        ("30000 + 5000", ["overflow"]),
        ("-20000 - 20000", ["overflow"]),
        ("100000L * 50000", ["overflow"]),
        ("1800 * 10", []),
        ("1800L * 1000", []),
        ("-32767 - 1", []),
        ("u << 24", ["shift-range"]),
        ("u << 24 | 1", ["shift-range"]),
        ("u >> 16", ["shift-range"]),
        ("(unsigned long)u << 24", []),
        ("u << 15", []),
        ("1 << 15", []),
    ],
)
def test_what_constants_lose_is_told_though_it_never_runs(value: str, rules: list[str]) -> None:
    text = f"unsigned long f(unsigned int u)\n{{\n    if (u != u)\n        return {value};\n    return 0;\n}}\n"
    assert [rule for rule, line in findings_of(text) if line == 4 and rule in ("overflow", "shift-range")] == rules


STATES = """enum { IDLE, RUN, FAULT } state, other;
int lamps, ready;
void stop(void) { state = FAULT; }
"""


@pytest.mark.parametrize(("body", "told"), [
    ("if (state == IDLE) { lamps = 0; state = IDLE; } else if (ready) lamps = 2;", True),
    ("if (IDLE == state) { state = IDLE; }", True),
    # Another state, another object, another value, and a state that what runs before the assignment may change.
    ("if (state == RUN) { state = IDLE; }", False), ("if (other == IDLE) { state = IDLE; }", False),
    ("if (state == IDLE) { stop(); state = IDLE; }", False),
    ("if (state == IDLE) { if (ready) state = RUN; state = IDLE; }", False),
    # One of several cases, in which it stays.
    ("if (state == IDLE) { state = IDLE; } else if (state == RUN) { state = FAULT; }", False),
    ("if (state == IDLE) { state = IDLE; } else { state = RUN; }", False),
    ("if (state == IDLE && ready) { state = IDLE; }", False),
    # A state that the function never leaves may stand for the end.
    ("if (state == FAULT) { state = FAULT; }", False),
])  # fmt: skip
def test_a_value_that_the_test_has_just_found_is_no_news(body: str, told: bool) -> None:
    text = f"{STATES}void step(void)\n{{\n    if (state == IDLE) state = RUN;\n{body}\n}}\n"
    assert [line for rule, line in findings_of(text) if rule == "self-assignment"] == [7] * told


@pytest.mark.parametrize(("tests", "told"), [
    ("if (strcmp(s, A) == 0) n = 1; else if (strcmp(s, B)) n = 2; else if (!strcmp(s, C)) n = 3;", True),
    ("if (strcmp(s, A) == 0) n = 1; else if (!strcmp(s, B)) n = 2; else if (strcmp(s, C) != 0) n = 3;", True),
    # Everything else, one after the other, and another text.
    ("if (strcmp(s, A) == 0) n = 1; else if (strcmp(s, B)) n = 2;", False), ("if (strcmp(s, A)) n = 1;", False),
    ("if (strcmp(s, A) == 0) n = 1; else if (!strcmp(s, B)) n = 2; else if (!strcmp(s, C)) n = 3;", False),
    ("if (strcmp(s, A) != 0) n = 1; else if (strcmp(s, B)) n = 2; else if (strcmp(s, C)) n = 3;", False),
    ("if (!strcmp(s, A)) n = 1; else if (!strcmp(s, B)) n = 2; else if (strcmp(t, C)) n = 3;", False),
])  # fmt: skip
def test_a_difference_of_texts_that_is_taken_for_equality(tests: str, told: bool) -> None:
    head = '#include <string.h>\n#define A "a"\n#define B "b"\n#define C "c"\nint n; char s[4], t[4];\n'
    rules = [rule for rule, _ in findings_of(f"{head}void f(void)\n{{\n    {tests}\n}}\n")]
    assert ("text-compare" in rules) is told


@pytest.mark.parametrize(("step", "told"), [
    ("at = (at + 1) & 16;", True), ("at = (at + 1) & N;", True), ("at += 1; at &= N;", False),
    ("at = (at + 1) & (N - 1);", False),
    # It toggles, or tests a bit of another object.
    ("at = (at + 1) & 1;", False), ("at = (at + 2) & 2;", False), ("at = (n + 1) & 16;", False),
    ("unsigned next = (at + 1) & 16; if (next != n) at = next;", True),
    ("unsigned bit = (at + 1) & 16; if (bit) n = 0;", False),
])  # fmt: skip
def test_a_step_that_is_masked_by_one_bit(step: str, told: bool) -> None:
    rules = [rule for rule, _ in findings_of(f"#define N 16\nint at, n;\nvoid f(void)\n{{\n    {step}\n}}\n")]
    assert ("mask-gaps" in rules) is told


@pytest.mark.parametrize(("body", "line"), [
    ("ring[at] = new;\nsum -= ring[at];\nsum += new;", 5),
    ("ring[at] = new;\nsum += new;\nsum -= ring[at];", 5),
    ("sum -= ring[at];\nring[at] = new;\nsum += new;", 0),
    ("ring[at] = new;\nsum -= old;\nsum += new;", 0),
    ("ring[at] = new;\nsum -= ring[at];\nnew = old;\nsum += new;", 0),
    ("ring[at] = new;\nsum += ring[at];\nsum += new;", 0),
    ("ring[at] = new;\nat = (at + 1) & 7;\nsum -= ring[at];\nsum += new;", 0),
])  # fmt: skip
def test_a_sum_that_gets_what_it_loses(body: str, line: int) -> None:
    text = f"int ring[8], at, old; long sum;\nvoid f(int new)\n{{\n{body}\n}}\n"
    assert [at for rule, at in findings_of(text) if rule == "own-copy"] == [line] * bool(line)


@pytest.mark.parametrize(("body", "line"), [
    ("edges = 0;\nrate = edges * 20;", 6), ("edges = 0;\nlong k = 3;\nrate = 60 * edges + k;", 7),
    ("edges = 0;\nif (edges > 3) rate = 0;", 6),
    # It is used first, shown, counted here, or something runs in between.
    ("rate = edges * 20;\nedges = 0;", 0), ("edges = 0;\nshow(edges);", 0),
    ("edges = 0;\nedges++;\nrate = edges * 20;", 0),
    ("edges = 0;\nshow(1);\nrate = edges * 20;", 0), ("rate = edges;\nedges = 0;\nrate = edges * 20;", 0),
    ("edges = 1;\nrate = edges * 20;", 0),
    # A loop waits until it has been counted.
    ("edges = 0;\nwhile (edges < 5) ;\nrate = edges * 20;", 0), ("edges = 0;\nwhile (rate && edges < 5) ;", 0),
])  # fmt: skip
def test_a_count_that_is_cleared_before_it_is_used(body: str, line: int) -> None:
    head = "int edges; long rate; void show(int n) { rate = n; }\nvoid count(void) { edges++; }\n"
    text = f"{head}void f(void)\n{{\n{body}\n}}\n"
    assert [at for rule, at in findings_of(text) if rule == "cleared-early"] == [line] * bool(line)


MACHINE = """enum { OFF, ON, ALARM, WAIT } state;
int hot;
void step(void)
{
    switch (state) {
    case OFF: if (hot) state = WAIT; break;
    case ON: if (hot) { %s }
    case ALARM: if (!hot) state = OFF; break;
    case WAIT: state = ON; break;
    }
}
"""


@pytest.mark.parametrize(("body", "told"), [
    ("state = OFF;", True), ("state = ALARM;", False), ("hot = 0;", False),
    ("state = OFF; } /* falls through */ {", False),
    ("state = OFF; } break; {", False), ("state = WAIT; } hot = 2; {", True),
])  # fmt: skip
def test_a_state_that_goes_on_with_the_case_of_another(body: str, told: bool) -> None:
    assert [line for rule, line in findings_of(MACHINE % body) if rule == "case-falls"] == [7] * told


LIFT = """enum { STANDS, OPEN, UP, DOWN, BROKEN } state;
int late, calls;
int next(int called) { return called > 2 ? UP : called > 0 ? DOWN : STANDS; }
void step(void)
{
    switch (state) {
    case STANDS: state = next(calls); break;
    case OPEN: if (late) %s
    case UP: case DOWN: if (late) state = BROKEN; break;
    case BROKEN: break;
    }
}
"""


@pytest.mark.parametrize(("body", "told"), [
    ("state = next(calls);", True), ("state = next(calls); break;", False), ("calls = next(calls);", False),
    ("state = next(calls); /* as on the way */ /* fall through */", False), ("state = UP;", False),
])  # fmt: skip
def test_a_case_of_two_states_is_one_case(body: str, told: bool) -> None:
    assert [line for rule, line in findings_of(LIFT % body) if rule == "case-falls"] == [8] * told


STAMPS = """unsigned long millis;
struct { unsigned last, period; } jobs[3];
unsigned seen; unsigned long whole;
void tick(void) { millis++; }
unsigned long now_ms(void) { unsigned long ms; ms = millis; return ms; }
void f(int i)
{
    unsigned long now = now_ms();
%s
}
"""


@pytest.mark.parametrize(("body", "line"), [
    ("if (now - jobs[i].last > 9)\njobs[i].last = now;", 10), ("if (millis - seen > 9)\nseen = (unsigned)millis;", 10),
    ("if (now_ms() - jobs[i].last >= jobs[i].period)\njobs[i].last += jobs[i].period;", 10),
    # The difference has 16 bits too; the stamp is whole, is no time, or is not subtracted from one.
    ("if ((unsigned)(now - seen) > 9)\nseen = now;", 0), ("unsigned age = now - seen;\nif (age > 9) seen = now;", 0),
    ("if (now - whole > 9)\nwhole = now;", 0), ("if (now - jobs[i].period > 9)\njobs[i].last = now;", 0),
    # A clock that is set back, or set.
    ("if (now - seen > 9)\nseen = now;\nif (millis > 999) millis = 0;", 0),
    ("if (now - seen > 9)\nseen = now;\nmillis += i;", 0),
    ("if (whole - seen > 9)\nseen = now;", 0), ("if (now - seen > 9)\nseen = 0;", 0),
])  # fmt: skip
def test_a_stamp_that_is_narrower_than_its_clock(body: str, line: int) -> None:
    assert [at for rule, at in findings_of(STAMPS % body) if rule == "narrowed"] == [line] * bool(line)


@pytest.mark.parametrize(
    ("test", "constant"),
    [
        ("SciaRegs.SCIFFTX.bit.TXFFST <= 16", True),
        ("SpiaRegs.SPIFFRX.bit.RXFFST > DEPTH", True),
        ("I2caRegs.I2CFFTX.bit.TXFFST != 17", True),
        ("SciaRegs.SCIFFTX.bit.TXFFST < 16", False),
        ("SciaRegs.SCIFFTX.bit.TXFFST != DEPTH", False),
        ("SciaRegs.SCIFFRX.bit.RXFFST >= DEPTH", False),
        ("SciaRegs.SCIFFRX.bit.RXFFST > 0", False),
        ("SciaRegs.SCIFFTX.bit.TXFFIL <= 16", False),
    ],
)
def test_a_fifo_holds_16_words(tmp_path: Path, test: str, constant: bool) -> None:
    file = tmp_path / "a.c"
    head = '#include "F28x_Project.h"\n#define DEPTH 16\nint f(void)\n{\n'
    file.write_text(f"{head}    if ({test}) return 1;\n    return 0;\n}}\n", encoding="utf-8")
    assert ("constant-condition" in {f.rule for f in Build([str(file)]).compiled.findings}) is constant
