"""The firmware's own names of kernel objects: the file-scope object that holds the handle."""

from __future__ import annotations

from typing import Any

from emulator.c28x.linker import Linked
from emulator.c28x.tree import Call, Convert, Load, LValue, Variable
from emulator.c28x.tree_queries import parts, roots, statements


class Names:
    """`of(handle)`: `Status_server` rather than `GateMutexPri`."""

    def __init__(self, linked: Linked) -> None:
        self._linked = linked
        self._known: dict[Any, str] = {}

    def of(self, handle: Any) -> str:
        """The name of the object that holds `handle`, else the kernel's."""
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

    def passed(self, function: str) -> set[str] | None:
        """File-scope objects that any statement passes to `function` first; None if one passes something else."""
        found: set[str] = set()
        for module in self._linked.program.modules.values():
            for body in (f.body for f in module.functions):
                calls = (p for s in statements(body) for root in roots(s) for p in parts(root) if isinstance(p, Call))
                for argument in (call.arguments[0] for call in calls if call.function.name == function):
                    inner = argument.operand if isinstance(argument, Convert) else argument
                    match inner:
                        case Load(lvalue=LValue(root=Variable(kind="global") as variable, indices=[])):
                            found.add(variable.declaration.path)
                        case _:
                            return None
        return found
