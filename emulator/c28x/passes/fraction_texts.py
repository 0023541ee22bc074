"""Static check of numbers that are printed in two parts, before and behind the point: `fraction-text`.

    sprintf(text, "%ld.%ld g", mg / 1000L, mg % 1000L);             /* 1005 mg: 1.5 g */
    sprintf(text, "%d.%02d V", cv / 100, abs(cv % 100));            /* -50 cV: 0.50 V */

The part behind the point needs as many digits as the divisor has zeros.  And the part before it has no sign where it is
0.

A version or a date is written without zeros: so the number must be computed, have a sign or a unit.  Not reported: a
number that goes in steps of which each has all digits (0, 25, 50, 75).
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Final, NamedTuple

from emulator.c28x.passes.formats import SPECIFICATION, format_of, printed
from emulator.c28x.passes.given import GivenValue, GivenValues
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Call, Compare, Conditional, Expr, Function, Load, Unary, Variable
from emulator.c28x.tree_queries import bare, named_scalar, own_nodes, source_text, statements

#: What follows a number with a unit.
_UNIT: Final = re.compile(
    r"\s?(%%|\N{DEGREE SIGN}|deg|([munkM]?(s|V|A|W|Hz|g|m|Pa|N|J|K|l|bar|Ah|Wh)|C|F|rpm)(?![A-Za-z]))"
)
_VERSION: Final = re.compile(r"(?i)\b(v|ver|vers|rev|fw|hw|sw)\W*$|version|revision")
#: Through how many objects a number is followed.
_DEEPEST: Final = 4


class _Part(NamedTuple):
    """A part of a number before the point (`digits`: what the divisor has zeros) or behind it (digits in it)."""

    number: Expr
    digits: int
    zeros: int
    #: Only its magnitude is printed.
    magnitude: bool


def check_fraction_texts(reports: dict[Module, StaticReport], given: GivenValues) -> None:
    """Report the numbers that a format shows with a wrong fraction, or without their sign."""
    for module, report in reports.items():
        for function in module.functions:
            for s in statements(function.body):
                for e in own_nodes(s):
                    if isinstance(e, Call) and (message := _wrong(e, given)) is not None:
                        report.report(function, s.where, "fraction-text", message, object=format_of(e) or "")


def _wrong(e: Call, given: GivenValues) -> str | None:
    """What is wrong with the numbers that a call prints; None: nothing."""
    form = format_of(e) or ""
    for (one, before, after), (other, between, behind) in pairwise(printed(e)):
        first, second = form[len(before) : len(form) - len(after)], form[len(between) : len(form) - len(behind)]
        point, padded = form[len(form) - len(after) : len(between)], _padded(second)
        whole, rest = _part(one, given), _part(other, given, behind=True)
        if point != "." or whole is None or rest is None or padded is None or first[-1] not in "diu":
            continue
        if whole.number != rest.number or whole.zeros != rest.zeros:
            continue
        if before.endswith(".") or behind.startswith(".") or _VERSION.search(before):
            continue
        text = source_text(whole.number)
        if rest.magnitude and not whole.magnitude and first[-1] != "u" and not before.endswith(("%c", "%s", "-")):
            return f"between -1 and 0 the part before the point is 0, so {text} is shown without its sign"
        if padded == rest.digits or max(padded, rest.digits) < 2 or _in_steps(whole.number, given, rest):
            continue
        if whole.magnitude or rest.magnitude or _UNIT.match(behind) or _computed(whole.number, given):
            right, shown = "5".rjust(rest.digits, "0"), "5".rjust(padded, "0")
            return f"{source_text(other)} has {rest.digits} digits: {second} shows 1.{right} of {text} as 1.{shown}"
    return None


def _padded(conversion: str) -> int | None:
    """The digits that a conversion of an integer shows at least; None: it is another one, or an argument says it."""
    found = SPECIFICATION.fullmatch(conversion)
    if found is None or found["kind"] not in "diu" or "*" in (found["width"], found["precision"]):
        return None
    if found["precision"]:
        return int(found["precision"])
    flags = conversion[1 : found.start("width")]
    return int(found["width"] or 1) if "0" in flags and "-" not in flags else 1


def _part(e: Expr, given: GivenValues, *, behind: bool = False) -> _Part | None:
    """The part of a number that an argument is; None: it is none."""
    e, magnitude = _magnitude(_value(e, given))
    cut = 0
    match e:
        case Binary(op="/", left=left, right=right) if behind and (cut := _zeros(right)):
            e, own = _magnitude(_value(left, given))
            magnitude |= own
    match e:
        case Binary(op="/" | "%" as op, left=left, right=right) if (op == "%") == behind and (zeros := _zeros(right)):
            number, own = _magnitude(left)
            return _Part(number, zeros - cut, zeros, magnitude or own)
    return None


def _zeros(e: Expr) -> int:
    """The zeros of a power of ten; 0: it is none."""
    digits = str(constant_of(e))
    return len(digits) - 1 if digits.strip("0") == "1" else 0


def _value(e: Expr, given: GivenValues) -> Expr:
    """The only value of a local that has one, without conversions; else the expression itself."""
    inner = bare(e)
    if isinstance(inner, Load) and isinstance(root := inner.lvalue.root, Variable) and root.plain:
        values = given.of((root, 0)) if root.kind == "local" and not inner.lvalue.indices else []
        if len(values) == 1 and (value := values[0].value) is not None:
            only, _ = _magnitude(value)
            return bare(value) if isinstance(only, Binary) and only.op in ("/", "%") else inner
    return inner


def _magnitude(e: Expr) -> tuple[Expr, bool]:
    """The number whose magnitude an expression takes, and that it does; or the expression."""
    match bare(e):
        case Call(function=Function(name="abs" | "labs"), arguments=[operand]):
            return bare(operand), True
        case Conditional(test=Compare(), then=then, otherwise=otherwise):
            for side, other in ((bare(then), bare(otherwise)), (bare(otherwise), bare(then))):
                if isinstance(side, Unary) and side.op == "-" and bare(side.operand) == other:
                    return other, True
    return bare(e), False


def _computed(number: Expr, given: GivenValues, depth: int = 0) -> bool:
    """Whether a number is a sum, a difference or a product, or its sign is taken off."""
    inner, magnitude = _magnitude(number)
    match inner:
        case Unary(op="-"):
            return True
        case Binary(op="+", left=left, right=right):
            joined = any(isinstance(side, Binary) and side.op == "*" for side in (bare(left), bare(right)))
            return not joined and constant_of(left) != 1 and constant_of(right) != 1
        case Binary(op="-" | "*"):
            return True
        case Binary(op="/" | ">>", left=left):
            return _computed(left, given, depth)
        case Call(function=Function(path=path)) if depth < _DEEPEST:
            results = given.results.get(path, ())
            return magnitude or any(v.value is not None and _computed(v.value, given, depth + 1) for v in results)
        case Load(lvalue=lvalue) if depth < _DEEPEST and (scalar := named_scalar(lvalue)) is not None:
            values = given.of(scalar)
            return magnitude or any(v.value is not None and _computed(v.value, given, depth + 1) for v in values)
    return magnitude


def _in_steps(number: Expr, given: GivenValues, rest: _Part) -> bool:
    """Whether a number is a multiple of one whose multiples have all digits behind the point."""
    products = [number, *(one.value for one in _given(number, given) if one.value is not None)]
    for product in map(bare, products):
        if isinstance(product, Binary) and product.op == "*":
            step = constant_of(product.right) or constant_of(product.left)
            cut = 10 ** (rest.zeros - rest.digits)
            shown = {step * k % 10**rest.zeros // cut for k in range(10**rest.digits)} if step else {1}
            if all(one == 0 or one >= 10 ** (rest.digits - 1) for one in shown):
                return True
    return False


def _given(number: Expr, given: GivenValues) -> list[GivenValue]:
    scalar = named_scalar(number.lvalue) if isinstance(number, Load) else None
    return given.of(scalar) if scalar is not None else []
