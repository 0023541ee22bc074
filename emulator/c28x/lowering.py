"""From source to typed tree: statements.  Expressions are lowered in `lowering_expressions.py`."""

from __future__ import annotations

import ast

from emulator.c28x.ctypes import VOID, ArrayType, FunctionType, IntType, StructType, promote
from emulator.c28x.lowering_expressions import ExpressionLowering
from emulator.c28x.lowering_places import PINT
from emulator.c28x.symbols import EnumType, Module
from emulator.c28x.tree import (
    Assign,
    Break,
    Continue,
    CopyStruct,
    Declaration,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import calls


class FunctionLowering(ExpressionLowering):
    """Lowers one function body."""

    def __init__(self, module: Module, function: Function) -> None:
        super().__init__(module, function)
        self.node = module.bodies[function.name]

    def lower(self) -> None:
        """Fill in `function.body` and `function.locals`."""
        for parameter in self.function.parameters:
            self.scope[parameter.name] = parameter
        self.depth = 0
        #: Names declared in the block so far.
        self.declared: set[str] = set()
        self.mark_addresses(self.node)
        self.function.body = self.block(self.node.body)

    def mark_addresses(self, node: ast.FunctionDef) -> None:
        """Names whose address is taken must live in memory."""
        for inner in ast.walk(node):
            match inner:
                case ast.Call(func=ast.Name(id="addressof"), args=[argument]):
                    root = argument
                    while isinstance(root, ast.Attribute | ast.Subscript):
                        root = root.value
                    if isinstance(root, ast.Name):
                        self.addressed.add(root.id)
        for parameter in self.function.parameters:
            parameter.in_memory = parameter.escapes = parameter.name in self.addressed

    def block(self, body: list[ast.stmt]) -> list[Stmt]:
        statements: list[Stmt] = []
        for node in body:
            statements.extend(self.statement(node))
        return statements

    def inner_block(self, body: list[ast.stmt]) -> list[Stmt]:
        """A block within braces: what it declares ends with it."""
        outer, declared = dict(self.scope), self.declared
        self.declared = set()
        self.depth += 1
        statements = self.block(body)
        self.depth -= 1
        for name in self.scope.keys() - outer.keys():
            self.ended[name] = self.scope[name]
        self.scope, self.declared = outer, declared
        return statements

    def statement(self, node: ast.stmt) -> list[Stmt]:
        where = self.where(node)
        match node:
            case ast.Pass() | ast.Expr(value=ast.Constant()) | ast.Global():
                return []
            case ast.AnnAssign(target=ast.Name()):
                return self.declare(node)
            case ast.Assign(targets=targets, value=value):
                result: list[Stmt] = []
                source = value
                for target in reversed(targets):
                    result.append(self.assign(target, source, where))
                    source = target
                return result
            case ast.AugAssign(target=target, op=op, value=value):
                return [self.augmented(target, op, value, where)]
            case ast.Expr(value=value):
                return [Evaluate(where, self.effect(value))]
            case ast.If(test=test, body=then, orelse=otherwise):
                return [If(where, self.condition(test), self.inner_block(then), self.otherwise(otherwise))]
            case ast.While(test=test, body=inner, orelse=[]):
                return [While(where, self.condition(test), self.inner_block(inner))]
            case ast.For():
                return [self.for_loop(node)]
            case ast.Match():
                return [self.switch(node)]
            case ast.Return(value=value):
                return [self.return_statement(value, node)]
            case ast.Break():
                return [Break(where)]
            case ast.Continue():
                return [Continue(where)]
        raise self.error(
            node, f"the statement '{ast.unparse(node).splitlines()[0]}' ({type(node).__name__}) is not in the language"
        )

    def otherwise(self, body: list[ast.stmt]) -> list[Stmt]:
        """An `else`; an `else if` is no block of its own."""
        return self.block(body) if len(body) == 1 and isinstance(body[0], ast.If) else self.inner_block(body)

    def declare(self, node: ast.AnnAssign) -> list[Stmt]:
        assert isinstance(node.target, ast.Name)
        name = node.target.id
        ctype = self.types.complete(node.annotation)
        known = self.scope.get(name)
        if known is not None and (not self.depth or name in self.declared):
            raise self.error(node, f"{name} is declared twice in one block of {self.function.name}")
        self.declared.add(name)
        declaration = Declaration(name, ctype, self.module.short, self.module.file, node.lineno, self.function.name)
        variable = Variable(declaration, ctype, "local", initialised=node.value is not None)
        aggregate = isinstance(ctype, ArrayType | StructType)
        variable.in_memory = aggregate or name in self.addressed
        variable.escapes = name in self.addressed
        variable.nested = self.depth > 0
        namesakes = [v for v in (*self.function.parameters, *self.function.locals) if v.declaration.name == name]
        variable.alias = f"{name}__{len(namesakes)}" if namesakes else ""
        self.scope[name] = variable
        self.function.locals.append(variable)
        if node.value is None:
            return [Declare(self.where(node), variable, None)]
        if isinstance(ctype, StructType) and not isinstance(node.value, ast.Tuple | ast.List):
            return [Declare(self.where(node), variable, None), self.assign(node.target, node.value, self.where(node))]
        if aggregate:
            return [Declare(self.where(node), variable, self.aggregate(ctype, node.value))]
        return [Declare(self.where(node), variable, self.convert(self.expression(node.value), ctype, node.value))]

    def assign(self, target: ast.expr, value: ast.expr, where: Where) -> Stmt:
        place = self.lvalue(target)
        if isinstance(place.ctype, StructType):
            source = self.expression(value)
            if not isinstance(source, Load) or source.ctype != place.ctype or isinstance(place, RegisterRef):
                raise self.error(value, f"a {place.ctype} is assigned from another {place.ctype}")
            for side in (place, source.lvalue):
                if isinstance(side.root, Variable):
                    side.root.escapes = True
            return CopyStruct(where, place, source.lvalue)
        if isinstance(place.ctype, ArrayType):
            raise self.error(target, "an array is not assignable in C")
        assigned = self.expression(value)
        if place.ctype == PINT and isinstance(assigned.ctype, FunctionType) and assigned.ctype.parameters:
            raise self.error(value, "an interrupt routine has no parameters")
        return Assign(where, place, self.convert(assigned, place.ctype, value))

    def augmented(self, target: ast.expr, op: ast.operator, value: ast.expr, where: Where) -> Stmt:
        place = self.lvalue(target)
        if isinstance(place, LValue) and (
            any(calls(index.expr) for index in place.indices) or (isinstance(place.root, Expr) and calls(place.root))
        ):
            raise self.error(target, "a call within the target of a compound assignment would run twice: use a local")
        if isinstance(place, RegisterRef):
            current: Expr = RegisterLoad(place.ctype, place)
        else:
            current = Load(place.ctype, place)
        combined = self.binary(op, current, self.expression(value), target)
        return Assign(where, place, self.convert(combined, place.ctype, value))

    def for_loop(self, node: ast.For) -> Stmt:
        match node:
            case ast.For(target=target, iter=ast.Call(func=ast.Name(id="range"), args=args), orelse=[]):
                pass
            case _:
                raise self.error(node, "write for i in range(...); any other C for is a while")
        variable = self.lvalue(target)
        if not isinstance(target, ast.Name):
            raise self.error(node, "the loop variable must be a plain object; for a member or element write a while")
        if isinstance(variable, RegisterRef) or not isinstance(variable.ctype, IntType):
            raise self.error(node, "the loop variable must be a declared integer object")
        start = args[0] if len(args) > 1 else ast.copy_location(ast.Constant(0), node)
        stop = args[1] if len(args) > 1 else args[0]
        step = 1
        if len(args) == 3:
            constant = self.constant_value(args[2])
            if not isinstance(constant, int) or constant == 0:
                raise self.error(args[2], "the step of range must be a constant other than 0")
            step = constant
        return For(
            self.where(node), variable, self.convert(self.expression(start), variable.ctype, start),
            self.expression(stop), step, self.inner_block(node.body),
        )  # fmt: skip

    def switch(self, node: ast.Match) -> Stmt:
        subject = self.expression(node.subject)
        if not isinstance(subject.ctype, IntType):
            raise self.error(node.subject, "switch needs an integer")
        cases: list[tuple[list[int] | None, list[Stmt]]] = []
        for case in node.cases:
            if case.guard is not None:
                raise self.error(case.pattern, "a guard on a case is not C")
            labels = self.pattern(case.pattern)
            if labels is not None:  # C converts a label to the promoted type of the subject
                labels = [promote(subject.ctype).wrap(value) for value in labels]
            cases.append((labels, self.inner_block(case.body)))
        return Switch(self.where(node), subject, cases, self.names_every_constant(node))

    def names_every_constant(self, node: ast.Match) -> bool:
        """Whether the cases are the constants of one enumeration, all of them."""
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
                        return False
        symbol = self.module.symbols.get(enumerations.pop()) if len(enumerations) == 1 else None
        return isinstance(symbol, EnumType) and named == set(symbol.constants)

    def pattern(self, pattern: ast.pattern) -> list[int] | None:
        match pattern:
            case ast.MatchAs(pattern=None, name=None):
                return None
            case ast.MatchOr(patterns=patterns):
                values: list[int] = []
                for inner in patterns:
                    values.extend(self.pattern(inner) or [])
                return values
            case ast.MatchValue(value=value):
                constant = self.constant_value(value)
                if isinstance(constant, int):
                    return [constant]
        raise self.error(pattern, "a case is an integer constant, ENUM.CONSTANT, or _")

    def return_statement(self, value: ast.expr | None, node: ast.stmt) -> Stmt:
        result = self.function.ctype.result
        if value is None:
            return Return(self.where(node), None)
        if result == VOID:
            raise self.error(node, f"{self.function.name} returns void")
        return Return(self.where(node), self.convert(self.expression(value), result, value))


def lower_function(module: Module, function: Function) -> None:
    """Lower one function of `module` in place."""
    FunctionLowering(module, function).lower()
