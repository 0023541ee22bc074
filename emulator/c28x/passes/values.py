"""Static check of values: constant conditions, constants that do not fit, lossy divisions, mixed signs."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from itertools import pairwise
from math import ceil, floor, isfinite
from typing import Any, Final, NamedTuple

from emulator.c28x.arithmetic import COMPARE
from emulator.c28x.ctypes import LONG_DOUBLE, NOBODY, UCHAR, FloatType, IntType, PointerType
from emulator.c28x.passes.blocks import check_blocks
from emulator.c28x.passes.counted import CounterEndValues, known_locals, turning
from emulator.c28x.passes.formats import check_format
from emulator.c28x.passes.intervals import Ranges, interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Convert,
    CopyStruct,
    Declare,
    Expr,
    Field,
    For,
    Function,
    If,
    Interval,
    Load,
    Logic,
    LValue,
    Not,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Unary,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    TURNED,
    NamedScalar,
    bare,
    calls,
    different,
    named_scalar,
    once,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
)  # fmt: skip

#: The most that a FIFO of an SCI, SPI or I2C holds (TRM, `TXFFST`).
_FIFO_WORDS: Final = 16


class ConstantChecks:
    """The checks of constants at one place of a function, or (None) of the file scope."""

    def __init__(self, function: Function | None, report: StaticReport, where: Where) -> None:
        self.function = function
        self.to = report
        self.where = where

    def report_here(self, rule: str, message: str, object: str = "", value: int | float | None = None) -> None:
        """Report at the present statement."""
        self.to.report(self.function, self.where, rule, message, object=object, value=value)

    def given(self, e: Any) -> None:
        """Check a value that is assigned, returned or passed."""
        match e:
            case Const(
                source=Convert(ctype=IntType() as to, operand=Const(value=value) as written, explicit=False)
            ) if value != e.value and not _as_pattern(written, to) and written.ctype != LONG_DOUBLE:
                # Macros compute counts of cycles in long double: their fraction is meant to be lost.
                text = source_text(written)
                self.report_here("assignment-loses", f"{text} does not fit a {to}: it becomes {e.value}", text, value)

    def folded(self, e: Const) -> None:
        """Report what was lost when a constant was folded."""
        waiting = [e]
        while waiting:
            waiting += reversed(self.fold(waiting.pop()))

    def fold(self, e: Const) -> list[Const]:
        """Report what one folding step has lost.  Returns the constants that it began with."""
        match e.source:
            case Convert(ctype=FloatType(), operand=Const() as operand):
                quotient = _lossy_division(operand)
                if quotient is not None:
                    self.integer_division(quotient)
            case Binary(op="*" | "/", left=left, right=Const(value=8) as right) if _size(left) and not _size(right):
                self.report_here(
                    "octet", f"{source_text(e.source)}: sizeof counts words of 16 bits here, not octets", "sizeof"
                )
            case Binary(op="/", left=left, right=right) if _of_pointer(left, right):
                message = "the size of a pointer divided by the size of its target is not the number of elements"
                self.report_here("sizeof-pointer", f"{source_text(e.source)}: {message}", source_text(e.source))
            case Binary(op="/", left=Const(value=int(a))) as quotient if a and e.value == 0:
                text = source_text(quotient)
                self.report_here("integer-division-in-float", f"{text} is 0 in integers", text)
            case Binary(left=Const() as left, right=Const() as right):
                return [left, right]
            case Convert(operand=Const() as operand) | Unary(operand=Const() as operand):
                return [operand]
        return []

    def integer_division(self, e: Binary) -> None:
        text = source_text(e)
        message = f"{text} divides integers, and is converted to float only afterwards"
        self.report_here("integer-division-in-float", message, text)


class _KnownLocals(NamedTuple):
    """What is known of the locals of a function."""

    known: Ranges
    #: The same without the numbers of turns of loops.
    loosely: Ranges
    #: The counters of loops around each statement: a test of one of them may be a choice of the build.
    turning: dict[int, frozenset[Variable]]
    #: The values of counters after their loops.
    ends: CounterEndValues
    doubtful: set[Variable]
    fixed: dict[Variable, Const]


@once
def _known_of(function: Function) -> _KnownLocals:
    return _KnownLocals(
        known_locals(function, counted=True), known_locals(function, counted=False),
        turning(function.body, frozenset()), CounterEndValues(function.body), maybe_negative(function),
        fixed_locals(function),
    )  # fmt: skip


class ValueChecks(ConstantChecks):
    """The checks of one function."""

    def __init__(
        self, function: Function, report: StaticReport, shared: Container[str] = (),
        flag_words: Container[NamedScalar] = (), masks: Container[Where] = (),
        results: Mapping[str, Interval] | None = None,
    ) -> None:  # fmt: skip
        """`shared`: the names of the file's objects.  `flag_words`: those in which a bit above bit 0 is a flag.

        `masks`: the places of the macros that the program uses as masks.
        `results`: the bounds of what functions return.
        """
        super().__init__(function, report, function.where)
        self.shared = shared
        self.flag_words = flag_words
        self.masks = masks
        self.results = results or {}
        self.body = function.body
        self.locals = _known_of(function)
        self.ranges: Ranges = self.locals.known
        #: Identities of results that are cast to their own type: a wrap is intended.
        self.meant: set[int] = set()
        #: Identities of assignments in a branch to objects that the other branch assigns too: `x = x` is allowed there.
        self.kept: set[int] = set()

    def run(self) -> None:
        """Make all checks of the function."""
        known, loosely, ends = self.locals.known, self.locals.loosely, self.locals.ends
        for s in statements(self.body):
            self.where = s.where
            self.ranges = known
            for counter in self.locals.turning.get(id(s), ()):
                others = {v: bounds for v, bounds in self.ranges.items() if v is not counter}
                self.ranges = others | ({counter: loosely[counter]} if counter in loosely else {})
            if behind := ends.behind.get(id(s)):
                self.ranges = {**self.ranges, **{v: (end, end) for v, end in behind.items()}}
            if id(s) in ends.too_late:
                self.too_late(ends.too_late[id(s)])
            literal = isinstance(s, While) and isinstance(s.test, Const)
            match s:
                case If(test=test) | While(test=test) if not literal:
                    self.condition(test)
                case For(variable=LValue(root=Variable(ctype=IntType() as ctype)), stop=stop, step=step):
                    bounds = self.bounds(stop)
                    if bounds is not None and (bounds[0] > ctype.high if step > 0 else bounds[1] < ctype.low):
                        self.report_here(
                            "constant-condition",
                            f"the loop never ends: a {ctype} never reaches {source_text(stop)}", source_text(stop),
                        )  # fmt: skip
            match s:
                case Assign(target=LValue(root=Variable() as root, indices=[]), value=given) if root.constants:
                    self.outside(root, bare(given))
            match s:
                case If(then=then, otherwise=otherwise):
                    self.kept |= _assigned_in_both(then, otherwise) | _assigned_in_both(otherwise, then)
            match s:
                case Assign(target=LValue() as target, value=Load(lvalue=source)) if (
                    target == source and id(s) not in self.kept
                ):
                    self.assigned_to_itself(target)
                case CopyStruct(target=target, source=source) if target == source and id(s) not in self.kept:
                    self.assigned_to_itself(target)
            match s:
                case Assign(target=LValue() as target, value=stepped):
                    self.stepped_by_one_bit(target, bare(stepped))
                case Declare(variable=local, value=Expr() as stepped):
                    self.stepped_by_one_bit(LValue(local.ctype, local), bare(stepped))
            match s:
                case Assign(value=value) | Declare(value=value) | Return(value=value):
                    for item in different(value) if isinstance(value, list) else [value]:
                        self.given(item)
            for part in own_nodes(s):
                if isinstance(part, Expr):
                    self.expression(part)

    def outside(self, variable: Variable, value: Expr) -> None:
        """Report a constant above all constants of its enumeration; not flags, nor a value that means "none"."""
        known = variable.constants
        low, high = min(known), max(known)
        if not isinstance(value, Const) or not isinstance(value.value, int) or value.value in NOBODY:
            return
        flags = high >= len(known) and all(constant & (constant - 1) == 0 for constant in known)
        if value.value > high and not flags:
            name = variable.declaration.name
            message = f"{name} is set to {source_text(value)}, no constant of its enumeration ({low} to {high})"
            self.report_here("no-case", message, variable.declaration.path, value.value)

    def assigned_to_itself(self, target: LValue) -> None:
        """Report `x = x`.  Allowed: a parameter, to mark it as unused; a volatile object (or `*p`), to read it.

        A parameter that hides an object of the file is reported: one side was meant to be that object.
        """
        root = target.root
        parameter = isinstance(root, Variable) and root.kind == "parameter" and root.declaration.name not in self.shared
        if not parameter and not volatile(target) and not target.text.startswith("*") and not calls(target):
            self.report_here("self-assignment", f"{target.text} is assigned to itself", target.text)

    def stepped_by_one_bit(self, target: LValue, value: Expr) -> None:
        """Report `at = (at + 1) & 16`, where `& 15` is the remainder.  One bit that is stepped by itself toggles.

        The step may go over a local: `next = (at + 1) & 16; ... at = next;`.
        """
        match value:
            case Binary(op="&", left=left, right=Const(value=int(mask))) if mask > 1 and mask & (mask - 1) == 0:
                match bare(left):
                    case Binary(op="+", left=Load(lvalue=same), right=Const(value=step)) if (
                        (same == target or self.copied_to(same, target)) and step != mask
                    ):
                        text = source_text(value)
                        message = f"{text} is 0 or {mask}: the mask of a remainder by {mask} is {mask} - 1"
                        self.report_here("mask-gaps", message, text, mask)

    def copied_to(self, place: LValue, value: LValue) -> bool:
        """Whether the function gives the value of one object to another one somewhere."""
        return any(
            isinstance(s, Assign) and s.target == place and isinstance(read := bare(s.value), Load)
            and read.lvalue == value
            for s in statements(self.body)
        )  # fmt: skip

    # Conditions

    def too_late(self, counter: Variable) -> None:
        """Report a comparison of a counter with 0 after a loop whose test has already counted past 0."""
        assert isinstance(counter.ctype, IntType)
        name, end = counter.declaration.name, counter.ctype.wrap(-1)
        message = f"{name} is compared with 0, but the test that ends the loop counts once more: then {name} is {end}"
        self.report_here("constant-condition", message, counter.declaration.path)

    def condition(self, test: Expr) -> None:
        """Check a controlling expression.  (`compare` checks comparisons, wherever they are.)"""
        match test:
            case Logic(operands=operands):
                for operand in operands:
                    self.condition(operand)
                    self.constant_operand(test, operand)
            case Not(operand=operand):
                self.condition(operand)
            case Compare():
                pass
            case _ if isinstance(test.ctype, IntType) and depends(test):
                low, high = interval(test, self.ranges)
                if low == high or low > 0 or high < 0:
                    always = "true" if low > 0 or high < 0 else "false"
                    text = source_text(test)
                    self.report_here("constant-condition", f"{text} is always {always}: it is {low} to {high}", text)

    def constant_operand(self, test: Logic, operand: Expr) -> None:
        """Report `mode == 1 || 2`, and `flags && MASK` where the program uses MASK as a mask.

        0 and 1 are truth values.  What a macro names may be a choice of the build.
        """
        number = bare(operand)
        if not isinstance(number, Const) or number.value in (0, 1) or number.source is not None or not depends(test):
            return
        others = [bare(o) for o in test.operands if o is not operand]
        compared = any(isinstance(o, Compare) and o.op == "==" and isinstance(bare(o.right), Const) for o in others)
        if number.where.macro in self.masks if number.where.macro is not None else compared or test.op == "and":
            text = source_text(test)
            message = f"{text}: {source_text(number)} alone is always true; it is not compared with anything"
            self.report_here("constant-condition", message, text)

    def bounds(self, e: Expr) -> tuple[float, float] | None:
        """Bounds of an arithmetic expression; None if nothing is known."""
        match e:
            case Const(value=value):
                return (value, value)
            case Convert(ctype=FloatType(), operand=operand):
                return self.bounds(operand)
        if _is_fifo_level(bare(e)):
            return (0, _FIFO_WORDS)
        return interval(e, self.ranges) if isinstance(e.ctype, IntType) else None

    def compare(self, e: Compare) -> None:
        if not depends(e):
            return
        left, right = self.bounds(e.left), self.bounds(e.right)
        if left is None or right is None:
            return
        outcomes = {COMPARE[e.op](a, b) for a in left for b in right}
        if e.op in ("==", "!="):
            left, right = self.returned(e.left, e.right) or left, self.returned(e.right, e.left) or right
            apart = left[1] < right[0] or right[1] < left[0] or _no_common_bits(e.left, e.right)
            same = left == right and left[0] == left[1]
            outcomes = {e.op == "!="} if apart else {e.op == "=="} if same else {False, True}
        if len(outcomes) > 1:
            return
        always = "true" if outcomes.pop() else "false"
        text = source_text(e)
        of = e.left if not isinstance(bare(e.left), Const) else e.right
        low, high = self.returned(of, e.right if of is e.left else e.left) or self.bounds(of) or (0, 0)
        why = f"{source_text(of)} is {low:g} to {high:g} ({bare(of).ctype})"
        self.report_here("constant-condition", f"{text} is always {always}: {why}", text)

    def returned(self, e: Expr, other: Expr) -> Interval | None:
        """The bounds of a call whose result is compared with a number; None: not known.

        A negative number may stand for a failure that the function of this build does not have.
        """
        call, number = bare(e), bare(other)
        if isinstance(call, Call) and isinstance(number, Const) and number.value > 0 and not _negative_source(number):
            return self.results.get(call.function.path)
        return None

    def logic(self, e: Logic) -> None:
        """Check joined comparisons of one value with constants: try the values at the constants, and between them."""
        subjects: set[str] = set()
        tests: list[tuple[str, float]] = []
        limits: set[float] = set()
        points: set[float]
        turned: list[Expr] = []
        for operand in e.operands:
            match operand:
                case Compare(left=Const()):
                    operand = Compare(operand.ctype, TURNED[operand.op], operand.right, operand.left)
            turned.append(operand)
            match operand:
                case Compare(op=op, left=left, right=Const(value=value)) if not calls(left) and depends(left):
                    subjects.add(source_text(left) if not volatile(left) else "")
                    tests.append((op, value))
                    limits.add(value)
                case _:
                    return
        if len(subjects) != 1 or "" in subjects or "expression" in subjects:
            return
        first = turned[0]
        assert isinstance(first, Compare)
        bounds = self.bounds(first.left)
        if isinstance(bare(first.left).ctype, IntType) and bounds is not None:
            whole = {n for limit in limits if isfinite(limit) for n in (floor(limit), ceil(limit))}
            points = {float(p) for n in whole for p in (n - 1, n, n + 1) if bounds[0] <= p <= bounds[1]}
        else:
            ordered = sorted(limits)
            between = {(a + b) / 2 for a, b in pairwise(ordered)}
            far = abs(ordered[0]) + abs(ordered[-1]) + 1
            points = {-far, *ordered, *between, far}
        join = all if e.op == "and" else any
        outcomes = {join(COMPARE[op](p, value) for op, value in tests) for p in points}
        if len(outcomes) == 1:
            text = source_text(e)
            self.report_here("constant-condition", f"{text} is always {'true' if outcomes.pop() else 'false'}", text)

    # Expressions

    def constant_wrap(self, e: Expr) -> None:
        """Check a sum, difference or product of two constants.

        A cast of an unsigned one to its own type states that a wrap is intended.
        """
        match e:
            case Convert(ctype=ctype, operand=Binary(ctype=same) as meant, explicit=True) if ctype == same:
                self.meant.add(id(meant))
            case Binary(ctype=IntType(signed=False) as ctype, left=Const(value=int(a)), right=Const(value=int(b))):
                value = {"+": a + b, "*": a * b}.get(e.op, 0)
                if value > ctype.high and ctype.high not in (a, b) and id(e) not in self.meant:
                    text, wrapped = source_text(e), ctype.wrap(value)
                    message = f"{text} is {value}, which {ctype.bits} unsigned bits do not hold: it becomes {wrapped}"
                    self.report_here("unsigned-wrap", message, text, value)
            case Binary(ctype=IntType(signed=True) as ctype, left=Const(value=int(a)), right=Const(value=int(b))):
                value = {"+": a + b, "-": a - b, "*": a * b}.get(e.op, 0)
                if not ctype.low <= value <= ctype.high:
                    text, wrapped = source_text(e), ctype.wrap(value)
                    message = f"{text} is {value}, which does not fit a {ctype.bits}-bit {ctype}: it becomes {wrapped}"
                    self.report_here("overflow", message, text, value)

    def constant_shift(self, e: Expr) -> None:
        """Check a shift by a constant."""
        match e:
            case Binary(op="<<" | ">>", ctype=IntType(bits=bits), right=Const(value=int(n))) if not 0 <= n < bits:
                text = source_text(e)
                self.report_here("shift-range", f"{text} shifts a {bits}-bit value by {n}", text, n)

    def expression(self, e: Expr) -> None:
        self.constant_wrap(e)
        self.constant_shift(e)
        match e:
            case Logic():
                self.logic(e)
            case Compare(op=op, left=left, right=right):
                self.compare(e)
                self.signs(e)
                for side, other in ((left, right), (right, left)):
                    if op in ("==", "!=") and bare(side).ctype == UCHAR and _negative_source(other):
                        text = source_text(e)
                        message = f"{text}: an unsigned char is never negative; the constant counts as 65535"
                        self.report_here("sign-compare", message, text)
                zero = any(isinstance(side, Const) and side.value == 0 for side in (left, right))
                # `x != x` is the test for NaN.
                same = isinstance(bare(left), Load) and source_text(left) == source_text(right)
                if op in ("==", "!=") and isinstance(left.ctype, FloatType) and not zero and not same:
                    text = source_text(e)
                    self.report_here("float-equality", f"{text} compares floats for equality: rounding decides", text)
            case Call(arguments=arguments) | CallPointer(arguments=arguments):
                for argument in arguments:
                    self.given(argument)
                if isinstance(e, Call):
                    check_format(e, self.to.double, self.report_here)
                    check_blocks(e, self.report_here, self.locals.fixed)
            case Const():
                self.folded(e)
            case Convert(ctype=FloatType(), operand=Binary(op="/", right=Const(value=int(b))) as quotient):
                if b and isinstance(quotient.left, Const) and int(quotient.left.value) % b:
                    self.integer_division(quotient)
            case Binary(op="&" | "|" | "^", right=right) if _compared_mask(right):
                text = source_text(e)
                self.report_here("mixed-logic", f"{text}: the comparison comes first and gives 0 or 1", text)
            case Binary(op="&", left=left, right=right) if (
                (truth := _truth_of_mask(left, right) or _truth_of_mask(right, left)) is not None
            ):
                text = source_text(e)
                self.report_here("mixed-logic", f"{text} is always 0: {source_text(truth)} is 0 or 1", text)
            case Binary(op="&" | "|" | "^", left=left, right=right) if (
                mask := self.not_of_mask(left, right) or self.not_of_mask(right, left)
            ):
                text = f"!{source_text(mask)}"
                self.report_here("mixed-logic", f"{text} is 0: ~ inverts the bits of a mask", text)
            case Binary(op="&", left=left, right=right) if (count := _less_one(right) or _less_one(left)) is not None:
                text = source_text(e)
                lost = f"{source_text(count)} - 1 is {count.value - 1:#x}, a mask with gaps"
                message = f"{text}: {lost}, because {count.value} is no power of two: some remainders never occur"
                self.report_here("mask-gaps", message, text, count.value)
            case Binary(op="*" | "/", left=left, right=Const(value=8) as right) if _size(left) and not _size(right):
                text = source_text(e)
                self.report_here("octet", f"{text}: sizeof counts words of 16 bits here, not octets", text)

    def not_of_mask(self, e: Expr, other: Expr) -> Expr | None:
        """The constant of an operand `!MASK`, if it is a mask; None: there is none.

        0 and 1 may be truth values.  1 is a mask if the other operand is a word with flags in other bits.
        """
        for part in _chain(e):
            inner = part.source if isinstance(part, Const) and part.source is not None else part
            if isinstance(inner, Not):
                match bare(inner.operand), bare(other):
                    case Const(value=1) as mask, Load(lvalue=lvalue):
                        return mask if named_scalar(lvalue) in self.flag_words else None
                    case Const(value=value) as mask, _ if value not in (0, 1):
                        return mask
                return None
        return None

    def signs(self, e: Compare) -> None:
        """Report a signed value that may be negative and is compared as unsigned."""
        if e.op in ("==", "!="):
            return
        for side in (e.left, e.right):
            match side:
                case Convert(
                    ctype=IntType(signed=False) as to,
                    operand=Expr(ctype=IntType(signed=True)) as operand,
                    explicit=False,
                ) if interval(operand, self.ranges)[0] < 0 and negative(operand, self.locals.doubtful):
                    text = source_text(operand)
                    message = f"{text} may be negative and is compared as {to}: it then counts as large"
                    self.report_here("sign-compare", message, text)
                case Const(
                    ctype=IntType(signed=False) as to,
                    source=Convert(operand=Const(value=int(written)) as constant, explicit=False),
                ) if written < -1 and depends(e) and not _as_pattern(constant, to):
                    # -1 is all ones, the largest number, and may be meant.
                    text, number = source_text(e), source_text(constant)
                    message = f"{number} is compared as {to}: {side.value}, and no unsigned number is negative"
                    self.report_here("sign-compare", f"{text}: {message}", text, written)


def file_scope(variable: Variable, values: list[Any], report: StaticReport) -> None:
    """Check the initial values of a file-scope object."""
    checks = ConstantChecks(None, report, variable.declaration.where)
    for value in different(values):
        checks.given(value)
        if isinstance(value, Const):
            checks.folded(value)


def volatile(e: Expr | LValue) -> bool:
    """Whether `e` contains something declared `volatile`, or a register."""
    return any(
        isinstance(p, RegisterLoad)
        or (isinstance(p, LValue) and (p.volatile or (isinstance(p.root, Variable) and p.root.volatile)))
        for p in parts(e)
    )


def _is_fifo_level(e: Expr) -> bool:
    """Whether an expression is how much a FIFO of an SCI, SPI or I2C holds."""
    match e:
        case RegisterLoad(register=RegisterRef(field=Field(name=name)) | RegisterAt(field=Field(name=name))):
            return name in ("TXFFST", "RXFFST")
    return False


def _as_pattern(e: Const, to: IntType) -> bool:
    """Whether a constant is a bit pattern for its target (0xFFFE in an int, ~0x3C in an unsigned int), or -1."""
    if not isinstance(e.ctype, IntType):
        return False
    bits = e.ctype.bits <= to.bits
    return e.value == -1 or (bits and (not e.ctype.signed or (isinstance(e.source, Unary) and e.source.op == "~")))


def _no_common_bits(left: Expr, right: Expr) -> bool:
    """Whether a constant has a bit that the other operand has not: `(x & 0x10) == 0x20`."""
    for side, other in ((left, right), (right, left)):
        constant = bare(other)
        if isinstance(constant, Const) and isinstance(constant.value, int) and constant.value > 0:
            bits = _possible_bits(side)
            if bits is not None and constant.value & ~bits:
                return True
    return False


def _possible_bits(e: Expr) -> int | None:
    """The bits that a value masked by a constant may have; None: not known."""
    match e:
        case Convert(ctype=IntType(bits=bits), operand=operand) if (inner := _possible_bits(operand)) is not None:
            return inner if inner < 1 << bits - 1 else None
        case Binary(op="&", left=left, right=right):
            masks = [m.value for m in (bare(left), bare(right)) if isinstance(m, Const) and isinstance(m.value, int)]
            return masks[0] if masks and masks[0] >= 0 else None
        case Binary(op=">>", left=left, right=Const(value=int(by))) if by >= 0:
            inner = _possible_bits(left)
            return None if inner is None else inner >> by
    return None


def _assigned_in_both(branch: list[Stmt], other: list[Stmt]) -> set[int]:
    """Identities of the assignments in a branch whose targets the other branch assigns too."""
    targets = [s.target for s in other if isinstance(s, Assign)]
    return {id(s) for s in branch if isinstance(s, Assign) and s.target in targets}


def _compared_mask(e: Expr) -> bool:
    """Whether an operand is a comparison of a constant for equality: `MASK == MASK` in `x & MASK == MASK`."""
    match bare(e):
        case Compare(op="==" | "!=", left=left):
            return isinstance(bare(left), Const)
    return False


def _truth_of_mask(e: Expr, other: Expr) -> Expr | None:
    """A negation that is masked with bits of which it has none, as in `!flags & 0x20`; None: it is none."""
    truth, mask = bare(e), bare(other)
    if isinstance(truth, Not) and isinstance(mask, Const) and isinstance(mask.value, int):
        return truth if mask.value and not mask.value & 1 else None
    return None


def flag_words(functions: Iterable[Function]) -> set[NamedScalar]:
    """The integers in which a statement sets a single bit above bit 0: `flags |= 4`."""
    found: set[NamedScalar] = set()
    for function in functions:
        for s in statements(function.body):
            match s:
                case Assign(target=LValue(ctype=IntType()) as target, value=value) if (word := named_scalar(target)):
                    match bare(value):
                        case Binary(op="|", left=left, right=right):
                            match bare(left), bare(right):
                                case Load(lvalue=lvalue), Const(value=int(bit)) if lvalue == target:
                                    if bit > 1 and not bit & bit - 1:
                                        found.add(word)
    return found


def results_of(functions: Iterable[Function]) -> dict[str, Interval]:
    """The bounds of the results of functions that compute or test what they return; not of those that name a constant.

    A caller may ask for a constant that a function of this build does not return.
    """
    found: dict[str, Interval] = {}
    for function in functions:
        values = [s.value for s in statements(function.body) if isinstance(s, Return) and s.value is not None]
        if not values or function.ends or any(not _computed(value) for value in values):
            continue
        bounds = [interval(value, {}) for value in values]
        found[function.path] = min(low for low, _ in bounds), max(high for _, high in bounds)
    return found


def _computed(value: Expr) -> bool:
    """Whether a value is an integer that is a truth value, or masked by a constant."""
    if not isinstance(value.ctype, IntType):
        return False
    match bare(value):
        case Compare() | Logic() | Not():
            return True
        case Conditional(then=then, otherwise=otherwise):
            return {getattr(bare(then), "value", None), getattr(bare(otherwise), "value", None)} == {0, 1}
        case Binary(op="&", left=left, right=right):
            return any(isinstance(bare(side), Const) for side in (left, right))
    return False


def macro_masks(functions: Iterable[Function]) -> set[Where]:
    """The places of the macros whose constants are masks: `status & FAULT`."""
    found: set[Where] = set()
    for function in functions:
        for p in within(function.body):
            if isinstance(p, Binary) and p.op == "&":
                found |= {m.where.macro for m in map(bare, (p.left, p.right)) if isinstance(m, Const) and m.where.macro}
    return found


def _less_one(e: Expr) -> Const | None:
    """The N of a mask `N - 1` or `~(N - 1)`, if N is a constant and no power of two; None: there is none."""
    for part in _chain(e):
        match part:
            case Unary(op="~", operand=operand):
                return _less_one(operand)
            case Binary(op="-", left=left, right=Const(value=1)):
                count = bare(left)
                if isinstance(count, Const) and isinstance(count.value, int) and count.value > 2:
                    return count if count.value & count.value - 1 else None
    return None


def _negative_source(e: Expr) -> bool:
    return any(isinstance(c, Const) and c.value < 0 for c in _chain(e))


def _size(e: Expr) -> bool:
    return any(isinstance(c, Const) and c.text.startswith("sizeof") for c in _chain(e))


def _of_pointer(left: Expr, right: Expr) -> bool:
    """Whether a quotient divides the size of a pointer by the size of its target: `sizeof p / sizeof *p`."""
    whole = {c.measured for c in _chain(left) if isinstance(c, Const) and isinstance(c.measured, PointerType)}
    return any(isinstance(c, Const) and c.measured == p.target for c in _chain(right) for p in whole)


def _chain(e: Expr | None) -> Iterator[Expr]:
    """A constant, and the expressions that it was folded from."""
    while e is not None:
        yield e
        e = e.source if isinstance(e, Const) else (e.operand if isinstance(e, Convert) else None)


def _lossy_division(e: Const) -> Binary | None:
    """The integer division with a remainder from which a constant was folded; None: there is none."""
    waiting = [e]
    while waiting:
        for step in _chain(waiting.pop()):
            match step:
                case Binary(op="/", ctype=IntType(), left=Const(value=int(a)), right=Const(value=int(b))) if (
                    b and a % b
                ):
                    return step
                case Binary(left=Const() as left, right=Const() as right):
                    waiting += [right, left]
                    break
    return None


def maybe_negative(function: Function) -> set[Variable]:
    """The locals to which a statement may assign a negative value.  (Results of calls, and arguments, are trusted.)"""
    doubtful = {v for v in function.locals if v.in_memory}
    locals_ = set(function.locals) | set(function.parameters)
    while True:
        found = set(doubtful)
        for s in statements(function.body):
            match s:
                case Assign(target=LValue(root=Variable() as root), value=value) if root in locals_:
                    if negative(value, doubtful):
                        found.add(root)
                case Declare(variable=variable, value=Expr() as value) if negative(value, doubtful):
                    found.add(variable)
                case For(variable=LValue(root=Variable() as root), start=start, step=step):
                    if step < 0 or negative(start, doubtful):
                        found.add(root)
        if found == doubtful:
            return locals_ & doubtful
        doubtful = found


def fixed_locals(function: Function) -> dict[Variable, Const]:
    """The locals to which one statement gives a constant, and no other statement anything."""
    given: dict[Variable, list[Expr | None]] = {}
    for s in statements(function.body):
        match s:
            case Assign(target=LValue(root=Variable(kind="local", in_memory=False) as variable), value=value):
                given.setdefault(variable, []).append(value)
            case Declare(variable=variable, value=Expr() as value) if not variable.in_memory:
                given.setdefault(variable, []).append(value)
            case For(counter=variable):
                given.setdefault(variable, []).append(None)
    single = {variable: bare(v[0]) for variable, v in given.items() if len(v) == 1 and v[0] is not None}
    return {variable: value for variable, value in single.items() if isinstance(value, Const)}


def negative(e: Expr, doubtful: set[Variable]) -> bool:
    """Whether the source shows that `e` may be negative: a minus, a negative constant, or a local that has one."""
    match e:
        case Const(value=value):
            return value < 0
        case Load(lvalue=LValue(root=Variable() as root)):
            return root in doubtful
        case Unary(op="-"):
            return True
        case Binary(op="-", ctype=IntType(signed=True)):
            return True
        case Binary(op="&" | "%" | ">>"):
            return False
        case Call() | CallPointer() | RegisterLoad() | Compare() | Logic() | Not():
            return False
        case Convert(operand=operand):
            return isinstance(e.ctype, IntType) and e.ctype.signed and negative(operand, doubtful)
        case Binary(left=left, right=right):
            return negative(left, doubtful) or negative(right, doubtful)
    return False


def depends(e: Expr) -> bool:
    """Whether an expression contains a load, a register or a call, not only constants."""
    return any(isinstance(p, Load | RegisterLoad | Call | CallPointer) for p in parts(e))
