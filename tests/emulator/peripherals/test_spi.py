"""SPI-A alone, in register language, against an echo slave.  Facts: TRM SPI chapter.

LSPCLK is SYSCLK/4 throughout, so a bit lasts 4 * (BRR + 1) cycles.
"""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.spi import Spi
from emulator.registers.spi import SpiRegs
from emulator.signals import SpiBus, Wire

RUN = 0x80
MASTER_TALK = 0x06


class EchoSlave:
    """Answers each word with the word before it; keeps what it saw."""

    def __init__(self) -> None:
        self.seen: list[tuple[int, int, int, int]] = []
        self.answer = 0

    def select(self, level: int) -> None:
        pass

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        self.seen.append((out_bits, length, cpol, cpha))
        answer, self.answer = self.answer, out_bits
        return answer & ((1 << length) - 1)


class Bench:
    def __init__(self, ccr: int = 7, brr: int = 9, ctl: int = MASTER_TALK) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        cpu = Cpu(self.clock, self.findings)
        self.regs = SpiRegs("SpiaRegs", 0x6100, cpu)
        self.chip_select = Wire("cs", pull=1)
        self.slave = EchoSlave()
        self.bus = bus = SpiBus("spia")
        bus.attach(self.chip_select, self.slave)
        self.chip_select.drive("test", 0)
        self.rx: list[int] = []
        self.tx: list[int] = []
        self.spi = Spi(
            self.clock, cpu, self.regs, bus,
            lambda: self.rx.append(self.clock.now), lambda: self.tx.append(self.clock.now),
        )  # fmt: skip
        self.regs.SPICTL.all = ctl
        self.regs.SPIBRR.all = brr
        self.regs.SPICCR.all = ccr | RUN

    def word(self, word: int) -> int:
        """Send one word and read what came, as a driver does."""
        self.regs.SPITXBUF = word
        while self.regs.SPISTS.bit.INT_FLAG == 0:
            self.clock.advance_to(self.clock.next)
        return self.regs.SPIRXBUF


@pytest.fixture
def bench() -> Bench:
    """8-bit words, BRR 9: a bit lasts 40 cycles, a word 320."""
    return Bench()


def told(bench: Bench) -> list[str]:
    return [finding.message for finding in bench.findings if finding.rule == "not-configured"]


def test_a_part_that_only_listens_needs_no_somi(bench: Bench) -> None:
    bench.bus.somi, bench.bus.no_somi = False, "GPIO17 has function 0"
    bench.word(0x5A00)
    assert [seen[0] for seen in bench.slave.seen] == [0x5A]
    assert told(bench) == []
    # The echo of the word before: now there is something that does not come.
    assert bench.word(0x0100) & 0xFF == 0
    assert len(told(bench)) == 1
    assert "GPIO17 has function 0: the answer does not reach the module" in told(bench)[0]


def test_a_part_that_only_talks_needs_no_simo(bench: Bench) -> None:
    bench.bus.simo, bench.bus.no_simo = False, "GPIO16 has function 0"
    bench.slave.answer = 0x3C
    assert bench.word(0xFF00) & 0xFF == 0x3C
    bench.word(0xFF00)
    assert told(bench) == []
    bench.word(0x8F00)
    assert {seen[0] for seen in bench.slave.seen} == {0}
    assert len(told(bench)) == 1
    assert "GPIO16 has function 0: the word does not reach the bus" in told(bench)[0]


def test_a_word_completes_after_length_times_bit_and_not_a_cycle_earlier(bench: Bench) -> None:
    bench.regs.SPITXBUF = 0x9800
    bench.clock.advance_to(319)
    assert bench.regs.SPISTS.bit.INT_FLAG == 0
    assert bench.slave.seen == []
    bench.clock.advance_to(320)
    assert bench.regs.SPISTS.bit.INT_FLAG == 1
    assert bench.slave.seen == [(0x98, 8, 0, 1)]


@pytest.mark.parametrize(
    ("brr", "cycles_per_bit"),
    # LSPCLK/(BRR+1) from 3 on, LSPCLK/4 below; a LSPCLK cycle is 4 SYSCLK cycles.
    [(0, 16), (1, 16), (2, 16), (3, 16), (4, 20), (127, 512)],
)
def test_baud_rate(brr: int, cycles_per_bit: int) -> None:
    bench = Bench(ccr=15, brr=brr)
    bench.regs.SPITXBUF = 1
    bench.clock.advance_to(bench.clock.next)
    assert bench.clock.now == 16 * cycles_per_bit


#: (CLKPOLARITY, CLK_PHASE) of each mode: the phase bit is the inverse of CPHA.
MODES = [(0, 1), (0, 0), (1, 1), (1, 0)]


@pytest.mark.parametrize("mode", range(4))
@pytest.mark.parametrize("modes", [(1,), (0, 3), (0, 1, 2, 3), None])
def test_a_part_that_declares_its_modes(mode: int, modes: tuple[int, ...] | None) -> None:
    polarity, phase = MODES[mode]
    bench = Bench(ccr=7 | polarity << 6, ctl=MASTER_TALK | phase << 3)
    part = EchoSlave()
    other = Wire("other", pull=1)
    if modes is not None:
        part.clock_modes = modes  # type: ignore[attr-defined]
    bench.bus.attach(other, part)
    bench.word(0x4200)
    assert [f.rule for f in bench.findings] == []  # another part was meant
    bench.chip_select.drive("test", 1)
    other.drive("test", 0)
    bench.word(0x4200)
    told = [f.message for f in bench.findings]
    assert len(told) == int(modes is not None and mode not in modes)
    assert all(f"has mode {mode}: CLKPOLARITY = {polarity}, CLK_PHASE = {phase}" in message for message in told)
    assert [seen[2:] for seen in part.seen] == [(mode >> 1, mode & 1)]


@pytest.mark.parametrize("modes", [(), (4,), (-1, 0)])
def test_modes_that_no_bus_has(bench: Bench, modes: tuple[int, ...]) -> None:
    part = EchoSlave()
    part.clock_modes = modes  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="clock_modes of EchoSlave: expected some of 0, 1, 2 and 3"):
        bench.bus.attach(Wire("other", pull=1), part)


def test_transmit_takes_bits_from_bit_15_downward(bench: Bench) -> None:
    # An unshifted 0x0055 with 8-bit characters sends its upper byte, 0.
    bench.word(0x0055)
    bench.word(0x5500)
    assert [seen[0] for seen in bench.slave.seen] == [0x00, 0x55]


def test_receive_is_right_justified_under_stale_transmit_bits(bench: Bench) -> None:
    # 16-bit SPIDAT shifted left 8 times: the low byte of 0x98AB moves up, the answer (0) comes in below.
    assert bench.word(0x98AB) == 0xAB00
    # The echo of 0x98 under the old low byte 0.
    assert bench.word(0x1200) == 0x0098


def test_loopback_returns_the_word_and_leaves_the_bus_quiet() -> None:
    bench = Bench(ccr=7 | 0x10)
    assert bench.word(0x9800) == 0x0098
    assert bench.slave.seen == []


@given(word=st.integers(0, 0xFFFF), length=st.integers(1, 16), answer=st.integers(0, 0xFFFF))
def test_shift_register_equals_bit_by_bit_shifting(word: int, length: int, answer: int) -> None:
    bench = Bench(ccr=length - 1)
    bench.slave.answer = answer
    dat, out = word, 0
    for i in range(length):
        out = out << 1 | dat >> 15
        dat = (dat << 1 | answer >> (length - 1 - i) & 1) & 0xFFFF
    assert bench.word(word) == dat
    assert bench.slave.seen == [(out, length, 0, 1)]


@pytest.mark.parametrize(
    ("polarity", "phase", "cpol", "cpha"),
    # TRM clock schemes: CLK_PHASE is the inverse of CPHA.
    [(0, 1, 0, 0), (0, 0, 0, 1), (1, 1, 1, 0), (1, 0, 1, 1)],
)
def test_clock_scheme(bench: Bench, polarity: int, phase: int, cpol: int, cpha: int) -> None:
    bench.regs.SPICCR.bit.CLKPOLARITY = polarity
    bench.regs.SPICTL.bit.CLK_PHASE = phase
    bench.word(0)
    assert bench.slave.seen == [(0, 8, cpol, cpha)]


def test_int_flag_is_cleared_only_by_reading_spirxbuf(bench: Bench) -> None:
    bench.regs.SPITXBUF = 0
    bench.clock.advance_to(320)
    bench.regs.SPISTS.all = 0xFFFF
    assert bench.regs.SPIRXEMU == 0
    assert bench.regs.SPISTS.bit.INT_FLAG == 1
    bench.regs.SPIRXBUF
    assert bench.regs.SPISTS.bit.INT_FLAG == 0


def test_overrun_keeps_the_new_word_and_is_cleared_by_writing_1_only(bench: Bench) -> None:
    bench.slave.answer = 0x11
    for word in (0x2200, 0x3300):
        bench.regs.SPITXBUF = word
        bench.clock.advance_to(bench.clock.now + 320)
    assert bench.regs.SPISTS.bit.OVERRUN_FLAG == 1
    assert not bench.findings.of("data-lost")  # it may only send
    assert bench.regs.SPIRXBUF == 0x22
    assert len(bench.findings.of("data-lost")) == 1
    assert bench.regs.SPISTS.all == 0x80
    bench.regs.SPISTS.bit.OVERRUN_FLAG = 1
    assert bench.regs.SPISTS.all == 0


def test_second_word_waits_in_the_buffer_and_follows_without_a_gap(bench: Bench) -> None:
    bench.regs.SPITXBUF = 0x1100
    assert bench.regs.SPISTS.bit.BUFFULL_FLAG == 0
    bench.regs.SPITXBUF = 0x2200
    assert bench.regs.SPISTS.bit.BUFFULL_FLAG == 1
    bench.clock.advance_to(639)
    assert [seen[0] for seen in bench.slave.seen] == [0x11]
    assert bench.regs.SPISTS.bit.BUFFULL_FLAG == 0
    bench.clock.advance_to(640)
    assert [seen[0] for seen in bench.slave.seen] == [0x11, 0x22]
    assert not bench.spi.busy


def test_third_word_overwrites_the_waiting_one(bench: Bench) -> None:
    for word in (0x1100, 0x2200, 0x3300):
        bench.regs.SPITXBUF = word
    bench.clock.advance_to(10_000)
    assert [seen[0] for seen in bench.slave.seen] == [0x11, 0x33]
    assert bench.findings.of("data-lost")


def test_spidat_starts_a_word_too(bench: Bench) -> None:
    bench.regs.SPIDAT = 0x7700
    bench.clock.advance_to(320)
    assert bench.slave.seen == [(0x77, 8, 0, 1)]


def test_a_deselected_slave_is_not_seen_and_the_line_reads_idle(bench: Bench) -> None:
    bench.slave.answer = 0xFF
    bench.chip_select.drive("test", 1)
    assert bench.word(0x1100) == 0
    assert bench.slave.seen == []


def test_talk_0_clocks_without_driving_simo(bench: Bench) -> None:
    bench.regs.SPICTL.bit.TALK = 0
    bench.slave.answer = 0x5A
    assert bench.word(0xFF00) == 0x5A
    assert bench.slave.seen[0][0] == 0


def test_swreset_0_stops_the_word_and_clears_flags_but_not_configuration(bench: Bench) -> None:
    bench.word(0x1100)
    bench.regs.SPITXBUF = 0x2200
    bench.regs.SPITXBUF = 0x3300
    bench.regs.SPICCR.bit.SPISWRESET = 0
    assert bench.regs.SPISTS.all == 0
    assert bench.regs.SPIBRR.all == 9
    bench.regs.SPITXBUF = 0x4400
    bench.regs.SPICCR.bit.SPISWRESET = 1
    bench.clock.advance_to(10_000)
    assert [seen[0] for seen in bench.slave.seen] == [0x11]


def test_slave_mode_is_reported_as_unmodelled() -> None:
    bench = Bench(ctl=0x02)
    bench.regs.SPITXBUF = 0x1100
    bench.clock.advance_to(10_000)
    assert bench.findings.of("unmodelled")
    assert bench.regs.SPISTS.all == 0


def test_interrupt_pulses_when_int_flag_rises_and_is_enabled(bench: Bench) -> None:
    bench.word(0)
    assert bench.rx == []
    bench.regs.SPICTL.bit.SPIINTENA = 1
    bench.word(0)
    assert bench.rx == [640]
    assert bench.tx == []


def test_overrun_interrupt_comes_once_until_the_flag_is_cleared(bench: Bench) -> None:
    bench.regs.SPICTL.bit.OVERRUNINTENA = 1
    for _ in range(3):
        bench.regs.SPITXBUF = 0
        bench.clock.advance_to(bench.clock.now + 320)
    assert bench.rx == [640]
    bench.regs.SPISTS.bit.OVERRUN_FLAG = 1
    bench.regs.SPITXBUF = 0
    bench.clock.advance_to(bench.clock.now + 320)
    assert bench.rx == [640, 1280]


def fifo_bench() -> Bench:
    bench = Bench()
    bench.regs.SPIFFTX.all = 0xE000
    return bench


def test_fifo_takes_16_words_behind_the_one_in_the_shifter_and_drops_the_next() -> None:
    bench = fifo_bench()
    for n in range(18):
        bench.regs.SPITXBUF = n << 8
    assert bench.regs.SPIFFTX.bit.TXFFST == 16
    assert len(bench.findings.of("data-lost")) == 1
    bench.clock.advance_to(17 * 320)
    assert [seen[0] for seen in bench.slave.seen] == list(range(17))
    assert bench.regs.SPIFFTX.bit.TXFFST == 0


def test_receive_fifo_pops_in_order_and_repeats_the_last_word_when_empty() -> None:
    bench = fifo_bench()
    for n in (1, 2, 3):
        bench.regs.SPITXBUF = n << 8
    bench.clock.advance_to(3 * 320)
    assert bench.regs.SPIFFRX.bit.RXFFST == 3
    assert bench.regs.SPIRXEMU == 0
    # The echo slave answers with the word before: 0, 1, 2.
    assert [bench.regs.SPIRXBUF for _ in range(4)] == [0, 1, 2, 2]
    assert bench.regs.SPIFFRX.bit.RXFFST == 0


def test_receive_fifo_overflow_loses_the_oldest_word() -> None:
    bench = fifo_bench()
    for n in range(17):
        bench.regs.SPITXBUF = (n + 1) << 8
    bench.clock.advance_to(17 * 320)
    assert bench.regs.SPIFFRX.bit.RXFFOVF == 1
    # 17 echoes 0..16 came, the first (0) is lost.
    assert not bench.findings.of("data-lost")
    assert [bench.regs.SPIRXBUF for _ in range(16)] == list(range(1, 17))
    assert len(bench.findings.of("data-lost")) == 1
    bench.regs.SPIFFRX.bit.RXFFOVFCLR = 1
    assert bench.regs.SPIFFRX.bit.RXFFOVF == 0


def test_a_driver_that_only_sends_loses_nothing_until_it_wants_what_comes() -> None:
    bench = fifo_bench()
    for n in range(40):
        bench.regs.SPITXBUF = n << 8
        bench.clock.advance_to(bench.clock.now + 320)
    assert not bench.findings.of("data-lost")
    bench.regs.SPIFFRX.bit.RXFFIENA = 1
    bench.regs.SPITXBUF = 0
    bench.clock.advance_to(bench.clock.now + 320)
    assert len(bench.findings.of("data-lost")) == 1


def test_txdly_adds_bit_times_between_fifo_words() -> None:
    bench = fifo_bench()
    bench.regs.SPIFFCT.bit.TXDLY = 3
    bench.regs.SPITXBUF = 0
    bench.regs.SPITXBUF = 0
    # Two words of 320 and three bits of 40 between them end at 760.
    bench.clock.advance_to(759)
    assert len(bench.slave.seen) == 1
    bench.clock.advance_to(760)
    assert len(bench.slave.seen) == 2


def test_transmit_fifo_interrupt_fires_with_an_empty_fifo_when_enabled() -> None:
    bench = fifo_bench()
    bench.regs.SPIFFTX.bit.TXFFINTCLR = 1
    assert bench.tx == []
    bench.regs.SPIFFTX.bit.TXFFIENA = 1
    assert bench.tx == [0]


def test_receive_fifo_interrupt_at_its_level_and_again_after_a_clear_that_does_not_last() -> None:
    bench = fifo_bench()
    bench.regs.SPIFFRX.all = 0x2000 | 0x20 | 2
    for _ in range(3):
        bench.regs.SPITXBUF = 0
    bench.clock.advance_to(3 * 320)
    assert bench.rx == [640]
    bench.regs.SPIFFRX.bit.RXFFINTCLR = 1
    assert bench.rx == [640, 960]
    bench.regs.SPIRXBUF
    bench.regs.SPIRXBUF
    bench.regs.SPIFFRX.bit.RXFFINTCLR = 1
    assert bench.rx == [640, 960]
    assert bench.regs.SPIFFRX.bit.RXFFINT == 0


def test_swreset_keeps_the_fifo_configuration_and_words() -> None:
    bench = Bench()
    bench.regs.SPICCR.bit.SPISWRESET = 0
    bench.regs.SPIFFTX.all = 0xE000
    bench.regs.SPITXBUF = 0x4200
    bench.regs.SPICCR.bit.SPISWRESET = 1
    bench.clock.advance_to(320)
    assert bench.slave.seen == [(0x42, 8, 0, 1)]


@pytest.mark.parametrize("bit", ["SPIRST", "TXFIFO"])
def test_fifo_resets_empty_the_transmit_fifo(bit: str) -> None:
    bench = fifo_bench()
    for _ in range(3):
        bench.regs.SPITXBUF = 0
    assert bench.regs.SPIFFTX.bit.TXFFST == 2
    setattr(bench.regs.SPIFFTX.bit, bit, 0)
    assert bench.regs.SPIFFTX.bit.TXFFST == 0


def test_module_reset_returns_every_register_to_its_reset_value() -> None:
    bench = fifo_bench()
    bench.regs.SPITXBUF = 0x1100
    bench.spi.reset()
    assert {r.name: r.value for r in bench.regs} == {r.name: r.reset_value for r in bench.regs}
    assert bench.regs.SPIFFTX.all == 0xA000
    assert bench.regs.SPIFFRX.all == 0x201F
    bench.clock.advance_to(10_000)
    assert bench.slave.seen == []


def test_3_wire_mode_is_reported() -> None:
    bench = Bench()
    bench.regs.SPIPRI.bit.TRIWIRE = 1
    assert [finding.object for finding in bench.findings.of("unmodelled")] == ["SpiaRegs.SPIPRI.TRIWIRE"]
