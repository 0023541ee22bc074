"""Task stacks (family/c28/TaskSupport.c, knl/Task.c Task_checkStacks)."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.c28x.ctypes import UINT, ArrayType
from emulator.c28x.memory import Memory, Object
from emulator.c28x.tree import Declaration
from emulator.sysbios.core import KernelError
from emulator.sysbios.stack import DEFAULT_WORDS
from tests.emulator.sysbios.bench import TICK, Bench, Struct


def idle_task(_a: int, _b: int) -> None:
    """Does nothing."""


def test_stacks_are_consecutive_even_and_filled_with_00be() -> None:
    words = Memory()
    b = Bench(memory=words)
    made: list[Any] = []
    b.boot(lambda: made.extend(b.task(idle_task, 1, stackSize=n, arg0=0x12345678, arg1=3) for n in (255, 512, 0)))
    # 255 words are rounded up to 256; 0 means the default of 256.
    assert [(t.stack.base, t.stack.words) for t in made] == [(0x8000, 256), (0x8100, 512), (0x8300, 256)]
    # Initial frame: words 0..25; from 26 on the fill.  arg1 at 2..3, arg0 at 4..5, saved registers 12..25 are zero.
    frame = [words.read_word(0x8000 + i) for i in range(28)]
    assert frame[2:6] == [3, 0, 0x5678, 0x1234]
    assert frame[12:26] == [0] * 14
    assert frame[26:] == [0x00BE] * 2
    assert words.read_word(0x80FF) == 0x00BE
    # The system stack holds 0xBEBE.
    assert words.read_word(0x0400) == words.read_word(0x07F7) == 0xBEBE


def test_the_task_function_starts_six_words_above_the_base() -> None:
    b = Bench()
    b.boot(lambda: b.task(lambda a, c: b.note((b.cpu.sp, b.cpu.stack_limit)), 1, stackSize=512))
    b.kernel.run_until(1)
    # Functions must leave 34 words to the dispatcher and 14 to the CPU, which an interrupt pushes.
    assert b.log == [(0x8006, 0x8200 - 48)]


def test_sp_follows_the_task_and_handlers_use_the_system_stack() -> None:
    b = Bench()

    def task(_a: int, _b: int) -> None:
        b.cpu.sp += 20
        b.kernel.Task_sleep(1)
        b.note(b.cpu.sp)

    b.boot(
        lambda: b.task(task, 2),
        lambda: b.timer(lambda _arg: b.note(("clock", b.cpu.sp, b.cpu.stack_limit)), 1),
    )
    b.run_ticks(2)
    assert b.log == [("clock", 0x400, 0x7F8), 0x8006 + 20]


@pytest.mark.parametrize(
    ("base", "words", "fits"), [(0x8000, 0x7FFE, True), (0x8000, 0x7FFF, False), (0xFF00, 0x100, False)]
)
def test_a_stack_must_lie_below_10000(base: int, words: int, fits: bool) -> None:
    """The end must be below 0xFFFF; 0x7FFF words are rounded up to 0x8000, which ends at 0x10000."""
    b = Bench(task_stack_base=base)
    if fits:
        b.kernel.start(lambda: b.task(idle_task, 1, stackSize=words))
    else:
        with pytest.raises(KernelError, match="TaskSupport_E_invalidStack"):
            b.kernel.start(lambda: b.task(idle_task, 1, stackSize=words))


def test_with_an_error_block_create_returns_null_instead() -> None:
    b = Bench(task_stack_base=0xFF00)
    block = Struct()
    block.values["id"] = 0
    params = Struct()

    def main() -> None:
        b.kernel.Error_init(block)
        b.kernel.Task_Params_init(params)
        b.note(b.kernel.Task_create(idle_task, params, block))
        b.note(b.kernel.Error_check(block))

    b.kernel.start(main)
    assert b.log == [None, 1]


def test_a_given_stack_is_used_and_cut_to_even_words() -> None:
    class At:
        addr = 0xA000

    b = Bench()
    made: list[Any] = []
    b.boot(
        lambda: made.append(b.task(idle_task, 1, stack=At(), stackSize=101)),
        lambda: made.append(b.task(idle_task, 1, stackSize=100)),
    )
    assert [(t.stack.base, t.stack.words) for t in made] == [(0xA000, 100), (0x8000, 100)]


def test_a_lost_top_word_is_an_overflow_at_the_next_switch() -> None:
    words = Memory()
    b = Bench(memory=words)

    def task(_a: int, _b: int) -> None:
        words.words[0x80FF] = 0x1234
        b.note("still running")
        b.kernel.Task_sleep(1)

    task.__name__ = "Greedy"
    b.boot(lambda: b.task(task, 1))
    with pytest.raises(KernelError, match="Task_E_stackOverflow"):
        b.run_ticks(1)
    assert b.log == ["still running"]
    (finding,) = b.findings.of("stack-overflow")
    assert finding.object == "Greedy"
    assert "0x8000" in finding.declaration
    assert "256 words" in finding.declaration


def test_a_top_word_overwritten_with_its_own_fill_goes_unnoticed() -> None:
    words = Memory()
    b = Bench(memory=words)

    def task(_a: int, _b: int) -> None:
        words.words[0x80FF] = 190
        b.kernel.Task_sleep(1)

    b.boot(lambda: b.task(task, 1))
    b.run_ticks(2)
    assert len(b.findings) == 0


def test_sp_out_of_range_at_a_switch_is_an_error() -> None:
    b = Bench()

    def task(_a: int, _b: int) -> None:
        b.cpu.sp = 0x8101
        b.kernel.Task_sleep(1)

    b.boot(lambda: b.task(task, 1))
    with pytest.raises(KernelError, match="Task_E_spOutOfBounds"):
        b.run_ticks(1)


def test_the_dispatchers_own_words_can_overflow_a_nearly_full_stack() -> None:
    """256 words; 14 by the core and 34 by the dispatcher end above 256 when the task uses 220."""
    outcomes = []
    for used in (200, 220):
        b = Bench()

        def task(_a: int, _b: int, b: Bench = b, used: int = used) -> None:
            b.cpu.sp = 0x8000 + used
            b.clock.charge(2 * TICK)
            b.kernel.Task_sleep(1)

        b.boot(lambda b=b, task=task: b.task(task, 1))
        try:
            b.run_ticks(4)
            outcomes.append("fine")
        except KernelError as error:
            outcomes.append(error.identifier)
    assert outcomes == ["fine", "Task_E_stackOverflow"]


def test_without_checks_an_overflow_stays_silent() -> None:
    b = Bench(check_stacks=False)

    def task(_a: int, _b: int) -> None:
        b.cpu.sp = 0x8101
        b.kernel.Task_sleep(1)

    b.boot(lambda: b.task(task, 1))
    b.run_ticks(2)
    assert len(b.findings) == 0


def test_params_without_init_are_noticed() -> None:
    b = Bench()
    params = Struct()
    b.kernel.Task_Params_init(params)
    params.values["__size"] = 0x00BE
    with pytest.raises(KernelError, match="Core_A_initializedParams"):
        b.kernel.start(lambda: b.kernel.Task_create(idle_task, params, None))


def test_used_words_count_from_the_highest_touched_word() -> None:
    words = Memory()
    b = Bench(memory=words)
    made: list[Any] = []
    b.boot(lambda: made.append(b.task(idle_task, 1)))
    stacks = b.kernel.tasks.stacks
    assert stacks.used(made[0].stack) == 26
    words.words[0x8050] = 1
    assert stacks.used(made[0].stack) == 0x51


def two_words(base: int) -> Object:
    """An object of two words that hold something else than the fill."""
    return Object(Declaration("buffer", ArrayType("uint16 [2]", UINT, 2), "", "", 0), base, [0x1234, 0x1234])


@pytest.mark.parametrize(("base", "covers"), [(0x80FE, True), (0x80FF, True), (0x80FD, False), (0x8100, False)])
def test_a_local_on_the_top_word_is_what_the_check_reads(base: int, covers: bool) -> None:
    """The top word of 0x8000..0x80FF is 0x80FF; a local of two words covers it from 0x80FE and from 0x80FF."""

    words = Memory()
    b = Bench(memory=words)

    def task(_a: int, _b: int) -> None:
        b.kernel.Task_sleep(1)
        words.live_locals.append(two_words(base))
        b.kernel.Task_sleep(1)
        b.note("not seen")

    b.boot(lambda: b.task(task, 1))
    if covers:
        with pytest.raises(KernelError, match="Task_E_stackOverflow"):
            b.kernel.run_until(3 * TICK)
    else:
        b.kernel.run_until(3 * TICK)
        assert b.log == ["not seen"]


def test_an_object_of_the_linker_on_the_top_word_is_what_the_check_reads() -> None:
    memory = Memory()
    placed = memory.place(two_words(0).declaration, data=[0x1234, 0x1234])
    b = Bench(memory=memory, task_stack_base=placed.base + placed.words - DEFAULT_WORDS)

    def task(_a: int, _b: int) -> None:
        b.kernel.Task_sleep(1)

    b.boot(lambda: b.task(task, 1))
    with pytest.raises(KernelError, match="Task_E_stackOverflow"):
        b.kernel.run_until(TICK)
