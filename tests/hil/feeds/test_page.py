"""The page of feeds tells the truth: its files are written, its commands run, its output comes."""

from __future__ import annotations

from pathlib import Path

import pytest

import hil
from tests import pages

SECTIONS = pages.sections(Path(hil.__file__).with_name("feeds") / "README.md")


@pytest.mark.parametrize("title", SECTIONS)
def test_section(
    title: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    pages.run(SECTIONS[title], pytester, monkeypatch, capsys)
