"""Pass `frame`: the places of the locals of a function on the stack."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from emulator.c28x.ctypes import ArrayType
from emulator.c28x.tree import Function
from emulator.c28x.tree_queries import INSTRUCTIONS

#: The words of a frame before its locals: the return address that LCR saves.
FRAME_WORDS: Final = 2


def lay_out(function: Function, room: Mapping[str, int], *, residue: bool) -> None:
    """Give every local its word in the frame.  `room`: path of an array -> its length, instead of that of its type."""
    words = FRAME_WORDS
    for variable in (*(p for p in function.parameters if p.in_memory), *function.locals):
        if variable.kind == "temporary":
            continue
        path = variable.declaration.path
        if path in room and isinstance(variable.ctype, ArrayType):
            element = variable.ctype.element
            variable.ctype = ArrayType(f"{element}[]", element, room[path])
            variable.declaration = replace(variable.declaration, ctype=variable.ctype)
        align = variable.ctype.align
        words = -(-words // align) * align
        variable.frame_offset = words
        words += variable.ctype.words
    function.live = [v for v in (*function.parameters, *function.locals) if v.in_memory and v.escapes]
    calls = any(path.rsplit(".", 1)[-1] not in INSTRUCTIONS for path in function.calls)
    needed = residue or calls or bool(function.live) or any(v.in_memory for v in function.locals)
    function.frame_words = words + words % 2 if needed else 0
