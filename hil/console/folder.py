"""The folder a console runs in.

The console of the thesis opens ``C:/.../configuracion.txt``, which on POSIX is a path below the working directory, and
opens the port whose name is the first *four* characters of that file: so a link ``COM3`` in the same folder.  It writes
its points beside its configuration, and loads them from a file with another name.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Final

from hil.console.app import App

#: Four characters, the console reads no more.
PORT_NAME: Final = "COM3"
CONFIGURATION: Final = "configuracion.txt"
#: What the console writes, and what its LOAD FILE reads.
WRITTEN_POINTS: Final = "trayectoria.txt"
LOADED_POINTS: Final = "trayectoriaa.txt"
OUTPUT: Final = "output.txt"
#: The console reads a file name from column 29 on and never uses it.
_PORT_FIELD: Final = 29


class RunFolder:
    """A folder laid out for an app.  What the app wrote in earlier runs stays."""

    def __init__(self, path: Path, app: App) -> None:
        """Lay it out.  Raises OSError if that is not possible."""
        self.path = path.absolute()
        self.path.mkdir(parents=True, exist_ok=True)
        for name in app.drive_paths:
            file = self.path / name
            file.parent.mkdir(parents=True, exist_ok=True)
            if file.name == CONFIGURATION:
                # Anew each time: the console's own dialogue for it writes what the console cannot read.
                file.write_text(configuration(), encoding="utf-8")
            elif file.name == LOADED_POINTS and file.with_name(WRITTEN_POINTS).is_file():
                shutil.copyfile(file.with_name(WRITTEN_POINTS), file)

    @property
    def port(self) -> Path:
        """Where the port's link belongs."""
        return self.path / PORT_NAME

    @property
    def output(self) -> Path:
        """Where the app's output goes."""
        return self.path / OUTPUT


def configuration() -> str:
    """The console's configuration file: port, and name of the file of points."""
    return f"{PORT_NAME + ' # port of the robot':{_PORT_FIELD}}\n{WRITTEN_POINTS} # file of points\n"
