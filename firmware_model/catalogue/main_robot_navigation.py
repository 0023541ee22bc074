"""Defects of the navigation in main_Robot.c, from its controllers' objects to P_ciego, in the order of the lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect, DefectKind

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "MAIN-kix-annex", "main_Robot.c", "kix", "kix = 0.0001",
        "Annex 4 tunes the position controller to Kp = 1 and Ki = 10. The code has kix = 0.0001: for an error of 1 "
        "rad the integral adds 2.5e-7 rad/s per period, which has no effect.",
        "TFG 3.2.3, annex 4",
        "The controller is called PI and is only proportional.",
        "text-versus-code",
        "kix is 10, with the step of 2.5 ms for which it was tuned. With the true step of 50 ms (MAIN-pi-period) it "
        "is 0.5.",
        DefectKind.TEXT,
        line=137,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-null-integrators", "main_Robot.c", "Ix", "float *Ix = 0, Iw, Iwl, Iwr, Iv",
        "The five integrals are null pointers. All of them are the same 32 bits at address 0, which is M0 RAM and "
        "never faults. The controllers of angle, rate and speed would share one integral.",
        "ISO C 6.3.2.3: a null pointer points to no object; F28377S memory map: M0 at 0",
        "None while one controller runs and nothing else uses address 0. Otherwise the robot jerks without a visible "
        "cause.",
        "null-dereference",
        "Each pointer has an object of its own.",
        line=139,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-heading", "main_Robot.c", "TaskNAVIGATION", "tita_abs = wZ * 0.005",
        "The code takes rate times step as the angle. It does not add the steps, so each period forgets the angle. "
        "And the step is 5 ms in a task with a period of 50 ms. At 0.3 rad/s the heading after one second is 0.0015 "
        "rad instead of 0.3 rad.",
        "TFG 3.2.3: the position controller compares the angle turned; arithmetic",
        "The controller passes its reference through. No turn ends at its angle, and the robot holds no course.",
        "rotation-scale",
        "TaskGYRO sums rate times period. TaskNAVIGATION adds the angle since its last call.",
        line=320,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-bump-repeats", "main_Robot.c", "MISION_4", "the branch bumper == 0",
        "After 60 periods the robot should drive backwards, but it does so only until the bumper is released (2 mm). "
        "If the front sonar does not detect the obstacle (slanted or slim), the robot drives at it again in the next "
        "period.",
        "TFG 3.2.1: after an obstacle the robot takes another direction",
        "None today, because MAIN-bump-clears prevents driving backwards. Without that defect the robot hits the wall "
        "again every three seconds.",
        "closed-loop",
        "The robot drives 15 cm back and then turns.",
        line=491,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-safety-distance", "main_Robot.c", "MISION_4", "if (df < 45)",
        "The safety distance in the text is 40 cm. The code stops at 45 cm, and below 25 cm it drives back up to 45 "
        "cm.",
        "TFG 3.2.1 (Frente, Rodeado: 40 cm)",
        "The robot refuses passages that it takes according to the text.",
        "text-versus-code",
        "The safety distance is 40 cm.",
        DefectKind.TEXT,
        line=495,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-side-correction", "main_Robot.c", "MISION_4", "Position(-2, v) and Position(2, v)",
        "For a wall nearer than 30 cm the code corrects the course by 2 degrees, at 29 cm as at 16 cm. If both sides "
        "are nearer than 30 cm, it corrects nothing.",
        "TFG 3.2.1: the course is corrected so that the robot comes no nearer",
        "In a narrow passage the robot drives into the nearer wall.",
        "closed-loop",
        "The correction is one degree for each centimetre below 30 cm, right minus left, 20 degrees at most "
        "(rectifica).",
        line=514,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-ciego-unused", "main_Robot.c", "MISION_4", "no call of P_ciego",
        "The text describes how the change of the side distance shows an approaching wall, and it reports good "
        "results. The code never calls the function that computes this change.",
        "TFG 3.2.2 (case C, figure 21)",
        "The blind spots of the sonars remain.",
        "never-called",
        "MISION_4 calls P_ciego for the nearer side and turns 2 degrees away from a wall that approaches.",
        DefectKind.TEXT,
        line=483,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-blind-spot", "main_Robot.c", "MISION_4", "Position(0, 0.15): df > 60 means free",
        "A wall at 40 to 50 degrees reflects no echo back to the sonar. The code takes three sonars without an echo "
        "for free space, and the robot drives on at 0.15 m/s.",
        "TFG 3.2.2: blind spot between 40 and 50 degrees; LV-MaxSonar-EZ data sheet: beam on a flat board",
        "The robot collides with walls that are at an angle.",
        "closed-loop",
        "If front, left and right have had no echo for 8 periods (6 cm), the robot stops. It turns 45 degrees to the "
        "side that lost its echo first, where the way has opened.",
        line=521,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-bump-turn", "main_Robot.c", "MISION_4", "if (caso > 60)",
        "The code starts the turn whether the bumper is pressed or not. A robot that should stand in front of an "
        "obstacle drives on at 0.1 m/s.",
        "TFG 3.2.1: the bumper is an obstacle in front, before which the robot stands",
        "None today, because MAIN-bump-clears sets the counter to 0. Without that defect the robot pushes the "
        "obstacle.",
        "closed-loop",
        "The turn starts only if the bumper is free.",
        covered_by=("MAIN-turn-moving",),
        line=534,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-turn-moving", "main_Robot.c", "MISION_4", "Position(89, 0.1), Position(-89, 0.1)",
        "The robot drives forward at 0.1 m/s while it turns in front of an obstacle. That is a quarter of a circle "
        "with a radius of 7 cm or more, and it starts 25 to 45 cm before the wall.",
        "TFG 3.2.1: the robot stands, measures, turns, and then goes on",
        "In a corner the robot touches the wall from which it turns away.",
        "closed-loop",
        "The robot turns on the spot.",
        line=539,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-turn-not-kept", "main_Robot.c", "MISION_4", "if (caso > 60), while df < 45",
        "The turn of 89 degrees lasts only while the front sonar hears the wall. It loses the wall at 25 degrees, and "
        "the turn ends some 0.15 s later. The code also chooses the side again every 50 ms, from sonars that turn "
        "with the robot.",
        "TFG 3.2.3: angles by a position controller; LV-MaxSonar-EZ data sheet: beam on a flat board",
        "Turns end between 30 and 50 degrees, in the blind spot, or change their direction.",
        "closed-loop",
        "The code decides side and angle once. The turn ends 3 degrees before its angle, and this heading is the new "
        "straight ahead.",
        line=534,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-equal-distances", "main_Robot.c", "MISION_4", "if (dl > dr) ... else if (dr > dl)",
        "With equal distances on both sides the code starts no turn, and the counter continues.",
        "TFG 3.2.1: the robot goes to one of the two sides",
        "The robot stands in front of a wall for ever.",
        "closed-loop",
        "With equal distances the robot turns right.",
        line=543,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-state-surrounded", "main_Robot.c", "MISION_4", "EstadoNav = RODEADO",
        "RODEADO is the state in which the robot drives back from an obstacle that is too near. The code sets it "
        "before a turn, where the next lines overwrite it, and does not set it when the robot drives backwards.",
        "TFG 3.2.1 (Rodeado)",
        "In a debugger the state is FRENTE while the robot drives backwards.",
        "text-versus-code",
        "The state is set where the robot drives backwards.",
        DefectKind.TEXT,
        line=536,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-reverse-unbounded", "main_Robot.c", "MISION_4", "if (caso2 > 60) Position(0, -0.1)",
        "While the front sonar reports less than 45 cm the robot drives backwards. It has no sensor behind, and there "
        "is no limit.",
        "TFG 3.2.1: backwards up to the safety distance, at most 40 cm away",
        "A cat that follows, or a broken sonar, makes the robot drive backwards into anything.",
        "closed-loop",
        "The robot drives back for 60 periods (30 cm) at most, then it turns.",
        line=549,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-pi-period", "main_Robot.c", "PI", "ki*err*Tsw",
        "Tsw is 2.5 ms. TaskNAVIGATION calls PI every 50 ms, and the period of the servos is 25 ms. So the integral "
        "is 20 times too slow, and Ki is not a gain per second.",
        "Definition of the integral; Navigation_Period",
        "The gains were found by trial and do not agree with any calculation.",
        "unit",
        "The step is Navigation_Period.",
        line=567,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-hidden-names", "main_Robot.c", "PI",
        "float kp, float ki; dF_ant in Comp, Wpi in velocity, Wpos in Position",
        "Three parameters and two locals have the names of file-scope objects. The file's kp and ki are the gains for "
        "W, but within PI they are what the caller passes. The file's Wpi and Wpos are never set, because the locals "
        "are set instead.",
        "ISO C 6.2.1: the inner declaration hides the outer",
        "None, except in a debugger: kp is the gain of another controller, and Wpi and Wpos are always 0.",
        "hidden-name",
        "The file-scope objects have names of their own, or the code sets them and not the locals.",
        line=555,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-undefined", "main_Robot.c", "Comp", "if (X <= 0)",
        "X gets a value only for i > 50, and the code compares it in any case.",
        "ISO C 6.7.8 p10: an automatic object without initialiser is indeterminate",
        "None while the only caller calls the function for i > 50. Otherwise the speed is a random number.",
        "maybe-uninitialised",
        "X starts at 0.",
        gone_with="MAIN-speed-control-unused",
        line=581,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-unit", "main_Robot.c", "Comp", "dF_act = (float) Read_Channel(1)",
        "dF_act is a number of ADC counts (213 at 65 cm), and dF_ant is a distance in cm. Their difference gives 0.3 "
        "m/s for a robot that stands. The function also uses the ADC beside TaskUS without a gate.",
        "us.c: Read_Channel returns the converter's result, Read_Distance centimetres",
        "The speed control brakes a robot that stands.",
        "unit",
        "The function calls read_front_distance().",
        gone_with="MAIN-speed-control-unused",
        covered_by=("MAIN-comp-sign",),
        line=578,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-sign", "main_Robot.c", "Comp", "(dF_act - dF_ant)",
        "When the robot drives forward, the distance ahead becomes smaller. The difference is negative, and the code "
        "sets it to 0. Only a robot that drives backwards has a speed. Figure 24 has the same sign.",
        "Geometry; TFG 3.2.3, figure 24",
        "The measured speed is 0 whenever the robot drives forward.",
        "closed-loop",
        "The difference is dF_ant - dF_act.",
        gone_with="MAIN-speed-control-unused",
        line=579,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-span", "main_Robot.c", "Comp", "X/5",
        "The code takes the two distances in the 10th and in the 52nd period of 50 ms, 2.1 s apart, and divides by 5 "
        "s.",
        "Lineal_velocity: Cuenta_US < 10 and > 50; Navigation_Period",
        "The measured speed is 42 % of the true one.",
        "unit",
        "The code divides by 2.1 s.",
        gone_with="MAIN-speed-control-unused",
        line=585,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-speed-control-unused", "main_Robot.c", "Lineal_velocity", "no caller of Lineal_velocity and velocity",
        "Nothing calls the controllers of V and W. The text tried them and kept the controller of the position.",
        "TFG 3.2.3: the control of V was discarded, the final configuration is figure 23; the gains are commented as "
        "not used",
        "Whoever looks for the speed control of the robot finds three functions with eight defects that never run.",
        "never-called",
        "Lineal_velocity, velocity, Comp and the objects that only they use are removed.",
        line=604,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-lineal-range", "main_Robot.c", "Lineal_velocity", "25<df<90",
        "The expression compares the result of 25 < df, which is 0 or 1, with 90. It is always true.",
        "ISO C 6.5.8: relational operators group to the left and give int; TFG 3.2.3 (20 to 80 cm)",
        "The function measures the speed at distances at which the sonar is not accurate enough.",
        "constant-condition",
        "The condition is 25 < df && df < 90.",
        gone_with="MAIN-speed-control-unused",
        line=611,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-lineal-turning", "main_Robot.c", "Lineal_velocity", "wZ <= 1",
        "The test excludes only fast turns to the left. Turns to the right are negative and pass.",
        "L3G4200D data sheet: the sign is the direction; TFG 3.2.3",
        "When the robot turns right, passing furniture counts as speed.",
        "rotation-sign",
        "The code tests the magnitude of wZ.",
        gone_with="MAIN-speed-control-unused",
        line=611,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-lineal-straightens", "main_Robot.c", "Lineal_velocity", "Action(V_pi, 0)",
        "When the function controls V it sets the ordered rate of turn to 0.",
        "TFG figure 25: V and W are regulated side by side",
        "With this speed control the robot would no longer turn.",
        "closed-loop",
        "The ordered rate stays.",
        gone_with="MAIN-speed-control-unused",
        line=629,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-velocity-reference", "main_Robot.c", "velocity", "Wref",
        "The function ignores the rate that its caller passes. It uses Robot_Reference_S.W, the reference of the last "
        "period, which TaskSERVO writes.",
        "ISO C: the parameter is never read",
        "The controller follows its own output.",
        "unused-parameter",
        "Wref is the reference.",
        gone_with="MAIN-speed-control-unused",
        line=632,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-position-count", "main_Robot.c", "Position", "cont_pos",
        "The counter of calls is a local. It is 1 in each call and never reaches 60.",
        "ISO C 6.2.4: automatic storage ends with the call",
        "The pause after 60 periods that the code describes does not exist.",
        "no-effect",
        "The counter has static storage.",
        line=644,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-position-radians", "main_Robot.c", "Position", "titaref*0.0174",
        "A degree is 0.0174533 rad; 0.0174 is 0.3 % less, a quarter of a degree in a quarter turn.",
        "pi/180",
        "Four quarter turns are one degree less than a full circle.",
        "unit",
        "The factor is 0.01745329.",
        line=642,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-ciego-overflow", "main_Robot.c", "P_ciego", "temp = t*20",
        "temp is an int of 16 bits. For t >= 1639 s the product is negative.",
        "ISO C 6.5 p5 with the widths of the C28x (SPRU514): int has 16 bits",
        "None with times of seconds.",
        "overflow",
        "The product is computed in 32 bits.",
        line=657,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-ciego-limits", "main_Robot.c", "P_ciego", "dmax, dmin",
        "The function ignores its limits for valid distances.",
        "ISO C: the parameters are never read",
        "A distance to another object counts as a wall that jumps.",
        "unused-parameter",
        "A distance outside the limits starts a new measurement.",
        line=654,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-ciego-zero", "main_Robot.c", "P_ciego", "(d_act-d_ant)/temp",
        "For t = 0 the function divides by 0.",
        "ISO C 6.5.5: undefined",
        "The rate of turn is infinite or undefined.",
        "division-by-zero",
        "Without a time the result is 0.",
        line=667,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-ciego-forgets", "main_Robot.c", "P_ciego", "d_ant = d_act",
        "The previous distance is a local that is 0 at the start of every call. For a constant 50 cm the result is "
        "2.5 cm per period. One counter is used for both sides.",
        "ISO C 6.2.4: automatic storage ends with the call; TFG figure 24",
        "A wall at rest seems to move away fast.",
        "dead-store",
        "The function keeps the distance at the start of the time, and computes the change at its end.",
        line=669,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
