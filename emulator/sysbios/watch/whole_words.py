"""Which functions move an object of 32 bits as a whole, and how often each may read it, found in the source.

`d = x` and `y = d` are one MOVL or MOV32 each.  A mask, a shift or a cut of a long (`d |= 1`, `d >> 16`, `(Uint16)d`)
may take one half only, and what uses the address of the object may do anything.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Binary, Const, Convert, If, Load, LValue, Stmt, Switch, Variable
from emulator.c28x.tree_queries import bare, blocks, own_nodes, statements
from emulator.sysbios.watch.statements import Function

#: Words of 32 bits.
_WORDS: Final = 2
_OF_HALVES: Final = ("&", "|", "^", ">>")


def whole_words(modules: Iterable[Module]) -> Mapping[str, Mapping[Function, int]]:
    """Path of a 32-bit object -> the functions that only move it as a whole -> how often they read it on one way.

    A statement that reads two objects that one function sets needs both of one time: this counts as a second read.
    """
    functions = [(f, statements(f.body)) for module in modules for f in module.functions]
    sets = [
        {v for s in every if isinstance(s, Assign) and (v := _word(s.target)) is not None} for _, every in functions
    ]  # fmt: skip
    found: dict[str, dict[Function, int]] = {}
    for function, every in functions:
        used = {v for s in every for p in own_nodes(s) if isinstance(p, LValue) and (v := _word(p)) is not None}
        if used:
            reads = _reads(function.body)
            for together in (_loaded(s) for s in every):
                reads.update(v for v in set(together) if any(v in one and len(one & set(together)) > 1 for one in sets))
            for variable in used - {v for s in every for v in _in_parts(s)}:
                found.setdefault(variable.declaration.path, {})[every[0].where.file, function.name] = reads[variable]
    return found


def _loaded(s: Stmt) -> list[Variable]:
    """The objects that a statement itself reads."""
    return [v for p in own_nodes(s) if isinstance(p, Load) and (v := _word(p)) is not None]


def _word(node: object) -> Variable | None:
    """The 32-bit object that an lvalue, or the load of one, designates; None: another one."""
    lvalue = node.lvalue if isinstance(node, Load) else node
    match lvalue:
        case LValue(root=Variable(kind="global") as variable) if variable.ctype.words == _WORDS:
            return variable
    return None


def _reads(body: list[Stmt]) -> Counter[Variable]:
    """How often a block reads each object at most, on one way through it."""
    most: Counter[Variable] = Counter()
    for s in body:
        most.update(_loaded(s))
        inner = [_reads(block) for block in blocks(s)]
        if isinstance(s, If | Switch):
            either: Counter[Variable] = Counter()
            for one in inner:
                either |= one
            inner = [either]
        for one in inner:
            most.update(one)
    return most


def _in_parts(s: Stmt) -> Iterable[Variable]:
    """The objects of which a statement may use a half, or of which it takes the address."""
    nodes = own_nodes(s)
    moved = [p.lvalue for p in nodes if isinstance(p, Load)] + ([s.target] if isinstance(s, Assign) else [])
    whole = {id(lvalue) for lvalue in moved if isinstance(lvalue, LValue) and lvalue.ctype.words == _WORDS}
    for p in nodes:
        halved: list[object] = []
        match p:
            case LValue() if id(p) not in whole:
                halved = [p]
            case Binary(op=op, left=left, right=right) if op in _OF_HALVES:
                sides = bare(left), bare(right)
                halved = list(sides) if any(isinstance(side, Const) for side in sides) else []
            case Convert(ctype=IntType(bits=16), operand=operand) if isinstance(operand.ctype, IntType):
                halved = [bare(operand)]
        yield from (v for each in halved if (v := _word(each)) is not None)
