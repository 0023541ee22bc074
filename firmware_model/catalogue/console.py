"""Defects of the console (TFG annex 2, main.py) that its user meets, in the order of its lines.

They are none of the firmware's: no correction of the firmware removes them, so `--fix` does not know them.
"""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect, DefectKind


def _console(
    id: str, line: int, function: str, place: str, wrong: str, source: str, symptom: str, rule: str, correction: str,
    severity: Severity = Severity.WARNING, depends_on: str = "", covered_by: tuple[str, ...] = (),
) -> Defect:  # fmt: skip
    return Defect(
        id, "main.py", function, place, wrong, source, symptom, rule, correction, DefectKind.CONSOLE, severity=severity,
        line=line, depends_on=depends_on, covered_by=covered_by,
    )  # fmt: skip


DEFECTS: Final[tuple[Defect, ...]] = (
    _console(
        "CONS-port-name", 43, "puerto", "info[0:4]",
        "The code takes the first four characters of the configuration as the port. It opens COM10 as COM1.",
        "Windows counts its ports beyond 9",
        'The console shows "Error puerto", or drives the robot on another port.',
        "wrong-result",
        "The name ends at the blank.",
    ),
    _console(
        "CONS-archive-unused", 44, "archivo", "archivo=info[29:45]",
        "The code reads the name of the drive file from the configuration and never uses it. It always writes "
        "trayectoria.txt.",
        "TFG 3.3.1: the second line of configuracion.txt names the file; the menu changes it",
        "The user gives a drive its own file name, and that file does not exist.",
        "no-effect",
        "The code writes the file that the second line names.",
    ),
    _console(
        "CONS-drive-erased", 87, "leerOdo", 'trayectoria.txt, "w"',
        "MISION clears the drive file first, without a question.",
        "TFG 3.3.1: a menu of its own is there to empty the file (Limpiar archivo)",
        "The user clicks MISION a second time and loses the first drive.",
        "wrong-result",
        "The console keeps the old file under another name.",
    ),
    _console(
        "CONS-byte-ends-map", 107, "leerOdo", "frame.decode('utf-8')",
        "A byte above 127 that is not valid UTF-8 raises an exception outside the try. The loop that reads and draws "
        "ends.",
        "Python: bytes.decode is strict; a disturbed character of a radio link can have any value",
        "After one damaged character the map stops, and the window still says Sending Data.",
        "malformed-frame",
        "The code replaces such bytes, so only one frame is lost.",
    ),
    _console(
        "CONS-oldest-first", 114, "leerOdo", "frame2[pos+5:]",
        "Only the loop of the map reads the port. It draws the first of the waiting frames and discards the others. "
        "So the map starts with the position that the robot had when the console was started, or when the map was "
        "last left.",
        "pyserial: what is not read is kept; four frames a second",
        "The first point of a map is not the position of the robot. Frames that arrive while a point is drawn are "
        "lost.",
        "wrong-result",
        "When the map starts, the code discards what waits. Then it draws the newest frame.",
        depends_on="whether the driver of the port keeps characters that nothing reads, 4096 here",
    ),
    _console(
        "CONS-torn-number", 124, "leerOdo", "frame2.count(',') == 5",
        "The code takes a frame as complete at its fifth comma. The last number is still arriving then, 1 ms per "
        "digit: 1922 becomes 1, 19 or 192.",
        "9600 baud; protocol.c ends a frame with CR",
        "Now and then a point of the left sonar is in the middle of the room.",
        "wrong-result",
        "A frame is complete at its CR.",
        depends_on="when the PC reads the port: here it draws a point in 60 ms and pauses for 50 ms",
        covered_by=("CONS-points-repeated",),
    ),
    _console(
        "CONS-points-repeated", 130, "leerOdo", "trama.write(frame2 + ...)",
        "Each pass of the loop writes and draws, whether a frame arrived or not. The drive file contains the same "
        "points several times, with the beginnings of frames between them.",
        "TFG 3.3.2: the file holds the points that the robot sent",
        "The file has several times as many lines as frames. Speeds that are computed from it are 0 or jump.",
        "wrong-result",
        "The code writes and draws each frame once.",
    ),
    _console(
        "CONS-load-other-file", 156, "CSV", "trayectoriaa.txt",
        "LOAD FILE opens trayectoriaa.txt. MISION writes trayectoria.txt, and nothing writes the other.",
        "TFG 3.3.1: LOAD FILE shows a drive that was saved",
        "LOAD FILE does nothing, and the shell shows FileNotFoundError.",
        "no-effect",
        "LOAD FILE opens what MISION wrote.",
    ),
    _console(
        "CONS-loaded-as-text", 164, "CSV", "plt.plot(x, y)",
        "csv reads everything as text, also the heading. Matplotlib takes texts for categories and draws them at "
        "equal distances: a step of 1 cm is as long as one of 1 m.",
        "Python csv: each row is a list of strings; matplotlib: categorical variables",
        "LOAD FILE shows a drive that never took place.",
        "wrong-result",
        "The code converts the values to numbers and leaves the heading out.",
    ),
    _console(
        "CONS-legend-grows", 245, "plotMemory", "plt.legend()",
        "Each point is three plots with a label each, and each label adds a line to the legend.",
        "matplotlib: the legend has a line for each labelled plot",
        "After a few seconds the legend covers the map, and each point takes longer than the one before.",
        "wrong-result",
        "The legend has three lines.",
    ),
    _console(
        "CONS-speeds-kept", 282, "Tele", "global i,j",
        "The console keeps the speeds of the arrow keys when TELE ends and when the user clicks STOP. The loop of "
        "TELE continues to send them after STOP, and the next TELE starts with them.",
        "TFG 3.3.1: STOP sets both references to 0; the arrows drive the robot",
        "The user clicks TELE, touches no key, and the robot drives off.",
        "stop-stops",
        "TELE starts with both speeds at 0, and sends them to the robot before it takes control.",
        Severity.ERROR,
    ),
    _console(
        "CONS-escape-drives", 299, "Tele", "keyboard.is_pressed: break",
        "Escape stops sending orders and sends no order itself, so the robot keeps the last speeds.",
        "TFG 3.3.1: Escape leaves the manual control",
        "The user has let go of the controls, and the robot drives on into the wall.",
        "stop-stops",
        "Escape sends speeds of 0 and STOP.",
        Severity.ERROR,
    ),
    _console(
        "CONS-keys-anywhere", 304, "Teclas", 'keyboard.is_pressed("down")',
        "The code reads the arrow keys of the whole PC, whichever window is active.",
        "keyboard: it hears the keys of all programs",
        "The user types in another program, and the robot drives.",
        "stop-stops",
        "Keys count only while the window of the console is active.",
    ),
    _console(
        "CONS-arrows-unbounded", 309, "Teclas", "i + 000.01",
        "An arrow key that is held adds 0.1 m/s each second without a limit: 0.6 m/s after six seconds, for a robot "
        "that reaches 0.3 m/s. The user must hold the other arrow for the same time before the robot becomes slower.",
        "TFG 3.2.3: +-0.3 m/s and +-1.57 rad/s",
        "The user holds the arrow for backwards, and the robot still drives forward for seconds.",
        "order-range",
        "Both speeds are limited to what the robot can do.",
    ),
    _console(
        "CONS-escape-leaves", 320, "Teclas", "quit()",
        "The code tests Escape in two places. The test beside the arrow keys ends the whole console without a STOP. "
        "It is reached if the user clicked MISION during TELE, and now and then by chance.",
        "TFG 3.3.1: Escape leaves a mode; Salir ends the console",
        "The window, with its STOP button, closes while the robot drives.",
        "stop-stops",
        "The code tests Escape once, at the end of the loop.",
    ),
    _console(
        "CONS-set-in-tele", 334, "Set", "ser.write(W)",
        "TELE continues after a click on SET, and 0.1 s later it sends the speeds of the arrow keys.",
        "TFG 3.3.1: SET gives the robot a speed",
        "With SET during TELE the robot jerks and stops.",
        "no-effect",
        "TELE continues with the speeds of SET.",
    ),
    _console(
        "CONS-set-verbatim", 328, "Set", "caja_setV.get(), caja_setW.get()",
        "The code sends the text of the two entries unchanged. With a decimal comma, 0,1 and 0.2 become #SETR0,1,0.2: "
        "V is 0 and W is 1.",
        "TFG 3.1.4: SETR has two numbers with a point",
        "The robot turns at 1 rad/s instead of driving at 0.1 m/s.",
        "malformed-frame",
        "The code reads both as numbers, with point or comma, and sends them with a point. If one is not a number, it "
        "sends nothing.",
    ),
    _console(
        "CONS-window-sleeps", 346, "Calibra", "time.sleep(6)",
        "The functions of the buttons sleep: CALIBRACION 6.5 s, Inicializar 1 s, TELE and SET 0.5 s. During this time "
        "the window handles no click.",
        "Tk: commands run in the loop that reads the mouse",
        "The user clicks STOP, and the console sends it up to 6.5 s later.",
        "order-latency",
        "The functions handle events of the window while they wait.",
    ),
    _console(
        "CONS-leave-drives", 436, "menu", "Salir, command=quit",
        "The console ends without sending anything, and the robot keeps its last order.",
        "TFG 3.3.1: Salir closes the console",
        "The user closes the console, and the robot drives on.",
        "stop-stops",
        "The console sends STOP first.",
        Severity.ERROR,
    ),
    _console(
        "CONS-connected-once", 440, "EstOrd", "if ser.read()",
        "The console tests once, at its start, whether the robot is there. The label never changes after that: it "
        "stays green when the robot is switched off, and red when the robot is switched on later.",
        "TFG 3.3.1: the console shows whether the robot is connected; it sends four frames a second",
        "The label says Robot Conectado, and no order arrives.",
        "wrong-result",
        "The label follows the frames: it turns red after one second without a character.",
    ),
)  # fmt: skip
