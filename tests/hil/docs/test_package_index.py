"""README.md as a package index shows it."""

from __future__ import annotations

import re
import tomllib
from importlib.resources import files
from pathlib import Path

from hil.docs import PAGES
from hil.docs.package_index import TARGET, described

REPOSITORY = Path(__file__).parents[3]
SHOWN = described((REPOSITORY / "README.md").read_text(encoding="utf-8"), {str(p.path): n for n, p in PAGES.items()})


def test_no_link_leads_to_a_file_that_is_not_there() -> None:
    assert re.findall(r"\]\((?!https?:)[^)]*\)", SHOWN) == []
    assert "![" not in SHOWN
    assert "<!--" not in SHOWN


def test_links_to_pages_are_their_names() -> None:
    named = set(re.findall(r"`hil docs ([\w-]+)`", SHOWN))
    assert named <= set(PAGES)
    assert len(named) > 15


def test_it_is_installed_from_the_index() -> None:
    assert "-e" not in re.findall(r"pip install (\S+)", SHOWN)
    assert "pip install c2000-hil && hil run" in SHOWN
    assert "pip install 'c2000-hil[all]' && hil demo" in SHOWN


def test_no_command_needs_a_checkout() -> None:
    for needs in ("tests/", "&& pytest", ".ci/run", "grep -r"):
        assert needs not in SHOWN
    assert "```sh\n```" not in SHOWN
    assert "hil tasks " in SHOWN


def test_text_between_stays() -> None:
    assert described("# A\n\n![p](x.png)\n\nb [c](d.md#e), [f](https://g.org) [h](i.md)", {"d.md": "page"}) == (
        "# A\n\nb `hil docs page`, [f](https://g.org) h"
    )


def test_the_build_takes_it() -> None:
    data = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    (folder,) = data["build-system"]["backend-path"]
    assert (REPOSITORY / folder / f"{data['build-system']['build-backend']}.py").is_file()
    assert data["tool"]["setuptools"]["dynamic"]["readme"]["file"] == [TARGET.as_posix()]
    assert files("hil.docs").joinpath("package_index.py").is_file()
