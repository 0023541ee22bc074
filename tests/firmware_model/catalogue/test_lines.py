"""File and line of each entry.  The C files are the thesis' own: where `C2000_HIL_FIRMWARE` names their folder, the
project's reader of C says which lines a function has, and where an object is declared.
"""

from __future__ import annotations

import os
import re
from bisect import bisect_right
from pathlib import Path

import pytest

from firmware_model.catalogue import CATALOGUE, Defect, DefectKind
from firmware_model.image import link
from hil.robot.board import RobotBoard

FOLDER = os.environ.get("C2000_HIL_FIRMWARE", "")
CODE = [defect for defect in CATALOGUE.values() if defect.in_firmware]
needs_c = pytest.mark.skipif(not FOLDER, reason="C2000_HIL_FIRMWARE names no folder with the thesis' C files")


def test_what_is_wrong_in_the_code_has_a_line_and_what_is_wrong_in_the_text_has_none() -> None:
    for defect in CATALOGUE.values():
        assert (defect.line > 0) == (defect.kind is not DefectKind.FIGURE), defect.id


def test_each_entry_names_a_section_of_the_thesis() -> None:
    # Chapters 2 to 4, down to three numbers, and the annexes.
    sections = {defect.section for defect in CATALOGUE.values()}
    assert [s for s in sections if not re.fullmatch(r"TFG ([234](\.[1-5]){1,2}|annex ([24]|A\.[1-4]\.[12]))", s)] == []


@needs_c
def test_each_line_is_in_the_function_or_declares_the_object() -> None:
    begins: dict[str, list[tuple[int, str]]] = {}
    for module in link(RobotBoard(), firmware=[FOLDER]).linked.program.modules.values():
        if Path(module.file).parent == Path(FOLDER):
            functions = [(function.line, function.name) for function in module.functions]
            objects = [(each.declaration.line, each.declaration.name) for each in module.variables]
            begins[module.c_file] = sorted(functions + objects)

    def elsewhere(defect: Defect) -> bool:
        lines = [line for line, _ in begins[defect.c_file]]
        begin = lines[bisect_right(lines, defect.line) - 1]
        return (begin, defect.function) not in begins[defect.c_file]

    assert [f"{defect.id}: {defect.where}" for defect in CODE if elsewhere(defect)] == []


@needs_c
def test_each_line_holds_a_word_of_its_place() -> None:
    def words(text: str) -> set[str]:
        return set(re.findall(r"[A-Za-z_]\w*|\d+", text))

    def has_none(defect: Defect) -> bool:
        lines = (Path(FOLDER) / defect.c_file).read_text(encoding="utf-8").splitlines()
        return words(f"{defect.place} {defect.function}").isdisjoint(words(lines[defect.line - 1]))

    assert [f"{defect.id}: {defect.where}: {defect.place}" for defect in CODE if has_none(defect)] == []
