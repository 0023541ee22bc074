"""Demonstrations of the defects of the navigation and of the functions it uses, by id."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import accumulate
from math import degrees, dist, nan, radians
from typing import Final

from hil.audit.evidence import Evidence, Picture, Series, measured, reported
from hil.audit.rig import Fixes, Rig, robot, static_findings
from hil.audit.task_rig import TaskRig
from hil.bench import Bench
from hil.world.robot_params import Pose

PRESSED, FREE = 0, 1
PERIOD_S: Final = 0.05
#: Nothing answers: what the three calibrations make of 255 inches is beyond this.
NOTHING_CM: Final = 655.0


def _mission(fixes: Fixes, calls: int, *, bumper: int = FREE, df: float, dl: float, dr: float) -> Rig:
    """Return a rig on which MISION_4 has been called with the same distances (cm) for some periods."""
    rig = TaskRig(fixes)
    _go(rig, calls, bumper=bumper, df=df, dl=dl, dr=dr)
    return rig


def _go(rig: Rig, calls: int, *, bumper: int = FREE, df: float, dl: float, dr: float) -> list[float]:
    """Return the commanded speeds (m/s) of `calls` periods of the mission."""
    main = rig.fw.main_robot
    main.bumper, main.df, main.dl, main.dr = bumper, df, dl, dr
    speeds = []
    for _ in range(calls):
        main.MISION_4()
        speeds.append(float(main.Robot_Reference_N.V))
    return speeds


def safety_distance(fixes: Fixes) -> Evidence:
    """Show a wall 42 cm ahead, beyond the safety distance of the text: the robot must still drive (slowly)."""
    rig = _mission(fixes, 1, df=42.0, dl=100.0, dr=100.0)
    return measured("speed 42 cm before a wall", rig.fw.main_robot.Robot_Reference_N.V, "m/s", low=0.09)


def turn_moving(fixes: Fixes) -> Evidence:
    """Wait three seconds before a wall: the robot then turns, and must stay in place meanwhile."""
    rig = _mission(fixes, 62, df=38.0, dl=100.0, dr=50.0)
    return measured("speed while turning", rig.fw.main_robot.Robot_Reference_N.V, "m/s", low=0.0, high=0.0)


def turn_not_kept(fixes: Fixes) -> Evidence:
    """Turn to the left before the end of the corridor.  A wall is certainly detected within 20 degrees of its normal.
    """
    with robot(fixes, world="corridor", watch=False) as bench:
        bench.run_for(0.8)
        bench.world.place(Pose(3.13, 0.6, 0.0))
        bench.feed(b"#MISN\r")
        bench.run_for(5.5)
        path = bench.true_path()
        start = path[0].time_s
        turned = Series("turned", [p.time_s - start for p in path], [degrees(p.heading_rad) for p in path])
        picture = Picture("The turn before a wall", "time since MISN in s", "turned in degrees", [turned])
        angle = degrees(bench.world.pose.heading_rad)
    return measured("a turn of 89 degrees", angle, "degrees", low=69.0, high=109.0).shown(picture)


def equal_distances(fixes: Fixes) -> Evidence:
    """Show the same distance on both sides: the robot must turn to the left or to the right."""
    rig = _mission(fixes, 62, df=38.0, dl=100.0, dr=100.0)
    turning = abs(rig.fw.main_robot.Robot_Reference_N.W)
    return measured("rate commanded between equal distances", turning, "rad/s", low=0.1)


def reverse_unbounded(fixes: Fixes) -> Evidence:
    """Keep an obstacle 20 cm ahead for 9 s.  The robot has no sensor behind; the safety distance is 40 cm."""
    rig = TaskRig(fixes)
    speeds = _go(rig, 180, df=20.0, dl=100.0, dr=80.0)
    way = list(accumulate(-min(v, 0.0) * PERIOD_S for v in speeds))
    times = [PERIOD_S * (i + 1) for i in range(len(way))]
    limit = Series("safety distance", [times[0], times[-1]], [0.4, 0.4])
    picture = Picture("Something stays 20 cm ahead", "time in s", "way backwards in m",
                      [Series("driven", times, way), limit])  # fmt: skip
    return measured("way driven backwards blindly", way[-1], "m", high=0.4).shown(picture)


def side_correction(fixes: Fixes) -> Evidence:
    """Show walls on both sides, the left one nearer: the robot must turn to the right, which is negative."""
    rig = _mission(fixes, 1, df=300.0, dl=20.0, dr=28.0)
    evidence = measured("rate 20 cm from the left wall", rig.fw.main_robot.Robot_Reference_N.W, "rad/s", high=-0.03)
    lines = []
    for right_cm in (28.0, 100.0):
        rates = []
        for left_cm in range(10, 46):
            _go(rig, 1, df=300.0, dl=float(left_cm), dr=right_cm)
            rates.append(float(rig.fw.main_robot.Robot_Reference_N.W))
        lines.append(Series(f"right wall at {right_cm:g} cm", range(10, 46), rates))
    return evidence.shown(Picture("The answer to a wall", "left wall in cm", "rate in rad/s", lines))


def _walls_near(bench: Bench, reach_m: float) -> Series:
    """Return the parts of the walls within `reach_m` of the robot."""
    points: list[tuple[float, float]] = []
    for (ax, ay), (bx, by) in bench.walls:
        wall = [(ax + (bx - ax) * i / 500, ay + (by - ay) * i / 500) for i in range(501)]
        points += [*(point for point in wall if dist(point, bench.world.pose[:2]) < reach_m), (nan, nan)]
    return Series("walls", [x for x, _ in points], [y for _, y in points])


def blind_spot(fixes: Fixes) -> Evidence:
    """Leave the corridor's bend, where all walls are at 45 degrees: no sonar detects anything while a wall comes
    nearer."""
    with robot(fixes, world="corridor", watch=False) as bench:
        bench.run_for(0.8)
        bench.world.place(Pose(3.15, 1.0, radians(90.0)))
        bench.feed(b"#MISN\r")
        bench.run_for(4.5)
        hits = bench.world.robot.collisions
        path = bench.true_path()
        driven = Series("path", [p.x_m for p in path], [p.y_m for p in path])
        picture = Picture("Towards a slanted wall", "x in m", "y in m", [driven, _walls_near(bench, 1.0)], plane=True)
    return measured("collisions with a slanted wall", hits, high=0.0).shown(picture)


def ciego_unused(fixes: Fixes) -> Evidence:
    """Look for calls of the function that section 3.2.2 credits with few collisions."""
    return reported(static_findings(fixes), "never-called", function="P_ciego")


def bump_repeats(fixes: Fixes) -> Evidence:
    """Reverse from a wall that the sonar does not detect: the robot must not drive at it once more."""
    rig = TaskRig(fixes)
    _go(rig, 65, bumper=PRESSED, df=NOTHING_CM, dl=100.0, dr=100.0)
    speeds = _go(rig, 60, df=NOTHING_CM, dl=100.0, dr=100.0)
    return measured("greatest speed in the 3 s after a bump", max(speeds), "m/s", high=0.0)


def bump_turn(fixes: Fixes) -> Evidence:
    """Wait three seconds before a wall, then press the bumper."""
    rig = _mission(fixes, 62, df=38.0, dl=100.0, dr=50.0)
    speed = _go(rig, 1, bumper=PRESSED, df=38.0, dl=100.0, dr=50.0)[-1]
    return measured("speed with the bumper pressed, at the time of a turn", speed, "m/s", high=0.0)


def dead_sonar(fixes: Fixes) -> Evidence:
    """Drive a mission of more than three seconds whose front sonar gives 0 V."""
    rig = TaskRig(fixes)
    us = rig.fw.us
    us.Init_US()
    us.Calibrate_US(us.US_SENSOR.FRONT, 0.0564, 2.3776)
    rig.codes(lambda _soc: 0)
    speeds = _go(rig, 70, df=float(us.Read_Distance(us.US_SENSOR.FRONT)), dl=100.0, dr=100.0)
    return measured("speed of a mission with a dead front sonar", min(speeds), "m/s", low=0.0)


def state_surrounded(fixes: Fixes) -> Evidence:
    """Stay too near for three seconds: the robot reverses, which the text calls RODEADO (5)."""
    rig = _mission(fixes, 62, df=20.0, dl=100.0, dr=80.0)
    main = rig.fw.main_robot
    return measured("EstadoNav while reversing from an obstacle", main.EstadoNav, low=5, high=5)


def pi_period(fixes: Fixes) -> Evidence:
    """Give a unit error for one period with a unit gain: the integral must grow by one period, 0.05 s."""
    rig = Rig(fixes)
    integral = rig.fw.new("float32", 0.0)
    rig.fw.main_robot.PI(1.0, 0.0, 0.0, 1.0, integral, 10.0, -10.0)
    return measured("the integral after one period", integral.load(), "s", low=0.0499, high=0.0501)


def hidden_names(fixes: Fixes) -> Evidence:
    """List parameters and locals with names of objects at file scope, without titaref (MAIN-titaref-unread)."""
    names = {"PI.kp", "PI.ki", "Comp.dF_ant", "velocity.Wpi", "Position.Wpos"}
    findings = [f for f in static_findings(fixes) if f.object.removeprefix("main_robot.") in names]
    return reported(findings, "hidden-name")


def comp_undefined(fixes: Fixes) -> Evidence:
    """Show that the change of the distance is used whether it was computed or not."""
    return reported(static_findings(fixes), "maybe-uninitialised", function="Comp", object="X")


def _comp(fixes: Fixes, before_cm: float, now: int) -> float:
    """Return the result of Comp for a front distance that was `before_cm`, when converter and server both give `now`.
    """
    rig = TaskRig(fixes, Read_Channel=lambda _ch: now, read_front_distance=lambda: float(now))
    return float(rig.fw.main_robot.Comp(51, before_cm))


def comp_unit(fixes: Fixes) -> Evidence:
    """Stand 65 cm before a wall, where the converter gives 213 counts."""
    rig = TaskRig(fixes, Read_Channel=lambda _ch: 213, read_front_distance=lambda: 65.0)
    return measured("speed of a standing robot", rig.fw.main_robot.Comp(51, 65.0), "m/s", low=0.0, high=0.0)


def comp_sign(fixes: Fixes) -> Evidence:
    """Bring the wall ahead nearer by 100: the robot drives forward, which is positive."""
    return measured("speed towards a wall", _comp(fixes, 300.0, 200), "m/s", low=0.05)


def comp_span(fixes: Fixes) -> Evidence:
    """Change the distance by 42 cm in either direction between the 10th and the 52nd period of 50 ms: 2.1 s, so 0.2
    m/s."""
    speed = max(_comp(fixes, 100.0, 142), _comp(fixes, 100.0, 58))
    return measured("speed over 42 cm in 42 periods", speed, "m/s", low=0.198, high=0.202)


def speed_control_unused(fixes: Fixes) -> Evidence:
    """Look for calls in the call graph of the image."""
    names = ("main_robot.Lineal_velocity", "main_robot.velocity")
    return reported([f for f in static_findings(fixes) if f.object in names], "never-called")


def lineal_range(fixes: Fixes) -> Evidence:
    """Look for the test of the range in which the front sonar measures speed well: its result is constant."""
    return reported(static_findings(fixes), "constant-condition", function="Lineal_velocity", object="25 < df")


def _lineal(fixes: Fixes, wz: float) -> Rig:
    rig = TaskRig(fixes, Read_Channel=lambda _ch: 213, read_front_distance=lambda: 65.0)
    main = rig.fw.main_robot
    main.Robot_Reference_S.V, main.Robot_Reference_N.W = 0.15, 0.3
    main.wZ, main.df, main.Cuenta_US, main.hayComp = wz, 50.0, 51, 0
    main.Lineal_velocity()
    return rig


def lineal_turning(fixes: Fixes) -> Evidence:
    """Turn to the right: the front distance then does not show the robot's speed."""
    rig = _lineal(fixes, -1.5)
    return measured("speed measured while turning right at 1.5 rad/s", rig.fw.main_robot.hayComp, low=0, high=0)


def lineal_straightens(fixes: Fixes) -> Evidence:
    """Control the speed: the commanded rate must not change."""
    rig = _lineal(fixes, 0.3)
    rate = rig.fw.main_robot.Robot_Reference_N.W
    return measured("a commanded rate of 0.3 after Lineal_velocity", rate, "rad/s", low=0.299, high=0.301)


def velocity_reference(fixes: Fixes) -> Evidence:
    """Look for uses of the rate that velocity is called with."""
    return reported(static_findings(fixes), "unused-parameter", function="velocity", object="Wref")


def position_count(fixes: Fixes) -> Evidence:
    """Call the controller 120 times, 6 s of an angle that is not reached: it must pause at every 60th call."""
    rig = Rig(fixes)
    pauses = 0
    for _ in range(120):
        rig.fw.main_robot.Position(45.0, 0.0)
        pauses += rig.fw.main_robot.Robot_Reference_N.W == 0.0
    return measured("pauses of the controller in 120 calls", pauses, low=1)


def position_radians(fixes: Fixes) -> Evidence:
    """Turn by 45 degrees, which are 0.785398 rad; the proportional gain is 1."""
    rig = Rig(fixes)
    rig.fw.main_robot.Position(45.0, 0.0)
    rate = rig.fw.main_robot.Robot_Reference_N.W
    return measured("45 degrees as the controller takes them", rate, "rad", low=0.78535, high=0.78545)


def _ciego(fixes: Fixes, t: int) -> Rig:
    rig = Rig(fixes)
    rig.fw.main_robot.P_ciego(50.0, t, 400.0, 20.0)
    return rig


def ciego_forgets(fixes: Fixes) -> Evidence:
    """Look for the value that P_ciego should keep for its next call: the store is lost."""
    return reported(static_findings(fixes), "dead-store", function="P_ciego", object="d_ant")


def ciego_overflow(fixes: Fixes) -> Evidence:
    """Drive blind for 1639 s, which are 32780 periods."""
    return reported(_ciego(fixes, 1639).findings, "overflow", function="P_ciego")


def ciego_zero(fixes: Fixes) -> Evidence:
    """Drive blind for no time at all."""
    return reported(_ciego(fixes, 0).findings, "division-by-zero", function="P_ciego")


def ciego_limits(fixes: Fixes) -> Evidence:
    """Look for uses of the limits of the distances that count."""
    return reported(static_findings(fixes), "unused-parameter", function="P_ciego", object="dm")


def init_offset(fixes: Fixes) -> Evidence:
    """Calibrate the gyro to 30 digits, then order INITIALITATION: the offset must stay, because nothing measures it
    again."""
    rig = TaskRig(fixes)
    rig.fw.main_robot.vZ_b = 30.0
    rig.fw.main_robot.Inicializa()
    return measured("gyro offset after Inicializa", rig.fw.main_robot.vZ_b, "digits", low=30.0, high=30.0)


def init_pointer(fixes: Fixes) -> Evidence:
    """Order INITIALITATION: it must clear the integral of the position controller, wherever it is stored."""
    rig = TaskRig(fixes)
    cell = rig.fw.main_robot.Ix
    address = cell.addr if cell else 0
    rig.fw.main_robot.PI(1.0, 0.0, 0.0, 1.0, cell, 10.0, -10.0)
    rig.fw.main_robot.Inicializa()
    left = cell.load() if cell and cell.obj else rig.fw.memory.load("float32", address)
    return measured("integral left by Inicializa", left, low=0.0, high=0.0)


def null_integrators(fixes: Fixes) -> Evidence:
    """Run two periods of the position controller."""
    rig = Rig(fixes)
    rig.fw.main_robot.Position(2.0, 0.1)
    rig.fw.main_robot.Position(2.0, 0.1)
    return reported(rig.findings, "null-dereference", function="PI", object="xenc")


def kix_annex(fixes: Fixes) -> Evidence:
    """Measure what one unit of error adds in one call: annex 4 tuned Ki = 10 with the step of 2.5 ms that PI has."""
    rig = Rig(fixes)
    integral = rig.fw.new("float32", 0.0)
    rig.fw.main_robot.PI(1.0, 0.0, 0.0, rig.fw.main_robot.kix, integral, 10.0, -10.0)
    return measured("integral action of one call", integral.load(), "rad/s", low=0.0249, high=0.0251)


def heading(fixes: Fixes) -> Evidence:
    """Turn for a second at 0.3 rad/s, with TaskGYRO at its period and TaskNAVIGATION every 50 ms."""
    def offset(_axis: int) -> float:
        """Measured on a robot that stands; the correction asks whether it did."""
        if hasattr(rig.fw.gyro, "Rested"):
            rig.fw.gyro.Rested = 1
        return 0.0

    rig = TaskRig(fixes, get_GYRO=lambda _axis, _bias: 0.3, Init_GYRO=lambda: None, Offset_GYRO=offset,
                  MISION_4=lambda: None, read_STATUS=lambda: 1, getZ=lambda: 0, Gyro_Answers=lambda: 1)  # fmt: skip
    angles = []
    for _ in range(20):
        rig.turns("TaskGYRO", 50 // rig.fw.main_robot.GYRO_Period)
        rig.turns("TaskNAVIGATION")
        angles.append(float(rig.fw.main_robot.tita_abs))
    times = [PERIOD_S * (i + 1) for i in range(20)]
    picture = Picture("The heading at 0.3 rad/s", "time in s", "angle in rad",
                      [Series("tita_abs", times, angles), Series("true", times, [0.3 * t for t in times])])  # fmt: skip
    return measured("heading after 1 s at 0.3 rad/s", angles[-1], "rad", low=0.27, high=0.33).shown(picture)


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "MAIN-null-integrators": null_integrators,
    "MAIN-kix-annex": kix_annex,
    "MAIN-heading": heading,
    "MAIN-safety-distance": safety_distance,
    "MAIN-state-surrounded": state_surrounded,
    "MAIN-turn-moving": turn_moving,
    "MAIN-turn-not-kept": turn_not_kept,
    "MAIN-equal-distances": equal_distances,
    "MAIN-reverse-unbounded": reverse_unbounded,
    "MAIN-side-correction": side_correction,
    "MAIN-blind-spot": blind_spot,
    "MAIN-ciego-unused": ciego_unused,
    "MAIN-bump-repeats": bump_repeats,
    "MAIN-bump-turn": bump_turn,
    "US-dead-sonar": dead_sonar,
    "MAIN-pi-period": pi_period,
    "MAIN-hidden-names": hidden_names,
    "MAIN-comp-undefined": comp_undefined,
    "MAIN-comp-unit": comp_unit,
    "MAIN-comp-sign": comp_sign,
    "MAIN-comp-span": comp_span,
    "MAIN-speed-control-unused": speed_control_unused,
    "MAIN-lineal-range": lineal_range,
    "MAIN-lineal-turning": lineal_turning,
    "MAIN-lineal-straightens": lineal_straightens,
    "MAIN-velocity-reference": velocity_reference,
    "MAIN-position-count": position_count,
    "MAIN-position-radians": position_radians,
    "MAIN-ciego-forgets": ciego_forgets,
    "MAIN-ciego-overflow": ciego_overflow,
    "MAIN-ciego-zero": ciego_zero,
    "MAIN-ciego-limits": ciego_limits,
    "MAIN-init-offset": init_offset,
    "MAIN-init-pointer": init_pointer,
}
