"""The headers of the robot's C files, made from the modules of this package.

The C files include them and the thesis does not print them as text.  A C file that stands in for a module of the port
finds here what the others declare: `text("ROBOT_types.h")`.  CHOICE: a header declares every function of its file that
is not `static` there (TFG annex 1); us.h of TFG figure 4 leaves out Read_Channel, which main_Robot.c calls.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Final

from emulator.c28x.program import Program
from emulator.c28x.readers.c.module_header import c_header, own_symbols

#: The kernel's header, which declares the types that none of these modules does.
_KERNEL: Final = "ti/sysbios/BIOS.h"


@dataclass(frozen=True)
class Header:
    """What stands in a header: the module's types and functions, some constants, without what is `static` in C."""

    module: str
    constants: tuple[str, ...] = ()
    private: tuple[str, ...] = ()


#: File name in C -> the module of the port.  A C file writes its own constants, so a header needs only those that
#: other files use.
HEADERS: Final[Mapping[str, Header]] = MappingProxyType({
    "ROBOT_types.h": Header("firmware_model.robot_types"),
    "us.h": Header("firmware_model.us"),
    "GYRO.h": Header("firmware_model.gyro"),
    "Odometry.h": Header("firmware_model.odometry"),
    "protocol.h": Header("firmware_model.protocol", private=("Move_to_comma",)),
    "servidores.h": Header("firmware_model.servidores"),
    "bumper.h": Header("firmware_model.board_support.bumper"),
    "clock.h": Header("firmware_model.board_support.clock"),
    "encoder.h": Header("firmware_model.board_support.encoder"),
    "pwm.h": Header("firmware_model.board_support.pwm"),
    "servos.h": Header("firmware_model.board_support.servos"),
    "spi.h": Header("firmware_model.board_support.spi", constants=("HIGH", "LOW")),
    "Wall_Follower.h": Header("firmware_model.board_support.wall_follower", constants=("WALL_LEFT", "WALL_RIGHT")),
    "XBee.h": Header("firmware_model.board_support.xbee"),
})  # fmt: skip
_BY_KEY: Final = MappingProxyType({name.lower(): name for name in HEADERS})


def names() -> tuple[str, ...]:
    """The headers of the robot, as its C files spell them."""
    return tuple(HEADERS)


def text(name: str) -> str | None:
    """The text of the header that a C file includes as `name`, whatever its case; None for one that is not here."""
    known = _BY_KEY.get(name.lower())
    return None if known is None else _made(known)


@lru_cache(maxsize=1)
def _program() -> Program:
    return Program(header.module for header in HEADERS.values())


@lru_cache(maxsize=len(HEADERS))
def _made(name: str) -> str:
    header = HEADERS[name]
    module = _program().module(header.module)
    return c_header(module, name, home=_home, constants=header.constants, private=header.private)


def _home(name: str) -> str:
    """The header that declares the type `name`."""
    modules = _program().modules
    return next((file for file, h in HEADERS.items() if name in own_symbols(modules[h.module])), _KERNEL)
