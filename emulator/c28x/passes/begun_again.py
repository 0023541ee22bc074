"""Static check of counts and flags that are never begun again: `not-begun-again`.

The check needs a whole program (one with a `main`), because it must see all statements.  It knows the integers at file
scope (and `static` ones) that every statement only counts up, or only sets to one value.  Eight uses of them are wrong
from the second time on:

* the time in a state, which the program can enter again (`if (stateMs > LIMIT) state = FAULT`);
* the place where a text ends, in a function that ends one text after the other (`line[length] = 0`);
* the mark that a buffer was too small, while its index begins again (`if (tooLong || ...) bad++; else ...`);
* the time without a sign of life after which another count is set back (`if (quiet > LIMIT) length = 0;`);
* the time without an order, after which the last order is taken back (`else if (without < LIMIT) without++; else ...`);
* the number of values in a sum that is begun again without it (`if (count == N) { mean = sum / N; sum = 0; }`); here
  the count may also be a local that an endless loop never sets back;
* the sum whose count is begun again without it (`if (count == N) { mean = sum / N; count = 0; }`), likewise;
* the count of readings that differ from a level, which the next reading that does not differ leaves as it is
  (`if (level != stable && ++different >= TIMES) { stable = level; different = 0; }`): bounces add up.

Clocks (read by any other statement), numbers of events, delays after the start, and faults that are latched are not
meant: the conditions stand at each use.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final

from emulator.c28x.ctypes import ArrayType, IntType
from emulator.c28x.passes.declared import line_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import ANYTHING, Given, StateValues, constant_of, named, start_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Declaration,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    Function,
    If,
    Index,
    Load,
    Logic,
    LValue,
    Not,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    added,
    addressed,
    all_blocks,
    assigned,
    bare,
    below,
    blocks,
    called,
    last_loop,
    leaves,
    own_nodes,
    parts,
    reached,
    roots,
    runs_function,
    statements,
    within,
    without_end,
)

#: Names and comments of flags that are meant to stay.
_LATCHED: Final = re.compile(r"latch|trip|fault|fail|lock|sticky|perman|for good|until reset", re.IGNORECASE)


def check_begun_again(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the uses of counts and flags that are wrong because nothing begins them again."""
    functions = [function for module in modules for function in module.functions]
    if any(function.name == "main" and function.body for function in functions):
        _Program(functions, {f: report for module, report in reports.items() for f in module.functions}).check()


class _Program:
    """The objects of a program that are only counted up or only set, and their uses."""

    def __init__(self, functions: list[Function], reports: dict[Function, StaticReport]) -> None:
        self.functions = functions
        self.own = {function.path: function for function in functions}
        self.reports = reports
        #: The assignments to each object.
        self.writes: dict[Variable, list[Stmt]] = {}
        self.taken: set[Variable] = set()
        for function in functions:
            self.taken |= addressed(within(function.body))
            for s in statements(function.body):
                if (variable := assigned(s)) is not None:
                    self.writes.setdefault(variable, []).append(s)
        plain = [v for v in self.writes if is_number(v) and v not in self.taken and not v.escapes]
        #: Those that are only counted up, and those that are only set to one value which they did not have.
        self.counts = {v for v in plain if all((step_of(s, v) or 0) > 0 for s in self.writes[v])}
        self.flags = {v for v in plain if self._only_set(v)}
        #: Those that may be places in a text: they are counted up, and set back at most where they have passed a limit.
        self.places = self.counts | self._back_at_limits(plain)
        self.places -= self._read_otherwise(self.places) if self.places else set()
        self.counts &= self.places
        self.states = StateValues(functions)

    def _only_set(self, v: Variable) -> bool:
        values = {constant_of(s.value) if isinstance(s, Assign) else None for s in self.writes[v]}
        return len(values) == 1 and None not in values and values != {start_of(v)}

    def _back_at_limits(self, plain: list[Variable]) -> set[Variable]:
        """The objects that are counted up, and that other statements set back only where they have passed a limit."""
        late: dict[Variable, set[int]] = {}
        for function in self.functions:
            for s in statements(function.body):
                for count, branch in _passed(s) if isinstance(s, If) else ():
                    late.setdefault(count, set()).update(map(id, statements(branch)))
        return {
            v for v in plain if v in late and any((step_of(s, v) or 0) > 0 for s in self.writes[v])
            and all((step_of(s, v) or 0) > 0 or (_begins(s) and id(s) in late[v]) for s in self.writes[v])
        }  # fmt: skip

    def _read_otherwise(self, counts: set[Variable]) -> set[Variable]:
        """The counts that anything reads but their steps, comparisons with constants, and subscripts: as clocks are."""
        by_declaration = {v.declaration: v for v in counts}
        found: set[Variable] = set()
        for function in self.functions:
            for s in statements(function.body):
                if isinstance(s, Declare) and s.variable.kind == "temporary":
                    continue
                own = assigned(s)
                for root in roots(s):
                    every = parts(root)
                    allowed = {
                        id(p) for q in every
                        if isinstance(q, Index) or (isinstance(q, Compare) and _against_constant(q) is not None)
                        for p in parts(q)
                    }  # fmt: skip
                    for p in every:
                        if isinstance(p, LValue) and isinstance(p.root, Variable) and id(p) not in allowed:
                            read = by_declaration.get(p.root.declaration)
                            if read is not None and read is not own:
                                found.add(read)
        return found

    def check(self) -> None:
        for function in self.functions:
            for s in statements(function.body):
                if isinstance(s, Switch) and (state := named(s.subject)) is not None and self.counts:
                    self._times(function, s, state)
                for block in blocks(s) if self.places else ():
                    self._text_end(function, block)
                if isinstance(s, If) and self.flags:
                    self._too_small(s)
                if isinstance(s, If) and self.counts:
                    self._set_back(function, s)
            for block, again in _repeated(function):
                self._sum_alone(function, block, again)
                self._without_orders(function, block, again)
                self._in_a_row(function, block)

    def _tell(self, function: Function, s: Stmt, name: Declaration, message: str) -> None:
        self.reports[function].report(
            function, s.where, "not-begun-again", message, object=name.path, declaration=name
        )  # fmt: skip

    # The time in a state

    def _times(self, function: Function, switch: Switch, state: Variable) -> None:
        """Report tests of a count that lead out of a state which can be entered again."""
        graph = self._graph(function, switch, state)
        if graph is None:
            return
        for labels, body in switch.cases:
            own = set(labels) if labels is not None else graph.keys() - {x for xs, _ in switch.cases for x in xs or ()}
            for s in statements(body):
                if not isinstance(s, If):
                    continue
                for count, branch in _passed(s):
                    to = self._leads(branch, state) if count in self.counts else set()
                    numbers = {value for kind, value in to if kind == "constant"}
                    later = set(reached(numbers, lambda number: graph.get(number, set())))
                    if numbers - own and ANYTHING not in to and own & later:
                        message = (
                            f"nothing begins {count.declaration.name} again: once it has passed this limit, each later "
                            "stay in this state ends at once"
                        )
                        self.reports[function].report(
                            function, s.where, "not-begun-again", message, object=count.declaration.path,
                            declaration=count.declaration,
                        )  # fmt: skip

    def _graph(self, function: Function, switch: Switch, state: Variable) -> dict[int, set[int]] | None:
        """The states, each with those that its case and the statements beside the switch lead to; None: not known."""
        inside = [s for _, body in switch.cases for s in statements(body)]
        by_cases = self._below(inside)
        beside = [s for f in self._elsewhere(function, by_cases) for s in self._again(f)]
        left_out = set(map(id, inside))
        always = self.states.of_statements((s for s in beside if id(s) not in left_out), state, by_cases)
        by_case = [(labels, self._leads(body, state)) for labels, body in switch.cases]
        every = always.union(*(given for _, given in by_case))
        if any(kind != "constant" for kind, _ in every):
            return None
        named_ones = {label for labels, _ in switch.cases for label in labels or ()}
        known = named_ones | {value for _, value in every} | {start_of(state)}
        graph = {label: {value for _, value in always} for label in known}
        for number, (labels, given) in enumerate(by_case):
            body = switch.cases[number][1]
            if body and isinstance(body[-1], FallThrough) and number + 1 < len(by_case):
                given = given | by_case[number + 1][1]
            for label in labels if labels is not None else known - named_ones:
                graph[label] |= {value for _, value in given}
        return graph

    def _elsewhere(self, function: Function, by_cases: set[str]) -> list[Function]:
        """The functions that run again and again, but those that the cases of a switch in `function` call."""
        begin = [f.path for f in self.functions if f.interrupt]
        begin += self._below(s for f in self.functions if f.name == "main" for s in self._again(f))
        repeated = {f.path for f in below(begin, self.own)} - by_cases
        return [f for f in self.functions if f.path in repeated or f.name == "main" or f is function]

    def _below(self, each: Iterable[Stmt]) -> set[str]:
        """The paths of the functions that statements themselves call, directly or not."""
        return {f.path for f in below((path for s in each for path in called(own_nodes(s))), self.own)}

    @staticmethod
    def _again(function: Function) -> list[Stmt]:
        """The statements of a function that run each time; of `main`, those of its loop."""
        loop = last_loop(function) if function.name == "main" else None
        return list(statements(function.body if loop is None else loop.body))

    def _leads(self, body: list[Stmt], state: Variable) -> set[Given]:
        return self.states.of_statements(statements(body), state)

    # The end of a text

    def _text_end(self, function: Function, block: list[Stmt]) -> None:
        """Report a text that is ended where a count says which nothing begins again, and then used."""
        for number, s in enumerate(block):
            match s:
                case Assign(target=LValue(root=Variable(ctype=ArrayType()) as text, indices=[index]), value=value):
                    count = named(index.expr)
                case _:
                    continue
            if count not in self.places or count is None or constant_of(value) != 0:
                continue
            if any(step_of(other, count) is not None for other in block):
                continue  # a text that grows, and is ended anew behind each character
            behind = [each for path in self._below(statements(block)) for each in self.own[path].body]
            if any(assigned(other) is count for other in [*statements(block), *statements(behind)]):
                continue
            used = any(text in _roots_of(p) for later in block[number + 1 :] for p in within([later]) if _passes(p))
            used = used or any(
                text in _roots_of(p) for p in within(behind) if count not in self.counts or _passes(p)
            )
            marks = any(
                isinstance(other, Assign) and constant_of(other.value) not in (None, 0) and assigned(other) is not None
                for other in block
            )  # fmt: skip
            if used and not marks:
                name = count.declaration
                message = f"nothing begins {name.name} again: the next text is appended to this one"
                self._tell(function, s, name, message)

    # What is set back after some time

    def _set_back(self, function: Function, s: If) -> None:
        """Report tests of a count behind which another count is set back, and nothing else: then in each pass."""
        for count, branch in _passed(s):
            back = self._only_sets_back(branch, frozenset({function.path})) if count in self.counts else None
            if back:
                name = count.declaration
                message = (
                    f"nothing begins {name.name} again: once it has passed this limit, "
                    f"{back[0].declaration.name} is set back in each pass"
                )
                self._tell(function, s, name, message)

    def _only_sets_back(self, body: list[Stmt], above: frozenset[str]) -> list[Variable] | None:
        """The counts that statements set to a constant, if they only give constants; None: they do anything else."""
        found: list[Variable] = []
        for s in body:
            match s:
                case Assign(target=LValue(), value=value) if constant_of(value) is not None:
                    v = assigned(s)
                    if v is not None and any((step_of(x, v) or 0) > 0 for x in self.writes[v]):
                        found.append(v)
                case Evaluate(value=Call(function=Function(path=path))) if path in self.own and path not in above:
                    inner = self._only_sets_back(self.own[path].body, above | {path})
                    if inner is None:
                        return None
                    found += inner
                case Return(value=None):
                    pass
                case _:
                    return None
        return found

    def _without_orders(self, function: Function, block: list[Stmt], again: list[Stmt]) -> None:
        """Report a time without orders which no order begins again, and after which the last order is taken back.

            if (Mailbox_pend(orders, &order, BIOS_NO_WAIT)) wanted = order;
            else if (without < LIMIT) without++;
            else wanted = 0;
        """
        for s in block:
            inner = next((x for x in s.otherwise if isinstance(x, If)), None) if isinstance(s, If) else None
            if not isinstance(s, If) or inner is None:
                continue
            for growing, late in ((inner.then, inner.otherwise), (inner.otherwise, inner.then)):
                count = next((v for x in growing if (v := assigned(x)) is not None and step_of(x, v) == 1), None)
                if count is None or count not in _roots_of(inner.test) or not self._only_grows(count, again):
                    continue
                orders = {assigned(x) for x in s.then if isinstance(x, Assign) and not isinstance(bare(x.value), Const)}
                back = next((
                    v for x in late if (v := assigned(x)) in orders and v is not None and isinstance(x, Assign)
                    and isinstance(bare(x.value), Const)
                ), None)  # fmt: skip
                if back is not None:
                    name = count.declaration
                    message = (
                        f"nothing begins {name.name} again: once it has passed this limit, {back.declaration.name} is "
                        "taken back in the first pass behind each new one"
                    )
                    self._tell(function, inner, name, message)

    # What is summed, and counted

    def _sum_alone(self, function: Function, block: list[Stmt], again: list[Stmt]) -> None:
        """Report that after a number of values their sum is begun again, but not their count; or their count alone.

        `again` is what runs again while the locals of the function live.
        """
        sums = {v for s in block if added(s) is not None and (v := assigned(s)) is not None}
        for s in block if sums else ():
            count = _reaches(s.test) if isinstance(s, If) and not leaves(s.then) else None
            if not isinstance(s, If) or count is None or not any(step_of(x, count) == 1 for x in block):
                continue
            if self._tests(count) > 1:
                continue  # `if (count < N)` around it: this happens once, and is meant to
            begun = [v for x in s.then if (v := assigned(x)) is not None and _begins(x)]
            if any(isinstance(x, Assign) and assigned(x) and constant_of(x.value) for x in statements(s.then)):
                continue  # a mark or a state says that it has happened, as a calibration does once
            totals = sums - {count}
            for total in [v for v in begun if v in totals] if self._only_grows(count, again) else ():
                once = isinstance(s.test, Compare) and s.test.op == "=="
                later = "only once" if once else "for each value from then on"
                self._tell_sum(function, s, count, f"though {total.declaration.name} is begun again here: {later}")
            for total in totals if count in begun else ():
                if _mean_of(s, total) and self._only_grows(total, again):
                    why = f"though {count.declaration.name} is begun again here: the next mean has all values"
                    self._tell_sum(function, s, total, why)

    def _only_grows(self, v: Variable, again: list[Stmt]) -> bool:
        """Whether all that gives an object a value, while it lives, adds to it."""
        writes = [s for s in (self.writes[v] if v.kind == "global" else again) if assigned(s) is v]
        return v not in self.taken and bool(writes) and all(added(s) or (step_of(s, v) or 0) > 0 for s in writes)

    def _tell_sum(self, function: Function, s: Stmt, v: Variable, why: str) -> None:
        self._tell(function, s, v.declaration, f"nothing begins {v.declaration.name} again, {why}")

    def _tests(self, v: Variable) -> int:
        """The number of comparisons with an object."""
        return sum(
            isinstance(p, Compare) and any(_value_of(side) is v for side in (p.left, p.right))
            for f in self.functions for p in within(f.body)
        )  # fmt: skip

    # Readings in a row

    def _in_a_row(self, function: Function, block: list[Stmt]) -> None:
        """Report a count of readings that differ from a level, which a reading that does not differ leaves as it is."""
        for number, s in enumerate(block):
            match s:
                case If(test=Compare(op="!=", left=left, right=right), then=differs, otherwise=same):
                    pass
                case If(test=Compare(op="==", left=left, right=right), then=same, otherwise=differs):
                    if not differs and leaves(same):
                        differs = block[number + 1 :]
                case _:
                    continue
            inside = statements(differs)
            for reading, level in ((left, right), (right, left)):
                new, stable = _value_of(reading), _value_of(level)
                if new is None or stable is None:
                    continue
                for x in inside:
                    count = assigned(x)
                    if count is None or count in self.taken or count.kind != "global" or step_of(x, count) != 1:
                        continue
                    within_it = set(map(id, inside))
                    back = [w for w in self.writes[count] if _begins(w)]
                    only_here = all(id(w) in within_it for w in self.writes[count])
                    if back and only_here and self._tests(count) == 1 and _taken_over(differs, count, stable, new):
                        name = count.declaration
                        message = (
                            f"{name.name} counts how often {new.declaration.name} differs from "
                            f"{stable.declaration.name}, and is not begun again where it does not: bounces add up"
                        )
                        self._tell(function, s, name, message)

    # The mark that a buffer was too small

    def _too_small(self, s: If) -> None:
        """Report the tests of a mark that is set where a buffer is full, and that nothing takes back."""
        match s.test:
            case Compare(op="<" | "<=" | "!="):
                fits, full = s.then, s.otherwise
            case Compare(op=">" | ">=" | "=="):
                fits, full = s.otherwise, s.then
            case _:
                return
        index = _against_constant(s.test)
        marks = {v for x in full if (v := assigned(x)) in self.flags}
        if index is None or not marks or not any(step_of(x, index) == 1 for x in statements(fits)):
            return
        again = {f for f in self.functions for x in statements(f.body) if assigned(x) is index and _begins(x)}
        for mark in marks:
            if mark is None or is_latched(mark):
                continue
            for function in self.functions:
                if function not in again:
                    continue
                for test in statements(function.body):
                    if isinstance(test, If) and _refuses(test, mark):
                        name = mark.declaration
                        message = (
                            f"nothing takes {name.name} back, though {index.declaration.name} begins again: once it "
                            "is set, all that follows is refused"
                        )
                        self._tell(function, test, name, message)


def _repeated(function: Function) -> Iterator[tuple[list[Stmt], list[Stmt]]]:
    """Each list of statements of a function, with what runs again while its locals live: the endless loop around it."""
    for s in function.body:
        again = statements(s.body) if isinstance(s, While) and without_end(s) else []
        for block in all_blocks([s]):
            yield block, again
    yield function.body, []


def is_number(v: Variable) -> bool:
    """Whether an object is one integer at file scope (or `static`), and can be changed."""
    return v.kind == "global" and isinstance(v.ctype, IntType) and not v.constant and v.address is None


def step_of(s: Stmt, v: Variable) -> int | None:
    """The constant that a statement adds to an object; None: it does something else."""
    if not isinstance(s, Assign) or assigned(s) is not v:
        return None
    match bare(s.value):
        case Binary(op="+" | "-" as op, left=left, right=right) if (by := constant_of(right)) is not None:
            stepped = bare(left)
            root = stepped.lvalue.root if isinstance(stepped, Load) else None
            # `v++` in an expression: its old value is a temporary of the same declaration.
            old = isinstance(root, Variable) and root.kind == "temporary" and root.declaration == v.declaration
            if root is v or old:
                return by if op == "+" else -by
    return None


def _against_constant(e: Expr) -> Variable | None:
    """The object that a comparison compares with a constant."""
    if not isinstance(e, Compare):
        return None
    for side, other in ((e.left, e.right), (e.right, e.left)):
        if constant_of(other) is not None:
            return named(side)
    return None


def _passed(s: If) -> Iterator[tuple[Variable, list[Stmt]]]:
    """The counts whose passing of a limit alone decides a test, each with the statements that run then."""
    tests = s.test.operands if isinstance(s.test, Logic) and s.test.op == "or" else [s.test]
    for test in tests:
        count = _against_constant(test)
        if not isinstance(test, Compare) or count is None:
            continue
        rises = test.op in (">", ">=") if named(test.left) is count else test.op in ("<", "<=")
        falls = test.op in ("<", "<=") if named(test.left) is count else test.op in (">", ">=")
        if rises:
            yield count, s.then
        elif falls and test is s.test:
            yield count, s.otherwise


def _reaches(test: Expr) -> Variable | None:
    """The integer of any kind that a test finds at or beyond a constant."""
    match test:
        case (
            Compare(op="==" | ">" | ">=", left=side, right=limit)
            | Compare(op="==" | "<" | "<=", right=side, left=limit)
        ):
            return _value_of(side) if constant_of(limit) is not None else None
    return None


def _value_of(e: Expr) -> Variable | None:
    """The integer of any kind of which an expression is just the value."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(ctype=IntType()) as v, indices=[])):
            return v
    return None


def _mean_of(s: If, total: Variable) -> bool:
    """Whether a test of a count against a number divides a sum by this number."""
    assert isinstance(s.test, Compare)
    limit = constant_of(s.test.left) or constant_of(s.test.right)
    for p in within(s.then):
        match p:
            case Binary(op="/" | ">>" as op, left=left, right=right) if _is_sum(left, total):
                by = constant_of(right)
                if by is not None and limit == (by if op == "/" else 1 << by):
                    return True
    return False


def _is_sum(e: Expr, total: Variable) -> bool:
    match bare(e):
        case Load(lvalue=LValue(root=root, indices=[])):
            return root is total
    return False


def _taken_over(differs: list[Stmt], count: Variable, level: Variable, reading: Variable) -> bool:
    """Whether a level becomes the reading, and only where a count has passed a limit."""
    for number, s in enumerate(differs):
        match s:
            case If(test=Compare(left=left, right=right), then=then) if count in (_value_of(left), _value_of(right)):
                rest = differs[number + 1 :] if leaves(then) else then
                return any(_copies(x, level, reading) for x in statements(rest))
        if any(_copies(x, level, reading) for x in statements([s])):
            return False
    return False


def _copies(s: Stmt, to: Variable, value: Variable) -> bool:
    """Whether a statement gives one object the value of another."""
    return isinstance(s, Assign) and assigned(s) is to and _value_of(s.value) is value


def _roots_of(e: Any) -> set[Variable]:
    return {p.root for p in parts(e) if isinstance(p, LValue) and isinstance(p.root, Variable)}


def _passes(e: Any) -> bool:
    return isinstance(e, Call)


def _begins(s: Stmt) -> bool:
    return isinstance(s, Assign) and constant_of(s.value) is not None


def _refuses(s: If, mark: Variable) -> bool:
    """Whether a mark alone decides that what a test else leads to, which calls a function, does not happen."""
    test = s.test
    tests = test.operands if isinstance(test, Logic) else [test]
    turned = isinstance(test, Logic) and test.op == "and"
    for one in tests:
        negated = isinstance(one, Not)
        inner = one.operand if isinstance(one, Not) else one
        if isinstance(inner, Compare) and _against_constant(inner) is mark:
            zero = 0 in (constant_of(inner.left), constant_of(inner.right))
            negated ^= (inner.op == "==") == zero
        elif named(inner) is not mark:
            continue
        if len(tests) > 1 and negated != turned:
            continue
        kept = s.then if negated else s.otherwise
        return any(map(runs_function, statements(kept)))
    return False


def is_latched(v: Variable) -> bool:
    """Whether the name of a flag, or the comment in its line, says that it is meant to stay."""
    line = line_of(v.declaration) or v.declaration.name
    return _LATCHED.search(line) is not None
