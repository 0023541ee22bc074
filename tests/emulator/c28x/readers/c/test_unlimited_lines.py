"""Lines whose length only their last character limits, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef unsigned int Uint16; typedef unsigned char Octet;
volatile Uint16 Received; static char Line[16]; static Uint16 Length, Left, Full; static Uint16 *Where;
static void Obey(void) { Received = Line[0]; }
"""
MAIN = "\nvoid main(void) { for (;;) Take(Received); }\n"
STORE = "Line[Length++] = c;"


def told(body: str, more: str = "") -> bool:
    """Whether the function that takes a character is told."""
    text = f"{HEAD}void Take(char c)\n{{\n{body}\n}}\n{more}{MAIN}"
    return any(rule == "line-unlimited" for rule, _ in findings_of(text))


@pytest.mark.parametrize(
    "body",
    [
        f"if (c == '\\r') {{ Obey(); Length = 0; }} else {{ {STORE} }}",
        f"if (c == '\\r') {{ Line[Length] = 0; Obey(); Length = 0; return; }} {STORE}",
        f"if (c == 2) Length = 0; else if (c == '\\r' || c == '\\n') {{ if (Length > 0) Obey(); Length = 0; }}"
        f" else if (c >= ' ' && c < 127) {{ {STORE} }}",
        "if (c == '\\r') { Obey(); Length = 0; } else { Line[Length] = c; Length = Length + 1; }",
        "while (Left != Full) { char d = Line[Left]; Left = (Left + 1) % 16; if (d == '\\r') Length = 0;"
        " else Line[Length++] = d; }",
    ],
)
def test_a_line_without_a_limit_is_told(body: str) -> None:
    assert told(body)


@pytest.mark.parametrize(
    ("body", "more"),
    [
        (f"if (c == '\\r') {{ Obey(); Length = 0; }} else if (Length < 15) {{ {STORE} }}", ""),
        (f"if (c == '\\r' || Length == 15) {{ Obey(); Length = 0; }} else {{ {STORE} }}", ""),
        (f"if (c == '\\r') {{ Obey(); Length = 0; }} else {{ {STORE} if (Length >= 16) Length = 0; }}", ""),
        (f"if (c == '\\r') {{ Obey(); Length = 0; }} else {{ {STORE} Length &= 15; }}", ""),
        (f"if (c == '\\r') {{ Length = 0; Left = 15; }} else if (Left > 0) {{ Left--; {STORE} }}", ""),
        (f"if (c == '\\r') {{ Obey(); Length = 0; }} else {{ {STORE} }}",
         "void Watch(void) { if (Length > 12) Length = 0; }"),
        (f"if (c == '\\r') {{ Obey(); Length = 0; }} else if (!Full) {{ {STORE} }}",
         "void Watch(void) { Full = Length / 15; }"),
        (f"if (c == '\\r') {{ Obey(); Length = 0; }} else {{ {STORE} }}", "void Watch(void) { Where = &Length; }"),
        (f"{STORE}", "void Put(void) { Length = 0; Take('o'); Take('k'); }"),  # what a program writes itself
    ],
)  # fmt: skip
def test_a_line_that_something_may_limit_is_silent(body: str, more: str) -> None:
    assert not told(body, more)


def test_without_a_main_nothing_is_known() -> None:
    body = f"if (c == '\\r') {{ Obey(); Length = 0; }} else {{ {STORE} }}"
    assert "line-unlimited" not in {rule for rule, _ in findings_of(f"{HEAD}void Take(char c) {{ {body} }}\n")}
