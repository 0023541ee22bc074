"""Static check of ports that `main` reads and writes back, while an interrupt routine sets other pins of them: `race`.

    GpioDataRegs.GPADAT.all |= BRAKE;       // main
    GpioDataRegs.GPASET.all = DIRECTION;    // the routine, at any time

The statement reads 32 latches, changes one, and writes all of them, by several instructions (CPU: `OR loc16` changes 16
bits).  If the routine comes in between, its pin gets the level back that it had before.

The check needs a whole program without a kernel, and follows what a function switches off before, also in its callers.
Not meant: a single field (`GPADAT.bit.GPIO9 = 1`), which the compiler sets with one instruction.
"""

from __future__ import annotations

import re
from typing import Final

from emulator.c28x.passes.interrupted import Sides, off_at
from emulator.c28x.tree import Assign, RegisterLoad, RegisterRef, Stmt
from emulator.c28x.tree_queries import parts, register_text, statements

#: The registers that change the latches of a port: its letter.
_LATCHES: Final = re.compile(r"GP([A-F])(?:DAT|SET|CLEAR|TOGGLE)$")


def check_port_writes(sides: Sides) -> None:
    """Report the statements that write a whole port back which a routine changes."""
    changing = {
        port: routine[0].name for routine in sides.routines for function in routine for s in statements(function.body)
        if (port := _port_of(s))
    }  # fmt: skip
    for function, body in sides.bodies.items() if changing else ():
        for s in statements(body):
            port, target = _port_of(s), _written_back(s)
            if port not in changing or target is None:
                continue
            if not off_at(body, {id(s)}) and not sides.mask_of_caller(function):
                name = register_text(target)
                message = (
                    f"{name} is read and written back: what {changing[port]} does to another pin of port {port} in "
                    "between is undone"
                )
                sides.owners[function].report(function, s.where, "race", message, object=name)


def _port_of(s: Stmt) -> str:
    """The letter of the port of which a statement changes latches; empty: of none."""
    match s:
        case Assign(target=RegisterRef(block="GpioDataRegs", register=name)):
            found = _LATCHES.match(name)
            return found[1] if found is not None else ""
    return ""


def _written_back(s: Stmt) -> RegisterRef | None:
    """The register that a statement writes as a whole, with a value that it makes of the register itself."""
    match s:
        case Assign(target=RegisterRef(field=None) as target, value=value):
            for p in parts(value):
                read = p.register if isinstance(p, RegisterLoad) else None
                if isinstance(read, RegisterRef) and (read.block, read.register) == (target.block, target.register):
                    return target
    return None
