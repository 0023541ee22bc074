"""What is outside the language is refused with file, line and construct."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from emulator.c28x.link import LinkError
from emulator.c28x.symbols import SourceError
from tests.emulator.c28x.workshop import Workshop


def body(*lines: str) -> str:
    return "v: array[int16, 3]\np: ptr[float32] = NULL\ndef f(a: int16) -> int16:\n" + "".join(
        f"    {line}\n" for line in lines
    )


@pytest.mark.parametrize(
    ("source", "line", "message"),
    [
        (body("return a // 2"), 6, "not an operator of C"),
        (body("return 1 < a < 3"), 6, "chained comparison"),
        (body("x = 1", "return x"), 6, "x is not a declared object"),
        (body("return y"), 6, "y is not declared"),
        (body("x: int16 = [1]", "return x"), 6, "List"),
        (body("return v"), 6, "cannot become"),
        (body("v = 3", "return 0"), 6, "not assignable"),
        (body("for x in v:", "    pass", "return 0"), 6, "range"),
        (body("a + 1", "return 0"), 6, "no effect"),
        (body("return True"), 6, "True is not C"),
        (body("return None"), 6, "None is not C"),
        (body("return a.x"), 6, "not a structure"),
        (body("return a[0]"), 6, "cannot be indexed"),
        (body("return f(1, 2)"), 6, "takes 1 arguments"),
        (body("return nosuch(1)"), 6, "nosuch is not declared"),
        (body("with a:", "    pass"), 6, "With"),
        (body("x: int16", "x: int16", "return 0"), 7, "declared twice"),
        (body("return p & 1"), 6, "is not C"),
        (body("return v[1.5]"), 6, "index must be an integer"),
        (body("match a:", "    case x:", "        pass", "return 0"), 7, "a case is"),
        ("x: nosuch\n", 3, "not a C type"),
        ('x: "nosuch"\n', 3, "nosuch is not a C type"),
        ('x: "two words"\n', 3, "'two words' is not a C type"),
        ("x: array[int16, 0]\n", 3, "at least one element"),
        ("x: array[int16, 1 << -1]\n", 3, "a shift by -1 is not a constant"),
        ("class C:\n    pass\n", 3, "must derive from enum or struct"),
        ("def f(a) -> int16:\n    return 0\n", 3, "needs a type"),
        ("x: int16 = nosuch()\n", 3, "nosuch is not declared"),
        ("while True:\n    pass\n", 3, "While at file scope"),
        ("def f() -> int16:\n    return (\n", 4, "not Python"),
    ],
)
def test_a_construct_outside_the_language_names_file_line_and_construct(source: str, line: int, message: str) -> None:
    with pytest.raises(SourceError, match=message) as caught:
        Workshop(source)
    assert (caught.value.file, caught.value.line) == ("drv.py", line)
    assert str(caught.value).startswith(f"drv.py:{line}:{caught.value.column}: ")


@pytest.mark.parametrize(
    ("line", "column"),
    [
        ("return 1 + y", 16),  # four of indentation, `return 1 + ` are 11: y is the 16th character
        ("y = 1", 5),
        ("for a in range():", 14),
        ("for a in range(p):", 20),
        ("a = 99999999999999999999", 9),
        ("s: ptr[char] = 'ä' + y", 26),  # characters count, not their bytes
    ],
)
def test_an_error_names_the_column_of_what_is_wrong(line: str, column: int) -> None:
    with pytest.raises(SourceError) as caught:
        Workshop(body(line, *(["    pass"] if line.endswith(":") else [])))
    assert (caught.value.line, caught.value.column) == (6, column)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("A = B\nB = A\ndef f() -> int16:\n    return A\n", "#define of A leads back to itself \\(A -> B -> A\\)"),
        ("A = B\nB = A + 1\nv: array[int16, A]\n", "leads back to itself"),
        (body("return " + " + ".join(["a"] * 10000)), "more than 100 operators or calls nested within each other"),
        (body("return " + "-" * 900 + "a"), "more than 100 operators or calls nested within each other"),
        (body("return " + "not " * 5000 + "a"), "more than 100 operators or calls nested within each other"),
        (
            "x: array[int16, 200000000]\n",
            "an array of 200000000 words does not fit into the memory: the chip has 83968 words of RAM",
        ),
        ("x: uint64 = 0x10000000000000000\n", "does not fit into 64 bits"),
        ("from emulator.registers_of_mine import Regs\n", "no module emulator.registers_of_mine"),
        ("from emulator.registers.nosuch import Regs\n", "no module emulator.registers.nosuch"),
        ("x: uint8_t\n", "uint8_t is not a C type: write uchar: this chip has no type of 8 bits"),
        (body("x: uint16_t = 1", "return x"), "uint16_t is not a C type: write uint16"),
    ],
)
def test_what_the_chip_or_the_translator_cannot_hold_is_refused_at_once(source: str, message: str) -> None:
    with pytest.raises(SourceError, match=message) as caught:
        Workshop(source)
    assert caught.value.line > 2  # behind the two lines of the header


def test_a_line_ends_where_python_says_it_does() -> None:
    # A form feed and U+2028 end no line of Python, so that `y` stands in line 5 (two of the header) at column 12.
    with pytest.raises(SourceError) as caught:
        Workshop("# \f\u2028\ndef f() -> int16:\n    return y\n")
    assert (caught.value.line, caught.value.column) == (5, 12)


def test_a_zero_character_is_refused_at_its_place() -> None:
    with pytest.raises(SourceError, match="value 0 is no text") as caught:
        Workshop("x: int16 = 1\0\n")
    assert (caught.value.line, caught.value.column) == (3, 13)


def test_a_local_may_be_initialised_with_itself_as_in_c() -> None:
    w = Workshop("def f() -> uint16:\n    x: uint16 = x\n    return x\n", fill="ones")
    w.f()
    assert w.rules() == ["uninitialised"]


def test_linking_runs_no_code_of_the_host(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "package_of_a_stranger"
    package.mkdir()
    (package / "__init__.py").write_text("raise SystemExit('executed')\n")
    (package / "driver.py").write_text("from emulator.c28x.language import *\nLIMIT = 7\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    w = Workshop("from package_of_a_stranger.driver import LIMIT\ndef f() -> int16:\n    return LIMIT\n")
    assert w.f() == 7
    assert "package_of_a_stranger" not in sys.modules


def test_an_extern_that_nothing_implements_is_named() -> None:
    with pytest.raises(LinkError, match="missing"):
        Workshop("@extern\ndef missing(a: int16) -> int16: ...\ndef f() -> int16:\n    return missing(1)\n")


@pytest.mark.parametrize("fill", ["zeros", "stack:1", ""])
def test_an_unknown_fill_is_refused(fill: str) -> None:
    with pytest.raises(ValueError, match="unknown fill policy"):
        Workshop("", fill=fill)


@pytest.mark.parametrize("seed", ["x", "", "-1", "1.5", "9" * 400])
def test_a_fill_has_a_seed_like_any_other(seed: str) -> None:
    with pytest.raises(ValueError, match="fill random:SEED: expected a whole number from 0 to 999999999999999"):
        Workshop("", fill=f"random:{seed}")


def test_a_traceback_shows_the_firmware_line() -> None:
    def boom(a: int) -> int:
        raise RuntimeError("boom")

    w = Workshop(
        "@extern\ndef boom(a: int16) -> int16: ...\ndef f() -> int16:\n    return boom(1)\n", externs={"boom": boom}
    )
    with pytest.raises(RuntimeError) as caught:
        w.f()
    frames = [entry for entry in caught.traceback if str(entry.path).endswith("drv.py")]
    assert [(frame.name, frame.lineno + 1) for frame in frames] == [("f", 6)]
