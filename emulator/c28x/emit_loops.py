"""From typed tree to Python text: loops.

A `for` over a plain local with an invariant bound becomes Python's own; any other is written as C defines it.  A loop
that only polls is carried from event to event.
"""

from __future__ import annotations

import re
from abc import abstractmethod
from types import FunctionType
from typing import Any, Final

from emulator.c28x import costs
from emulator.c28x.ctypes import INT, IntType, usual
from emulator.c28x.emit_expressions import ExpressionEmitter
from emulator.c28x.emit_needs import Needs, Options
from emulator.c28x.tree import (
    Compare,
    Const,
    Convert,
    Expr,
    For,
    Function,
    Load,
    LValue,
    RegisterLoad,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    calls,
    changed_names,
    computes_alone,
    identifiers,
    observable,
    parts,
    source_text,
)  # fmt: skip
from emulator.clock import Clock

State = set[Any] | None

#: How time is charged: a compiled clock is fastest called, an interpreted one where its attributes are used in place.
CALLED: Final = not isinstance(Clock.charge, FunctionType)
CHARGE: Final = re.compile(r"(?:_k\.now \+= |_k\.charge\()(\d+)\)?")


def meet(*states: State) -> State:
    """What is written on every way that arrives (None is a way that does not)."""
    arriving = [s for s in states if s is not None]
    return set.intersection(*arriving) if arriving else None


class LoopEmitter(ExpressionEmitter):
    """Loop part of the emitter of one function."""

    def __init__(self, function: Function, needs: Needs, options: Options) -> None:
        super().__init__(function, needs, options)
        self.lines: list[tuple[str, int]] = []
        self.depth = 0
        self.line = function.line
        #: On the cycles of the cost table.
        self.factor = 1.0
        self.loops: list[tuple[list[State], list[State]]] = []
        #: For each loop around: what `continue` must do first, and what it costs.
        self.continue_text: list[tuple[str | None, int]] = []
        self.live: list[Variable] = []

    # Text

    @abstractmethod
    def block(self, body: list[Stmt]) -> None:
        """Write statements."""

    @abstractmethod
    def written(self, variable: Variable, key: Any = None) -> None:
        """`variable` (or the element `key`) has just been written."""

    def put(self, text: str) -> None:
        self.lines.append(("    " * self.depth + text, self.line))

    def stand(self, kind: str = "") -> None:
        """Say where the firmware is; `kind` as in `Place`."""
        self.put(f"_p.at = {self.place_number(kind)}")

    def flush(self) -> None:
        """Charge what has been executed so far."""
        if self.cost:
            self.stand()
            cycles = max(1, round(self.cost * self.factor))
            if CALLED:
                self.put(f"_k.charge({cycles})")
            else:
                self.put(f"_k.now += {cycles}")
                self.put("if _k.now >= _k.next: _k.run_due()")
            self.cost = 0

    def while_loop(self, s: While) -> None:
        self.forget_changed(s.body)
        pure_poll = not s.body and not calls(s.test)
        self.flush()
        test = self.condition(s.test)
        test_cost = self.cost + costs.LOOP
        self.cost = 0
        if pure_poll:
            cycles = max(1, round(test_cost * self.factor))
            site = self.site(IntType("int", 16, True, 2), self.polled(s.test))
            self.stand("poll")
            if isinstance(s.test, Const) and s.test.value != 0:  # The CPU waits for interrupts.
                self.put("while True:")
                self.put(f"    if not _k.poll({cycles}): _c_poll({site}, _k.now)")
                self.assigned = None
                return
            self.put("_since = _k.now + _c_poll_limit")
            self.put(f"while {test}:")
            self.put(f"    if not _k.poll({cycles}) or _k.now > _since: _since = _c_poll({site}, _since)")
            self.cost = test_cost
            return
        endless = isinstance(s.test, Const) and s.test.value != 0
        if not endless:
            self.cost = test_cost
            self.flush()
        alone = self.checked and computes_alone(s)
        if alone:
            self.put(f"_e{self.depth} = _k.now + _c_loop_limit")
        self.put(f"while {test}:")
        entry = None if self.assigned is None else set(self.assigned)
        self.loops.append(([], []))
        self.continue_text.append((None, test_cost))
        self.depth += 1
        if alone:
            self.put(f"if _k.now > _e{self.depth - 1}: _c_endless({self.site(INT, source_text(s.test))})")
        self.block(s.body)
        self.line = s.line
        self.cost += test_cost
        self.flush()
        self.depth -= 1
        breaks, _ = self.loops.pop()
        self.continue_text.pop()
        self.assigned = meet(*breaks) if endless else meet(entry, *breaks)

    def polled(self, test: Expr) -> str:
        """The register or object that a poll looks at."""
        for part in parts(test):
            if isinstance(part, RegisterLoad):
                ref = part.register
                return f"{ref.block}.{ref.register}" + (f".bit.{ref.field.name}" if ref.field else "")
            if isinstance(part, LValue) and isinstance(part.root, Variable):
                return part.root.declaration.path
        return "condition"

    def forget_changed(self, body: list[Stmt]) -> None:
        """At a loop's head nothing is known of elements whose index the body changes."""
        names = changed_names(body)
        if self.assigned is not None:
            self.assigned = {k for k in self.assigned if not (isinstance(k, tuple) and names & identifiers(k[1]))}
        self.ranges = {v: r for v, r in self.ranges.items() if v.name not in names}

    def for_loop(self, s: For) -> None:
        root = s.variable.root
        assert isinstance(root, Variable)
        changed = changed_names(s.body)
        stop_names = {p.root.name for p in parts(s.stop) if isinstance(p, LValue) and isinstance(p.root, Variable)}
        simple = (
            not root.in_memory and root.kind != "global" and root.name not in changed and not observable(s.stop)
            and not (stop_names & (changed | {root.name})) and not any(
                isinstance(p, LValue) and isinstance(p.root, Variable) and p.root.in_memory and p.root.escapes
                for p in parts(s.stop)
            )
        )  # fmt: skip
        start_text, stop_text = self.value(s.start), self.value(s.stop)
        self.forget_changed(s.body)
        trips: range | None = None
        if isinstance(s.start, Const) and isinstance(s.stop, Const):
            trips = range(int(s.start.value), int(s.stop.value), s.step)
        self.flush()
        if not simple or not self.counts_plainly(s, root, trips):
            self.for_general(s, root, start_text)
            return
        if not isinstance(s.start, Const):
            # Evaluated once: the body may change what it depends on.
            self.put(f"_a{self.depth} = {start_text}")
            start_text = f"_a{self.depth}"
        self.put(f"{root.name} = {start_text}")
        self.written(root)
        start_low, start_high = self.interval(s.start)
        stop_low, stop_high = self.interval(s.stop)
        if s.step > 0:
            self.ranges[root] = (start_low, max(start_low, stop_high - 1))
        else:
            self.ranges[root] = (min(start_high, stop_low + 1), start_high)
        step = f", {s.step}" if s.step != 1 else ""
        self.put(f"for {root.name} in _range({start_text}, {stop_text}{step}):")
        entry = None if self.assigned is None else set(self.assigned)
        self.loops.append(([], []))
        turn_cost = costs.LOOP + costs.COMPARE + costs.INT_OP
        self.continue_text.append((None, turn_cost))
        self.depth += 1
        first = len(self.lines)
        self.block(s.body)
        self.line = s.line
        self.cost += turn_cost
        first = min(first + 1, len(self.lines) - 1)
        text, line = self.lines[first]
        charge = CHARGE.fullmatch(text, 4 * self.depth)
        if charge is not None and self.assigned is not None:
            # One charge a turn: the end of a turn is charged with the beginning of the next.
            cycles = int(charge[1]) + max(1, round(self.cost * self.factor))
            self.lines[first] = (text.replace(charge[1], str(cycles)), line)
            self.cost = 0
        self.flush()
        self.depth -= 1
        end = self.assigned
        breaks, continues = self.loops.pop()
        self.continue_text.pop()
        # Behind the loop C's variable holds the first value that failed the test.
        if trips is not None:
            final = str(trips[-1] + s.step) if trips else start_text
        elif s.step == 1:
            final = f"_max({start_text}, {stop_text})"
        else:
            final = f"{start_text} + _len(_range({start_text}, {stop_text}{step})) * {s.step}"
        self.put("else:")
        self.put(f"    {root.name} = {final}")
        del self.ranges[root]
        self.assigned = meet(end, *continues, *breaks) if trips else meet(entry, end, *breaks)
        self.written(root)

    def counts_plainly(self, s: For, root: Variable, trips: range | None) -> bool:
        """Whether no conversion of the test matters and the variable can hold the value behind the loop."""
        if not isinstance(s.stop.ctype, IntType) or not isinstance(root.ctype, IntType):
            return False
        common = usual(root.ctype, s.stop.ctype)
        assert isinstance(common, IntType)
        (start_low, _), (stop_low, stop_high) = self.interval(s.start), self.interval(s.stop)
        if min(start_low, stop_low) < common.low:
            return False
        if trips is not None:
            return not trips or root.ctype.low <= trips[-1] + s.step <= root.ctype.high
        return stop_high + s.step - 1 <= root.ctype.high if s.step > 0 else stop_low + s.step + 1 >= root.ctype.low

    def for_general(self, s: For, root: Variable, start_text: str) -> None:
        """A for whose variable or bound is changed, shared or may wrap: written as C defines it."""
        data = root.name if not root.in_memory and root.kind != "global" else f"{self.base(root)}[{s.variable.leaf}]"
        assert isinstance(root.ctype, IntType)
        self.put(f"{data} = {start_text}")
        if self.watched(root):
            self.put(self.touch(root, str(s.variable.words), write=True))
        self.written(root)
        common = usual(root.ctype, s.stop.ctype)
        variable = Load(root.ctype, s.variable)
        test = self.condition(
            Compare(INT, "<" if s.step > 0 else ">", Convert(common, variable), Convert(common, s.stop))
        )
        test_cost = self.cost + costs.LOOP
        self.cost = 0
        alone = self.checked and computes_alone(s)
        if alone:
            self.put(f"_e{self.depth} = _k.now + _c_loop_limit")
        self.put(f"while {test}:")
        site = self.site(root.ctype, root.declaration.path, root.declaration)
        low, high = root.ctype.low, root.ctype.high
        if root.ctype.signed and self.checked:
            step = f"{data} = _t if {low} <= (_t := {data} + {s.step}) <= {high} else _c_overflow(_t, {site})"
        elif root.ctype.signed:
            step = f"{data} = (({data} + {s.step - low}) & {high - low}) + {low}"
        else:
            step = f"{data} = {data} + {s.step} & {high}"
        if self.watched(root):
            word = s.variable.words
            step = f"{self.touch(root, str(word), write=False)}; {self.touch(root, str(word), write=True)}; {step}"
        entry = None if self.assigned is None else set(self.assigned)
        self.loops.append(([], []))
        self.continue_text.append((step, test_cost))
        self.depth += 1
        if alone:
            text = f"{root.declaration.name} {'<' if s.step > 0 else '>'} {source_text(s.stop)}"
            self.put(f"if _k.now > _e{self.depth - 1}: _c_endless({self.site(INT, text)})")
        self.block(s.body)
        self.line = s.line
        self.cost += test_cost
        self.flush()
        self.put(step)
        self.depth -= 1
        breaks, _ = self.loops.pop()
        self.continue_text.pop()
        self.assigned = meet(entry, *breaks)
        self.written(root)
