"""Expressions of C-shaped Python: each construct is given to the builder, anything else is refused."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import partial
from typing import Final

from emulator.c28x import build
from emulator.c28x.build import Braces, Builder, Item, Place
from emulator.c28x.build.scope import DEEP_NESTING
from emulator.c28x.ctypes import INT, VOID, ArrayType, CType, PointerType, StructType
from emulator.c28x.readers.python.types import TypeReader, hint, shown
from emulator.c28x.symbols import CoreRegister, Define, Enumerator, EnumType, Registers, SourceError, Symbol
from emulator.c28x.tree import Const, Expr, Function, Null, Variable, Where

_OPS: Final[dict[type, str]] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Mod: "%", ast.LShift: "<<", ast.RShift: ">>",
    ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
_COMPARE: Final[dict[type, str]] = {
    ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
}  # fmt: skip
_UNARY: Final[dict[type, str]] = {ast.USub: "-", ast.UAdd: "+", ast.Invert: "~"}


class ExpressionReader:
    """Reads expressions of one function, or of a file-scope initialiser, for the builder `b`."""

    def __init__(self, b: Builder, types: TypeReader) -> None:
        self.b = b
        self.types = types

    def error(self, node: ast.AST, message: str) -> SourceError:
        """A construct outside the language, with its place."""
        return self.types.error(node, message)

    def where(self, node: ast.AST) -> Where:
        """The place of a construct."""
        return self.types.where(node)

    # Values

    def value(self, node: ast.expr) -> Expr:
        """The value of an expression, arrays decayed."""
        with self.b.nested(self.where(node)):
            return build.shallow(self.b, self.whole_value(node))

    def whole_value(self, node: ast.expr) -> Expr:
        """The value, however deep its tree is."""
        where = self.where(node)
        b = self.b
        match node:
            case ast.Constant():
                return self.constant(node)
            case ast.Name(id=name):
                return self.name(node, name)
            case ast.Attribute() | ast.Subscript():
                enumerated = self.enumerated(node)
                return Const(INT, enumerated, where=where) if enumerated is not None else self.loaded(node)
            case ast.BinOp():
                return self.chain(node)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return build.logical_not(b, self.value(operand), where)
            case ast.UnaryOp(op=op, operand=operand):
                return build.unary(b, _UNARY[type(op)], self.value(operand), where)
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                symbol = _COMPARE.get(type(op))
                if symbol is None:
                    raise self.error(node, "not a comparison of C")
                first, second = self.values(left, right)
                return build.compare(b, symbol, first, second, where)
            case ast.Compare():
                raise self.error(
                    node, "a chained comparison means something else in C: write (a < b) < c, or a < b and b < c"
                )
            case ast.BoolOp(op=op, values=values):
                parts = [lambda part=part: self.value(part) for part in values]
                return build.logic(b, "and" if isinstance(op, ast.And) else "or", parts, where)
            case ast.IfExp(test=test, body=then, orelse=otherwise):
                return build.conditional(
                    b, self.value(test), lambda: self.value(then), lambda: self.value(otherwise), where
                )
            case ast.Call():
                return self.call(node)
        raise self.error(node, f"'{shown(node)}' ({type(node).__name__}) is not in the language")

    def values(self, *nodes: ast.expr) -> list[Expr]:
        """The values of operands, evaluated from left to right."""
        return build.arguments(self.b, [partial(self.value, node) for node in nodes])

    def chain(self, node: ast.BinOp) -> Expr:
        """Operators one after the other, as a sum of many terms: `((a + b) + c) + d`."""
        steps = [node]
        while isinstance(steps[-1].left, ast.BinOp):
            steps.append(steps[-1].left)
        first, *others = reversed(steps)
        self.b.deep |= len(steps) > DEEP_NESTING
        left, right = self.values(first.left, first.right)
        value = build.binary(self.b, self.operator(first.op, first), left, right, self.where(first))
        for step in others:
            terms = [partial(build.shallow, self.b, value), partial(self.value, step.right)]
            left, right = build.arguments(self.b, terms)
            value = build.binary(self.b, self.operator(step.op, step), left, right, self.where(step))
        return value

    def converted(self, node: ast.expr, ctype: CType, *, explicit: bool = False) -> Expr:
        """The value of an expression where a `ctype` is wanted: 'a' is a character, or a string for a pointer."""
        return build.convert(self.b, self.wanted(node, ctype), ctype, explicit=explicit)

    def wanted(self, node: ast.expr, ctype: CType) -> Expr:
        """The value of an expression, a string where text is wanted."""
        match node:
            case ast.Constant(value=str(text)) if isinstance(ctype, PointerType | ArrayType):
                return build.string(text, self.where(node))
        return self.value(node)

    def effect(self, node: ast.expr) -> Expr:
        """An expression statement."""
        if not isinstance(node, ast.Call):
            raise self.error(node, f"'{shown(node)}' has no effect")
        return self.value(node)

    def operator(self, op: ast.operator, node: ast.AST) -> str:
        """The C operator."""
        symbol = _OPS.get(type(op))
        if symbol is None:
            raise self.error(node, "not an operator of C (// and ** do not exist; / divides integers by truncation)")
        return symbol

    def constant(self, node: ast.Constant) -> Expr:
        """A literal."""
        value, where = node.value, self.where(node)
        if isinstance(value, bool) or value is None:
            raise self.error(node, f"{value} is not C: write 1, 0 or NULL")
        if isinstance(value, float):
            return build.floating(value, where)
        if isinstance(value, str):
            return build.character(ord(value), where) if len(value) == 1 else build.string(value, where)
        if not isinstance(value, int):
            raise self.error(node, f"{value!r} is not a C constant")
        return build.integer(value, where, decimal=not self.types.text(node).startswith(("0x", "0b", "0o")))

    def name(self, node: ast.expr, name: str) -> Expr:
        """What a name stands for."""
        where = self.where(node)
        match self.meaning(name):
            case Variable() as variable:
                return build.value_of(self.b, build.object_place(variable, where))
            case Define() as define:
                with self.b.expanding(name, where):
                    return define.expression(self.b, where)
            case Enumerator(value=value):
                return Const(INT, value, where=where)
            case CoreRegister() as register:
                return build.value_of(self.b, build.core_register(register, where))
            case Function() as function:
                return build.function_value(self.b, function, where)
            case None if name == "NULL":
                return Null(PointerType("void *", VOID), where=where)
        raise self.b.undeclared(name, where, f"{name} is not declared{hint(name)}")

    def meaning(self, name: str) -> Symbol | None:
        """What a name means where the expression is used; within a `#define` also where that stands."""
        symbol = self.b.look_up(name)
        return symbol if symbol is not None else self.types.module.symbols.get(name)

    def enumerated(self, node: ast.expr) -> int | None:
        """`ENUM.CONSTANT`."""
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=constant):
                symbol = self.meaning(name)
                if isinstance(symbol, EnumType):
                    if constant not in symbol.constants:
                        raise self.error(node, f"enum {name} has no {constant}: it has {', '.join(symbol.constants)}")
                    return symbol.constants[constant]
        return None

    # Places

    def loaded(self, node: ast.expr) -> Expr:
        """The value of what an expression designates."""
        return build.value_of(self.b, self.place(node))

    def place(self, node: ast.expr) -> Place:
        """What an expression designates."""
        where = self.where(node)
        with self.b.nested(where):
            return build.shallow_place(self.b, self.whole_place(node))

    def whole_place(self, node: ast.expr) -> Place:
        """What an expression designates, however deep its pointer is."""
        where = self.where(node)
        match node:
            case ast.Name(id=name):
                match self.meaning(name):
                    case CoreRegister() as register:
                        return build.core_register(register, where)
                    case Variable() as variable:
                        return build.object_place(variable, where)
                    case Registers() as block:
                        return build.register_block(block, where)
                raise self.b.undeclared(name, where, f"{name} is not a declared object")
            case ast.Attribute(value=base, attr=name):
                return build.member(
                    self.b, self.base(base), name, where, text=shown(node), base_text=shown(base)
                )
            case ast.Subscript(value=base, slice=index):
                whole, number = build.operands(self.b, lambda: self.base(base), lambda: self.value(index))
                assert isinstance(number, Expr)
                return build.element(self.b, whole, number, where, shown(node), shown(base))
        raise self.error(node, f"'{shown(node)}' does not designate an object")

    def base(self, node: ast.expr) -> Place | Expr:
        """What stands before `.member` or `[index]`: an aggregate, a pointer, a register block."""
        if isinstance(node, ast.Name | ast.Attribute | ast.Subscript) and self.enumerated(node) is None:
            return self.place(node)
        value = self.value(node)
        if not isinstance(value.ctype, PointerType):
            raise self.error(node, f"'{shown(node)}' is a {value.ctype}, not a pointer")
        return value

    # Calls, casts

    def call(self, node: ast.Call) -> Expr:
        """A call, a cast, or a word of the language."""
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args):
            raise self.error(node, "C has no keyword or starred arguments")
        where = self.where(node)
        if isinstance(node.func, ast.Name):
            name = node.func.id
            symbol = self.meaning(name)
            if name in ("addressof", "sizeof", "cast") and symbol is None:
                return self.word(name, node)
            if isinstance(symbol, Function):
                wanted = (*symbol.ctype.parameters, *([VOID] * len(node.args)))
                arguments = self.arguments(node.args, wanted)
                return build.call(self.b, symbol, arguments, where)
            ctype = self.types.try_type(node.func)
            if ctype is not None:
                if len(node.args) != 1:
                    raise self.error(node, f"a cast to {ctype} takes one value")
                return self.converted(node.args[0], ctype, explicit=True)
            if not isinstance(symbol, Variable):
                raise self.error(
                    node, f"{name} is not declared{hint(name) or ': declare it in a header as @extern, or import it'}"
                )
        target = self.value(node.func)
        wanted = (*getattr(target.ctype, "parameters", ()), *([VOID] * len(node.args)))
        arguments = self.arguments(node.args, wanted)
        return build.call_value(self.b, target, arguments, where, shown(node.func))

    def arguments(self, nodes: Sequence[ast.expr], wanted: Sequence[CType]) -> list[Expr]:
        """The arguments of a call, as its parameters want them."""
        given = zip(nodes, wanted, strict=False)
        return build.arguments(self.b, [partial(self.wanted, node, ctype) for node, ctype in given])

    def word(self, name: str, node: ast.Call) -> Expr:
        """`addressof(x)`, `cast(type, x)`, `sizeof(x)`."""
        where = self.where(node)
        if name == "addressof" and len(node.args) == 1:
            argument = node.args[0]
            if isinstance(argument, ast.Name) and isinstance(self.meaning(argument.id), Function):
                return self.value(argument)
            return build.address_of(self.b, self.place(argument), where)
        if name == "cast" and len(node.args) == 2:
            return self.converted(node.args[1], self.types.ctype(node.args[0]), explicit=True)
        if name == "sizeof" and len(node.args) == 1:
            ctype = self.types.try_type(node.args[0]) or build.complete(self.place(node.args[0])).ctype
            return build.sizeof(ctype, where)
        raise self.error(node, f"{name} used wrongly")

    # Initialisers

    def initialiser(self, node: ast.expr) -> Item | Braces:
        """The right side of a declaration: a value, or a tuple of them."""
        if isinstance(node, ast.Tuple | ast.List):
            return Braces(self.where(node), [self.initialiser(part) for part in node.elts])
        return Item(self.where(node), lambda ctype: self.wanted(node, ctype))

    def initial(self, ctype: CType, node: ast.expr) -> list[Expr]:
        """The initial value of every scalar of an object."""
        if isinstance(ctype, ArrayType | StructType):
            return build.values(self.b, ctype, self.initialiser(node))
        return [self.converted(node, ctype)]

    def constant_value(self, node: ast.expr) -> int | float | None:
        """The number that an expression is, if it is one at translation time."""
        return build.constant_value(self.value(node))
