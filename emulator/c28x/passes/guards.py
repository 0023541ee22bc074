"""Pass `guards`: which values are checked while the firmware runs, and what the checks report.

A check is made only if passes `intervals` and `flow` cannot prove that it is not needed.  The decisions are stored on
the nodes (`guard`, `fresh`, `outside`, `sign`, `leaving`, `unwrapped`), so every code writer makes the same checks.

An unsigned result wraps silently, as C defines it.  It is compared with the mathematical result only where a wrap is
hardly intended: where it is widened afterwards, divided, limited, compared by order, or selects an element.

Kinds of guards:

| kind | on | what is tested |
|---|---|---|
| `overflow` | signed + - * << and negation | the result fits its type |
| `wrapped` | unsigned + - * << | the mathematical value is the wrapped one |
| `fields` | OR of shifted objects (pass `fields`) | no field has bits in the place of another |
| `divide`, `modulo`, `quotient` | / and % | the divisor is not 0; no needed remainder is lost |
| `shift` | << and >> | the count is in range |
| `float` | float operations of a watched image | no NaN or infinity arises; `more` is the check of a division |
| `float-to-int`, `float-argument`, `narrowed`, `octet`, `sign` | conversions | the value is not changed |
| `callable` | calls through a pointer | it points to a function |
| `unwritten` | loads | the object was written before |
| `index`, `deep`, `pointer`, `member` | accesses to an object | they stay inside |
| `poll`, `endless` | loops | they end |
| `pulse` | differences of captures that 16 bits keep, and their wider uses | no bits were lost |
| `parsed` | results of `atoi` that are widened | the text holds no larger number |
| `extended` | comparisons for equality of a 32-bit number with one that was cut to an `int` | the cut lost no sign |
| `stamps`, `past` | comparisons of stamps (pass `stamps`), the time since one | the counter has not wrapped between |
| `case` | switches over an enumeration | a value has a case |
| `float-out` | floats that others will see | they are finite |
| `quantity` | integers that go to a register field | they fit the field |
| `sign-lost` | signed integers that are scaled or limited as unsigned ones | they are not negative |
| `gone-back` | differences of 32 bits that become a float by 16 bits without a sign | they are not negative |
| `fraction` | floats that a cast makes integers in front of a factor | no fraction is lost that counts |
| `shifted-sign` | signed shift registers (pass `signs`) | their highest bit is not set |
| `word-of-24` | signed words of three octets (pass `signs`) | they take no step below 0 |
| `error-side` | errors of regulators with a sign that seems wrong (pass `feedback`) | they get to the other side of 0 |
| `signed-word` | unsigned words that the source takes for signed (pass `signs`) | their highest bit is not set |
| `regulator` | parts of regulators (pass `wind_up`) | their integral does not run beyond the limits of the output |
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Final

from emulator.c28x.ctypes import (
    CHAR,
    INT,
    SCHAR,
    UCHAR,
    UINT,
    ULONG,
    VOID,
    CType,
    Double64,
    FloatType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    StructType,
)
from emulator.c28x.passes.fields import meeting, or_terms, shift_of
from emulator.c28x.passes.image_facts import ImageFacts
from emulator.c28x.passes.intervals import LONGEST, RING, bounds_of, combine
from emulator.c28x.sites import Site, StackFrame
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Convert,
    CopyStruct,
    Declaration,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    Guard,
    If,
    Index,
    Interval,
    Load,
    Logic,
    LValue,
    Not,
    PointerAdd,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Unary,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    averaged,
    bare,
    blocks,
    children,
    computes_alone,
    different,
    named_scalar,
    own_nodes,
    parts,
    polls,
    register_text,
    source_text,
    statements,
    variables,
    without_end,
)  # fmt: skip
from emulator.c28x.tree_queries import within as inside

#: Factors that scale a ratio: per cent, per mille, milli.
SCALES: Final = (10, 100, 1000, 10000)
#: The full scales of an ADC of 12 bits: a code divided by one is a ratio.
FULL_SCALES: Final = (4095, 4096)
#: CHOICE: an odd factor above this one spreads the bits of a hash or of a random number; 4095 is the last of an ADC.
_HASH: Final = 4095
#: CHOICE: a difference of 32 bits without a sign above this one is a small negative one, and no time.
LAST_TIME: Final = 0xFFFF_FFFF - 4096
#: The captures of an eCAP.
CAPTURES: Final = ("CAP1", "CAP2", "CAP3", "CAP4")
CHARACTERS: Final = (CHAR.name, SCHAR.name, UCHAR.name)
#: Fields that hold a quantity, a level or a number: nobody intends a value that does not fit.  Fields for a phase (it
#: is cyclic), an octet (the lower part of a word) or a flag (a truth value) are not among them.
QUANTITIES: Final = frozenset((
    "CMPA", "CMPB", "CMPC", "CMPD", "TBPRD", "DBRED", "DBFED", "DACVALS", "DACVAL", "DELAY", "ACQPS", "CHSEL",
    "TRIGSEL", "BURSTSIZE", "SOCPRIORITY", "SPI_BIT_RATE", "SPICHAR", "RXFFIL", "TXFFIL", "IPSC", "SAR", "BRP",
    "TSEG1", "TSEG2", "DLC", "MSG_NUM", "UPPS", "CCPS", "TDDR", "THRESH", "SAMPWIN",
))  # fmt: skip


def is_character(ctype: object) -> bool:
    """Whether a type is one of the three character types."""
    return isinstance(ctype, IntType) and ctype.name in CHARACTERS

#: The name of a last constant that counts the others: `DIR_COUNT`, `NUM_MODES`, `MODE_N`.
_COUNT: Final = re.compile(r"count|(?<![a-z])num|max|size|total|last|end$|_n$|^n_|anzahl|numero", re.IGNORECASE)


class Guards:
    """Makes the decisions for one function.

    `watch`: the image is watched; `ieee`: float division follows IEEE; `room`: path of an array -> its length, instead
    of that of its type; `facts`: those about the image.
    """

    def __init__(
        self, function: Function, facts: ImageFacts, *, watch: bool, ieee: bool, room: Mapping[str, int]
    ) -> None:  # fmt: skip
        self.function = function
        self.watch = watch
        self.ieee = ieee
        self.room = room
        self.facts = facts
        #: The object that the statement assigns to; the ORs within one that is checked.
        self.assigned: LValue | None = None
        self.composed: set[int] = set()
        self.where = function.where
        self.frame = StackFrame(
            function.path,
            tuple((v.frame_offset, v.declaration) for v in (*function.parameters, *function.locals) if v.frame_offset),
        )
        #: Identity of each result that is widened afterwards -> the wider type; identities of remainders as subscripts.
        self.widened: dict[int, str] = {}
        self.indexing: set[int] = set()
        #: Identities of the operands of products and quotients.
        self.scaled: set[int] = set()
        self.averaged = averaged(function.body)
        self.kept = kept_objects(function.body)
        self.stepped = {n for s in statements(function.body) if isinstance(s, While) for n in steps(s)}

    def run(self) -> None:
        """Decide for the whole function."""
        for s in statements(self.function.body):
            self.where = s.where
            self.assigned = s.target if isinstance(s, Assign) and isinstance(s.target, LValue) else None
            self.statement(s)
            self.follow_parts(s)
        self.where = self.function.where
        f = self.function
        if f.ends and f.ctype.result != VOID:
            f.owing = Guard("unwritten", self.site(f.ctype.result, f"the value of {f.path}", caseless=f.left_by))

    def site(self, ctype: CType, name: str, declaration: Declaration | None = None, *, at: Where | None = None,
             **more: Any) -> Site:  # fmt: skip
        """The site of a check: at `at` if that has a line, else at the statement."""
        where = at if at is not None and at.line else self.where
        return Site(where, ctype, name, declaration, **more)

    def follow_parts(self, s: Stmt) -> None:
        """Check the words that have a sign in a statement, and follow the parts of regulators in it."""
        for p in own_nodes(s) if self.facts.regulators or self.facts.words else ():
            word = self.facts.words.get(id(p))
            if word is not None and p.leaving is None:
                site = self.site(p.ctype, source_text(p), at=p.where, bound=word.largest, widened=word.use)
                p.leaving = Guard(word.kind, site)
            part = self.facts.regulators.get(id(p))
            if part is not None:
                name = part.integral if part.kind == "sum" else source_text(p)
                site = self.site(
                    p.ctype, name, kind=part.kind, regulator=part.regulator, scale=part.scale, side=part.side
                )  # fmt: skip
                p.regulated = Guard("regulator", site)

    # Statements

    def statement(self, s: Stmt) -> None:
        match s:
            case Assign(target=target, value=value):
                if isinstance(target, LValue):
                    if id(s) in self.stepped:
                        self.unwrapped(value, "unsigned-wrap", "is compared by the loop around it")
                    elif id(s) in self.facts.sums:
                        self.unwrapped(value, "unsigned-wrap", "is divided or widened further down")
                    else:
                        self.sum_value(target, value)
                    self.leaves_for_all(target.root, value)
                    if not target.indices:
                        self.limited_later(named_scalar(target), value)
                        self.float_later(target, value)
                        self.cut_capture(target, value)
                    self.check_access(target)
                else:
                    self.value(value)
                    self.quantity(target, value)
                    if isinstance(target, RegisterAt):
                        self.register(target)
            case CopyStruct(target=target, source=source):
                self.check_access(target)
                self.check_access(source)
                # A structure that a caller passes is reported where the caller copies it.
                kind = "parameter" if isinstance(source.root, Variable) and source.root.kind == "parameter" else ""
                s.guard = Guard("pointer", self.site(INT, target.text or "structure", at=target.where, kind=kind))
            case Declare(value=list() as values):
                for value in different(values):
                    self.value(value)
            case Declare(variable=variable, value=Expr() as value):
                self.value(value)
                self.limited_later((variable, 0), value)
            case Evaluate(value=value) | Return(value=Expr() as value):
                self.value(value)
            case If(test=test):
                self.condition(test)
            case Switch(subject=subject):
                self.value(subject)
                self.no_case(s)
            case While(test=test):
                self.condition(test)
                if polls(s):
                    s.endless = Guard("poll", self.site(INT, polled(test)))
                elif computes_alone(s) or (not without_end(s) and computes_alone(s, self.facts.computing)):
                    kind = "idle" if without_end(s) else ""
                    s.endless = Guard("endless", self.site(INT, source_text(test), kind=kind))
            case For():
                self.for_loop(s)

    def for_loop(self, s: For) -> None:
        self.value(s.start)
        root = s.counter
        assert isinstance(root.ctype, IntType)
        if s.test is None:
            self.value(s.stop)
            return
        self.condition(s.test)
        if root.ctype.signed:
            s.guard = Guard("overflow", self.site(root.ctype, root.declaration.path, root.declaration))
        if computes_alone(s):
            text = f"{root.declaration.name} {'<' if s.step > 0 else '>'} {source_text(s.stop)}"
            s.endless = Guard("endless", self.site(INT, text))

    def no_case(self, s: Switch) -> None:
        """Check a switch over an enumeration without default.

        If it has all constants: a value above the first constant that has no case is not one of the enumeration.  If it
        has not: a constant without a case is reported only if all cases set the same object, and one of them to the
        value that it already has.  Then the list of cases was intended to be complete.  A last constant that only
        counts the others (`DIR_COUNT`) needs no case; a value above it is none of them.
        """
        if s.left is None or not isinstance(s.subject.ctype, IntType):
            return
        named = source_text(s.subject)
        labels = [value for values, _ in s.cases for value in values or ()]
        if s.complete and labels and not flags(labels):
            s.guard = Guard("case", self.site(s.subject.ctype, named, bound=max(labels), word=min(labels)))
        elif labels:
            most = max(s.left) if counts_others(s.left, labels) and not flags(labels) else 0
            text, constants = self.kept.get(id(s), ""), tuple(s.left.items())
            if text or most:
                site = self.site(
                    s.subject.ctype, named, text=text, constants=constants if text else (), bound=most, word=most
                )
                s.guard = Guard("case", site)

    def leaves_for_all(self, root: Variable | Expr, value: Expr) -> None:
        """Check a float that is stored where others see it."""
        if self.watch and isinstance(value.ctype, FloatType) and isinstance(root, Variable) and root.kind == "global":
            value.leaving = Guard("float-out", self.site(value.ctype, root.declaration.path, root.declaration))

    def quantity(self, target: RegisterRef | RegisterAt, value: Expr) -> None:
        """Check a number that is computed for a register field, before any cast cuts it."""
        named = target.field.name if target.field is not None else register_text(target).rpartition(".")[2]
        if named not in QUANTITIES:
            return
        while isinstance(value, Convert) and isinstance(value.operand.ctype, IntType) and value.guard is None:
            value = value.operand
        high = (1 << (target.field.width if target.field is not None else target.bits)) - 1
        low, largest = bounds_of(value)
        if isinstance(value.ctype, IntType) and not isinstance(value, Const) and not (low >= 0 and largest <= high):
            site = self.site(value.ctype, source_text(value), text=register_text(target), bound=high)
            value.leaving = Guard("quantity", site)

    def limited_later(self, scalar: NamedScalar | None, value: Expr) -> None:
        """Check a value of a scalar that is limited as unsigned: a negative number would become the largest."""
        if scalar in self.facts.limited:
            self.not_negative(value, "is limited")

    def float_later(self, target: LValue, value: Expr) -> None:
        """Check a number that the source casts to signed and then stores as unsigned, where its value becomes a float.

        A small negative number is none of the upper half of an unsigned range.
        """
        cast = as_unsigned(value)
        if isinstance(cast, Convert) and cast.explicit and named_scalar(target) in self.facts.made_float:
            later = "becomes a float later"
            site = self.site(cast.ctype, source_text(cast), at=cast.where, widened=later, kind="small")
            cast.leaving = Guard("sign-lost", site)
        named = named_scalar(target)
        if named in self.facts.made_float and named not in self.facts.in_a_range:
            self.gone_back(value, "becomes a float later")

    def cut_capture(self, target: LValue, value: Expr) -> None:
        """Check a capture of 32 bits that an object of 16 bits takes without a cast, and that is divided later.

        Other registers are cut on purpose: the lower half of a timer, the difference of two stamps.
        """
        match value:
            case Convert(
                ctype=IntType(signed=False, bits=16), explicit=False,
                operand=RegisterLoad(register=RegisterRef(bits=32, field=None) as register) as read,
            ) if register.register in CAPTURES and value.guard is None and named_scalar(target) in self.facts.numbers:
                value.guard = Guard("narrowed", self.site(value.ctype, source_text(read), at=value.where))

    def gone_back(self, e: Expr, then: str) -> None:
        """Check a difference of 32 bits of which 16 bits without a sign are kept, and become a float.

        A time since a stamp of 32 bits is never just below 0; a way is, once the wheel turns back.
        """
        match e:
            case Convert(
                ctype=IntType(signed=False, bits=16),
                operand=Binary(op="-", ctype=IntType(signed=False, bits=32), right=right) as difference,
            ) if not isinstance(right, Const):
                text = source_text(difference)
                site = self.site(difference.ctype, text, at=difference.where, widened=then, bound=LAST_TIME)
                difference.leaving = Guard("gone-back", site)

    def not_negative(self, e: Expr, then: str) -> None:
        """Check a signed number that is converted to unsigned of the same width; `then`: how it is used as a number."""
        operand = as_unsigned(e)
        if operand is not None and bounds_of(operand)[0] < 0 and not isinstance(operand, Const):
            site = self.site(operand.ctype, source_text(operand), at=operand.where, widened=then)
            operand.leaving = Guard("sign-lost", site)

    def sum_value(self, target: LValue, e: Expr) -> None:
        """Decide for an assigned value: an unsigned sum that is divided or widened later must not wrap."""
        match target.root, e:
            case Variable(in_memory=False) as root, Binary(op="+", left=Load(lvalue=LValue(root=added))) if (
                added is root and root.kind != "global" and root in self.averaged
            ):
                self.unwrapped(e, "unsigned-wrap", "is divided or widened further down")
            case Variable(in_memory=False) as root, Binary(op="*" | "<<") if (
                root in self.averaged and root not in variables(parts(e))
            ):
                self.unwrapped(e, "unsigned-wrap", "is divided or widened further down")
            case _, Binary(op="+" | "-", ctype=IntType(signed=False), left=Load(lvalue=stepped), right=by) if (
                stepped == target and named_scalar(target) in self.facts.limited
                and not (isinstance(by, Const) and by.value == 1)  # down from 0 to the limit: a ring, a digit
            ):
                self.unwrapped(e, "unsigned-wrap", "is limited")
            case _, Binary() if _of_stamps(target, e):
                self.unwrapped(e, "unsigned-wrap", "is more than 16 bits count")
                if e.guard is not None:
                    e.guard.site = replace(e.guard.site, kind="stamps", difference=False)
            case _:
                self.value(e)

    # Values

    def value(self, e: Expr) -> None:
        """Decide for an expression and its parts."""
        match e:
            case Load(lvalue=lvalue):
                self.load(lvalue)
            case Compare() | Logic() | Not():
                self.condition(e)
            case Conditional(test=test, then=then, otherwise=otherwise):
                self.value(then)
                self.condition(test)
                self.value(otherwise)
            case Convert():
                self.convert(e)
            case Binary():
                self.binary(e)
            case Unary(op=op, operand=operand, ctype=IntType() as ctype):
                self.value(operand)
                low, high = bounds_of(operand)
                if op == "-":
                    self.fits(e, ctype, (-high, -low))
            case Call():
                self.call(e)
            case CallPointer(target=target, arguments=arguments):
                taken_for = FunctionType("function", e.ctype, tuple(a.ctype for a in arguments))
                e.guard = Guard("callable", self.site(taken_for, source_text(target), at=e.where))
                self.all_in(e)
                self.float_arguments(arguments)
            case _:
                self.all_in(e)

    def all_in(self, e: Expr) -> None:
        """Decide for the parts of an expression."""
        for inner in children(e):
            if isinstance(inner, LValue):
                self.check_access(inner, address=isinstance(e, AddressOf))
            elif isinstance(inner, RegisterAt):
                self.register(inner)
            else:
                self.value(inner)

    def condition(self, e: Expr) -> None:
        """Decide for a controlling expression."""
        match e:
            case Compare(op=op, left=left, right=right):
                if id(e) in self.facts.stamps:
                    site = self.site(left.ctype, source_text(e), at=e.where, kind=self.facts.stamps[id(e)])
                    e.guard = Guard("stamps", site)
                pointers = isinstance(left.ctype, PointerType | HandleType | FunctionType)
                if pointers or op in ("==", "!="):
                    self.value(left)
                    self.value(right)
                    self.extended(e)
                    return
                self.ordered(left, right)
                self.ordered(right, left)
                if op in ("<", ">=") and isinstance(right, Const) and right.value == 0:
                    self.asked_for_sign(left)
            case Logic(operands=operands):
                for operand in operands:
                    self.condition(operand)
            case Not(operand=operand):
                self.condition(operand)
            case _:
                self.value(e)

    def ordered(self, e: Expr, other: Expr) -> None:
        """Decide for one side of a comparison by order."""
        ctype = e.ctype
        if not isinstance(ctype, IntType) or ctype.signed:
            self.value(e)
        elif isinstance(other, Const) and other.value in (ctype.high // 2, ctype.high // 2 + 1):
            self.value(e)  # a deliberate test whether a difference is negative
        else:
            self.unwrapped(e, "sign-compare" if isinstance(e, Convert) else "unsigned-wrap", "is compared")

    def extended(self, e: Compare) -> None:
        """Check a comparison with a 32-bit number: a number that became an `int` before may have become negative."""
        for side, other, kind in ((e.left, e.right, "left"), (e.right, e.left, "right")):
            cut = cut_to_int(side)
            if cut is not None and cut.guard is None and e.guard is None and not isinstance(other, Const):
                e.guard = Guard("extended", self.site(cut.ctype, source_text(e), at=e.where, kind=kind))

    def asked_for_sign(self, e: Expr) -> None:
        """A plain `char` is compared with 0, as if it had the sign of an octet: check it."""
        match e:
            case Convert(operand=Load(ctype=IntType(name="char")) as operand) if bounds_of(operand)[1] > 127:
                e.sign = Guard("sign", self.site(operand.ctype, source_text(operand), at=operand.where, kind="sign"))

    # Wraps that matter

    def unwrapped(self, e: Expr, rule: str, then: str) -> None:
        """Decide for a value that must be the mathematical one: check an unsigned result that can differ from it."""
        ctype = e.ctype
        if isinstance(e, Conditional):
            self.unwrapped(e.then, rule, then)
            self.condition(e.test)
            self.unwrapped(e.otherwise, rule, then)
            return
        if not isinstance(ctype, IntType) or ctype.signed or not _computed(e) or _shifted_out(e):
            self.value(e)
            return
        self.mathematical(e, ctype)
        e.unwrapped = True
        low, high = mathematical_bounds(e, ctype)
        if low < 0 or high > ctype.high:
            difference = isinstance(e, Binary) and e.op == "-" and not isinstance(e.right, Const)
            site = self.site(ctype, source_text(e), at=e.where, rule=rule, widened=then, difference=difference)
            e.guard = Guard("wrapped", site)

    def mathematical(self, e: Expr, ctype: IntType) -> None:
        """Decide for the operands below the + - * << of an unsigned tree that is computed without wraps."""
        for product in parts(e):
            if isinstance(product, Binary) and product.op == "*":
                self.scaled |= {id(product.left), id(product.right)}
        for leaf in mathematical_leaves(e, ctype):
            self.value(leaf)
        for product in parts(e):
            if isinstance(product, Binary):
                self.factors(product)

    def factors(self, e: Binary) -> None:
        """Check the widened factors of a product.  (In 16 bits the product is the same, signed or not.)

        A product with a large constant joins words or computes a hash, so it is not checked.
        """
        for side, other in ((e.left, e.right), (e.right, e.left)) if e.op == "*" else ():
            large = isinstance(other, Const) and other.value > UINT.high
            if isinstance(side, Convert) and not large and side.operand.ctype != side.ctype:
                self.not_negative(side.operand, "is scaled")
            if isinstance(other, Const) and other.value in SCALES:
                self.cut_before(side, int(other.value))

    def cut_before(self, side: Expr, scale: int) -> None:
        """Check a float that a cast makes an integer in front of a factor, if nothing else scales this float.

        Digits are taken apart so: `(int) (x * 10) - (int) x * 10`.
        """
        while isinstance(side, Convert) and isinstance(side.operand.ctype, IntType):
            side = side.operand
        if not isinstance(side, Convert) or not side.explicit or not isinstance(side.operand, Load | Call):
            return
        value = side.operand
        if isinstance(value, Call) or not any(
            isinstance(p, Binary) and _takes_fraction(p, value.lvalue, scale) for p in inside(self.function.body)
        ):  # fmt: skip
            site = self.site(value.ctype, source_text(value), at=value.where, scale=float(scale))
            value.leaving = Guard("fraction", site)

    def mark_widened(self, e: Expr, to: str) -> None:
        """Remember that the results below `e` are converted to `to` only after they have been computed."""
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

    def fits(self, e: Expr, ctype: IntType, exact: Interval | None, kind: str = "") -> None:
        """Check a signed result that may not fit its type."""
        if ctype.signed and (exact is None or exact[0] < ctype.low or exact[1] > ctype.high):
            widened = self.widened.get(id(e), "")
            site = self.site(ctype, source_text(e), at=e.where, widened=widened, kind=kind)
            e.guard = Guard("overflow", site)

    # Operators

    def binary(self, e: Binary) -> None:
        ctype, op = e.ctype, e.op
        if isinstance(ctype, FloatType):
            self.float_operation(e)
            return
        assert isinstance(ctype, IntType)
        if op == "|":
            self.fields(e)
        if op == "*" and isinstance(e.right, Const):
            quotient = bare(e.left)
            if isinstance(quotient, Binary) and quotient.op == "/" and _is_ratio(quotient, e.right):
                self.widened.setdefault(id(quotient), "scaled")
        if op in ("*", "/"):
            self.scaled |= {id(e.left), id(e.right)}
        self.dividend(e)
        self.value(e.right)
        self.factors(e)
        if op == "/":
            cast = e.left.operand if isinstance(e.left, Convert) and not e.left.explicit else e.left
            if isinstance(cast, Convert) and cast.explicit:  # otherwise the wrap of the dividend is reported
                self.not_negative(cast, "is divided")
        widened = self.widened.get(id(e), "")
        if op in ("/", "%"):
            kind = "divide" if op == "/" else "modulo"
            if op == "/" and widened in ("float", "scaled"):
                kind = "quotient"
            elif bounds_of(e.left)[0] >= 0 and bounds_of(e.right)[0] > 0:
                return
            e.guard = Guard(kind, self.site(ctype, source_text(e), at=e.where, widened=widened))
        elif op in ("<<", ">>"):
            low, high = bounds_of(e.right)
            if low < 0 or high >= ctype.bits:
                site = self.site(ctype, source_text(e), at=e.where, widened=widened, kind="shift")
                e.guard = Guard("shift", site)
            elif op == "<<":
                self.fits(e, ctype, e.exact, "shift")
        elif op in RING:
            self.fits(e, ctype, e.exact)

    def fields(self, e: Binary) -> None:
        """Check an OR of shifted fields that may have bits in each other's place."""
        self.composed |= {id(side) for side in (e.left, e.right) if side.ctype == e.ctype}
        if id(e) in self.composed:
            return
        pairs = meeting(e, self.facts.flags, self.assigned)
        if pairs:
            terms = or_terms(e)
            named = tuple((shift_of(term), source_text(term)) for term in terms)
            site = self.site(e.ctype, source_text(e), at=e.where, dimensions=tuple(pairs), constants=named)
            e.guard = Guard("fields", site)

    def float_operation(self, e: Binary) -> None:
        self.value(e.left)
        self.value(e.right)
        site = self.site(e.ctype, source_text(e), at=e.where)
        if self.watch:
            e.guard = Guard("float", site, site if e.op == "/" else None)
        elif e.op == "/" and not (
            (self.ieee or isinstance(e.ctype, Double64)) and isinstance(e.right, Const) and e.right.value != 0
        ):
            e.guard = Guard("divide", site)

    def dividend(self, e: Binary) -> None:
        """Decide for the left operand: a value that wraps before a division or a right shift is not intended."""
        power = isinstance(e.right, Const) and e.right.value > 0 and not int(e.right.value) & (int(e.right.value) - 1)
        divided = e.op == "/" or (e.op == "%" and not power)
        shifted = e.op == ">>" and isinstance(e.left, Binary) and (e.left.op == "-" or _scales(e.left))
        if divided or shifted:
            rule = "unsigned-wrap-index" if id(e) in self.indexing else "unsigned-wrap"
            self.unwrapped(e.left, rule, "is shifted" if e.op == ">>" else "is divided")
        else:
            self.value(e.left)

    def call(self, e: Call) -> None:
        self.all_in(e)
        self.float_arguments(e.arguments)
        for parameter, argument in zip(e.function.parameters, e.arguments, strict=False):
            self.limited_later((parameter, 0), argument)
        if not e.function.extern or not self.watch:
            return
        for argument in (*e.arguments, *e.extra):
            if isinstance(argument.ctype, FloatType):
                text = f"{e.function.name}({source_text(argument)})"
                argument.leaving = Guard("float-out", self.site(argument.ctype, text, at=argument.where))

    @staticmethod
    def float_arguments(arguments: Iterable[Expr]) -> None:
        """Let the conversions of float arguments report lost fractions, too; not those that are rounded."""
        for argument in arguments:
            match argument:
                case Convert(guard=Guard(kind="float-to-int") as guard, explicit=False, operand=given):
                    guard.kind = "float-to-int" if _rounded(given) else "float-argument"

    # Conversions

    def convert(self, e: Convert) -> None:
        target, operand = e.ctype, e.operand
        source = operand.ctype
        if id(e) in self.facts.pulses and e.guard is None:
            self.value(operand)
            kind = "cut" if isinstance(source, IntType) and source.bits == 32 else "read"
            text = self.facts.pulses[id(e)]
            e.guard = Guard("pulse", self.site(source, source_text(operand), at=e.where, kind=kind, text=text))
            return
        if isinstance(source, IntType) and (
            isinstance(target, FloatType) or (isinstance(target, IntType) and target.bits > source.bits)
        ):
            self.mark_widened(operand, target.name)
            self.unwrapped(operand, "widened-late", target.name)
            less = less_constant(operand)
            if less is not None and (isinstance(target, FloatType) or id(e) in self.scaled):
                self.unwrapped(less, "widened-late", target.name)
        else:
            self.value(operand)
        if isinstance(operand, Call) and operand.function.extern and operand.function.name == "atoi" and (
            isinstance(target, FloatType) or (isinstance(target, IntType) and target.bits == 32)
        ):  # fmt: skip
            text = source_text(operand)
            e.guard = Guard("parsed", self.site(operand.ctype, text, at=e.where, widened=target.name))
            return
        if isinstance(target, FloatType) and isinstance(operand, Convert) and operand.explicit:
            self.not_negative(operand, "becomes a float")
            self.gone_back(operand, "becomes a float")
        match target, source:
            case FloatType(), IntType(bits=bits) if bits <= 16:
                self.signed_character(e)
            case IntType(), FloatType():
                e.guard = Guard("float-to-int", self.site(target, source_text(operand), at=e.where))
            case IntType(), IntType():
                self.convert_int(e, target, source)

    def convert_int(self, e: Convert, target: IntType, source: IntType) -> None:
        operand = e.operand
        low, high = bounds_of(operand)
        if is_character(target) and not is_character(source):
            if self.octet(e, target):
                return
        elif is_character(source) and not is_character(target):
            self.signed_character(e)
        if target.low <= low and high <= target.high:
            return
        if id(e) in self.facts.stamps:
            e.guard = Guard("past", self.site(target, source_text(operand), at=e.where))
            return
        if (e.explicit or not target.signed) and not is_character(target) and loses_high_bits(operand, target):
            kind = "cast" if e.explicit else ""
            e.guard = Guard("narrowed", self.site(target, source_text(operand), at=e.where, kind=kind))
        if not target.signed or e.explicit:
            return
        if _mixed(operand, target):
            self.mathematical(operand, source)
            operand.unwrapped, operand.guard = True, None
            low, high = mathematical_bounds(operand, source)
            if target.low <= low and high <= target.high:
                return
        elif source.bits <= target.bits:
            return
        e.guard = Guard("narrowed", self.site(target, source_text(operand), at=e.where))

    def octet(self, e: Convert, target: IntType) -> bool:
        """Check a conversion to a character if the value may not fit an octet.  Returns whether there is a check."""
        low, high = octet_range(target)
        least, largest = bounds_of(e.operand)
        if (low <= least and largest <= high) or isinstance(e.operand, Const):
            return False
        counter = None if e.explicit else _stepped(e.operand)
        if counter is not None and (counter.kind != "global" or counter in self.facts.compared):
            return False  # a counter with a limit: it is meant to have 16 bits
        e.guard = Guard("octet", self.site(target, source_text(e.operand), at=e.where))
        return True

    def signed_character(self, e: Convert) -> None:
        """Check a signed character that is used in arithmetic: 0x80..0xFF is not negative here."""
        operand = e.operand
        match operand:
            case Load(ctype=IntType(name=name)):
                asked = name == SCHAR.name
            case Convert(ctype=IntType(name=name), explicit=True):
                asked = name == CHAR.name
            case _:
                asked = False
        if asked and bounds_of(operand)[1] > 127:
            e.sign = Guard("sign", self.site(operand.ctype, source_text(operand), at=operand.where, kind="sign"))

    # Objects

    def load(self, lvalue: LValue) -> None:
        self.check_access(lvalue)
        root = lvalue.root
        if isinstance(root, Variable) and lvalue.unwritten is not None:
            if root.kind == "temporary":  # it has no name in the source
                lvalue.fresh = Guard("unwritten", self.site(lvalue.ctype, lvalue.text, at=lvalue.where))
                return
            text = "" if root.plain else lvalue.text
            kind = "static" if root.kind == "global" else ""
            site = self.object(lvalue, root, text=text, caseless=lvalue.unwritten.complete, kind=kind)
            lvalue.fresh = Guard("unwritten", site)

    def check_access(self, lvalue: LValue, *, address: bool = False) -> None:
        """Check the subscripts and the pointer of an access.  An `address` may be right behind an array."""
        for index in lvalue.indices:
            self.subscript(index.expr)
        if isinstance(lvalue.root, Expr):
            self.pointed(lvalue, lvalue.root, address=address)
            return
        root = lvalue.root
        limits = [self.bound(root, index) for index in lvalue.indices]
        if lvalue.bits is not None or (isinstance(lvalue.ctype, StructType) and lvalue.indices):
            # It is accessed by its words, as through a pointer.
            lvalue.outside = Guard("pointer", self.object(lvalue, root))
        elif not all(within(i.expr, limit) for i, limit in zip(lvalue.indices, limits, strict=True)):
            local = root.kind != "global"
            one = len(limits) == 1
            site = self.object(
                lvalue, root, bound=limits[0] if one else 0,
                dimensions=tuple((limit, i.words) for limit, i in zip(limits, lvalue.indices, strict=True)),
                word=lvalue.words, wraps=wrapping_subscript(lvalue), frame=self.frame if local else None,
                frame_start=root.frame_offset + lvalue.words if local else 0,
            )  # fmt: skip
            lvalue.outside = Guard("index" if one else "deep", site)

    def pointed(self, lvalue: LValue, pointer: Expr, *, address: bool) -> None:
        """Check an access through a pointer, and the subscripts of array members behind it."""
        self.value(pointer)
        about: dict[str, Any] = {"at": lvalue.where, "text": lvalue.text, "wraps": wrapping_subscript(lvalue)}
        lvalue.outside = Guard("pointer", self.site(lvalue.ctype, describe(pointer), **about))
        for index in lvalue.indices:
            if index.bound is not None and not within(index.expr, index.bound + address):
                about |= {"bound": index.bound, "kind": "address" if address else ""}
                index.guard = Guard("member", self.site(lvalue.ctype, describe(pointer), **about))

    def object(self, lvalue: LValue, root: Variable, **more: Any) -> Site:
        """The site of an access to an object by its name."""
        about: dict[str, Any] = {"text": lvalue.text, **more}
        return self.site(lvalue.ctype, root.declaration.path, root.declaration, at=lvalue.where, **about)

    def register(self, ref: RegisterAt) -> None:
        """Check an access to a register through a pointer to its block."""
        self.value(ref.block)
        ctype = ULONG if ref.bits == 32 else UINT
        ref.guard = Guard("pointer", self.site(ctype, describe(ref.block), at=ref.block.where, text=register_text(ref)))

    def bound(self, variable: Variable, index: Index) -> int:
        """The length of the subscripted array; `room` may have enlarged it."""
        assert index.bound is not None
        return self.room.get(variable.declaration.path, index.bound) if index.leaves == 1 else index.bound

    def subscript(self, e: Expr) -> None:
        # A difference that wraps is far outside of any array; other wrapped results may be inside by chance.
        if isinstance(e, Binary) and e.op in ("+", "*"):
            self.unwrapped(e, "unsigned-wrap-index", "")
            return
        if isinstance(e, Binary) and e.op == "%":
            self.indexing.add(id(e))
        self.value(e)


def flags(values: Iterable[int]) -> bool:
    """Whether constants are flags, to be combined: 1, 2, 4 ..."""
    listed = set(values)
    return 4 in listed and 3 not in listed and all(value & value - 1 == 0 for value in listed)


def counts_others(left: Mapping[int, str], labels: Collection[int]) -> bool:
    """Whether the only constant of an enumeration that is no case is the last one, and its name says that it counts."""
    return list(left) == [max(labels) + 1] and _COUNT.search(left[max(labels) + 1]) is not None


def kept_objects(body: list[Stmt]) -> dict[int, str]:
    """Identity of a switch -> the object that every case sets to a constant, one case to the value it already has."""
    found: dict[int, str] = {}
    for block in (body, *(inner for s in statements(body) for inner in blocks(s))):
        start: dict[str, int | float] = {}
        for s in block:
            match s:
                case Declare(variable=variable, value=Const(value=value)):
                    start[variable.declaration.name] = value
                case Assign(target=LValue(text=text), value=Const(value=value)):
                    start[text] = value
                case Switch(cases=cases):
                    given = [_constants(inner) for _, inner in cases]
                    for text, value in start.items():
                        if all(text in one for one in given) and any(one.get(text) == value for one in given):
                            found[id(s)] = f"{text} keeps {value}"
                    start = {}
                case _:
                    start = {}
    return found


def _constants(body: list[Stmt]) -> dict[str, int | float]:
    """The constants that a case assigns to objects."""
    return {
        s.target.text: s.value.value
        for s in body
        if isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(s.value, Const)
    }


def steps(loop: While) -> set[int]:
    """The statements of a loop that step an unsigned object of its test: one compared by order or with a constant.

    A test whether an unsigned number is below 0 never ends the loop: it is reported as a constant condition instead.
    A step down that wraps ends a loop with an upper limit (`i < n`), as it shall.
    """
    tested = [loop.test, *(s.test for s in loop.body if isinstance(s, If) and s.then and isinstance(s.then[0], Break))]
    tested += [s.value for s in loop.step if isinstance(s, Assign)]
    objects: list[LValue] = []
    for part in (p for test in tested for p in parts(test)):
        if isinstance(part, Compare) and not (part.op in ("<", ">=") and zero(part.right)):
            for side, other in ((part.left, part.right), (part.right, part.left)):
                match bare(side):
                    case Load(lvalue=lvalue) if part.op not in ("==", "!=") or isinstance(other, Const):
                        objects.append(lvalue)
    for test in tested:
        match bare(test):
            case Load(lvalue=lvalue) | Not(operand=Load(lvalue=lvalue)):
                objects.append(lvalue)
    found: set[int] = set()
    for s in statements([*loop.body, *loop.step]):
        match s:
            case Assign(target=LValue(ctype=IntType(signed=False)) as target, value=Binary(op="+" | "-", left=left)):
                stepped = bare(left)
                down = isinstance(s.value, Binary) and s.value.op == "-"
                if down and any(_limits(test, target) for test in _conjuncts(loop.test)):
                    continue
                if target in objects and isinstance(stepped, Load) and stepped.lvalue == target:
                    found.add(id(s))
    return found


def _conjuncts(test: Expr) -> Iterator[Expr]:
    """The conditions that must all be true for `test` to be true."""
    match bare(test):
        case Logic(op="and", operands=operands):
            for each in operands:
                yield from _conjuncts(each)
        case one:
            yield one


def _limits(test: Expr, target: LValue) -> bool:
    """Whether a condition is false for a large number at `target`: `i < 600`."""
    match test:
        case Compare(op="<" | "<=", left=small) | Compare(op=">" | ">=", right=small):
            match bare(small):
                case Load(lvalue=lvalue):
                    return lvalue == target
    return False


def zero(e: Expr) -> bool:
    """Whether `e` is the constant 0."""
    return isinstance(e, Const) and e.value == 0


def loses_high_bits(e: Expr, target: IntType) -> bool:
    """Whether a cast cuts a number that was meant to fit: a product, or a product or a long after scaling down.

    Casts of sums and differences intend a result modulo 65536; shifts of unsigned values split words.
    """
    match e:
        case Binary(op="*"):
            return target.signed
        case Binary(op="/", left=left):
            # A clock divided by a rate: the cut is no counter's wrap.
            return _product(left) or (isinstance(left, Const) and left.value > UINT.high)
        case Binary(op=">>", left=Expr(ctype=IntType(signed=True)) as left, right=Const(value=count)):
            return target.signed and (_product(left) or 0 < count < target.bits)
    return False


def as_unsigned(e: Expr) -> Expr | None:
    """The signed integer that `e` converts to unsigned of the same width; None for other expressions."""
    match e:
        case Convert(ctype=IntType(signed=False, bits=bits), operand=Expr(ctype=IntType(signed=True)) as operand):
            return operand if isinstance(operand.ctype, IntType) and operand.ctype.bits == bits else None
    return None


def less_constant(e: Expr) -> Binary | None:
    """The difference of an unsigned number and a constant, in a cast to its own type; None for other expressions.

    Such a cast says that a wrap is intended, as for the time since a stamp.  A constant is no stamp.
    """
    match e:
        case Convert(
            ctype=IntType(signed=False, bits=bits), operand=Binary(op="-", ctype=IntType(signed=False), right=Const())
        ) if isinstance(e.operand.ctype, IntType) and e.operand.ctype.bits == bits:
            assert isinstance(e.operand, Binary)
            return e.operand
    return None


def cut_to_int(e: Expr) -> Convert | Call | None:
    """The `int` that `e` widens, if it was a wider or an unsigned number before.

    It is a cast, or a call of a function that returns only unsigned numbers, as an `int`.
    """
    match e:
        case Convert(
            ctype=IntType(bits=32), operand=Convert(ctype=IntType(signed=True, bits=16), operand=before) as cut
        ) if _larger(before, cut.ctype):
            return cut
        case Convert(ctype=IntType(bits=32), operand=Call(ctype=IntType(signed=True, bits=16)) as call):
            results = [s.value for s in statements(call.function.body) if isinstance(s, Return)]
            if results and all(isinstance(r, Convert) and _larger(r.operand, call.ctype, bits=16) for r in results):
                return call
    return None


def _larger(e: Expr, target: CType, *, bits: int = 32) -> bool:
    """Whether `e` is an integer of at most `bits` bits that may be above the range of `target`; no characters."""
    of = e.ctype
    return (
        isinstance(of, IntType) and isinstance(target, IntType) and of.bits <= bits and bounds_of(e)[1] > target.high
        and not is_character(of) and not is_character(target)
    )  # fmt: skip


def _rounded(e: Expr) -> bool:
    """Whether an expression adds 0.5, to round before the fraction is cut."""
    return any(isinstance(p, Const) and p.value == 0.5 for p in parts(e))


def _product(e: Expr) -> bool:
    return any(isinstance(p, Binary) and p.op == "*" for p in parts(e))


def within(e: Expr, limit: int) -> bool:
    """Whether a subscript is certainly one of `limit` elements."""
    low, high = bounds_of(e)
    return low >= 0 and high < limit


def wraps(e: Binary) -> bool:
    """Whether an operator only loses upper bits when it wraps: + - *, and << by a constant."""
    return e.op in RING or (e.op == "<<" and isinstance(e.right, Const) and e.right.value in range(LONGEST))


def mathematical_leaves(e: Expr, ctype: IntType) -> list[Expr]:
    """The operands below the + - * << of an unsigned tree; a converted signed value counts before its conversion."""
    match e:
        case Binary(left=left, right=right) if wraps(e) and e.ctype == ctype:
            return [*mathematical_leaves(left, ctype), *mathematical_leaves(right, ctype)]
        case Convert(operand=Expr(ctype=IntType(signed=True)) as operand, explicit=False) if e.ctype == ctype:
            return [operand]
    return [e]


def mathematical_constant(e: Expr) -> int | None:
    """The negative constant in the source that was converted to this unsigned one; None: there is none."""
    match e:
        case Const(source=Convert(operand=Const(ctype=IntType(signed=True), value=int(value)), explicit=False)):
            return value
    return None


def mathematical_bounds(e: Expr, ctype: IntType) -> Interval:
    """Bounds of the mathematical value of an unsigned tree, without any wrap."""
    match e:
        case Binary(op=op, left=left, right=right) if wraps(e) and e.ctype == ctype:
            result = combine(op, mathematical_bounds(left, ctype), mathematical_bounds(right, ctype))
            assert result is not None
            return result
        case Convert(operand=Expr(ctype=IntType(signed=True)) as operand, explicit=False) if e.ctype == ctype:
            return bounds_of(operand)
    constant = mathematical_constant(e)
    return bounds_of(e) if constant is None else (constant, constant)


def octet_range(target: IntType) -> Interval:
    """The range of a character type if it had 8 bits."""
    return (0, 255) if target.name == UCHAR.name else (-128, 127 if target.name == SCHAR.name else 255)


def describe(e: Expr) -> str:
    """The name of a pointer expression for a report."""
    match e:
        case Load(lvalue=LValue(root=Variable() as variable)):
            return variable.declaration.path
        case PointerAdd(pointer=pointer) | Convert(operand=pointer):
            return describe(pointer)
        case AddressOf(lvalue=LValue(root=Variable() as variable)):
            return variable.declaration.path
        case AddressOf(lvalue=LValue(root=Expr() as pointer)):
            return describe(pointer)
        case Load() | Call() | CallPointer():
            return source_text(e)
    return "pointer"


def polled(test: Expr) -> str:
    """The register or object that a poll reads."""
    for part in parts(test):
        if isinstance(part, RegisterLoad):
            return register_text(part.register)
        if isinstance(part, LValue) and isinstance(part.root, Variable):
            return part.root.declaration.path
    return "condition"


def wrapping_subscript(lvalue: LValue) -> str:
    """The source text of a subscript that an unsigned operation computes; empty: there is none."""
    for index in lvalue.indices:
        match index.expr:
            case Binary(ctype=IntType(signed=False), op="-" | "+" | "*") as computed:
                return source_text(computed)
    return ""


def _shifted_out(e: Expr) -> bool:
    """Whether a constant in `e` shifts by the width of its type or more: C does not define that, whatever the value."""
    shifts = (p for p in parts(e) if isinstance(p, Binary) and p.op == "<<")
    return any(isinstance(p.ctype, IntType) and bounds_of(p.right)[0] >= p.ctype.bits for p in shifts)


def _scales(e: Binary) -> bool:
    """Whether a product is that of a fixed-point number, and not the hash of one: hashes have large odd factors."""
    return e.op == "*" and not any(
        isinstance(side, Convert | Const) and isinstance(factor := bare(side), Const)
        and int(factor.value) % 2 and factor.value > _HASH
        for side in (e.left, e.right)
    )  # fmt: skip


def _computed(e: Expr) -> bool:
    """Whether `e` is a result of + - * <<, or a signed value that is converted to unsigned."""
    match e:
        case Binary() if wraps(e):
            return True
        case Convert(operand=Expr(ctype=IntType(signed=True)), explicit=False):
            return True
    return False


def _of_stamps(target: LValue, e: Binary) -> bool:
    """Whether a long gets, or adds, the difference of two unsigned 16-bit numbers that were widened before."""
    match e:
        case Binary(op="+", left=Load(lvalue=grown), right=Binary(op="-") as difference) if grown == target:
            e = difference
    match e:
        case Binary(ctype=IntType(signed=False, bits=32), op="-", left=Convert(operand=a), right=Convert(operand=b)):
            return all(isinstance(x.ctype, IntType) and not x.ctype.signed and x.ctype.bits == 16 for x in (a, b))
    return False


def _mixed(e: Expr, target: IntType) -> bool:
    """Whether `e` adds or subtracts a signed and an unsigned number: the result is unsigned, of the same width.

    A word composed of octets by shifts is a bit pattern; its sign is intended.
    """
    match e:
        case Binary(ctype=IntType(signed=False, bits=target.bits), op="+" | "-", left=left, right=right):
            sides = [s.operand if isinstance(s, Convert) and not s.explicit else s for s in (left, right)]
            signed = [isinstance(side.ctype, IntType) and side.ctype.signed for side in sides]
            shifted = any(isinstance(side, Binary) and side.op == "<<" for side in sides)
            return sum(signed) == 1 and not shifted and not any(isinstance(side, Const) for side in sides)
    return False


def _takes_fraction(e: Binary, lvalue: LValue, scale: int) -> bool:
    """Whether a float operation scales an object too, or takes its whole part away: `x * 10.0f`, `x - (int) x`."""
    sides = [bare(side) for side in (e.left, e.right)]
    if not isinstance(e.ctype, FloatType) or not any(isinstance(s, Load) and s.lvalue == lvalue for s in sides):
        return False
    return e.op == "-" or (e.op == "*" and any(isinstance(s, Const) and s.value == scale for s in sides))


def _stepped(e: Expr) -> Variable | None:
    """The object that `e` increments or decrements by a constant; None: there is none."""
    match e:
        case Binary(op="+" | "-", left=stepped, right=Const()) | Binary(op="+", left=Const(), right=stepped):
            match bare(stepped):
                case Load(lvalue=LValue(root=Variable() as root)):
                    return root
    return None


def _is_ratio(quotient: Binary, factor: Const) -> bool:
    """Whether a quotient in front of a constant factor is a ratio, and no number of whole units."""
    divisor = bare(quotient.right)
    if isinstance(divisor, Const):
        return divisor.value in FULL_SCALES and factor.value not in (1, divisor.value)
    return factor.value in SCALES
