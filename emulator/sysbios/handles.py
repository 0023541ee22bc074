"""Checks handles: is the argument of a kernel function a living object of the right kind?

The prototypes in `headers.py` tell which arguments are handles.  The real kernel does not check.  Through a handle that
was never created it reads and writes the RAM at address 0.  Through a deleted one it uses memory that the heap may have
given to another object.  CHOICE: here the program ends, as by an assertion, because what follows would depend on
unknown bytes.
Sources: XDCtools, `*_create` and `*_delete` of an instance; rule `kernel-handle`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, wraps
from types import FunctionType, MappingProxyType
from typing import Any, Final, NamedTuple

from emulator.c28x.memory import NULL, Memory, Pointer
from emulator.c28x.program import Program
from emulator.sysbios import headers as declarations
from emulator.sysbios.core import Function, KernelCore, KernelError, KernelObject

#: A function that finds the object of one kind that a value stands for; None if it stands for none.
Find = Callable[[Any], "KernelObject | None"]
#: Annotations of parameters that are not handles.
_NUMBERS: Final = ("int", "float", "bool")
#: Handles that may be NULL: the argument of a function.
_OPTIONAL: Final = frozenset({
    ("Semaphore_registerEvent", 1),
    *((f"Memory_{name}", 0) for name in ("alloc", "calloc", "valloc", "free", "getStats")),
})  # fmt: skip
#: Before tasks run these return without a look at the gate (`GateMutexPri.c`: Task_self() is NULL).
_NOT_BEFORE_TASKS: Final = frozenset({"GateMutexPri_enter", "GateMutexPri_leave"})


@lru_cache(maxsize=1)
def headers() -> Mapping[str, Any]:
    """The declarations of `headers.py`."""
    return MappingProxyType(Program().module("emulator.sysbios.headers").symbols)


class HandlePrototype(NamedTuple):
    """A C function: how many arguments it has, and of each handle which argument, its type, whether a pointer to it."""

    arguments: int
    handles: tuple[tuple[int, str, bool], ...]


@lru_cache(maxsize=1)
def prototypes() -> Mapping[str, HandlePrototype]:
    """The C functions that take handles.

    The names of the types tell; `headers` would take as long as linking a kept program.
    """
    found = {}
    for name, function in vars(declarations).items():
        if isinstance(function, FunctionType):
            types = [text for parameter, text in function.__annotations__.items() if parameter != "return"]
            handles = tuple((i, *_handle(text)) for i, text in enumerate(types) if "_Handle" in text)
            if handles:
                found[name] = HandlePrototype(len(types), handles)
    return MappingProxyType(found)


def _handle(text: str) -> tuple[str, bool]:
    """The name of a handle's type, and whether `text` is a pointer to the handle."""
    name = text.removeprefix("ptr[").removesuffix("]")
    return name, name != text


def _may_take_handles(function: Function) -> bool:
    """Whether any parameter may be a handle.  The annotations tell; a compiled function has none."""
    annotations = getattr(function, "__annotations__", None)
    return annotations is None or any(
        kind not in _NUMBERS for name, kind in annotations.items() if name != "return"
    )


class Handles:
    """Checks the handles that calls pass.

    `classes`: the name of a handle's type -> the class of its object.  `finders`: the same names -> a function that
    finds the object, for types where the class is not enough.  `in_task()`: whether a task runs.
    """

    def __init__(
        self, core: KernelCore, memory: Memory | None, classes: Mapping[str, type[KernelObject]],
        finders: Mapping[str, Find], in_task: Callable[[], bool],
    ) -> None:  # fmt: skip
        self._in_task = in_task
        self._core = core
        self._memory = memory
        self.classes = classes
        self.finders = finders
        #: C function -> its handles: which argument, and the class of its object (None: the class is not enough).
        self._passed: dict[str, list[tuple[int, type[KernelObject] | None]]] = {}

    def guarded(self, name: str, function: Function) -> Function:
        """A C function that checks its handles before it does anything else."""
        if not _may_take_handles(function):
            return function
        arguments, handles = prototypes().get(name, HandlePrototype(0, ()))
        # Where the first argument is the only handle, its class is enough.  A call with any number of arguments takes
        # three times as long as one with as many as the kernel's busiest functions have.
        wanted = self.classes.get(handles[0][1]) if len(handles) == 1 and handles[0][0] == 0 else None
        if wanted is not None and not handles[0][2]:
            if arguments == 1:

                @wraps(function)
                def call_with_handle(handle: Any) -> Any:
                    if isinstance(handle, KernelObject) and type(handle) is wanted and not handle.deleted:
                        return function(handle)
                    return function(*self.checked(name, (handle,)))

                return call_with_handle
            if arguments == 2:

                @wraps(function)
                def call_with_handle_and_argument(handle: Any, argument: Any) -> Any:
                    if isinstance(handle, KernelObject) and type(handle) is wanted and not handle.deleted:
                        return function(handle, argument)
                    return function(*self.checked(name, (handle, argument)))

                return call_with_handle_and_argument

        @wraps(function)
        def call(*passed: Any) -> Any:
            if passed and passed[0].__class__ is wanted and not passed[0].deleted:
                return function(*passed)
            return function(*self.checked(name, passed))

        return call

    def checked(self, name: str, arguments: tuple[Any, ...]) -> tuple[Any, ...]:
        """The arguments of a C function, with objects where numbers stood for them.

        Raises KernelError, after a finding, for a handle without a living object of its kind.
        """
        passed = self._passed.get(name)
        if passed is None:
            handles = prototypes()[name].handles if name in prototypes() else ()
            passed = self._passed[name] = [(i, self.classes.get(kind)) for i, kind, _ in handles]
        for i, wanted in passed:
            value = arguments[i]
            if not isinstance(value, KernelObject) or type(value) is not wanted or value.deleted:
                return self._found(name, arguments)
        return arguments

    def _found(self, name: str, arguments: tuple[Any, ...]) -> tuple[Any, ...]:
        """As `checked`, for arguments that are not all living objects."""
        if name in _NOT_BEFORE_TASKS and not self._in_task():
            return arguments
        for i, kind, behind in prototypes()[name].handles:
            value = arguments[i]
            if value.__class__ is self.classes.get(kind) and not value.deleted:
                continue
            if behind and value is not None:
                value = value.load()
            if (value is None or value is NULL) and (name, i) in _OPTIONAL:
                continue
            found = self.living(kind, value, name)
            if isinstance(value, int):
                arguments = (*arguments[:i], found, *arguments[i + 1 :])
        return arguments

    def living(self, kind: str, value: Any, function: str) -> KernelObject:
        """The object of a handle, or of the number that it was cast to.  Raises KernelError, after a finding."""
        if isinstance(value, int) and self._memory is not None:
            value = self._memory.code_at(value) or value
        found = self._find(kind, value)
        if found is not None and not found.deleted:
            return found
        if found is not None:
            what = f"{found.name}, which was deleted"
        elif value is None or (isinstance(value, Pointer) and not value):
            what = f"NULL as {kind}: the object was never created, its creation failed, or it was deleted"
        else:
            what = f"{value.name if isinstance(value, KernelObject) else value}, which is no {kind}"
        message = f"{function} is given {what}"
        self._core.findings.report("kernel-handle", message, object=function)
        raise KernelError("kernel-handle", message)

    def _find(self, kind: str, value: Any) -> KernelObject | None:
        wanted = self.classes.get(kind)
        if wanted is None:
            return self.finders[kind](value)
        return value if isinstance(value, wanted) else None
