"""One name, one thing: a class name is defined once in the three packages."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

_ROOT = Path(__file__).parents[1]
#: What `hil new` writes: the user's own.
_DATA = ("hil/project/template",)
#: Module -> why its classes are defined twice in it.
_TWICE = {
    "emulator/c28x/language.py": "the words of the language: once for the type checker, once for the interpreter",
}


def test_a_class_name_means_one_thing() -> None:
    places: dict[str, list[str]] = defaultdict(list)
    for package in ("emulator", "firmware_model", "hil"):
        for file in sorted((_ROOT / package).rglob("*.py")):
            path = file.relative_to(_ROOT).as_posix()
            if path.startswith(_DATA):
                continue
            classes = [node for node in ast.walk(ast.parse(file.read_text())) if isinstance(node, ast.ClassDef)]
            if path in _TWICE:
                classes = list({node.name: node for node in classes}.values())
            for node in classes:
                places[node.name].append(f"{path}:{node.lineno}")
    assert len(places) > 1000
    # Register classes may share a name where the manual names registers of two blocks alike.  None do today.
    assert {name: where for name, where in places.items() if len(where) > 1} == {}
