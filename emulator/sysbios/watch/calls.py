"""Intercepts calls of an image's C functions: the function, its arguments, the calling statement.

The functions themselves do not change; an image that is not watched calls them directly.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from emulator.c28x.link import Linked
from emulator.sysbios.kernel import Kernel

#: Gets the arguments of the call.
Before = Callable[..., None]
#: Gets the result, then the arguments.
After = Callable[..., None]


class Calls:
    """Collects the listeners of each function.  `install` puts them between the image and its external functions.

    Calls by the host, while the kernel does not run, are not reported.
    """

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._before: dict[str, list[Before]] = {}
        self._after: dict[str, list[After]] = {}

    def before(self, *names: str, callback: Before) -> None:
        """Call `callback(*arguments)` before each call of these functions."""
        for name in names:
            self._before.setdefault(name, []).append(callback)

    def after(self, *names: str, callback: After) -> None:
        """Call `callback(result, *arguments)` after each call of these functions."""
        for name in names:
            self._after.setdefault(name, []).append(callback)

    def install(self, linked: Linked) -> None:
        """Put the listeners into an image."""
        for name in {**self._before, **self._after}:
            function = linked.namespace.get(f"_x_{name}")
            if function is not None:
                before, after = self._before.get(name, []), self._after.get(name, [])
                linked.replace(name, self._around(name, function, before, after))

    def _around(
        self, name: str, function: Callable[..., Any], before: list[Before], after: list[After]
    ) -> Callable[..., Any]:  # fmt: skip
        kernel = self._kernel
        # Listeners never get a wrong handle.  The function checks handles itself, but only after the listeners.
        handles = kernel.handles if before else None

        def call(*arguments: Any) -> Any:
            if not kernel.active:
                return function(*arguments)
            if handles is not None:
                arguments = handles.checked(name, arguments)
            for callback in before:
                callback(*arguments)
            result = function(*arguments)
            for callback in after:
                callback(result, *arguments)
            return result

        return call
