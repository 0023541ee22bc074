"""What an app finds in place of Windows' modules, and that nobody else finds it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import pytest

from hil.console import runner
from hil.console.runner import load_stand_in

REPOSITORY = Path(__file__).parents[3]

pytestmark = pytest.mark.skipif(os.name != "posix", reason="on Windows the real modules are there")


@dataclass
class KeyEvent:
    keysym: str
    char: str = ""


class Keyboard:
    """The stand-in with a clock of ours."""

    def __init__(self, module: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
        self.module = module
        self.now_s = 100.0
        monkeypatch.setattr(module, "time", self)

    def monotonic(self) -> float:
        return self.now_s

    def down(self, keysym: str, char: str = "") -> None:
        self.module._pressed(KeyEvent(keysym, char))

    def up(self, keysym: str, char: str = "") -> None:
        self.module._released(KeyEvent(keysym, char))

    def after(self, seconds: float) -> Keyboard:
        self.now_s += seconds
        return self

    def __call__(self, name: str) -> bool:
        return bool(self.module.is_pressed(name))


@pytest.fixture
def keyboard(monkeypatch: pytest.MonkeyPatch) -> Iterator[Keyboard]:
    tkinter = pytest.importorskip("tkinter", reason="needs Debian's package python3-tk")
    monkeypatch.setattr(tkinter.Tk, "__init__", tkinter.Tk.__init__)  # what loading changes is put back
    yield Keyboard(load_stand_in("keyboard"), monkeypatch)
    sys.modules.pop("stand_in_keyboard", None)


def test_a_key_is_down_from_a_little_after_its_press_to_its_release(keyboard: Keyboard) -> None:
    assert not keyboard("up")
    keyboard.down("Up")
    # The thesis' TELE asks 1 ms after `update`: there a real key goes down while the loop sleeps, not before.
    assert not keyboard.after(0.001)("up")
    assert keyboard.after(0.1)("up")
    assert keyboard.after(5.0)("up")
    keyboard.up("Up")
    assert not keyboard.after(0.1)("up")


def test_on_a_busy_machine_too_a_press_is_not_seen_in_the_turn_that_brought_it(keyboard: Keyboard) -> None:
    keyboard.down("Escape")
    # The process waits for the CPU between `update` and the first query: there the thesis' TELE would end the program.
    assert not keyboard.after(0.1)("esc")
    assert keyboard.after(0.1)("esc")


def test_repetitions_of_a_held_key_are_no_new_presses(keyboard: Keyboard) -> None:
    keyboard.down("Left")
    keyboard.after(0.5)
    for _ in range(20):  # X11 sends both at once
        keyboard.up("Left")
        keyboard.down("Left")
        assert keyboard("left")
        keyboard.after(0.04)
    assert keyboard("left")


def test_a_tap_that_nobody_saw_is_seen_once(keyboard: Keyboard) -> None:
    keyboard.down("Escape")
    keyboard.up("Escape")
    assert keyboard.after(0.5)("esc")
    assert not keyboard("esc")


def test_a_tap_is_seen_by_a_loop_that_asks_once_a_second(keyboard: Keyboard) -> None:
    keyboard.down("Escape")
    keyboard.up("Escape")
    assert not keyboard.after(0.001)("esc")
    assert keyboard.after(1.0)("esc")
    assert not keyboard.after(1.0)("esc")


def test_a_tap_of_long_ago_is_not_seen(keyboard: Keyboard) -> None:
    keyboard.down("Escape")
    keyboard.up("Escape")
    assert not keyboard.after(2.0)("esc")


def test_a_key_that_was_seen_ends_with_its_release(keyboard: Keyboard) -> None:
    keyboard.down("Down")
    assert keyboard.after(0.5)("down")
    keyboard.up("Down")
    assert not keyboard.after(0.05)("down")


def test_keys_are_let_go_when_the_keyboard_goes_to_another_window(keyboard: Keyboard) -> None:
    keyboard.down("Right")
    assert keyboard.after(0.5)("right")
    keyboard.module._left(None)
    assert not keyboard.after(0.05)("right")


@pytest.mark.parametrize(
    ("name", "keysym", "char"),
    [
        ("esc", "Escape", "\x1b"), ("enter", "Return", "\r"), ("space", "space", " "),
        (" ", "space", " "), ("a", "a", "a"), ("A", "A", "A"), ("+", "plus", "+"),
        ("ñ", "ntilde", "ñ"), ("page up", "Prior", ""), ("F1", "F1", ""),
    ],
)  # fmt: skip
def test_keys_have_the_packages_names(keyboard: Keyboard, name: str, keysym: str, char: str) -> None:
    keyboard.down(keysym, char)
    assert keyboard.after(0.5)(name)
    assert not keyboard("tab")


def test_several_keys_are_down_when_each_is(keyboard: Keyboard) -> None:
    keyboard.down("Control_L")
    assert not keyboard.after(0.5)("ctrl+a")
    keyboard.down("a", "a")
    assert keyboard.after(0.5)("ctrl+a")


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The other end of a terminal that is our standard input and output."""
    master, slave = os.openpty()
    with os.fdopen(slave, "r+b", buffering=0) as end:
        monkeypatch.setattr(sys, "stdin", end)
        monkeypatch.setattr(sys, "stdout", end)
        yield master
    os.close(master)


def test_keys_of_a_terminal_come_one_by_one_without_enter(terminal: int) -> None:
    msvcrt = load_stand_in("msvcrt")
    assert not msvcrt.kbhit()
    os.write(terminal, b"ab\r")
    assert msvcrt.kbhit()
    assert [msvcrt.getch(), msvcrt.getche()] == [b"a", b"b"]


def test_a_character_of_several_bytes_is_one_key(terminal: int) -> None:
    msvcrt = load_stand_in("msvcrt")
    os.write(terminal, "ñ€x".encode())
    assert [msvcrt.getwch() for _ in range(3)] == ["ñ", "€", "x"]
    os.write(terminal, b"\xffx")
    assert [msvcrt.getwch() for _ in range(2)] == ["\ufffd", "x"]


def test_only_the_app_finds_them(tmp_path: Path) -> None:
    """`subprocess`, `getpass` and others ask for `msvcrt` to learn whether they are on Windows."""
    (tmp_path / "main.py").write_text(
        "from msvcrt import getch\n"
        "import msvcrt, part\n"
        "import subprocess, getpass, multiprocessing.spawn\n"
        "assert subprocess._mswindows is False\n"
        "assert getpass.getpass is getpass.unix_getpass\n"
        "assert part.getch is getch is msvcrt.getch\n"
        "import library, sys\n"
        "assert not library.windows\n"
        "assert 'msvcrt' not in sys.modules\n"
        "print(subprocess.run([sys.executable, '-c', 'import subprocess; print(subprocess._mswindows)'],\n"
        "                     capture_output=True, text=True).stdout)\n"
    )
    (tmp_path / "part.py").write_text("from msvcrt import getch\n")
    site = tmp_path / "lib" / "site-packages"
    site.mkdir(parents=True)
    (site / "library.py").write_text("try:\n import msvcrt\n windows = True\nexcept ImportError:\n windows = False\n")
    done = subprocess.run(
        [sys.executable, runner.__file__, str(tmp_path / "main.py")],
        env={**os.environ, "PYTHONPATH": str(site)}, capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "False", "")


def test_the_runner_needs_nothing_of_this_project(tmp_path: Path) -> None:
    (tmp_path / "main.py").write_text(
        "import sys\nprint([n for n in sys.modules if n.split('.')[0] in ('hil', 'emulator')])"
    )
    done = subprocess.run(
        [sys.executable, runner.__file__, str(tmp_path / "main.py")],
        cwd=tmp_path, capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.stdout.strip() == "[]"
