"""From typed tree to Python text: expressions.

Every expression becomes one Python expression.  Checks appear only where the translator cannot prove them away: an
interval for each integer expression removes wraps and bounds, definite assignment removes tests for never-written
objects.

Names in the generated text: `_g_x` data of a file-scope object, `_p_x` pointer to an object, `_f_x` firmware function,
`_x_x` extern, `_r_block_register_access` register, `_sN` site, `_tN` type or declaration, `_c_...` runtime, `_k` clock.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x import costs
from emulator.c28x.ctypes import INT, FloatType, FunctionType, HandleType, IntType, PointerType
from emulator.c28x.emit_conversions import ConversionEmitter
from emulator.c28x.intervals import Interval, exact, interval
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
    FunctionRef,
    Load,
    Logic,
    Not,
    Null,
    PointerAdd,
    PointerDifference,
    RegisterLoad,
    String,
    Unary,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, source_text

#: Factors that scale a ratio: per cent, per mille, milli.
SCALES: Final = (10, 100, 1000, 10000)


class ExpressionEmitter(ConversionEmitter):
    """Expression part of the emitter of one function."""

    # Values

    def value(self, e: Expr) -> str:
        """Python text for the value of `e`."""
        match e:
            case Const(value=value):
                return self.literal(value)
            case Null():
                return "_c_NULL"
            case String(text=text):
                name = f"_str{len(self.needs.strings)}"
                self.needs.strings[name] = text
                return name
            case Load():
                return self.load(e.lvalue)
            case RegisterLoad(register=ref):
                return self.register_load(ref)
            case AddressOf(lvalue=lvalue):
                return self.address(lvalue)
            case Convert():
                return self.convert(e)
            case Binary():
                return self.binary(e)
            case Unary():
                return self.unary(e)
            case Compare() | Logic() | Not():
                return f"(1 if {self.condition(e)} else 0)"
            case Conditional(test=test, then=then, otherwise=otherwise):
                self.cost += costs.BRANCH
                return f"({self.value(then)} if {self.condition(test)} else {self.value(otherwise)})"
            case PointerAdd(pointer=pointer, index=index, negative=negative):
                self.cost += costs.POINTER
                assert isinstance(e.ctype, PointerType)
                stride = max(1, e.ctype.target.words)
                target = self.needs.constant("t", e.ctype.target, ("target", e.ctype.name))
                distance = f"{'-' if negative else ''}{self.value(index)} * {stride}"
                return f"_c_address({self.value(pointer)}, {distance}, {target})"
            case PointerDifference(left=left, right=right):
                assert isinstance(left.ctype, PointerType)
                self.cost += costs.INT_DIV
                return f"(({self.value(left)}.addr - {self.value(right)}.addr) // {max(1, left.ctype.target.words)})"
            case FunctionRef(function=function):
                return self.needs.function(function)
            case Call():
                return self.call(e)
            case CallPointer(target=target, arguments=arguments):
                self.cost += costs.CALL
                site = self.site(INT, source_text(target))
                return f"_c_callable({self.value(target)}, {site})({', '.join(self.value(a) for a in arguments)})"
        raise TypeError(f"no text for {type(e).__name__}")

    def condition(self, e: Expr) -> str:
        """Python text that is true when C takes the branch."""
        match e:
            case Compare(op=op, left=left, right=right):
                self.cost += costs.COMPARE
                pointers = isinstance(left.ctype, PointerType | HandleType | FunctionType)
                if pointers and op not in ("==", "!="):
                    return f"({self.value(left)}.addr {op} {self.value(right)}.addr)"
                if op in ("==", "!="):
                    return f"({self.value(left)} {op} {self.value(right)})"
                if op in ("<", ">=") and isinstance(right, Const) and right.value == 0:
                    left = self.asked_for_sign(left)
                return f"({self.ordered(left, right)} {op} {self.ordered(right, left)})"
            case Logic(op=op, operands=operands):
                # What the first operands write is not certain for the later ones; nothing here writes.
                return "(" + f" {op} ".join(self.condition(o) for o in operands) + ")"
            case Not(operand=operand):
                return f"(not {self.condition(operand)})"
        self.cost += costs.COMPARE
        return self.value(e)

    def ordered(self, e: Expr, other: Expr) -> str:
        """One side of a comparison by order."""
        ctype = e.ctype
        if not isinstance(ctype, IntType) or ctype.signed:
            return self.value(e)
        if isinstance(other, Const) and other.value in (ctype.high // 2, ctype.high // 2 + 1):
            return self.value(e)  # whether a difference is negative, asked on purpose
        rule = "sign-compare" if isinstance(e, Convert) else "unsigned-wrap"
        return self.unwrapped(e, rule, "is compared")

    def asked_for_sign(self, e: Expr) -> Expr:
        """A plain character that is compared with 0 is taken to have the sign of an octet."""
        match e:
            case Convert(operand=Load(ctype=IntType(name="char")) as operand):
                return Convert(e.ctype, Convert(operand.ctype, operand, explicit=True))
        return e

    def literal(self, value: int | float) -> str:
        if isinstance(value, float):
            if value != value or value in (float("inf"), float("-inf")):
                return self.needs.constant("k", value, ("float", repr(value)))
            return repr(value) if value >= 0 and not repr(value).startswith("-") else f"({value!r})"
        return str(value) if value >= 0 else f"({value})"

    # Arithmetic

    def interval(self, e: Expr) -> Interval:
        """Bounds of an integer expression."""
        return interval(e, self.ranges)

    def wrap(
        self, text: str, ctype: IntType, bounds: Interval | None, what: str, widened: str = "", kind: str = ""
    ) -> str:  # fmt: skip
        """`text` brought into `ctype`, by the cheapest sufficient means."""
        if bounds is not None and ctype.low <= bounds[0] and bounds[1] <= ctype.high:
            return text
        mask = (1 << ctype.bits) - 1
        if not ctype.signed:
            return f"({text} & {mask})"
        if self.checked:
            site = self.site(ctype, what, widened=widened, kind=kind)
            return f"(_t if {ctype.low} <= (_t := {text}) <= {ctype.high} else _c_overflow(_t, {site}))"
        half = 1 << ctype.bits - 1
        return f"(({text} + {half} & {mask}) - {half})"

    def binary(self, e: Binary) -> str:
        ctype, op = e.ctype, e.op
        if isinstance(ctype, FloatType):
            self.cost += costs.FLOAT[op]
            left, right = self.value(e.left), self.value(e.right)
            if self.options.watch and self.checked:
                return self.watched_float(e, left, right)
            if op == "/":
                if self.options.ieee and isinstance(e.right, Const) and e.right.value != 0:
                    return f"_c_f32({left} / {right})"
                return f"_c_divide_floats({left}, {right}, {self.site(ctype, source_text(e))})"
            return f"_c_f32({left} {op} {right})"
        assert isinstance(ctype, IntType)
        self.cost += costs.INT[op] * (2 if ctype.bits > 16 else 1)
        if op == "*" and isinstance(e.right, Const) and e.right.value in SCALES and self.checked:
            quotient = bare(e.left)
            if isinstance(quotient, Binary) and quotient.op == "/" and not isinstance(quotient.right, Const):
                self.widened.setdefault(id(quotient), "scaled")
        left, right = self.dividend(e), self.value(e.right)
        bounds = exact(e, self.ranges)
        widened = self.widened.get(id(e), "")
        if op == "/" and widened in ("float", "scaled") and self.checked:
            return f"_c_quotient({left}, {right}, {self.site(ctype, source_text(e), widened=widened)})"
        if op in ("/", "%"):
            low, divisor = self.interval(e.left)[0], self.interval(e.right)
            if low >= 0 and divisor[0] > 0:
                return f"({left} {'//' if op == '/' else '%'} {right})"
            helper = "_c_divide_ints" if op == "/" else "_c_modulo_ints"
            return f"{helper}({left}, {right}, {self.site(ctype, source_text(e))})"
        if op in ("<<", ">>"):
            low, high = self.interval(e.right)
            if low >= 0 and high < ctype.bits:
                text = f"({left} {op} {right})"
                return text if op == ">>" else self.wrap(text, ctype, bounds, source_text(e), widened, "shift")
            site = self.site(ctype, source_text(e), widened=widened, kind="shift")
            if isinstance(e.left, Const) and op == "<<" and int(e.left.value) > 0:
                # A constant shifted by a variable: in range up to the count at which it would overflow.
                limit = ctype.high.bit_length() - int(e.left.value).bit_length()
                count, named = (right, right) if right.isidentifier() else (f"(_n := {right})", "_n")
                slow = f"_c_shift('{op}', {left}, {named}, {site})"
                return f"({left} << {named} if 0 <= {count} <= {limit} else {slow})"
            return f"_c_shift('{op}', {left}, {right}, {site})"
        if op in "&|^":
            return f"({left} {op} {right})"
        return self.wrap(f"({left} {op} {right})", ctype, bounds, source_text(e), widened)

    def dividend(self, e: Binary) -> str:
        """The left operand: what wrapped before it is divided or shifted down is not what is meant."""
        power = isinstance(e.right, Const) and e.right.value > 0 and not int(e.right.value) & (int(e.right.value) - 1)
        indexing = id(e) in self.indexing
        divided = e.op == "/" or (e.op == "%" and not power)
        if divided or (e.op == ">>" and isinstance(e.left, Binary) and e.left.op == "-"):
            rule = "unsigned-wrap-index" if indexing else "unsigned-wrap"
            return self.unwrapped(e.left, rule, "is shifted" if e.op == ">>" else "is divided")
        return self.value(e.left)

    def watched_float(self, e: Binary, left: str, right: str) -> str:
        """A float operation in an image that is watched: a NaN or an infinity is seen where it is made."""
        self.fresh += 1
        a, b = f"_a{self.fresh}", f"_b{self.fresh}"
        site = self.site(e.ctype, source_text(e))
        if e.op == "/":
            result = f"_c_divide_floats({a}, {b}, {self.site(e.ctype, source_text(e))})"
        else:
            result = f"_c_f32({a} {e.op} {b})"
        return f"_c_float_result(({a} := {left}), ({b} := {right}), {result}, {site})"

    def unary(self, e: Unary) -> str:
        operand = self.value(e.operand)
        ctype = e.ctype
        if isinstance(ctype, FloatType):
            self.cost += costs.FLOAT_OP
            return f"(-{operand})"
        assert isinstance(ctype, IntType)
        self.cost += costs.INT_OP
        if e.op == "~":
            return f"(~{operand})" if ctype.signed else f"({operand} ^ {(1 << ctype.bits) - 1})"
        low, high = self.interval(e.operand)
        return self.wrap(f"(-{operand})", ctype, (-high, -low), source_text(e))

    # Calls

    def outgoing(self, argument: Expr, function: str) -> str:
        """An argument on its way out of the firmware."""
        text = self.value(argument)
        if self.options.watch and self.checked and isinstance(argument.ctype, FloatType):
            return f"_c_float_out({text}, {self.site(argument.ctype, f'{function}({source_text(argument)})')})"
        return text

    def call(self, e: Call) -> str:
        function = e.function
        self.cost += costs.CALL
        name = self.needs.function(function)
        if not function.extern:
            return f"{name}({', '.join(self.value(a) for a in e.arguments)})"
        arguments = []
        for argument in e.arguments:
            if isinstance(argument, Null):
                arguments.append("None")
            elif isinstance(argument.ctype, PointerType | HandleType):
                arguments.append(f"_c_outward({self.value(argument)})")
            else:
                arguments.append(self.outgoing(argument, function.name))
        for argument in e.extra:
            key = ("type", argument.ctype.name, type(argument.ctype).__name__)
            text = self.outgoing(argument, function.name)
            arguments.append(f"({self.needs.constant('t', argument.ctype, key)}, {text})")
        text = f"{name}({', '.join(arguments)})"
        return f"_c_inward({text})" if isinstance(e.ctype, PointerType | HandleType) else text
