"""Follows the values of a running program: where each one came in, and when.

An image that is linked with `CompileOptions.follow` reports each statement before it begins.  This replays what the
statement does, with ages in place of values: an age says when the data of a source came in.  What a pointer points to,
which register a number addresses and which branch is taken is known at this time, so a library that reaches registers
by numbers needs no rules of its own.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import FloatType, IntType, PointerType
from emulator.c28x.emit.names import local_name
from emulator.c28x.memory import Object, Pointer
from emulator.c28x.position import Calls
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Convert,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    Logic,
    LValue,
    Not,
    PointerAdd,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Unary,
    Variable,
    While,
)
from emulator.c28x.tree_queries import bare, blocks, children, parts, roots, statements
from emulator.registers.cell import Cell
from hil.image import Image

#: Source -> the cycle at which it gave the data in a value.
Ages = dict[str, int]
NO_AGES: Final[Ages] = {}
#: The source of what only the passing of time changes: a counter, a timer, the ticks of the kernel.
TIME: Final = ""
#: Registers, as `block.register`, that count time.
_TIMES: Final = re.compile(r"(CpuTimer\dRegs\.TIM|ECap\w*\.TSCTR|EPwm\w*\.TBCTR|EQep\w*\.QUTMR|IpcRegs\.IPCCOUNTER)")
#: Functions outside of the program whose result depends on the time.
_TELLING: Final = re.compile(r"Clock_getTicks|Timestamp_get\w*|Timer_getCount|\w+_pend$|\w+_getTime\w*")
#: Functions that copy words: the positions of the target, the source and (None: none) the count.
_COPIES: Final = {
    "memcpy": (0, 1, 2), "memmove": (0, 1, 2), "strcpy": (0, 1, None), "strncpy": (0, 1, 2), "strcat": (0, 1, None),
}  # fmt: skip
#: The most words of a local that a function of a library fills or copies.
_LOCAL_WORDS: Final = 64
#: Functions that write a text.
TEXTS: Final = re.compile(r"(System_)?v?sn?printf$|ltoa$")
_OPERATORS: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b, "&": lambda a, b: a & b,
    "|": lambda a, b: a | b, "^": lambda a, b: a ^ b, "<<": lambda a, b: a << b, ">>": lambda a, b: a >> b,
    "==": lambda a, b: a == b, "!=": lambda a, b: a != b, "<": lambda a, b: a < b, ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b, ">=": lambda a, b: a >= b,
}  # fmt: skip


class MemoryWord(NamedTuple):
    """A word of an object."""

    path: str
    word: int


@dataclass(eq=False, slots=True)
class FollowedStatement:
    """What is known of a statement before the program runs."""

    function: Function
    #: The statements with a test around it, the outermost first, and what is evaluated again after its body.
    around: tuple[Stmt, ...]
    loops: tuple[Stmt, ...]
    #: The calls of functions of the program in it.
    calls: tuple[Call, ...]
    #: The tests in its expressions that choose a value; of an `if` its own, if a state depends on it.
    choices: tuple[Expr, ...]
    #: It limits what it assigns: `if (x > MAX) x = MAX;`.
    limits: bool
    #: It changes what others can see: an object, a register, what another function does.
    acts: bool
    #: It changes no ages, and no state is tested.
    idle: bool
    #: What it does to ages.
    effect: Callable[[FollowedCall], None]


@dataclass(eq=False, slots=True)
class FollowedCall:
    """A call of a function that has not returned yet."""

    calls: Calls | None
    function: Function
    caller: FollowedCall | None
    #: What called it, if it is an interrupt routine: the source of the interrupt.
    interrupt: str = ""
    statement: Stmt | None = None
    #: The statement calls functions of the program: it ends with their results.
    pending: bool = False
    values: Mapping[str, Any] = field(default_factory=dict)
    #: The ages of locals and parameters, and those alone that do not come from parameters.
    locals: dict[Variable, Ages] = field(default_factory=dict)
    own: dict[Variable, Ages] = field(default_factory=dict)
    #: Function -> the ages of its last results in this statement.
    results: dict[str, Ages] = field(default_factory=dict)
    #: Identity of a statement around -> the ages of its test, if that calls functions of the program.
    tests: dict[int, Ages] = field(default_factory=dict)


def newest(first: Ages, second: Ages) -> Ages:
    """The ages of a value that is made of two; of each source the newest data."""
    if not first or first is second:
        return second
    if not second:
        return first
    found = dict(first)
    for source, birth in second.items():
        if birth > found.get(source, -1):
            found[source] = birth
    return found


class ValueFollower:
    """Follows the values on one image.

    `reading(cell)` gives the ages of what a register holds; None: nothing of outside.  `began(statement, call)` is
    called before each statement.
    """

    def __init__(
        self, image: Image, functions: Iterable[Function], reading: Callable[[Cell], Ages],
        began: Callable[[Stmt, FollowedStatement, FollowedCall], None],
    ) -> None:  # fmt: skip
        self._board = image.board
        self._objects = image.linked.objects
        self._position = image.board.findings.position
        self._clock = image.board.clock
        self._reading = reading
        self._began = began
        self._functions = {function.path: function for function in functions}
        self.known: dict[int, FollowedStatement] = {}
        #: The ages of words of objects.
        self.memory: dict[MemoryWord, Ages] = {}
        #: Path of an object -> its words that have ages.
        self._words: dict[str, set[int]] = {}
        #: Who runs -> the calls that it is in, the innermost last.
        self._stacks: dict[str, list[FollowedCall]] = {}
        #: Who ran when the last statement began, and its calls.
        self._who = ""
        self._stack: list[FollowedCall] = []
        #: The interrupt that runs: its name, by that of its routine.
        self.interrupts: dict[str, str] = {}
        #: Local -> what is assigned to it.
        self._assigned: dict[Variable, list[Expr]] = {}
        #: Identity of an expression -> the expression, and the parts of it that have ages.
        self._aged: dict[int, tuple[Expr, tuple[Expr, ...]]] = {}
        self._read = _read_objects(self._functions.values())
        for function in self._functions.values():
            self._learn(function, function.body, (), ())
        self._position.follow = self._follow

    def _learn(self, f: Function, body: Iterable[Stmt], around: tuple[Stmt, ...], loops: tuple[Stmt, ...]) -> None:
        for s in body:
            nodes = [p for root in roots(s) for p in parts(root)]
            calls = tuple(p for p in nodes if isinstance(p, Call) and p.function.path in self._functions)
            idle = not isinstance(s, Assign | Declare | CopyStruct | For | Evaluate) and not calls
            match s:
                case Switch(subject=subject) if any(isinstance(p, Load) and not _plain(p) for p in parts(subject)):
                    idle = False
            if isinstance(s, Return) and s.value is not None and not isinstance(bare(s.value), Const):
                idle = False
            limits = _limits(s, around)
            self.known[id(s)] = FollowedStatement(
                f, around, loops, calls, tuple(self._choices(s, nodes)), limits, self._acts(s), idle,
                _nothing if limits else self._effect(s),
            )  # fmt: skip
            match s:
                case Assign(target=LValue(root=Variable() as root), value=value) | Declare(
                    variable=root, value=Expr() as value
                ):  # fmt: skip
                    self._assigned.setdefault(root, []).append(value)
            tested = isinstance(s, If | Switch | While)
            for block in blocks(s):
                self._learn(
                    f, block, (*around, s) if tested else around, (*loops, s) if isinstance(s, While) else loops
                )  # fmt: skip

    def _acts(self, s: Stmt) -> bool:
        match s:
            case Assign(target=LValue(root=Variable() as root)):
                return not root.plain and root.declaration.path in self._read
            case Assign() | CopyStruct():
                return True
            case Evaluate(value=Call(function=Function(extern=True, name=name))):
                return name not in ("EALLOW", "EDIS", "EINT", "DINT", "NOP", "__eallow", "__edis")
            case Evaluate():
                return True
        return False

    def _choices(self, s: Stmt, nodes: list[Any]) -> Iterator[Expr]:
        if isinstance(s, If):
            if any(self.sets_state(inner) for inner in statements([*s.then, *s.otherwise])):
                yield s.test
        elif not isinstance(s, While | For | Switch):
            yield from (p for p in nodes if isinstance(p, Compare | Logic | Not))
            yield from (p.test for p in nodes if isinstance(p, Conditional))

    # The calls ------------------------------------------------------------------------------------------------------

    def _follow(self, s: Stmt, values: Mapping[str, Any]) -> None:
        known = self.known[id(s)]
        if known.idle and not known.choices:
            return
        who, calls = self._position.who, self._position.calls
        if who != self._who:
            self._switch(who, calls)
        stack = self._stack
        call = stack[-1] if stack else None
        if call is None or call.calls is not calls:
            call = self._enter(stack, who, calls, s)
        elif call.pending:
            self._end(call)
        call.statement, call.values = s, values
        self._began(s, known, call)
        if known.calls:
            call.pending = True
            call.results = {}
        elif not known.idle:
            known.effect(call)

    def _switch(self, who: str, calls: Calls | None) -> None:
        """Another thread runs.  An interrupt routine that is over has ended its last statement."""
        over = self._stacks.get(self._who)
        if over and over[0].calls is not None and self._who.startswith(("Isr:", "Hwi:", "Swi:")):
            first = over[0].calls
            step = calls
            while step is not None and step is not first:
                step = step[1]
            if step is None:
                self._unwind(over, 0)
        self._who, self._stack = who, self._stacks.setdefault(who, [])

    def _unwind(self, stack: list[FollowedCall], depth: int) -> None:
        while len(stack) > depth:
            call = stack.pop()
            if call.pending:
                self._end(call)

    def _enter(self, stack: list[FollowedCall], who: str, calls: Calls | None, s: Stmt) -> FollowedCall:
        """The call whose statement begins: one that is returned to, or a new one."""
        while stack:
            top = stack[-1]
            if top.calls is calls:
                if top.pending:
                    self._end(top)
                return top
            if calls is not None and calls[1] is top.calls and len(calls) < 3:
                break
            self._unwind(stack, len(stack) - 1)
        function = self.known[id(s)].function
        caller = stack[-1] if stack else None
        name = who.partition(":")[2]
        interrupt = self.interrupts.get(name, "") if caller is None else caller.interrupt
        call = FollowedCall(calls, function, caller, interrupt)
        if caller is not None and caller.statement is not None:
            for made in self._made(caller.statement, function):
                for parameter, argument in zip(function.parameters, made.arguments, strict=False):
                    call.locals[parameter] = newest(call.locals.get(parameter, NO_AGES), self.ages(argument, caller))
        stack.append(call)
        return call

    def _made(self, s: Stmt, function: Function) -> list[Call]:
        """The calls of a function that a statement makes, or the test of a loop around it."""
        known = self.known[id(s)]
        made = [each for each in known.calls if each.function.path == function.path]
        for loop in reversed(known.loops):
            made = made or [each for each in self.known[id(loop)].calls if each.function.path == function.path]
        return made

    def running(self) -> FollowedCall | None:
        """The call whose statement executes."""
        stack = self._stacks.get(self._position.who)
        call = stack[-1] if stack else None
        return call if call is not None and call.calls is self._position.calls else None

    def _end(self, call: FollowedCall) -> None:
        call.pending = False
        assert call.statement is not None
        self.known[id(call.statement)].effect(call)

    # Statements -----------------------------------------------------------------------------------------------------

    def _effect(self, s: Stmt) -> Callable[[FollowedCall], None]:
        match s:
            case Assign(target=LValue() as target, value=value):
                return partial(self._set, target, value, _only_time(target, value))
            case Declare(variable=variable, value=Expr() as value):
                target = LValue(variable.ctype, variable)
                return partial(self._set, target, value, _only_time(target, value))
            case Declare(variable=variable):
                return partial(self._forget, variable.declaration.path)
            case CopyStruct(target=target, source=source):
                return partial(self._copy_struct, target, source)
            case Return(value=Expr() as value):
                return partial(self._return, value)
            case If(test=test) | While(test=test) | Switch(subject=test):
                return partial(self._test, s, test)
            case For(variable=LValue(root=Variable() as root)):
                return partial(self._count, root)
            case Evaluate(value=Call(function=Function(extern=True, name=name), arguments=arguments, extra=extra)):
                if name in _COPIES or name == "memset" or TEXTS.match(name):
                    return partial(self._library, name, [*arguments, *extra])
        return _nothing

    def _copy_struct(self, target: LValue, source: LValue, call: FollowedCall) -> None:
        to, of = self.word(target, call), self.word(source, call)
        if to is not None and of is not None:
            self._copy(to, of, target.ctype.words)

    def _return(self, value: Expr, call: FollowedCall) -> None:
        if call.caller is not None:
            results = call.caller.results
            results[call.function.path] = newest(results.get(call.function.path, NO_AGES), self.ages(value, call))

    def _test(self, s: Stmt, test: Expr, call: FollowedCall) -> None:
        call.tests[id(s)] = self.ages(test, call)

    def _count(self, variable: Variable, call: FollowedCall) -> None:
        call.locals[variable] = call.own[variable] = NO_AGES

    def _set(self, target: LValue, value: Expr, only_time: bool, call: FollowedCall) -> None:
        ages = self.ages(value, call)
        if only_time:
            ages = newest(ages, {TIME: self._clock.now})
        root = target.root
        if isinstance(root, Variable) and root.plain:
            call.locals[root] = ages
            call.own[root] = self.ages(value, call, own=True) if call.function.parameters else ages
            return
        if call.interrupt:
            ages = newest(ages, {call.interrupt: self._clock.now})
        word = self.word(target, call)
        if word is not None:
            self.set(word, ages)

    def set(self, word: MemoryWord, ages: Ages) -> None:
        """A word has got a value."""
        if ages:
            self.memory[word] = ages
            self._words.setdefault(word.path, set()).add(word.word)
        elif word in self.memory:
            del self.memory[word]
            self._words[word.path].discard(word.word)

    def lay(self, message: Pointer, words: int, ages: Ages) -> None:
        """A message has been copied to where a pointer points."""
        if message.obj is not None:
            for n in range(words):
                self.set(MemoryWord(message.obj.declaration.path, message.offset + n), ages)

    def _forget(self, path: str, _call: FollowedCall) -> None:
        for word in self._words.pop(path, ()):
            del self.memory[MemoryWord(path, word)]

    def _copy(self, to: MemoryWord, of: MemoryWord, words: int) -> None:
        found = [self.memory.get(MemoryWord(of.path, of.word + n), NO_AGES) for n in range(words)]
        for n, ages in enumerate(found):
            self.set(MemoryWord(to.path, to.word + n), ages)

    def _library(self, name: str, arguments: list[Expr], call: FollowedCall) -> None:
        """A function outside of the program that writes to memory."""
        if name in _COPIES:
            to, of, count = _COPIES[name]
            target, source = self._pointed(arguments[to], call), self._pointed(arguments[of], call)
            words = self.value(arguments[count], call) if count is not None else 0
            if target is None or not isinstance(words, int):
                return
            if source is not None:
                words = words or len(self._words.get(source.path, ())) or 1
                self._copy(target, source, min(words, self._room(target), self._room(source)))
        elif name == "memset":
            target, words = self._pointed(arguments[0], call), self.value(arguments[2], call)
            if target is not None and isinstance(words, int):
                for n in range(min(words, self._room(target))):
                    self.set(MemoryWord(target.path, target.word + n), NO_AGES)
        elif TEXTS.match(name) and arguments:
            target = self._pointed(arguments[0], call)
            ages = NO_AGES
            for argument in arguments[1:]:
                ages = newest(ages, self.ages(argument, call))
            if target is not None:
                for n in range(self._room(MemoryWord(target.path, 0))):
                    self.set(MemoryWord(target.path, n), ages)

    def _room(self, word: MemoryWord) -> int:
        """The words from one to the end of its object: what a wrong count adds belongs to other rules."""
        obj = self._objects.get(word.path)
        return max(0, (obj.words if obj is not None else _LOCAL_WORDS) - word.word)

    # Ages -----------------------------------------------------------------------------------------------------------

    def ages(self, e: Expr, call: FollowedCall, *, own: bool = False) -> Ages:
        """The ages of an expression.  `own`: without what came through parameters."""
        known = self._aged.get(id(e))
        if known is None:
            known = self._aged[id(e)] = e, tuple(_aged(e))
        found = NO_AGES
        for part in known[1]:
            found = newest(found, self._ages_of_part(part, call, own))
        return found

    def _ages_of_part(self, e: Expr, call: FollowedCall, own: bool) -> Ages:
        match e:
            case Load(lvalue=LValue(root=Variable() as root)) if root.plain:
                return (call.own if own else call.locals).get(root, NO_AGES)
            case Load(lvalue=lvalue):
                return self._loaded(lvalue, call)
            case RegisterLoad(register=register):
                cell = self._register(register, call)
                return NO_AGES if cell is None else self.of_register(cell)
            case Conditional(test=test, then=a, otherwise=b):
                chosen = self.value(test, call)
                if chosen is not None:
                    return self.ages(a if chosen else b, call, own=own)
                one, other = self.ages(a, call, own=own), self.ages(b, call, own=own)
                return {source: max(birth, other[source]) for source, birth in one.items() if source in other}
            case Call(function=function, arguments=arguments, extra=extra):
                if function.path in self._functions:
                    return call.results.get(function.path, NO_AGES)
                found = {TIME: self._clock.now} if _TELLING.match(function.name) else NO_AGES
                for argument in (*arguments, *extra):
                    found = newest(found, self.ages(argument, call, own=own))
                    pointed = self._pointed(argument, call) if isinstance(argument.ctype, PointerType) else None
                    if pointed is not None:
                        found = newest(found, self._any_of(pointed.path))
                return found
        return NO_AGES

    def all_ages(self, used: Iterable[Expr], call: FollowedCall, *, own: bool = False) -> Ages:
        """The ages of several expressions together."""
        found = NO_AGES
        for e in used:
            found = newest(found, self.ages(e, call, own=own))
        return found

    def given(self, call: FollowedCall) -> Ages:
        """The ages of all locals and parameters of a function."""
        found = NO_AGES
        for ages in call.locals.values():
            found = newest(found, ages)
        return found

    def chosen(self, used: tuple[Expr, ...], call: FollowedCall) -> tuple[int, tuple[Expr, ...], FollowedCall]:
        """Where a value is chosen: how many calls up, from what, and in which call.  Functions in between only pass it
        on.
        """
        depth, values, at = 0, used, call
        while not self.all_ages(values, at, own=True):
            caller = at.caller
            if caller is None or caller.statement is None:
                return 0, used, call
            values = tuple(a for made in self._made(caller.statement, at.function) for a in made.arguments)
            depth, at = depth + 1, caller
        return depth, values, at

    def filled(self, used: tuple[Expr, ...], call: FollowedCall) -> int:
        """How many calls up the object belongs that an expression reaches by a pointer which functions only pass on."""
        at = call
        loads = [p for e in used for p in parts(e) if isinstance(p, Load)]
        reached = [bare(p.lvalue.root) for p in loads if isinstance(p.lvalue.root, Expr)]
        depth = 0
        while reached:
            pointer = reached[0]
            while isinstance(pointer, PointerAdd):
                pointer = bare(pointer.pointer)
            match pointer:
                case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in at.function.parameters:
                    pass
                case _:
                    break
            caller = at.caller
            if caller is None or caller.statement is None:
                break
            number = at.function.parameters.index(root)
            made = self._made(caller.statement, at.function)
            depth, at = depth + 1, caller
            reached = [bare(each.arguments[number]) for each in made if number < len(each.arguments)]
        return depth

    def carriers(self, used: Iterable[Expr], call: FollowedCall) -> tuple[str, ...]:
        """The objects at file scope from which expressions take values with an age, in their function."""
        found: set[str] = set()
        seen: set[Variable] = set()
        waiting = list(used)
        while waiting:
            for p in parts(waiting.pop()):
                root = p.lvalue.root if isinstance(p, Load) else None
                if not isinstance(root, Variable) or root in seen:
                    continue
                seen.add(root)
                if root.kind == "global":
                    found |= {root.declaration.path} if self._words.get(root.declaration.path) else set()
                else:
                    waiting += self._assigned.get(root, ())
        return tuple(sorted(found))

    def sets_state(self, s: Stmt) -> bool:
        """Whether a statement sets or steps a state: an object that others read gets a constant, or counts."""
        if not isinstance(s, Assign) or not self._acts(s):
            return False
        return isinstance(bare(s.value), Const) or (
            isinstance(s.target, LValue) and _only_time(s.target, s.value)
        )

    def of_register(self, cell: Cell) -> Ages:
        """The ages of what a register holds."""
        if _TIMES.match(cell.path):
            return {TIME: self._clock.now}
        return self._reading(cell)

    def _loaded(self, lvalue: LValue, call: FollowedCall) -> Ages:
        word = self.word(lvalue, call)
        if word is not None:
            return self.memory.get(word, NO_AGES)
        if isinstance(lvalue.root, Variable):
            return self._any_of(lvalue.root.declaration.path)
        cell = self._addressed(self.value(lvalue.root, call), lvalue, call)
        return NO_AGES if cell is None else self.of_register(cell)

    def _any_of(self, path: str) -> Ages:
        """The ages of an object, whichever of its words is meant."""
        found = NO_AGES
        for word in self._words.get(path, ()):
            found = newest(found, self.memory[MemoryWord(path, word)])
        return found

    def control(self, s: Stmt, call: FollowedCall) -> Ages:
        """The ages of the tests around a statement, in its function and in those that called it."""
        found = NO_AGES
        caller: FollowedCall | None = call
        at: Stmt | None = s
        while caller is not None and at is not None:
            for s in self.known[id(at)].around:
                ages = caller.tests.get(id(s))
                if ages is None and isinstance(s, If | While | Switch):
                    ages = self.ages(s.subject if isinstance(s, Switch) else s.test, caller)
                found = newest(found, ages or NO_AGES)
            caller = caller.caller
            at = caller.statement if caller is not None else None
        return found

    # Where ----------------------------------------------------------------------------------------------------------

    def word(self, lvalue: LValue, call: FollowedCall) -> MemoryWord | None:
        """The word of an object that an lvalue designates; None: it is not known, or no object."""
        words = lvalue.words
        for index in lvalue.indices:
            at = self.value(index.expr, call)
            if not isinstance(at, int):
                return None
            words += at * index.words
        if isinstance(lvalue.root, Variable):
            return MemoryWord(lvalue.root.declaration.path, words)
        pointed = self._pointed(lvalue.root, call)
        return None if pointed is None else MemoryWord(pointed.path, pointed.word + words)

    def _pointed(self, pointer: Expr, call: FollowedCall) -> MemoryWord | None:
        match self.value(pointer, call):
            case MemoryWord() as word:
                return word
            case Pointer(obj=Object() as obj, offset=offset):
                return MemoryWord(obj.declaration.path, offset)
        return None

    def _register(self, register: RegisterRef | RegisterAt, call: FollowedCall) -> Cell | None:
        if isinstance(register, RegisterRef):
            return None if register.unmodelled else self._board.register(register.block, register.register)
        address = _address(self.value(register.block, call))
        return None if address is None else self._board.register_at(address + register.words)

    def _addressed(self, pointer: Any, lvalue: LValue, call: FollowedCall) -> Cell | None:
        address = _address(pointer)
        if address is None:
            return None
        address += lvalue.words
        for index in lvalue.indices:
            at = self.value(index.expr, call)
            if not isinstance(at, int):
                return None
            address += at * index.words
        return self._board.register_at(address) or self._board.register_at(address & ~1)

    # Values ---------------------------------------------------------------------------------------------------------

    def value(self, e: Expr, call: FollowedCall) -> Any:
        """The present value of an expression: a number, a pointer; None: it is not known without running it."""
        match e:
            case Const(value=value):
                return value
            case Convert(ctype=ctype, operand=operand):
                return _converted(self.value(operand, call), ctype)
            case Load(lvalue=LValue(root=Variable() as root) as lvalue):
                return self._stored(root, lvalue, call)
            case AddressOf(lvalue=lvalue):
                return self.word(lvalue, call)
            case RegisterAddress(block=block, register=register):
                return self._board.register(block, register).address if register else self._board.blocks[block].base
            case PointerAdd(pointer=pointer, index=index, negative=negative):
                assert isinstance(e.ctype, PointerType)
                at = self.value(index, call)
                if not isinstance(at, int):
                    return None
                step = at * max(1, e.ctype.target.words) * (-1 if negative else 1)
                match self.value(pointer, call):
                    case int() as address:
                        return address + step
                    case MemoryWord() as word:
                        return MemoryWord(word.path, word.word + step)
                    case Pointer(obj=Object() as obj, offset=offset):
                        return MemoryWord(obj.declaration.path, offset + step)
                    case Pointer(offset=offset):
                        return offset + step
                return None
            case Not(operand=operand):
                value = self.value(operand, call)
                return None if value is None else not value
            case Unary(op=op, operand=operand):
                value = self.value(operand, call)
                return None if not isinstance(value, int | float) else -value if op == "-" else ~int(value)
            case Logic(op=op, operands=operands):
                return self._logic(op, operands, call)
            case Conditional(test=test, then=a, otherwise=b):
                chosen = self.value(test, call)
                return None if chosen is None else self.value(a if chosen else b, call)
            case Binary(op=op, left=left, right=right) | Compare(op=op, left=left, right=right) if op in _OPERATORS:
                one, other = self.value(left, call), self.value(right, call)
                if isinstance(one, int | float) and isinstance(other, int | float):
                    if op in ("<<", ">>") and not 0 <= other < 64:
                        return None
                    if op in ("&", "|", "^", "<<", ">>"):
                        one, other = int(one), int(other)
                    return _converted(_OPERATORS[op](one, other), e.ctype)
        return None

    def _logic(self, op: str, operands: list[Expr], call: FollowedCall) -> bool | None:
        known = True
        for operand in operands:
            value = self.value(operand, call)
            if value is None:
                known = False
            elif bool(value) is (op == "or"):
                return bool(value) if known else None
        return op == "and" if known else None

    def _stored(self, root: Variable, lvalue: LValue, call: FollowedCall) -> Any:
        leaf = lvalue.leaf
        for index in lvalue.indices:
            at = self.value(index.expr, call)
            if not isinstance(at, int):
                return None
            leaf += at * index.leaves
        data: Any
        if root.kind == "global":
            obj = self._objects.get(root.declaration.path)
            data = None if obj is None else obj.data
        else:
            data = call.values.get(local_name(root))
        if isinstance(data, list):
            data = data[leaf] if 0 <= leaf < len(data) else None
        if lvalue.bits is not None:
            bits = lvalue.bits
            return data >> bits.lo & (1 << bits.width) - 1 if isinstance(data, int) else None
        return data


def _plain(e: Load) -> bool:
    return isinstance(e.lvalue.root, Variable) and e.lvalue.root.plain


def _address(value: Any) -> int | None:
    match value:
        case int():
            return value
        case Pointer(obj=None, offset=offset):
            return offset
    return None


def _converted(value: Any, ctype: Any) -> Any:
    if isinstance(value, int | float) and isinstance(ctype, IntType):
        if value != value or value in (float("inf"), float("-inf")):
            return None
        signed = 1 << ctype.bits - 1 if ctype.signed else 0
        return (int(value) + signed & (1 << ctype.bits) - 1) - signed
    if isinstance(value, int) and isinstance(ctype, FloatType):
        return float(value)
    return value


def _limits(s: Stmt, around: tuple[Stmt, ...]) -> bool:
    """Whether an assignment limits its target: `if (x > MAX) x = MAX;`."""
    if not isinstance(s, Assign) or not isinstance(s.target, LValue):
        return False
    limit = bare(s.value)
    for test in (p for outer in around if isinstance(outer, If) for p in parts(outer.test)):
        if isinstance(test, Compare) and test.op in ("<", ">", "<=", ">="):
            sides = bare(test.left), bare(test.right)
            for a, b in (sides, sides[::-1]):
                if isinstance(a, Load) and a.lvalue == s.target and _same(b, limit):
                    return True
    return False


def _aged(e: Expr) -> Iterator[Expr]:
    """The parts of an expression that have ages: what it loads, calls and chooses."""
    match e:
        case Load() | RegisterLoad() | Conditional() | Call():
            yield e
        case AddressOf() | CallPointer():
            pass
        case _:
            for child in children(e):
                if isinstance(child, Expr):
                    yield from _aged(child)


def _only_time(target: LValue, value: Expr) -> bool:
    """Whether a value is made of the old one and constants: a counter, a value that decays."""
    value = bare(value)
    if not isinstance(value, Binary):
        return False
    of_itself = False
    for p in parts(value):
        if isinstance(p, Load):
            if p.lvalue != target:
                return False
            of_itself = True
        elif isinstance(p, RegisterLoad | Call | CallPointer):
            return False
    return of_itself


def _nothing(_call: FollowedCall) -> None:
    """The effect of a statement that changes no ages."""


def _same(a: Expr, b: Expr) -> bool:
    return a == b or (isinstance(a, Const) and isinstance(b, Const) and a.value == b.value)


def _read_objects(functions: Iterable[Function]) -> set[str]:
    """The paths of objects whose value some statement uses for something else than their own next value."""
    found: set[str] = set()
    for function in functions:
        for s in statements(function.body):
            own = s.target if isinstance(s, Assign) and isinstance(s.target, LValue) else None
            for p in (p for root in roots(s) for p in parts(root)):
                match p:
                    case Load(lvalue=lvalue) if lvalue != own:
                        pass
                    case AddressOf(lvalue=lvalue):
                        pass
                    case _:
                        continue
                if isinstance(lvalue.root, Variable):
                    found.add(lvalue.root.declaration.path)
            if isinstance(s, CopyStruct) and isinstance(s.source.root, Variable):
                found.add(s.source.root.declaration.path)
    return found
