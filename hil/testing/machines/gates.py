"""Gates entered and left by tasks of different priority, beside a model of `GateMutexPri`.

`GateModel` states the rules of the kernel's manual and source in a few lines and knows nothing of the emulator.
`GateMachine` is the Hypothesis machine; a subclass may choose other priorities, or put its own functions (a monitor of
the firmware) in the place of enter and leave:

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

#: What carries the machine's commands to its tasks; above all of them.
DIRECTOR_PRIORITY: Final = 15


# The model


@dataclass
class GateState:
    """A gate: its owner, the priority to return to, its waiters."""

    owner: str = ""
    original: int = 0
    waiters: list[str] = field(default_factory=list)


class GateModel:
    """What `GateMutexPri` does to owners, waiters and priorities."""

    def __init__(self, priorities: dict[str, int], gates: int) -> None:
        self.priority = dict(priorities)
        self.gates = [GateState() for _ in range(gates)]
        #: Keys of the gates a task is inside of, the latest one last: 0 took the gate, 1 was inside already.
        self.keys: dict[tuple[str, int], list[int]] = {(t, g): [] for t in priorities for g in range(gates)}

    def waits(self, task: str) -> bool:
        """Whether a task is blocked at some gate."""
        return any(task in gate.waiters for gate in self.gates)

    def deadlocks(self, task: str, number: int) -> bool:
        """Whether this task would wait for somebody who waits, directly or not, for what it owns."""
        owner = self.gates[number].owner
        while owner and owner != task:
            waited = next((gate for gate in self.gates if owner in gate.waiters), None)
            if waited is None:
                return False
            owner = waited.owner
        return bool(owner) and self.gates[number].owner != task

    def enter(self, task: str, number: int) -> None:
        """Free: it is taken.  Own: nested.  Else wait by priority; a lower owner inherits."""
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
        """The key 0 gives the gate to the first waiter and returns to the priority that it was taken with."""
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
    """A board whose kernel runs one task a name; each does what it is told, one command at a time."""

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
        """Have a task run `command`, and everybody come to rest."""
        self._commands[name] = command
        self._queue.append(name)
        self.kernel.run_until(self.board.clock.now + 3 * CYCLES_PER_MS)

    def enter(self, name: str, number: int) -> None:
        """What the task runs to enter a gate."""
        self.keys[name, number].append(self.kernel.GateMutexPri_enter(self.gates[number]))

    def leave(self, name: str, number: int) -> None:
        """What the task runs to leave a gate with its latest key."""
        self.kernel.GateMutexPri_leave(self.gates[number], self.keys[name, number].pop())

    def owner(self, number: int) -> str:
        """Who owns a gate; empty if it is free."""
        gate = self.gates[number]
        return "" if gate.free or gate.owner is None else str(gate.owner.name)

    def waiters(self, number: int) -> list[str]:
        """Who waits for a gate, the next owner first."""
        return [waiter.task.name for waiter in self.gates[number].waiters]

    def priorities(self) -> dict[str, int]:
        """The present priority of each task."""
        return {task.name: task.priority for task in self.kernel.tasks.all if task.name in self._wanted}

    def close(self) -> None:
        """End the tasks."""
        self.kernel.shutdown()


class GateMachine(RuleBasedStateMachine):
    """Tasks enter and leave gates in any order without a deadlock; after each step both worlds are compared."""

    #: Task -> priority.  Two equal ones show that waiters of one priority stand in order of arrival.
    priorities: ClassVar[dict[str, int]] = {"low": 2, "middle": 5, "other": 5, "high": 9}
    #: How many gates.
    gates: ClassVar[int] = 2

    rig: GateRig
    model: GateModel

    def open(self) -> GateRig:
        """The system under test; a subclass may give another."""
        return GateRig(self.priorities, self.gates)

    @initialize()
    def begin(self) -> None:
        """A new board and a new model."""
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
        """Some task that is awake enters some gate."""
        task, number = data.draw(st.sampled_from(self._can_enter()), label="enter")
        self.rig.do(task, lambda: self.rig.enter(task, number))
        self.model.enter(task, number)

    @precondition(lambda self: bool(self._can_leave()))
    @rule(data=st.data())
    def leave(self, data: st.DataObject) -> None:
        """Some task that is awake leaves some gate that it is inside of."""
        task, number = data.draw(st.sampled_from(self._can_leave()), label="leave")
        self.rig.do(task, lambda: self.rig.leave(task, number))
        self.model.leave(task, number)

    @invariant()
    def same(self) -> None:
        """Owners, waiters in their order, keys, and the priority of every task."""
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
