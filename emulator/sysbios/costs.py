"""CPU cycles that kernel services take.

CHOICE: the proportions are those of the benchmark tables that TI publishes with SYS/BIOS for C28x devices.  There, a
post or pend of a semaphore without a task switch takes about a hundred cycles, a task switch less than two hundred, and
the prologue and epilogue of an interrupt together about a hundred.  `scale` multiplies the whole table.  The board of
the robot uses the times that were measured on it: 5 us for the tick's interrupt, and 4.05 us to enter and leave a gate
(TFG 3.4.2, 3.4.3).  The time of System_sprintf is computed from TaskODO, which takes 860 to 873 us and calls it six
times (TFG figures 37 and 39).  The rest of TaskODO's time is divided by six, because nothing else there can take so
long.  Almost all of that time must be the same for every call, because otherwise the figures would differ more.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

#: Service -> cycles.  A call is charged its cycles before it acts.  So it can be pre-empted before it acts, not within.
CYCLES: Final[Mapping[str, int]] = {
    # Interrupts: the dispatcher around the handler.  The CPU itself charges the core's 14 + 8 cycles.
    "hwi_prologue": 90,
    "hwi_epilogue": 60,
    "hwi_disable": 6,
    "hwi_create": 300,
    # The tick: the cycles of its handler, added to the dispatcher's, and the Clock Swi.
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
    # Events.  They match a mask where a semaphore has a count.
    "event_create": 150,
    "event_pend": 110,
    "event_post": 120,
    "event_block": 70,
    "event_service": 15,
    # Mailboxes.  Their two semaphores come on top, and "mailbox_word" for each word of a message.
    "mailbox_create": 600,
    "mailbox_copy": 60,
    "mailbox_word": 2,
    "mailbox_service": 15,
    # Queues.  A function changes four pointers; the atomic functions do so with interrupts disabled.
    "queue_create": 150,
    "queue_link": 25,
    "queue_look": 10,
    # Gates
    "gate_create": 200,
    "gate_enter": 160,
    "gate_leave": 160,
    "gate_mutex": 25,  # besides its semaphore
    "gate_key": 10,  # besides the scheduler or the interrupts that it disables
    # Heaps.  The gate of HeapMem comes on top, and a time for each free block examined and each word set or copied.
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
