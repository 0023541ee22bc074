"""The pages by reader: what they show comes, command by command."""

from __future__ import annotations

from pathlib import Path

import pytest

import hil.docs
from tests.pages import Block, run, sections

FOLDER = Path(hil.docs.__file__).parent
SECTIONS = {
    f"{page}: {title}": blocks
    for page in ("lab", "engineer", "safe")
    for title, blocks in sections(FOLDER / f"{page}.md").items()
}


@pytest.mark.parametrize("name", SECTIONS)
def test_it_does_what_it_says(
    name: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    blocks: list[Block] = SECTIONS[name]
    if name.startswith("engineer"):  # its sections go on with the file of the first
        first = next(blocks for title, blocks in SECTIONS.items() if title.startswith("engineer"))
        blocks = [block for block in first if block.kind == "c"] + blocks
    run(blocks, pytester, monkeypatch, capsys)
    assert not (pytester.path / "ran").exists(), "a driver has run on this machine"
