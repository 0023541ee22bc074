"""Statements of C: the reader passes each to the builder.

A `goto` forward out of blocks, loops and switches ends the statements before its label.  One backward repeats those
behind its label.  Any other is an error: into a block, or into the middle of what another one repeats.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, Final, Protocol

from pycparser import c_ast

from emulator.c28x import build
from emulator.c28x.build import Builder
from emulator.c28x.ctypes import VOID, ArrayType, IntType, StructType, promote
from emulator.c28x.readers.c.expressions import CExpressionReader
from emulator.c28x.readers.c.grammar import Parenthesised
from emulator.c28x.readers.c.outside_body import outside_bodies
from emulator.c28x.readers.c.written import written
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    Break,
    Continue,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    Jump,
    LeaveSwitch,
    LValue,
    Return,
    Stmt,
    Variable,
    Where,
)  # fmt: skip
from emulator.c28x.tree_queries import leaves, parts

#: The texts of a comment about a case that falls through, as compilers and people write them.
_FALLS: Final = re.compile(r"(?i)(//|/\*).*(fall|thro?ugh|no\W*break|drops|goes on|next case)")
_STEPS: Final = {"p++": 1, "++": 1, "p--": -1, "--": -1}


class Locals(Protocol):
    """Reads the declarations of a block: objects, types, functions."""

    def local(self, node: c_ast.Node) -> None:
        """Read a declaration within a function."""


@dataclass
class _Around:
    """What surrounds a statement: a "loop" or a "switch", or what a `goto` ends ("block") or repeats ("again").

    `label` is its name for `Jump`: that of the label, or one that is made for a switch when it is needed.  `again` is
    `crossed` if a `goto` that repeats it comes from within a loop in it.
    """

    kind: str
    label: str = ""
    crossed: bool = False


@dataclass
class _Region:
    """The statements of a block, from number `first` to before `end`, that a `goto` ends ("block") or repeats."""

    kind: str
    label: str
    first: int
    end: int
    where: Where


class CStatementReader:
    """Reads the body of one function."""

    def __init__(self, b: Builder, expressions: CExpressionReader, declarations: Locals) -> None:
        self.b = b
        self.expressions = expressions
        self.declarations = declarations
        #: What a `break`, `continue` or `goto` ends or repeats, innermost last.
        self.around: list[_Around] = []
        #: The labels of the function -> their places.
        self.labels: dict[str, Where] = {}
        self._switches = 0

    def statement(self, node: c_ast.Node | None) -> None:
        """Read one statement."""
        b = self.b
        if node is None:
            return
        where: Where = node.coord
        match node:
            case c_ast.EmptyStatement() | c_ast.Pragma():
                pass
            case c_ast.Compound():
                with b.block(where) as statements:
                    self.statements(node.block_items)
                b.out.extend(statements)
            case c_ast.Decl() | c_ast.Typedef():
                self.declarations.local(node)
            case c_ast.DeclList():
                self.statements(node.decls)
            case c_ast.If():
                self.if_(node)
            case c_ast.While():
                build.loop(b, lambda: self.test(node.cond), self.body(node.stmt, "loop"), None, where)
            case c_ast.DoWhile():
                build.do_while(b, self.body(node.stmt, "loop"), lambda: self.test(node.cond), where)
            case c_ast.For():
                self.for_(node)
            case c_ast.Switch():
                self.switch(node)
            case c_ast.Return():
                self.return_(node)
            case c_ast.Break():
                self.break_(where)
            case c_ast.Continue():
                if not any(around.kind == "loop" for around in self.around):
                    raise SourceError.at(where, "continue is outside of a loop")
                self.inside(where, "continue", "loop")
                b.emit(Continue(where))
            case c_ast.Goto():
                self.goto(node)
            case c_ast.Label():
                self.statements([node])
            case c_ast.Case() | c_ast.Default():
                word = "case" if isinstance(node, c_ast.Case) else "default"
                raise SourceError.at(where, f"{word} is outside of a switch, or in a block within one: not modelled")
            case c_ast.StaticAssert():
                self.static_assert(node)
            case _:
                self.expression(node)

    def statements(self, items: list[c_ast.Node] | None) -> None:
        """Read statements in order."""
        if self.labels and any(isinstance(item, c_ast.Label) for item in items or ()):
            self.with_labels(items or [])
            return
        for item in items or ():
            self.statement(item)

    # Jumps

    def function(self, items: list[c_ast.Node] | None) -> None:
        """Read the body of the function."""
        for node in _within(items or ()):
            if isinstance(node, c_ast.Label):
                if node.name in self.labels:
                    raise SourceError.at(node.coord, f"the label {node.name} is here twice in one function")
                self.labels[node.name] = node.coord
        for found in outside_bodies(items):
            self.b.remark(found.where, "outside-body", found.message, found.keyword)
        self.statements(items)

    def break_(self, where: Where) -> None:
        """`break` of a loop, or of a switch."""
        around = next((each for each in reversed(self.around) if each.kind in ("loop", "switch")), None)
        if around is None:
            raise SourceError.at(where, "break is outside of a loop or a switch")
        self.inside(where, "break", "loop", "switch")
        if around.kind == "loop":
            self.b.emit(Break(where))
        elif around is self.around[-1]:
            self.b.emit(LeaveSwitch(where))
        else:
            if not around.label:
                self._switches += 1
                around.label = f"switch {self._switches}"
            self.b.emit(Jump(where, label=around.label))

    def inside(self, where: Where, word: str, *kinds: str) -> None:
        """Raises SourceError for a `break` or `continue` that leaves what a `goto` repeats."""
        for around in reversed(self.around):
            if around.kind in kinds:
                return
            if around.kind == "again":
                label = around.label
                message = f"{word} leaves the statements that goto {label} repeats: not modelled, write a loop for them"
                raise SourceError.at(where, message)

    def goto(self, node: c_ast.Goto) -> None:
        """`goto`: to the end of statements around it, or to the beginning of some."""
        name, where = node.name, node.coord
        crosses = False
        for around in reversed(self.around):
            if around.label == name and around.kind == "block":
                self.b.emit(Jump(where, label=name))
                return
            if around.label == name and around.kind == "again":
                around.crossed |= crosses
                self.b.emit(Jump(where, label=_again(name)) if crosses else Continue(where))
                return
            crosses |= around.kind in ("loop", "again")
        if name not in self.labels:
            raise SourceError.at(where, f"goto {name}: the function has no such label")
        message = f"goto {name} leads into a block, or into the middle of what another goto repeats: not modelled"
        raise SourceError.at(where, f"{message}, write a loop, a function or an if")

    def with_labels(self, items: list[c_ast.Node]) -> None:
        """Read the statements of a block with labels."""
        parts: list[c_ast.Node] = []
        at: dict[str, int] = {}
        for item in items:
            inner = item
            while isinstance(inner, c_ast.Label):
                at[inner.name] = len(parts)
                inner = inner.stmt
            if inner is not None:
                parts.append(inner)
        regions: list[_Region] = []
        used = [{each.name for each in _within([part]) if isinstance(each, c_ast.Goto)} for part in parts]
        for name, place in at.items():
            where = self.labels[name]
            by = [number for number, names in enumerate(used) if name in names]
            if by and by[0] < place:
                regions.append(_Region("block", name, by[0], place, where))
            if by and by[-1] >= place:
                regions.append(_Region("again", name, place, by[-1] + 1, where))
        _nest(regions)
        self.parts(parts, 0, len(parts), regions)

    def parts(self, parts: list[c_ast.Node], first: int, end: int, regions: list[_Region]) -> None:
        """Read some statements of a block; `regions` are those among them, the outer ones first."""
        while first < end:
            region = next((each for each in regions if each.first == first and each.end <= end), None)
            if region is None:
                self.statement(parts[first])
                first += 1
                continue
            rest = regions[regions.index(region) + 1 :]
            where = parts[first].coord if region.kind == "block" else region.where
            around = _Around(region.kind, region.label)
            self.around.append(around)
            with self.b.region(where, 1 if region.kind == "block" else 2) as body:
                self.parts(parts, region.first, region.end, rest)
            self.around.pop()
            if region.kind == "block":
                build.before_label(self.b, body, region.label, where)
            else:
                build.from_label(self.b, body, _again(region.label) if around.crossed else "", where)
            first = region.end

    def expression(self, node: c_ast.Node) -> None:
        """An expression statement; a call becomes a statement directly."""
        b = self.b
        if isinstance(node, c_ast.FuncCall) and not (isinstance(node.name, c_ast.ID) and node.name.name == "__asm"):
            value = self.expressions.value(node)
            if any(part is value and type(value).__name__ in ("Call", "CallPointer") for part in parts(value)):
                b.emit(Evaluate(node.coord, value))
            else:
                build.evaluate(b, value)
            return
        self.expressions.effect(node)

    def static_assert(self, node: c_ast.StaticAssert) -> None:
        """`_Static_assert`."""
        if not self.expressions.types.number(node.cond, "what is asserted"):
            message = node.message.value if node.message is not None else "it is 0"
            raise SourceError.at(node.coord, f"the static assertion fails: {message}")

    # Blocks

    def body(self, node: c_ast.Node | None, kind: str) -> Callable[[], None]:
        """A function that reads the body of a loop; the builder calls it within a block that the builder opens."""

        def read() -> None:
            self.around.append(_Around(kind))
            if isinstance(node, c_ast.Compound):
                self.statements(node.block_items)
            else:
                self.statement(node)
            self.around.pop()

        return read

    def branch(self, node: c_ast.Node | None) -> Callable[[], None]:
        """A function that reads a branch of an `if` as a block, with braces or without."""

        def read() -> None:
            if node is None:
                return
            with self.b.block(node.coord) as statements:
                if isinstance(node, c_ast.Compound):
                    self.statements(node.block_items)
                else:
                    self.statement(node)
            self.b.out.extend(statements)

        return read

    def if_(self, node: c_ast.If) -> None:
        """`if`; an `else if` does not open a block."""
        links: list[build.IfBranch] = []
        last: c_ast.Node | None = node
        while isinstance(last, c_ast.If):
            test = partial(self.test, last.cond, last.iftrue, last.iffalse)
            links.append(build.IfBranch(last.coord, test, self.branch(last.iftrue)))
            last = last.iffalse
        build.chain(self.b, links, self.branch(last) if last is not None else None)

    def test(self, node: c_ast.Node, *branches: c_ast.Node | None) -> Expr:
        """A controlling expression; `branches` are those of an `if`.  Raises SourceError for a structure or void."""
        value = self.expressions.value(node)
        if isinstance(value.ctype, StructType):
            raise SourceError.at(node.coord, f"a structure ({value.ctype}) is not a condition")
        if value.ctype == VOID:
            raise SourceError.at(node.coord, f"'{written(node)}' is void: it is not a condition")
        if not isinstance(node, c_ast.Assignment):
            self.expressions.tell_odd_condition(node)
        elif node.op == "=" and self.compares(node, branches):
            self.expressions.tell_assigned(node)
        return value

    def compares(self, node: c_ast.Assignment, branches: tuple[c_ast.Node | None, ...]) -> bool:
        """Whether an assignment as a condition was meant as a comparison.

        An assignment of a constant always was.  One of another value was if it is in an `if`, has no parentheses of its
        own, and a branch copies the target back (`if (now = seen) seen = now;`) or none uses it.  An `else` that reads
        it does not use it: it is 0 there.  A local that gets the result of a function may be used later: it was not.
        """
        if self.expressions.assigns_constant(node):
            return True
        if not branches or isinstance(node, Parenthesised):
            return False
        target = self.b.look_up(node.lvalue.name) if isinstance(node.lvalue, c_ast.ID) else None
        if isinstance(node.rvalue, c_ast.FuncCall) and isinstance(target, Variable) and target.kind != "global":
            return False
        if any(_copies_back(node, branch) for branch in branches):
            return True
        text = written(node.lvalue)
        return not (_contains_text(text, branches[0]) or any(_assigns(text, branch) for branch in branches[1:]))

    # Loops

    def for_(self, node: c_ast.For) -> None:
        """`for`: a counting loop from a start to a limit, or a general loop."""
        b, where = self.b, node.coord
        if isinstance(node.init, c_ast.DeclList):
            with b.block(where) as statements:
                counted = self.counted(node)
                if counted is None:
                    self.statements(node.init.decls)
                    self.general(node)
                else:
                    declaration = node.init.decls[0]
                    start = declaration.init
                    declaration.init = None
                    self.declarations.local(declaration)
                    declaration.init = start
                    self.range(node, declaration.name, start, *counted)
            b.out.extend(statements)
            return
        counted = self.counted(node)
        if counted is not None:
            self.range(node, node.init.lvalue.name, node.init.rvalue, *counted)
            return
        if node.init is not None:
            self.expressions.effect(node.init)
        self.general(node)

    def general(self, node: c_ast.For) -> None:
        """A general `for`, after its initialisation."""
        test = (lambda: self.test(node.cond)) if node.cond is not None else None
        step = (lambda: self.expressions.effect(node.next)) if node.next is not None else None
        build.loop(self.b, test, self.body(node.stmt, "loop"), step, node.coord)

    def counted(self, node: c_ast.For) -> tuple[c_ast.Node, int] | None:
        """Limit and step of a counting `for (i = a; i < n; i++)`, or with `>` and a step down; None for any other."""
        match node.init:
            case c_ast.Assignment(op="=", lvalue=c_ast.ID(name=name)):
                symbol = self.b.look_up(name)
                ctype = symbol.ctype if isinstance(symbol, Variable) else None
            case c_ast.DeclList(decls=[c_ast.Decl(name=name, init=start, storage=[]) as declared]):
                if start is None or not isinstance(declared.type, c_ast.TypeDecl) or isinstance(start, c_ast.InitList):
                    return None
                ctype = self.expressions.types.ctype(declared.type)
            case _:
                return None
        if not isinstance(ctype, IntType):
            return None
        match node.next:
            case c_ast.UnaryOp(op=op, expr=c_ast.ID(name=stepped)) if op in _STEPS and stepped == name:
                step: int | float | None = _STEPS[op]
            case c_ast.Assignment(op="+=" | "-=" as op, lvalue=c_ast.ID(name=stepped), rvalue=by) if stepped == name:
                step = self.number(by)
                step = -step if step is not None and op == "-=" else step
            case c_ast.Assignment(
                op="=", lvalue=c_ast.ID(name=stepped),
                rvalue=c_ast.BinaryOp(op="+" | "-" as op, left=c_ast.ID(name=counter), right=by),
            ) if stepped == name == counter:  # fmt: skip
                step = self.number(by)
                step = -step if step is not None and op == "-" else step
            case _:
                return None
        match node.cond:
            case c_ast.BinaryOp(op="<" | ">" as op, left=c_ast.ID(name=tested), right=limit) if tested == name:
                pass
            case _:
                return None
        if not isinstance(step, int) or not step or (op == "<") != (step > 0) or _mentions(limit, name):
            return None
        if _declares(limit):
            return None
        effects, stop = self.b.collect_effects(lambda: self.expressions.value(limit))
        return (limit, step) if not effects and isinstance(stop.ctype, IntType) else None

    def number(self, node: c_ast.Node) -> int | None:
        """The value of a constant step; None if it is not a constant."""
        if not isinstance(node, c_ast.Constant):
            return None
        value = build.constant_value(self.expressions.value(node))
        return value if isinstance(value, int) else None

    def range(self, node: c_ast.For, name: str, start: c_ast.Node, limit: c_ast.Node, step: int) -> None:
        """A counting `for`."""
        b = self.b
        symbol = b.look_up(name)
        assert isinstance(symbol, Variable)
        first = self.expressions.value(start)
        stop = self.expressions.value(limit)
        counter = build.object_place(symbol, node.init.coord)
        build.for_range(b, counter, first, stop, step, self.body(node.stmt, "loop"), node.coord)

    # Switch

    def switch(self, node: c_ast.Switch) -> None:
        """`switch`: its cases may end, fall through, or be left from within."""
        b, where = self.b, node.coord
        subject = self.expressions.value(node.cond)
        if not isinstance(subject.ctype, IntType):
            raise SourceError.at(node.cond.coord, f"switch needs an integer, not a {subject.ctype}")
        items = node.stmt.block_items or [] if isinstance(node.stmt, c_ast.Compound) else [node.stmt]
        around = _Around("switch")
        self.around.append(around)
        with b.block(where, loop=True) as before:
            while items and not isinstance(items[0], c_ast.Case | c_ast.Default):
                if not isinstance(items[0], c_ast.Decl) or items[0].init is not None:
                    raise SourceError.at(items[0].coord, "statements before the first case of a switch never run")
                self.statement(items[0])
                items = items[1:]
            cases = self.cases(items, subject)
        self.around.pop()
        b.out.extend(before)
        build.switch(b, subject, cases, where, self.named(items), self.expressions.types.enumerations, around.label)

    def cases(self, items: list[Any], subject: Expr) -> list[tuple[list[int] | None, list[Stmt]]]:
        """Labels and bodies, in order.  Adjacent labels share a body."""
        assert isinstance(subject.ctype, IntType)
        ctype = promote(subject.ctype)
        groups: list[tuple[list[int] | None, list[Any], Where]] = []
        seen: set[int] = set()
        labels: list[int] | None = []
        defaults = 0
        for item in items:
            if isinstance(item, c_ast.Case):
                value = build.constant_value(self.expressions.constant_expression(item.expr))
                if not isinstance(value, int):
                    raise SourceError.at(item.expr.coord, f"'{written(item.expr)}' is not an integer constant")
                value = ctype.wrap(value)
                if value in seen:
                    raise SourceError.at(item.expr.coord, f"case {value} occurs twice in this switch")
                seen.add(value)
                labels = labels if labels is None else [*labels, value]
            elif isinstance(item, c_ast.Default):
                defaults += 1
                if defaults > 1:
                    raise SourceError.at(item.coord, "default occurs twice in this switch")
                labels = None
            else:
                if not groups:
                    raise SourceError.at(item.coord, "statements before the first case of a switch never run")
                groups[-1][1].append(item)
                continue
            if item.stmts:
                groups.append((labels, list(item.stmts), item.coord))
                labels = []
        if labels is None or labels:  # labels at the very end have an empty body
            groups.append((labels, [], items[-1].coord))
        behind = [where for _, _, where in groups[1:]]
        return [self.case(*group, behind=next_) for group, next_ in zip(groups, [*behind, None], strict=True)]

    def case(
        self, labels: list[int] | None, statements: list[Any], where: Where, *, behind: Where | None
    ) -> tuple[list[int] | None, list[Stmt]]:  # fmt: skip
        """One case.  A `break` at its end ends it; without one it falls through to the case at `behind`."""
        b = self.b
        ended = False
        last = statements[-1] if statements else None
        with b.collect() as body:
            if any(isinstance(statement, c_ast.Label) for statement in statements):
                ended = isinstance(statements[-1], c_ast.Break)
                self.statements(statements[:-1] if ended else statements)
                statements = statements[-1:] if ended else []
            for i, statement in enumerate(statements):
                if isinstance(statement, c_ast.Break):
                    ended = True
                    self.behind_break(statements[i + 1 :])
                    break
                if isinstance(statement, c_ast.Compound) and i == len(statements) - 1:
                    ended = self.block_case(statement)
                else:
                    self.statement(statement)
        if behind is not None and not ended and not leaves(body) and not (body and isinstance(body[-1], LeaveSwitch)):
            end = last.coord if last is not None else where
            body.append(FallThrough(end, said=self.falls(end, behind)))
        return labels, body

    def behind_break(self, statements: list[Any]) -> None:
        """Report the statements between the `break` of a case and the next one: they are not in the tree."""
        idle = (c_ast.Break, c_ast.Return, c_ast.EmptyStatement, c_ast.Pragma, c_ast.Decl)
        first = next((s for s in statements if not isinstance(s, idle)), None)
        if first is not None:
            name = self.b.function.path
            self.b.remark(first.coord, "unreachable", f"this statement of {name} can never run", name)

    def falls(self, end: Where, behind: Where) -> bool:
        """Whether a comment between the end of a case and the next one says that it falls through.

        CHOICE: text that is not known (of a header or a macro) counts as such a comment.
        """
        module = self.b.module
        if end.file != module.file or behind.file != module.file or end.macro or behind.macro:
            return True
        return _FALLS.search("\n".join(module.text.splitlines()[end.line - 1 : behind.line])) is not None

    def block_case(self, node: c_ast.Compound) -> bool:
        """Read the block of `case 1: { ... break; }`.  Returns whether it ends with a `break`."""
        items = list(node.block_items or ())
        ended = bool(items) and isinstance(items[-1], c_ast.Break)
        with self.b.block(node.coord) as statements:
            self.statements(items[:-1] if ended else items)
        self.b.out.extend(statements)
        return ended

    def named(self, items: list[Any]) -> set[str]:
        """The names in the cases, if all cases are names and there is no default; else empty."""
        names = {item.expr.name for item in items if isinstance(item, c_ast.Case) and isinstance(item.expr, c_ast.ID)}
        if len(names) != sum(isinstance(item, c_ast.Case) for item in items):
            return set()
        return set() if any(isinstance(item, c_ast.Default) for item in items) else names

    def return_(self, node: c_ast.Return) -> None:
        """`return`."""
        b, where = self.b, node.coord
        result = b.function.ctype.result
        if node.expr is None:
            b.emit(Return(where, None))
            return
        if result == VOID:
            value = self.expressions.value(node.expr)
            if value.ctype != VOID and b.function.name != "main":  # nobody takes what main returns
                raise SourceError.at(where, f"{b.function.name} returns void: it has no value to return")
            build.evaluate(b, value)
            b.emit(Return(where, None))
            return
        value = self.expressions.value(node.expr)
        if value.ctype == VOID:
            raise SourceError.at(node.expr.coord, f"'{written(node.expr)}' is void: it has no value")
        build.return_(b, value, where)


def _again(label: str) -> str:
    """The label of the block whose end begins the next turn of what a `goto` repeats."""
    return f"{label} again"


def _nest(regions: list[_Region]) -> None:
    """Extend regions until each two lie within each other or apart, and sort them, the outer ones first.

    Raises SourceError where a jump would lead into the middle of what another one repeats.
    """
    changed = True
    while changed:
        changed = False
        for one in regions:
            for other in regions:
                if not one.first < other.first < one.end < other.end:
                    continue
                if other.kind == "block":
                    other.first = one.first
                elif one.kind == "again":
                    one.end = other.end
                else:
                    message = f"a goto leads to {one.label}, into the middle of what goto {other.label} repeats"
                    raise SourceError.at(one.where, f"{message}: not modelled, write a loop for it")
                changed = True
    regions.sort(key=lambda region: (region.first, -region.end, region.kind != "block"))


def _within(nodes: Iterable[c_ast.Node]) -> Iterator[c_ast.Node]:
    """Nodes and all that is in them, in the order of the source."""
    waiting = list(nodes)[::-1]
    while waiting:
        node = waiting.pop()
        yield node
        waiting.extend(child for _, child in reversed(node.children()))


def initialise_local(b: Builder, reader: CExpressionReader, variable: Variable, init: c_ast.Node, where: Where) -> None:
    """Declare a local with an initial value."""
    ctype = variable.ctype
    if isinstance(ctype, StructType) and not isinstance(init, c_ast.InitList):
        value = reader.value(init)
        b.emit(Declare(where, variable, None))
        variable.initialised = True
        place = LValue(ctype, variable, where=where, text=variable.declaration.name)
        build.assign(b, place, value, where)
        return
    given = reader.initialiser(init)
    if isinstance(ctype, ArrayType | StructType) or isinstance(init, c_ast.InitList):
        build.begin(b, variable, given, where)
        return
    value = reader.value(init)
    if value.ctype == VOID:
        raise SourceError.at(init.coord, f"'{written(init)}' is void: it has no value")
    build.initialise(b, variable, value, where)


def _mentions(node: c_ast.Node, name: str) -> bool:
    """Whether an expression uses a name.  (A limit that uses the counter of its loop is not a limit.)"""
    waiting = [node]
    while waiting:
        inner = waiting.pop()
        if isinstance(inner, c_ast.ID) and inner.name == name:
            return True
        waiting.extend(child for _, child in inner.children())
    return False


def _declares(node: c_ast.Node) -> bool:
    """Whether an expression creates an object, so that it must be read only once."""
    waiting = [node]
    while waiting:
        inner = waiting.pop()
        if isinstance(inner, c_ast.CompoundLiteral):
            return True
        waiting.extend(child for _, child in inner.children())
    return False


def _copies_back(assigned: c_ast.Assignment, branch: c_ast.Node | None) -> bool:
    """Whether a branch assigns the target of an assignment to what it was assigned from."""
    if branch is None:
        return False
    if isinstance(branch, c_ast.Assignment) and branch.op == "=":
        to, what = written(branch.lvalue), written(branch.rvalue)
        return (to, what) == (written(assigned.rvalue), written(assigned.lvalue))
    return any(_copies_back(assigned, child) for _, child in branch.children())


def _assigns(text: str, node: c_ast.Node | None) -> bool:
    """Whether a statement changes an object with this text, or takes its address."""
    match node:
        case None:
            return False
        case c_ast.Assignment() if written(node.lvalue) == text:
            return True
        case c_ast.UnaryOp(op="++" | "--" | "p++" | "p--" | "&") if written(node.expr) == text:
            return True
    return any(_assigns(text, child) for _, child in node.children())


def _contains_text(text: str, node: c_ast.Node | None) -> bool:
    """Whether a statement contains an expression with this text."""
    waiting = [node]
    while waiting:
        inner = waiting.pop()
        if inner is None:
            continue
        if isinstance(inner, c_ast.ID | c_ast.StructRef | c_ast.ArrayRef | c_ast.UnaryOp) and written(inner) == text:
            return True
        waiting.extend(child for _, child in inner.children())
    return False
