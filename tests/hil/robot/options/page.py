"""The page of the options, and the files on it."""

from __future__ import annotations

from pathlib import Path

import hil.robot.options
from tests import pages

PAGE = Path(hil.robot.options.__file__).with_name("README.md")
SECTIONS = pages.sections(PAGE)
#: Drivers and their tests, by name.
FILES = {name: text for blocks in SECTIONS.values() for name, text in pages.files(blocks).items()}
