"""Expressions of C-shaped Python: the reader passes each construct to the builder; all others are errors."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import partial
from typing import Final

from emulator.c28x import build
from emulator.c28x.build import Braces, Builder, Item, Place
from emulator.c28x.ctypes import BASIC, INT, VOID, ArrayType, CType, PointerType, StructType
from emulator.c28x.readers.python import hints
from emulator.c28x.readers.python.hints import hint
from emulator.c28x.readers.python.types import PythonTypeReader, shown
from emulator.c28x.symbols import (
    CoreRegister,
    Define,
    Enumerator,
    EnumType,
    RegisterBlock,
    SourceError,
    Symbol,
    Unmodelled,
    nearest,
)  # fmt: skip
from emulator.c28x.tree import Const, Expr, Function, LValue, Null, RegisterAt, RegisterRef, Stmt, Variable, Where

_OPS: Final[dict[type, str]] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Mod: "%", ast.LShift: "<<", ast.RShift: ">>",
    ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
_COMPARE: Final[dict[type, str]] = {
    ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
}  # fmt: skip
#: The syntax of language words that look like functions.
_USES: Final = {
    "addressof": "addressof(object)", "cast": "cast(ptr[TYPE], value)", "sizeof": "sizeof(TYPE) or sizeof(object)",
    "do": "while do(test):", "fallthrough": "fallthrough() as the last statement of a case that is not the last",
}  # fmt: skip
_UNARY: Final[dict[type, str]] = {ast.USub: "-", ast.UAdd: "+", ast.Invert: "~"}


class PythonExpressionReader:
    """Reads expressions of one function, or of a file-scope initialiser, for the builder `b`."""

    def __init__(self, b: Builder, types: PythonTypeReader) -> None:
        self.b = b
        self.types = types

    def error(self, node: ast.AST, message: str) -> SourceError:
        """The error about a construct outside the language, with its place."""
        return self.types.error(node, message)

    def where(self, node: ast.AST) -> Where:
        """The place of a construct."""
        return self.types.where(node)

    # Values

    def value(self, node: ast.expr) -> Expr:
        """The value of an expression; arrays decay to pointers."""
        where = self.where(node)
        with self.b.nested(where):
            return build.shallow(self.b, self.whole_value(node, where))

    def whole_value(self, node: ast.expr, where: Where) -> Expr:
        """The value of an expression, before its depth is limited."""
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
                self.check_step(node)
                return build.unary(b, _UNARY[type(op)], self.value(operand), where)
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                symbol = _COMPARE.get(type(op))
                if symbol is None:
                    raise self.error(node, f"not a comparison of C{hints.operator(op)}")
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
            case ast.NamedExpr(target=target, value=source):
                place, value = self.assignment(target, source)
                if self.types.before(node) == "(":  # where it is an operand, its operation begins at the parenthesis
                    where = where._replace(column=where.column - 1)
                return build.assigned(b, place, value, where)
        kind = type(node).__name__
        raise self.error(node, f"'{shown(node)}' ({kind}) is not in the language{hints.construct(node)}")

    def check_step(self, node: ast.UnaryOp) -> None:
        """Reject `++x` and `--x`: in Python they are two signs, in C a step."""
        match node:
            case ast.UnaryOp(
                op=ast.UAdd() | ast.USub() as op,
                operand=ast.UnaryOp(op=inner, operand=ast.Name() | ast.Attribute() | ast.Subscript() as stepped),
            ) if type(op) is type(inner):
                sign = _UNARY[type(op)]
                if self.types.text(node).startswith(2 * sign) and self.types.before(node) != sign:
                    instead = f"write {shown(stepped)} {sign}= 1 before"
                    raise self.error(node, f"{2 * sign} is not an operator here: {instead}")

    def values(self, *nodes: ast.expr) -> list[Expr]:
        """The values of operands, evaluated from left to right."""
        return build.arguments(self.b, [partial(self.value, node) for node in nodes])

    def chain(self, node: ast.BinOp) -> Expr:
        """A chain of operators, such as a sum of many terms: `((a + b) + c) + d`."""
        steps = [node]
        while isinstance(steps[-1].left, ast.BinOp):
            steps.append(steps[-1].left)
        steps.reverse()
        operators = [(self.operator(step.op, step), self.where(step)) for step in steps]
        operands = [partial(self.value, operand) for operand in (steps[0].left, *(step.right for step in steps))]
        return build.row(self.b, operands, operators)

    def converted(self, node: ast.expr, ctype: CType, *, explicit: bool = False) -> Expr:
        """The value of an expression, converted to `ctype`: 'a' is a character, or a string if a pointer is needed."""
        return build.convert(self.b, self.wanted(node, ctype), ctype, explicit=explicit)

    def wanted(self, node: ast.expr, ctype: CType) -> Expr:
        """The value of an expression for a `ctype`; a text is a string if a pointer is needed."""
        match node:
            case ast.Constant(value=str(text)) if isinstance(ctype, PointerType | ArrayType):
                return build.string(text, self.where(node))
            case ast.Tuple() | ast.List() | ast.Dict() if isinstance(ctype, StructType):
                members = ", ".join(member.name for member in ctype.members)
                raise self.error(node, f"a list is not a value here: write {ctype}({members})")
        return self.value(node)

    def effect(self, node: ast.expr) -> Expr:
        """An expression statement."""
        if isinstance(node, ast.UnaryOp):
            self.check_step(node)
        if isinstance(node, ast.Await | ast.Yield | ast.YieldFrom):
            return self.value(node)
        if not isinstance(node, ast.Call):
            acts = any(isinstance(part, ast.Call | ast.NamedExpr) for part in ast.walk(node))
            wanted = ": write an assignment, or an if around a call" if acts else ""
            raise self.error(node, f"'{shown(node)}' has no effect{wanted}")
        return self.value(node)

    def operator(self, op: ast.operator, node: ast.AST) -> str:
        """The C operator."""
        symbol = _OPS.get(type(op))
        if symbol is None:
            reason = "not an operator of C (// and ** do not exist; / divides integers by truncation)"
            raise self.error(node, f"{reason}{hints.operator(op)}")
        return symbol

    def constant(self, node: ast.Constant) -> Expr:
        """A literal."""
        value, where = node.value, self.where(node)
        if isinstance(value, bool) or value is None:
            raise self.error(node, f"{value} is not C{hint(str(value))}")
        if isinstance(value, float):
            return build.floating(value, where)
        if isinstance(value, str):
            return build.character(ord(value), where) if len(value) == 1 else build.string(value, where)
        if not isinstance(value, int):
            wanted = "a text without b" if isinstance(value, bytes) else "a number or a text"
            raise self.error(node, f"{value!r} is not a C constant: write {wanted}")
        return build.integer(value, where, decimal=not self.types.text(node).startswith(("0x", "0b", "0o")))

    def name(self, node: ast.expr, name: str) -> Expr:
        """The value of a name."""
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
            case CType() | EnumType():
                raise self.error(node, f"{name} is a type, not a value")
            case Unmodelled() as block:
                return build.value_of(self.b, build.unmodelled_block(block, where))
            case None if name == "NULL":
                return Null(VOID.pointer, where=where)
            case None if name in BASIC:
                raise self.error(node, f"{name} is a type, not a value: write {name}(x) for a cast")
        wanted = self.hint(name) or ": declare it, or import it"
        raise self.b.undeclared(name, where, f"{name} is not declared{wanted}")

    def hint(self, name: str) -> str:
        """What to write instead of an undeclared name; it may be similar to a declared one."""
        known = hint(name, self.types.module.text)
        return known or nearest(name, [*self.types.module.symbols, *self.b.scope])

    def meaning(self, name: str) -> Symbol | None:
        """The meaning of a name where the expression is used; for a `#define`, also where it is defined."""
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
        """The value of the place that an expression designates."""
        return build.value_of(self.b, self.place(node))

    def place(self, node: ast.expr) -> Place:
        """The place that an expression designates."""
        where = self.where(node)
        with self.b.nested(where):
            return build.shallow_place(self.b, self.whole_place(node, where))

    def whole_place(self, node: ast.expr, where: Where) -> Place:
        """The place that an expression designates, before the depth of its pointer is limited."""
        match node:
            case ast.Name(id=name):
                match self.meaning(name):
                    case CoreRegister() as register:
                        return build.core_register(register, where)
                    case Variable() as variable:
                        return build.object_place(variable, where)
                    case RegisterBlock() as block:
                        return build.register_block(block, where)
                    case Unmodelled() as unmodelled:
                        return build.unmodelled_block(unmodelled, where)
                declare = self.hint(name) or f": write {name}: TYPE before"
                raise self.b.undeclared(name, where, f"{name} is not a declared object{declare}")
            case ast.Attribute(value=base, attr=name):
                return build.member(self.b, self.base(base), name, where, text=shown(node), base_text=shown(base))
            case ast.Subscript(value=base, slice=index):
                whole, number = build.operands(self.b, lambda: self.base(base), lambda: self.value(index))
                assert isinstance(number, Expr)
                return build.element(self.b, whole, number, where, shown(node), shown(base))
            case ast.Call() if (ctype := self.constructed(node)) is not None:
                return build.literal(self.b, ctype, self.initialiser(node), where)
        raise self.error(node, f"'{shown(node)}' does not designate an object{hints.construct(node)}")

    def object(self, node: ast.expr) -> LValue | RegisterRef | RegisterAt:
        """The object that a statement changes.  Raises SourceError if the expression is not an object."""
        place = build.complete(self.place(node))
        if isinstance(place, LValue) and isinstance(place.root, Variable) and place.root.constant:
            raise self.error(node, f"{place.root.declaration.name} is const: nothing is assigned to it")
        if isinstance(place.ctype, ArrayType):
            raise self.error(node, "an array is not assignable in C: write a loop, or memcpy")
        return place

    def assignment(self, target: ast.expr, source: ast.expr) -> tuple[Place, Expr]:
        """The two sides of an assignment."""
        effects: list[Stmt] = []
        place: list[LValue | RegisterRef | RegisterAt] = []

        def left() -> Place:
            place.append(self.object(target))
            return place[0]

        def right() -> Expr:
            before, value = self.b.collect_effects(lambda: self.wanted(source, place[0].ctype))
            effects.extend(before)
            self.b.out.extend(before)
            return value

        designated, value = build.operands(self.b, left, right)
        assert isinstance(value, Expr)
        assert not isinstance(designated, Expr)
        if isinstance(designated, LValue) and build.writes_itself(self.b, effects, designated):
            build.unsequenced(self.b, designated)
        return designated, value

    def base(self, node: ast.expr) -> Place | Expr:
        """The part before `.member` or `[index]`: an aggregate, a pointer, a register block."""
        if isinstance(node, ast.Name | ast.Attribute | ast.Subscript) and self.enumerated(node) is None:
            return self.place(node)
        if isinstance(node, ast.Call) and self.constructed(node) is not None:
            return self.place(node)
        value = self.value(node)
        if isinstance(value.ctype, StructType):  # the result of a function
            return build.in_temporary(self.b, value, self.where(node))
        if not isinstance(value.ctype, PointerType):
            raise self.error(node, f"'{shown(node)}' is a {value.ctype}, not a pointer")
        return value

    # Calls, casts

    def call(self, node: ast.Call) -> Expr:
        """A call, a cast, a structure with its members, or a word of the language."""
        if self.constructed(node) is not None:
            return self.loaded(node)
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args):
            raise self.error(node, "C has no keyword or starred arguments: write them in order; p[0] for *p")
        where = self.where(node)
        if isinstance(node.func, ast.Name):
            name = node.func.id
            symbol = self.meaning(name)
            if name in ("addressof", "sizeof", "cast", "do", "fallthrough") and symbol is None:
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
                wanted_here = self.hint(name) or ": declare it in a header as @extern, or import it"
                raise self.b.undeclared(name, where, f"{name} is not declared{wanted_here}")
        target = self.called(node.func)
        wanted = (*getattr(target.ctype, "parameters", ()), *([VOID] * len(node.args)))
        arguments = self.arguments(node.args, wanted)
        return build.call_value(self.b, target, arguments, where, shown(node.func))

    def called(self, node: ast.expr) -> Expr:
        """The function pointer of a call.  Raises SourceError; it says so if the call looks like a method."""
        try:
            return self.value(node)
        except SourceError as error:
            if not isinstance(node, ast.Attribute):
                raise
            message = str(error).removeprefix(f"{error.file}:{error.line}:{error.column}: ")
            wanted = hint(node.attr) or ": write a function that takes what stands before the dot"
            raise self.error(node, f"{message}. C has no methods{wanted}") from None

    def constructed(self, node: ast.Call) -> StructType | None:
        """The structure type of `point(1, 2)` or `point(x=1)`; None for any other call."""
        if not isinstance(node.func, ast.Name):
            return None
        symbol = self.meaning(node.func.id)
        return symbol if isinstance(symbol, StructType) else None

    def arguments(self, nodes: Sequence[ast.expr], wanted: Sequence[CType]) -> list[Expr]:
        """The arguments of a call, for the types of its parameters."""
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
            return build.sizeof(self.types.try_type(node.args[0]) or self.measured(node.args[0]), where)
        raise self.error(node, f"{name} used wrongly: write {_USES[name]}")

    def measured(self, node: ast.expr) -> CType:
        """The type of the operand of `sizeof`; the operand is not evaluated."""
        _, place = self.b.collect_effects(lambda: build.complete(self.place(node)))
        if isinstance(place, LValue) and place.bits is not None:
            raise self.error(node, "a bit-field has no size")
        return place.ctype

    # Initialisers

    def initialiser(self, node: ast.expr) -> Item | Braces:
        """The right side of a declaration: a value, or a list for elements or members, in order or by name."""
        where = self.where(node)
        match node:
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                return Braces(where, [self.initialiser(part) for part in parts])
            case ast.Dict(keys=keys, values=parts):
                return Braces(where, [self.named(self.index(k, node), p) for k, p in zip(keys, parts, strict=True)])
            case ast.Call(args=parts, keywords=keywords) if (ctype := self.constructed(node)) is not None:
                if not ctype.members:
                    raise self.error(node, f"{ctype} has no members here: declare it before")
                given = [self.initialiser(part) for part in parts]
                for keyword in keywords:
                    if keyword.arg is None:
                        raise self.error(node, "C has no ** arguments: write the members by name")
                    given.append(self.named(keyword.arg, keyword.value))
                return Braces(where, given, ctype=ctype)
            case ast.Starred():
                raise self.error(node, f"'{shown(node)}' (Starred) is not in the language: write the values")
        return Item(where, lambda ctype: self.wanted(node, ctype))

    def named(self, designator: str | int, node: ast.expr) -> Item | Braces:
        """The value of the member or element that `designator` names."""
        given = self.initialiser(node)
        given.way = (designator,)
        return given

    def index(self, key: ast.expr | None, node: ast.expr) -> int:
        """The element that a key of `{2: 5}` names."""
        if key is None:
            raise self.error(node, "C has no ** in a list: write the elements")
        if isinstance(key, ast.Constant) and isinstance(key.value, str) and len(key.value) != 1:
            raise self.error(key, "members by name are arguments: write point(x=1) for a structure point")
        return self.types.constant(key)

    def initial(self, ctype: CType, node: ast.expr) -> list[Expr]:
        """The initial value of every scalar of an object."""
        if isinstance(ctype, ArrayType | StructType):
            return build.values(self.b, ctype, self.initialiser(node))
        return [self.converted(node, ctype)]

    def length(self, annotation: ast.expr, ctype: CType, node: ast.expr | None) -> CType:
        """The type of an object: `array[T]` takes its length from its list or text."""
        match annotation:
            case ast.Subscript(value=ast.Name(id="array"), slice=part) if not isinstance(part, ast.Tuple):
                assert isinstance(ctype, PointerType)
                if node is None:
                    raise self.error(annotation, f"this array has no length: write array[{shown(part)}, LENGTH]")
                length = build.length_given(ctype.target, self.initialiser(node))
                return build.array_of(ctype.target, length, self.where(annotation))
        return ctype

    def constant_value(self, node: ast.expr) -> int | float | None:
        """The value of an expression that is constant at translation time, else None."""
        return build.constant_value(self.value(node))
