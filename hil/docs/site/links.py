"""Links of pages: from one to the other as they stand; to a file as a copy of it; to what is not installed as words."""

from __future__ import annotations

import posixpath
import re
import shutil
from importlib.resources import as_file, files
from pathlib import Path, PurePosixPath
from typing import Final

from hil.docs import PAGES

#: The root of the sources.
ROOT: Final = PurePosixPath()
_LINK: Final = re.compile(r"(?P<shown>!?\[[^\]\n]*\])\((?P<to>[^)\s:#]+)(?P<place>#[^)\s]*)?\)")


def mended(text: str, page: PurePosixPath, source: Path) -> str:
    """The text of a page whose links hold in the folder that the site is made from; files that it shows are put there.

    Raises ValueError for a link to something that is not there.
    """
    known = {entry.path for entry in PAGES.values()}

    def link(found: re.Match[str]) -> str:
        path = PurePosixPath(posixpath.normpath(page.parent / found["to"]))
        if path == ROOT / "README.md":
            return f"{found['shown']}({posixpath.relpath('index.md', page.parent)}{found['place'] or ''})"
        if path in known:
            to = found["to"].removesuffix(".py") + ".md" if path.suffix == ".py" else found["to"]
            return f"{found['shown']}({to}{found['place'] or ''})"
        if path.parts[0] == "tests":  # is no part of what is installed
            return found["shown"].strip("![]")
        if path.name == "CHANGELOG.md":
            return found["shown"].strip("![]")
        file = files(path.parts[0]).joinpath(*path.parts[1:])
        if not file.is_file():
            raise ValueError(f"{page}: a link to {path}, which is not there")
        (source / path).parent.mkdir(parents=True, exist_ok=True)
        with as_file(file) as real:
            shutil.copyfile(real, source / path)
        return found[0]

    return _LINK.sub(link, text)
