"""A program as methods does what its functions do: values, cycles, findings, places."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator import image
from emulator.c28x.memory import Object
from emulator.c28x.sites import FILE_STEP
from emulator.c28x.typed_text import ProgramPart, methods, parts, typed_text
from emulator.c28x.watcher import CallingWatcher
from emulator.image import Firmware
from emulator.system import System
from tests.emulator.c28x import linking
from tests.emulator.c28x.as_methods import AsMethods
from tests.emulator.c28x.workshop import Workshop

#: Wraps, a loop that steps beyond the end of an array, float arithmetic, a local that may be never written, calls, a
#: pointer to a function, a switch.
SOURCE = """
total: int32
table: array[uint16, 4]

def add(a: int16, b: int16) -> int16:
    return a + b

def scaled(x: float32, n: uint16) -> float32:
    y: float32 = x
    i: uint16
    for i in range(n):
        y = y * 1.5 + 0.25
    return y

def fill(n: uint16) -> uint16:
    global total
    last: uint16
    i: uint16 = 0
    while i < n:
        table[i] = i * 9
        last = table[i]
        total = total + last
        i += 1
    return last

def chosen(which: int16) -> int16:
    f: funcptr[int16, int16, int16] = add
    match which:
        case 0:
            return f(which, 32767)
        case 1 | 2:
            return add(which, add(which, which))
        case _:
            return which << 3
"""


@contextmanager
def as_methods() -> Iterator[None]:
    """Programs are linked as methods, while this lasts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(linking, "Linked", AsMethods)
        yield


def both(source: str = SOURCE, **options: Any) -> tuple[Workshop, Workshop]:
    """The same program as functions and as methods."""
    functions = Workshop(source, **options)
    with as_methods():
        return functions, Workshop(source, **options)


def seen(workshop: Workshop) -> list[Any]:
    """Everything that calls leave behind."""
    objects = {path: list(obj.data) for path, obj in workshop.linked.objects.items()}
    told = [(f.rule, f.message, f.place, f.count) for f in workshop.findings]
    return [workshop.clock.now, workshop.cpu.sp, objects, told]


@given(st.lists(st.tuples(
    st.integers(-32768, 32767), st.integers(-32768, 32767), st.floats(-1e6, 1e6, width=32), st.integers(0, 6)
), max_size=4))  # fmt: skip
def test_methods_and_functions_leave_the_same_behind(calls: list[tuple[int, int, float, int]]) -> None:
    functions, methods = both()
    for a, b, x, n in calls:
        for name, arguments in (("add", (a, b)), ("scaled", (x, n)), ("fill", (n,)), ("chosen", (a % 5,))):
            one, other = getattr(functions, name)(*arguments), getattr(methods, name)(*arguments)
            assert (repr(one), seen(functions)) == (repr(other), seen(methods))


def test_the_calls_reach_what_they_are_meant_to_reach() -> None:
    _, methods = both()
    methods.fill(6)
    methods.add(32767, 1)
    methods.fill(0)
    assert {"index", "uninitialised", "overflow"} <= set(methods.rules())


def test_a_name_that_is_bound_again_is_bound_for_methods_too() -> None:
    source = "def ready() -> int16:\n    return Ready()\n"
    header = "from emulator.c28x.language import *\n@extern\ndef Ready() -> int16: ...\n"
    functions, methods = both(source, header=header, externs={"Ready": lambda: 1})
    for workshop in (functions, methods):
        assert workshop.ready() == 1
        workshop.linked.replace("Ready", lambda: 2)
        assert workshop.ready() == 2


def test_a_function_that_others_call_directly_cannot_be_replaced() -> None:
    _, methods = both()
    with pytest.raises(ValueError, match="add cannot be replaced in a compiled program"):
        methods.linked.replace("add", lambda a, b: 0)
    assert methods.add(1, 2) == 3


def part(source: str, **options: Any) -> ProgramPart:
    """The only part of a program of one file."""
    (only,) = Workshop(source, **options).linked.parts
    return only


def test_a_part_is_known_by_its_text_its_first_place_and_whether_it_is_watched() -> None:
    linked = Workshop(SOURCE).linked
    (one,) = linked.parts
    assert one.identity == part(SOURCE).identity
    (later,) = parts(linked.compiled, one.end)
    different = [part(SOURCE.replace("1.5", "1.25")), part(SOURCE, watch=True), later]
    assert len({one.identity, *(other.identity for other in different)}) == 4


def test_the_places_of_a_file_keep_their_numbers_when_another_one_grows() -> None:
    linked = Workshop(SOURCE).linked
    (one,) = linked.parts
    assert (one.first, one.end) == (1, 1 + sum(len(each.written.places) for each in linked.compiled.functions))
    assert one.end < FILE_STEP
    for free in range(2, FILE_STEP + 2):
        assert [other.first for other in parts(linked.compiled, free)] == [1 + FILE_STEP]


@pytest.mark.parametrize("other", ["float32", "int32", "ptr[int16]"])
def test_a_part_is_known_by_the_types_of_its_variables_too(other: str) -> None:
    """Its text does not show them, and its methods have them."""
    source = "def same(x: T) -> T:\n    y: T = x\n    return y\n"
    one, another = (Workshop(source.replace("T", t)).linked for t in ("int16", other))
    assert one.sources == another.sources
    assert one.parts[0].identity != another.parts[0].identity


#: Accesses to a global, to an element, and through a pointer.
THROUGH = """
n: int16 = 3
a: array[int16, 4] = (1, 2, 3, 4)

def first(t: ptr[int16]) -> int16:
    t[1] = 5
    return t[0]

def each() -> int16:
    a[n] = first(a)
    return a[n]
"""


def test_methods_tell_a_watcher_of_the_same_accesses() -> None:
    told: list[list[tuple[str, int, bool]]] = []
    for workshop in both(THROUGH, watch=True):
        heard: list[tuple[str, int, bool]] = []

        def hear(obj: Object, word: int, write: bool, heard: list[tuple[str, int, bool]] = heard) -> None:
            heard.append((obj.declaration.name, word, write))

        workshop.linked.watch_with(CallingWatcher(hear))
        assert workshop.each() == 1
        told.append(heard)
    assert told[0] == told[1]
    assert set(told[0]) == {("n", 0, False), ("a", 0, False), ("a", 1, True), ("a", 3, True), ("a", 3, False)}


def test_a_program_is_known_by_whether_it_is_watched() -> None:
    source = "def first(t: ptr[int16]) -> int16:\n    return t[0]\n"
    plain, watched = (Workshop(source, watch=watch).linked for watch in (False, True))
    assert plain.sources == watched.sources
    assert plain.parts[0].identity != watched.parts[0].identity


def test_variables_of_c_have_types_and_what_may_be_unwritten_has_none() -> None:
    tree = ast.parse(typed_text(part(SOURCE)))
    (made,) = (node for node in tree.body if isinstance(node, ast.ClassDef))
    method = {node.name: ast.unparse(node) for node in made.body if isinstance(node, ast.FunctionDef)}
    assert list(method) == ["__init__", *methods(part(SOURCE).functions)]
    assert methods(part(SOURCE).functions) == ["add", "scaled", "fill", "chosen"]
    assert method["scaled"].startswith("def scaled(self, x: float, n: int) -> float:")
    assert "last: Any" in method["fill"]
    assert "i: int" in method["fill"]
    assert "self.add(which, self.add(which, which))" in method["chosen"]


def test_a_program_without_functions_is_a_program() -> None:
    with as_methods():
        assert Workshop("limit: int16 = 7\n").value("limit") == 7


def test_a_file_that_changes_leaves_what_is_compiled_of_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It calls functions of other files as they are by then."""
    one, other = tmp_path / "one.c", tmp_path / "other.c"
    other.write_text("float half(int x);\nint quarter(int x) { return (int)(half((int)half(x)) + 0.0f); }\n")

    def linked(statement: str) -> Firmware:
        one.write_text(f"float half(int x) {{ {statement} return x / 2.0f; }}\n")
        return image.link(System(), [str(one), str(other)])

    monkeypatch.setattr(image, "Linked", AsMethods)
    before, after = linked(""), linked("x += 4;")
    assert [p.functions[0].path for p in before.linked.parts] == ["one.half", "other.quarter"]
    changed, same = zip(before.linked.parts, after.linked.parts, strict=True)
    assert changed[0].identity != changed[1].identity
    assert same[0].identity == same[1].identity
    assert "cast(float, self._f_half(" in typed_text(same[0])
    assert (before.other.quarter(20), after.other.quarter(20)) == (5, 8)
