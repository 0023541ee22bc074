"""From typed tree to Python text: conversions, and the results for which a wrap or a lost remainder matters.

An unsigned result wraps silently, as C says.  It is held against the mathematical one only where the wrap is hardly
meant: it is widened afterwards, divided, compared by order, or selects an element.  The mathematical value of a tree of
+, - and * costs one test more than the wrap itself; where an interval proves that nothing wraps, nothing is tested.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x import costs
from emulator.c28x.ctypes import CHAR, SCHAR, UCHAR, FloatType, IntType, PointerType
from emulator.c28x.emit_memory import MemoryEmitter
from emulator.c28x.intervals import RING, Interval, combine
from emulator.c28x.tree import (
    Binary,
    Conditional,
    Const,
    Convert,
    Expr,
    Load,
    LValue,
    Unary,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import averaged, bare, source_text

CHARACTERS: Final = (CHAR.name, SCHAR.name, UCHAR.name)


def is_character(ctype: object) -> bool:
    """Whether a type is one of the three character types."""
    return isinstance(ctype, IntType) and ctype.name in CHARACTERS


class ConversionEmitter(MemoryEmitter):
    """Conversion part of the emitter of one function."""

    # Wraps that matter

    def mathematical(self, e: Expr, ctype: IntType) -> tuple[str, Interval]:
        """The value of an unsigned tree without any wrap, and its bounds."""
        match e:
            case Binary(op=op, left=left, right=right) if op in RING and e.ctype == ctype:
                self.cost += costs.INT[op] * (2 if ctype.bits > 16 else 1)
                (a, bounds_a), (b, bounds_b) = self.mathematical(left, ctype), self.mathematical(right, ctype)
                return f"({a} {op} {b})", combine(op, bounds_a, bounds_b)
            case Convert(operand=Expr(ctype=IntType(signed=True)) as operand, explicit=False) if e.ctype == ctype:
                return self.value(operand), self.interval(operand)
            case Const(source=Convert(operand=Const(ctype=IntType(signed=True), value=int(value)), explicit=False)):
                return self.literal(value), (value, value)
        return self.value(e), self.interval(e)

    def unwrapped(self, e: Expr, rule: str, then: str) -> str:
        """The value of `e`, held against the mathematical one where it is unsigned and can differ."""
        ctype = e.ctype
        if not self.checked or not isinstance(ctype, IntType) or ctype.signed or not _computed(e, ctype):
            return self.value(e)
        text, (low, high) = self.mathematical(e, ctype)
        if low >= 0 and high <= ctype.high:
            return text
        difference = isinstance(e, Binary) and e.op == "-" and not isinstance(e.right, Const)
        site = self.site(ctype, source_text(e), rule=rule, widened=then, difference=difference)
        test = f"0 <= (_t := {text})" if high <= ctype.high else f"0 <= (_t := {text}) <= {ctype.high}"
        return f"(_t if {test} else _c_wrapped(_t, {site}))"

    def sum_value(self, target: LValue, e: Expr) -> str:
        """A value on its way into an object: an unsigned sum that is divided or widened later must not wrap."""
        match target.root, e:
            case Variable(in_memory=False) as root, Binary(op="+", left=Load(lvalue=LValue(root=added))) if (
                added is root and root.kind != "global"
            ):
                if self.averaged is None:
                    self.averaged = averaged(self.function.body)
                if root in self.averaged:
                    return self.unwrapped(e, "unsigned-wrap", "is divided or widened further down")
        return self.value(e)

    def index_value(self, e: Expr) -> str:
        # A difference that wraps is far outside of any array; other results may lie inside by luck.
        if isinstance(e, Binary) and e.op in ("+", "*"):
            return self.unwrapped(e, "unsigned-wrap-index", "")
        if isinstance(e, Binary) and e.op == "%":
            self.indexing.add(id(e))
        return self.value(e)

    def mark_widened(self, e: Expr, to: str) -> None:
        """Signed results below `e` are converted to `to` after they have been computed."""
        match e:
            case Binary(op=op, left=left, right=right) if isinstance(e.ctype, IntType):
                self.widened[id(e)] = to
                if op in RING:
                    self.mark_widened(left, to)
                    self.mark_widened(right, to)
            case Unary(operand=operand):
                self.mark_widened(operand, to)
            case Conditional(then=then, otherwise=otherwise):
                self.mark_widened(then, to)
                self.mark_widened(otherwise, to)

    # Conversions

    def convert(self, e: Convert) -> str:
        """Text of a conversion."""
        target, operand = e.ctype, e.operand
        source = operand.ctype
        if isinstance(source, IntType) and self.checked:
            if isinstance(target, FloatType) or (isinstance(target, IntType) and target.bits > source.bits):
                self.mark_widened(operand, target.name)
                text = self.unwrapped(operand, "widened-late", target.name)
            else:
                text = self.value(operand)
        else:
            text = self.value(operand)
        if isinstance(target, FloatType):
            if isinstance(source, FloatType):
                return text
            self.cost += costs.CONVERT
            assert isinstance(source, IntType)
            return f"({self.signed_character(text, operand)} + 0.0)" if source.bits <= 16 else f"_c_f32({text} + 0.0)"
        if isinstance(target, IntType):
            if isinstance(source, FloatType):
                self.cost += costs.CONVERT
                what = source_text(operand)
                return f"_c_float_to_int({text}, {self.site(target, what)})"
            if isinstance(source, IntType):
                return self.convert_int(text, e, target, source)
            mask, half = (1 << target.bits) - 1, 1 << target.bits - 1
            return f"(({text}.addr + {half} & {mask}) - {half})" if target.signed else f"({text}.addr & {mask})"
        if isinstance(source, IntType) and isinstance(target, PointerType):
            return f"_c_pointer_at({text}, {self.needs.constant('t', target, ('type', target.name, 'p'))})"
        if isinstance(target, PointerType) and isinstance(source, PointerType):
            return f"_c_cast({text}, {self.needs.constant('t', target, ('type', target.name, 'p'))})"
        return text

    def convert_int(self, text: str, e: Convert, target: IntType, source: IntType) -> str:
        """Text of a conversion from integer to integer."""
        low, high = self.interval(e.operand)
        if is_character(target) and not is_character(source) and self.checked:
            octet = self.octet(text, e, target, (low, high))
            if octet:
                return octet
        elif is_character(source) and not is_character(target):
            text = self.signed_character(text, e.operand)
        if target.low <= low and high <= target.high:
            return text
        if target.signed and self.checked and not e.explicit and _mixed(e.operand, target):
            cost = self.cost
            text, (low, high) = self.mathematical(e.operand, source)
            self.cost = cost
            site = self.site(target, source_text(e.operand))
            if target.low <= low and high <= target.high:
                return text
            return f"(_t if {target.low} <= (_t := {text}) <= {target.high} else _c_narrowed(_t, {site}))"
        mask = (1 << target.bits) - 1
        if target.signed and source.bits > target.bits and self.checked and not e.explicit:
            site = self.site(target, source_text(e.operand))
            return f"(_t if {target.low} <= (_t := {text}) <= {target.high} else _c_narrowed(_t, {site}))"
        if not target.signed:
            return f"({text} & {mask})"
        half = 1 << target.bits - 1
        return f"(({text} + {half} & {mask}) - {half})"

    # Characters of 16 bits

    def octet(self, text: str, e: Convert, target: IntType, bounds: Interval) -> str:
        """Text of a conversion to a character, if the value may be one that an octet could not hold."""
        operand = e.operand
        low, high = (0, 255) if target.name == UCHAR.name else (-128, 127 if target.name == SCHAR.name else 255)
        if (low <= bounds[0] and bounds[1] <= high) or isinstance(operand, Const):
            return ""
        counter = None if e.explicit else _stepped(operand)
        if counter is not None and (counter.kind != "global" or counter in self.needs.compared):
            return ""  # a counter with a limit: 16 bits are what it wants
        site = self.site(target, source_text(operand))
        return f"(_t if {low} <= (_t := {text}) <= {high} else _c_octet(_t, {site}))"

    def signed_character(self, text: str, e: Expr) -> str:
        """A signed character on its way into arithmetic: 0x80..0xFF is not negative here."""
        written = isinstance(e, Convert) and e.explicit and is_character(e.ctype) and isinstance(e.ctype, IntType)
        if not self.checked or not (isinstance(e, Load) or written) or not isinstance(e.ctype, IntType):
            return text
        if e.ctype.name == SCHAR.name if isinstance(e, Load) else e.ctype.name == CHAR.name:
            if self.interval(e)[1] <= 127:
                return text
            site = self.site(e.ctype, source_text(e), kind="sign")
            return f"(_t if (_t := {text}) <= 127 else _c_octet(_t, {site}))"
        return text


def _computed(e: Expr, ctype: IntType) -> bool:
    """Whether `e` is an unsigned result, or a signed value taken as unsigned."""
    match e:
        case Binary(op=op) if op in RING:
            return True
        case Convert(operand=Expr(ctype=IntType(signed=True)), explicit=False):
            return True
    return False


def _mixed(e: Expr, target: IntType) -> bool:
    """Whether `e` adds an unsigned number to a signed one, or takes it away: an unsigned result of the same width.

    A word put together of its octets by shifts is a pattern of bits, whose sign is meant.
    """
    match e:
        case Binary(ctype=IntType(signed=False, bits=target.bits), op="+" | "-", left=left, right=right):
            sides = [s.operand if isinstance(s, Convert) and not s.explicit else s for s in (left, right)]
            signed = [isinstance(side.ctype, IntType) and side.ctype.signed for side in sides]
            shifted = any(isinstance(side, Binary) and side.op == "<<" for side in sides)
            return sum(signed) == 1 and not shifted and not any(isinstance(side, Const) for side in sides)
    return False


def _stepped(e: Expr) -> Variable | None:
    """The object that `e` steps by a constant."""
    match e:
        case Binary(op="+" | "-", left=stepped, right=Const()) | Binary(op="+", left=Const(), right=stepped):
            match bare(stepped):
                case Load(lvalue=LValue(root=Variable() as root)):
                    return root
    return None
