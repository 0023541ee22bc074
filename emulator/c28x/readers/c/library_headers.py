"""The headers of C's library as C text, for the C28x: types, limits and the functions of `emulator.c28x.rts`.

Functions of the library that the emulator does not have are declared too.  So the error for a program that uses one
says "not modelled", not "undeclared" (`unmodelled`).  Sizes and limits come from `ctypes`: the smallest type has 16
bits, so there is no `uint8_t`; `size_t` is `unsigned long`.  Sources: CC table 6-1; ISO C 7; TI's stdint.h, stddef.h
and float.h for this chip.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Final

from emulator.c28x.ctypes import CHAR, INT, LONG, SCHAR, UCHAR, UINT, ULONG, IntType
from emulator.c28x.program import Program
from emulator.c28x.readers.c.library_text import TEXT
from emulator.c28x.readers.c.module_header import guarded, own_symbols, prototypes
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Function

#: In a variadic function, the name of the pointer to its extra arguments.
VA_GIVEN: Final = "va_given"
#: The functions of one or two real numbers that `rts.py` declares: of `float`, and with an `l` of `long double`.
_REAL: Final = (
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log", "pow", "sqrt", "floor", "ceil", "fmod", "fabs",
)
#: Header -> the functions of `rts.py` that it declares.
FUNCTIONS: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType({
    "math.h": (*_REAL, *(f"{name}l" for name in _REAL)),
    "stdarg.h": ("va_arg_at",),
    "stdio.h": ("printf", "puts", "putchar", "sprintf", "snprintf", "vprintf", "vsprintf", "vsnprintf"),
    "stdlib.h": ("atof", "atoi", "atol", "strtold", "abs", "labs", "malloc", "calloc", "realloc", "free"),
    "string.h": ("memcpy", "memset", "memcmp", "memmove", "strlen", "strcmp", "strcpy", "strcat", "strncpy", "strncmp",
                 "strncat", "strchr", "strrchr", "strstr"),
})  # fmt: skip
#: Header -> declarations of functions that are not modelled (ISO C 7).
_UNMODELLED: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType({
    "math.h": (
        "double sinh(double x)", "double cosh(double x)", "double tanh(double x)", "double log10(double x)",
        "double ldexp(double x, int n)", "double frexp(double x, int *n)", "double modf(double x, double *whole)",
        "double hypot(double x, double y)", "double cbrt(double x)", "double exp2(double x)", "double log2(double x)",
        "long lrint(double x)", "double rint(double x)", "double copysign(double x, double y)",
    ),
    "stdio.h": (
        "int getchar(void)", "int scanf(const char *form, ...)", "int sscanf(const char *text, const char *form, ...)",
    ),
    "stdarg.h": (),
    "stdlib.h": (
        "void exit(int status)",
        "long long strtoll(const char *text, char **end, int base)",
        "unsigned long long strtoull(const char *text, char **end, int base)",
    ),
    "string.h": (
        "void *memchr(const void *block, int character, size_t n)", "char *strerror(int number)",
    ),
})  # fmt: skip
#: Function of float -> function of double: under COFF they are the same, because `double` is `float` there.
OF_FLOAT: Final[Mapping[str, str]] = MappingProxyType({f"{name}f": name for name in (*_REAL, *TEXT["math.h"])})
#: POSIX constants that many programs expect in math.h; the compiler's math.h has them.
_MATHEMATICAL: Final = (
    ("PI", math.pi), ("PI_2", math.pi / 2), ("PI_4", math.pi / 4), ("1_PI", 1 / math.pi), ("2_PI", 2 / math.pi),
    ("E", math.e), ("LN2", math.log(2)), ("LN10", math.log(10)), ("SQRT2", math.sqrt(2)),
    ("SQRT1_2", math.sqrt(0.5)),
)  # fmt: skip
#: Character tests in the C locale: name -> condition on c.
_CHARACTERS: Final = (
    ("isdigit", "c >= '0' && c <= '9'"),
    ("isupper", "c >= 'A' && c <= 'Z'"),
    ("islower", "c >= 'a' && c <= 'z'"),
    ("isalpha", "isupper(c) || islower(c)"),
    ("isalnum", "isalpha(c) || isdigit(c)"),
    ("isxdigit", "isdigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')"),
    ("isspace", "c == ' ' || (c >= '\\t' && c <= '\\r')"),
    ("isprint", "c >= ' ' && c <= '~'"),
    ("isgraph", "c > ' ' && c <= '~'"),
    ("iscntrl", "(c >= 0 && c < ' ') || c == 127"),
    ("ispunct", "isgraph(c) && !isalnum(c)"),
)
#: stdint.h: the types with an exact number of bits.
_EXACT: Final = (("int", 16), ("long", 32), ("long long", 64))
#: The largest number of 64 bits.
_DOUBLE_MAX: Final = "1.7976931348623157e+308"
_NULL: Final = ("#ifndef NULL", "#define NULL 0", "#endif")
#: Names that programs expect in these headers but that cannot exist on this chip -> what to write instead.
ABSENT: Final[Mapping[str, str]] = MappingProxyType({
    **{name: f"{name} does not exist on this chip, whose smallest type has 16 bits: write {wide}"
       for name, wide in (("uint8_t", "uint16_t"), ("int8_t", "int16_t"), ("Uint8", "Uint16"), ("int8", "int16"),
                          ("UINT8_MAX", "UINT16_MAX"), ("INT8_MAX", "INT16_MAX"), ("INT8_MIN", "INT16_MIN"))},
    **{name: f"{name} of C's library is not modelled"
       for name in ("complex.h", "errno.h", "fenv.h", "iso646.h", "locale.h", "setjmp.h", "signal.h", "tgmath.h",
                    "wchar.h", "wctype.h")},
})  # fmt: skip


@lru_cache(maxsize=1)
def library() -> Module:
    """The prototypes of the run-time library in C-shaped Python, read."""
    return Program().module("emulator.c28x.rts")


def header(name: str) -> str:
    """The text of the standard header `name`.  Raises KeyError for an unknown header."""
    return guarded(name, list(_CONTENT[name](name)))


def unmodelled() -> Iterator[str]:
    """Names of functions that the headers declare but the emulator does not have."""
    for declarations in _UNMODELLED.values():
        for declaration in declarations:
            yield declaration.split("(")[0].split()[-1].lstrip("*")


def _functions(name: str) -> Iterator[str]:
    own = own_symbols(library())
    yield from prototypes({function: own[function] for function in FUNCTIONS[name]})
    yield from (f"{declaration};" for declaration in _UNMODELLED[name])
    for text in TEXT.get(name, {}).values():
        yield from text.strip().splitlines()


def _math(name: str) -> Iterator[str]:
    yield from _functions(name)
    real = "|".join((*_REAL, *TEXT[name]))
    for text in TEXT[name].values():
        wide = re.sub(rf"\b({real})\b", r"\1l", text)
        yield from re.sub(r"\bfloat\b", "long double", wide).strip().splitlines()
    yield "#ifdef __TI_EABI__"
    # `sin` is the function of float above this line, and that of double below it.
    yield from (_of_float(function) for function in _REAL)
    for function, text in TEXT[name].items():
        yield from re.sub(rf"\b{function}\b", f"{function}f", text).strip().splitlines()
    yield from (f"#define {function}(...) {function}l(__VA_ARGS__)" for function in OF_FLOAT.values())
    yield f"#define HUGE_VAL {_DOUBLE_MAX}"
    yield "#else"
    yield from (f"#define {of_float} {function}" for of_float, function in OF_FLOAT.items())
    yield "#define HUGE_VAL 3.402823466e+38f"
    yield "#endif"
    yield from (f"#define M_{name} {value!r}" for name, value in _MATHEMATICAL)


def _of_float(name: str) -> str:
    """The function of float under the name that it has where `double` is another type."""
    function = own_symbols(library())[name]
    assert isinstance(function, Function)
    names = [parameter.declaration.name for parameter in function.parameters]
    listed = ", ".join(f"float {parameter}" for parameter in names)
    return f"static inline float {name}f({listed}) {{ return {name}({', '.join(names)}); }}"


def _stdio(name: str) -> Iterator[str]:
    yield from ("#include <stddef.h>", "#include <stdarg.h>", "#define EOF (-1)")
    yield from _functions(name)


def _stdlib(name: str) -> Iterator[str]:
    yield from ("#include <stddef.h>", "#define EXIT_FAILURE 1", "#define EXIT_SUCCESS 0", "#define RAND_MAX 32767")
    yield "static inline void abort(void) { for (;;) ; }"
    yield from _functions(name)
    yield from ("#ifdef __TI_EABI__", "#define atof(text) strtold(text, (char **)0)", "#define strtod strtold")
    yield from ("#else", "#define strtod strtof", "#endif")


def _time(name: str) -> Iterator[str]:
    # CHOICE: there is no calendar, as on the chip without a debugger: -1 (ISO C 7.23.2.4).
    yield from ("#include <stddef.h>", "typedef unsigned long time_t;")
    yield "static inline time_t time(time_t *timer)"
    yield "{ if (timer != NULL) *timer = (time_t)-1; return (time_t)-1; }"


def _string(name: str) -> Iterator[str]:
    yield "#include <stddef.h>"
    yield from _functions(name)


def _stddef(name: str) -> Iterator[str]:
    yield from _NULL
    yield from ("typedef unsigned long size_t;", "typedef long ptrdiff_t;", "typedef int wchar_t;")
    yield "#define offsetof(type, member) ((size_t)&((type *)0)->member)"


def _stdarg(name: str) -> Iterator[str]:
    yield "typedef char *va_list;"
    yield from _functions(name)
    yield f"#define va_start(list, last) ((list) = {VA_GIVEN})"
    yield "#define va_arg(list, type) (*(type *)va_arg_at(&(list), sizeof(type)))"
    yield "#define va_end(list) ((void)0)"
    yield "#define va_copy(to, from) ((to) = (from))"


def _stdbool(name: str) -> Iterator[str]:
    yield from ("#define bool _Bool", "#define true 1", "#define false 0", "#define __bool_true_false_are_defined 1")


def _stdint(name: str) -> Iterator[str]:
    for ctype, bits in _EXACT:
        for kind in ("int{}_t", "int_least{}_t", "int_fast{}_t"):
            yield f"typedef {ctype} {kind.format(bits)};"
            yield f"typedef unsigned {ctype} u{kind.format(bits)};"
    for kind in ("int_least8_t", "int_fast8_t"):
        yield f"typedef int {kind};"
        yield f"typedef unsigned int u{kind};"
    yield from ("typedef long intptr_t;", "typedef unsigned long uintptr_t;")
    yield from ("typedef long long intmax_t;", "typedef unsigned long long uintmax_t;")
    for suffix, bits in (("", 16), ("L", 32), ("LL", 64)):
        high, unsigned = (1 << bits - 1) - 1, (1 << bits) - 1
        u = f"U{suffix}" if suffix else "U"
        yield f"#define INT{bits}_MAX {high}{suffix}"
        yield f"#define INT{bits}_MIN (-INT{bits}_MAX - 1)"
        yield f"#define UINT{bits}_MAX {unsigned}{u}"
        yield f"#define INT{bits}_C(value) {f'value##{suffix}' if suffix else 'value'}"
        yield f"#define UINT{bits}_C(value) value##{u}"
    yield from ("#define SIZE_MAX UINT32_MAX", "#define INTPTR_MAX INT32_MAX", "#define UINTPTR_MAX UINT32_MAX")


def _limits(name: str) -> Iterator[str]:
    yield f"#define CHAR_BIT {CHAR.bits}"
    yield "#define MB_LEN_MAX 1"
    for prefix, ctype in (("CHAR", CHAR), ("SCHAR", SCHAR), ("SHRT", INT), ("INT", INT), ("LONG", LONG)):
        yield from _range(prefix, ctype)
    for prefix, ctype in (("UCHAR", UCHAR), ("USHRT", UINT), ("UINT", UINT), ("ULONG", ULONG)):
        yield f"#define {prefix}_MAX {ctype.high}{'UL' if ctype.bits > 16 else 'U'}"


def _range(prefix: str, ctype: IntType) -> Iterator[str]:
    """The limits of a signed type.  The lowest value cannot be written as one number."""
    yield f"#define {prefix}_MAX {ctype.high}{'L' if ctype.bits > 16 else ''}"
    yield f"#define {prefix}_MIN (-{prefix}_MAX - 1)"


def _float(name: str) -> Iterator[str]:
    single = (
        ("DIG", "6"), ("EPSILON", "1.192092896e-07f"), ("MANT_DIG", "24"), ("MAX", "3.402823466e+38f"),
        ("MAX_10_EXP", "38"), ("MAX_EXP", "128"), ("MIN", "1.175494351e-38f"), ("MIN_10_EXP", "(-37)"),
        ("MIN_EXP", "(-125)"),
    )  # fmt: skip
    yield "#define FLT_RADIX 2"
    yield "#define FLT_ROUNDS 1"
    double = (
        ("DIG", "15"), ("EPSILON", "2.2204460492503131e-16"), ("MANT_DIG", "53"), ("MAX", _DOUBLE_MAX),
        ("MAX_10_EXP", "308"), ("MAX_EXP", "1024"), ("MIN", "2.2250738585072014e-308"), ("MIN_10_EXP", "(-307)"),
        ("MIN_EXP", "(-1021)"),
    )  # fmt: skip
    yield from (f"#define FLT_{name} {value}" for name, value in single)
    yield from (f"#define LDBL_{name} {value}{'L' if '.' in value else ''}" for name, value in double)
    yield "#ifdef __TI_EABI__"
    yield from (f"#define DBL_{name} {value}" for name, value in double)
    yield "#else"
    yield from (f"#define DBL_{name} {value}" for name, value in single)
    yield "#endif"


def _assert(name: str) -> Iterator[str]:
    # A failed assertion ends in an endless loop, as the library's abort does.
    yield "static inline void _abort_msg(const char *text) { for (;;) ; }"
    yield from ("#ifdef NDEBUG", "#define assert(condition) ((void)0)", "#else")
    yield "#define assert(condition) ((condition) ? (void)0 : _abort_msg(#condition))"
    yield "#endif"


def _ctype(name: str) -> Iterator[str]:
    for function, condition in _CHARACTERS:
        yield f"static inline int {function}(int c) {{ return {condition}; }}"
    yield "static inline int tolower(int c) { return isupper(c) ? c + ('a' - 'A') : c; }"
    yield "static inline int toupper(int c) { return islower(c) ? c - ('a' - 'A') : c; }"


def _inttypes(name: str) -> Iterator[str]:
    yield "#include <stdint.h>"
    for length, bits in (("", 16), ("l", 32)):
        yield from (f'#define PRI{kind}{bits} "{length}{kind}"' for kind in "diouxX")


_CONTENT: Final = MappingProxyType({
    "assert.h": _assert, "ctype.h": _ctype, "float.h": _float, "inttypes.h": _inttypes, "limits.h": _limits,
    "math.h": _math, "stdarg.h": _stdarg, "stdbool.h": _stdbool, "stddef.h": _stddef, "stdint.h": _stdint,
    "stdio.h": _stdio, "stdlib.h": _stdlib, "string.h": _string, "time.h": _time,
})  # fmt: skip
#: The headers of the library.
HEADERS: Final = tuple(_CONTENT)
