"""Every rule of this package finds its defect at the right line, and nothing in the correct twin."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.rules import RULES, source
from tests.emulator.c28x.specimens import (
    MARK,
    Driver,
    Pair,
    construct_arithmetic,
    construct_control,
    construct_objects,
    counters,
    divisions,
    driver_arithmetic,
    driver_control,
    driver_data,
    idioms,
    indices,
    integers,
    octets,
    pointers,
    regulators,
    static_flow,
    static_names,
    static_values,
    static_waiting,
    uninitialised,
)  # fmt: skip
from tests.emulator.c28x.workshop import HEADER, Workshop

_PAIRS = (
    uninitialised, indices, pointers, integers, octets, divisions, counters, idioms, regulators,
    static_flow, static_names, static_values, static_waiting,
)  # fmt: skip
_DRIVERS = (
    driver_arithmetic, driver_data, driver_control, construct_arithmetic, construct_control, construct_objects,
)  # fmt: skip
PAIRS = tuple(pair for theme in _PAIRS for pair in theme.PAIRS)
DRIVERS = tuple(driver for theme in _DRIVERS for driver in theme.DRIVERS)
LIBRARY = "from emulator.c28x.language import *\nfrom emulator.c28x.rts import *\n"
FILLS = ("zero", "ones", "nan", "random:7", "stack")


def run(pair: Pair, source: str, **options: Any) -> tuple[Workshop, list[object]]:
    shop = Workshop(source, **options)
    results: list[object] = [getattr(shop, name)(*arguments) for name, arguments in pair.calls]
    shop.runtime.finish()
    return shop, results


def marked_line(source: str) -> int:
    lines = (HEADER + source).splitlines()
    (line,) = (number for number, text in enumerate(lines, 1) if MARK in text)
    return line


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.id)
def test_the_defect_is_found_at_its_line(pair: Pair) -> None:
    shop, _ = run(pair, pair.defect, static=pair.how == "static", watch=pair.watch)
    found = [(f.rule, f.how, f.place.line if f.place else 0) for f in shop.findings]
    assert (pair.rule, pair.how, marked_line(pair.defect)) in found


def test_every_rule_has_a_specimen_for_each_way_in_which_it_is_found() -> None:
    families = ("memory", "arithmetic", "static")
    of_c = {rule.id for rule in source.RULES}  # what only a reader of C can notice: tests/emulator/c28x/readers/c
    ways = {
        (rule.id, how)
        for rule in RULES.values()
        if rule.family in families and rule.id not in of_c
        for how in rule.how.split("/")
    }
    assert {(pair.rule, pair.how) for pair in PAIRS if RULES[pair.rule].family in families} == ways


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.id)
def test_the_correct_twin_is_silent(pair: Pair) -> None:
    shop, _ = run(pair, pair.correct, static=True, watch=True)
    assert [(f.rule, f.message) for f in shop.findings] == []


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.id)
def test_the_correct_twin_gives_one_result_however_it_is_linked(pair: Pair) -> None:
    expected = run(pair, pair.correct)[1]
    for fill in FILLS:
        for watched in (False, True):
            assert run(pair, pair.correct, fill=fill, watch=watched)[1] == expected
    assert run(pair, pair.correct, watch=True)[1] == expected


@pytest.mark.parametrize("driver", DRIVERS, ids=lambda driver: driver.name)
def test_a_correct_driver_is_silent_and_right(driver: Driver) -> None:
    options: dict[str, Any]
    for options in ({"static": True, "watch": True}, {}, {"watch": True}, {"fill": "nan"}, {"fill": "stack"}):
        shop = Workshop(driver.source, header=LIBRARY, **options)
        results = [(arguments, getattr(shop, driver.function)(*arguments)) for arguments, _ in driver.results]
        assert results == list(driver.results)
        assert [(f.rule, f.place and f.place.line, f.message) for f in shop.findings] == []


@pytest.mark.parametrize("source", [p.defect for p in PAIRS], ids=[p.id for p in PAIRS])
def test_a_random_fill_is_the_same_plain_and_watched(source: str) -> None:
    pair = next(p for p in PAIRS if p.defect == source)
    plain, watched = (run(pair, source, fill="random:3", watch=c)[1] for c in (False, True))
    assert [repr(x) for x in plain] == [repr(x) for x in watched]
