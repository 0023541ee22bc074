"""Variables of the firmware at file scope, looked at in a way that no detector takes for an access."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from emulator.c28x.ctypes import part_name, scalars
from emulator.c28x.link import Linked

#: A value now; None: never written, or no number.
VariableReader = Callable[[], float | None]


def variables(linked: Linked) -> Iterator[tuple[str, VariableReader]]:
    """Every scalar by its name, `module.object`, `module.object.member`, `module.object[3]`."""
    for path, obj in linked.objects.items():
        for index, (offset, _) in enumerate(scalars(obj.declaration.ctype)):
            yield path + part_name(obj.declaration.ctype, offset), _reader(obj.data, index)


def variable(linked: Linked, name: str) -> VariableReader | None:
    """The one of this name, if there is one."""
    for path, obj in linked.objects.items():
        if name == path or name.startswith((f"{path}.", f"{path}[")):
            for index, (offset, _) in enumerate(scalars(obj.declaration.ctype)):
                if path + part_name(obj.declaration.ctype, offset) == name:
                    return _reader(obj.data, index)
    return None


def _reader(data: list[Any], index: int) -> VariableReader:
    def look() -> float | None:
        value = data[index]
        return float(value) if isinstance(value, int | float) else None

    return look
