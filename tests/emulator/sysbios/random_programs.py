"""Programs of two to six tasks with Swis and Clocks, made at random, and their run on the emulated kernel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Any

from emulator.c28x.ctypes import INT
from emulator.c28x.memory import Memory, Pointer
from emulator.c28x.tree import Declaration
from tests.emulator.sysbios.bench import Bench

FOREVER = 0xFFFF
#: What a thread does: a word and its operands.
Op = tuple[Any, ...]


@dataclass(frozen=True)
class Program:
    """Objects by number, and what each thread does.  Task i alone waits for event i."""

    #: Priority and what it does.
    tasks: list[tuple[int, list[Op]]]
    swis: list[tuple[int, list[Op]]]
    #: Timeout, period, and what it does.
    clocks: list[tuple[int, int, list[Op]]]
    #: Count and mode.
    semaphores: list[tuple[int, int]]
    #: Places of each.
    mailboxes: list[int]
    gates: int = 2
    mutexes: int = 1


def make(seed: int) -> Program:
    """The program of a seed."""
    r = Random(seed)
    tasks, swis = r.randint(2, 6), r.randint(0, 3)
    made = _Maker(r, tasks, swis, r.choice((1, 1, 2)), r.choice((0, 1, 1, 2)))
    return Program(
        tasks=[(r.randint(1, 5), made.task(i)) for i in range(tasks)],
        # A Swi posts only those after it: none posts itself for ever.
        swis=[(r.choice((2, 2, 9)), made.interrupt(i + 1)) for i in range(swis)],
        # One Clock releases whoever waits, so that most programs go on to their end.
        clocks=[
            (r.randint(1, 5), r.choice((0, 2, 3, 5)), made.interrupt(0)) for _ in range(r.randint(0, 2))
        ] + [(2, r.choice((2, 3)), [("post", i) for i in range(made.semaphores)] + made.interrupt(0))],
        semaphores=[(r.choice((0, 0, 1, 2)), r.randint(0, 3)) for _ in range(made.semaphores)],
        mailboxes=[r.randint(1, 2) for _ in range(made.mailboxes)],
    )


class _Maker:
    def __init__(self, r: Random, tasks: int, swis: int, semaphores: int, mailboxes: int) -> None:
        self.r = r
        self.tasks, self.swis, self.semaphores, self.mailboxes = tasks, swis, semaphores, mailboxes
        # Not everything in every program: few kinds of waits meet each other more often.
        waits = ["pend", "event pend"] + ["mailbox post", "mailbox pend"] * bool(mailboxes)
        self.waits = r.sample(waits, r.randint(1, len(waits)))
        more = (["gate"] * 3, ["gate", "gate", "other"], ["other"], ["disabled"], ["gate", "other", "disabled"])
        self.does = ["quick", "wait", "wait", *r.choice(more)]

    def timeout(self) -> int:
        return self.r.choice((0, 1, 2, 3, FOREVER, FOREVER))

    def mask(self) -> int:
        return self.r.choice((0, 1, 2, 3, 4, 5, 6))

    def quick(self, first_swi: int = 0) -> Op:
        """What never waits."""
        r = self.r
        kinds = ["work", "post", "post", "event post", "event post", "pend"]
        kinds += ["swi post"] * (first_swi < self.swis) + ["mailbox post", "mailbox pend"] * bool(self.mailboxes)
        match r.choice(kinds):
            case "work":
                return ("work", r.choice((1_000, 40_000, 90_000, 150_000, 260_000, 500_000)))
            case "post":
                return ("post", r.randrange(self.semaphores))
            case "event post":
                return ("event post", r.randrange(self.tasks), r.choice((1, 2, 4, 7)))
            case "pend":
                return ("pend", r.randrange(self.semaphores), 0)
            case "swi post":
                return ("swi post", r.randrange(first_swi, self.swis))
            case "mailbox post":
                return ("mailbox post", r.randrange(self.mailboxes), r.randrange(100), 0)
            case _:
                return ("mailbox pend", r.randrange(self.mailboxes), 0)

    def interrupt(self, first_swi: int) -> list[Op]:
        return [self.quick(first_swi) for _ in range(self.r.randint(1, 4))]

    def task(self, number: int) -> list[Op]:
        """Gates are left by whoever entered them, innermost first or not; what is disabled is restored."""
        r = self.r
        ops: list[Op] = []
        held: list[Op] = []
        for _ in range(r.randint(4, 14)):
            match r.choice(self.does):
                case "quick":
                    ops.append(self.quick())
                case "wait":
                    ops.append(self.wait(number))
                case "gate":
                    if held and r.random() < 0.5:
                        ops.append(held.pop(r.choice((-1, -1, 0))))
                    else:
                        kind, i = r.choice((("", 0), ("", 1), ("mutex ", 0)))
                        ops.append((f"{kind}enter", i))
                        held.append((f"{kind}leave", i))
                case "other":
                    ops.append(r.choice((
                        ("yield",), ("sleep", r.randint(0, 3)),
                        ("set priority", r.randrange(self.tasks), r.randint(1, 6)),
                    )))  # fmt: skip
                case _:
                    ops += self.disabled()
        return ops + (held[::-1] if r.random() < 0.8 else [])

    def wait(self, number: int) -> Op:
        r = self.r
        match r.choice(self.waits):
            case "pend":
                return ("pend", r.randrange(self.semaphores), self.timeout())
            case "event pend":
                masks = (self.mask(), self.mask())
                return ("event pend", number, *(masks if any(masks) else (1, 2)), self.timeout())
            case "mailbox post":
                return ("mailbox post", r.randrange(self.mailboxes), r.randrange(100), self.timeout())
            case _:
                return ("mailbox pend", r.randrange(self.mailboxes), self.timeout())

    def disabled(self) -> list[Op]:
        r = self.r
        what = r.choice(("task", "swi", "hwi"))
        if what == "hwi":  # calls that switch enable interrupts again: only time passes
            inside: list[Op] = [("work", r.choice((90_000, 260_000)))]
        else:
            inside = [self.quick() for _ in range(r.randint(1, 3))]
            if r.random() < 0.3:
                inside.append(("set priority", r.randrange(self.tasks), r.randint(1, 6)))
            if what == "task" and r.random() < 0.3:
                inside.append(("yield",))
            if r.random() < 0.3:
                inside = [(f"{what} disable",), *inside, (f"{what} restore",)]
        return [(f"{what} disable",), *inside, (f"{what} restore",)]


class Emulated:
    """A program on the kernel of the project."""

    def __init__(self, program: Program) -> None:
        self.memory = Memory()
        self.bench = b = Bench(memory=self.memory)
        k = self.kernel = b.kernel
        self.trace: list[tuple[int, str, Op, Any]] = []
        self.semaphores = [b.semaphore(count, mode) for count, mode in program.semaphores]
        self.gates = [k.GateMutexPri_create(None, None) for _ in range(program.gates)]
        self.mutexes = [k.GateMutex_create(None, None) for _ in range(program.mutexes)]
        self.events = [k.Event_create(None, None) for _ in program.tasks]
        self.mailboxes = [k.Mailbox_create(1, places, None, None) for places in program.mailboxes]
        self.swis = [b.swi(self.thread(f"swi{i}", ops), pri) for i, (pri, ops) in enumerate(program.swis)]
        for i, (timeout, period, ops) in enumerate(program.clocks):
            b.timer(self.thread(f"clock{i}", ops), timeout, period=period)
        self.tasks = [b.task(self.thread(f"task{i}", ops), pri) for i, (pri, ops) in enumerate(program.tasks)]

    def run(self, ticks: int) -> list[tuple[int, str, Op, Any]]:
        """The trace until a while after tick `ticks`."""
        self.bench.boot()
        self.bench.run_ticks(ticks)
        self.kernel.shutdown()
        return self.trace

    def thread(self, name: str, ops: list[Op]) -> Callable[[], None]:
        """A function that does what is said and notes it."""

        def function() -> None:
            keys: dict[Any, list[int]] = {}
            place = Pointer(self.memory, self.memory.place(Declaration(name, INT, "", "", 0)), 0, INT)
            for op in ops:
                result = self.do(op, keys, place)
                self.trace.append((self.bench.clock.now, name, op, result))

        function.__name__ = name
        return function

    def do(self, op: Op, keys: dict[Any, list[int]], place: Pointer) -> Any:
        k = self.kernel
        match op:
            case ("work", cycles):
                self.bench.clock.delay(cycles)
            case ("pend", i, timeout):
                return int(k.Semaphore_pend(self.semaphores[i], timeout) != 0)
            case ("post", i):
                k.Semaphore_post(self.semaphores[i])
            case ("event pend", i, and_mask, or_mask, timeout):
                return k.Event_pend(self.events[i], and_mask, or_mask, timeout)
            case ("event post", i, mask):
                k.Event_post(self.events[i], mask)
            case ("mailbox post", i, letter, timeout):
                place.store(letter)
                return k.Mailbox_post(self.mailboxes[i], place, timeout)
            case ("mailbox pend", i, timeout):
                return place.load() if k.Mailbox_pend(self.mailboxes[i], place, timeout) else None
            case ("enter", i):
                keys.setdefault(("gate", i), []).append(k.GateMutexPri_enter(self.gates[i]))
                return keys["gate", i][-1]
            case ("leave", i):
                k.GateMutexPri_leave(self.gates[i], keys["gate", i].pop())
            case ("mutex enter", i):
                keys.setdefault(("mutex", i), []).append(k.GateMutex_enter(self.mutexes[i]))
                return keys["mutex", i][-1]
            case ("mutex leave", i):
                k.GateMutex_leave(self.mutexes[i], keys["mutex", i].pop())
            case ("swi post", i):
                k.Swi_post(self.swis[i])
            case ("set priority", i, pri):
                return k.Task_setPri(self.tasks[i], pri)
            case ("sleep", ticks):
                k.Task_sleep(ticks)
            case ("yield",):
                k.Task_yield()
            case (("task disable" | "swi disable" | "hwi disable") as what,):
                module = what.split()[0].capitalize()
                keys.setdefault(module, []).append(getattr(k, f"{module}_disable")())
            case (("task restore" | "swi restore" | "hwi restore") as what,):
                module = what.split()[0].capitalize()
                getattr(k, f"{module}_restore")(keys[module].pop())
            case _:
                raise ValueError(f"no such operation: {op}")
        return None
