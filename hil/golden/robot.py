"""Adapters of main_Robot.c: navigation, the controllers, what the tasks call."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from hil.golden.bench import VectorBench
from hil.golden.drivers import start_adc, start_gyro
from hil.golden.values import to_float, to_floats

Given = Mapping[str, Any]
Out = dict[str, Any]

#: File-scope scalars of main_Robot.c in the order in which the vector lists them: integers, then floats.
INTEGERS: Final = (
    "caso", "caso2", "caso3", "cuenta_gyro", "Cuenta_US", "Ti", "siguiente", "periodo", "j", "hayComp", "EstadoNav",
    "et_status",
)  # fmt: skip
FLOATS: Final = (
    "dl", "df", "dr", "Left_distance", "Front_distance", "Right_distance", "vX_b", "vY_b", "vZ_b", "wZ", "Wabs",
    "tita_abs", "Wpos", "titaref", "Wl", "Wr", "Wl_ref", "Wr_ref", "U_l", "U_r", "Vl_T", "Vr_T", "Wciego", "d_ciegoL",
    "d_ciegoR", "cont", "alpha", "V_comp", "dF_ant", "V_pi", "wZ_task", "Wpi", "Wl_ref_pi", "Wr_ref_pi", "kp", "ki",
    "kp_V", "ki_V", "kpx", "kix",
)  # fmt: skip
STRUCTURES: Final = {"Robot_Reference_N": ("V", "W"), "odoT": ("X", "Y", "tita", "df", "dr", "dl")}


def reference(bench: VectorBench) -> list[float]:
    """Robot_Reference_N."""
    n = bench.fw.main_robot.Robot_Reference_N
    return [n.V, n.W]


def action(bench: VectorBench, given: Given) -> Out:
    """Sets the reference."""
    bench.fw.main_robot.Action(to_float(given["V"]), to_float(given["W"]))
    return {"ref": reference(bench)}


def pi(bench: VectorBench, given: Given) -> Out:
    """The output and the integrator after each step."""
    kp, ki, high, low = (to_float(given[name]) for name in ("kp", "ki", "Umax", "Umin"))
    xenc = bench.array("float32", [to_float(given["xenc0"])])
    steps = []
    for step in given["steps"]:
        xref, x = to_floats(step)
        steps.append([bench.fw.main_robot.PI(xref, x, kp, ki, xenc, high, low), xenc.load()])
    return {"steps": steps}


def comp(bench: VectorBench, given: Given) -> Out:
    """The local X starts as stated."""
    start_adc(bench)
    bench.convert([given["adc"]])
    bench.fw.initial("main_robot.Comp.X", to_float(given["X0"]))
    v = bench.fw.main_robot.Comp(given["i"], to_float(given["dF_ant"]))
    return {"V": v, "conversions": len(bench.converted)}


def calib_gyro(bench: VectorBench, given: Given) -> Out:
    """Recorded are the first call, each that read the gyro, and the last."""
    start_gyro(bench, given)
    robot = bench.fw.main_robot
    bench.gyro.set_axis(2, given["raw"])
    robot.cuenta_gyro = given["cuenta0"]
    robot.vZ_b = 99.0  # what the vectors start from
    steps: list[list[Any]] = []
    reads = 0
    for call in range(given["calls"]):
        robot.CalibGyro(to_float(given["tiempo"]))
        if call == 0 or bench.gyro.reads != reads:
            steps.append([robot.cuenta_gyro, robot.vZ_b, bench.gyro.reads])
        reads = bench.gyro.reads
    steps.append([robot.cuenta_gyro, robot.vZ_b, reads])
    return {"steps": steps}


def lineal_velocity(bench: VectorBench, given: Given) -> Out:
    """The state after each group of repeats."""
    start_adc(bench)
    robot = bench.fw.main_robot
    cells = bench.cells(given["pointers"])
    robot.Cuenta_US = given["cuenta0"]
    steps = []
    for v, server_df, wz, df, adc, repeats in given["steps"]:
        robot.Robot_Reference_S.V = to_float(v)
        bench.fw.servidores.ROBOT_df = to_float(server_df)
        robot.wZ = to_float(wz)
        robot.df = to_float(df)
        for _ in range(repeats):
            bench.convert([adc])
            robot.Lineal_velocity()
        steps.append([*reference(bench), robot.Cuenta_US, robot.dF_ant, robot.V_comp, robot.hayComp])
    return {"steps": steps, "cells": bench.cell_values(cells)}


def velocity(bench: VectorBench, given: Given) -> Out:
    """The reference after each step."""
    robot = bench.fw.main_robot
    cells = bench.cells(given["pointers"])
    steps = []
    for step in given["steps"]:
        wref, v, w, robot.wZ = to_floats(step)
        robot.Robot_Reference_S.W = w
        robot.velocity(wref, v)
        steps.append(reference(bench))
    return {"steps": steps, "cells": bench.cell_values(cells)}


def position(bench: VectorBench, given: Given) -> Out:
    """The reference after each step."""
    robot = bench.fw.main_robot
    cells = bench.cells(given["pointers"])
    bench.fw.memory.store("float32", 0, to_float(given.get("addr0", "00000000")))
    steps = []
    for step in given["steps"]:
        titaref, v, robot.tita_abs = to_floats(step)
        robot.Position(titaref, v)
        steps.append(reference(bench))
    return {"steps": steps, "cells": bench.cell_values(cells)}


def mision_4(bench: VectorBench, given: Given) -> Out:
    """The state after each group of repeats."""
    robot = bench.fw.main_robot
    cells = bench.cells(given["pointers"])
    robot.caso, robot.caso2 = given["caso0"], given["caso20"]
    robot.EstadoNav = robot.enumeration("INICIAL").INICIAL
    steps = []
    for df, dl, dr, bumper, tita_abs, repeats in given["steps"]:
        robot.df, robot.dl, robot.dr, robot.tita_abs = to_floats((df, dl, dr, tita_abs))
        robot.bumper = bumper
        for _ in range(repeats):
            robot.MISION_4()
        steps.append([*reference(bench), robot.caso, robot.caso2, robot.enumeration("INICIAL").name(robot.EstadoNav)])
    return {"steps": steps, "cells": bench.cell_values(cells)}


def p_ciego(bench: VectorBench, given: Given) -> Out:
    """The result and the counter after each call."""
    robot = bench.fw.main_robot
    robot.cont = to_float(given["cont0"])
    steps = []
    for us in to_floats(given["us"]):
        steps.append([robot.P_ciego(us, given["t"], 0.0, 0.0), robot.cont])
    return {"steps": steps}


def inicializa(bench: VectorBench, given: Given) -> Out:
    """Which file-scope objects are cleared and which are left."""
    robot = bench.fw.main_robot
    integer, real = given["fill16"], to_float(given["fillf"])
    cells = bench.cells("distinct", real)
    for name in INTEGERS:
        setattr(robot, name, integer)
    for name in FLOATS:
        setattr(robot, name, real)
    for name, members in STRUCTURES.items():
        for member in members:
            setattr(getattr(robot, name), member, real)
    robot.Inicializa()
    scalars = {name: (getattr(robot, name), integer) for name in INTEGERS}
    scalars |= {name: (getattr(robot, name), real) for name in FLOATS}
    untouched = [name for name, (value, filled) in scalars.items() if value == filled]
    untouched += [
        name for name, members in STRUCTURES.items() if all(getattr(getattr(robot, name), m) == real for m in members)
    ]
    return {
        "zeroed": [name for name, (value, _) in scalars.items() if value == 0],
        "untouched": untouched,
        "Ix_is_null_cell": not robot.Ix,
        "integrator_cells": bench.cell_values(cells),
    }


ADAPTERS: Final[dict[str, Callable[[VectorBench, Given], Out]]] = {
    "Action": action,
    "PI": pi,
    "Comp": comp,
    "CalibGyro": calib_gyro,
    "Lineal_velocity": lineal_velocity,
    "velocity": velocity,
    "Position": position,
    "MISION_4": mision_4,
    "P_ciego": p_ciego,
    "Inicializa": inicializa,
}
