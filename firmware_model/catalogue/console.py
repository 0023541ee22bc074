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
        "The name of the port is the first four characters of the configuration: COM10 is opened as COM1.",
        "Windows counts its ports beyond 9", "Error puerto, or the robot on another port is driven.",
        "wrong-result", "The name ends at the blank.",
    ),
    _console(
        "CONS-archive-unused", 44, "archivo", "archivo=info[29:45]",
        "The name of the file of drives is read from the configuration, and used nowhere: trayectoria.txt is written.",
        "TFG 3.3.1: the second line of configuracion.txt names the file; the menu changes it",
        "The user gives a drive a name of its own, and it is not there.",
        "no-effect", "What the second line names is written.",
    ),
    _console(
        "CONS-drive-erased", 87, "leerOdo", 'trayectoria.txt, "w"',
        "MISION empties the file of the drive before, and asks nobody.",
        "TFG 3.3.1: a menu of its own is there to empty the file (Limpiar archivo)",
        "MISION is clicked a second time, and the first drive is lost.",
        "wrong-result", "The file that is there is kept under another name.",
    ),
    _console(
        "CONS-byte-ends-map", 107, "leerOdo", "frame.decode('utf-8')",
        "A character above 127 that is no UTF-8 raises an exception outside of the try: the loop that reads and draws is left.",
        "Python: bytes.decode is strict; a disturbed character of a radio link can have any value",
        "One damaged character, and the map stands still, while the window goes on to say Sending Data.",
        "malformed-frame", "Such characters are replaced, and with them only one frame is lost.",
    ),
    _console(
        "CONS-oldest-first", 114, "leerOdo", "frame2[pos+5:]",
        "Nothing is read but in the map's loop, and of all that waits there the first frame is drawn and the others are "
        "thrown away: the map begins where the robot was when the console was started, or the map left.",
        "pyserial: what is not read is kept; four frames a second",
        "The first point of a map is not where the robot is; frames that come while a point is drawn are lost.",
        "wrong-result", "What waits is thrown away when the map begins, and then the newest frame is drawn.",
        depends_on="that the driver of the port keeps characters that nobody reads, 4096 here",
    ),
    _console(
        "CONS-torn-number", 124, "leerOdo", "frame2.count(',') == 5",
        "A frame counts as complete with its fifth comma, but the last number still arrives, 1 ms a digit: 1922 is taken "
        "as 1, 19 or 192.",
        "9600 baud; protocol.c ends a frame with CR",
        "Now and then a point of the left sonar lies in the middle of the room.",
        "wrong-result", "A frame is complete with its CR.",
        depends_on="at which moments the PC looks at the port: here it draws a point in 60 ms beside its pause of 50 ms",
        covered_by=("CONS-points-repeated",),
    ),
    _console(
        "CONS-points-repeated", 130, "leerOdo", "trama.write(frame2 + ...)",
        "Each turn of the loop writes and draws, whether a frame came or not: the file of a drive has the same points "
        "several times, and beginnings of frames between them.",
        "TFG 3.3.2: the file holds the points that the robot sent",
        "A file with several times as many lines as frames; who computes speeds from it gets 0 and jumps.",
        "wrong-result", "A frame is written and drawn once.",
    ),
    _console(
        "CONS-load-other-file", 156, "CSV", "trayectoriaa.txt",
        "LOAD FILE opens trayectoriaa.txt. MISION writes trayectoria.txt, and nothing writes the other.",
        "TFG 3.3.1: LOAD FILE shows a drive that was saved", "LOAD FILE does nothing; the shell has FileNotFoundError.",
        "no-effect", "LOAD FILE opens what MISION wrote.",
    ),
    _console(
        "CONS-loaded-as-text", 164, "CSV", "plt.plot(x, y)",
        "What csv reads is text, the heading too. Matplotlib takes texts for names and puts one beside the other: a step of "
        "1 cm is as long as one of a metre.",
        "Python csv: each row is a list of strings; matplotlib: categorical variables",
        "LOAD FILE shows a drive that has never been driven.",
        "wrong-result", "Numbers are drawn, without the heading.",
    ),
    _console(
        "CONS-legend-grows", 245, "plotMemory", "plt.legend()",
        "Each point is three plots with a label of their own, and each label is a line of the legend.",
        "matplotlib: the legend has a line for each labelled plot",
        "After a few seconds the legend covers the map; each point takes longer than the last.",
        "wrong-result", "The legend has three lines.",
    ),
    _console(
        "CONS-speeds-kept", 282, "Tele", "global i,j",
        "The speeds of the arrows are kept when TELE is left and when STOP is clicked, and the loop of TELE goes on to send "
        "them after STOP. The next TELE begins with them.",
        "TFG 3.3.1: STOP sets both references to 0; the arrows drive the robot",
        "TELE is clicked, no key is touched, and the robot drives off.",
        "stop-stops", "TELE begins with both speeds 0, and says so to the robot before it takes the control.",
        Severity.ERROR,
    ),
    _console(
        "CONS-escape-drives", 299, "Tele", "keyboard.is_pressed: break",
        "Escape ends the orders and sends none: the robot keeps the last speeds.",
        "TFG 3.3.1: Escape leaves the manual control",
        "The user has let go of the controls, and the robot drives on, to the wall.",
        "stop-stops", "Speeds of 0 and STOP are sent.",
        Severity.ERROR,
    ),
    _console(
        "CONS-keys-anywhere", 304, "Teclas", 'keyboard.is_pressed("down")',
        "The arrows are asked of the whole PC, whatever window is in front.",
        "keyboard: it hears the keys of all programs",
        "The user writes in another program, and the robot drives.",
        "stop-stops", "Keys count while the console's window is in front.",
    ),
    _console(
        "CONS-arrows-unbounded", 309, "Teclas", "i + 000.01",
        "An arrow that is held adds 0.1 m/s each second, without an end: 0.6 m/s after six seconds, from a robot that does "
        "0.3. The other arrow must be held for as long before the robot slows.",
        "TFG 3.2.3: +-0.3 m/s and +-1.57 rad/s",
        "The arrow for backwards is held, and the robot goes on ahead for seconds.",
        "order-range", "Both speeds are held within what the robot does.",
    ),
    _console(
        "CONS-escape-leaves", 320, "Teclas", "quit()",
        "Escape is looked at twice. Where the keys of the arrows are read it ends the whole console, without a STOP: when "
        "MISION was clicked during TELE, and now and then by chance.",
        "TFG 3.3.1: Escape leaves a mode; Salir ends the console",
        "The window is gone while the robot drives, and with it the button STOP.",
        "stop-stops", "Escape is looked at once, at the end of the loop.",
    ),
    _console(
        "CONS-set-in-tele", 334, "Set", "ser.write(W)",
        "TELE goes on while SET is clicked, and sends the speeds of the arrows 0.1 s later.",
        "TFG 3.3.1: SET gives the robot a speed",
        "SET during TELE: the robot jerks and stands.",
        "no-effect", "TELE goes on from the speeds of SET.",
    ),
    _console(
        "CONS-set-verbatim", 328, "Set", "caja_setV.get(), caja_setW.get()",
        "What stands in the two entries is sent as it is. 0,1 and 0.2 (decimal comma) becomes #SETR0,1,0.2: V is 0 and W is 1.",
        "TFG 3.1.4: SETR has two numbers with a point",
        "The robot turns at 1 rad/s instead of driving at 0.1 m/s.",
        "malformed-frame", "Both are read as numbers, with point or comma, and sent as such; otherwise nothing is sent.",
    ),
    _console(
        "CONS-window-sleeps", 346, "Calibra", "time.sleep(6)",
        "The commands of the buttons sleep: CALIBRACION 6.5 s, Inicializar 1 s, TELE and SET 0.5 s. Until then no click is "
        "looked at.",
        "Tk: commands run in the loop that reads the mouse",
        "STOP is clicked, and goes out up to 6.5 s later.",
        "order-latency", "The commands look at the window while they wait.",
    ),
    _console(
        "CONS-leave-drives", 436, "menu", "Salir, command=quit",
        "The console ends without a word to the robot, which keeps its last order.",
        "TFG 3.3.1: Salir closes the console",
        "The console is closed, and the robot drives on.",
        "stop-stops", "STOP is sent first.",
        Severity.ERROR,
    ),
    _console(
        "CONS-connected-once", 440, "EstOrd", "if ser.read()",
        "Whether the robot is there is looked at once, at the start. The label says so from then on: green with the robot "
        "switched off, red with one that was switched on later.",
        "TFG 3.3.1: the console shows whether the robot is connected; it sends four frames a second",
        "Robot Conectado, and no order arrives.",
        "wrong-result", "The label follows the frames: red after a second without a character.",
    ),
)  # fmt: skip
