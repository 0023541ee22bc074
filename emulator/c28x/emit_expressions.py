"""From typed tree to Python text: expressions.

Every expression becomes one Python expression.  Checks appear only where the translator cannot prove them away: an interval
for each integer expression removes wraps and bounds, definite assignment removes tests for never-written objects.

Names in the generated text: `_g_x` data of a file-scope object, `_p_x` pointer to an object, `_f_x` firmware function, `_x_x` extern,
`_rN` register, `_sN` site, `_tN` type or declaration, `_c_...` runtime.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from emulator.c28x import costs
from emulator.c28x.ctypes import CType, FloatType, FunctionType, HandleType, IntType, PointerType
from emulator.c28x.runtime import Site
from emulator.c28x.tree import (
    AddressOf,
    Binary,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Convert,
    Declaration,
    Expr,
    Function,
    FunctionRef,
    Index,
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

Interval = tuple[int, int]


@dataclass
class Options:
    """How to generate."""

    checked: bool = True
    #: Spill locals to the stack memory at return (fill policy `stack`).
    residue: bool = False
    #: Keep a function's locals for tests.
    keep_locals: bool = False
    ieee: bool = True
    room: dict[str, int] = field(default_factory=dict)
    calibration: dict[str, float] = field(default_factory=dict)


@dataclass
class Needs:
    """Constants that the generated text refers to, by name."""

    names: dict[str, Any] = field(default_factory=dict)
    registers: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    strings: dict[str, str] = field(default_factory=dict)
    variables: dict[str, Variable] = field(default_factory=dict)
    functions: dict[str, Function] = field(default_factory=dict)
    _reuse: dict[Any, str] = field(default_factory=dict)

    def constant(self, prefix: str, value: Any, key: Any = None) -> str:
        """A name for `value`; equal keys share one."""
        if key is not None and key in self._reuse:
            return self._reuse[key]
        name = f"_{prefix}{len(self.names)}"
        self.names[name] = value
        if key is not None:
            self._reuse[key] = name
        return name

    def register(self, ref: RegisterRef, access: str) -> str:
        """A name for the function that does `access` ("read", "write" or "modify") to a register."""
        name = f"_r_{ref.block}_{ref.register}_{access}"
        self.registers[name] = (ref.block, ref.register, access)
        return name

    def data(self, variable: Variable) -> str:
        """A name for the data of a file-scope object."""
        name = f"_g_{variable.declaration.module}_{variable.name}"
        self.variables[name] = variable
        return name

    def function(self, function: Function) -> str:
        """A name for a function."""
        name = f"_{'x' if function.extern else 'f'}_{function.name}"
        self.functions[name] = function
        return name


class ExpressionEmitter:
    """Expression part of the emitter of one function."""

    def __init__(self, function: Function, needs: Needs, options: Options) -> None:
        self.function = function
        self.needs = needs
        self.options = options
        self.checked = options.checked
        self.cost = 0
        #: What is definitely written here: variables, and elements as (variable, index text).
        self.assigned: set[Any] | None = set()
        self.ranges: dict[Variable, Interval] = {}
        self.frame = False
        self.initials: dict[str, dict[str, Any]] = {}
        self.planted: dict[str, dict[int, Any]] = {}

    # Sites

    def site(self, ctype: CType, name: str, declaration: Declaration | None = None, bound: int = 0) -> str:
        """A new place to report at."""
        site = Site(ctype, declaration, name, bound)
        if declaration is not None:
            site.initial = self.initials.setdefault(declaration.path, site.initial)
            site.planted = self.planted.setdefault(declaration.path, site.planted)
        return self.needs.constant("s", site)

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
                return f"{self.value(pointer)}.at({'-' if negative else ''}{self.value(index)})"
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
                return f"{self.value(target)}({', '.join(self.value(a) for a in arguments)})"
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

    def literal(self, value: float) -> str:
        if isinstance(value, float):
            if value != value or value in (float("inf"), float("-inf")):
                return self.needs.constant("k", value, ("float", repr(value)))
            return repr(value) if value >= 0 and not repr(value).startswith("-") else f"({value!r})"
        return str(value) if value >= 0 else f"({value})"

    # Memory

    def base(self, variable: Variable) -> str:
        """The list that holds a memory object's scalars."""
        return variable.name if variable.kind != "global" else self.needs.data(variable)

    def location(self, variable: Variable, words: str) -> str:
        """The address of a memory object's word, as text."""
        if variable.kind == "global":
            return f"{self.pointer_name(variable)}.addr + {words}"
        self.frame = True
        return f"_fp + {variable.frame_offset} + {words}"

    def pointer_name(self, variable: Variable) -> str:
        """The pointer to an object, made where the object is."""
        if variable.kind == "global":
            self.needs.data(variable)
            return f"_p_{variable.declaration.module}_{variable.name}"
        return f"_p_{variable.name}"

    def bound(self, variable: Variable, index: Index) -> int:
        """The length of the array that `index` subscripts (`room` may have enlarged it)."""
        assert index.bound is not None
        if index.leaves == 1 and variable.declaration.path in self.options.room:
            return self.options.room[variable.declaration.path]
        return index.bound

    def load(self, lvalue: LValue) -> str:
        root = lvalue.root
        if isinstance(root, Expr):
            self.cost += costs.POINTER + costs.LOAD_MEMORY
            site = self.site(lvalue.ctype, self.describe(root))
            return f"_c_load({self.value(root)}, {self.offset_words(lvalue)}, {site})"
        if not root.in_memory and root.kind != "global":
            self.cost += costs.LOAD
            return self.defined(root.name, root, root, "0")
        self.cost += costs.LOAD_MEMORY
        data = self.base(root)
        if not lvalue.indices:
            return self.defined(f"{data}[{lvalue.leaf}]", root, (root, str(lvalue.leaf)), str(lvalue.words), lvalue)
        if len(lvalue.indices) > 1:
            return self.load_deep(lvalue, root)
        index = lvalue.indices[0]
        self.cost += costs.INDEX
        text = self.value(index.expr)
        low, high = self.interval(index.expr)
        limit = self.bound(root, index)
        if low >= 0 and high < limit:
            place = self.leaf_text(text, index.leaves, lvalue.leaf)
            words = f"({text}) * {index.words} + {lvalue.words}"
            return self.defined(f"{data}[{place}]", root, (root, place), words, lvalue)
        place = self.leaf_text("_i", index.leaves, lvalue.leaf)
        key = (root, self.leaf_text(text, index.leaves, lvalue.leaf))
        inner = self.defined(f"{data}[{place}]", root, key, f"_i * {index.words} + {lvalue.words}", lvalue)
        site = self.site(lvalue.ctype, root.declaration.path, root.declaration, limit)
        base = self.location(root, str(lvalue.words))
        outside = f"_c_oob_load({site}, _i, {index.words}, {base})"
        test = f"0 <= (_i := {text}) < {limit}" if low < 0 else f"(_i := {text}) < {limit}"
        return f"({inner} if {test} else {outside})"

    def load_deep(self, lvalue: LValue, root: Variable) -> str:
        """More than one subscript: in one list when all are proven, else by address."""
        proven = all(
            self.interval(i.expr)[0] >= 0 and self.interval(i.expr)[1] < (i.bound or 0) for i in lvalue.indices
        )
        self.cost += costs.INDEX * len(lvalue.indices)
        if proven:
            terms = [self.leaf_text(self.value(i.expr), i.leaves, 0) for i in lvalue.indices]
            place = " + ".join([*terms, str(lvalue.leaf)])
            return self.defined(f"{self.base(root)}[{place}]", root, (root, place), self.offset_words(lvalue), lvalue)
        site = self.site(lvalue.ctype, root.declaration.path, root.declaration)
        return f"_c_load({self.pointer_name(root)}, {self.offset_words(lvalue)}, {site})"

    def leaf_text(self, index: str, stride: int, leaf: int) -> str:
        text = index if stride == 1 else f"{index} * {stride}"
        return f"{text} + {leaf}" if leaf else text

    def offset_words(self, lvalue: LValue) -> str:
        """The distance of an lvalue from its root in words."""
        terms = [f"{self.value(i.expr)} * {i.words}" for i in lvalue.indices]
        if lvalue.words or not terms:
            terms.append(str(lvalue.words))
        return " + ".join(terms)

    def defined(self, text: str, root: Variable, key: Any, words: str, lvalue: LValue | None = None) -> str:
        """`text`, with a test for never-written where that is possible."""
        if not self.checked or root.kind == "parameter":
            return text
        if root.initialised and not (root.in_memory or root.kind == "global"):
            return text
        if root.initialised and not root.escapes:
            return text
        if self.assigned is None or key in self.assigned or (root in self.assigned and not root.escapes):
            return text
        ctype = lvalue.ctype if lvalue is not None else root.ctype
        name = root.declaration.path
        if isinstance(key, tuple) and lvalue is not None and lvalue.indices:
            name += "[]"
        site = self.site(ctype, name, root.declaration)
        where = ""
        if self.options.residue and root.kind != "global":
            where = f", {self.location(root, words)}"
        if text.isidentifier():
            return f"({text} if {text} is not None else _c_uninit({site}{where}))"
        return f"(_u if (_u := {text}) is not None else _c_uninit({site}{where}))"

    def address(self, lvalue: LValue) -> str:
        self.cost += costs.POINTER
        root = lvalue.root
        if isinstance(root, Expr):
            if not lvalue.indices and not lvalue.words and isinstance(root.ctype, PointerType) and root.ctype.target == lvalue.ctype:
                return self.value(root)
            base = self.value(root)
        else:
            base = self.pointer_name(root)
        target = getattr(lvalue.ctype, "element", lvalue.ctype)
        type_name = self.needs.constant("t", target, ("type", target.name, type(target).__name__))
        return f"_c_address({base}, {self.offset_words(lvalue)}, {type_name})"

    def describe(self, e: Expr) -> str:
        """The name of a pointer expression for a report."""
        match e:
            case Load(lvalue=LValue(root=Variable() as variable)):
                return variable.declaration.path
            case PointerAdd(pointer=pointer) | Convert(operand=pointer):
                return self.describe(pointer)
            case AddressOf(lvalue=LValue(root=Variable() as variable)):
                return variable.declaration.path
        return "pointer"

    # Registers

    def register_load(self, ref: RegisterRef) -> str:
        self.cost += costs.REGISTER
        name = self.needs.register(ref, "read")
        if ref.field is None:
            return f"{name}()"
        self.cost += costs.REGISTER_FIELD
        shift = f" >> {ref.field.lo}" if ref.field.lo else ""
        return f"({name}(){shift} & {(1 << ref.field.width) - 1})"

    def register_store(self, ref: RegisterRef, value: Expr) -> str:
        """The statement that writes a register or field."""
        self.cost += costs.REGISTER
        if ref.field is None:
            return f"{self.needs.register(ref, 'write')}({self.value(value)}, {0xFFFFFFFF})"
        self.cost += costs.REGISTER + costs.REGISTER_FIELD
        f = ref.field
        keep = ((1 << ref.bits) - 1) & ~f.mask
        if isinstance(value, Const):
            bits = str(int(value.value) << f.lo & f.mask)
        else:
            bits = f"{self.value(value)} << {f.lo} & {f.mask}" if f.lo else f"{self.value(value)} & {f.mask}"
        if ref.reads_zero:
            return f"{self.needs.register(ref, 'write')}({bits}, {f.lane})"
        return f"{self.needs.register(ref, 'modify')}({keep}, {bits}, {f.lane})"

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
                return f"_c_divide_floats({left}, {right}, {self.site(ctype, 'quotient')})"
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
            return f"{helper}({left}, {right}, {self.site(ctype, 'quotient' if op == '/' else 'remainder')})"
        if op in ("<<", ">>"):
            low, high = self.interval(e.right)
            if low >= 0 and high < ctype.bits:
                text = f"({left} {op} {right})"
                return text if op == ">>" else self.wrap(text, ctype, exact, "shift result")
            slow = f"_c_shift('{op}', {left}, _n, {self.site(ctype, 'shift')})"
            if isinstance(e.left, Const) and op == "<<" and int(e.left.value) > 0:
                # A constant shifted by a variable: in range up to the count at which it would overflow.
                limit = ctype.high.bit_length() - int(e.left.value).bit_length()
                return f"({left} << _n if 0 <= (_n := {right}) <= {limit} else {slow})"
            return f"_c_shift('{op}', {left}, {right}, {self.site(ctype, 'shift')})"
        if op in "&|^":
            return f"({left} {op} {right})"
        names = {"+": "sum", "-": "difference", "*": "product"}
        return self.wrap(f"({left} {op} {right})", ctype, exact, f"16-bit {names[op]}" if ctype.bits == 16 else names[op])

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
        return self.wrap(f"(-{operand})", ctype, (-high, -low), "negation")

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
                what = self.describe(operand) if isinstance(operand, Load) else "float expression"
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
            return f"({text}.addr & {(1 << target.bits) - 1})"
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
            ctype = self.needs.constant("t", argument.ctype, ("type", argument.ctype.name, type(argument.ctype).__name__))
            arguments.append(f"({ctype}, {self.value(argument)})")
        text = f"{name}({', '.join(arguments)})"
        return f"_c_inward({text})" if isinstance(e.ctype, PointerType | HandleType) else text


OBSERVABLE: Final = (RegisterLoad, Call, CallPointer)


def parts(e: Any) -> Iterator[Any]:
    """Every expression and lvalue below `e`, itself included."""
    yield e
    for value in vars(e).values() if hasattr(e, "__dict__") else ():
        for inner in value if isinstance(value, list) else [value]:
            if isinstance(inner, Expr | LValue | Index):
                yield from parts(inner)


def observable(e: Any) -> bool:
    """Whether evaluating `e` touches anything that another task, an interrupt or a peripheral can see."""
    for part in parts(e):
        if isinstance(part, OBSERVABLE):
            return True
        if isinstance(part, LValue) and (isinstance(part.root, Expr) or part.root.kind == "global"):
            return True
    return False


def calls(e: Any) -> bool:
    """Whether evaluating `e` runs a function."""
    return any(isinstance(part, Call | CallPointer) for part in parts(e))
