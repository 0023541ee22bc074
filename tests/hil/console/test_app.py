"""What is read from a console program, and the folder that is laid out for it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.console.app import App, read_app
from hil.console.folder import RunFolder, configuration
from hil.console.needs import check

SOURCE = """
from __future__ import annotations
import os, serial.tools
import keyboard
from msvcrt import getch
from tkinter import ttk
try:
    import colorama
except ImportError:
    colorama = None
def later():
    import torch
with open("C:/año 4/configuracion.txt") as f, open("C:/año 4/trayectoria.txt", "a") as g:
    pass
open("C:/año 4/trayectoriaa.txt")
print("http://x", "C:", "c:/x\\ny", "/tmp/x")
"""


@pytest.fixture
def app(tmp_path: Path) -> App:
    path = tmp_path / "main.py"
    path.write_text(SOURCE, "utf-8")
    return read_app(path)


def test_what_it_needs_is_what_it_imports_at_its_top(app: App) -> None:
    assert app.packages == ("serial", "tkinter")
    assert app.draws


def test_files_on_a_drive_are_found(app: App) -> None:
    assert app.drive_paths == (
        "C:/año 4/configuracion.txt", "C:/año 4/trayectoria.txt", "C:/año 4/trayectoriaa.txt",
    )  # fmt: skip


@pytest.mark.parametrize("text", [b"def (", b"\xff\xfe\x00", b"a = '\xe9'"])
def test_what_is_no_python_is_one_line(tmp_path: Path, text: bytes) -> None:
    path = tmp_path / "main.py"
    path.write_bytes(text)
    with pytest.raises(ValueError, match=r"main\.py.*: is no Python program"):
        read_app(path)


def test_a_folder_points_to_the_program_in_it(app: App) -> None:
    with pytest.raises(ValueError, match=r"is a folder; give .*main\.py"):
        read_app(app.path.parent)


def test_the_configuration_is_as_the_console_cuts_it() -> None:
    # The port is columns 0 to 3 of the file, its file name columns 29 to 44 (annex 2), a line feed being one.
    text = configuration()
    assert text[0:4] == "COM3"
    assert text[29:45].strip() == "trayectoria.txt"


def test_the_folder_has_what_the_console_opens(app: App, tmp_path: Path) -> None:
    folder = RunFolder(tmp_path / "a" / "run", app)
    inside = folder.path / "C:" / "año 4"
    assert [path.name for path in inside.iterdir()] == ["configuracion.txt"]
    assert (inside / "configuracion.txt").read_text("utf-8") == configuration()
    assert folder.port == folder.path / "COM3"


def test_points_of_an_earlier_run_stay_and_can_be_loaded(app: App, tmp_path: Path) -> None:
    inside = RunFolder(tmp_path / "run", app).path / "C:" / "año 4"
    (inside / "trayectoria.txt").write_text("X,Y\n1,2\n")
    (inside / "configuracion.txt").write_text("COM12 # what the console's dialogue writes")
    RunFolder(tmp_path / "run", app)
    assert (inside / "trayectoria.txt").read_text() == "X,Y\n1,2\n"
    assert (inside / "trayectoriaa.txt").read_text() == "X,Y\n1,2\n"
    assert (inside / "configuracion.txt").read_text("utf-8") == configuration()


def test_missing_packages_are_one_line_with_both_names(tmp_path: Path) -> None:
    app = App(tmp_path / "main.py", ("serial_not_here", "json"), ())
    with pytest.raises(ValueError, match="serial_not_here") as caught:
        check(app)
    assert "pip install serial_not_here" in str(caught.value)
    assert "apt install python3-serial_not_here" in str(caught.value)


def python_without(names: list[str], folder: Path) -> str:
    """A Python that cannot import some modules."""
    path = folder / "python"
    blocked = "; ".join(f"sys.modules[{name!r}] = None" for name in names)
    site = folder / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(f"import sys; {blocked}\n")
    path.write_text(f'#!/bin/sh\nPYTHONPATH={site} exec {sys.executable} "$@"\n')
    path.chmod(0o755)
    return str(path)


def test_a_python_without_tk_is_one_line_with_the_package(tmp_path: Path) -> None:
    app = App(tmp_path / "main.py", ("tkinter",), ())
    with pytest.raises(ValueError, match="tkinter") as caught:
        check(app, python_without(["tkinter", "_tkinter"], tmp_path))
    assert "apt install python3-tk" in str(caught.value)
    assert "--python" in str(caught.value)


def test_what_matplotlib_needs_to_draw_in_tk_is_asked_for_too(tmp_path: Path) -> None:
    app = App(tmp_path / "main.py", ("matplotlib", "tkinter"), ())
    with pytest.raises(ValueError, match=r"PIL\.ImageTk.*pip install pillow.*python3-pil\.imagetk"):
        check(app, python_without(["PIL.ImageTk", "PIL"], tmp_path))


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere Tk needs no X display")
def test_no_display_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("tkinter", reason="needs Debian's package python3-tk")
    monkeypatch.delenv("DISPLAY", raising=False)
    app = App(tmp_path / "main.py", ("tkinter",), ())
    with pytest.raises(ValueError, match=r"no display .*xvfb"):
        check(app)


@pytest.mark.parametrize("python", ["/nowhere/python", "/bin/false", "/bin/echo"])
def test_a_python_that_is_none_is_one_line(python: str, app: App, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["console", "--app", str(app.path), "--python", python]) == 2
    err = capsys.readouterr().err
    assert python in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--dir", "somewhere"], "--app"),
        (["--view"], "--port"),
        (["--app", "nothing.py"], "nothing.py"),
        (["--app", "."], "is a folder"),
    ],
)
def test_wrong_arguments_are_one_line(arguments: list[str], complaint: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["console", *arguments]) == 2
    err = capsys.readouterr().err
    assert complaint in err
    assert err.startswith("hil: error: ")
    assert err.count("\n") == 1


def test_on_windows_it_says_what_to_run_instead(
    app: App, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("hil.cli.console.POSIX", False)
    assert invoke(["console", "--app", str(app.path)]) == 2
    assert "hil run --port COM8" in capsys.readouterr().err
