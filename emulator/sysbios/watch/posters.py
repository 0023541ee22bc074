"""Which tasks can post a semaphore.  The calls in the source tell it: a thread that is stuck has not posted yet."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from emulator.c28x.link import Linked
from emulator.c28x.tree_queries import reached
from emulator.sysbios.kernel import Kernel
from emulator.sysbios.scheduler import TERMINATED, Task
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.swi import Swi
from emulator.sysbios.watch.names import HandleNames, Paths, calls, first_argument


class Posters:
    """Finds the tasks that can post a semaphore, if nobody else can: `of(semaphore)`."""

    def __init__(self, kernel: Kernel, linked: Linked, names: HandleNames) -> None:
        self._kernel = kernel
        self._linked = linked
        self._names = names
        #: Per function, read at the first question: the functions that it calls or whose address it takes; those that
        #: it calls; the semaphores that it posts.
        self._mentioned: dict[str, set[str]] = {}
        self._called: dict[str, set[str]] = {}
        self._posted: dict[str, Paths] = {}

    def _read(self) -> None:
        """Read the calls of every function, once."""
        for module in self._linked.program.modules.values() if not self._posted else ():
            for function in module.functions:
                self._mentioned[function.path] = function.calls
                made = list(calls(function.body))
                self._called[function.path] = {call.function.path for call in made}
                posts = (call for call in made if call.function.name == "Semaphore_post")
                self._posted[function.path] = {first_argument(post) for post in posts}

    def of(self, semaphore: Semaphore) -> set[Task] | None:
        """Tasks whose code posts `semaphore`; None if a Clock, Swi, Hwi or unknown code could post it too."""
        self._read()
        objects: Paths = {None, *self._names.objects(semaphore)}
        left = {path for path, posted in self._posted.items() if posted & objects}
        if not left:
            return None
        found: set[Task] = set()
        for what, function in self._threads():
            path = self._linked.path_of(function)
            if path not in self._posted:
                return None
            inside = self._posted.keys() & reached([path], lambda name: self._mentioned.get(name, set()))
            if any(self._posted[name] & objects for name in inside):
                if not isinstance(what, Task):
                    return None
                found.add(what)
                left -= inside
        for path in self._posted:
            if path.endswith(".main"):  # `main` does not return.  A function whose address it passes is a thread's.
                inside = self._posted.keys() & reached([path], lambda name: self._called.get(name, set()))
                left -= inside
        return found if found and not left else None

    def _threads(self) -> Iterator[tuple[Any, Any]]:
        """All threads that run code of the firmware, each with the function that it begins with."""
        kernel = self._kernel
        for task in kernel.tasks.all:
            if task.mode != TERMINATED and task.priority != 0:
                yield task, task.function
        for timer in kernel.clocks.queue:
            if timer.name:  # The kernel's own timeouts have none.
                yield timer, timer.function
        for hwi in kernel.hwis.table.values():
            if getattr(hwi.function, "__self__", None) is not kernel.clocks:
                yield hwi, hwi.function
        for obj in self._linked.objects.values():
            for value in obj.data:
                if isinstance(value, Swi):
                    yield value, value.function
