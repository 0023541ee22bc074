"""The tutorial tells the truth: from its first command to its last, in one folder."""

from __future__ import annotations

from pathlib import Path

import pytest

import hil
from tests import pages

PAGE = Path(hil.__file__).with_name("docs") / "tutorial.md"


def test_all_of_it(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    sections = pages.all_sections(PAGE)
    assert len(sections) == 8
    blocks = [block for section in sections.values() for block in section]
    assert sum(block.kind == "console" for block in blocks) > 6
    pages.run(blocks, pytester, monkeypatch, capsys)
