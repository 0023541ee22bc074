"""What the typed tree says of values: constants, equal conditions, locals that never change or are never negative."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from emulator.c28x.arithmetic import divide_int, modulo_int
from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.intervals import RING
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Const,
    Convert,
    Declare,
    Expr,
    For,
    Function,
    Load,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    Unary,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned_variables, parts, statements

COMPARE: Final[dict[str, Callable[[Any, Any], bool]]] = {
    "<": lambda a, b: a < b, ">": lambda a, b: a > b, "<=": lambda a, b: a <= b, ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b, "!=": lambda a, b: a != b,
}  # fmt: skip


def evaluate(e: Expr | None, known: Mapping[Variable, int]) -> int | None:
    """The integer that an expression is, with what is known of locals; None if that is not enough."""
    match e:
        case Const(value=int(value)):
            return value
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if not root.in_memory:
            return known.get(root)
        case Convert(ctype=IntType() as ctype, operand=Expr(ctype=IntType()) as operand):
            inner = evaluate(operand, known)
            return None if inner is None else ctype.wrap(inner)
        case Not(operand=operand):
            inner = evaluate(operand, known)
            return None if inner is None else int(not inner)
        case Logic(op=op, operands=operands):
            values = [evaluate(o, known) for o in operands]
            decided = [v for v in values if v is not None and bool(v) == (op == "or")]
            if decided:
                return int(op == "or")
            return None if None in values else int(op == "and")
        case Compare(op=op, left=left, right=right):
            a, b = evaluate(left, known), evaluate(right, known)
            return None if a is None or b is None else int(COMPARE[op](a, b))
        case Binary(ctype=IntType() as ctype, op=op, left=left, right=right) if op in RING or op in "/%":
            a, b = evaluate(left, known), evaluate(right, known)
            if a is None or b is None or (op in "/%" and b == 0):
                return None
            results = {"+": a + b, "-": a - b, "*": a * b}
            if op in "/%":
                return divide_int(a, b) if op == "/" else modulo_int(a, b)
            return ctype.wrap(results[op])
    return None


def fingerprint(e: Expr) -> str:
    """A text that is equal for equal conditions of plain locals and constants, names set apart by blanks; else ""."""
    match e:
        case Const(value=value):
            return f" {value!r} "
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if not root.in_memory and root.kind != "global":
            return f" {root.name} "
        case Convert(ctype=ctype, operand=operand):
            inner = fingerprint(operand)
            return f"<{ctype}>{inner}" if inner and isinstance(ctype, FloatType) else inner
        case Compare(op=op, left=left, right=right) | Binary(op=op, left=left, right=right):
            a, b = fingerprint(left), fingerprint(right)
            return f"({a}{op}{b})" if a and b else ""
    return ""


def constant_locals(function: Function) -> dict[Variable, tuple[int, int]]:
    """Locals that have one constant value from their declaration on."""
    values: dict[Variable, tuple[int, int]] = {}
    changed = assigned_variables([s for s in statements(function.body) if not isinstance(s, Declare)])
    for s in function.body:
        match s:
            case Declare(variable=variable, value=Const(value=int(value))) if (
                not variable.in_memory and variable not in changed
            ):
                values[variable] = (value, value)
    return values


def maybe_negative(function: Function) -> set[Variable]:
    """Signed locals that a statement of the function may give a negative value (calls and parameters are trusted)."""
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
    """Whether an expression is made of anything but constants."""
    return any(isinstance(p, Load | RegisterLoad | Call | CallPointer) for p in parts(e))
