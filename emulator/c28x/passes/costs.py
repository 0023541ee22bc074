"""Pass `costs`: what the operations of the tree cost in CPU cycles.

Magnitudes are those of unoptimised C28x code with FPU32 (load 1-2, float add or multiply 2 plus a delay slot,
division a library call, a peripheral access two wait states, call and return with their saves).  CHOICE: one factor a
function, given with the firmware, brings whole tasks to the times measured on the robot (TFG figures 37 and 39).
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.tree import (
    AddressOf,
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
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    Logic,
    LValue,
    Not,
    PointerAdd,
    PointerDifference,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Unary,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import INSTRUCTIONS, children, statements, whole_target

LOAD: Final = 1
LOAD_MEMORY: Final = 2
STORE: Final = 2
INDEX: Final = 4
POINTER: Final = 3
REGISTER: Final = 4
REGISTER_FIELD: Final = 3
INT_OP: Final = 1
INT_MUL: Final = 3
INT_DIV: Final = 32
FLOAT_OP: Final = 4
FLOAT_DIV: Final = 60
CONVERT: Final = 4
COMPARE: Final = 3
BRANCH: Final = 4
CALL: Final = 16
LOOP: Final = 4
#: What a turn of a counting loop costs besides its body.
TURN: Final = LOOP + COMPARE + INT_OP

#: Operators of the tree -> cycles, for ints (of 16 bits) and floats.
INT: Final = {
    "+": INT_OP, "-": INT_OP, "*": INT_MUL, "/": INT_DIV, "%": INT_DIV, "<<": 2, ">>": 2, "&": 1, "|": 1, "^": 1,
}  # fmt: skip
FLOAT: Final = {"+": FLOAT_OP, "-": FLOAT_OP, "*": FLOAT_OP, "/": FLOAT_DIV}


def leave_costs(function: Function) -> None:
    """Leave on every statement what its own expressions cost; of a loop, one look at its test."""
    for s in statements(function.body):
        s.cycles = _statement(s)


def _statement(s: Stmt) -> int:
    match s:
        case Assign(target=RegisterRef() | RegisterAt() as target, value=value):
            field = 0 if target.field is None else REGISTER + REGISTER_FIELD
            block = POINTER + cycles(target.block) if isinstance(target, RegisterAt) else 0
            return REGISTER + field + block + cycles(value)
        case Assign(target=LValue() as target, value=value):
            return cycles(value) + STORE + way(target) + (REGISTER_FIELD if target.bits else 0)
        case CopyStruct(target=target, source=source):
            return _address(target) + _address(source) + STORE * target.ctype.words
        case Declare(value=list() as values):
            return STORE * len(values) + sum(0 if isinstance(value, Const) else cycles(value) for value in values)
        case Declare(value=Expr() as value):
            return cycles(value) + STORE
        case Evaluate(value=Call(function=function)) if function.extern and function.name in INSTRUCTIONS:
            return 1
        case Evaluate(value=value) | Return(value=Expr() as value):
            return cycles(value)
        case If(test=test):
            return condition(test) + BRANCH
        case While(test=test):
            return condition(test) + LOOP
        case For(test=None, start=start, stop=stop):
            return cycles(start) + cycles(stop)
        case For(test=Compare() as test):
            return condition(test) + LOOP
        case Switch(subject=Const(), cases=[(None, _)]):
            return 0  # nothing is chosen
        case Switch(subject=subject, cases=cases):
            return cycles(subject) + BRANCH * max(1, len(cases))
    return 0


def cycles(e: Any) -> int:
    """What the value of an expression costs."""
    match e:
        case Load(lvalue=lvalue):
            plain = isinstance(lvalue.root, Variable) and lvalue.root.plain
            return (LOAD if plain else LOAD_MEMORY) + way(lvalue) + (REGISTER_FIELD if lvalue.bits else 0)
        case RegisterLoad(register=register):
            block = POINTER + cycles(register.block) if isinstance(register, RegisterAt) else 0
            return block + REGISTER + (REGISTER_FIELD if register.field is not None else 0)
        case AddressOf(lvalue=lvalue):
            return _address(lvalue)
        case Compare() | Logic() | Not():
            return condition(e)
        case Conditional(test=test, then=then, otherwise=otherwise):
            return BRANCH + condition(test) + cycles(then) + cycles(otherwise)
        case Convert(operand=operand):
            floats = isinstance(e.ctype, FloatType), isinstance(operand.ctype, FloatType)
            between = isinstance(e.ctype, IntType | FloatType) and floats[0] != floats[1]
            return cycles(operand) + (CONVERT if between else 0)
        case Binary(ctype=FloatType(), op=op, left=left, right=right):
            return FLOAT[op] + cycles(left) + cycles(right)
        case Binary(ctype=IntType(words=words), op=op, left=left, right=right):
            return INT[op] * words + cycles(left) + cycles(right)
        case Unary(operand=operand):
            return (FLOAT_OP if isinstance(e.ctype, FloatType) else INT_OP) + cycles(operand)
        case PointerAdd(pointer=pointer, index=index):
            return POINTER + cycles(pointer) + cycles(index)
        case PointerDifference(left=left, right=right):
            return INT_DIV + cycles(left) + cycles(right)
        case Call() | CallPointer():
            return CALL + sum(map(cycles, children(e)))
    return 0


def condition(e: Expr) -> int:
    """What it costs to branch on an expression."""
    match e:
        case Compare(left=left, right=right):
            return COMPARE + cycles(left) + cycles(right)
        case Logic(operands=operands):
            return sum(map(condition, operands))
        case Not(operand=operand):
            return condition(operand)
    return COMPARE + cycles(e)


def way(lvalue: LValue) -> int:
    """What it costs to come to an object: its subscripts, its pointer."""
    indices = sum(cycles(index.expr) for index in lvalue.indices)
    if isinstance(lvalue.root, Variable):
        return INDEX * len(lvalue.indices) + indices
    return POINTER + cycles(lvalue.root) + indices


def _address(lvalue: LValue) -> int:
    root = lvalue.root
    if isinstance(root, Variable):
        return POINTER + sum(cycles(index.expr) for index in lvalue.indices)
    return POINTER + cycles(root) + (0 if whole_target(lvalue) else sum(cycles(i.expr) for i in lvalue.indices))
