"""Demonstrations of the defects of main_Robot.c, by id: start-up and tasks here, navigation in its own module."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, pi
from typing import Any, Final

from emulator.clock import SYSCLK_HZ
from hil.audit import main_robot_guards, main_robot_navigation
from hil.audit.evidence import Evidence, Picture, Series, measured, reported
from hil.audit.rig import Fixes, robot, static_findings
from hil.audit.task_rig import TaskRig

PRESSED, FREE = 0, 1


def clock_before_task(fixes: Fixes) -> Evidence:
    """Count the releases that wait for TaskGYRO and TaskODO while Init_GYRO takes its two seconds."""
    times: list[float] = []
    waiting: dict[str, list[int]] = {"TaskGYRO": [], "TaskODO": []}
    with robot(fixes, boot=False) as bench:

        def look(_share: float) -> None:
            times.append(bench.clock.now / SYSCLK_HZ)
            for task, counts in waiting.items():
                counts.append(getattr(bench.firmware.main_robot, f"{task}_sem").count)

        bench.boot(look)
        evidence = reported(bench.findings, "semaphore-pile-up")
    picture = Picture("Releases that wait", "time since power-up in s", "count of the semaphore",
                      [Series(f"{task}_sem", times, counts) for task, counts in waiting.items()])  # fmt: skip
    return evidence.shown(picture)


def us_period(fixes: Fixes) -> Evidence:
    """Let the robot read the sonars for three seconds."""
    with robot(fixes, watch=False) as bench:
        bench.findings.clear()
        bench.run_for(3.0)
        return reported(bench.findings, "stale-sample", object="sonar")


def gyro_period(fixes: Fixes) -> Evidence:
    """Let the robot read the gyro for three seconds, after the releases of start-up are done."""
    with robot(fixes, watch=False) as bench:
        bench.run_for(1.0)
        bench.findings.clear()
        bench.run_for(3.0)
        return reported(bench.findings, "polling-above-rate", object="L3G4200D")


def us_first_read(fixes: Fixes) -> Evidence:
    """Read the first distances after power-up."""
    with robot(fixes, watch=False) as bench:
        return reported(bench.findings, "startup-read", object="sonar")


def calib_task(fixes: Fixes) -> Evidence:
    """Run the last period of the five seconds of CALIBRATION, while TaskGYRO uses the same bus."""
    with robot(fixes) as bench:
        bench.run_for(0.8)
        bench.firmware.main_robot.cuenta_gyro = 101
        bench.feed(b"#CALB\r")
        bench.run_for(0.2)
        return reported(bench.findings, "transaction-cut", object="Spia")


def calib_span(fixes: Fixes) -> Evidence:
    """Calibrate while the robot still turns for half a second, and is then rocked once a second by 50 digits around an
    offset of 100, which five seconds average away."""
    period = -1

    def navigation() -> None:
        nonlocal period
        period += 1
        rig.fw.main_robot.CalibGyro(5.0)

    def sample() -> int:
        turn = 4000 if period < 10 else 0
        return round(turn + 100 + 50 * cos(2 * pi * (period - 101) * 0.05))

    rig = TaskRig(fixes, navigation, getZ=sample, Init_GYRO=lambda: None, get_GYRO=lambda _axis, _bias: 0.0,
                  Gyro_Answers=lambda: 1)  # fmt: skip
    rig.turns("TaskGYRO", 130)
    offset = rig.fw.main_robot.vZ_b
    return measured("offset of a gyro that reads 100 +- 50 at rest", offset, "digits", low=95.0, high=105.0)


def calib_repeats(fixes: Fixes) -> Evidence:
    """Calibrate at rest, then move the robot by hand for 7 s without another order."""
    period = -1

    def navigation() -> None:
        nonlocal period
        period += 1
        if rig.fw.servidores.ROBOT_Status == rig.fw.robot_types.STATUS.CALIBRATION:
            rig.fw.main_robot.CalibGyro(5.0)

    rig = TaskRig(fixes, navigation, getZ=lambda: 100 if period < 130 else 600, Init_GYRO=lambda: None,
                  get_GYRO=lambda _axis, _bias: 0.0, Gyro_Answers=lambda: 1)  # fmt: skip
    rig.fw.servidores.ROBOT_Status = rig.fw.robot_types.STATUS.CALIBRATION
    rig.turns("TaskGYRO", 270)
    offset = rig.fw.main_robot.vZ_b
    return measured("offset of a gyro that read 100 in the calibration", offset, "digits", low=95.0, high=105.0)


def calib_resumed(fixes: Fixes) -> Evidence:
    """Calibrate for three seconds, send a STOP, and measure how long the next calibration takes."""
    rig = TaskRig(fixes, Read_Bumper=lambda: FREE, getZ=lambda: 0)
    main, states = rig.fw.main_robot, rig.fw.robot_types.STATUS
    for state, periods in ((states.CALIBRATION, 60), (states.STOP, 1)):
        rig.fw.servidores.ROBOT_Status = state
        rig.turns("TaskNAVIGATION", periods)
    rig.fw.servidores.ROBOT_Status = states.CALIBRATION
    periods, counted = 0, -1
    while main.cuenta_gyro > counted:
        counted = main.cuenta_gyro
        rig.turns("TaskNAVIGATION")
        periods += 1
    return measured("length of a calibration after one that was cut off", periods * 0.05, "s", low=5.0)


def unused_objects(fixes: Fixes) -> Evidence:
    """Look for objects at file scope that no statement uses."""
    names = {f"main_robot.{name}" for name in ("d", "Iwl", "Iwr", "Wl_ref_pi", "Wr_ref_pi")}
    return reported([f for f in static_findings(fixes) if f.object in names], "unused-object")


def titaref_unread(fixes: Fixes) -> Evidence:
    """Look for `titaref` in Position, where another name hides the object that TaskNAVIGATION sets."""
    return reported(static_findings(fixes), "hidden-name", function="Position", object="titaref")


def _navigate(fixes: Fixes, turns: int, status: str, bumper: int = FREE, **objects: Any) -> tuple[TaskRig, list[float]]:
    """Run TaskNAVIGATION in a state; return every speed (m/s) that it passes to TaskSERVO."""
    speeds: list[float] = []
    rig = TaskRig(
        fixes, Read_Bumper=lambda: bumper, getZ=lambda: 0, age_US=lambda: 0,  # TaskUS does not turn here
        write_REF=lambda ref: speeds.append(float(ref.member("V").load())),
    )  # fmt: skip
    rig.fw.servidores.ROBOT_Status = getattr(rig.fw.robot_types.STATUS, status)
    rig.fw.servidores.ROBOT_df = rig.fw.servidores.ROBOT_dl = rig.fw.servidores.ROBOT_dr = 100.0
    rig.fw.servidores.Telemanipulation_Reference.V = objects.pop("tele_v", 0.0)
    for name, value in objects.items():
        setattr(rig.fw.main_robot, name, value)
    rig.turns("TaskNAVIGATION", turns)
    return rig, speeds


def bump_clears(fixes: Fixes) -> Evidence:
    """Press the bumper for ten periods: the mission must know it, to reverse after sixty."""
    rig, _ = _navigate(fixes, 10, "MISSION", PRESSED)
    return measured(
        "periods that the mission knows of, of ten with the bumper pressed", rig.fw.main_robot.caso2, low=10
    )


def tele_twice(fixes: Fixes) -> Evidence:
    """List the speeds that TaskSERVO may see while the bumper is pressed and the console orders 0.2 m/s."""
    _, speeds = _navigate(fixes, 5, "TELEMANIPULATION", PRESSED, tele_v=0.2)
    return measured("greatest speed handed on with the bumper pressed", max(speeds), "m/s", high=0.0)


def bump_holds(fixes: Fixes) -> Evidence:
    """Order the robot to drive backwards, away from the obstacle."""
    _, speeds = _navigate(fixes, 5, "TELEMANIPULATION", PRESSED, tele_v=-0.1)
    return measured("speed when the console backs off from an obstacle", speeds[-1], "m/s", high=-0.09)


def state_reset(fixes: Fixes) -> Evidence:
    """Press the bumper before an obstacle, where the mission is in FRENTE (2): the state must stay."""
    rig, _ = _navigate(fixes, 1, "MISSION", PRESSED, EstadoNav=2)
    return measured("EstadoNav with the bumper pressed after FRENTE", rig.fw.main_robot.EstadoNav, low=2, high=2)


def mission_resumed(fixes: Fixes) -> Evidence:
    """Stop a mission after 50 of the 60 periods that it waits before an obstacle."""
    rig, _ = _navigate(fixes, 1, "STOP", caso=50)
    return measured("periods of waiting left from the mission before", rig.fw.main_robot.caso, high=0)


def _orders(fixes: Fixes, *frames: str, posts: int = 0, **externs: Callable[..., Any]) -> TaskRig:
    """Run TaskORD on these frames, which arrive one by one."""
    queue = list(frames)

    def read_frame(data: Any) -> None:
        text = queue.pop(0) if len(queue) > 1 else queue[0]
        received[0] = 0
        for i, c in enumerate(text):
            data.at(i).store(ord(c))
        data.at(len(text)).store(0)

    received = [1]
    if posts == 0:
        externs["Received_Frame"] = lambda: 1
    else:
        externs["Received_Frame"] = lambda: received[0]
    rig = TaskRig(fixes, Read_Frame=read_frame, **externs)
    rig.turns("TaskORD", posts or len(frames))
    return rig


def order_twice(fixes: Fixes) -> Evidence:
    """Receive two frames before TaskORD runs: there are two posts, but one frame is left in XBee.c."""
    states: list[int] = []
    _orders(fixes, "#STOP\r", posts=2, write_STATUS=states.append)
    return measured("executions of one frame", len(states), low=1, high=1)


def stop_keeps_reference(fixes: Fixes) -> Evidence:
    """Measure the reference with which the next TELE starts."""
    rig = _orders(fixes, "#TELE\r", "#SETR0.2,0.1\r", "#STOP\r", "#TELE\r")
    speed = rig.fw.servidores.Telemanipulation_Reference.V
    return measured("speed with which TELE begins after STOP", speed, "m/s", low=0.0, high=0.0)


def reference_outlives(fixes: Fixes) -> Evidence:
    """Measure the reference with which TELE starts after a SETR in another state, and after a mission."""
    before = ("#SETR0.2,0.1\r",), ("#TELE\r", "#SETR0.2,0.1\r", "#MISN\r")
    speeds = [float(_orders(fixes, *orders, "#TELE\r").fw.servidores.Telemanipulation_Reference.V) for orders in before]
    what = "greatest speed with which TELE begins after SETR in STOP, or a mission"
    return measured(what, max(speeds), "m/s", low=0.0, high=0.0)


def init_reference(fixes: Fixes) -> Evidence:
    """Measure the reference with which TELE starts after INIT."""
    rig = _orders(fixes, "#TELE\r", "#SETR0.2,0.1\r", "#INIT\r", "#TELE\r")
    speed = rig.fw.servidores.Telemanipulation_Reference.V
    return measured("speed with which TELE begins after INIT", speed, "m/s", low=0.0, high=0.0)


def odo_commanded(fixes: Fixes) -> Evidence:
    """Order 0.3 m/s for 0.1 s of each period of TaskODO, which reads the reference once."""
    with robot(fixes, world="room", watch=False) as bench:
        bench.run_for(0.8)
        bench.feed(b"#TELE\r")
        for _ in range(16):
            bench.feed(b"#SETR0.3,0.0\r")
            bench.run_for(0.1)
            bench.feed(b"#SETR0.0,0.0\r")
            bench.run_for(0.15)
        odometry, true = bench.odometry_path(), bench.true_path()
        last = odometry[-1]
        driven = max(p.x_m for p in true if p.time_s <= last.time_s) - true[0].x_m
        paths = [
            Series("odometry", [p.time_s for p in odometry], [p.x_m for p in odometry]),
            Series("true", [p.time_s for p in true], [p.x_m - true[0].x_m for p in true]),
        ]
        picture = Picture("0.3 m/s is ordered for 0.1 s of each 0.25 s", "time in s", "way in m", paths)
    # A frame is on the line for 30 ms and counts periods of 25 and 250 ms: within a tenth after 1 m.
    return measured("odometry over driven way", last.x_m / driven, low=0.9, high=1.1).shown(picture)


def odo_race(fixes: Fixes) -> Evidence:
    """Find TaskODO's use of references that TaskNAVIGATION, a higher task, writes; the three distances have the same
    defect."""
    with robot(fixes) as bench:
        bench.run_for(1.0)
        bench.feed(b"#MISN\r")
        bench.run_for(1.0)
        return reported(bench.findings, "race", object="main_robot.Robot_Reference_N")


def init_others(fixes: Fixes) -> Evidence:
    """Find objects of TaskSERVO and TaskUS, which are above TaskNAVIGATION and share no gate with it."""
    theirs = ("Wl", "Wr", "Wl_ref", "Wr_ref", "U_l", "U_r", "Left_distance", "Front_distance", "Right_distance")
    with robot(fixes) as bench:
        bench.run_for(0.8)
        bench.feed(b"#INIT\r")
        bench.run_for(0.2)
        findings = [f for f in bench.findings if f.object in {f"main_robot.{name}" for name in theirs}]
    return reported(findings, "race-long")


def init_odometry(fixes: Fixes) -> Evidence:
    """Order INITIALITATION, which must reset everything; the user sees the pose."""
    rig = TaskRig(fixes)
    pose = rig.fw.servidores.ROBOT_Odometry_T
    pose.X, pose.Y, pose.tita = 500.0, 300.0, 1.0
    rig.fw.main_robot.Inicializa()
    rig.turns("TaskODO")
    return measured("X after INITIALITATION", pose.X, "mm", low=0.0, high=0.0)


def init_distances(fixes: Fixes) -> Evidence:
    """Read the distances in the frames half a second after INIT, in the middle of a room."""
    with robot(fixes, world="room", watch=False) as bench:
        bench.run_for(0.8)
        bench.feed(b"#INIT\r")
        bench.run_for(0.5)
        sent = bytearray()
        bench.uart_sent.connect(lambda byte, _cycles: sent.append(byte))
        bench.run_for(0.5)
    distances = [int(number) for number in sent.split(b"#ODO ")[1].split(b",")[3:]]
    return measured("shortest distance in a frame after INIT, in a room", min(distances), "mm", low=500)


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "MAIN-unused-objects": unused_objects,
    "MAIN-clock-before-task": clock_before_task,
    "MAIN-us-period": us_period,
    "MAIN-gyro-period": gyro_period,
    "MAIN-us-first-read": us_first_read,
    "MAIN-calib-task": calib_task,
    "MAIN-calib-span": calib_span,
    "MAIN-bump-clears": bump_clears,
    "MAIN-titaref-unread": titaref_unread,
    "MAIN-tele-twice": tele_twice,
    "MAIN-bump-holds": bump_holds,
    "MAIN-state-reset": state_reset,
    "MAIN-mission-resumed": mission_resumed,
    "MAIN-order-twice": order_twice,
    "MAIN-stop-keeps-reference": stop_keeps_reference,
    "MAIN-odo-commanded": odo_commanded,
    "MAIN-odo-race": odo_race,
    "MAIN-init-others": init_others,
    "MAIN-init-distances": init_distances,
    "MAIN-init-reference": init_reference,
    "MAIN-calib-resumed": calib_resumed,
    "MAIN-calib-repeats": calib_repeats,
    "MAIN-reference-outlives": reference_outlives,
    "MAIN-init-odometry": init_odometry,
    **main_robot_guards.DEMONSTRATIONS,
    **main_robot_navigation.DEMONSTRATIONS,
}
