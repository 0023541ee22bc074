"""Declarations in comments: which lines they are about, and what is none."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import Final

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.declarations import WORDS, declarations

#: When files of one name were written: each later than the one before.
_MOMENTS: Final = count()


def read(folder: Path, text: str, name: str = "a.c") -> list[tuple[str, str, int, int, int]]:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    os.utime(file, ns=(0, next(_MOMENTS)))
    return [(d.word, d.text, d.line, *d.about) for d in declarations(str(file))]


def test_behind_code_it_is_about_its_line(tmp_path: Path) -> None:
    assert read(tmp_path, "int a;\nint b; // hil: unit cm\nint c; /* hil: unit mm */\n") == [
        ("unit", "cm", 2, 2, 2), ("unit", "mm", 3, 3, 3),
    ]  # fmt: skip


def test_alone_it_is_about_the_statement_that_follows(tmp_path: Path) -> None:
    text = "// hil: allow index, why\n\n/* more */\nx = f(a,\n      b);\ny = 1;\n"
    assert read(tmp_path, text) == [("allow", "index, why", 1, 4, 5)]


def test_a_function_is_meant_by_its_head(tmp_path: Path) -> None:
    assert read(tmp_path, "/* hil: odd\n * hil: range -1..1 */\nint f(int v)\n{\n  return v;\n}\n") == [
        ("odd", "", 1, 3, 4), ("range", "-1..1", 2, 3, 4),
    ]  # fmt: skip


def test_in_python_statements_are_those_of_the_parser(tmp_path: Path) -> None:
    text = (
        "# hil: allow index, why\nx = f(a,\n      b)\n\n"
        "# hil: odd\ndef g(\n    v: int,\n) -> int:\n    return v  # hil: unit cm\n"
    )
    assert read(tmp_path, text, "a.py") == [
        ("allow", "index, why", 1, 2, 3), ("odd", "", 5, 6, 8), ("unit", "cm", 9, 9, 9),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "text", ['char *s = "// hil: nothing";\n', "char c = '\"'; // of hil: nothing\n", "/* hill: x */\n"]
)
def test_a_text_is_no_comment_and_a_sentence_no_declaration(tmp_path: Path, text: str) -> None:
    assert read(tmp_path, text) == []


def test_a_word_that_declares_nothing_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"a\.c:2: hil: alow: there are allow, range, "):
        read(tmp_path, "int a;\n// hil: alow index, why\n")


@given(lines=st.lists(st.sampled_from(["x = 1;", "", "// a", "/* b", "b */", '"', "'", "// hil: odd", "# hil: odd"])))
def test_any_text_is_read_and_each_declaration_is_on_a_line_of_it(
    lines: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    for name in ("a.c", "a.py"):
        for word, _, line, first, last in read(tmp_path_factory.getbasetemp(), "\n".join(lines), name):
            assert word in WORDS
            assert "hil: odd" in lines[line - 1]
            assert 1 <= first <= last <= len(lines)
