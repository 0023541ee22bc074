"""The folder in which a console runs.

The console of the thesis opens ``C:/.../configuracion.txt``, which on POSIX is a path below the working directory.  It
opens the port whose name is the first *four* characters of that file.  So there is a link ``COM3`` in the folder.  The
console writes its points beside its configuration, and loads them from a file with another name.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Final

from hil.console.app import App

#: The name has four characters, because the console reads no more.
PORT_NAME: Final = "COM3"
CONFIGURATION: Final = "configuracion.txt"
#: The file that the console writes, and the file that its LOAD FILE reads.
WRITTEN_POINTS: Final = "trayectoria.txt"
LOADED_POINTS: Final = "trayectoriaa.txt"
OUTPUT: Final = "output.txt"
#: The console reads a file name from column 29 on, but never uses it.
_PORT_FIELD: Final = 29


class RunFolder:
    """A folder for an app.  Files that the app wrote in earlier runs stay."""

    def __init__(self, path: Path, app: App) -> None:
        """Create the folder and its files.  Raises OSError if that is not possible."""
        self.path = path.absolute()
        self.path.mkdir(parents=True, exist_ok=True)
        for name in app.drive_paths:
            file = self.path / name
            file.parent.mkdir(parents=True, exist_ok=True)
            if file.name == CONFIGURATION:
                # It is written each time: the console's own dialogue writes a file that the console cannot read.
                file.write_text(configuration(), encoding="utf-8")
            elif file.name == LOADED_POINTS and file.with_name(WRITTEN_POINTS).is_file():
                shutil.copyfile(file.with_name(WRITTEN_POINTS), file)

    @property
    def port(self) -> Path:
        """The path of the link to the port."""
        return self.path / PORT_NAME

    @property
    def output(self) -> Path:
        """The path of the file for the app's output."""
        return self.path / OUTPUT


def configuration() -> str:
    """The text of the console's configuration file: the port, and the name of the file of points."""
    return f"{PORT_NAME + ' # port of the robot':{_PORT_FIELD}}\n{WRITTEN_POINTS} # file of points\n"
