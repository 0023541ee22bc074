"""A second SYS/BIOS, written from the kernel's sources alone, for programs of `random_programs.py`.

It shares nothing with the emulator but two facts of the core: a tick is 200,001 cycles, an interrupt takes 14 and 8.
Kernel calls take no time.  A task is a generator that is resumed when it is `cur`; it yields wherever the kernel may
have switched.  Sources: `knl/Task.c`, `Semaphore.c`, `Event.c`, `Mailbox.c`, `Swi.c`, `Clock.c`,
`gates/GateMutexPri.c`, `GateMutex.c` of 6.83, and their names.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Any

from tests.emulator.sysbios.random_programs import FOREVER, Op, Program

TICK = 200_001
ENTRY, EXIT = 14, 8
CLOCK_SWI = 15
#: A step of the kernel on behalf of a thread; what it returns is the call's result.
Steps = Generator[None, None, Any]


class Record:
    """An object of the kernel: a bag of members."""

    def __init__(self, **members: Any) -> None:
        self.__dict__.update(members)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name)


class TheEnd(Exception):
    """The time of the run is over."""


class Reference:
    """Runs one program up to cycle `end`; `trace` is who did what, with which result, at which cycle."""

    def __init__(self, program: Program, end: int) -> None:
        self.end = end
        self.trace: list[tuple[int, str, Op, Any]] = []
        self.now, self.next_tick, self.ticks = 0, TICK, 0
        self.interrupts_off = self.latched = False
        self.swi_locked, self.swi_pri = False, -1
        self.swi_ready: dict[int, list[Record]] = {}
        self.locked = self.work = False
        self.ready: list[list[Record]] = [[] for _ in range(16)]
        self.missed = 0
        self.clock_queue: list[Record] = []
        self.clock_swi = Record(name="Clock", pri=CLOCK_SWI, posted=False, run=self.clock_work)
        self.sems = [Record(count=count, mode=mode, waiting=[]) for count, mode in program.semaphores]
        self.gates = [Record(free=True, owner=None, original=0, waiting=[]) for _ in range(program.gates)]
        self.mutexes = [
            Record(owner=None, sem=Record(count=1, mode=0, waiting=[])) for _ in range(program.mutexes)
        ]  # fmt: skip
        self.events = [Record(posted=0, waiting=[]) for _ in program.tasks]
        self.boxes = [
            Record(full=Record(count=0, mode=0, waiting=[]), places=Record(count=n, mode=0, waiting=[]), letters=[])
            for n in program.mailboxes
        ]
        self.swis = [
            Record(name=f"swi{i}", pri=pri, posted=False, run=lambda i=i, ops=ops: self.body(f"swi{i}", ops))
            for i, (pri, ops) in enumerate(program.swis)
        ]
        for i, (timeout, period, ops) in enumerate(program.clocks):
            self.clock_start(timeout, period, lambda i=i, ops=ops: self.body(f"clock{i}", ops))
        self.idle = Record(name="idle", pri=0, left=0, elem=None)
        self.tasks = []
        for i, (pri, ops) in enumerate(program.tasks):
            task = Record(name=f"task{i}", pri=pri, left=0, elem=None, keys={}, steps=None)
            task.steps = self.life(task, ops)
            self.tasks.append(task)
        for task in (*self.tasks, self.idle):
            task.ready = True
            self.ready[task.pri].append(task)
        self.cur_q = max(p for p in range(16) if self.ready[p])
        self.cur = self.ready[self.cur_q][0]

    def run(self) -> list[tuple[int, str, Op, Any]]:
        """The whole trace."""
        try:
            while True:
                task = self.cur
                if task is self.idle:
                    self.spend(Record(left=TICK))
                elif task.left:
                    self.spend(task)
                else:
                    next(task.steps)
        except TheEnd:
            return self.trace

    def life(self, task: Record, ops: list[Op]) -> Iterator[None]:
        for op in ops:
            result = yield from self.do(op, task)
            self.trace.append((self.now, task.name, op, result))
        key = self.disable()
        self.block(task)
        self.restore(key)
        while True:
            yield

    # Time

    def spend(self, thread: Record) -> None:
        step = min(thread.left, self.next_tick - self.now)
        if self.now + step >= self.end:
            raise TheEnd
        thread.left -= step
        self.now += step
        if self.now == self.next_tick:
            self.tick()

    def tick(self) -> None:
        self.next_tick += TICK
        if self.interrupts_off:
            self.latched = True
        else:
            self.interrupt()

    def interrupt(self) -> None:
        self.now += ENTRY
        task_key, swi_key = self.locked, self.swi_locked
        self.locked = self.swi_locked = True
        self.ticks += 1
        if self.clock_queue:
            self.missed += 1
            self.swi_post(self.clock_swi)
        self.now += EXIT
        if not swi_key:
            self.swi_loop()
            self.swi_locked = False
        if not task_key:
            self.restore(False)

    # Swi

    def swi_post(self, swi: Record) -> None:
        if swi.posted:
            return
        swi.posted = True
        key, self.swi_locked = self.swi_locked, True
        self.swi_queue(swi)
        if not key:
            self.swi_schedule()

    def swi_queue(self, swi: Record) -> None:
        self.swi_ready.setdefault(swi.pri, []).append(swi)

    def swi_schedule(self) -> None:
        if max(self.swi_ready, default=-1) > self.swi_pri:
            key = self.disable()
            self.swi_loop()
            self.swi_locked = False
            self.restore(key)
        self.swi_locked = False

    def swi_loop(self) -> None:
        floor = self.swi_pri
        while (top := max(self.swi_ready, default=-1)) > floor:
            swi = self.swi_ready[top].pop(0)
            if not self.swi_ready[top]:
                del self.swi_ready[top]
            self.swi_pri, swi.posted, self.swi_locked = top, False, False
            swi.run()
            self.swi_locked, self.swi_pri = True, floor

    def body(self, name: str, ops: list[Op]) -> None:
        """What a Swi or Clock function does: nothing that blocks."""
        thread = Record(name=name, left=0)
        for op in ops:
            steps = self.do(op, thread)
            result = None
            while True:
                try:
                    next(steps)
                except StopIteration as stop:
                    result = stop.value
                    break
                while thread.left:
                    self.spend(thread)
            self.trace.append((self.now, name, op, result))

    # Clock

    def clock_start(self, timeout: int, period: int, function: Any) -> Record:
        clock = Record(due=self.ticks + timeout, period=period, function=function, active=True)
        self.clock_queue.append(clock)
        return clock

    def clock_work(self) -> None:
        count, self.missed = self.missed, 0
        compare = self.ticks - count
        for _ in range(count):
            compare += 1
            for clock in self.clock_queue:  # what is appended meanwhile is seen too, as in a linked list
                if clock.active and clock.due == compare:
                    clock.active = bool(clock.period)
                    clock.due += clock.period
                    clock.function()

    # Task

    def disable(self) -> bool:
        key, self.locked = self.locked, True
        return key

    def restore(self, key: bool) -> None:
        if not key:
            if self.work and not self.swi_locked:
                self.schedule()
            self.locked = False

    def schedule(self) -> None:
        self.work = False
        top = max(p for p in range(16) if self.ready[p])
        if top > self.cur_q:
            self.cur_q, self.cur = top, self.ready[top][0]

    def block(self, task: Record) -> None:
        self.ready[task.pri].remove(task)
        if task is self.cur:
            self.cur_q = -1
        task.ready, self.work = False, True

    def unblock(self, task: Record) -> None:
        self.ready[task.pri].append(task)
        task.ready = self.work = True

    def set_pri(self, task: Record, pri: int) -> int:
        key, old = self.disable(), task.pri
        if old != pri:
            if task.ready:
                self.ready[old].remove(task)
                if task is self.cur:
                    self.cur_q = pri
                    self.ready[pri].insert(0, task)
                else:
                    self.ready[pri].append(task)
            task.pri, self.work = pri, True
        self.restore(key)
        return int(old)

    # What waits: an element in a queue, perhaps with a Clock

    def wait(self, task: Record, queue: list[Record], timeout: int, elem: Record) -> Steps:
        """From Task_disable on; the element stands in its queue already.  The state in which it was woken."""
        elem.task, elem.state, elem.clock = task, "waiting", None
        key = self.disable()
        self.block(task)
        if timeout != FOREVER:
            elem.clock = self.clock_start(timeout, 0, lambda: self.expire(elem, queue))
        self.restore(key)
        yield
        if elem.clock is not None:
            self.clock_queue.remove(elem.clock)
        return elem.state

    def expire(self, elem: Record, queue: list[Record]) -> None:
        if elem.state == "waiting":
            queue.remove(elem)
            elem.state = "timeout"
            self.unblock(elem.task)

    def wake(self, elem: Record) -> None:
        elem.state = "posted"
        if elem.clock is not None:
            elem.clock.active = False
        self.unblock(elem.task)

    # Semaphore

    def pend(self, thread: Record, sem: Record, timeout: int) -> Steps:
        if sem.count:
            sem.count -= 1
            return 1
        if timeout == 0:
            return 0
        elem = Record(task=thread)
        place = len(sem.waiting)
        if sem.mode & 2:
            place = self.by_priority(sem.waiting, thread.pri)
        sem.waiting.insert(place, elem)
        state = yield from self.wait(thread, sem.waiting, timeout, elem)
        return int(state != "timeout")

    def by_priority(self, waiting: list[Record], pri: int) -> int:
        return next((i for i, elem in enumerate(waiting) if pri > elem.task.pri), len(waiting))

    def post(self, sem: Record) -> Steps:
        key = self.disable()
        if sem.waiting:
            self.wake(sem.waiting.pop(0))
        else:
            sem.count = 1 if sem.mode & 1 else sem.count + 1
        self.restore(key)
        yield

    # Event

    def match(self, event: Record, and_mask: int, or_mask: int) -> int:
        matching = or_mask & event.posted
        if and_mask & event.posted == and_mask:
            matching |= and_mask
        event.posted &= ~matching
        return int(matching)

    def event_pend(self, thread: Record, event: Record, and_mask: int, or_mask: int, timeout: int) -> Steps:
        matching = self.match(event, and_mask, or_mask)
        if matching or timeout == 0:
            return matching
        elem = Record(and_mask=and_mask, or_mask=or_mask, matching=0)
        event.waiting.append(elem)
        state = yield from self.wait(thread, event.waiting, timeout, elem)
        return 0 if state == "timeout" else elem.matching

    def event_post(self, event: Record, mask: int) -> Steps:
        event.posted |= mask
        if event.waiting:
            key = self.disable()
            elem = event.waiting[0]
            elem.matching = self.match(event, elem.and_mask, elem.or_mask)
            if elem.matching:
                self.wake(event.waiting.pop(0))
            self.restore(key)
        yield

    # Mailbox

    def mailbox_post(self, thread: Record, box: Record, letter: int, timeout: int) -> Steps:
        if not (yield from self.pend(thread, box.places, timeout)):
            return 0
        key = self.disable()
        box.letters.append(letter)
        yield from self.post(box.full)
        self.restore(key)
        yield
        return 1

    def mailbox_pend(self, thread: Record, box: Record, timeout: int) -> Steps:
        if not (yield from self.pend(thread, box.full, timeout)):
            return None
        letter = box.letters.pop(0)
        yield from self.post(box.places)
        return letter

    # Gates

    def enter(self, task: Record, gate: Record) -> Steps:
        if gate.free:
            gate.free, gate.owner, gate.original = False, task, task.pri
            return 0
        if gate.owner is task:
            return 1
        key = self.disable()
        self.block(task)
        gate.waiting.insert(self.by_priority(gate.waiting, task.pri), Record(task=task))
        if task.pri > gate.owner.pri:
            self.set_pri(gate.owner, task.pri)
        self.restore(key)
        yield
        return 0

    def leave(self, task: Record, gate: Record, inner: int) -> Steps:
        if inner:
            return
        key = self.disable()
        if gate.original < task.pri:
            self.set_pri(task, gate.original)
        if gate.waiting:
            gate.owner = gate.waiting.pop(0).task
            gate.original = gate.owner.pri
            self.unblock(gate.owner)
        else:
            gate.free = True
        self.restore(key)
        yield

    def mutex_enter(self, task: Record, mutex: Record) -> Steps:
        if mutex.owner is task:
            return 1
        yield from self.pend(task, mutex.sem, FOREVER)
        mutex.owner = task
        return 0

    def mutex_leave(self, mutex: Record, inner: int) -> Steps:
        if not inner:
            mutex.owner = None
            yield from self.post(mutex.sem)

    # What a program says

    def do(self, op: Op, thread: Record) -> Steps:
        match op:
            case ("work", cycles):
                thread.left = cycles
                yield
            case ("pend", i, timeout):
                return (yield from self.pend(thread, self.sems[i], timeout))
            case ("post", i):
                yield from self.post(self.sems[i])
            case ("event pend", i, and_mask, or_mask, timeout):
                return (yield from self.event_pend(thread, self.events[i], and_mask, or_mask, timeout))
            case ("event post", i, mask):
                yield from self.event_post(self.events[i], mask)
            case ("mailbox post", i, letter, timeout):
                return (yield from self.mailbox_post(thread, self.boxes[i], letter, timeout))
            case ("mailbox pend", i, timeout):
                return (yield from self.mailbox_pend(thread, self.boxes[i], timeout))
            case ("enter", i):
                key = yield from self.enter(thread, self.gates[i])
                thread.keys.setdefault(("gate", i), []).append(key)
                return key
            case ("leave", i):
                yield from self.leave(thread, self.gates[i], thread.keys["gate", i].pop())
            case ("mutex enter", i):
                key = yield from self.mutex_enter(thread, self.mutexes[i])
                thread.keys.setdefault(("mutex", i), []).append(key)
                return key
            case ("mutex leave", i):
                yield from self.mutex_leave(self.mutexes[i], thread.keys["mutex", i].pop())
            case ("swi post", i):
                self.swi_post(self.swis[i])
                yield
            case ("set priority", i, pri):
                old = self.set_pri(self.tasks[i], pri)
                yield
                return old
            case ("sleep", ticks):
                if ticks:
                    elem = Record(task=thread)
                    yield from self.wait(thread, [elem], ticks, elem)
            case ("yield",):
                key = self.disable()
                if self.cur_q >= 0:
                    self.ready[self.cur_q].append(self.ready[self.cur_q].pop(0))
                self.cur_q, self.work = -1, True
                self.restore(key)
                yield
            case ("task disable",):
                thread.keys.setdefault("task", []).append(self.disable())
            case ("task restore",):
                self.restore(thread.keys["task"].pop())
                yield
            case ("swi disable",):
                thread.keys.setdefault("swi", []).append(self.swi_locked)
                self.swi_locked = True
            case ("swi restore",):
                if not thread.keys["swi"].pop():
                    if self.swi_ready:
                        self.swi_schedule()
                    self.swi_locked = False
                    self.restore(self.disable())
                yield
            case ("hwi disable",):
                thread.keys.setdefault("hwi", []).append(self.interrupts_off)
                self.interrupts_off = True
            case ("hwi restore",):
                self.interrupts_off = thread.keys["hwi"].pop()
                if self.latched and not self.interrupts_off:
                    self.latched = False
                    self.interrupt()
                yield
        return None
