"""Turns of a loop that change nothing are skipped: the same cycle, the same objects and findings as one by one."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.c28x.coverage import Coverage
from emulator.c28x.runtime import EndlessPoll
from tests.emulator.c28x.readers.c.workshop import CWorkshop
from tests.emulator.c28x.workshop import Workshop

#: Each function ends after eight changes of Ticks.
SOURCE = """
Ticks: volatile[uint16] = 0
Done: uint16 = 0
Out: uint16 = 0
Turns: uint32 = 0
# drv.c: cost
def cost(n: uint16) -> uint16:
    return n * 3 + 1
# drv.c: tested
def tested() -> uint16:
    before: uint16 = 0
    while 1:
        now: uint16 = Ticks
        if uint16(now - before) >= 2:
            before += 2
            Done += cost(now)
        if before == 8:
            return now
# drv.c: continued
def continued() -> uint16:
    last: uint16 = 0
    now: uint16
    while 1:
        now = Ticks
        if now == last:
            continue
        last = now
        Done += cost(last)
        if last == 8:
            return Done
# drv.c: waited
def waited() -> uint16:
    seen: uint16 = 0
    now: uint16
    while seen < 8:
        while 1:
            now = Ticks
            if now != seen:
                break
        seen = now
        Done += cost(seen)
    return Done
# drv.c: emptied
def emptied() -> uint16:
    while 1:
        while Out != Ticks:
            Out += 1
            Done += cost(Out)
        if Out == 8:
            return Done
# drv.c: chosen
def chosen() -> uint16:
    level: uint16 = 0
    while Ticks < 8:
        if Ticks < 4:
            level = 1
        else:
            level = 2
    return level
# drv.c: counted
def counted() -> uint32:
    turns: uint32 = 0
    while Ticks < 8:
        turns += 1
    return turns
# drv.c: told
def told() -> uint16:
    unset: array[uint16, 2]
    while Ticks < 8:
        if unset[1] == 5:
            Turns += 1
    return Done
# drv.c: due
def due(last: uint16) -> uint16:
    now: uint16 = Ticks
    return now != last
# drv.c: serve
def serve() -> void:
    if Out == Ticks:
        return
    Done += cost(Out)
    Out = Ticks
# drv.c: send
def send() -> void:
    while Turns < Ticks:
        Turns += 1
# drv.c: called
def called() -> uint16:
    last: uint16 = 0
    while last < 8:
        if due(last):
            last += 1
        serve()
        send()
    return Done
# drv.c: count
def count() -> void:
    if Ticks < 8:
        Turns += 1
# drv.c: counted_elsewhere
def counted_elsewhere() -> uint32:
    while due(8):
        count()
    return Turns
# drv.c: again
def again(n: uint16) -> uint16:
    if n == 0:
        return Ticks
    return again(n - 1)
# drv.c: called_by_itself
def called_by_itself() -> uint16:
    while again(3) < 8:
        serve()
    return Done
"""
SKIPPED = ("tested", "continued", "waited", "emptied", "chosen", "called")
#: Loops that count their turns, one with a finding in each turn, and one that calls what nobody follows.
EXECUTED = ("counted", "counted_elsewhere", "told", "called_by_itself")


def run(name: str, gaps: list[int], *, skips: bool, coverage: Coverage | None = None) -> tuple[Any, int]:
    """What a function gives and leaves while Ticks changes after each of `gaps`; the cycles that were executed."""
    firmware = Workshop(SOURCE, watch=True, coverage=coverage)
    if skips:
        firmware.linked.skip_turns()
    ticks = firmware.linked.objects["drv.Ticks"].data

    def tick() -> None:
        ticks[0] += 1

    at = 0
    for gap in gaps:
        at += gap
        firmware.clock.schedule(at, tick)
    result = getattr(firmware, name)()
    clock = firmware.clock
    found = [(finding.rule, finding.count, finding.time_us) for finding in firmware.findings]
    left = {path: list(obj.data) for path, obj in firmware.linked.objects.items()}
    return (result, clock.now, found, left), clock.now - clock.waited


@pytest.mark.parametrize("name", [*SKIPPED, *EXECUTED])
@given(gaps=st.lists(st.integers(0, 700), min_size=8, max_size=8))
def test_a_run_that_skips_is_the_run_that_does_not(name: str, gaps: list[int]) -> None:
    assert run(name, gaps, skips=True)[0] == run(name, gaps, skips=False)[0]


@pytest.mark.parametrize("name", SKIPPED)
def test_idle_turns_are_not_executed(name: str) -> None:
    outcome, executed = run(name, [10_000] * 8, skips=True)
    assert outcome[1] >= 80_000
    assert executed < 5_000


@pytest.mark.parametrize("name", SKIPPED)
def test_who_counts_lines_sees_those_of_a_run_that_does_not_skip(name: str) -> None:
    """A limit of what is computed then ends neither run earlier."""
    lines = []
    for skips in (True, False):
        coverage = Coverage()
        _, executed = run(name, [10_000] * 8, skips=skips, coverage=coverage)
        assert (executed < 5_000) == skips
        ((_, counted),) = coverage.files().items()
        lines.append({line for line, hits in counted.lines.items() if hits})
    assert lines[0] == lines[1]


@pytest.mark.parametrize("name", EXECUTED)
def test_a_turn_that_changes_or_tells_something_is_executed(name: str) -> None:
    outcome, executed = run(name, [1_000] * 8, skips=True)
    assert executed == outcome[1]


def test_a_function_that_is_replaced_runs_in_each_turn() -> None:
    firmware = Workshop(SOURCE, watch=True)
    firmware.linked.skip_turns()
    ticks = firmware.linked.objects["drv.Ticks"].data
    turns: list[int] = []
    firmware.linked.replace("send", lambda: turns.append(1))
    firmware.clock.schedule(10_000, lambda: ticks.__setitem__(0, 8))
    firmware.called()
    assert len(turns) > 50


#: Main loops, which an interrupt routine ends that counts Ticks.
MAINS = """
volatile unsigned int Ticks = 0, Due = 0;
unsigned int Done = 0, Kept = 0, Periods[3] = { 2, 3, 5 }, Last[3] = { 0 };
void flagged(void) { for (;;) { if (Due >= 2) { Due = 0; Done++; } } }
static unsigned int now(void)
{
    unsigned int ticks;
    asm(" setc INTM");
    ticks = Ticks;
    asm(" clrc INTM");
    return ticks;
}
void scheduled(void)
{
    unsigned int i;
    for (;;) {
        unsigned int at = now();
        for (i = 0; i < 3; i++) {
            if (at - Last[i] >= Periods[i]) { Last[i] += Periods[i]; Done += i; }
        }
    }
}
void let_in_for_a_moment(void)
{
    for (;;) {
        asm(" clrc INTM");
        Kept;
        asm(" setc INTM");
        if (Due >= 2) { Due = 0; Done++; }
    }
}
static unsigned int first(void)
{
    unsigned int i;
    for (i = 0; i < 3; i++) {
        if (Last[i] == Ticks) continue;
        if (Last[i] > Ticks) break;
        return i;
    }
    return 3;
}
void searched(void)
{
    unsigned int i;
    for (;;) {
        i = first();
        if (i < 3) Last[i]++;
    }
}
void chosen_among(void)
{
    unsigned int i, most = 0;
    for (;;) {
        for (i = 0; i < 3; i++) {
            if (Last[i] > Ticks) break;
            if (Due + i > most) { most = Due + i; Done++; }
        }
        if (i < 3) Kept = i;
    }
}
void counted_in_a_table(void)
{
    unsigned int i, turns = 0;
    for (;;) {
        for (i = 0; i < 3; i++) turns++;
        if (Due >= 2) { Due = 0; Done = turns; }
    }
}
void filled(void)
{
    unsigned int i;
    for (;;) {
        for (i = 0; i < 3; i++) Last[i]++;
        if (Due >= 2) { Due = 0; Done++; }
    }
}
void ended(void) { while (Ticks < 900) { if (Due >= 2) { Due = 0; Done++; } } }
"""
WITHOUT_END = ("flagged", "scheduled", "let_in_for_a_moment", "searched")
MAINS_SKIPPED = (*WITHOUT_END, "chosen_among", "ended")


class _GapsOver(Exception):
    pass


def run_main(name: str, gaps: list[int], *, skips: bool, driven: bool, limit: int) -> tuple[Any, int]:
    """What happens while an interrupt comes after each of `gaps`, and the cycles that were executed.

    `limit`: how long a loop may compute alone, in cycles; a host that runs it in slices of time (`driven`) allows more.
    """
    externs = {"DINT": lambda: cpu.disable_interrupts(), "EINT": lambda: cpu.enable_interrupts()}
    firmware = CWorkshop(MAINS, watch=True, driven=lambda: driven, externs=externs)
    if skips:
        firmware.linked.skip_turns()
    firmware.linked.allow_loops(limit)
    clock, cpu, objects = firmware.clock, firmware.cpu, firmware.linked.objects
    log: list[Any] = []

    def routine() -> None:
        for path in ("drv.Ticks", "drv.Due"):
            objects[path].data[0] += 1
        left = {path: list(obj.data) for path, obj in objects.items()}
        log.append((clock.now, firmware.findings.position.calls, left))

    def up() -> None:
        raise _GapsOver

    cpu.connect(13, routine)
    cpu.ier = 1 << 12
    cpu.enable_interrupts()
    at = 0
    for gap in gaps:
        at += gap
        clock.schedule(at, lambda: cpu.raise_line(13))
    clock.schedule(at + 300, up)
    with pytest.raises((_GapsOver, EndlessPoll)) as why:
        firmware.call(name)
    found = [(finding.rule, finding.count, finding.time_cycles) for finding in firmware.findings]
    return (log, clock.now, found, why.type), clock.now - clock.waited


@pytest.mark.parametrize("driven", [True, False])
@pytest.mark.parametrize("name", [*MAINS_SKIPPED, "counted_in_a_table", "filled"])
@settings(max_examples=12)
@given(gaps=st.lists(st.integers(0, 700), min_size=8, max_size=8), limit=st.sampled_from([500, 2_000, 100_000]))
def test_a_main_loop_that_skips_is_the_one_that_does_not(name: str, gaps: list[int], limit: int, driven: bool) -> None:
    skipping, turning = (run_main(name, gaps, skips=skips, driven=driven, limit=limit)[0] for skips in (True, False))
    assert skipping == turning


@pytest.mark.parametrize(
    ("name", "limit"),
    [*((name, 1_000_000) for name in MAINS_SKIPPED), *((name, 1_000) for name in WITHOUT_END)],
)
def test_a_main_loop_is_skipped_also_after_the_limit_of_a_loop(name: str, limit: int) -> None:
    (log, now, _, _), executed = run_main(name, [20_000] * 8, skips=True, driven=True, limit=limit)
    assert (len(log), now >= 160_000) == (8, True)
    assert executed < 8_000


def test_a_main_loop_that_nobody_drives_ends_at_the_limit() -> None:
    for name in ("flagged", "ended"):
        (log, now, found, why), _ = run_main(name, [20_000] * 8, skips=True, driven=False, limit=50_000)
        assert (len(log), why, [rule for rule, _, _ in found]) == (2, EndlessPoll, ["endless-loop"])
        assert 50_000 < now < 60_000


@pytest.mark.parametrize("name", ["counted_in_a_table", "filled"])
def test_a_main_loop_that_computes_is_executed(name: str) -> None:
    (_, now, _, _), executed = run_main(name, [2_000] * 8, skips=True, driven=True, limit=1_000)
    assert executed == now
