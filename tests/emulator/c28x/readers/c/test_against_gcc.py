"""The preprocessor beside `gcc -E`: the same tokens in the same lines, on generated macros and conditions."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from emulator.c28x.readers.c.preprocessor import preprocess_text
from emulator.c28x.readers.c.tokens import SourceText, TokenBudget
from emulator.c28x.symbols import SourceError

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")


def gcc(text: str) -> list[tuple[str, int]] | None:
    """The tokens that gcc makes of `text`, each with its line; None where it refuses."""
    command = ["gcc", "-E", "-std=gnu99", "-undef", "-nostdinc", "-w", "-x", "c", "-"]
    run = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if run.returncode:
        return None
    found = []
    line = 0
    for row in run.stdout.splitlines():
        if marker := re.match(r'# (\d+) "([^"]*)"', row):
            line = int(marker[1]) if marker[2] == "<stdin>" else -(10**6)
            continue
        for tokens in SourceText("", row).lines(TokenBudget(100_000)):
            found += [(token.text, line) for token in tokens]
        line += 1
    return found


def ours(text: str) -> list[tuple[str, int]]:
    return [(token.text, token.where.line) for token in preprocess_text(text, "t.c").tokens]


NAMES = ("A", "B", "C", "f", "g", "h")
WORD = st.sampled_from([*NAMES, *NAMES, "x", "y", "1", "+", ",", "(", ")", "f(", "g(", "h(", "'c'", '"s"', "~"])


@st.composite
def definitions(draw: st.DrawFn) -> str:
    """A `#define`, now and then with `#` and `##`, now and then over two lines."""
    name = draw(st.sampled_from(NAMES))
    parameters: list[str] = []
    head = name
    if name.islower():
        parameters = draw(st.sampled_from([[], ["x"], ["x", "y"], ["x", "..."]]))
        head = f"{name}({', '.join(parameters)})"
    inner = ["__VA_ARGS__" if parameter == "..." else parameter for parameter in parameters]
    body = []
    for word in draw(st.lists(WORD, max_size=7)):
        body.append(word)
        if inner and draw(st.integers(0, 4)) == 0:
            chosen = draw(st.sampled_from(inner))
            body.append(draw(st.sampled_from([f"#{chosen}", chosen, f"q ## {chosen}", f"{chosen} ## {chosen}"])))
    text = draw(st.sampled_from([" ", " ", " \\\n "])).join(body)
    return f"#define {head} {text}"


@st.composite
def programs(draw: st.DrawFn) -> str:
    lines: list[str] = []
    names = set()
    for definition in draw(st.lists(definitions(), min_size=1, max_size=6)):
        name = re.split(r"[ (]", definition)[1]
        if name not in names:
            lines.append(definition)
            names.add(name)
    for words in draw(st.lists(st.lists(WORD, max_size=8), min_size=1, max_size=5)):
        lines.append(" ".join(words))
        if draw(st.integers(0, 3)) == 0:
            name = draw(st.sampled_from(NAMES))
            lines += [f"#ifdef {name}", f"{name} /* with", "comment */ yes", "#else", "no", "#endif", f"#undef {name}"]
    # Calls end in their line: where one goes on, gcc prints it as one line.
    balanced = []
    for line in lines:
        if not line.startswith("#"):
            line += " )" * max(0, line.count("(") - line.count(")")) + " ;"
        balanced.append(line)
    return "\n".join(balanced) + "\n"


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])
@given(programs())
def test_the_same_tokens_in_the_same_lines(text: str) -> None:
    expected = gcc(text)
    assume(expected is not None)
    assert expected is not None
    assert [token for token, _ in ours(text)] == [token for token, _ in expected]
    if not any(calls_over_lines(line) for line in text.splitlines()):
        assert ours(text) == expected


def calls_over_lines(line: str) -> bool:
    """Whether a macro's arguments may go on after `line`."""
    depth = 0
    for character in line:
        depth += (character == "(") - (character == ")")
    return depth != 0 or bool(re.search(r"\b[fgh]\s*(/\*.*)?$", line))


OPERAND = st.sampled_from(["0", "1", "2", "7", "-1", "3u", "0x8000000000000000", "defined A", "B", "'a'", "010"])
CONDITION = st.recursive(
    OPERAND,
    lambda inner: st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from(
            ["+", "-", "*", "/", "%", "<<", ">>", "<", ">", "<=", ">=", "==", "!=", "&", "|", "^", "&&", "||"]), inner),
        st.builds("({} ? {} : {})".format, inner, inner, inner),
        st.builds("{}{}".format, st.sampled_from(["!", "~", "- ", "+ "]), inner),
        st.builds("{} {} {}".format, inner, st.sampled_from(["+", "*", "<<", "==", "&&", "||", "&", "-"]), inner),
    ),
    max_leaves=8,
)  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(CONDITION)
def test_a_condition_has_the_same_value(condition: str) -> None:
    text = f"#define A\n#define B 5\n#if {condition}\nyes\n#else\nno\n#endif\n"
    expected = gcc(text)
    if expected is None:
        with pytest.raises(SourceError, match="divides by zero"):
            ours(text)
    else:
        assert ours(text) == expected
