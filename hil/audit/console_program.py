"""Runs the unmodified console of TFG annex 2 on a desk in virtual time.

Stand-ins replace the modules that it imports (pyserial, Tk, matplotlib, the keyboard, the clock) and files on `C:`.
`C2000_HIL_CONSOLE` names the program; this project has no copy.  With a real window, it is tested by
`tests/hil/console/test_thesis_console.py`.
"""

from __future__ import annotations

import builtins
import io
import os
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

from hil.audit.console_desk import Desk
from hil.audit.console_model import FOLDER, on_axis

VARIABLE: Final = "C2000_HIL_CONSOLE"


def at_hand() -> Path | None:
    """The path of the program, if there is one."""
    name = os.environ.get(VARIABLE, "")
    return Path(name) if name and Path(name).is_file() else None


class _SerialException(Exception):
    """Replaces the exception of pyserial."""


class _DeskFile(io.StringIO):
    """A file of the desk.  The desk gets its content when the file is closed."""

    def __init__(self, files: dict[str, str], name: str, mode: str) -> None:
        if mode == "r" and name not in files:
            raise FileNotFoundError(name)
        if mode == "w":
            files[name] = ""
        super().__init__(files[name], newline="")
        self._files, self._name, self._mode = files, name, mode
        if mode == "a":
            self.seek(0, io.SEEK_END)

    def close(self) -> None:
        if not self.closed and self._mode != "r":
            self._files[self._name] = self.getvalue()
        super().close()


class _Widget:
    """Any widget.  Widgets with a command are clicked by their text."""

    def __init__(self, program: ConsoleProgram, *_master: object, **options: Any) -> None:
        self._program = program
        self.config(**options)
        if "command" in options:
            program.desk.commands[options["text"]] = options["command"]

    def config(self, **options: Any) -> None:
        if "background" in options:
            self._program.desk.label = options["text"]

    configure = config

    def place(self, **_where: object) -> None:
        """Do nothing: the position does not matter here."""

    def after(self, _delay_ms: int, _what: Callable[[], None]) -> None:
        """Do nothing: it would update the text of the label, which nothing here reads."""


class _Entry(_Widget):
    """The entries beside SET.  The program creates that for V first."""

    def __init__(self, program: ConsoleProgram, *master: object, **options: Any) -> None:
        super().__init__(program, *master, **options)
        self._text = next(program.texts, "")

    def get(self) -> str:
        return self._text


class _Window(_Widget):
    def title(self, _text: str) -> None:
        """Do nothing."""

    def config(self, **_options: Any) -> None:
        """Do nothing: it sets the size and the menu."""

    def update(self) -> None:
        self._program.desk.update()

    def mainloop(self) -> None:
        while True:
            self.update()


class _Menu(_Widget):
    def add_cascade(self, **_options: object) -> None:
        """Do nothing: no click goes there."""

    def add_command(self, label: str, command: Callable[[], None]) -> None:
        self._program.desk.commands[label] = command


class ConsoleProgram:
    """The stand-ins for the modules and functions that the program uses."""

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.texts = iter((desk.script.v, desk.script.w))
        self._plotted: list[tuple[float, float]] = []
        configuration = f"{desk.script.port}# COM donde esta el XBee\n{desk.script.archive}\n"
        desk.files[FOLDER + "configuracion.txt"] = configuration
        kinds: dict[str, type[_Widget]] = {
            "Tk": _Window, "Menu": _Menu, "Label": _Widget, "Button": _Widget, "Entry": _Entry,
        }  # fmt: skip
        widgets = {name: self._maker(kind) for name, kind in kinds.items()}
        self._modules = {
            "serial": SimpleNamespace(Serial=self._open_port, SerialException=_SerialException),
            "time": SimpleNamespace(sleep=desk.wait),
            "io": SimpleNamespace(open=self._open),
            "tkinter": SimpleNamespace(**widgets, ttk=SimpleNamespace(**widgets)),
            "msvcrt": SimpleNamespace(getch=None),
            "keyboard": SimpleNamespace(is_pressed=desk.pressed),
            "pandas": SimpleNamespace(),
            "numpy": SimpleNamespace(),
            "datetime": SimpleNamespace(datetime=SimpleNamespace(now=lambda: desk.now_s)),
            "matplotlib": SimpleNamespace(
                animation=SimpleNamespace(),
                pyplot=SimpleNamespace(
                    ion=self._nothing, title=self._nothing, legend=self._nothing, show=self._nothing,
                    axis=self._nothing, plot=self._plot, pause=self._pause,
                ),
            ),
        }  # fmt: skip
        self._modules["matplotlib.pyplot"] = self._modules["matplotlib.animation"] = self._modules["matplotlib"]

    def run(self, path: Path) -> None:
        """Run the program from its first line."""
        names = {
            **vars(builtins), "__import__": self._import, "open": self._open, "print": self._nothing,
            "quit": self._leave,
        }  # fmt: skip
        code = compile(path.read_text("utf-8"), str(path), "exec", dont_inherit=True)
        exec(code, {"__builtins__": names, "__name__": "__main__"})

    def _maker(self, kind: type[_Widget]) -> Callable[..., _Widget]:
        return lambda *master, **options: kind(self, *master, **options)

    def _import(self, name: str, *arguments: Any) -> Any:
        return self._modules[name] if name in self._modules else builtins.__import__(name, *arguments)

    def _nothing(self, *_arguments: object, **_options: object) -> None:
        """Do nothing: it changes neither the robot nor the map."""

    def _leave(self) -> None:
        raise SystemExit

    def _open(self, name: str, mode: str = "r") -> _DeskFile:
        return _DeskFile(self.desk.files, name, mode)

    def _open_port(self, port: str, baudrate: int, timeout: float) -> SimpleNamespace:
        desk = self.desk
        desk.opened = port
        return SimpleNamespace(
            write=desk.write, read=lambda size=1: desk.read(size, timeout), inWaiting=lambda: desk.waiting,
            isOpen=lambda: True,
        )  # fmt: skip

    def _plot(self, x: list[Any], y: list[Any], *_form: object, label: str = "", **_options: object) -> None:
        if label == "Trayectoria Robot":
            self.desk.loaded = len(x)
            self.desk.path = list(zip(on_axis(x), on_axis(y), strict=True))
        elif label:
            self.desk.legend += 1
            self._plotted.append((x[0], y[0]))
        if label == "Left US":
            robot, right, left = self._plotted[-3:]
            self.desk.draw(robot, left, right)

    def _pause(self, duration_s: float) -> None:
        """Wait, and update the window: matplotlib runs Tk during a pause."""
        self.desk.wait(duration_s)
        self.desk.update()
