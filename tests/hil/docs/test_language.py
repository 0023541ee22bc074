"""The page that teaches the language: every file on it is read, every test on it runs, every line of output comes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

# A pytest within this one forgets what it imported, and a second one would mix two copies of reader and builder.
import emulator.c28x.compile
import emulator.c28x.readers.c.declarations
import emulator.c28x.readers.c.source
import emulator.c28x.readers.python.source  # noqa: F401
import hil
from emulator.c28x.readers.c import device_headers, library_headers, register_types
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


def test_what_is_declared_and_not_there_is_listed() -> None:
    section = PAGE.read_text(encoding="utf-8").split("## Declared, and not there\n")[1].split("\n## ")[0]
    listed = set(re.findall(r"`(\w+)`", section))
    there = {*register_types.unmodelled(), *device_headers.unmodelled(), *library_headers.unmodelled()}
    shortened = {name for name in there - listed if re.match(r"Clb[234]\D|InitMcbsp[ab]\w", name)}
    assert there - listed == shortened
    endings = {re.sub(r"^(Clb\d|InitMcbsp[ab])", "", name) for name in shortened}
    ofs = {re.sub(r"^Clb\d", "", name) for name in listed if name.startswith("Clb1")}
    assert endings <= listed | ofs
    widths = {"8bit", "12bit", "16bit", "20bit", "24bit", "32bit"}
    assert listed - there == {"Clb2", "Clb3", "Clb4", "Gpio", "Int"} | widths


@pytest.mark.parametrize("title", SECTIONS)
def test_section(
    title: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    pages.run(SECTIONS[title], pytester, monkeypatch, capsys)
