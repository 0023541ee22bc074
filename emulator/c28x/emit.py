"""From typed tree to Python text: statements, time, and what is known to be written.

One pass over a function does three things at once, because each needs the same walk: it writes the text, it carries
forward which objects are definitely written (so that no test is made for them), and it adds up cycles.  Cycles are
charged in batches, always *before* a statement that anybody else could see (a register, a file-scope object, a call),
so that a task can be pre-empted before every such statement.
"""

from __future__ import annotations

from dataclasses import replace

from emulator.c28x import costs
from emulator.c28x.ctypes import VOID, ArrayType
from emulator.c28x.emit_loops import State, meet
from emulator.c28x.emit_stores import StoreEmitter
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    Continue,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    If,
    Return,
    Stmt,
    Switch,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import INSTRUCTIONS, leaves, observable, visible_to_others

#: Words of a frame besides its locals: the return address that LCR saves.
FRAME_WORDS = 2


class FunctionEmitter(StoreEmitter):
    """Writes one function."""

    def function_text(self) -> list[tuple[str, int]]:
        """The whole function, one (text, source line) per line of output."""
        f = self.function
        words = FRAME_WORDS
        for variable in (*(p for p in f.parameters if p.in_memory), *f.locals):
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
            if f.ctype.result == VOID:
                self.leave(None)
            else:
                # The end of a function that owes a value: the caller gets whatever the register held.
                site = self.site(f.ctype.result, f"the value of {f.path}")
                self.leave(f"_c_uninit({site})" if self.checked else f"_c_fill({site})")
        if sum("_k." in text for text, _ in self.lines) > 2:
            # A local is quicker to reach, once it is used more than once or twice.
            self.lines.insert(1, ("    _k = _c_clock", f.line))
        else:
            self.lines = [(text.replace("_k.", "_c_clock."), line) for text, line in self.lines]
        return self.lines

    def prologue(self) -> None:
        self.put("_p = _c_position; _up = (_p.at, _p.calls); _p.calls = _up")
        if self.frame:
            self.put("_fp = _cpu.sp")
            self.put(f"_cpu.sp = _fp + {self.frame_words}")
            if self.checked:
                here = self.place_number()
                self.put(f"if _cpu.sp > _cpu.stack_limit: _p.at = {here}; _c_stack_check({self.function.path!r})")
        for variable in self.function.parameters:
            if variable.in_memory:
                self.put(f"{variable.name} = [{variable.name}]")
        for variable in self.function.locals:
            if self.checked and self.renewed(variable):
                self.put(f"_old_{variable.name} = None")
            if variable.initialised and not variable.in_memory:
                if self.options.residue or self.options.keep_locals:
                    # A return may come before the declaration, and leaves all locals behind.
                    self.put(f"{variable.name} = None")
                continue
            count = variable.ctype.leaves
            if self.checked:
                empty = "None"
            else:
                site = self.site(variable.ctype, variable.declaration.path, variable.declaration)
                empty = f"_c_fill({site})"
            if variable.in_memory:
                if not self.checked:
                    self.put(f"{variable.name} = _c_filled({site})")
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
        if value is not None:
            self.put(f"_v = {value}")
            value = "_v"
        if self.options.residue or self.options.keep_locals:
            spilled = list(self.function.locals)
            site = self.needs.constant("t", (self.function.path, spilled))
            named = ", ".join(v.name for v in spilled)
            self.put(f"_c_spill({site}, {'_fp' if self.frame else 'None'}, ({named}{',' if spilled else ''}))")
        for variable in self.live:
            self.put(f"_c_retire(_p_{variable.name})")
        if self.frame:
            self.put("_cpu.sp = _fp")
        self.put("_p.at, _p.calls = _up")
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
            case Return(value=returned):
                result = None if returned is None else self.value(returned)
                if returned is not None and observable(returned):
                    self.flush()
                self.leave(result)
                self.assigned = None
            case Break():
                self.flush()
                self.loops[-1][0].append(self.assigned)
                self.put("break")
                self.assigned = None
            case Continue():
                step, turn_cost = self.continue_text[-1]
                self.cost += turn_cost
                self.flush()
                self.loops[-1][1].append(self.assigned)
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

    def if_statement(self, s: If) -> None:
        test = self.condition(s.test)
        self.cost += costs.BRANCH
        if observable(s.test) or any(visible_to_others(b) and not leaves(b) for b in (s.then, s.otherwise)):
            self.flush()
        carried, self.cost = self.cost, 0
        self.put(f"if {test}:")
        before = None if self.assigned is None else set(self.assigned)
        # What has been executed is charged behind the join; a branch that does not come there charges it itself.
        after_then = self.branch(s.then, before, carried if leaves(s.then) else 0)
        after_else = before
        if s.otherwise:
            self.put("else:")
            after_else = self.branch(s.otherwise, before, carried if leaves(s.otherwise) else 0)
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
