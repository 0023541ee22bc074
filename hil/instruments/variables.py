"""Reads variables of the firmware at file scope.  No detector counts this as an access of the firmware."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from emulator.c28x.ctypes import part_name, scalars
from emulator.c28x.link import Linked

#: A function that reads the present value.  None: never written, or no number.
VariableReader = Callable[[], float | None]


def variables(linked: Linked) -> Iterator[tuple[str, VariableReader]]:
    """All scalars by their names: `module.object`, `module.object.member`, `module.object[3]`."""
    for path, obj in linked.objects.items():
        for index, (offset, _) in enumerate(scalars(obj.declaration.ctype)):
            yield path + part_name(obj.declaration.ctype, offset), _reader(obj.data, index)


def variable(linked: Linked, name: str) -> VariableReader | None:
    """The reader of the scalar of this name; None if there is none."""
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
