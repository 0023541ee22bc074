"""Compiled programs on disk: taken while nothing has changed that they were made of, made anew otherwise."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from emulator.c28x import cache
from emulator.c28x.compile import Compiled, Options, compile_program
from emulator.c28x.program import Program

SOURCE = "from emulator.c28x.language import *\n\n\ndef Twice(x: int16) -> int16:\n    return 2 * x\n"


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """What was translated, and not taken from the folder."""
    monkeypatch.setenv("HIL_CACHE", str(tmp_path / "cache"))
    translated: list[str] = []

    def counted(program: Program, *arguments: Any) -> Compiled:
        translated.append(next(iter(program.modules)))
        return compile_program(program, *arguments)

    monkeypatch.setattr(cache, "compile_program", counted)
    return translated


def compiled(file: Path, options: Options | None = None, **asked: Any) -> Compiled:
    return cache.compiled({"names": (str(file),), **asked}, options or Options(), lambda block, name: False)


def test_what_has_not_changed_is_not_translated_again(made: list[str], tmp_path: Path) -> None:
    file = tmp_path / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    first, second = compiled(file), compiled(file)
    assert made == ["drv"]
    texts = [[function.written.text for function in program.functions] for program in (first, second)]
    assert texts[0] == texts[1]


@pytest.mark.parametrize(
    "change",
    [
        lambda file: file.write_text(SOURCE.replace("2 * x", "3 * x"), encoding="utf-8"),
        lambda file: [kept.write_bytes(b"damaged") for kept in (file.parent / "cache").iterdir()],
    ],
    ids=["the source", "a damaged file"],
)
def test_a_change_is_translated(made: list[str], tmp_path: Path, change: Callable[[Path], object]) -> None:
    file = tmp_path / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    compiled(file)
    change(file)
    compiled(file)
    assert made == ["drv"] * 2


def test_other_options_are_another_program(made: list[str], tmp_path: Path) -> None:
    file = tmp_path / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    counted = [bool(compiled(file, Options(coverage=c)).functions[0].written.counted) for c in (False, True, False)]
    assert counted == [False, True, False]
    assert made == ["drv"] * 2


def test_a_change_of_the_project_that_gives_headers_is_translated(
    made: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    package = tmp_path / "given"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "headers.py").write_text("def text(name):\n    return None\n", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    header = importlib.import_module("given.headers").text
    file = tmp_path / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    compiled(file, header=header)
    compiled(file, header=header)
    assert made == ["drv"]
    (package / "types.py").write_text("LENGTH = 3\n", encoding="utf-8")
    compiled(file, header=header)
    assert made == ["drv"] * 2


def test_a_module_of_the_project_that_gives_headers_is_translated_when_it_changes(
    made: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    """It is known by its size and time, as all of its package; its content is not looked at again."""
    package = tmp_path / "held"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "headers.py").write_text("def text(name):\n    return None\n", encoding="utf-8")
    file = package / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    header = importlib.import_module("held.headers").text
    compiled(file, header=header)
    compiled(file, header=header)
    assert made == ["drv"]
    file.write_text(SOURCE.replace("2 * x", "30 * x"), encoding="utf-8")
    assert "30" in compiled(file, header=header).functions[0].written.text
    assert made == ["drv"] * 2


def test_a_kept_program_of_c_needs_no_parser(made: list[str], tmp_path: Path) -> None:
    pytest.importorskip("pycparser")
    file = tmp_path / "drv.c"
    file.write_text("#include <math.h>\ndouble f(double x) { return sqrt(x); }\n", encoding="utf-8")
    compiled(file)
    (kept,) = (tmp_path / "cache").iterdir()
    content = kept.read_bytes()
    assert b"pycparser" not in content
    assert b"readers.c.types" not in content
