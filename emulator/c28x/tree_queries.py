"""Queries on the typed tree: what code accesses, calls and changes, and whether it can reach its end."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Set
from dataclasses import fields
from itertools import chain
from typing import Any, Final, TypeVar, get_args, get_type_hints

from emulator.c28x import tree
from emulator.c28x.ctypes import FloatType, IntType, PointerType, StructType
from emulator.c28x.tree import (
    FOUND,
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Continue,
    Convert,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    For,
    Function,
    FunctionRef,
    If,
    Index,
    Jump,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Not,
    Null,
    PointerAdd,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    String,
    Switch,
    Unary,
    Variable,
    While,
)  # fmt: skip

#: `EALLOW` and `EDIS` set and clear a bit of ST1 (CPU, instruction set): they are no calls, and nobody else sees them.
INSTRUCTIONS: Final = ("EALLOW", "EDIS")
OBSERVABLE: Final = (RegisterLoad, Call, CallPointer)


#: A comparison -> the same one with its sides exchanged.
TURNED: Final = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}
#: A comparison by order -> what holds where it fails.
OPPOSITE: Final = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
#: How strongly an operator binds its operands, as in C and in Python.
_BINDS: Final = {"|": 1, "^": 2, "&": 3, "<<": 4, ">>": 4, "+": 5, "-": 5, "*": 6, "/": 6, "%": 6}
_UNARY: Final = 7


def source_text(e: Expr) -> str:
    """The source text of an expression, for a report, without its conversions."""
    match e:
        case Load(lvalue=lvalue) | AddressOf(lvalue=lvalue):
            return lvalue.text or "expression"
        case Const(value=value):
            return f"{value:g}" if isinstance(value, float) else str(value)
        case Convert(operand=operand):
            return source_text(operand)
        case Unary(op=op, operand=operand):
            return f"{op}{_operand(operand, _UNARY)}"
        case Binary(op=op, left=left, right=right):
            return f"{_operand(left, _BINDS[op])} {op} {_operand(right, _BINDS[op] + 1)}"
        case Compare(op=op, left=left, right=right):
            return f"{_operand(left)} {op} {_operand(right)}"
        case PointerAdd(pointer=pointer, index=index, negative=negative):
            return f"{_operand(pointer)} {'-' if negative else '+'} {_operand(index, _BINDS['+'] + 1)}"
        case Logic(op=op, operands=operands):
            return f" {op} ".join(_operand(o) for o in operands)
        case Not(operand=operand):
            return f"not {_operand(operand)}"
        case Conditional(test=test, then=then, otherwise=otherwise):
            return f"{_operand(then)} if {_operand(test)} else {_operand(otherwise)}"
        case CallPointer(target=target):
            return f"{source_text(target)}(...)"
        case String(text=text):
            return repr(text)
        case Null():
            return "NULL"
        case FunctionRef(function=function):
            return function.name
        case Call(function=function):
            return f"{function.name}(...)"
        case RegisterLoad(register=ref):
            return register_text(ref)
        case RegisterAddress(block=block, register=register):
            return f"&{block}.{register}" if register else f"&{block}"
    return "expression"


def register_text(ref: RegisterRef | RegisterAt) -> str:
    """The source text of a register or field."""
    if isinstance(ref, RegisterRef):
        return f"{ref.block}.{ref.register}" + (f".bit.{ref.field.name}" if ref.field else "")
    return f"{source_text(ref.block)}->{ref.name}" + (f".bit.{ref.field.name}" if ref.field else "")


def _operand(e: Expr, binds: int = 0) -> str:
    """The text of an operand, in parentheses if its own operator binds less strongly than `binds`."""
    inner = e
    while isinstance(inner, Convert):
        inner = inner.operand
    text = source_text(inner)
    own = _BINDS[inner.op] if isinstance(inner, Binary) else _BINDS["+"] if isinstance(inner, PointerAdd) else binds
    return f"({text})" if own < binds or isinstance(inner, Compare | Logic | Not | Conditional) else text


def children(e: Any) -> list[Any]:
    """The expressions, lvalues and subscripts directly below `e`."""
    found: list[Any] = []
    for name in INNER.get(type(e), ()):
        value = getattr(e, name)
        found += [v for v in (value if isinstance(value, list) else (value,)) if isinstance(v, _NODES)]
    return found


def parts(e: Any) -> list[Any]:
    """Every expression, lvalue and subscript in `e`; `e` itself is the first."""
    found: list[Any] = []
    _gather(e, found)
    return found


def _gather(e: Any, found: list[Any]) -> None:
    found.append(e)
    for name in INNER.get(type(e), ()):
        value = getattr(e, name)
        if type(value) is list:
            for inner in value:
                if type(inner) in _KINDS:
                    _gather(inner, found)
        elif type(value) in _KINDS:
            _gather(value, found)


_NODES: Final = (Expr, LValue, Index, RegisterAt)


def _found(kind: type[Any]) -> set[str]:
    """The names of the fields of a node that passes fill."""
    return {f.name for f in fields(kind) if f.metadata == FOUND}


def _holds(hint: Any) -> bool:
    """Whether a field of this type can hold a node that `parts` lists, or a list of such nodes."""
    if inner := get_args(hint):
        return any(map(_holds, inner))
    return isinstance(hint, type) and issubclass(hint, _NODES)


#: Kind of node -> its fields that can hold expressions or lvalues.  `Const` is left out: its field is only its origin.
INNER: Final = {
    kind: tuple(name for name, hint in get_type_hints(kind).items() if name not in _found(kind) and _holds(hint))
    for kind in vars(tree).values()
    if isinstance(kind, type) and issubclass(kind, (*_NODES, Stmt, RegisterAt)) and kind is not Const
}


#: The kinds of nodes that `parts` lists.
_KINDS: Final = frozenset(
    kind for kind in vars(tree).values() if isinstance(kind, type) and issubclass(kind, _NODES)
)  # fmt: skip

#: Kind of statement -> its fields that are part of the program.
STATEMENT_FIELDS: Final = {
    kind: tuple(f.name for f in fields(kind) if f.metadata != FOUND)
    for kind in vars(tree).values()
    if isinstance(kind, type) and issubclass(kind, Stmt)
}


#: The kinds of nodes that `roots` lists.
_ROOTS: Final = frozenset(
    kind
    for kind in vars(tree).values()
    if isinstance(kind, type) and issubclass(kind, (Expr, LValue, RegisterRef, RegisterAt))
)


def whole_target(lvalue: LValue) -> bool:
    """Whether an lvalue is a whole object, or exactly the target of a pointer: then its address is already known."""
    root = lvalue.root
    if lvalue.indices or lvalue.words:
        return False
    if isinstance(root, Variable):
        return root.ctype == lvalue.ctype
    return isinstance(root.ctype, PointerType) and root.ctype.target == lvalue.ctype


def observable(e: Any) -> bool:
    """Whether evaluating `e` accesses anything that another task, an interrupt or a peripheral can see."""
    for part in parts(e):
        if isinstance(part, (*OBSERVABLE, RegisterAt)):
            return True
        if isinstance(part, LValue) and (isinstance(part.root, Expr) or part.root.kind == "global"):
            return True
    return False


def executes(s: Stmt) -> bool:
    """Whether a statement executes anything at its start.  A declaration without a value does not, nor does `do`."""
    match s:
        case Declare(value=None) | FallThrough() | While(first=False) | Break(said=False):
            return False
        case Switch(only_block=True):
            return False
    return True


def polls(loop: While) -> bool:
    """Whether a loop only evaluates its condition, without a call."""
    return not loop.body and not loop.step and not calls(loop.test)


def without_end(loop: While) -> bool:
    """Whether no test ends a loop, and nothing leaves it."""
    endless = isinstance(loop.test, Const) and loop.test.value != 0
    return endless and not any(isinstance(s, Break | Return | Jump) for s in statements(loop.body))


def last_loop(function: Function) -> While | None:
    """The endless loop at the end of a function (a `main` never leaves it); None if there is no such loop."""
    last = function.body[-1] if function.body else None
    if isinstance(last, Return) and len(function.body) > 1:
        last = function.body[-2]
    return last if isinstance(last, While) and isinstance(last.test, Const) and last.test.value else None


def renewed(variable: Variable) -> bool:
    """Whether a local has no value again each time its inner block is entered."""
    return variable.kind == "local" and variable.nested and not variable.in_memory and not variable.initialised


def passing(s: Stmt) -> bool:
    """Whether a statement accesses only named objects: no register, no call, no pointer, no inner block."""
    if not isinstance(s, Assign | Declare | Return):
        return False
    for part in own_nodes(s):
        if isinstance(part, (*OBSERVABLE, RegisterRef, RegisterAt)):
            return False
        if isinstance(part, LValue) and isinstance(part.root, Expr):
            return False
    return True


#: An operator that groups freely, and its reverse.
PRODUCT: Final = ("*", "/")
SUM: Final = ("+", "-")


def operands(e: Expr, group: tuple[str, str], forward: bool = True) -> Iterator[tuple[Expr, bool]]:
    """The factors of a `PRODUCT`, or the terms of a `SUM`: each with whether it multiplies, or is added."""
    inner = bare(e)
    if isinstance(inner, Binary) and inner.op in group:
        yield from operands(inner.left, group, forward)
        yield from operands(inner.right, group, forward == (inner.op == group[0]))
    else:
        yield inner, forward


def outermost(nodes: Iterable[Any], group: tuple[str, str]) -> list[Binary]:
    """The products or sums among `nodes` that are no operands of others."""
    found = [p for p in nodes if isinstance(p, Binary) and p.op in group]
    inner = {id(bare(side)) for p in found for side in (p.left, p.right)}
    return [p for p in found if id(p) not in inner]


def number_of(e: Any) -> int | float | None:
    """The value of a constant number; None: it is none."""
    inner = bare(e)
    return inner.value if isinstance(inner, Const) and isinstance(inner.value, int | float) else None


def calls(e: Any) -> bool:
    """Whether evaluating `e` runs a function."""
    return any(isinstance(part, Call | CallPointer) for part in parts(e))


def statements(body: Iterable[Stmt]) -> list[Stmt]:
    """Every statement, each before those of its inner blocks."""
    found: list[Stmt] = []
    for s in body:
        found.append(s)
        if (inner := _BLOCKS.get(type(s))) is not None:  # most statements have no blocks, and every pass asks
            for block in inner(s):
                found += statements(block)
    return found


def blocks(s: Stmt) -> list[list[Stmt]]:
    """The blocks within a statement."""
    inner = _BLOCKS.get(type(s))
    return [] if inner is None else inner(s)


#: The kinds of statements that have blocks -> the blocks.
_BLOCKS: Final[dict[type[Stmt], Callable[[Any], list[list[Stmt]]]]] = {
    If: lambda s: [s.then, s.otherwise],
    While: lambda s: [s.body, s.step],
    For: lambda s: [s.body],
    Switch: lambda s: [inner for _, inner in s.cases],
}


def all_blocks(body: list[Stmt]) -> Iterator[list[Stmt]]:
    """A block, and all that are in it."""
    yield body
    for s in body:
        for inner in blocks(s):
            yield from all_blocks(inner)


GraphNode = TypeVar("GraphNode", bound=Hashable)


def reached(first: Iterable[GraphNode], leads: Callable[[GraphNode], Iterable[GraphNode]]) -> list[GraphNode]:
    """Some nodes of a graph, and all to which they lead, directly or not."""
    found: dict[GraphNode, None] = {}
    waiting = list(first)
    while waiting:
        node = waiting.pop()
        if node not in found:
            found[node] = None
            waiting += leads(node)
    return list(found)


def below(paths: Iterable[str], own: Mapping[str, Function]) -> list[Function]:
    """Functions by their paths, and all of `own` that they call, directly or not."""
    found = reached(paths, lambda path: own[path].calls if path in own else ())
    return [own[path] for path in found if path in own]


def called(nodes: Iterable[Any]) -> list[str]:
    """The paths of the functions that are called by their names among `nodes`."""
    return [p.function.path for p in nodes if isinstance(p, Call)]


def different(values: Iterable[Any]) -> list[Any]:
    """The nodes of a list, each once: the zeros after a short list of initial values are all the same node."""
    return list({id(value): value for value in values}.values())


def roots(s: Stmt) -> list[Any]:
    """The expressions and lvalues of a statement itself, each once, without its inner blocks."""
    found: list[Any] = []
    for name in STATEMENT_FIELDS[type(s)]:
        value = getattr(s, name)
        if type(value) is list:
            found += [part for part in different(value) if type(part) in _ROOTS]
        elif type(value) in _ROOTS:
            found.append(value)
    return found


def own_nodes(s: Stmt) -> list[Any]:
    """Every expression, lvalue and subscript of a statement itself, roots before their parts.  Do not change the list.

    The statement keeps it: dozens of passes ask, and after the builder nothing changes what a tree consists of.
    """
    if s.nodes is None:
        s.nodes = [part for root in roots(s) for part in parts(root)]
    return s.nodes


def runs_function(s: Stmt) -> bool:
    """Whether the expressions of a statement itself call a function."""
    return any(isinstance(part, Call | CallPointer) for part in own_nodes(s))


def assigned(s: Stmt) -> Variable | None:
    """The variable that a statement itself assigns."""
    match s:
        case (
            Assign(target=LValue(root=Variable() as root)) | For(variable=LValue(root=Variable() as root))
            | CopyStruct(target=LValue(root=Variable() as root)) | Declare(variable=root)
        ):  # fmt: skip
            return root
    return None


def gives(s: Stmt) -> tuple[LValue, Expr] | None:
    """The object that a statement itself gives a value, in an assignment or a declaration, and the value."""
    match s:
        case Assign(target=LValue() as target, value=value):
            return target, value
        case Declare(variable=variable, value=Expr() as value):
            return LValue(variable.ctype, variable), value
    return None


def added(s: Stmt) -> Expr | None:
    """What a statement adds to its own target (`x += y`); None: it does something else."""
    match s:
        case Assign(target=LValue() as target, value=value):
            match bare(value):
                case Binary(op="+", left=left, right=right):
                    match bare(left):
                        case Load(lvalue=same) if same == target:
                            return right
    return None


def given_values(body: Iterable[Stmt]) -> Iterator[tuple[LValue, Expr]]:
    """What `gives` finds in statements."""
    return (given for s in statements(body) if (given := gives(s)) is not None)


def assigned_variables(body: list[Stmt]) -> set[Variable]:
    """The variables that statements assign."""
    return {variable for s in statements(body) if (variable := assigned(s)) is not None}


def addressed(nodes: Iterable[Any]) -> set[Variable]:
    """The variables whose address is taken among `nodes`."""
    return variables(p.lvalue for p in nodes if isinstance(p, AddressOf))


def within(body: Iterable[Stmt]) -> Iterator[Any]:
    """Every expression and lvalue of statements."""
    return chain.from_iterable(map(own_nodes, statements(body)))


def variables(nodes: Iterable[Any]) -> set[Variable]:
    """The variables that are roots of lvalues among `nodes`."""
    return {p.root for p in nodes if isinstance(p, LValue) and isinstance(p.root, Variable)}


Answer = TypeVar("Answer")


def once(query: Callable[[Function], Answer]) -> Callable[[Function], Answer]:
    """Ask a query only once for each function, because programs share functions (`Program.like`).

    It may use what the builder and the pass `intervals` made, which later passes do not change.
    """

    def ask(function: Function) -> Answer:
        if query not in function.answers:
            function.answers[query] = query(function)
        answer: Answer = function.answers[query]
        return answer

    return ask


def of_all(query: Callable[[Function], set[Answer]]) -> Callable[[Iterable[Function]], set[Answer]]:
    """Ask a query `once` for each of some functions, and take what it finds in any of them."""
    ask = once(query)
    return lambda functions: set[Answer]().union(*map(ask, functions))


@of_all
def compared(function: Function) -> set[Variable]:
    """The variables that occur in a comparison or a subscript."""
    nodes = [p for p in within(function.body) if isinstance(p, Compare | Index)]
    return variables(part for p in nodes for part in parts(p))


#: A scalar by what holds it, whichever object that is: the object itself or the structure, and the offset in words.
NamedScalar = tuple[Variable | StructType, int]


def named_scalar(lvalue: LValue) -> NamedScalar | None:
    """The scalar that an lvalue names: a variable, or a member of a structure; None for an element of an array."""
    match lvalue:
        case LValue(indices=[], bits=None, root=Variable(ctype=StructType() as holder), words=words):
            return holder, words
        case LValue(indices=[], bits=None, root=Variable() as holder, words=words):
            return holder, words
        case LValue(indices=[], bits=None, root=Expr(ctype=PointerType(target=StructType() as holder)), words=words):
            return holder, words
    return None


@once
def named_scalars(function: Function) -> set[NamedScalar]:
    """The scalars that a function names."""
    return {scalar for p in within(function.body) if isinstance(p, LValue) and (scalar := named_scalar(p)) is not None}


def fixed_words(lvalue: LValue) -> int | None:
    """The offset of a scalar from the root of its lvalue, in words; None if a subscript is no constant."""
    words = lvalue.words
    for index in lvalue.indices:
        at = bare(index.expr)
        if not isinstance(at, Const) or not isinstance(at.value, int):
            return None
        words += at.value * index.words
    return words


@of_all
def limited(function: Function) -> set[NamedScalar]:
    """The unsigned scalars that the source limits: a larger value is replaced by the limit."""
    found: set[NamedScalar] = set()
    for larger, limit, chosen in _choices(function.body):
        match _as_it_is(larger):
            case Load(lvalue=lvalue, ctype=IntType(signed=False)) if any(_same(value, limit) for value in chosen):
                if (scalar := named_scalar(lvalue)) is not None:
                    found.add(scalar)
    return found


def _choices(body: list[Stmt]) -> Iterator[tuple[Expr, Expr, list[Expr]]]:
    """The branches of comparisons by order: the larger side there, the smaller one, and the values that are taken."""
    for s in statements(body):
        match s:
            case If(test=Compare() as test, then=then, otherwise=otherwise):
                for branch, holds in ((then, True), (otherwise, False)):
                    given = [x.value for x in branch if isinstance(x, Assign | Return) and isinstance(x.value, Expr)]
                    yield from _sides(test, given, holds=holds)
        for p in own_nodes(s):
            match p:
                case Conditional(test=Compare() as test, then=value, otherwise=other):
                    yield from _sides(test, [value], holds=True)
                    yield from _sides(test, [other], holds=False)


def _sides(test: Compare, chosen: list[Expr], *, holds: bool) -> Iterator[tuple[Expr, Expr, list[Expr]]]:
    if test.op in ("<", "<=", ">", ">="):
        left_larger = (test.op in (">", ">=")) == holds
        yield (test.left, test.right, chosen) if left_larger else (test.right, test.left, chosen)


@of_all
def made_float(function: Function) -> set[NamedScalar]:
    """The unsigned scalars of 16 bits whose value some expression converts to a float."""
    found: set[NamedScalar] = set()
    for p in within(function.body):
        match p:
            case Convert(ctype=FloatType(), operand=Load(ctype=IntType(signed=False, bits=16), lvalue=lvalue)):
                if (named := named_scalar(lvalue)) is not None:
                    found.add(named)
    return found


@of_all
def limited_scalars(function: Function) -> set[NamedScalar]:
    """The scalars that some expression compares by order with a constant."""
    found: set[NamedScalar] = set()
    for p in within(function.body):
        if isinstance(p, Compare) and p.op not in ("==", "!="):
            for side, other in ((bare(p.left), p.right), (bare(p.right), p.left)):
                named = named_scalar(side.lvalue) if isinstance(side, Load) and isinstance(other, Const) else None
                if named is not None:
                    found.add(named)
    return found


def _as_it_is(e: Expr) -> Expr:
    """An integer without the conversions around it that keep every value that is not negative."""
    match e:
        case Convert(ctype=IntType(signed=True, bits=to), operand=Expr(ctype=IntType(bits=bits))) if to <= bits:
            return e
        case Convert(operand=operand):
            return _as_it_is(operand)
    return e


def _same(a: Expr, b: Expr) -> bool:
    """Whether two expressions are the same number; their types may differ."""
    a, b = bare(a), bare(b)
    return a == b or (isinstance(a, Const) and isinstance(b, Const) and a.value == b.value)


def averaged(body: list[Stmt]) -> set[Variable]:
    """The variables whose value is divided, or converted to a float or to a wider integer."""
    found: set[Variable] = set()
    for p in within(body):
        match p:
            case Binary(op="/", left=used) | Convert(ctype=FloatType(), operand=used):
                pass
            case Convert(ctype=IntType(bits=wide), operand=Expr(ctype=IntType(bits=narrow)) as used) if wide > narrow:
                pass
            case _:
                continue
        match bare(used):
            case Load(lvalue=LValue(root=Variable() as root)):
                found.add(root)
    return found


def leaves(body: list[Stmt]) -> bool:
    """Whether control never reaches the end of the statements."""
    match body[-1] if body else None:
        case Return() | Break() | Continue() | LeaveSwitch():
            return True
        case If(then=a, otherwise=b):
            return leaves(a) and leaves(b)
    return False


def bare(e: Expr) -> Expr:
    """An expression without the conversions around it."""
    while isinstance(e, Convert):
        e = e.operand
    return e


def counts(loop: Stmt) -> bool:
    """Whether every turn of a loop steps the plain local that its test compares: then it ends sooner or later."""
    match loop:
        case While(test=Compare(op="<" | ">" | "<=" | ">=" | "!=" as op, left=left, right=right), body=body):
            if op == ">=" and isinstance(right, Const) and right.value == 0:
                return False
        case While(test=left, body=body):
            pass
        case _:
            return False
    match bare(left):
        case Load(lvalue=LValue(root=Variable(in_memory=False) as counter, indices=[])) if counter.kind != "global":
            pass
        case _:
            return False
    for s in body:
        match s:
            case Assign(target=LValue(root=root), value=value) if root is counter:
                match bare(value):
                    case Binary(op="+" | "-", left=stepped, right=Const()):
                        return counter in variables(parts(stepped))
    return False


def only_compute(functions: Iterable[Function]) -> set[str]:
    """The paths of the functions whose result nobody else changes, and that call only such functions.

    They access no register and no object at file scope that is not constant.
    """
    found = {f.path: f.calls for f in functions if not _sees_others(f)}
    while more := [path for path, called in found.items() if called - found.keys()]:
        for path in more:
            del found[path]
    return set(found)


@once
def _sees_others(function: Function) -> bool:
    return any(map(_of_others, within(function.body)))


def _of_others(node: Any) -> bool:
    """Whether a node is a register, an object at file scope that can change, or a call of an unknown function."""
    match node:
        case LValue(root=Variable(kind="global", constant=False)):
            return True
        case RegisterLoad() | RegisterRef() | RegisterAt() | CallPointer():
            return True
    return False


def computes_alone(loop: Stmt, only_compute: Set[str] = frozenset()) -> bool:
    """Whether only its own statements can end a loop: it reads no register, and does not just count.

    It calls nothing but functions that only compute, by their paths.
    """
    return not counts(loop) and not any(
        isinstance(p, OBSERVABLE) and not (isinstance(p, Call) and p.function.path in only_compute)
        for p in within([loop])
    )


def visible_to_others(body: list[Stmt]) -> bool:
    """Whether a statement may access something that others can see; every `for` and `switch` counts as one."""
    for s in body:
        match s:
            case Assign(target=target, value=value):
                if isinstance(target, RegisterRef | RegisterAt) or observable(target) or observable(value):
                    return True
            case Evaluate(value=Call(function=Function(extern=True, name=name))) if name in INSTRUCTIONS:
                pass
            case Return(value=Expr() as value) if observable(value):
                return True
            case Evaluate() | CopyStruct():
                return True
            case Declare(value=Expr() as value) if observable(value):
                return True
            case Declare(value=list() as values) if any(observable(value) for value in different(values)):
                return True
            case If(test=test, then=a, otherwise=b):
                if observable(test) or visible_to_others(a) or visible_to_others(b):
                    return True
            case While(test=test, body=inner):
                if observable(test) or visible_to_others(inner) or not inner:
                    return True
            case For() | Switch():
                return True
    return False
