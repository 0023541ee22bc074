"""Defects of protocol.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "PROTO-frame-rewritten", "protocol.c", "Send_ODO_Trayect", "Aux_Frame",
        "There is one frame buffer, and the serial line needs 28 ms to send it. A second frame within that time "
        "overwrites the first one. At start-up there are eight frames at once.",
        "9600 baud, 27 characters; XBee.c keeps the pointer",
        "After switching on, the first frames are mixtures of several frames.",
        "buffer-rewritten",
        "The task sleeps until the previous frame has been sent.",
        covered_by=("GYRO-starves-at-start", "GYRO-turn-on", "MAIN-clock-before-task"),
        line=46,
        depends_on="whether XBee.c, which is not printed in the thesis, keeps the pointer and does not copy the frame",
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-coordinate-range", "protocol.c", "Send_ODO_Trayect", "(int) dataT->X, (int) dataT->Y",
        "Coordinates are millimetres in a float, and the code converts them to int. An int ends at 32.767 m, after "
        "109 s at 0.3 m/s. Beyond that C does not define the conversion.",
        "ISO C 6.3.1.4; TFG 3.1.4 names the overflow of the scaled values and keeps it for the unscaled ones",
        "After two minutes straight ahead the map jumps or stops.",
        "float-to-int",
        "The value is limited to the range of int.",
        line=46,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-angle-unit", "protocol.c", "Send_ODO_Trayect", "(int) dataT->tita",
        "The heading is in radians, and the code cuts it to a whole number. The console gets 0, 1, 2 ... rad, which "
        "are 57 degrees apart.",
        "TFG annex 2: the console multiplies the angle by 180 / pi, and draws with it",
        "On the console's map the robot and its sonar points turn in steps of 57 degrees.",
        "unit",
        "A heading stays the same after a whole turn. So the code sends the whole number of radians that is nearest "
        "to the heading plus some whole turns; the error is at most 0.3 degrees. Protocol and console stay as they "
        "are.",
        line=55,
        severity=Severity.ERROR,
    ),
    Defect(
        "PROTO-order-prefix", "protocol.c", "Interpret_Order", "data[0] to data[4] are compared",
        "The code compares five characters only. Any frame that begins like an order is taken as the order: "
        "#STOPWATCH, #MISNOMER.",
        "TFG 3.1.4: an order is #, four letters and the end mark",
        "The robot obeys a damaged frame.",
        "malformed-frame",
        "The end mark must follow the name.",
        line=79,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-numbers-unchecked", "protocol.c", "Obtain_Reference", "atof of anything",
        "atof returns 0 for a text that is not a number. #SETRabc,def sets both speeds to 0. With decimal commas, "
        "0,1,0.2 sets W to 1.",
        "ISO C 7.20.1.1: atof reports no error",
        "A mistyped order stops the robot, or turns it at 1 rad/s.",
        "malformed-frame",
        "The code checks sign, digits, point, comma and end mark before it accepts the order.",
        line=104,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-reference-range", "protocol.c", "Obtain_Reference", "ref->V, ref->W",
        "The code accepts any speed, for example 9.9 m/s for a robot that reaches 0.3 m/s.",
        "TFG 3.2.3: +-0.3 m/s and +-1.57 rad/s",
        "A wrong decimal point gives full speed.",
        "order-range",
        "Both speeds are limited to what the robot can do.",
        line=104,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-damage-unseen", "protocol.c", "Interpret_Order", "data[0] to data[4] are compared, and nothing else",
        "A frame has no checksum. If the line changes a digit, the result is another valid digit: #SETR0.1,0.0 "
        "becomes 0.3 or 9.1.",
        "TFG 2.2.1: 8 bits, start and stop, no parity; TFG 3.1.4: # to the end mark",
        "Now and then the robot makes a movement that nobody ordered, until the next SETR.",
        "malformed-frame",
        "An order may end with * and two hexadecimal digits: the exclusive or of the characters between # and *. "
        "After the first order with a right checksum, the robot rejects orders without one, except STOP. A console "
        "that never sends a checksum works as before.",
        line=79,
        severity=Severity.WARNING,
    ),
    Defect(
        "PROTO-comma-missing", "protocol.c", "Move_to_comma", "while (data[j] != ',')",
        "Without a comma the search leaves the frame and continues through memory until a word is 44.",
        "ISO C 6.5.6: pointer beyond the object",
        "#SETR0.2 without a comma takes W from any place in memory, or the function never returns.",
        "pointer-outside",
        "The search also ends at the end mark; W is then 0.",
        line=113,
        severity=Severity.WARNING,
    ),
)  # fmt: skip
