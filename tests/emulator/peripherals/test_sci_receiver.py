"""The receiving half of an SCI, in register language.  Facts: TRM SCI chapter."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.signals import SerialFrame
from tests.emulator.peripherals.sci_bench import BIT, FIFO_ON, FRAME, Bench


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture
def fifo() -> Bench:
    return Bench(fifo=True)


# --- receiver ---------------------------------------------------------------------------------------------------------


def test_a_character_waits_in_scirxbuf_until_it_is_read(bench: Bench) -> None:
    bench.receive(0xA5)
    assert bench.regs.SCIRXST.all == 0x40
    assert bench.regs.SCIRXEMU.bit.ERXDT == 0xA5
    assert bench.regs.SCIRXST.bit.RXRDY == 1
    assert bench.regs.SCIRXBUF.all == 0xA5
    assert bench.regs.SCIRXST.all == 0


def test_overrun_keeps_the_new_character_and_latches_oe(bench: Bench) -> None:
    bench.receive(1)
    bench.receive(2)
    assert bench.regs.SCIRXBUF.all == 2
    # OE and RXERROR; reading cleared RXRDY only.
    assert bench.regs.SCIRXST.all == 0x88
    bench.regs.SCIRXST.all = 0xFF
    assert bench.regs.SCIRXST.all == 0x88
    bench.regs.SCICTL1.bit.SWRESET = 0
    bench.regs.SCICTL1.bit.SWRESET = 1
    assert bench.regs.SCIRXST.all == 0


def test_framing_error_is_flagged_and_the_character_is_delivered(bench: Bench) -> None:
    bench.receive(0x55, framing_error=True)
    assert bench.regs.SCIRXST.all == 0x80 | 0x40 | 0x10
    # Without FIFO the error bits of SCIRXBUF stay 0.
    assert bench.regs.SCIRXBUF.all == 0x55


def test_parity_error() -> None:
    bench = Bench(7 | 0x60)
    bench.receive(0x03, parity="even")
    assert bench.regs.SCIRXST.bit.PE == 0
    bench.regs.SCIRXBUF.all
    bench.receive(0x03, parity="odd")
    assert bench.regs.SCIRXST.all == 0x80 | 0x40 | 0x04


def test_rx_interrupts_of_character_and_error_are_separate(bench: Bench) -> None:
    bench.receive(1)
    assert bench.rx == []
    bench.regs.SCIRXBUF.all
    bench.regs.SCICTL2.bit.RXBKINTENA = 1
    bench.receive(2)
    assert bench.rx == [2 * FRAME]
    bench.regs.SCICTL2.bit.RXBKINTENA = 0
    bench.regs.SCICTL1.bit.RXERRINTENA = 1
    bench.receive(3)
    # Overrun: the error interrupt, once while RXERROR stays.
    bench.receive(4)
    assert bench.rx == [2 * FRAME, 3 * FRAME]


def test_rxena_0_keeps_characters_out(bench: Bench) -> None:
    bench.regs.SCICTL1.bit.RXENA = 0
    bench.receive(1)
    assert bench.regs.SCIRXST.all == 0


def test_rx_fifo_carries_error_bits_with_their_character(fifo: Bench) -> None:
    fifo.receive(1)
    fifo.receive(2, framing_error=True)
    fifo.receive(3)
    assert fifo.regs.SCIFFRX.bit.RXFFST == 3
    # The bad character is not at the head yet.
    assert fifo.regs.SCIRXST.bit.FE == 0
    assert fifo.regs.SCIRXBUF.all == 1
    assert fifo.regs.SCIRXST.bit.FE == 1
    assert [fifo.regs.SCIRXBUF.all for _ in range(3)] == [0x8002, 3, 3]
    assert fifo.regs.SCIRXST.bit.RXRDY == 0


def test_rx_fifo_overflow_loses_the_oldest_and_is_cleared_by_its_own_bit(fifo: Bench) -> None:
    for data in range(17):
        fifo.receive(data)
    assert fifo.regs.SCIFFRX.bit.RXFFOVF == 1
    assert fifo.regs.SCIRXST.bit.OE == 1
    fifo.regs.SCIFFRX.bit.RXFFOVRCLR = 1
    assert fifo.regs.SCIFFRX.bit.RXFFOVF == 0
    assert [fifo.regs.SCIRXBUF.all for _ in range(16)] == list(range(1, 17))


def test_rx_fifo_interrupt_at_its_level(fifo: Bench) -> None:
    fifo.regs.SCIFFRX.all = 0x2000 | 0x20 | 2
    for data in range(3):
        fifo.receive(data)
    assert fifo.rx == [2 * FRAME]
    fifo.regs.SCIRXBUF.all
    # Two are left: the level still holds.
    fifo.regs.SCIFFRX.bit.RXFFINTCLR = 1
    assert fifo.rx == [2 * FRAME, 3 * FRAME]
    fifo.regs.SCIRXBUF.all
    fifo.regs.SCIFFRX.bit.RXFFINTCLR = 1
    assert fifo.rx == [2 * FRAME, 3 * FRAME]


def test_loopback_returns_the_character_and_leaves_both_lines_alone() -> None:
    bench = Bench(7 | 0x10)
    bench.put(0x3C)
    bench.receive(0x11)
    assert bench.regs.SCIRXBUF.all == 0x3C
    assert bench.sent == []


def test_a_program_that_only_hears_itself_loses_nothing_before_it_reads() -> None:
    bench = Bench(7 | 0x10)
    for data in (1, 2, 3):
        bench.put(data)
        bench.pass_bits(10)
    assert bench.regs.SCIRXST.bit.OE == 1
    assert list(bench.findings) == []
    assert bench.regs.SCIRXBUF.all == 3
    assert [finding.rule for finding in bench.findings] == ["data-lost"]


# --- break ------------------------------------------------------------------------------------------------------------


def test_line_held_low_is_a_zero_with_fe_and_then_a_break(bench: Bench) -> None:
    bench.rx_line.hold_low(True)
    bench.pass_bits(10)
    assert bench.regs.SCIRXST.all == 0x80 | 0x40 | 0x10
    assert bench.regs.SCIRXBUF.all == 0
    # Ten bits more behind the missing stop bit.
    bench.clock.advance_to(20 * BIT - 1)
    assert bench.regs.SCIRXST.bit.BRKDT == 0
    bench.clock.advance_to(20 * BIT)
    assert bench.regs.SCIRXST.all == 0x80 | 0x20 | 0x10


def test_after_a_break_nothing_is_received_until_swreset(bench: Bench) -> None:
    bench.rx_line.hold_low(True)
    bench.pass_bits(30)
    bench.rx_line.hold_low(False)
    bench.regs.SCIRXBUF.all
    bench.receive(1)
    assert bench.regs.SCIRXST.bit.RXRDY == 0
    bench.regs.SCICTL1.bit.SWRESET = 0
    bench.regs.SCICTL1.bit.SWRESET = 1
    bench.receive(2)
    assert bench.regs.SCIRXST.all == 0x40
    assert bench.regs.SCIRXBUF.all == 2


def test_a_line_that_is_low_at_start_up_stops_reception() -> None:
    bench = Bench()
    bench.regs.SCICTL1.bit.SWRESET = 0
    bench.rx_line.hold_low(True)
    bench.regs.SCICTL1.bit.SWRESET = 1
    bench.pass_bits(20)
    assert bench.regs.SCIRXST.bit.BRKDT == 1


def test_low_for_less_than_a_break_is_only_a_framing_error(bench: Bench) -> None:
    bench.rx_line.hold_low(True)
    bench.pass_bits(19)
    bench.rx_line.hold_low(False)
    bench.pass_bits(20)
    assert bench.regs.SCIRXST.bit.BRKDT == 0
    bench.regs.SCIRXBUF.all
    bench.receive(7)
    assert bench.regs.SCIRXBUF.all == 7


@pytest.mark.parametrize(
    ("bits", "received"),
    # A start bit needs four low samples; the fourth is taken at 3.5/8 = 0.4375 bits.
    [(0.4, None), (0.5, 0xFF), (1.0, 0xFF), (3.0, 0xFC)],
)
def test_glitch_of_the_idle_line(bench: Bench, bits: float, received: int | None) -> None:
    bench.rx_line.hold_low(True)
    bench.pass_bits(bits)
    bench.rx_line.hold_low(False)
    bench.pass_bits(12)
    if received is None:
        assert bench.regs.SCIRXST.all == 0
    else:
        assert (bench.regs.SCIRXST.all, bench.regs.SCIRXBUF.all) == (0x40, received)


def test_break_interrupts_through_rxbkintena_only_without_fifo(bench: Bench, fifo: Bench) -> None:
    for each in (bench, fifo):
        each.regs.SCICTL2.bit.RXBKINTENA = 1
        each.rx_line.hold_low(True)
        each.clock.advance_to(20 * BIT)
    assert bench.rx == [10 * BIT, 20 * BIT]
    assert fifo.rx == []


# --- mismatch ---------------------------------------------------------------------------------------------------------


@given(data=st.integers(0, 255), ratio=st.floats(0.965, 1.035))
def test_up_to_3_5_percent_of_baud_error_is_harmless(data: int, ratio: float) -> None:
    bench = Bench()
    bench.receive(data, BIT * ratio)
    assert (bench.regs.SCIRXST.all, bench.regs.SCIRXBUF.all) == (0x40, data)


@given(data=st.integers(0, 255))
def test_a_vote_lost_to_the_next_bit_is_outvoted(data: int) -> None:
    # Own bits 4.5 % long: vote 6 of data bit 6 lies at 7.6875 * 1.045 = 8.03 of the sender's bits, in data bit 7, but
    # vote 5 of the stop bit at 9.5625 * 1.045 = 9.993 is still in the stop bit.
    bench = Bench()
    bench.receive(data, BIT / 1.045)
    assert (bench.regs.SCIRXST.all, bench.regs.SCIRXBUF.all) == (0x40, data)


@pytest.mark.parametrize("ratio", [1 / 1.045, 1 / 1.02, 1.0, 1.05])
def test_a_gapless_stream_keeps_its_place_within_the_budget(fifo: Bench, ratio: float) -> None:
    # Own bits 4.5 % long or 5 % short: the last vote but one of the stop bit still falls into the stop bit.
    stream = [0x00, 0xFF, 0x55, 0x80, 0x01, 0x7F] * 2
    for data in stream:
        fifo.receive(data, BIT * ratio)
    assert [fifo.regs.SCIRXBUF.all for _ in stream] == stream
    assert fifo.regs.SCIRXST.all == 0


def test_a_sender_10_percent_slow_gives_framing_errors_on_trailing_zeros_first() -> None:
    # Vote 5 of the stop bit lies at 9.5625 own bits = 8.69 of the sender's: still data bit 7.
    bench = Bench()
    bench.receive(0x7F, BIT * 1.1)
    assert bench.regs.SCIRXST.bit.FE == 1
    bench = Bench()
    bench.receive(0x80, BIT * 1.1)
    assert bench.regs.SCIRXST.bit.FE == 0


def test_a_receiver_twice_as_fast_sees_two_characters_of_doubled_bits(fifo: Bench) -> None:
    # Own bits 0..9 are start start b0 b0 b1 b1 b2 b2 b3 b3; b3 = 1 is taken for the stop bit.  The next falling edge
    # is b4, after which own bits are b4 (start) b4 b5 b5 b6 b6 b7 b7 stop and idle.
    fifo.receive(0b1010_1010, BIT * 2)
    # First: 0; b0 b0 = 00; b1 b1 = 11; b2 b2 = 00; b3 = 1, lowest bit first.  Second: 0; 11; 00; 11; 1.
    assert fifo.regs.SCIFFRX.bit.RXFFST == 2
    assert [fifo.regs.SCIRXBUF.all for _ in range(2)] == [0b1001_1000, 0b1110_0110]
    assert fifo.regs.SCIRXST.bit.RXERROR == 0


def test_parity_of_the_sender_that_the_receiver_does_not_know_is_taken_as_stop_bit() -> None:
    bench = Bench()
    # Even parity of one 1 is 1: looks like a stop bit.  Of two: 0, a framing error.
    bench.receive(0x01, parity="even")
    assert bench.regs.SCIRXST.bit.FE == 0
    bench.receive(0x03, parity="even")
    assert bench.regs.SCIRXST.bit.FE == 1


def test_two_modules_understand_each_other_at_every_format() -> None:
    for ccr in [char | flags for char in range(8) for flags in (0, 0x20, 0x60, 0x80, 0xE0)]:
        one, other = Bench(ccr), Bench(ccr)
        one.tx_line.sent.connect(lambda frame, other=other: other.rx_line.send(frame))  # type: ignore[misc]
        one.put(0x5A)
        one.clock.advance_to(13 * BIT)
        mask = (2 << (ccr & 7)) - 1
        assert (other.regs.SCIRXST.all, other.regs.SCIRXBUF.all) == (0x40, 0x5A & mask)


def test_reception_in_the_middle_of_a_stream_slips() -> None:
    """A receiver released from reset inside a character takes the next falling edge for a start bit."""
    bench = Bench()
    bench.regs.SCICTL1.bit.SWRESET = 0
    frame = SerialFrame(0b1110_1111, 0, FRAME, BIT)
    bench.pass_bits(2)
    bench.regs.SCICTL1.bit.SWRESET = 1
    bench.clock.advance_to(FRAME)
    bench.rx_line.send(frame)
    # The only falling edge after 2 bits is data bit 4; above it bits 5, 6, 7, stop and idle are all ones.
    assert bench.regs.SCIRXBUF.all == 0xFF
    bench.rx_line.send(replace(frame, start=2 * FRAME, end=3 * FRAME))
    assert bench.regs.SCIRXBUF.all == 0b1110_1111


def empty(bench: Bench) -> None:
    """What a routine does that has seen RXFFOVF, but for RXFFOVRCLR."""
    bench.regs.SCIFFRX.bit.RXFIFORESET = 0
    bench.regs.SCIFFRX.bit.RXFIFORESET = 1


@pytest.mark.parametrize("cleared", [True, False])
def test_characters_that_an_old_overflow_costs_are_told(fifo: Bench, cleared: bool) -> None:
    for data in range(17):
        fifo.receive(data)
    fifo.regs.cpu.in_interrupt = 1
    empty(fifo)
    if cleared:
        fifo.regs.SCIFFRX.bit.RXFFOVRCLR = 1
    assert [finding.rule for finding in fifo.findings] == ["data-lost"]  # that of the overflow
    # Nothing is lost by emptying an empty one.
    empty(fifo)
    fifo.receive(1)
    empty(fifo)
    assert [finding.rule for finding in fifo.findings][1:] == ([] if cleared else ["flag-not-cleared"])


def test_a_second_overflow_is_a_reason_of_its_own(fifo: Bench) -> None:
    fifo.regs.cpu.in_interrupt = 1
    for _ in range(3):
        for data in range(17):
            fifo.receive(data)
        empty(fifo)
    assert {finding.rule for finding in fifo.findings} == {"data-lost"}


def test_a_fifo_that_is_emptied_by_main_loses_what_it_wants(fifo: Bench) -> None:
    for data in range(17):
        fifo.receive(data)
    for _ in range(3):
        empty(fifo)
        fifo.receive(1)
    assert {finding.rule for finding in fifo.findings} == {"data-lost"}


@pytest.mark.parametrize(("opened", "lost"), [(True, 1), (False, 0)])
def test_a_fifo_that_stays_in_reset_loses_what_comes(opened: bool, lost: int) -> None:
    bench = Bench(fifo=opened)
    bench.regs.SCIFFTX.all = FIFO_ON
    if opened:
        bench.regs.SCIFFRX.bit.RXFIFORESET = 0
    for data in range(15):
        bench.receive(data)
    assert not list(bench.findings)
    bench.receive(15)
    told = list(bench.findings)
    assert [finding.rule for finding in told] == ["data-lost"] * lost
    assert all("held in reset" in finding.message for finding in told)
