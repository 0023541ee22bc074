"""Hints what to write instead of constructs that C-shaped Python does not have: words, syntax of C and Python."""

from __future__ import annotations

import ast
import re
from functools import lru_cache
from pathlib import Path
from typing import Final

_LIBRARY: Final = "emulator.c28x.rts"
_STRUCTURE: Final = "a structure, class NAME(struct), or an array of them"
_CONSOLE: Final = f"sprintf of {_LIBRARY} into an array of char: the chip has no console"
_RANGE: Final = "for i in range(first, limit, step)"
#: Names of C or Python -> what to write here.
_NAMES: Final = {
    # C's types
    "int": "int16", "float": "float32", "bool": "uint16, with 1 and 0", "_Bool": "uint16, with 1 and 0",
    "uint8": "uchar: this chip has no type of 8 bits", "int8": "schar: this chip has no type of 8 bits",
    "uint8_t": "uchar: this chip has no type of 8 bits", "int8_t": "schar: this chip has no type of 8 bits",
    "Uint8": "uchar: this chip has no type of 8 bits", "Int8": "schar: this chip has no type of 8 bits",
    "byte": "uchar: this chip has no type of 8 bits", "uint16_t": "uint16", "int16_t": "int16", "uint32_t": "uint32",
    "int32_t": "int32", "uint64_t": "uint64", "int64_t": "int64", "Uint16": "uint16", "Int16": "int16",
    "Uint32": "uint32", "Int32": "int32", "Uint64": "uint64", "Int64": "int64", "float32_t": "float32",
    "double": "float32, as double is on this chip", "float64_t": "float64",
    "unsigned": "uint16", "signed": "int16", "long": "int32", "ulong": "uint32", "short": "int16", "ushort": "uint16",
    "uint": "uint16", "size_t": "uint32", "ptrdiff_t": "int32", "uintptr_t": "uint32", "PINT": "funcptr[void]",
    # C's words
    "true": "1", "false": "0", "TRUE": "1", "FALSE": "0", "nullptr": "NULL", "asm": "EALLOW(), EDIS(), EINT(), DINT()",
    "__asm": "EALLOW(), EDIS(), EINT(), DINT()", "__eallow": "EALLOW()", "__edis": "EDIS()",
    "__disable_interrupts": "DINT()", "__enable_interrupts": "EINT()", "goto": "a loop, a function or an if",
    "printf": _CONSOLE, "puts": _CONSOLE, "putchar": _CONSOLE,
    "scanf": "a driver for the serial line", "offsetof": "uint32(addressof(object.member)) - uint32(addressof(object))",
    "assert": "if not condition: and what is to happen then", "switch": "match", "typedef": "NAME = TYPE",
    # Python's types
    "str": "array[char, N], or ptr[char]", "bytes": "array[uchar, N]", "bytearray": "array[uchar, N]",
    "list": "array[TYPE, N]", "List": "array[TYPE, N]", "tuple": _STRUCTURE, "Tuple": _STRUCTURE, "dict": _STRUCTURE,
    "Dict": _STRUCTURE, "set": "array[TYPE, N]", "frozenset": "array[TYPE, N]", "complex": _STRUCTURE,
    "object": "ptr[void]", "Any": "the type that it has", "Optional": "ptr[TYPE], which may be NULL",
    "Union": "class NAME(union)", "Callable": "funcptr[RESULT, PARAMETER]", "Enum": "enum", "IntEnum": "enum",
    "Literal": "an enumeration, class NAME(enum)", "Final": "const[TYPE]", "ClassVar": "an object at file scope",
    # Python's values and functions
    "True": "1", "False": "0", "None": "NULL", "print": _CONSOLE, "input": "a driver for the serial line",
    "open": "a driver: the chip has no files", "len": "sizeof(v) / sizeof(v[0]), or strlen for a text", "ord": "'A'",
    "chr": "char(code)", "min": "a if a < b else b", "max": "a if a > b else b", "sum": "a loop",
    "any": "a loop", "all": "a loop", "map": "a loop", "filter": "a loop", "sorted": "a loop", "reversed": _RANGE,
    "enumerate": _RANGE, "zip": _RANGE, "range": _RANGE, "iter": _RANGE, "next": "an index", "round": "int16(x + 0.5)",
    "divmod": "a / b and a % b", "hex": f'sprintf of {_LIBRARY} with "%x"', "bin": "a loop over the bits",
    "id": "addressof(object)", "type": "the type itself", "isinstance": "nothing: the type is known",
    "property": "a function", "super": "a function by its name", "exec": "a function", "eval": "a function",
    "self": "a pointer to the structure, as a parameter",
}  # fmt: skip
#: Modules of Python's library whose names no firmware uses -> what to write here.
_MODULES: Final = {
    "math": f"from {_LIBRARY} import sin, cos, sqrt, fabs", "random": "a generator of your own: x = x * 25173 + 13849",
    "dataclasses": "class NAME(struct) with struct of emulator.c28x.language",
    "ctypes": "from emulator.c28x.language import *", "threading": "a task of emulator.sysbios.headers",
    "asyncio": "a task of emulator.sysbios.headers", "numpy": "array[TYPE, LENGTH] and loops",
}  # fmt: skip
#: Header in C-shaped Python -> the files with its declarations.
_HEADERS: Final = {
    _LIBRARY: ("c28x/rts.py",), "emulator.device_h": ("device_h.py", "blocks.py"),
    "emulator.sysbios.headers": ("sysbios/headers.py",),
}  # fmt: skip
#: Words of the language that cannot be used alone -> their syntax.
_WORDS: Final = {
    "ptr": "ptr[TYPE]", "array": "array[TYPE, LENGTH]", "const": "const[TYPE]", "volatile": "volatile[TYPE]",
    "static": "static[TYPE]", "struct": "class NAME(struct)", "union": "class NAME(union)", "enum": "class NAME(enum)",
    "do": "while do(test):", "fallthrough": "fallthrough() at the end of a case", "bits": "Annotated[uint16, bits(3)]",
    "addressof": "addressof(object)", "sizeof": "sizeof(TYPE)", "cast": "cast(ptr[TYPE], value)",
    "extern": "@extern before a function", "interrupt": "@interrupt before a function",
    "handle": 'NAME = handle("NAME")', "cregister": "NAME: cregister[uint16]",
}  # fmt: skip

#: Kinds of Python statements and expressions -> what to write here.
_CONSTRUCTS: Final = {
    "With": "the statements before and after it", "AsyncWith": "the statements before and after it",
    "Try": "an if: C has no exceptions, a function returns a status",
    "TryStar": "an if: C has no exceptions, a function returns a status",
    "Raise": "return with a status: C has no exceptions", "Assert": "if not condition: and what is to happen then",
    "FunctionDef": "the function at file scope", "AsyncFunctionDef": "def: a task of SYS/BIOS for what runs beside",
    "ClassDef": "the type at file scope", "Import": "the import at file scope",
    "ImportFrom": "the import at file scope", "Delete": "nothing, because a local ends with its block",
    "Nonlocal": "an object at file scope, and global", "AsyncFor": "for", "TypeAlias": "NAME = TYPE at file scope",
    "AnnAssign": "the type where the object itself is declared", "For": _RANGE, "While": "while without else",
    "List": "the list where the array is declared, v: array[int16, 3] = (1, 2, 3)",
    "Tuple": "one assignment for each object, or the list where the object is declared: v: array[int16, 2] = (1, 2)",
    "Dict": "the list where the array is declared, v: array[int16, 3] = {2: 5}", "Set": "an array",
    "ListComp": "a loop", "SetComp": "a loop", "DictComp": "a loop", "GeneratorExp": "a loop",
    "Lambda": "a function at file scope, and its name here", "JoinedStr": f"sprintf of {_LIBRARY}",
    "TemplateStr": f"sprintf of {_LIBRARY}", "Await": "a call", "Yield": "return", "YieldFrom": "return",
    "Starred": "p[0] for what p points to", "Slice": "a loop over the elements, or memcpy",
    "NamedExpr": "the assignment as a statement",
}  # fmt: skip
#: What to do with other statements than declarations at file scope.
_AT_FILE_SCOPE: Final = "only declarations are allowed there: write it into a function"

_OPERATORS: Final = {
    "FloorDiv": "/, which truncates integers", "Pow": "x * x, or pow of emulator.c28x.rts", "MatMult": "a loop",
}  # fmt: skip
_COMPARISONS: Final = {"Is": "==", "IsNot": "!=", "In": "x == a or x == b", "NotIn": "x != a and x != b"}

_TYPES: Final = (
    r"(?:(?:static|const|volatile|extern|unsigned|signed|struct|union|enum|register)\s+)*"
    r"(?:u?int(?:8|16|32|64)?(?:_t)?|[Uu]int(?:8|16|32|64)|u?char|float(?:32|64)?|double|long|short|void|unsigned|bool)"
)
#: C syntax in a line that Python cannot parse, in the order of the search.
_SPELLINGS: Final = (
    (r"^\s*(?:typedef\s+)?(?:struct|union|enum)\b", "class NAME(struct): with a line `member: type` for each member"),
    (r"^\s*(?:typedef\b|type\s+\w+\s*=)", "NAME = TYPE at file scope"),
    (r"^\s*(?:else\s+if)\b", "elif"),
    (r"^\s*(?:switch)\b", "match x: with case 1: and case _:"),
    (r"^\s*default\s*:", "case _:"),
    (r"^\s*case\b.*:\s*case\b", "case 1 | 2:"),
    (r"^\s*goto\b", "a loop, a function or an if"),
    (r"^\s*for\s*\(", "for i in range(first, limit, step):, or a while"),
    (r"^\s*do\b\s*(?:\{|$)", "while do(test): before the body"),
    (rf"^\s*{_TYPES}[\s*]+\w+\s*\(", "def name(parameter: type) -> type:"),
    (rf"^\s*{_TYPES}[\s*]+\w+\s*(?:\[|=|;|,|$)", "a declaration as name: type = value"),
    (r"^\s*(?:static|const|volatile|extern|unsigned|signed|register)\s+\w", "a declaration as name: type = value"),
    (r"//|/\*", "# before a comment"),
    (r"\{\s*$|^\s*\}", "a block as a colon and an indented body"),
    (r"\w\s*\+\+|\+\+\s*\w", "x += 1"),
    (r"\w\s*--|--\s*\w", "x -= 1"),
    (r"->\s*\w", "p.member for p->member"),
    (r"&&", "and for &&"),
    (r"\|\|", "or for ||"),
    (r"!(?!=)", "not for !"),
    (r"\?", "a if test else b"),
    (r"\b(?:0[xX][0-9a-fA-F]+|\d+)[uUlL]+\b", "a cast for the suffix of a constant: uint32(1)"),
    (r"\b(?:\d+\.\d*|\.\d+|\d+)[fF]\b", "1.5 without f: it is a float32"),
    (rf"\(\s*{_TYPES}\s*\*+\s*\)\s*\w", "cast(ptr[TYPE], value) for a cast"),
    (rf"\(\s*{_TYPES}\s*\)\s*[\w(]", "uint16(value) for a cast"),
    (r"(?:^|[=(,]|\breturn\b)\s*&\s*\w", "addressof(x) for &x"),
    (r"(?:^|[=(,]|\breturn\b)\s*\*+\s*\w", "p[0] for *p"),
    (r"\bsizeof\s+\w", "sizeof(x)"),
)  # fmt: skip
#: Messages of Python about text that its grammar accepts -> what to write.
_MESSAGES: Final = (
    ("'break' outside loop", "a case ends by itself: write the rest of it into an else, or a function with return"),
    ("'continue' not properly in loop", "continue stands in a while or for"),
    ("outside async function", "write a call, or a task of emulator.sysbios.headers"),
    ("nonlocal", "write an object at file scope, and global"),
    ("makes remaining patterns unreachable", "the default, case _, comes last"),
)
_QUOTED: Final = re.compile(r"'(?:\\.|[^'\\])*'|\"(?:\\.|[^\"\\])*\"")


def hint(name: str, text: str = "") -> str:
    """What to write instead of an unknown name in the module `text`: empty, or `: write ...`."""
    if name in _NAMES:
        return f": write {_NAMES[name]}"
    if name in _MODULES:
        return library(name)
    if name in _WORDS:
        return f": write {_WORDS[name]}"
    for header, paths in _HEADERS.items():
        if any(name in _declared(path) for path in paths):
            return f": write from {header} import {name}"
    if text and re.search(rf"^[ \t]*#[ \t]*define[ \t]+{re.escape(name)}\b", text, re.MULTILINE):
        return f": # begins a comment; for #define {name} write {name} = value"
    return ""


@lru_cache(maxsize=8)
def _declared(path: str) -> frozenset[str]:
    """The names that a file declares: a header in C-shaped Python, or the table of blocks."""
    text = (Path(__file__).parents[3] / path).read_text(encoding="utf-8")
    return frozenset(re.findall(r"^(?:def |class )?([A-Za-z]\w*)(?=\(|:(?! Final)| = )", text, re.MULTILINE))


def construct(node: ast.AST) -> str:
    """What to write instead of a construct of Python: empty, or `: write ...`."""
    wanted = _CONSTRUCTS.get(type(node).__name__)
    return "" if wanted is None else f": write {wanted}"


def at_file_scope(node: ast.stmt) -> str:
    """What to write instead of a statement at file scope."""
    if isinstance(node, ast.ImportFrom | ast.Import | ast.FunctionDef | ast.ClassDef):
        return ""
    wanted = _CONSTRUCTS.get(type(node).__name__) if isinstance(node, ast.AsyncFunctionDef | ast.AnnAssign) else None
    if type(node).__name__ == "TypeAlias":
        wanted = "NAME = TYPE"
    return f": {_AT_FILE_SCOPE}" if wanted is None else f": write {wanted}"


def operator(op: ast.operator | ast.cmpop) -> str:
    """What to write instead of an operator of Python: empty, or `: write ...`."""
    kind = type(op).__name__
    wanted = _OPERATORS.get(kind) or _COMPARISONS.get(kind)
    return "" if wanted is None else f": write {wanted}"


def library(module: str) -> str:
    """What to import instead of a module of Python's library."""
    top = module.split(".", 1)[0]
    known = _MODULES.get(top) or {
        "time": "from emulator.device_h import DelayUs, or Task_sleep of emulator.sysbios.headers",
        "enum": "class NAME(enum) with enum of emulator.c28x.language", "struct": "a union: class NAME(union)",
    }.get(top)  # fmt: skip
    return "" if known is None else f": write {known}"


def spelling(line: str, message: str) -> str:
    """What to write instead of C syntax in a line that Python rejects with `message`: empty, or `: ...`."""
    for part, wanted in _MESSAGES:
        if part in message:
            return f": {wanted}"
    code = _QUOTED.sub("0", line).split("#", 1)[0][:400]
    for pattern, wanted in _SPELLINGS:
        if re.search(pattern, code):
            return f": write {wanted}"
    return ""
