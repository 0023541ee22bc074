"""Static check of regulators whose integral is limited on one side only, or not at all: `wind-up`.

    integral += error;
    if (integral < 0) integral = 0;
    output = error / 4 + integral / 2000;
    if (output > HIGH) output = HIGH;
    if (output < 0) output = 0;

The output has two limits, the integral has one.  Whoever wrote it knows that an integral needs limits: one is missing.

    integral += KI * error;
    output = limit(KP * error + integral, OUTPUT_MAX);

`limit` replaces its parameter on both sides, and was not used for the integral.  That is said only if nothing else of
the program touches the integral, nor asks about the output on the way to it, and if each pass adds to it.  Any other
integral without a limit is judged when the program runs (`wind_up`): its plant may never bring the output to a limit.

The check needs a whole program, for it reads the calls of the regulator.

Not meant: an integral that is added to, or set back, under a test of the error; a regulator that is called under such a
test, or in one state only, for both keep the error small.
"""

from __future__ import annotations

from collections.abc import Mapping

from emulator.c28x.passes.on_the_way import Turn, ways_to, with_turns
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.stamps import Key, key_of
from emulator.c28x.passes.wind_up import (
    IntegralSum,
    OpenRegulator,
    integral_sums,
    limited_sides,
    numbers_in,
    open_regulators,
    regulator_of,
)  # fmt: skip
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Continue,
    CopyStruct,
    Declare,
    Expr,
    Function,
    FunctionRef,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Return,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    bare,
    blocks,
    gives,
    last_loop,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
)  # fmt: skip


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
        place = _place(added)
        if _always_added(each, place) and not _kept_small(each, functions):
            side = "above" if "high" in each.sides else "below"
            owners[added.function].report(
                added.function, place.where, "wind-up",
                f"{added.target.text} has a limit on one side only: nothing limits it {side}, where the output stands "
                "at its own limit",
                object=f"{added.function.path}: {added.target.text}",
            )  # fmt: skip
    for function in functions if whole else ():
        for added in integral_sums(function, _lasting(function)):
            regulator = regulator_of(added, frozenset({"high", "low"}))
            if regulator is not None and _never_limited(regulator, functions):
                place = _place(added)
                owners[function].report(
                    function, place.where, "wind-up",
                    f"{added.target.text} has no limit, only the output has{_by(regulator.limited[0])}: while that is "
                    f"at its limit, {added.target.text} goes on growing",
                    object=f"{function.path}: {added.target.text}",
                )  # fmt: skip


def _by(limited: Expr) -> str:
    return f" by {source_text(limited)}" if isinstance(limited, Call) else ""


def _place(added: IntegralSum) -> Stmt:
    return next(s for s in statements(added.function.body) if getattr(s, "value", None) is added.value)


def _lasting(function: Function) -> set[Variable]:
    """The locals that keep their values from one turn of an endless loop to the next."""
    loop = last_loop(function)
    return {s.variable for s in function.body if isinstance(s, Declare)} if loop is not None else set()


def _never_limited(regulator: OpenRegulator, functions: list[Function]) -> bool:
    """Whether a function limits the output on both sides, and nothing at all the integral."""
    added, limited = regulator.added, regulator.limited
    sides = set[str]().union(*map(limited_sides, limited))
    if len(sides) < 2 or not all(map(limited_sides, limited)) or not _plainly_added(added):
        return False
    ids = {number for number, part in regulator.parts.items() if part.kind in ("output", "limit")}
    own = {id(q) for p in within(added.function.body) if p is added.value or id(p) in ids for q in parts(p)}
    if any(_touches(function, added, own) for function in functions):
        return False
    output = _follows(ids, functions)
    if _reads(added.addend, output, ids):
        return False
    ways = list(ways_to(added.function, functions))
    asked = output | _makes(numbers_in(added.addend), functions)
    if any(_reads(turn.test, asked, ids) for turns in ways for turn in turns):
        return False
    if ways:
        return not _kept_small(regulator, functions)
    named = any(isinstance(p, FunctionRef) and p.function is added.function for f in functions for p in within(f.body))
    return named or bool(added.function.interrupt) or last_loop(added.function) is not None


def _plainly_added(added: IntegralSum) -> bool:
    """Whether each pass adds to the integral, always by the same rule: no test decides what, or whether."""
    function = added.function
    loop = last_loop(function)
    for s in loop.body if loop is not None else function.body:
        if getattr(s, "value", None) is added.value:
            break
        if any(isinstance(each, Return | Break | Continue | LeaveSwitch) for each in statements([s])):
            return False
    else:
        return False
    terms = [added.addend]
    for turns, s in with_turns(function):
        given = gives(s)
        if given is not None and key_of(given[0]) in numbers_in(added.addend):
            if not all(isinstance(turn.test, Const) for turn in turns):
                return False
            terms.append(given[1])
    called = [p for p in parts(added.addend) if isinstance(p, CallPointer) or (isinstance(p, Call) and p.function.body)]
    return not called and not any(isinstance(p, Conditional | Compare | Logic) for term in terms for p in parts(term))


def _touches(function: Function, added: IntegralSum, own: set[int]) -> bool:
    """Whether a function does anything with the integral; `own`: the nodes of its sum and of the output.

    A structure within another has two keys, so a member is known by its name.
    """
    member = added.key[0] == "member"
    name = _member(added.target)
    loop = last_loop(function)
    start = function.body[: function.body.index(loop)] if loop is not None else []
    for s in statements(function.body):
        if member and isinstance(s, CopyStruct):
            return True
        if isinstance(s, Assign) and isinstance(s.target, LValue) and s.value is not added.value:
            first = any(s is each for each in start) and isinstance(bare(s.value), Const)
            if not first and (key_of(s.target) == added.key or (member and _member(s.target) == name)):
                return True
        for p in own_nodes(s):
            match p:
                case Load(lvalue=lvalue) | AddressOf(lvalue=lvalue) if id(p) not in own:
                    if (member and _member(lvalue) == name) or key_of(lvalue) == added.key:
                        return True
                case Call(function=called) if member and called.extern and called.name.startswith("mem"):
                    return True
    return False


def _member(lvalue: LValue) -> str:
    return lvalue.text.replace("->", ".").rpartition(".")[2]


def _follows(ids: set[int], functions: list[Function]) -> set[Key]:
    """What depends on the output, or is set under a test of it; `ids`: the nodes of the output."""
    found: set[Key] = set()
    before = -1
    while len(found) != before:
        before = len(found)
        for function in functions:
            for turns, s in with_turns(function):
                tested = any(_reads(turn.test, found, ids) for turn in turns)
                given = gives(s)
                value = given[1] if given is not None else s.value if isinstance(s, Return) else None
                key = key_of(given[0]) if given is not None else ("result", function.path)
                if value is not None and key is not None and (tested or _reads(value, found, ids)):
                    found.add(key)
                for p in own_nodes(s):
                    if isinstance(p, Call):
                        given_to = zip(p.function.parameters, p.arguments, strict=False)
                        found |= {(parameter, 0) for parameter, argument in given_to if _reads(argument, found, ids)}
    return found


def _makes(keys: set[Key], functions: list[Function]) -> set[Key]:
    """Numbers, and all from which they are computed."""
    found: set[Key] = set()
    while keys - found:
        found |= keys
        for function in functions:
            for s in statements(function.body):
                given = gives(s)
                if given is not None and key_of(given[0]) in found:
                    keys = keys | numbers_in(given[1])
                for p in own_nodes(s):
                    if isinstance(p, Call):
                        for parameter, argument in zip(p.function.parameters, p.arguments, strict=False):
                            keys = keys | numbers_in(argument) if (parameter, 0) in found else keys
    return found


def _reads(e: Expr, keys: set[Key], ids: set[int]) -> bool:
    """Whether an expression reads one of some numbers or results, or has one of some nodes."""
    for p in parts(e):
        match p:
            case Load(lvalue=lvalue) if key_of(lvalue) in keys:
                return True
            case Call(function=function) if ("result", function.path) in keys:
                return True
        if id(p) in ids:
            return True
    return False


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
