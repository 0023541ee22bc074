"""From source to typed tree: names, expressions, conversions.

C's rules are applied here and nowhere else: promotions and usual arithmetic conversions (`ctypes.usual`), decay of
arrays, the types of constants (a hexadecimal 0x8000..0xFFFF is unsigned int, a decimal one is long), default
promotions of variable arguments.
"""

from __future__ import annotations

import ast
from typing import Any, Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.constants import constant_type, fold
from emulator.c28x.ctypes import (
    CHAR,
    FLOAT,
    INT,
    LONG,
    ULONG,
    VOID,
    ArrayType,
    CType,
    FloatType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    StructType,
    is_arithmetic,
    promote,
    usual,
)  # fmt: skip
from emulator.c28x.lowering_places import PlaceLowering
from emulator.c28x.symbols import CoreRegister, Define
from emulator.c28x.tree import (
    AddressOf,
    Binary,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    Function,
    FunctionRef,
    Load,
    Logic,
    LValue,
    Not,
    Null,
    PointerAdd,
    PointerDifference,
    RegisterLoad,
    RegisterRef,
    String,
    Unary,
    Variable,
)  # fmt: skip

_OPS: Final[dict[type, str]] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Mod: "%", ast.LShift: "<<", ast.RShift: ">>",
    ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
_COMPARE: Final[dict[type, str]] = {
    ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
}  # fmt: skip


class ExpressionLowering(PlaceLowering):
    """Lowers expressions of one function (or of a file-scope initialiser)."""

    # Values

    def expression(self, node: ast.expr) -> Expr:
        """The value of an expression, arrays decayed."""
        match node:
            case ast.Constant():
                return self.constant(node)
            case ast.Name(id=name):
                return self.name(node, name)
            case ast.Attribute() | ast.Subscript():
                enumerated = self.enumerated(node)
                if enumerated is not None:
                    return Const(INT, enumerated)
                return self.value_of(self.lvalue(node))
            case ast.BinOp(left=left, op=op, right=right):
                return self.binary(op, self.expression(left), self.expression(right), node)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return Not(INT, self.condition(operand))
            case ast.UnaryOp(op=op, operand=operand):
                return self.unary(op, self.expression(operand), node)
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                return self.compare(op, self.expression(left), self.expression(right), node)
            case ast.Compare():
                raise self.error(
                    node, "a chained comparison means something else in C: write (a < b) < c, or a < b and b < c"
                )
            case ast.BoolOp(op=op, values=values):
                return Logic(INT, "and" if isinstance(op, ast.And) else "or", [self.condition(v) for v in values])
            case ast.IfExp(test=test, body=then, orelse=otherwise):
                return self.conditional(test, then, otherwise)
            case ast.Call():
                return self.call(node)
        raise self.error(node, f"'{ast.unparse(node)}' ({type(node).__name__}) is not in the language")

    def effect(self, node: ast.expr) -> Expr:
        """An expression statement."""
        if not isinstance(node, ast.Call):
            raise self.error(node, f"'{ast.unparse(node)}' has no effect")
        return self.expression(node)

    def condition(self, node: ast.expr) -> Expr:
        """A controlling expression: anything scalar."""
        value = self.expression(node)
        if isinstance(value.ctype, StructType) or value.ctype == VOID:
            raise self.error(node, f"a {value.ctype} is not a condition")
        return value

    def constant(self, node: ast.Constant) -> Expr:
        value = node.value
        if isinstance(value, bool) or value is None:
            raise self.error(node, f"{value} is not C: write 1, 0 or NULL")
        if isinstance(value, float):
            return Const(FLOAT, f32(value))
        if isinstance(value, str):
            if len(value) == 1:
                return Const(INT, ord(value))
            return String(PointerType("char *", CHAR), value)
        if not isinstance(value, int):
            raise self.error(node, f"{value!r} is not a C constant")
        # Columns count UTF-8 bytes.
        written = self.source_lines[node.lineno - 1].encode()[node.col_offset : node.end_col_offset]
        text = written.decode(errors="replace").lower()
        return Const(constant_type(value, text.startswith(("0x", "0b", "0o"))), value)

    def name(self, node: ast.expr, name: str) -> Expr:
        variable = self.scope.get(name)
        if variable is not None:
            return self.value_of(LValue(variable.ctype, variable, where=self.where(node), text=name))
        symbol = self.module.symbols.get(name)
        match symbol:
            case Variable():
                return self.value_of(LValue(symbol.ctype, symbol, where=self.where(node), text=name))
            case Define():
                return self.define(symbol)
            case CoreRegister():
                return self.value_of(self.lvalue(node))
            case Function():
                self.function.calls.add(symbol.path)
                return FunctionRef(symbol.ctype, symbol)
            case None if name == "NULL":
                return Null(PointerType("void *", VOID))
        raise self.undeclared(node, name, f"{name} is not declared")

    def define(self, define: Define) -> Expr:
        """A `#define`: its replacement, evaluated where it is used."""
        lines, self.source_lines = self.source_lines, define.lines
        try:
            return self.expression(define.node)
        finally:
            self.source_lines = lines

    def constant_value(self, node: ast.expr) -> int | float | None:
        """The number that an expression is, if it is one at translation time."""
        folded = fold(self.expression(node))
        return folded.value if isinstance(folded, Const) else None

    def value_of(self, place: LValue | RegisterRef) -> Expr:
        """Lvalue to value: arrays decay to a pointer to their first element."""
        if isinstance(place, RegisterRef):
            return RegisterLoad(place.ctype, place)
        if isinstance(place.ctype, ArrayType):
            if isinstance(place.root, Variable):
                place.root.escapes = True
            element = place.ctype.element
            return AddressOf(PointerType(f"{element} *", element), place)
        return Load(place.ctype, place)

    # Operators

    def unary(self, op: ast.unaryop, operand: Expr, node: ast.expr) -> Expr:
        if isinstance(op, ast.Invert) and isinstance(operand.ctype, IntType):
            ctype = promote(operand.ctype)
            return fold(Unary(ctype, "~", self.convert(operand, ctype, node)))
        if isinstance(op, ast.USub | ast.UAdd) and is_arithmetic(operand.ctype):
            target: CType = promote(operand.ctype) if isinstance(operand.ctype, IntType) else operand.ctype
            converted = self.convert(operand, target, node)
            return converted if isinstance(op, ast.UAdd) else fold(Unary(target, "-", converted))
        raise self.error(node, f"this operator does not apply to a {operand.ctype}")

    def binary(self, op: ast.operator, left: Expr, right: Expr, node: ast.expr) -> Expr:
        """`left op right` with C's conversions."""
        symbol = _OPS.get(type(op))
        if symbol is None:
            raise self.error(node, "not an operator of C (// and ** do not exist; / divides integers by truncation)")
        if isinstance(left.ctype, PointerType):
            if symbol == "-" and isinstance(right.ctype, PointerType):
                return PointerDifference(LONG, left, right)
            if symbol in "+-" and isinstance(right.ctype, IntType):
                return PointerAdd(left.ctype, left, right, negative=symbol == "-")
        if isinstance(right.ctype, PointerType) and symbol == "+" and isinstance(left.ctype, IntType):
            return PointerAdd(right.ctype, right, left)
        if not is_arithmetic(left.ctype) or not is_arithmetic(right.ctype):
            raise self.error(node, f"{left.ctype} {symbol} {right.ctype} is not C")
        if symbol in ("<<", ">>"):
            if not isinstance(left.ctype, IntType) or not isinstance(right.ctype, IntType):
                raise self.error(node, "shifts are for integers")
            ctype: CType = promote(left.ctype)
            return fold(
                Binary(ctype, symbol, self.convert(left, ctype, node), self.convert(right, promote(right.ctype), node))
            )
        ctype = usual(left.ctype, right.ctype)
        if symbol in ("%", "&", "|", "^") and isinstance(ctype, FloatType):
            raise self.error(node, f"{symbol} is for integers")
        return fold(Binary(ctype, symbol, self.convert(left, ctype, node), self.convert(right, ctype, node)))

    def compare(self, op: ast.cmpop, left: Expr, right: Expr, node: ast.expr) -> Expr:
        symbol = _COMPARE.get(type(op))
        if symbol is None:
            raise self.error(node, "not a comparison of C")
        if is_arithmetic(left.ctype) and is_arithmetic(right.ctype):
            ctype = usual(left.ctype, right.ctype)
            return Compare(INT, symbol, self.convert(left, ctype, node), self.convert(right, ctype, node))
        pointers = PointerType | HandleType | FunctionType
        if isinstance(left.ctype, pointers) and isinstance(right.ctype, pointers):
            return Compare(INT, symbol, left, right)
        raise self.error(node, f"{left.ctype} {symbol} {right.ctype} is not C")

    def conditional(self, test: ast.expr, then: ast.expr, otherwise: ast.expr) -> Expr:
        a, b = self.expression(then), self.expression(otherwise)
        ctype = usual(a.ctype, b.ctype) if is_arithmetic(a.ctype) and is_arithmetic(b.ctype) else a.ctype
        return Conditional(ctype, self.condition(test), self.convert(a, ctype, then), self.convert(b, ctype, otherwise))

    # Calls, casts

    def call(self, node: ast.Call) -> Expr:
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args):
            raise self.error(node, "C has no keyword or starred arguments")
        if isinstance(node.func, ast.Name) and node.func.id not in self.scope:
            name = node.func.id
            if name in ("addressof", "cast", "sizeof"):
                return self.operator_call(name, node)
            symbol = self.module.symbols.get(name)
            if isinstance(symbol, Function):
                return self.call_function(symbol, node)
            ctype = self.types.try_type(node.func)
            if ctype is not None:
                if len(node.args) != 1:
                    raise self.error(node, f"a cast to {ctype} takes one value")
                return self.convert(self.expression(node.args[0]), ctype, node.args[0], explicit=True)
            if not isinstance(symbol, Variable):
                raise self.error(node, f"{name} is not declared: declare it in a header as @extern, or import it")
        target = self.expression(node.func)
        if not isinstance(target.ctype, FunctionType):
            raise self.error(node, f"'{ast.unparse(node.func)}' is a {target.ctype}, not a function")
        wanted = target.ctype.parameters
        if len(node.args) != len(wanted):
            raise self.error(node, f"this function takes {len(wanted)} arguments, {len(node.args)} given")
        arguments = [self.convert(self.expression(a), t, a) for a, t in zip(node.args, wanted, strict=True)]
        return CallPointer(target.ctype.result, target, arguments)

    def call_function(self, function: Function, node: ast.Call) -> Expr:
        wanted = function.ctype.parameters
        if len(node.args) < len(wanted) or (len(node.args) > len(wanted) and not function.ctype.variadic):
            raise self.error(node, f"{function.name} takes {len(wanted)} arguments, {len(node.args)} given")
        arguments = [self.convert(self.expression(a), t, a) for a, t in zip(node.args, wanted, strict=False)]
        extra = [self.default_promotion(self.expression(a), a) for a in node.args[len(wanted) :]]
        self.function.calls.add(function.path)
        return Call(function.ctype.result, function, arguments, extra)

    def default_promotion(self, value: Expr, node: ast.expr) -> Expr:
        if isinstance(value.ctype, IntType):
            return self.convert(value, promote(value.ctype), node)
        return value

    def operator_call(self, name: str, node: ast.Call) -> Expr:
        if name == "addressof" and len(node.args) == 1:
            function = self.module.symbols.get(ast.unparse(node.args[0]))
            if isinstance(function, Function):
                return self.expression(node.args[0])
            place = self.lvalue(node.args[0])
            if isinstance(place, RegisterRef):
                raise self.error(node, "the address of a register is not in the language")
            if isinstance(place.root, Variable):
                place.root.escapes = True
            return AddressOf(PointerType(f"{place.ctype} *", place.ctype), place)
        if name == "cast" and len(node.args) == 2:
            ctype = self.types.ctype(node.args[0])
            return self.convert(self.expression(node.args[1]), ctype, node, explicit=True)
        if name == "sizeof" and len(node.args) == 1:
            ctype = self.types.try_type(node.args[0]) or self.lvalue(node.args[0]).ctype
            return Const(ULONG, ctype.words, text="sizeof")
        raise self.error(node, f"{name} used wrongly")

    def convert(self, value: Expr, ctype: CType, node: ast.AST, *, explicit: bool = False) -> Expr:
        """Convert to `ctype` as by assignment (or by a cast)."""
        if isinstance(value, Null) or (isinstance(value, Const) and value.value == 0 and not is_arithmetic(ctype)):
            if is_arithmetic(ctype):
                if explicit or isinstance(ctype, IntType):
                    return Const(ctype, 0)
                raise self.error(node, f"NULL is not a {ctype}")
            return Null(ctype)
        if isinstance(ctype, PointerType) and isinstance(node, ast.Constant) and isinstance(node.value, str):
            return String(ctype, node.value)
        source = value.ctype
        if source == ctype and type(source) is type(ctype):
            # A cast to the type that a result has anyway says that its wrap is meant.
            return Convert(ctype, value, explicit) if explicit and isinstance(value, Binary) else value
        if is_arithmetic(source) and is_arithmetic(ctype):
            return fold(Convert(ctype, value, explicit))
        addresses = PointerType | HandleType | FunctionType
        if isinstance(ctype, addresses) and isinstance(source, addresses):
            if isinstance(ctype, PointerType) and isinstance(source, PointerType) and not explicit:
                loose = VOID in (ctype.target, source.target)
                same = ctype.target.name == source.target.name
                if not loose and not same:
                    raise self.error(
                        node, f"a {source} given where a {ctype} is wanted: C needs cast(ptr[{ctype.target}], ...)"
                    )
            return Convert(ctype, value)
        if explicit and isinstance(ctype, PointerType) and isinstance(source, IntType):
            return Convert(ctype, value)
        if explicit and isinstance(ctype, IntType) and isinstance(source, PointerType):
            return Convert(ctype, value)
        if ctype == VOID:
            return value
        raise self.error(node, f"a {source} cannot become a {ctype}")

    def aggregate(self, ctype: CType, node: ast.expr) -> list[Any]:
        """An initialiser list: one value per scalar; what is left out is zero, as in C."""
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and isinstance(ctype, ArrayType):
            text = [ord(c) for c in node.value][: ctype.length]
            return [*(Const(ctype.element, c) for c in text), *([Const(ctype.element, 0)] * (ctype.length - len(text)))]
        if not isinstance(node, ast.Tuple | ast.List):
            raise self.error(node, f"a {ctype} is initialised by a tuple")
        parts = [m.ctype for m in ctype.members] if isinstance(ctype, StructType) else []
        if isinstance(ctype, ArrayType):
            parts = [ctype.element] * ctype.length
        if len(node.elts) > len(parts):
            raise self.error(node, f"too many initialisers for a {ctype}: {len(node.elts)} for {len(parts)}")
        values: list[Any] = []
        for i, part in enumerate(parts):
            given = node.elts[i] if i < len(node.elts) else None
            if isinstance(part, ArrayType | StructType):
                values.extend(self.aggregate(part, given if given is not None else ast.Tuple([], ast.Load())))
            elif given is None:
                values.append(Const(part, 0) if is_arithmetic(part) else Null(part))
            else:
                values.append(self.convert(self.expression(given), part, given))
        return values
