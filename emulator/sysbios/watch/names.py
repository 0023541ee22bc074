"""Names of kernel objects in the firmware.  Each is the name of the file-scope object that holds the handle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from emulator.c28x.link import Linked
from emulator.c28x.tree import Call, Const, Convert, Evaluate, Function, FunctionRef, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import bare, different, parts, statements, within

#: Paths of file-scope objects.  None stands for objects that the source does not name.
Paths = set[str | None]


class HandleNames:
    """Finds the name of a handle: `of(handle)` returns `Status_server`, for example, and not `GateMutexPri`."""

    def __init__(self, linked: Linked) -> None:
        self._linked = linked
        self._known: dict[Any, str] = {}

    def of(self, handle: Any) -> str:
        """The name of the object that holds `handle`; without one, the kernel's own name."""
        known = self._known.get(handle)
        if known is not None:
            return known
        for obj in self._linked.objects.values():
            if any(value is handle for value in obj.data):
                name = self._known[handle] = obj.declaration.name
                return name
        return str(getattr(handle, "name", handle))

    def objects(self, handle: Any) -> set[str]:
        """Paths of the file-scope objects that hold `handle`."""
        return {path for path, obj in self._linked.objects.items() if any(value is handle for value in obj.data)}

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
        return {path for caller in self.functions for path in first_arguments(caller.body, function)}

    @property
    def whole(self) -> bool:
        """Whether the image is a whole program: one with a `main`."""
        return any(function.name == "main" for function in self.functions)

    def could(self, function: str, handle: Any) -> bool:
        """Whether a statement of the image can call `function` for `handle`; also True where the source does not tell.

        A function whose address is taken can be called for anything.
        """
        for caller in self.functions:
            for part in within(caller.body):
                if isinstance(part, FunctionRef) and part.function.name == function:
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

    def callers(self, function: str, handle: Any) -> list[str]:
        """The paths of the functions that can call `function` for `handle`, also where the source does not tell."""
        objects: Paths = {None, *self.objects(handle)}
        return [caller.path for caller in self.functions if objects & set(first_arguments(caller.body, function))]

    def only_given_to(self, path: str, function: str) -> bool:
        """Whether the source mentions the function `path` only in calls of `function`, and never calls it."""
        modules = self._linked.program.modules.values()
        variables = (variable for module in modules for variable in module.variables)
        starts = (expression for variable in variables for expression in different(variable.initial or ()))
        mentions = [part for expression in starts for part in parts(expression)]
        mentions += [part for caller in self.functions for part in within(caller.body)]
        given = [
            id(part) for call in mentions if isinstance(call, Call) and call.function.name == function
            for argument in call.arguments for part in parts(argument)
        ]  # fmt: skip
        return all(
            id(part) in given
            for part in mentions
            if isinstance(part, FunctionRef | Call) and part.function.path == path
        )

    def bits(self, function: str, handle: Any) -> int:
        """The bits that statements can pass to `function` as second argument, after `handle`.

        All bits where the source does not tell.
        """
        objects, bits = self.objects(handle), 0
        for caller in self.functions:
            made = [call for call in calls(caller.body) if call.function.name == function]
            for call, path in zip(made, first_arguments(caller.body, function), strict=True):
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


def first_arguments(body: list[Stmt], function: str) -> Iterator[str | None]:
    """The first argument of each call of `function` in a body: the path of the file-scope object that holds the handle.

    None where the source does not name one.

    An array of handles is one object.
    """
    for call in calls(body):
        if call.function.name == function:
            argument = call.arguments[0]
            match argument.operand if isinstance(argument, Convert) else argument:
                case Load(lvalue=LValue(root=Variable(kind="global") as variable)):
                    yield variable.declaration.path
                case _:
                    yield None
