"""Pass `pulses`: times between two captures of an eCAP, of which a 16-bit object keeps the lower half.

`Uint16 width = Captured.fall - Captured.rise;` is right up to 65535 counts, 328 us at 200 MHz.  Beyond, the upper bits
are lost.  This is wrong only where the object is used as a wider number afterwards: the running code checks that
(`Guards`, `Runtime.pulse`).  A 16-bit stamp that is widened for the difference is none: the lower half is right then.
"""

from __future__ import annotations

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.stamps import CAPTURES, STAMP, Stamps
from emulator.c28x.tree import Assign, Binary, Const, Convert, Declare, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import own_nodes, statements, within


def pulses(image: Stamps) -> dict[int, str]:
    """Identities of conversions, each with the path of its object: those that cut a time, and the wider uses of it.

    `image` are the stamps of an image, of whatever registers.
    """
    stamps = image.of(CAPTURES)
    for function in stamps.functions:
        stamps.read(function)
    while stamps.grows():
        pass
    if not stamps.kinds:
        return {}
    found: dict[int, str] = {}
    kept: set[Variable] = set()
    for function in stamps.functions:
        for s in statements(function.body):
            match s:
                case Assign(target=LValue(root=Variable() as variable, indices=[]), value=Convert() as cut) | Declare(
                    variable=variable, value=Convert() as cut
                ) if _word(variable.ctype) and _time(cut, stamps) and not _split(function.body, cut):  # fmt: skip
                    found[id(cut)] = variable.declaration.path
                    kept.add(variable)
    for p in (p for function in stamps.functions if kept for p in within(function.body)):
        match p:
            case Convert(ctype=wide, operand=Load(lvalue=LValue(root=Variable() as variable))) if variable in kept:
                if isinstance(wide, FloatType) or (isinstance(wide, IntType) and wide.bits == 32):
                    found[id(p)] = variable.declaration.path
    return found


def _word(ctype: object) -> bool:
    return isinstance(ctype, IntType) and ctype.bits == 16 and not ctype.signed


def _time(cut: Convert, stamps: Stamps) -> bool:
    """Whether a conversion without a cast keeps 16 bits of a difference of two captures in 32 bits."""
    match cut:
        case Convert(
            explicit=False, operand=Binary(op="-", ctype=IntType(signed=False, bits=32), left=left, right=right)
        ):
            return all(not isinstance(side, Convert) and stamps.kind(side) == STAMP for side in (left, right))
    return False


def _split(body: list[Stmt], cut: Convert) -> bool:
    """Whether the function keeps the upper half of the same difference too."""
    return any(
        isinstance(p, Binary) and p.op == ">>" and isinstance(p.right, Const) and p.left == cut.operand
        for s in statements(body) for p in own_nodes(s)
    )  # fmt: skip
