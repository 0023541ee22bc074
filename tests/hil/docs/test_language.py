"""The page that teaches the language: every file on it is read, every test on it runs, every line of output comes."""

from __future__ import annotations

from pathlib import Path

import pytest

import hil
from tests import pages

PAGE = Path(hil.__file__).with_name("docs") / "language.md"
SECTIONS = pages.sections(PAGE)


def test_no_block_is_left_out() -> None:
    for title, blocks in pages.all_sections(PAGE).items():
        commands = "".join(block.text for block in blocks if block.kind == "console")
        for name in pages.files(blocks):
            if name.startswith("test_"):
                assert f"$ pytest {name}\n" in commands, title
        assert {block.kind for block in blocks} <= {"c", "python", "console"}
        assert not blocks or title in SECTIONS, f"{title}: files, and nothing that runs them"


@pytest.mark.parametrize("title", SECTIONS)
def test_section(
    title: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    pages.run(SECTIONS[title], pytester, monkeypatch, capsys)
