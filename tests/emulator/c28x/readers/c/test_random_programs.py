"""Random programs leave the same trace here, plain and watched, as through a compiler for a 16-bit int in a simulator.

`HIL_PROGRAMS=2000` runs more of them, `HIL_FIRST=500` begins at another seed.
"""

from __future__ import annotations

import os
import re

import pytest

from tests.emulator.c28x.readers.c import avr
from tests.emulator.c28x.readers.c.random_programs import TRACE, program
from tests.emulator.c28x.readers.c.test_programs import WRONG
from tests.emulator.c28x.readers.c.workshop import CWorkshop

FIRST = int(os.environ.get("HIL_FIRST", "0"))
SEEDS = range(FIRST, FIRST + int(os.environ.get("HIL_PROGRAMS", "80")))
CALLS = ("(p_run(), p_at(0))", *(f"p_at({i})" for i in range(1, TRACE)))

with_avr = pytest.mark.skipif(bool(avr.missing()), reason=f"not installed: {avr.missing()}")


def trace(text: str, *, watch: bool) -> list[int]:
    """What the program leaves on this machine; it has no undefined behaviour, so nothing may be found that says so."""
    shop = CWorkshop(text, watch=watch)
    shop.call("p_run")
    assert not WRONG & set(shop.rules())
    return [shop.call("p_at", i) for i in range(TRACE)]


@with_avr
@pytest.mark.parametrize("seed", SEEDS)
def test_a_random_program_leaves_the_trace_that_another_compiler_gives_it(seed: int) -> None:
    text = program(seed)
    expected = avr.results({"p.c": text}, CALLS)
    assert trace(text, watch=False) == expected
    assert trace(text, watch=True) == expected


@with_avr
@pytest.mark.parametrize("seed", SEEDS[:10])
def test_a_random_program_means_the_same_however_it_is_optimised(seed: int) -> None:
    # What is undefined mostly shows as a difference between the two.
    text = program(seed)
    assert avr.results({"p.c": text}, CALLS, optimise="-O0") == avr.results({"p.c": text}, CALLS, optimise="-O3")


def test_a_seed_makes_the_same_program_each_time_and_another_one_another() -> None:
    assert program(1) == program(1)
    assert program(1) != program(2)


def test_programs_of_two_prefixes_share_no_name() -> None:
    names = [set(re.findall(rf"\b{prefix}\w+", program(3, prefix))) for prefix in ("a_", "b_")]
    assert names[0]
    assert not names[0] & names[1]
    assert {name.removeprefix("a_") for name in names[0]} == {name.removeprefix("b_") for name in names[1]}


def test_together_the_programs_use_all_of_the_language_that_is_asked_for() -> None:
    texts = "".join(program(seed) for seed in range(20))
    wanted = (
        "long long", "switch", "default:", "for (", "while (", "do {", "break;", "continue;", " ? ", "&&", "||", "<<=",
        ">>=", "%=", "++", "--", "->", "static ", "volatile ", "struct p_t ", "*p_p", "p_table[", "unsigned char",
    )  # fmt: skip
    assert [word for word in wanted if word not in texts] == []
