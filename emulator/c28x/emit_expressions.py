"""From typed tree to Python text: expressions.

Every expression becomes one Python expression.  Checks appear only where the translator cannot prove them away: an
interval for each integer expression removes wraps and bounds, definite assignment removes tests for never-written
objects.

Names in the generated text: `_g_x` data of a file-scope object, `_p_x` pointer to an object, `_f_x` firmware function,
`_x_x` extern, `_r_block_register_access` register, `_sN` site, `_tN` type or declaration, `_c_...` runtime, `_k` clock.
"""

from __future__ import annotations

from emulator.c28x import costs
from emulator.c28x.ctypes import INT, FloatType, FunctionType, HandleType, IntType, PointerType
from emulator.c28x.emit_memory import Interval, MemoryEmitter
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
    LValue,
    Not,
    Null,
    PointerAdd,
    PointerDifference,
    RegisterLoad,
    String,
    Unary,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import source_text


class ExpressionEmitter(MemoryEmitter):
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
                return f"({self.value(left)} {op} {self.value(right)})"
            case Logic(op=op, operands=operands):
                # What the first operands write is not certain for the later ones; nothing here writes.
                return "(" + f" {op} ".join(self.condition(o) for o in operands) + ")"
            case Not(operand=operand):
                return f"(not {self.condition(operand)})"
        self.cost += costs.COMPARE
        return self.value(e)

    def literal(self, value: int | float) -> str:
        if isinstance(value, float):
            if value != value or value in (float("inf"), float("-inf")):
                return self.needs.constant("k", value, ("float", repr(value)))
            return repr(value) if value >= 0 and not repr(value).startswith("-") else f"({value!r})"
        return str(value) if value >= 0 else f"({value})"

    # Arithmetic

    def interval(self, e: Expr) -> Interval:
        """Bounds of an integer expression."""
        ctype = e.ctype
        assert isinstance(ctype, IntType)
        whole = (ctype.low, ctype.high)
        match e:
            case Const(value=int(value)):
                return (value, value)
            case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in self.ranges:
                return self.ranges[root]
            case Compare() | Logic() | Not():
                return (0, 1)
            case Convert(operand=operand) if isinstance(operand.ctype, IntType):
                inner = self.interval(operand)
                return inner if whole[0] <= inner[0] and inner[1] <= whole[1] else whole
            case Binary():
                exact = self.exact(e)
                return exact if exact is not None and whole[0] <= exact[0] and exact[1] <= whole[1] else whole
        return whole

    def exact(self, e: Binary) -> Interval | None:
        """Bounds of the mathematical result, before any wrap."""
        (a, b), (c, d) = self.interval(e.left), self.interval(e.right)
        match e.op:
            case "+":
                return (a + c, b + d)
            case "-":
                return (a - d, b - c)
            case "*":
                products = (a * c, a * d, b * c, b * d)
                return (min(products), max(products))
            case "&" if c >= 0:
                return (0, min(b, d) if a >= 0 else d)
            case "&" if a >= 0:
                return (0, b)
            case "|" | "^" if a >= 0 and c >= 0:
                return (0, (1 << max(b, d).bit_length()) - 1)
            case ">>" if c == d >= 0:
                return (a >> c, b >> c)
            case "<<" if c == d >= 0:
                return (a << c, b << c)
            case "/" if c == d > 0 and a >= 0:
                return (a // c, b // c)
            case "%" if c == d > 0 and a >= 0:
                return (0, min(b, c - 1))
        return None

    def wrap(self, text: str, ctype: IntType, exact: Interval | None, what: str) -> str:
        """`text` brought into `ctype`, by the cheapest sufficient means."""
        if exact is not None and ctype.low <= exact[0] and exact[1] <= ctype.high:
            return text
        mask = (1 << ctype.bits) - 1
        if not ctype.signed:
            return f"({text} & {mask})"
        if self.checked:
            site = self.site(ctype, what)
            return f"(_t if {ctype.low} <= (_t := {text}) <= {ctype.high} else _c_overflow(_t, {site}))"
        half = 1 << ctype.bits - 1
        return f"(({text} + {half} & {mask}) - {half})"

    def binary(self, e: Binary) -> str:
        ctype, op = e.ctype, e.op
        if isinstance(ctype, FloatType):
            self.cost += costs.FLOAT[op]
            left, right = self.value(e.left), self.value(e.right)
            if op == "/":
                if self.options.ieee and isinstance(e.right, Const) and e.right.value != 0:
                    return f"_c_f32({left} / {right})"
                return f"_c_divide_floats({left}, {right}, {self.site(ctype, source_text(e))})"
            return f"_c_f32({left} {op} {right})"
        assert isinstance(ctype, IntType)
        self.cost += costs.INT[op] * (2 if ctype.bits > 16 else 1)
        left, right = self.value(e.left), self.value(e.right)
        exact = self.exact(e)
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
                return text if op == ">>" else self.wrap(text, ctype, exact, source_text(e))
            if isinstance(e.left, Const) and op == "<<" and int(e.left.value) > 0:
                # A constant shifted by a variable: in range up to the count at which it would overflow.
                limit = ctype.high.bit_length() - int(e.left.value).bit_length()
                count, named = (right, right) if right.isidentifier() else (f"(_n := {right})", "_n")
                slow = f"_c_shift('{op}', {left}, {named}, {self.site(ctype, source_text(e))})"
                return f"({left} << {named} if 0 <= {count} <= {limit} else {slow})"
            return f"_c_shift('{op}', {left}, {right}, {self.site(ctype, source_text(e))})"
        if op in "&|^":
            return f"({left} {op} {right})"
        return self.wrap(f"({left} {op} {right})", ctype, exact, source_text(e))

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

    def convert(self, e: Convert) -> str:
        target, operand = e.ctype, e.operand
        source = operand.ctype
        text = self.value(operand)
        if isinstance(target, FloatType):
            if isinstance(source, FloatType):
                return text
            self.cost += costs.CONVERT
            assert isinstance(source, IntType)
            return f"({text} + 0.0)" if source.bits <= 16 else f"_c_f32({text} + 0.0)"
        if isinstance(target, IntType):
            if isinstance(source, FloatType):
                self.cost += costs.CONVERT
                what = source_text(operand)
                return f"_c_float_to_int({text}, {self.site(target, what)})"
            if isinstance(source, IntType):
                low, high = self.interval(operand)
                if target.low <= low and high <= target.high:
                    return text
                mask = (1 << target.bits) - 1
                if not target.signed:
                    return f"({text} & {mask})"
                half = 1 << target.bits - 1
                return f"(({text} + {half} & {mask}) - {half})"
            mask, half = (1 << target.bits) - 1, 1 << target.bits - 1
            return f"(({text}.addr + {half} & {mask}) - {half})" if target.signed else f"({text}.addr & {mask})"
        if isinstance(source, IntType) and isinstance(target, PointerType):
            return f"_c_pointer_at({text}, {self.needs.constant('t', target, ('type', target.name, 'p'))})"
        if isinstance(target, PointerType) and isinstance(source, PointerType):
            return f"_c_cast({text}, {self.needs.constant('t', target, ('type', target.name, 'p'))})"
        return text

    # Calls

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
                arguments.append(self.value(argument))
        for argument in e.extra:
            key = ("type", argument.ctype.name, type(argument.ctype).__name__)
            arguments.append(f"({self.needs.constant('t', argument.ctype, key)}, {self.value(argument)})")
        text = f"{name}({', '.join(arguments)})"
        return f"_c_inward({text})" if isinstance(e.ctype, PointerType | HandleType) else text
