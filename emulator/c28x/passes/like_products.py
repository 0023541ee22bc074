"""Static check of products of 16 bits beside others that are widened first: `widened-late`.

    square = (long)mg[0] * mg[0] + (long)mg[1] * mg[1] + mg[2] * mg[2];     /* the last one wraps beyond 181 */

Who casts one product of a sum says that such a product does not fit 16 bits.  The other one must be like it: the square
of another element of the same array, of another member or object with a name that differs in one letter (`x`, `y`), a
product of elements of the same two arrays, or the same members crosswise (`a.x * b.y - a.y * b.x`).

Silent if the function compares what is multiplied by order, or gives it only values whose product fits, and about
elements of tables, which may be small numbers.
"""

from __future__ import annotations

from collections.abc import Iterator

from emulator.c28x.ctypes import INT, CType, FloatType, IntType
from emulator.c28x.passes.intervals import interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import (
    Binary,
    Compare,
    Const,
    Convert,
    Expr,
    Function,
    Load,
    LValue,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    bare,
    fixed_words,
    given_values,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
)  # fmt: skip


def check_like_products(function: Function, report: StaticReport) -> None:
    """Report the products of 16 bits in sums of which a product of the same form is widened before."""
    for s in statements(function.body):
        inner = {id(e) for p in own_nodes(s) if _is_sum(p) for e in (bare(p.left), bare(p.right))}
        for whole in own_nodes(s):
            if not _is_sum(whole) or id(whole) in inner:
                continue
            terms = list(_terms(whole))
            for narrow in filter(None, map(_narrow, terms)):
                wide = next((one for one in terms if _is_widened(one) and _alike(narrow, bare(one))), None)
                if wide is not None and not _fits(function, narrow):
                    text = source_text(narrow)
                    message = (
                        f"{text} is computed in 16 bits before it is widened, and {source_text(wide)} of the same sum "
                        "is not: it wraps"
                    )
                    report.report(function, s.where, "widened-late", message, object=text)


def _is_sum(e: object) -> bool:
    return isinstance(e, Binary) and e.op in ("+", "-") and _is_wide(e.ctype)


def _is_wide(ctype: CType) -> bool:
    return isinstance(ctype, FloatType) or (isinstance(ctype, IntType) and ctype.bits > INT.bits)


def _terms(e: Expr) -> Iterator[Expr]:
    """The terms of a sum, with their conversions."""
    inner = bare(e)
    if isinstance(inner, Binary) and inner.op in ("+", "-") and _is_wide(inner.ctype):
        yield from _terms(inner.left)
        yield from _terms(inner.right)
    else:
        yield e


def _narrow(term: Expr) -> Binary | None:
    """The product of 16 bits that a term of a wide sum is."""
    match term:
        case Convert(operand=Binary(op="*", ctype=IntType(bits=INT.bits)) as product) if _is_wide(term.ctype):
            return product if _factors(product) is not None else None
    return None


def _is_widened(term: Expr) -> bool:
    """Whether a term is a product of numbers of 16 bits of which one is cast to a wider type."""
    match bare(term):
        case Binary(op="*", left=left, right=right) as product if _is_wide(product.ctype):
            cast = any(isinstance(e, Convert) and e.explicit and _is_wide(e.ctype) for e in (left, right))
            return cast and _factors(product) is not None
    return False


def _factors(product: Expr) -> tuple[LValue, LValue] | None:
    """The two objects of an `int` or an `unsigned int` that a product multiplies."""
    match product:
        case Binary(op="*", left=left, right=right):
            match bare(left), bare(right):
                case Load(lvalue=a), Load(lvalue=b) if _is_int(a) and _is_int(b):
                    return a, b
    return None


def _is_int(lvalue: LValue) -> bool:
    """Whether an object is an `int` of 16 bits.  A `char` is taken for a small number, and so is a bit-field."""
    ctype = lvalue.ctype
    return isinstance(ctype, IntType) and (ctype.bits, ctype.rank) == (INT.bits, INT.rank) and lvalue.bits is None


def _alike(narrow: Expr, wide: Expr) -> bool:
    """Whether two products have the same form."""
    ours, others = _factors(narrow), _factors(wide)
    if ours is None or others is None:
        return False
    (a, b), (c, d) = ours, others
    if a == b:
        return c == d and (_of_one_array(a, c) or _named_alike(a, c))
    for e, f in ((c, d), (d, c)):
        if _of_one_array(a, e) and _of_one_array(b, f) and not _is_table(a) and not _is_table(b):
            return True
        if a.root == e.root and b.root == f.root and a.ctype == e.ctype and b.ctype == f.ctype:
            at = [fixed_words(one) for one in (a, b, e, f)]
            if None not in at and at[0] != at[1] and (at[0], at[1]) == (at[3], at[2]) and a.root != b.root:
                return True
    return False


def _of_one_array(a: LValue, b: LValue) -> bool:
    """Whether two objects are elements of the same array."""
    same = a.root == b.root and a.ctype == b.ctype and a.words == b.words
    return same and bool(a.indices) and len(a.indices) == len(b.indices)


def _is_table(element: LValue) -> bool:
    """Whether an array is one of constants, as the coefficients of a filter, or may be one."""
    root = element.root
    if not isinstance(root, Variable):
        return True
    return root.constant or root.initialised or any(not isinstance(e, Const) or e.value for e in root.initial or ())


def _named_alike(a: LValue, b: LValue) -> bool:
    """Whether two members of an object, or two objects, have the same type and names that differ in one letter."""
    if a.indices or b.indices or a.ctype != b.ctype or len(a.text) != len(b.text):
        return False
    return sum(x != y for x, y in zip(a.text, b.text, strict=True)) == 1


def _fits(function: Function, product: Binary) -> bool:
    """Whether a product may be known to fit: from its types, the values of its factors, or a test of them."""
    factors = _factors(product)
    assert isinstance(product.ctype, IntType)
    if factors is None or _product_fits(product.ctype, product.left, product.right):
        return True
    for p in within(function.body):
        if isinstance(p, Compare) and p.op not in ("==", "!="):
            for side, other in ((p.left, p.right), (p.right, p.left)):
                limit, inside = bare(other), parts(side)
                if isinstance(limit, Const) and limit.value == 0:
                    continue
                if any(isinstance(q, Binary) and q.op == "*" for q in inside):
                    continue  # the sum itself, or another
                if any(isinstance(q, LValue) and q.root == one.root for q in inside for one in factors):
                    return True
    values = [
        value for target, value in given_values(function.body) if any(target.root == one.root for one in factors)
    ]  # fmt: skip
    return bool(values) and all(_product_fits(product.ctype, value, value) for value in values)


def _product_fits(ctype: IntType, a: Expr, b: Expr) -> bool:
    if not isinstance(a.ctype, IntType) or not isinstance(b.ctype, IntType):
        return False
    ends = [x * y for x in a.bounds or interval(a, {}) for y in b.bounds or interval(b, {})]
    return ctype.low <= min(ends) and max(ends) <= ctype.high
