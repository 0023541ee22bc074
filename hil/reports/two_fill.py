"""The two-fill proof: the same scenario under two fills, every output compared.

What never-written memory holds is chance on the robot.  If an output changes when nothing but this chance changes, it
depends on it: no argument about the code is needed.  Then the scenario runs once more for each finding with only its
own memory changed (the object; the cell outside the array; the words at address 0), which says what that finding alone
reaches.  What follows in a closed loop (the robot drives elsewhere) is reached, too.

Not examined one by one: writes outside an object, pointers that left their object, residue on the stack.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Final, TypeAlias

from emulator.c28x.ctypes import ArrayType, CType
from emulator.c28x.findings import Finding
from emulator.c28x.runtime import parse_fill
from emulator.c28x.tree import Variable
from emulator.image import Firmware
from hil.bench import Bench
from hil.reports.differences import FilledMemory, RunDifferences, TwoFillProof, compare
from hil.reports.outputs import RunOutputs, record
from hil.scenarios.scenario import Scenario

#: What the second run's memory holds unless told otherwise: a float of ones is not a number, an int is -1.
OTHER_FILL: Final = "ones"
#: CHOICE: what is tried, one after the other, when an object reaches nothing with the second fill: numbers of all sizes
#: and signs.  That something reaches nothing cannot be proven by trying; the report says what was tried.
FURTHER_FILLS: Final = ("random:1", "random:2")
#: CHOICE: the part of M0 RAM from address 0 on that is changed; a structure at a null pointer may have this length.
M0_WORDS: Final = 32

#: What is done to a robot before it has power, with which fill.
Change: TypeAlias = Callable[[Bench, str], None]


def prove(
    scenario: Scenario, findings: Iterable[Finding], *, against: str = OTHER_FILL,
    progress: Callable[[float], None] = lambda fraction: None,
) -> TwoFillProof:  # fmt: skip
    """Run `scenario` under its own fill and under `against`, and once for each of `findings` that a fill can touch.

    Raises ValueError for an unknown fill and for one that is the scenario's own.
    """
    check_fills(scenario.setup.fill, against)
    own = scenario.setup.fill
    # Who watches changes nothing that is put out, and costs time.
    scenario = replace(scenario, setup=replace(scenario.setup, watch=False, static=False))
    bench = scenario.bench()
    examined = dict(_changes(findings, _variables(bench.firmware)))
    bench.close()
    first = outputs(scenario)
    whole = replace(compare(first, outputs(scenario.with_fill(against))), tried=(against,))
    parts: dict[FilledMemory, RunDifferences] = {}
    for subject, change in examined.items():
        progress(len(parts) / len(examined))
        parts[subject] = _reach(scenario, first, change, [fill for fill in (against, *FURTHER_FILLS) if fill != own])
    return TwoFillProof(own, against, whole, parts)


def check_fills(own: str, against: str) -> None:
    """Raise ValueError for fills between which there is no proof: `prove` does so, too, but after a run."""
    parse_fill(against)
    if against == own:
        raise ValueError(f"the two-fill proof needs two fills: the scenario's own is {own!r}")
    if "trap" in (own, against):
        raise ValueError("the two-fill proof needs fills that run on: trap ends the run")


def _reach(scenario: Scenario, first: RunOutputs, change: Change, fills: list[str]) -> RunDifferences:
    """What differs under the first of `fills` that makes a difference."""
    for fill in fills:
        reach = compare(first, outputs(scenario, change, fill))
        if reach.anything:
            return replace(reach, tried=(fill,))
    return replace(reach, tried=tuple(fills))


def outputs(scenario: Scenario, change: Change = lambda bench, fill: None, fill: str = "") -> RunOutputs:
    """Everything that one run of `scenario` puts out; `change(bench, fill)` is done before the robot has power."""
    bench = scenario.bench()
    try:
        made = RunOutputs()
        record(made, bench.board.blocks, bench.clock)
        uart = made.uart
        bench.uart_sent.connect(lambda byte, cycles: uart.append((cycles, byte)))
        change(bench, fill)
        made.stopped = scenario.run(bench)
        made.end_cycles = bench.clock.now
        return made
    finally:
        bench.close()


def _changes(findings: Iterable[Finding], variables: Sequence[Variable]) -> Iterator[tuple[FilledMemory, Change]]:
    """For each finding that a fill can touch: what gives its memory, and no other, what a fill says."""
    for finding in findings:
        subject = FilledMemory.of(finding)
        if finding.rule == "null-dereference":
            yield subject, _at_zero
            continue
        # Through a pointer, a finding names the pointer and the object's declaration.
        variable = next((v for v in variables if str(v.declaration) == finding.declaration), None)
        if variable is None:
            continue
        path, ctype = variable.declaration.path, variable.ctype
        if finding.rule == "uninitialised":
            yield subject, partial(_holds, path)
        elif finding.rule == "index" and " is read: " in finding.message and isinstance(ctype, ArrayType):
            yield subject, partial(_planted, path, ctype.element, finding.value)


def _holds(path: str, bench: Bench, fill: str) -> None:
    """The object `path`, never written."""
    bench.firmware.runtime.fill_of[path] = parse_fill(fill)


def _planted(path: str, element: CType, index: int, bench: Bench, fill: str) -> None:
    """The cell outside an array that `path[index]` designates."""
    runtime = bench.firmware.runtime
    runtime.fill_of[path] = parse_fill(fill)
    value = runtime.fill_value(element, path)
    del runtime.fill_of[path]
    bench.firmware.plant(path, index, value)


def _at_zero(bench: Bench, fill: str) -> None:
    """M0 RAM from address 0 on."""
    memory, runtime = bench.firmware.memory, bench.firmware.runtime
    own = (runtime.fill, runtime.seed)
    runtime.fill, runtime.seed = parse_fill(fill)
    for addr in range(M0_WORDS):
        memory.words[addr] = runtime.fill_word(addr)
    runtime.fill, runtime.seed = own


def _variables(firmware: Firmware) -> list[Variable]:
    """Every object that the firmware declares."""
    modules = firmware.linked.program.modules.values()
    functions = [function for module in modules for function in module.functions]
    return [v for module in modules for v in module.variables] + [v for f in functions for v in f.locals]
