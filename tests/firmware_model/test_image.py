"""The Python face of a linked image: functions, objects, types, policies; several images in one process."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from emulator.c28x.ctypes import CHAR
from emulator.c28x.link import to_c
from emulator.c28x.tree import FOUND, Const, Expr, Index, LValue
from emulator.c28x.tree_queries import parts, statements
from emulator.image import Firmware
from firmware_model.image import link
from hil.robot.board import RobotBoard


@pytest.fixture(scope="module")
def fw() -> Firmware:
    return link(RobotBoard())


def test_scalars_structures_and_arrays_are_attributes(fw: Firmware) -> None:
    fw.us.L_Calib_m = 0.5
    assert fw.us.L_Calib_m == 0.5
    fw.main_robot.Robot_Reference_N.V = 0.1
    # Stored as float32.
    assert fw.main_robot.Robot_Reference_N.V == pytest.approx(0.1, abs=1e-8)
    assert fw.main_robot.Robot_Reference_N.V != 0.1
    fw.gyro.buff[99] = -7
    assert (fw.gyro.buff[99], len(fw.gyro.buff)) == (-7, 100)
    with pytest.raises(IndexError):
        fw.gyro.buff[100]


def test_enumerations_have_their_constants_and_names(fw: Firmware) -> None:
    assert fw.us.US_SENSOR.FRONT == 1
    assert fw.us.US_SENSOR.name(2) == "RIGHT"
    with pytest.raises(AttributeError):
        fw.us.US_SENSOR.REAR


def test_a_misspelt_name_is_an_error_that_names_the_c_file(fw: Firmware) -> None:
    with pytest.raises(AttributeError, match=r"us\.c declares no Read_Distence"):
        fw.us.Read_Distence
    with pytest.raises(AttributeError, match=r"us\.c declares no object Calib"):
        fw.us.Calib = 1
    with pytest.raises(AttributeError, match="no module uss"):
        fw.uss


def test_a_value_that_does_not_fit_the_c_type_is_refused(fw: Firmware) -> None:
    with pytest.raises(ValueError, match=r"gyro\.Z_dc_offset: 32768 is no int"):
        fw.gyro.Z_dc_offset = 32768
    with pytest.raises(ValueError, match="is no char"):
        fw.us.Read_Channel(1.5)
    with pytest.raises(TypeError, match="takes 1 arguments"):
        fw.us.Read_Channel()


def test_arrays_and_structures_can_be_made_and_passed(fw: Firmware) -> None:
    values = fw.array("float32", [3.0, 1.0, 2.0])
    fw.initial("us.average.result", 0.0)
    assert fw.us.average(values, 3) == 2.0
    reference = fw.new("REFERENCE", V=0.25, W=-1)
    # Before tasks run a gate that nobody has created is not looked at, as in the kernel's source.
    fw.servidores.write_T_REF(reference)
    assert fw.servidores.Telemanipulation_Reference.W == -1.0
    with pytest.raises(ValueError, match="no C type REFERENZ"):
        fw.new("REFERENZ")


def test_a_planted_cell_answers_for_the_index_outside(fw: Firmware) -> None:
    fw.plant("us.Read_Distance.v", 65535, math.inf)
    assert fw.planted("us.Read_Distance.v", 65535) == math.inf
    with pytest.raises(ValueError, match="keep_locals"):
        fw.last_locals("us.Read_Distance")


@pytest.mark.parametrize(
    ("policy", "message"),
    [({"fill": "x"}, "fill policy"), ({"divide": "x"}, "divider"), ({"float_to_int": "x"}, "float to int")],
)
def test_unknown_policies_are_refused(policy: dict[str, str], message: str) -> None:
    with pytest.raises(ValueError, match=f"unknown {message}"):
        link(RobotBoard(), **policy)  # type: ignore[arg-type]


def test_images_share_nothing() -> None:
    first, second = link(RobotBoard()), link(RobotBoard())
    first.us.Calibrate_US(first.us.US_SENSOR.LEFT, 2.0, 3.0)
    assert (first.us.L_Calib_m, second.us.L_Calib_m) == (2.0, 1.0)


def test_a_replaced_function_is_called_by_everybody() -> None:
    fw = link(RobotBoard(), externs={"Read_Channel": lambda channel: 100 + channel})
    fw.us.Calibrate_US(fw.us.US_SENSOR.FRONT, 1.0, 0.0)
    # Twelve conversions of 101 / 2.3, in float32.
    assert fw.us.Read_Distance(fw.us.US_SENSOR.FRONT) == pytest.approx(12 * 101 / 2.3, rel=1e-6)


def test_plain_and_watched_images_compute_the_same_distance() -> None:
    results = []
    for watched in (False, True):
        fw = link(RobotBoard(), watch=watched, externs={"Read_Channel": lambda channel: 200})
        fw.us.Calibrate_US(fw.us.US_SENSOR.LEFT, 0.0551, 4.3516)
        results.append(fw.us.Read_Distance(fw.us.US_SENSOR.LEFT))
    assert results[0] == results[1]


def linked(folder: Path, source: str, **externs: Callable[..., Any]) -> Firmware:
    file = folder / "driver.py"
    file.write_text("from emulator.c28x.language import *\n" + source, "utf-8")
    return link(RobotBoard(), modules=(str(file),), externs=externs)


def test_a_local_of_a_call_that_an_exception_has_ended_dangles(tmp_path: Path) -> None:
    def stop() -> None:
        raise InterruptedError

    fw = linked(
        tmp_path,
        "Data: ptr[int16] = NULL\n@extern\ndef stop() -> void: ...\n"
        "def Start() -> void:\n    x: int16 = 7\n    Data = addressof(x)\n    stop()\n"
        "def Use() -> int16:\n    return Data[0]\n",
        stop=stop,
    )
    sp = fw.runtime.cpu.sp
    with pytest.raises(InterruptedError):
        fw.driver.Start()
    assert fw.runtime.cpu.sp == sp
    fw.driver.Use()
    assert [finding.rule for finding in fw.runtime.findings] == ["dangling-pointer"]


def test_a_recursion_without_end_is_a_finding_and_a_line(tmp_path: Path) -> None:
    fw = linked(tmp_path, "def Down(n: int16) -> int16:\n    v: array[int16, 8]\n    v[0] = n\n    return Down(v[0])\n")
    sp = fw.runtime.cpu.sp
    with pytest.raises(RecursionError, match=r"^driver\.Down: unbounded recursion"):
        fw.driver.Down(1)
    assert [finding.rule for finding in fw.runtime.findings] == ["stack-overflow"]
    assert fw.runtime.cpu.sp == sp


def test_the_parts_of_a_statement_are_all_that_any_of_its_fields_holds(fw: Firmware) -> None:
    def held(e: Any) -> list[Any]:
        found = [e]
        for each in () if isinstance(e, Const) else fields(e):
            value = None if each.metadata == FOUND else getattr(e, each.name)  # what passes found is no part
            for inner in value if isinstance(value, list) else [value]:
                if isinstance(inner, Expr | LValue | Index):
                    found += held(inner)
        return found

    functions = [f for module in fw.linked.program.modules.values() for f in module.functions]
    for s in (s for function in functions for s in statements(function.body)):
        assert list(map(id, parts(s))) == list(map(id, held(s)))


@pytest.mark.parametrize("value", ["hello", b"hello", 3, [1, 2]])
def test_a_pointer_is_made_by_the_firmware_not_by_python(value: object) -> None:
    with pytest.raises(ValueError, match=r"is not a char \*: make an object with firmware\.array"):
        to_c(value, CHAR.pointer)


def test_before_tasks_run_a_gate_that_nobody_created_is_not_looked_at() -> None:
    # GateMutexPri.c: Task_self() is NULL, so entering and leaving return at once. Here with all that watches gates.
    board = RobotBoard()
    firmware = link(board, watch=True)
    board.watch(firmware.linked)
    firmware.servidores.write_T_REF(firmware.new("REFERENCE", V=0.25, W=-1))
    assert firmware.servidores.Telemanipulation_Reference.V == 0.25
    # The handle that nobody wrote is read; the gate behind it is not.
    assert {f.rule for f in board.findings if f.how == "dynamic"} == {"uninitialised"}
