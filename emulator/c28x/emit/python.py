"""The writer of Python: one visitor over the annotated tree of a function.

Every C expression becomes one Python expression.  Cycles are charged in batches, always *before* a statement that
others could notice (it accesses a register or a file-scope object, or calls a function).  So a task can be pre-empted
before every such statement.  The number of the statement is stored with the charge, so that whatever comes in between
knows where the firmware is.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Final

from emulator.c28x.ctypes import (
    VOID,
    CType,
    Double64,
    FloatType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    StructType,
    pointed,
)  # fmt: skip
from emulator.c28x.emit.lines import Begin, Charge, EmittedLine, Exit, Item, LineEntry, printed
from emulator.c28x.emit.names import FunctionNames, escaped, local_name, object_name
from emulator.c28x.emit.written import FIRST_NUMBER, EmittedFunction
from emulator.c28x.options import CompileOptions
from emulator.c28x.passes.costs import CALL, TURN, Costs
from emulator.c28x.passes.fields import or_terms
from emulator.c28x.passes.guards import (
    cut_to_int,
    mathematical_bounds,
    mathematical_constant,
    octet_range,
    wraps,
)  # fmt: skip
from emulator.c28x.passes.idle_turns import IdleCalls, idle_turns
from emulator.c28x.passes.intervals import bounds_of
from emulator.c28x.sites import Place, Site
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    Continue,
    Convert,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    Field,
    For,
    Function,
    FunctionRef,
    Guard,
    If,
    Index,
    Jump,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Not,
    Null,
    PointerAdd,
    PointerDifference,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    String,
    Switch,
    Unary,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    INSTRUCTIONS,
    executes,
    leaves,
    observable,
    parts,
    passing,
    polls,
    renewed,
    visible_to_others,
    whole_target,
)  # fmt: skip

#: The largest number of cases in one `if` ... `elif` chain of a switch.
CHOICES: Final = 32


@dataclass(slots=True)
class _Breakable:
    """An enclosing loop, or an enclosing switch that is written as a loop.

    `carries_on` and `ends` are flags of such a switch: a `continue` or `break` of the loop around has left it.  A loop
    has none.  `used` contains the flags that are needed.
    """

    loop: While | For | None
    carries_on: str = ""
    ends: str = ""
    used: set[str] = field(default_factory=set)
    #: The label of such a switch; the labels of those around that a `goto` from within ends.
    label: str = ""
    jumps: set[str] = field(default_factory=set)


class PythonWriter:
    """Writes one function.

    `costs` has put the cycles on its statements, `factor` scales them.  `idle` is the result of `idle_calls`.
    """

    def __init__(
        self, function: Function, names: FunctionNames, options: CompileOptions, *, costs: Costs, factor: float,
        idle: IdleCalls,
    ) -> None:  # fmt: skip
        self.function = function
        self.names = names
        self.options = options
        self.costs = costs
        self.factor = factor
        #: A function leaves its locals behind when it returns.
        self.spills = options.residue or options.keep_locals
        self.items: list[Item] = []
        self.depth = 0
        self.where = function.where
        self.cost = 0
        self.uses_clock = False
        self.places: list[tuple[Place, Site | None]] = []
        self.statements: dict[Where, int] = {}
        #: Identity of each counted statement (and of the function) -> its counter; the places by counter.
        self.counters: dict[int, int] = {}
        self.counted: list[Where] = []
        #: Nobody else sees the effects of the present statement.
        self.passing = False
        #: The value of `_p.at` at this point; 0: not known.
        self.stored_place = 0
        self.fresh = 0
        self.around: list[_Breakable] = []
        #: Label -> the flag that a `goto` from within another loop or switch has set.
        self.jump_flags: dict[str, str] = {}
        #: The loops with turns that time may skip, and what ends the idleness of a turn.  Nobody stops there.
        self.idle_loops, self.busy, self.busy_calls = (
            idle_turns(function, idle) if options.watch and not options.steps else ({}, {}, set[int]())
        )
        #: Identity of a loop -> the variable with the beginning of its turn, and the text of its time limit.
        self.turn_of: dict[int, str] = {}
        self.limits: dict[int, str] = {}

    def write(self) -> EmittedFunction:
        """The whole function."""
        f = self.function
        listed = f.parameters if f.given is None else [*f.parameters, f.given]
        self.put(f"def {escaped(f.name)}({', '.join(map(local_name, listed))}):")
        self.depth = 1
        self.items.append(LineEntry(1, self.where.line))
        self.begin(f, f.where)
        self.prologue()
        self.cost += CALL
        self.block(f.body)
        if f.ends:
            if f.ctype.result == VOID:
                self.leave(None)
            else:
                # The function ends without the value that it must return: the caller gets what the register held.
                self.leave(f"_c_uninit({self.number(f.owing)})")
        by_call = self.options.charge_by_call
        lines = printed(self.items, places=bool(self.places), clock=self.uses_clock, charge_by_call=by_call)
        text = "\n".join(line for line, _ in lines)
        numbers = tuple(number for _, number in lines)
        return EmittedFunction(text, numbers, tuple(self.places), self.names, tuple(self.counted))

    # Places

    def number(self, guard: Guard | None) -> int:
        """Add the place of a check and return its number."""
        assert guard is not None
        return self.place(guard.site.where, guard.site)

    def place(self, where: Where, site: Site | None = None, kind: str = "") -> int:
        f = self.function
        self.places.append((Place(where.file, where.line, f.name, f.c_file, where.column, kind), site))
        return FIRST_NUMBER + len(self.places) - 1

    def here(self) -> int:
        """The number of the present statement."""
        return self.statement_at(self.where)

    def statement_at(self, where: Where) -> int:
        if where not in self.statements:
            self.statements[where] = self.place(where)
        return self.statements[where]

    # Lines and time

    def put(self, text: str) -> None:
        self.items.append(EmittedLine(self.depth, self.where.line, text))

    def begin(self, what: Function | Stmt, where: Where) -> None:
        """Write the start of a statement, or of the function: count it, and stop there, if the options ask for it."""
        texts = []
        if self.options.coverage:
            counter = self.counters.setdefault(id(what), len(self.counted))
            if counter == len(self.counted):
                self.counted.append(where)
            texts.append(f"{self.names.counters}[{counter}] += 1")
        if self.options.steps and isinstance(what, Stmt):
            self.stored_place = self.statement_at(where)
            texts += [f"_p.at = {self.stored_place}", "if _p.hold: _p.hold(locals())"]
        if self.options.follow and isinstance(what, Stmt):
            self.stored_place = self.statement_at(where)
            followed = self.names.constant("t", what, ("followed", id(what)))
            texts += [f"_p.at = {self.stored_place}", f"_p.follow({followed}, locals())"]
        if texts:
            self.items.append(Begin(self.depth, where.line, tuple(texts)))

    def place_to_store(self) -> int:
        """The number to store in `_p.at` before others see what comes next; 0 if it is already there."""
        number = self.here()
        if number == self.stored_place:
            return 0
        self.stored_place = number
        return number

    def flush(self) -> None:
        """Charge the cycles executed so far."""
        if self.cost:
            self.charge(self.cost)
            self.cost = 0

    def charge(self, cost: int) -> None:
        self.uses_clock = True
        at = self.place_to_store()
        if at and self.passing:
            self.stored_place = 0
        self.items.append(Charge(self.depth, self.where.line, self.scaled(cost), at, self.passing))

    def scaled(self, cost: int) -> int:
        return max(1, round(cost * self.factor))

    # The function

    def prologue(self) -> None:
        f = self.function
        if f.frame_words:
            self.put("_fp = _cpu.sp")
            self.put(f"_cpu.sp = _fp + {f.frame_words}")
            self.put(f"if _cpu.sp > _cpu.stack_limit: _c_stack_check({self.here()})")
        for variable in f.parameters:
            if variable.in_memory and not isinstance(variable.ctype, StructType):
                name = local_name(variable)
                self.put(f"{name} = [{name}]")
        for variable in f.locals:
            if variable.kind == "temporary":
                continue
            name = local_name(variable)
            if variable.unwritten and renewed(variable):
                self.put(f"_old_{name} = None")
            if variable.in_memory:
                count = variable.ctype.leaves
                self.put(f"{name} = [None] * {count}" if count > 1 else f"{name} = [None]")
            elif variable.unwritten or self.spills or self.options.steps or self.options.follow:
                # A look at the locals, at a return or at any statement, must find all of them.
                self.put(f"{name} = None")
        for variable in f.live:
            declared = self.names.constant("t", variable.declaration, ("declared", id(variable)))
            name = local_name(variable)
            self.put(f"_p_{name} = _c_enter({declared}, {name}, _fp + {variable.frame_offset})")

    def leave(self, value: str | None) -> None:
        """Return `value` and release the frame."""
        self.flush()
        f = self.function
        if value is not None and (f.frame_words or self.spills):
            self.put(f"_v = {value}")
            value = "_v"
        if self.spills:
            spilled = [v for v in f.locals if v.kind != "temporary"]
            what = self.names.constant("t", (f.path, spilled), "spilled")
            named = "".join(f"{local_name(v)}, " for v in spilled)
            self.put(f"_c_spill({what}, {'_fp' if f.frame_words else 'None'}, ({named}))")
        for variable in f.live:
            self.put(f"_c_retire(_p_{local_name(variable)})")
        if f.frame_words:
            self.put("_cpu.sp = _fp")
        self.items.append(Exit(self.depth, self.where.line, value))

    # Statements

    def block(self, body: list[Stmt]) -> None:
        """Write statements.  Unreachable ones are written too: they cost nothing."""
        start = len(self.items)
        for s in body:
            self.where = s.where
            self.passing = not self.options.watch and passing(s)
            for loop in self.busy.get(id(s), ()):
                if loop in self.turn_of:
                    self.put(f"{self.turn_of[loop]} = -1")
            if id(s) in self.busy_calls:
                self.put("_c_busy()")
            if executes(s):
                self.begin(s, s.where)
            self.statement(s)
            self.passing = False
        if len(self.items) == start:
            self.put("pass")

    def statement(self, s: Stmt) -> None:
        match s:
            case Assign():
                if s.takes:
                    self.statements.setdefault(s.where, self.place(s.where, kind="takes"))
                self.assign(s)
            case CopyStruct():
                self.copy_struct(s)
            case Declare():
                self.declare(s)
            case Evaluate(value=Call(function=Function(extern=True, name=name))) if name in INSTRUCTIONS:
                self.cost += s.cycles
                self.put("_cpu.eallow = True" if name == "EALLOW" else f"_cpu.edis({self.statement_at(s.where)})")
            case Evaluate(value=value):
                self.cost += s.cycles
                text = self.value(value)
                self.flush()
                self.put(text)
            case If():
                self.if_statement(s)
            case While():
                self.while_loop(s)
            case For():
                self.for_loop(s)
            case Switch():
                self.switch(s)
            case Return(value=value):
                self.cost += s.cycles
                result = None if value is None else self.value(value)
                if value is not None and observable(value):
                    self.flush()
                self.leave(result)
            case Break():
                self.flush()
                self.break_loop()
            case Continue():
                self.continue_turn(s.where)
            case Jump(label=label):
                self.flush()
                self.jump(label)
            case LeaveSwitch():
                self.flush()
                self.put("break")
            case FallThrough():
                self.flush()

    def if_statement(self, s: If) -> None:
        test = self.condition(s.test)
        self.cost += s.cycles
        if observable(s.test) or any(visible_to_others(b) and not leaves(b) for b in (s.then, s.otherwise)):
            self.flush()
        carried, self.cost = self.cost, 0
        self.put(f"if {test}:")
        # Cycles executed so far are charged behind the `if`; a branch that does not get there charges them itself.
        self.branch(s.then, carried if leaves(s.then) else 0)
        if s.otherwise:
            self.put("else:")
            self.branch(s.otherwise, carried if leaves(s.otherwise) else 0)
        self.cost = carried

    def branch(self, body: list[Stmt], cost: int = 0) -> None:
        """Write an inner block, whose end may continue behind the statement."""
        self.cost = cost
        where, stored_place = self.where, self.stored_place
        self.depth += 1
        self.block(body)
        if not leaves(body):
            self.flush()
        self.cost = 0
        self.depth -= 1
        self.where = where
        if self.stored_place != stored_place:
            self.stored_place = 0

    def switch(self, s: Switch) -> None:
        if s.only_block:
            self.block_before_label(s)
            return
        subject = self.value(s.subject)
        self.cost += s.cycles
        self.flush()
        self.put(f"_w = {subject}")
        inner = (each for _, body in s.cases for each in own_statements(body))
        if s.label or any(isinstance(each, LeaveSwitch | FallThrough) for each in inner):
            self.switch_at_large(s)
            return
        # Cases that do not fall through may come in any order: the default is last.
        none = f"_c_no_case(_w, {self.number(s.guard)})" if s.guard is not None else ""
        self.choice(sorted(s.cases, key=lambda case: case[0] is None), none)

    def choice(self, cases: list[tuple[list[int] | None, list[Stmt]]], none: str) -> None:
        """Write the choice of a case by `_w`, else `none`.  Many cases are halved: Python's parser nests `elif`."""
        if len(cases) > CHOICES:
            half = len(cases) // 2
            labels = frozenset(label for values, _ in cases[:half] for label in values or ())
            self.put(f"if _w in {self.names.constant('k', labels, ('labels', labels))}:")
            self.depth += 1
            self.choice(cases[:half], "")
            self.depth -= 1
            self.put("else:")
            self.depth += 1
            self.choice(cases[half:], none)
            self.depth -= 1
            return
        word = "if"
        for values, body in cases:
            if values is None:
                self.put("else:" if word == "elif" else "if True:")
            else:
                self.put(f"{word} {_labels(values)}:")
            word = "elif"
            self.branch(body)
        if none:
            self.put(f"else: {none}")

    def switch_at_large(self, s: Switch) -> None:
        """Write a switch with inner `break`s or with fall-through, as a loop that is entered at a case."""
        self.fresh += 1
        entered = f"_e{self.fresh}"
        default = next((i for i, (values, _) in enumerate(s.cases) if values is None), len(s.cases))
        chosen = str(default)
        if len(s.cases) > CHOICES:
            entries = {label: i for i, (values, _) in reversed(list(enumerate(s.cases))) for label in values or ()}
            chosen = f"{self.names.constant('k', entries, ('entries', id(s)))}.get(_w, {default})"
        else:
            for i, (values, _) in reversed(list(enumerate(s.cases))):
                if values is not None:
                    chosen = f"{i} if {_labels(values)} else {chosen}"
        self.put(f"{entered} = {chosen}")
        if s.guard is not None:
            self.put(f"if {entered} == {default}: _c_no_case(_w, {self.number(s.guard)})")
        with self.left_at_large(s):
            self.depth += 1
            for i, (_, body) in enumerate(s.cases):
                self.put(f"if {entered} <= {i}:")
                self.branch(body)
                if not leaves(body) and not (body and isinstance(body[-1], FallThrough)):
                    self.put("    break")
                self.stored_place = 0
            self.put("break")
            self.depth -= 1

    def block_before_label(self, s: Switch) -> None:
        """Write the statements before a label, as a loop of one turn."""
        self.flush()
        self.fresh += 1
        (_, body), = s.cases
        with self.left_at_large(s):
            self.branch(body)
            if not leaves(body):
                self.put("    break")

    @contextmanager
    def left_at_large(self, s: Switch) -> Iterator[None]:
        """Write a switch as a loop, and behind it what else has ended in it; its body is written meanwhile."""
        around = _Breakable(None, f"_g{self.fresh}", f"_b{self.fresh}", label=s.label)
        self.around.append(around)
        start = len(self.items)
        self.put("while True:")
        yield
        self.around.pop()
        self.stored_place = 0
        if around.label in self.jump_flags:
            name = self.jump_flags[around.label]
            self.items.insert(start, EmittedLine(self.depth, s.where.line, f"{name} = False"))
        for name in sorted(around.used):
            self.items.insert(start, EmittedLine(self.depth, s.where.line, f"{name} = False"))
            self.put(f"if {name}:")
            self.depth += 1
            self.continue_turn(s.where) if name == around.carries_on else self.break_loop()
            self.depth -= 1
        self.jump_on(around)

    def jump(self, label: str) -> None:
        """`goto` to the end of a switch: it first leaves the loops and switches within."""
        if self.around[-1].label != label:
            self.around[-1].jumps.add(label)
            name = self.jump_flags.setdefault(label, f"_j{len(self.jump_flags)}")
            self.put(f"{name} = True")
        self.put("break")

    def jump_on(self, around: _Breakable) -> None:
        """Write what follows a loop or switch that a `goto` may have left."""
        for label in sorted(around.jumps):
            self.put(f"if {self.jump_flags[label]}: break")
            if self.around[-1].label != label:
                self.around[-1].jumps.add(label)

    # Loops

    def continue_turn(self, where: Where) -> None:
        """`continue`: first do what comes before the test, then charge the time of the test."""
        around = self.around[-1]
        loop = around.loop
        if loop is None:
            self.flush()
            around.used.add(around.carries_on)
            self.put(f"{around.carries_on} = True")
            self.put("break")
            return
        self.end_of_turn(loop)
        if isinstance(loop, While) and not loop.first:
            self.put(f"if {self.condition(loop.test)}: continue")
            self.put("break")
        else:
            self.put("continue")

    def break_loop(self) -> None:
        """`break` of the enclosing loop; it first leaves the switches within, which are written as loops."""
        around = self.around[-1] if self.around else None
        if around is not None and around.loop is None:
            around.used.add(around.ends)
            self.put(f"{around.ends} = True")
        self.put("break")

    def end_of_turn(self, loop: While | For) -> None:
        """Write what comes before the next evaluation of the test, and charge the time of the test."""
        where = self.where
        self.begin(loop, loop.where if isinstance(loop, For) or loop.first else loop.test.where)
        if isinstance(loop, For) and loop.test is None:
            self.cost += TURN
            self.flush()
            return
        if isinstance(loop, While) and loop.step:
            for s in loop.step:
                self.where = s.where
                self.begin(s, s.where)
                self.statement(s)
            self.where = loop.where
        self.cost += loop.cycles
        self.flush()
        if id(loop) in self.idle_loops:
            began = self.turn_of[id(loop)]
            idle = " and ".join(
                [f"{began} >= 0", *(self.names.register(ref, "steady") for ref in self.idle_loops[id(loop)])]
            )
            self.put(f"if {idle}: _c_turn({began}, {self.limits.get(id(loop), '_c_NEVER')})")
        self.where = where
        if isinstance(loop, For):
            self.step(loop)

    def while_loop(self, s: While) -> None:
        self.flush()
        if polls(s):
            self.poll(s)
            return
        endless = isinstance(s.test, Const) and s.test.value != 0
        if not endless and s.first:
            self.cost = s.cycles
            self.flush()
        self.put_loop_limit(s)
        self.put(f"while {self.condition(s.test)}:" if s.first else "while True:")
        self.turns(s, s.body)
        self.where = s.where
        if s.first:
            self.end_of_turn(s)
        elif not leaves(s.body):
            self.end_of_turn(s)
            self.put(f"if not {self.condition(s.test)}: break")
        self.depth -= 1
        around = self.around.pop()
        self.stored_place = 0
        self.jump_on(around)

    def put_loop_limit(self, loop: While | For) -> None:
        """Write the time limit of a loop that nobody else can end."""
        if loop.endless is not None:
            self.uses_clock = True
            self.put(f"_e{self.depth}_ = _k.now + _c_loop_limit")
            self.limits[id(loop)] = f"_e{self.depth}_"

    def turns(self, loop: While | For, body: list[Stmt]) -> None:
        """Write the body of a loop; the caller writes the end of its turn."""
        self.around.append(_Breakable(loop))
        self.depth += 1
        self.stored_place = 0
        if loop.endless is not None:
            self.put(f"if _k.now > _e{self.depth - 1}_: _c_endless({self.number(loop.endless)})")
        if id(loop) in self.idle_loops:
            self.uses_clock = True
            self.turn_of[id(loop)] = f"_q{len(self.turn_of)}_"
            self.put(f"{self.turn_of[id(loop)]} = _k.now")
        self.block(body)

    def poll(self, s: While) -> None:
        """Write a loop that only evaluates its condition: it advances from event to event."""
        assert s.endless is not None
        self.uses_clock = True
        cycles = self.scaled(s.cycles)
        idles = isinstance(s.test, Const) and s.test.value != 0
        number = self.stored_place = self.place(s.where, s.endless.site, "idle" if idles else "poll")
        self.put(f"_p.at = {number}")
        test = self.condition(s.test)
        self.cost = 0
        if idles:  # The CPU waits for interrupts.
            self.put("while True:")
            self.put(f"    if _k.poll({cycles}) == _c_NEVER: _c_idle({number})")
            return
        unmodelled = any(
            isinstance(p, RegisterLoad) and isinstance(p.register, RegisterRef) and p.register.unmodelled
            for p in parts(s.test)
        )
        self.put(f"_since = _k.now + _c_{'unmodelled_wait' if unmodelled else 'poll_limit'}")
        self.put(f"while {test}:")
        self.put(f"    if _k.poll({cycles}) > _since: _since = _c_poll({number}, _since)")
        self.cost = s.cycles

    def for_loop(self, s: For) -> None:
        if s.test is not None:
            self.counting_at_large(s)
            return
        start, stop = self.value(s.start), self.value(s.stop)
        self.cost += s.cycles
        self.flush()
        if not isinstance(s.start, Const):
            # The start is evaluated once: the body may change its operands.
            self.put(f"_a{self.depth} = {start}")
            start = f"_a{self.depth}"
        name = local_name(s.counter)
        step = f", {s.step}" if s.step != 1 else ""
        if not s.trips:  # else the Python loop sets the first value
            self.put(f"{name} = {start}")
        self.put(f"for {name} in _range({start}, {stop}{step}):")
        first = len(self.items)
        self.turns(s, s.body)
        self.where = s.where
        if s.turns:
            self.begin(s, s.where)
        charge = next(item for item in self.items[first:] if not isinstance(item, Begin))
        if isinstance(charge, Charge) and charge.depth == self.depth and s.turns:
            # One charge a turn: the end of a turn is charged with the beginning of the next.
            charge.cycles += self.scaled(self.cost + TURN)
            self.cost = 0
        elif s.turns:
            self.cost += TURN
            self.flush()
        self.cost = 0
        self.depth -= 1
        around = self.around.pop()
        self.stored_place = 0
        # After the loop, the C variable holds the first value for which the test failed.
        if s.trips is not None:
            final = str(s.trips[-1] + s.step) if s.trips else start
        elif s.step == 1:
            final = f"_max({start}, {stop})"
        else:
            final = f"{start} + _len(_range({start}, {stop}{step})) * {s.step}"
        self.put("else:")
        self.put(f"    {name} = {final}")
        self.jump_on(around)

    def counting_at_large(self, s: For) -> None:
        """Write a `for` as C defines it: its variable or bound is changed in the body, is shared, or may wrap."""
        assert s.test is not None
        start = self.value(s.start)
        self.cost += self.costs.cycles(s.start) + self.costs.cycles(s.stop)
        self.flush()
        self.put(f"{self.counter(s)} = {start}")
        if self.is_watched(s.counter):
            self.put(self.touch(s.counter, str(s.variable.words), write=True))
        test = self.condition(s.test)
        self.put_loop_limit(s)
        self.put(f"while {test}:")
        self.turns(s, s.body)
        self.where = s.where
        self.end_of_turn(s)
        self.depth -= 1
        around = self.around.pop()
        self.stored_place = 0
        self.jump_on(around)

    def counter(self, s: For) -> str:
        """The text of the variable of a counting loop."""
        root = s.counter
        return local_name(root) if root.plain else f"{self.data(root)}[{s.variable.leaf}]"

    def step(self, s: For) -> None:
        """`i += step` at the end of a turn."""
        root, ctype = s.counter, s.counter.ctype
        assert isinstance(ctype, IntType)
        data = self.counter(s)
        if s.guard is not None:
            number = self.number(s.guard)
            fits = f"{ctype.low} <= (_t := {data} + {s.step}) <= {ctype.high}"
            text = f"{data} = _t if {fits} else _c_overflow(_t, {number})"
        else:
            text = f"{data} = {data} + {s.step} & {ctype.high}"
        if self.is_watched(root):
            word = str(s.variable.words)
            text = f"{self.touch(root, word, write=False)}; {self.touch(root, word, write=True)}; {text}"
        self.put(text)

    # Assignments

    def assign(self, s: Assign) -> None:
        target = s.target
        self.cost += s.cycles
        if isinstance(target, RegisterRef | RegisterAt):
            called, in_place = self.register_store(target, s.value)
            # Nobody sees a store in place: only the call must store its place.
            self.passing = bool(in_place) and not self.options.watch
            self.flush()
            if in_place:
                self.put(in_place)
                called = f"else: {called}" if self.stored_place else f"else: _p.at = {self.here()}; {called}"
            self.put(called)
            return
        value = self.value(s.value)
        visible = observable(s.value) or observable(target)
        root = target.root
        if target.bits is not None or isinstance(root, Expr):
            text = self.store_pointed(target, value)
            self.flush()
            self.put(text)
        elif root.plain:
            if visible:
                self.flush()
            self.put(f"{local_name(root)} = {value}")
        elif isinstance(target.ctype, StructType):
            self.flush()
            if target.outside is not None:
                self.put(f"_c_store_struct({self.address(target)}, {value}, {self.number(target.outside)})")
            elif root.kind == "temporary":
                self.put(f"{local_name(root)} = {value}")
            else:
                self.put(f"{self.data(root)}[{target.leaf}:{target.leaf + target.ctype.leaves}] = {value}")
        else:
            self.store_memory(target, root, value, visible=visible)

    def store_pointed(self, target: LValue, value: str) -> str:
        """The statement that writes through a pointer, or to a bit-field."""
        number = self.number(target.outside)
        root = target.root
        pointer, offset = self.base(root), self.offset_words(target)
        if target.bits is not None and target.bits.octets:
            return f"_c_store_octet({pointer}, {offset}, {value}, {number})"
        if target.bits is not None:
            return f"_c_store_bits({pointer}, {offset}, {value}, {target.bits.lo}, {target.bits.width}, {number})"
        if isinstance(target.ctype, StructType):
            return f"_c_store_struct(_c_address({pointer}, {offset}, {self.type(target.ctype)}), {value}, {number})"
        return f"_c_store({pointer}, {offset}, {value}, {number})"

    def store_memory(self, target: LValue, root: Variable, value: str, *, visible: bool) -> None:
        """Write an object in memory, or an element or member of it."""
        data = self.data(root)
        if not target.indices:
            if visible:
                self.flush()
            if self.is_watched(root):
                # The value is computed first, so that its reads are reported to the watcher before this write.
                self.put(f"_v = {value}")
                self.put(self.touch(root, str(target.words), write=True))
                value = "_v"
            self.put(f"{data}[{target.leaf}] = {value}")
            return
        access = self.element_access(target)
        if visible or len(target.indices) > 1:
            self.flush()
        if not access.names:
            self.put(f"{data}[{access.leaf}] = {value}")
            return
        notification = (
            self.touch(root, access.watched_word or access.words, write=True) + "; " if self.is_watched(root) else ""
        )
        self.put(f"_v = {value}")
        if not access.tests:
            self.put(f"{notification}{data}[{access.leaf}] = _v")
            return
        self.put(f"if {access.tests}: {notification}{data}[{access.leaf}] = _v")
        self.put(f"else: {self.outside('store', target, root, access, ', _v')}")

    def copy_struct(self, s: CopyStruct) -> None:
        target, source = self.address(s.target), self.address(s.source)
        self.cost += s.cycles
        self.flush()
        self.put(f"_c_copy_struct({target}, {source}, {s.target.ctype.words}, {self.number(s.guard)})")

    def declare(self, s: Declare) -> None:
        variable = s.variable
        name = local_name(variable)
        if s.value is None:
            # A local of an inner block has no value at the start of each turn (its words keep the old value).
            if variable.unwritten and renewed(variable) and any(around.loop is not None for around in self.around):
                self.put(f"if {name} is not None: _old_{name} = {name}; {name} = None")
            return
        self.cost += s.cycles
        if isinstance(s.value, list):
            if all(isinstance(value, Const) for value in s.value):
                constants = tuple([value.value for value in s.value])
                self.put(f"{name}[:] = {self.names.constant('k', constants, ('initial', id(s)))}")
                return
            values = ", ".join(map(self.value, s.value))
            if any(map(observable, s.value)):
                self.flush()
            self.put(f"{name}[:] = ({values},)")
            return
        value = self.value(s.value)
        if observable(s.value):
            self.flush()
        if isinstance(variable.ctype, StructType):
            self.put(f"{name}{'' if variable.kind == 'temporary' else '[:]'} = {value}")
        else:
            self.put(f"{name}[0] = {value}" if variable.in_memory else f"{name} = {value}")

    # Values

    def value(self, e: Expr) -> str:
        """Python text for the value of `e`."""
        text = self.mathematical(e, e.ctype) if e.unwrapped else self.plain(e)
        if e.unwrapped and e.guard is not None:
            assert isinstance(e.ctype, IntType)
            number, high = self.number(e.guard), mathematical_bounds(e, e.ctype)[1]
            test = f"0 <= (_t := {text})" if high <= e.ctype.high else f"0 <= (_t := {text}) <= {e.ctype.high}"
            text = f"(_t if {test} else _c_wrapped(_t, {number}))"
        if e.leaving is not None:
            text = self.leaving(e.leaving, text, e)
        if e.regulated is None:
            return text
        helper = "_c_regulated_float" if isinstance(e.ctype, FloatType) else "_c_regulated"
        return f"{helper}({text}, {self.number(e.regulated)})"

    def leaving(self, guard: Guard, text: str, e: Expr) -> str:
        """The text of a value, with the check that its use asks for."""
        number, helper = self.number(guard), _helper(guard)
        match guard.kind:
            case "quantity":
                return f"(_t if 0 <= (_t := {text}) <= {guard.site.bound} else {helper}(_t, {number}))"
            case "signed-word" | "gone-back":
                return f"(_t if (_t := {text}) <= {guard.site.bound} else {helper}(_t, {number}))"
            case "shifted-sign" | "sign-lost":
                return f"(_t if 0 <= (_t := {text}) else {helper}(_t, {number}))"
            case "error-side":
                assert isinstance(e, Binary)
                kind = "_float" if isinstance(guard.site.ctype, FloatType) else ""
                return f"{helper}{kind}({text}, {self.value(e.right)}, {number})"
        return f"{helper}({text}, {number})"

    def plain(self, e: Expr) -> str:
        """The text of `e`, without the checks that its use asks for."""
        match e:
            case Const(value=value):
                return self.literal(value)
            case Null():
                return "_c_NULL"
            case String(text=text):
                return self.names.string(text)
            case Load(lvalue=lvalue):
                return self.load(lvalue)
            case RegisterLoad(register=ref):
                return self.register_load(ref)
            case RegisterAddress(ctype=ctype, block=block, register=register):
                return f"_c_register_address({block!r}, {register!r}, {self.type(ctype)})"
            case AddressOf(lvalue=lvalue):
                return self.address(lvalue)
            case Convert():
                return self.convert(e)
            case Binary():
                return self.binary(e)
            case Unary():
                return self.unary(e)
            case Compare() | Logic() | Not():
                return f"(1 if {self.condition(e)} else 0)"
            case Conditional(test=test, then=then, otherwise=otherwise):
                return f"({self.value(then)} if {self.condition(test)} else {self.value(otherwise)})"
            case PointerAdd(ctype=PointerType(target=target), pointer=pointer, index=index, negative=negative):
                distance = f"{'-' if negative else ''}{self.value(index)} * {max(1, target.words)}"
                return f"_c_address({self.value(pointer)}, {distance}, {self.type(target)})"
            case PointerDifference(left=Expr(ctype=PointerType(target=target)) as left, right=right):
                return f"(({self.value(left)}.addr - {self.value(right)}.addr) // {max(1, target.words)})"
            case FunctionRef(function=function):
                return self.names.function(function)
            case Call():
                return self.call(e)
            case CallPointer(target=target, arguments=arguments, guard=guard):
                values = ", ".join(map(self.value, arguments))
                return f"_c_callable({self.value(target)}, {self.number(guard)})({values})"
        raise TypeError(f"no text for {type(e).__name__}")

    def condition(self, e: Expr) -> str:
        """Python text that is true if C takes the branch."""
        match e:
            case Compare(op=op, left=left, right=right, guard=Guard(kind="stamps") as guard):
                return f"_c_stamps({self.value(left)}, {op!r}, {self.value(right)}, {self.number(guard)})"
            case Compare(op=op, left=left, right=right, guard=Guard(kind="extended", site=Site(kind=kind)) as guard):
                sides = [self.uncut(left) if kind == "left" else self.value(left)]
                sides += [self.uncut(right) if kind == "right" else self.value(right)]
                return f"_c_extended({', '.join(sides)}, {op!r}, {self.number(guard)})"
            case Compare(op=op, left=left, right=right):
                pointers = isinstance(left.ctype, PointerType | HandleType | FunctionType)
                if pointers and op not in ("==", "!=") and not isinstance(left.ctype, PointerType):
                    return f"(_c_code({self.value(left)}) {op} _c_code({self.value(right)}))"
                if pointers and op not in ("==", "!="):
                    return f"({self.value(left)}.addr {op} {self.value(right)}.addr)"
                return f"({self.value(left)} {op} {self.value(right)})"
            case Logic(op=op, operands=operands):
                return "(" + f" {op} ".join(map(self.condition, operands)) + ")"
            case Not(operand=operand):
                return f"(not {self.condition(operand)})"
        return self.value(e)

    def uncut(self, e: Expr) -> str:
        """The text of a number before it became an `int`."""
        cut = cut_to_int(e)
        assert cut is not None
        return self.value(cut.operand) if isinstance(cut, Convert) else f"({self.value(cut)} & 65535)"

    def literal(self, value: int | float) -> str:
        if isinstance(value, float):
            if value != value or value in (float("inf"), float("-inf")):
                return self.names.constant("k", value, ("float", repr(value)))
            return repr(value) if value >= 0 and not repr(value).startswith("-") else f"({value!r})"
        return str(value) if value >= 0 else f"({value})"

    def type(self, ctype: CType) -> str:
        """A name for a type."""
        return self.names.constant("t", ctype, ("type", ctype.name, type(ctype).__name__))

    # Arithmetic

    def mathematical(self, e: Expr, ctype: CType) -> str:
        """The text of the mathematical value of an unsigned tree, without any wrap."""
        match e:
            case Binary(op=op, left=left, right=right) if wraps(e) and e.ctype == ctype:
                return f"({self.mathematical(left, ctype)} {op} {self.mathematical(right, ctype)})"
            case Convert(operand=Expr(ctype=IntType(signed=True)) as operand, explicit=False) if e.ctype == ctype:
                return self.value(operand)
        constant = mathematical_constant(e)
        return self.plain(e) if constant is None else self.literal(constant)

    def fitted(self, text: str, e: Expr, exact: tuple[int, int] | None) -> str:
        """A result converted to its type, in the cheapest way that its bounds allow."""
        ctype = e.ctype
        assert isinstance(ctype, IntType)
        if exact is not None and ctype.low <= exact[0] and exact[1] <= ctype.high:
            return text
        if not ctype.signed:
            return f"({text} & {(1 << ctype.bits) - 1})"
        number = self.number(e.guard)
        return f"(_t if {ctype.low} <= (_t := {text}) <= {ctype.high} else _c_overflow(_t, {number}))"

    def binary(self, e: Binary) -> str:
        ctype, op = e.ctype, e.op
        if e.guard is not None and e.guard.kind == "fields":
            return self.fields(e, e.guard)
        left, right = self.value(e.left), self.value(e.right)
        if isinstance(ctype, FloatType):
            return self.float_operation(e, left, right)
        assert isinstance(ctype, IntType)
        if op in ("/", "%"):
            if e.guard is None:
                return f"({left} {'//' if op == '/' else '%'} {right})"
            helper = {"quotient": "_c_quotient", "divide": "_c_divide_ints", "modulo": "_c_modulo_ints"}[e.guard.kind]
            return f"{helper}({left}, {right}, {self.number(e.guard)})"
        if e.guard is not None and e.guard.kind == "shift":
            return self.shift(e, ctype, left, right)
        if op in "&|^" or op == ">>":
            return f"({left} {op} {right})"
        return self.fitted(f"({left} {op} {right})", e, e.exact)

    def fields(self, e: Binary, guard: Guard) -> str:
        """The text of an OR whose fields must not meet."""
        self.fresh += 1
        terms = [self.value(term) for term in or_terms(e)]
        names = [f"_w{self.fresh}_{i}_" for i in range(len(terms))]
        whole = " | ".join(f"({name} := {text})" for name, text in zip(names, terms, strict=True))
        tests = " or ".join(f"{names[a]} & {names[b]}" for a, b in guard.site.dimensions)
        told = f"_c_fields(_t, [{', '.join(names)}], {self.number(guard)})"
        return f"({told} if (_t := {whole}) and ({tests}) else _t)"

    def shift(self, e: Binary, ctype: IntType, left: str, right: str) -> str:
        """The text of a shift whose count may be out of range."""
        number = self.number(e.guard)
        if isinstance(e.left, Const) and e.op == "<<" and int(e.left.value) > 0:
            # A constant shifted by a variable: in range up to the count at which it would overflow.
            limit = ctype.high.bit_length() - int(e.left.value).bit_length()
            count, named = (right, right) if right.isidentifier() else (f"(_n := {right})", "_n")
            slow = f"_c_shift('{e.op}', {left}, {named}, {number})"
            low = "0 <= " if bounds_of(e.right)[0] < 0 else ""
            return f"({left} << {named} if {low}{count} <= {limit} else {slow})"
        return f"_c_shift('{e.op}', {left}, {right}, {number})"

    def float_operation(self, e: Binary, left: str, right: str) -> str:
        guard = e.guard
        wide = isinstance(e.ctype, Double64)
        rounded, divided = ("", "_c_divide_doubles") if wide else ("_c_f32", "_c_divide_floats")
        if guard is None:
            return f"{rounded}({left} {e.op} {right})"
        number = self.number(guard)
        if guard.kind == "divide":
            return f"{divided}({left}, {right}, {number})"
        # In a watched image, a NaN or an infinity is reported where it arises: times 0, they are NaN.  This is one
        # comparison: mypy looks at what a chain compares again and again, 12 times a level of nesting against 3.
        self.fresh += 1
        a, b, r = f"_a{self.fresh}_", f"_b{self.fresh}_", f"_r{self.fresh}_"
        result = f"{rounded}(({a} := {left}) {e.op} ({b} := {right}))"
        if guard.more is not None:
            place = self.place(guard.more.where, guard.more)
            result = f"{divided}(({a} := {left}), ({b} := {right}), {place})"
        return f"({r} if ({r} := {result}) * 0.0 == 0.0 else _c_float_result({a}, {b}, {r}, {number}))"

    def unary(self, e: Unary) -> str:
        operand, ctype = self.value(e.operand), e.ctype
        if not isinstance(ctype, IntType):
            return f"(-{operand})"
        if e.op == "~":
            return f"(~{operand})" if ctype.signed else f"({operand} ^ {(1 << ctype.bits) - 1})"
        low, high = bounds_of(e.operand)
        return self.fitted(f"(-{operand})", e, (-high, -low))

    def convert(self, e: Convert) -> str:
        target, operand = e.ctype, e.operand
        source = operand.ctype
        text = self.value(operand)
        if e.sign is not None:
            text = f"(_t if (_t := {text}) <= 127 else _c_octet(_t, {self.number(e.sign)}))"
        if e.guard is not None and e.guard.kind in ("parsed", "pulse"):
            text = f"{_helper(e.guard)}({text}, {self.number(e.guard)})"
        match target, source:
            case FloatType(), IntType(bits=bits):
                exact = bits <= 16 or isinstance(target, Double64)
                return f"({text} + 0.0)" if exact else f"_c_f32({text} + 0.0)"
            case FloatType(), Double64() if not isinstance(target, Double64):
                return f"_c_f32({text})"
            case IntType(), FloatType():
                assert e.guard is not None
                return f"{_helper(e.guard)}({text}, {self.number(e.guard)})"
            case IntType(), IntType():
                return self.convert_int(text, e, target)
            case IntType(), PointerType(target=behind) if behind != VOID:
                return self.masked(f"{text}.addr", target)
            case IntType(), _:
                return self.masked(f"_c_code({text})", target)
            case (FunctionType(), IntType() | PointerType()) | (HandleType(), IntType()):
                return f"_c_function_at({text})"
            case PointerType(), IntType():
                return f"_c_pointer_at({text}, {self.pointer_type(target)})"
            case PointerType(), PointerType():
                return f"_c_cast({text}, {self.pointer_type(target)})"
        return text

    def pointer_type(self, ctype: CType) -> str:
        return self.names.constant("t", ctype, ("type", ctype.name, "p"))

    def convert_int(self, text: str, e: Convert, target: IntType) -> str:
        if e.guard is not None and e.guard.kind == "past":
            return f"(_t if (_t := {self.masked(text, target)}) >= 0 else _c_past(_t, {self.number(e.guard)}))"
        if e.guard is not None and e.guard.kind not in ("parsed", "pulse"):
            low, high = octet_range(target) if e.guard.kind == "octet" else (target.low, target.high)
            return f"(_t if {low} <= (_t := {text}) <= {high} else {_helper(e.guard)}(_t, {self.number(e.guard)}))"
        low, high = bounds_of(e.operand)
        if e.operand.unwrapped and isinstance(e.operand.ctype, IntType):
            low, high = mathematical_bounds(e.operand, e.operand.ctype) if e.operand.guard is None else (low, high)
        return text if target.low <= low and high <= target.high else self.masked(text, target)

    def masked(self, text: str, target: IntType) -> str:
        """An integer cut to the bits of its type."""
        mask, half = (1 << target.bits) - 1, 1 << target.bits - 1
        return f"(({text} + {half} & {mask}) - {half})" if target.signed else f"({text} & {mask})"

    # Calls

    def call(self, e: Call) -> str:
        function = e.function
        name = self.names.function(function)
        extra = [f"({self.type(argument.ctype)}, {self.value(argument)})" for argument in e.extra]
        if not function.extern:
            arguments = list(map(self.value, e.arguments))
            if function.given is None:
                return f"{name}({', '.join(arguments)})"
            arguments.append(f"(_a := _c_given({', '.join(extra)}))")
            return f"_c_taken({name}({', '.join(arguments)}), _a)"
        arguments = []
        for argument in e.arguments:
            if isinstance(argument, Null):
                arguments.append("None")
            elif isinstance(argument.ctype, HandleType):  # an object of the emulator, or NULL
                arguments.append(f"(None if (_h := {self.value(argument)}) is _c_NULL else _h)")
            elif isinstance(argument.ctype, PointerType):
                arguments.append(f"_c_outward({self.value(argument)})")
            else:
                arguments.append(self.value(argument))
        text = f"{name}({', '.join([*arguments, *extra])})"
        pointer = isinstance(e.ctype, PointerType | HandleType)
        return f"(_c_NULL if (_h := {text}) is None else _h)" if pointer else text

    # Objects

    def data(self, variable: Variable) -> str:
        """The list that holds a memory object's scalars."""
        return f"_g_{object_name(variable)}" if variable.kind == "global" else local_name(variable)

    def pointer_name(self, variable: Variable) -> str:
        """The name of the pointer to an object."""
        return f"_p_{object_name(variable) if variable.kind == 'global' else local_name(variable)}"

    def base(self, root: Variable | Expr) -> str:
        """The pointer through which an object is reached."""
        return self.value(root) if isinstance(root, Expr) else self.pointer_name(root)

    def location(self, variable: Variable, words: str) -> str:
        """The text of the address of a word of an object in memory."""
        if variable.kind == "global":
            return f"{self.pointer_name(variable)}.addr + {words}"
        return f"_fp + {variable.frame_offset} + {words}"

    def is_watched(self, variable: Variable) -> bool:
        """Whether the watcher hears of accesses: to an object of the file, or to a local with a pointer to it.

        Who follows the statements replays them, and needs no watcher.
        """
        told = self.options.watch and not self.options.follow
        return told and (variable.kind == "global" or (variable.in_memory and variable.escapes))

    def touch(self, variable: Variable, words: str, *, write: bool) -> str:
        """The call that tells the watcher; its value is None."""
        known = variable.kind == "global"
        obj = f"_o_{object_name(variable)}" if known else f"{self.pointer_name(variable)}.obj"
        return f"_c_touch({obj}, {words}, {write})"

    def load(self, lvalue: LValue) -> str:
        root = lvalue.root
        if lvalue.bits is not None or isinstance(root, Expr):
            return self.load_pointed(lvalue)
        if root.plain:
            return self.tested(local_name(root), lvalue, root, "0")
        if isinstance(lvalue.ctype, StructType) and lvalue.outside is not None:
            number = self.number(lvalue.outside)
            return f"_c_load_struct({self.address(lvalue)}, {self.type(lvalue.ctype)}, {number})"
        if isinstance(lvalue.ctype, StructType):
            return f"{self.data(root)}[{lvalue.leaf}:{lvalue.leaf + lvalue.ctype.leaves}]"
        data = self.data(root)
        access = self.element_access(lvalue)
        text = self.tested(f"{data}[{access.leaf}]", lvalue, root, access.words)
        if self.is_watched(root):
            text = f"({self.touch(root, access.watched_word or access.words, write=False)} or {text})"
        if not access.tests:
            return text
        return f"({text} if {access.tests} else {self.outside('load', lvalue, root, access)})"

    def outside(self, way: str, lvalue: LValue, root: Variable, access: _ElementAccess, stored: str = "") -> str:
        """The call that reads or writes an element when a subscript is outside."""
        number = self.number(lvalue.outside)
        if lvalue.outside is not None and lvalue.outside.kind == "index":
            base = self.location(root, str(lvalue.words))
            return f"_c_oob_{way}({number}, {access.names[0]}, {lvalue.indices[0].words}, {base}{stored})"
        names = "".join(f"{name}, " for name in access.names)
        return f"_c_oob_deep_{way}({number}, {self.data(root)}, ({names}), {self.location(root, '0')}{stored})"

    def load_pointed(self, lvalue: LValue) -> str:
        """The text of a read through a pointer, or of a bit-field."""
        root = lvalue.root
        number = self.number(lvalue.outside)
        pointer, offset = self.base(root), self.offset_words(lvalue)
        if lvalue.bits is not None and lvalue.bits.octets:
            return f"_c_load_octet({pointer}, {offset}, {number})"
        if lvalue.bits is not None:
            signed = isinstance(lvalue.ctype, IntType) and lvalue.ctype.signed
            return f"_c_load_bits({pointer}, {offset}, {lvalue.bits.lo}, {lvalue.bits.width}, {signed}, {number})"
        if isinstance(lvalue.ctype, StructType):
            whole = f"_c_address({pointer}, {offset}, {self.type(lvalue.ctype)})"
            return f"_c_load_struct({whole}, {self.type(lvalue.ctype)}, {number})"
        return f"_c_load({pointer}, {offset}, {number})"

    def tested(self, text: str, lvalue: LValue, root: Variable, words: str) -> str:
        """`text`, with a test for a value that was never written if there can be one."""
        if lvalue.fresh is None:
            return text
        number = self.number(lvalue.fresh)
        where = "" if words == "0" else f", {words}"
        if self.options.residue and root.frame_offset:
            where = f", {words}, {self.location(root, words)}"
        if text.isidentifier():
            if renewed(root):
                return f"({text} if {text} is not None else _c_stale({number}, _old_{text}{where}))"
            return f"({text} if {text} is not None else _c_uninit({number}{where}))"
        return f"(_u if (_u := {text}) is not None else _c_uninit({number}{where}))"

    def element_access(self, lvalue: LValue) -> _ElementAccess:
        """How an element of an object in memory is accessed.  Each subscript is evaluated once."""
        root = lvalue.root
        assert isinstance(root, Variable)
        if not lvalue.indices:
            return _ElementAccess(str(lvalue.leaf), str(lvalue.words))
        texts = [self.value(index.expr) for index in lvalue.indices]
        outside = lvalue.outside is not None
        if not outside and not self.is_watched(root):
            return _ElementAccess(_leaf(texts, lvalue), _words([f"({text})" for text in texts], lvalue))
        names: list[str] = []
        for _ in texts:
            self.fresh += 1
            names.append("_i" if len(texts) == 1 else f"_i{self.fresh}")
        access = _ElementAccess(_leaf(names, lvalue), _words(names, lvalue), tuple(names))
        if not outside:
            access.watched_word = _words([f"({n} := {t})" for n, t in zip(names, texts, strict=True)], lvalue)
            return access
        assert lvalue.outside is not None
        site = lvalue.outside.site
        limits = [site.bound] if lvalue.outside.kind == "index" else [limit for limit, _ in site.dimensions]
        tests = []
        for name, text, index, limit in zip(names, texts, lvalue.indices, limits, strict=True):
            low = bounds_of(index.expr)[0]
            tests.append(f"{'0 <= ' if low < 0 else ''}({name} := {text}) < {limit}")
        # `&`, not `and`: all subscripts are evaluated, whatever the first test gives.
        access.tests = tests[0] if len(tests) == 1 else " & ".join(f"({test})" for test in tests)
        return access

    def offset_words(self, lvalue: LValue) -> str:
        """The text of the distance of an lvalue from its root, in words."""
        return _words([self.member_index(i) for i in lvalue.indices], lvalue)

    def member_index(self, index: Index) -> str:
        """A subscript behind a pointer, checked against the length of the array member if that is known."""
        text = self.value(index.expr)
        return text if index.guard is None else f"_c_member_index({text}, {self.number(index.guard)})"

    def address(self, lvalue: LValue) -> str:
        base = self.base(lvalue.root)
        if whole_target(lvalue):
            return base
        return f"_c_address({base}, {self.offset_words(lvalue)}, {self.type(pointed(lvalue.ctype))})"

    # Registers

    def register_load(self, ref: RegisterRef | RegisterAt) -> str:
        if isinstance(ref, RegisterAt):
            word = f"{self.pointed_register(ref)}.read()"
        elif self.names.looked_at(ref.block, ref.register):
            word = f"{self.names.register(ref, 'source')}.value"
        else:
            word = f"{self.names.register(ref, 'read')}()"
        if ref.field is None:
            return word
        shift = f" >> {ref.field.lo}" if ref.field.lo else ""
        return f"({word}{shift} & {(1 << ref.field.width) - 1})"

    def pointed_register(self, ref: RegisterAt) -> str:
        """The text of a register in the block that a pointer points to."""
        return f"_c_register({self.value(ref.block)}, {ref.words}, {ref.bits}, {self.number(ref.guard)})"

    def register_store(self, ref: RegisterRef | RegisterAt, value: Expr) -> tuple[str, str]:
        """The call that writes a register or field, and the store in place that has the same effect ("": none)."""
        if isinstance(ref, RegisterAt):
            write = modify = self.pointed_register(ref)
            write, modify = f"{write}.write", f"{modify}.modify"
        elif ref.field is None or ref.reads_zero:
            write = modify = self.names.register(ref, "write")
        else:
            write = modify = self.names.register(ref, "modify")
        if ref.field is None:
            return f"{write}({self.value(value)}, {0xFFFFFFFF})", ""
        f = ref.field
        bits = self.field_bits(f, value)
        if isinstance(ref, RegisterRef) and ref.reads_zero:
            called = f"{write}({bits}, {f.lane})"
            if not ref.clears or observable(value):
                return called, ""
            flags = f"{self.names.register(ref, 'cleared')}.value"
            return called, f"if {self.names.register(ref, 'gate')}.eallow: {flags} = {flags} & ~({bits})"
        keep = ((1 << ref.bits) - 1) & ~f.mask
        called = f"{modify}({keep}, {bits}, {f.lane})"
        if isinstance(ref, RegisterAt) or not ref.plain or observable(value):
            return called, ""
        # Most fields are only stored: doing it in place is faster than a call.
        gate, word = self.names.register(ref, "gate"), f"{self.names.register(ref, 'source')}.value"
        return called, f"if {gate}.eallow: {word} = {word} & {keep} | ({bits})"

    def field_bits(self, f: Field, value: Expr) -> str:
        """A value as the bits of a field."""
        if isinstance(value, Const):
            return str(int(value.value) << f.lo & f.mask)
        bits = self.value(value)
        low, high = bounds_of(value)
        if f.lo:
            bits = f"{bits} << {f.lo}"
        return f"{bits} & {f.mask}" if low < 0 or high << f.lo > f.mask else bits


@dataclass(slots=True)
class _ElementAccess:
    """The access to an element, as text.

    `leaf` is the number of its scalar, `words` its word, `names` the names of its subscripts.  `tests` assigns these
    names and checks the bounds.  Without tests, `watched_word`, the word for a watcher, assigns the names.
    """

    leaf: str
    words: str
    names: tuple[str, ...] = ()
    tests: str = ""
    watched_word: str = ""


def _leaf(subscripts: list[str], lvalue: LValue) -> str:
    """The text of the number of the scalar that subscripts designate."""
    terms = [t if i.leaves == 1 else f"{t} * {i.leaves}" for t, i in zip(subscripts, lvalue.indices, strict=True)]
    return " + ".join([*terms, str(lvalue.leaf)] if lvalue.leaf else terms)


def _words(subscripts: list[str], lvalue: LValue) -> str:
    """The text of the word of the object that subscripts designate."""
    terms = [t if i.words == 1 else f"{t} * {i.words}" for t, i in zip(subscripts, lvalue.indices, strict=True)]
    return " + ".join([*terms, str(lvalue.words)] if lvalue.words or not terms else terms)


def _helper(guard: Guard) -> str:
    """The name of the function that makes a check, if it is called after its kind."""
    return f"_c_{guard.kind.replace('-', '_')}"


def _labels(values: list[int]) -> str:
    return f"_w == {values[0]}" if len(values) == 1 else f"_w in {tuple(values)}"


def own_statements(body: list[Stmt]) -> list[Stmt]:
    """The statements of a case to which its `break` belongs: without those of inner switches."""
    found: list[Stmt] = []
    for s in body:
        found.append(s)
        match s:
            case If(then=then, otherwise=otherwise):
                found += own_statements(then) + own_statements(otherwise)
            case While(body=inner) | For(body=inner):
                found += own_statements(inner)
    return found
