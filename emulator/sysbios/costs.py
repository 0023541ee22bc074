"""CPU cycles that kernel services take.

CHOICE: magnitudes of the benchmark tables that TI publishes with SYS/BIOS for C28x devices (a semaphore post or pend
without a switch is in the order of a hundred cycles, a task switch below two hundred, interrupt prologue and epilogue
about a hundred together).  Not measured on the robot: `scale` multiplies the whole table, so that a measured task
brings it into line.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

#: Service -> cycles.  What a call costs is charged before it acts, so it can be pre-empted before, never within.
CYCLES: Final[Mapping[str, int]] = {
    # Interrupts: the dispatcher around the handler (the core's own 14 + 8 cycles are charged by the CPU).
    "hwi_prologue": 90,
    "hwi_epilogue": 60,
    "hwi_disable": 6,
    "hwi_create": 300,
    # The tick: what its handler adds to the dispatcher, and the Clock Swi.
    "clock_tick": 40,
    "clock_work": 70,
    "clock_walk": 14,
    "clock_call": 40,
    "clock_service": 40,
    "clock_create": 250,
    # Swis
    "swi_post": 60,
    "swi_run": 80,
    "swi_trigger": 20,
    "swi_disable": 8,
    "swi_create": 250,
    # Tasks
    "task_switch": 180,
    "task_create": 600,
    "task_service": 30,
    "task_set_priority": 110,
    "task_yield": 90,
    "task_sleep": 160,
    # Semaphores
    "semaphore_create": 200,
    "semaphore_pend": 90,
    "semaphore_post": 120,
    "semaphore_block": 70,
    "semaphore_timeout": 60,
    "semaphore_service": 15,
    # Gates
    "gate_create": 200,
    "gate_enter": 100,
    "gate_leave": 100,
    # Params_init, Log, System
    "params_init": 40,
    "log_write": 120,
    "print_call": 60,
    "print_character": 24,
    "print_conversion": 110,
    "print_digit": 120,  # one 32-bit remainder and one 32-bit division of the run-time library
    "system_service": 40,
    "bios_start": 2000,
}


def scaled(scale: float) -> dict[str, int]:
    """The table times `scale`, each entry rounded to whole cycles.  Raises ValueError for a negative factor."""
    if scale < 0:
        raise ValueError(f"kernel cost scale is {scale}; it must be 0 or more")
    return {name: round(cycles * scale) for name, cycles in CYCLES.items()}
