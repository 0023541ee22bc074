"""`goto`: generated functions do what gcc's do, as functions and as methods; what the passes find of it; refusals."""

from __future__ import annotations

import random
import shutil
import subprocess
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

import pytest

from emulator.c28x.coverage import Coverage
from emulator.c28x.symbols import SourceError
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of, refused, run_c
from tests.emulator.c28x.test_typed_text import as_methods

#: How many functions are generated, and how many of them at least have a `goto` that is read.
GENERATED: Final = 60
LEAST_READ: Final = 35


class Generated:
    """A function of random blocks, loops, switches, labels and jumps, which notes where it comes along."""

    def __init__(self, number: int) -> None:
        self._rng = random.Random(number)
        self._labels = 0
        self.text = f"int f{number}(int x)\n{{\n    int y = 0;\n{self._block(1, [], 3, loop=False)}    return y;\n}}\n"

    def _block(self, depth: int, labels: list[str], most: int, *, loop: bool) -> str:
        """Some statements, between which labels of their own may stand; `labels` are those of the blocks around."""
        rng, pad = self._rng, "    " * depth
        count = rng.randint(1, max(1, most + 1))
        own = {}
        for place in range(count + 1):
            if rng.random() < 0.35:
                self._labels += 1
                own[place] = f"l{self._labels}"
        lines = []
        for place in range(count + 1):
            if place in own:
                lines.append(f"{own[place]}:\n{pad};\n")
            if place < count:
                lines.append(self._statement(depth, [*labels, *own.values()], most, loop=loop))
        return "".join(lines)

    def _statement(self, depth: int, labels: list[str], most: int, *, loop: bool) -> str:
        rng, pad = self._rng, "    " * depth
        kind = rng.choice(["note", "note", "goto", "goto", "if", "for", "while", "switch", "leave"])
        test = f"x + y {rng.choice('<>')} {rng.randint(-4, 20)}"
        if kind == "goto" and labels:
            counted = f"{pad}    if (note(-1)) return -3;\n"
            return f"{pad}if ({test}) {{\n{counted}{pad}    goto {rng.choice(labels)};\n{pad}}}\n"
        if kind == "leave" and loop:
            return f"{pad}if ({test}) {rng.choice(['break', 'continue'])};\n"
        if depth > 3 or kind in ("note", "goto", "leave"):
            return f"{pad}if (note({rng.randint(1, 99)})) return -1;\n{pad}y += {rng.randint(-3, 5)};\n"
        if kind == "switch":
            cases = "".join(
                f"{pad}case {n}: {{\n{self._block(depth + 1, labels, most - 1, loop=loop)}{pad}    break;\n{pad}}}\n"
                for n in range(2)
            )
            return f"{pad}switch ((x ^ y) & 3) {{\n{cases}{pad}default:\n{pad}    y++;\n{pad}}}\n"
        inner = self._block(depth + 1, labels, most - 1, loop=loop or kind != "if")
        if kind == "if":
            return f"{pad}if ({test}) {{\n{inner}{pad}}} else {{\n{pad}    y--;\n{pad}}}\n"
        if kind == "for":
            name = f"i{depth}"
            return f"{pad}for (int {name} = 0; {name} < {rng.randint(1, 3)}; {name}++) {{\n{inner}{pad}}}\n"
        return f"{pad}do {{\n{pad}    if (note(0)) return -2;\n{inner}{pad}}} while (y++ < {rng.randint(1, 6)});\n"


HEAD: Final = """
static unsigned int trace = 0, steps = 0;
static int note(int what)
{
    trace = (trace * 31u + (unsigned int)what) & 0x3FFFu;
    return ++steps > 60u;
}
unsigned int traced(int begin)
{
    unsigned int was = trace;
    if (begin) { trace = 1; steps = 0; }
    return was;
}
"""
ARGUMENTS: Final = (-5, 0, 3, 9, 18)


def runs(call: Callable[[str, int], int], names: list[str]) -> list[tuple[str, int, int, int]]:
    """The function, its argument, its result and its trace, of every call."""
    found = []
    for name in names:
        for x in ARGUMENTS:
            call("traced", 1)
            result = call(name, x)
            found.append((name, x, result, call("traced", 0)))
    return found


def read_ones() -> dict[str, str]:
    """The generated functions whose jumps are read, by name."""
    texts = {}
    for number in range(GENERATED):
        text = Generated(number).text
        if "goto" not in text:
            continue
        with suppress(SourceError):
            CWorkshop(HEAD + text)
            texts[f"f{number}"] = text
    return texts


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")
def test_generated_jumps_go_where_gcc_lets_them_go(tmp_path: Path) -> None:
    texts = read_ones()
    assert len(texts) >= LEAST_READ
    text = HEAD + "".join(texts.values())
    calls = "".join(
        f'    traced(1); r = {name}({x}); printf("%d %u\\n", r, traced(0));\n' for name in texts for x in ARGUMENTS
    )
    main = f"\n#include <stdio.h>\nint main(void)\n{{\n    int r;\n{calls}    return 0;\n}}\n"
    (tmp_path / "all.c").write_text(text + main, encoding="utf-8")
    subprocess.run(["gcc", "-w", "-O1", "-o", tmp_path / "all", tmp_path / "all.c"], check=True, timeout=120)
    out = subprocess.run([tmp_path / "all"], check=True, capture_output=True, text=True, timeout=60).stdout
    expected = [(int(a), int(b)) for a, b in map(str.split, out.splitlines())]
    for watch in (False, True):
        shop = CWorkshop(text, watch=watch)
        found = runs(shop.call, list(texts))
        assert [(result, trace) for _, _, result, trace in found] == expected
        with as_methods():
            methods = CWorkshop(text, watch=watch)
        assert runs(methods.call, list(texts)) == found
        assert methods.clock.now == shop.clock.now
        assert not {"uninitialised", "overflow"} & set(shop.rules())


CLEAN_UP: Final = """
int begin(int what);
int f(int a)
{
    int rc, late;
    if (a < 0)
        goto out;
    late = a * 2;
    rc = late;
    if (rc > 10)
        goto out;
    rc++;
out:
    return rc;
}
"""


def test_a_local_that_a_jump_leaves_without_a_value_is_told() -> None:
    assert ("maybe-uninitialised", 14) in findings_of(CLEAN_UP)
    assert ("uninitialised", 14) in findings_of(CLEAN_UP, "f", -1)
    assert findings_of(CLEAN_UP.replace("int rc, late", "int rc = 0, late"), "f", -1) == []


def test_a_value_that_only_the_jump_uses_is_used() -> None:
    text = "int f(int a)\n{\n    int rc = 1;\n    for (;;) {\n        if (a > 3)\n            goto out;\n        a++;\n"
    text += "    }\n"
    assert findings_of(text + "out:\n    return rc;\n}\n", "f", 1) == []
    dead = text.replace("int rc = 1", "int rc = 1, last = 2").replace("goto out", "{ last = a; goto out; }")
    assert [rule for rule, _ in findings_of(dead + "out:\n    return rc;\n}\n")] == ["dead-store"]


def test_what_stands_behind_a_jump_cannot_run() -> None:
    text = "int g;\nint f(int a)\n{\n    goto out;\n    g = a;\nout:\n    return g;\n}\n"
    assert ("unreachable", 5) in findings_of(text)


def test_a_jump_costs_no_more_than_the_structured_form() -> None:
    jump = "int f(int a)\n{\n    int r = 1;\n    if (a) goto out;\n    r = 2;\nout:\n    return r;\n}\n"
    structured = "int f(int a)\n{\n    int r = 1;\n    if (!a) {\n        r = 2;\n    }\n    return r;\n}\n"
    for a in (0, 1):
        shops = [CWorkshop(text) for text in (jump, structured)]
        assert [shop.call("f", a) for shop in shops] == [1 if a else 2] * 2
        assert shops[0].clock.now == shops[1].clock.now


def test_each_statement_is_counted_as_often_as_it_runs() -> None:
    text = "int f(int n)\n{\n    int k = 0;\nagain:\n    k++;\n    if (k < n)\n        goto again;\n    return k;\n}\n"
    coverage = Coverage()
    shop = CWorkshop(text, coverage=coverage)
    assert shop.call("f", 3) == 3
    lines = {place.where.line: times for place, times in coverage.begun().items()}
    assert (lines[5], lines[6], lines[7], lines[8]) == (3, 3, 2, 1)


@pytest.mark.parametrize(
    ("body", "line", "words"),
    [
        ("    goto in;\n    if (n) {\nin:\n        n++;\n    }\n", 3, ("goto in", "into a block")),
        ("    if (n)\n        goto in;\nfirst:\n    n++;\nin:\n    n--;\n    if (n) goto first;\n", 7, ("first", "in")),
        ("    goto nowhere;\n", 3, ("nowhere", "no such label")),
        ("two:\n    n++;\ntwo:\n    n++;\n", 5, ("two", "twice")),
        ("    for (;;) {\nagain:\n        n++;\n        if (n == 5) break;\n        if (n < 9) goto again;\n    }\n", 6,
         ("break", "again")),
        ("    switch (n) {\n    case 1: n++; goto there; break;\n    case 2: there: n--; break;\n    }\n", 4,
         ("goto there", "block")),
    ],
    ids=["into a block", "into what is repeated", "no label", "two labels", "break of what is repeated", "into a case"],
)  # fmt: skip
def test_another_form_is_refused_in_one_line(body: str, line: int, words: tuple[str, ...]) -> None:
    at, _, message = refused(f"int f(int n)\n{{\n{body}    return n;\n}}\n")
    assert at == line
    assert "\n" not in message
    assert not [word for word in words if word not in message]


def test_a_label_that_nothing_jumps_to_is_no_error() -> None:
    assert run_c("int f(int n)\n{\nbegin:\n    n++;\nend:\n    return n;\n}\n", "f", 4) == 5
