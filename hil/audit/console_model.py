"""A model of the console of TFG annex 2: the bytes and times of each button, and the display of the robot's frames.

With the ids of catalogue entries (`CONS-...`), the model does not have the defects of these entries.

It is a description in our words; this project has no copy of the program.  If the program is available,
`tests/hil/audit/test_console_model.py` checks that both send the same bytes at the same times.
"""

from __future__ import annotations

import math
from collections.abc import Container, Sequence
from contextlib import suppress
from typing import Final

from hil.audit.console_desk import Desk

FOLDER: Final = "C:/D/Documentos/4 año/TFG/logs trayectoria/"
DRIVE_FILE: Final = FOLDER + "trayectoria.txt"
#: The file that LOAD FILE opens.
LOAD_FILE: Final = FOLDER + "trayectoriaa.txt"
HEADER: Final = "X,Y,theta,dF,dR,dL\n"
#: The greatest speeds of the robot (TFG 3.2.3).
V_MOST_M_S: Final = 0.3
W_MOST_RAD_S: Final = 1.57
#: If frames are missing for this time, the corrected console says that the robot is gone.
GONE_S: Final = 1.0


def on_axis(values: Sequence[str] | Sequence[float]) -> list[float]:
    """The positions of values on a matplotlib axis.  Texts are categories, in the order in which they first appear."""
    if not any(isinstance(value, str) for value in values):
        return [float(value) for value in values]
    places: dict[object, float] = {}
    return [places.setdefault(value, float(len(places))) for value in values]


class ConsoleModel:
    """The console on a desk; `corrected`: the ids of its corrected entries."""

    def __init__(self, desk: Desk, corrected: Container[str] = ()) -> None:
        self.desk = desk
        self.corrected = corrected
        self.v_m_s = self.w_rad_s = 0.0
        #: The numbers of the last frame, as text, and the characters after it.
        self.text = ""
        self.pending = ""
        self.points: list[tuple[int, ...]] = []

    def run(self) -> None:
        """Run the console from its start."""
        desk = self.desk
        port = desk.script.port
        desk.opened = port.split()[0] if self.fixed("CONS-port-name") else port[:4]
        desk.write(b"#STOP\r")
        desk.wait(0.5)
        desk.wait(0.5)
        desk.commands |= {
            "MISION": self.mission, "STOP": self.stop, "TELE": self.tele, "SET": self.set_speeds,
            "CALIBRACIÓN": self.calibrate, "LOAD FILE": self.load, "Inicializar Robot": self.initialise,
            "Salir": self.leave,
        }  # fmt: skip
        there = bool(desk.read())
        if there:
            desk.wait(2.0)
        self.robot_label(there)
        while True:
            self.update()

    def fixed(self, name: str) -> bool:
        """Whether the entry `name` is corrected."""
        return name in self.corrected

    def robot_label(self, there: bool) -> None:
        """Set the label about the robot."""
        self.desk.label = "Robot Conectado" if there else "Robot No Conectado"

    def update(self) -> None:
        """Update the window."""
        if self.fixed("CONS-connected-once"):
            self.robot_label(self.desk.now_s - self.desk.heard_s < GONE_S)
        self.desk.update()

    def sleep(self, duration_s: float) -> None:
        """Sleep in the command of a button."""
        if not self.fixed("CONS-window-sleeps"):
            self.desk.wait(duration_s)
            return
        until_s = self.desk.now_s + duration_s
        while self.desk.now_s < until_s:
            self.update()

    # Orders

    def stop(self) -> None:
        """The button STOP."""
        self.desk.write(b"#STOP\r")

    def leave(self) -> None:
        """The button Salir, and the closing button of the window."""
        if self.fixed("CONS-leave-drives"):
            self.desk.write(b"#STOP\r")
        raise SystemExit

    def initialise(self) -> None:
        """The button Inicializar."""
        self.desk.write(b"#INIT\r")
        self.sleep(1.0)

    def calibrate(self) -> None:
        """The button CALIBRACION."""
        self.sleep(0.5)
        self.desk.write(b"#CALB\r")
        self.sleep(6.0)

    def set_speeds(self) -> None:
        """The button SET."""
        v, w = self.desk.script.v, self.desk.script.w
        if self.fixed("CONS-set-verbatim"):
            try:
                v, w = (f"{float(text.replace(',', '.')):.3f}" for text in (v, w))
            except ValueError:
                return
        self.desk.write(b"#TELE\r")
        self.sleep(0.5)
        self.desk.write(f"#SETR{v},{w}\r".encode())
        if self.fixed("CONS-set-in-tele"):
            with suppress(ValueError):
                self.v_m_s, self.w_rad_s = float(v), float(w)

    def tele(self) -> None:
        """The button TELE.  The arrow keys change the speeds, ten times a second."""
        desk = self.desk
        self.sleep(0.5)
        if self.fixed("CONS-speeds-kept"):
            self.v_m_s = self.w_rad_s = 0.0
            desk.write(b"#SETR0.0,0.0\r")
        desk.write(b"#TELE\r")
        while True:
            self.update()
            self._arrows()
            v, w = round(self.v_m_s, 3), round(self.w_rad_s, 3)
            desk.wait(0.1)
            desk.write(f"#SETR{v},{w}\r".encode())
            if desk.pressed("esc"):
                break
        if self.fixed("CONS-escape-drives"):
            desk.write(b"#SETR0.0,0.0\r#STOP\r")

    def _arrows(self) -> None:
        pressed = self.desk.pressed
        if self.fixed("CONS-keys-anywhere") and not self.desk.in_front:
            return
        if pressed("down"):
            self.v_m_s -= 0.01
        elif pressed("up"):
            self.v_m_s += 0.01
        elif pressed("left"):
            self.w_rad_s += 0.03
        elif pressed("right"):
            self.w_rad_s -= 0.03
        elif pressed("esc") and not self.fixed("CONS-escape-leaves"):
            raise SystemExit
        if self.fixed("CONS-arrows-unbounded"):
            self.v_m_s = max(-V_MOST_M_S, min(V_MOST_M_S, self.v_m_s))
            self.w_rad_s = max(-W_MOST_RAD_S, min(W_MOST_RAD_S, self.w_rad_s))

    # The map

    def mission(self) -> None:
        """The button MISION.  It sends the order, and then draws the map until Escape."""
        self.desk.write(b"#MISN\r")
        if self.fixed("CONS-oldest-first"):
            self.desk.read(self.desk.waiting)
        file = FOLDER + self.desk.script.archive if self.fixed("CONS-archive-unused") else DRIVE_FILE
        if self.fixed("CONS-drive-erased") and file in self.desk.files:
            self.desk.files[f"{file}.{len(self.desk.files)}"] = self.desk.files[file]
        self.desk.files[file] = HEADER
        self.text = self.pending = ""
        while True:
            self.update()
            if self._receive() and "," in self.text:
                self.desk.files[file] += self.text + "\n"
                self._draw()
            if self.desk.pressed("esc"):
                break

    def _receive(self) -> bool:
        """Take in the received characters.  Returns whether there is a point to draw."""
        newest = self.fixed("CONS-oldest-first")
        came = self.desk.read(self.desk.waiting)
        text = came.decode("utf-8", "replace" if self.fixed("CONS-byte-ends-map") else "strict")
        if self.fixed("CONS-torn-number"):
            *whole, self.pending = (self.pending + text).split("\r")
            whole = [frame for frame in whole if "#ODO" in frame]
            if whole:
                self.text = whole[-1 if newest else 0].partition("#ODO")[2][1:-1]
            return bool(whole) or not self.fixed("CONS-points-repeated")
        self.text += text
        begin = (self.text.rfind if newest and text.count("\r") < 2 else self.text.find)("#ODO")
        if begin >= 0:
            self.text = self.text[begin + len("#ODO ") :]
        end = self.text.find("\r")
        if end >= 0:
            self.text = self.text[: end - 1]
        return (bool(came) and end >= 0) or not self.fixed("CONS-points-repeated")

    def _draw(self) -> None:
        if self.text.count(",") == 5:
            try:
                self.points.append(tuple(int(number) for number in self.text.split(",")))
            except ValueError:
                return
        if not self.points:
            return
        x_mm, y_mm, heading_rad, _front, right_mm, left_mm = self.points[-1]
        x, y = x_mm / 10, y_mm / 10

        def seen(distance_mm: int, side: float) -> tuple[float, float]:
            return (
                x + distance_mm / 10 * math.cos(heading_rad + side),
                y + distance_mm / 10 * math.sin(heading_rad + side),
            )

        self.desk.legend = 3 if self.fixed("CONS-legend-grows") else self.desk.legend + 3
        self.desk.draw((x, y), seen(left_mm, math.pi / 2), seen(right_mm, -math.pi / 2))
        self.desk.wait(0.05)
        self.update()

    def load(self) -> None:
        """The menu entry LOAD FILE."""
        name = DRIVE_FILE if self.fixed("CONS-load-other-file") else LOAD_FILE
        if name not in self.desk.files:
            raise FileNotFoundError(name)
        rows = [line.split(",") for line in self.desk.files[name].splitlines()]
        if self.fixed("CONS-loaded-as-text"):
            path = [(float(row[0]), float(row[1])) for row in rows[1:]]
        else:
            path = list(zip(on_axis([row[0] for row in rows]), on_axis([row[1] for row in rows]), strict=True))
        self.desk.path = path
        self.desk.loaded = len(path)
