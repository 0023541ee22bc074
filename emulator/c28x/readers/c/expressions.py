"""Expressions of C: the reader passes each construct to the builder."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Final

from pycparser import c_ast

from emulator.c28x import build
from emulator.c28x.build import Braces, Builder, Item, Place
from emulator.c28x.ctypes import (
    FLOAT,
    INT,
    LONG,
    UINT,
    ULONG,
    VOID,
    ArrayType,
    BlockType,
    CType,
    FunctionType,
    IntType,
    PointerType,
    StructType,
)  # fmt: skip
from emulator.c28x.readers.c import headers, literals
from emulator.c28x.readers.c.intrinsics import PLAIN, plain
from emulator.c28x.readers.c.no_object import Prototype, Unsized
from emulator.c28x.readers.c.types import Abi, CTypeReader, specifier
from emulator.c28x.readers.c.written import written
from emulator.c28x.symbols import CoreRegister, Define, Enumerator, EnumType, RegisterBlock, SourceError, nearest
from emulator.c28x.tree import (
    Call,
    CallPointer,
    Const,
    Declaration,
    Expr,
    Function,
    FunctionRef,
    LValue,
    RegisterLoad,
    Variable,
    Where,
)  # fmt: skip
from emulator.c28x.tree_queries import parts

_COMPARISONS: Final = ("==", "!=", "<", "<=", ">", ">=")
_ARITHMETIC: Final = {f"{op}=": op for op in build.BINARY}


def _instead(text: str) -> str:
    """What to write instead of an unknown instruction."""
    if re.match(r"(PUSH|POP) ST1$", text, re.IGNORECASE):
        return "write __disable_interrupts() and __restore_interrupts() around what they protect"
    return "write in C what it does"


def _intrinsic(name: str, result: CType, *parameters: CType) -> Function:
    """Make a function that the compiler knows without a declaration."""
    listed = [Variable(Declaration("", p, "intrinsic", "", 0, name), p, "parameter") for p in parameters]
    return Function(name, "intrinsic", FunctionType(name, result, parameters), listed, 0, "", extern=True)


#: Disable, enable and restore interrupts (SPRU514, "Intrinsics"); `emulator.c28x.intrinsics` implements them.
INTERRUPTS: Final = {
    "__disable_interrupts": _intrinsic("__disable_interrupts", UINT),
    "__enable_interrupts": _intrinsic("__enable_interrupts", UINT),
    "__restore_interrupts": _intrinsic("__restore_interrupts", VOID, UINT),
}
#: The trigonometric unit, and other instructions of one float (SPRU514, "TMU" and "FPU Intrinsics").
FLOATS: Final = {
    name: _intrinsic(name, FLOAT, *(FLOAT,) * count)
    for name, count in (
        ("__einvf32", 1), ("__eisqrtf32", 1),
        ("__sin", 1), ("__cos", 1), ("__atan", 1), ("__atan2", 2), ("__sinpuf32", 1), ("__cospuf32", 1),
        ("__atanpuf32", 1), ("__sqrt", 1), ("__divf32", 2), ("__fmax", 2), ("__fmin", 2), ("__fracf32", 1),
    )
}  # fmt: skip
#: Fixed-point products and limits (SPRU514, "Intrinsics"); `emulator.c28x.rts_iqmath` implements them.
FIXED_POINT: Final = {
    "__IQmpy": _intrinsic("__IQmpy", LONG, LONG, LONG, INT), "__IQxmpy": _intrinsic("__IQxmpy", LONG, LONG, LONG, INT),
    "__IQsat": _intrinsic("__IQsat", LONG, LONG, LONG, LONG), "__IQ": _intrinsic("__IQ", LONG, FLOAT, INT),
}  # fmt: skip
#: `RPT #n || NOP`: waits for this number of cycles.
_IDLE_CYCLES: Final = _intrinsic("__idle_cycles", VOID, UINT)
#: `IDLE`: waits for an interrupt.
_IDLE: Final = _intrinsic("__idle", VOID)
_MODES: Final = re.compile(r"(SETC|CLRC) ((?:INTM|DBGM)(?: ?, ?(?:INTM|DBGM))?)", re.IGNORECASE)
_REPEATED: Final = re.compile(r"RPT ?#\(?(0x[0-9a-f]+|0|[1-9]\d*)\)? ?\|\| ?NOP", re.IGNORECASE)
_MAX_REPEATED: Final = 255
#: `IACK` starts tasks of the CLA, as a write to MIFRC does (TRM 7.3.3, "Software Trigger").
_IACK: Final = re.compile(r"IACK ?#(0x[0-9a-f]+|\d+)", re.IGNORECASE)
#: Save and restore of registers that C does not see, around a call of code that changes them.
_KEPT: Final = re.compile(
    r"(PUSH|POP) (ACC|P|XT|DP|XAR[0-7]|AR[0-7](:AR[0-7])?|RPC|RB)"
    r"|MOV32 \*SP\+\+ ?, ?(R[0-7]H|STF)|MOV32 (R[0-7]H|STF) ?, ?\*--SP(, ?UNCF?)?", re.IGNORECASE,
)
#: All functions that the compiler knows; a declaration of them in a file or header changes nothing.
INTRINSICS: Final = frozenset(
    {*INTERRUPTS, *FLOATS, *FIXED_POINT, *PLAIN, "__qmpy32", "__eallow", "__edis", "__byte", "__byte_peripheral_32"}
)


class CExpressionReader:
    """Reads expressions of one function, or of a file-scope initialiser, for the builder `b`."""

    def __init__(
        self, b: Builder, tags: dict[str, CType | EnumType], abi: Abi,
        implicit: Callable[[str, Where], Function | None], use: Callable[[Function | Variable, Where], None], *,
        around: CTypeReader | None = None,
    ) -> None:  # fmt: skip
        """`implicit` finds the function for a call without a declaration; `use` is called for every named symbol.

        Types contain expressions and expressions contain types, so this reader also has the `CTypeReader` of its scope;
        `tags`, `abi` and `around` are passed to it.
        """
        self.use = use
        self.b = b
        self.types = CTypeReader(b, tags, abi, self.constant_expression, around)
        self.implicit = implicit
        self._read: dict[str, Callable[[Any], Expr]] = {
            "Constant": self.constant, "ID": self.identifier, "ArrayRef": self.loaded, "StructRef": self.loaded,
            "UnaryOp": self.unary, "BinaryOp": self.binary, "TernaryOp": self.ternary, "Assignment": self.assignment,
            "FuncCall": self.call, "Cast": self.cast, "ExprList": self.comma, "CompoundLiteral": self.loaded,
            "Parenthesised": self.assignment,
        }  # fmt: skip

    def value(self, node: c_ast.Node) -> Expr:
        """The value of an expression; arrays and functions decay to pointers."""
        read = self._read.get(type(node).__name__)
        if read is None:
            raise SourceError.at(node.coord, f"{type(node).__name__} is not an expression of C")
        with self.b.nested(node.coord):
            if not _orders(node):
                return build.shallow(self.b, read(node))
            with self.b.sequence():
                return build.shallow(self.b, read(node))

    def operands(self, *nodes: c_ast.Node) -> list[Expr]:
        """The values of operands, evaluated from left to right."""
        return build.arguments(self.b, [partial(self.value, node) for node in nodes])

    def constant_expression(self, node: c_ast.Node) -> Expr:
        """An expression that must not have effects: a length, a label.  Raises SourceError if it has any."""
        effects, value = self.b.collect_effects(lambda: self.value(node))
        if effects:
            raise SourceError.at(node.coord, "this must be a constant: it has an effect")
        return value

    # Values

    def constant(self, node: c_ast.Constant) -> Expr:
        """A literal."""
        text, where = node.value, node.coord
        if text.startswith(('"', 'L"')):
            return literals.string(text, where)
        return literals.character(text, where) if text.endswith("'") else literals.number(text, where, self.b.double)

    def identifier(self, node: c_ast.ID) -> Expr:
        """The value of a name."""
        name, where = node.name, node.coord
        match self.b.look_up(name):
            case Variable() as variable:
                self.use(variable, where)
                return build.value_of(self.b, build.object_place(variable, where))
            case Enumerator(value=value):
                fits = INT.low <= value <= INT.high  # TI's compiler accepts longs too (SPRU514, "Enumeration type")
                return Const(INT if fits else LONG if value <= LONG.high else ULONG, value, where=where)
            case Define() as define:
                return define.expression(self.b, where)
            case Function() as function:
                self.use(function, where)
                return build.function_value(self.b, function, where)
            case CoreRegister() as register:
                return build.value_of(self.b, build.core_register(register, where))
            case RegisterBlock() as block:
                return build.value_of(self.b, build.register_block(block, where))
            case CType():
                raise SourceError.at(where, f"{name} is a type, not a value")
        unmodelled = headers.unmodelled_block(name)
        if unmodelled is not None:
            return build.value_of(self.b, build.unmodelled_block(unmodelled, where))
        if name in ("__func__", "__FUNCTION__"):
            return build.string(self.b.function.name, where)
        raise self.undeclared(name, where)

    def undeclared(self, name: str, where: Where, otherwise: str = "") -> SourceError:
        """The error about an undeclared name.  It ends in a similar name, or in `otherwise` if there is none."""
        alike = nearest(name, [*self.b.module.symbols, *self.b.scope])
        return self.b.undeclared(name, where, headers.hint(name) or f"{name} is not declared{alike or otherwise}")

    def loaded(self, node: c_ast.Node) -> Expr:
        """The value of the place that an expression designates."""
        place = self.place(node)
        return place if isinstance(place, Expr) else build.value_of(self.b, place)

    # Places

    def place(self, node: c_ast.Node) -> Place | Expr:
        """The place that an expression designates; for a function or a call, its value."""
        b, where = self.b, node.coord
        match node:
            case c_ast.ID(name=name):
                match b.look_up(name):
                    case Variable() as variable:
                        self.use(variable, where)
                        return build.object_place(variable, where)
                    case RegisterBlock() as block:
                        return build.register_block(block, where)
                    case CoreRegister() as register:
                        return build.core_register(register, where)
                    case None if (unmodelled := headers.unmodelled_block(name)) is not None:
                        return build.unmodelled_block(unmodelled, where)
                return self.value(node)
            case c_ast.StructRef():
                with b.nested(where):
                    return self.member(node)
            case c_ast.ArrayRef():
                with b.nested(where):
                    base, index = build.operands(b, lambda: self.place(node.name), lambda: self.value(node.subscript))
                assert isinstance(index, Expr)
                if isinstance(base.ctype if not isinstance(base, build.RegisterPath) else None, IntType) and (
                    isinstance(index.ctype, PointerType)
                ):
                    base, index = index, self.as_value(base)  # 2[v] is v[2]
                return build.element(b, base, index, where, written(node), written(node.name))
            case c_ast.UnaryOp(op="*"):
                with b.nested(where):
                    pointer = self.value(node.expr)
                if not isinstance(pointer.ctype, PointerType | FunctionType):
                    raise SourceError.at(node.expr.coord, f"'{written(node.expr)}' is a {pointer.ctype}, not a pointer")
                return build.dereference(b, pointer, where, written(node))
            case c_ast.CompoundLiteral():
                return self.compound_literal(node)
            case c_ast.FuncCall() if self.is_octet(node):
                return self.octet(node)
        value = self.value(node)
        return build.in_temporary(b, value, where) if isinstance(value.ctype, StructType) else value

    def as_value(self, place: Place | Expr) -> Expr:
        """The value of a place."""
        return place if isinstance(place, Expr) else build.value_of(self.b, place)

    def object(self, node: c_ast.Node, what: str) -> Place:
        """The object that an operation changes.  Raises SourceError if the expression is not an object."""
        place = self.place(node)
        if isinstance(place, Expr):
            message = f"{what} needs an object: '{written(node)}' is a value, nothing to assign to"
            raise SourceError.at(node.coord, message)
        place = build.complete(place)
        if isinstance(place, LValue):
            root = place.root
            if isinstance(place.ctype, ArrayType):
                raise SourceError.at(node.coord, "an array is not assignable in C")
            if isinstance(root, Variable) and root.constant:
                raise SourceError.at(node.coord, f"{root.declaration.name} is const: nothing is assigned to it")
        return place

    def member(self, node: c_ast.StructRef) -> Place:
        """`a.b` or `a->b`."""
        b, where = self.b, node.coord
        base = self.place(node.name)
        shown = written(node.name)
        ctype = None if isinstance(base, build.RegisterPath) else base.ctype
        if node.type == "->":
            if isinstance(ctype, ArrayType):
                base = self.as_value(base)
            elif not isinstance(ctype, PointerType):
                raise SourceError.at(node.name.coord, f"'{shown}' is not a pointer: write . instead of ->")
        elif isinstance(ctype, PointerType):
            raise SourceError.at(node.name.coord, f"'{shown}' is a {ctype}: write -> instead of .")
        elif isinstance(base, LValue | Expr) and not isinstance(ctype, StructType):
            raise SourceError.at(node.name.coord, f"'{shown}' is a {ctype}, not a structure")
        at = node.field.coord if isinstance(ctype, StructType | PointerType) else where
        made = build.member(b, base, node.field.name, at, text=written(node), base_text=shown)
        if isinstance(made, LValue):
            made.where = where
        return made

    def compound_literal(self, node: c_ast.CompoundLiteral) -> Place:
        """`(T){ ... }`: an object without a name."""
        where = node.coord
        ctype = self.types.ctype(node.type)
        given = self.initialiser(node.init)
        if isinstance(ctype, Unsized):
            ctype = build.array_of(ctype.element, build.length_given(ctype.element, given), where)
        return build.literal(self.b, ctype, given, where)

    # Operators

    def unary(self, node: c_ast.UnaryOp) -> Expr:
        """A unary operator."""
        b, where, op = self.b, node.coord, node.op
        match op:
            case "+" | "-" | "~":
                return build.unary(b, op, self.value(node.expr), where)
            case "!":
                return build.logical_not(b, self.value(node.expr), where)
            case "*":
                return self.loaded(node)
            case "&":
                return self.address(node)
            case "sizeof":
                return self.sizeof(node)
            case "++" | "--" | "p++" | "p--":
                place = self.object(node.expr, op.removeprefix("p"))
                return build.step(b, op[-1], place, where, before=len(op) == 2)
        raise SourceError.at(where, f"{op} is not an operator of C99")

    def address(self, node: c_ast.UnaryOp) -> Expr:
        """`&x`."""
        place = self.place(node.expr)
        if isinstance(place, Expr):
            if isinstance(place.ctype, FunctionType) and isinstance(node.expr, c_ast.ID | c_ast.UnaryOp):
                return place
            raise SourceError.at(node.expr.coord, f"& needs an object: '{written(node.expr)}' is a value")
        if isinstance(place, LValue) and place.bits is not None:
            at = node.expr.field.coord if isinstance(node.expr, c_ast.StructRef) else node.expr.coord
            raise SourceError.at(at, "a bit-field has no address")
        if isinstance(place, build.RegisterPath) and (ctype := self.types.register(place.way)) is not None:
            word = build.address_of(self.b, replace(place, way=place.way[:1]), node.coord)
            return build.convert(self.b, word, ctype.pointer, explicit=True)
        return build.address_of(self.b, place, node.coord)

    def sizeof(self, node: c_ast.UnaryOp) -> Expr:
        """`sizeof`: the operand is not evaluated."""
        inner = node.expr
        if isinstance(inner, c_ast.Typename):
            ctype = self.types.ctype(inner)
        elif isinstance(inner, c_ast.Constant) and inner.value.startswith('"'):
            value = literals.string(inner.value, inner.coord)
            ctype = ArrayType("char[]", INT, len(getattr(value, "text", "")) + 1)
        else:
            use, self.use = self.use, _unused
            try:
                _, place = self.b.collect_effects(lambda: self.place(inner))
            finally:
                self.use = use
            if isinstance(place, LValue) and place.bits is not None:
                at = inner.field.coord if isinstance(inner, c_ast.StructRef) else inner.coord
                raise SourceError.at(at, "a bit-field has no size")
            ctype = place.ctype
        if not isinstance(ctype, BlockType):
            self.types.complete(ctype, node.coord)
        return build.sizeof(ctype, node.coord)

    def binary(self, node: c_ast.BinaryOp) -> Expr:
        """A binary operator; a long chain is read without recursion."""
        if node.op in ("&&", "||"):
            return self.logic(node)
        row = [node]
        while isinstance(row[-1].left, c_ast.BinaryOp) and row[-1].left.op not in ("&&", "||"):
            row.append(row[-1].left)
        row.reverse()
        for step in row:
            self.tell_odd_operands(step)
        operands = [partial(self.value, operand) for operand in (row[0].left, *(step.right for step in row))]
        return build.row(self.b, operands, [(step.op, step.coord) for step in row])

    def tell_odd_operands(self, node: c_ast.BinaryOp) -> None:
        """Report a comparison with a text, and `10^6` for a power."""
        left, right = node.left, node.right
        text = written(node)
        if node.op in ("==", "!=") and any(isinstance(e, c_ast.Constant) and e.type == "string" for e in (left, right)):
            message = f"{text} compares addresses, and the text has its own: strcmp compares what is in it"
            self.b.remark(node.coord, "constant-condition", message, text)
        factor = left.right if isinstance(left, c_ast.BinaryOp) and left.op == "*" else left
        if node.op == "^" and _decimal(factor) in (2, 10) and (power := _decimal(right)) is not None:
            said = f"{factor.value}^{power}"
            message = f"{said} is {int(factor.value) ^ power} in C: ^ is the exclusive or, not a power"
            self.b.remark(node.coord, "mixed-logic", message, said)

    def logic(self, node: c_ast.BinaryOp) -> Expr:
        """`&&` and `||`; a chain of the same operator is one node."""
        parts = [node.right]
        left = node.left
        while isinstance(left, c_ast.BinaryOp) and left.op == node.op:
            parts.append(left.right)
            left = left.left
        builds = [lambda part=part: self.value(part) for part in (left, *reversed(parts))]
        return build.logic(self.b, "and" if node.op == "&&" else "or", builds, node.coord)

    def ternary(self, node: c_ast.TernaryOp) -> Expr:
        """`a ? b : c`."""
        test = self.value(node.cond)
        self.tell_odd_condition(node.cond)
        return build.conditional(
            self.b, test, lambda: self.value(node.iftrue), lambda: self.value(node.iffalse), node.coord
        )

    def tell_odd_condition(self, node: c_ast.Node) -> None:
        """Report assignments of constants, and functions, in a condition and in the operands of `!`, `&&` and `||`."""
        match node:
            case c_ast.ID(name=name) if isinstance(self.b.look_up(name), Function):
                message = f"{name} is a function, whose address is never 0: {name}() calls it"
                self.b.remark(node.coord, "constant-condition", message, name)
            case c_ast.UnaryOp(op="!", expr=inner):
                self.tell_odd_condition(inner)
            case c_ast.BinaryOp(op="&&" | "||", left=left, right=right):
                self.tell_odd_condition(left)
                self.tell_odd_condition(right)
            case c_ast.Assignment(op="=") if self.assigns_constant(node):
                self.tell_assigned(node)

    def assigns_constant(self, node: c_ast.Assignment) -> bool:
        """Whether an assignment gives a constant."""
        effects, value = self.b.collect_effects(lambda: self.value(node.rvalue))
        return not effects and build.constant_value(value) is not None

    def tell_assigned(self, node: c_ast.Assignment) -> None:
        """Report an assignment as a condition."""
        text = written(node.lvalue)
        message = f"the condition assigns {written(node.rvalue)} to {text}: == compares"
        self.b.remark(node.coord, "assigned-condition", message, text)

    def assignment(self, node: c_ast.Assignment) -> Expr:
        """An assignment used as a value."""
        b, where = self.b, node.coord
        if node.op == "=":
            place, value = self.assigned_operands(node)
            return build.assigned(b, place, value, where)
        place, value = self.assigned_operands(node)
        place = build.complete(build.evaluated_once(b, place))
        result = build.binary(b, _ARITHMETIC[node.op], build.value_of(b, place), value, where)
        return build.assigned(b, place, result, where)

    def assigned_operands(self, node: c_ast.Assignment) -> tuple[Place, Expr]:
        """The two sides of an assignment."""
        what = "an assignment"
        effects: list[Any] = []

        def right() -> Expr:
            before, value = self.b.collect_effects(lambda: self.value(node.rvalue))
            effects.extend(before)
            self.b.out.extend(before)
            return value

        place, value = build.operands(self.b, lambda: self.object(node.lvalue, what), right)
        assert isinstance(value, Expr)
        assert not isinstance(place, Expr)
        if value.ctype == VOID:
            raise SourceError.at(node.rvalue.coord, f"'{written(node.rvalue)}' is void: it has no value")
        if isinstance(place, LValue) and build.writes_itself(self.b, effects, place):
            build.unsequenced(self.b, place)
        return place, value

    def comma(self, node: c_ast.ExprList) -> Expr:
        """`a, b`: the value of the last."""
        for part in node.exprs[:-1]:
            self.effect(part)
        return self.value(node.exprs[-1])

    # Statements' expressions

    def effect(self, node: c_ast.Node) -> None:
        """An expression that is evaluated for its effect."""
        b, where = self.b, node.coord
        match node:
            case c_ast.Assignment(op="="):
                place, value = self.assigned_operands(node)
                build.assign(b, place, value, where)
            case c_ast.Assignment(op=op):
                place, value = self.assigned_operands(node)
                build.combined(b, _ARITHMETIC[op], place, value, where)
            case c_ast.UnaryOp(op="++" | "--" | "p++" | "p--" as op):
                place = self.object(node.expr, op.removeprefix("p"))
                build.combined(b, op[-1], place, Const(INT, 1, where=where), where)
            case c_ast.ExprList():
                for part in node.exprs:
                    self.effect(part)
            case c_ast.Cast(expr=c_ast.BinaryOp()) if self.types.ctype(node.to_type) == VOID:
                build.evaluate(b, self.value(node.expr))
            case c_ast.Cast() if self.types.ctype(node.to_type) == VOID:
                self.effect(node.expr)
            case c_ast.FuncCall(name=c_ast.ID(name="__asm")):
                self.assembler(node)
            case _:
                value = self.value(node)
                if _idle(node, value):
                    text = written(node)
                    self.b.remark(where, "idle-statement", f"{text} is computed and not used", text)
                build.evaluate(b, value)

    def assembler(self, node: c_ast.FuncCall) -> None:
        """`asm("...")`: the modelled instructions, one per line."""
        value = literals.string(node.args.exprs[0].value, node.coord)
        for line in getattr(value, "text", "").split("\n"):
            text = " ".join(line.partition(";")[0].split())
            if text:
                self.instruction(text, node.coord)

    def instruction(self, text: str, where: Where) -> None:
        """One assembler instruction.  Raises SourceError for one that is not modelled."""
        modes = _MODES.fullmatch(text)
        repeated = _REPEATED.fullmatch(text)
        if modes is not None:
            for mode in modes[2].split(","):
                self.core(headers.ASSEMBLER[f"{modes[1]} {mode.strip()}".upper()], where)
        elif repeated is not None and int(repeated[1], 0) <= _MAX_REPEATED:
            times = Const(UINT, int(repeated[1], 0) + 1, where=where)
            build.evaluate(self.b, build.call(self.b, _IDLE_CYCLES, [times], where))
        elif text.upper() == "IDLE":
            build.evaluate(self.b, build.call(self.b, _IDLE, [], where))
        elif _KEPT.fullmatch(text) is not None:
            pass
        elif (started := _IACK.fullmatch(text)) is not None:
            tasks = Const(ULONG, int(started[1], 0) & 0xFFFF, where=where)
            cla = headers.unmodelled_block("Cla1Regs")
            assert cla is not None
            block = build.unmodelled_block(cla, where)
            force = build.member(self.b, block, "MIFRC", where, text="Cla1Regs.MIFRC", base_text="Cla1Regs")
            whole = build.member(self.b, force, "all", where, text="Cla1Regs.MIFRC.all", base_text="Cla1Regs.MIFRC")
            build.assign(self.b, whole, tasks, where)
        elif text.upper() in headers.ASSEMBLER:
            self.core(headers.ASSEMBLER[text.upper()], where)
        else:
            known = ", ".join(headers.ASSEMBLER)
            message = f'asm("{text}") is not modelled: known are {known}, IDLE, IACK #n, RPT #n || NOP'
            raise SourceError.at(where, f"{message}; {_instead(text)}, or leave it out with #if and -D")

    def core(self, name: str, where: Where) -> None:
        """A statement of the core by its C name, a function of the device header; an empty name does nothing."""
        function = self.implicit(name, where) if name else None
        if function is not None and function.extern:  # not the user's: it may contain this
            build.evaluate(self.b, build.call(self.b, function, [], where))

    # Calls and casts

    def cast(self, node: c_ast.Cast) -> Expr:
        """`(T)x`."""
        ctype = self.types.ctype(node.to_type)
        at = specifier(node.to_type)
        if isinstance(ctype, ArrayType | Prototype | Unsized):
            raise SourceError.at(at, f"a cast to a {ctype}: C casts to numbers and pointers")
        value = self.value(node.expr)
        if ctype == VOID:
            build.evaluate(self.b, value)
            return Const(VOID, 0, where=node.coord)
        if isinstance(value.ctype, StructType) or isinstance(ctype, StructType):
            raise SourceError.at(node.expr.coord, f"a cast of a {value.ctype}: C casts numbers and pointers")
        return build.convert(self.b, value, ctype, explicit=True)

    def call(self, node: c_ast.FuncCall) -> Expr:
        """A call."""
        where = node.coord
        arguments = node.args.exprs if node.args is not None else []
        if isinstance(node.name, c_ast.ID):
            name = node.name.name
            symbol = self.b.look_up(name)
            if symbol is None and name == "__asm":
                self.assembler(node)
                return Const(VOID, 0, where=where)
            if symbol is None and (known := self.intrinsic(name, arguments, where)) is not None:
                return known
            if symbol is None:
                symbol = self.implicit(name, where)
                if symbol is None:
                    raise self.undeclared(name, where, ", and no file defines it: name the one that does too")
                self.b.module.symbols[name] = symbol
                values = self.argument_values(arguments)
                self.remark_implicit(symbol, values, where)
                return build.call(self.b, symbol, values, where)
            if isinstance(symbol, Function):
                self.use(symbol, where)
                return build.call(self.b, symbol, self.argument_values(arguments), where)
        parts = [lambda: self.value(node.name), *[lambda a=a: self.value(a) for a in arguments]]
        target, *values = build.arguments(self.b, parts)
        return build.call_value(self.b, target, values, where, written(node.name))

    def argument_values(self, nodes: list[c_ast.Node]) -> list[Expr]:
        """The values of arguments.  Raises SourceError for one that is void."""
        values = self.operands(*nodes)
        for value, node in zip(values, nodes, strict=True):
            if value.ctype == VOID:
                raise SourceError.at(node.coord, f"'{written(node)}' is void: it has no value")
        return values

    def remark_implicit(self, function: Function, values: list[Expr], where: Where) -> None:
        """Make the remark about a call without a declaration: what C passes, and what the function takes."""
        wrong = []
        for i, (value, wanted) in enumerate(zip(values, function.ctype.parameters, strict=False), 1):
            passed = build.unnamed(self.b, value).ctype
            if passed.words != wanted.words:
                wrong.append(f"argument {i} is passed in {passed.words} words and taken from {wanted.words}")
        if function.ctype.result.words > 1:
            wrong.append(f"its result has {function.ctype.result.words} words and is taken for an int")
        name = function.name
        message = f"{name} is called without a declaration: C takes it for int {name}()"
        message += f"; {', '.join(wrong)}" if wrong else ""
        self.b.remark(where, "implicit-declaration", f"{message}. Include its header", name)

    # Intrinsics of TI's compiler

    def intrinsic(self, name: str, arguments: list[c_ast.Node], where: Where) -> Expr | None:
        """A call of a function that TI's compiler knows without a declaration; None for any other name."""
        b = self.b
        match name, len(arguments):
            case "__eallow" | "__edis", 0:
                self.core({"__eallow": "EALLOW", "__edis": "EDIS"}[name], where)
                return Const(VOID, 0, where=where)
            case _ if known := INTERRUPTS.get(name) or FLOATS.get(name) or FIXED_POINT.get(name):
                return build.call(b, known, self.argument_values(arguments), where)
            case "__qmpy32", 3:
                return build.call(b, FIXED_POINT["__IQmpy"], self.argument_values(arguments), where)
            case _ if name in PLAIN:
                return plain(b, name, self.argument_values(arguments), where)
            case "__byte" | "__byte_peripheral_32", _ if len(arguments) == (2 if name == "__byte" else 1):
                return build.value_of(b, self.octet(c_ast.FuncCall(c_ast.ID(name), c_ast.ExprList(arguments), where)))
        return None

    def is_octet(self, node: c_ast.FuncCall) -> bool:
        """Whether a call is an intrinsic that designates an octet or a 32-bit register."""
        return (
            isinstance(node.name, c_ast.ID)
            and node.name.name in ("__byte", "__byte_peripheral_32")
            and (self.b.look_up(node.name.name) is None)
        )

    def octet(self, node: c_ast.FuncCall) -> Place:
        """`__byte(array, n)`: octet n; an even one is the lower half of its word.  `__byte_peripheral_32(p)`: `*p`."""
        b, where = self.b, node.coord
        arguments = node.args.exprs
        if len(arguments) == 1:
            place = build.dereference(b, self.value(arguments[0]), where, written(node))
            assert not isinstance(place, Expr)
            return place
        array, index = self.operands(*arguments)
        words = build.convert(b, array, UINT.pointer, explicit=True)
        return build.octet_of(words, index, where, written(node))

    # Initialisers

    def initialiser(self, node: c_ast.Node) -> Item | Braces:
        """The right side of a declaration."""
        if isinstance(node, c_ast.NamedInitializer):
            given = self.initialiser(node.expr)
            given.way = [self.designator(part) for part in node.name]
            first = node.name[0]
            given.where = getattr(first, "expr", first).coord
            return given
        if isinstance(node, c_ast.InitList):
            return Braces(node.coord, [self.initialiser(part) for part in node.exprs])
        return Item(node.coord, lambda ctype: self.value(node))

    def designator(self, node: c_ast.Node) -> str | int:
        """`.name` or `[index]`."""
        if isinstance(node, c_ast.ID):
            return str(node.name)
        inner = getattr(node, "expr", None) or getattr(node, "subscript", None) or node
        return self.types.number(inner, "a designator")


def _unused(symbol: Function | Variable, where: Where) -> None:
    """Do nothing: a name in `sizeof` is not a use, so it needs no definition."""


def _idle(node: c_ast.Node, value: Expr) -> bool:
    """Whether an operation as a statement has no effect.  `a && f()` has one, and so may a read of a register.

    The name of a function alone does not call it.
    """
    acts = any(isinstance(p, Call | CallPointer) for p in parts(value))
    reads = any(isinstance(p, RegisterLoad) for p in parts(value))
    match node:
        case c_ast.BinaryOp(op="&&" | "||"):
            return not acts
        case c_ast.BinaryOp(op=op):
            return op in _COMPARISONS or not (acts or reads)
        case c_ast.UnaryOp(op="-" | "~" | "!"):
            return not (acts or reads)
        case c_ast.ID():
            return isinstance(value, FunctionRef)
    return False


def _orders(node: c_ast.Node) -> bool:
    """Whether C sequences the effects within an expression before the use of its value."""
    if isinstance(node, c_ast.BinaryOp):
        return node.op in ("&&", "||")
    return isinstance(node, c_ast.FuncCall | c_ast.ExprList | c_ast.TernaryOp)


def _decimal(node: c_ast.Node) -> int | None:
    """The value of a decimal number that stands in the file itself; None: something else."""
    plain = isinstance(node, c_ast.Constant) and node.coord.macro is None and node.value.isdecimal()
    return int(node.value) if plain and (node.value[0] != "0" or node.value == "0") else None
