"""Comments that swallow code because their end is missing."""

from __future__ import annotations

import pytest

from emulator.c28x.readers.c.preprocessor import preprocess_text


def told(text: str) -> list[int]:
    return [r.where.line for r in preprocess_text(text, "t.c").remarks if r.rule == "comment-open"]


@pytest.mark.parametrize(("text", "lines"), [
    ("int a; /* one\nint b; /* two */\nint c;", [1]), ("int a;\n/* one\nvoid f(void)\n{\n/* two */\nint c;", [2]),
    ("/* one\nint b;\n\n/* two\n */ int c;\n/* three\nint d; /* four */", [1, 6]),
])  # fmt: skip
def test_a_comment_with_code_and_another_comment_is_told(text: str, lines: list[int]) -> None:
    assert told(text) == lines


@pytest.mark.parametrize("text", [
    "int a; /* one */\nint b; /* two */", "/* int a;\n   int b; */ int c;", "/* see src/*.c;\n   and more */ int c;",
    "/***\n * text;\n ***/ int c;", "/* first\n/* second */ int c;", "// one /*\nint b; /* two */",
    'char *t = "/*"; /* a\n;*/',
])  # fmt: skip
def test_other_comments_are_not_told(text: str) -> None:
    assert told(text) == []
