"""Words that must be read or written together, found in the source of a program without the kernel.

The source shows them even where a run does not: a carry from minutes to hours is rare.  There are five forms:

- An interrupt routine sets several words of one object.  Another function computes with two of them at once.
- A routine sets words of a structure at one time.  Another function copies the whole structure and uses two of them,
  or it copies two of them into a structure of the same type.
- A routine increments an index and uses it with other objects.  Another function sets the index and one of these.
- A routine and another function move the same index of a ring buffer.
- A routine fills objects only while a flag is 0, and sets the flag.  Another function clears the flag before it reads
  them.  Or the other way round: the routine takes them while the flag is set, and it is set before they are filled.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import ArrayType, CType, IntType, PointerType, StructType, scalars
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Compare,
    Const,
    CopyStruct,
    Declare,
    Expr,
    For,
    Function,
    If,
    Index,
    Load,
    Logic,
    LValue,
    Not,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import (
    all_blocks,
    assigned_variables,
    bare,
    below,
    blocks,
    called,
    given_values,
    leaves,
    named_scalar,
    once,
    own_nodes,
    parts,
    reached,
    statements,
    within,
)
from emulator.sysbios.watch.kept_off import Word, object_path, rereads, written_objects
from emulator.sysbios.watch.ways import Ways, free_ways, interrupt_routines

#: Operators that combine the values of both operands.
_COMBINE: Final = ("+", "-", "*", "/", "%")


class Pair(NamedTuple):
    """Words of an object that some routines (names) set, and that one function (file, name) uses together."""

    words: frozenset[int]
    routines: frozenset[str]
    reader: tuple[str, str]
    #: The line that uses them; 0: the whole function.
    line: int = 0


class HandOver(NamedTuple):
    """A flag that a function hands over to a routine too early: before it is done with what the flag stands for."""

    flag: str
    routine: str


def pairs(modules: Iterable[Module]) -> dict[str, list[Pair]]:
    """The pairs of each object, by its path."""
    own = {function.path: function for module in modules for function in module.functions}
    written: dict[Word, set[str]] = {}
    inside: set[str] = set()
    for routine, functions in interrupt_routines(own):
        for function in functions:
            inside.add(function.path)
            for word in _writes(function):
                written.setdefault(word, set()).add(routine.name)
    found: dict[str, list[Pair]] = {}
    for function in own.values() if written else ():
        if function.path in inside:
            continue
        for words in _combined(function, {path for path, _ in written}):
            for path in {path for path, _ in words}:
                here = frozenset(word for part, word in words if part == path and (part, word) in written)
                if len(here) > 1:
                    routines = frozenset.intersection(*(frozenset(written[path, word]) for word in here))
                    if routines:
                        found.setdefault(path, []).append(Pair(here, routines, (function.where.file, function.name)))
    _add_copied(own, found)
    return found


def _add_copied(own: dict[str, Function], found: dict[str, list[Pair]]) -> None:
    """Add the words of structures that a routine sets together, and that another function copies together.

    Words are set together in one block, and not all of them are counters.  A copy for which a test decides (a flag, a
    loop that copies again) is left out, unless the test is about other routines only.
    """
    routines = list(interrupt_routines(own))
    inside = {function.path for _, functions in routines for function in functions}
    others = [function for function in own.values() if function.path not in inside]
    writes = [{path for function in functions for path in written_objects(function.body)} for _, functions in routines]
    for number, (routine, functions) in enumerate(routines):
        together: dict[str, list[frozenset[int]]] = {}
        for function in functions:
            for block in all_blocks(function.body):
                for path, words in _set_together(block).items():
                    together.setdefault(path, []).append(words)
        if not together:
            continue
        telling = {path for function in functions for path in _read_addresses(function)} | writes[number]
        for (_, asking), written in zip(routines, writes, strict=True):
            if any(path in writes[number] for function in asking for path in _mentioned(function)):
                telling |= written  # what it has found out about this routine
        for way in free_ways(others, own, telling):
            for source, used, line in _copies(way):
                about = source.declaration.path
                for words in together.get(about, ()):
                    if len(words & used) > 1:
                        reader = (way.function.where.file, way.function.name)
                        found.setdefault(about, []).append(Pair(words & used, frozenset({routine.name}), reader, line))


def _mentioned(function: Function) -> set[str]:
    """The objects at file scope that a function has to do with."""
    return {path for part in within(function.body) if (path := object_path(part)) is not None}


def _read_addresses(function: Function) -> set[str]:
    """The objects at file scope whose address a function takes."""
    addresses = (part.lvalue for part in within(function.body) if isinstance(part, AddressOf))
    return {path for lvalue in addresses if (path := object_path(lvalue)) is not None}


def _set_together(block: list[Stmt]) -> dict[str, frozenset[int]]:
    """The words of structures that the statements of a block itself set: several, and not all of them counters."""
    found: dict[str, set[int]] = {}
    counted: dict[str, set[int]] = {}
    for statement in block:
        match statement:
            case Assign(target=LValue(root=Variable(kind="global", ctype=StructType()) as root, indices=[]) as target):
                path = root.declaration.path
                found.setdefault(path, set()).add(target.words)
                if _counts(statement.value, target):
                    counted.setdefault(path, set()).add(target.words)
            case CopyStruct(target=LValue(root=Variable(kind="global", ctype=StructType() as whole) as root)):
                if statement.target.ctype == whole:
                    found.setdefault(root.declaration.path, set()).update(_words(whole))
    return {
        path: frozenset(words) for path, words in found.items()
        if len(words) > 1 and words != counted.get(path, set())
    }  # fmt: skip


def _counts(value: Expr, target: LValue) -> bool:
    """Whether a value is the old one of its target plus or minus a constant: the object counts."""
    match bare(value):
        case Binary(op="+" | "-", left=left, right=right):
            stepped = bare(left)
            return isinstance(bare(right), Const) and isinstance(stepped, Load) and stepped.lvalue == target
    return False


def _words(ctype: StructType) -> frozenset[int]:
    return frozenset(offset for offset, _ in scalars(ctype))


def _copies(way: Ways) -> Iterator[tuple[Variable, frozenset[int], int]]:
    """The structures at file scope that a function copies, the words of the copies that are used, and the line.

    Copied as a whole, or member by member into a structure of the same type: then the line is 0, for any.
    """
    by_member: dict[tuple[Variable, Variable], set[int]] = {}
    for statement in way.undecided:
        target: Variable | Expr | None = None
        source: LValue | None = None
        match statement:
            case CopyStruct(target=LValue(root=target), source=source):
                pass
            case Declare(variable=target, value=Load(lvalue=source)):
                pass
            case Assign(target=LValue(words=to) as member, value=value) if (
                isinstance(copied := bare(value), Load) and copied.lvalue.words == to
            ):  # fmt: skip
                root, into = copied.lvalue.root, member.root
                if isinstance(into, Load) and isinstance(into.ctype, PointerType):
                    into = into.lvalue.root
                if (
                    isinstance(root, Variable) and isinstance(into, Variable)
                    and root.kind == "global" and _is_member_of_same(member, root.ctype)
                ):  # fmt: skip
                    by_member.setdefault((root, into), set()).add(to)
        match source:
            case LValue(root=Variable(kind="global", ctype=StructType() as whole) as root, ctype=ctype) if (
                ctype == whole and not whole.word_backed and not _has_array(whole)
            ):
                yield root, _used_words(way.function, target, whole), statement.line
    for (root, into), words in by_member.items():
        if isinstance(root.ctype, StructType):
            of_structure = into.ctype == root.ctype
            yield root, frozenset(words) & _used_words(way.function, into if of_structure else None, root.ctype), 0


def _is_member_of_same(member: LValue, whole: CType) -> bool:
    """Whether an lvalue is a scalar in a structure of the same type, or in one that a pointer points to."""
    holder = member.root.ctype
    if isinstance(holder, PointerType):
        holder = holder.target
    return isinstance(whole, StructType) and holder == whole and not (member.indices or _has_array(whole))


def _has_array(ctype: StructType) -> bool:
    return any(isinstance(member.ctype, ArrayType) for member in ctype.members)


def _used_words(function: Function, copy: Variable | Expr | None, whole: StructType) -> frozenset[int]:
    """The words of a copy that a function reads; all of them if others may read it too."""
    if not isinstance(copy, Variable) or copy.kind == "global":
        return _words(whole)
    used: set[int] = set()
    for part in within(function.body):
        match part:
            case AddressOf(lvalue=LValue(root=root)) if root is copy:
                return _words(whole)
            case Load(lvalue=LValue(root=root, ctype=ctype, words=words)) if root is copy:
                if isinstance(ctype, StructType):
                    return _words(whole)
                used.add(words)
    for statement in statements(function.body):
        if isinstance(statement, CopyStruct) and statement.source.root is copy:
            return _words(whole)
    return frozenset(used)


def continued(modules: Iterable[Module]) -> dict[str, set[tuple[str, str]]]:
    """Counts and indices that a routine both changes and depends on: object path -> (routine, function).

    The function sets the object, and it sets another object that the routine depends on.
    """
    own = {function.path: function for module in modules for function in module.functions}
    stepped: dict[str, dict[str, set[str]]] = {}
    inside: set[str] = set()
    for routine, functions in interrupt_routines(own):
        inside |= {function.path for function in functions}
        used = {path for function in functions for path in decided_by(function)}
        steps = {path for function in functions for path in _steps(function)}
        for path in used & steps:
            stepped.setdefault(path, {})[routine.name] = used - {path}
    found: dict[str, set[tuple[str, str]]] = {}
    for function in own.values() if stepped else ():
        sets = {path for path, _ in _writes(function)}
        for path in sets & set(stepped) if function.path not in inside else ():
            for routine_name, others in stepped[path].items():
                if sets & others:
                    found.setdefault(path, set()).add((routine_name, function.name))
    return found


def divided(modules: Iterable[Module]) -> set[StructType]:
    """The structures of which each of two threads writes a member that the other one never writes.

    A thread here is an interrupt routine, or a function that no other one calls by its name.
    """
    own = {function.path: function for module in modules for function in module.functions}
    calls = {path: _calls_of(function) for path, function in own.items()}
    inner = set[str]().union(*calls.values())
    found: dict[StructType, list[set[int]]] = {}
    for function in own.values():
        if function.path in inner and not function.interrupt:
            continue
        written: dict[StructType, set[int]] = {}
        for path in reached([function.path], lambda path: calls.get(path, ())):
            for holder, words in _members_set(own[path]) if path in own else ():
                written.setdefault(holder, set()).add(words)
        for holder, members in written.items():
            found.setdefault(holder, []).append(members)
    return {holder for holder, sets in found.items() if any(a - b and b - a for a, b in combinations(sets, 2))}


@once
def _calls_of(function: Function) -> set[str]:
    return set(called(within(function.body)))


@once
def _members_set(function: Function) -> set[tuple[StructType, int]]:
    """The members of structures that a function itself sets, by the structure and the offset in words."""
    scalars_set = (named_scalar(target) for target, _ in given_values(function.body))
    return {(each[0], each[1]) for each in scalars_set if each is not None and isinstance(each[0], StructType)}


def arrays_of_flags(modules: Iterable[Module]) -> set[str]:
    """The paths of arrays of integers whose elements are only ever set to constants: each is a flag, not data."""
    arrays: set[str] = set()
    data: set[str] = set()
    for function in (function for module in modules for function in module.functions):
        for statement in statements(function.body):
            for part in own_nodes(statement):
                whole = part.lvalue if isinstance(part, AddressOf) else None
                if whole is not None and isinstance(whole.root, Variable):
                    data.add(whole.root.declaration.path)
            match statement:
                case Assign(target=LValue(root=Variable(ctype=ArrayType(element=IntType())) as root), value=value):
                    (arrays if isinstance(bare(value), Const) else data).add(root.declaration.path)
    return arrays - data


def flag_members(modules: Iterable[Module]) -> set[tuple[StructType, int]]:
    """The members of structures that are only ever set to constants, as the mark of a buffer that is full.

    Each by its structure and its offset in words.
    """
    flags: set[tuple[StructType, int]] = set()
    data: set[tuple[StructType, int]] = set()
    for function in (function for module in modules for function in module.functions):
        for part in within(function.body):
            whole = part.lvalue if isinstance(part, AddressOf) and isinstance(part.lvalue.ctype, IntType) else None
            if whole is not None and (member := _member_of(whole)) is not None:
                data.add(member)
        for statement in statements(function.body):
            match statement:
                case Assign(target=LValue(ctype=IntType()) as target, value=value):
                    if (member := _member_of(target)) is not None:
                        (flags if isinstance(bare(value), Const) else data).add(member)
    return flags - data


def _member_of(lvalue: LValue) -> tuple[StructType, int] | None:
    """The member that an lvalue names, of a structure by itself or in an array."""
    match lvalue:
        case LValue(root=Variable(ctype=ArrayType(element=StructType() as holder)), indices=[_], words=words):
            return holder, words
    scalar = named_scalar(lvalue)
    return (scalar[0], scalar[1]) if scalar is not None and isinstance(scalar[0], StructType) else None


def turned_by_both(modules: Iterable[Module]) -> dict[str, set[str]]:
    """Indices of ring buffers that a routine moves and `main` moves too: path -> names of the routines.

    `main` stands for every function that no routine calls.
    """
    own = {function.path: function for module in modules for function in module.functions}
    by_routine: dict[str, set[str]] = {}
    inside: set[str] = set()
    for routine, functions in interrupt_routines(own):
        for function in functions:
            inside.add(function.path)
            for path in _turns(function):
                by_routine.setdefault(path, set()).add(routine.name)
    outside = (function for function in own.values() if by_routine and function.path not in inside)
    others = {path for function in outside for path in _turns(function)}
    return {path: routines for path, routines in by_routine.items() if path in others}


def handed_over(modules: Iterable[Module]) -> dict[str, set[HandOver]]:
    """The objects that a function uses after it has handed over the flag that stands for them, by their paths."""
    own = {function.path: function for module in modules for function in module.functions}
    awaited: dict[tuple[str, bool], dict[str, set[str]]] = {}
    inside: set[str] = set()
    for routine, functions in interrupt_routines(own):
        for function in functions:
            inside.add(function.path)
            for flag, raised, body in _branches(function.body):
                if (flag, not raised) in {_flag(statement) for statement in statements(body)}:
                    used = (_read if raised else written_objects)(body)
                    awaited.setdefault((flag, raised), {}).setdefault(routine.name, set()).update(used - {flag})
    found: dict[str, set[HandOver]] = {}
    for function in own.values() if awaited else ():
        for block in all_blocks(function.body) if function.path not in inside else ():
            for number, statement in enumerate(block):
                key = _flag(statement)
                if key is None or key not in awaited:
                    continue
                behind = block[number + 1 :]
                for inner in below(called(within(behind)), own):
                    behind = [*behind, *inner.body]
                late = (written_objects if key[1] else _read)(behind)
                for routine_name, used in awaited[key].items():
                    for path in used & late:
                        found.setdefault(path, set()).add(HandOver(key[0], routine_name))
    return found


def _branches(body: list[Stmt]) -> Iterator[tuple[str, bool, list[Stmt]]]:
    """(path of a flag, whether it must be set, the statements that run only then)."""
    for number, statement in enumerate(body):
        if isinstance(statement, If):
            behind = body[number + 1 :] if leaves(statement.then) else []
            tested = statement.test
            several = isinstance(tested, Logic) and tested.op == "and"
            for test in tested.operands if isinstance(tested, Logic) and several else [tested]:
                if (found := _tested(test)) is not None:
                    yield *found, statement.then
                    if not several:
                        yield found[0], not found[1], [*statement.otherwise, *behind]
        for block in blocks(statement):
            yield from _branches(block)


def _tested(test: Expr) -> tuple[str, bool] | None:
    """The flag that a test looks at, and whether it must be set."""
    match bare(test):
        case Not(operand=operand):
            found = _tested(operand)
            return None if found is None else (found[0], not found[1])
        case Compare(op="==" | "!=" as op, left=left, right=right) if isinstance(constant := bare(right), Const):
            found = _tested(left)
            return None if found is None else (found[0], (op == "!=") == (constant.value == 0))
        case Load(lvalue=LValue(root=Variable(kind="global") as root, indices=[])) if root.ctype.leaves == 1:
            return root.declaration.path, True
    return None


def _flag(statement: Stmt) -> tuple[str, bool] | None:
    """The plain object that a statement sets to a constant, and whether that is another one than 0."""
    match statement:
        case Assign(target=LValue(root=Variable(kind="global") as root), value=value) if root.ctype.leaves == 1:
            constant = bare(value)
            return (root.declaration.path, constant.value != 0) if isinstance(constant, Const) else None
    return None



def _read(body: Iterable[Stmt]) -> set[str]:
    """The objects at file scope whose values or addresses statements use."""
    found = {object_path(statement.source) for statement in statements(body) if isinstance(statement, CopyStruct)}
    found |= {object_path(part.lvalue) for part in within(body) if isinstance(part, Load | AddressOf)}
    return {path for path in found if path is not None}


def _turns(function: Function) -> Iterator[str]:
    """The plain objects that a function moves round a ring buffer: `i = (i + 1) % N`."""
    for statement in statements(function.body):
        match statement:
            case Assign(target=LValue(root=Variable(kind="global") as root), value=value) if root.ctype.leaves == 1:
                wrapped = bare(value)
                if not isinstance(wrapped, Binary) or wrapped.op not in ("%", "&"):
                    continue
                stepped = bare(wrapped.left)
                own = any(isinstance(part, Load) and part.lvalue.root is root for part in parts(stepped))
                if own and isinstance(stepped, Binary) and stepped.op in ("+", "-"):
                    yield root.declaration.path


def _steps(function: Function) -> Iterator[str]:
    """The plain objects that a function sets to a value computed from the old one, as `n = n + 1`."""
    for statement in statements(function.body):
        match statement:
            case Assign(target=LValue(root=Variable(kind="global") as root), value=value) if root.ctype.leaves == 1:
                if any(isinstance(part, Load) and part.lvalue.root is root for part in parts(value)):
                    yield root.declaration.path


def decided_by(function: Function) -> Iterator[str]:
    """The plain objects that a function reads in a test or in an array index."""
    for statement in statements(function.body):
        deciding: list[Any] = [statement.test] if isinstance(statement, If | While) else []
        deciding += [part for part in own_nodes(statement) if isinstance(part, Index)]
        for part in (part for expression in deciding for part in parts(expression)):
            root = part.root if isinstance(part, LValue) else None
            if isinstance(root, Variable) and root.kind == "global" and root.ctype.leaves == 1:
                yield root.declaration.path


def _word(expression: Any) -> Word | None:
    """The word of a file-scope object that an expression reads, or that an lvalue names; None for any other."""
    lvalue = expression.lvalue if isinstance(expression, Load) else expression
    match lvalue:
        case LValue(root=Variable(kind="global") as root, indices=[], words=words):
            return root.declaration.path, words
    return None


def _writes(function: Function) -> Iterator[Word]:
    for statement in statements(function.body):
        if isinstance(statement, Assign) and (word := _word(statement.target)) is not None:
            yield word


def _combined(function: Function, shared: set[str]) -> Iterator[frozenset[Word]]:
    """The words that each operation of a function combines, also by copies of them or of the whole structure.

    The body of a loop is left out if its test reads a shared object again: the loop checks what it has read.
    """
    given: dict[Variable, list[Word | None]] = {}
    for loop in statements(function.body):
        if isinstance(loop, While) and rereads(loop):
            for variable in assigned_variables(loop.body):
                given.setdefault(variable, []).append(None)
    for statement in statements(function.body):
        match statement:
            case Assign(target=LValue(root=Variable() as root, indices=[]), value=value) if root.kind != "global":
                given.setdefault(root, []).append(_word(bare(value)))
            case Declare(variable=root, value=Expr() as value):
                given.setdefault(root, []).append(_word(bare(value)))
            case For(variable=LValue(root=Variable() as root)):
                given.setdefault(root, []).append(None)
            case CopyStruct(target=LValue(root=Variable() as root), source=source) if root.kind != "global":
                given.setdefault(root, []).append(_word(source) if source.ctype == root.ctype else None)
    copies = {variable: words[0] for variable, words in given.items() if len(words) == 1 and words[0] is not None}
    for statement in _once(function.body, shared):
        for expression in own_nodes(statement):
            if isinstance(expression, Binary) and expression.op in _COMBINE:
                yield frozenset(_leaves(expression, copies))


def _leaves(expression: Any, copies: dict[Variable, Word]) -> Iterator[Word]:
    for part in parts(expression):
        if isinstance(part, Load):
            word = _word(part)
            if word is None and isinstance(part.lvalue.root, Variable) and not part.lvalue.indices:
                copy = copies.get(part.lvalue.root)
                word = (copy[0], copy[1] + part.lvalue.words) if copy is not None else None
            if word is not None:
                yield word


def _once(body: list[Stmt], shared: set[str]) -> Iterator[Stmt]:
    """The statements that are not in a loop whose test reads a shared object."""
    for statement in body:
        yield statement
        if isinstance(statement, While) and any(
            isinstance(part, LValue) and isinstance(part.root, Variable) and part.root.declaration.path in shared
            for part in parts(statement.test)
        ):  # fmt: skip
            continue
        for block in blocks(statement):
            yield from _once(block, shared)
