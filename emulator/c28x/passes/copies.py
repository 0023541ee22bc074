"""Static check of differences: an object minus its own copy is always 0, and their quotient always 1.

`last = now; speed = now - last;` stores before it subtracts.  The check follows copies through the statements of a
block, and into the branches of an `if`.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.values import volatile
from emulator.c28x.tree import (
    Assign,
    Binary,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    OBSERVABLE,
    bare,
    blocks,
    own_nodes,
    runs_function,
    source_text,
    statements,
)

#: Operator -> its result for an object and its copy.
_RESULT: Final = {"-": 0, "/": 1, "^": 0}
#: Pairs of a copy and its original.
_Copies = list[tuple[LValue, LValue]]


def check_copies(function: Function, report: StaticReport) -> None:
    """Report the differences of a function whose operands are copies of each other."""
    _block(function, function.body, [], report)


def _block(function: Function, body: list[Stmt], copies: _Copies, report: StaticReport) -> None:
    for s in body:
        inner = blocks(s)
        copies = _copies_within(s, copies)
        for e in own_nodes(s) if copies else ():
            if isinstance(e, Binary) and e.op in _RESULT and _are_copies(e, copies):
                message = f"{source_text(e)} is always {_RESULT[e.op]}: one has just been copied to the other"
                report.report(function, s.where, "own-copy", message, object=source_text(e))
        for block in inner:
            _block(function, block, list(copies) if isinstance(s, If) else [], report)
        copies = [] if inner or not isinstance(s, Assign | Declare | Evaluate) else _copies_after(s, copies)


def _are_copies(e: Binary, copies: _Copies) -> bool:
    left, right = bare(e.left), bare(e.right)
    if not isinstance(left, Load) or not isinstance(right, Load):
        return False
    both = left.lvalue, right.lvalue
    return any(both in ((a, b), (b, a)) for a, b in copies)


def _copies_within(s: Stmt, copies: _Copies) -> _Copies:
    """The copies that are valid wherever the expressions of a statement are evaluated.

    A call in them may come first (`if (Find(&line) && line - last > 2)`).  A loop evaluates its test after each turn.
    """
    if not copies:
        return copies
    if not isinstance(s, While | For):
        return _kept(copies, None, called=runs_function(s))
    turns = list(statements([s]))
    for turn in turns:
        copies = _kept(copies, _written(turn), called=False)
    return _kept(copies, None, called=any(map(runs_function, turns)))


def _copies_after(s: Assign | Declare | Evaluate, copies: _Copies) -> _Copies:
    """The copies that are valid after a statement."""
    called = any(isinstance(part, OBSERVABLE) for part in own_nodes(s))
    written = _written(s)
    target: LValue | None = None
    match s:
        case Assign(target=LValue() as target):
            pass
        case Declare(variable=variable):
            target = LValue(variable.ctype, variable)
    left = _kept(copies, written, called=called)
    value = s.value
    match value:
        case Load(lvalue=source) if target is not None and _plain(target) and _plain(source):
            if source.root is not written and not called:
                left.append((target, source))
    return left


def _kept(copies: _Copies, written: Variable | Expr | None, *, called: bool) -> _Copies:
    """The copies that a write to an object, or (an expression) through a pointer, and a call leave."""
    if isinstance(written, Expr):
        return []
    return [pair for pair in copies if not any(end.root is written or (called and _reached(end)) for end in pair)]


def _written(s: Stmt) -> Variable | Expr | None:
    """The object that a statement itself writes, or the pointer that it writes through."""
    match s:
        case Assign(target=LValue(root=root)) | CopyStruct(target=LValue(root=root)) | For(variable=LValue(root=root)):
            return root
        case Declare(variable=variable):
            return variable
    return None


def _plain(lvalue: LValue) -> bool:
    """Whether an lvalue is one named scalar that only statements change."""
    root = lvalue.root
    return isinstance(root, Variable) and not lvalue.indices and not volatile(lvalue) and lvalue.ctype.leaves == 1


def _reached(lvalue: LValue) -> bool:
    """Whether a called function could change an object."""
    return isinstance(lvalue.root, Variable) and (lvalue.root.kind == "global" or lvalue.root.in_memory)
