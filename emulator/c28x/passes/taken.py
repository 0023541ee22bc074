"""Pass `taken`: statements that clear an object whose value the statement before has copied.

    taken = Flags;
    Flags = 0;

Together they read and change the object, as `Flags &= ...` does: a flag that an interrupt sets between them is lost.
After a test of the object (`if (Flags)`) they acknowledge a flag, which is right for a flag that is only set.
"""

from __future__ import annotations

from itertools import pairwise

from emulator.c28x.tree import Assign, Const, Declare, Expr, Function, If, Load, LValue, Stmt, Switch, Variable, While
from emulator.c28x.tree_queries import bare, blocks, parts


def leave_taken(function: Function) -> None:
    """Mark the statements that clear the object which the statement before has copied."""
    _look(function.body, frozenset())


def _look(body: list[Stmt], tested: frozenset[Variable]) -> None:
    for before, s in pairwise(body):
        kept = _kept(before)
        if kept is not None and kept not in tested and _clears(s, kept):
            assert isinstance(s, Assign)
            s.takes = True
    for s in body:
        test = s.test if isinstance(s, If | While) else s.subject if isinstance(s, Switch) else None
        inner = tested | {p.root for p in parts(test) if isinstance(p, LValue) and isinstance(p.root, Variable)}
        for block in blocks(s):
            _look(block, inner)


def _kept(s: Stmt) -> Variable | None:
    """The scalar file-scope object that a statement copies; None: there is none."""
    value = s.value if isinstance(s, Assign | Declare) else None
    read = bare(value) if isinstance(value, Expr) else None
    if isinstance(read, Load) and isinstance(read.lvalue, LValue) and not read.lvalue.indices:
        root = read.lvalue.root
        return root if isinstance(root, Variable) and root.kind == "global" and root.ctype.leaves == 1 else None
    return None


def _clears(s: Stmt, kept: Variable) -> bool:
    match s:
        case Assign(target=LValue(root=Variable() as root), value=value):
            return root is kept and isinstance(bare(value), Const)
    return False
