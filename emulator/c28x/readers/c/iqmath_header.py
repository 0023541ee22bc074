"""IQmathLib.h as C text: the types, macros and functions of the IQmath library, in both of its modes.

Names, types and values are those of the library's own header.  If the user has a file of that name anywhere on the
include path, it is read instead: many projects have one with their own `GLOBAL_Q`.
Source: the header of the IQmath library of C2000Ware.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from emulator.c28x.readers.c.module_header import guarded
from emulator.c28x.rts_iqmath import ALL, OF_TWO, formats

NAME: Final = "IQmathLib.h"
_SHORT: Final = range(1, 16)
#: In both modes: function -> parameters of its macro.
_PRODUCTS: Final = ("mpy", "rmpy", "rsmpy")


def _parameters(name: str) -> str:
    return "A, B" if name in OF_TWO else "A"


def header() -> str:
    """The text of the header."""
    lines = [
        "#include <limits.h>", "#include <stdlib.h>", "#define FLOAT_MATH 1", "#define IQ_MATH 0",
        "#ifndef MATH_TYPE", "#define MATH_TYPE IQ_MATH", "#endif", "#ifndef GLOBAL_Q", "#define GLOBAL_Q 24", "#endif",
        "#define QG GLOBAL_Q", *(f"#define Q{q} {q}" for q in ALL),
        "#define MAX_IQ_POS LONG_MAX", "#define MAX_IQ_NEG LONG_MIN", "#define MIN_IQ_POS 1", "#define MIN_IQ_NEG -1",
        "#if MATH_TYPE == IQ_MATH", *_fixed(),
        "#else", "#include <math.h>", "#include <stdio.h>", *_floating(), "#endif",
    ]  # fmt: skip
    return guarded(NAME, lines)


def _fixed() -> Iterator[str]:
    yield "typedef long _iq;"
    yield from (f"typedef long _iq{q};" for q in ALL)
    for by in range(1, 7):
        yield f"#define _IQmpy{1 << by}(A) ((A) << {by})"
        yield f"#define _IQdiv{1 << by}(A) ((A) >> {by})"
    for q in ALL:
        yield f"#define _IQ{q}(A) ((long)((A) * {1 << q}.0L))"
        yield f"extern float _IQ{q}toF(long A);"
        yield f"#define _IQ{q}mpy(A, B) __IQmpy(A, B, {q})"
        yield f"#define _IQ{q}mpyIQX(A, IQA, B, IQB) __IQxmpy(A, B, ({q} + 32 - (IQA) - (IQB)))"
        yield f"#define _IQ{q}mpyI32(A, B) ((A) * (B))"
        yield f"#define _IQ{q}abs(A) labs(A)"
        yield f"#define _IQ{q}atan(A) _IQ{q}atan2(A, {1 << q}L)"
        yield f"#define _atoIQ{q}(A) _atoIQN(A, {q})"
        yield f"#define _IQ{q}toa(A, B, C) __IQNtoa(A, B, C, {q})"
    for name, of in formats().items():
        parameters = "long A, long B" if name in OF_TWO else "long A"
        yield from (f"extern long _IQ{q}{name}({parameters});" for q in of)
    yield "extern long _atoIQN(const char *A, long q_value);"
    yield "extern int __IQNtoa(char *A, const char *B, long C, int D);"
    for q in ALL:
        yield f"#if GLOBAL_Q == {q}"
        yield from (f"#define _IQ(A) _IQ{q}(A)", f"#define _IQtoF(A) _IQ{q}toF(A)", f"#define _IQatan(A) _IQ{q}atan(A)")
        yield from (f"#define _IQ{name}({_parameters(name)}) _IQ{q}{name}({_parameters(name)})"
                    for name, of in formats().items() if q in of)
        yield from _other_formats(q)
        yield "#endif"
    yield "#define _IQsat(A, Pos, Neg) __IQsat(A, Pos, Neg)"
    yield "#define _IQmpy(A, B) __IQmpy(A, B, GLOBAL_Q)"
    yield "#define _IQmpyIQX(A, IQA, B, IQB) __IQxmpy(A, B, (GLOBAL_Q + 32 - (IQA) - (IQB)))"
    yield "#define _IQmpyI32(A, B) ((A) * (B))"
    yield "#define _IQabs(A) labs(A)"
    yield "#define _atoIQ(A) _atoIQN(A, GLOBAL_Q)"
    yield "#define _IQtoa(A, B, C) __IQNtoa(A, B, C, GLOBAL_Q)"


def _other_formats(q: int) -> Iterator[str]:
    """The conversions from the global format to other formats, and back."""
    for kind, others in (("IQ", ALL), ("Q", _SHORT)):
        for other in others:
            there, back = (">>", "<<") if other <= q else ("<<", ">>")
            by = abs(q - other)
            yield f"#define _IQto{kind}{other}(A) ((long)(A) {there} {by})"
            yield f"#define _{kind}{other}toIQ(A) ((long)(A) {back} {by})"


#: Function -> its expression in floats.
_FLOATS: Final = {
    "mpy": "((A) * (B))", "rmpy": "((A) * (B))", "rsmpy": "((A) * (B))", "div": "((float)(A) / (float)(B))",
    "sin": "sinf(A)", "sinPU": "sinf((A) * 6.283185307f)", "cos": "cosf(A)", "cosPU": "cosf((A) * 6.283185307f)",
    "asin": "asinf(A)", "acos": "acosf(A)", "atan": "atanf(A)", "atan2": "atan2f(A, B)",
    "atan2PU": "(atan2f(A, B) >= 0.0f ? atan2f(A, B) * (1.0f / 6.283185307f)"
               " : 1.0f + atan2f(A, B) * (1.0f / 6.283185307f))",
    "sqrt": "sqrtf(A)", "isqrt": "(1.0f / sqrtf(A))", "exp": "expf(A)", "log": "logf(A)", "int": "((long)(A))",
    "frac": "((A) - (float)(long)(A))", "mpyI32": "((A) * (float)(B))", "mpyI32int": "((long)((A) * (float)(B)))",
    "mpyI32frac": "((A) * (B) - (float)(long)((A) * (float)(B)))", "mag": "sqrtf((A) * (A) + (B) * (B))",
    "abs": "fabsf(A)", "toF": "(A)",
}  # fmt: skip


def _floating() -> Iterator[str]:
    """The same names for floats, for a program that switches to floating-point mode."""
    yield "typedef float _iq;"
    yield from (f"typedef float _iq{q};" for q in ALL)
    for by in range(1, 7):
        yield f"#define _IQmpy{1 << by}(A) ((A) * {1 << by}.0f)"
        yield f"#define _IQdiv{1 << by}(A) ((A) * {1 / (1 << by)}f)"
    for q in ("", *ALL):
        yield f"#define _IQ{q}(A) (A)"
        yield f"#define _atoIQ{q}(A) atof(A)"
        yield f"#define _IQ{q}toa(A, B, C) sprintf(A, B, C)"
        yield f"#define _IQ{q}mpyIQX(A, IQA, B, IQB) ((A) * (B))"
        for name, expression in _FLOATS.items():
            both = name in OF_TWO or name in (*_PRODUCTS, "mpyI32")
            yield f"#define _IQ{q}{name}({'A, B' if both else 'A'}) {expression}"
    yield "#define _IQsat(A, Pos, Neg) (__fmax(__fmin(A, Pos), Neg))"
    for q in ALL:
        yield from (f"#define _IQtoIQ{q}(A) (A)", f"#define _IQ{q}toIQ(A) (A)")
    for q in _SHORT:
        yield f"#define _IQtoQ{q}(A) ((int)((A) * {1 << q}.0f))"
        yield f"#define _Q{q}toIQ(A) ((float)(A) * {1 / (1 << q)}f)"
