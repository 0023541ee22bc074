"""The robot's own C files in the place of the modules that mirror them, any subset of them.

    Program(MODULES, **replacing(["thesis/us.c", "thesis/GYRO.c"]))
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import Any

from emulator.c28x.program import Program
from firmware_model import headers


def module_of(file: str | Path) -> str | None:
    """The module that mirrors a C file, by the file's name, whatever its case; None: a file of somebody else's."""
    name = f"firmware_model.{Path(file).stem.lower()}"
    known = {header.module for header in headers.HEADERS.values()} | {"firmware_model.main_robot"}
    return name if name in known else None


@lru_cache(maxsize=1)
def libraries() -> dict[str, str]:
    """Function of the port -> the module that defines it: what a C file of the robot only declares."""
    program = Program(header.module for header in headers.HEADERS.values())
    return {function.name: module.name for module in program.modules.values() for function in module.functions}


def replacing(files: Iterable[str | Path]) -> dict[str, Any]:
    """The arguments of `Program` that put C files in the place of modules of the port.

    Raises ValueError for a file that mirrors none, and for two that mirror one.
    """
    instead: dict[str, str] = {}
    for file in files:
        name = module_of(file)
        if name is None:
            raise ValueError(f"{file}: the robot has no C file of that name")
        if name in instead:
            raise ValueError(f"{file} and {instead[name]} are the same file of the robot")
        instead[name] = str(file)
    return {"instead": instead, "header": headers.text, "libraries": libraries()}
