"""Register blocks as C names and types: `EPwm1Regs` of type `struct EPWM_REGS`, and the members of that structure.

The blocks and their registers are read from the device header, which has them from `emulator.blocks`.  The device
header in C text only declares the blocks, because otherwise 4,000 lines of fields would be parsed for each file.  The C
reader resolves a block by its name (`instances`), a pointer to a block by the tag of its structure (`block_types`), and
the type of a copy of a register by its tag (`register_type`).  `block_text` returns the types as C text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from emulator.c28x.ctypes import UINT, ULONG, StructType, UnionType, complete
from emulator.c28x.program import Program
from emulator.c28x.readers.c.module_header import own_symbols
from emulator.c28x.symbols import Module, RegisterBlock, Unmodelled


@lru_cache(maxsize=1)
def device() -> Module:
    """The device header in C-shaped Python, read."""
    return Program().module("emulator.device_h")


@lru_cache(maxsize=1)
def block_types() -> Mapping[str, RegisterBlock]:
    """Tag of a block's structure -> its registers, with the name of the block class."""
    blocks = [symbol for symbol in device().symbols.values() if isinstance(symbol, RegisterBlock)]
    return MappingProxyType({symbol.struct: replace(symbol, name=symbol.type_name) for symbol in blocks})


@lru_cache(maxsize=1)
def instances() -> Mapping[str, RegisterBlock]:
    """Name of a register block in C -> its registers, with that name."""
    own = own_symbols(device())
    return MappingProxyType({name: symbol for name, symbol in own.items() if isinstance(symbol, RegisterBlock)})


@lru_cache(maxsize=1)
def unmodelled() -> Mapping[str, Unmodelled]:
    """Name of each register block in C that is not modelled -> the block."""
    own = own_symbols(device())
    return MappingProxyType({name: symbol for name, symbol in own.items() if isinstance(symbol, Unmodelled)})


def tag(name: str) -> str:
    """The tag of the structure of the block that C calls `name`.  Raises KeyError for one that is not modelled."""
    return instances()[name].struct


def declarations() -> Iterator[str]:
    """The C declarations of the blocks, without their members."""
    for name in instances():
        yield f"extern volatile struct {tag(name)} {name};"


@lru_cache(maxsize=1)
def _registers() -> Mapping[str, Any]:
    """Name of a register with fields -> the register.  Registers of one name have the same fields in all blocks."""
    return MappingProxyType({
        name: described
        for block in block_types().values()
        for name, described in block.layout.items()
        if described.part is None and not _plain(described)
    })  # fmt: skip


def register_type(tag: str) -> StructType | None:
    """The type that C calls `struct NAME_BITS` or `union NAME_REG`, made anew; None: no register has this name.

    A copy of a register in RAM has this type: firmware prepares there a value that it then writes at once.
    """
    name, _, kind = tag.rpartition("_")
    described = _registers().get(name) if kind in ("BITS", "REG") else None
    if described is None:
        return None
    bits = StructType(f"struct {name}_BITS")
    complete(bits, [(field, ULONG if wide == 32 else UINT, width) for wide, field, width in _fields(described)])
    if kind == "BITS":
        return bits
    word = ULONG if described.register.bits == 32 else UINT
    return complete(UnionType(f"union {tag}"), [("all", word, None), ("bit", bits, None)])


@lru_cache(maxsize=64)
def block_text(name: str) -> str:
    """The definition of the structure with the tag `name`, with the types of its registers before it.

    Every register is at its true offset; reserved parts are filled with words.  The structure ends with its last
    register.  Needs Uint16, Uint32 and PINT.  Raises KeyError for a tag that is not a block's.
    """
    layout = block_types()[name].layout
    registers = sorted(layout.items(), key=lambda item: item[1].offset)
    kinds = {described.part.kind.struct: None for _, described in registers if described.part is not None}
    own = [(register, described) for register, described in registers if described.part is None]
    parts = [text for register, described in own for text in _register_types(register, described)]
    parts = [*map(block_text, kinds), *parts]
    lines, at, gaps = [], 0, 0
    for register, described in registers:
        if described.part is not None and described.offset < at:
            continue
        if described.offset > at:
            gaps += 1
            lines.append(f"    Uint16 rsvd{gaps}[{described.offset - at}];")
        part = described.part
        if part is None:
            lines.append(f"    {_register_type(register, described)} {register};")
            at = described.offset + described.register.bits // 16
        else:
            lines.append(f"    struct {part.kind.struct} {part.name};")
            at = part.offset + max(one.offset + one.register.bits // 16 for one in part.kind.layout.values())
    return "\n".join([*parts, f"struct {name} {{", *lines, "};", ""])


def _plain(described: Any) -> bool:
    """Whether C accesses a register as a whole: a number, or a vector as a pointer, without fields."""
    return list(described.register.fields) == ["VALUE"]


def _register_type(name: str, described: Any) -> str:
    if getattr(described, "routine", False):
        return "PINT"
    if _plain(described):
        return "Uint32" if described.register.bits == 32 else "Uint16"
    return f"union {name}_REG"


def _fields(described: Any) -> Iterator[tuple[int, str, int]]:
    """The fields of a register from bit 0 up: bits of the declared type (16 or 32), name, width."""
    bits = described.register.bits
    at, gaps = 0, 0
    named = [(field, f) for field, f in described.register.fields.items() if f.access.name != "RSV"]
    for field, f in [*sorted(named, key=lambda item: item[1].lo), ("", None)]:
        lo = bits if f is None else f.lo
        while at < lo:  # a reserved field ends at the end of a word
            gaps += 1
            width = min(lo, (at // 16 + 1) * 16) - at
            yield 16, f"rsvd{gaps}", width
            at += width
        if f is not None:
            yield 32 if f.lo // 16 != f.hi // 16 else 16, field, f.hi - lo + 1
            at = f.hi + 1


def _register_types(name: str, described: Any) -> Iterator[str]:
    """The structure of a register's fields from bit 0 up, and the union of it with the whole word."""
    if _plain(described):
        return
    lines = [f"    Uint{wide} {field}:{width};" for wide, field, width in _fields(described)]
    yield "\n".join([f"struct {name}_BITS {{", *lines, "};"])
    yield f"union {name}_REG {{ Uint{described.register.bits} all; struct {name}_BITS bit; }};"
