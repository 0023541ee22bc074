"""``hil docs``: the pages are there, in the terminal and in the wheel."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.cli.docs import complete_page
from hil.docs import PAGES

REPOSITORY = Path(__file__).parents[3]


def test_the_list_has_every_page(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["docs"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    for name, page in PAGES.items():
        assert f"{name} {page.about}" in out
        assert f"{page.section}:" in out


@pytest.mark.parametrize("name", PAGES)
def test_every_page_is_shown(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    title = PAGES[name].text().partition("\n")[0].removeprefix("# ").replace("`", "")
    assert invoke(["docs", name]) == 0
    out = capsys.readouterr().out
    assert title in " ".join(out.split())
    # Markdown is rendered, not printed.
    assert "```" not in out
    assert invoke(["docs", name, "--markdown"]) == 0
    assert capsys.readouterr().out == PAGES[name].text()


def test_a_page_that_there_is_not_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["docs", "languages"]) == 2
    assert capsys.readouterr().err == f"hil: error: no page 'languages': one of {', '.join(PAGES)}\n"


def test_names_are_completed() -> None:
    assert complete_page("la") == ["lab", "language"]


@pytest.mark.parametrize("name", PAGES)
def test_the_wheel_takes_every_page(name: str) -> None:
    data = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    page = PAGES[name]
    if page.path.suffix == ".py":
        return  # a module
    folder = REPOSITORY / page.package
    patterns = data["tool"]["setuptools"]["package-data"][page.package]
    assert any(folder / page.file in folder.glob(pattern) for pattern in patterns)
