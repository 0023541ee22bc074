"""What the robot ought to notice and does not: parts that fail while the tasks of main_Robot.c drive on."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "MAIN-watchdog", "main_Robot.c", "main", "BIOS_start() with the watchdog off, as the start-up code leaves it",
        "Nobody looks whether the tasks still run. A task that hangs stops those below it, and TaskSERVO, which has a "
        "higher priority than TaskNAVIGATION and TaskODO, drives on with the last reference.",
        "F28377S TRM, watchdog: it resets the chip unless it is serviced; TFG 3.4: each task has a period and a deadline",
        "The robot drives on, and neither STOP nor its bumper nor a wall counts any more.",
        "closed-loop",
        "The watchdog is armed when the gyro's offset is known. A Clock function services it every 50 ms, only while no "
        "task leaves releases waiting in its semaphore for longer than two periods (100 ms if that is more), nor an order; "
        "else the chip is reset after 105 ms: its pins are inputs, so that the motors are off, and it starts anew and stands.",
        line=254,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-distance-unchecked", "main_Robot.c", "TaskNAVIGATION", "df = read_front_distance(), dl, dr",
        "A distance has neither an age nor a range. Nobody asks when TaskUS wrote it last, and what is no number is "
        "neither below 45 nor below 60: the mission takes it for free space.",
        "IEEE 754: no comparison with NaN is true; LV-MaxSonar-EZ data sheet: 6 to 254 inches, a reading each 49 ms",
        "A mission drives on at 0.15 m/s on a distance of half a minute ago, or on none.",
        "closed-loop",
        "TaskUS says when it has measured. A mission stands if all three are not between 0 and 700 cm and younger than "
        "350 ms, two rounds of the ring.",
        line=310,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-front-stuck", "main_Robot.c", "TaskNAVIGATION", "df = read_front_distance()",
        "Nothing compares the front distance with the way: it may stay the same over any number of metres.",
        "TFG 3.2.1: the mission waits for what comes nearer; the wheels measure the way (TFG 3.1.3)",
        "With a sonar that hears its own echo, or with AN held by a filter, a mission drives into the wall.",
        "closed-loop",
        "A mission stands when the wheels have rolled 25 cm, ten of the sonar's inches, and something ahead seems as far "
        "as before, within 2 cm. It goes on when the distance changes.",
        line=310,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-link-silent", "main_Robot.c", "TaskNAVIGATION", "if (et_status == TELEMANIPULATION)",
        "The reference of the last SETR counts for ever. Whether the console still sends is looked at by nobody, though "
        "it repeats the reference every 0.1 s while somebody drives.",
        "Annex 2: SETR in the loop of Tele with a pause of 0.1 s; TFG 2.2.1 (radio)",
        "The radio is lost and the robot drives on until it meets something; STOP does not come through.",
        "stop-stops",
        "2.5 s after the last order that was understood the reference is 0. A console that sets a speed once (annex 2: "
        "Set) repeats it, or any order, before that.",
        line=350,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-turn-unchecked", "main_Robot.c", "TaskNAVIGATION", "wZ = read_z_axis()",
        "The wheels and the gyro measure the same turn, and nobody compares them. A gyro at the end of its range, one "
        "whose offset has jumped, and an encoder that loses edges are believed.",
        "TFG 3.1.2, 3.1.3: both give the rate about z; (Wr - Wl) r / d",
        "The mission turns and turns, for a heading that one of the two has made up.",
        "closed-loop",
        "Where the two differ by 0.2 rad within half a second (0.4 rad/s) the robot stands until it is told to stop.",
        line=318,
        depends_on="that the gyro measures both turns as large as they are (GYRO-scale, GYRO-clockwise-zero)",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-actuator-limits", "main_Robot.c", "TaskSERVO", "Wl_ref = (V - W*dhalf) / r, Wr_ref",
        "Whatever stands in the reference becomes a speed of the wheels: 100 m/s, or what is no number.",
        "TFG 3.2.3: 0.3 m/s; the position controller asks for 1.57 rad/s at most",
        "One flipped bit in a reference is full voltage on both motors.",
        "order-range", "V is held within 0.3 m/s and W within 1.57 rad/s; what is no number is 0.",
        line=388,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-wheel-unchecked", "main_Robot.c", "TaskSERVO", "U_l = Rl(Wl_ref, Wl), U_r",
        "A wheel that does not turn, or turns the other way, is driven harder and harder. A blocked wheel, a cut encoder "
        "and a swapped one look the same here, and are noticed by nobody.",
        "NXT motor: stall current 2 A; TFG 3.2.3 (servo system)",
        "A motor at full voltage against what holds it; with a cut encoder the robot spins at full speed.",
        "closed-loop",
        "A wheel that has less than a tenth of its speed for 0.4 s makes the robot stand until it is told to stop.",
        line=394,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-push-unnoticed", "main_Robot.c", "TaskSERVO", "left_action(U_l), right_action(U_r)",
        "A wall at an angle, which neither sonar nor bumper meets, holds the robot while its tyres slip: the wheels have "
        "their speed and the gyro stands still, as on a free way. Only the voltage is a third more, and nobody looks.",
        "TFG 3.2.3: what slips is not in what the encoders measure; TFG 3.2.2: collisions with walls at 40 to 50 degrees",
        "The robot stands at a wall with turning wheels until somebody comes.",
        "closed-loop",
        "A mission whose motors take a fifth more voltage for their speed than in the seconds before, for 0.3 s, goes 15 cm "
        "back and turns, as after a bump.",
        line=403,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-bumper-stuck", "main_Robot.c", "MISION_4", "if (caso2 > 60) Position(0, -0.1) with bumper == 0",
        "Reversing with the bumper pressed ends when the bumper is released, and a contact that is stuck never is.",
        "TFG 3.2.1: the robot reverses to get away from the obstacle; there is no sensor behind",
        "A robot with a bent bumper drives backwards until something stops it.",
        "closed-loop",
        "After 6 s pressed, 3 s of them backwards (30 cm), it stands until the bumper is released.",
        line=490,
        depends_on="that the mission gets to reverse at all (MAIN-bump-clears)",
        severity=Severity.WARNING,
    ),
)  # fmt: skip
