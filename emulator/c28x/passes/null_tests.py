"""Static check of tests for NULL that come too late: the pointer was dereferenced before.

One forward walk carries the plain pointers that every path has dereferenced and not changed since.  A library function
that reads a text or a block dereferences its arguments.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.ctypes import PointerType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import (
    AddressOf,
    Break,
    Call,
    Compare,
    Conditional,
    Continue,
    Expr,
    For,
    Function,
    If,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Not,
    Null,
    RegisterAt,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, assigned_variables, bare, children, roots

Used = frozenset[Variable]
#: Library functions that dereference all their pointer arguments.
_THROUGH: Final = frozenset({
    "memcpy", "memmove", "memset", "memcmp", "strlen", "strcmp", "strncmp", "strcpy", "strncpy", "strcat", "strncat",
    "strchr", "strrchr", "strstr", "atoi", "atol", "atof",
})  # fmt: skip


class NullTests:
    """The forward walk over one function."""

    def __init__(self, function: Function, report: StaticReport) -> None:
        self.function = function
        self.to = report

    def run(self) -> None:
        """Report the tests that come too late."""
        self.block(self.function.body, frozenset())

    def block(self, body: list[Stmt], used: Used) -> Used | None:
        """The pointers dereferenced at the end of a block; None: its end is not reached."""
        for s in body:
            after = self.statement(s, used)
            if after is None:
                return None
            used = after
        return used

    def statement(self, s: Stmt, used: Used) -> Used | None:
        match s:
            case If(test=test, then=then, otherwise=otherwise):
                used = self.condition(test, used)
                return _meet(self.block(then, used), self.block(otherwise, used))
            case While(test=test, body=body, step=step, first=first):
                head = used - assigned_variables([s])
                used = self.condition(test, head) if first else head
                self.block([*body, *step], used)
                if not first:
                    self.condition(test, head)
                return used
            case For(start=start, stop=stop, body=body):
                head = self.value(stop, self.value(start, used)) - assigned_variables([s])
                self.block(body, head)
                return head
            case Switch(subject=subject, cases=cases):
                head = self.value(subject, used) - assigned_variables([s])
                for _, body in cases:
                    self.block(body, head)
                return head
            case Return() | Break() | Continue() | LeaveSwitch():
                return None
        for root in roots(s):
            used = self.value(root, used)
        written = assigned(s)
        return used if written is None else used - {written}

    def condition(self, e: Expr, used: Used) -> Used:
        """The pointers dereferenced after a controlling expression; reports late tests in it."""
        match e:
            case Logic(operands=operands):
                used = self.condition(operands[0], used)
                after = used
                for operand in operands[1:]:  # later operands may not be reached
                    after = self.condition(operand, after)
                return used
            case Not(operand=operand):
                return self.condition(operand, used)
            case Compare(op=op, left=left, right=right):
                for side, other in ((left, right), (right, left)):
                    if op in ("==", "!=") and isinstance(bare(other), Null):
                        self.tested(side, e, used)
                return self.value(right, self.value(left, used))
        self.tested(e, e, used)
        return self.value(e, used)

    def tested(self, e: Expr, test: Expr, used: Used) -> None:
        """Report a test of a dereferenced pointer for NULL."""
        match bare(e):
            case Load(ctype=PointerType(), lvalue=LValue(root=Variable() as root, indices=[])) if root in used:
                if test.where.macro is None and e.where.macro is None:
                    name = root.declaration.name
                    message = f"{name} is compared with NULL after it was dereferenced: the test is too late"
                    where = test.where if test.where.line else self.function.where
                    self.to.report(
                        self.function, where, "constant-condition", message, declaration=root.declaration
                    )  # fmt: skip

    def value(self, e: Any, used: Used) -> Used:
        """The pointers dereferenced after an expression."""
        match e:
            case Logic() | Not() | Compare():
                return self.condition(e, used)
            case Conditional(test=test, then=then, otherwise=otherwise):
                used = self.condition(test, used)
                self.value(then, used)
                self.value(otherwise, used)
                return used
            case AddressOf(lvalue=LValue(root=root)) if not isinstance(root, Variable):
                return self.value(root, used)
        for inner in children(e):
            used = self.value(inner, used)
        match e:
            case LValue(root=Expr() as pointer) | RegisterAt(block=pointer):
                return used | _pointer(pointer)
            case Call(function=function, arguments=arguments) if function.extern and function.name in _THROUGH:
                return used.union(*map(_pointer, arguments))
        return used


def _pointer(e: Expr) -> Used:
    """The plain pointer whose value an expression is, as a set; empty: none."""
    match bare(e):
        case Load(ctype=PointerType(), lvalue=LValue(root=Variable() as root, indices=[])) if root.plain:
            return frozenset({root})
    return frozenset()


def _meet(one: Used | None, other: Used | None) -> Used | None:
    """The pointers that both of two paths have dereferenced."""
    if one is None or other is None:
        return other if one is None else one
    return one & other
