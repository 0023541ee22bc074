"""Compares gates, which tasks of different priorities enter and leave, with a model of `GateMutexPri`.

`GateModel` states the rules of the kernel's manual and source in a few lines, and does not use the emulator.
`GateMachine` is the Hypothesis machine.  A subclass may choose other priorities, or replace enter and leave by its own
functions (a monitor of the firmware):

    class TestGates(GateMachine.TestCase):
        settings = settings(max_examples=50)

Sources: SYS/BIOS `gates/GateMutexPri.c` 6.83.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, Final

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from emulator.clock import CYCLES_PER_MS
from emulator.sysbios.core import WAIT_FOREVER
from hil.board import Board

#: The priority of the task that passes the machine's commands to its tasks.  It is above all of them.
DIRECTOR_PRIORITY: Final = 15


# The model


@dataclass
class GateState:
    """A gate: its owner, the priority to which the owner returns, and its waiters."""

    owner: str = ""
    original: int = 0
    waiters: list[str] = field(default_factory=list)


class GateModel:
    """A model of `GateMutexPri`: owners, waiters and priorities."""

    def __init__(self, priorities: dict[str, int], gates: int) -> None:
        self.priority = dict(priorities)
        self.gates = [GateState() for _ in range(gates)]
        #: The keys of each task for each gate, the latest last.  0: it took the gate; 1: it was inside already.
        self.keys: dict[tuple[str, int], list[int]] = {(t, g): [] for t in priorities for g in range(gates)}

    def waits(self, task: str) -> bool:
        """Whether a task is blocked at a gate."""
        return any(task in gate.waiters for gate in self.gates)

    def deadlocks(self, task: str, number: int) -> bool:
        """Whether this task would wait for a task that waits, directly or not, for a gate of this task."""
        owner = self.gates[number].owner
        while owner and owner != task:
            waited = next((gate for gate in self.gates if owner in gate.waiters), None)
            if waited is None:
                return False
            owner = waited.owner
        return bool(owner) and self.gates[number].owner != task

    def enter(self, task: str, number: int) -> None:
        """A free gate is taken; an own gate is nested.  Else the task waits by priority, and a lower owner inherits."""
        gate = self.gates[number]
        if not gate.owner:
            gate.owner, gate.original = task, self.priority[task]
            self.keys[task, number].append(0)
        elif gate.owner == task:
            self.keys[task, number].append(1)
        else:
            mine = self.priority[task]
            place = next((i for i, w in enumerate(gate.waiters) if mine > self.priority[w]), len(gate.waiters))
            gate.waiters.insert(place, task)
            self.priority[gate.owner] = max(self.priority[gate.owner], mine)

    def leave(self, task: str, number: int) -> None:
        """With key 0, the first waiter gets the gate, and the task returns to the priority with which it took it."""
        gate = self.gates[number]
        if self.keys[task, number].pop():
            return
        self.priority[task] = min(self.priority[task], gate.original)
        gate.owner = ""
        if gate.waiters:
            gate.owner = gate.waiters.pop(0)
            gate.original = self.priority[gate.owner]
            self.keys[gate.owner, number].append(0)


# The system


class GateRig:
    """A board whose kernel runs a task for each name.  Each task executes commands, one at a time."""

    def __init__(self, priorities: dict[str, int], gates: int) -> None:
        self.board = Board()
        kernel = self.kernel = self.board.kernel
        self.gates = [kernel.GateMutexPri_create(None, None) for _ in range(gates)]
        self.keys: dict[tuple[str, int], list[int]] = {(t, g): [] for t in priorities for g in range(gates)}
        self._commands: dict[str, Callable[[], None]] = {}
        self._wanted = {name: kernel.Semaphore_create(0, None, None) for name in priorities}
        self._queue: deque[str] = deque()
        for name, priority in priorities.items():
            self._task(name, priority, self._worker(name))
        self._task("director", DIRECTOR_PRIORITY, self._director)
        kernel.start(kernel.BIOS_start)

    def _task(self, name: str, priority: int, function: Callable[[], None]) -> None:
        tasks = self.kernel.tasks
        stack = tasks.stacks.allocate(256, 0, None)
        assert stack is not None
        tasks.add(function, priority, stack, (0, 0), True, name)

    def _worker(self, name: str) -> Callable[[], None]:
        def work() -> None:
            while True:
                self.kernel.Semaphore_pend(self._wanted[name], WAIT_FOREVER)
                self._commands[name]()

        return work

    def _director(self) -> None:
        while True:
            self.kernel.Task_sleep(1)
            if self._queue:
                self.kernel.Semaphore_post(self._wanted[self._queue.popleft()])

    def do(self, name: str, command: Callable[[], None]) -> None:
        """Let a task execute `command`, and run until all tasks are blocked."""
        self._commands[name] = command
        self._queue.append(name)
        self.kernel.run_until(self.board.clock.now + 3 * CYCLES_PER_MS)

    def enter(self, name: str, number: int) -> None:
        """The command with which a task enters a gate."""
        self.keys[name, number].append(self.kernel.GateMutexPri_enter(self.gates[number]))

    def leave(self, name: str, number: int) -> None:
        """The command with which a task leaves a gate with its latest key."""
        self.kernel.GateMutexPri_leave(self.gates[number], self.keys[name, number].pop())

    def owner(self, number: int) -> str:
        """The owner of a gate; empty if it is free."""
        gate = self.gates[number]
        return "" if gate.free or gate.owner is None else str(gate.owner.name)

    def waiters(self, number: int) -> list[str]:
        """The tasks that wait for a gate, the next owner first."""
        return [waiter.task.name for waiter in self.gates[number].waiters]

    def priorities(self) -> dict[str, int]:
        """The present priority of each task."""
        return {task.name: task.priority for task in self.kernel.tasks.all if task.name in self._wanted}

    def close(self) -> None:
        """End the tasks."""
        self.kernel.shutdown()


class GateMachine(RuleBasedStateMachine):
    """Tasks enter and leave gates in any order without a deadlock.  After each step, system and model are compared."""

    #: Task -> priority.  Two equal priorities show that waiters of one priority are served in the order of arrival.
    priorities: ClassVar[dict[str, int]] = {"low": 2, "middle": 5, "other": 5, "high": 9}
    #: The number of gates.
    gates: ClassVar[int] = 2

    rig: GateRig
    model: GateModel

    def open(self) -> GateRig:
        """Create the system under test.  A subclass may return another one."""
        return GateRig(self.priorities, self.gates)

    @initialize()
    def begin(self) -> None:
        """Create a board and a model."""
        self.rig = self.open()
        self.model = GateModel(self.priorities, self.gates)

    def _can_enter(self) -> list[tuple[str, int]]:
        awake = [task for task in self.priorities if not self.model.waits(task)]
        pairs = [(task, number) for task in awake for number in range(self.gates)]
        return [(task, number) for task, number in pairs if not self.model.deadlocks(task, number)]

    def _can_leave(self) -> list[tuple[str, int]]:
        return [(t, n) for (t, n), keys in self.model.keys.items() if keys and not self.model.waits(t)]

    @precondition(lambda self: bool(self._can_enter()))
    @rule(data=st.data())
    def enter(self, data: st.DataObject) -> None:
        """A task that is not blocked enters a gate."""
        task, number = data.draw(st.sampled_from(self._can_enter()), label="enter")
        self.rig.do(task, lambda: self.rig.enter(task, number))
        self.model.enter(task, number)

    @precondition(lambda self: bool(self._can_leave()))
    @rule(data=st.data())
    def leave(self, data: st.DataObject) -> None:
        """A task that is not blocked leaves a gate in which it is."""
        task, number = data.draw(st.sampled_from(self._can_leave()), label="leave")
        self.rig.do(task, lambda: self.rig.leave(task, number))
        self.model.leave(task, number)

    @invariant()
    def same(self) -> None:
        """Compare owners, waiters in their order, keys, and the priority of each task."""
        if not hasattr(self, "rig"):
            return
        for number, gate in enumerate(self.model.gates):
            assert self.rig.owner(number) == gate.owner, f"owner of gate {number}"
            assert self.rig.waiters(number) == gate.waiters, f"waiters of gate {number}"
        assert self.rig.keys == self.model.keys
        assert self.rig.priorities() == self.model.priority

    def teardown(self) -> None:
        """End the tasks."""
        rig: Any = self.__dict__.get("rig")
        if rig is not None:
            rig.close()
