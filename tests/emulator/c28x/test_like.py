"""A program that takes functions from another one, with other corrections, is as if it were made from the start."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from emulator.c28x.compile import compile_program
from emulator.c28x.compiled_program import Compiled
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.symbols import NotAlike
from tests.emulator.c28x.likeness import parts

HEADER = """
from emulator.c28x.language import *

LIMIT = 10


class PAIR(struct):
    a: int16
    b: uint16


shared: PAIR
level: uint16 = 0


def Scale(x: int16) -> int16:
    return 2 * x
"""
DRIVER = """
from emulator.c28x.language import *
from likeheader import LIMIT, PAIR, Scale, level, shared

table: array[int16, 4] = [1, 2, 3, 4]
count: uint16 = 0
spare: int16 = 0


def Alone(x: int16) -> int16:
    seen: static[int16] = 0
    seen += 1
    return x + seen


def Scaled(x: int16) -> int16:
    return Scale(x) + LIMIT


def Member() -> uint16:
    return shared.b


def Step(by: int16) -> void:
    count = count - by
    level = count


def Set(to: int16) -> void:
    count = uint16(to)


def Clip() -> void:
    level = count


def Read(n: uint16) -> int16:
    return table[n]


def Unused() -> int16:
    return spare
"""
OVER_HEADER = """
from emulator.c28x.language import *
from likeheader import LIMIT, level

HELP = 3
if FIXED("limit"):
    LIMIT = 20
if FIXED("type"):
    class PAIR(struct):
        b: uint16
        a: int16
    shared: PAIR


def Help(x: int16) -> int16:
    return x + HELP if FIXED("help") else x


def Scale(x: int16) -> int16:
    if FIXED("scale"):
        return Help(x)
    return 2 * x
"""
OVER_DRIVER = """
from emulator.c28x.language import *
from likedriver import count, spare, table
from likeheader import level

if FIXED("spare"):
    del spare
    def Unused() -> int16:
        return 0
if FIXED("table"):
    table: array[int16, 5] = [5, 6, 7, 8, 9]


def Fill(to: ptr[uint16]) -> void:
    to[0] = 7


def Clip() -> void:
    if FIXED("limited"):
        if count > 100:
            count = 100
    level = count


def Step(by: int16) -> void:
    if FIXED("exposed"):
        Fill(addressof(level))
    count = count - by
    level = count
"""
FIXES = ("limit", "type", "help", "scale", "spare", "table", "limited", "exposed")
Maker = Callable[[frozenset[str], Compiled | None], Compiled]


@pytest.fixture(scope="module")
def make(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Maker]:
    """Compiles the driver with corrections, like another program or from the start."""
    folder = tmp_path_factory.mktemp("like")
    texts = {"likeheader": HEADER, "likedriver": DRIVER, "overheader": OVER_HEADER, "overdriver": OVER_DRIVER}
    for name, text in texts.items():
        Path(folder, f"{name}.py").write_text(text, encoding="utf-8")

    def compiled(fixes: frozenset[str], like: Compiled | None) -> Compiled:
        overlays = {"likeheader": "overheader", "likedriver": "overdriver"}
        program = Program(["likedriver"], overlays=overlays, fixes=fixes, like=like and like.program)
        return compile_program(program, CompileOptions(static=True, watch=True), lambda _block, _name: False, like)

    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        yield compiled


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(first=st.sets(st.sampled_from(FIXES), min_size=1), second=st.sets(st.sampled_from(FIXES), min_size=1))
def test_a_program_like_another_is_the_one_made_from_the_start(
    make: Maker, first: set[str], second: set[str]
) -> None:
    like = make(frozenset(first), None)
    before = parts(like)
    try:
        made = make(frozenset(second), like)
    except NotAlike:
        made = None
    assert parts(like) == before
    assume(made is not None)
    assert made is not None
    assert parts(made) == parts(make(frozenset(second), None))
    assert not parts(made)["foreign"]


@pytest.mark.parametrize(
    ("fix", "anew"),
    [
        ("scale", {"Scale", "Scaled"}),
        ("limit", {"Scaled"}),
        ("type", {"Member"}),
        ("table", {"Read"}),
        ("spare", {"Unused"}),
    ],
)
def test_only_what_a_correction_reaches_is_translated_again(make: Maker, fix: str, anew: set[str]) -> None:
    like = make(frozenset({"nothing"}), None)
    made = make(frozenset({"nothing", fix}), like)
    taken = {each.function for each in like.functions}
    assert {each.function.name for each in made.functions if each.function not in taken} == anew
    assert [each for each in made.functions if each.function in taken] == [
        each for each in like.functions if each.function in {one.function for one in made.functions}
    ]


@pytest.mark.parametrize("fix", ["limited", "exposed"])
def test_a_correction_that_changes_the_code_of_other_functions_takes_none(make: Maker, fix: str) -> None:
    with pytest.raises(NotAlike):
        make(frozenset({"nothing", fix}), make(frozenset({"nothing"}), None))
