"""Addresses of locals that a function leaves in a pointer at file scope, and right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

DRIVER = """typedef struct { int gain, limit; } CONFIG;
static CONFIG *used, stays; static int n, *values; volatile int done; void elsewhere(void);
int Gain(void) { return used->gain; }
int Value(int i) { return values[i]; }
"""


def told(folder: Path, functions: str) -> bool:
    """Whether the address of a local is told."""
    file = folder / "a.c"
    file.write_text(DRIVER + functions, encoding="utf-8")
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
    ],
)
def test_wrong(tmp_path: Path, functions: str) -> None:
    assert told(tmp_path, functions)


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
def test_right(tmp_path: Path, functions: str) -> None:
    assert not told(tmp_path, functions)


def test_a_pointer_that_nobody_follows(tmp_path: Path) -> None:
    assert not told(tmp_path, "static int *other; void f(void) { int own = 3; other = &own; }")
