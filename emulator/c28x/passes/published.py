"""Static check of rings whose index is written before the element that it guards: `published-early`.

    ringIn = next;
    ring[old] = c;

The interrupt routine compares `ringIn` with its own index to see whether there is an element.  If it comes between the
two statements, it takes an element that is not there yet.

The check needs a whole program without a kernel, in which the loop of `main` fills a ring and a routine empties it.  It
follows what a function switches off before, also in its callers.  The mirror is `released.py`.
"""

from __future__ import annotations

from collections.abc import Iterator

from emulator.c28x.passes.interrupted import Place, Sides, mentions, off_at, place_of, scalar_of, written
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import Assign, Binary, Compare, Declare, Expr, Function, Index, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import all_blocks, bare, own_nodes, parts, source_text, statements


def check_published(sides: Sides) -> None:
    """Report the elements of rings that are written behind the index which guards them."""
    guards = {index: rings for routine in sides.routines for index, rings in _guards(routine).items()}
    for function, body in sides.bodies.items() if guards else ():
        for s, later in _early(body, guards):
            if not off_at(body, {id(s)}) and not sides.mask_of_caller(function):
                name = source_text(Load(s.target.ctype, s.target)) if isinstance(s.target, LValue) else ""
                message = (
                    f"{name} is written before the element that it guards (line {later.line}): an interrupt routine "
                    "that comes in between takes an element which is not there yet"
                )
                sides.owners[function].report(function, s.where, "published-early", message, object=name)


def _guards(routine: list[Function]) -> dict[Place, set[Place]]:
    """The indices that a routine compares with an index of its own, each with the rings that its own one reads."""
    nodes = [p for function in routine for s in statements(function.body) for p in own_nodes(s)]
    written_here = {written(s) for function in routine for s in statements(function.body)}
    found: dict[Place, set[Place]] = {}
    for p in nodes:
        if not isinstance(p, Compare):
            continue
        for mine, other in ((scalar_of(p.left), scalar_of(p.right)), (scalar_of(p.right), scalar_of(p.left))):
            if mine is None or other is None or mine not in written_here or other in written_here:
                continue
            rings = {
                place for q in nodes if isinstance(q, Load) and len(q.lvalue.indices) == 1
                and mentions(q.lvalue.indices[0], mine) and (place := place_of(q.lvalue)) is not None
            }  # fmt: skip
            if rings:
                found[other] = rings
    return found


def _early(body: list[Stmt], guards: dict[Place, set[Place]]) -> Iterator[tuple[Assign, Stmt]]:
    """The statements that write an index, each with the one behind it that writes the element before that index."""
    copies: dict[Variable, set[Place | None]] = {}
    for s in statements(body):
        match s:
            case (
                Declare(variable=copy, value=Expr() as value)
                | Assign(target=LValue(root=Variable(kind="local") as copy, indices=[]), value=value)
            ):  # fmt: skip
                copies.setdefault(copy, set()).add(scalar_of(value))
    for block in all_blocks(body):
        for number, s in enumerate(block):
            index = written(s)
            if index is None or index not in guards or not isinstance(s, Assign):
                continue
            following = block[number + 1 :]
            if any(written(later) == index for later in following):
                continue
            for later in following:
                match later:
                    case Assign(target=LValue(indices=[Index(expr=at)]) as target) if place_of(target) in guards[index]:
                        if _is_before(at, index, bare(s.value), copies):
                            yield s, later
                            break


def _is_before(at: Expr, index: Place, given: Expr, copies: dict[Variable, set[Place | None]]) -> bool:
    """Whether a subscript is an index as it was before it got a value: its copy, or one less than it is now."""
    match bare(at):
        case Load(lvalue=LValue(root=Variable(kind="local") as copy, indices=[])):
            return copies.get(copy) == {index}
    for p in parts(at):
        match p:
            case Binary(op="-", left=left, right=right) if constant_of(right) == 1:
                pass
            case Binary(op="%" | "&" as op, left=summed, right=around):
                match bare(summed), constant_of(around):
                    case Binary(op="+", left=left, right=right), int(size) if constant_of(right) == size - (op == "%"):
                        pass
                    case _:
                        continue
            case _:
                continue
        if mentions(left, index) or any(q == given for q in parts(left) if isinstance(q, Load)):
            return True
    return False
