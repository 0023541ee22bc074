"""Adapters of the tasks of main_Robot.c: one pass of the loop for each release."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from hil.golden.bench import VectorBench
from hil.golden.drivers import TRAYECT, start_gyro
from hil.golden.values import to_float, to_floats

Given = Mapping[str, Any]
Out = dict[str, Any]


def task_navigation(bench: VectorBench, given: Given) -> Out:
    """One pass of the loop a release; gates by number."""
    start_gyro(bench, given)
    bench.gyro.set_axis(2, given["gyro_raw"])
    robot, servers = bench.fw.main_robot, bench.fw.servidores
    bench.cells(given["pointers"])
    robot.EstadoNav = robot.enumeration("INICIAL").INICIAL
    out: list[Out] = []

    def before(number: int) -> None:
        release = given["releases"][number]
        bench.locks.clear()
        servers.ROBOT_Status = getattr(robot.STATUS, release["status"])
        bench.bumper = release["bumper"]
        servers.ROBOT_df, servers.ROBOT_dl, servers.ROBOT_dr, servers.ROBOT_wz = (
            to_float(release[name]) for name in ("df", "dl", "dr", "wz")
        )
        servers.Telemanipulation_Reference.V = to_float(release["TV"])
        servers.Telemanipulation_Reference.W = to_float(release["TW"])

    def after(_number: int) -> None:
        out.append({
            "REF": [servers.ROBOT_Reference.V, servers.ROBOT_Reference.W],
            "caso": robot.caso,
            "caso2": robot.caso2,
            "cuenta_gyro": robot.cuenta_gyro,
            "vZ_b": robot.vZ_b,
            "df_dl_dr": [robot.df, robot.dl, robot.dr],
            "tita_abs": robot.tita_abs,
            "EstadoNav": robot.enumeration("INICIAL").name(robot.EstadoNav),
            "lock_sequence": list(bench.locks),
        })  # fmt: skip

    bench.run_releases("TaskNAVIGATION", len(given["releases"]), before, after)
    return {"releases": out}


def task_odo(bench: VectorBench, given: Given) -> Out:
    """The frames sent; the gates of the last release."""
    robot = bench.fw.main_robot

    def before(number: int) -> None:
        bench.locks.clear()
        v, w, robot.df, robot.dl, robot.dr = to_floats(given["releases"][number])
        robot.Robot_Reference_N.V, robot.Robot_Reference_N.W = v, w

    bench.run_releases("TaskODO", len(given["releases"]), before, lambda _number: None)
    return {
        "frames": list(bench.frames),
        "locks": list(bench.locks),
        "odoT": [getattr(robot.odoT, name) for name in TRAYECT],
    }


def task_ord(bench: VectorBench, given: Given) -> Out:
    """The servers after each frame."""
    servers = bench.fw.servidores
    after: list[list[Any]] = []

    def before(number: int) -> None:
        bench.frame_in[:] = [ord(character) for character in given["frames"][number]]

    def record(_number: int) -> None:
        reference = servers.Telemanipulation_Reference
        after.append([servers.STATUS.name(servers.ROBOT_Status), reference.V, reference.W])

    bench.run_releases("TaskORD", len(given["frames"]), before, record)
    return {"after": after}


def task_servo(bench: VectorBench, given: Given) -> Out:
    """One release with controllers that subtract."""
    robot, servers = bench.fw.main_robot, bench.fw.servidores
    servers.ROBOT_Reference.V, servers.ROBOT_Reference.W = to_float(given["V"]), to_float(given["W"])
    bench.wheel_speed.update(left=to_float(given["wl"]), right=to_float(given["wr"]))
    bench.run_releases("TaskSERVO", 1, lambda _number: None, lambda _number: None)
    return {"Wl_ref": robot.Wl_ref, "Wr_ref": robot.Wr_ref, "actions": list(bench.actions)}


ADAPTERS: Final[dict[str, Callable[[VectorBench, Given], Out]]] = {
    "TaskNAVIGATION": task_navigation,
    "TaskODO": task_odo,
    "TaskORD": task_ord,
    "TaskSERVO": task_servo,
}
