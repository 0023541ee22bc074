"""README.md as a package index shows it."""

from __future__ import annotations

import email
import re
import subprocess
import sys
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

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


def test_a_picture_is_its_words_and_the_command_that_draws_it() -> None:
    drawn = "<!-- made by: hil demo -->\n![A robot](robot.gif)\n\n![Another](other.png)\n\nEnd\n"
    assert described(drawn, {}) == "A robot: `hil demo` draws it.\n\nEnd\n"
    assert "`hil run --no-port --pace max --for 60 --order mission --plot mission.gif` draws it." in SHOWN


def test_what_the_build_writes_shows_no_broken_link_and_no_picture_on_an_index(tmp_path: Path) -> None:
    markdown = pytest.importorskip("readme_renderer.markdown", reason="needs readme-renderer[md], of the extra test")
    pytest.importorskip("setuptools", minversion="77", reason="needs setuptools 77, the build's backend")
    for name in ("LICENSE", "README.md", "pyproject.toml", "emulator", "firmware_model", "hil"):
        (tmp_path / name).symlink_to(REPOSITORY / name)
    hook = "import sys; sys.path.insert(0, 'hil/docs'); from package_index import *; "
    call = "print(prepare_metadata_for_build_wheel('metadata'), file=sys.stderr)"
    (tmp_path / "metadata").mkdir()
    built = subprocess.run(
        [sys.executable, "-c", hook + call], cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        check=True,
    )  # fmt: skip
    folder = built.stderr.splitlines()[-1]
    metadata = email.message_from_bytes((tmp_path / "metadata" / folder / "METADATA").read_bytes())
    text = metadata.get_payload()
    assert metadata["Description-Content-Type"] == "text/markdown"
    page = markdown.render(text)
    assert "<table>" in page
    assert "mission in the corridor" in page
    assert re.findall(r'(?:href|src)="(?!https?:|#)[^"]*', page) == []
    assert "<img" not in page


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
