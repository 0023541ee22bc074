"""Gates that disable a scheduler or interrupts: `ti.sysbios.gates.GateTask`, `GateSwi`, `GateHwi`, `GateAll`.

Modelled
    A GateTask disables the task scheduler, a GateSwi the Swi scheduler, a GateHwi interrupts.  This depends only on the
    kind of the gate, not on the instance.  The key is that of the disable function.  The assertions say which threads
    may not enter.  A GateAll disables interrupts and the Swi scheduler, and stores their keys itself.  Its `enter`
    returns 0, or 1 if it was entered already; only a `leave` with key 0 releases it.
Time
    `gate_key`, added to the time of the disable function.
Sources
    BIOS; `gates/GateTask.c`, `gates/GateSwi.c`, `gates/GateHwi.c`, `gates/GateAll.c` 6.83.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.memory import NULL
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import HWI, MAIN, TASK, KernelCore, KernelObject, UniqueNames
from emulator.sysbios.hwi import HwiModule
from emulator.sysbios.swi import SwiModule
from emulator.sysbios.task import TaskModule

# GateAll
FIRST_ENTER: Final = 0
NESTED_ENTER: Final = 1


class GateKey(KernelObject):
    """A gate; `kind` is the module's name."""

    __slots__ = ("entered", "hwi_key", "kind", "swi_key")

    def __init__(self, name: str, kind: str) -> None:
        super().__init__(name)
        self.kind = kind
        #: For a GateAll: whether it is entered, and the keys that it restores when it is left.
        self.entered = False
        self.hwi_key = 0
        self.swi_key = 0

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name}>"


class GateKeyModule:
    """`GateTask_*`, `GateSwi_*`, `GateHwi_*`, `GateAll_*`."""

    def __init__(self, core: KernelCore, tasks: TaskModule, swis: SwiModule, hwis: HwiModule) -> None:
        self.core = core
        self.tasks = tasks
        self.swis = swis
        self.hwis = hwis
        self._names = UniqueNames()

    def _create(self, kind: str, params: Any) -> GateKey:
        self.core.clock.charge(self.core.costs["gate_create"])
        struct_params.read(self.core, f"{kind}_Params", params)
        return GateKey(self._names.unique(kind), kind)

    def _delete(self, pointer: Any) -> None:
        self.core.clock.charge(self.core.costs["delete"])
        pointer.load().deleted = True
        pointer.store(NULL)

    def _initialise(self, kind: str, params: Any) -> None:
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise(f"{kind}_Params", params)

    def _charge(self) -> None:
        self.core.clock.charge(self.core.costs["gate_key"])

    # C functions

    def GateTask_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self._initialise("GateTask", params)

    def GateTask_create(self, params: Any = None, error_block: Any = None) -> GateKey:
        """Create a gate that disables task switches."""
        return self._create("GateTask", params)

    def GateTask_delete(self, pointer: Any) -> None:
        """Delete the gate."""
        self._delete(pointer)

    def GateTask_enter(self, gate: GateKey) -> int:
        """`Task_disable`, from main or a task."""
        core = self.core
        self._charge()
        core.check(
            core.thread_type in (TASK, MAIN), "GateTask_A_badContext",
            "a GateTask can be entered from main or a task only",
        )  # fmt: skip
        return self.tasks.Task_disable()

    def GateTask_leave(self, gate: GateKey, key: int) -> None:
        """`Task_restore`."""
        self._charge()
        self.tasks.Task_restore(key)

    def GateSwi_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self._initialise("GateSwi", params)

    def GateSwi_create(self, params: Any = None, error_block: Any = None) -> GateKey:
        """Create a gate that disables Swis and task switches."""
        return self._create("GateSwi", params)

    def GateSwi_delete(self, pointer: Any) -> None:
        """Delete the gate."""
        self._delete(pointer)

    def GateSwi_enter(self, gate: GateKey) -> int:
        """`Swi_disable`, from anything but a Hwi."""
        self._charge()
        self.core.check(self.core.thread_type != HWI, "GateSwi_A_badContext", "a GateSwi cannot be entered from a Hwi")
        return self.swis.Swi_disable()

    def GateSwi_leave(self, gate: GateKey, key: int) -> None:
        """`Swi_restore`."""
        self._charge()
        self.swis.Swi_restore(key)

    def GateHwi_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self._initialise("GateHwi", params)

    def GateHwi_create(self, params: Any = None, error_block: Any = None) -> GateKey:
        """Create a gate that disables interrupts."""
        return self._create("GateHwi", params)

    def GateHwi_delete(self, pointer: Any) -> None:
        """Delete the gate."""
        self._delete(pointer)

    def GateHwi_enter(self, gate: GateKey) -> int:
        """`Hwi_disable`."""
        self._charge()
        return self.hwis.Hwi_disable()

    def GateHwi_leave(self, gate: GateKey, key: int) -> None:
        """`Hwi_restore`."""
        self._charge()
        self.hwis.Hwi_restore(key)

    def GateAll_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self._initialise("GateAll", params)

    def GateAll_create(self, params: Any = None, error_block: Any = None) -> GateKey:
        """Create a gate that disables interrupts and Swis."""
        return self._create("GateAll", params)

    def GateAll_delete(self, pointer: Any) -> None:
        """Delete the gate."""
        self._delete(pointer)

    def GateAll_enter(self, gate: GateKey) -> int:
        """Call `Hwi_disable`, then `Swi_disable`.  While the gate is entered, it only returns 1."""
        self._charge()
        if gate.entered:
            return NESTED_ENTER
        gate.hwi_key = self.hwis.Hwi_disable()
        gate.swi_key = self.swis.Swi_disable()
        gate.entered = True
        return FIRST_ENTER

    def GateAll_leave(self, gate: GateKey, key: int) -> None:
        """Call `Swi_restore`, then `Hwi_restore`, if `key` is 0."""
        self._charge()
        if key == FIRST_ENTER:
            gate.entered = False
            self.swis.Swi_restore(gate.swi_key)
            self.hwis.Hwi_restore(gate.hwi_key)
