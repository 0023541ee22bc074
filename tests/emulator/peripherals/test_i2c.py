"""The I2C as controller, in register language.  Facts: TRM I2C chapter; the choices are those of `i2c.py`."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.emulator.peripherals.i2c_bench import (
    ARBL,
    ARDY,
    BB,
    BIT,
    BYTE,
    DLB,
    IRS,
    MODULE,
    MST,
    NACK,
    NACKMOD,
    NACKSNT,
    RECEIVE,
    RM,
    RRDY,
    RSFULL,
    SCD,
    SEND,
    START,
    STP,
    STT,
    TRX,
    XRDY,
    XSMT,
    Bench,
    Target,
)

BYTES = st.lists(st.integers(0, 255), min_size=1, max_size=20)


@pytest.fixture
def bench() -> Bench:
    return Bench()


# Time


def test_each_step_takes_the_time_of_its_bits(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CDXR.all = 0xA5
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    # SDA falls a module clock after STT; address and byte are 9 bits each, a STOP one.
    address = START + BYTE
    assert bench.target.times == [MODULE, address, address + BYTE, address + BYTE + BIT]
    assert bench.target.text == "S W a5 P"


@given(ipsc=st.integers(0, 255), iccl=st.integers(1, 500), icch=st.integers(1, 500))
def test_a_bit_is_what_prescaler_and_dividers_make_of_sysclk(ipsc: int, iccl: int, icch: int) -> None:
    bench = Bench(ipsc=ipsc, iccl=iccl, icch=icch)
    bench.send(0x11, 0x22)
    # TRM: Tmst = Tmod * ((ICCL + d) + (ICCH + d)), d = 7, 6 for IPSC = 0, 1, else 5.
    d = 7 if ipsc == 0 else 6 if ipsc == 1 else 5
    bench.run(100_000_000)
    assert bench.target.times[3] - bench.target.times[2] == 9 * (ipsc + 1) * (iccl + icch + 2 * d)


def test_the_prescaler_takes_effect_only_when_irs_is_set(bench: Bench) -> None:
    bench.regs.I2CPSC.all = 24
    assert (bench.rules(), bench.regs.I2CPSC.all) == (["i2c-prescaler"], 24)
    assert bench.i2c.bit_cycles == BIT
    bench.regs.I2CMDR.all = 0
    bench.regs.I2CMDR.all = IRS
    # 25 instead of 20 cycles a module clock.
    assert bench.i2c.bit_cycles == BIT // 20 * 25


def test_the_prescaler_may_be_written_again_as_it_is(bench: Bench) -> None:
    bench.regs.I2CPSC.all = 19
    assert bench.rules() == []


# Transmitter


@given(data=BYTES)
def test_a_message_is_start_address_data_stop(data: list[int]) -> None:
    bench = Bench()
    bench.send(*data)
    assert bench.target.text == " ".join(["S W", *(f"{byte:02x}" for byte in data), "P"])
    # The controller has let go: STT, STP and MST are cleared by what they asked for, BB by the STOP.
    assert bench.regs.I2CMDR.all == TRX | IRS
    assert bench.regs.I2CSTR.all == XSMT | XRDY | SCD
    assert bench.rules() == []


def test_without_stp_the_bus_is_held_and_ardy_tells(bench: Bench) -> None:
    bench.send(0x12, 0x34, stop=False)
    assert bench.target.text == "S W 12 34"
    assert bench.has(ARDY)
    assert bench.has(BB)
    assert not bench.has(SCD)
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert bench.target.text == "S W 12 34 P"
    assert bench.regs.I2CMDR.all == TRX | IRS


def test_with_stp_the_count_does_not_set_ardy(bench: Bench) -> None:
    bench.send(0x12)
    assert not bench.has(ARDY)


def test_stp_may_come_while_the_message_runs(bench: Bench) -> None:
    bench.regs.I2CCNT = 2
    bench.regs.I2CMDR.all = SEND
    bench.run(START + BYTE // 2)
    bench.regs.I2CMDR.bit.STP = 1
    bench.regs.I2CDXR.all = 1
    bench.until(XRDY)
    bench.regs.I2CDXR.all = 2
    bench.run()
    # In non-repeat mode it ends at the count, not at once.
    assert bench.target.text == "S W 01 02 P"


def test_an_underflow_holds_scl_until_data_comes(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    assert (bench.target.text, bench.has(XSMT), bench.has(BB)) == ("S W", False, True)
    bench.regs.I2CDXR.all = 0x77
    assert bench.has(XSMT)
    now = bench.clock.now
    bench.run()
    assert bench.target.text == "S W 77 P"
    # On with the next module clock.
    assert bench.target.times[2] == now + MODULE + BYTE


def test_xrdy_falls_with_a_byte_and_rises_when_the_shift_register_takes_it(bench: Bench) -> None:
    bench.regs.I2CCNT = 2
    bench.regs.I2CDXR.all = 1
    assert not bench.has(XRDY)
    bench.regs.I2CMDR.all = SEND | STP
    bench.clock.advance_to(START + BYTE - 1)
    assert not bench.has(XRDY)
    bench.clock.advance_to(START + BYTE)
    assert bench.has(XRDY)


def test_a_byte_that_replaces_one_is_told(bench: Bench) -> None:
    bench.regs.I2CDXR.all = 1
    bench.regs.I2CDXR.all = 2
    assert bench.rules() == ["data-lost"]


def test_i2ccnt_0_is_65536(bench: Bench) -> None:
    bench.regs.I2CCNT = 0
    bench.regs.I2CMDR.all = SEND | STP
    for n in range(300):
        bench.until(XRDY)
        bench.regs.I2CDXR.all = n & 0xFF
    bench.run()
    assert len(bench.target.seen) == 302
    assert bench.has(BB)


def test_in_repeat_mode_the_program_ends_the_message(bench: Bench) -> None:
    bench.regs.I2CCNT = 1  # is not used
    bench.regs.I2CMDR.all = SEND | RM
    for byte in (1, 2, 3):
        bench.until(XRDY)
        bench.regs.I2CDXR.all = byte
    bench.run()
    assert (bench.target.text, bench.has(ARDY)) == ("S W 01 02 03", True)
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert bench.target.text == "S W 01 02 03 P"


def test_in_repeat_mode_stp_ends_it_behind_the_byte_under_way(bench: Bench) -> None:
    bench.regs.I2CMDR.all = SEND | RM
    bench.regs.I2CDXR.all = 1
    bench.run(START + BYTE + BIT)
    bench.regs.I2CDXR.all = 2
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert bench.target.text == "S W 01 P"


def test_ardy_of_the_message_before_is_gone_with_stt(bench: Bench) -> None:
    bench.send(1, stop=False)
    assert bench.has(ARDY)
    bench.regs.I2CMDR.all = SEND
    assert not bench.has(ARDY)


def test_in_repeat_mode_the_end_of_each_byte_sets_ardy(bench: Bench) -> None:
    bench.regs.I2CMDR.all = SEND | RM
    for byte in (1, 2):
        bench.until(ARDY)
        bench.regs.I2CSTR.all = ARDY
        bench.regs.I2CDXR.all = byte
    before = bench.clock.now
    bench.until(ARDY)
    assert bench.clock.now == before + MODULE + BYTE


def test_all_of_rm_stt_and_stp_is_reserved_and_does_nothing(bench: Bench) -> None:
    bench.regs.I2CMDR.all = SEND | RM | STP
    bench.run()
    assert bench.target.text == ""
    assert bench.rules() == ["not-configured"]


# Acknowledgment


def test_nobody_at_the_address(bench: Bench) -> None:
    bench.regs.I2CSAR.all = 0x51
    bench.regs.I2CCNT = 1
    bench.regs.I2CDXR.all = 0x12
    bench.regs.I2CMDR.all = SEND
    bench.run()
    assert bench.target.text == "S"
    assert bench.regs.I2CSTR.all == BB | XSMT | ARDY | NACK
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert bench.target.text == "S P"
    # The byte was not sent: it still waits.
    assert bench.regs.I2CSTR.all == XSMT | ARDY | NACK | SCD
    # NACK is cleared by an acknowledgment, ARDY by the START.
    bench.regs.I2CSAR.all = 0x50
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    assert bench.target.text == "S P S W 12 P"
    assert not bench.has(NACK | ARDY)
    assert bench.rules() == []


def test_a_byte_refused_in_the_middle_waits_for_the_program(bench: Bench) -> None:
    bench.target.refuses = 1
    bench.regs.I2CCNT = 3
    bench.regs.I2CMDR.all = SEND | STP
    for byte in (1, 2):
        bench.until(XRDY)
        bench.regs.I2CDXR.all = byte
    bench.run()
    # CHOICE: STP, which waits for the count, does not end it; the write of STP does.
    assert bench.target.text == "S W 01 02"
    assert bench.has(NACK)
    assert bench.has(ARDY)
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert bench.target.text == "S W 01 02 P"


def test_with_the_other_choice_a_standing_stp_ends_a_refused_message(bench: Bench) -> None:
    bench.i2c.stops_when_refused = True
    bench.target.present = False
    bench.regs.I2CCNT = 3
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    assert bench.target.text == "S W P"
    assert bench.has(NACK)


def test_the_last_byte_refused_has_its_stop(bench: Bench) -> None:
    bench.target.refuses = 1
    bench.send(1, 2)
    assert bench.target.text == "S W 01 02 P"
    assert bench.has(NACK)


# Receiver


@given(data=st.binary(min_size=1, max_size=20))
def test_a_receiver_acknowledges_all_bytes_but_the_last(data: bytes) -> None:
    bench = Bench(answers=data)
    bench.regs.I2CCNT = len(data)
    bench.regs.I2CMDR.all = RECEIVE | STP
    got = bytearray()
    for _ in data:
        assert not bench.has(NACKSNT)
        bench.until(RRDY)
        got.append(bench.regs.I2CDRR.all)
    bench.run()
    assert bytes(got) == data
    assert bench.has(NACKSNT)
    assert bench.target.text == " ".join(["S R", *(f"<{byte:02x}" for byte in data), "P"])
    assert bench.regs.I2CMDR.all == IRS
    assert bench.rules() == []


def test_a_repeated_start_turns_the_direction(bench: Bench) -> None:
    bench.target.answers = [0xD3]
    bench.send(0x0F, stop=False)
    held = bench.clock.now
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.run()
    assert bench.target.text == "S W 0f S R <d3 P"
    assert bench.regs.I2CDRR.all == 0xD3
    # CHOICE: out of the hold with the next module clock, a bit and a module clock to the START.
    assert bench.target.times[3] == held + MODULE + BIT + MODULE


def test_an_overrun_holds_scl_and_loses_nothing() -> None:
    bench = Bench(answers=bytes([1, 2, 3]))
    bench.regs.I2CCNT = 3
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.run()
    # One byte in I2CDRR, one in the shift register.
    assert (bench.target.text, bench.has(RSFULL)) == ("S R <01 <02", True)
    assert bench.regs.I2CDRR.all == 1
    assert not bench.has(RSFULL)
    assert bench.has(RRDY)
    bench.run()
    assert bench.regs.I2CDRR.all == 2
    bench.run()
    assert bench.regs.I2CDRR.all == 3
    bench.run()
    assert bench.target.text == "S R <01 <02 <03 P"
    assert bench.rules() == []


def test_a_stop_is_not_held_by_bytes_that_were_not_read() -> None:
    bench = Bench(answers=bytes([1, 2]))
    bench.regs.I2CCNT = 2
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.run()
    assert (bench.target.text, bench.has(RSFULL)) == ("S R <01 <02 P", True)
    assert [bench.regs.I2CDRR.all, bench.regs.I2CDRR.all] == [1, 2]
    assert not bench.has(RSFULL | RRDY)
    assert bench.rules() == []


def test_nackmod_ends_a_message_early_and_is_cleared(bench: Bench) -> None:
    bench.target.answers = [1, 2, 3]
    bench.regs.I2CCNT = 3
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.until(RRDY)
    assert bench.regs.I2CDRR.all == 1
    bench.regs.I2CMDR.bit.NACKMOD = 1
    bench.run()
    assert bench.target.text == "S R <01 <02 P"
    assert not bench.regs.I2CMDR.all & NACKMOD
    assert bench.has(NACKSNT)


def test_a_repeat_mode_receiver_refuses_the_byte_under_way_when_stp_comes(bench: Bench) -> None:
    bench.target.answers = [1, 2, 3]
    bench.regs.I2CMDR.all = RECEIVE | RM
    bench.until(RRDY)
    bench.regs.I2CMDR.bit.STP = 1
    assert bench.regs.I2CDRR.all == 1
    bench.run()
    assert bench.target.text == "S R <01 <02 P"
    assert bench.has(NACKSNT)


def test_a_read_without_a_byte_is_told_but_not_the_first_one(bench: Bench) -> None:
    bench.target.answers = [7]
    assert bench.regs.I2CDRR.all == 0
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.run()
    assert bench.regs.I2CDRR.all == 7
    assert bench.rules() == []
    assert bench.regs.I2CDRR.all == 7
    assert bench.rules() == ["result-not-ready"]


def test_with_nobody_on_the_line_bits_stay_high() -> None:
    bench = Bench()
    second = Target(bench.clock, 0x50, answers=bytes([0x3C]))
    bench.bus.attach(0x50, second)
    bench.target.answers = [0xF0]
    bench.regs.I2CCNT = 2
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.until(RRDY)
    # Both drive: a bit is low if one of them pulls it; then neither has anything to say.
    assert bench.regs.I2CDRR.all == 0x30
    bench.run()
    assert bench.regs.I2CDRR.all == 0xFF


# FIFOs


@given(data=st.lists(st.integers(0, 255), min_size=1, max_size=16))
def test_a_message_out_of_the_fifo(data: list[int]) -> None:
    bench = Bench()
    bench.regs.I2CFFTX.all = 0x6000
    bench.regs.I2CCNT = len(data)
    for byte in data:
        bench.regs.I2CDXR.all = byte
    assert bench.regs.I2CFFTX.bit.TXFFST == len(data)
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    assert bench.target.text == " ".join(["S W", *(f"{byte:02x}" for byte in data), "P"])
    assert bench.regs.I2CFFTX.bit.TXFFST == 0
    assert bench.rules() == []


def test_a_full_receive_fifo_holds_the_bus() -> None:
    bench = Bench(answers=bytes(range(20)))
    bench.regs.I2CFFTX.all = 0x6000
    bench.regs.I2CFFRX.all = 0x2000
    bench.regs.I2CCNT = 20
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.run()
    # 16 in the FIFO, the 17th in the shift register.
    assert (bench.regs.I2CFFRX.bit.RXFFST, bench.has(RSFULL), len(bench.target.answers)) == (16, True, 3)
    got = []
    while bench.regs.I2CFFRX.bit.RXFFST:
        got.append(bench.regs.I2CDRR.all)
        bench.run()
    assert got == list(range(20))
    assert bench.target.text.endswith("<13 P")


def test_fifo_mode_begins_without_what_was_left_in_the_registers() -> None:
    bench = Bench(answers=bytes([1, 2, 3]))
    for count in (2, 1):
        bench.regs.I2CFFTX.all = 0x4000 if count == 1 else 0
        bench.regs.I2CFFRX.all = 0x2000
        bench.regs.I2CCNT = count
        bench.regs.I2CMDR.all = RECEIVE | STP
        bench.run()
    assert bench.regs.I2CFFRX.bit.RXFFST == 1
    assert bench.regs.I2CDRR.all == 3
    assert not bench.has(RSFULL | RRDY)


def test_fifo_levels_give_the_second_interrupt() -> None:
    bench = Bench(answers=bytes([1, 2, 3]))
    bench.regs.I2CFFTX.all = 0x6000
    # Level 2, enabled.
    bench.regs.I2CFFRX.all = 0x2000 | 1 << 5 | 2
    bench.regs.I2CCNT = 3
    bench.regs.I2CMDR.all = RECEIVE | STP
    bench.run()
    assert bench.fifo == [START + 3 * BYTE]
    assert bench.regs.I2CFFRX.bit.RXFFINT == 1
    for _ in range(3):
        bench.regs.I2CDRR.all
    bench.regs.I2CFFRX.bit.RXFFINTCLR = 1
    assert bench.regs.I2CFFRX.bit.RXFFINT == 0
    assert bench.basic == []


def test_an_old_flag_of_a_fifo_gives_no_interrupt_when_it_is_enabled_unless_its_level_holds(bench: Bench) -> None:
    bench.regs.I2CFFTX.all = 0x6000
    bench.regs.I2CDXR.all = 1
    # TXFFINT is from the empty FIFO; there is a byte now, and TXFFIL is 0.
    assert bench.regs.I2CFFTX.bit.TXFFINT == 1
    bench.regs.I2CFFTX.bit.TXFFIENA = 1
    assert bench.fifo == []
    bench.regs.I2CFFTX.bit.TXFFINTCLR = 1
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    # The shift register takes the byte behind the address.
    assert bench.fifo == [START + BYTE]
    bench.regs.I2CFFTX.bit.TXFFIENA = 0
    bench.regs.I2CFFTX.bit.TXFFIENA = 1
    assert len(bench.fifo) == 2


def test_fifo_interrupts_wait_for_irs() -> None:
    bench = Bench()
    bench.regs.I2CMDR.all = 0
    # TRM: with RXFFIL = 0 the flag is set when the FIFO is enabled and the module is taken out of reset.
    bench.regs.I2CFFTX.all = 0x6000
    bench.regs.I2CFFRX.all = 0x2000 | 1 << 5
    assert bench.fifo == []
    bench.regs.I2CMDR.all = IRS
    assert bench.fifo == [bench.clock.now]


def test_a_byte_for_a_full_fifo_is_told(bench: Bench) -> None:
    bench.regs.I2CFFTX.all = 0x6000
    for byte in range(16):
        bench.regs.I2CDXR.all = byte
    assert bench.rules() == []
    bench.regs.I2CDXR.all = 16
    assert bench.rules() == ["data-lost"]


# Interrupts


def test_isrc_gives_the_highest_request_and_its_read_the_next_one(bench: Bench) -> None:
    bench.regs.I2CIER.all = NACK | ARDY | SCD
    bench.regs.I2CSAR.all = 0x51
    bench.regs.I2CMDR.all = SEND
    bench.run()
    refused = START + BYTE
    assert bench.basic == [refused]
    # TRM I2CISRC: 2 is NACK and clears it, 3 ARDY, which stays.
    assert bench.regs.I2CISRC.all == 2
    assert not bench.has(NACK)
    assert bench.basic == [refused, bench.clock.now]
    assert bench.regs.I2CISRC.all == 3
    assert bench.has(ARDY)
    assert bench.regs.I2CISRC.all == 0
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert len(bench.basic) == 3
    assert bench.regs.I2CISRC.all == 6
    assert not bench.has(SCD)


def test_a_flag_asks_only_when_it_is_enabled(bench: Bench) -> None:
    bench.send(1)
    assert bench.basic == []
    # Enabled while it stands, it asks.
    bench.regs.I2CIER.all = SCD
    assert bench.basic == [bench.clock.now]


def test_a_flag_that_is_cleared_asks_no_more(bench: Bench) -> None:
    bench.regs.I2CIER.all = ARDY | SCD
    bench.send(1, stop=False)
    bench.regs.I2CSTR.all = ARDY
    assert bench.regs.I2CISRC.all == 0


def test_a_message_by_interrupts_of_xrdy(bench: Bench) -> None:
    bench.regs.I2CCNT = 3
    bench.regs.I2CMDR.all = SEND | STP
    bench.regs.I2CIER.all = XRDY
    data = [0x11, 0x22, 0x33]
    while data:
        assert bench.basic, "no interrupt came"
        bench.basic.clear()
        assert bench.regs.I2CISRC.all == 5
        bench.regs.I2CDXR.all = data.pop(0)
        bench.run(2 * BYTE)
    bench.run()
    assert bench.target.text == "S W 11 22 33 P"


# The bus


def test_a_bus_that_somebody_else_has_is_lost(bench: Bench) -> None:
    bench.bus.take(True)
    assert bench.has(BB)
    bench.regs.I2CMDR.all = SEND | STP
    # TRM I2CSTR.ARBL: a transfer is started while BB = 1; MST and STP are cleared.
    assert bench.regs.I2CMDR.all & (MST | STP) == 0
    assert bench.has(ARBL)
    bench.run()
    assert bench.target.text == ""
    bench.bus.take(False)
    assert not bench.has(BB)
    assert bench.has(SCD)
    bench.send(1)
    assert bench.target.text == "S W 01 P"


def test_irs_lets_the_bus_go_and_clears_the_flags(bench: Bench) -> None:
    bench.send(1, 2, stop=False)
    bench.regs.I2CMDR.bit.IRS = 0
    assert bench.regs.I2CSTR.all == XSMT | XRDY
    bench.regs.I2CMDR.all = IRS
    bench.send(3)
    assert bench.target.text == "S W 01 02 P S W 03 P"


def test_irs_in_the_middle_of_a_byte_ends_it(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CDXR.all = 1
    bench.regs.I2CMDR.all = SEND | STP
    bench.run(START + BYTE + BIT)
    bench.regs.I2CMDR.all = 0
    bench.run()
    assert bench.target.text == "S W P"
    assert bench.clock.pending == 0


def test_stt_and_stp_cannot_be_set_in_reset(bench: Bench) -> None:
    bench.regs.I2CMDR.all = 0
    bench.regs.I2CMDR.all = STT | STP | MST | TRX
    assert bench.regs.I2CMDR.all == MST | TRX
    bench.regs.I2CMDR.bit.IRS = 1
    bench.run()
    assert bench.target.text == ""


def test_pins_that_belong_to_somebody_else(bench: Bench) -> None:
    bench.bus.connected, bench.bus.missing = False, "GPIO32 has function 0, where I2C-A is function 1"
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    assert bench.has(NACK)
    assert (bench.target.text, bench.rules()) == ("", ["not-configured"])


@given(address=st.integers(0, 0x3FF))
def test_ten_bit_addresses_send_their_first_byte_and_find_nobody(address: int) -> None:
    bench = Bench()
    bench.regs.I2CSAR.all = address
    bench.regs.I2CMDR.all = SEND | 0x0100
    bench.run()
    assert bench.has(NACK)
    assert bench.rules() == []


def test_addresses_with_another_meaning_are_no_devices(bench: Bench) -> None:
    for address in (0, 7, 0x78, 0x100):
        with pytest.raises(ValueError, match="I2C address"):
            bench.bus.attach(address, bench.target)


# Loopback


def test_loopback_brings_what_is_sent_back_and_leaves_the_bus_alone(bench: Bench) -> None:
    bench.regs.I2CFFTX.all = 0x6000
    bench.regs.I2CFFRX.all = 0x2000
    bench.regs.I2CSAR.all = 0x3C
    bench.regs.I2CCNT = 2
    bench.regs.I2CDXR.all = 0x12
    bench.regs.I2CDXR.all = 0x34
    bench.regs.I2CMDR.all = SEND | STP | DLB
    # TRM DLB: n = (input clock / module clock) * 8 cycles to I2CDRR.
    second = START + 3 * BYTE + 8 * MODULE
    bench.clock.advance_to(second - 1)
    assert bench.regs.I2CFFRX.bit.RXFFST == 1
    bench.clock.advance_to(second)
    assert [bench.regs.I2CDRR.all, bench.regs.I2CDRR.all] == [0x12, 0x34]
    bench.run()
    assert bench.regs.I2CMDR.all == TRX | DLB | IRS
    assert (bench.target.text, bench.rules()) == ("", [])


def test_loopback_goes_on_with_each_start(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = MST | TRX | DLB | IRS
    for byte in (5, 6):
        bench.regs.I2CDXR.all = byte
        bench.regs.I2CMDR.bit.STT = 1
        bench.run()
        assert bench.regs.I2CDRR.all == byte
    assert bench.rules() == []


# What a driver overlooks


@pytest.mark.parametrize(("ipsc", "found"), [(15, ["i2c-clock"]), (16, []), (27, []), (28, ["i2c-clock"])])
def test_the_module_clock_is_7_to_12_mhz(ipsc: int, found: list[str]) -> None:
    # 200 MHz / 17 = 11.8 MHz, / 28 = 7.1 MHz; / 16 = 12.5 and / 29 = 6.9 MHz are outside.
    # 35 module clocks a bit: of the fastest module some 360 kHz, which a bus bears.
    bench = Bench(ipsc=ipsc, iccl=20)
    bench.send(1)
    assert bench.rules() == found


@pytest.mark.parametrize(("iccl", "found"), [(10, []), (9, ["i2c-clock"])])
def test_the_bus_has_400_khz_at_most(iccl: int, found: list[str]) -> None:
    # 10 MHz / (10 + 5 + 2 * 5) = 400 kHz; / 24 = 417 kHz.
    bench = Bench(iccl=iccl)
    bench.send(1)
    assert bench.rules() == found


@pytest.mark.parametrize(("dividers", "found"), [(495, []), (496, ["i2c-slow"])])
def test_a_bus_below_10_khz_is_told(dividers: int, found: list[str]) -> None:
    # 10 MHz / (495 + 495 + 2 * 5) = 10 kHz.
    bench = Bench(iccl=dividers, icch=dividers)
    bench.send(1)
    assert bench.rules() == found


def test_a_module_clock_that_is_too_slow_is_told_alone() -> None:
    # 200 MHz / 256 = 0.78 MHz, and SCL follows from it.
    bench = Bench(ipsc=255, iccl=40, icch=40)
    bench.send(1)
    assert bench.rules() == ["i2c-clock"]


@pytest.mark.parametrize("which", ["iccl", "icch"])
def test_a_divider_of_0_is_told(which: str) -> None:
    bench = Bench(**{"iccl": 25, "icch": 25, which: 0})
    bench.send(1)
    assert [(f.rule, f.object) for f in bench.findings] == [("not-configured", f"I2caRegs.I2CCLK{which[-1].upper()}")]


def test_an_address_with_its_rw_bit_is_told(bench: Bench) -> None:
    bench.regs.I2CSAR.all = 0xA0
    bench.send()
    assert [(f.rule, f.object) for f in bench.findings] == [("reserved-field", "I2caRegs.I2CSAR")]
    assert "0x20" in next(iter(bench.findings)).message


@pytest.mark.parametrize("moment", [START + BYTE + BIT, START + 2 * BYTE + BIT // 2, START + 2 * BYTE + BIT])
def test_a_start_before_the_stop_is_told(bench: Bench, moment: int) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CDXR.all = 1
    bench.regs.I2CMDR.all = SEND | STP
    bench.run(moment)
    bench.regs.I2CMDR.all = SEND | STP
    assert bench.rules() == ["i2c-stop-pending"]


@pytest.mark.parametrize("enabled", [XRDY, RRDY])
def test_interrupts_of_the_data_registers_are_not_for_fifo_mode(bench: Bench, enabled: int) -> None:
    bench.regs.I2CIER.all = enabled | SCD
    bench.send(1)
    assert bench.rules() == []
    bench.regs.I2CFFTX.all = 0x6000
    bench.send(1)
    assert bench.rules() == ["i2c-fifo-interrupt"]


def test_stp_is_cleared_behind_scd(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CDXR.all = 1
    bench.regs.I2CMDR.all = SEND | STP
    bench.until(SCD)
    # TRM: clearing of STP is delayed until after SCD is set; a routine of SCD has to look at it.
    assert bench.regs.I2CMDR.all == STP | MST | TRX | IRS
    assert not bench.has(BB)
    bench.run(MODULE)
    assert bench.regs.I2CMDR.all == TRX | IRS


def test_stp_written_behind_stt_or_right_before_it_is_no_hurry(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    for first, second in (("STT", "STP"), ("STP", "STT")):
        bench.regs.I2CDXR.all = 1
        bench.regs.I2CMDR.all = MST | TRX | IRS
        setattr(bench.regs.I2CMDR.bit, first, 1)
        bench.run(MODULE // 2)
        setattr(bench.regs.I2CMDR.bit, second, 1)
        bench.run()
    assert bench.target.text == "S W 01 P S W 01 P"
    assert bench.rules() == []


def test_a_start_without_mst_is_told(bench: Bench) -> None:
    bench.regs.I2CMDR.all = STT | TRX | IRS
    bench.run()
    assert (bench.target.text, bench.rules()) == ("", ["not-configured"])


@pytest.mark.parametrize(
    ("register", "word"),
    [("I2COAR", 0x3C), ("I2CIER", 0x40), ("I2CEMDR", 0), *(("I2CMDR", IRS | bits) for bits in (7, 8, 16))],
)
def test_what_is_not_modelled_reports_itself(bench: Bench, register: str, word: int) -> None:
    bench.regs.registers[register].write(word, 0xFFFF)
    assert bench.rules() == ["unmodelled"]


def test_a_receiver_in_loopback_is_not_modelled(bench: Bench) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = RECEIVE | DLB
    bench.run()
    assert bench.rules() == ["unmodelled"]


def test_a_reset_of_the_module_is_one(bench: Bench) -> None:
    bench.regs.I2CFFTX.all = 0x6000
    bench.regs.I2CDXR.all = 1
    bench.regs.I2CMDR.all = SEND | STP
    bench.run(START)
    bench.i2c.reset()
    bench.run()
    assert bench.target.text == "S P"
    assert all(register.value == register.reset_value for register in bench.regs)


@pytest.mark.parametrize("fifo", [False, True])
def test_a_driver_that_tries_again_until_it_is_acknowledged_is_right(bench: Bench, fifo: bool) -> None:
    bench.regs.I2CFFTX.all = 0x6000 if fifo else 0
    bench.target.present = False
    bench.regs.I2CCNT = 1
    for tries in range(20):
        bench.target.present = tries == 19
        bench.regs.I2CDXR.all = 0x12
        bench.regs.I2CMDR.all = SEND
        bench.run()
        bench.regs.I2CMDR.bit.STP = 1
        bench.run()
    assert bench.target.text == "S W P " * 19 + "S W 12 P"
    assert bench.rules() == []


ACCESSES = st.lists(
    st.one_of(
        st.tuples(st.just("I2CMDR"), st.integers(0, 0xFFFF).map(lambda word: word & 0xAEE0)),
        st.tuples(st.just("I2CMDR"), st.sampled_from([SEND, SEND | STP, RECEIVE | STP, SEND | RM, STP | MST | IRS])),
        st.tuples(st.just("I2CDXR"), st.integers(0, 0xFF)),
        st.tuples(st.just("I2CSTR"), st.integers(0, 0xFFFF)),
        st.tuples(st.just("I2CIER"), st.integers(0, 0x3F)),
        st.tuples(st.just("I2CCNT"), st.integers(0, 3)),
        st.tuples(st.just("I2CSAR"), st.sampled_from([0x50, 0x51, 0x3FF])),
        st.tuples(st.just("I2CFFTX"), st.sampled_from([0, 0x4000, 0x6000, 0x6040, 0x6063])),
        st.tuples(st.just("I2CFFRX"), st.sampled_from([0, 0x2000, 0x2040, 0x2061])),
        st.tuples(st.sampled_from(["I2CDRR", "I2CISRC"]), st.none()),
        st.tuples(st.just("take"), st.integers(0, 1)),
        st.tuples(st.just("time"), st.integers(1, 30_000)),
    ),
    max_size=60,
)  # fmt: skip


@given(accesses=ACCESSES)
@example(accesses=[
    ("I2CMDR", SEND), ("I2CMDR", IRS | 0x40), ("I2CDXR", 0), ("time", 3292), ("I2CMDR", SEND | STP), ("I2CMDR", SEND),
    ("time", 1431),
])  # fmt: skip
def test_whatever_a_program_does_the_bus_sees_messages(accesses: list[tuple[str, int | None]]) -> None:
    bench = Bench(answers=bytes(100))
    for name, word in accesses:
        if name == "time":
            bench.run(word or 0)
        elif name == "take":
            bench.bus.take(bool(word))
        elif word is None:
            bench.regs.registers[name].read()
        else:
            bench.regs.registers[name].write(word, 0xFFFF)
        status = bench.regs.I2CSTR.all
        # At most the end of what is on the bus, and a byte in the loopback.
        assert len(bench.clock.waiting()) <= 2
        assert bench.regs.I2CISRC.value & 7 <= 6
        if not bench.regs.I2CMDR.value & IRS:
            # Nothing but a byte written to I2CDXR since.
            assert status | XRDY == XSMT | XRDY
    # An independent reading of the bus: START, address, then bytes of one direction, and a STOP at some time.
    expected = "SP"
    for seen in bench.target.seen:
        kind = seen[0] if seen[0] in "SPRW<" else "d"
        assert kind in expected, bench.target.text
        expected = {"S": "RWSP", "R": "<SP", "W": "dSP", "<": "<SP", "d": "dSP", "P": "SP"}[kind]
    # It can be set up again, and works.
    bench.bus.take(False)
    bench.i2c.reset()
    bench.target.seen.clear()
    for name, word in (("I2CPSC", 19), ("I2CCLKL", 10), ("I2CCLKH", 5), ("I2CSAR", 0x50), ("I2CMDR", IRS)):
        bench.regs.registers[name].write(word, 0xFFFF)
    bench.send(0x42)
    assert bench.target.text == "S W 42 P"


def refused(bench: Bench) -> None:
    """A message to nobody that is ended by a STOP; NACK stands behind it."""
    bench.regs.I2CSAR.all = 0x51
    bench.regs.I2CMDR.all = SEND
    bench.run()
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    bench.regs.I2CSAR.all = 0x50


@pytest.mark.parametrize("cleared", [True, False])
def test_a_message_given_up_for_a_refusal_of_before_is_told(bench: Bench, cleared: bool) -> None:
    refused(bench)
    if cleared:
        bench.regs.I2CSTR.all = NACK
    bench.regs.I2CMDR.all = SEND | STP
    bench.run(10)
    bench.regs.I2CMDR.bit.STP = 1  # what a routine does that has read NACK
    assert bench.rules() == ([] if cleared else ["flag-not-cleared"])
    bench.run()


def test_stp_behind_stt_is_a_command_also_with_an_old_nack(bench: Bench) -> None:
    refused(bench)
    bench.regs.I2CMDR.all = SEND
    bench.run(10)
    bench.regs.I2CMDR.bit.STP = 1
    bench.run()
    assert bench.rules() == []


def looks_on(bench: Bench, milliseconds: int) -> None:
    """The program reads I2CSTR for so long, each millisecond."""
    for _ in range(milliseconds + 1):
        assert bench.has(BB)
        bench.run(200_000)


def test_a_refused_message_that_holds_the_bus_is_told_where_the_program_looks_on(bench: Bench) -> None:
    bench.regs.I2CSAR.all = 0x51
    bench.regs.I2CMDR.all = SEND
    bench.run()
    looks_on(bench, 98)
    assert bench.rules() == []
    looks_on(bench, 3)
    assert bench.rules() == ["i2c-left-busy"]
    looks_on(bench, 200)
    assert [finding.count for finding in bench.findings] == [1]


@pytest.mark.parametrize("end", [STP, STT])
def test_a_refused_message_that_is_ended_late_is_not_told(bench: Bench, end: int) -> None:
    bench.target.present = False
    bench.regs.I2CMDR.all = SEND
    bench.run(400_000_000)
    looks_on(bench, 90)
    bench.target.present = True
    bench.regs.I2CMDR.all |= end
    bench.run()
    for _ in range(200):
        bench.has(BB)
        bench.run(200_000)
    assert bench.rules() == []


def test_a_message_that_waits_for_its_next_byte_is_not_told(bench: Bench) -> None:
    bench.regs.I2CCNT = 2
    bench.regs.I2CMDR.all = SEND | STP
    bench.run()
    looks_on(bench, 300)
    assert bench.rules() == []


def polls(bench: Bench, times: int = 2000) -> None:
    """The program reads I2CSTR so often, each microsecond."""
    for _ in range(times):
        bench.has(BB)
        bench.run(200)


@pytest.mark.parametrize(("end", "told"), [(0, ["i2c-left-busy"]), (STP, []), (STT, [])])
def test_a_message_that_nothing_ends_is_told_at_the_reset(bench: Bench, end: int, told: list[str]) -> None:
    bench.send(0x12, stop=False)
    if end:
        bench.regs.I2CMDR.all |= end
        bench.run()
    polls(bench)
    bench.regs.I2CMDR.all = 0
    assert bench.rules() == told


def test_a_reset_without_a_wait_is_not_told(bench: Bench) -> None:
    bench.send(0x12, stop=False)
    polls(bench, 900)
    bench.regs.I2CMDR.all = 0
    assert bench.rules() == []


@pytest.mark.parametrize(("command", "reset", "told"), [
    (RECEIVE | STP, True, ["i2c-count"]), (RECEIVE | STP, False, []), (SEND | STP, True, []),
])  # fmt: skip
def test_a_wait_for_more_bytes_than_the_message_has_is_told(
    bench: Bench, command: int, reset: bool, told: list[str]
) -> None:
    bench.regs.I2CCNT = 1
    bench.regs.I2CDXR.all = 0
    bench.regs.I2CMDR.all = command
    bench.until(RRDY if command & TRX == 0 else SCD)
    assert bench.regs.I2CDRR.all >= 0
    polls(bench)
    if reset:
        bench.regs.I2CMDR.all = 0
    assert bench.rules() == told


def test_a_wait_for_a_part_that_does_not_answer_is_not_told(bench: Bench) -> None:
    bench.target.present = False
    bench.regs.I2CCNT = 1
    bench.regs.I2CMDR.all = RECEIVE | STP
    polls(bench)
    bench.regs.I2CMDR.all = 0
    assert bench.rules() == []
