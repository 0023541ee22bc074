"""Defects of the navigation in main_Robot.c, from its controllers' objects to P_ciego, in the order of the lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect, DefectKind

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "MAIN-kix-annex", "main_Robot.c", "kix", "kix = 0.0001",
        "Annex 4 tunes the position controller to Kp = 1, Ki = 10. The code has kix = 0.0001: the integral adds "
        "2.5e-7 rad/s a period for an error of 1 rad, which is nothing.",
        "TFG 3.2.3, annex 4",
        "A proportional controller that is called PI.",
        "text-versus-code",
        "10, with the step of 2.5 ms it was tuned with; 0.5 once the step is the true one of 50 ms (MAIN-pi-period).",
        DefectKind.TEXT,
        line=137,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-null-integrators", "main_Robot.c", "Ix", "float *Ix = 0, Iw, Iwl, Iwr, Iv",
        "The five integrals are pointers that point nowhere: all of them are the 32 bits at address 0, which is M0 RAM "
        "and never faults. Controllers of angle, rate and speed would share one integral.",
        "ISO C 6.3.2.3: a null pointer points to no object; F28377S memory map: M0 at 0",
        "None as long as one controller runs and nobody else uses address 0; then jumps without a cause.",
        "null-dereference", "Each pointer has an object of its own.",
        line=139,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-heading", "main_Robot.c", "TaskNAVIGATION", "tita_abs = wZ * 0.005",
        "The angle is the rate times a step. It is not summed up, so it is forgotten every period, and the step is 5 "
        "ms in a task of 50 ms: at 0.3 rad/s the heading after one second is 0.0015 rad instead of 0.3.",
        "TFG 3.2.3: the position controller compares the angle turned; arithmetic",
        "The controller feeds its reference through: no turn ends by its angle, no course is held.",
        "rotation-scale",
        "TaskGYRO sums rate times its period; TaskNAVIGATION adds what was turned since it last asked.",
        line=320,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-bump-repeats", "main_Robot.c", "MISION_4", "the branch bumper == 0",
        "After 60 periods the robot is to reverse, but only until the bumper lets go, 2 mm. If the front sonar does not "
        "hear the obstacle (slanted, slim), the next period drives at it again.",
        "TFG 3.2.1: after an obstacle the robot takes another direction",
        "None today: MAIN-bump-clears keeps it from ever reversing. Without that one it knocks at the wall again and "
        "again, every three seconds.",
        "closed-loop", "15 cm back, then a turn.",
        line=491,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-safety-distance", "main_Robot.c", "MISION_4", "if (df < 45)",
        "The safety distance of the text is 40 cm. The code stops at 45 cm, and reverses below 25 cm up to 45.",
        "TFG 3.2.1 (Frente, Rodeado: 40 cm)",
        "The robot refuses ways that the text says it takes.",
        "text-versus-code", "40 cm.",
        DefectKind.TEXT,
        line=495,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-side-correction", "main_Robot.c", "MISION_4", "Position(-2, v) and Position(2, v)",
        "A wall nearer than 30 cm is answered by 2 degrees, 29 cm and 16 cm alike, and by nothing at all when both "
        "sides are nearer than 30 cm.",
        "TFG 3.2.1: the course is corrected so that the robot comes no nearer",
        "In a narrow passage the robot drives into the nearer wall.",
        "closed-loop", "One degree for each centimetre below 30, right minus left, 20 degrees at most (rectifica).",
        line=514,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-ciego-unused", "main_Robot.c", "MISION_4", "no call of P_ciego",
        "The text describes how the variation of the side distance tells an approaching wall and reports good results. "
        "The function that computes the variation is called by nobody.",
        "TFG 3.2.2 (case C, figure 21)",
        "Blind spots as before.",
        "never-called",
        "MISION_4 asks P_ciego about the nearer side and bears 2 degrees away from a wall that approaches.",
        DefectKind.TEXT,
        line=483,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-blind-spot", "main_Robot.c", "MISION_4", "Position(0, 0.15): df > 60 means free",
        "At 40 to 50 degrees a wall throws no echo back. Three sonars that hear nothing are taken for free space, and "
        "the robot drives on at 0.15 m/s.",
        "TFG 3.2.2: blind spot between 40 and 50 degrees; LV-MaxSonar-EZ data sheet: beam on a flat board",
        "Collisions with walls that stand at an angle.",
        "closed-loop",
        "When nothing has been heard ahead, left and right for 8 periods (6 cm), the robot stops and turns by 45 "
        "degrees to the side that went silent first, where the way has opened.",
        line=521,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-bump-turn", "main_Robot.c", "MISION_4", "if (caso > 60)",
        "The turn is begun whether the bumper is pressed or not: who was to stand before an obstacle in front drives on at "
        "0.1 m/s.",
        "TFG 3.2.1: the bumper is an obstacle in front, before which the robot stands",
        "None today: MAIN-bump-clears sets the counter to 0. Without that one the robot pushes what it has run into.",
        "closed-loop", "Only with the bumper free.",
        covered_by=("MAIN-turn-moving",),
        line=534,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-turn-moving", "main_Robot.c", "MISION_4", "Position(89, 0.1), Position(-89, 0.1)",
        "The turn before an obstacle is driven with 0.1 m/s forward: a quarter of a circle of 7 cm radius and more, "
        "starting 25 to 45 cm before the wall.",
        "TFG 3.2.1: the robot stands, measures, turns, and then goes on",
        "In a corner the robot touches what it turns away from.",
        "closed-loop", "It turns on the spot.",
        line=539,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-turn-not-kept", "main_Robot.c", "MISION_4", "if (caso > 60), while df < 45",
        "The turn of 89 degrees lasts as long as the front sonar hears the wall, which it loses at 25 degrees and some "
        "0.15 s later; and the side is chosen anew from turning sonars every 50 ms.",
        "TFG 3.2.3: angles by a position controller; LV-MaxSonar-EZ data sheet: beam on a flat board",
        "Turns end between 30 and 50 degrees, in the blind spot, or go to and fro.",
        "closed-loop",
        "Side and angle are decided once; the turn ends 3 degrees before its angle, and its end is the new straight "
        "on.",
        line=534,
        severity=Severity.ERROR,
    ),
    Defect(
        "MAIN-equal-distances", "main_Robot.c", "MISION_4", "if (dl > dr) ... else if (dr > dl)",
        "With equal distances there is no turn; the counter runs on.",
        "TFG 3.2.1: the robot goes to one of the two sides",
        "The robot stands before a wall for ever.",
        "closed-loop", "Equal distances lead to the right.",
        line=543,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-state-surrounded", "main_Robot.c", "MISION_4", "EstadoNav = RODEADO",
        "RODEADO is the state of reversing from something too near. The code sets it before it turns left or right, "
        "where it is overwritten in the next lines, and not when it reverses.",
        "TFG 3.2.1 (Rodeado)",
        "A debugger shows FRENTE while the robot drives backwards.",
        "text-versus-code", "Set where the robot reverses.",
        DefectKind.TEXT,
        line=536,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-reverse-unbounded", "main_Robot.c", "MISION_4", "if (caso2 > 60) Position(0, -0.1)",
        "As long as the front sonar says less than 45 cm the robot reverses, without eyes behind and without an end.",
        "TFG 3.2.1: backwards up to the safety distance, at most 40 cm away",
        "A cat that follows, or a broken sonar, drives the robot backwards into whatever is there.",
        "closed-loop", "60 periods (30 cm) at most, then a turn.",
        line=549,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-pi-period", "main_Robot.c", "PI", "ki*err*Tsw",
        "Tsw is 2.5 ms. PI is called by TaskNAVIGATION every 50 ms, and the period of the servos is 25 ms: the "
        "integral is 20 times too slow, and Ki is no gain per second.",
        "Definition of the integral; Navigation_Period",
        "Gains that were tuned by trial and mean nothing on paper.",
        "unit", "The step is Navigation_Period.",
        line=567,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-hidden-names", "main_Robot.c", "PI", "float kp, float ki; dF_ant in Comp, Wpi in velocity, Wpos in Position",
        "Three parameters and two locals have the names of objects at file scope. kp and ki of the file are the gains of "
        "W, and within PI whatever the caller passes; Wpi and Wpos of the file are never set, as the locals take their "
        "place.",
        "ISO C 6.2.1: the inner declaration hides the outer",
        "None, but for whoever debugs: kp in a watch is the gain of another controller, Wpi and Wpos are 0 for ever.",
        "hidden-name", "The objects of the file have names of their own, or are the ones that are set.",
        line=555,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-undefined", "main_Robot.c", "Comp", "if (X <= 0)",
        "X gets a value only for i > 50 and is compared in any case.",
        "ISO C 6.7.8 p10: an automatic object without initialiser is indeterminate",
        "None while the only caller calls it beyond 50; a speed out of nothing otherwise.",
        "maybe-uninitialised", "X starts at 0.", gone_with="MAIN-speed-control-unused",
        line=581,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-unit", "main_Robot.c", "Comp", "dF_act = (float) Read_Channel(1)",
        "dF_act is a number of counts (213 at 65 cm), dF_ant a distance in cm. Their difference is the speed of a "
        "robot that stands, 0.3 m/s; and the ADC is used beside TaskUS without a gate.",
        "us.c: Read_Channel returns the converter's result, Read_Distance centimetres",
        "A speed control that brakes a standing robot.",
        "unit", "read_front_distance().", gone_with="MAIN-speed-control-unused",
        covered_by=("MAIN-comp-sign",),
        line=578,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-sign", "main_Robot.c", "Comp", "(dF_act - dF_ant)",
        "Driving forward makes the distance ahead smaller: the difference is negative and becomes 0. Only a robot that "
        "reverses has a speed. Figure 24 has the same sign.",
        "Geometry; TFG 3.2.3, figure 24",
        "The measured speed is 0 whenever the robot drives.",
        "closed-loop", "dF_ant - dF_act.", gone_with="MAIN-speed-control-unused",
        line=579,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-comp-span", "main_Robot.c", "Comp", "X/5",
        "The two distances are taken in the 10th and the 52nd period of 50 ms, 2.1 s apart; the code divides by 5 s.",
        "Lineal_velocity: Cuenta_US < 10 and > 50; Navigation_Period",
        "A speed of 42 % of the true one.",
        "unit", "2.1 s.", gone_with="MAIN-speed-control-unused",
        line=585,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-speed-control-unused", "main_Robot.c", "Lineal_velocity", "no caller of Lineal_velocity and velocity",
        "The controllers of V and of W are called by nobody: the text tried them and kept the one of the position.",
        "TFG 3.2.3: the control of V was discarded, the final configuration is figure 23; the gains are commented as "
        "not used",
        "Whoever looks for the robot's speed control finds three functions with eight defects that never run.",
        "never-called", "Lineal_velocity, velocity, Comp and the objects that only they use are gone.",
        line=604,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-lineal-range", "main_Robot.c", "Lineal_velocity", "25<df<90",
        "Compares the truth value of 25 < df, 0 or 1, with 90: always true.",
        "ISO C 6.5.8: relational operators group to the left and give int; TFG 3.2.3 (20 to 80 cm)",
        "Speed is measured where the sonar is no good for it.",
        "constant-condition", "25 < df && df < 90.", gone_with="MAIN-speed-control-unused",
        line=611,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-lineal-turning", "main_Robot.c", "Lineal_velocity", "wZ <= 1",
        "Leaves out fast turns to the left only; turns to the right are negative and pass.",
        "L3G4200D data sheet: the sign is the direction; TFG 3.2.3",
        "Turning to the right past furniture is taken for speed.",
        "rotation-sign", "The magnitude of wZ.", gone_with="MAIN-speed-control-unused",
        line=611,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-lineal-straightens", "main_Robot.c", "Lineal_velocity", "Action(V_pi, 0)",
        "Regulating V sets the commanded rate to 0.",
        "TFG figure 25: V and W are regulated side by side",
        "With the speed control in use the robot would not turn any more.",
        "closed-loop", "The commanded rate stays.", gone_with="MAIN-speed-control-unused",
        line=629,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-velocity-reference", "main_Robot.c", "velocity", "Wref",
        "The rate that the caller asks for is not used; instead Robot_Reference_S.W is, the reference of the last "
        "period, which TaskSERVO writes.",
        "ISO C: the parameter is never read",
        "A controller that follows its own output.",
        "unused-parameter", "Wref is the reference.", gone_with="MAIN-speed-control-unused",
        line=632,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-position-count", "main_Robot.c", "Position", "cont_pos",
        "A counter of calls that lives in the function: it is 1 in each call and never reaches 60.",
        "ISO C 6.2.4: automatic storage ends with the call",
        "The pause after 60 periods that the code describes does not exist.",
        "no-effect", "The counter has static storage.",
        line=644,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-position-radians", "main_Robot.c", "Position", "titaref*0.0174",
        "A degree is 0.0174533 rad; 0.0174 is 0.3 % less, a quarter of a degree in a quarter turn.",
        "pi/180",
        "Four quarter turns miss a circle by one degree.",
        "unit", "0.01745329.",
        line=642,
        severity=Severity.WARNING,
    ),
    Defect(
        "MAIN-ciego-overflow", "main_Robot.c", "P_ciego", "temp = t*20",
        "An int of 16 bits: from t = 1639 s on the product is negative.",
        "ISO C 6.5 p5 with the widths of the C28x (SPRU514): int has 16 bits",
        "None with times of seconds.",
        "overflow", "The product is computed in 32 bits.",
        line=657,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-ciego-limits", "main_Robot.c", "P_ciego", "dmax, dmin",
        "The limits of the distances that count are taken and not used.",
        "ISO C: the parameters are never read",
        "Distances of another room count as a wall that jumps.",
        "unused-parameter", "A distance outside begins a new measurement.",
        line=654,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-ciego-zero", "main_Robot.c", "P_ciego", "(d_act-d_ant)/temp",
        "For t = 0 the variation is divided by 0.",
        "ISO C 6.5.5: undefined",
        "An infinite or undefined rate of turn.",
        "division-by-zero", "Without a time there is no variation: 0.",
        line=667,
        severity=Severity.NOTE,
    ),
    Defect(
        "MAIN-ciego-forgets", "main_Robot.c", "P_ciego", "d_ant = d_act",
        "The distance before is a local that starts at 0 in every call: the variation of a constant 50 cm is 2.5 cm a "
        "period, and one counter serves both sides.",
        "ISO C 6.2.4: automatic storage ends with the call; TFG figure 24",
        "A wall at rest seems to rush away.",
        "dead-store", "The distance at the begin of the time is kept; the variation is taken at its end.",
        line=669,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
