"""Paths in JSON: what lies below the working folder is named from there, whatever the user typed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.reports.excerpt import from_here

GOLDEN = Path(__file__).parents[2] / "golden"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("{here}/us.c", "us.c"),
        ("front={here}/a/b.csv", "front=a/b.csv"),
        ("{here}/us.c:3: no such thing", "us.c:3: no such thing"),
        ("/elsewhere{here}/us.c", "/elsewhere{here}/us.c"),
        ("{here}2/us.c", "{here}2/us.c"),
        ("us.c", "us.c"),
    ],
)
def test_only_what_lies_below_is_named_from_here(
    text: str, shown: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert from_here(text.format(here=tmp_path)) == shown.format(here=tmp_path)


def test_no_command_echoes_the_whole_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drv.c").write_text("int Half(int n)\n{\n    return n / 2;\n}\n", encoding="utf-8")
    golden = shutil.copy(min(GOLDEN.glob("*.json"), key=lambda file: file.stat().st_size), tmp_path)

    def told(*arguments: object) -> str:
        assert invoke([*map(str, arguments), "--json"]) == 0
        out = capsys.readouterr().out
        json.loads(out)
        assert str(tmp_path) not in out, arguments
        return out

    wire, trace = tmp_path / "a.wire", tmp_path / "a.trace"
    told("run", "--no-port", "--pace", "max", "--for", "0.1", "--wire", wire, "--trace", trace)
    assert '"log": "a.wire"' in told("replay", wire)
    assert '"file": "a.csv"' in told("export", trace, tmp_path / "a.csv")
    assert '"folder": "ranger"' in told("new", tmp_path / "ranger")
    told("conformance", golden)
    told("check", tmp_path / "drv.c", "-I", tmp_path)
    board, main = tmp_path / "ranger" / "board.py", tmp_path / "main.c"
    main.write_text("void main(void)\n{\n    for (;;) {\n    }\n}\n", encoding="utf-8")
    told("run", "--board", board, "--firmware", main, "--no-port", "--pace", "max", "--for", "0.001")
