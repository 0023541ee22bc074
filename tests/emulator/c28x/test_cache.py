"""Compiled programs on disk: taken while nothing has changed that they were made of, made anew otherwise."""

from __future__ import annotations

import importlib
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from emulator.c28x import cache
from emulator.c28x.compile import compile_program
from emulator.c28x.compiled_program import Compiled
from emulator.c28x.ctypes import PointerType, StructType
from emulator.c28x.options import CompileOptions
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

    monkeypatch.setattr("emulator.c28x.compile.compile_program", counted)
    return translated


def compiled(file: Path, options: CompileOptions | None = None, **asked: Any) -> Compiled:
    return cache.compiled({"names": (str(file),), **asked}, options or CompileOptions(), lambda block, name: False)


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
    counted = [
        bool(compiled(file, CompileOptions(coverage=c)).functions[0].written.counted) for c in (False, True, False)
    ]
    assert counted == [False, True, False]
    assert made == ["drv"] * 2


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package of a project, whose module `headers` gives headers."""
    package = tmp_path / f"given_{tmp_path.name}"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "headers.py").write_text("def text(name):\n    return None\n", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    return package


def test_a_change_of_the_project_that_gives_headers_is_translated(
    made: list[str], given: Path, tmp_path: Path
) -> None:  # fmt: skip
    header = importlib.import_module(f"{given.name}.headers").text
    file = tmp_path / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    compiled(file, header=header)
    compiled(file, header=header)
    assert made == ["drv"]
    (given / "types.py").write_text("LENGTH = 3\n", encoding="utf-8")
    compiled(file, header=header)
    assert made == ["drv"] * 2


def test_a_module_of_the_project_that_gives_headers_is_translated_when_it_changes(made: list[str], given: Path) -> None:
    """It is known by its size and time, as all of its package; its content is not looked at again."""
    header = importlib.import_module(f"{given.name}.headers").text
    file = given / "drv.py"
    file.write_text(SOURCE, encoding="utf-8")
    compiled(file, header=header)
    compiled(file, header=header)
    assert made == ["drv"]
    file.write_text(SOURCE.replace("2 * x", "30 * x"), encoding="utf-8")
    assert "30" in compiled(file, header=header).functions[0].written.text
    assert made == ["drv"] * 2


def test_a_structure_of_a_header_is_kept_once(made: list[str], tmp_path: Path) -> None:
    pytest.importorskip("pycparser")
    folder = tmp_path / "sources"
    folder.mkdir()
    (folder / "s.h").write_text("struct s { int a; struct s *next; };\n", encoding="utf-8")
    files = []
    for name in "fgh":
        own = "struct s { long a; };" if name == "h" else '#include "s.h"'
        files.append(folder / f"{name}.c")
        files[-1].write_text(f"{own}\nint {name}(struct s *p) {{ return p->a; }}\n", encoding="utf-8")
    for _ in range(2):
        program = cache.compiled({"names": tuple(map(str, files))}, CompileOptions(), lambda block, name: False)
    assert len(made) == 1
    pointers = {f.function.name: f.function.ctype.parameters[0] for f in program.functions}
    targets = {name: p.target for name, p in pointers.items() if isinstance(p, PointerType)}
    structures = {name: target for name, target in targets.items() if isinstance(target, StructType)}
    assert structures["f"] is structures["g"]
    assert [member.ctype.words for name in "fh" for member in structures[name].members] == [1, 2, 2]


def test_a_kept_program_of_c_needs_no_parser(made: list[str], tmp_path: Path) -> None:
    pytest.importorskip("pycparser")
    file = tmp_path / "drv.c"
    file.write_text("#include <math.h>\ndouble f(double x) { return sqrt(x); }\n", encoding="utf-8")
    compiled(file)
    (kept,) = (tmp_path / "cache").iterdir()
    content = zlib.decompress(kept.read_bytes())
    assert b"pycparser" not in content
    assert b"readers.c.types" not in content


def test_a_request_that_has_no_description_takes_nothing_from_another_one(made: list[str], tmp_path: Path) -> None:
    names = []
    for name in ("one", "two"):
        file = tmp_path / f"{name}.py"
        file.write_text(SOURCE.replace("Twice", name), encoding="utf-8")
        program = compiled(file, fixes=frozenset({"X"}), header=lambda text: None)
        names.append([function.function.name for function in program.functions])
    assert names == [["one"], ["two"]]
    assert made == ["one", "two"]
