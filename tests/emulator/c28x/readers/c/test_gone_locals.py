"""Addresses of locals that outlive the call: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop

PROGRAM = """#include <stdio.h>
#include <string.h>
typedef unsigned Uint16;
typedef struct {{ float x, y; }} Point;
static Uint16 speed, state;
static volatile Uint16 left;
static const char *names[3];
void fill(Uint16 *into);
void Wait(void);
{functions}
"""


def told(functions: str) -> list[str]:
    """What is told of pointers to locals, in a program of these functions."""
    externs = {"fill": lambda into: None, "Wait": lambda: None}
    shop = CWorkshop(PROGRAM.format(functions=functions), static=True, externs=externs)
    return [f.message for f in shop.findings if f.rule == "dangling-pointer"]


TEXT = 'char text[20]; sprintf(text, "%u", speed);'


@pytest.mark.parametrize("function", [
    f"const char *f(void) {{ {TEXT} return text; }}",
    f"const char *f(void) {{ {TEXT} return &text[2]; }}",
    f"const char *f(void) {{ {TEXT} return text + 2; }}",
    f"char *f(void) {{ {TEXT} if (speed) return 0; return (char *)text; }}",
    f'const char *f(void) {{ {TEXT} return speed ? text : "none"; }}',
    'char *f(void) { char text[20]; return strcpy(text, "on"); }',
    "char *f(Uint16 n) { char text[6]; char *p = &text[5]; *p = 0; do { *--p = 48 + n % 10; n /= 10; } while (n);"
    " return p; }",
    f"const char *f(void) {{ {TEXT} {{ char *p; p = text; p++; return p; }} }}",
    "Point *f(void) { Point text; text.x = speed; text.y = 0; return &text; }",
    "float *f(void) { Point text = {1, 2}; return &text.y; }",
    "Uint16 *f(void) { Uint16 text[4]; fill(text); return text; }",
    "Uint16 *f(void) { Uint16 text = speed + 1; return &text; }",
    "Uint16 *f(Uint16 text) { text = speed + 1; return &text; }",
    'const char *f(void) { const char text[] = "abc"; return text; }',
])  # fmt: skip
def test_the_address_of_a_local_is_returned(function: str) -> None:
    (message,) = told(function)
    assert "f returns the address of its local text" in message


@pytest.mark.parametrize("function", [
    f"const char *f(void) {{ static {TEXT} return text; }}",
    'const char *f(void) { const char *text = "abc"; return text; }',
    'char *f(char *text) { sprintf(text, "%u", speed); return text; }',
    "char *f(char text[]) { char *p = text; while (*p) p++; return p; }",
    "char f(void) { char text[4]; text[1] = 3; return text[1]; }",
    "Point f(void) { Point text; text.x = speed; text.y = 0; return text; }",
    "const char *f(void) { Uint16 at[2]; at[0] = state & 1; at[1] = 2; return names[at[0]]; }",
    # It may point elsewhere.
    "char *f(char *to) { char text[8]; char *p = text; if (to) p = to; text[0] = 1; *p = text[0]; return p; }",
    f"char *f(char *to) {{ {TEXT} return strcpy(to, text); }}",
    # What it points to is no local.
    "Point *f(Point *of) { Point *one = of; one->x = 2; return one; }",
    "float *f(Point *of) { return &of->y; }",
    # It measures the stack.
    "Uint16 *f(void) { Uint16 text; return &text; }",
    "void *f(void) { char text[1]; return text; }",
    "unsigned long f(void) { Uint16 text = speed; return (unsigned long)&text; }",
])  # fmt: skip
def test_other_addresses_are_returned(function: str) -> None:
    assert told(function) == []


LEFT = """typedef struct { int gain, limit; } CONFIG;
static CONFIG *used, stays; static int n, *values; volatile int done; void elsewhere(void);
int Gain(void) { return used->gain; }
int Value(int i) { return values[i]; }
"""


def told_left(folder: Path, functions: str) -> bool:
    """Whether the address of a local is told."""
    file = folder / "a.c"
    file.write_text(LEFT + functions, encoding="utf-8")
    return "dangling-pointer" in {f.rule for f in Build([str(file)]).compiled.findings}


@pytest.mark.parametrize(
    "functions",
    [
        "void Defaults(void) { CONFIG small = { 4, 2 }; used = &small; }",
        "void Defaults(void) { CONFIG small = { 4, 2 }; used = &small; n = 0; }",
        "void Defaults(int big) { CONFIG small = { 4, 2 }; if (big) { used = &stays; } else { used = &small; } }",
        "void Use(CONFIG own) { used = &own; }",
        "void Numbers(void) { int own[3] = { 1, 2, 3 }; values = own; }",
        "void Numbers(void) { int own[3] = { 1, 2, 3 }; values = own + 1; }",
        "void Numbers(void) { int own[3] = { 1, 2, 3 }; int *p = own; p++; values = p; }",
    ],
)
def test_the_address_of_a_local_is_left_behind(tmp_path: Path, functions: str) -> None:
    assert told_left(tmp_path, functions)


@pytest.mark.parametrize(
    "functions",
    [
        "void Defaults(void) { static CONFIG small = { 4, 2 }; used = &small; }",
        "void Defaults(void) { used = &stays; }",
        "void Use(CONFIG *config) { used = config; }",
        # It is used, waited for or set back while the local is there.
        "void Work(void) { CONFIG small = { 4, 2 }; used = &small; elsewhere(); }",
        "void Work(void) { CONFIG small = { 4, 2 }; used = &small; n = Gain(); }",
        "void Work(void) { CONFIG small = { 4, 2 }; used = &small; while (!done) { } }",
        "void Work(void) { CONFIG small = { 4, 2 }; used = &small; n = 3; used = &stays; }",
        # A caller sets it; another one may.
        "static void f(void) { CONFIG small = { 4, 2 }; used = &small; } void g(void) { f(); used = &stays; }",
        "void f(void) { CONFIG small = { 4, 2 }; used = &small; } CONFIG **g(void) { return &used; }",
    ],
)
def test_what_is_left_behind_lasts(tmp_path: Path, functions: str) -> None:
    assert not told_left(tmp_path, functions)


def test_a_pointer_that_nobody_follows(tmp_path: Path) -> None:
    assert not told_left(tmp_path, "static int *other; void f(void) { int own = 3; other = &own; }")
