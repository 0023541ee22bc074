"""What `run`, `check`, `tasks`, `audit` and `conformance` share: the robot's own C files and how they are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION, FLOAT_DIVISIONS
from hil.cli import show

#: The options, one definition for all commands.
Firmware = Annotated[
    list[Path] | None,
    typer.Option(
        "--firmware", metavar="DIR", help="Your C files with the robot's file names: folder or file; repeatable."
    ),
]
#: Of commands with `--board`.
FirmwareOrProgram = Annotated[
    list[Path] | None,
    typer.Option(
        "--firmware", metavar="DIR",
        help="Your C files with the robot's file names, or the program of --board: folder or file; repeatable.",
    ),
]
Project = Annotated[
    Path | None,
    typer.Option("--project", metavar="FILE",
        help="A Code Composer .cproject file (default: the one beside the C files)."),
]
Include = Annotated[
    list[Path] | None, typer.Option("-I", metavar="DIR", help="A folder of C headers; repeatable.")
]
Define = Annotated[
    list[str] | None, typer.Option("-D", metavar="NAME[=VALUE]", help="Define a macro for C files; repeatable.")
]
FloatDivision = Annotated[
    str | None,
    typer.Option(
        "--float-division", metavar="BUILD",
        help=f"The time of a float division: {', '.join(FLOAT_DIVISIONS)} "
        f"(default {DEFAULT_FLOAT_DIVISION}).",
    ),
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class OwnC:
    """The fields of a `Setup` that say which C files are linked; empty: the port alone."""

    firmware: tuple[str, ...] = ()
    include: tuple[str, ...] = ()
    defines: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """As keyword arguments."""
        return asdict(self)


def own_c(
    firmware: Sequence[Path] | None, project: Path | None, include: Sequence[Path] | None,
    define: Sequence[str] | None, *, robot: bool = True,
) -> OwnC:  # fmt: skip
    """The C files, folders and macros of the options; notes about files left out go to stderr.

    Files of a `robot` take the places of its modules, by their names; those of another board are a program.

    Raises ValueError for what is not there, and for options that mean nothing without C files.
    """
    if not firmware:
        for option, value in (("--project", project), ("-I", include), ("-D", define)):
            if value:
                raise ValueError(f"{option} needs C files: give --firmware DIR")
        return OwnC()
    if not robot:
        return OwnC(tuple(map(str, firmware)), *read_as(firmware, project, include, define))
    from firmware_model.c_files import own

    found = own(firmware)
    for file in found.left_out:
        show.print_line(
            f"note: {file}: no file of the robot, left out (--firmware {file} links it too)", to_stderr=True
        )
    return OwnC(found.files, *read_as(firmware, project, include, define))


def read_as(
    paths: Sequence[Path], project: Path | None, include: Sequence[Path] | None, define: Sequence[str] | None,
) -> tuple[tuple[str, ...], tuple[str, ...]]:  # fmt: skip
    """Include folders and macros for C files: those of the options, and of the project that lies beside the files.

    Raises ValueError for what is not there or no project.
    """
    from emulator.c28x.readers.c import project as code_composer
    from hil.drivers.files import defines, folders

    beside = [path / code_composer.NAME for path in paths if path.is_dir()]
    projects = [project] if project is not None else [path for path in beside if path.exists()]
    read = [code_composer.read(path) for path in projects]
    for note in (note for one in read for note in one.notes):
        show.print_line(f"note: {note}", to_stderr=True)
    folders_said = [str(folder) for folder in folders(include or ())]
    return (
        tuple(dict.fromkeys([*folders_said, *(folder for one in read for folder in one.include)])),
        tuple(dict.fromkeys([*(d for one in read for d in one.defines), *defines(define or ())])),
    )
