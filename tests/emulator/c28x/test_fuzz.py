"""Damaged and hostile firmware is answered with an image or with one line that names file and line.

`HIL_FUZZ=20000` tries that many texts of each language, `HIL_FIRST=5000` begins at another seed; the command
`python -m tests.emulator.c28x.fuzz` also looks for the smallest text of each failure.
"""

from __future__ import annotations

import os

import pytest

from emulator.c28x.symbols import SourceError
from tests.emulator.c28x import fuzz
from tests.emulator.c28x.workshop import Workshop

FIRST = int(os.environ.get("HIL_FIRST", "0"))
CASES = int(os.environ.get("HIL_FUZZ", "1000"))
#: Seeds of one test: small enough to be shared between the processes of a run.
BATCH = 100

PY = "from emulator.c28x.language import *\n"
F = "def f(n: int16) -> int16:\n"

#: What once ended in an internal error, or took forever.
HOSTILE_PYTHON = {
    "a local named as the translator names the core": PY + F + "    _cpu: int16 = n\n    return _cpu\n",
    "a local that begins with itself": PY + "x: uint16\ndef f() -> uint16:\n    x: uint16 = x\n    return x\n",
    "a define of itself": PY + "A = A + 1\n" + F + "    return A\n",
    "defines in a circle": PY + "A = B\nB = A\n" + F + "    return A\n",
    "900 members of members": PY + F + "    return n" + ".x" * 900 + "\n",
    "900 indices": PY + F + "    return n" + "[0]" * 900 + "\n",
    "a start value 900 times not": PY + "x: int16 = " + "not " * 900 + "1\n",
    "a local of 65,535 elements": PY + F + "    v: array[int16, 65535] = (1,)\n    return v[0]\n",
    "a text in 65,535 elements": PY + F + '    v: array[char, 65535] = "ok"\n    return v[0]\n',
    "a sum of 5,000 terms": PY + F + "    return n" + " + 1" * 5000 + "\n",
    "900 unary minuses": PY + F + "    return " + "-" * 900 + "n\n",
    "900 times not": PY + F + "    return " + "not " * 900 + "n\n",
    "a shift out of reason": PY + F + "    return 1 << 10000000000\n",
    "a shift out of reason in a define": PY + "A = 1 << 10000000000\n" + F + "    return A\n",
    "a power out of reason": PY + F + "    return 9 ** 9 ** 9\n",
    "an array of 200 million": PY + "x: array[int16, 200000000]\n",
    "an array of 200 million with a start value": PY + "x: array[int16, 200000000] = (1,)\n",
    "a local array of 200 million": PY + F + "    x: array[int16, 200000000]\n    return x[0]\n",
    "an array longer than any number": PY + "x: array[char, 99999999999999999999]\n",
    "arrays of arrays of arrays": PY + "x: array[array[array[int16, 30000], 30000], 30000]\n",
    "a limit that is infinite": PY + F + "    i: int16\n    for i in range(1e400):\n        n = 1\n    return n\n",
    "a comparison with infinity": PY + F + "    if n != 1 or n != 1e39:\n        return 1\n    return 0\n",
    "a range without a limit": PY + F + "    i: int16\n    for i in range():\n        n = 1\n    return n\n",
    "a limit that is a text": PY + F + '    i: int16\n    for i in range(""):\n        n = 1\n    return n\n',
    "a count too long for a number": PY + F + "    i: int16\n    for i in range(3):\n"
                                              "        n = n << 99999999999999999999\n    return n\n",
    "200 nested parentheses": PY + F + "    return " + "(" * 200 + "n" + ")" * 200 + "\n",
    "100 nested tests": PY + F + "    return " + "(1 and " * 100 + "n" + ")" * 100 + "\n",
    "a type of 900 pointers": PY + "x: " + "ptr[" * 150 + "int16" + "]" * 150 + " = NULL\n",
    "a type with operators": PY + "x: " + "~" * 900 + "int16\n",
    "a module of 300 dots": "from " + ".".join("a" * 300) + " import *\n" + PY,
    "no such module": "from nosuch import x\n" + PY,
    "a zero character": PY + "x: int16 = 1\x00\n",
    "a page of 1,000 nested blocks": PY + F + "".join("    " * (d + 1) + "if n:\n" for d in range(95))
                                     + "    " * 96 + "return 1\n    return 0\n",
    "a module of a very long name": "from " + "a" * 300 + " import x\n" + PY,
    "an import of dots": "from . import *\n" + PY,
    "a switch of 3,000 cases": PY + F + "    match n:\n" + "".join(f"        case {j}:\n            n = {j}\n"
                                                                for j in range(3000)) + "    return n\n",
    "16 loops within each other": PY + F + "".join("    " * d + "while n < 5:\n" for d in range(1, 17))
                                  + "    " * 17 + "n += 1\n    return n\n",
    "defines that double": PY + "".join(f"A{j} = A{j + 1} + A{j + 1}\n" for j in range(40)) + "A40 = n\n" + F
                           + "    return A0\n",
    "lengths that double": PY + "".join(f"A{j} = A{j + 1} * A{j + 1}\n" for j in range(40))
                           + "A40 = 7\nv: array[int16, A0]\n",
    "structures that double": PY + "class s0(struct):\n    a: int16\n" + "".join(
        f"class s{j}(struct):\n    a: s{j - 1}\n    b: s{j - 1}\n" for j in range(1, 40)) + "x: s39\n",
    "many large objects": PY + "".join(f"x{j}: array[int16, 65535]\n" for j in range(300)),
    "a start value of 5,000 terms": PY + "x: int16 = " + "1 + " * 5000 + "1\n",
    "a start value that is no constant, of 5,000 terms": PY + "y: int16 = 0\nx: int16 = " + "y + " * 5000 + "1\n",
    "a length of 5,000 terms": PY + "x: array[int16, " + "1 + " * 5000 + "1]\n",
    "an index of 5,000 terms": PY + "x: array[int16, 3]\n" + F + "    return x[" + "n + " * 5000 + "1]\n",
    "a limit of 50 terms": PY + F + "    i: int16\n    for i in range(" + "n + " * 50 + "n):\n        pass\n"
                           + "    return 0\n",
    "2,000 objects with a start value": PY + "".join(f"x{j}: int16 = {j}\n" for j in range(2000)),
    "a structure within itself": PY + "class s(struct):\n    x: s\ny: s\n",
    "a function that is a keyword's namesake": PY + "def print(n: int16) -> int16:\n    return n\n",
}  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE_PYTHON.values(), ids=HOSTILE_PYTHON.keys())
def test_hostile_python_is_taken_or_refused_with_its_place(text: str) -> None:
    assert fuzz.outcome(text, "py") is None


#: What nests: `o` n times, a value, `c` n times.
NESTED = {
    "sum to the right": ("(n + ", ")"), "unsigned sum": ("(u + ", ")"), "subscript": ("g[", "]"), "call": ("k(", ")"),
    "character": ("uchar(int32(1 + ", "))"), "unary": ("-", ""), "not": ("not ", ""), "and": ("(n and ", ")"),
    "comparison": ("(n < ", ")"), "choice": ("(1 if n else ", ")"), "float": ("int16(fl * ", ")"),
    "shift": ("(1 << ", ")"), "quotient": ("(n / ", ")"),
    "pointer": ("p.v[", "]"), "signed character": ("int16(schar(char(", ")) + 1)"),
}  # fmt: skip


@pytest.mark.parametrize("kind", NESTED)
@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
def test_what_nests_as_deep_as_the_reader_takes_it_can_be_written(kind: str, watched: bool) -> None:
    # The reader takes 100 expressions within each other (four a level at most here: 24 levels), Python's parser 200
    # parentheses.  What is taken is written without a fault, though each level makes several parentheses.
    opening, closing = NESTED[kind]
    head = (
        'class s(struct):\n    v: array[int16, 5]\np: ptr[s] = NULL\ng: array[int16, 9]\nu: uint16\nfl: float32\n'
        "def k(a: int16) -> int16:\n    return a\n"
    )
    for times in (10, 20, 30, 45, 64, 99, 150):
        refused, text = "", f"{head}def f(n: int16) -> int16:\n    return {opening * times}n{closing * times}\n"
        try:
            Workshop(text, watch=watched)
        except SourceError as error:
            refused = str(error)
        assert not refused or times > 20
        assert not refused or "nested within each other" in refused or "too many nested parentheses" in refused


def test_a_sum_of_many_terms_has_the_value_that_c_gives() -> None:
    # 3 + 5000 * 1; and from left to right: 3 - 1 - 1 ... (5000 times) = 3 - 5000.
    up, down = "n" + " + 1" * 5000, "n" + " - 1" * 5000
    shop = Workshop(f"{F}    return {up}\ndef g(n: int16) -> int16:\n    return {down}\n")
    assert (shop.f(3), shop.g(3)) == (5003, -4997)


def test_deep_operands_are_evaluated_from_left_to_right() -> None:
    # Each call appends its digit: c(1) - (c(2) - (c(3) - ...)) makes the digits 1 2 3 ... in this order.
    head = "@extern\ndef c(n: int16) -> int16: ...\n"
    seen: list[int] = []
    differences = "".join(f"(c({i}) - " for i in range(60)) + "c(60)" + ")" * 60
    text = f"{head}def f() -> int16:\n    return {differences}\n"
    Workshop(text, externs={"c": lambda n: seen.append(n) or n}).f()
    assert seen == list(range(61))


def test_numbers_of_64_bits_are_no_places() -> None:
    # Generated text numbers its places with integers that are replaced when it is linked: 2**40 + 5 is none.
    shop = Workshop("def f(a: uint64) -> uint64:\n    return a + 0x10000000005\n")
    assert shop.f(2**64 - 1) == 0x10000000004


@pytest.mark.parametrize("language", fuzz.LANGUAGES)
@pytest.mark.parametrize("start", range(FIRST, FIRST + CASES, BATCH))
def test_damaged_firmware_is_taken_or_refused_with_its_place(language: str, start: int) -> None:
    assert [f"seed {seed}: {failure}" for seed, failure in fuzz.failures(range(start, start + BATCH), language)] == []


@pytest.mark.parametrize("language", fuzz.LANGUAGES)
def test_what_is_damaged_is_sound_before(language: str) -> None:
    assert [failure for text in fuzz.corpus(language)[:40] if (failure := fuzz.outcome(text, language))] == []


def test_a_seed_makes_the_same_text_each_time() -> None:
    assert [fuzz.case(seed, "py") for seed in range(20)] == [fuzz.case(seed, "py") for seed in range(20)]


def test_work_out_of_proportion_is_a_failure_and_not_a_hang() -> None:
    # The calls allowed are fewer than any text needs.
    failure = fuzz.outcome(PY + "x: int16 = 1\n", "py", calls=10)
    assert failure is not None
    assert failure.kind == "too much work"


#: Where a name of the firmware stands: a local, a parameter, an object of the file, a function.  f(3) is
#: (1 + 2 + 3) * 3 + 3 = 21 in each.
_EXTERNS = "@extern\ndef EALLOW() -> None: ...\n@extern\ndef EDIS() -> None: ...\n"
_TABLE = "table: array[int16, 4] = (1, 2, 3, 4)\n"
_BODY = """
    i: int16
    total: int16 = 0
    EALLOW()
    for i in range(NAME):
        total += table[i] * NAME
    EDIS()
    return total + NAME
"""
NAMED = {
    "local": f"def f(n: int16) -> int16:\n    NAME: int16 = n{_BODY}",
    "parameter": f"def f(NAME: int16) -> int16:{_BODY}",
    "object": f"NAME: int16 = 0\ndef f(n: int16) -> int16:\n    NAME = n\n    EALLOW(){_BODY}",
    "define": f"NAME = 3\ndef f(n: int16) -> int16:{_BODY}",
    "enumeration": "class NAME(enum):\n    A = 3\ndef f(n: int16) -> int16:\n    p: int16 = NAME.A"
    + _BODY.replace("NAME", "p"),
    "structure": "class NAME(struct):\n    a: int16\ndef f(n: int16) -> int16:\n    s: NAME\n    s.a = n"
    + _BODY.replace("NAME", "s.a"),
    "member": "class s(struct):\n    NAME: int16\nx: s\ndef f(n: int16) -> int16:\n    x.NAME = n"
    + _BODY.replace("NAME", "x.NAME"),
    "function": "def NAME(n: int16) -> int16:\n    return n\ndef f(n: int16) -> int16:\n    p: int16 = NAME(n)"
    + _BODY.replace("NAME", "p"),
}


@pytest.mark.parametrize("kind", NAMED)
@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
def test_no_name_of_the_firmware_meets_one_of_the_generated_text(kind: str, watched: bool) -> None:
    def run(name: str) -> object:
        text = _EXTERNS + _TABLE + NAMED[kind].replace("NAME", name)
        shop = Workshop(text, watch=watched, externs={"EALLOW": lambda: None, "EDIS": lambda: None})
        names.update(name for name in shop.linked.namespace if name.isidentifier())
        return shop.f(3)

    names: set[str] = {"print", "len", "range", "max", "int", "float", "list", "self", "_", "__builtins__", "__name__"}
    assert run("plain") == 21
    wrong = {}
    for name in sorted(names):
        try:
            result = run(name)
        except Exception as error:
            result = f"{type(error).__name__}: {error}"
        if result != 21:
            wrong[name] = result
    assert wrong == {}


def test_a_local_that_begins_with_itself_is_read_before_it_is_written() -> None:
    # The name means the local from its declarator on (ISO C 6.2.1), also where the file has an object of that name.
    shop = Workshop("x: uint16 = 3\ndef f() -> uint16:\n    x: uint16 = x\n    return x\n")
    shop.f()
    assert shop.rules() == ["uninitialised"]
