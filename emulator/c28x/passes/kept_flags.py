"""Static check of flags and marks that a program sets and never takes back: `not-begun-again`.

    __interrupt void Tick(void) { due = 1; PieCtrlRegs.PIEACK.all = 1; }
    ...
    while (1) { if (due) { ms++; } }

Nothing clears `due`: after the first interrupt `ms` counts the turns of the loop.  So do a sum (`sum += sample`) and a
pin that toggles.

Silent if the loop waits anywhere: then something else sets its pace, and the flag may say that the program has begun.
Silent too if the interrupt sets the flag only under a condition, if the flag's name or comment says that it stays, and
if what is counted is meant to count turns (`idle++`).

The check also tells of marks of elements that are full (`if (blocks[i].full) lost++; else ...`) which the program sets
and tests, and never takes back: each element can be used once.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, IntType, PointerType, StructType
from emulator.c28x.passes.begun_again import is_latched, is_number, step_of
from emulator.c28x.passes.declared import words_of
from emulator.c28x.passes.drained import found_set
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CallPointer,
    CopyStruct,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    RegisterRef,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    added,
    addressed,
    assigned,
    below,
    blocks,
    last_loop,
    leaves,
    own_nodes,
    parts,
    statements,
    within,
)

#: Names of functions that wait.
_WAITS: Final = re.compile(r"delay|wait|sleep|pause|idle|pend|block", re.IGNORECASE)
#: Words of marks that somebody must take back.  One of `used` may stand for good: a place that was given away.
_IN_USE: Final = frozenset(("full", "busy", "voll", "lleno", "llena"))
#: Names of what counts turns on purpose: the load of the CPU, a start value for random numbers.
_TURNS: Final = re.compile(r"idle|load|spin|turn|loop|pass|free|cpu|seed|rand", re.IGNORECASE)


def check_kept_flags(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the tests of flags that nothing clears, in the loop of a `main` that counts behind them."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    own = {function.path: function for function in owners}
    main = next((function for function in owners if function.name == "main" and function.body), None)
    loop = last_loop(main) if main is not None else None
    if main is None or loop is None:
        return
    flags = _flags(list(owners), main)
    if not flags or _waits(loop.body, own):
        return
    for block in _each_turn(loop.body, own, frozenset()):
        for s, flag, behind in found_set([block], set(flags)):
            if block is loop.body and _paced(block, s):
                break
            changed = _changed(behind, own, frozenset())
            if changed and isinstance(s, If):
                name = flag.declaration
                message = (
                    f"nothing clears {name.name}: once {flags[flag]} has set it, each turn of the loop {changed} again"
                )
                owner = main if block is loop.body else next(f for f in owners if f.body is block)
                owners[owner].report(owner, s.where, "not-begun-again", message, object=name.path, declaration=name)


def _flags(functions: list[Function], main: Function) -> dict[Variable, str]:
    """The flags that each run of an interrupt sets, and that nothing clears but the start; with its name."""
    start = {id(s) for s in statements(main.body[:-1])}
    writes: dict[Variable, list[tuple[Function, Stmt]]] = {}
    taken: set[Variable] = set()
    for function in functions:
        taken |= addressed(within(function.body))
        for s in statements(function.body):
            if (v := assigned(s)) is not None and is_number(v):
                writes.setdefault(v, []).append((function, s))
    found: dict[Variable, str] = {}
    for v, each in writes.items():
        late = [(f, s) for f, s in each if id(s) not in start]
        always = [
            f.name for f, s in late
            if f.interrupt and isinstance(s, Assign) and constant_of(s.value) and _again(f, s)
        ]  # fmt: skip
        if late and len(always) == len(late) and v not in taken and not v.escapes and not is_latched(v):
            found[v] = always[0]
    return found


def _again(function: Function, s: Stmt) -> bool:
    """Whether an interrupt executes a statement in each run, or in one of so many runs."""
    for x in function.body:
        if isinstance(x, If) and any(y is s for y in x.then) and any(_begins_again(y, function) for y in x.then):
            return True
    return any(x is s for x in function.body)


def _begins_again(s: Stmt, function: Function) -> bool:
    """Whether a statement sets back what a function else counts."""
    count = assigned(s)
    return count is not None and isinstance(s, Assign) and constant_of(s.value) is not None and any(
        assigned(x) is count and not (isinstance(x, Assign) and constant_of(x.value) is not None)
        for x in statements(function.body)
    )  # fmt: skip


def _waits(body: list[Stmt], own: dict[str, Function]) -> bool:
    """Whether anything that a loop does in a turn may wait."""
    paths = [p.function.path for p in within(body) if isinstance(p, Call)]
    every = [*statements(body), *(s for function in below(paths, own) for s in statements(function.body))]
    for s in every:
        if isinstance(s, While) or (isinstance(s, For) and not s.body):
            return True
        for p in own_nodes(s):
            if isinstance(p, CallPointer):
                return True
            if isinstance(p, Call) and p.function.path not in own and _WAITS.search(p.function.name):
                return True
    return False


def _each_turn(body: list[Stmt], own: dict[str, Function], above: frozenset[str]) -> Iterator[list[Stmt]]:
    """The statements of a loop, and those of functions that each turn calls."""
    yield body
    for s in body:
        match s:
            case Evaluate(value=Call(function=Function(path=path))) if path in own and path not in above:
                yield from _each_turn(own[path].body, own, above | {path})
            case If(then=then) if leaves(then):
                return


def _paced(block: list[Stmt], test: Stmt) -> bool:
    """Whether something before a test may end the turn."""
    return any(isinstance(s, If) and any(map(leaves, blocks(s))) for s in block[: block.index(test)])


def _changed(body: list[Stmt], own: dict[str, Function], above: frozenset[str]) -> str:
    """What statements do in each case that counts, adds up or toggles; empty: nothing."""
    for s in body:
        match s:
            case Assign(target=RegisterRef(register=name)) if name.endswith("TOGGLE"):
                return f"writes {name}"
            case Evaluate(value=Call(function=Function(name=name))) if "toggle" in name.lower():
                return f"calls {name}"
            case Evaluate(value=Call(function=Function(path=path))) if path in own and path not in above:
                if inner := _changed(own[path].body, own, above | {path}):
                    return inner
            case If() if any(map(leaves, blocks(s))):
                return ""
        v = assigned(s)
        more = v is not None and (added(s) is not None or (step_of(s, v) or 0) > 0)
        if v is not None and more and v.kind == "global" and not _TURNS.search(v.declaration.name):
            return f"changes {v.declaration.name}"
    return ""


# Marks of elements


def check_kept_marks(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the tests of marks that an element is full or busy, in whole programs that never take such a mark back."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    if not any(function.name == "main" and function.body for function in owners):
        return
    given: dict[NamedScalar, list[Expr]] = {}
    others: set[NamedScalar] = set()
    whole: set[CType] = set()
    for function in owners:
        for s in statements(function.body):
            match s:
                case Assign(target=LValue() as target, value=value) if (mark := _mark(target)) is not None:
                    given.setdefault(mark, []).append(value)
                case CopyStruct(target=LValue(ctype=holder)):
                    whole.add(holder)
        for p in within(function.body):
            match p:
                case AddressOf(lvalue=lvalue) if (mark := _mark(lvalue)) is not None:
                    others.add(mark)
                case Call(function=Function(extern=True), arguments=arguments):
                    whole |= {of for e in arguments for q in parts(e) if (of := _holder(q)) is not None}
    kept = {
        mark for mark, values in given.items()
        if mark not in others and mark[0] not in whole and all(map(constant_of, values))
    }  # fmt: skip
    for function, report in owners.items() if kept else ():
        for s in statements(function.body):
            for p in parts(s.test) if isinstance(s, If) else ():
                mark = _mark(p.lvalue) if isinstance(p, Load) else None
                if mark in kept and isinstance(p, Load):
                    kept.discard(mark)
                    text = p.lvalue.text
                    message = f"nothing takes {text} back: once it is set, it stands for good"
                    report.report(function, s.where, "not-begun-again", message, object=text)


def _holder(e: object) -> CType | None:
    """The structure to which, or to an array of which, an expression points."""
    target = e.lvalue.ctype if isinstance(e, AddressOf) else None
    if isinstance(e, Expr) and isinstance(e.ctype, PointerType):
        target = target or e.ctype.target
    while isinstance(target, ArrayType):
        target = target.element
    return target if isinstance(target, StructType) else None


def _mark(lvalue: LValue) -> NamedScalar | None:
    """The member of the elements of an array that an lvalue names, if it says that an element is full or busy.

    A mark that is no member may say that something happens once (a record that is full).
    """
    match lvalue:
        case LValue(root=Variable(ctype=ArrayType(element=StructType() as holder)), indices=[_], words=words):
            pass
        case LValue(root=Expr(ctype=PointerType(target=StructType() as holder)), indices=[], words=words):
            pass
        case _:
            return None
    if isinstance(lvalue.ctype, IntType) and lvalue.bits is None:
        for member in holder.members:
            if member.offset == words and _IN_USE.intersection(words_of(member.name)):
                return holder, words
    return None
