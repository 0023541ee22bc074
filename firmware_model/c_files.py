"""The robot's own C files in the place of the modules that mirror them, any subset of them.

    link(board, firmware=["my_firmware"])                           # us.c, GYRO.c, ... of that folder
    Program(MODULES, **own(["us.c", "GYRO.c"]).arguments())

A file is known by its name, whatever its case.  CHOICE: of a folder only the robot's files are taken, since a project
of Code Composer holds much besides that this machine brings along; any other C file is linked if it is named itself.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping, Set
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Final, TypedDict

from emulator.c28x.program import Program, find_module
from firmware_model import headers

#: Headers of types alone: no C file belongs to them.
_WITHOUT_FILE: Final = ("ROBOT_types.h",)
#: The C files of the robot, as it spells them -> the module that mirrors each.
FILES: Final[Mapping[str, str]] = MappingProxyType({
    "main_Robot.c": "firmware_model.main_robot",
    **{f"{Path(name).stem}.c": h.module for name, h in headers.HEADERS.items() if name not in _WITHOUT_FILE},
})  # fmt: skip
_BY_KEY: Final = MappingProxyType({name.lower(): module for name, module in FILES.items()})


class Arguments(TypedDict):
    """What `Program` is told so that C files stand for modules of the port."""

    instead: Mapping[str, str]
    header: Callable[[str], str | None]
    library: Callable[[str], str | None]


@dataclass(frozen=True)
class UserFiles:
    """C files of a user: those that stand for a module, and what is linked besides."""

    #: Module of the port -> the file in its place.
    instead: Mapping[str, str]
    #: Files that mirror no module and were named: linked with the others.
    besides: tuple[str, ...] = ()
    #: C files that lie in a folder and are not the robot's: not read.
    left_out: tuple[str, ...] = ()

    @property
    def files(self) -> tuple[str, ...]:
        """Every file that is linked."""
        return (*self.instead.values(), *self.besides)

    def arguments(self) -> Arguments:
        """What `Program` is told: the files, the robot's headers, and who defines what they only declare."""
        return {"instead": self.instead, "header": headers.text, "library": library}

    def refuse_corrections(self, overlays: Mapping[str, str], fixes: Set[str]) -> None:
        """Raises ValueError if one of `fixes` is written for a module that a C file stands for."""
        for module, file in self.instead.items():
            if fixes and module in overlays:
                text = find_module(overlays[module]).read_text(encoding="utf-8")
                lost = sorted(fixes & set(re.findall(r'FIXED\("([^"]+)"', text)))
                if lost:
                    raise ValueError(f"{file}: the correction {lost[0]} is for the port, not for a C file of one's own")


def module_of(file: str | Path) -> str | None:
    """The module that mirrors a C file, by the file's name, whatever its case; None: a file of somebody else's."""
    return _BY_KEY.get(os.path.basename(file).lower())


def own(paths: Iterable[str | Path]) -> UserFiles:
    """The C files that `paths` mean: files, and those of the robot directly in a folder.

    Raises ValueError, in one line, for what is not there or no C file, for a folder without a file of the robot, for
    files of which none is the robot's, and for two that mirror one module.
    """
    instead: dict[str, str] = {}
    besides: list[str] = []
    left_out: list[str] = []
    listed = [Path(path) for path in paths]
    for path in listed:
        folder = path.is_dir()
        for file in _of_folder(str(path)) if folder else [_regular(str(path))]:
            module = module_of(file)
            if module is None:
                (left_out if folder else besides).append(file)
            elif module in instead and not os.path.samefile(instead[module], file):
                raise ValueError(f"{file} and {instead[module]} are the same file of the robot: give one of them")
            else:
                instead[module] = file
    if listed and not instead:
        raise ValueError(f"{listed[0]}: no C file of the robot: looked for {', '.join(FILES)}")
    return UserFiles(instead, tuple(dict.fromkeys(besides)), tuple(left_out))


def _of_folder(folder: str) -> list[str]:
    with os.scandir(folder) as entries:
        found = sorted((e.path, e.is_file()) for e in entries if e.name.lower().endswith(".c") and not e.is_dir())
    if not any(module_of(file) for file, _ in found):
        raise ValueError(f"{folder}: no C file of the robot in this folder: looked for {', '.join(FILES)}")
    return [file if regular or module_of(file) is None else _regular(file) for file, regular in found]


def _regular(file: str) -> str:
    if not os.path.exists(file):
        raise ValueError(f"{file}: there is no such file or folder")
    if not file.lower().endswith(".c") or not os.path.isfile(file):
        raise ValueError(f"{file}: expected a C file (*.c), or a folder with C files of the robot")
    return file


def library(function: str) -> str | None:
    """The module of the port that defines a function which a C file of the robot only declares."""
    return _functions().get(function)


@lru_cache(maxsize=1)
def _functions() -> Mapping[str, str]:
    """Function of the port -> the module that defines it."""
    program = Program(header.module for header in headers.HEADERS.values())
    return MappingProxyType({f.name: module.name for module in program.modules.values() for f in module.functions})
