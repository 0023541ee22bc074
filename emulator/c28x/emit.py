"""From typed tree to Python text: statements, time, and what is known to be written.

One pass over a function does three things at once, because each needs the same walk: it writes the text, it carries forward
which objects are definitely written (so that no test is made for them), and it adds up cycles.  Cycles are charged in
batches, always *before* a statement that anybody else could see (a register, a file-scope object, a call), so that a task
can be pre-empted before every such statement.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from emulator.c28x import costs
from emulator.c28x.ctypes import ArrayType, FloatType, IntType, StructType
from emulator.c28x.emit_expressions import ExpressionEmitter, Needs, Options, calls, observable, parts
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    Const,
    Continue,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip

#: Words of a frame besides its locals: the return address that LCR saves.
FRAME_WORDS = 2

#: `EALLOW` and `EDIS` set and clear a bit of ST1 (CPU, instruction set).
INSTRUCTIONS: Final = {"EALLOW": "_cpu.eallow = True", "EDIS": "_cpu.eallow = False"}

State = set[Any] | None


def meet(*states: State) -> State:
    """What is written on every way that arrives (None is a way that does not)."""
    arriving = [s for s in states if s is not None]
    return set.intersection(*arriving) if arriving else None


class FunctionEmitter(ExpressionEmitter):
    """Writes one function."""

    def __init__(self, function: Function, needs: Needs, options: Options) -> None:
        super().__init__(function, needs, options)
        self.lines: list[tuple[str, int]] = []
        self.depth = 0
        self.line = function.line
        self.factor = options.calibration.get(function.path, options.calibration.get(function.module, 1.0))
        self.loops: list[tuple[list[State], list[State]]] = []
        self.continue_text: list[str | None] = []
        self.live: list[Variable] = []

    # Text

    def put(self, text: str) -> None:
        self.lines.append(("    " * self.depth + text, self.line))

    def flush(self) -> None:
        """Charge what has been executed so far."""
        if self.cost:
            cycles = max(1, round(self.cost * self.factor))
            self.put(f"_k.now += {cycles}")
            self.put("if _k.now >= _k.next: _k.run_due()")
            self.cost = 0

    def function_text(self) -> list[tuple[str, int]]:
        """The whole function, one (text, source line) per line of output."""
        f = self.function
        words = FRAME_WORDS
        for variable in f.locals:
            if variable.declaration.path in self.options.room and isinstance(variable.ctype, ArrayType):
                element = variable.ctype.element
                variable.ctype = ArrayType(f"{element}[]", element, self.options.room[variable.declaration.path])
                variable.declaration = replace(variable.declaration, ctype=variable.ctype)
            align = variable.ctype.align
            words = -(-words // align) * align
            variable.frame_offset = words
            words += variable.ctype.words
        self.frame_words = words + words % 2
        self.live = [v for v in (*f.parameters, *f.locals) if v.in_memory and v.escapes]
        self.frame = self.options.residue or bool(self.live) or any(v.in_memory for v in f.locals)
        self.frame = self.frame or any(path.rsplit(".", 1)[-1] not in INSTRUCTIONS for path in f.calls)
        self.put(f"def {f.name}({', '.join(p.name for p in f.parameters)}):")
        self.depth = 1
        self.prologue()
        self.cost += costs.CALL
        self.block(f.body)
        if self.assigned is not None:
            self.leave(None)
        return self.lines

    def prologue(self) -> None:
        if self.frame:
            self.put("_fp = _cpu.sp")
            self.put(f"_cpu.sp = _fp + {self.frame_words}")
            if self.checked:
                self.put(f"if _cpu.sp > _cpu.stack_limit: _c_stack_check({self.function.path!r})")
        for variable in self.function.parameters:
            if variable.in_memory:
                self.put(f"{variable.name} = [{variable.name}]")
        for variable in self.function.locals:
            if variable.initialised and not variable.in_memory:
                if self.options.residue or self.options.keep_locals:
                    # A return may come before the declaration, and leaves all locals behind.
                    self.put(f"{variable.name} = None")
                continue
            count = variable.ctype.leaves
            if self.checked:
                empty = "None"
            else:
                leaf: Any = variable.ctype
                while isinstance(leaf, ArrayType):
                    leaf = leaf.element
                if isinstance(leaf, StructType):
                    empty = "None"
                else:
                    site = self.site(leaf, variable.declaration.path, variable.declaration)
                    empty = f"_c_fill({site})"
            if variable.in_memory:
                if empty == "None" and not self.checked:
                    site = self.site(variable.ctype, variable.declaration.path, variable.declaration)
                    self.put(f"{variable.name} = _c_fill_struct({site})")
                else:
                    self.put(f"{variable.name} = [{empty}] * {count}" if count > 1 else f"{variable.name} = [{empty}]")
            else:
                self.put(f"{variable.name} = {empty}")
        for variable in self.live:
            declared = self.needs.constant("t", variable.declaration)
            self.put(f"_p_{variable.name} = _c_enter({declared}, {variable.name}, _fp + {variable.frame_offset})")

    def leave(self, value: str | None) -> None:
        """Return, giving back the frame."""
        self.flush()
        if value is not None and (self.frame or self.live):
            self.put(f"_v = {value}")
            value = "_v"
        if self.options.residue or self.options.keep_locals:
            spilled = list(self.function.locals)
            site = self.needs.constant("t", (self.function.path, spilled))
            named = ", ".join(v.name for v in spilled)
            self.put(f"_c_spill({site}, {'_fp' if self.frame else 'None'}, ({named}{',' if spilled else ''}))")
        if self.live:
            self.put(f"del _c_live[-{len(self.live)}:]")
        if self.frame:
            self.put("_cpu.sp = _fp")
        self.put(f"return {value}" if value is not None else "return")

    # Statements

    def block(self, body: list[Stmt]) -> None:
        """Write statements; unreachable ones are written too, they cost nothing."""
        start = len(self.lines)
        for statement in body:
            self.line = statement.line
            self.statement(statement)
        if len(self.lines) == start:
            self.put("pass")

    def statement(self, s: Stmt) -> None:
        match s:
            case Assign():
                self.assign(s)
            case CopyStruct():
                self.copy_struct(s)
            case Declare():
                self.declare(s)
            case Evaluate(value=value):
                instruction = self.instruction(value)
                if instruction is not None:
                    self.put(instruction)
                else:
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
                text = None if value is None else self.value(value)
                if value is not None and observable(value):
                    self.flush()
                self.leave(text)
                self.assigned = None
            case Break():
                self.flush()
                self.loops[-1][0].append(self.assigned)
                self.put("break")
                self.assigned = None
            case Continue():
                self.flush()
                self.loops[-1][1].append(self.assigned)
                step = self.continue_text[-1]
                if step is not None:
                    self.put(step)
                self.put("continue")
                self.assigned = None

    def instruction(self, value: Expr) -> str | None:
        """Externs that are one instruction of the CPU are written inline."""
        if isinstance(value, Call) and value.function.extern and value.function.name in INSTRUCTIONS:
            self.cost += 1
            return INSTRUCTIONS[value.function.name]
        return None

    def written(self, variable: Variable, key: Any = None) -> None:
        """`variable` (or the element `key`) has just been written."""
        if self.assigned is None:
            return
        if key is None:
            # A new value of an index makes what was known of elements by that index meaningless.
            name = variable.name
            self.assigned = {k for k in self.assigned if not (isinstance(k, tuple) and name in _identifiers(k[1]))}
            self.assigned.add(variable)
        else:
            self.assigned.add((variable, key))

    def assign(self, s: Assign) -> None:
        target = s.target
        if isinstance(target, RegisterRef):
            text = self.register_store(target, s.value)
            self.flush()
            self.put(text)
            return
        value = self.value(s.value)
        self.cost += costs.STORE
        visible = observable(s.value) or observable(target)
        root = target.root
        if isinstance(root, Expr):
            site = self.site(target.ctype, self.describe(root))
            self.cost += costs.POINTER
            text = f"_c_store({self.value(root)}, {self.offset_words(target)}, {value}, {site})"
            self.flush()
            self.put(text)
            return
        if not root.in_memory and root.kind != "global":
            if visible:
                self.flush()
            self.put(f"{root.name} = {value}")
            self.written(root)
            return
        self.store_memory(target, root, value, visible)

    def store_memory(self, target: LValue, root: Variable, value: str, visible: bool) -> None:
        data = self.base(root)
        if not target.indices:
            if visible:
                self.flush()
            self.put(f"{data}[{target.leaf}] = {value}")
            self.written(root, str(target.leaf))
            if root.kind != "global" and root.ctype.leaves == 1:
                self.written(root)
            return
        if len(target.indices) > 1:
            site = self.site(target.ctype, root.declaration.path, root.declaration)
            text = f"_c_store({self.pointer_name(root)}, {self.offset_words(target)}, {value}, {site})"
            self.flush()
            self.put(text)
            return
        index = target.indices[0]
        self.cost += costs.INDEX
        text = self.value(index.expr)
        low, high = self.interval(index.expr)
        limit = self.bound(root, index)
        place = self.leaf_text(text, index.leaves, target.leaf)
        if visible:
            self.flush()
        if low >= 0 and high < limit:
            self.put(f"{data}[{place}] = {value}")
        else:
            site = self.site(target.ctype, root.declaration.path, root.declaration, limit)
            self.put(f"_v = {value}")
            self.put(f"if 0 <= (_i := {text}) < {limit}: {data}[{self.leaf_text('_i', index.leaves, target.leaf)}] = _v")
            self.put(f"else: _c_oob_store({site}, _i, {index.words}, {self.location(root, str(target.words))}, _v)")
        if not calls(index.expr):
            self.written(root, place)

    def copy_struct(self, s: CopyStruct) -> None:
        words = s.target.ctype.words
        target, source = self.address(s.target), self.address(s.source)
        self.cost += costs.STORE * words
        self.flush()
        self.put(f"_c_copy({target}, {source}, {words})")

    def declare(self, s: Declare) -> None:
        variable = s.variable
        if s.value is None:
            return
        if isinstance(s.value, list):
            self.cost += costs.STORE * len(s.value)
            values = ", ".join(self.value(v) for v in s.value)
            self.put(f"{variable.name}[:] = ({values},)")
            self.written(variable)
            return
        value = self.value(s.value)
        self.cost += costs.STORE
        if observable(s.value):
            self.flush()
        self.put(f"{variable.name}[0] = {value}" if variable.in_memory else f"{variable.name} = {value}")
        self.written(variable)

    def if_statement(self, s: If) -> None:
        test = self.condition(s.test)
        self.cost += costs.BRANCH
        if observable(s.test) or any(_visible(b) and not _leaves(b) for b in (s.then, s.otherwise)):
            self.flush()
        carried, self.cost = self.cost, 0
        self.put(f"if {test}:")
        before = None if self.assigned is None else set(self.assigned)
        # What has been executed is charged behind the join; a branch that does not come there charges it itself.
        after_then = self.branch(s.then, before, carried if _leaves(s.then) else 0)
        after_else = before
        if s.otherwise:
            self.put("else:")
            after_else = self.branch(s.otherwise, before, carried if _leaves(s.otherwise) else 0)
        self.assigned = meet(after_then, after_else)
        self.cost = carried

    def branch(self, body: list[Stmt], before: State, cost: int = 0) -> State:
        self.cost = cost
        self.assigned = None if before is None else set(before)
        line = self.line
        self.depth += 1
        self.block(body)
        if self.assigned is not None:
            self.flush()
        self.cost = 0
        self.depth -= 1
        self.line = line
        return self.assigned

    def switch(self, s: Switch) -> None:
        subject = self.value(s.subject)
        self.cost += costs.BRANCH * max(1, len(s.cases))
        self.flush()
        self.put(f"_w = {subject}")
        before = None if self.assigned is None else set(self.assigned)
        states: list[State] = []
        word = "if"
        default = False
        for values, body in s.cases:
            if values is None:
                default = True
                self.put("else:" if word == "elif" else "if True:")
            else:
                test = f"_w == {values[0]}" if len(values) == 1 else f"_w in {tuple(values)}"
                self.put(f"{word} {test}:")
            word = "elif"
            states.append(self.branch(body, before))
        if not default:
            states.append(before)
        self.assigned = meet(*states)

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
            self.put("_since = _k.now + _c_poll_limit")
            self.put(f"while {test}:")
            self.put(f"    if not _k.poll({cycles}) or _k.now > _since: _since = _c_poll({site}, _since)")
            self.cost = test_cost
            return
        endless = isinstance(s.test, Const) and s.test.value != 0
        if not endless:
            self.cost = test_cost
            self.flush()
        self.put(f"while {test}:")
        entry = None if self.assigned is None else set(self.assigned)
        self.loops.append(([], []))
        self.continue_text.append(None)
        self.depth += 1
        self.block(s.body)
        if True:
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
            self.assigned = {
                k for k in self.assigned if not (isinstance(k, tuple) and names & _identifiers(k[1]))
            }
        self.ranges = {v: r for v, r in self.ranges.items() if v.name not in names}

    def for_loop(self, s: For) -> None:
        root = s.variable.root
        assert isinstance(root, Variable)
        changed = changed_names(s.body)
        stop_names = {p.root.name for p in parts(s.stop) if isinstance(p, LValue) and isinstance(p.root, Variable)}
        simple = (
            not root.in_memory and root.kind != "global" and root.name not in changed and not observable(s.stop)
            and not (stop_names & (changed | {root.name})) and isinstance(s.stop.ctype, IntType)
        )  # fmt: skip
        start_text, stop_text = self.value(s.start), self.value(s.stop)
        visible = observable(s.start) or observable(s.stop)
        if visible or _visible(s.body):
            self.flush()
        self.forget_changed(s.body)
        constant = isinstance(s.start, Const) and isinstance(s.stop, Const)
        fits = False
        if isinstance(s.stop.ctype, IntType) and isinstance(root.ctype, IntType):
            stop_low, stop_high = self.interval(s.stop)
            fits = root.ctype.low <= stop_low + s.step and stop_high + s.step - 1 <= root.ctype.high
            fits = fits or (constant and root.ctype.low <= stop_low <= root.ctype.high)
        self.flush()
        if not simple or not fits:
            self.for_general(s, root, start_text)
            return
        self.put(f"{root.name} = _stop{self.depth} = {start_text}")
        self.written(root)
        start_low, start_high = self.interval(s.start)
        if s.step > 0:
            self.ranges[root] = (start_low, max(start_low, stop_high - 1))
        else:
            self.ranges[root] = (min(start_high, stop_low + 1), start_high)
        step = f", {s.step}" if s.step != 1 else ""
        trips = constant and (
            range(int(s.start.value), int(s.stop.value), s.step) if isinstance(s.start, Const) and isinstance(s.stop, Const) else ()  # type: ignore[arg-type]
        )
        self.put(f"for {root.name} in _range({start_text}, {stop_text}{step}):")
        entry = None if self.assigned is None else set(self.assigned)
        self.loops.append(([], []))
        self.continue_text.append(None)
        self.depth += 1
        first = len(self.lines)
        self.block(s.body)
        self.cost += costs.LOOP + costs.COMPARE + costs.INT_OP
        if self.lines[first][0].startswith("    " * self.depth + "_k.now += ") and self.assigned is not None:
            # One charge a turn: the end of a turn is charged with the beginning of the next.
            text, line = self.lines[first]
            head, cycles = text.rsplit(" ", 1)
            self.lines[first] = (f"{head} {int(cycles) + max(1, round(self.cost * self.factor))}", line)
            self.cost = 0
        self.flush()
        self.depth -= 1
        end = self.assigned
        breaks, continues = self.loops.pop()
        self.continue_text.pop()
        # Behind the loop C's variable holds the first value that failed the test.
        if constant and isinstance(s.stop, Const):
            final = str(trips[-1] + s.step) if trips else start_text  # type: ignore[index]
        elif s.step == 1:
            final = f"_max({start_text}, {stop_text})"
        else:
            final = f"{start_text} + len(_range({start_text}, {stop_text}{step})) * {s.step}"
        self.put("else:")
        self.put(f"    {root.name} = {final}")
        del self.ranges[root]
        self.assigned = meet(end, *continues, *breaks) if trips else meet(entry, end, *breaks)
        self.written(root)

    def for_general(self, s: For, root: Variable, start_text: str) -> None:
        """A for whose variable or bound is changed, shared or may wrap: written as C defines it."""
        data = root.name if not root.in_memory and root.kind != "global" else f"{self.base(root)}[{s.variable.leaf}]"
        assert isinstance(root.ctype, IntType)
        self.put(f"{data} = {start_text}")
        self.written(root)
        stop = self.value(s.stop)
        test_cost = self.cost + costs.LOOP + costs.COMPARE
        self.cost = 0
        self.put(f"while {data} {'<' if s.step > 0 else '>'} {stop}:")
        site = self.site(root.ctype, root.declaration.path, root.declaration)
        low, high = root.ctype.low, root.ctype.high
        if root.ctype.signed and self.checked:
            step = f"{data} = _t if {low} <= (_t := {data} + {s.step}) <= {high} else _c_overflow(_t, {site})"
        elif root.ctype.signed:
            step = f"{data} = (({data} + {s.step - low}) & {high - low}) + {low}"
        else:
            step = f"{data} = {data} + {s.step} & {high}"
        entry = None if self.assigned is None else set(self.assigned)
        self.loops.append(([], []))
        self.continue_text.append(step)
        self.depth += 1
        self.block(s.body)
        self.cost += test_cost
        self.flush()
        self.put(step)
        self.depth -= 1
        breaks, _ = self.loops.pop()
        self.continue_text.pop()
        self.assigned = meet(entry, *breaks)
        self.written(root)


def _identifiers(text: str) -> set[str]:
    """The names in an index text."""
    return set("".join(c if c.isalnum() or c == "_" else " " for c in text).split())


def changed_names(body: list[Stmt]) -> set[str]:
    """Names of the variables that statements assign."""
    names: set[str] = set()
    for s in body:
        match s:
            case Assign(target=LValue(root=Variable() as root)) | For(variable=LValue(root=Variable() as root)):
                names.add(root.name)
            case Declare(variable=variable):
                names.add(variable.name)
            case CopyStruct(target=LValue(root=Variable() as root)):
                names.add(root.name)
        match s:
            case If(then=a, otherwise=b):
                names |= changed_names(a) | changed_names(b)
            case While(body=inner) | For(body=inner):
                names |= changed_names(inner)
            case Switch(cases=cases):
                for _, inner in cases:
                    names |= changed_names(inner)
    return names


def _leaves(body: list[Stmt]) -> bool:
    """Whether statements never reach what stands behind them."""
    match body[-1] if body else None:
        case Return() | Break() | Continue():
            return True
        case If(then=a, otherwise=b):
            return _leaves(a) and _leaves(b)
    return False


def _visible(body: list[Stmt]) -> bool:
    """Whether any statement touches what others can see."""
    for s in body:
        match s:
            case Assign(target=target, value=value):
                if isinstance(target, RegisterRef) or observable(target) or observable(value):
                    return True
            case Evaluate(value=Call(function=Function(extern=True, name=name))) if name in INSTRUCTIONS:
                pass
            case Return(value=Expr() as value) if observable(value):
                return True
            case Evaluate() | CopyStruct():
                return True
            case Declare(value=Expr() as value) if observable(value):
                return True
            case If(test=test, then=a, otherwise=b):
                if observable(test) or _visible(a) or _visible(b):
                    return True
            case While(test=test, body=inner):
                if observable(test) or _visible(inner) or not inner:
                    return True
            case For() | Switch():
                return True
    return False


__all__ = ["FloatType", "FunctionEmitter"]
