"""A desktop nobody sees: an X server in memory, real clicks and keys, pictures of the windows."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from PIL import Image, ImageGrab

from tests.hil.waiting import TIMEOUT_S, eventually

#: Program -> Debian's package.
PROGRAMS = {"Xvfb": "xvfb", "xdotool": "xdotool"}


def missing() -> str:
    """Why there can be no desk here, or ""."""
    lacking = [package for program, package in PROGRAMS.items() if shutil.which(program) is None]
    if find_spec("_tkinter") is None:
        lacking.append("python3-tk")
    return f"needs Debian's packages: {', '.join(lacking)}" if lacking else ""


class Window:
    """A window of the desk, by its title."""

    def __init__(self, desk: Desk, identity: str) -> None:
        self._desk = desk
        self.identity = identity

    def geometry(self) -> tuple[int, int, int, int]:
        """x, y, width, height on the screen."""
        shell = self._desk.xdotool("getwindowgeometry", "--shell", self.identity)
        values = dict(line.split("=") for line in shell.split())
        return int(values["X"]), int(values["Y"]), int(values["WIDTH"]), int(values["HEIGHT"])

    def move(self, x: int, y: int) -> None:
        self._desk.xdotool("windowmove", "--sync", self.identity, str(x), str(y))

    def click(self, x: int, y: int) -> None:
        """Click at a point of the window."""
        left, top, _, _ = self.geometry()
        self._desk.click(left + x, top + y)

    def colours(self) -> set[tuple[int, int, int]]:
        """What colours its pixels have."""
        picture = self.picture()
        return {colour for _, colour in picture.getcolors(picture.width * picture.height) or ()}  # type: ignore[misc]

    def picture(self) -> Image.Image:
        x, y, width, height = self.geometry()
        return self._desk.picture().crop((x, y, x + width, y + height))


class Desk:
    """An X display with a mouse and a keyboard.  There is no window manager: keys go where the mouse is."""

    def __init__(self, display: str, pictures: Path) -> None:
        self.display = display
        self.environment = {**os.environ, "DISPLAY": display}
        self._pictures = pictures
        pictures.mkdir(parents=True, exist_ok=True)

    def xdotool(self, *words: str) -> str:
        return subprocess.run(
            ["xdotool", *words], env=self.environment, capture_output=True, text=True, timeout=TIMEOUT_S, check=True
        ).stdout

    def window(self, title: str) -> Window:
        """Wait for a window with exactly this title."""

        def find() -> str:
            done = subprocess.run(
                ["xdotool", "search", "--onlyvisible", "--name", f"^{title}$"],
                env=self.environment, capture_output=True, text=True, timeout=TIMEOUT_S,
            )  # fmt: skip
            return done.stdout.strip().partition("\n")[0]

        return Window(self, eventually(find, what=f"a window {title!r}"))

    def point(self, x: int, y: int) -> None:
        """Put the mouse there."""
        self.xdotool("mousemove", "--sync", str(x), str(y))

    def click(self, x: int, y: int) -> None:
        """Press for 50 ms, as a finger does."""
        self.point(x, y)
        self.xdotool("mousedown", "1", "sleep", "0.05", "mouseup", "1")

    def key(self, name: str) -> None:
        """Tap a key."""
        self.xdotool("keydown", name, "sleep", "0.05", "keyup", name)

    def until_it_changes(self, act: Callable[[], None]) -> None:
        """Act, and wait until the screen has changed by it and come to rest."""
        before = self.picture().tobytes()
        act()
        eventually(lambda: self.picture().tobytes() != before, what="the screen changes")

        def rests() -> bool:
            shown = self.picture().tobytes()
            time.sleep(0.2)  # at rest: that nothing comes has no event
            return self.picture().tobytes() == shown

        eventually(rests, what="the screen comes to rest")

    @contextmanager
    def held(self, name: str) -> Iterator[None]:
        """Hold a key down."""
        self.xdotool("keydown", name)
        try:
            yield
        finally:
            self.xdotool("keyup", name)

    def write(self, text: str) -> None:
        self.xdotool("type", "--delay", "30", "--", text)

    def picture(self) -> Image.Image:
        return ImageGrab.grab(xdisplay=self.display).convert("RGB")

    def photograph(self, name: str) -> None:
        """Keep a picture of the screen."""
        self.picture().save(self._pictures / f"{name}.png")


@contextmanager
def desk(pictures: Path) -> Iterator[Desk]:
    """An X server on a display that is free."""
    read_fd, write_fd = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write_fd), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
        pass_fds=(write_fd,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(write_fd)
    try:
        with os.fdopen(read_fd) as answer:
            number = answer.readline().strip()
        assert number, "Xvfb did not start"
        yield Desk(f":{number}", pictures)
    finally:
        server.terminate()
        server.wait()
