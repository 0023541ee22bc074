"""README.md as a package index shows it: the build backend of pyproject.toml, which is setuptools with that text.

An index shows the text alone.  A link to a file beside it would lead nowhere, so it becomes the name of the page that
`hil docs` shows, or the words of the link; a picture becomes its words and the command that draws it, or is left out;
what is installed from a checkout is installed from the index; a command or a row that needs files of a checkout is left
out.  `[project.urls]` has no address yet: with one, links and pictures could go there.

The backend is started by its path, without anything of this project installed.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import (
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
)

__all__ = [
    "build_editable", "build_sdist", "build_wheel", "get_requires_for_build_editable", "get_requires_for_build_sdist",
    "get_requires_for_build_wheel", "prepare_metadata_for_build_editable", "prepare_metadata_for_build_wheel",
]  # fmt: skip

NAME = "c2000-hil"
#: What pyproject.toml names as its readme; made anew by each build.
TARGET = Path("build/package_index.md")
_DRAWN = re.compile(r"<!-- made by: (?P<command>.*?) -->\n!\[(?P<words>[^\]]*)\]\([^)]*\)")
_COMMENT = re.compile(r"<!--.*?-->\n?", re.DOTALL)
_PICTURE = re.compile(r"!\[[^\]]*\]\([^)]*\)\n*")
_LINK = re.compile(r"\[(?P<words>[^\]\n]*)\]\((?!https?:)(?P<to>[^)#\s]+)[^)]*\)")
#: The tests, the script of CI, the sources as text.
_OF_CHECKOUT = re.compile(r"^.*(?:tests/|&& pytest|\.ci/|grep -r).*\n", re.MULTILINE)
_INSTALL = re.compile(r"pip install -e (?:\.|'\.(?P<extras>\[[^\]]*\])')")


def described(text: str, pages: dict[str, str]) -> str:
    """README's text for an index; `pages` are the pages of `hil docs` by their path."""
    text = _DRAWN.sub(r"\g<words>: `\g<command>` draws it.", text)
    text = _OF_CHECKOUT.sub("", _PICTURE.sub("", _COMMENT.sub("", text)))
    text = _LINK.sub(lambda to: f"`hil docs {pages[to['to']]}`" if to["to"] in pages else to["words"], text)
    return _INSTALL.sub(_installed, text)


def _installed(found: re.Match[str]) -> str:
    return f"pip install '{NAME}{found['extras']}'" if found["extras"] else f"pip install {NAME}"


def write() -> None:
    """Write the text of the project in this folder, where pyproject.toml looks for it."""
    sys.path.insert(0, str(Path.cwd()))
    from hil.docs import PAGES

    pages = {str(page.path): name for name, page in PAGES.items()}
    TARGET.parent.mkdir(exist_ok=True)
    TARGET.write_text(described(Path("README.md").read_text(encoding="utf-8"), pages), encoding="utf-8")


def build_wheel(*arguments: Any, **options: Any) -> str:
    """As setuptools, so are the others."""
    write()
    return build_meta.build_wheel(*arguments, **options)


def build_editable(*arguments: Any, **options: Any) -> str:
    """See build_wheel."""
    write()
    return build_meta.build_editable(*arguments, **options)


def build_sdist(*arguments: Any, **options: Any) -> str:
    """See build_wheel."""
    write()
    return build_meta.build_sdist(*arguments, **options)


def prepare_metadata_for_build_wheel(*arguments: Any, **options: Any) -> str:
    """See build_wheel."""
    write()
    return build_meta.prepare_metadata_for_build_wheel(*arguments, **options)


def prepare_metadata_for_build_editable(*arguments: Any, **options: Any) -> str:
    """See build_wheel."""
    write()
    return build_meta.prepare_metadata_for_build_editable(*arguments, **options)
