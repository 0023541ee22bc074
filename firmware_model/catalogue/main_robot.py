"""Defects of main_Robot.c, in the order of its lines; navigation, and what fails unnoticed, in modules of their own."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue import main_robot_guards, main_robot_navigation
from firmware_model.catalogue.defect import Defect, DefectKind

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "MAIN-us-period", "main_Robot.c", "US_Period", "US_Period = 5",
        "The three sonars form a ring, and each one measures once in 3 x 49 = 147 ms. TaskUS converts each one twelve "
        "times every 5 ms. So 29 of 30 readings are the same range again, and some come in the 44 ms in which the "
        "analog output changes.",
        "LV-MaxSonar-EZ data sheet: timing description, chaining; TFG 3.1.1 (period 5 ms)",
        "TaskUS uses 2 % of the CPU at the highest priority without a benefit. Now and then it reads a distance that "
        "was never measured.",
        "stale-sample",
        "The period is 150 ms. The priority is below TaskGYRO, so TaskUS does not delay its samples. TaskUS holds the "
        "start wire low, reads, and then starts the next round. So it reads every range once, and after it has "
        "settled.",
        line=58,
        depends_on="whether the three sonars are chained: TX of one to RX of the next",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-gyro-period", "main_Robot.c", "GYRO_Period", "GYRO_Period = 5",
        "CTRL_REG1 selects 100 samples per second. TaskGYRO reads 200 times per second, so it uses every sample twice.",
        "L3G4200D data sheet, CTRL_REG1: DR = 00 is 100 Hz; TFG 3.1.2 (period 5 ms)",
        "The bus is used twice as long, and the rate seems to be measured more often than it is.",
        "polling-above-rate",
        "The period is 10 ms.",
        line=59,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-unused-objects", "main_Robot.c", "d", "d, Iwl, Iwr, Wl_ref_pi, Wr_ref_pi",
        "Five file-scope objects are never used. One of them, d (the track), has the same meaning as dhalf. Whoever "
        "changes only one of the two changes half of the robot.",
        "ISO C: no use in any expression",
        "None, except for somebody who changes d.",
        "unused-object",
        "The objects are removed.",
        line=106,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-clock-before-task", "main_Robot.c", "main", "clockParams.startFlag = TRUE",
        "All Clocks run from BIOS_start on, while TaskGYRO spends 2 s in Init_GYRO with a higher priority than four "
        "other tasks. The counting semaphores collect 400 releases of TaskGYRO, 80 of TaskSERVO, 40 of TaskNAVIGATION "
        "and 8 of TaskODO. The tasks then run these jobs without a pause, although their code assumes one period "
        "between two jobs.",
        "SYS/BIOS: Clock, startFlag; Semaphore, counting mode; TFG 3.4.4 (one release a period)",
        "After 2 s a burst of frames comes that overwrite each other, and the tasks compute speeds over a time of "
        "almost 0.",
        "semaphore-pile-up",
        "The Clocks are created stopped. Each task starts its own Clock when it is ready. TaskGYRO starts the Clock "
        "of TaskNAVIGATION, so the robot does not drive before the offset of the gyro is known.",
        line=170,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-us-first-read", "main_Robot.c", "TaskUS", "Read_Distance right after Init_US()",
        "After the first command each sonar calibrates for 49 ms and then measures for 49 ms, one after the other. "
        "TaskUS reads from the first tick on. At 0 V the calibration gives 1.5 to 4.4 cm, and TaskUS writes that.",
        "LV-MaxSonar-EZ data sheet: 49 ms calibration, then 49 ms to the first range",
        "The robot starts with obstacles on three sides, and the map has a cloud of points around the origin.",
        "startup-read",
        "TaskUS sleeps 450 ms before its first reading, until the third range has settled.",
        line=272,
        depends_on="whether the sonars are switched on together with the board",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-task", "main_Robot.c", "CalibGyro", "Offset_GYRO(Z) in TaskNAVIGATION",
        "TaskNAVIGATION (priority 2) reads the gyro fifty times. It uses the SPI bus and the chip select that "
        "TaskGYRO (priority 5) uses in every period, without a gate. One task writes vZ_b and the other reads it.",
        "TFG 3.4 figure 35: the gyro belongs to TaskGYRO; C has no atomic transfers",
        "If a calibration lasts longer than a period, TaskGYRO interrupts it in the middle of a byte. Then offset and "
        "rate are random.",
        "transaction-cut",
        "TaskNAVIGATION requests the calibration behind GYRO_server, and TaskGYRO does it.",
        line=595,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-span", "main_Robot.c", "CalibGyro", "if (cuenta_gyro > t)",
        "The text calibrates for 5 s. The code waits for 102 periods (5.1 s) and then makes fifty readings in 2 ms. "
        "These are one sample of the gyro, so its noise, or a movement of the robot, goes fully into the offset.",
        "TFG 3.3.1 (CALIBRACION, 5 s); L3G4200D data sheet: 100 Hz",
        "A second click on CALIBRACION gives another offset, and the heading then drifts differently.",
        "text-versus-code",
        "The code takes one reading every 50 ms for 5 s. It starts 1 s after the order, when the wheels stand still. "
        "The offset is the mean of the readings.",
        DefectKind.TEXT,
        line=593,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-resumed", "main_Robot.c", "CalibGyro", "cuenta_gyro++",
        "If another order ended the last calibration early, the counter of periods continues from there.",
        "TFG 3.3.1 (CALIBRACION, 5 s)",
        "After CALIBRACION, STOP after 4.9 s, a push, and CALIBRACION again, the robot measures the offset at once, "
        "while it moves.",
        "closed-loop",
        "In every other state the counter is set to 0.",
        line=599,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-calib-repeats", "main_Robot.c", "CalibGyro", "cuenta_gyro = 0",
        "After a calibration the state CALIBRATION stays until another order. 5.1 s later the code measures the "
        "offset again, and so on.",
        "TFG 3.3.1 (CALIBRACION, 5 s: the console says Robot Calibrado and waits for the user)",
        "Somebody calibrates the robot and carries it to its start. The mission then drives with an offset that was "
        "measured in that person's hands.",
        "closed-loop",
        "When the offset is known, the state becomes STOP.",
        line=596,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-bump-clears", "main_Robot.c", "TaskNAVIGATION",
        "|| bumper == 0 in the tests for CALIBRATION and INITIALITATION",
        "While the bumper is pressed, CalibGyro and Inicializa run in any state. Inicializa sets caso2 to 0, so the "
        "mission never reaches the 60 periods after which it drives backwards. It also sets the offset of the gyro to "
        "0.",
        "TFG 3.2.1: the bumper is an obstacle in front; 3.3.1: calibration and initialisation are orders of the user",
        "The robot stays at the obstacle for ever. When somebody frees it, it measures a rotation that is not there.",
        "closed-loop",
        "Each of the two runs only in its own state.",
        line=328,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-mission-resumed", "main_Robot.c", "TaskNAVIGATION", "if (et_status == MISSION)",
        "The start of a mission initialises nothing. caso, caso2 and the integral continue from where the last "
        "mission was stopped.",
        "TFG 3.2.1: an obstacle must stay for a while before the robot turns away",
        "If the robot is carried to another place and started in front of a wall, it turns or drives backwards at "
        "once.",
        "closed-loop",
        "In every other state the code clears the counters, the heading, the integral and the turn.",
        line=342,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-state-reset", "main_Robot.c", "TaskNAVIGATION", "EstadoNav = INICIAL",
        "The code sets the state of the navigation to INICIAL every 50 ms. With the bumper pressed, MISION_4 sets no "
        "state, so the state is lost. Nothing reads it.",
        "TFG 3.2.1: five situations, of which one holds until another is recognised",
        "In a debugger the state is INICIAL while the robot stands in front of an obstacle.",
        "no-effect",
        "The state is set at the start of a mission and where a situation is recognised.",
        line=343,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-titaref-unread", "main_Robot.c", "TaskNAVIGATION", "titaref = 0, titaref = 89",
        "The code sets the file-scope object titaref to 0 in three states and to 89 in a mission, as if it were the "
        "reference of the position controller. Nothing reads it. Within Position, the parameter with that name hides "
        "it.",
        "ISO C 6.2.1: the inner declaration hides the outer",
        "Somebody changes 89 to turn by another angle, and nothing changes.",
        "hidden-name",
        "The object and its assignments are removed; the parameter is the reference.",
        line=345,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-tele-twice", "main_Robot.c", "TaskNAVIGATION", "write_REF right after read_T_REF",
        "The code passes the console's reference to TaskSERVO before it tests the bumper, and once more at the end of "
        "the loop. TaskSERVO has the higher priority. If it runs between the two, the motors follow the untested "
        "reference for 25 ms.",
        "TFG 3.1.5 (REF), 3.4 figure 35",
        "The robot pushes briefly against an obstacle although its bumper is pressed.",
        "stop-stops",
        "The reference is written once, at the end of the loop, after the test of the bumper.",
        line=352,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-bump-holds", "main_Robot.c", "TaskNAVIGATION", "if (bumper == 0) Action(0,0) in TELEMANIPULATION",
        "While the bumper is pressed every reference becomes 0, also one that leads away from the obstacle.",
        "TFG 3.3.1 (TELE): the user moves the robot in all directions",
        "When the robot has hit something, somebody must lift it off.",
        "no-effect",
        "The code refuses only driving forward.",
        line=353,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-order-twice", "main_Robot.c", "TaskORD", "char Order_frame[200] = Received_Order()",
        "A call cannot initialise an array, so the printed line is not valid C. Without it, nothing asks "
        "Received_Order whether there is a frame. If two frames come before the task runs, the semaphore has two "
        "posts, but XBee.c keeps one frame. The task executes it twice.",
        "ISO C 6.7.8 p16: the initialiser of an array is a list or a string; SYS/BIOS: counting semaphores",
        "Of the orders sent during the two seconds of start-up, the robot executes the last one twice and the first "
        "one never.",
        "malformed-frame",
        "The task calls Received_Order at each release. Without a frame it does nothing.",
        line=415,
        depends_on="how the printed line, which is not valid C, was compiled",
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-stop-keeps-reference", "main_Robot.c", "TaskORD", "case O_STOP",
        "STOP should set the references of V and W to 0. The code only changes the state. The reference of the last "
        "SETR stays in the server and is used at the next TELE.",
        "TFG 3.3.1 (STOP)",
        "After STOP and TELE the robot drives off with an old speed.",
        "stop-stops",
        "STOP writes a reference of 0 too.",
        DefectKind.TEXT,
        line=427,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-init-reference", "main_Robot.c", "TaskORD", "case O_INITIALITATION",
        "INICIALIZAR should initialise every variable. Neither this case nor Inicializa sets the reference of the "
        "telemanipulation, so the last SETR is used at the next TELE.",
        "TFG 3.3.1 (inicializar el robot)",
        "After INICIALIZAR and TELE the robot drives off with an old speed.",
        "stop-stops",
        "INIT writes a reference of 0, as STOP should.",
        line=446,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-reference-outlives", "main_Robot.c", "TaskORD", "case O_SETR",
        "The robot accepts SETR in every state, and only SETR changes the reference. So a SETR that came in STOP, or "
        "before a mission, is used at the next TELE.",
        "TFG 3.3.1: SETR sets the speed that the robot follows in TELE",
        "After a mission and TELE the robot drives off with an old speed.",
        "stop-stops",
        "The robot accepts SETR only in TELE. MISSION and CALIBRATION set the reference to 0, as STOP should.",
        line=439,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-odo-commanded", "main_Robot.c", "TaskODO",
        "Odom_Trayect(&odoT, Robot_Reference_N.V, Robot_Reference_N.W, ...)",
        "The code computes the odometry from the references at the moment of the call, one of five since the last "
        "call. It uses neither the wheel speeds, which TaskSERVO measures, nor the gyro.",
        "TFG 3.1.3 and 3.3.2: V and W measured by the encoders; header of Odometry.h, figure 13",
        "If the robot is blocked, slips or is overloaded, or turns between two frames, the map shows it where it "
        "never was.",
        "odometry-path",
        "TaskSERVO sums the distance of the wheels and TaskGYRO the angle of the gyro. TaskODO takes both every 250 "
        "ms.",
        DefectKind.TEXT,
        line=468,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-odo-race", "main_Robot.c", "TaskODO", "Robot_Reference_N.V, Robot_Reference_N.W, df, dl, dr",
        "TaskODO (priority 1) reads five 32-bit objects that TaskNAVIGATION (priority 2) writes, without a gate. V "
        "can be of one period and W of the next.",
        "TFG 3.1.5: what tasks share is behind the servers",
        "A smooth path has single wrong points.",
        "race",
        "TaskODO uses read_REF and the read functions of the US server.",
        covered_by=("MAIN-odo-commanded",),
        line=468,
        severity=Severity.WARNING,
    ),
    *main_robot_guards.DEFECTS,
    *main_robot_navigation.DEFECTS,
    Defect(
        "MAIN-init-offset", "main_Robot.c", "Inicializa", "vZ_b = 0",
        "TaskGYRO measures the offset of the gyro at start-up. Inicializa sets it to 0, and nothing measures it again.",
        "L3G4200D data sheet: zero-rate level +-10 degrees/s; TFG 3.1.2 (offset at the start)",
        "After INICIALIZAR the navigation of a standing robot sees a turn.",
        "rotation-bias",
        "Inicializa keeps the offset.",
        line=694,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-init-pointer", "main_Robot.c", "Inicializa", "Ix = 0",
        "The code sets the pointer to the integral to 0, not the integral. The pointer then points to address 0 "
        "(again), and the integral keeps its value. Iw and Iv are not initialised at all.",
        "ISO C 6.5.3.2: *Ix is the object",
        "The controller starts with its old integral. If somebody repairs the pointer, the next INICIALIZAR breaks it "
        "again.",
        "no-effect",
        "The code sets *Ix = 0.",
        line=698,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-init-distances", "main_Robot.c", "Inicializa", "dl = 0, df = 0, dr = 0",
        "INITIALITATION lasts until another order, and Inicializa runs in each of its periods. It sets the three "
        "distances to 0 that TaskNAVIGATION has just read and that TaskODO sends.",
        "TFG 3.1.4: a frame holds the three distances; TFG 3.3.1 (inicializar el robot)",
        "After INICIALIZAR the console draws three walls at the position of the robot until the next order.",
        "closed-loop",
        "Inicializa keeps the distances, because every period reads them again.",
        covered_by=("MAIN-odo-race",),
        line=680,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-init-others", "main_Robot.c", "Inicializa", "Left_distance = 0 ... U_r = 0",
        "Inicializa sets nine objects to 0 that TaskUS and TaskSERVO use in their computations. Both tasks have a "
        "higher priority than TaskNAVIGATION, and there is no gate.",
        "TFG 3.1.5: what tasks share is behind the servers",
        "None while each object is computed again in every period. An object that keeps its value would be lost at "
        "random.",
        "race-long",
        "Each task owns its objects, and Inicializa does not write them.",
        line=683,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-init-odometry", "main_Robot.c", "Inicializa", "no write to the odometry server",
        "INICIALIZAR should initialise everything. The pose in the server and in odoT keeps its value.",
        "TFG 3.3.1 (inicializar el robot)",
        "A new path on the map starts at the end of the last one.",
        "text-versus-code",
        "Inicializa requests it, and TaskODO, which owns the pose, sets it to 0.",
        DefectKind.TEXT,
        line=673,
        severity=Severity.WARNING,
    ),
)  # fmt: skip
