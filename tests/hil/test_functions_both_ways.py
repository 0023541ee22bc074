"""Each function of the robot and of the test drivers does the same as a function and as a method, whatever it is given.

A method is the typed text that `hil build` compiles: here interpreted, and in a compiled tree also the robot's as it is
compiled.  Arguments, memory and what the peripherals answer are random.  Equal must be the result or error, all memory,
the interrupt registers, the cycles and the findings.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import cycle
from math import isfinite
from random import Random
from typing import Any, Final

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator import compiled, image
from emulator.c28x.arithmetic import f32
from emulator.c28x.ctypes import ArrayType, CType, FloatType, IntType, PointerType, scalars
from emulator.c28x.memory import Pointer
from emulator.c28x.objects import make
from firmware_model.image import MODULES, link
from hil.build import functions_of
from hil.golden.scripted_gyro import ScriptedGyro
from hil.robot.board import GYRO_CS_GPIO, RobotBoard
from tests.emulator.c28x import as_methods
from tests.hil.testing.test_specimens import SPECIMENS

#: A function that has not returned by then is stopped.
LONGEST_CYCLES: Final = 100_000
#: The elements behind a pointer that is passed.
ROOM: Final = 24
#: Numbers at which something happens.
EDGES: Final = (0, 1, -1, 2, 255, 256, 32767, 32768, 65535, 65536, 2**31 - 1, 2**31, 0.5, -1e-3, 1e9, 3e38)
#: Characters of frames.
FRAME: Final = "#TELE,STOP,-0.5,12\r\0"
#: The C files of the robot, and the drivers, by the name of their module.
FILES: Final = {
    **{name.rpartition(".")[2]: compiled.ROOT / f"{name.replace('.', '/')}.py" for name in MODULES},
    **{file.stem: file for file in sorted(SPECIMENS.glob("[a-z]*.py"))},
}


class TooLongError(Exception):
    """The function has taken too long."""


@dataclass
class Given:
    """What a call is given: numbers, in an order that `seed` makes."""

    seed: int
    numbers: list[float]

    def __post_init__(self) -> None:
        self.random = Random(self.seed)

    def value(self, ctype: CType, old: Any = None) -> Any:
        """A number of this type; `old` if it is none."""
        number = self.random.choice((*EDGES, *self.numbers))
        match ctype:
            case IntType(name="char") if self.random.random() < 0.8:
                return ord(self.random.choice(FRAME))
            case FloatType():
                return f32(float(number))
            case IntType(bits=bits, signed=signed):
                whole = (int(number) if isfinite(number) else 0) & (1 << bits) - 1
                return whole - (1 << bits) if signed and whole >> bits - 1 else whole
        return old


class Machine:
    """A board with linked functions."""

    def __init__(self, module: str, part: Callable[[str], Any]) -> None:
        self.board = RobotBoard()
        self.gyro = ScriptedGyro()
        self.board.spi_bus["A"].attach(self.board.pins[GYRO_CS_GPIO], self.gyro)
        if FILES[module].is_relative_to(SPECIMENS):
            self.firmware = image.link(self.board, [str(FILES[module])], built=part)
        else:
            self.firmware = link(self.board, built=part)
        self.linked = self.firmware.linked
        self.objects = [self.linked.objects[path] for path in sorted(self.linked.objects)]
        self.starts = [list(obj.data) for obj in self.objects]
        self.functions = {f.path: f.function for f in self.linked.compiled.functions}

    def call(self, path: str, given_: Given) -> list[Any]:
        """All that a call leaves behind."""
        clock, cpu, findings = self.board.clock, self.board.cpu, self.linked.runtime.findings
        for obj, start in zip(self.objects, self.starts, strict=True):
            types = [ctype for _, ctype in scalars(obj.declaration.ctype)]
            if not obj.readonly:
                obj.data[:] = [given_.value(ctype, old) for ctype, old in zip(types, start, strict=True)]
        self.gyro.registers = [given_.random.randrange(256) for _ in range(64)]
        codes = cycle([given_.random.randrange(4096) for _ in range(7)])
        self.board.adc["A"].force_codes(lambda _soc: next(codes))
        before = {id(finding): finding.count for finding in findings}
        arguments = [self.argument(ctype, given_) for ctype in self.functions[path].ctype.parameters]

        def stop() -> None:
            raise TooLongError

        event = clock.after(LONGEST_CYCLES, stop)
        begun, module, name = clock.now, *path.split(".")
        try:
            outcome = repr(getattr(getattr(self.firmware, module), name)(*arguments))
        except Exception as error:
            outcome = f"{type(error).__name__}: {error}"
        took = clock.now - begun
        clock.cancel(event)
        passed = [argument.obj for argument in arguments if isinstance(argument, Pointer) and argument.obj]
        told = [(f.rule, f.message, f.place, f.count) for f in findings if before.get(id(f)) != f.count]
        memory = [[getattr(v, "__name__", repr(v)) for v in obj.data] for obj in (*passed, *self.objects)]
        return [outcome, took, cpu.sp, cpu.ier, cpu.ifr, cpu.intm, memory, told]

    def argument(self, ctype: CType, given_: Given) -> Any:
        """A number, or a pointer to some: sometimes a null pointer."""
        if isinstance(ctype, PointerType) and given_.random.random() > 0.1:
            whole = ArrayType("passed", ctype.target, ROOM)
            values = [given_.value(inner) for _, inner in scalars(whole)]
            return make(self.firmware.memory, whole, "passed", values).at(0)
        return given_.value(ctype, 0)


@cache
def machines(module: str) -> tuple[Machine, ...]:
    """The same board with functions, with methods and, where there is a build, with what is compiled."""
    functions = Machine(module, lambda _identity: None)
    texts = as_methods.modules(functions.linked.parts)
    others = [Machine(module, texts.get)]
    if compiled.MODE == "compiled" and not FILES[module].is_relative_to(SPECIMENS):
        others.append(Machine(module, compiled.part))
    assert functions.linked.namespace.__class__ is dict
    assert all(other.linked.namespace.__class__ is not dict for other in others)
    return (functions, *others)


#: Every function, as `module.name`.
PATHS: Final = [f"{module}.{name}" for module, file in FILES.items() for name in functions_of(file)]


@pytest.mark.slow
@pytest.mark.parametrize("path", PATHS)
@settings(max_examples=settings.default.max_examples // 4)
@given(given_=st.builds(
    Given, st.integers(0, 9999), st.lists(st.integers(-70_000, 70_000) | st.floats(width=32), max_size=4)
))  # fmt: skip
def test_a_function_does_the_same_both_ways(path: str, given_: Given) -> None:
    of_module = machines(path.partition(".")[0])
    first, *others = (machine.call(path, Given(given_.seed, given_.numbers)) for machine in of_module)
    for other in others:
        assert other == first
