"""What a float division costs by the build; what it gives is the same in all of them."""

from __future__ import annotations

import pytest

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION, FLOAT_DIVISIONS
from tests.emulator.c28x.workshop import Workshop

SOURCE = """
def by_a_variable(a: float32, b: float32) -> float32:
    return a / b

def by_a_constant(a: float32) -> float32:
    return a / 2.3

def times(a: float32) -> float32:
    return a * 2.3

def of_integers(a: int16, b: int16) -> int16:
    return a / b
"""


def cycles(build: str, function: str, *arguments: float) -> tuple[int, float]:
    """What a call takes, and gives."""
    shop = Workshop(SOURCE, float_division=build)
    before = shop.clock.now
    result = getattr(shop, function)(*arguments)
    return shop.clock.now - before, result


@pytest.mark.parametrize(
    ("build", "price"),
    [
        ("calibrated", 60),  # what the factors of the robot's firmware were fitted with
        ("tmu", 5),  # DIVF32: 5 cycles (TMU instruction set)
        ("fast", 23),  # counted in TI's fast library
        ("standard", 221),  # counted: 217, and LCR's 4
    ],
)
def test_the_build_decides_what_a_division_by_a_variable_costs(build: str, price: int) -> None:
    longer = cycles(build, "by_a_variable", 7.0, 2.0)[0] - cycles("tmu", "by_a_variable", 7.0, 2.0)[0]
    assert longer == price - 5


@pytest.mark.parametrize("build", FLOAT_DIVISIONS)
def test_a_relaxed_build_multiplies_by_the_inverse_of_a_constant(build: str) -> None:
    # SPRU514, --fp_mode=relaxed: division by a constant is converted to inverse multiplication.
    longer = cycles(build, "by_a_constant", 7.0)[0] - cycles(build, "times", 7.0)[0]
    assert (longer == 0) == (build in ("tmu", "fast"))


@pytest.mark.parametrize("build", FLOAT_DIVISIONS)
def test_neither_results_nor_other_operations_depend_on_it(build: str) -> None:
    for function, arguments in (("by_a_variable", (7.0, 3.0)), ("by_a_constant", (7.0,)), ("of_integers", (7, 3))):
        assert cycles(build, function, *arguments)[1] == cycles(DEFAULT_FLOAT_DIVISION, function, *arguments)[1]
    assert cycles(build, "of_integers", 7, 3)[0] == cycles(DEFAULT_FLOAT_DIVISION, "of_integers", 7, 3)[0]
    assert cycles(build, "times", 7.0)[0] == cycles(DEFAULT_FLOAT_DIVISION, "times", 7.0)[0]


def test_a_build_that_is_not_known_is_refused() -> None:
    with pytest.raises(ValueError, match="float division 'slow': one of calibrated, tmu, fast, standard"):
        Workshop(SOURCE, float_division="slow")
