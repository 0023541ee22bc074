"""The trees of a whole program in which a pointer that always points to one object is another name of it.

    static void Step(PUMP *p) { if (p->rest > 0) ... }      if (pump.rest > 0) ...
    ... Step(&pump);

Checks of a whole program know objects by their names.  A parameter that only ever gets `&pump`, a local that is set
once, a pointer at file scope that keeps its first value: what they point to has a name, and these checks get trees with
it.  The trees are for reading only: functions and statements without such a pointer are those of the program itself.

A pointer stays as it is if its address is taken, if it is computed or gets two addresses, or if its function is called
by a pointer.  The address of an object that only such pointers got is gone from the trees: nothing else reaches it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import chain
from operator import is_
from typing import Any, NamedTuple

from emulator.c28x.ctypes import ArrayType, PointerType
from emulator.c28x.passes.rewriting import Rewriting
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    Compare,
    Convert,
    Declare,
    Expr,
    Function,
    FunctionRef,
    If,
    Load,
    Logic,
    LValue,
    Not,
    Null,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import INNER, addressed, bare, once, own_nodes, roots, statements

#: The object to which a pointer points: a variable at file scope, and the offset in it in leaves and words.
Target = tuple[Variable, int, int]


def with_targets(modules: Iterable[Module]) -> list[Module]:
    """The modules of a whole program, with the names of what known pointers point to."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    view = _TargetView(functions, [v for module in modules for v in module.variables], _Pointers(functions))
    return [view.module(module, [view.named.get(v, v) for v in module.variables]) for module in modules]


class _PointerUses(NamedTuple):
    """What a function does with pointers."""

    #: The statements with an address, a pointer or what it leads to.
    statements: list[Stmt]
    #: The pointers that it sets, with what they get.
    set_to: list[tuple[Variable, Expr]]
    calls: list[Call]
    #: The variables and functions whose address it takes.
    taken: set[Variable]
    by_address: set[str]


@once
def _pointer_uses(function: Function) -> _PointerUses:
    found = _PointerUses([], [], [], set(), set())
    for s in statements(function.body):
        nodes = own_nodes(s)
        found.taken.update(addressed(nodes))
        found.by_address.update(p.function.path for p in nodes if isinstance(p, FunctionRef))
        found.calls.extend(p for p in nodes if isinstance(p, Call))
        if any(isinstance(p, AddressOf) or (isinstance(p, LValue) and _by_pointer(p.root)) for p in nodes):
            found.statements.append(s)
        match s:
            case Assign(target=LValue(root=Variable(ctype=PointerType()) as pointer), value=value):
                found.set_to.append((pointer, value))
            case Declare(variable=Variable(ctype=PointerType()) as pointer, value=Expr() as value):
                found.set_to.append((pointer, value))
    return found


def _by_pointer(root: Variable | Expr) -> bool:
    return isinstance(root, Expr) or isinstance(root.ctype, PointerType)


class _Pointers:
    """The pointers of a program that point to one object at file scope, as long as it runs."""

    def __init__(self, functions: list[Function]) -> None:
        #: Each pointer with all that it may get; None: with anything.
        self._gets: dict[Variable, list[Expr] | None] = {}
        uses = list(map(_pointer_uses, functions))
        for use in uses:
            for pointer, value in use.set_to:
                self._add(pointer, value)
        parameters = {f.path: f.parameters for f in functions}
        for call in chain.from_iterable(use.calls for use in uses):
            for pointer, value in zip(parameters.get(call.function.path, ()), call.arguments, strict=False):
                self._add(pointer, value)
        taken = set[Variable]().union(*(use.taken for use in uses))
        by_address = set[str]().union(*(use.by_address for use in uses))
        for function in functions:
            if function.path in by_address:
                taken.update(function.parameters)
        for pointer in taken & self._gets.keys():
            self._gets[pointer] = None
        #: Each pointer that `target` was asked for, with the answer.
        self.known: dict[Variable, Target | None] = {}

    def _add(self, pointer: Variable, value: Expr) -> None:
        values = self._gets.setdefault(pointer, [])
        if values is not None:
            values.append(value)

    def target(self, pointer: Variable) -> Target | None:
        """What a pointer points to; None: more than one object, or something else."""
        if pointer not in self.known:
            self.known[pointer] = None  # it may point to what it is made of itself
            self.known[pointer] = self._only(pointer)
        return self.known[pointer]

    def _only(self, pointer: Variable) -> Target | None:
        if not isinstance(pointer.ctype, PointerType):
            return None
        values = self._gets.get(pointer, [])
        if values is None:
            return None
        first = pointer.initial if pointer.kind == "global" and pointer.initial is not None else []
        targets = {self.of(value) for value in (*first, *values) if not isinstance(bare(value), Null)}
        return targets.pop() if len(targets) == 1 else None

    def of(self, value: Expr) -> Target | None:
        """The object to which an expression points."""
        match bare(value):
            case AddressOf(lvalue=LValue(indices=[], bits=None) as lvalue):
                return self.place(lvalue)
            case Load(lvalue=LValue(root=Variable() as pointer, indices=[], words=0)):
                return self.target(pointer)
        return None

    def place(self, lvalue: LValue) -> Target | None:
        """The object at file scope that an lvalue is in, also through a pointer that is known."""
        root = lvalue.root
        if isinstance(root, Variable):
            return (root, lvalue.leaf, lvalue.words) if root.kind == "global" and root.address is None else None
        target = self.of(root)
        return (target[0], target[1] + lvalue.leaf, target[2] + lvalue.words) if target is not None else None


class _TargetView(Rewriting):
    """Writes the trees anew, with the names of targets."""

    def __init__(self, functions: list[Function], objects: list[Variable], pointers: _Pointers) -> None:
        self._pointers = pointers
        self._parameters = {f.path: f.parameters for f in functions}
        #: What something reaches by its address, and what known pointers point to.
        reached: set[Variable] = set()
        pointed: set[Variable] = set()
        for function in functions:
            for s in _pointer_uses(function).statements:
                for root in roots(s):
                    self._look(root, s, reached, pointed)
        for v in objects:
            for value in v.initial or () if pointers.target(v) is None else ():
                if isinstance(value, AddressOf):
                    self._look(value, None, reached, pointed)
        #: Each object to which only known pointers point, and what it is in these trees.
        self.named = {v: replace(v, escapes=False) for v in pointed - reached}
        super().__init__(self.named)
        self.about |= {p for p, to in pointers.known.items() if to is not None and to[0] in self.named}

    def _look(self, e: Any, s: Stmt | None, reached: set[Variable], pointed: set[Variable]) -> None:
        """Find what a part of a statement reaches by an address."""
        inner: list[Any] = []
        match e:
            case LValue(root=Expr() as root, indices=indices) if (target := self._pointers.of(root)) is not None:
                pointed.add(target[0])
                inner = list(indices)
            case Compare(left=left, right=right) if isinstance(bare(left), Null) or isinstance(bare(right), Null):
                inner = self._asked([left, right])
            case Not(operand=operand):
                inner = self._asked([operand])
            case Logic(operands=operands):
                inner = self._asked(operands)
            case Expr() if isinstance(s, If | While) and self._pointers.of(e) is not None:
                return
            case Call(function=Function(path=path), arguments=arguments, extra=extra):
                parameters = self._parameters.get(path, [])
                for number, argument in enumerate(arguments):
                    given = parameters[number] if number < len(parameters) else None
                    target = self._pointers.target(given) if given is not None else None
                    if target is None:
                        inner.append(argument)
                    else:
                        pointed.add(target[0])
                inner += extra
            case AddressOf(lvalue=lvalue) if (target := self._pointers.place(lvalue)) is not None:
                if not self._defines(s, e):
                    reached.add(target[0])
                inner = list(lvalue.indices)
            case Load(lvalue=LValue(root=Variable() as pointer)) if target := self._pointers.target(pointer):
                if not self._defines(s, e):
                    reached.add(target[0])
            case _:
                for name in INNER.get(type(e), ()):
                    value = getattr(e, name)
                    inner += value if isinstance(value, list) else [value]
        for part in inner:
            self._look(part, s if isinstance(e, Convert) else None, reached, pointed)

    def _asked(self, operands: list[Expr]) -> list[Expr]:
        """The operands of a test without known pointers: whether these are null says nothing of their targets."""
        return [operand for operand in operands if self._pointers.of(operand) is None]

    def _defines(self, s: Stmt | None, e: Expr) -> bool:
        """Whether a statement gives an address to a pointer that is known."""
        match s:
            case (
                Assign(target=LValue(root=Variable() as pointer), value=value)
                | Declare(variable=pointer, value=Expr() as value)
            ) if bare(value) is e:  # fmt: skip
                return self._pointers.target(pointer) is not None
        return False

    def instead(self, node: Any) -> Any:
        """A node with the name of the target of a pointer."""
        match node:
            case LValue():
                place = self._pointers.place(node)
                if place is not None and place[0] in self.named:
                    root, leaf, words = place
                    volatile = node.volatile or root.volatile
                    return replace(node, root=self.named[root], leaf=leaf, words=words, volatile=volatile)
            case Call(function=Function(path=path), arguments=arguments) if path in self._parameters:
                given = list(map(self._name, self._parameters[path], arguments))
                if not all(map(is_, given, arguments)):
                    return replace(node, arguments=[*given, *arguments[len(given) :]])
            case (
                Assign(target=LValue(root=Variable() as pointer), value=value)
                | Declare(variable=pointer, value=Expr() as value)
            ) if (name := self._name(pointer, value)) is not value:  # fmt: skip
                return replace(node, value=name)
        return node

    def _name(self, pointer: Variable, value: Expr) -> Expr:
        """What a pointer gets; without an address, if the pointer is another name of its target, which is no array."""
        target = self._pointers.target(pointer)
        match bare(value):
            case AddressOf(lvalue=LValue(ctype=ArrayType())):
                return value
        return Null(value.ctype, where=value.where) if target is not None and target[0] in self.named else value
