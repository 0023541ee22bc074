"""One C program a feature gives what was derived by hand, plain and watched; another compiler agrees."""

from __future__ import annotations

import struct

import pytest

from tests.emulator.c28x.readers.c import avr
from tests.emulator.c28x.readers.c.programs import CProgram, programs
from tests.emulator.c28x.readers.c.workshop import CWorkshop

#: Findings that would say that a program is wrong: none of the programs has undefined behaviour.
WRONG = {
    "overflow", "shift-range", "division-by-zero", "uninitialised", "index", "pointer-outside", "null-dereference",
    "dangling-pointer", "write-to-constant", "odd-access", "unsequenced", "missing-return", "nan",
}  # fmt: skip


@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
@pytest.mark.parametrize("program", programs(), ids=lambda program: program.name)
def test_a_feature_of_c_gives_what_was_derived_by_hand(program: CProgram, watched: bool) -> None:
    for expected in program.expectations:
        shop = CWorkshop(program.files, watch=watched)
        assert shop.call(expected.function, *expected.arguments) == expected.value, expected.call
        assert not WRONG & set(shop.rules()), expected.call


@pytest.mark.skipif(bool(avr.missing()), reason=f"not installed: {avr.missing()}")
@pytest.mark.parametrize("program", programs(), ids=lambda program: program.name)
def test_a_compiler_for_a_16_bit_int_gives_the_same(program: CProgram) -> None:
    portable = [e for e in program.expectations if e.portable]
    if not portable:
        pytest.skip("it shows what this chip has of its own")
    for expected, bits in zip(portable, avr.results(program.files, [e.call for e in portable]), strict=True):
        if isinstance(expected.value, float):
            assert bits == struct.unpack("<I", struct.pack("<f", expected.value))[0], expected.call
        else:
            assert bits == expected.value % 2**64, expected.call
