"""Headers of ours that a file begins with are parsed once: the tree, or the error, is that of the whole text."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.c28x.program import Program
from emulator.c28x.readers.c.parser import ParserLimits, parse
from emulator.c28x.readers.c.preprocessor import PreprocessorOptions, preprocess_text
from emulator.c28x.readers.c.source import CSettings
from emulator.c28x.symbols import SourceError

c_ast = pytest.importorskip("pycparser.c_ast", reason="pycparser is not installed: pip install c2000-hil[c]")

#: With limits of its own a text is parsed as a whole.
WHOLE = ParserLimits(tokens=499_999)
DEVICE = '#include "F28x_Project.h"\n'


def options(**more: Any) -> PreprocessorOptions:
    return CSettings(**more).options()


def plain(node: Any) -> Any:
    """A node as plain data: its kind, attributes, place and children."""
    attributes = [repr(getattr(node, name)) for name in node.attr_names]
    return type(node).__name__, attributes, node.coord, [(name, plain(child)) for name, child in node.children()]


def outcome(text: str, settings: PreprocessorOptions, **how: Any) -> Any:
    try:
        return plain(parse(preprocess_text(text, "t.c", settings).tokens, **how))
    except SourceError as error:
        return str(error)


@pytest.mark.parametrize("text", [
    DEVICE + "Uint16 a; void f(void) { EALLOW; GpioCtrlRegs.GPADIR.bit.GPIO1 = 1; EDIS; }",
    DEVICE,
    "#include <stdint.h>\n#include <stdbool.h>\nbool on = true; int16_t x;",
    # Names of the headers once more, as what they are, as something else, and in a block.
    DEVICE + "typedef unsigned int Uint16; extern struct EPWM_REGS EPwm1Regs;",
    DEVICE + "int Uint16;", DEVICE + "typedef int EPwm1Regs;", DEVICE + "int f(int Uint16) { return Uint16 * 2; }",
    # Headers behind other text, and twice.
    "int a;\n" + DEVICE + "Uint16 b;", DEVICE + "Uint16 a;\n" + DEVICE + '#include <math.h>\nUint16 b;',
    # A text that begins with a macro of the headers.
    "#include <stdbool.h>\nbool a;", "#include <limits.h>\nint a = INT_MAX;", "#include <stdbool.h>\nbool",
    # Errors at the seam, and at the end.
    DEVICE + "}", DEVICE + "else", DEVICE + "5 + 6;", DEVICE + "Unit16 a;", DEVICE + "{", DEVICE + "int",
    DEVICE + "__attribute__((interrupt)) void f(void) { }", DEVICE + "_Generic", DEVICE + ";;",
    'static\n#include <stdint.h>\nint a;',
])  # fmt: skip
def test_the_tree_is_that_of_the_whole_text(text: str) -> None:
    whole = outcome(text, options(), limits=WHOLE)
    for _ in range(2):
        assert outcome(text, options()) == whole


def test_they_are_parsed_once() -> None:
    one, other = (parse(preprocess_text(DEVICE + text, "t.c", options()).tokens) for text in ("int a;", "int b;"))
    assert len(one.ext) > 100
    assert all(a is b for a, b in zip(one.ext[:-1], other.ext[:-1], strict=True))
    assert one.ext[-1].name == "a"


def test_a_macro_of_the_command_line_changes_the_headers() -> None:
    text = DEVICE + "Uint16 a;"
    with_it = options(defines=["Uint16=long"])
    assert outcome(text, options()) != outcome(text, with_it, limits=WHOLE)
    assert outcome(text, with_it) == outcome(text, with_it, limits=WHOLE)


def test_reading_the_declarations_leaves_the_tree_as_it_was() -> None:
    text = DEVICE + '#include <math.h>\n#include <string.h>\nfloat x; void main(void) { x = sinf(x); }'
    whole = outcome(text, options(), limits=WHOLE)
    program = Program()
    program.add("t", "t.c", text)
    program.translate()
    assert outcome(text, options()) == whole
