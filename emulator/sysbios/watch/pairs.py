"""Words that must be read or written together, found in the source of a program without the kernel; double buffers.

The source shows them even where a run does not: a carry from minutes to hours is rare.  There are five forms:

- An interrupt routine sets several words of one object.  Another function computes with two of them at once.
- A routine sets words of a structure at one time.  Another function copies the whole structure and uses two of them.
- A routine increments an index and uses it with other objects.  Another function sets the index and one of these.
- A routine and another function move the same index of a ring buffer.
- A routine fills objects only while a flag is 0, and sets the flag.  Another function clears the flag before it reads
  them.  Or the other way round: the routine takes them while the flag is set, and it is set before they are filled.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import ArrayType, IntType, StructType, scalars
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
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
from emulator.c28x.tree_queries import assigned_variables, bare, blocks, leaves, parts, roots, statements, within
from emulator.sysbios.watch.kept_off import rereads
from emulator.sysbios.watch.ways import Ways, below, free_ways, interrupt_routines

#: Operators that combine the values of both operands.
_COMBINE: Final = ("+", "-", "*", "/", "%")
#: The path of an object, and the offset of a word in it.
_Word = tuple[str, int]


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
    own = {f.path: f for module in modules for f in module.functions}
    written: dict[_Word, set[str]] = {}
    inside: set[str] = set()
    for routine, reached in interrupt_routines(own):
        for f in reached:
            inside.add(f.path)
            for word in _writes(f):
                written.setdefault(word, set()).add(routine.name)
    found: dict[str, list[Pair]] = {}
    for f in own.values() if written else ():
        if f.path in inside:
            continue
        for words in _combined(f, {path for path, _ in written}):
            for path in {path for path, _ in words}:
                here = frozenset(word for p, word in words if p == path and (p, word) in written)
                if len(here) > 1:
                    routines = frozenset.intersection(*(frozenset(written[path, word]) for word in here))
                    if routines:
                        found.setdefault(path, []).append(Pair(here, routines, (f.where.file, f.name)))
    _add_copied(own, found)
    return found


def _add_copied(own: dict[str, Function], found: dict[str, list[Pair]]) -> None:
    """Add the words of structures that a routine sets together, and that another function copies together.

    Words are set together in one block, and not all of them are counters.  A copy for which a test decides (a flag, a
    loop that copies again) is left out.
    """
    together: dict[str, list[tuple[str, frozenset[int]]]] = {}
    inside: set[str] = set()
    telling: set[str] = set()
    for routine, reached in interrupt_routines(own):
        for f in reached:
            inside.add(f.path)
            telling |= _written(f.body) | _read_addresses(f)
            for block in _blocks(f.body):
                for path, words in _set_together(block).items():
                    together.setdefault(path, []).append((routine.name, words))
    others = [f for f in own.values() if together and f.path not in inside]
    for way in free_ways(others, own, telling):
        for source, used, line in _copies(way):
            about = source.declaration.path
            for routine_name, words in together.get(about, ()):
                if len(words & used) > 1:
                    reader = (way.function.where.file, way.function.name)
                    found.setdefault(about, []).append(Pair(words & used, frozenset({routine_name}), reader, line))


def _read_addresses(f: Function) -> set[str]:
    """The objects at file scope whose address a function takes."""
    addresses = (p.lvalue for p in within(f.body) if isinstance(p, AddressOf))
    return {path for lvalue in addresses if (path := _path(lvalue)) is not None}


def _set_together(block: list[Stmt]) -> dict[str, frozenset[int]]:
    """The words of structures that the statements of a block itself set: several, and not all of them counters."""
    found: dict[str, set[int]] = {}
    counted: dict[str, set[int]] = {}
    for s in block:
        match s:
            case Assign(target=LValue(root=Variable(kind="global", ctype=StructType()) as root, indices=[]) as target):
                path = root.declaration.path
                found.setdefault(path, set()).add(target.words)
                if _counts(s.value, target):
                    counted.setdefault(path, set()).add(target.words)
            case CopyStruct(target=LValue(root=Variable(kind="global", ctype=StructType() as whole) as root)):
                if s.target.ctype == whole:
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
    """The structures at file scope that a function copies as a whole, the words of the copies that are used, the line.
    """
    for s in way.undecided:
        target: Variable | Expr | None = None
        source: LValue | None = None
        match s:
            case CopyStruct(target=LValue(root=target), source=source):
                pass
            case Declare(variable=target, value=Load(lvalue=source)):
                pass
        match source:
            case LValue(root=Variable(kind="global", ctype=StructType() as whole) as root, ctype=ctype) if (
                ctype == whole and not whole.word_backed and not _has_array(whole)
            ):
                yield root, _used_words(way.function, target, whole), s.line


def _has_array(ctype: StructType) -> bool:
    return any(isinstance(member.ctype, ArrayType) for member in ctype.members)


def _used_words(f: Function, copy: Variable | Expr | None, whole: StructType) -> frozenset[int]:
    """The words of a copy that a function reads; all of them if others may read it too."""
    if not isinstance(copy, Variable) or copy.kind == "global":
        return _words(whole)
    used: set[int] = set()
    for p in within(f.body):
        match p:
            case AddressOf(lvalue=LValue(root=root)) if root is copy:
                return _words(whole)
            case Load(lvalue=LValue(root=root, ctype=ctype, words=words)) if root is copy:
                if isinstance(ctype, StructType):
                    return _words(whole)
                used.add(words)
    for s in statements(f.body):
        if isinstance(s, CopyStruct) and s.source.root is copy:
            return _words(whole)
    return frozenset(used)


def continued(modules: Iterable[Module]) -> dict[str, set[tuple[str, str]]]:
    """Counts and indices that a routine both changes and depends on: object path -> (routine, function).

    The function sets the object, and it sets another object that the routine depends on.
    """
    own = {f.path: f for module in modules for f in module.functions}
    stepped: dict[str, dict[str, set[str]]] = {}
    inside: set[str] = set()
    for routine, reached in interrupt_routines(own):
        inside |= {f.path for f in reached}
        used = {path for f in reached for path in _used(f)}
        steps = {path for f in reached for path in _steps(f)}
        for path in used & steps:
            stepped.setdefault(path, {})[routine.name] = used - {path}
    found: dict[str, set[tuple[str, str]]] = {}
    for f in own.values() if stepped else ():
        sets = {path for path, _ in _writes(f)}
        for path in sets & set(stepped) if f.path not in inside else ():
            for routine_name, others in stepped[path].items():
                if sets & others:
                    found.setdefault(path, set()).add((routine_name, f.name))
    return found


def arrays_of_flags(modules: Iterable[Module]) -> set[str]:
    """The paths of arrays of integers whose elements are only ever set to constants: each is a flag, not data."""
    arrays: set[str] = set()
    data: set[str] = set()
    for f in (f for module in modules for f in module.functions):
        for s in statements(f.body):
            for part in (p for root in roots(s) for p in parts(root)):
                whole = part.lvalue if isinstance(part, AddressOf) else None
                if whole is not None and isinstance(whole.root, Variable):
                    data.add(whole.root.declaration.path)
            match s:
                case Assign(target=LValue(root=Variable(ctype=ArrayType(element=IntType())) as root), value=value):
                    (arrays if isinstance(bare(value), Const) else data).add(root.declaration.path)
    return arrays - data


def turned_by_both(modules: Iterable[Module]) -> dict[str, set[str]]:
    """Indices of ring buffers that a routine moves and `main` moves too: path -> names of the routines.

    `main` stands for every function that no routine calls.
    """
    own = {f.path: f for module in modules for f in module.functions}
    by_routine: dict[str, set[str]] = {}
    inside: set[str] = set()
    for routine, reached in interrupt_routines(own):
        for f in reached:
            inside.add(f.path)
            for path in _turns(f):
                by_routine.setdefault(path, set()).add(routine.name)
    others = {path for f in own.values() if by_routine and f.path not in inside for path in _turns(f)}
    return {path: routines for path, routines in by_routine.items() if path in others}


def handed_over(modules: Iterable[Module]) -> dict[str, set[HandOver]]:
    """The objects that a function uses after it has handed over the flag that stands for them, by their paths."""
    own = {f.path: f for module in modules for f in module.functions}
    awaited: dict[tuple[str, bool], dict[str, set[str]]] = {}
    inside: set[str] = set()
    for routine, reached in interrupt_routines(own):
        for f in reached:
            inside.add(f.path)
            for flag, raised, body in _branches(f.body):
                if (flag, not raised) in {key for s in statements(body) if (key := _flag(s)) is not None}:
                    used = (_read if raised else _written)(body)
                    awaited.setdefault((flag, raised), {}).setdefault(routine.name, set()).update(used - {flag})
    found: dict[str, set[HandOver]] = {}
    for f in own.values() if awaited else ():
        for block in _blocks(f.body) if f.path not in inside else ():
            for number, s in enumerate(block):
                key = _flag(s)
                if key is None or key not in awaited:
                    continue
                behind = block[number + 1 :]
                for called in {p.function.path for p in within(behind) if isinstance(p, Call)}:
                    behind = [*behind, *(s for other in below(called, own) for s in other.body)]
                late = (_written if key[1] else _read)(behind)
                for routine_name, used in awaited[key].items():
                    for path in used & late:
                        found.setdefault(path, set()).add(HandOver(key[0], routine_name))
    return found


def alternating(modules: Iterable[Module]) -> dict[str, set[str]]:
    """Arrays whose parts a routine uses in turn (double buffers), by their paths: what selects the part.

    Such an object is the first of several subscripts, a pointer to the array, or what a test of two arrays asks.  The
    routine toggles it, or changes it only when something is complete.
    """
    own = {f.path: f for module in modules for f in module.functions}
    chosen: dict[str, set[str]] = {}
    for _, reached in interrupt_routines(own):
        turned = set().union(*map(_turned_now_and_then, reached))
        for f in reached if turned else ():
            for path, selector in _selected(f.body):
                if selector in turned:
                    chosen.setdefault(path, set()).add(selector)
    pointed = {selector for selectors in chosen.values() for selector in selectors}
    for f in own.values() if pointed else ():
        for s in statements(f.body):
            if isinstance(s, Assign) and (pointer := _path(s.target)) is not None and pointer in pointed:
                for p in parts(s.value):
                    if isinstance(p, AddressOf) and (array := _path(p.lvalue)) is not None:
                        chosen.setdefault(array, set()).add(pointer)
    return chosen


def _turned_now_and_then(f: Function) -> set[str]:
    """The plain objects that a function toggles, or sets only in branches."""
    always = [s for s in f.body if isinstance(s, Assign) and not _toggles(s)]
    plain = [s for s in statements(f.body) if isinstance(s, Assign) and s.target.ctype.leaves == 1]
    return _written(plain) - _written(always)


def _toggles(s: Assign) -> bool:
    """Whether a statement sets an object to the other one of two values: `x ^= 1`, `x = 1 - x`, `x = !x`."""
    value = bare(s.value)
    match value:
        case Binary(op="^"):
            return True
        case Binary(op="-", left=left):
            return isinstance(bare(left), Const)
    return isinstance(value, Not)


def _selected(body: list[Stmt]) -> Iterator[tuple[str, str]]:
    """(path of an array, or of a pointer that statements go through; path of what selects it)."""
    for s in statements(body):
        targets = [s.target] if isinstance(s, Assign) else []
        for lvalue in [*targets, *(p.lvalue for root in roots(s) for p in parts(root) if isinstance(p, Load))]:
            match lvalue:
                case LValue(root=Variable(kind="global") as root, indices=[Index(expr=first), _, *_]):
                    if isinstance(row := bare(first), Load) and (selector := _path(row.lvalue)) is not None:
                        yield root.declaration.path, selector
                case LValue(root=Load(lvalue=pointed)) if (pointer := _path(pointed)) is not None:
                    yield pointer, pointer
        if isinstance(s, If):
            asked = {path for p in parts(s.test) if isinstance(p, Load) and (path := _path(p.lvalue)) is not None}
            if len(asked) == 1:
                for path in _written(s.then) ^ _written(s.otherwise):
                    yield path, min(asked)


def _branches(body: list[Stmt]) -> Iterator[tuple[str, bool, list[Stmt]]]:
    """(path of a flag, whether it must be set, the statements that run only then)."""
    for number, s in enumerate(body):
        if isinstance(s, If):
            behind = body[number + 1 :] if leaves(s.then) else []
            tested = s.test
            several = isinstance(tested, Logic) and tested.op == "and"
            for test in tested.operands if isinstance(tested, Logic) and several else [tested]:
                if (found := _tested(test)) is not None:
                    yield *found, s.then
                    if not several:
                        yield found[0], not found[1], [*s.otherwise, *behind]
        for block in blocks(s):
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


def _flag(s: Stmt) -> tuple[str, bool] | None:
    """The plain object that a statement sets to a constant, and whether that is another one than 0."""
    match s:
        case Assign(target=LValue(root=Variable(kind="global") as root), value=value) if root.ctype.leaves == 1:
            constant = bare(value)
            return (root.declaration.path, constant.value != 0) if isinstance(constant, Const) else None
    return None


def _blocks(body: list[Stmt]) -> Iterator[list[Stmt]]:
    yield body
    for s in body:
        for block in blocks(s):
            yield from _blocks(block)


def _written(body: Iterable[Stmt]) -> set[str]:
    """The objects at file scope that statements assign."""
    targets = [s.target for s in statements(body) if isinstance(s, Assign | CopyStruct)]
    return {path for target in targets if (path := _path(target)) is not None}


def _read(body: Iterable[Stmt]) -> set[str]:
    """The objects at file scope whose values or addresses statements use."""
    found = {_path(s.source) for s in statements(body) if isinstance(s, CopyStruct)}
    found |= {_path(p.lvalue) for p in within(body) if isinstance(p, Load | AddressOf)}
    return {path for path in found if path is not None}


def _path(lvalue: Any) -> str | None:
    root = lvalue.root if isinstance(lvalue, LValue) else None
    return root.declaration.path if isinstance(root, Variable) and root.kind == "global" else None


def _turns(f: Function) -> Iterator[str]:
    """The plain objects that a function moves round a ring buffer: `i = (i + 1) % N`."""
    for s in statements(f.body):
        match s:
            case Assign(target=LValue(root=Variable(kind="global") as root), value=value) if root.ctype.leaves == 1:
                wrapped = bare(value)
                if not isinstance(wrapped, Binary) or wrapped.op not in ("%", "&"):
                    continue
                stepped = bare(wrapped.left)
                own = any(isinstance(p, Load) and p.lvalue.root is root for p in parts(stepped))
                if own and isinstance(stepped, Binary) and stepped.op in ("+", "-"):
                    yield root.declaration.path


def _steps(f: Function) -> Iterator[str]:
    """The plain objects that a function sets to a value computed from the old one, as `n = n + 1`."""
    for s in statements(f.body):
        match s:
            case Assign(target=LValue(root=Variable(kind="global") as root), value=value) if root.ctype.leaves == 1:
                if any(isinstance(p, Load) and p.lvalue.root is root for p in parts(value)):
                    yield root.declaration.path


def _used(f: Function) -> Iterator[str]:
    """The plain objects that a function reads in a test or in an array index."""
    for s in statements(f.body):
        deciding: list[Any] = [s.test] if isinstance(s, If | While) else []
        deciding += [p for root in roots(s) for p in parts(root) if isinstance(p, Index)]
        for p in (p for e in deciding for p in parts(e)):
            root = p.root if isinstance(p, LValue) else None
            if isinstance(root, Variable) and root.kind == "global" and root.ctype.leaves == 1:
                yield root.declaration.path


def _word(e: Any) -> _Word | None:
    """The word of a file-scope object that an expression reads, or that an lvalue names; None for any other."""
    lvalue = e.lvalue if isinstance(e, Load) else e
    match lvalue:
        case LValue(root=Variable(kind="global") as root, indices=[], words=words):
            return root.declaration.path, words
    return None


def _writes(f: Function) -> Iterator[_Word]:
    for s in statements(f.body):
        if isinstance(s, Assign) and (word := _word(s.target)) is not None:
            yield word


def _combined(f: Function, shared: set[str]) -> Iterator[frozenset[_Word]]:
    """The words that each operation of a function combines.

    The body of a loop is left out if its test reads a shared object again: the loop checks what it has read.
    """
    given: dict[Variable, list[_Word | None]] = {}
    for loop in statements(f.body):
        if isinstance(loop, While) and rereads(loop):
            for variable in assigned_variables(loop.body):
                given.setdefault(variable, []).append(None)
    for s in statements(f.body):
        match s:
            case Assign(target=LValue(root=Variable() as root, indices=[]), value=value) if root.kind != "global":
                given.setdefault(root, []).append(_word(bare(value)))
            case Declare(variable=root, value=Expr() as value):
                given.setdefault(root, []).append(_word(bare(value)))
            case For(variable=LValue(root=Variable() as root)):
                given.setdefault(root, []).append(None)
    copies = {v: words[0] for v, words in given.items() if len(words) == 1 and words[0] is not None}
    for s in _once(f.body, shared):
        for root in roots(s):
            for e in parts(root):
                if isinstance(e, Binary) and e.op in _COMBINE:
                    yield frozenset(_leaves(e, copies))


def _leaves(e: Any, copies: dict[Variable, _Word]) -> Iterator[_Word]:
    for p in parts(e):
        if isinstance(p, Load):
            word = _word(p)
            if word is None and isinstance(p.lvalue.root, Variable):
                word = copies.get(p.lvalue.root)
            if word is not None:
                yield word


def _once(body: list[Stmt], shared: set[str]) -> Iterator[Stmt]:
    """The statements that are not in a loop whose test reads a shared object."""
    for s in body:
        yield s
        if isinstance(s, While) and any(
            isinstance(p, LValue) and isinstance(p.root, Variable) and p.root.declaration.path in shared
            for p in parts(s.test)
        ):  # fmt: skip
            continue
        for block in blocks(s):
            yield from _once(block, shared)
