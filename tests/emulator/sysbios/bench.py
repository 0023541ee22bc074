"""A kernel on a clock and a CPU, without a board: a timer that raises line 14, and pointers for structures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from emulator.c28x.ctypes import FLOAT
from emulator.c28x.findings import Findings
from emulator.c28x.sites import Place
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.sysbios.kernel import Kernel
from emulator.sysbios.timer import TickSource
from emulator.trace import Trace

MS = 200_000
#: PRD is 200,000 and the timer counts one more.
TICK = 200_001
#: BIOS_WAIT_FOREVER
FOREVER = 0xFFFF


class Cell:
    """A pointer to one scalar, with no memory behind it."""

    memory = None

    def __init__(self, values: dict[str, Any], name: str) -> None:
        self.values = values
        self.name = name

    def load(self) -> Any:
        return self.values[self.name]

    def store(self, value: Any) -> None:
        self.values[self.name] = value

    write = store


class Struct:
    """A pointer to a structure."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}

    def member(self, name: str) -> Cell:
        return Cell(self.values, name)


class Buffer:
    """A pointer into an array of char."""

    def __init__(self, words: list[int], at: int = 0, addr: int = 0x9000) -> None:
        self.words = words
        self.start = at
        self.addr = addr + at

    def at(self, index: int) -> Buffer:
        return Buffer(self.words, self.start + index, self.addr - self.start)

    def load(self) -> int:
        return self.words[self.start]

    read = load

    def store(self, value: int) -> None:
        self.words[self.start] = value

    write = store

    @property
    def text(self) -> str:
        return "".join(chr(w) for w in self.words[self.start : self.words.index(0, self.start)])


class Ctype:
    """A C type, as far as variable arguments need it."""

    def __init__(self, words: int) -> None:
        self.words = words


INT = Ctype(1)
LONG = Ctype(2)
DOUBLE = FLOAT
POINTER = Ctype(2)


def string(text: str) -> Buffer:
    return Buffer([ord(c) for c in text] + [0])


class Pie:
    """What the kernel asks of the PIE."""

    def __init__(self, cpu: Cpu) -> None:
        self.cpu = cpu
        self.vectors: dict[int, Callable[[], None] | None] = {}
        self.enabled: set[int] = set()
        self.acknowledged: list[int] = []

    def set_vector(self, number: int, handler: Callable[[], None] | None, _begins: Place | None = None) -> None:
        if number < 32:  # INT13 and INT14 bypass the groups
            assert handler is not None
            self.cpu.connect(number, handler)
        else:
            self.vectors[number] = handler

    def enable(self, number: int, on: bool) -> bool:
        was = number in self.enabled
        (self.enabled.add if on else self.enabled.discard)(number)
        return was

    def acknowledge(self, group: int) -> None:
        self.acknowledged.append(group)

    def request(self, number: int) -> None:
        """A peripheral's interrupt: the vector is fetched when the core takes the group's line."""
        line = (number - 32 >> 3) + 1

        def fetch() -> None:
            handler = self.vectors[number]
            assert handler is not None
            handler()

        self.cpu.connect(line, fetch)
        self.cpu.raise_line(line)


class Bench:
    """Kernel, clock and trace of a test.  Kernel costs are 0 unless `cost_scale` is given."""

    def __init__(self, *, cost_scale: float = 0.0, **switches: Any) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.trace = Trace(self.clock)
        self.pie = Pie(self.cpu)
        self.log: list[Any] = []
        self.events: list[tuple[int, str, str]] = []
        self.period = 0
        self.ticking = True
        self.kernel = Kernel(
            self.clock, self.cpu, self.findings, self.trace,
            pie_set_vector=self.pie.set_vector, pie_enable=self.pie.enable, pie_acknowledge=self.pie.acknowledge,
            start_tick=self.start_tick, cost_scale=cost_scale, **switches,
        )  # fmt: skip

    def start_tick(self, period_register: int, handler: Callable[[], None]) -> TickSource | None:
        self.period = period_register + 1
        self.started = self.clock.now
        if self.ticking:
            self.clock.after(self.period, self._underflow)
        return None

    def _underflow(self) -> None:
        self.clock.after(self.period, self._underflow)
        self.cpu.raise_line(14)

    def tick_time(self, n: int) -> int:
        """Cycle of tick `n`."""
        return self.started + n * self.period

    def listen(self) -> None:
        self.trace.listen(lambda cycles, kind, name: self.events.append((cycles, kind, name)))

    def kinds(self, *kinds: str) -> list[tuple[str, str]]:
        return [(kind, name) for _, kind, name in self.events if kind in kinds]

    def note(self, what: Any) -> None:
        self.log.append(what)

    def task(self, function: Callable[..., Any], priority: int, **members: Any) -> Any:
        params = Struct()
        self.kernel.Task_Params_init(params)
        params.values.update(priority=priority, **members)
        return self.kernel.Task_create(function, params, None)

    def timer(
        self, function: Callable[..., Any], timeout: int, *, period: int = 0, start: bool = True, arg: int = 0
    ) -> Any:
        params = Struct()
        self.kernel.Clock_Params_init(params)
        params.values.update(period=period, startFlag=int(start), arg=arg)
        return self.kernel.Clock_create(function, timeout, params, None)

    def swi(self, function: Callable[..., Any], priority: int, **members: Any) -> Any:
        params = Struct()
        self.kernel.Swi_Params_init(params)
        params.values.update(priority=priority, **members)
        return self.kernel.Swi_create(function, params, None)

    def semaphore(self, count: int = 0, mode: int = 0) -> Any:
        params = Struct()
        self.kernel.Semaphore_Params_init(params)
        params.values.update(mode=mode)
        return self.kernel.Semaphore_create(count, params, None)

    def boot(self, *actions: Callable[[], Any]) -> None:
        """main(): the actions, then BIOS_start."""

        def main() -> None:
            for action in actions:
                action()
            self.kernel.BIOS_start()

        self.kernel.start(main)

    def run_ms(self, milliseconds: float) -> None:
        self.kernel.run_until(round(milliseconds * MS))

    def run_ticks(self, ticks: int) -> None:
        """Until a while after tick `ticks`: its work is done, the next tick is not there yet."""
        self.kernel.run_until(self.tick_time(ticks) + TICK // 2)


def logger(b: Bench, name: str, *steps: Any) -> Any:
    """A task function that notes its name with each step's number, after having run the step."""

    def function(_a: int, _b: int) -> None:
        for i, step in enumerate(steps):
            step()
            b.note(f"{name}{i}")

    function.__name__ = name
    return function


def nothing() -> None:
    """A step without effect."""
