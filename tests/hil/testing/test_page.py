"""The plugin's page tells the truth: its files are written as they stand, its commands run, its output comes."""

from __future__ import annotations

from pathlib import Path

import pytest

import hil.testing
from tests import pages

PAGE = Path(hil.testing.__file__).with_name("README.md")
SECTIONS = pages.sections(PAGE)
#: Files that later sections use.
EARLIER = ("blink.py", "test_blink.py", "test_division.py")


def test_every_section_has_commands() -> None:
    assert pages.all_sections(PAGE).keys() == SECTIONS.keys()


@pytest.mark.parametrize("title", SECTIONS)
def test_section(
    title: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    everything = {name: text for blocks in SECTIONS.values() for name, text in pages.files(blocks).items()}
    for name in EARLIER:
        (pytester.path / name).write_text(everything[name], encoding="utf-8")
    pages.run(SECTIONS[title], pytester, monkeypatch, capsys)
