"""Files made to crash or to hang: each is answered, by tokens or by an error with a place, after little work."""

from __future__ import annotations

import pytest

from emulator.c28x.readers.c.parser import parse
from emulator.c28x.readers.c.preprocessor import preprocess_text
from emulator.c28x.symbols import SourceError


def chain(first: str, step: str, last: str, count: int = 40) -> str:
    """Macros A0 to A`count`, each by `step` out of the one before, and `last`."""
    lines = [f"#define A0{first}", *(f"#define A{n + 1}" + step.replace("$", f"A{n}") for n in range(count))]
    return "\n".join([*lines, last])


MEGABYTE = 1_000_000
REFUSED = {
    "tokens doubled 40 times": chain(" x", " $ $", "A40"),
    "calls doubled 40 times": chain("(x) x", "(x) $(x) $(x)", "A40(y)"),
    "a name doubled 40 times": "#define C(a, b) D(a, b)\n#define D(a, b) a ## b\n" + chain(" x", " C($, $)", "A40"),
    "quotes doubled": "#define S(x) #x\n#define T(x) S(x)\nint y = " + "T(" * 40 + '"\\""' + ")" * 40 + ";",
    "calls within arguments": "#define f(x) x\n" + "f(" * 50_000 + ")" * 50_000,
    "round brackets": "(" * MEGABYTE,
    "braces": "{" * MEGABYTE,
    "one number": "int x = " + "1" * MEGABYTE + ";",
    "NUL": "\0" * 100_000,
    "a comment without end": "int x;\n" + "/*" * 500_000,
    "a string without end": 'char *s = "' + '\\"' * 500_000,
    "an apostrophe without end": "'" * 3 + "a" * MEGABYTE,
    "conditions without end": "#if 1\n" * 100_000,
    "a deep condition": "#if " + "(" * 100_000 + "\n#endif",
    "a long condition without end": "#if " + "1+" * 400_000 + "\n#endif",
    "a number in a condition": "#if " + "9" * MEGABYTE + "\n#endif",
    "parameters without end": "#define f(" + "".join(f"a{n}," for n in range(100_000)),
    "arguments without end": "#define f(x) x\nf(" + "a," * 100_000,
}
READ = {
    "a chain of macros": chain(" x", " $", "A30000;", 30_000).replace("\nA30000;", "\nint A30000;"),
    "joined lines": "\\\n" * 500_000 + "int x;",
    "short comments": "/**/" * 250_000 + "int x;",
    "one long line": "int x; " * 20_000,
    "one long string": 'char *s = "' + "a" * MEGABYTE + '";',
    "many short strings": "char *s = " + '"a"' * 100_000 + ";",
    "names in many blocks": "void f(void) {" + "{" * 300 + "x;" * 50_000 + "}" * 301,
}


@pytest.mark.parametrize("text", REFUSED.values(), ids=REFUSED)
def test_it_is_refused_with_a_place(text: str) -> None:
    with pytest.raises(SourceError) as error:
        parse(preprocess_text(text, "t.c").tokens)
    assert error.value.file == "t.c"
    assert error.value.line >= 1
    assert error.value.column >= 1
    assert len(str(error.value)) < 300


@pytest.mark.parametrize("text", READ.values(), ids=READ)
def test_it_is_read(text: str) -> None:
    assert parse(preprocess_text(text, "t.c").tokens).ext
