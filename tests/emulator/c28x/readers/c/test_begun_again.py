"""Counts and flags that nothing begins again: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of

GATE = """typedef unsigned int Uint16;
enum {{ SHUT, RISING, OPEN, STUCK }};
static Uint16 gate = SHUT;
static Uint16 stay = 0;
Uint16 Button = 0, Top = 0, Shown = 0;
static void Go(Uint16 next) {{ gate = next; {enter} }}
static void Block(void) {{ Go(STUCK); }}
static void Step(void)
{{
    stay++;
    switch (gate) {{
    case SHUT:
        if (Button) Go(RISING);
        break;
    case RISING:
        if (Top) Go(OPEN);
        else {late}
        break;
    case OPEN:
        if (!Button) Go(SHUT);
        break;
    default:
        {stuck}
        break;
    }}
}}
int main(void)
{{
    for (;;) {{ Step(); Shown = gate; {turn} }}
}}
"""


def told(text: str) -> list[str]:
    """The lines at which `not-begun-again` is told."""
    lines = text.splitlines()
    return [lines[line - 1].strip() for rule, line in findings_of(text) if rule == "not-begun-again"]


def gate(
    enter: str = "", late: str = "if (stay > 500) Block();", stuck: str = "if (Button) Go(SHUT);", turn: str = ""
) -> str:
    return GATE.format(enter=enter, late=late, stuck=stuck, turn=turn)


@pytest.mark.parametrize("text", [
    gate(),
    gate(late="if (stay >= 500 || Button > 1) gate = STUCK;"),
    gate(late="if (500 < stay) Go(STUCK);"),
    gate(late="{ int over = stay > 500; if (over) Block(); }"),
    gate(late="if (stay < 500) Shown = 0; else Go(Button ? SHUT : STUCK);"),
    # Another routine ends the last state.
    gate(stuck="", turn="if (Button > 2) Go(SHUT);"),
])  # fmt: skip
def test_a_time_in_a_state_that_is_never_begun_again_is_told(text: str) -> None:
    (line,) = told(text)
    assert "stay" in line


@pytest.mark.parametrize("text", [
    gate(enter="stay = 0;"),
    gate(enter="stay = 0;", late="{ int over = stay > 500; if (over) Block(); }"),
    gate(turn="if (gate == SHUT) stay = 0;"),
    # A last state: the fault is latched.
    gate(stuck=""),
    # A clock, which others read; the address is taken; a limit that only lets something else act.
    gate(turn="Shown = stay;"),
    gate(turn="{ Uint16 *p = &stay; *p = 0; }"),
    gate(late="if (stay > 500 && Button) Block();"),
    # Counted down, too.
    gate(turn="if (Button) stay--;"),
    # The limit does not end the state.
    gate(late="if (stay > 500) Shown = 9;"),
    # A delay after the start: the state does not come again.
    gate(late="Shown = 1;").replace("if (Button) Go(RISING);", "if (stay > 50) Go(RISING);")
    .replace("if (!Button) Go(SHUT);", "Shown = 2;").replace("if (Button) Go(SHUT);", ""),
    # The state gets a value that is not known here.
    gate(turn="if (Button) gate = Button;"),
])  # fmt: skip
def test_a_time_in_a_state_that_is_begun_again_or_means_something_else_is_silent(text: str) -> None:
    assert told(text) == []


TEXT = """typedef unsigned int Uint16;
static char order[12] = "";
static Uint16 length = 0;
static Uint16 tooLong = 0;
volatile char Came = 0;
Uint16 Bad = 0, Done = 0, Good = 0;
static void Obey(const char *text) {{ Good += text[0]; }}
static void Take(char c)
{{
    if (c == 10) {{
        {end}
        {test}
        {again}
    }}
    else if (length < 11) order[length++] = c;
    else tooLong = 1;
}}
int main(void)
{{
    for (;;) {{ Take(Came); {turn} }}
}}
"""
LENGTH, MARK = "length = 0;", "tooLong = 0;"
END = "order[length] = 0;"
REFUSE = "if (tooLong || length == 0) Bad++; else Obey(order);"


def text(again: str = LENGTH + MARK, *, test: str = REFUSE, end: str = END, turn: str = "") -> str:
    return TEXT.format(again=again, test=test, end=end, turn=turn)


@pytest.mark.parametrize(("program", "line"), [
    (text(MARK), END),
    (text(MARK, test="Obey(order);"), END),
    # A function that uses it by its name.
    (text(MARK, test="Use();").replace("static void Obey", "static void Use(void);\nstatic void Obey")
     + "static void Use(void) { Obey(order); }\n", END),
    # Only a line that is too long sets it back.
    (text(MARK, test="Obey(order);").replace("else tooLong = 1;", "else length = 0;"), END),
    (text(LENGTH), REFUSE),
    (text(LENGTH, test="int bad = tooLong || length == 0; if (bad) Bad++; else Obey(order);"),
     "int bad = tooLong || length == 0; if (bad) Bad++; else Obey(order);"),
    (text(LENGTH, test="if (!tooLong && length > 0) Obey(order);"), "if (!tooLong && length > 0) Obey(order);"),
    (text(LENGTH, test="if (tooLong == 1) Bad++; else Obey(order);"), "if (tooLong == 1) Bad++; else Obey(order);"),
    (text(LENGTH, test="if (tooLong == 0) Obey(order);"), "if (tooLong == 0) Obey(order);"),
])  # fmt: skip
def test_a_text_and_a_mark_that_are_never_begun_again_are_told(program: str, line: str) -> None:
    assert told(program) == [line]


@pytest.mark.parametrize("program", [
    text(),
    text(MARK, turn="if (Done) length = 0;"),
    text(LENGTH, turn="if (Done) tooLong = 0;"),
    text(test="Obey(order);").replace("else tooLong = 1;", "else length = 0;"),
    text("", test="Obey(order);").replace("if (c == 10)", "if (c == 35) length = 0; else if (c == 10)"),
    text("", test="Obey(order);").replace("Good += text[0];", "Good += text[0]; length = 0;"),
    # One text only: a mark says that it is there.
    text(MARK, end="order[length] = 0; Done = 1;"),
    # A text that grows: it is ended behind each character.
    text(MARK, end="").replace("order[length++] = c;", "{ order[length++] = c; order[length] = 0; Obey(order); }"),
    # The mark is only counted or shown, or decides with something else; it is meant to stay.
    text(LENGTH, test="if (tooLong) Bad++; Obey(order);"),
    text(LENGTH, test="if (tooLong && Done) Bad++; else Obey(order);"),
    text(LENGTH).replace("tooLong", "lineFault"),
])  # fmt: skip
def test_texts_and_marks_that_begin_again_or_are_meant_to_stay_are_silent(program: str) -> None:
    assert told(program) == []


def test_a_comment_says_that_a_mark_is_meant_to_stay(tmp_path: Path) -> None:
    found = []
    for comment in ("", "  // latched"):
        file = tmp_path / "a.c"
        file.write_text(text(LENGTH).replace("tooLong = 0;", f"tooLong = 0;{comment}", 1), encoding="utf-8")
        found.append([f.rule for f in Build([str(file)]).compiled.findings if f.rule == "not-begun-again"])
    assert found == [["not-begun-again"], []]


CODE = """typedef unsigned int Uint16;
static Uint16 quiet = 0;
static Uint16 length = 0;
static char code[9];
Uint16 Key = 0, Shown = 0;
static void Forget(void) {{ length = 0; code[0] = '\\0'; }}
static void Take(void)
{{
    {taken}
    if (length < 8) code[length++] = (char) Key;
}}
int main(void)
{{
    for (;;)
    {{
        if (Key) Take();
        {old}
    }}
}}
"""


@pytest.mark.parametrize("old", [
    "if (quiet < 100) quiet++; else Forget();", "quiet++; if (quiet > 100) length = 0;",
    "quiet++; if (quiet > 100) { length = 0; Key = 0; }",
])  # fmt: skip
def test_a_count_that_is_set_back_in_each_pass_is_told(old: str) -> None:
    (line,) = told(CODE.format(taken="", old=old))
    assert line == old


@pytest.mark.parametrize(("old", "taken"), [
    ("if (quiet < 100) quiet++; else Forget();", "quiet = 0;"),
    ("quiet++; if (quiet > 100) { length = 0; quiet = 0; }", ""),
    # It does something, or sets back what nothing counts: a delay after the start.
    ("if (quiet < 100) quiet++; else Shown = length;", ""), ("if (quiet < 100) quiet++; else Shown = 0;", ""),
    ("if (quiet < 100) { quiet++; length = 0; }", ""),
])  # fmt: skip
def test_a_count_that_is_set_back_now_and_then_is_silent(old: str, taken: str) -> None:
    assert told(CODE.format(taken=taken, old=old)) == []


MEAN = """typedef unsigned int Uint16;
Uint16 Reading = 0, Shown = 0, Ready = 0;
static Uint16 number = 0;
static unsigned long total = 0;
static void Take(Uint16 value)
{{
    {take}
}}
int main(void)
{{
    Uint16 turns = 0;
    unsigned long all = 0;
    for (;;) {{ Take(Reading); {turn} }}
}}
"""
FULL = "total += value; number++; if (number {} 8) {{ Shown = total / 8; total = 0; {} }}"
LOCAL = "all += Reading; turns++; if (turns == 10) {{ Shown = all / 10; all = 0; {} }} {}"


@pytest.mark.parametrize(("take", "turn"), [
    (FULL.format("==", ""), ""), (FULL.format(">=", "Reading++;"), ""), ("", LOCAL.format("", "")),
    ("number++; total = total + value; if (8 <= number) { total = 0; Shown++; }", ""),
])  # fmt: skip
def test_a_sum_that_is_begun_again_without_its_count_is_told(take: str, turn: str) -> None:
    (line,) = told(MEAN.format(take=take, turn=turn))
    assert line in (take, f"for (;;) {{ Take(Reading); {turn} }}")


@pytest.mark.parametrize(("take", "turn"), [
    (FULL.format("==", "number = 0;"), LOCAL.format("turns = 0;", "")),
    # The count is begun again elsewhere, or goes round.
    (FULL.format("==", ""), "if (Reading > 9) number = 0;"), ("", LOCAL.format("", "if (Shown) turns = 0;")),
    (FULL.format("==", "").replace("number++", "number = (number + 1) % 9"), ""),
    # It happens once, and is meant to: the first values are summed, and no others.
    ("if (number < 8) { " + FULL.format("==", "") + " }", ""),
    ("if (number >= 8) return; " + FULL.format("==", ""), ""),
    ("total += value; number++; if (number == 8) { Shown = total / 8; total = 0; Ready = 1; }", ""),
    ("number++; if (number == 8) { Shown = total; total = 0; } else total += value;", ""),
    # The loop ends, or each call begins with a count of its own.
    ("", LOCAL.format("break;", "")),
    ("Uint16 n; for (n = 0; n < 9; n++) { total += value; if (n == 8) { Shown = total; total = 0; } }", ""),
    # No sum: what is set back is only counted elsewhere, or given a value.
    ("number++; if (number == 8) { Shown = 1; total = 0; }", "total++;"),
    ("number++; total = value; if (number == 8) { Shown = 1; total = 0; }", ""),
])  # fmt: skip
def test_a_sum_with_its_count_or_of_the_first_values_is_silent(take: str, turn: str) -> None:
    assert told(MEAN.format(take=take, turn=turn)) == []


@pytest.mark.parametrize(("take", "turn"), [
    ("total += value; number++; if (number == 8) { Shown = total / 8; number = 0; }", ""),
    ("total += value; if (++number >= 8) { Shown = total >> 3; number = 0; }", ""),
    ("", "all += Reading; turns++; if (turns == 10) { Shown = all / 10; turns = 0; }"),
])  # fmt: skip
def test_a_count_that_is_begun_again_without_its_sum_is_told(take: str, turn: str) -> None:
    (line,) = told(MEAN.format(take=take, turn=turn))
    assert line in (take, f"for (;;) {{ Take(Reading); {turn} }}")


@pytest.mark.parametrize("take", [
    # The sum of all values: an energy, which is shown now and then; or a mean of it all.
    "total += value; number++; if (number == 8) { Shown = total; number = 0; }",
    "total += value; number++; if (number == 8) { Shown = total / 100; number = 0; }",
    # It is begun again elsewhere.
    "total += value; number++; if (number == 8) { Shown = total / 8; number = 0; } if (number == 0) total = 0;",
    "total += value; total -= total / 8; number++; if (number == 8) { Shown = total / 8; number = 0; }",
])  # fmt: skip
def test_a_sum_of_all_values_is_silent(take: str) -> None:
    assert told(MEAN.format(take=take, turn="")) == []


BOUNCES = """typedef unsigned int Uint16;
Uint16 Pin = 0, Presses = 0;
static Uint16 stable = 0, different = 0;
static Uint16 Read(Uint16 level)
{{
    {body}
    return 0;
}}
int main(void)
{{
    for (;;) {{ Read(Pin); {turn} }}
}}
"""
TAKEN = "stable = level; different = 0; Presses++;"


@pytest.mark.parametrize("body", [
    "if (level != stable) { different++; if (different >= 20) { " + TAKEN + " } }",
    "if (level == stable) return 0; different++; if (different < 20) return 0; " + TAKEN,
    "if (stable == level) { Presses |= 1; } else if (++different > 20) { " + TAKEN + " }",
])  # fmt: skip
def test_readings_that_are_counted_though_not_in_a_row_are_told(body: str) -> None:
    assert told(BOUNCES.format(body=body, turn="")) == [body]


@pytest.mark.parametrize(("body", "turn"), [
    ("if (level != stable) { different++; if (different >= 20) { " + TAKEN + " } } else { different = 0; }", ""),
    ("if (level == stable) { different = 0; return 0; } different++; if (different < 20) return 0; " + TAKEN, ""),
    # It counts down, or something else begins it again.
    ("if (level == stable) { if (different) different--; } else if (++different > 20) { " + TAKEN + " }", ""),
    ("if (level != stable) { different++; if (different >= 20) { " + TAKEN + " } }", "if (!Pin) different = 0;"),
    # Changes are counted: each is taken at once.
    ("if (level != stable) { stable = level; different++; if (different >= 20) { different = 0; } }", ""),
    # What has been counted is only shown, or is the number of all.
    ("if (level != stable) { different++; if (different >= 20) { Presses = 1; different = 0; } }", ""),
    ("if (level != stable) { different++; if (different >= 20) { stable = level; } }", ""),
])  # fmt: skip
def test_readings_in_a_row_and_counts_of_all_are_silent(body: str, turn: str) -> None:
    assert told(BOUNCES.format(body=body, turn=turn)) == []


CLOCK = """typedef unsigned int Uint16;
typedef unsigned long Uint32;
volatile Uint32 Millis = 0;
Uint16 Runs = 0, Ready = 0;
{file_scope}
static void Work(void) {{ Runs++; }}
interrupt void Tick(void) {{ Millis++; }}
void (*Vector)(void) = &Tick;
int main(void)
{{
    Uint32 {local} = 0, lamp = 0;
    for (;;)
    {{
        if (Millis - {stamp} >= 100) {{ {then} }}
        {turn}
    }}
}}
"""
LAMP = "if (Millis - lamp >= 250) { lamp += 250; Ready ^= 1; }"


@pytest.mark.parametrize(("stamp", "file_scope", "turn"), [
    ("run", "", LAMP), ("lastRun", "", ""), ("letzte", "static Uint32 letzte = 0;", ""),
    ("since", "static Uint32 since = 0;", LAMP),
])  # fmt: skip
def test_a_time_since_a_stamp_that_is_not_renewed_is_told(stamp: str, file_scope: str, turn: str) -> None:
    local = "other" if file_scope else stamp
    text = CLOCK.format(local=local, stamp=stamp, file_scope=file_scope, then="Work();", turn=turn)
    assert told(text) == [f"if (Millis - {stamp} >= 100) {{ Work(); }}"]


@pytest.mark.parametrize(("stamp", "then", "turn"), [
    ("lastRun", "lastRun += 100; Work();", LAMP), ("lastRun", "Work();", "if (Ready) lastRun = Millis;"),
    # The time since the start, and nothing says that it is meant to be renewed; the loop ends.
    ("start", "Work();", LAMP), ("run", "Ready = 1;", LAMP), ("since", "Work();", ""), ("lastRun", "break;", ""),
])  # fmt: skip
def test_a_time_since_a_stamp_that_is_renewed_or_the_start_is_silent(stamp: str, then: str, turn: str) -> None:
    assert told(CLOCK.format(local=stamp, stamp=stamp, file_scope="", then=then, turn=turn)) == []


ORDERS = """typedef unsigned Uint16;
int order(int *wanted);
int Driven = 0;
int main(void)
{{
    int wanted = 0, given = 0;
    Uint16 without = 0;
    for (;;) {{
        if (order(&given)) {{ wanted = given; {order} }}
        else if (without < 2000) without++;
        else {{ {late} }}
        Driven = wanted;
        {turn}
    }}
}}
"""


@pytest.mark.parametrize(("order", "late", "turn", "told"), [
    ("", "wanted = 0;", "", True),
    ("without = 0;", "wanted = 0;", "", False),
    ("", "wanted = 0;", "if (Driven == 0) without = 0;", False),
    ("", "wanted = 0; without = 0;", "", False),
    ("", "Driven = 0;", "", False),  # it takes back no order
])  # fmt: skip
def test_the_time_without_an_order_begins_again(order: str, late: str, turn: str, told: bool) -> None:
    """Else each order holds for one pass."""
    shop = CWorkshop(ORDERS.format(order=order, late=late, turn=turn), static=True, externs={"order": lambda _: 0})
    assert [f.object for f in shop.findings if f.rule == "not-begun-again"] == ["drv.main.without"] * told
