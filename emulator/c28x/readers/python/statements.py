"""Statements of C-shaped Python: the reader passes each to the builder; all other constructs are errors."""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import partial

from emulator.c28x import build
from emulator.c28x.build import Builder
from emulator.c28x.ctypes import ArrayType, CType, IntType, StructType
from emulator.c28x.readers.python import hints
from emulator.c28x.readers.python.expressions import PythonExpressionReader
from emulator.c28x.readers.python.types import PythonTypeReader, shown
from emulator.c28x.symbols import EnumType, Module, SourceError
from emulator.c28x.tree import Break, Continue, Evaluate, Expr, FallThrough, Function, LValue, Stmt, Variable, Where


class PythonStatementReader:
    """Reads the body of one function."""

    def __init__(self, module: Module, function: Function) -> None:
        self.module = module
        self.function = function
        self.b = Builder(module, function)
        self.types = PythonTypeReader(module)
        self.expressions = PythonExpressionReader(self.b, self.types)

    def error(self, node: ast.AST, message: str) -> SourceError:
        """The error about a construct outside the language, with its place."""
        return self.types.error(node, message)

    def read(self, node: ast.FunctionDef) -> None:
        """Fill in `function.body` and `function.locals`."""
        with self.b.collect() as self.function.body:
            self.statements(node.body)

    def statements(self, body: list[ast.stmt]) -> None:
        """Read statements in order."""
        for node in body:
            self.statement(node)

    def block(self, body: list[ast.stmt], where: Where) -> Callable[[], None]:
        """A function that reads a block; the builder calls it."""

        def read() -> None:
            with self.b.block(where) as statements:
                self.statements(body)
            self.b.out.extend(statements)

        return read

    def statement(self, node: ast.stmt) -> None:
        """Read one statement."""
        b, where = self.b, self.types.where(node)
        match node:
            case ast.Pass() | ast.Expr(value=ast.Constant()) | ast.Global():
                pass
            case ast.AnnAssign(target=ast.Name()):
                self.declare(node)
            case ast.Assign(targets=targets, value=source):
                for target in reversed(targets):
                    self.assign(target, source, where)
                    source = target
            case ast.AugAssign(target=target, op=op, value=value):
                symbol = self.expressions.operator(op, target)
                place, given = self.expressions.assignment(target, value)
                build.combined(b, symbol, place, given, where)
            case ast.Expr(value=value):
                b.emit(Evaluate(where, self.expressions.effect(value)))
            case ast.If():
                self.choice(node)
            case ast.While(test=ast.Call(func=ast.Name(id="do"), args=[test], keywords=[]), body=inner, orelse=[]) if (
                self.expressions.meaning("do") is None
            ):
                build.do_while(b, lambda: self.statements(inner), lambda: self.expressions.value(test), where)
            case ast.While(test=test, body=inner, orelse=[]):
                build.while_(b, lambda: self.expressions.value(test), lambda: self.statements(inner), where)
            case ast.While():
                raise self.error(node, "a loop has no else in C: set an object in the loop, and write an if behind it")
            case ast.For():
                self.for_loop(node)
            case ast.Match():
                self.switch(node)
            case ast.Return(value=value):
                result = self.function.ctype.result
                build.return_(b, None if value is None else self.expressions.wanted(value, result), where)
            case ast.Break():
                b.emit(Break(where))
            case ast.Continue():
                b.emit(Continue(where))
            case _:
                first = shown(node).splitlines()[0]
                kind = type(node).__name__
                message = f"the statement '{first}' ({kind}) is not in the language{hints.construct(node)}"
                raise self.error(node, message)

    def choice(self, node: ast.If) -> None:
        """`if`, `elif`, `else`; an `else` with only an `if` in it is an `elif`."""
        links: list[build.IfBranch] = []
        body: list[ast.stmt] = [node]
        where = self.types.where(node)
        while len(body) == 1 and isinstance(last := body[0], ast.If):
            where = self.types.where(last)
            links.append(
                build.IfBranch(where, partial(self.expressions.value, last.test), self.block(last.body, where))
            )
            body = last.orelse
        build.chain(self.b, links, self.block(body, where))

    def declare(self, node: ast.AnnAssign) -> None:
        """Declare a local, with or without a value."""
        assert isinstance(node.target, ast.Name)
        b, where = self.b, self.types.where(node)
        declared = self.types.declared(node.annotation)
        ctype = self.expressions.length(declared.node, declared.ctype, node.value)
        if "static" in declared.words:
            variable = b.declare_static(node.target.id, ctype, where)
            declared.mark(variable)
            self.start(variable, node.value)
            return
        variable = b.declare(node.target.id, ctype, where)
        variable.volatile = "volatile" in declared.words
        if node.value is None:
            build.initialise(b, variable, None, where)
        else:
            self.initialise(variable, ctype, node.value, where)
        declared.mark(variable)

    def initialise(self, variable: Variable, ctype: CType, source: ast.expr, where: Where) -> None:
        """Declare a local with a value; a structure may be a copy of another one."""
        reader = self.expressions
        listed = isinstance(source, ast.Tuple | ast.List | ast.Dict) or (
            isinstance(source, ast.Call) and reader.constructed(source) is not None
        )
        if isinstance(ctype, StructType) and not listed:
            value = reader.value(source)
            build.initialise(self.b, variable, value, where)
            variable.initialised = True
        elif isinstance(ctype, ArrayType | StructType):
            build.begin(self.b, variable, reader.initialiser(source), where)
        else:
            build.initialise(self.b, variable, reader.wanted(source, ctype), where)

    def start(self, variable: Variable, source: ast.expr | None) -> None:
        """Read the initial value of a `static` local, a constant."""
        variable.initialised = source is not None
        if source is None:
            return
        effects, values = self.b.collect_effects(lambda: self.expressions.initial(variable.ctype, source))
        for value in values:
            if effects or not build.is_constant(value):
                raise self.error(source, f"the initial value of {variable.declaration.name} is not a constant")
        variable.initial = values
        self.module.initialisers[variable] = lambda: values

    def assign(self, target: ast.expr, value: ast.expr, where: Where) -> None:
        """`target = value`; a structure is copied."""
        place, given = self.expressions.assignment(target, value)
        build.assign(self.b, place, given, where)

    def for_loop(self, node: ast.For) -> None:
        """`for i in range(...)`."""
        match node:
            case ast.For(target=target, iter=ast.Call(func=ast.Name(id="range"), args=args) as counted, orelse=[]):
                pass
            case ast.For(orelse=[_, *_]):
                raise self.error(node, "a loop has no else in C: set an object in the loop, and write an if behind it")
            case _:
                raise self.error(node, "write for i in range(...); any other C for is a while")
        where = self.types.where(node)
        if not 1 <= len(args) <= 3 or counted.keywords:
            raise self.error(counted, "write range(limit), range(first, limit) or range(first, limit, step)")
        counter = self.expressions.object(target)
        if not isinstance(target, ast.Name):
            raise self.error(node, "the loop variable must be a plain object; for a member or element write a while")
        if not isinstance(counter, LValue) or not isinstance(counter.ctype, IntType):
            raise self.error(node, "the loop variable must be a declared integer object")
        step: int | float | None = 1
        if len(args) == 3:
            step = self.expressions.constant_value(args[2])
        if not isinstance(step, int) or step == 0:
            raise self.error(args[2], "the step of range must be a constant other than 0")
        start: Expr = build.integer(0, where)
        if len(args) > 1:
            start = self.expressions.value(args[0])
        limit = args[1] if len(args) > 1 else args[0]
        before, stop = self.b.collect_effects(lambda: self.expressions.value(limit))
        if before:  # it is evaluated again for every turn
            raise self.error(limit, "this limit of range has too many operators: use a local for it")
        build.for_range(self.b, counter, start, stop, step, lambda: self.statements(node.body), where)

    def switch(self, node: ast.Match) -> None:
        """`match`: a switch.  Each case ends it, unless it ends with `fallthrough()`."""
        where = self.types.where(node)
        subject = self.expressions.value(node.subject)
        if not isinstance(subject.ctype, IntType):
            raise self.error(node.subject, "switch needs an integer")
        cases: list[tuple[list[int] | None, list[Stmt]]] = []
        for case in node.cases:
            if case.guard is not None:
                raise self.error(case.pattern, "a guard on a case is not C: write an if in the case")
            labels = self.labels(case.pattern)
            falls = case is not node.cases[-1] and self.falls(case.body[-1])
            with self.b.block(where) as body:
                self.statements(case.body[:-1] if falls else case.body)
            if falls:
                body.append(FallThrough(self.types.where(case.body[-1])))
            cases.append((labels, body))
        build.switch(self.b, subject, cases, where, *self.named(node))

    def falls(self, node: ast.stmt) -> bool:
        """Whether a statement is `fallthrough()`."""
        match node:
            case ast.Expr(value=ast.Call(func=ast.Name(id="fallthrough"), args=[], keywords=[])):
                return self.expressions.meaning("fallthrough") is None
        return False

    def named(self, node: ast.Match) -> tuple[set[str], list[EnumType]]:
        """The constants that the cases name, and their enumeration, if all are of one; else empty."""
        named: set[str] = set()
        enumerations: set[str] = set()
        for case in node.cases:
            patterns = case.pattern.patterns if isinstance(case.pattern, ast.MatchOr) else [case.pattern]
            for pattern in patterns:
                match pattern:
                    case ast.MatchValue(value=ast.Attribute(value=ast.Name(id=enumeration), attr=constant)):
                        enumerations.add(enumeration)
                        named.add(constant)
                    case _:
                        return set(), []
        symbol = self.module.symbols.get(enumerations.pop()) if len(enumerations) == 1 else None
        return (named, [symbol]) if isinstance(symbol, EnumType) else (set(), [])

    def labels(self, pattern: ast.pattern) -> list[int] | None:
        """The constants of a case; None: the default."""
        match pattern:
            case ast.MatchAs(pattern=None, name=None):
                return None
            case ast.MatchOr(patterns=patterns):
                listed = [self.labels(inner) for inner in patterns]
                return None if None in listed else [value for labels in listed for value in labels or ()]
            case ast.MatchValue(value=value):
                constant = self.expressions.constant_value(value)
                if isinstance(constant, int):
                    return [constant]
        raise self.error(pattern, "a case is an integer constant, ENUM.CONSTANT, or _")
