"""An overlay says only what differs: with none of its corrections active, it is the faithful function."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import firmware_model
import firmware_model.corrections
from emulator.c28x.compile import compile_program
from emulator.c28x.compiled_program import Compiled
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.readers.python.preprocessor import fixed_ids, preprocess
from emulator.c28x.symbols import NotAlike
from firmware_model.catalogue import CATALOGUE
from firmware_model.corrections import ALL, overlays, resolve
from firmware_model.image import MODULES, link
from hil.audit.rig import Rig
from hil.robot.board import RobotBoard
from tests.emulator.c28x.likeness import parts

OVERLAYS = sorted(p for p in Path(firmware_model.corrections.__file__).parent.glob("*.py") if p.stem != "__init__")


def faithful_source(overlay: Path) -> Path:
    package = Path(firmware_model.__file__).parent
    return next(p for p in (package / overlay.name, package / "board_support" / overlay.name) if p.exists())


def functions(tree: ast.Module) -> dict[str, ast.FunctionDef]:
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


def text(function: ast.FunctionDef) -> str:
    return ast.unparse(function)


@pytest.mark.parametrize("overlay", OVERLAYS, ids=lambda p: p.stem)
def test_an_overlay_without_corrections_is_the_faithful_function(overlay: Path) -> None:
    faithful = functions(ast.parse(faithful_source(overlay).read_text(encoding="utf-8")))
    plain = functions(preprocess(ast.parse(overlay.read_text(encoding="utf-8")), frozenset()))
    for name in plain.keys() & faithful.keys():
        assert text(plain[name]) == text(faithful[name])


@pytest.mark.parametrize("overlay", OVERLAYS, ids=lambda p: p.stem)
def test_an_overlay_replaces_nothing_without_a_reason(overlay: Path) -> None:
    tree = ast.parse(overlay.read_text(encoding="utf-8"))
    faithful = functions(ast.parse(faithful_source(overlay).read_text(encoding="utf-8")))
    for name, function in functions(tree).items():
        if name in faithful:
            assert fixed_ids(function), f"{name} is repeated without a correction"


def test_every_correction_of_code_stands_in_an_overlay_and_the_other_way_round() -> None:
    mentioned = set().union(*(fixed_ids(ast.parse(p.read_text(encoding="utf-8"))) for p in OVERLAYS))
    assert mentioned == {d.id for d in CATALOGUE.values() if d.in_firmware}


def test_overlays_import_like_any_module() -> None:
    for overlay in OVERLAYS:
        importlib.import_module(f"firmware_model.corrections.{overlay.stem}")


def test_the_image_links_with_all_corrections() -> None:
    assert link(RobotBoard(), fixes=["all"]).us.Read_Distance.text


@cache
def told_without_corrections() -> set[str]:
    return {f.message for f in Rig([], static=True).findings}


@given(st.sets(st.sampled_from(sorted(resolve([ALL])))))
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_corrections_link_and_leave_nothing_of_the_others(fixes: set[str]) -> None:
    left_over = {"never-called", "unused-object", "unused-parameter"}
    told = {f.message for f in Rig(fixes, static=True).findings if f.rule in left_over}
    assert told <= told_without_corrections()


def test_what_an_overlay_adds_is_used_by_some_correction() -> None:
    trees = {overlay: ast.parse(overlay.read_text(encoding="utf-8")) for overlay in OVERLAYS}
    nodes = [node for tree in trees.values() for node in ast.walk(tree)]
    mentioned = {node.id for node in nodes if isinstance(node, ast.Name)}
    for overlay, tree in trees.items():
        faithful = functions(ast.parse(faithful_source(overlay).read_text(encoding="utf-8")))
        added = functions(tree).keys() - faithful.keys()
        assert added <= mentioned


def test_an_unknown_correction_is_named_with_its_neighbours() -> None:
    with pytest.raises(ValueError, match=r"'US-acumulator' is no correction: did you mean US-accumulator"):
        resolve(["US-acumulator"])


IDS = sorted(d.id for d in CATALOGUE.values() if d.in_firmware)
#: Corrections of functions, of objects and of constants, in several files.
SOME = {"US-median-even", "MAIN-hidden-names", "GYRO-dead-band", "SERV-distances-apart", "MAIN-comp-undefined"}


#: The number of groups of three: their corrections are far from one another, in different files.
THREES = len(IDS) // 3


def translated(fixes: Sequence[str], like: Compiled | None = None) -> Compiled:
    board = RobotBoard()
    corrected = overlays((*MODULES, "firmware_model.board_support.xbee"))
    program = Program(MODULES, overlays=corrected, fixes=resolve(fixes), like=like and like.program)
    return compile_program(
        program, CompileOptions(static=True), lambda block, name: board.register(block, name).looked_at, like
    )


@lru_cache(maxsize=1)
def other() -> tuple[Compiled, dict[str, Any]]:
    """A program to take functions from, and what it consists of."""
    like = translated(["US-accumulator"])
    return like, parts(like)


@pytest.mark.parametrize(
    "fixes",
    [*([i] for i in sorted(SOME)), *(pytest.param(IDS[n::THREES], marks=pytest.mark.slow) for n in range(THREES))],
    ids=" ".join,
)
def test_a_program_with_corrections_may_be_like_one_with_another(fixes: list[str]) -> None:
    like, before = other()
    try:
        made = translated(fixes, like)
    except NotAlike:  # a few change what is known of objects that other functions use
        assert not SOME.issuperset(fixes)
        return
    assert parts(made) == parts(translated(fixes))
    assert parts(like) == before
