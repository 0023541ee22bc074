"""Defects of main_Robot.c, in the order of its lines; navigation, and what fails unnoticed, in modules of their own."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue import main_robot_guards, main_robot_navigation
from firmware_model.catalogue.defect import Defect, DefectKind

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "MAIN-us-period", "main_Robot.c", "US_Period", "US_Period = 5",
        "The three sonars form a ring and each ranges once in 3 x 49 = 147 ms. TaskUS converts each twelve times every "
        "5 ms: 29 of 30 readings are the same range again, and some fall into the 44 ms in which AN moves.",
        "LV-MaxSonar-EZ data sheet: timing description, chaining; TFG 3.1.1 (period 5 ms)",
        "2 % of the processor at the highest priority for nothing; now and then a distance that was never measured.",
        "stale-sample",
        "Period 150 ms, and the priority below TaskGYRO, whose samples it would delay now and then; TaskUS holds the "
        "start wire low, reads, and then starts the next round, so that every range is read once and settled.",
        line=58,
        depends_on="that the three sonars are chained: TX of one to RX of the next",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-gyro-period", "main_Robot.c", "GYRO_Period", "GYRO_Period = 5",
        "CTRL_REG1 selects 100 samples a second; TaskGYRO reads 200 times a second, so every sample is used twice.",
        "L3G4200D data sheet, CTRL_REG1: DR = 00 is 100 Hz; TFG 3.1.2 (period 5 ms)",
        "Twice the bus time, and a rate that looks finer in time than it is.",
        "polling-above-rate", "Period 10 ms.",
        line=59,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-unused-objects", "main_Robot.c", "d", "d, Iwl, Iwr, Wl_ref_pi, Wr_ref_pi",
        "Five objects at file scope are mentioned nowhere else. d, the track, says the same as dhalf, so that a "
        "change of one of them changes half of the robot.",
        "ISO C: no use in any expression", "None, but for whoever changes d.",
        "unused-object", "They are gone.",
        line=106,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-clock-before-task", "main_Robot.c", "main", "clockParams.startFlag = TRUE",
        "All clocks run from BIOS_start on, while TaskGYRO spends 2 s in Init_GYRO above four other tasks. The "
        "counting semaphores collect 400 releases of TaskGYRO, 80 of TaskSERVO, 40 of TaskNAVIGATION, 8 of TaskODO, "
        "which are then worked off back to back, with code that takes its period for granted.",
        "SYS/BIOS: Clock, startFlag; Semaphore, counting mode; TFG 3.4.4 (one release a period)",
        "After 2 s a burst of frames that overwrite each other, and speeds measured over no time at all.",
        "semaphore-pile-up",
        "The clocks are created stopped; each task starts its own when it is ready, and TaskGYRO starts that of "
        "TaskNAVIGATION, so that nothing drives before the gyro's offset is known.",
        line=170,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-us-first-read", "main_Robot.c", "TaskUS", "Read_Distance right after Init_US()",
        "The first command makes each sonar calibrate for 49 ms and range for 49 ms, one after the other. TaskUS reads "
        "from the first tick on and writes what the calibration makes of 0 V: 1.5 to 4.4 cm.",
        "LV-MaxSonar-EZ data sheet: 49 ms calibration, then 49 ms to the first range",
        "A robot that starts with obstacles on three sides, and a cloud of points around the origin.",
        "startup-read", "TaskUS sleeps 450 ms, until the third range has settled, before it begins.",
        line=272,
        depends_on="that the sonars are switched on together with the board",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-task", "main_Robot.c", "CalibGyro", "Offset_GYRO(Z) in TaskNAVIGATION",
        "Fifty readings of the gyro are made in TaskNAVIGATION (priority 2), on the SPI bus and the chip select that "
        "TaskGYRO (priority 5) uses every period, without a gate. vZ_b is written by one and read by the other.",
        "TFG 3.4 figure 35: the gyro belongs to TaskGYRO; C has no atomic transfers",
        "A calibration that lasts longer than a period is cut in the middle of a byte: offset and rate are garbage.",
        "transaction-cut", "TaskNAVIGATION asks for it behind GYRO_server; TaskGYRO does it.",
        line=595,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-span", "main_Robot.c", "CalibGyro", "if (cuenta_gyro > t)",
        "The text calibrates for 5 s. The code waits for 102 periods (5.1 s) and then makes fifty readings in 2 ms, "
        "which are one sample of the gyro: noise and a shaken robot go into the offset in full.",
        "TFG 3.3.1 (CALIBRACION, 5 s); L3G4200D data sheet: 100 Hz",
        "A second press of CALIBRACION gives another offset, and the heading drifts with it.",
        "text-versus-code",
        "One reading every 50 ms for 5 s, from 1 s after the order on, when the wheels are at rest; the offset is their mean.",
        DefectKind.TEXT,
        line=593,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-resumed", "main_Robot.c", "CalibGyro", "cuenta_gyro++",
        "The counter of periods goes on where another order cut the last calibration off.",
        "TFG 3.3.1 (CALIBRACION, 5 s)",
        "CALIBRACION, STOP after 4.9 s, a push, CALIBRACION again: the offset is measured at once, of a moving robot.",
        "closed-loop", "In every other state the counter is 0.",
        line=599,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-repeats", "main_Robot.c", "CalibGyro", "cuenta_gyro = 0",
        "A calibration ends, and the state CALIBRATION goes on until another order: 5.1 s later the offset is measured "
        "again, and so forth.",
        "TFG 3.3.1 (CALIBRACION, 5 s: the console says Robot Calibrado and waits for the user)",
        "Calibrated, then carried to its start: the mission drives with the offset of a robot in somebody's hands.",
        "closed-loop", "The state is STOP when the offset is known.",
        line=596,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-bump-clears", "main_Robot.c", "TaskNAVIGATION",
        "|| bumper == 0 in the tests for CALIBRATION and INITIALITATION",
        "While the bumper is pressed, in any state, CalibGyro and Inicializa run too. Inicializa zeroes caso2, so the "
        "mission never gets to the 60 periods after which it reverses, and zeroes the gyro's offset.",
        "TFG 3.2.1: the bumper is an obstacle in front; 3.3.1: calibration and initialisation are orders of the user",
        "The robot stands against the obstacle for ever, and measures a rotation when it is freed.",
        "closed-loop", "Both run in their own state only.",
        line=328,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-mission-resumed", "main_Robot.c", "TaskNAVIGATION", "if (et_status == MISSION)",
        "Nothing is set when a mission begins: caso, caso2 and the integral go on where the last mission was stopped.",
        "TFG 3.2.1: an obstacle must stay for a while before the robot turns away",
        "Carried elsewhere and started again before a wall, the robot turns or reverses at once.",
        "closed-loop", "In every other state counters, heading, integral and turn are cleared.",
        line=342,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-state-reset", "main_Robot.c", "TaskNAVIGATION", "EstadoNav = INICIAL",
        "The state of the navigation is set to INICIAL every 50 ms. With the bumper pressed MISION_4 sets none, so the "
        "state is lost; nothing reads it anyway.",
        "TFG 3.2.1: five situations, of which one holds until another is recognised",
        "A debugger shows INICIAL while the robot stands before an obstacle.",
        "no-effect", "The state is set at the begin of a mission and where a situation is recognised.",
        line=343,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-titaref-unread", "main_Robot.c", "TaskNAVIGATION", "titaref = 0, titaref = 89",
        "The file-scope object titaref is set to 0 in three states and to 89 in a mission, as if it were the "
        "reference of the position controller. Nothing reads it: within Position the parameter of that name hides it.",
        "ISO C 6.2.1: the inner declaration hides the outer",
        "Who changes 89 to turn by another angle wonders why nothing changes.",
        "hidden-name", "The object and its assignments are gone; the parameter is the reference.",
        line=345,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-tele-twice", "main_Robot.c", "TaskNAVIGATION", "write_REF right after read_T_REF",
        "The console's reference is handed to TaskSERVO before the bumper is looked at, and a second time at the end "
        "of the loop. TaskSERVO has the higher priority: what it reads between the two drives the motors for 25 ms.",
        "TFG 3.1.5 (REF), 3.4 figure 35",
        "Short pushes against an obstacle that is pressed already.",
        "stop-stops", "One write, at the end, after the bumper has been considered.",
        line=352,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-bump-holds", "main_Robot.c", "TaskNAVIGATION", "if (bumper == 0) Action(0,0) in TELEMANIPULATION",
        "With the bumper pressed every reference becomes 0, also one that leads away from the obstacle.",
        "TFG 3.3.1 (TELE): the user moves the robot in all directions",
        "A robot that has hit something must be lifted off it.",
        "no-effect", "Only driving forward is refused.",
        line=353,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-order-twice", "main_Robot.c", "TaskORD", "char Order_frame[200] = Received_Order()",
        "An array cannot be initialised by a call, so the line is not C; without it, nobody asks Received_Order "
        "whether there is a frame. Two frames before the task runs are two posts and one frame in XBee.c: it is "
        "executed twice.",
        "ISO C 6.7.8 p16: the initialiser of an array is a list or a string; SYS/BIOS: counting semaphores",
        "Orders sent within the two seconds of start-up: the last one twice, the first one never.",
        "malformed-frame", "Received_Order is asked at each release; without a frame there is nothing to execute.",
        line=415,
        depends_on="how the printed line, which is no C, was built",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-stop-keeps-reference", "main_Robot.c", "TaskORD", "case O_STOP",
        "STOP is to set the references of V and W to 0. It only changes the state: the reference of the last SETR "
        "stays in the server and counts again at the next TELE.",
        "TFG 3.3.1 (STOP)",
        "TELE after STOP, and the robot drives off with a speed that nobody has ordered now.",
        "stop-stops", "STOP writes a reference of 0 too.",
        DefectKind.TEXT,
        line=427,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-init-reference", "main_Robot.c", "TaskORD", "case O_INITIALITATION",
        "INICIALIZAR is to initialise every variable; the reference of the telemanipulation is left out, here and in "
        "Inicializa: that of the last SETR counts again at the next TELE.",
        "TFG 3.3.1 (inicializar el robot)",
        "TELE after INICIALIZAR, and the robot drives off with a speed that nobody has ordered now.",
        "stop-stops", "INIT writes a reference of 0, as STOP is to.",
        line=446,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-reference-outlives", "main_Robot.c", "TaskORD", "case O_SETR",
        "SETR is taken in every state, and no order but SETR changes the reference: one that came in STOP, or before a "
        "mission, counts at the next TELE.",
        "TFG 3.3.1: SETR sets the speed that the robot follows in TELE",
        "TELE after a mission, and the robot drives off with a speed that nobody has ordered now.",
        "stop-stops", "SETR counts in TELE only; MISSION and CALIBRATION set the reference to 0, as STOP is to.",
        line=439,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-odo-commanded", "main_Robot.c", "TaskODO",
        "Odom_Trayect(&odoT, Robot_Reference_N.V, Robot_Reference_N.W, ...)",
        "The odometry is computed from the references that hold at the moment of the call, one of five, not from the "
        "speeds of the wheels, which TaskSERVO measures, nor from the gyro.",
        "TFG 3.1.3 and 3.3.2: V and W measured by the encoders; header of Odometry.h, figure 13",
        "A blocked, slipping or overloaded robot, and one that turned between two frames, is drawn where it never was.",
        "odometry-path",
        "TaskSERVO sums the way of the wheels and TaskGYRO the angle of the gyro; TaskODO takes both every 250 ms.",
        DefectKind.TEXT,
        line=468,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-odo-race", "main_Robot.c", "TaskODO", "Robot_Reference_N.V, Robot_Reference_N.W, df, dl, dr",
        "TaskODO (priority 1) reads five 32-bit objects that TaskNAVIGATION (priority 2) writes, none behind a gate: "
        "V may be of one period and W of the next.",
        "TFG 3.1.5: what tasks share is behind the servers",
        "Odd points in a path that is otherwise smooth.",
        "race", "read_REF and the read functions of the US server.",
        covered_by=("MAIN-odo-commanded",),
        line=468,
        severity=Severity.WARNING,
    ),
    *main_robot_guards.DEFECTS,
    *main_robot_navigation.DEFECTS,
    Defect(
        "MAIN-init-offset", "main_Robot.c", "Inicializa", "vZ_b = 0",
        "The offset of the gyro, measured at start-up by TaskGYRO, is thrown away, and nothing measures it again.",
        "L3G4200D data sheet: zero-rate level +-10 degrees/s; TFG 3.1.2 (offset at the start)",
        "After INICIALIZAR a standing robot turns, for its own navigation.",
        "rotation-bias", "The offset stays.",
        line=694,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-init-pointer", "main_Robot.c", "Inicializa", "Ix = 0",
        "Sets the pointer to the integral, not the integral: it points to address 0 from then on (again), and the "
        "value stays. Iw and Iv are left out altogether.",
        "ISO C 6.5.3.2: *Ix is the object",
        "The controller begins with what it integrated before; a repaired pointer is broken by the next INICIALIZAR.",
        "no-effect", "*Ix = 0.",
        line=698,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-init-distances", "main_Robot.c", "Inicializa", "dl = 0, df = 0, dr = 0",
        "INITIALITATION lasts until another order comes, and Inicializa runs in each of its periods: it zeroes the three "
        "distances that TaskNAVIGATION has just read and that TaskODO sends.",
        "TFG 3.1.4: a frame holds the three distances; TFG 3.3.1 (inicializar el robot)",
        "After INICIALIZAR the console draws three walls where the robot stands, until the next order.",
        "closed-loop", "The distances stay: they are read anew in every period.",
        covered_by=("MAIN-odo-race",),
        line=680,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-init-others", "main_Robot.c", "Inicializa", "Left_distance = 0 ... U_r = 0",
        "Nine objects that TaskUS and TaskSERVO, both above TaskNAVIGATION, compute with are zeroed without a gate.",
        "TFG 3.1.5: what tasks share is behind the servers",
        "Harmless as long as each is computed anew in every period; one that is kept would be lost at random.",
        "race-long", "Each task keeps its own objects; Inicializa leaves them alone.",
        line=683,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-init-odometry", "main_Robot.c", "Inicializa", "no write to the odometry server",
        "INICIALIZAR is to initialise everything; the pose stays, as it lives in the server and in odoT.",
        "TFG 3.3.1 (inicializar el robot)",
        "A new path is drawn from the end of the last one.",
        "text-versus-code", "Inicializa asks for it; TaskODO, which owns the pose, sets it to zero.",
        DefectKind.TEXT,
        line=673,
        severity=Severity.WARNING,
    ),
)  # fmt: skip
