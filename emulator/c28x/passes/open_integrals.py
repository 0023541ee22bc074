"""Static check of regulators whose integral is limited on one side only: `wind-up`.

    integral += error;
    if (integral < 0) integral = 0;
    output = error / 4 + integral / 2000;
    if (output > HIGH) output = HIGH;
    if (output < 0) output = 0;

The output has two limits, the integral has one.  Whoever wrote it knows that an integral needs limits: one is missing.
An integral without any is judged when the program runs (`wind_up`): its plant may never bring the output to a limit.

The check needs a whole program, for it reads the calls of the regulator.

Not meant: an integral that is added to, or set back, under a test of the error; a regulator that is called under such a
test, or in one state only, for both keep the error small.
"""

from __future__ import annotations

from collections.abc import Mapping

from emulator.c28x.passes.on_the_way import Turn, ways_to, with_turns
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.passes.wind_up import OpenRegulator, numbers_in, open_regulators
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Compare,
    Declare,
    Expr,
    Function,
    Load,
    LValue,
    Return,
    Stmt,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, blocks, parts, statements


def check_open_integrals(reports: Mapping[Module, StaticReport]) -> None:
    """Report the sums of integrals that nothing limits on one of two sides."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    functions = list(owners)
    whole = any(function.name == "main" for function in functions)
    for each in open_regulators(functions) if whole else ():
        two = len(each.limited) > 1 or any(isinstance(limit, Call) for limit in each.limited)
        if len(each.sides) != 1 or not two:
            continue
        added = each.added
        place = next(s for s in statements(added.function.body) if getattr(s, "value", None) is added.value)
        if _always_added(each, place) and not _kept_small(each, functions):
            side = "above" if "high" in each.sides else "below"
            owners[added.function].report(
                added.function, place.where, "wind-up",
                f"{added.target.text} has a limit on one side only: nothing limits it {side}, where the output stands "
                "at its own limit",
                object=f"{added.function.path}: {added.target.text}",
            )  # fmt: skip


def _always_added(regulator: OpenRegulator, place: Stmt) -> bool:
    """Whether each call of the function adds to the integral, and nothing but a limit sets it there."""
    added = regulator.added
    for s in added.function.body:
        if s is place:
            break
        if any(isinstance(each, Return) for block in blocks(s) for each in statements(block)):
            return False
    else:
        return False
    return all(
        s is place or not _sets(s, added.key) or any(added.key in numbers_in(turn.test) for turn in turns)
        for turns, s in with_turns(added.function)
    )


def _sets(s: Stmt, key: Key) -> bool:
    return isinstance(s, Assign) and isinstance(s.target, LValue) and key_of(s.target) == key


def _kept_small(regulator: OpenRegulator, functions: list[Function]) -> bool:
    """Whether tests on the way to the regulator, or to where its integral is set back, may keep the error small."""
    added = regulator.added
    operands = _through_locals(added.function, numbers_in(added.addend)) - {added.key}
    for function in functions:
        for turns, s in with_turns(function):
            if _sets(s, added.key) and any(_about(turn, operands) > 1 for turn in turns):
                return True
    states: list[set[int]] = []
    for turns in ways_to(added.function, functions):
        if any(_about(turn, operands) > (0 if turn.enters and _is_ordered(turn.test) else 1) for turn in turns):
            return True
        states.append({value for turn in turns for value in turn.values})
    return not states or (all(states) and len(set.union(*states)) == 1)


def _is_ordered(test: Expr) -> bool:
    return any(isinstance(p, Compare) and p.op not in ("==", "!=") for p in parts(test))


def _about(turn: Turn, operands: set[Key]) -> int:
    """How many of the numbers that make the error a test is about."""
    return len(_through_locals(turn.function, numbers_in(turn.test)) & operands)


def _through_locals(function: Function, keys: set[Key]) -> set[Key]:
    """Numbers, and those from which the locals among them are computed."""
    found = set(keys)
    for s in statements(function.body):
        match s:
            case Declare(variable=variable, value=Expr() as value) if (variable, 0) in keys:
                found |= numbers_in(value)
            case Assign(target=LValue() as target, value=value) if (
                key_of(target) in keys and not isinstance(bare(value), Load)
            ):  # fmt: skip
                found |= numbers_in(value)
    return found
