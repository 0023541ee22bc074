"""Objects that a program counts one by one: their values are whole counts, in no other scale.

position += direction;      // direction is only ever 1 or -1
copy.position = position;
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable

from emulator.c28x.tree import Binary, Conditional, Const, Expr, Load, LValue, Unary
from emulator.c28x.tree_queries import bare


def counted(assignments: Iterable[tuple[LValue, Expr]], name_of: Callable[[LValue], str]) -> set[str]:
    """The names of objects and members that take only numbers, steps of one, and copies of such objects.

    `assignments` are all of a program; `name_of` gives the name of the object or member that an lvalue ends in.
    """
    taken: defaultdict[str, list[Expr]] = defaultdict(list)
    for target, value in assignments:
        taken[name_of(target)].append(bare(value))
    taken.pop("", None)
    ones = {name for name, values in taken.items() if all(_one(value) for value in values)}

    def steps(name: str, value: Expr) -> bool:
        match value:
            case Binary(op="+" | "-", left=left, right=right):
                by, own = bare(right), bare(left)
                known = _one(by) or (isinstance(by, Load) and name_of(by.lvalue) in ones)
                return known and isinstance(own, Load) and name_of(own.lvalue) == name
        return False

    found = {name for name, values in taken.items() if any(steps(name, value) for value in values)}
    grown = True
    while grown:
        grown = False
        for name, values in taken.items():
            copies = [name_of(value.lvalue) for value in values if isinstance(value, Load)]
            if name not in found and any(copy in found for copy in copies):
                found.add(name)
                grown = True
    while True:
        wrong = {
            name for name in found for value in taken[name]
            if not isinstance(value, Const) and not steps(name, value)
            and not (isinstance(value, Load) and name_of(value.lvalue) in found)
        }  # fmt: skip
        if not wrong:
            return found
        found -= wrong


def _one(value: Expr) -> bool:
    """Whether a value is 1, 0 or -1."""
    match value:
        case Const(value=number):
            return abs(number) <= 1
        case Unary(op="-", operand=operand):
            return _one(bare(operand))
        case Conditional(then=then, otherwise=otherwise):
            return _one(bare(then)) and _one(bare(otherwise))
    return False
