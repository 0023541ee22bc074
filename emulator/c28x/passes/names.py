"""Static check of names and stores: unused values and objects, functions that are never called, hidden names."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, IntType, StructType
from emulator.c28x.passes.declared import lines_from, words_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.values import volatile
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
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
    FallThrough,
    For,
    Function,
    FunctionRef,
    If,
    Jump,
    LeaveSwitch,
    Load,
    LValue,
    Null,
    PointerAdd,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    String,
    Switch,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    OBSERVABLE,
    addressed,
    assigned,
    bare,
    blocks,
    different,
    last_loop,
    parts,
    roots,
    source_text,
    statements,
    variables,
    within,
)  # fmt: skip

Live = frozenset[Variable]


def read(s: Stmt) -> set[Variable]:
    """The variables that a statement itself uses; of a target, only those in its subscripts or pointer."""
    nodes: list[Any] = []
    for root in roots(s):
        target = isinstance(root, LValue) and not (isinstance(s, CopyStruct) and root is s.source)
        nodes += parts(root)[1:] if target else parts(root)
    return variables(nodes)


class Liveness:
    """Finds values of plain locals that nothing reads, by a backward walk over a function."""

    def __init__(self, function: Function, report: StaticReport) -> None:
        self.function = function
        self.to = report
        self.tracked = {v for v in (*function.parameters, *function.locals) if not v.in_memory}
        copied, reached = _copied(function.body), addressed(within(function.body))
        #: Structures and arrays that only statements of the function reach.  A store to a part does not kill them.
        self.whole = {
            v
            for v in (*function.parameters, *function.locals)
            if isinstance(v.ctype, StructType | ArrayType) and v.in_memory and not v.volatile
            and (not v.escapes or (v in copied and v not in reached))
        }  # fmt: skip
        #: Identity of each statement -> the variables that it uses itself.
        self.used = {id(s): frozenset(read(s)) for s in statements(function.body)}
        self.read_anywhere = {v for used in self.used.values() for v in used}
        #: Variables whose value only their own next value is made of: `check ^= word;`.
        self.only_themselves = self.tracked & self.read_anywhere
        for s in statements(function.body):
            own = assigned(s) if isinstance(s, Assign) else None
            self.only_themselves -= {v for v in self.used[id(s)] if v is not own}
        end = last_loop(function)
        #: It stops at its end, so that a debugger shows its locals.
        self.stops = end is not None and not end.body
        if self.stops:
            self.only_themselves = set()
        #: The live variables after each enclosing loop and at its `continue`; after each enclosing switch.
        self.loops: list[tuple[Live, Live]] = []
        self.switches: list[tuple[str, Live]] = []
        self.reporting = True
        #: Identities of statements that only limit the local of their `if`.
        self.limits = {id(s) for test in statements(function.body) if isinstance(test, If) for s in _limits(test)}
        self.found: dict[int, tuple[Where, Variable, Expr]] = {}
        #: Identity of both last statements of an exchange (`t = a; a = b; b = t;`) -> what the other one sets.
        self.exchanged = {id(s): other for body in _bodies(function.body) for s, other in _exchanges(body)}
        #: Identities of statements of an exchange whose other half is used.
        self.halves: set[int] = set()

    def run(self) -> None:
        """Report the dead stores of the function."""
        self.block(self.function.body, frozenset())
        for where, variable, value in sorted(self.found.values(), key=lambda found: found[0].line):
            path = variable.declaration.path
            message = f"the value {source_text(value)} of {path} is never used"
            self.to.report(self.function, where, "dead-store", message, declaration=variable.declaration)

    def block(self, body: list[Stmt], live: Live) -> Live:
        for i, s in reversed(list(enumerate(body))):
            if id(s) in self.exchanged and i and id(body[i - 1]) in self.exchanged:
                self.exchange((body[i - 1], s), live)
            live = self.statement(s, live)
        return live

    def exchange(self, halves: tuple[Stmt, Stmt], live: Live) -> None:
        """Note which half of an exchange is needed for the other; `live` are the variables behind it.

        If nothing uses either of the two, the exchange is useless (parameters that were passed by value).
        """
        for s in halves:
            other = self.exchanged[id(s)].root
            if not isinstance(other, Variable) or other in live or other not in self.tracked:
                self.halves.add(id(s))
            else:
                self.halves.discard(id(s))

    def statement(self, s: Stmt, live: Live) -> Live:
        used = self.used[id(s)]
        match s:
            case Assign(target=LValue(root=Variable() as root, indices=[]), value=value) if root in self.tracked:
                self.store(s, root, value, live)
                return live - {root} | (used - self.only_themselves)
            case Assign(target=LValue(root=Variable() as root), value=value) if root in self.whole:
                self.store(s, root, value, live)
                return live | used
            case Declare(variable=variable, value=value) if variable in self.tracked:
                if isinstance(value, Expr):
                    self.store(s, variable, value, live)
                return live - {variable} | used
            case Return():
                return used
            case Break():
                return self.loops[-1][0]
            case Continue():
                return self.loops[-1][1]
            case Jump(label=label):
                return next(live for name, live in self.switches if name == label)
            case LeaveSwitch():
                return self.switches[-1][1]
            case If(then=then, otherwise=otherwise):
                return self.block(then, live) | self.block(otherwise, live) | used
            case Switch():
                return self.switch(s, live) | used
            case While():
                return self.while_loop(s, live, used)
            case For(body=body, variable=LValue(root=Variable() as root)):
                test = used | {root}
                return self.repeated(lambda head: self.turn(body, live, head | test), live | test) | test
        return live | used

    def switch(self, s: Switch, live: Live) -> Live:
        """The live variables before the cases."""
        self.switches.append((s.label, live))
        entries: list[Live] = []
        following = live
        for _, body in reversed(s.cases):
            falls = bool(body) and isinstance(body[-1], FallThrough)
            following = self.block(body, following if falls else live)
            entries.append(following)
        self.switches.pop()
        default = s.complete or any(values is None for values, _ in s.cases)
        return frozenset().union(*entries, *(() if default else (live,)))

    def while_loop(self, s: While, live: Live, used: Live) -> Live:
        """The live variables before the loop; `used` are those that its test reads."""
        endless = isinstance(s.test, Const) and s.test.value != 0
        test = used if endless else live | used
        first = self.repeated(lambda head: self.turn(s.body, live, self.block(s.step, head | test)), frozenset())
        return first | test if s.first else first

    def turn(self, body: list[Stmt], behind: Live, end: Live) -> Live:
        """The live variables at the start of a loop's body: `end` at the end of the body, `behind` after the loop."""
        self.loops.append((behind, end))
        live = self.block(body, end)
        self.loops.pop()
        return live

    def repeated(self, turn: Callable[[Live], Live], head: Live) -> Live:
        """The live variables before the first of many turns: the smallest set that one more turn does not enlarge."""
        reporting, self.reporting = self.reporting, False
        while not (grown := turn(head)) <= head:
            head |= grown
        self.reporting = reporting
        return head | turn(head) if reporting else head

    def store(self, s: Assign | Declare, variable: Variable, value: Expr, live: Live) -> None:
        if not self.reporting or variable in live or (_harmless(variable, value) and id(s) not in self.limits):
            return
        if variable.volatile:  # the store itself is an effect (ISO C 5.1.2.3 p2): a debugger shows the value
            return
        if id(s) in self.halves or (isinstance(s, Assign) and self.says_unused(s, variable)):
            return
        declared = isinstance(s, Declare)
        if _reads_device(value):
            return
        for_effect = _for_effect(value) and (declared or variable not in self.read_anywhere)
        if for_effect and not self.is_forgotten(variable, value, live):
            return
        if variable in self.only_themselves and volatile(value):
            return
        if variable in self.whole:  # reported once, at its first part: the walk goes backwards
            self.found = {line: found for line, found in self.found.items() if found[1] is not variable}
        self.found[s.line] = (s.where, variable, value)

    def is_forgotten(self, variable: Variable, value: Expr, live: Live) -> bool:
        """Whether a value was meant to be used in the place of another local: `command = limit(turn, -MOST, MOST);`.

        A function that only computes makes it of a local that is used later, and nothing ever reads the value.
        """
        if variable in self.read_anywhere or self.stops or _NOT_READ & {*words_of(variable.declaration.name)}:
            return False
        sources = {root for root in _computed_of(value) if root in live and root in self.tracked}
        counted = {v for s in statements(self.function.body) if (v := _stepped(s)) is not None}
        return bool(sources - counted - {variable}) and not self.is_said_elsewhere(variable)

    def is_said_elsewhere(self, variable: Variable) -> bool:
        """Whether the text of the function names a local where the tree does not: a message that this build leaves out.

        A remark about its line that it is there to be looked at is one, too.
        """
        own = {variable.declaration.line}
        for s in statements(self.function.body):
            if assigned(s) is variable or (isinstance(s, Declare) and s.variable is variable):
                own.add(s.line)
        name = re.compile(rf"\b{re.escape(variable.declaration.name)}\b")
        for number, line in lines_from(variable.declaration.file, variable.declaration.line):
            if line.startswith("}"):
                return False
            if name.search(line) and (number not in own or _LOOKED_AT.search(line)):
                return True
        return True

    def says_unused(self, s: Assign, variable: Variable) -> bool:
        """`arg = arg;` marks a parameter as unused.  (`ValueChecks` reports it if `arg` hides a file object.)"""
        itself = isinstance(s.value, Load) and s.value.lvalue == s.target
        return itself and variable.kind == "parameter"


def _copied(body: list[Stmt]) -> set[Variable]:
    """The structures that statements copy as a whole: these have an address, but nothing keeps it."""
    copies = [s for s in statements(body) if isinstance(s, CopyStruct)]
    found = {side.root for s in copies for side in (s.target, s.source) if isinstance(side.root, Variable)}
    return {v for v in found if isinstance(v.ctype, StructType) and not v.ctype.word_backed}


def _bodies(body: list[Stmt]) -> Iterator[list[Stmt]]:
    """Every block."""
    yield body
    for s in statements(body):
        yield from blocks(s)


def _exchanges(body: list[Stmt]) -> Iterator[tuple[Stmt, LValue]]:
    """`a = b` and `b = t` of each `t = a; a = b; b = t;` of a block, with the target of the other of the two."""
    for first, second, third in zip(body, body[1:], body[2:], strict=False):
        match second, third:
            case Assign(target=LValue() as a, value=taken), Assign(target=LValue() as b, value=put):
                if _value(taken) == b and _keeps(first, _value(put), a):
                    yield second, b
                    yield third, a


def _value(e: Expr) -> LValue | None:
    """The object of which an expression is just the value."""
    inner = bare(e)
    return inner.lvalue if isinstance(inner, Load) else None


def _keeps(s: Stmt, keeper: LValue | None, what: LValue) -> bool:
    """Whether a statement stores the value of `what` in `keeper`."""
    match s:
        case Assign(target=target, value=value):
            return target == keeper and _value(value) == what
        case Declare(variable=variable, value=Expr() as value):
            return keeper is not None and keeper.root is variable and _value(value) == what
    return False


def _limits(test: If) -> list[Stmt]:
    """The statement of `if (x > 300) x = 300;`."""
    match test:
        case If(test=Compare() as compared, then=[Assign(target=LValue(root=Variable() as root)) as s]):
            return [s] if compared.op not in ("==", "!=") and root in variables(parts(compared)) else []
    return []


def _harmless(variable: Variable, value: Expr) -> bool:
    """Whether an unused value needs no report: a constant, or a step (`*p++` leaves a last one)."""
    inner = bare(value)
    match inner:
        case Const() | Null() | String():
            return True
        case Binary(op="+" | "-", right=Const()) as step:
            return variable in variables(parts(step.left))
        case PointerAdd():
            return variable in variables(parts(inner))
    return False


#: Functions of the run-time library without an effect: they only return a value.
_VALUES_ONLY: Final = frozenset({
    "abs", "acos", "asin", "atan", "atan2", "atof", "atoi", "atol", "ceil", "cos", "exp", "fabs", "floor", "fmod",
    "labs", "log", "memcmp", "pow", "sin", "sqrt", "strcmp", "strlen", "tan",
})  # fmt: skip


#: Words of locals that nothing shall read, or only a debugger.
_NOT_READ: Final = frozenset({
    "dummy", "unused", "temp", "tmp", "junk", "ignore", "ignored", "scratch", "discard", "discarded", "sink", "trash",
    "waste", "spare", "debug", "dbg", "watch", "probe", "trace", "test",
})  # fmt: skip
#: Remarks about such locals.
_LOOKED_AT: Final = re.compile(r"debug|watch|inspect|breakpoint|expressions|not used|unused|later|todo", re.IGNORECASE)


def _computed_of(value: Expr) -> set[Variable]:
    """The locals that are arguments of the calls of a value; none if it can have an effect or read a device."""
    found: set[Variable] = set()
    for p in parts(value):
        match p:
            case Call(function=function, arguments=arguments) if _only_computes(function):
                for argument in arguments:
                    lvalue = _value(argument)
                    if lvalue is not None and isinstance(lvalue.root, Variable) and not lvalue.indices:
                        found.add(lvalue.root)
            case LValue(root=Variable(volatile=False), volatile=False):
                pass
            case Call() | CallPointer() | RegisterLoad() | RegisterAt() | LValue():
                return set()
    return found


def _only_computes(function: Function, above: frozenset[str] = frozenset()) -> bool:
    """Whether a function does nothing but return a value: it sets only its own locals, and takes no time to wait."""
    if function.extern:
        return function.name in _VALUES_ONLY
    if not function.body or function.path in above:
        return False
    for s in statements(function.body):
        match s:
            case Assign(target=LValue(root=Variable(kind=kind))) | CopyStruct(target=LValue(root=Variable(kind=kind))):
                if kind == "global":
                    return False
            case Assign() | CopyStruct() | While(body=[]) | For(body=[]):
                return False
    for node in within(function.body):
        match node:
            case RegisterLoad() | RegisterRef() | RegisterAt() | CallPointer():
                return False
            case LValue(root=root) if volatile(node) or (isinstance(root, Expr) and not _of_pointer(root)):
                return False
            case Call(function=called):
                if not _only_computes(called, above | {function.path}):
                    return False
    return True


def _of_pointer(root: Expr) -> bool:
    """Whether an object is one that a pointer leads to; not one at an address by number."""
    return isinstance(bare(root), Load) and not isinstance(bare(root).ctype, IntType)


def _stepped(s: Stmt) -> Variable | None:
    """The variable that a statement counts."""
    match s:
        case For(variable=LValue(root=Variable() as counter)):
            return counter
        case Assign(target=LValue(root=Variable() as counter, indices=[]), value=value):
            return counter if _harmless(counter, value) and not isinstance(bare(value), Const) else None
    return None


def _for_effect(value: Expr) -> bool:
    """Whether a value may be read for an effect: it has a call, a volatile object, or an access by pointer."""
    return volatile(value) or any(
        isinstance(p, (*OBSERVABLE, RegisterAt)) or (isinstance(p, LValue) and isinstance(p.root, Expr))
        for p in parts(value)
    )


def _reads_device(value: Expr) -> bool:
    """Whether a value is read from a device: from a register, by its name or by a number, or by a library function."""
    return any(
        _reads_register(p)
        or (isinstance(p, Call) and p.function.extern and p.function.name not in _VALUES_ONLY)
        or (isinstance(p, Call) and _gets_register(p.function.body))
        for p in parts(value)
    )


def _reads_register(part: Any) -> bool:
    """Whether a part of an expression is a register: `AdcaRegs.ADCCTL1`, or `HWREG(base + offset)`."""
    if isinstance(part, LValue) and isinstance(part.root, Convert):
        return isinstance(bare(part.root).ctype, IntType)
    return isinstance(part, RegisterLoad | RegisterAt)


def _gets_register(body: list[Stmt]) -> bool:
    """Whether a function only returns what a register holds, as those of driverlib (`ADC_getInterruptStatus`)."""
    match body:
        case [Return(value=Expr() as value)]:
            return any(map(_reads_register, parts(value)))
    return False


class Mentions:
    """The names that the bodies and initialisers of an image mention."""

    def __init__(self, modules: Iterable[Module], initialisers: Mapping[Variable, list[Any]]) -> None:
        #: The paths of functions whose name is used as a value.
        self.by_address: set[str] = set()
        #: The variables that each function mentions; `at_start`: those that initialisers mention.
        self.by = {f: self._variables(within(f.body)) for module in modules for f in module.functions}
        starts = [value for values in initialisers.values() for value in different(values) if isinstance(value, Expr)]
        self.at_start = self._variables(p for value in starts for p in parts(value))

    def _variables(self, nodes: Iterable[Any]) -> set[Variable]:
        nodes = list(nodes)
        self.by_address |= {p.function.path for p in nodes if isinstance(p, FunctionRef)}
        return variables(nodes)


def check_names(
    function: Function, module: Module, report: StaticReport, used: Set[Variable], *, by_address: bool = False
) -> None:
    """Report locals and parameters that the body does not use (`used` are the used ones), or that hide another name.

    A function that is called through a pointer (`by_address`) needs all parameters that its caller passes.
    """
    for variable in (*function.parameters, *function.locals):
        declaration = variable.declaration
        path, where = declaration.path, declaration.where
        kind = "parameter" if variable.kind == "parameter" else "object"
        if variable not in used and not (by_address and kind == "parameter"):
            rule = "unused-parameter" if kind == "parameter" else "unused-object"
            report.report(function, where, rule, f"{path} is not used", declaration=declaration)
        hidden = module.symbols.get(declaration.name)
        if isinstance(hidden, Variable | Function):
            what = hidden.declaration if isinstance(hidden, Variable) else f"the function {hidden.path}"
            message = f"{path} hides {what}: within {function.name} the name means the local"
            report.report(function, where, "hidden-name", message, declaration=declaration)


def in_header(where: Where, file: str) -> bool:
    """Whether something in `file` comes from a header: other files use it too, so it may be unused here."""
    return where.file not in ("", file)


def check_image(
    modules: list[Module], mentions: Mentions, reports: Mapping[Module, StaticReport], entered: Set[str], *,
    entries: bool,
) -> None:  # fmt: skip
    """Report functions that nothing calls, and objects that nothing mentions, in the whole image.

    `entered` are functions that a pointer or the board calls.  Not checked: modules that were only read because others
    need a part of them, and additions of an overlay, which serve some of the corrections.  Functions are reported only
    if it is known where the image begins: it has `entries`, or a function `main`.
    """
    every = [function for module in modules for function in module.functions]
    reached = {path for function in every for path in function.calls if path != function.path} | entered
    meant = [module for module in modules if not module.brought]
    functions = [(module, function) for module in meant for function in module.functions]
    begins = entries or any(function.name == "main" for _, function in functions)
    for module, function in functions:
        shared = function.name in module.added or in_header(function.where, module.unit(function.name).file)
        if begins and not shared and function.path not in reached and function.name != "main":
            message = f"{function.path} is never called, and its address is never taken"
            reports[module].report(function, function.where, "never-called", message)
    used = mentions.at_start.union(*mentions.by.values())
    for module in meant:
        for variable in module.variables:
            declaration = variable.declaration
            shared = declaration.name in module.added or in_header(
                declaration.where, module.unit(declaration.name).file
            )
            if variable not in used and not shared:
                message = f"{declaration.path} is not used"
                reports[module].report(None, declaration.where, "unused-object", message, declaration=declaration)
