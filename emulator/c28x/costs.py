"""What an operation of the tree costs in CPU cycles.

Magnitudes are those of unoptimised C28x code with FPU32 (load 1-2, float add or multiply 2 plus a delay slot,
division a library call, a peripheral access two wait states, call and return with their saves).  CHOICE: one factor a
function, given with the firmware, brings whole tasks to the times measured on the robot (TFG figures 37 and 39).
"""

from __future__ import annotations

from typing import Final

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

#: Operators of the tree -> cycles, for ints and floats.
INT: Final = {
    "+": INT_OP,
    "-": INT_OP,
    "*": INT_MUL,
    "/": INT_DIV,
    "%": INT_DIV,
    "<<": 2,
    ">>": 2,
    "&": 1,
    "|": 1,
    "^": 1,
}
FLOAT: Final = {"+": FLOAT_OP, "-": FLOAT_OP, "*": FLOAT_OP, "/": FLOAT_DIV}
