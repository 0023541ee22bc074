"""Static check of products that overflow before their quotient reaches what it is compared with: `overflow`.

    static int32 Rope_um(void) { return Counts * 7500 / 2000; }
    ...
    if (Rope_um() >= 12000000) Stop();

A quotient of 32 bits by 2000 is never above 1073741, so the comparison never holds: the product overflows long before.
The check follows the quotient through results of functions and through scalars that get nothing else.
"""

from __future__ import annotations

from typing import NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.given import GivenValues
from emulator.c28x.passes.intervals import combine, interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Call, Compare, Convert, Expr, Function, Load, Stmt, Variable
from emulator.c28x.tree_queries import bare, named_scalar, own_nodes, source_text, statements

#: Through how many objects and functions a quotient is followed.
_DEEPEST = 3


class _Quotient(NamedTuple):
    """A product that may overflow, divided by a constant: its largest value, and what it is without an overflow."""

    product: Binary
    most: int
    meant: tuple[int, int]


def check_quotients(reports: dict[Module, StaticReport], given: GivenValues) -> None:
    """Report the products that overflow before a comparison of their quotient can hold."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    quotients = _Quotients(list(owners), given)
    told: set[int] = set()
    for function in owners:
        for s in statements(function.body):
            for p in own_nodes(s):
                if not isinstance(p, Compare) or p.op in ("==", "!="):
                    continue
                for side, other in ((p.left, p.right), (p.right, p.left)):
                    found, limit = quotients.of(side, 0), constant_of(other)
                    if found is None or limit is None or abs(limit) <= found.most or id(found.product) in told:
                        continue
                    if found.meant[0] <= limit <= found.meant[1]:
                        told.add(id(found.product))
                        at, by = quotients.places[id(found.product)]
                        message = (
                            f"{source_text(found.product)} overflows before its quotient is above {found.most}, and "
                            f"line {s.line} compares that with {limit}"
                        )
                        owners[at].report(at, by.where, "overflow", message, object=source_text(found.product))


class _Quotients:
    """The quotients of products that scalars and functions of a program have."""

    def __init__(self, functions: list[Function], given: GivenValues) -> None:
        self._given = given
        #: Whether nothing but these functions gives values to objects and parameters.
        self._whole = any(function.name == "main" and function.body for function in functions)
        #: Identity of a product -> its function and its statement.
        self.places: dict[int, tuple[Function, Stmt]] = {
            id(p): (function, s) for function in functions for s in statements(function.body)
            for p in own_nodes(s) if isinstance(p, Binary) and p.op == "*"
        }  # fmt: skip

    def of(self, e: Expr, depth: int) -> _Quotient | None:
        """The quotient that a value is; None: it is none, or may be something else too."""
        if not isinstance(e.ctype, IntType) or depth > _DEEPEST:
            return None
        match e:
            case Convert(operand=Expr(ctype=IntType()) as operand):
                return self.of(operand, depth)
            case Binary(op="/", ctype=IntType(high=high), left=left, right=right):
                product, divisor = bare(left), constant_of(right)
                if isinstance(product, Binary) and product.op == "*" and divisor is not None and divisor > 1:
                    assert isinstance(product.ctype, IntType)
                    meant = combine("*", interval(product.left, {}), interval(product.right, {}))
                    scaled = constant_of(product.left) is not None or constant_of(product.right) is not None
                    if scaled and meant is not None and meant[1] > product.ctype.high and product.ctype == e.ctype:
                        return _Quotient(product, high // divisor, (-(-meant[0] // divisor), meant[1] // divisor))
            case Load(lvalue=lvalue) if (scalar := named_scalar(lvalue)) is not None:
                known = self._whole or (isinstance(scalar[0], Variable) and scalar[0].kind == "local")
                given = self._given.of(scalar) if known else []
                return self.of(given[0].value, depth + 1) if len(given) == 1 and given[0].value is not None else None
            case Call(function=function):
                given = self._given.results.get(function.path, [])
                return self.of(given[0].value, depth + 1) if len(given) == 1 and given[0].value is not None else None
        return None
