"""From typed tree to Python text: statements, time, and what is known to be written.

One pass over a function does three things at once, because each needs the same walk: it writes the text, it carries
forward which objects are definitely written (so that no test is made for them), and it adds up cycles.  Cycles are
charged in batches, always *before* a statement that anybody else could see (a register, a file-scope object, a call),
so that a task can be pre-empted before every such statement.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from emulator.c28x import costs
from emulator.c28x.ctypes import INT, VOID, ArrayType, StructType
from emulator.c28x.emit_loops import LoopEmitter, State, meet
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
    LValue,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import INSTRUCTIONS, calls, identifiers, leaves, observable, parts, visible_to_others

#: Words of a frame besides its locals: the return address that LCR saves.
FRAME_WORDS = 2


class FunctionEmitter(LoopEmitter):
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
        for variable in self.live:
            self.put(f"_c_live.remove(_p_{variable.name}.obj)")
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

    def written(self, variable: Variable, key: Any = None) -> None:
        """`variable` (or the element `key`) has just been written."""
        if self.assigned is None:
            return
        if key is None:
            # A new value of an index makes what was known of elements by that index meaningless.
            self.forget(variable.name)
            self.assigned.add(variable)
        elif not variable.escapes and variable.kind != "global":
            # Through a pointer, or by another function, a never-written value may be copied in later.
            self.assigned.add((variable, key))

    def forget(self, name: str) -> None:
        """Elements whose index text mentions `name` are not known to be written any more."""
        if self.assigned is not None:
            self.assigned = {k for k in self.assigned if not (isinstance(k, tuple) and name in identifiers(k[1]))}

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
            # The value may be an index of some array.
            self.forget(root.name)
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
            within = self.leaf_text("_i", index.leaves, target.leaf)
            self.put(f"if 0 <= (_i := {text}) < {limit}: {data}[{within}] = _v")
            self.put(f"else: _c_oob_store({site}, _i, {index.words}, {self.location(root, str(target.words))}, _v)")
        if _plain_index(index.expr):
            self.written(root, place)

    def copy_struct(self, s: CopyStruct) -> None:
        words = s.target.ctype.words
        target, source = self.address(s.target), self.address(s.source)
        self.cost += costs.STORE * words
        self.flush()
        site = self.site(INT, s.target.text or "structure")
        self.put(f"_c_copy({target}, {source}, {words}, {site})")
        # What was never written in the source is so in the target now.
        if self.assigned is not None:
            root = s.target.root
            self.assigned = {k for k in self.assigned if not (k is root or (isinstance(k, tuple) and k[0] is root))}

    def declare(self, s: Declare) -> None:
        variable = s.variable
        if s.value is None:
            return
        if isinstance(s.value, list):
            self.cost += costs.STORE * len(s.value)
            values = ", ".join(self.value(v) for v in s.value)
            if any(observable(v) for v in s.value):
                self.flush()
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


def _plain_index(e: Expr) -> bool:
    """Whether an index is made of constants and plain locals only, so that its text tells when it changes."""
    return all(
        not isinstance(part, LValue)
        or (isinstance(part.root, Variable) and not part.root.in_memory and part.root.kind != "global")
        for part in parts(e)
    ) and not calls(e)
