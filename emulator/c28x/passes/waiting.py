"""Static check of loops that wait for an object which another thread writes and which is not `volatile`.

Nothing in such a loop writes the object, so the compiler may read it once, before the loop (ISO C 5.1.2.3 p3; CC,
`volatile`).  It may not if the loop writes through a pointer, or calls a function whose body it may not know.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from functools import cached_property
from typing import NamedTuple

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Compare,
    Const,
    Continue,
    Convert,
    CopyStruct,
    Declare,
    Expr,
    For,
    Function,
    If,
    Jump,
    Load,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    INSTRUCTIONS,
    bare,
    blocks,
    fixed_words,
    own_nodes,
    parts,
    reached,
    statements,
    variables,
)


class WordRange(NamedTuple):
    """Words of an object of static storage: of a structure, those of one member."""

    root: Variable
    first: int
    end: int

    def meets(self, other: WordRange) -> bool:
        """Whether they have a word in common."""
        return self.root is other.root and self.first < other.end and other.first < self.end


def _words(lvalue: LValue, *, whole: bool = False) -> WordRange | None:
    """What an lvalue names; all of the object if that is asked for, or if a subscript is not known."""
    root = lvalue.root
    if not isinstance(root, Variable) or root.kind != "global":
        return None
    first = None if whole else fixed_words(lvalue)
    return WordRange(root, 0, root.ctype.words) if first is None else WordRange(root, first, first + lvalue.ctype.words)


def _name(lvalue: LValue, root: Variable) -> str:
    """The path of what an lvalue names."""
    declaration = root.declaration
    if lvalue.text.startswith(declaration.name):
        return declaration.path.removesuffix(declaration.name) + lvalue.text
    return declaration.path


class WriterAnalysis:
    """Which functions write an object, seen from a function that waits for it.

    `entered` are the functions (`module.name`) that a pointer, an interrupt or the board calls.  Each of them begins a
    thread of its own.  So do `main`, and every function that nothing in this image calls.
    """

    def __init__(self, modules: list[Module], entered: Set[str]) -> None:
        self.functions = {function.path: function for module in modules for function in module.functions}
        self.entered = entered

    @cached_property
    def called(self) -> dict[str, set[str]]:
        """Path of each function -> those that it calls by name."""
        return {
            path: {call.function.path for call in _calls(list(statements(f.body))) if isinstance(call, Call)}
            for path, f in self.functions.items()
        }

    @cached_property
    def writers(self) -> dict[Variable, list[tuple[WordRange, str, Stmt]]]:
        """File-scope object -> what statements write of it or take the address of, with their functions."""
        found: dict[Variable, list[tuple[WordRange, str, Stmt]]] = {}
        for path, function in self.functions.items():
            for s in statements(function.body):
                # A pointer to an element leads to all others.
                pointed = (
                    _words(p.lvalue, whole=bool(p.lvalue.indices)) for p in own_nodes(s) if isinstance(p, AddressOf)
                )
                for words in (*_written(s), *pointed):
                    if words is not None:
                        found.setdefault(words.root, []).append((words, path, s))
        return found

    def writing(self, variable: Variable) -> list[str]:
        """The functions that write a file-scope object or take its address."""
        return list(dict.fromkeys(path for _, path, _ in self.writers.get(variable, ())))

    @cached_property
    def begins(self) -> dict[str, set[str]]:
        """Each function that begins a thread -> the functions that the thread runs."""
        inner = {callee for caller, callees in self.called.items() for callee in callees if callee != caller}
        first = {
            path
            for path, function in self.functions.items()
            if path in self.entered or path not in inner or function.interrupt or function.name == "main"
        }
        return {path: self.below(path) for path in first}

    def below(self, path: str) -> set[str]:
        """A function and all functions that it calls, directly or indirectly."""
        return set(reached([path], lambda caller: self.called.get(caller, ())))

    def writer(self, read: WordRange, waiting: Function) -> tuple[Function, Stmt] | None:
        """The first function that another thread runs and that writes some of `read`; None: there is none."""
        inside = self.below(waiting.path)
        runs = {begin for begin, reached in self.begins.items() if waiting.path in reached}
        for words, path, s in self.writers.get(read.root, ()):
            if path not in inside and words.meets(read) and any(
                path in reached and runs - {begin} for begin, reached in self.begins.items()
            ):  # fmt: skip
                return self.functions[path], s
        return None


def check_waiting(function: Function, threads: WriterAnalysis, report: StaticReport) -> None:
    """Report loops of a function that wait for an object which another thread writes and which is not `volatile`."""
    for loop in statements(function.body):
        if isinstance(loop, While | For):
            told: set[WordRange] = set()
            turns = (loop, *_continued(loop))
            for turning in (*turns, *_refused(turns, function, threads)):
                for words, path in dict(_Loop(turning, function, threads).polled()).items():
                    found = threads.writer(words, function)
                    if found is None or words in told:
                        continue
                    told.add(words)
                    writer, s = found
                    place = f"{s.where.file.rsplit('/', 1)[-1]}:{s.where.line}"
                    message = f"the loop waits on {path}, which {writer.path} writes ({place}) and which is not "
                    message += "volatile: the compiler may read it once, before the loop"
                    report.report(
                        function, turning.where, "poll-not-volatile", message, object=path,
                        declaration=words.root.declaration,
                    )  # fmt: skip


def _continued(loop: While | For) -> Iterator[While]:
    """Turns in which a loop without an end waits, as loops of their own.

    `for (;;) { if (Ticks == seen) continue; ... }`: nothing behind the `continue` runs as long as its test holds.
    `for (;;) { if (Events > 0) { ... } }`: as long as no test holds, only the tests run.
    """
    if isinstance(loop, While) and isinstance(loop.test, Const) and not loop.step:
        for n, s in enumerate(loop.body):
            match s:
                case If(test=test, then=[*before, Continue()], otherwise=[]):
                    yield While(s.where, test, [*loop.body[:n], *before])
                case If(test=test, otherwise=[]):
                    others = [_untaken(other) for other in loop.body if other is not s]
                    yield While(s.where, Not(test.ctype, test), others)


def _refused(turns: Iterable[While | For], function: Function, threads: WriterAnalysis) -> Iterator[While]:
    """Turns that end at the first test of a function of the same file.

    `while (!Take(&block));` with `int Take(BLOCK *to) { if (Ready == 0) return 0; ... }`: as long as the test holds,
    nothing else of the function runs.
    """
    for turn in turns:
        match turn:
            case (
                While(test=Not(operand=Call() as call))
                | While(test=Compare(op="==", left=Call() as call, right=Const(value=0)))
            ):  # fmt: skip
                pass
            case _:
                continue
        callee = threads.functions.get(call.function.path)
        if callee is None or callee.module != function.module or any(isinstance(p, CallPointer) for p in parts(call)):
            continue
        first = next((s for s in callee.body if not isinstance(s, Declare) or s.value is not None), None)
        match first:
            case If(test=test, then=[Return(value=Expr() as value)]) if constant_of(value) == 0:
                if all(v.kind == "global" for v in variables(parts(test))):
                    yield While(turn.where, test, turn.body)


def _untaken(s: Stmt) -> Stmt:
    """A statement without what runs only on a condition."""
    return If(s.where, s.test, [], []) if isinstance(s, If) and not s.otherwise else s


class _Loop:
    """One loop, and the conditions that decide whether it continues."""

    def __init__(self, loop: While | For, function: Function, threads: WriterAnalysis) -> None:
        self.loop = loop
        self.function = function
        self.threads = threads
        #: The statements of a turn after which another one can follow.
        self.inside = [loop, *(s for block in blocks(loop) for s in _turning(block, inner=False))]
        self.written = {words for s in self.inside for words in _written(s)}
        #: Locals that its turns change -> the values assigned to them (None: not known).
        self.given: dict[Variable, list[Expr | None]] = {}
        for s in self.inside:
            match s:
                case Assign(target=LValue(root=Variable() as root), value=value) if root.kind != "global":
                    self.given.setdefault(root, []).append(value)
                case Declare(variable=variable, value=value):
                    self.given.setdefault(variable, []).append(value if isinstance(value, Expr) else None)
                case For(variable=LValue(root=Variable() as root)) | CopyStruct(target=LValue(root=Variable() as root)):
                    self.given.setdefault(root, []).append(None)

    def polled(self) -> list[tuple[WordRange, str]]:
        """What the loop waits for and the compiler need not read again; its name."""
        decisive = [source for test in self.exits() for source in self.sources(test, frozenset())]
        if not any(self.read(source) for source in decisive) or not self.transparent():
            return []
        read = [self.read(source) for source in decisive]  # again, because `transparent` has added what its calls write
        return [each for one in read for each in one] if all(read) or self.idle() else []

    def exits(self) -> Iterator[Expr | None]:
        """The conditions that decide whether the loop ends (None: a counter at its limit)."""
        for block in blocks(self.loop):
            if block and isinstance(block[-1], Break | Return | Jump):
                return  # it turns once
        match self.loop:
            case While(test=test) if not isinstance(test, Const):
                yield test
            case For():
                yield None
        for block in blocks(self.loop):
            yield from _decisions(block, inner=False)

    def sources(self, test: Expr | None, seen: Set[Variable]) -> Iterator[Expr | None]:
        """The expressions on which a condition depends and which no turn changes; None for those that turns change."""
        for term in _terms(test):
            changed = self.changed(term)
            if term is not None and not changed:
                yield term
            elif len(changed) == 1 and not changed & seen and changed.issuperset(variables(parts(term))):
                for value in self.given[min(changed, key=id)]:
                    yield from self.sources(value, seen | changed)
            else:
                yield None

    def changed(self, e: Expr | None) -> set[Variable]:
        """The locals in an expression that the turns of the loop change."""
        return {variable for variable in variables(parts(e)) if variable in self.given}

    def read(self, e: Expr | None) -> list[tuple[WordRange, str]]:
        """What an expression reads of objects of static storage; nothing if some of it must be read every time.

        A volatile object that no other thread writes is read every time too, but it does not change.
        """
        found = []
        for p in parts(e):
            match p:
                case RegisterLoad() | Call() | CallPointer() | LValue(root=Expr()) | LValue(volatile=True):
                    return []
                case LValue(root=Variable(volatile=True)) if (words := _words(p)) and self.threads.writer(
                    words, self.function
                ):
                    return []
                case Load(lvalue=LValue(root=Variable(kind="global", constant=False) as root) as lvalue):
                    words = _words(lvalue)
                    if words is None or any(map(words.meets, self.written)):
                        return []
                    if not root.volatile:
                        found.append((words, _name(lvalue, root)))
        return found

    def transparent(self) -> bool:
        """Whether the compiler knows all that the loop writes.  Adds to `written` what its calls write."""
        return not any(map(_writes_by_pointer, self.inside)) and all(map(self.known, _calls(self.inside)))

    def known(self, call: Call | CallPointer) -> bool:
        """Whether a call runs only functions of this file, of which none writes or calls through a pointer."""
        if isinstance(call, CallPointer):
            return False
        if call.function.extern:
            return call.function.name in INSTRUCTIONS
        for path in self.threads.below(call.function.path):
            callee = self.threads.functions.get(path)
            if callee is None or callee.module != self.function.module:
                return False
            body = list(statements(callee.body))
            if any(map(_writes_by_pointer, body)) or any(isinstance(call, CallPointer) for call in _calls(body)):
                return False
            self.written |= {words for s in body for words in _written(s)}
        return True

    def idle(self) -> bool:
        """Whether the turns only count and test."""
        if any(True for _ in _calls(self.inside)):
            return False
        for s in self.inside:
            if _written(s) or (isinstance(s, Assign) and not isinstance(s.target, LValue)):
                return False
        values = [value for values in self.given.values() for value in values if value is not None]
        return all(not self.changed(value) or _counts_or_looks(value) for value in values)


def _turning(block: list[Stmt], *, inner: bool) -> Iterator[Stmt]:
    """The statements of a block, without the blocks whose end leaves the loop.  In an inner loop only `return` does."""
    for s in block:
        yield s
        within = inner or isinstance(s, While | For)
        for b in blocks(s):
            if not b or not isinstance(b[-1], Return | Jump if within else Return | Jump | Break):
                yield from _turning(b, inner=within)


def _terms(test: Expr | None) -> Iterator[Expr | None]:
    """The single conditions that `&&`, `||` and `!` join."""
    match test:
        case Logic(operands=operands):
            for operand in operands:
                yield from _terms(operand)
        case Not(operand=operand):
            yield from _terms(operand)
        case _:
            yield test


def _decisions(block: list[Stmt], *, inner: bool) -> Iterator[Expr | None]:
    """The conditions under which a block leaves its loop, or (`inner`) the loop around its loop."""
    for s in block:
        within = inner or isinstance(s, While | For)
        if any(_leaves(b, inner=within) for b in blocks(s)):
            match s:
                case If(test=test) | Switch(subject=test):
                    yield test
                case While(test=test) if not isinstance(test, Const):
                    yield test
                case For():
                    yield None
            for b in blocks(s):
                yield from _decisions(b, inner=within)


def _leaves(block: list[Stmt], *, inner: bool) -> bool:
    """Whether a block contains a statement that leaves the loop.  From an inner loop (`inner`), only `return` does."""
    return any(
        isinstance(s, Return | Jump) or (isinstance(s, Break) and not inner)
        or any(_leaves(b, inner=inner or isinstance(s, While | For)) for b in blocks(s))
        for s in block
    )  # fmt: skip


def _calls(body: list[Stmt]) -> Iterator[Call | CallPointer]:
    """The calls of statements, without those of their inner blocks."""
    for s in body:
        for part in own_nodes(s):
            if isinstance(part, Call | CallPointer):
                yield part


def _written(s: Stmt) -> list[WordRange]:
    """What a statement itself writes of objects of static storage."""
    match s:
        case Assign(target=LValue() as target) | For(variable=LValue() as target) | CopyStruct(target=target):
            words = _words(target)
            return [] if words is None else [words]
    return []


def _writes_by_pointer(s: Stmt) -> bool:
    match s:
        case Assign(target=LValue(root=Expr())) | CopyStruct(target=LValue(root=Expr())):
            return True
    return False


def _counts_or_looks(value: Expr) -> bool:
    """Whether a value is a step of a counter, or a truth value of comparisons."""
    match bare(value):
        case Binary(op="+" | "-", left=left, right=Const()):
            return isinstance(bare(left), Load)
    looking = (Not, Compare, Logic, Load, Const, Convert, LValue)
    return all(isinstance(p, looking) and not (isinstance(p, LValue) and p.indices) for p in parts(value))
