"""Both readers fill one tree: functions whose trees are equal do the same with every input, in the same time.

Of the others it is told where they differ: both trees are walked side by side, statement by statement, and the first
node that differs in a statement gives the cause.  Names of locals do not matter, nor do places and what passes found.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from difflib import SequenceMatcher
from typing import Any, Final

from emulator.c28x import tree
from emulator.c28x.compiled_program import Compiled, CompiledFunction
from emulator.c28x.ctypes import CType, scalars
from emulator.c28x.sites import Site
from emulator.c28x.tree import (
    FOUND,
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Convert,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Index,
    LValue,
    RegisterAt,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import blocks, register_text, source_text
from hil.diff.difference import OWN, PORT, Difference, place

#: Fields that say which statement or expression is meant, not what it does: compared by what is below them.
_BLOCKS: Final = ("then", "otherwise", "body", "step", "cases")


@dataclass
class Trees:
    """What the trees of two programs show."""

    #: Functions with equal trees.
    equal: list[str] = field(default_factory=list)
    #: Function (`module.name`) -> how it differs.
    functions: dict[str, list[Difference]] = field(default_factory=dict)
    #: File-scope objects that differ, and what only one of the two has.
    others: list[Difference] = field(default_factory=list)

    @property
    def differences(self) -> list[Difference]:
        """All of them, functions first."""
        return [d for found in self.functions.values() for d in found] + self.others


def compare_trees(port: Compiled, own: Compiled, modules: Iterable[str]) -> Trees:
    """Compare the functions and objects of `modules` (short names), as both programs have them."""
    wanted = set(modules)
    found = Trees()
    ours = {f.path: f for f in port.functions if f.function.module in wanted}
    theirs = {f.path: f for f in own.functions if f.function.module in wanted}
    for path, function in ours.items():
        if path not in theirs:
            message = f"only {PORT} has this function"
            found.functions[path] = [Difference(path, place(function.function.where), "", message)]
            continue
        differences = compare_functions(function, theirs[path], _factor(port, function.function))
        if differences:
            found.functions[path] = differences
        else:
            found.equal.append(path)
    for path, function in theirs.items():
        if path not in ours:
            message = f"only {OWN} has this function"
            found.functions[path] = [Difference(path, "", place(function.function.where), message)]
    found.others = list(_objects(port, own, wanted))
    return found


def _factor(program: Compiled, function: Function) -> float:
    factors = program.options.calibration
    full = next((name for name, module in program.program.modules.items() if function in module.functions), "")
    return factors.get(f"{full}.{function.name}", factors.get(full, 1.0))


def _objects(port: Compiled, own: Compiled, modules: set[str]) -> Iterator[Difference]:
    """File-scope objects: there or not, type, initial value."""
    ours = {v.declaration.path: v for v, _ in port.objects if v.declaration.module in modules}
    theirs = {v.declaration.path: v for v, _ in own.objects if v.declaration.module in modules}
    for path in [*ours, *(path for path in theirs if path not in ours)]:
        a, b = ours.get(path), theirs.get(path)
        cause = ""
        if a is None or b is None:
            cause = f"only {PORT if b is None else OWN} has this object"
        elif _layout(a.ctype) != _layout(b.ctype):
            cause = f"other type: {a.ctype} in {PORT}, {b.ctype} in {OWN}"
        elif (a.initial is None) != (b.initial is None):
            cause = f"only {PORT if b.initial is None else OWN} gives it an initial value"
        elif a.initial is not None and b.initial is not None:
            values = zip(a.initial, b.initial, strict=True)
            differing = [(n, x, y) for n, (x, y) in enumerate(values) if key(x, {}) != key(y, {})]
            if differing:
                n, x, y = differing[0]
                which = f"scalar {n} of " if len(a.initial) > 1 else ""
                cause = f"other initial value: {which}{source_text(x)} in {PORT}, {source_text(y)} in {OWN}"
        if cause:
            yield Difference(path, _declared(a), _declared(b), cause)


def _declared(variable: Variable | None) -> str:
    return "" if variable is None else place(Where(variable.declaration.file, variable.declaration.line))


def _layout(ctype: CType) -> list[tuple[int, str]]:
    return [(offset, scalar.name) for offset, scalar in scalars(ctype)]


def compare_functions(port: CompiledFunction, own: CompiledFunction, factor: float = 1.0) -> list[Difference]:
    """How two functions differ; nothing if they are equal.  `factor`: the factor on its cycles."""
    walk = _FunctionComparison(port.function, own.function, factor)
    walk.signature()
    walk.retyped()
    bodies = _undeclared(port.function.body), _undeclared(own.function.body)
    walk.block(*bodies, port.function.where, own.function.where)
    if not walk.found and walk.named_alike and _generated(port) != _generated(own):
        walk.add_difference(port.function.where, own.function.where, "other checks: they are translated differently")
    return walk.found


def _generated(compiled: CompiledFunction) -> Hashable:
    """What is generated, with one name for a function, `static` in its file or not, and what it refers to by name."""
    written = compiled.written
    names, text = written.names, written.text
    for name, function in names.functions.items():
        if function.static:
            text = text.replace(name, f"_f_{function.name}")
    sites = tuple((_path(s), type_name(s.ctype), s.bound, s.rule, s.kind) for _, s in written.places if s is not None)
    constants = tuple(
        (name, type_name(value) if isinstance(value, CType) else str(value))
        for name, value in names.constants.items()
        if isinstance(value, CType | int)
    )
    return text, tuple(names.strings.items()), tuple(names.registers.items()), sites, constants


def _path(site: Site) -> str:
    """The object that a check is about; how an expression is spelled does not matter."""
    return site.declaration.path if site.declaration is not None else ""


def _undeclared(body: list[Stmt]) -> list[Stmt]:
    """A function's body without the declarations that give no value: their order means nothing there."""
    return [s for s in body if not (isinstance(s, Declare) and s.value is None)]


def type_name(ctype: CType) -> str:
    """The name of a type; of a structure without the word before its tag, which Python does not write."""
    return _TAG.sub("", ctype.name)


_TAG: Final = re.compile(r"\b(?:struct|union) (?=\w)")

# Keys: nodes as values that can be compared


Renamed = Mapping[Variable, str]


def key(node: Any, renamed: Renamed) -> Hashable:
    """What a node means, as a value: equal keys, equal meaning.  `renamed` names the locals of both alike."""
    if isinstance(node, Variable):
        if node.kind == "global":
            return "object", node.declaration.path
        return "local", renamed.get(node, f"{node.declaration.name} ")
    if isinstance(node, Function):
        return "function", node.module if not node.extern else "", node.name
    if isinstance(node, CType):
        return type_name(node)
    if isinstance(node, Where):
        return ""
    if is_dataclass(node) and not isinstance(node, type):
        return type(node).__name__, *(key(getattr(node, name), renamed) for name in compared_fields(type(node)))
    if isinstance(node, list | tuple):
        return tuple(key(item, renamed) for item in node)
    if isinstance(node, float):
        return repr(node)
    return node if isinstance(node, Hashable) else repr(node)


def compared_fields(kind: Any) -> tuple[str, ...]:
    """The fields of a kind of node that are part of the program."""
    return _FIELDS[kind]


_FIELDS: Final = {
    kind: tuple(f.name for f in fields(kind) if f.compare and f.metadata != FOUND)
    for kind in vars(tree).values()
    if isinstance(kind, type) and is_dataclass(kind)
}


# The walk


class _FunctionComparison:
    """Two functions, side by side.  `found` collects how they differ, in the order of the text."""

    def __init__(self, port: Function, own: Function, factor: float) -> None:
        self.port = port
        self.own = own
        self.factor = factor
        self.found: list[Difference] = []
        self.renamed = _renamed(port, own)
        self.named_alike = [v.name for v in _locals(port)] == [v.name for v in _locals(own)]
        self._declares = _declares(port.body), _declares(own.body)
        self._reported: set[Hashable] = set()
        self._retyped = False

    def key(self, node: Any) -> Hashable:
        return key(node, self.renamed)

    def add_difference(self, port: Where, own: Where, cause: str) -> None:
        """A difference at two places, told once."""
        if not port.file:
            port = self.port.where
        if not own.file:
            own = self.own.where
        difference = Difference(self.port.path, place(port), place(own), cause)
        if difference not in self.found:
            self.found.append(difference)

    def retyped(self) -> None:
        """Locals that have another type: told once, not again at each use."""
        ours = {self.renamed[v]: v for v in self.port.locals if v in self.renamed and v.kind == "local"}
        for b in self.own.locals:
            a = ours.get(self.renamed.get(b, ""))
            if a is not None and type_name(a.ctype) != type_name(b.ctype):
                port, own = (Where(v.declaration.file, v.declaration.line) for v in (a, b))
                cause = f"other type: {b.declaration.name} is {a.ctype} in {PORT}, {b.ctype} in {OWN}"
                self.add_difference(port, own, cause)
                self._retyped = True

    def signature(self) -> None:
        """Parameters and result."""
        a, b = self.port, self.own
        if type_name(a.ctype.result) != type_name(b.ctype.result):
            cause = f"other type: it returns {a.ctype.result} in {PORT}, {b.ctype.result} in {OWN}"
            self.add_difference(a.where, b.where, cause)
        if len(a.parameters) != len(b.parameters):
            message = f"other parameters: {len(a.parameters)} in {PORT}, {len(b.parameters)} in {OWN}"
            self.add_difference(a.where, b.where, message)
        for x, y in zip(a.parameters, b.parameters, strict=False):
            if type_name(x.ctype) != type_name(y.ctype):
                message = f"other type: parameter {y.declaration.name} is {x.ctype} in {PORT}, {y.ctype} in {OWN}"
                self.add_difference(a.where, b.where, message)

    # Statements

    def block(self, port: list[Stmt], own: list[Stmt], at: Where, own_at: Where) -> None:
        """Two blocks; `at` and `own_at` are the statements that they belong to."""
        ours, theirs = [self.key(s) for s in port], [self.key(s) for s in own]
        if ours == theirs:
            return
        for tag, i1, i2, j1, j2 in SequenceMatcher(None, ours, theirs, autojunk=False).get_opcodes():
            if tag == "equal":
                continue
            before = port[i1 - 1].where if i1 else at
            own_before = own[j1 - 1].where if j1 else own_at
            self._unequal(port[i1:i2], own[j1:j2], before, own_before)

    def _unequal(self, port: list[Stmt], own: list[Stmt], at: Where, own_at: Where) -> None:
        """Statements none of which has an equal one: those that are about the same thing belong together."""
        ours, theirs = [self._about(s) for s in port], [self._about(s) for s in own]
        for tag, i1, i2, j1, j2 in SequenceMatcher(None, ours, theirs, autojunk=False).get_opcodes():
            if tag == "equal":
                for x, y in zip(port[i1:i2], own[j1:j2], strict=True):
                    self.statement(x, y)
                continue
            left, right = self._without_moved(port[i1:i2], own[j1:j2], at, own_at)
            for x, y in zip(left, right, strict=False):
                if type(x) is type(y):
                    self.statement(x, y)
                else:
                    cause = f"other statement: {statement_text(x)} in {PORT}, {statement_text(y)} in {OWN}"
                    self.add_difference(x.where, y.where, cause)
            for x in left[len(right) :]:
                self.add_difference(x.where, own_at, f"other statement: only {PORT} has {statement_text(x)}")
            for y in right[len(left) :]:
                self.add_difference(at, y.where, f"other statement: only {OWN} has {statement_text(y)}")

    def _about(self, s: Stmt) -> Hashable:
        match s:
            case Declare(variable=variable):
                return "declare", self.key(variable)
            case Assign(target=target):
                return "assign", self.key(target)
            case Evaluate(value=Call(function=function)):
                return "call", function.name
        return type(s).__name__

    def _without_moved(
        self, port: list[Stmt], own: list[Stmt], at: Where, own_at: Where
    ) -> tuple[list[Stmt], list[Stmt]]:  # fmt: skip
        """What is left without the declarations that the other one has, too, in another place."""
        return (
            [s for s in port if not (isinstance(s, Declare) and self._moved(s.variable))],
            [s for s in own if not (isinstance(s, Declare) and self._moved(s.variable))],
        )

    def _moved(self, variable: Variable) -> bool:
        """Whether both declare a local, each in its place; then that is told."""
        name = self.key(variable)
        ours, theirs = ({self.key(v): found for v, found in d.items()} for d in self._declares)
        if name not in ours or name not in theirs:
            return False
        if name not in self._reported:
            self._reported.add(name)
            (a, where), (b, own_where) = ours[name], theirs[name]
            moved = f": {a.cycles * self.factor:.3g} cycles moved" if a.cycles == b.cycles and a.cycles else ""
            places = f"{OWN} declares {b.variable.declaration.name} {own_where}, {PORT} {where}"
            if where == own_where:
                places = f"{OWN} declares {b.variable.declaration.name} before or after other statements than {PORT}"
            self.add_difference(a.where, b.where, f"declared elsewhere: {places}{moved}")
            self._about_value(a, b)
        return True

    def _about_value(self, a: Declare, b: Declare) -> None:
        if self.key(a.value) != self.key(b.value):
            self._values(a, b, a.value, b.value)

    def statement(self, a: Stmt, b: Stmt) -> None:
        """Two statements of one kind."""
        for name in compared_fields(type(a)):
            x, y = getattr(a, name), getattr(b, name)
            if self.key(x) == self.key(y):
                continue
            if name == "cases":
                self._cases(a, b, x, y)
            elif name in _BLOCKS:
                self.block(x, y, a.where, b.where)
            else:
                self._values(a, b, x, y)

    def _cases(self, a: Stmt, b: Stmt, x: list[tuple[Any, list[Stmt]]], y: list[tuple[Any, list[Stmt]]]) -> None:
        labels, own_labels = ([label for label, _ in cases] for cases in (x, y))
        if labels != own_labels:
            message = f"other constant: cases {_labels(labels)} in {PORT}, {_labels(own_labels)} in {OWN}"
            self.add_difference(a.where, b.where, message)
            return
        for (_, inner), (_, own_inner) in zip(x, y, strict=True):
            self.block(inner, own_inner, a.where, b.where)

    def _values(self, a: Stmt, b: Stmt, x: Any, y: Any) -> None:
        where, own_where, cause = self.expression(x, y)
        if self._retyped and cause.startswith("other type"):
            return  # what follows from the type of a local
        self.add_difference(where if where.file else a.where, own_where if own_where.file else b.where, cause)

    # Expressions

    def expression(self, a: Any, b: Any) -> tuple[Where, Where, str]:
        """Where two expressions that are not equal differ first, and why."""
        if isinstance(a, list) and isinstance(b, list):
            return self._lists(a, b)
        here = _where(a), _where(b)
        if type(a) is not type(b):
            return *here, self._other_kind(a, b)
        match a, b:
            case Const(), Const() if a.value != b.value:
                return *here, f"other constant: {source_text(a)} in {PORT}, {source_text(b)} in {OWN}"
            case (Binary() | Compare()), (Binary() | Compare()) if a.op != b.op:
                return *here, f"other operator: {text_of(a)} in {PORT}, {text_of(b)} in {OWN}"
            case (Binary() | Compare()), (Binary() | Compare()) if (self.key(a.left), self.key(a.right)) == (
                self.key(b.right), self.key(b.left)
            ):  # fmt: skip
                return *here, f"other operand order: {text_of(a)} in {PORT}, {text_of(b)} in {OWN}"
            case Variable(), Variable():
                return *here, f"other variable: {a.declaration.name} in {PORT}, {b.declaration.name} in {OWN}"
            case Function(), Function():
                return *here, f"other function: {a.name} in {PORT}, {b.name} in {OWN}"
            case RegisterRef(), RegisterRef() if register_text(a) != register_text(b):
                return *here, f"other register: {register_text(a)} in {PORT}, {register_text(b)} in {OWN}"
        if is_dataclass(a):
            return self._fields(a, b, here)
        return *here, f"{a} in {PORT}, {b} in {OWN}"

    def _fields(self, a: Any, b: Any, here: tuple[Where, Where]) -> tuple[Where, Where, str]:
        plain: list[str] = []
        for name in compared_fields(type(a)):
            x, y = getattr(a, name), getattr(b, name)
            if self.key(x) == self.key(y):
                continue
            if isinstance(x, CType) or not (is_dataclass(x) or isinstance(x, list)):
                plain.append(name)
                continue
            where, own_where, cause = self.expression(x, y)
            return where if where.file else here[0], own_where if own_where.file else here[1], cause
        if "ctype" in plain:
            return *here, f"other type: {text_of(b)} is {a.ctype} in {PORT}, {b.ctype} in {OWN}"
        if isinstance(a, LValue):
            return *here, f"other element: {text_of(a)} in {PORT}, {text_of(b)} in {OWN}"
        name = plain[0]
        return *here, f"other {name}: {getattr(a, name)!r} in {PORT}, {getattr(b, name)!r} in {OWN}"

    def _lists(self, a: list[Any], b: list[Any]) -> tuple[Where, Where, str]:
        for x, y in zip(a, b, strict=False):
            if self.key(x) != self.key(y):
                return self.expression(x, y)
        return Where("", 0), Where("", 0), f"other number of values: {len(a)} in {PORT}, {len(b)} in {OWN}"

    def _other_kind(self, a: Any, b: Any) -> str:
        if isinstance(b, Convert) and self._within(a, b):
            return f"other type: {OWN} converts {text_of(b.operand)} to {b.ctype}, {PORT} does not"
        if isinstance(a, Convert) and self._within(b, a):
            return f"other type: {PORT} converts {text_of(a.operand)} to {a.ctype}, {OWN} does not"
        if a is None or b is None:
            return f"other value: {text_of(a)} in {PORT}, {text_of(b)} in {OWN}"
        if text_of(a) == text_of(b):
            return f"other type: {text_of(b)} is converted otherwise"
        return f"other expression: {text_of(a)} in {PORT}, {text_of(b)} in {OWN}"

    def _within(self, inner: Any, outer: Expr) -> bool:
        """Whether an expression is another one with conversions around it."""
        while isinstance(outer, Convert):
            outer = outer.operand
            if self.key(inner) == self.key(outer):
                return True
        return False


def _locals(function: Function) -> list[Variable]:
    return [*function.parameters, *function.locals]


def _renamed(port: Function, own: Function) -> dict[Variable, str]:
    """One name for each local of both functions: parameters by place; locals by name, the rest by type and order."""
    names: dict[Variable, str] = {}
    for n, (a, b) in enumerate(zip(port.parameters, own.parameters, strict=False)):
        names[a] = names[b] = f"parameter {n}"
    ours = [v for v in port.locals if v not in names]
    theirs = [v for v in own.locals if v not in names]
    for by_name in (True, False):
        for a in [v for v in ours if v not in names]:
            wanted = _alike(a, by_name)
            found = next((v for v in theirs if v not in names and _alike(v, by_name) == wanted), None)
            if found is not None:
                names[a] = names[found] = f"local {len(names)}"
    return names


def _alike(variable: Variable, by_name: bool) -> tuple[str, str]:
    return variable.declaration.name if by_name else type_name(variable.ctype), variable.kind


def _declares(body: list[Stmt], where: str = "at the top") -> dict[Variable, tuple[Declare, str]]:
    """Every local with the statement that declares it, and in what kind of block that stands."""
    found: dict[Variable, tuple[Declare, str]] = {}
    for s in body:
        if isinstance(s, Declare):
            found.setdefault(s.variable, (s, where))
        for inner in blocks(s):
            for variable, known in _declares(inner, _block_text(s, inner)).items():
                found.setdefault(variable, known)
    return found


def _block_text(s: Stmt, inner: list[Stmt]) -> str:
    match s:
        case If(otherwise=otherwise):
            return "in the else" if inner is otherwise else "in the if"
        case Switch():
            return "in the switch"
    return "in the loop"


def _where(node: Any) -> Where:
    match node:
        case Expr(where=where) | LValue(where=where) | RegisterRef(where=where) | RegisterAt(where=where):
            return where
        case Index(expr=expr):
            return expr.where
    return Where("", 0)


def _labels(cases: list[list[int] | None]) -> str:
    return ", ".join("default" if label is None else " ".join(map(str, label)) for label in cases)


def text_of(node: Any) -> str:
    """An expression, or what it goes to, as its source says it."""
    match node:
        case None:
            return "nothing"
        case Binary(op=op, left=left, right=right) | Compare(op=op, left=left, right=right):
            return f"{source_text(left)} {op} {source_text(right)}"
        case Expr():
            return source_text(node)
        case LValue(text=text, root=root):
            return text or (root.declaration.name if isinstance(root, Variable) else source_text(root))
        case RegisterRef() | RegisterAt():
            return register_text(node)
        case Index(expr=expr):
            return source_text(expr)
        case Variable():
            return node.declaration.name
        case Function():
            return node.name
        case list():
            return "{" + ", ".join(map(text_of, node)) + "}"
    return str(node)


def statement_text(s: Stmt) -> str:
    """A statement in short, as C begins it."""
    match s:
        case Assign(target=target, value=value):
            return f"{text_of(target)} = {text_of(value)}"
        case CopyStruct(target=target, source=source):
            return f"{text_of(target)} = {text_of(source)}"
        case Evaluate(value=value):
            return text_of(value)
        case If(test=test):
            return f"if ({text_of(test)})"
        case While(test=test):
            return f"while ({text_of(test)})"
        case For(variable=variable):
            return f"for ({text_of(variable)} ...)"
        case Switch(subject=subject):
            return f"switch ({text_of(subject)})"
        case Return(value=value):
            return "return" if value is None else f"return {text_of(value)}"
        case Declare(variable=variable, value=value):
            begins = "" if value is None else f" = {text_of(value)}"
            return f"{variable.ctype} {variable.declaration.name}{begins}"
    named = {"LeaveSwitch": "break", "FallThrough": "the fall through", "Jump": "goto"}
    return named.get(type(s).__name__, type(s).__name__.lower())
