"""Static check of differences: an object minus its own copy is always 0, and their quotient always 1.

`last = now; speed = now - last;` stores before it subtracts.  The check follows copies through the statements of a
block, and into the branches of an `if`: of objects, members, elements, and what a local pointer leads to.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.declared import may_be_volatile
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.values import volatile
from emulator.c28x.tree import (
    Assign,
    Binary,
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
    LValue,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    OBSERVABLE,
    bare,
    blocks,
    fixed_words,
    own_nodes,
    parts,
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
    #: What the block has added to objects or taken off: object -> the statement, the operator, the operand, the copies.
    changed: dict[str, tuple[Stmt, str, LValue, _Copies]] = {}
    for s in body:
        _check_sum(function, s, changed, copies, report)
        inner = blocks(s)
        copies = _copies_within(s, copies)
        for e in own_nodes(s) if copies else ():
            if isinstance(e, Binary) and e.op in _RESULT and _are_copies(e, copies):
                message = f"{source_text(e)} is always {_RESULT[e.op]}: one has just been copied to the other"
                report.report(function, s.where, "own-copy", message, object=source_text(e))
        for block in inner:
            _block(function, block, list(copies) if isinstance(s, If) else [], report)
        copies = [] if inner or not isinstance(s, Assign | Declare | Evaluate) else _copies_after(s, copies)


def _check_sum(
    function: Function, s: Stmt, changed: dict[str, tuple[Stmt, str, LValue, _Copies]], copies: _Copies,
    report: StaticReport,
) -> None:  # fmt: skip
    """Report a sum that gets what it has just lost: `ring[at] = new; sum -= ring[at]; sum += new;`."""
    match s:
        case Assign(target=LValue() as target, value=value):
            match bare(value):
                case Binary(op="+" | "-" as op, left=left, right=right):
                    match bare(left), bare(right):
                        case Load(lvalue=same), Load(lvalue=operand) if same == target and target.text:
                            before = changed.get(target.text)
                            if before is not None and before[1] != op and _both(before[2], operand, before[3], copies):
                                first = before[0]
                                message = (
                                    f"{target.text} loses and gets the same: {before[2].text} and {operand.text} are "
                                    "copies of each other here"
                                )
                                report.report(function, first.where, "own-copy", message, object=target.text)
                            changed[target.text] = s, op, operand, list(copies)


def _both(one: LValue, other: LValue, before: _Copies, now: _Copies) -> bool:
    """Whether two objects were copies of each other then, and are now."""
    pairs = (one, other), (other, one)
    return any(pair in before and pair in now for pair in pairs)


def _are_copies(e: Binary, copies: _Copies) -> bool:
    left, right = bare(e.left), bare(e.right)
    if not isinstance(left, Load) or not isinstance(right, Load):
        return False
    both = left.lvalue, right.lvalue
    if not any(both in ((a, b), (b, a)) and _differ_by_nothing(e, a, b) for a, b in copies):
        return False
    return not any(isinstance(end.root, Expr) and may_be_volatile(end.root) for end in both)


def _differ_by_nothing(e: Binary, a: LValue, b: LValue) -> bool:
    """Whether the result is that of equal numbers: copies of another sign are equal in their own width only."""
    if a.ctype == b.ctype:
        return True
    match a.ctype, e.ctype:
        case IntType(bits=bits), IntType(bits=computed):
            return e.op != "/" and computed == bits
    return False


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
    target = _written(s)
    left = _kept(copies, target, called=called)
    value = s.value
    match value:
        case Convert(ctype=IntType(bits=bits), operand=Load(ctype=IntType(bits=same)) as inner) if bits == same:
            value = inner
    match value:
        case Load(lvalue=source) if target is not None and _plain(target) and _plain(source):
            if not called and not _touches(target, source):
                left.append((target, source))
    return left


def _kept(copies: _Copies, written: LValue | None, *, called: bool) -> _Copies:
    """The copies that a write, and a call, leave."""
    return [
        pair for pair in copies
        if not any((written is not None and _touches(written, end)) or (called and _reached(end)) for end in pair)
    ]  # fmt: skip


def _touches(written: LValue, end: LValue) -> bool:
    """Whether a write may change an object, or which object an lvalue designates."""
    root = written.root
    if any(isinstance(p, LValue) and p is not end and p.root is root for p in parts(end)):
        return True
    if isinstance(root, Variable) and isinstance(end.root, Variable):
        return root is end.root and not _apart(written, end)
    if isinstance(root, Variable):
        return root.kind == "global" or root.in_memory
    if isinstance(end.root, Variable):
        return _reached(end)
    return root != end.root or not _apart(written, end)


def _apart(one: LValue, other: LValue) -> bool:
    """Whether two scalars of one object are two of its members."""
    same = one.indices == other.indices  # an element, whichever it is
    first, second = (one.words, other.words) if same else (fixed_words(one), fixed_words(other))
    if first is None or second is None or one.bits is not None or other.bits is not None:
        return False
    return first + one.ctype.words <= second or second + other.ctype.words <= first


def _written(s: Stmt) -> LValue | None:
    """What a statement itself writes."""
    match s:
        case Assign(target=LValue() as target) | CopyStruct(target=target) | For(variable=target):
            return target
        case Declare(variable=variable):
            return LValue(variable.ctype, variable)
    return None


def _plain(lvalue: LValue) -> bool:
    """Whether an lvalue is one scalar that only statements change, and that only statements can move."""
    if volatile(lvalue) or lvalue.ctype.leaves != 1:
        return False
    outer = lvalue.root if isinstance(lvalue.root, Expr) else None
    shared = isinstance(lvalue.root, Variable) and lvalue.root.kind == "global"  # then calls end what is known
    designators = [outer, *(index.expr for index in lvalue.indices)]
    return all(_fixed(e, shared=shared) for e in designators if e is not None)


def _fixed(e: Expr, *, shared: bool) -> bool:
    """Whether an expression is a constant, a local that no pointer leads to, or (`shared`) another scalar."""
    match bare(e):
        case Const():
            return True
        case Load(lvalue=LValue(root=Variable() as root, indices=[])):
            return root.plain or (shared and root.kind == "global" and not root.volatile)
    return False


def _reached(lvalue: LValue) -> bool:
    """Whether a called function could change an object."""
    root = lvalue.root
    return isinstance(root, Expr) or root.kind == "global" or root.in_memory
