"""What the robot ought to notice and does not: parts that fail while the tasks of main_Robot.c drive on."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "MAIN-watchdog", "main_Robot.c", "main", "BIOS_start() with the watchdog off, as the start-up code leaves it",
        "Nothing checks whether the tasks still run. If a task hangs, the tasks below it stop. TaskSERVO has a higher "
        "priority than TaskNAVIGATION and TaskODO, and continues with the last reference.",
        "F28377S TRM, watchdog: it resets the chip unless it is serviced; TFG 3.4: each task has a period and a "
        "deadline",
        "The robot drives on, and reacts neither to STOP nor to its bumper nor to a wall.",
        "closed-loop",
        "The program enables the watchdog when the offset of the gyro is known. A Clock function services it every 50 "
        "ms, but only if no task and no order has waited in its semaphore for longer than two periods (at least 100 "
        "ms). Otherwise the watchdog resets the chip after 105 ms. Its pins are then inputs, so the motors are off, "
        "and the program starts again and stays stopped.",
        line=254,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-distance-unchecked", "main_Robot.c", "TaskNAVIGATION", "df = read_front_distance(), dl, dr",
        "A distance has neither an age nor a valid range. Nothing checks when TaskUS wrote it last. NaN is neither "
        "below 45 nor below 60, so the mission takes it for free space.",
        "IEEE 754: no comparison with NaN is true; LV-MaxSonar-EZ data sheet: 6 to 254 inches, a reading each 49 ms",
        "A mission drives at 0.15 m/s with a distance that is half a minute old, or with none.",
        "closed-loop",
        "TaskUS records when it has measured. A mission stops unless all three distances are between 0 and 700 cm and "
        "younger than 350 ms (two rounds of the ring).",
        line=310,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-front-stuck", "main_Robot.c", "TaskNAVIGATION", "df = read_front_distance()",
        "Nothing compares the front distance with the movement of the robot. It may stay the same over any number of "
        "metres.",
        "TFG 3.2.1: the mission waits for what comes nearer; the wheels measure the way (TFG 3.1.3)",
        "If a sonar hears its own echo, or a filter holds its output, the mission drives into the wall.",
        "closed-loop",
        "A mission stops if the wheels have rolled 25 cm (ten inches of the sonar) and the front distance is within 2 "
        "cm of its old value. It continues when the distance changes.",
        line=310,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-link-silent", "main_Robot.c", "TaskNAVIGATION", "if (et_status == TELEMANIPULATION)",
        "The reference of the last SETR is used for ever. Nothing checks whether the console still sends, although "
        "the console repeats the reference every 0.1 s while somebody drives.",
        "Annex 2: SETR in the loop of Tele with a pause of 0.1 s; TFG 2.2.1 (radio)",
        "If the radio link fails, the robot drives on until it meets something; STOP does not arrive.",
        "stop-stops",
        "2.5 s after the last valid order the reference becomes 0. A console that sets a speed once (annex 2: Set) "
        "must repeat it, or send any order, within that time.",
        line=350,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-turn-unchecked", "main_Robot.c", "TaskNAVIGATION", "wZ = read_z_axis()",
        "The wheels and the gyro measure the same turn, and nothing compares them. So the code believes a gyro at the "
        "end of its range, a gyro whose offset has jumped, and an encoder that loses edges.",
        "TFG 3.1.2, 3.1.3: both give the rate about z; (Wr - Wl) r / d",
        "The mission turns again and again towards a heading that is wrong.",
        "closed-loop",
        "If the two differ by 0.2 rad within half a second (0.4 rad/s), the robot stops until it is ordered to stop.",
        line=318,
        depends_on="whether the gyro measures turns to both sides with the right size (GYRO-scale, GYRO-clockwise-zero)",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-actuator-limits", "main_Robot.c", "TaskSERVO", "Wl_ref = (V - W*dhalf) / r, Wr_ref",
        "The code converts any reference to wheel speeds, also 100 m/s or NaN.",
        "TFG 3.2.3: 0.3 m/s; the position controller asks for 1.57 rad/s at most",
        "One flipped bit in a reference gives full voltage on both motors.",
        "order-range",
        "V is limited to 0.3 m/s and W to 1.57 rad/s; NaN becomes 0.",
        line=388,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-wheel-unchecked", "main_Robot.c", "TaskSERVO", "U_l = Rl(Wl_ref, Wl), U_r",
        "If a wheel does not turn, or turns the wrong way, the controller increases its voltage more and more. A "
        "blocked wheel, a cut encoder wire and swapped encoder wires look the same, and nothing checks for them.",
        "NXT motor: stall current 2 A; TFG 3.2.3 (servo system)",
        "A motor runs at full voltage against what blocks it. With a cut encoder wire the robot spins at full speed.",
        "closed-loop",
        "If a wheel has less than a tenth of its ordered speed for 0.4 s, the robot stops until it is ordered to stop.",
        line=394,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-push-unnoticed", "main_Robot.c", "TaskSERVO", "left_action(U_l), right_action(U_r)",
        "A wall at an angle, which neither sonar nor bumper detects, can hold the robot while its tyres slip. The "
        "wheels have their speed and the gyro reads 0, as on a free path. Only the voltage is a third higher, and "
        "nothing checks it.",
        "TFG 3.2.3: what slips is not in what the encoders measure; TFG 3.2.2: collisions with walls at 40 to 50 "
        "degrees",
        "The robot stands at a wall with turning wheels until somebody comes.",
        "closed-loop",
        "If the motors of a mission need a fifth more voltage for their speed than in the seconds before, for 0.3 s, "
        "the robot drives 15 cm back and turns, as after a bump.",
        line=403,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-bumper-stuck", "main_Robot.c", "MISION_4", "if (caso2 > 60) Position(0, -0.1) with bumper == 0",
        "The robot drives backwards until the bumper is released. A contact that is stuck is never released.",
        "TFG 3.2.1: the robot reverses to get away from the obstacle; there is no sensor behind",
        "A robot with a bent bumper drives backwards until something stops it.",
        "closed-loop",
        "When the bumper has been pressed for 6 s, 3 s of them backwards (30 cm), the robot stops until the bumper is "
        "released.",
        line=490,
        depends_on="whether the mission ever drives backwards (MAIN-bump-clears)",
        severity=Severity.WARNING,
    ),
)  # fmt: skip
