"""Pass `costs`: the CPU cycles of the operations in the tree.

The costs are in the order of magnitude of unoptimised C28x code with FPU32 (a load 1-2 cycles, a float addition or
multiplication 2 plus a delay slot, a peripheral access two wait states, call and return with their saves).  CHOICE: one
factor per function, given with the firmware, scales whole tasks to the times measured on the robot (TFG figures 37 and
39).  `float_division.py` has the cost of a float division.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.ctypes import Double64, FloatType, IntType
from emulator.c28x.float_division import FloatDivision
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
CONVERT: Final = 4
COMPARE: Final = 3
#: Operations on floats of 64 bits are calls of the run-time library: CHOICE, in the order of magnitude of code that
#: computes in words of 32 bits (no list of their cycles was found).
DOUBLE_OP: Final = {"+": 250, "-": 250, "*": 300, "/": 1300}
DOUBLE_CONVERT: Final = 60
DOUBLE_COMPARE: Final = 60
BRANCH: Final = 4
CALL: Final = 16
LOOP: Final = 4
#: The cycles of a turn of a counting loop, without its body.
TURN: Final = LOOP + COMPARE + INT_OP

#: Functions that compile to instructions without a call -> their cycles (SPRU514, "Intrinsics"): a product is MOVL,
#: IMPYL, QMPYL and LSL64, a limit is MINL and MAXL.
INLINE: Final = {"__IQmpy": 4, "__IQxmpy": 4, "__IQsat": 2}

#: Operators of the tree on ints (of 16 bits) -> cycles.
INT: Final = {
    "+": INT_OP, "-": INT_OP, "*": INT_MUL, "/": INT_DIV, "%": INT_DIV, "<<": 2, ">>": 2, "&": 1, "|": 1, "^": 1,
}  # fmt: skip

#: The time of code without calibration may be wrong by this factor, in both directions.  It was computed by leaving out
#: each task in turn and predicting it, and from tasks that were never fitted: `python -m tests.calibration --write`.
UNCALIBRATED_FACTOR: Final = 3.0


class Costs:
    """The prices of one build."""

    def __init__(self, division: FloatDivision) -> None:
        self.division = division

    def leave(self, function: Function) -> None:
        """Store on every statement the cycles of its own expressions; on a loop, those of one test."""
        for s in statements(function.body):
            s.cycles = self._statement(s)

    def _statement(self, s: Stmt) -> int:
        match s:
            case Assign(target=RegisterRef() | RegisterAt() as target, value=value):
                field = 0 if target.field is None else REGISTER + REGISTER_FIELD
                block = POINTER + self.cycles(target.block) if isinstance(target, RegisterAt) else 0
                return REGISTER + field + block + self.cycles(value)
            case Assign(target=LValue() as target, value=value):
                return self.cycles(value) + STORE + self.access_cycles(target) + (REGISTER_FIELD if target.bits else 0)
            case CopyStruct(target=target, source=source):
                return self._address(target) + self._address(source) + STORE * target.ctype.words
            case Declare(value=list() as values):
                return STORE * len(values) + sum(0 if isinstance(one, Const) else self.cycles(one) for one in values)
            case Declare(value=Expr() as value):
                return self.cycles(value) + STORE
            case Evaluate(value=Call(function=function)) if function.extern and function.name in INSTRUCTIONS:
                return 1
            case Evaluate(value=value) | Return(value=Expr() as value):
                return self.cycles(value)
            case If(test=test):
                return self.condition(test) + BRANCH
            case While(test=test):
                return self.condition(test) + LOOP
            case For(test=None, start=start, stop=stop):
                return self.cycles(start) + self.cycles(stop)
            case For(test=Compare() as test):
                return self.condition(test) + LOOP
            case Switch(subject=Const(), cases=[(None, _)]):
                return 0  # there is no choice at run time
            case Switch(subject=subject, cases=cases):
                return self.cycles(subject) + BRANCH * max(1, len(cases))
        return 0

    def cycles(self, e: Any) -> int:
        """The cycles of an expression."""
        match e:
            case Load(lvalue=lvalue):
                plain = isinstance(lvalue.root, Variable) and lvalue.root.plain
                return (
                    (LOAD if plain else LOAD_MEMORY)
                    + self.access_cycles(lvalue)
                    + (REGISTER_FIELD if lvalue.bits else 0)
                )
            case RegisterLoad(register=register):
                block = POINTER + self.cycles(register.block) if isinstance(register, RegisterAt) else 0
                return block + REGISTER + (REGISTER_FIELD if register.field is not None else 0)
            case AddressOf(lvalue=lvalue):
                return self._address(lvalue)
            case Compare() | Logic() | Not():
                return self.condition(e)
            case Conditional(test=test, then=then, otherwise=otherwise):
                return BRANCH + self.condition(test) + self.cycles(then) + self.cycles(otherwise)
            case Convert(ctype=Double64(), operand=operand) | Convert(operand=Expr(ctype=Double64()) as operand):
                same = isinstance(e.ctype, Double64) and isinstance(operand.ctype, Double64)
                return self.cycles(operand) + (0 if same else DOUBLE_CONVERT)
            case Convert(operand=operand):
                floats = isinstance(e.ctype, FloatType), isinstance(operand.ctype, FloatType)
                between = isinstance(e.ctype, IntType | FloatType) and floats[0] != floats[1]
                return self.cycles(operand) + (CONVERT if between else 0)
            case Binary(ctype=Double64(), op=op, left=left, right=right):
                return DOUBLE_OP[op] + self.cycles(left) + self.cycles(right)
            case Binary(ctype=FloatType(), op=op, left=left, right=right):
                return self._float(op, right) + self.cycles(left) + self.cycles(right)
            case Binary(ctype=IntType(words=words), op=op, left=left, right=right):
                return INT[op] * words + self.cycles(left) + self.cycles(right)
            case Unary(operand=operand):
                return (FLOAT_OP if isinstance(e.ctype, FloatType) else INT_OP) + self.cycles(operand)
            case PointerAdd(pointer=pointer, index=index):
                return POINTER + self.cycles(pointer) + self.cycles(index)
            case PointerDifference(left=left, right=right):
                return INT_DIV + self.cycles(left) + self.cycles(right)
            case Call(function=function) if function.extern and function.name in INLINE:
                return INLINE[function.name] + sum(map(self.cycles, children(e)))
            case Call() | CallPointer():
                return CALL + sum(map(self.cycles, children(e)))
        return 0

    def _float(self, op: str, right: Expr) -> int:
        if op != "/":
            return FLOAT_OP
        multiplies = self.division.constant_multiplies and isinstance(right, Const)
        return FLOAT_OP if multiplies else self.division.cycles

    def condition(self, e: Expr) -> int:
        """The cycles of a branch on an expression."""
        match e:
            case Compare(left=left, right=right):
                wide = isinstance(left.ctype, Double64)
                return (DOUBLE_COMPARE if wide else COMPARE) + self.cycles(left) + self.cycles(right)
            case Logic(operands=operands):
                return sum(map(self.condition, operands))
            case Not(operand=operand):
                return self.condition(operand)
        return (DOUBLE_COMPARE if isinstance(getattr(e, "ctype", None), Double64) else COMPARE) + self.cycles(e)

    def access_cycles(self, lvalue: LValue) -> int:
        """The cycles of reaching an object: its subscripts, its pointer."""
        indices = sum(self.cycles(index.expr) for index in lvalue.indices)
        if isinstance(lvalue.root, Variable):
            return INDEX * len(lvalue.indices) + indices
        return POINTER + self.cycles(lvalue.root) + indices

    def _address(self, lvalue: LValue) -> int:
        root = lvalue.root
        if isinstance(root, Variable):
            return POINTER + sum(self.cycles(index.expr) for index in lvalue.indices)
        indices = 0 if whole_target(lvalue) else sum(self.cycles(index.expr) for index in lvalue.indices)
        return POINTER + self.cycles(root) + indices
