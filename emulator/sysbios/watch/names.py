"""Names of kernel objects in the firmware.  Each is the name of the object, or of the member, that holds the handle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from emulator.c28x.ctypes import ArrayType, CType, StructType
from emulator.c28x.link import Linked
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Call, Const, Convert, Evaluate, Function, FunctionRef, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import bare, blocks, different, own_nodes, parts, statements, within

#: Paths of file-scope objects.  None stands for objects that the source does not name.
Paths = set[str | None]


class _Mentions:
    """The calls of functions and the pointers to them in the source of an image.  It is read once for all questions."""

    __slots__ = ("all", "calls", "pointed")

    def __init__(self, modules: Iterable[Module], functions: Iterable[Function]) -> None:
        #: Path of a function -> the calls of it and pointers to it.
        self.all: dict[str, list[Call | FunctionRef]] = {}
        #: Name of a function -> its calls in functions, each with the caller.
        self.calls: dict[str, list[tuple[Function, Call]]] = {}
        #: The names of functions whose address is taken, by a function or in the initial value of an object.
        self.pointed: set[str] = set()
        for module in modules:
            for variable in module.variables:
                for expression in different(variable.initial or ()):
                    for part in parts(expression):
                        self._mentioned(part)
        for caller in functions:
            for part in within(caller.body):
                self._mentioned(part)
                if isinstance(part, Call):
                    self.calls.setdefault(part.function.name, []).append((caller, part))

    def _mentioned(self, part: Any) -> None:
        if isinstance(part, Call | FunctionRef):
            self.all.setdefault(part.function.path, []).append(part)
        if isinstance(part, FunctionRef):
            self.pointed.add(part.function.name)


class HandleNames:
    """Finds the name of a handle: `of(handle)` returns `Status_server`, for example, and not `GateMutexPri`."""

    def __init__(self, linked: Linked) -> None:
        self._linked = linked
        self._known: dict[Any, str] = {}
        self._read: _Mentions | None = None

    @property
    def _mentions(self) -> _Mentions:
        """What the source says of functions, read at the first question."""
        if self._read is None:
            self._read = _Mentions(self._linked.program.modules.values(), self.functions)
        return self._read

    def of(self, handle: Any) -> str:
        """The name of the object that holds `handle`; without one, the kernel's own name."""
        known = self._known.get(handle)
        if known is not None:
            return known
        for obj in self._linked.objects.values():
            leaf = next((leaf for leaf, value in enumerate(obj.data) if value is handle), None)
            if leaf is not None:
                declaration = obj.declaration
                name = self._known[handle] = scalar_path(declaration.name, declaration.ctype, leaf, subscripts=True)
                return name
        return str(getattr(handle, "name", handle))

    def objects(self, handle: Any) -> set[str]:
        """Paths of the file-scope objects that hold `handle`, and of the members of structures that do."""
        return {
            scalar_path(path, obj.declaration.ctype, leaf)
            for path, obj in self._linked.objects.items() for leaf, value in enumerate(obj.data) if value is handle
        }  # fmt: skip

    @property
    def functions(self) -> list[Function]:
        """The functions of the image that have a body."""
        return [
            function
            for module in self._linked.program.modules.values()
            for function in module.functions
            if function.body
        ]

    def passed(self, function: str) -> Paths:
        """The first arguments that statements of the image pass to `function`."""
        return {first_argument(call) for _, call in self._mentions.calls.get(function, ())}

    def passed_by(self, *functions: str) -> dict[str, Paths]:
        """The first arguments that functions of the image pass to any of these functions, by the caller's path."""
        found: dict[str, Paths] = {}
        for function in functions:
            for caller, call in self._mentions.calls.get(function, ()):
                found.setdefault(caller.path, set()).add(first_argument(call))
        return found

    @property
    def whole(self) -> bool:
        """Whether the image is a whole program: one with a `main`."""
        return any(function.name == "main" for function in self.functions)

    def could(self, function: str, handle: Any) -> bool:
        """Whether a statement of the image can call `function` for `handle`; also True where the source does not tell.

        A function whose address is taken can be called for anything.
        """
        if function in self._mentions.pointed:
            return True
        passed, objects = self.passed(function), self.objects(handle)
        # If no file-scope object holds the handle now, any of them may have held it before.
        return None in passed or bool(passed & objects) or bool(passed and not objects)

    def idle_calls(self, function: str) -> set[tuple[str, int]]:
        """File and line of the calls of `function` whose result nothing uses."""
        return {
            (statement.where.file, statement.where.line)
            for caller in self.functions
            for statement in statements(caller.body)
            if isinstance(statement, Evaluate)
            and isinstance(call := bare(statement.value), Call)
            and call.function.name == function
        }

    def mentions(self, function: str) -> bool:
        """Whether some function of the image calls `function`, or takes its address."""
        return function in self._mentions.calls or function in self._mentions.pointed

    def places(self, function: str, handle: Any) -> list[Place]:
        """The statements that call `function` for `handle`; none if the source does not tell all of them."""
        objects = self.objects(handle)
        if function in self._mentions.pointed or not objects or None in self.passed(function):
            return []
        return [
            Place(s.where.file, s.where.line, caller.name, caller.c_file, s.where.column)
            for caller in self.functions for s in statements(caller.body) for part in own_nodes(s)
            if isinstance(part, Call) and part.function.name == function and first_argument(part) in objects
        ]  # fmt: skip

    def callers(self, function: str, handle: Any) -> list[str]:
        """The paths of the functions that can call `function` for `handle`, also where the source does not tell."""
        objects: Paths = {None, *self.objects(handle)}
        return [path for path, passed in self.passed_by(function).items() if objects & passed]

    def only_given_to(self, path: str, function: str) -> bool:
        """Whether the source mentions the function `path` only in calls of `function`, and never calls it."""
        given = [
            id(part) for _, call in self._mentions.calls.get(function, ())
            for argument in call.arguments for part in parts(argument)
        ]  # fmt: skip
        return all(id(part) in given for part in self._mentions.all.get(path, ()))

    def bits(self, function: str, handle: Any) -> int:
        """The bits that statements can pass to `function` as second argument, after `handle`.

        All bits where the source does not tell.
        """
        objects, bits = self.objects(handle), 0
        for _, call in self._mentions.calls.get(function, ()):
            path = first_argument(call)
            if path is None or path in objects:
                mask = bare(call.arguments[1])
                bits |= mask.value if isinstance(mask, Const) and isinstance(mask.value, int) else ~0
        return bits

    def brings(self, event: Any) -> bool:
        """Whether a semaphore or mailbox posts `event` by itself."""
        held = (value for obj in self._linked.objects.values() for value in obj.data)
        return any(
            getattr(part, "event", None) is event
            for value in held for part in (value, getattr(value, "full", None), getattr(value, "free", None))
        )  # fmt: skip


def calls(body: list[Stmt]) -> Iterator[Call]:
    """The calls in a function's body."""
    return (part for part in within(body) if isinstance(part, Call))


def calls_before(body: list[Stmt], name: str, earlier: str) -> Iterator[tuple[Call, list[Call]]]:
    """The calls of `name`, each with the calls of `earlier` that come before it in its block or in those around it."""

    def inside(block: list[Stmt], before: list[Call]) -> Iterator[tuple[Call, list[Call]]]:
        for s in block:
            own = [node for node in own_nodes(s) if isinstance(node, Call)]
            yield from ((call, before) for call in own if call.function.name == name)
            before = before + [call for call in own if call.function.name == earlier]
            for inner in blocks(s):
                yield from inside(inner, before)

    return inside(body, [])


def first_argument(call: Call) -> str | None:
    """The path of the file-scope object that holds the handle in the first argument; None where the source names none.

    A member of a structure is an object of its own: `drv.link.ready`.  An array of handles is one object.
    """
    argument = call.arguments[0]
    match argument.operand if isinstance(argument, Convert) else argument:
        case Load(lvalue=LValue(root=Variable(kind="global") as variable, leaf=leaf)):
            return scalar_path(variable.declaration.path, variable.ctype, leaf)
    return None


def scalar_path(path: str, ctype: CType, leaf: int, *, subscripts: bool = False) -> str:
    """The path of the scalar number `leaf` of an object, with or without the subscripts of arrays."""
    while True:
        if isinstance(ctype, ArrayType):
            ctype = ctype.element
            element, leaf = divmod(leaf, ctype.leaves)
            path += f"[{element}]" if subscripts else ""
        elif isinstance(ctype, StructType) and ctype.members and not ctype.word_backed:
            first = leaf
            member = next(m for m in reversed(ctype.members) if m.leaf <= first)
            path, ctype, leaf = f"{path}.{member.name}", member.ctype, leaf - member.leaf
        else:
            return path
