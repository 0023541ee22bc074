"""The five drivers' work without kernel and tasks: on the emulator, and on an instruction simulator of an AVR.

One turn takes 5 ms of virtual time: `Read_Distance` of the three sonars (36 conversions), `get_GYRO` (three transfers
of SPI) and four writes of the servers.  On the AVR it is the same work with that chip's own converter and SPI
(`drivers_avr.c`); the processor sleeps until the next turn.  CPU time of this process, or of simavr.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import process_time
from typing import Final

from emulator import compiled
from emulator.clock import CYCLES_PER_US
from firmware_model.image import link
from hil.robot.board import RobotBoard
from tests.emulator.c28x.readers.c import avr

if sys.platform != "win32":  # simavr is not measured there
    import resource

TURN_US: Final = 5000
#: Virtual seconds that are left out of both: what starts a process, links and initialises.
LEAD_S: Final = 1
SOURCE: Final = Path(__file__).with_name("drivers_avr.c")


def emulated(seconds: int) -> float:
    """CPU seconds of this process for a virtual second of the drivers, with every check."""
    board = RobotBoard()
    firmware = link(board, built=compiled.part)
    firmware.spi.Init_SPIA()
    firmware.us.Init_US()
    firmware.gyro.Init_GYRO()
    read, rate = firmware.function("us.Read_Distance"), firmware.function("gyro.get_GYRO")
    writes = [
        firmware.function(f"servidores.{name}")
        for name in ("write_left_distance", "write_front_distance", "write_right_distance", "write_z_axis")
    ]
    clock = board.cpu.clock

    def turns(number: int) -> None:
        for _ in range(number):
            until = clock.now + TURN_US * CYCLES_PER_US
            values = [*map(read, range(3)), rate(2, 0.0)]
            for write, value in zip(writes, values, strict=True):
                write(value)
            clock.advance_to(until)

    turns(LEAD_S * 1_000_000 // TURN_US)
    start = process_time()
    turns(seconds * 1_000_000 // TURN_US)
    return (process_time() - start) / seconds


def on_an_avr(seconds: int) -> float | None:
    """CPU seconds of simavr for a virtual second of the drivers; None if a package is not installed."""
    if sys.platform == "win32" or avr.missing():
        return None
    with tempfile.TemporaryDirectory() as folder:
        lead, whole = (_simulated(folder, turns * 1_000_000 // TURN_US) for turns in (LEAD_S, LEAD_S + seconds))
    return (whole - lead) / seconds


def _simulated(folder: str, turns: int) -> float:
    """CPU seconds of simavr for so many turns, with its start."""
    program = str(Path(folder, "drivers.elf"))
    subprocess.run(
        ["avr-gcc", f"-mmcu={avr.MCU}", "-std=gnu99", "-O2", f"-DTURNS={turns}", "-o", program, str(SOURCE)], check=True
    )  # fmt: skip
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        ["simavr", "-m", avr.MCU, "-f", "16000000", program], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        check=True, timeout=600,
    )  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(seconds: int, rounds: int) -> dict[str, list[float]]:
    """Virtual seconds a CPU second of both, round by round; without simavr only ours."""
    result: dict[str, list[float]] = {"emulated": [], "simavr": []}
    for _ in range(rounds):
        result["emulated"].append(1 / emulated(seconds))
        if (taken := on_an_avr(seconds)) is not None:
            result["simavr"].append(1 / taken)
    return result


def show(result: dict[str, list[float]]) -> None:
    """Lines for people."""
    ours, other = result["emulated"], result["simavr"]
    print(f"{'drivers alone':30} {'':12} {median(ours):12.1f}")
    if other:
        ratios = [a / b for a, b in zip(ours, other, strict=True)]
        print(f"{'  the same work, simavr':30} {'':12} {median(other):12.1f}")
        print(f"  ratio {median(ratios):.1f} ({min(ratios):.1f} to {max(ratios):.1f})")
    else:
        print(f"  to compare with an AVR: apt install {avr.missing()}")
