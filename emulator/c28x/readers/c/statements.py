"""Statements of C: the reader passes each to the builder; labels, `goto` and computed cases are errors."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any, Final, Protocol

from pycparser import c_ast

from emulator.c28x import build
from emulator.c28x.build import Builder
from emulator.c28x.ctypes import VOID, ArrayType, IntType, StructType, promote
from emulator.c28x.readers.c.expressions import CExpressionReader
from emulator.c28x.readers.c.grammar import Parenthesised
from emulator.c28x.readers.c.written import written
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    Break,
    Continue,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
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


class CStatementReader:
    """Reads the body of one function."""

    def __init__(self, b: Builder, expressions: CExpressionReader, declarations: Locals) -> None:
        self.b = b
        self.expressions = expressions
        self.declarations = declarations
        #: What a `break` ends, innermost last: "loop" or "switch".
        self.breakable: list[str] = []

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
                if not self.breakable:
                    raise SourceError.at(where, "break is outside of a loop or a switch")
                b.emit(Break(where) if self.breakable[-1] == "loop" else LeaveSwitch(where))
            case c_ast.Continue():
                if "loop" not in self.breakable:
                    raise SourceError.at(where, "continue is outside of a loop")
                b.emit(Continue(where))
            case c_ast.Goto():
                raise SourceError.at(where, "goto is not modelled: write a loop, a function or an if")
            case c_ast.Label():
                raise SourceError.at(where, f"the label {node.name} is for goto, which is not modelled")
            case c_ast.Case() | c_ast.Default():
                word = "case" if isinstance(node, c_ast.Case) else "default"
                raise SourceError.at(where, f"{word} is outside of a switch, or in a block within one: not modelled")
            case c_ast.StaticAssert():
                self.static_assert(node)
            case _:
                self.expression(node)

    def statements(self, items: list[c_ast.Node] | None) -> None:
        """Read statements in order."""
        for item in items or ():
            self.statement(item)

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
            self.breakable.append(kind)
            if isinstance(node, c_ast.Compound):
                self.statements(node.block_items)
            else:
                self.statement(node)
            self.breakable.pop()

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
        if isinstance(node, c_ast.Assignment) and node.op == "=" and self.compares(node, branches):
            text = written(node.lvalue)
            message = f"the condition assigns {written(node.rvalue)} to {text}: == compares"
            self.b.remark(node.coord, "assigned-condition", message, text)
        return value

    def compares(self, node: c_ast.Assignment, branches: tuple[c_ast.Node | None, ...]) -> bool:
        """Whether an assignment as a condition was meant as a comparison.

        An assignment of a constant always was.  One of another value was if it is in an `if`, has no parentheses of its
        own, and a branch copies the target back (`if (now = seen) seen = now;`) or none uses it.  A local that gets the
        result of a function may be used later: it was not.
        """
        effects, value = self.b.collect_effects(lambda: self.expressions.value(node.rvalue))
        if not effects and build.constant_value(value) is not None:
            return True
        if not branches or isinstance(node, Parenthesised):
            return False
        target = self.b.look_up(node.lvalue.name) if isinstance(node.lvalue, c_ast.ID) else None
        if isinstance(node.rvalue, c_ast.FuncCall) and isinstance(target, Variable) and target.kind != "global":
            return False
        if any(_copies_back(node, branch) for branch in branches):
            return True
        return not any(_contains_text(written(node.lvalue), branch) for branch in branches)

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
        self.breakable.append("switch")
        with b.block(where, loop=True) as before:
            while items and not isinstance(items[0], c_ast.Case | c_ast.Default):
                if not isinstance(items[0], c_ast.Decl) or items[0].init is not None:
                    raise SourceError.at(items[0].coord, "statements before the first case of a switch never run")
                self.statement(items[0])
                items = items[1:]
            cases = self.cases(items, subject)
        self.breakable.pop()
        b.out.extend(before)
        build.switch(b, subject, cases, where, self.named(items), self.expressions.types.enumerations)

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
        with b.collect() as body:
            for i, statement in enumerate(statements):
                if isinstance(statement, c_ast.Break):
                    ended = True
                    break
                if isinstance(statement, c_ast.Compound) and i == len(statements) - 1:
                    ended = self.block_case(statement)
                else:
                    self.statement(statement)
        if behind is not None and not ended and not leaves(body) and not (body and isinstance(body[-1], LeaveSwitch)):
            end = statements[-1].coord if statements else where
            body.append(FallThrough(end, said=self.falls(end, behind)))
        return labels, body

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
            if value.ctype != VOID:
                raise SourceError.at(where, f"{b.function.name} returns void: it has no value to return")
            build.evaluate(b, value)
            b.emit(Return(where, None))
            return
        value = self.expressions.value(node.expr)
        if value.ctype == VOID:
            raise SourceError.at(node.expr.coord, f"'{written(node.expr)}' is void: it has no value")
        build.return_(b, value, where)


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
