"""The site: every page is in it, links hold, nothing is asked of other computers.  `.ci/run` builds it in whole."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

import pytest

from emulator.rules import RULES
from firmware_model.catalogue import CATALOGUE
from hil.cli import invoke
from hil.docs import PAGES
from hil.docs.site import api, catalogue, commands, links, replays, rules


def test_a_link_to_a_page_stays_and_one_to_a_file_brings_it(tmp_path: Path) -> None:
    page = PurePosixPath("hil/docs/lab.md")
    text = "[a](tutorial.md) [b](../README.md#time) [c](modelled.py) [d](../serial_url.py) [e](../../tests/README.md) "
    assert links.mended(text + "[f](https://there.org)", page, tmp_path) == (
        "[a](tutorial.md) [b](../README.md#time) [c](modelled.md) [d](../serial_url.py) e [f](https://there.org)"
    )
    assert (tmp_path / "hil" / "serial_url.py").is_file()
    with pytest.raises(ValueError, match=r"hil/docs/lab\.md: a link to hil/docs/nowhere\.md, which is not there"):
        links.mended("[g](nowhere.md)", page, tmp_path)


@pytest.mark.parametrize("name", PAGES)
def test_every_link_of_every_page_holds(name: str, tmp_path: Path) -> None:
    links.mended(PAGES[name].text(), PAGES[name].path, tmp_path)


def test_rules_and_defects_have_their_pages() -> None:
    index = rules.index()
    for rule in RULES.values():
        assert f"[{rule.id}]({rule.id}.md)" in index
        assert rule.page in rules.page(rule)
    shown = "".join(catalogue.page(name, defects) for name, defects in catalogue.files())
    for defect in CATALOGUE.values():
        assert f"## {defect.id}\n" in shown
        assert defect.wrong in shown
        assert f"](../rules/{defect.rule}.md)" in shown
        assert defect.rule in RULES


@pytest.mark.parametrize("name", [name for name, _ in commands.commands()])
def test_a_commands_page_has_every_option_of_its_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke([name, "--help"]) == 0
    options = set(re.findall(r"(?<![\w-])--[a-z][\w-]+", capsys.readouterr().out))
    shown = commands.page(name, dict(commands.commands())[name])
    assert options - set(re.findall(r"--[a-z][\w-]+", shown)) <= {"--help"}
    assert "[bold]" not in shown


@pytest.mark.parametrize("name", api.PAGES)
def test_the_reference_has_public_names_with_what_they_say(name: str) -> None:
    shown = api.page(*api.PAGES[name])
    assert "### _" not in shown
    for signature in re.findall(r"```python\n(def .*?)\n```", shown, re.DOTALL):
        compile(f"from __future__ import annotations\n{signature}: ...", name, "exec")  # it is Python
    assert shown.count("```python") > 10



def test_the_reference_says_what_the_docstring_says() -> None:
    shown = api.page(*api.PAGES["robot"])
    bench = shown.partition("\n## hil.bench\n")[2].partition("\n## ")[0]
    assert "### Bench\n" in bench
    assert "#### Bench.plot\n" in bench
    assert "def plot(self) -> Figure" in bench
    assert "The frames that it has sent, a row each" in bench


def test_a_folder_of_somebody_is_not_touched(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("sphinx", reason="needs the extra docs: pip install 'c2000-hil[docs]'")
    (tmp_path / "mine.txt").write_text("mine", encoding="utf-8")
    assert invoke(["docs", "--site", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"hil: error: {tmp_path}: is there, and is no site: give another folder\n"
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]


def test_it_is_for_all_pages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["docs", "lab", "--site", str(tmp_path / "site")]) == 2
    assert "leave out the page" in capsys.readouterr().err


def test_runs_that_play_again_are_made_as_their_page_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replays, "RUNS", {"short": ("A second.", ("--for", "1"))})
    assert "hil run --no-port --pace max --for 1 --page short.html" in replays.page()
    with replays.made(tmp_path / "runs"):
        pass
    assert "<html" in (tmp_path / "runs" / "short.html").read_text(encoding="utf-8")
    monkeypatch.setattr(replays, "RUNS", {"none": ("Nothing.", ("--world", "nowhere"))})
    with pytest.raises(ValueError, match="the run none: hil: error: nowhere"), replays.made(tmp_path / "others"):
        pass
