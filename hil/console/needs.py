"""Checks that everything that a console needs is installed: its packages, Tk, a display.

The check runs in the Python that will run the console.  If something is missing, one line says how to install it, with
the names of Debian's package and of pip's.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from typing import Final

from hil.console.app import App

#: The check normally takes a second at most.  It would take for ever if a display does not answer.
TIMEOUT_S: Final = 30.0
#: The back end of matplotlib that uses the same windows as the app.
BACK_END: Final = "TkAgg"
_BACK_END_NEEDS: Final = "PIL.ImageTk"

#: The imported name -> (Debian's package, pip's package).
_PACKAGES: Final = {
    "tkinter": ("python3-tk", ""),
    "serial": ("python3-serial", "pyserial"),
    "PIL.ImageTk": ("python3-pil.imagetk", "pillow"),
    "PIL": ("python3-pil", "pillow"),
}

#: A program that prints which of the given names cannot be imported, and the error of Tk about the display.
_QUESTION: Final = """
import importlib.util, json, sys
folder, windows, *names = sys.argv[1:]
sys.path.insert(0, folder)
answer = {"missing": [], "display": ""}
for name in names:
    try:
        if importlib.util.find_spec(name) is None:
            raise ImportError
        if name == "tkinter":  # without Tk itself it can be found, and not imported
            importlib.import_module(name)
    except ImportError:
        answer["missing"].append(name)
if windows == "windows" and "tkinter" not in answer["missing"]:
    import tkinter
    try:
        tkinter.Tk().destroy()
    except tkinter.TclError as error:
        answer["display"] = str(error)
print(json.dumps(answer))
"""


@dataclass(frozen=True, slots=True)
class _Answer:
    missing: tuple[str, ...]
    display: str


def environment(app: App) -> dict[str, str]:
    """The environment variables of the app's process."""
    result = {**os.environ, "PYTHONUTF8": "1", "PYTHONUNBUFFERED": "1"}
    if app.draws:
        result["MPLBACKEND"] = BACK_END
    return result


def check(app: App, python: str = sys.executable) -> None:
    """Raise ValueError, one line, if `python` cannot run the app here."""
    names = list(app.packages)
    if {"matplotlib", "tkinter"} <= set(names):
        names.append(_BACK_END_NEEDS)
    answer = _ask(app, python, names)
    if answer.missing:
        raise ValueError(f"{app.path.name} needs {_how(answer.missing, python)}")
    if answer.display:
        raise ValueError(
            f"{app.path.name} opens windows and there is no display ({answer.display}): run it in a desktop session, "
            "or under xvfb-run (Debian: apt install xvfb)"
        )


def _ask(app: App, python: str, names: list[str]) -> _Answer:
    windows = "windows" if app.draws else "none"
    command = [python, "-c", _QUESTION, str(app.path.parent), windows, *names]
    try:
        done = subprocess.run(
            command, env=environment(app), capture_output=True, text=True, timeout=TIMEOUT_S, check=True
        )
        answer = json.loads(done.stdout)
        return _Answer(tuple(answer["missing"]), " ".join(answer["display"].split()))
    except subprocess.TimeoutExpired:
        raise ValueError(f"{python}: gave no answer in {TIMEOUT_S:.0f} s; does the display answer?") from None
    except (subprocess.CalledProcessError, json.JSONDecodeError, KeyError):
        raise ValueError(f"{python}: is no working Python 3") from None


def _how(missing: tuple[str, ...], python: str) -> str:
    """The text that says what to install for the missing names."""
    known = [_PACKAGES.get(name, (f"python3-{name.lower()}", name)) for name in missing]
    debian = " ".join(package for package, _ in known)
    pip = " ".join(package for _, package in known if package)
    text = f"{', '.join(missing)}, which {python} does not have"
    ways = [f"{python} -m pip install {pip}" if pip else "", f"apt install {debian} for Debian's own Python"]
    text += ": " + ", or ".join(way for way in ways if way)
    if "tkinter" in missing:
        text += "; tkinter comes with the Python, not from pip: choose one that has it (--python /usr/bin/python3)"
    return text
