"""The page does without Tailwind: a class that no rule of the style sheet knows does nothing."""

from __future__ import annotations

import re
from pathlib import Path

import hil.robot.view
import hil.view
from hil.view.style import CSS

#: `.classes("...")`, `classes(add="...")`; what is put together at run time is left out.
CLASSES = re.compile(r"""classes\((?:\w+=)?f?"([^"]*)\"""")
FILES = [file for package in (hil.view, hil.robot.view) for file in sorted(Path(package.__path__[0]).glob("*.py"))]


def test_every_class_of_the_page_has_a_rule() -> None:
    used = {name for file in FILES for names in CLASSES.findall(file.read_text("utf-8")) for name in names.split()}
    known = set(re.findall(r"\.([a-zA-Z][\w-]*)", CSS))
    assert len(used) > 40
    assert {name for name in used if "{" not in name and "}" not in name} <= known
