"""Pictures of the pages: each stands below the command that makes it, and is made anew by the tests.

``python -m tests.pictures`` shows which there are, ``--write`` makes them again.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[1]
#: `<!-- made by: COMMAND -->`, then the picture.
_MADE: Final = re.compile(r"<!-- made by: (?P<command>[^\n]+?) -->\n!\[[^\]]*\]\((?P<file>[^)]+\.(?:png|gif))\)")
_ANY: Final = re.compile(r"!\[[^\]]*\]\((?P<file>[^):]+\.(?:png|gif))\)")


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of a page, and the command that writes a file of its name into the current folder."""

    file: Path
    command: str

    def make(self, folder: Path) -> Path:
        """Run the command in a folder.  Raises CalledProcessError."""
        words = shlex.split(self.command)
        start = [sys.executable, "-m", *words]
        search = os.pathsep.join((str(ROOT), os.environ.get("PYTHONPATH", "")))
        subprocess.run(start, cwd=folder, env={**os.environ, "PYTHONPATH": search}, check=True, capture_output=True)
        return folder / self.file.name


def pages() -> list[Path]:
    """Every page of the project."""
    return [ROOT / "README.md", *sorted((ROOT / "hil").rglob("*.md")), *sorted((ROOT / "emulator").rglob("*.md"))]


def pictures() -> list[Picture]:
    """Those with a command."""
    return [
        Picture((page.parent / found["file"]).resolve(), found["command"])
        for page in pages()
        for found in _MADE.finditer(page.read_text(encoding="utf-8"))
    ]


def shown() -> set[Path]:
    """Every picture that some page shows."""
    return {
        (page.parent / found["file"]).resolve()
        for page in pages()
        for found in _ANY.finditer(page.read_text(encoding="utf-8"))
    }


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tests.pictures", description=__doc__)
    parser.add_argument("--write", action="store_true", help="make them again")
    asked = parser.parse_args()
    for picture in pictures():
        print(picture.file.relative_to(ROOT), "   ", picture.command, flush=True)
        if asked.write:
            with tempfile.TemporaryDirectory() as folder:
                shutil.copyfile(picture.make(Path(folder)), picture.file)


if __name__ == "__main__":
    main()
