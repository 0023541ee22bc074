"""Defects of protocol.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "PROTO-frame-rewritten", "protocol.c", "Send_ODO_Trayect", "Aux_Frame",
        "There is one frame buffer, and the line takes 28 ms to read it. A second frame within that time is written over "
        "the first: at start-up eight of them.",
        "9600 baud, 27 characters; XBee.c keeps the pointer",
        "The first frames after switching on are mixtures of several.",
        "buffer-rewritten", "Wait, asleep, until the previous frame has left.",
        covered_by=("GYRO-starves-at-start", "GYRO-turn-on", "MAIN-clock-before-task"),
        line=46,
        depends_on="that XBee.c, which is not printed, keeps the pointer and copies nothing",
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-coordinate-range", "protocol.c", "Send_ODO_Trayect", "(int) dataT->X, (int) dataT->Y",
        "Coordinates are millimetres in a float; an int ends at 32.767 m, 109 s of driving at 0.3 m/s. The conversion "
        "beyond is undefined.",
        "ISO C 6.3.1.4; TFG 3.1.4 names the overflow of the scaled values and keeps it for the unscaled ones",
        "After two minutes straight on, the map jumps or stands still.",
        "float-to-int", "The value is held at the end of the range.",
        line=46,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-angle-unit", "protocol.c", "Send_ODO_Trayect", "(int) dataT->tita",
        "The heading is in radians and is cut to a whole number: the console gets 0, 1, 2 ..., 57 degrees apart, and takes "
        "them for the radians that they are.",
        "TFG annex 2: the console multiplies the angle by 180 / pi, and draws with it",
        "In the console's map the robot and the points of its sonars turn in leaps of 57 degrees.",
        "unit",
        "Of the whole numbers of radians that are this heading but for whole turns the nearest is sent, at most 0.3 degrees "
        "off: the protocol and the console stay as they are.",
        line=55,
        severity=Severity.ERROR,
    ),
    Defect(
        "PROTO-order-prefix", "protocol.c", "Interpret_Order", "data[0] to data[4] are compared",
        "Whatever begins like an order is the order: #STOPWATCH, #MISNOMER.",
        "TFG 3.1.4: an order is #, four letters and the end mark",
        "A disturbed frame is obeyed.",
        "malformed-frame", "The end mark must follow the name.",
        line=79,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-numbers-unchecked", "protocol.c", "Obtain_Reference", "atof of anything",
        "What is no number is 0 for atof: #SETRabc,def sets both speeds to 0, and 0,1,0.2 (decimal commas) sets W to 1.",
        "ISO C 7.20.1.1: atof reports no error",
        "A mistyped order stops the robot, or spins it at 1 rad/s.",
        "malformed-frame", "Sign, digits, point, comma and end mark are looked at before the order is accepted.",
        line=104,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-reference-range", "protocol.c", "Obtain_Reference", "ref->V, ref->W",
        "Any speed is taken: 9.9 m/s from a robot that can do 0.3.",
        "TFG 3.2.3: +-0.3 m/s and +-1.57 rad/s", "A slipped decimal point gives full speed.",
        "order-range", "Both are held within what the robot does.",
        line=104,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-damage-unseen", "protocol.c", "Interpret_Order", "data[0] to data[4] are compared, and nothing else",
        "A frame has no check. A digit that was damaged on the line is another digit: #SETR0.1,0.0 becomes 0.3 or 9.1.",
        "TFG 2.2.1: 8 bits, start and stop, no parity; TFG 3.1.4: # to the end mark",
        "Now and then a jerk that nobody has ordered, until the next SETR.",
        "malformed-frame",
        "An order may end with * and two hexadecimal digits, the exclusive or of the characters between # and *. Once a "
        "right one has come, orders without it are refused, but for STOP; a console that sends none is served as before.",
        line=79,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-comma-missing", "protocol.c", "Move_to_comma", "while (data[j] != ',')",
        "Without a comma the search leaves the frame and goes on through memory until some word holds 44.",
        "ISO C 6.5.6: pointer beyond the object", "#SETR0.2 without comma takes W from anywhere, or never returns.",
        "pointer-outside", "The search ends at the end mark too; W is 0 then.",
        line=113,
        severity=Severity.WARNING,
    ),
)  # fmt: skip
