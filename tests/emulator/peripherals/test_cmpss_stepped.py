"""A comparator subsystem with steady inputs against one that is stepped cycle by cycle, after the manual's figures."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from random import Random

from hypothesis import given
from hypothesis import strategies as st

from emulator.chip import Chip
from emulator.registers.core import ALL

LSB_V = 3.3 / 4096
CONTROL = 1 << 15


@dataclass
class SteppedHalf:
    """Comparator, filter and latch of one side."""

    shift: int
    raw: int = 0
    level: int = 0
    fifo: list[int] = field(default_factory=lambda: [0] * 32)
    window: int = 1
    threshold: int = 1
    period: int = 1
    since: int = 0
    output: int = 0
    latched: int = 0

    def compare(self, code: float, dac: int, hysteresis: int, control: int) -> None:
        if not control & CONTROL:
            self.raw = self.level = 0
            return
        self.raw = int(code > (dac - 12 * min(hysteresis, 4) if self.raw else dac))
        self.level = self.raw ^ (control >> self.shift + 1 & 1)

    def sample(self, cycle: int) -> None:
        if cycle > self.since and (cycle - self.since) % self.period == 0:
            self.fifo = [*self.fifo[1:], self.level]
            self.vote()

    def vote(self) -> None:
        if self.fifo[-self.window :].count(1 - self.output) >= self.threshold:
            self.output ^= 1
        self.latched |= self.output

    def outputs(self, control: int) -> tuple[int, int]:
        control >>= self.shift
        latched = self.latched | self.level & control >> 6
        choices = self.level, self.level, self.output, latched
        return choices[control >> 2 & 3], choices[control >> 4 & 3]


@dataclass(frozen=True)
class Step:
    wait: int
    name: str
    value: int


def filters(name: str) -> st.SearchStrategy[Step]:
    """A proper window and threshold, sometimes with FILINIT."""

    def step(wait: int, window: int, more: int, init: int) -> Step:
        threshold = min(window // 2 + 1 + more, window)
        return Step(wait, name, init << 15 | threshold - 1 << 9 | window - 1 << 4)

    return st.builds(step, st.integers(1, 40), st.integers(1, 32), st.integers(0, 15), st.integers(0, 1))


waits = st.integers(1, 40)
#: Around the codes that the DACs get, so that hysteresis matters.
codes = st.sampled_from([1_900, 1_960, 1_990, 2_000, 2_010, 2_100])
steps = st.lists(
    st.one_of(
        st.builds(Step, waits, st.just("volts"), codes),
        st.builds(Step, waits, st.just("volts"), codes),
        st.builds(Step, waits, st.sampled_from(["DACHVALS", "DACLVALS"]), codes),
        st.builds(Step, waits, st.just("COMPCTL"), st.integers(0, 0x7FFF).map(lambda word: CONTROL | word & 0x7E7E)),
        st.builds(Step, waits, st.just("COMPCTL"), st.integers(0, 0x7FFF).map(lambda word: word & 0x7E7E)),
        st.builds(Step, waits, st.just("COMPHYSCTL"), st.integers(0, 7)),
        st.builds(Step, waits, st.just("COMPSTSCLR"), st.sampled_from([1 << 1, 1 << 9, 1 << 1 | 1 << 9])),
        st.builds(Step, waits, st.sampled_from(["CTRIPHFILCLKCTL", "CTRIPLFILCLKCTL"]), st.integers(0, 6)),
        filters("CTRIPHFILCTL"), filters("CTRIPLFILCTL"),
    ),
    max_size=12,
)  # fmt: skip


class Stepped:
    """Both halves, and what is set."""

    def __init__(self) -> None:
        self.high, self.low = SteppedHalf(0), SteppedHalf(8)
        self.registers = {"COMPCTL": 0, "COMPHYSCTL": 0, "DACHVALS": 0, "DACLVALS": 0}
        self.code = 0.0
        self.cycle = 0

    def compare(self) -> None:
        set_to = self.registers
        for half, dac in ((self.high, "DACHVALS"), (self.low, "DACLVALS")):
            half.compare(self.code, set_to[dac], set_to["COMPHYSCTL"], set_to["COMPCTL"])

    def step(self, volts: float | None) -> None:
        self.cycle += 1
        if volts is not None:
            self.code = volts
            self.compare()
        for half in (self.high, self.low):
            half.sample(self.cycle)

    def write(self, name: str, value: int) -> None:
        half = self.high if "H" in name[:6] else self.low
        if name == "COMPSTSCLR":
            for half, bit in ((self.high, 1), (self.low, 9)):
                if value >> bit & 1:
                    half.latched = half.output
        elif name.endswith("FILCLKCTL"):
            if half.period != value + 1:
                half.period, half.since = value + 1, self.cycle
        elif name.endswith("FILCTL"):
            half.window, half.threshold = 1 + (value >> 4 & 31), 1 + (value >> 9 & 31)
            if value >> 15:
                half.fifo = [half.level] * 32
                half.vote()
        else:
            self.registers[name] = value
        self.compare()

    def outputs(self) -> tuple[int, ...]:
        control = self.registers["COMPCTL"]
        return (*self.high.outputs(control), *self.low.outputs(control))

    def status(self) -> int:
        return sum((half.output | half.latched << 1) << half.shift for half in (self.high, self.low))


def put(chip: Chip, volts: float) -> None:
    chip.analog["A"][2].follow("test", lambda _cycles: volts, steady=True)


@given(changes=steps)
def test_outputs_and_status_equal_the_stepped_ones(changes: list[Step]) -> None:
    chip, model = Chip(rng=Random(0), vdda_v=3.3), Stepped()
    chip.cpu.eallow = True
    chip.register("CpuSysRegs", "PCLKCR14").write(1, ALL)
    module = chip.cmpss[1]
    wires = [wire for half in (module.high, module.low) for wire in (half.trip, half.trip_out)]
    levels = [0, 0, 0, 0]
    #: Cycle -> the levels at its end, where they are other ones than before.
    seen: dict[int, tuple[int, ...]] = {}
    expected: dict[int, tuple[int, ...]] = {}
    last: tuple[int, ...] = (0, 0, 0, 0)

    def hear(i: int, level: int) -> None:
        levels[i] = level
        seen[chip.clock.now] = tuple(levels)

    def note() -> None:
        expected[model.cycle] = model.outputs()

    for i, wire in enumerate(wires):
        wire.changed.connect(partial(hear, i))
    for change in [*changes, Step(300, "end", 0)]:
        for n in range(change.wait):
            # Half a code above, so that no voltage is a threshold.
            here = n == change.wait - 1 and change.name == "volts"
            model.step(change.value + 0.5 if here else None)
            note()
        if change.name == "volts":
            # The wire steps in the cycle in which the filters sample it.
            chip.clock.schedule(model.cycle, partial(put, chip, (change.value + 0.5) * LSB_V), priority=-1)
        chip.clock.advance_to(model.cycle)
        if change.name not in ("volts", "end"):
            model.write(change.name, change.value)
            note()
            chip.register("Cmpss1Regs", change.name).write(change.value, ALL)
        assert chip.register("Cmpss1Regs", "COMPSTS").read() == model.status()
    for cycle in sorted(expected):
        if expected[cycle] == last:
            del expected[cycle]
        else:
            last = expected[cycle]
    # Of what changed back within a cycle the stepped one knows nothing.
    last = (0, 0, 0, 0)
    for cycle in sorted(seen):
        if seen[cycle] == last:
            del seen[cycle]
        else:
            last = seen[cycle]
    assert seen == expected
