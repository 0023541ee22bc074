"""Other forms of a driver: programs that do the same in C, written in another way, line by line.

A damage that `hil check` finds in one form should be found in each of them, and a correct driver stays silent.
"""

from __future__ import annotations

import copy
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import zip_longest
from typing import Any, Final

from pycparser import c_ast

from emulator.c28x.ctypes import FloatType, FunctionType, IntType, PointerType
from emulator.c28x.readers.c.tokens import spelled
from emulator.c28x.tree import Variable
from hil.board import load
from tests.corpus.corpus import Damage, Driver, Result, check
from tests.corpus.source import FieldOf, Source, declaration_of, named, nodes, value_declaration

#: The operators of assignments that compute.
_COMPOUND: Final = ("+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=")
_STEPS: Final = {"p++": "+", "++": "+", "p--": "-", "--": "-"}
_LOGICAL: Final = ("==", "!=", "<", ">", "<=", ">=", "&&", "||")


@dataclass(frozen=True)
class Rewritten:
    """A driver in another form."""

    text: str
    #: Line -> the lines in which something of it is now, besides it.
    moved: dict[int, frozenset[int]]

    def lines(self, accepted: frozenset[int]) -> frozenset[int]:
        """The accepted lines of this form."""
        return accepted.union(*(self.moved.get(line, frozenset()) for line in accepted))


def rewrite(name: str, text: str, form: str) -> Rewritten:
    """The text of the driver file `name` in a form.  Raises SourceError."""
    source = Source(name, text, load("robot"))
    FORMS[form](source)
    return Rewritten(source.edited, {line: frozenset(to) for line, to in source.moved.items()})


def compound(source: Source) -> None:
    """`x += e` and `x++` as `x = x + e`, and that as `x += e`."""
    for node in _effects(source):
        match node:
            case c_ast.UnaryOp(op=op, expr=target) if op in _STEPS and _twice(source, target):
                text = source.of(target)
                source.replace(node, f"{text} = {text} {_STEPS[op]} 1")
            case c_ast.Assignment(op=op, lvalue=target, rvalue=value) if op in _COMPOUND and _twice(source, target):
                text = source.of(target)
                source.replace(node, f"{text} = {text} {op[:-1]} {source.operand(value)}")
            case c_ast.Assignment(op="=", lvalue=target, rvalue=c_ast.BinaryOp(op=op, left=left, right=right)) if (
                f"{op}=" in _COMPOUND and source.of(left) == source.of(target) and _twice(source, target)
            ):
                source.replace(node, f"{source.of(target)} {op}= {source.of(right)}")


def _twice(source: Source, target: Any) -> bool:
    """Whether an lvalue designates the same object if it is said twice, and a read of it is a read of it all."""
    if source.is_register(target):
        return isinstance(target, c_ast.StructRef) and target.field.name == "all"
    return not any(
        source.reads_volatile(part.subscript) for part in nodes(target) if isinstance(part, c_ast.ArrayRef)
    ) and not any(isinstance(part, c_ast.FuncCall | c_ast.Assignment) for part in nodes(target))


def _effects(source: Source) -> list[Any]:
    """The expressions that are statements, or steps of a `for`."""
    found = []
    for function in source.functions:
        for node in nodes(function.body):
            found += [part for part in _parts(node) if isinstance(part, c_ast.Assignment | c_ast.UnaryOp)]
            if isinstance(node, c_ast.For) and isinstance(node.next, c_ast.Assignment | c_ast.UnaryOp):
                found.append(node.next)
    return found


def _parts(node: Any) -> list[Any]:
    """The statements that a statement consists of."""
    match node:
        case c_ast.Compound():
            return node.block_items or []
        case c_ast.If():
            return [part for part in (node.iftrue, node.iffalse) if part is not None]
        case c_ast.While() | c_ast.DoWhile() | c_ast.For() | c_ast.Label():
            return [node.stmt]
        case c_ast.Case() | c_ast.Default():
            return node.stmts or []
    return []


def temporary(source: Source) -> None:
    """The value of an assignment, of a condition and of a `return` is first that of a local."""
    for function in source.functions:
        declared = source.declared(function)
        for node in nodes(function.body):
            for part in _parts(node):
                match part:
                    case c_ast.Assignment(op="=", rvalue=value) if not isinstance(value, c_ast.Constant):
                        name = source.fresh("held")
                        declaration = source.target_type(part, name, declared)
                        if declaration is not None:
                            source.before(part, f"{{ {declaration} = {source.of(value)}; ")
                            source.replace(value, name)
                            source.after(part, " }")
                    case c_ast.If(cond=cond) if not isinstance(cond, c_ast.Assignment):  # `(x = 1)` says: on purpose
                        name = source.fresh("held")
                        source.before(part, f"{{ int {name} = {_truth(source, cond)}; ")
                        source.replace(cond, name)
                        source.after(part, " }")
                    case c_ast.Return(expr=value) if value is not None and not isinstance(value, c_ast.Constant):
                        name = source.fresh("held")
                        declaration = _result(function, name)
                        if declaration is not None:
                            source.before(part, f"{{ {declaration} = {source.of(value)}; ")
                            source.replace(value, f" {name}")
                            source.after(part, " }")
                if isinstance(part, c_ast.If):
                    source.move(part.cond, source.line(part, statement=True))
                elif isinstance(part, c_ast.Assignment | c_ast.Return):
                    source.move(part, source.line(part, statement=True), statement=True)


def _truth(source: Source, cond: Any) -> str:
    """A condition as an `int` of 0 or 1."""
    decides = isinstance(cond, c_ast.BinaryOp | c_ast.UnaryOp) and cond.op in (*_LOGICAL, "!")
    return source.of(cond) if decides else f"{source.operand(cond)} != 0"


def _result(function: Any, name: str) -> str | None:
    """The declaration of `name` with the type of the result of a function."""
    declaration = c_ast.Decl(name, [], [], [], [], function.decl.type.type, None, None)
    return value_declaration(declaration, name)


def helper_expression(source: Source) -> None:
    """The value of an assignment, a condition, an argument and a result is computed by a function of its own."""
    for function in source.functions:
        _Computed(source, function).visit(function.body)


class _Computed:
    """Expressions of one function become functions in front of it, with the locals that they read as parameters."""

    def __init__(self, source: Source, function: Any) -> None:
        self.source = source
        self.function = function
        self.declared = source.declared(function)

    def visit(self, node: Any) -> None:
        """Make functions of the expressions in a statement or an expression, outer ones first."""
        source = self.source
        done = None
        match node:
            case c_ast.Assignment(op="=", rvalue=value) if self.made(
                value, lambda name: source.target_type(node, name, self.declared), source.of(value)
            ):
                done = value
            case c_ast.If(cond=cond) | c_ast.While(cond=cond) | c_ast.DoWhile(cond=cond) if self.made(
                cond, lambda name: f"int {name}", _truth(source, cond)
            ):
                done = cond
            case c_ast.Return(expr=value) if value is not None and self.made(
                value, lambda name: _result(self.function, name), source.of(value), " "
            ):
                done = value
            case c_ast.FuncCall(args=c_ast.ExprList(exprs=arguments)) if (called := source.called(node)) is not None:
                for argument, ctype in zip_longest(arguments, called.ctype.parameters[: len(arguments)]):
                    if (
                        ctype is None
                        or isinstance(ctype, FunctionType)
                        or not self.made(argument, partial(declaration_of, ctype), source.of(argument))
                    ):
                        self.visit(argument)
                return
        for _, child in node.children():
            if child is not done:
                self.visit(child)

    def made(self, value: Any, typed: Callable[[str], str | None], text: str, space: str = "") -> bool:
        """Whether a function for an expression was made; `typed` declares its name with the type of its result."""
        if isinstance(value, c_ast.Assignment):  # `(x = 1)` says that it is on purpose
            return False
        given = self.parameters(value)
        told = isinstance(value, c_ast.ID) and value.name not in self.declared and text != self.source.of(value)
        if given is None or not (_computes(value) or told):
            return False
        name = self.source.fresh("found")
        declaration = typed(f"{name}({', '.join(given.values()) or 'void'})")
        if declaration is None:
            return False
        self.source.above(self.function, f"static {declaration} {{ return {text}; }} ")
        self.source.replace(value, f"{space}{name}({', '.join(given)})")
        self.source.move(value, self.source.line(self.function, statement=True))
        return True

    def parameters(self, value: Any) -> dict[str, str] | None:
        """The declaration of each local that an expression reads; None: it wants more of one than its value."""
        names = self.source.free(value, self.declared)
        for part in nodes(value):
            operand: Any = None
            match part:
                case c_ast.UnaryOp(op="++" | "--" | "p++" | "p--" | "&" | "sizeof", expr=operand):
                    pass
                case c_ast.Assignment(lvalue=operand):
                    pass
            if operand is not None and self.source.free(operand, self.declared):
                return None
        declarations = {}
        for name in names:
            declaration = self.declared[name]
            if declaration is None or "volatile" in declaration.quals:
                return None
            text = value_declaration(declaration, name, parameter=True)
            if text is None:
                return None
            declarations[name] = text
        return declarations


def _computes(value: Any) -> bool:
    """Whether a value is more than a number, a name or an address."""
    while isinstance(value, c_ast.UnaryOp) and value.op in ("-", "+", "~", "&"):
        value = value.expr
    return not isinstance(value, c_ast.Constant | c_ast.ID)


def helper_statement(source: Source) -> None:
    """The innermost blocks of `if` and loops become functions; of a loop that ends a function, its whole body."""
    for function in source.functions:
        helpers = _Blocks(source, function)
        last = (function.body.block_items or [None])[-1]
        if not (isinstance(last, c_ast.For | c_ast.While) and helpers.split(last.stmt)):
            helpers.visit(function.body)


class _Blocks:
    """Blocks of one function become functions: locals are passed as values, or as pointers if they are changed."""

    def __init__(self, source: Source, function: Any) -> None:
        self.source = source
        self.function = function
        self.declared = source.declared(function)

    def visit(self, node: Any) -> bool:
        """Make functions of the innermost blocks in a statement; whether there was one."""
        parts = [node.stmt] if isinstance(node, c_ast.Switch) else _parts(node)
        chosen = isinstance(node, c_ast.If | c_ast.While | c_ast.For | c_ast.DoWhile)
        made = [self.visit(part) or (chosen and self.made(part)) for part in parts]
        return any(made)

    def made(self, block: Any) -> bool:
        """Whether a function for a block was made in front of this one."""
        if not isinstance(block, c_ast.Compound) or not block.block_items or any(_leaves(block)):
            return False
        given = self.parameters(block)
        if given is None or any(isinstance(part, c_ast.Switch) for part in nodes(block)):
            return False
        source = self.source
        name = source.fresh("step")
        pointers = {local: f"(*{local})" for local, (_, argument) in given.items() if argument != local}
        source.above(self.function, f"{self.head(name, given)} {{ {source.within(block, pointers)} }} ")
        source.replace(block, f"{{ {self.call(name, given)} }}", statement=True)
        source.move(block, source.line(self.function, statement=True), statement=True)
        return True

    def split(self, block: Any) -> bool:
        """Whether the body of the loop that ends this function became a function, in its place."""
        left = list(_leaves(block))
        if not isinstance(block, c_ast.Compound) or any(not isinstance(part, c_ast.Continue) for part in left):
            return False
        given = self.parameters(block)
        if given is None:
            return False
        source = self.source
        name = source.fresh("step")
        source.above(self.function, f"{self.head(name, given)}; ")
        source.brace(block, f"{{ {self.call(name, given)} }} }} {self.head(name, given)} {{")
        for part in named(block):
            if part.name in given and given[part.name][1] != part.name:
                source.replace_name(part, f"(*{part.name})")
        for part in left:
            source.replace(part, "return;", statement=True)
        source.brace(self.function.body, "", closing=True)
        return True

    def head(self, name: str, given: Mapping[str, tuple[str, str]]) -> str:
        """The head of the function `name`."""
        return f"static void {name}({', '.join(declaration for declaration, _ in given.values()) or 'void'})"

    def call(self, name: str, given: Mapping[str, tuple[str, str]]) -> str:
        """The call of the function `name`."""
        return f"{name}({', '.join(argument for _, argument in given.values())});"

    def parameters(self, block: Any) -> dict[str, tuple[str, str]] | None:
        """Local -> the declaration of its parameter and the argument; None: a local cannot be passed."""
        changed = set()
        for part in nodes(block):
            match part:
                case c_ast.UnaryOp(op="++" | "--" | "p++" | "p--" | "&", expr=target) | c_ast.Assignment(lvalue=target):
                    while isinstance(target, c_ast.ArrayRef) or (
                        isinstance(target, c_ast.StructRef) and target.type == "."
                    ):
                        target = target.name
                    changed.update([target.name] if isinstance(target, c_ast.ID) else [])
        given = {}
        for local in self.source.free(block, self.declared):
            declaration = self.declared[local]
            if declaration is None or "volatile" in declaration.quals:
                return None
            array = isinstance(declaration.type, c_ast.ArrayDecl)
            pointer = local in changed and not array
            text = value_declaration(declaration, f"*{local}" if pointer else local, parameter=True)
            if text is None:
                return None
            given[local] = text, f"&{local}" if pointer else local
        return given


def _leaves(node: Any) -> Iterator[Any]:
    """The jumps out of a statement."""
    match node:
        case c_ast.Return() | c_ast.Goto() | c_ast.Label() | c_ast.Break() | c_ast.Continue():
            yield node
        case c_ast.While() | c_ast.For() | c_ast.DoWhile():
            yield from (part for part in _leaves(node.stmt) if not isinstance(part, c_ast.Break | c_ast.Continue))
        case c_ast.Switch():
            yield from (part for part in _leaves(node.stmt) if not isinstance(part, c_ast.Break))
        case _:
            for part in _parts(node):
                yield from _leaves(part)


def inverted(source: Source) -> None:
    """`if` and `?:` with the opposite condition; an `if` at the end of a function or a loop leaves it early."""
    for function in source.functions:
        early = {}
        if source.of(function.decl.type.type) == "void" and function.decl.name != "main":
            early[_last(function.body)] = "return"
        for node in nodes(function.body):
            if isinstance(node, c_ast.While | c_ast.For):
                early[_last(node.stmt)] = "continue"
        _invert(source, function.body, early)


def _invert(source: Source, node: Any, early: Mapping[Any, str]) -> None:
    match node:
        case c_ast.TernaryOp(cond=cond, iftrue=then, iffalse=otherwise):
            _negate(source, cond)
            one, other = source.of(then), source.of(otherwise)
            source.replace(then, f"({other})" if isinstance(otherwise, c_ast.TernaryOp) else other)
            source.replace(otherwise, f"({one})" if isinstance(then, c_ast.ExprList | c_ast.Assignment) else one)
            return
        case c_ast.If(cond=cond, iftrue=then, iffalse=None) if node in early:
            _negate(source, cond)
            source.before(then, f"{early[node]}; ")
        case c_ast.If(cond=cond, iftrue=then, iffalse=otherwise) if otherwise is not None and not any(
            isinstance(part, c_ast.Switch) for part in nodes(node)
        ):
            _negate(source, cond)
            one, other = _block(source, then), _block(source, otherwise)
            source.replace(then, other, statement=True)
            source.replace(otherwise, one, statement=True)
            source.move(then, source.line(otherwise, statement=True), statement=True)
            source.move(otherwise, source.line(then, statement=True), statement=True)
            return
    for _, child in node.children():
        _invert(source, child, early)


def _last(block: Any) -> Any:
    """The last statement of a block."""
    return (block.block_items or [None])[-1] if isinstance(block, c_ast.Compound) else None


def _block(source: Source, statement: Any) -> str:
    """The text of a statement as a block."""
    text = source.of(statement, statement=True)
    return text if isinstance(statement, c_ast.Compound) else f"{{ {text} }}"


def _negate(source: Source, cond: Any) -> None:
    """Replace a condition by its opposite."""
    match cond:
        case c_ast.UnaryOp(op="!", expr=operand):
            source.replace(cond, source.of(operand))
        case c_ast.BinaryOp(op="==" | "!=" as op, left=left, right=right):
            source.replace(cond, f"{source.of(left)} {'!=' if op == '==' else '=='} {source.of(right)}")
        case _:
            source.replace(cond, f"!{source.operand(cond)}")


_TURNED: Final = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}


def turned(source: Source) -> None:
    """`a < b` as `b > a`; `x == 0` as `!x`, and that as `x == 0`."""
    for function in source.functions:
        _turn(source, function.body)


def _turn(source: Source, node: Any) -> None:
    match node:
        case c_ast.BinaryOp(op="==", left=left, right=c_ast.Constant(value="0" | "0u" | "0U")):
            source.replace(node, f"!{source.operand(left)}")
            return
        case c_ast.UnaryOp(op="!", expr=operand):
            source.replace(node, f"{source.operand(operand)} == 0")
            return
        case c_ast.BinaryOp(op=op, left=left, right=right) if op in _TURNED and not (
            source.reads_volatile(left) and source.reads_volatile(right)
        ):
            source.replace(node, f"{source.operand(right)} {_TURNED[op]} {source.operand(left)}")
            return
    for _, child in node.children():
        _turn(source, child)


def loops(source: Source) -> None:
    """`for` as `while`, that as `for`, and `switch` as a chain of `if`."""
    for function in source.functions:
        declared = source.declared(function)
        for node in nodes(function.body):
            match node:
                case c_ast.For() if node.next is None or not _continues(node.stmt):
                    _as_while(source, node)
                case c_ast.While():
                    source.header(node, f"for (; {source.of(node.cond)}; )")
                case c_ast.Switch(stmt=c_ast.Compound(block_items=list(items))) if _separate(items):
                    _as_chain(source, node, declared)


def _continues(body: Any) -> bool:
    """Whether the body of a loop has a `continue` of that loop."""
    return any(isinstance(part, c_ast.Continue) for part in _leaves(body))


def _as_while(source: Source, node: Any) -> None:
    first = node.init
    begin = (
        ""
        if first is None
        else source.of(first, statement=True)
        if isinstance(first, c_ast.DeclList)
        else (f"{source.of(first)};")
    )
    source.header(node, f"{{ {begin} while ({'1' if node.cond is None else source.of(node.cond)}) {{")
    source.after(node, f" {source.of(node.next) + '; ' if node.next is not None else ''}}} }}")


def _separate(items: list[Any]) -> bool:
    """Whether the cases of a switch are separate: each ends in a jump, none breaks before, a default is the last."""
    for number, item in enumerate(items):
        last = number == len(items) - 1
        if not isinstance(item, c_ast.Case | c_ast.Default) or (isinstance(item, c_ast.Default) and not last):
            return False
        body = item.stmts or []
        if not body:
            if last:
                return False
            continue
        breaks = [part for part in _leaves(item) if isinstance(part, c_ast.Break)]
        ends = isinstance(body[-1], c_ast.Break | c_ast.Return | c_ast.Continue)
        if breaks != [part for part in body[-1:] if isinstance(part, c_ast.Break)] or not (ends or last):
            return False
        if any(isinstance(part, c_ast.Decl) for part in body):
            return False
    return True


def _as_chain(source: Source, node: Any, declared: dict[str, Any]) -> None:
    name = source.fresh("chosen")
    declaration = source.subject_type(node, name, declared)
    if declaration is None:
        return
    source.header(node, f"{{ {declaration} = {source.of(node.cond)};")
    source.brace(node.stmt, "")
    word, values = "if", []
    for item in node.stmt.block_items:
        if isinstance(item, c_ast.Case):
            values.append(f"{name} == {source.operand(item.expr)}")
        if not item.stmts:
            source.label(item, "")
            continue
        test = f"{word} ({' || '.join(values)}) {{" if isinstance(item, c_ast.Case) else "else {"
        source.label(item, test)
        word, values = "else if", []
        if isinstance(item.stmts[-1], c_ast.Break):
            source.replace(item.stmts[-1], "}", statement=True)
        else:
            source.after(item.stmts[-1], " }")


def member(source: Source) -> None:
    """Objects that are declared one after the other are members of one structure."""
    for name, objects in _structures(source):
        _join(source, "", name, objects)
        for function in source.functions:
            for part in named(function.body):
                if part.name in objects:
                    source.replace_name(part, f"{name}.{part.name}")


def _join(source: Source, tag: str, name: str, objects: Mapping[str, Any]) -> None:
    """Make objects the members of a structure, where they stand."""
    declarations = list(objects.values())
    static = "static " * ("static" in declarations[0].storage)
    source.before(declarations[0], f"{static}struct {tag}{{ ")
    done = set()
    for declaration in declarations:
        line = source.span(declaration, statement=True)
        if static and line not in done:
            source.remove_word(declaration, "static")
        done.add(line)
        if declaration.init is not None:
            source.remove_initialiser(declaration)
    values = ", ".join(source.of(each.init) for each in declarations if each.init is not None)
    source.after(declarations[-1], f" }} {name}{f' = {{ {values} }}' * bool(values)};")


def _structures(source: Source) -> list[tuple[str, dict[str, Any]]]:
    """Names of structures, and the declarations of their members: neighbours of which all or none have a value."""
    settled = source.settled()
    runs: list[dict[str, Any]] = []
    kind: tuple[bool, bool] | None = None
    for node in source.tree.ext:
        here = None
        if (
            isinstance(node, c_ast.Decl)
            and node.name in source.objects
            and node.name not in settled
            and not ("const" in node.quals or (isinstance(node.type, c_ast.ArrayDecl) and node.type.dim is None))
        ):
            here = "static" in node.storage, node.init is not None
        if here is not None and here != kind:
            runs.append({})
        if here is not None:
            runs[-1][node.name] = node
        kind = here
    return [(source.fresh("own"), run) for run in runs if len(run) > 1]


def handle(source: Source) -> None:
    """As `member`; functions that only calls name get a pointer to the structure."""
    settled = source.settled()
    inside = [part for function in source.functions for part in nodes(function.body)]
    called = {part.name for part in inside if isinstance(part, c_ast.FuncCall) and isinstance(part.name, c_ast.ID)}
    fixed = settled | {part.name for part in inside if isinstance(part, c_ast.ID) and part not in called}
    taken: defaultdict[str, dict[str, str]] = defaultdict(dict)
    for name, objects in _structures(source):
        _join(source, f"{name.capitalize()} ", name, objects)
        pointer = source.fresh("its")
        for function in source.functions:
            own = function.decl.name
            uses = [part for part in named(function.body) if part.name in objects]
            if uses and "static" in function.decl.storage and own not in fixed:
                taken[own][name] = pointer
            for part in uses:
                source.replace_name(
                    part, f"{taken[own][name]}->{part.name}" if name in taken[own] else f"{name}.{part.name}"
                )
    for function in source.functions:
        own = function.decl.name
        if taken[own]:
            parameters = (f"struct {name.capitalize()} *{pointer}" for name, pointer in taken[own].items())
            source.add_first(source.opening(function), ", ".join(parameters))
        for part in named(function.body):
            if part in called and taken[part.name]:
                arguments = (taken[own].get(name, f"&{name}") for name in taken[part.name])
                source.add_first(source.opening(part), ", ".join(arguments))


def accessor(source: Source) -> None:
    """Scalars of the file are read through `Get_x()` and written through `Set_x(value)`."""
    settled = source.settled()
    bodies = [function.body for function in source.functions]
    for body in bodies:
        settled |= {
            part.name for node in nodes(body) if isinstance(node, c_ast.UnaryOp) and node.op in ("&", "sizeof")
            for part in named(node)
        }  # fmt: skip
    assigned = [node for node in _effects(source) if isinstance(node, c_ast.Assignment) and node.op == "="]
    for name, declaration in source.objects.items():
        value = value_declaration(declaration, f"Get_{name}(void)")
        symbol = source.symbol(name)
        if (
            name in settled
            or value is None
            or "const" in declaration.quals
            or not (isinstance(symbol, Variable) and isinstance(symbol.ctype, IntType | FloatType | PointerType))
        ):
            continue
        written = {node.lvalue for node in assigned if isinstance(node.lvalue, c_ast.ID) and node.lvalue.name == name}
        others = {
            target for body in bodies for node in nodes(body)
            if (target := _changed(node)) is not None and target not in written
        }  # fmt: skip
        read = [
            part for body in bodies for part in named(body)
            if part.name == name and part not in written and part not in others
        ]  # fmt: skip
        for part in read:
            source.replace_name(part, f"Get_{name}()")
        for node in assigned:
            if node.lvalue in written:
                source.replace_target(node, f"Set_{name}(")
                source.after(node.rvalue, ")", statement=False)
        text = f" static {value} {{ return {name}; }}" if read else ""
        if written:
            text += f" static void Set_{name}({value_declaration(declaration, 'value')}) {{ {name} = value; }}"
        source.after(declaration, text)


def _changed(node: Any) -> Any:
    """What a node assigns to, counts up or down; None: nothing."""
    match node:
        case c_ast.Assignment(lvalue=target) | c_ast.UnaryOp(op="++" | "--" | "p++" | "p--", expr=target):
            return target
    return None


def mask(source: Source) -> None:
    """Fields of registers as bits of the whole register, where all of it can be written back."""
    for function in source.functions:
        for node in nodes(function.body):
            for part in _parts(node):
                if isinstance(part, c_ast.Assignment) and part.op == "=" and (found := source.field(part.lvalue)):
                    whole, field = found
                    if field.plain:
                        source.replace(part, _masked(source, part.rvalue, whole, field))
            tests = [node.cond] if isinstance(node, c_ast.If | c_ast.While | c_ast.DoWhile) else []
            if isinstance(node, c_ast.BinaryOp) and node.op in ("&&", "||"):
                tests = [node.left, node.right]
            if isinstance(node, c_ast.UnaryOp) and node.op == "!":
                tests = [node.expr]
            for test in tests:
                if found := source.field(test):
                    whole, field = found
                    source.replace(test, f"({whole} & {field.number(field.mask)})")
            if isinstance(node, c_ast.BinaryOp) and node.op in ("==", "!=") and (found := source.field(node.left)):
                whole, field = found
                shifted = f"({whole} >> {field.lo})" if field.lo else whole
                source.replace(node.left, f"({shifted} & {field.number(field.mask >> field.lo)})")


def _masked(source: Source, value: Any, whole: str, field: FieldOf) -> str:
    """The assignment of a value to a field, as one to the whole register."""
    others = f"{whole} = ({whole} & ~{field.number(field.mask)})"
    text = source.of(value)
    if not (isinstance(value, c_ast.Constant) and text.rstrip("uUlL").isdigit()):
        shift = f" << {field.lo}" * bool(field.lo)
        word = "Uint32" if field.wide else "Uint16"
        return f"{others} | ((({word}){source.operand(value)}{shift}) & {field.number(field.mask)})"
    number = int(text.rstrip("uUlL")) << field.lo & field.mask
    if number in (0, field.mask):
        return f"{whole} |= {field.number(number)}" if number else f"{whole} &= ~{field.number(field.mask)}"
    return f"{others} | {field.number(number)}"


def expanded(source: Source) -> None:
    """The driver's macros are the numbers that they stand for."""
    texts: dict[str, str] = {}
    for _, word, *rest in source.directives:
        if word.text == "define" and len(rest) > 1 and (rest[1].text != "(" or rest[1].space):
            tokens = [copy.copy(token) for token in rest[1:]]
            for token in tokens:
                token.text = texts.get(token.text, token.text)
            text = spelled(tokens)
            texts[rest[0].text] = text if len(tokens) == 1 else f"({text})"
    source.expand(texts)


def constants(source: Source) -> None:
    """Numbers in functions are named: an `enum` for an `int`, a `static const` for others."""
    for function in source.functions:
        names: dict[str, str] = {}
        fixed = {
            part
            for node in nodes(function.body)
            if isinstance(node, c_ast.Case | c_ast.Decl)
            for part in nodes(node)
            if isinstance(node, c_ast.Decl) or part is node.expr
        }
        for node in nodes(function.body):
            if not isinstance(node, c_ast.Constant) or "int" not in node.type or node in fixed:
                continue
            number, unsigned = int(node.value.rstrip("uUlL"), 0), "u" in node.value.lower()
            if number < 2 or "l" in node.value.lower():
                continue
            if node.value not in names:
                name = names[node.value] = source.fresh("NUMBER_")
                if number > 0x7FFF and not unsigned and not node.value.lower().startswith("0x"):
                    text = f"static const long {name} = {node.value};"
                elif number > 0xFFFF:
                    text = f"static const {'unsigned ' * unsigned}long {name} = {node.value};"
                elif number > 0x7FFF or unsigned:
                    text = f"static const unsigned int {name} = {node.value};"
                else:
                    text = f"enum {{ {name} = {node.value} }};"
                source.above(function, f"{text} ")
            source.replace(node, names[node.value])


FORMS: Final[dict[str, Callable[[Source], None]]] = {
    "compound": compound, "temporary": temporary, "helper-expression": helper_expression,
    "helper-statement": helper_statement, "inverted": inverted, "turned": turned, "loops": loops, "member": member,
    "handle": handle, "accessor": accessor, "mask": mask, "expanded": expanded, "constants": constants,
}  # fmt: skip


def found_in(driver: Driver, damage: Damage, forms: Sequence[str]) -> dict[str, str | None]:
    """For each form that changes the damaged driver: None if it finds the damage, else what it tells instead.

    Empty if the damage is not found as it is written.
    """
    text = damage.of(driver.text)
    lines = damage.lines(text)
    plain = _found(driver, text, lines)
    if plain.at(lines) != "found":
        return {}
    rules = sorted({rule for line, rule, _ in plain.told if line in lines})
    found: dict[str, str | None] = {}
    for form in forms:
        other = rewrite(driver.file.name, text, form)
        if other.text != text:
            result = _found(driver, other.text, other.lines(lines))
            how = result.at(other.lines(lines))
            told = ", ".join(f"{line} {rule}" for line, rule, _ in result.told[:4])
            found[form] = None if how == "found" else f"{how}, was {', '.join(rules)}; told: {told or 'nothing'}"
    return found


def _found(driver: Driver, text: str, lines: frozenset[int]) -> Result:
    """The findings of the source if one is at these lines, which is quick; else those of the whole check."""
    quick = check(driver, text, run=False)
    return quick if quick.at(lines) == "found" else check(driver, text)


def false_alarms(driver: Driver, forms: Sequence[str]) -> dict[str, str]:
    """For each form of a correct driver, what is told of it."""
    found = {}
    for form in forms:
        told = check(driver, rewrite(driver.file.name, driver.text, form).text).told
        found[form] = "; ".join(f"{line} {rule}: {message}" for line, rule, message in told)
    return found
