"""C files that lie beside headers: a program takes of them what it uses and no file of it defines."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.link import LinkError
from emulator.c28x.readers.c.neighbour_files import NeighbourFiles, functions, objects
from hil.drivers.check import DriverFiles, check_files
from hil.image import Build

OWN = """#include "led.h"
unsigned int Blink(void)
{
    return LED_toggle(3);
}
"""
LED_H = (
    "#ifndef LED_H\n#define LED_H\nunsigned int LED_toggle(unsigned int n);\nvoid LED_off(unsigned int n);\n#endif\n"
)
LED_C = """#include "led.h"
#include "port.h"
static unsigned int Unused;
unsigned int LED_toggle(unsigned int n)
{
    PORT_set(1 << n);
    return PORT_get();
}
void LED_off(unsigned int n) { PORT_set(0); }
"""
PORT_H = "void PORT_set(unsigned int word);\nunsigned int PORT_get(void);\n"
PORT_C = '#include "port.h"\nunsigned int PORT_Word;\nvoid PORT_set(unsigned int word) { PORT_Word = word; }\n'
PORT_C += "unsigned int PORT_get(void) { return PORT_Word; }\n"
WRONG_C = "void Other(void) { this is no C; }\n"


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A library of two files, one of which uses the other, and one that nobody uses and nobody could read."""
    folder = tmp_path / "library"
    folder.mkdir()
    files = {"led.h": LED_H, "led.c": LED_C, "port.h": PORT_H, "port.c": PORT_C, "wrong.c": WRONG_C}
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    (tmp_path / "led.c").write_text(OWN, encoding="utf-8")
    return folder


def test_what_a_program_uses_is_linked_and_what_that_uses(library: Path) -> None:
    # The user's file may be called like one of the library.
    build = Build([str(library.parent / "led.c")], include=[library])
    assert sorted(build.program.modules) == ["led", "library.led", "library.port"]
    assert build.image().call("led.Blink", []) == 8


TABLE_H = "struct Part { unsigned int pin; };\nextern const struct Part Parts[2];\nextern unsigned int Level;\n"
TABLE_C = '#include "table.h"\nconst struct Part Parts[2] = { {4}, {6} };\n'


def test_an_object_that_a_program_uses_is_linked(library: Path) -> None:
    (library / "table.h").write_text(TABLE_H, encoding="utf-8")
    (library / "table.c").write_text(TABLE_C, encoding="utf-8")
    (library / "level.c").write_text('#include "table.h"\nunsigned int Level;\n', encoding="utf-8")
    text = '#include "table.h"\nunsigned int Second(void)\n{\n    return Parts[1].pin;\n}\n'
    (library.parent / "led.c").write_text(text, encoding="utf-8")
    build = Build([str(library.parent / "led.c")], include=[library])
    assert sorted(build.program.modules) == ["led", "library.table"]  # nobody uses Level
    assert build.image().call("led.Second", []) == 6


def test_a_library_is_not_checked_by_itself(library: Path) -> None:
    checked = check_files(DriverFiles([library.parent / "led.c"], [library], calls=2))
    assert [function.name for function in checked.functions] == ["Blink"]
    assert checked.findings == []


def test_without_the_folder_the_error_says_what_is_missing(library: Path) -> None:
    text = OWN.replace('#include "led.h"', "unsigned int LED_toggle(unsigned int n);")
    (library.parent / "led.c").write_text(text, encoding="utf-8")
    with pytest.raises(LinkError, match=r"led\.c:4:12: LED_toggle is declared, and no file defines it"):
        Build([str(library.parent / "led.c")]).image()


def test_sources_lie_in_source_beside_include_too(library: Path, tmp_path: Path) -> None:
    library.rename(tmp_path / "source")
    (tmp_path / "include").mkdir()
    for header in ("led.h", "port.h"):
        (tmp_path / "source" / header).rename(tmp_path / "include" / header)
    build = Build([str(tmp_path / "led.c")], include=[tmp_path / "include"])
    assert "source.port" in build.program.modules


def test_another_program_is_no_library(library: Path) -> None:
    (library / "port.c").write_text(PORT_C + "void main(void) { }\n", encoding="utf-8")
    assert NeighbourFiles([library]).file("PORT_set") is None


def test_a_link_that_leaves_the_folder_is_not_followed(library: Path, tmp_path: Path) -> None:
    (library / "port.c").rename(tmp_path / "port.c")
    (library / "port.c").symlink_to(tmp_path / "port.c")
    assert NeighbourFiles([library]).file("PORT_set") is None


@pytest.mark.parametrize(("text", "found"), [
    ("int f(void)\n{\n}\n", ["f"]),
    ("int f(void);\nint g(int (*of)(int), int n)\n{ return h(1); }\n", ["g"]),
    ("/* int no(void) { */ static inline int f(int a) { if (a) { b(); } } // int not(void) {", ["f"]),
    ('char *s = "f(void) {"; int n = \'{\';\n#define m(x) { x }\nvoid g(void) { }', ["g"]),
    ("struct s { int a; }; int list[] = { 1, 2 };\nint f(a) int a; { return a; }\n", []),
    ("} } int f(void) {", ["f"]),
])  # fmt: skip
def test_beginnings_of_functions(text: str, found: list[str]) -> None:
    assert list(functions(text)) == found


@pytest.mark.parametrize(("text", "found"), [
    ("int a;\nint b = 3;\nconst char *c = \"x = 1;\";\nint d[2][3] = { {1}, {2} };\n", ["a", "b", "c", "d"]),
    ("extern int a;\nstatic int b;\ntypedef int c;\nstruct s;\nenum e { A = 1, B };\nint f(void);\n", []),
    ("volatile struct R *Rs[3] =\n{ 0, &A, &B };\nint f(void) { int x = 1; y = 2; }\nlong last;\n", ["Rs", "last"]),
    ("struct s { int a; } x;\nint (*g)(void);\nint a = 1, b = 2;\n", ["a"]),
])  # fmt: skip
def test_definitions_of_objects(text: str, found: list[str]) -> None:
    assert list(objects(text)) == found


@pytest.mark.parametrize("text", ["/* ", "a", "a(", "a() ", "a(b() ", " ", '"', "'a", "\\\n#", "{a(){"])
def test_a_hostile_file_of_a_megabyte_is_searched_once(text: str) -> None:
    found = list(functions("int f(void) { } " + text * (1_000_000 // len(text)) + "{"))
    assert found[0] == "f"
    found = list(objects("int a; " + text * (1_000_000 // len(text)) + ";"))
    assert found[0] == "a"


@given(st.text(alphabet="abc(){};\"'/*#\\\n ", max_size=200))
def test_any_text_is_searched(text: str) -> None:
    assert all(name.isidentifier() for name in (*functions(text), *objects(text)))
