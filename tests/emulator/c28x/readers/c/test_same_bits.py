"""Names of a set of flags that are the same bit."""

from __future__ import annotations

import pytest

from emulator.c28x.readers.c.preprocessor import preprocess_text

FLAGS = "#define IDLE 0u\n#define A 0x1\n#define B (A << 1)\n#define C 0x4\n#define D Id_03\n"


@pytest.mark.parametrize(("defines", "told"), [
    ("#define E 0x4\n#define ALL (A | B | C | E)", {"E": 6}),
    ("#define E (C)\n#define F 0x4\n#define ALL E|F", {"F": 7}),
    ("#define E Id_03\n#define ALL D | E\n#define SOME (E | D)", {"E": 6}), ("#define ALL (C | A | C)", {}),
    # Another name for a flag, another bit, no flag, no list of names, and names that the file does not define.
    ("#define E C\n#define ALL (A | C | E)", {}), ("#define E 0x8\n#define ALL (A | C | E)", {}),
    ("#define NONE 0u\n#define ALL (IDLE | NONE | A)", {}), ("#define E 0x4\n#define ALL (C | (E << 1))", {}),
    ("#define E 0x4\n#define ALL(x) (C | E)", {}), ("#define ALL (X | Y)", {}),
    ("#define E E\n#define ALL (E | C)", {}), ("#define E F\n#define F E\n#define ALL (E | F | C)", {}),
    ("#define C(x) 0x4\n#define E 0x4\n#define ALL (C | E)", {}),
])  # fmt: skip
def test_two_names_of_one_bit_are_told_at_the_second(defines: str, told: dict[str, int]) -> None:
    unit = preprocess_text(f"{FLAGS}{defines}\n", "t.c")
    assert {r.name: r.where.line for r in unit.remarks if r.rule == "same-bit"} == told
