"""What all kernel objects share: time, the type of the running thread, assertions, and calls of firmware functions.

Sources: SYS/BIOS `BIOS.xdc` (thread types), XDCtools `xdc/runtime/Assert`, `Error`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, Final, NoReturn

from emulator.c28x.ctypes import FLOAT, FloatType
from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.sysbios.costs import scaled
from emulator.trace import Trace

# BIOS_ThreadType
HWI: Final = 0
SWI: Final = 1
TASK: Final = 2
MAIN: Final = 3

FALSE: Final = 0
TRUE: Final = 1
NO_WAIT: Final = 0
#: `~(0U)` with a 16-bit unsigned int.  The width of the parameter that takes it does not matter.
WAIT_FOREVER: Final = 0xFFFF

Function = Callable[..., Any]


class KernelError(Exception):
    """The kernel has aborted the program (System_abort), as `Assert`, and `Error_raise` without an Error_Block, do.

    `identifier` is the kernel's own name of the reason: `Semaphore_A_badContext`, `Task_E_stackOverflow`, ...
    """

    def __init__(self, identifier: str, message: str) -> None:
        super().__init__(f"{identifier}: {message}")
        self.identifier = identifier


class KernelObject:
    """The object of a handle.  `name` may be set to the firmware's name; `deleted`: `*_delete` was called for it."""

    __slots__ = ("deleted", "name")

    def __init__(self, name: str) -> None:
        self.name = name
        self.deleted = False


class KernelCore:
    """State that the kernel's modules share."""

    __slots__ = ("asserts", "clock", "costs", "cpu", "double", "findings", "thread_type", "trace")

    def __init__(
        self, clock: Clock, cpu: Cpu, findings: Findings, trace: Trace, *, cost_scale: float, asserts: bool
    ) -> None:
        self.clock = clock
        self.cpu = cpu
        self.findings = findings
        self.trace = trace
        self.costs = scaled(cost_scale)
        self.asserts = asserts
        self.thread_type = MAIN
        #: What the program calls `double`; whoever links it sets this.
        self.double: FloatType = FLOAT

    def check(self, condition: bool, identifier: str, message: str) -> None:
        """`Assert_isTrue`: raise KernelError unless `condition` holds.  Does nothing while asserts are disabled."""
        if not condition and self.asserts:
            raise KernelError(identifier, message)

    def error(self, error_block: Any, identifier: str, message: str) -> None:
        """`Error_raise`: store the error in the caller's Error_Block; without one, end the program."""
        if error_block is None:
            raise KernelError(identifier, message)
        error_block.member("id").store(error_number(identifier))


def error_number(identifier: str) -> int:
    """The number of an error in `Error_Block.id`, never 0.  CHOICE: it is a sum of the identifier's characters."""
    return sum((index + 1) * ord(letter) for index, letter in enumerate(identifier)) & 0xFFFF | 0x10000


def fitted(core: KernelCore, function: Function | None, given: int, what: str) -> Function:
    """A firmware function, ready to be called with `given` arguments.

    C casts function pointers freely and passes arguments in registers, so a function with fewer parameters ignores
    the rest.  Raises ValueError for a function with more parameters, which would read a stale register.  A pointer to
    no function (NULL) is a finding when it is called, at the place where the firmware passed it.
    """
    if not callable(function):
        return _nowhere(core, what)
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return function
    if any(each.kind is each.VAR_POSITIONAL for each in parameters):
        return function
    wanted = sum(
        each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD) and each.default is each.empty
        for each in parameters
    )
    if wanted > given:
        raise ValueError(f"{what} {function_name(function)} wants {wanted} arguments, the kernel passes {given}")
    accepted = sum(each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD) for each in parameters)
    if accepted >= given:
        return function

    def fewer(*arguments: Any) -> Any:
        return function(*arguments[:accepted])

    fewer.__wrapped__ = function  # type: ignore[attr-defined]
    return fewer


def _nowhere(core: KernelCore, what: str) -> Function:
    """The function that is called in place of a pointer that points to no function."""
    findings = core.findings
    path = findings.path(findings.position.at, findings.position.calls)
    message = f"the kernel calls the {what} that was given here, but it points to no function"

    def call(*_arguments: Any) -> NoReturn:
        if path:
            findings.report_at(path[0], "null-dereference", message, how="dynamic", object=what, call_path=path)
        else:
            findings.report("null-dereference", message, object=what)
        raise KernelError("null-dereference", message)

    return call


def function_name(function: Function) -> str:
    """The C name of a function."""
    return str(getattr(function, "__name__", type(function).__name__))


class UniqueNames:
    """Unique names for one kind of object: the wanted name, with `#2` and so on appended if it is taken."""

    __slots__ = ("_taken",)

    def __init__(self) -> None:
        self._taken: dict[str, int] = {}

    def unique(self, wanted: str) -> str:
        """A name that no other object has."""
        count = self._taken.get(wanted, 0) + 1
        self._taken[wanted] = count
        return wanted if count == 1 else f"{wanted}#{count}"
