"""The same functions in both languages, and what is told where they differ."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.diff.calls import Caller
from hil.diff.trees import Trees, compare_trees
from hil.image import Build

PORT = """from emulator.c28x.language import *

level: int16 = 3


def scaled(x: int16, by: int16) -> int16:
    i: int16 = 0
    if x > 0:
        x = x * by
    else:
        for i in range(0, by):
            x = x + 4
    return x
"""
C = """int level = 3;

int scaled(int x, int by)
{
    int i = 0;
    if (x > 0)
        x = x * by;
    else
        for (i = 0; i < by; i++)
            x = x + 4;
    return x;
}
"""


def builds(folder: Path, c: str, python: str = PORT) -> tuple[Build, Build]:
    (folder / "filter.py").write_text(python)
    (folder / "filter.c").write_text(c)
    return Build([str(folder / "filter.py")]), Build([str(folder / "filter.c")])


def compared(folder: Path, c: str, python: str = PORT) -> Trees:
    port, own = builds(folder, c, python)
    return compare_trees(port.compiled, own.compiled, ["filter"])


def test_the_same_functions_in_both_languages_have_equal_trees(tmp_path: Path) -> None:
    found = compared(tmp_path, C)
    assert found.equal == ["filter.scaled"]
    assert not found.differences


def test_a_function_that_the_c_file_keeps_to_itself_is_called_as_in_the_port(tmp_path: Path) -> None:
    helper = "static int raised(int x)\n{\n    return x + 4;\n}\n\n"
    port = PORT.replace("def scaled", "def raised(x: int16) -> int16:\n    return x + 4\n\n\ndef scaled")
    trees = compared(
        tmp_path, C.replace("int scaled", helper + "int scaled").replace("x = x + 4", "x = raised(x)"),
        port.replace("x = x + 4", "x = raised(x)").replace("x += 4", "x = raised(x)"),
    )  # fmt: skip
    assert trees.equal == ["filter.raised", "filter.scaled"]
    assert not trees.differences


def test_names_of_locals_do_not_matter(tmp_path: Path) -> None:
    renamed = C.replace("int i = 0", "int turn = 0").replace("i = 0; i < by; i++", "turn = 0; turn < by; turn++")
    assert compared(tmp_path, renamed).equal == ["filter.scaled"]


@pytest.mark.parametrize(
    ("old", "new", "places", "cause"),
    [
        ("x + 4", "x + 5", ("filter.py:12", "filter.c:10"), "other constant: 4 in the port, 5 in the C"),
        ("x * by", "by * x", ("filter.py:9", "filter.c:7"), "other operand order: x * by in the port, by * x in the C"),
        ("x > 0", "x >= 0", ("filter.py:8", "filter.c:6"), "other operator: x > 0 in the port, x >= 0 in the C"),
        ("int i = 0", "long i = 0", ("filter.py:7", "filter.c:5"), "other type: i is int in the port, long in the C"),
        ("x = x * by", "level = x", ("filter.py:9", "filter.c:7"), "x in the port, level in the C"),
    ],
)  # fmt: skip
def test_a_difference_is_told_with_both_places_and_its_cause(
    tmp_path: Path, old: str, new: str, places: tuple[str, str], cause: str
) -> None:
    found = compared(tmp_path, C.replace(old, new))
    assert list(found.functions) == ["filter.scaled"]
    first = found.functions["filter.scaled"][0]
    assert first.port == places[0]
    assert first.own.startswith(places[1])
    assert cause in first.cause


COSINE = """from emulator.c28x.language import *
from emulator.c28x.rts import cos


def shadow(x: float32) -> float32:
    return cos(x) * 2.5
"""


@pytest.mark.parametrize("declared", ["#include <math.h>", "extern double cos(double x); extern float cosf(float x);"])
@pytest.mark.parametrize(
    "value", ["cos(x) * 2.5", "cosf(x) * 2.5f", "(float)cos((double)x) * 2.5", "2.5"], ids=lambda value: value
)
def test_double_is_float_here_so_that_cosf_is_cos(tmp_path: Path, declared: str, value: str) -> None:
    # CC table 6-1 (COFF): both have 32 bits, and the library has one function for both.
    found = compared(tmp_path, f"{declared}\nfloat shadow(float x)\n{{\n    return {value};\n}}\n", COSINE)
    assert found.equal == (["filter.shadow"] if "cos" in value else [])


def test_a_declaration_in_another_block_is_told_once_with_its_cycles(tmp_path: Path) -> None:
    # `int i = 0` costs the same cycles in the else: they are moved there, nothing else differs.
    moved = C.replace("    int i = 0;\n", "").replace("    else\n", "    else {\n        int i = 0;\n")
    found = compared(tmp_path, moved.replace("x + 4;\n", "x + 4;\n    }\n"))
    (difference,) = found.differences
    assert difference.cause.startswith("declared elsewhere: the C declares i in the else, the port at the top: ")
    assert difference.cause.endswith("cycles moved")


def test_what_only_one_side_has_and_other_initial_values_are_told(tmp_path: Path) -> None:
    found = compared(tmp_path, C.replace("level = 3", "level = 7") + "int extra(void) { return 1; }\n")
    causes = {d.what: d.cause for d in found.differences}
    assert causes == {
        "filter.extra": "only the C has this function",
        "filter.level": "other initial value: 3 in the port, 7 in the C",
    }


def test_calls_show_a_difference_that_a_caller_can_see_with_its_arguments(tmp_path: Path) -> None:
    port, own = builds(tmp_path, C.replace("x * by", "x + by"))
    called = Caller(port, own, calls=20, seed=1).compare("filter.scaled")
    # scaled(2, 3) is 6 here and 5 there; with both 1, the second list, it is 1 and 2.
    assert called.differences[0].cause.startswith("other result: 1 in the port, 2 in the C; called as scaled(1, 1)")


def test_calls_of_functions_that_only_differ_in_order_show_nothing(tmp_path: Path) -> None:
    port, own = builds(tmp_path, C.replace("x * by", "by * x"))
    called = Caller(port, own, calls=20, seed=1).compare("filter.scaled")
    assert (called.differences, called.calls > 10) == ([], True)
