"""The headers of the robot's C files: each parses with those of the project, and declares what the port has."""

from __future__ import annotations

import pytest

from emulator.c28x.program import Program
from emulator.c28x.readers.c import headers as project
from emulator.c28x.readers.c.module_header import own_symbols
from emulator.c28x.symbols import EnumType
from emulator.c28x.tree import Function
from firmware_model import headers
from tests.emulator.c28x.readers.c.parsed import Parsed, prototype_shape


def find(name: str) -> str | None:
    return headers.text(name) or project.text(name)


def read(*names: str) -> Parsed:
    return Parsed("\n".join(f'#include "{name}"' for name in names), find)


@pytest.mark.parametrize("name", headers.names())
def test_each_header_parses_alone(name: str) -> None:
    read(name)


def test_the_headers_of_main_Robot_c_go_together() -> None:
    # The includes of main_Robot.c (TFG annex 1), in its order.
    parsed = read(
        "stdio.h", "xdc/std.h", "xdc/runtime/Error.h", "xdc/runtime/System.h", "ti/sysbios/BIOS.h",
        "ti/sysbios/knl/Task.h", "ti/sysbios/knl/Semaphore.h", "ti/sysbios/knl/Clock.h", "xdc/runtime/Log.h",
        "ti/uia/events/UIABenchmark.h", "F2837xS_device.h", "pwm.h", "encoder.h", "us.h", "GYRO.h", "bumper.h",
        "ROBOT_types.h", "servos.h", "servidores.h", "protocol.h", "Odometry.h", "ti/sysbios/knl/Swi.h",
        "Wall_Follower.h", "clock.h",
    )  # fmt: skip
    assert {"Read_Distance", "get_GYRO", "left_velocity", "Server_Create", "Get_Time"} <= set(parsed.names)


@pytest.mark.parametrize("name", headers.names())
def test_every_function_has_the_type_of_the_port(name: str) -> None:
    header = headers.HEADERS[name]
    parsed = read(name)
    for function, symbol in own_symbols(Program().module(header.module)).items():
        if function in header.private:
            assert function not in parsed.names
        elif isinstance(symbol, Function):
            assert parsed.shape(parsed.names[function]) == prototype_shape(symbol.ctype), function
        elif isinstance(symbol, EnumType):
            values = parsed.structs[function].values.enumerators
            assert {e.name: int(e.value.value) for e in values} == symbol.constants


def test_a_header_leaves_the_constants_of_its_C_file_to_that_file() -> None:
    # GYRO.c defines REFERENCE, which is a type in ROBOT_types.h.
    assert "REFERENCE" not in read("GYRO.h").defines
    assert read("spi.h").defines["HIGH"] == "1"


def test_a_header_is_found_in_any_case_and_others_are_not() -> None:
    assert headers.text("gyro.h") is headers.text("GYRO.h")
    assert headers.text("stdio.h") is None
