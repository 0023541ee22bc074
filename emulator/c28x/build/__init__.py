"""C's rules on typed nodes: what both readers build their trees with.

Free functions on a `Builder`: typed operands and a place in, a typed node out; conversions, promotions, decay and
lvalues are decided here and nowhere else.  It knows neither Python's syntax tree nor a C parser's.
"""

from __future__ import annotations

from emulator.c28x.build.calls import call, call_value, sizeof
from emulator.c28x.build.constants import character, constant_value, floating, fold, integer, string, why_no_constant
from emulator.c28x.build.conversions import condition, convert, promoted, same_type
from emulator.c28x.build.depth import shallow, shallow_place
from emulator.c28x.build.effects import arguments, operands, settled, unsequenced, writes_itself
from emulator.c28x.build.initialisers import RAM_WORDS, Braces, Item, array_of, is_constant, length_given, values
from emulator.c28x.build.operators import (
    BINARY,
    COMPARISONS,
    assigned,
    binary,
    combined,
    compare,
    conditional,
    logic,
    logical_not,
    row,
    step,
    unary,
)  # fmt: skip
from emulator.c28x.build.places import (
    PINT,
    Place,
    RegisterPath,
    address_of,
    block_type,
    complete,
    core_register,
    dereference,
    element,
    function_value,
    member,
    object_place,
    octet_of,
    pointee,
    register_block,
    unmodelled_block,
    value_of,
)  # fmt: skip
from emulator.c28x.build.scope import Builder, file_scope
from emulator.c28x.build.statements import (
    Link,
    assign,
    begin,
    chain,
    do_while,
    evaluate,
    for_range,
    held,
    initialise,
    literal,
    loop,
    return_,
    switch,
    while_,
)  # fmt: skip

__all__ = [
    "BINARY", "COMPARISONS", "PINT", "RAM_WORDS", "Braces", "Builder", "Item", "Link", "Place", "RegisterPath",
    "address_of", "arguments", "array_of", "assign", "assigned", "begin", "binary", "block_type", "call",
    "call_value", "chain", "character", "combined", "compare", "complete", "condition", "conditional",
    "constant_value", "convert", "core_register", "dereference", "do_while", "element", "evaluate", "file_scope",
    "floating", "fold", "for_range", "function_value", "held", "initialise", "integer", "is_constant", "length_given",
    "literal", "logic", "logical_not", "loop", "member", "object_place", "octet_of", "operands", "pointee", "promoted",
    "register_block", "return_", "row", "same_type", "settled", "shallow", "shallow_place", "sizeof",
    "step", "string", "switch", "unary", "unmodelled_block", "unsequenced", "value_of", "values", "while_",
    "why_no_constant", "writes_itself",
]  # fmt: skip
