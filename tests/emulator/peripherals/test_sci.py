"""One SCI alone, in register language: transmitter and module.  Facts: TRM SCI chapter."""

from __future__ import annotations

import pytest

from emulator.signals import SerialFrame
from tests.emulator.peripherals.sci_bench import BIT, FRAME, Bench


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture
def fifo() -> Bench:
    return Bench(fifo=True)


# --- transmitter ------------------------------------------------------------------------------------------------------


def test_8n1_frame_at_9600_ends_after_208320_cycles(bench: Bench) -> None:
    bench.put(0x41)
    bench.clock.advance_to(FRAME - 1)
    assert bench.sent == []
    bench.clock.advance_to(FRAME)
    assert bench.sent == [SerialFrame(0x41, 0, FRAME, BIT)]


@pytest.mark.parametrize(
    ("ccr", "bits", "parity"),
    # start + data + parity + stop
    [
        (0x07, 10, None),
        (0x27, 11, "odd"),
        (0x67, 11, "even"),
        (0x87, 11, None),
        (0xE6, 11, "even"),
        (0x00, 3, None),
    ],
)
def test_frame_length(ccr: int, bits: int, parity: str | None) -> None:
    bench = Bench(ccr)
    bench.put(0xFF)
    bench.clock.advance_to(bits * BIT)
    (frame,) = bench.sent
    assert (frame.end, frame.parity, frame.data_bits) == (bits * BIT, parity, (ccr & 7) + 1)
    assert frame.data == (1 << frame.data_bits) - 1


@pytest.mark.parametrize(
    ("brr", "bit"),
    # 8 * (BRR + 1) LSPCLK, 16 at BRR = 0; 4 SYSCLK each.
    [(0, 64), (1, 64), (53, 1728), (65535, 2_097_152)],
)
def test_baud_rate(brr: int, bit: int) -> None:
    bench = Bench(brr=brr)
    bench.put(0)
    bench.clock.advance_to(10 * bit)
    assert bench.sent[0].bit_cycles == bit
    assert bench.sent[0].end == 10 * bit


def test_txrdy_is_buffer_and_txempty_is_buffer_and_shifter(bench: Bench) -> None:
    states = [bench.regs.SCICTL2.all]
    for data in (1, 2):
        bench.put(data)
        states.append(bench.regs.SCICTL2.all)
    for end in (FRAME, 2 * FRAME):
        bench.clock.advance_to(end)
        states.append(bench.regs.SCICTL2.all)
    # idle; one in the shifter; one more waits; it moved up; all out.
    assert states == [0xC0, 0x80, 0x00, 0x80, 0xC0]
    assert [(frame.data, frame.start) for frame in bench.sent] == [(1, 0), (2, FRAME)]


def test_writing_with_txrdy_0_loses_the_waiting_character(bench: Bench) -> None:
    for data in (1, 2, 3):
        bench.put(data)
    bench.clock.advance_to(10 * FRAME)
    assert [frame.data for frame in bench.sent] == [1, 3]
    assert bench.findings.of("data-lost")


def test_tx_interrupt_when_txrdy_rises(bench: Bench) -> None:
    bench.regs.SCICTL2.bit.TXINTENA = 1
    assert bench.tx == []
    bench.put(1)
    bench.put(2)
    bench.clock.advance_to(5 * FRAME)
    assert bench.tx == [0, FRAME]


def test_txena_0_stops_after_the_current_frame(fifo: Bench) -> None:
    fifo.put(1)
    fifo.put(2)
    fifo.regs.SCICTL1.bit.TXENA = 0
    fifo.clock.advance_to(5 * FRAME)
    assert [frame.data for frame in fifo.sent] == [1]
    fifo.regs.SCICTL1.bit.TXENA = 1
    fifo.clock.advance_to(6 * FRAME)
    assert [(frame.data, frame.end) for frame in fifo.sent] == [(1, FRAME), (2, 6 * FRAME)]


def test_swreset_0_abandons_the_frame_and_keeps_the_configuration(bench: Bench) -> None:
    bench.put(1)
    bench.put(2)
    bench.regs.SCICTL1.bit.SWRESET = 0
    assert bench.regs.SCICTL2.all == 0xC0
    assert (bench.regs.SCIHBAUD.all, bench.regs.SCILBAUD.all) == (0x02, 0x8A)
    bench.put(3)
    bench.regs.SCICTL1.bit.SWRESET = 1
    bench.clock.advance_to(5 * FRAME)
    assert bench.sent == []


def test_tx_fifo_takes_16_behind_the_shifter_and_sends_without_gaps(fifo: Bench) -> None:
    for data in range(18):
        fifo.put(data)
    assert fifo.regs.SCIFFTX.bit.TXFFST == 16
    assert fifo.regs.SCICTL2.bit.TXRDY == 0
    fifo.clock.advance_to(17 * FRAME - 1)
    assert fifo.regs.SCICTL2.all == 0x80
    fifo.clock.advance_to(17 * FRAME)
    assert [(frame.data, frame.end) for frame in fifo.sent] == [(n, (n + 1) * FRAME) for n in range(17)]
    assert fifo.regs.SCICTL2.all == 0xC0


def test_fftxdly_adds_bit_times_between_characters(fifo: Bench) -> None:
    fifo.regs.SCIFFCT.bit.FFTXDLY = 2
    fifo.put(1)
    fifo.put(2)
    fifo.clock.advance_to(5 * FRAME)
    assert [frame.end for frame in fifo.sent] == [FRAME, 2 * FRAME + 2 * BIT]


def test_tx_fifo_interrupt_fires_with_an_empty_fifo_when_it_is_enabled(fifo: Bench) -> None:
    fifo.regs.SCIFFTX.bit.TXFFINTCLR = 1
    assert fifo.tx == []
    fifo.regs.SCIFFTX.bit.TXFFIENA = 1
    assert fifo.tx == [0]
    # Clearing it with the FIFO still empty pulses again; with a character in the FIFO it stays away until that moved.
    fifo.regs.SCIFFTX.bit.TXFFINTCLR = 1
    assert fifo.tx == [0, 0]
    fifo.put(1)
    fifo.put(2)
    fifo.regs.SCIFFTX.bit.TXFFINTCLR = 1
    assert fifo.tx == [0, 0]
    fifo.clock.advance_to(FRAME)
    assert fifo.tx == [0, 0, FRAME]


@pytest.mark.parametrize("bit", ["TXFIFORESET", "SCIRST"])
def test_fifo_resets_empty_the_fifo_and_hold_it(fifo: Bench, bit: str) -> None:
    for data in range(3):
        fifo.put(data)
    setattr(fifo.regs.SCIFFTX.bit, bit, 0)
    assert fifo.regs.SCIFFTX.bit.TXFFST == 0
    setattr(fifo.regs.SCIFFTX.bit, bit, 1)
    fifo.clock.advance_to(5 * FRAME)
    # TXFIFORESET empties the FIFO behind the shifter, SCIRST stops the channel with the shifter.
    assert [frame.data for frame in fifo.sent] == ([0] if bit == "TXFIFORESET" else [])


# --- the rest ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("register", "field"),
    [("SCICCR", "ADDRIDLE_MODE"), ("SCICTL1", "SLEEP"), ("SCICTL1", "TXWAKE"), ("SCIFFCT", "CDC")],
)
def test_unmodelled_fields_are_reported_by_name(bench: Bench, register: str, field: str) -> None:
    setattr(bench.regs.registers[register].bit, field, 1)
    assert [finding.object for finding in bench.findings.of("unmodelled")] == [f"ScicRegs.{register}.{field}"]


def test_module_reset_returns_every_register_to_its_reset_value(fifo: Bench) -> None:
    fifo.put(1)
    fifo.receive(2)
    fifo.sci.reset()
    assert {r.name: r.value for r in fifo.regs} == {r.name: r.reset_value for r in fifo.regs}
    assert (fifo.regs.SCICTL2.all, fifo.regs.SCIFFTX.all, fifo.regs.SCIFFRX.all) == (0xC0, 0xA000, 0x201F)


def test_a_gated_module_hears_nothing(bench: Bench) -> None:
    bench.regs.set_clock(False)
    bench.receive(1)
    bench.regs.set_clock(True)
    assert bench.regs.SCIRXST.all == 0
