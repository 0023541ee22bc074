"""What C-shaped Python does not have is refused at its place, in one line that says what to write instead."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.program import Program
from emulator.c28x.readers.python import hints
from emulator.c28x.symbols import RegisterBlock, SourceError, Unmodelled
from tests.emulator.c28x.workshop import HEADER, Workshop

DECLARED = """class point(struct):
    x: int16
    y: int16
v: array[int16, 3]
p: ptr[float32] = NULL
q: ptr[point]
pt: point
n: int16
def g(a: int16) -> int16:
    return a
"""
#: The line of what is written first behind the header and the declarations.
FIRST = HEADER.count("\n") + DECLARED.count("\n") + 1


def refused(text: str) -> tuple[int, int, str]:
    """Line (1 is the first one of `text`), column and message of the refusal."""
    with pytest.raises(SourceError) as caught:
        Workshop(DECLARED + text)
    error = caught.value
    assert error.file == "drv.py"
    assert "\n" not in str(error)
    return error.line - FIRST + 1, error.column, str(error).split(": ", 1)[1]


def in_function(*lines: str) -> str:
    return "def f(a: int16) -> int16:\n" + "".join(f"    {line}\n" for line in lines) + "    return 0\n"


@pytest.mark.parametrize(
    ("name", "instead"),
    [
        ("uint8_t", "uchar: this chip has no type of 8 bits"), ("int8_t", "schar"), ("uint16_t", "uint16"),
        ("int16_t", "int16"), ("uint32_t", "uint32"), ("int32_t", "int32"), ("uint64_t", "uint64"),
        ("int64_t", "int64"), ("Uint16", "uint16"), ("long", "int32"), ("short", "int16"), ("unsigned", "uint16"),
        ("int", "int16"), ("double", "float32"), ("float", "float32"), ("bool", "uint16, with 1 and 0"),
        ("size_t", "uint32"), ("str", "array[char, N]"), ("list", "array[TYPE, N]"), ("dict", "class NAME(struct)"),
        ("tuple", "class NAME(struct)"), ("object", "ptr[void]"), ("ptr", "ptr[TYPE]"),
        ("array", "array[TYPE, LENGTH]"), ("void", "ptr[void]"), ("struct", "class NAME(struct)"),
        ("list[int16]", "array[TYPE, N]"),
        ("int16[3]", "array[int16, LENGTH]"), ("array[int16]", "array[int16, LENGTH]"),
        ("Optional[int16]", "ptr[TYPE], which may be NULL"), ("int16 | None", "ptr[TYPE], which may be NULL"),
        ("array[int16, 2, 3]", "array[array[TYPE, COLUMNS], ROWS]"), ("Callable", "funcptr[RESULT, PARAMETER]"),
    ],
)  # fmt: skip
def test_a_type_of_c_or_of_python_has_its_counterpart_named(name: str, instead: str) -> None:
    line, column, message = refused(in_function(f"x: {name}"))
    assert (line, column) == (2, 8)  # four of indentation, `x: ` are three
    assert instead in message


@pytest.mark.parametrize(
    ("statement", "column", "instead"),
    [
        ("a = true", 9, "write 1"), ("a = True", 9, "write 1"), ("a = False", 9, "write 0"),
        ("a = None", 9, "write NULL"), ("a = nullptr", 9, "write NULL"), ("print(a)", 5, "sprintf"),
        ("printf('x')", 5, "sprintf"), ("a = len(v)", 9, "sizeof(v) / sizeof(v[0])"),
        ("a = max(a, 1)", 9, "a if a > b else b"), ("a = min(a, 1)", 9, "a if a < b else b"),
        ("a = abs(a)", 9, "from emulator.c28x.rts import abs"), ("a = int(a)", 9, "int16"),
        ("EALLOW()", 5, "from emulator.device_h import EALLOW"),
        ("a = malloc(3)", 9, "from emulator.c28x.rts import malloc"),
        ("AdcaRegs.ADCCTL1.all = 3", 5, "from emulator.device_h import AdcaRegs"),
        ("a = int16", 9, "int16(x) for a cast"), ("a = sizeof(a, 1)", 9, "sizeof(TYPE) or sizeof(object)"),
        ("a = math.pi", 9, "from emulator.c28x.rts import sin"), ("v.append(1)", 5, "C has no methods"),
        ("pt.go(1)", 5, "C has no methods"), ("x = 1", 5, "write x: TYPE before"), ("a = x", 9, "declare it"),
        ("limit: int16 = 3; a = limti", 27, "is it limit?"),
        ("a = [1, 2]", 9, "v: array[int16, 3] = (1, 2, 3)"), ("a = {1: 2}", 9, "{2: 5}"), ("a = {1}", 9, "an array"),
        ("a = [i for i in v]", 9, "a loop"), ("a = f'{a}'", 9, "sprintf"), ("a = lambda x: x", 9, "at file scope"),
        ("a = v[0:1]", 11, "memcpy"), ("a = b'x'", 9, "a text without b"), ("a = 1j", 9, "a number"),
        ("a = p is NULL", 9, "write =="), ("a = a in v", 9, "x == a or x == b"), ("a = a // 2", 9, "write /"),
        ("a = a ** 2", 9, "write x * x"), ("a, n = n, a", 5, "one assignment for each object"),
        ("a = ++a", 9, "a += 1"), ("a = --a", 9, "a -= 1"), ("++a", 5, "a += 1"), ("a = --v[1]", 9, "v[1] -= 1"),
        ("a and g(1)", 5, "an if around a call"), ("g(a=1)", 5, "write them in order"), ("g(*v)", 5, "p[0] for *p"),
        ("yield 1", 5, "return"), ("del a", 5, "ends with its block"), ("assert a", 5, "if not condition"),
        ("raise a", 5, "return with a status"), ("import math", 5, "at file scope"),
        ("pt.x: int16 = 3", 5, "where the object itself is declared"), ("pt = (1, 2)", 10, "write point(x, y)"),
        ("x: point = point(z=1)", 24, "has no member z"), ("x: array[int16, 2] = {3: 1}", 30, "[3] is outside"),
        ("x: static[int16] = a", 24, "not a constant"), ("x: array[int16, a]", 21, "write a number"),
        ("x: const[int16] = 3; x = 4", 26, "x is const"), ("x: ptr[static[int16]]", 12, "static[uint16]"),
        ("v = 3", 5, "a loop, or memcpy"), ("fallthrough()", 5, "the last statement of a case"),
        ("do(a)", 5, "while do(test):"), ("x: Annotated[uint16, bits(3)]", 8, "for a member of a structure"),
        ("with a: pass", 5, "before and after it"), ("for i in v: pass", 5, "range"),
        ("for a in range(len(v)): pass", 20, "sizeof(v) / sizeof(v[0])"), ("while True: pass", 11, "write 1"),
    ],
)  # fmt: skip
def test_a_construct_of_python_names_what_to_write(statement: str, column: int, instead: str) -> None:
    line, found, message = refused(in_function(statement))
    assert (line, found) == (2, column)
    assert instead in message


@pytest.mark.parametrize(
    ("statement", "instead"),
    [
        ("i++", "x += 1"), ("a = n--", "x -= 1"), ("a = &n", "addressof(x)"), ("g(&n)", "addressof(x)"),
        ("a = *p", "p[0]"), ("*p = 3", "p[0]"), ("a = q->x", "p.member"), ("a = a ? 1 : 2", "a if test else b"),
        ("a = !a", "not for !"), ("if a && n: pass", "and for &&"), ("if a || n: pass", "or for ||"),
        ("if (a) {", "a colon and an indented body"), ("int x = 3;", "name: type = value"),
        ("uint16_t x;", "name: type = value"), ("const int x = 3", "name: type = value"),
        ("struct point x;", "class NAME(struct)"), ("a = 10U", "uint32(1)"), ("a = 0x10UL", "uint32(1)"),
        ("p[0] = 1.5f", "1.5 without f"), ("a = (int)n", "uint16(value)"), ("q = (float *)p", "cast(ptr[TYPE], value)"),
        ("// comment", "# before a comment"), ("/* comment */", "# before a comment"), ("switch (a) {", "match x:"),
        ("for (a = 0; a < 3; a++) {", "for i in range"), ("do {", "while do(test):"), ("else if (a)", "elif"),
        ("goto x", "a loop, a function or an if"), ("a = sizeof n", "sizeof(x)"), ("typedef int x;", "NAME = TYPE"),
        ("case 1: case 2:", "case 1 | 2:"), ("default:", "case _:"), ("void h(int x) {", "def name(parameter: type)"),
    ],
)  # fmt: skip
def test_cs_own_spelling_has_its_counterpart_named(statement: str, instead: str) -> None:
    line, _, message = refused(in_function(statement))
    assert line == 2
    assert message.startswith("not Python: ")
    assert instead in message


@pytest.mark.parametrize(
    ("lines", "place", "instead"),
    [
        (("try:", "    pass", "except:", "    pass"), (2, 5), "C has no exceptions"),
        (("for a in range(3):", "    pass", "else:", "    pass"), (2, 5), "a loop has no else"),
        (("while a:", "    pass", "else:", "    pass"), (2, 5), "a loop has no else"),
        (("def h() -> void:", "    pass"), (2, 5), "the function at file scope"),
        (("class h(struct):", "    x: int16"), (2, 5), "the type at file scope"),
        (("match a:", "    case 1 if a:", "        pass"), (3, 14), "write an if in the case"),
        (("match a:", "    case 1:", "        break"), (4, 13), "a case ends by itself"),
        (("match a:", "    case _:", "        pass", "    case 1:", "        pass"), (3, 14), "comes last"),
        (("match a:", "    case 1:", "        fallthrough()"), (4, 13), "of a case that is not the last"),
    ],
)
def test_a_statement_of_several_lines_names_what_to_write(
    lines: tuple[str, ...], place: tuple[int, int], instead: str
) -> None:
    *found, message = refused(in_function(*lines))
    assert tuple(found) == place
    assert instead in message


@pytest.mark.parametrize(
    ("text", "place", "instead"),
    [
        ("import math", (1, 1), "from emulator.c28x.rts import sin"),
        ("import emulator.device_h", (1, 1), "from emulator.device_h import NAME"),
        ("from math import sin", (1, 1), "from emulator.c28x.rts import sin"),
        ("from os import path", (1, 1), "nothing of it runs on the chip"),
        ("from enum import Enum", (1, 1), "class NAME(enum)"),
        ("@dataclass\nclass c(struct):\n    x: int16", (1, 2), "write class c(struct):"),
        ("class c(struct):\n    x: int16 = 3", (2, 5), "write x: type; a value is given where an object is declared"),
        ("class c(struct):\n    def m(self) -> int16: ...", (2, 5), "at file scope that takes a ptr[c]"),
        ("class c(struct):\n    x: int16\n    x: int16", (3, 5), "declared twice"),
        ("class c(Enum):\n    A = 1", (1, 1), "must derive from enum or struct"),
        ("class c(enum):\n    A = auto()", (2, 9), "write a number"),
        ("class c(struct):\n    x: Annotated[uint16, 3]", (2, 26), "Annotated[uint16, bits(3)]"),
        ("class c(struct):\n    x: Annotated[float32, bits(3)]", (2, 18), "only integers have bit-fields"),
        ("class c(struct):\n    x: Annotated[uint16, bits(17)]", (2, 31), "at most 16 bits"),
        ("x: static[int16] = 3", (1, 1), "begins with _"),
        ("def h(a: int16 = 3) -> void: ...", (1, 1), "only plain parameters"),
        ("def h(a) -> void: ...", (1, 7), "needs a type"),
        ("async def h() -> void: ...", (1, 1), "a task of SYS/BIOS"),
        ("@property\ndef h() -> void: ...", (1, 2), "only @extern and @interrupt"),
        ("def h() -> array[int16, 3]: ...", (1, 12), "return a pointer, or a structure"),
        ("for i in v:\n    pass", (1, 1), "only declarations are allowed there"),
        ("if __name__ == '__main__':\n    pass", (1, 1), "only declarations are allowed there"),
        ("n += 1", (1, 1), "only declarations are allowed there"),
        ("#define AA 3\ndef h() -> int16:\n    return AA", (3, 12), "write AA = value"),
    ],
)
def test_what_stands_at_file_scope_names_what_to_write(text: str, place: tuple[int, int], instead: str) -> None:
    *found, message = refused(text + "\n")
    assert tuple(found) == place
    assert instead in message


@pytest.mark.parametrize(
    "statement",
    [
        "a = - -a", "a = -(-a)", "a = 3 - -a", "a = ---a", "a = + +a", "a = a --a", "x: int16 = --3",
        "len: int16 = 3; a = len", "do: int16 = 3; a = do", "math: point; math.x = 3", "bits: int16 = 1; a = bits",
    ],
)  # fmt: skip
def test_what_only_looks_like_it_is_taken(statement: str) -> None:
    Workshop(DECLARED + in_function(statement))


def test_a_module_of_ones_own_may_be_called_as_one_of_pythons(tmp_path: Path) -> None:
    (tmp_path / "queue.py").write_text("from emulator.c28x.language import *\nLENGTH = 7\n")
    (tmp_path / "drv.py").write_text(f"{HEADER}from queue import LENGTH\ndef f() -> int16:\n    return LENGTH\n")
    (module,) = (m for m in Program([str(tmp_path / "drv.py")]).translate() if m.name == "drv")
    assert [f.name for f in module.functions] == ["f"]


@given(name=st.text(min_size=1, max_size=20), line=st.text(max_size=200), message=st.text(max_size=60))
def test_any_name_and_any_line_have_a_hint_or_none(name: str, line: str, message: str) -> None:
    for found in (hints.hint(name, line), hints.library(name), hints.spelling(line, message)):
        assert not found or found.startswith(": ")


BLOCKS = (Path(__file__).parents[2] / "facts" / "blocks.csv").read_text().split()[1:]


def test_every_block_of_the_chip_is_declared() -> None:
    symbols = Program().module("emulator.device_h").symbols
    assert sorted(name for name in BLOCKS if not isinstance(symbols.get(name), RegisterBlock | Unmodelled)) == []


@pytest.mark.parametrize("form", ["from emulator.device_h import Cla1Regs", "from emulator.device_h import *"])
@pytest.mark.parametrize("use", ["Cla1Regs", "Cla1Regs.MCTL.bit", "Cla1Regs._MR0.i32"])
def test_of_a_block_that_is_not_modelled_only_registers_by_name_are_known(form: str, use: str) -> None:
    line, _, message = refused(f"{form}\ndef f() -> uint16:\n    return {use}\n")
    assert (line, message) == (
        3, "Cla1Regs is a peripheral of this chip that is not modelled: only its registers by name are known"
    )  # fmt: skip
