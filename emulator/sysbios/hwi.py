"""Hardware interrupts: `ti.sysbios.family.c28.Hwi` and its dispatcher.

Modelled
    A handler belongs to a CPU interrupt 1 to 15, or to one of the PIE (32 to 127 are INTx.1 to 8, 128 to 223 are
    INTx.9 to 16).  Interrupts nest as the masking option says; with the default SELF, the whole PIE group of the
    handler stays masked in IER.  Handlers run on the system stack.  The dispatcher acknowledges the PIE group before
    the handler runs, and locks the Swi scheduler while it runs.  `Hwi_disable` returns a key.
Not modelled
    Zero-latency interrupts, hooks, `Hwi_plug`, `Hwi_restoreInterrupt`, `Hwi_clearInterrupt`, and the calls on whole
    words of IER and PIEIER.  On the chip, enabling or disabling an interrupt of the PIE also clears what its group has
    latched in IFR, and acknowledges the group; here it does not.  The FPU context is not saved (STF rounding is the
    same everywhere).
Time
    `hwi_prologue` and `hwi_epilogue` around the handler, added to the cycles of the core.
Sources
    BIOS; `family/c28/Hwi.c`, `Hwi.xdc` 6.83 (Hwi_Instance_init, Hwi_enableInterrupt, Hwi_dispatchC, Hwi_dispatchCore).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from inspect import unwrap
from typing import Any, Final, Protocol

from emulator.c28x.memory import NULL
from emulator.c28x.sites import Place
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import (
    HWI,
    TASK,
    Function,
    KernelCore,
    KernelError,
    KernelObject,
    UniqueNames,
    fitted,
    function_name,
)
from emulator.sysbios.stack import DISPATCHER_WORDS, INTERRUPT_ROOM
from emulator.sysbios.swi import SwiModule
from emulator.sysbios.task import TaskModule

MASKING_NONE: Final = 0
MASKING_ALL: Final = 1
MASKING_SELF: Final = 2
MASKING_BITMASK: Final = 3
MASKING_LOWER: Final = 4
FIRST_PIE: Final = 32
FIRST_PIE_EXTENSION: Final = 128
END_OF_VECTORS: Final = 224
#: Interrupts of the CPU whose vector is fetched from the PIE's table as well: CPU timers 1 and 2.
DIRECT: Final = (13, 14)
#: CPU interrupts that can have a handler, and those of them that a call enables.
LAST_PLUGGED: Final = 15
LAST_ENABLED: Final = 14


def pie_group(number: int) -> int:
    """PIE group 1..12 of an interrupt, or 0 if it does not come from the PIE."""
    if number < FIRST_PIE:
        return 0
    return (number - (FIRST_PIE if number < FIRST_PIE_EXTENSION else FIRST_PIE_EXTENSION) >> 3) + 1


def ier_bit(number: int) -> int:
    """The IER bit of an interrupt."""
    return 1 << (pie_group(number) or number) - 1


class SetVector(Protocol):
    """Writes a vector of the PIE's table; `begins` is the place of the firmware's function."""

    def __call__(self, number: int, handler: Callable[[], None] | None, begins: Place | None = None, /) -> None:
        """Write the vector: `handler` runs when interrupt `number` is taken."""


class Hwi(KernelObject):
    """The handler of a hardware interrupt: the object of a `Hwi_Handle`."""

    __slots__ = ("ack", "arg", "disable_mask", "function", "group", "ier_bit", "number", "restore_mask", "who")

    def __init__(self, name: str, number: int, function: Function, arg: int, ack: bool) -> None:
        super().__init__(name)
        self.who = f"Hwi:{name}"
        self.number = number
        self.function = function
        self.arg = arg
        self.ack = ack
        self.group = pie_group(number)
        self.ier_bit = ier_bit(number)
        self.disable_mask = self.restore_mask = self.ier_bit

    def __repr__(self) -> str:
        return f"<Hwi {self.name} interrupt {self.number}>"


class HwiModule:
    """`Hwi_*`.  The board gives the three functions for the PIE.  Interrupts without a PIE vector go to the core."""

    def __init__(
        self,
        core: KernelCore,
        swis: SwiModule,
        tasks: TaskModule,
        *,
        system_stack: tuple[int, int],
        pie_set_vector: SetVector,
        pie_enable: Callable[[int, bool], bool],
        pie_acknowledge: Callable[[int], None],
    ) -> None:
        self.core = core
        self.swis = swis
        self.tasks = tasks
        self.current: Hwi | None = None
        self.table: dict[int, Hwi] = {}
        self._system_stack = system_stack
        self._set_vector = pie_set_vector
        self._enable = pie_enable
        self._acknowledge = pie_acknowledge
        self._names = UniqueNames()
        self._cost_prologue = core.costs["hwi_prologue"]
        self._cost_epilogue = core.costs["hwi_epilogue"]

    def _dispatch(self, hwi: Hwi) -> None:
        """Run a handler.  The core calls it with interrupts disabled, on the interrupted stack.

        Swis and tasks that the handler made ready run when the core has left its outermost interrupt.
        """
        core, swis, tasks = self.core, self.swis, self.tasks
        cpu, clock, trace = core.cpu, core.clock, core.trace
        task_key, swi_key = tasks.locked, swis.locked
        tasks.locked = swis.locked = True
        previous, sp, limit = core.thread_type, cpu.sp, cpu.stack_limit
        if previous == TASK:
            if sp + DISPATCHER_WORDS > limit + INTERRUPT_ROOM:
                tasks.overrun(sp + DISPATCHER_WORDS)
            cpu.sp, cpu.stack_limit = self._system_stack
        outer, who = self.current, cpu.position.who
        self.current, cpu.position.who = hwi, hwi.who
        core.thread_type = HWI
        if trace.active:
            trace.emit("hwi", hwi.name)
        if hwi.group and hwi.ack:
            self._acknowledge(hwi.group)
        clock.now += self._cost_prologue
        if clock.now >= clock.next:
            clock.run_due()
        # The core masked this line on entry; the dispatcher puts it back and then masks what the option says.
        cpu.ier |= hwi.ier_bit
        ier = cpu.ier
        cpu.ier = ier & ~hwi.disable_mask
        cpu.intm = False
        if cpu.ifr & cpu.ier:
            clock.request_attention()
        hwi.function(hwi.arg)
        clock.now += self._cost_epilogue
        if clock.now >= clock.next:
            clock.run_due()
        cpu.intm = True
        cpu.ier |= hwi.restore_mask & ier
        if trace.active:
            trace.emit("hwi end", hwi.name)
        self.current, cpu.position.who = outer, who
        core.thread_type = previous
        cpu.sp, cpu.stack_limit = sp, limit
        tasks.locked, swis.locked = task_key, swi_key

    def create(self, number: int, function: Function, *, name: str = "", arg: int = 0, ack: bool = True) -> Hwi:
        """Plug a handler with the default masking SELF.  The interrupt is not enabled."""
        name = self._names.unique(name or function_name(function))
        hwi = Hwi(name, number, fitted(self.core, function, 1, "Hwi function"), arg, ack)
        self.table[number] = hwi
        handler = partial(self._dispatch, hwi)
        beginnings = self.core.findings.beginnings
        begins = beginnings.get(function) or beginnings.get(unwrap(function))
        if begins is not None and self.core.findings.interrupts.get(begins):
            self.core.findings.report_at(
                begins, "isr-keyword", f"{begins.function} is declared `interrupt`, and the Hwi {name} calls it",
                how="dynamic", object=begins.function,
            )  # fmt: skip
        if hwi.group or number in DIRECT:
            if begins is not None:
                self.core.cpu.dispatched.add(begins)
            self._set_vector(number, handler, begins)
        else:
            self.core.cpu.connect(number, handler)
        return hwi

    def handler(self, number: int) -> Callable[[], None]:
        """The function that the core calls for interrupt `number`."""
        return partial(self._dispatch, self.table[number])

    # C functions

    def Hwi_Params_init(self, params: Any) -> None:
        """Set the defaults: masking SELF, enabled at once, the dispatcher acknowledges the PIE."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Hwi_Params", params)

    def Hwi_create(self, number: int, function: Function, params: Any, error_block: Any = None) -> Hwi | None:
        """Create a handler for interrupt `number`.  NULL if it has one already and an Error_Block was passed."""
        core = self.core
        core.clock.charge(core.costs["hwi_create"])
        given = struct_params.read(core, "Hwi_Params", params)
        self._check_number(number, LAST_PLUGGED)
        if number in self.table:
            core.error(
                error_block, "Hwi_E_alreadyDefined", f"interrupt {number} has the handler {self.table[number].name}"
            )
            return None
        hwi = self.create(number, function, arg=given["arg"], ack=bool(given["enableAck"]))
        option = given["maskSetting"]
        if option == MASKING_NONE:
            hwi.disable_mask = hwi.restore_mask = 0
        elif option == MASKING_ALL:
            hwi.disable_mask = hwi.restore_mask = 0xFFFF
        elif option == MASKING_BITMASK:
            hwi.disable_mask, hwi.restore_mask = given["disableMask"] & 0xFFFF, given["restoreMask"] & 0xFFFF
        else:  # SELF; LOWER means the same on this family.
            core.check(option in (MASKING_SELF, MASKING_LOWER), "Hwi_A_invalidArg", f"{option} is no MaskingOption")
        if given["enableInt"]:
            self.Hwi_enableInterrupt(number)
        return hwi

    def Hwi_delete(self, pointer: Any) -> None:
        """Disable the interrupt and remove its handler."""
        self.core.clock.charge(self.core.costs["delete"])
        hwi = pointer.load()
        if hwi.number <= LAST_ENABLED or hwi.number >= FIRST_PIE:
            self.Hwi_disableInterrupt(hwi.number)
        del self.table[hwi.number]
        unplugged = partial(self._unplugged, hwi.number)
        if hwi.group:
            self._set_vector(hwi.number, unplugged)
        else:
            self.core.cpu.connect(hwi.number, unplugged)
        hwi.deleted = True
        pointer.store(NULL)

    def _unplugged(self, number: int) -> None:
        """End the program: an interrupt occurred whose handler was deleted (`Hwi_unPluggedInterrupt`)."""
        raise KernelError("Hwi_E_unpluggedInterrupt", f"interrupt {number} came, whose Hwi was deleted")

    def Hwi_enableInterrupt(self, number: int) -> int:
        """Enable interrupt `number`: set its PIEIER bit if it has one, and its IER bit.

        Returns the old PIEIER bit, or for a CPU interrupt the old IER bit, at the bit's own position.
        """
        self._check_number(number, LAST_ENABLED)
        cpu, bit = self.core.cpu, ier_bit(number)
        was = cpu.ier & bit if number < FIRST_PIE else self._pie_key(number, True)
        cpu.write_ier(cpu.ier | bit)
        return was

    def Hwi_disableInterrupt(self, number: int) -> int:
        """Disable interrupt `number`: clear its PIEIER bit, or its IER bit if it does not come from the PIE.

        Returns the old bit at its own position.
        """
        self._check_number(number, LAST_ENABLED)
        if number >= FIRST_PIE:
            return self._pie_key(number, False)
        cpu, bit = self.core.cpu, ier_bit(number)
        was = cpu.ier & bit
        cpu.write_ier(cpu.ier & ~bit)
        return was

    def _check_number(self, number: int, last: int) -> None:
        valid = 1 <= number <= last or FIRST_PIE <= number < END_OF_VECTORS
        message = f"{number} is neither 1..{last} nor {FIRST_PIE}..{END_OF_VECTORS - 1}"
        self.core.check(valid, "Hwi_A_badIntNum", message)

    def _pie_key(self, number: int, on: bool) -> int:
        """Write a PIEIER bit.  Returns the old bit at its position in PIEIER."""
        bit = 1 << (number & 7) + (8 if number >= FIRST_PIE_EXTENSION else 0)
        return bit if self._enable(number, on) else 0

    def Hwi_disable(self) -> int:
        """Disable interrupts (DINT).  Returns the key for `Hwi_restore`: whether they were disabled already."""
        cpu = self.core.cpu
        key = cpu.intm
        cpu.intm = True
        self.core.clock.charge(self.core.costs["hwi_disable"])
        return int(key)

    def Hwi_enable(self) -> int:
        """Enable interrupts (EINT).  Returns whether they were disabled.  Latched interrupts are taken in this call."""
        cpu = self.core.cpu
        key = cpu.intm
        cpu.enable_interrupts()
        self.core.clock.charge(self.core.costs["hwi_disable"])
        return int(key)

    def Hwi_restore(self, key: int) -> None:
        """Restore the interrupts to their state before the `Hwi_disable` that returned `key`."""
        cpu = self.core.cpu
        if key:
            cpu.intm = True
        else:
            cpu.enable_interrupts()
        self.core.clock.charge(self.core.costs["hwi_disable"])
