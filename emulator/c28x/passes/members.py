"""The members of structures at file scope as objects of their own, for checks that know whole objects only.

    static struct { Uint16 lost, sent; } Link;
    Link.lost++;

A check that asks who writes an object, and who reads it, asks the same of `Link.lost` if only named accesses reach it:
nobody takes the address of `Link` or copies it, and no two members overlap.  Elements of arrays that are only accessed
by constants count as members; an array in a structure that has other subscripts, or whose address is taken, is a member
as a whole.  The trees that the checks get have a variable for each.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, CType, FloatType, IntType, PointerType, StructType, is_word_backed
from emulator.c28x.passes.rewriting import Rewriting
from emulator.c28x.symbols import Module
from emulator.c28x.tree import AddressOf, Bits, Declare, Index, Load, LValue, Variable
from emulator.c28x.tree_queries import assigned, fixed_words, own_nodes, parts, statements

#: A member: its offset in words, and its bits if it is a bit-field.
_Member = tuple[int, Bits | None]
_SCALARS: Final = (IntType, FloatType, PointerType)


def with_members(modules: Iterable[Module]) -> list[Module]:
    """The modules of a whole program; in their trees, the members of structures are objects of their own."""
    modules = list(modules)
    split = _split(modules)
    view = _MemberView(split)
    return [
        view.module(module, [v for variable in module.variables for v in split.get(variable, {0: variable}).values()])
        for module in modules
    ]


def _split(modules: list[Module]) -> dict[Variable, dict[_Member, Variable]]:
    """The structures and arrays whose members are objects of their own, with these."""
    uses: dict[Variable, dict[_Member, LValue] | None] = {
        v: {} for module in modules for v in module.variables
        if isinstance(v.ctype, StructType | ArrayType) and v.kind == "global" and v.address is None and not v.constant
        and not (v.escapes and is_word_backed(v.ctype)) and v.declaration.name not in module.placed
        and not module.brought
    }  # fmt: skip
    if not uses:
        return {}
    written: set[Variable] = set()
    for module in modules:
        for variable in module.variables:
            for p in (p for value in variable.initial or () for p in parts(value)):
                if isinstance(p, AddressOf):
                    _use(p, uses)
        for function in module.functions:
            for s in statements(function.body):
                if (target := assigned(s)) is not None:
                    written.add(target)
                for p in own_nodes(s):
                    _use(p, uses)
    return {
        variable: {member: _object(variable, member, lvalue) for member, lvalue in _merged(members).items()}
        for variable, members in uses.items() if members and variable in written and _apart(_merged(members))
    }  # fmt: skip


def _use(p: Any, uses: dict[Variable, dict[_Member, LValue] | None]) -> None:
    """Take note of an access to a structure, or drop it."""
    match p:
        case AddressOf(lvalue=LValue(root=Variable() as root) as lvalue):
            if _array(lvalue) is None:
                uses.pop(root, None)
        case LValue(root=Variable() as root) if (members := uses.get(root)) is not None:
            words = fixed_words(p)
            array = _array(p)
            if array is not None and (words is None or isinstance(p.ctype, ArrayType)):
                members[array.words, None] = array
                return
            if words is None or not isinstance(p.ctype, _SCALARS) or (p.bits is not None and p.bits.octets):
                uses.pop(root, None)
                return
            known = members.setdefault((words, p.bits), p)
            if known.ctype != p.ctype:
                uses.pop(root, None)


def _array(lvalue: LValue) -> LValue | None:
    """The array, a member of a structure, in which an lvalue is, or that it is; None: there is none."""
    assert isinstance(lvalue.root, Variable)
    ctype: CType = lvalue.root.ctype
    if not isinstance(ctype, StructType):
        return None
    leaf = first = 0
    while isinstance(ctype, StructType):
        inside = [m for m in ctype.members if m.offset <= lvalue.words - first < m.offset + m.ctype.words]
        if ctype.word_backed or len(inside) != 1:
            return None
        leaf, first, ctype = leaf + inside[0].leaf, first + inside[0].offset, inside[0].ctype
    if not isinstance(ctype, ArrayType):
        return None
    text = lvalue.text.partition("[")[0]
    return LValue(ctype, lvalue.root, leaf, first, where=lvalue.where, text=text, volatile=lvalue.volatile)


def _merged(members: dict[_Member, LValue]) -> dict[_Member, LValue]:
    """Members without those that are elements of another one."""
    arrays = [lvalue for lvalue in members.values() if isinstance(lvalue.ctype, ArrayType)]
    return {
        member: lvalue for member, lvalue in members.items()
        if all(lvalue is a or not a.words <= member[0] < a.words + a.ctype.words for a in arrays)
    }  # fmt: skip


def _apart(members: dict[_Member, LValue]) -> bool:
    """Whether no two members share a bit."""
    spans: list[tuple[int, int]] = []
    for (words, bits), lvalue in members.items():
        low = 16 * words + (bits.lo if bits is not None else 0)
        spans.append((low, low + (bits.width if bits is not None else 16 * lvalue.ctype.words)))
    return all(one[1] <= other[0] for one, other in pairwise(sorted(spans)))


def _object(variable: Variable, member: _Member, lvalue: LValue) -> Variable:
    """The object that stands for a member."""
    at = lvalue.leaf + sum(_leaves(index) for index in lvalue.indices)
    start = variable.initial[at : at + lvalue.ctype.leaves] if variable.initial and member[1] is None else None
    ctype = lvalue.ctype
    if member[1] is not None and isinstance(ctype, IntType):
        ctype = replace(ctype, bits=member[1].width)
    declared = variable.declaration
    name = lvalue.text if lvalue.text.startswith(declared.name) else _path(variable, member[0])
    declaration = replace(declared, name=name, ctype=lvalue.ctype)
    return Variable(
        declaration, ctype, "global", escapes=isinstance(ctype, ArrayType), initialised=variable.initialised,
        initial=start, volatile=variable.volatile or lvalue.volatile, static=variable.static,
    )  # fmt: skip


def _path(variable: Variable, words: int) -> str:
    """The name of the member at a word of an object, whatever pointer led to it."""
    names, ctype = [variable.declaration.name], variable.ctype
    while isinstance(ctype, StructType):
        member = next(m for m in ctype.members if m.offset <= words < m.offset + m.ctype.words)
        names.append(member.name)
        words, ctype = words - member.offset, member.ctype
    return ".".join(name for name in names if name)


def _leaves(index: Index) -> int:
    value = getattr(index.expr, "value", 0)
    return index.leaves * value if isinstance(value, int) else 0


class _MemberView(Rewriting):
    """Trees in which each member is an object."""

    def __init__(self, split: dict[Variable, dict[_Member, Variable]]) -> None:
        super().__init__(split)
        self._split = split
        #: The temporaries that hold the old value of a member, as of `x.n++`: each names the member as its declaration.
        self._kept: dict[Variable, Variable] = {}

    def instead(self, node: Any) -> Any:
        """The member for a structure or an array."""
        match node:
            case Variable(kind="temporary"):
                return self._kept.get(node, node)
            case Declare(variable=Variable(kind="temporary") as kept, value=Load(lvalue=LValue() as lvalue)):
                member = self.instead(lvalue).root
                if member is not lvalue.root and isinstance(member, Variable):
                    self._kept[kept] = replace(kept, declaration=member.declaration)
            case LValue(root=Variable() as root) if root in self._split:
                members = self._split[root]
                words = fixed_words(node)
                if words is not None and (words, node.bits) in members and not isinstance(node.ctype, ArrayType):
                    member = members[words, node.bits]
                    if not isinstance(member.ctype, ArrayType):
                        return LValue(node.ctype, member, where=node.where, text=node.text, volatile=node.volatile)
                array = _array(node)
                assert array is not None
                member = members[array.words, None]
                return replace(node, root=member, leaf=node.leaf - array.leaf, words=node.words - array.words)
        return node
