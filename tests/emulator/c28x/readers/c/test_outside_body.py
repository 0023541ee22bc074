"""What looks like a part of an if or a loop, and is outside of its body: told, and layouts that are meant so."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import program

HEAD = """#define TRACE()
#define BOTH next(); total++
#define SAFE do { next(); total++; } while (0)
#define END ) ;
volatile int live; int total, k;
int next(void) { return 1; }
int f(int a, int b)
{
"""
LINE = HEAD.count("\n") + 1


def told(statement: str, folder: Path) -> list[int]:
    """The lines, from 0, of a statement at which something is told."""
    file = folder / "drv.c"
    file.write_text(f"{HEAD}{statement}\n    return a + b;\n}}\n", encoding="utf-8")
    read = program([str(file)])
    read.translate()
    remarks = [remark for module in read.modules.values() for remark in module.remarks]
    return [remark.where.line - LINE for remark in remarks if remark.rule == "outside-body"]


@pytest.mark.parametrize(("statement", "lines"), [
    ("if (a > b); { k = 1; }", [0]), ("if (a > b);\n{ k = 1; }", [0]), ("if (a > b) ; k = 1;", [0]),
    ("    if (a > b);\n        k = 1;", [0]), ("if (a) { if (b)\n;\nif (a > b); { k = 1; } }", [2]),
    ("for (k = 0; k < 3; k++); { total++; }", [0]), ("while (live) ;\n{ total++; }", [0]),
    ("if (a) ;\n{ if (b); { k = 1; } }", [0, 1]),
])  # fmt: skip
def test_a_body_behind_a_semicolon_is_told(tmp_path: Path, statement: str, lines: list[int]) -> None:
    assert sorted(told(statement, tmp_path)) == lines


@pytest.mark.parametrize("statement", [
    # What waits, or does nothing, and says so by where the `;` is or by what follows.
    "while (live); k = 1;", "while (live);\n    k = 1;", "for (k = 0; k < 3 && live; k++);\nk = 1;",
    "if (a > b)\n    ;\n{ k = 1; }", "    if (next());\n    k = 1;", "if (a) { if (next()); }",
    "if (next());\n\n{ k = 1; }", "if (a > b); else k = 1;", "if (a > b) /* nothing */ ;",
    "do k++; while (live); { k = 1; }", "while (live);\n{\n    // stuck here?\n}", "if (a > b); { }",
    # A macro without text, and one that ends the statement.
    "if (a > b) TRACE(); k = 1;", "if (a > b END { k = 1; }",
])  # fmt: skip
def test_a_semicolon_that_is_meant_is_not_told(tmp_path: Path, statement: str) -> None:
    assert told(statement, tmp_path) == []


@pytest.mark.parametrize(("statement", "lines"), [
    ("    if (a)\n        k = 1;\n        total = 2;", [2]), ("\tif (a)\n\t\tk = 1;\n\t\ttotal++;", [2]),
    ("    for (k = 0; k < 3; k++)\n        total++;\n        next();", [2]),
    ("    if (a)\n        k = 1;\n    else\n        k = 2;\n        total = 2;", [4]),
    ("    if (a)\n        k = 1;\n    else if (b)\n        k = 2;\n        total = 2;", [4]),
    ("    while (live)\n        if (a)\n            k = 1;\n        total = 2;", [3]),
    ("    while (live)\n        if (a)\n            k = 1;\n            total = 2;", [3]),
    ("    if (a) {\n        if (b)\n            k = 1;\n            total = 2;\n    }", [3]),
    ("    if (a)\n        k = 1;   // one\n\n        /* two */\n        total = 2;", [4]),
])  # fmt: skip
def test_a_statement_with_the_indent_of_a_body_is_told(tmp_path: Path, statement: str, lines: list[int]) -> None:
    assert told(statement, tmp_path) == lines


@pytest.mark.parametrize("statement", [
    "    if (a)\n        k = 1;\n    total = 2;", "    if (a) k = 1;\n    total = 2;", "if (a)\nk = 1;\ntotal = 2;",
    "    if (a) {\n        k = 1;\n    }\n        total = 2;", "    if (a)\n        k = 1;\n      total = 2;",
    # Tabs beside blanks: where the columns are equal and the white space is not.
    "\tif (a)\n\t\tk = 1;\n  total = 2;", " if (a)\n\tk = 1;\n  total = 2;",
    "    if (a)\n        k =\n        1;\n    total = 2;", "    do\n        k = 1;\n    while (live);\n    total = 2;",
    "    switch (a)\n    {\n    case 1:\n        if (b)\n            k = 1;\n        total = 1;\n        break;\n"
    "    default:\n        total = 2;\n    }",
    "    if (a)\n        SAFE;\n    total = 2;",
])  # fmt: skip
def test_a_statement_with_an_indent_of_its_own_is_not_told(tmp_path: Path, statement: str) -> None:
    assert told(statement, tmp_path) == []


@pytest.mark.parametrize(("statement", "lines"), [
    ("if (a) BOTH;", [0]), ("for (k = 0; k < 3; k++) BOTH;", [0]), ("if (a) k = 1; else BOTH;", [0]),
    ("if (a)\n    BOTH;", [1]), ("if (a) { BOTH; }", []), ("if (a) SAFE;", []), ("BOTH;", []),
    ("if (a) next(); total++;", []),
])  # fmt: skip
def test_the_second_statement_of_a_macro_is_told(tmp_path: Path, statement: str, lines: list[int]) -> None:
    assert told(statement, tmp_path) == lines


@pytest.mark.parametrize(("statement", "lines"), [
    ("    if (a)\n        if (b) k = 1;\n    else\n        k = 2;", [2]),
    ("    if (a)\n        if (b)\n            k = 1;\n    else k = 2;", [3]),
    ("    if (a)\n        if (b) k = 1;\n        else k = 2;", []),
    ("    if (a) {\n        if (b) k = 1;\n    } else k = 2;", []),
    ("    if (a) if (b) k = 1; else k = 2;", []), ("    if (a)\n    if (b) k = 1;\n    else k = 2;", []),
    ("    if (a)\n        if (b) k = 1;\n        else k = 2;\n    else k = 3;", []),
])  # fmt: skip
def test_an_else_under_an_outer_if_is_told(tmp_path: Path, statement: str, lines: list[int]) -> None:
    assert told(statement, tmp_path) == lines
