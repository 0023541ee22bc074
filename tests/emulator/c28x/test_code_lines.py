"""The code of a function has the source's lines: each instruction that of the text's line it was made of."""

from __future__ import annotations

from types import CodeType

from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.compiled_program import CompiledFunction
from emulator.c28x.ctypes import VOID, FunctionType
from emulator.c28x.emit.names import FunctionNames
from emulator.c28x.emit.written import EmittedFunction
from emulator.c28x.tree import Function, Where

#: 20 lines with a loop, branches, a long run of code in one line and an inner function.
TEXT = "\n".join([
    "def f(a, b=2):",
    "    while a < 10:",
    "        a += 1",
    "        if a == 3:",
    "            continue",
    "        b = " + " + ".join(["a * b"] * 40),
    "    else:",
    "        b = 0",
    "    for i in range(3):",
    "        b -= i",
    "    g = lambda x: (",
    "        x + 1",
    "    )",
    "    try:",
    "        a = g(",
    "            b",
    "        )",
    "    finally:",
    "        b = 1",
    "    return a, b",
])  # fmt: skip


def lines(code: CodeType) -> list[int | None]:
    """The line of each unit of code, inner code behind it."""
    found = [line for start, end, line in code.co_lines() for _ in range(start, end, 2)]
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            found += lines(inner)
    return found


@given(numbers=st.lists(st.integers(1, 1 << 20), min_size=20, max_size=20))
def test_each_unit_of_code_has_the_number_of_its_line(numbers: list[int]) -> None:
    function = Function("f", "drv", FunctionType("f", VOID, ()), [], 1, "drv.c", where=Where("drv.py", 1))
    written = EmittedFunction(TEXT, tuple(numbers), (), FunctionNames("f", lambda block, name: False))
    made = CompiledFunction(function, written).code
    plain = compile(TEXT, "drv.py", "exec", dont_inherit=True)
    assert lines(made) == [None if line is None else numbers[line - 1] for line in lines(plain)]
    space: dict[str, object] = {}
    exec(made, space)
    (entered,) = (c for c in made.co_consts if isinstance(c, CodeType))
    assert entered.co_firstlineno == numbers[0]
    # a is 10 and ends the loop; b is 0, then 0 - 0 - 1 - 2 = -3; a is -3 + 1, b is 1.
    assert space["f"](9, 0) == (-2, 1)  # type: ignore[operator]
