"""CPU cycles that kernel services take.

CHOICE: the proportions are those of the benchmark tables that TI publishes with SYS/BIOS for C28x devices (a semaphore
post or pend without a switch is in the order of a hundred cycles, a task switch below two hundred, interrupt prologue
and epilogue about a hundred together).  `scale` multiplies the whole table.  The board of the robot uses the times that
were measured on it: 5 us for the tick's interrupt and 4.05 us for entering and leaving a gate (TFG 3.4.2, 3.4.3).  The
time of System_sprintf is computed from TaskODO, which takes 860..873 us and calls it six times (TFG figures 37 and 39):
the rest of TaskODO's time is divided among the six calls, because nothing else there can take so long.  Almost all of
it must be the same for every call, or the figures would differ more.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

#: Service -> cycles.  A call is charged its cycles before it acts.  So it can be pre-empted before it acts, not within.
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
    "semaphore_service": 15,
    "pend_timeout": 60,  # of semaphores and events
    # Events: a mask to match in place of a count
    "event_create": 150,
    "event_pend": 110,
    "event_post": 120,
    "event_block": 70,
    "event_service": 15,
    # Mailboxes: besides their two semaphores; a message takes "mailbox_word" for each of its words
    "mailbox_create": 600,
    "mailbox_copy": 60,
    "mailbox_word": 2,
    "mailbox_service": 15,
    # Queues: four pointers, with interrupts off in those that are atomic
    "queue_create": 150,
    "queue_link": 25,
    "queue_look": 10,
    # Gates
    "gate_create": 200,
    "gate_enter": 160,
    "gate_leave": 160,
    "gate_mutex": 25,  # besides its semaphore
    "gate_key": 10,  # besides the scheduler or the interrupts that it disables
    # Heaps, besides the gate of HeapMem; each free block that is looked at, each word that is set or copied
    "heap_create": 250,
    "heap_service": 60,
    "heap_look": 12,
    "memory_word": 2,
    # Any *_delete
    "delete": 120,
    # Params_init, Log, System
    "params_init": 40,
    "log_write": 20,
    "print_call": 11500,
    "print_character": 10,
    "print_conversion": 110,
    "print_digit": 50,  # one 32-bit remainder and one 32-bit division of the run-time library
    "system_service": 40,
    "bios_start": 2000,
}


def scaled(scale: float) -> dict[str, int]:
    """The table times `scale`, each entry rounded to whole cycles.  Raises ValueError for a negative factor."""
    if scale < 0:
        raise ValueError(f"kernel cost scale is {scale}; it must be 0 or more")
    return {name: round(cycles * scale) for name, cycles in CYCLES.items()}
