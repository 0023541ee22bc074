"""C text of types and declarations, for all generated headers.

A type is written as in C, inside out: `int (*table[4])(char)`.  A `FunctionType` is the type of a pointer to a
function, as everywhere in the translator; only `prototype` writes a function itself.
"""

from __future__ import annotations

from collections.abc import Sequence

from emulator.c28x.ctypes import ArrayType, CType, FunctionType, PointerType, StructType, UnionType
from emulator.c28x.symbols import Define, EnumType
from emulator.c28x.tree import Function


def declarator(ctype: CType, name: str = "") -> str:
    """The declaration of `name` with type `ctype`, without the semicolon.  Without a name: the type, as in a cast."""
    match ctype:
        case PointerType(target=target):
            return declarator(target, f"*{name}")
        case ArrayType(element=element, length=length):
            return declarator(element, f"{_grouped(name)}[{length}]")
        case FunctionType(result=result):
            # An empty list means any parameters, as `funcptr` does.
            return declarator(result, f"(*{name})({_parameters(ctype, (), empty='')})")
    return f"{ctype.name} {name}".rstrip()


def prototype(function: Function) -> str:
    """The declaration of a function, with the names of its parameters, without the semicolon."""
    names = [parameter.declaration.name for parameter in function.parameters]
    return declarator(function.ctype.result, f"{function.name}({_parameters(function.ctype, names, empty='void')})")


def _parameters(ctype: FunctionType, names: Sequence[str], *, empty: str) -> str:
    listed = [declarator(p, names[i] if names else "") for i, p in enumerate(ctype.parameters)]
    return ", ".join([*listed, "..."] if ctype.variadic else listed) or empty


def _grouped(name: str) -> str:
    """A declarator in parentheses if it begins with `*`, because `[]` and `()` bind before `*`."""
    return f"({name})" if name.startswith("*") else name


def structure(ctype: StructType) -> str:
    """The definition of a structure or union by its tag; `forward` makes the tag a type name."""
    lines = []
    bit_field = False
    for member in ctype.members:
        width = "" if member.width is None else f" : {member.width}"
        if bit_field and width and not member.lo and not isinstance(ctype, UnionType):
            lines.append(f"    {declarator(member.ctype)} : 0;\n")  # the next bit-field begins a new word
        lines.append(f"    {declarator(member.ctype, member.name)}{width};\n")
        bit_field = bool(width)
    return f"{_word(ctype)} {ctype.name} {{\n{''.join(lines)}}};"


def forward(ctype: StructType) -> str:
    """The declaration of a structure without its members: after it, pointers to the structure can be declared."""
    return f"typedef {_word(ctype)} {ctype.name} {ctype.name};"


def _word(ctype: StructType) -> str:
    return "union" if isinstance(ctype, UnionType) else "struct"


def enumeration(ctype: EnumType) -> str:
    """The definition of an enumeration, under the same name as tag and as type."""
    constants = ", ".join(f"{name} = {value}" for name, value in ctype.constants.items())
    return f"typedef enum {ctype.name} {{ {constants} }} {ctype.name};"


def definition(name: str, define: Define) -> str | None:
    """The `#define` of a constant; None if C has no such constant."""
    value = define.written()
    return None if value is None else f"#define {name} {value}"
