"""DMA in register language (TRM, DMA): loops, times, modes, triggers, priorities, what it reaches."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.registers.core import ALL
from tests.emulator.peripherals.dma_bench import (
    BURSTSTS,
    CHINTE,
    CHINTMODE,
    CONTINUOUS,
    DATASIZE,
    ERRCLR,
    HALT,
    ONESHOT,
    OVRFLG,
    OVRINTE,
    PERINTCLR,
    PERINTFLG,
    PERINTFRC,
    RAM,
    RUN,
    RUNSTS,
    SOFTRESET,
    TRANSFERSTS,
    DmaBench,
)

TO = RAM + 0x1000


@pytest.mark.parametrize(
    ("mode", "words", "cycles"),
    # TRM: 8 bursts of 16 words take 8 * (4 * 16 + 1) = 520 cycles, and 32 bits at a time 8 * (4 * 8 + 1) = 264.
    [(0, 1, 520), (DATASIZE, 2, 264)],
)
def test_a_transfer_takes_the_time_of_the_manuals_example(mode: int, words: int, cycles: int) -> None:
    bench = DmaBench()
    bench.fill(RAM, list(range(1000, 1128)))
    bench.channel(
        MODE=mode | ONESHOT | CHINTE | CHINTMODE, BURST_SIZE=15, TRANSFER_SIZE=7, SRC_BURST_STEP=words,
        DST_BURST_STEP=words, SRC_TRANSFER_STEP=words, DST_TRANSFER_STEP=words,
    )  # fmt: skip
    bench.control(RUN)
    bench.control(PERINTFRC)
    bench.pass_cycles(cycles - 1)
    assert bench.read("CONTROL") == RUNSTS | BURSTSTS | TRANSFERSTS
    assert not bench.latched(1)
    bench.pass_cycles(1)
    assert bench.read("CONTROL") == 0
    assert bench.latched(1)
    assert bench.words(TO, 129) == [*range(1000, 1128), 0]
    assert not list(bench.findings)


def test_a_word_is_read_by_the_third_cycle_behind_the_trigger_and_written_in_the_fifth() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1, 2])
    bench.channel(BURST_SIZE=1, SRC_BURST_STEP=1, DST_BURST_STEP=1)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(1)
    bench.fill(RAM, [10, 20])
    bench.pass_cycles(1)
    bench.fill(RAM, [100, 200])
    bench.pass_cycles(2)
    assert bench.words(TO, 2) == [0, 0]
    bench.pass_cycles(1)
    assert bench.words(TO, 2) == [10, 0]
    bench.pass_cycles(4)
    assert bench.words(TO, 2) == [10, 200]


def test_one_burst_a_trigger() -> None:
    bench = DmaBench()
    bench.fill(RAM, list(range(1, 13)))
    bench.channel(
        MODE=CHINTE | CHINTMODE, BURST_SIZE=3, TRANSFER_SIZE=2, SRC_BURST_STEP=1, DST_BURST_STEP=1,
        SRC_TRANSFER_STEP=1, DST_TRANSFER_STEP=1,
    )  # fmt: skip
    bench.control(RUN)
    bench.pass_cycles(100)
    assert bench.read("CONTROL") == RUNSTS, "nobody has triggered"
    for burst in (1, 2, 3):
        bench.control(PERINTFRC)
        bench.pass_cycles(17)
        assert bench.words(TO, 13) == [*range(1, 4 * burst + 1), *[0] * (13 - 4 * burst)]
        assert bench.latched(1) == (burst == 3)
    assert bench.read("CONTROL") == 0
    # Off: a trigger is remembered, and the next transfer begins with it.
    bench.control(PERINTFRC)
    bench.pass_cycles(100)
    assert bench.read("CONTROL") == PERINTFLG
    bench.control(RUN)
    assert bench.read("CONTROL") == RUNSTS | BURSTSTS | TRANSFERSTS
    bench.pass_cycles(100)
    bench.control(PERINTFRC)
    bench.control(PERINTCLR | HALT)
    assert bench.read("TRANSFER_COUNT") == 1


def test_an_interrupt_at_the_beginning_of_each_transfer_of_a_continuous_channel() -> None:
    bench = DmaBench()
    bench.channel(MODE=CHINTE | CONTINUOUS, TRANSFER_SIZE=1, SRC_TRANSFER_STEP=1, DST_TRANSFER_STEP=1)
    bench.control(RUN)
    seen = []
    for _ in range(5):
        bench.control(PERINTFRC)
        seen.append(bench.latched(1))
        bench.pass_cycles(5)
        assert bench.read("CONTROL") & RUNSTS
    assert seen == [True, False, True, False, True]


def test_shadow_addresses_are_taken_at_the_beginning_of_a_transfer() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1, 2])
    bench.channel(MODE=CONTINUOUS, TRANSFER_SIZE=1, SRC_TRANSFER_STEP=1, DST_TRANSFER_STEP=1)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(5)
    # Ping-pong: while one buffer fills, the other is announced.
    bench.write("DmaRegs", "CH1.DST_ADDR_SHADOW", TO + 0x100)
    bench.control(PERINTFRC)
    bench.pass_cycles(5)
    assert bench.words(TO, 2) == [1, 2]
    bench.control(PERINTFRC)
    bench.pass_cycles(5)
    assert bench.words(TO + 0x100, 1) == [1]
    assert bench.read("DST_ADDR_ACTIVE") == TO + 0x101


def test_a_wrap_reloads_the_begin_and_steps_it() -> None:
    bench = DmaBench()
    bench.fill(RAM, list(range(1, 33)))
    # Two bursts of one word from each row of four words: 1 2, 5 6, 9 10.
    bench.channel(
        MODE=ONESHOT, TRANSFER_SIZE=5, SRC_TRANSFER_STEP=1, SRC_WRAP_SIZE=1, SRC_WRAP_STEP=4, DST_TRANSFER_STEP=1
    )
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(100)
    assert bench.words(TO, 7) == [1, 2, 5, 6, 9, 10, 0]


SIZES = st.integers(0, 6)
STEPS = st.integers(-7, 7)


@given(
    burst=SIZES, transfer=SIZES, burst_steps=st.tuples(STEPS, STEPS), transfer_steps=st.tuples(STEPS, STEPS),
    wrap_sizes=st.tuples(SIZES, SIZES), wrap_steps=st.tuples(STEPS, STEPS), begins=st.tuples(STEPS, STEPS),
    double=st.booleans(), one_shot=st.booleans(),
)  # fmt: skip
def test_the_two_loops_of_the_manual(
    burst: int, transfer: int, burst_steps: tuple[int, int], transfer_steps: tuple[int, int],
    wrap_sizes: tuple[int, int], wrap_steps: tuple[int, int], begins: tuple[int, int], double: bool, one_shot: bool,
) -> None:  # fmt: skip
    source, target = RAM + 0x400, TO + 0x400
    image = {RAM + i: (RAM + i) * 40503 & 0xFFFF for i in range(0x800)}
    bench = DmaBench()
    for address, word in image.items():
        bench.memory.words[address] = word
    names = ("SRC", "DST")
    bench.channel(
        MODE=(ONESHOT if one_shot else 0) | (DATASIZE if double else 0) | CHINTE | CHINTMODE, BURST_SIZE=burst,
        TRANSFER_SIZE=transfer, SRC_ADDR_SHADOW=source, DST_ADDR_SHADOW=target,
        SRC_BEG_ADDR_SHADOW=source + begins[0], DST_BEG_ADDR_SHADOW=target + begins[1],
        **{f"{name}_BURST_STEP": step for name, step in zip(names, burst_steps, strict=True)},
        **{f"{name}_TRANSFER_STEP": step for name, step in zip(names, transfer_steps, strict=True)},
        **{f"{name}_WRAP_SIZE": size for name, size in zip(names, wrap_sizes, strict=True)},
        **{f"{name}_WRAP_STEP": step for name, step in zip(names, wrap_steps, strict=True)},
    )
    # TRM: the sizes are of 16-bit words, less one; the steps are of 16-bit words.
    per_word = 2 if double else 1
    copies = -(-(burst + 1) // per_word)
    at, begin, left = [source, target], [source + begins[0], target + begins[1]], list(wrap_sizes)
    for number in range(transfer + 1):
        for word in range(copies):
            low = [address & ~(per_word - 1) for address in at]
            for half, value in enumerate([image.get(low[0] + half, 0) for half in range(per_word)]):
                image[low[1] + half] = value
            if word < copies - 1:
                at = [address + step for address, step in zip(at, burst_steps, strict=True)]
        if number == transfer:
            break
        for side in range(2):
            if left[side] == 0:
                begin[side] += wrap_steps[side]
                at[side], left[side] = begin[side], wrap_sizes[side]
            else:
                at[side] += transfer_steps[side]
                left[side] -= 1
    bench.control(RUN)
    for number in range(1 if one_shot else transfer + 1):
        assert bench.read("CONTROL") & RUNSTS
        assert not bench.latched(1), number
        bench.control(PERINTFRC)
        bench.pass_cycles((4 * copies + 1) * (transfer + 1 if one_shot else 1))
    assert bench.read("CONTROL") == 0
    assert bench.latched(1)
    assert {address: bench.memory.read_word(address) for address in image} == image
    assert [bench.read(f"{name}_ADDR_ACTIVE") for name in names] == at
    assert [bench.read(f"{name}_BEG_ADDR_ACTIVE") for name in names] == begin
    assert [bench.read(f"{name}_WRAP_COUNT") for name in names] == left
    assert not list(bench.findings)


# Control


def test_a_halt_ends_the_word_and_run_goes_on_with_the_next() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1, 2, 3])
    bench.channel(BURST_SIZE=2, SRC_BURST_STEP=1, DST_BURST_STEP=1)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(3)
    bench.control(HALT)
    bench.pass_cycles(1000)
    assert bench.words(TO, 3) == [1, 0, 0]
    assert bench.read("CONTROL") == BURSTSTS | TRANSFERSTS
    assert bench.read("BURST_COUNT") == 1
    bench.control(RUN)
    bench.pass_cycles(1 + 2 * 4)
    assert bench.words(TO, 3) == [1, 2, 3]
    assert bench.read("CONTROL") == 0


def test_a_halt_that_is_taken_back_at_once_changes_nothing() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1, 2, 3])
    bench.channel(BURST_SIZE=2, SRC_BURST_STEP=1, DST_BURST_STEP=1)
    bench.control(RUN | PERINTFRC)
    bench.control(HALT)
    bench.control(RUN)
    bench.pass_cycles(13)
    assert bench.words(TO, 3) == [1, 2, 3]


def test_a_soft_reset_ends_the_word_and_forgets_the_transfer() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1, 2, 3])
    bench.channel(BURST_SIZE=2, TRANSFER_SIZE=4, SRC_BURST_STEP=1, DST_BURST_STEP=1)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(3)
    bench.control(SOFTRESET)
    assert bench.read("CONTROL") == 0
    names = ("BURST_COUNT", "TRANSFER_COUNT", "SRC_WRAP_COUNT", "DST_WRAP_COUNT")
    assert [bench.read(name) for name in names] == [0] * 4
    bench.pass_cycles(1000)
    assert bench.words(TO, 3) == [1, 0, 0]
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(13)
    assert bench.words(TO, 3) == [1, 2, 3]
    assert bench.read("BURST_SIZE") == 2, "settings stay"


def test_a_channel_that_starts_again_while_its_soft_reset_ends_a_word_begins_anew() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1, 2, 3])
    bench.channel(BURST_SIZE=2, SRC_BURST_STEP=1, DST_BURST_STEP=1)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(3)
    bench.control(SOFTRESET)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(2 + 13)
    assert bench.words(TO, 3) == [1, 2, 3]
    assert bench.read("CONTROL") == 0


def test_a_hard_reset_leaves_nothing() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1])
    bench.channel()
    bench.control(RUN | PERINTFRC)
    bench.write("DmaRegs", "DMACTRL", 1)
    bench.pass_cycles(1000)
    assert bench.words(TO, 1) == [0]
    assert all(register.value == register.reset_value for register in bench.chip.blocks["DmaRegs"])


def test_software_triggers_only_a_channel_that_takes_triggers() -> None:
    bench = DmaBench()
    bench.channel()
    bench.write("DmaRegs", "CH1.MODE", 1)
    bench.control(RUN | PERINTFRC)
    assert bench.read("CONTROL") == RUNSTS
    assert [(f.rule, f.object) for f in bench.findings] == [("not-configured", "DmaRegs.CH1.MODE.PERINTE")]


def test_a_protected_register_is_written_whatever_EALLOW_says() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "SECMSEL", 1)
    bench.fill(RAM, [1])
    bench.channel(destination=bench.chip.register("DacaRegs", "DACCTL").address)
    bench.write("CpuSysRegs", "PCLKCR16", 1 << 16)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(5)
    assert bench.chip.register("DacaRegs", "DACCTL").value == 1
    assert not bench.chip.cpu.eallow
    assert not list(bench.findings)


def test_registers_are_protected_and_gated() -> None:
    bench = DmaBench()
    bench.chip.register("DmaRegs", "CH3.BURST_SIZE").write(7, 0xFFFF)
    assert bench.read("BURST_SIZE", 3) == 0
    assert [(f.rule, f.object) for f in bench.findings] == [("eallow", "DmaRegs.CH3.BURST_SIZE")]
    bench.findings.clear()
    bench.write("CpuSysRegs", "PCLKCR0", 0)
    bench.write("DmaRegs", "CH3.BURST_SIZE", 7)
    assert [f.rule for f in bench.findings] == ["clock-gated"]


def test_without_its_clock_a_word_stands_still() -> None:
    bench = DmaBench()
    bench.fill(RAM, [1])
    bench.channel()
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(4)
    bench.write("CpuSysRegs", "PCLKCR0", 0)
    bench.pass_cycles(1000)
    assert bench.words(TO, 1) == [0]
    bench.write("CpuSysRegs", "PCLKCR0", 1 << 2)
    bench.pass_cycles(1)
    assert bench.words(TO, 1) == [1]


# Who comes first


def order(bench: DmaBench, cycles: int) -> list[int]:
    """Which channel had the bus in each of the next cycles, repetitions left out; 0: none."""
    seen: list[int] = []
    for _ in range(cycles):
        active = bench.chip.register("DmaRegs", "PRIORITYSTAT").read() & 7
        if not seen or seen[-1] != active:
            seen.append(active)
        bench.pass_cycles(1)
    return seen


def channels(bench: DmaBench, *numbers: int, words: int = 2) -> None:
    for n in numbers:
        bench.fill(RAM + 16 * n, [n] * words)
        bench.channel(
            n, RAM + 16 * n, TO + 16 * n, MODE=CONTINUOUS, BURST_SIZE=words - 1, SRC_BURST_STEP=1, DST_BURST_STEP=1
        )
        bench.control(RUN, n)


def test_the_round_goes_on_behind_the_channel_that_was_served() -> None:
    # The manual's example: CH1, CH4 and CH5 are on; while CH4 is served, CH1 and CH5 are triggered.
    bench = DmaBench()
    channels(bench, 1, 4, 5)
    bench.control(PERINTFRC, 4)
    bench.pass_cycles(3)
    bench.control(PERINTFRC, 1)
    bench.control(PERINTFRC, 5)
    assert order(bench, 40) == [4, 5, 1, 0]


def test_a_trigger_that_waits_lets_the_others_of_the_round_go_first() -> None:
    bench = DmaBench()
    channels(bench, 2, 3)
    bench.control(PERINTFRC, 2)
    bench.pass_cycles(1)
    bench.control(PERINTFRC, 2)
    bench.control(PERINTFRC, 3)
    assert order(bench, 40) == [2, 3, 2, 0]


def test_a_new_round_begins_with_channel_1() -> None:
    bench = DmaBench()
    channels(bench, 1, 4, 5)
    bench.control(PERINTFRC, 4)
    bench.pass_cycles(50)
    bench.control(PERINTFRC, 5)
    bench.pass_cycles(1)
    bench.write("DmaRegs", "DMACTRL", 2)  # PRIORITYRESET acts behind the burst of CH5
    bench.control(PERINTFRC, 1)
    bench.control(PERINTFRC, 4)
    assert order(bench, 60) == [5, 1, 4, 0]


def test_channel_1_of_high_priority_interrupts_a_burst_behind_its_word() -> None:
    bench = DmaBench()
    bench.write("DmaRegs", "PRIORITYCTRL1", 1)
    channels(bench, 1, 4, 5, words=3)
    bench.control(PERINTFRC, 4)
    bench.pass_cycles(3)
    bench.control(PERINTFRC, 5)
    bench.control(PERINTFRC, 1)
    bench.pass_cycles(2)
    # 1 + 4 cycles are over: one word of CH4.
    assert bench.words(TO + 64, 3) == [4, 0, 0]
    assert bench.chip.register("DmaRegs", "PRIORITYSTAT").read() == 4 << 4 | 1
    bench.pass_cycles(1 + 3 * 4)
    assert bench.words(TO + 16, 3) == [1, 1, 1]
    # TRM: one cycle to return; then the two words that are left.
    bench.pass_cycles(1 + 2 * 4 - 1)
    assert bench.words(TO + 64, 3) == [4, 4, 0]
    bench.pass_cycles(1)
    assert bench.words(TO + 64, 3) == [4, 4, 4]
    assert order(bench, 40) == [5, 0]


def test_a_one_shot_transfer_gives_way_to_channel_1_of_high_priority_and_goes_on() -> None:
    bench = DmaBench()
    bench.write("DmaRegs", "PRIORITYCTRL1", 1)
    channels(bench, 1)
    bench.fill(RAM + 0x100, list(range(1, 7)))
    bench.channel(
        2, RAM + 0x100, TO + 0x100, MODE=ONESHOT, TRANSFER_SIZE=5, SRC_TRANSFER_STEP=1, DST_TRANSFER_STEP=1
    )
    bench.control(RUN | PERINTFRC, 2)
    bench.pass_cycles(7)
    bench.control(PERINTFRC, 1)
    assert order(bench, 100) == [2, 1, 2, 0]
    assert bench.words(TO + 0x100, 6) == list(range(1, 7))


# Triggers of modules


def test_a_timer_triggers_and_an_overflow_is_told() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR0", 1 << 3 | 1 << 2)
    bench.write("CpuTimer0Regs", "PRD", 99)
    bench.write("CpuTimer0Regs", "TCR", 1 << 14 | 1 << 5)
    bench.channel(MODE=CONTINUOUS | OVRINTE | CHINTE | CHINTMODE, TRANSFER_SIZE=0xFFFF, DST_TRANSFER_STEP=1)
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL1", 68)
    bench.fill(RAM, [7])
    bench.control(PERINTCLR | RUN)
    bench.pass_cycles(450)
    assert bench.words(TO, 5) == [7, 7, 7, 7, 0]
    assert not list(bench.findings)
    bench.control(HALT)
    bench.pass_cycles(200)
    assert bench.read("CONTROL") & (OVRFLG | PERINTFLG) == OVRFLG | PERINTFLG
    assert bench.latched(1)
    assert not list(bench.findings), "the channel is off: nothing was to be copied"
    bench.control(ERRCLR)
    assert not bench.read("CONTROL") & OVRFLG


def test_a_burst_that_is_lost_is_told() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR0", 1 << 3 | 1 << 2)
    bench.write("CpuTimer0Regs", "PRD", 9)
    bench.write("CpuTimer0Regs", "TCR", 1 << 14 | 1 << 5)
    bench.channel(MODE=CONTINUOUS, BURST_SIZE=31, TRANSFER_SIZE=0xFFFF)
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL1", 68)
    bench.control(RUN)
    bench.pass_cycles(100)
    assert [(f.rule, f.object) for f in bench.findings] == [("data-lost", "DmaRegs.CH1.CONTROL.OVRFLG")]


@pytest.mark.parametrize(
    ("source", "give"),
    [
        (29, lambda bench: edge(bench)), (36, lambda bench: bench.chip.triggered[5].emit()),
        (59, lambda bench: bench.chip.triggered[28].emit()), (69, lambda bench: bench.chip.triggered[2].emit()),
        (2, lambda bench: convert(bench, "A", 1)), (16, lambda bench: convert(bench, "D", 0)),
        (10, lambda bench: convert(bench, "B", 4)),
    ],
    ids=["XINT1", "EPWM1SOCA", "EPWM12SOCB", "TINT1", "ADCAINT2", "ADCDINT1", "ADCBEVT"],
)  # fmt: skip
def test_each_module_triggers_the_channels_that_select_it(
    source: int, give: Callable[[DmaBench], object]
) -> None:  # fmt: skip
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR13", 0xF)
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL2", source << 8 | (source + 1))
    for n in (5, 6):
        bench.channel(n)
    give(bench)
    assert bench.read("CONTROL", 6) == PERINTFLG
    assert bench.read("CONTROL", 5) == 0
    assert not list(bench.findings)


def edge(bench: DmaBench) -> None:
    """A rising edge of GPIO5, which is XINT1."""
    bench.write("InputXbarRegs", "INPUT4SELECT", 5)
    bench.write("XintRegs", "XINT1CR", 1 << 2 | 1)
    bench.chip.pins[5].drive("test", 1)


def convert(bench: DmaBench, letter: str, n: int) -> None:
    """A conversion whose end raises ADCINT(n+1), or the event of block 1 for 4."""
    block = f"Adc{letter.lower()}Regs"
    for register, word in (
        ("ADCCTL2", 6), ("ADCCTL1", 0x84), ("ADCSOC3CTL", 19), ("ADCINTSEL1N2", 0x23 << 8 if n == 1 else 0x23),
        ("ADCPPB1CONFIG", 3), ("ADCPPB1TRIPLO", 1), ("ADCEVTINTSEL", 2 if n == 4 else 0),
    ):  # fmt: skip
        bench.write(block, register, word)
    bench.pass_cycles(100_000)
    bench.write(block, "ADCSOCFRC1", 1 << 3)
    bench.pass_cycles(100)


def test_nobody_brings_triggers_that_nobody_waits_for() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR13", 0xF)
    assert not bench.chip.triggered[5].listeners
    bench.channel()
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL1", 36)
    assert bench.chip.triggered[5].listeners
    bench.write("DmaRegs", "CH1.MODE", 1)
    assert not bench.chip.triggered[5].listeners


def test_a_trigger_of_a_module_that_is_not_modelled_is_told() -> None:
    bench = DmaBench()
    bench.channel()
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL1", 95)
    bench.control(RUN)
    assert [f.rule for f in bench.findings] == ["unmodelled"]


def test_the_choice_of_triggers_can_be_locked() -> None:
    bench = DmaBench()
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSELLOCK", 2)
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL1", 36)
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL2", 36)
    assert [f.object for f in bench.findings.of("locked")] == ["DmaClaSrcSelRegs.DMACHSRCSEL2"]
    assert bench.chip.register("DmaClaSrcSelRegs", "DMACHSRCSEL1").read() == 36


# What it reaches


@pytest.mark.parametrize("address", [0x0400, 0x9000, 0x1010, 0x7200, 0x82000, 0x1C000])
def test_what_no_bus_leads_to_is_told(address: int) -> None:
    bench = DmaBench()
    bench.channel(destination=address)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(5)
    assert [(f.rule, f.value) for f in bench.findings] == [("dma-address", address)]
    assert bench.read("CONTROL") == 0, "the channel counts on"


@pytest.mark.parametrize(("block", "register", "shift"), [("DacaRegs", "DACVALS", 0), ("SpiaRegs", "SPITXBUF", 2)])
def test_a_bridge_leads_to_its_modules_once_it_is_the_dmas(block: str, register: str, shift: int) -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR16", 1 << 16)
    bench.write("CpuSysRegs", "PCLKCR8", 1)
    bench.fill(RAM, [1234])
    bench.channel(destination=bench.chip.register(block, register).address)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(5)
    assert [f.rule for f in bench.findings] == ["dma-address"]
    assert bench.chip.register(block, register).value == 0
    bench.findings.clear()
    bench.write("CpuSysRegs", "SECMSEL", 1 << shift)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(5)
    assert bench.chip.register(block, register).value == 1234
    assert not bench.findings.of("dma-address")


def test_a_32_bit_register_is_written_in_one_access() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR2", 1)
    bench.write("CpuSysRegs", "SECMSEL", 1)
    seen: list[tuple[int, int]] = []
    compare = bench.chip.register("EPwm1Regs", "CMPA")
    compare.on_write = lambda word, lanes: seen.append((word, lanes))
    bench.fill(RAM, [0x1234, 0x5678])
    bench.channel(destination=compare.address, MODE=DATASIZE, BURST_SIZE=1)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(5)
    assert seen == [(0x56781234, ALL)]


def test_what_the_dma_accesses_is_no_access_of_the_cpu() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR2", 1)
    bench.write("CpuSysRegs", "SECMSEL", 1)
    seen: list[str] = []
    period = bench.chip.register("EPwm1Regs", "TBPRD")
    period.tap(lambda _register, access, _word, _lanes: seen.append(access), reads=True)
    bench.fill(RAM, [77])
    bench.channel(1, RAM, period.address)
    bench.channel(2, period.address, TO)
    for n in (1, 2):
        bench.control(RUN | PERINTFRC, n)
        bench.pass_cycles(10)
    assert bench.words(TO, 1) == [77]
    assert seen == []


@pytest.mark.parametrize(("half", "word"), [(0, 0x5678_0000 | 0x1111), (1, 0x1111_0000 | 0x1234)])
def test_half_of_a_32_bit_register_leaves_the_other_half(half: int, word: int) -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR2", 1)
    bench.write("CpuSysRegs", "SECMSEL", 1)
    offset = bench.chip.register("EPwm1Regs", "TBPHS")
    bench.write("EPwm1Regs", "TBPHS", 0x56781234)
    bench.fill(RAM, [0x1111])
    bench.channel(1, RAM, offset.address + half)
    bench.channel(2, offset.address + half, TO)
    for n in (1, 2):
        bench.control(RUN | PERINTFRC, n)
        bench.pass_cycles(10)
    assert offset.value == word & offset.rw_mask
    assert bench.words(TO, 1) == [(offset.value >> 16 * half) & 0xFFFF]


def test_a_module_without_clock_is_deaf_to_the_dma_too() -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "SECMSEL", 1)
    bench.channel(destination=bench.chip.register("EPwm1Regs", "TBPRD").address)
    bench.control(RUN | PERINTFRC)
    bench.pass_cycles(10)
    assert [f.rule for f in bench.findings] == ["clock-gated"]


@pytest.mark.parametrize(
    ("prescale", "stale"),
    # DS: tEOC and tLAT are 21 and 23, 26 and 28, 31 and 34, 41 and 44, 86 and 91.  ERR: stale where 3 or more cycles
    # lie between, and then not for a second channel, which reads 1 + 4 cycles later.
    [(2, False), (3, False), (4, True), (6, True), (15, True)],
)
def test_a_result_that_has_not_latched_is_read_as_it_was_before(prescale: int, stale: bool) -> None:
    bench = DmaBench()
    bench.write("CpuSysRegs", "PCLKCR13", 1)
    bench.chip.adc["A"].force_codes((111, 222))
    for register, word in (("ADCCTL2", prescale), ("ADCCTL1", 0x84), ("ADCSOC0CTL", 19), ("ADCINTSEL1N2", 0x60)):
        bench.write("AdcaRegs", register, word)
    bench.pass_cycles(200_000)
    bench.write("DmaClaSrcSelRegs", "DMACHSRCSEL1", 1 << 8 | 1)
    for n in (1, 2):
        bench.channel(n, 0x0B00, TO + n, MODE=CONTINUOUS)
        bench.control(RUN, n)
    for _ in range(2):
        bench.write("AdcaRegs", "ADCSOCFRC1", 1)
        bench.pass_cycles(1000)
    assert bench.words(TO + 1, 2) == [111 if stale else 222, 222]
