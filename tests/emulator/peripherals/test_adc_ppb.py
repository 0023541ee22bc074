"""Post-processing blocks of the ADC (TRM ADC, post-processing blocks) in register language, and in three programs."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.drivers import Driver
from tests.emulator.peripherals.adc_bench import EOC, LAT, SYNC, WINDOW, Bench

#: Events of block 1 in ADCEVTSTAT (HDR).
TRIPHI, TRIPLO, ZERO = 1, 2, 4


def converted(bench: Bench, soc: int, code: int) -> int:
    """ADCRESULTn of a software conversion whose code is `code`."""
    bench.adc.force_codes([code])
    bench.regs.ADCSOCFRC1.all = 1 << soc
    bench.clock.charge(300)  # more than SYNC + WINDOW and a tLAT of 16 bits, 120
    return bench.result(soc)


def ppb_result(bench: Bench, ppb: int) -> int:
    """ADCPPBxRESULT as C reads it through an int32."""
    word = bench.results.registers[f"ADCPPB{ppb}RESULT"].read()
    return word - (1 << 32) if word >> 31 else word


@pytest.mark.parametrize(
    ("resolution", "code", "offset", "result"),
    # ADCRESULT = code - OFFCAL, a signed number of 10 bits; the ends are 0 and 4095 or 65535.
    [
        (0, 2000, 100, 1900), (0, 2000, -100, 2100), (0, 50, 100, 0), (0, 4090, -100, 4095), (0, 2000, 511, 1489),
        (0, 2000, -512, 2512), (1, 65500, -512, 65535), (1, 4090, -100, 4190), (0, 7, 0, 7),
    ],
)  # fmt: skip
def test_an_offset_is_taken_from_the_result_which_saturates(
    resolution: int, code: int, offset: int, result: int
) -> None:
    bench = Bench()
    bench.regs.ADCCTL2.all = resolution << 7 | resolution << 6 | 6
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.regs.ADCPPB1OFFCAL.all = offset & 0x3FF
    assert converted(bench, 1, code) == result
    assert converted(bench, 2, code) == code, "a SOC that no block watches"


def test_of_several_blocks_of_one_soc_the_highest_number_corrects() -> None:
    bench = Bench()
    for ppb, offset in ((1, 10), (3, 30)):
        bench.regs.registers[f"ADCPPB{ppb}CONFIG"].write(5, 0xFFFF)
        bench.regs.registers[f"ADCPPB{ppb}OFFCAL"].write(offset, 0xFFFF)
    assert converted(bench, 5, 1000) == 970
    assert [(f.rule, f.object) for f in bench.findings] == [("not-configured", "AdcaRegs.ADCPPB1OFFCAL")]


def test_out_of_reset_block_4_watches_soc0_too_and_undoes_what_block_1_is_told() -> None:
    bench = Bench()
    bench.regs.ADCPPB1OFFCAL.all = 10
    assert converted(bench, 0, 1000) == 1000
    assert [f.rule for f in bench.findings] == ["not-configured"]


def test_the_difference_from_the_reference_is_sign_extended_and_may_be_turned() -> None:
    bench = Bench()
    bench.regs.ADCPPB2CONFIG.bit.CONFIG = 3
    bench.regs.ADCPPB2OFFREF = 2048
    converted(bench, 3, 1048)
    assert bench.results.ADCPPB2RESULT.all == 0x1_0000_0000 - 1000
    assert bench.results.ADCPPB2RESULT.bit.SIGN == 0xFFFF
    bench.regs.ADCPPB2CONFIG.bit.TWOSCOMPEN = 1
    converted(bench, 3, 1048)
    assert ppb_result(bench, 2) == 1000
    assert not list(bench.findings)


def test_the_result_of_a_block_latches_with_that_of_the_soc_and_its_flags_come_with_the_eoc() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.regs.ADCEVTINTSEL.bit.PPB1TRIPHI = 1
    bench.adc.force_codes([77])
    bench.regs.ADCSOCFRC1.all = 2
    bench.at(EOC - 1)
    assert bench.regs.ADCEVTSTAT.bit.PPB1TRIPHI == 0
    bench.at(EOC)
    assert bench.regs.ADCEVTSTAT.bit.PPB1TRIPHI == 1
    bench.at(LAT - 1)
    assert ppb_result(bench, 1) == 0
    bench.at(LAT)
    assert ppb_result(bench, 1) == 77
    assert bench.events == [EOC]


def test_the_early_pulse_changes_nothing_for_a_block() -> None:
    bench = Bench()
    bench.regs.ADCCTL1.bit.INTPULSEPOS = 0
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.regs.ADCPPB1OFFCAL.all = 7
    bench.regs.ADCEVTINTSEL.bit.PPB1TRIPHI = 1
    assert converted(bench, 1, 77) == 70
    assert bench.events == [EOC]


def test_a_block_that_nobody_touched_has_the_last_result_of_soc0() -> None:
    bench = Bench()
    converted(bench, 0, 0)
    converted(bench, 0, 1234)
    converted(bench, 1, 99)
    # Limits are 0 out of reset, so that 1234 is above the high one of all four blocks: bits 0, 4, 8, 12.
    assert bench.regs.ADCEVTSTAT.all == 0x1111
    assert [ppb_result(bench, ppb) for ppb in (1, 2, 3, 4)] == [1234] * 4
    converted(bench, 0, 5)
    assert ppb_result(bench, 4) == 5


def test_a_flag_has_to_be_cleared_before_it_interrupts_again() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.regs.ADCPPB1TRIPHI.bit.LIMITHI = 3000
    bench.regs.ADCPPB1TRIPLO.bit.LIMITLO = 1000
    bench.regs.ADCEVTINTSEL.all = TRIPHI | TRIPLO
    # A result on the limit is within.
    for code, events, flags in (
        (3000, 0, 0), (1000, 0, 0), (3001, 1, TRIPHI), (3001, 1, TRIPHI), (999, 2, TRIPHI | TRIPLO),
    ):  # fmt: skip
        converted(bench, 1, code)
        assert (len(bench.events), bench.regs.ADCEVTSTAT.all & 7) == (events, flags), code
    bench.regs.ADCEVTCLR.bit.PPB1TRIPHI = 1
    assert bench.regs.ADCEVTSTAT.all & 7 == TRIPLO
    converted(bench, 1, 3001)
    assert len(bench.events) == 3
    assert not list(bench.findings)


def test_a_flag_that_was_set_before_it_was_enabled_does_not_interrupt() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    converted(bench, 1, 1)
    bench.regs.ADCEVTINTSEL.bit.PPB1TRIPHI = 1
    converted(bench, 1, 2)
    assert bench.events == []


def test_limits_do_not_compare_signed_results_on_this_silicon() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.regs.ADCPPB1OFFREF = 2048
    converted(bench, 1, 2000)
    assert not list(bench.findings), "nobody asked for the limits"
    bench.regs.ADCEVTINTSEL.bit.PPB1TRIPLO = 1
    converted(bench, 1, 2100)
    assert not list(bench.findings)
    converted(bench, 1, 2000)
    assert [(f.rule, f.object) for f in bench.findings] == [("adc-limit-signed", "AdcaResultRegs.ADCPPB1RESULT")]


def test_the_stamp_is_the_time_from_trigger_to_window() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.soc(1).bit.TRIGSEL = 5
    bench.adc.trigger(5)
    assert bench.regs.ADCPPB1TRIPLO.bit.REQSTAMP == bench.regs.ADCCOUNTER.bit.FREECOUNT
    bench.at(LAT)
    assert bench.regs.ADCPPB1STAMP.bit.DLYSTAMP == SYNC
    # SOC2 takes the S/H first: SOC1, triggered 10 cycles after it, waits for its end.
    bench.at(1000)
    bench.regs.ADCSOCFRC1.all = 1 << 2
    bench.at(1010)
    bench.adc.trigger(5)
    bench.at(2000)
    assert bench.regs.ADCPPB1STAMP.bit.DLYSTAMP == SYNC + WINDOW + 41 - 10
    # Software triggers give no stamp.
    bench.regs.ADCSOCFRC1.all = 1 << 1
    bench.at(3000)
    assert bench.regs.ADCPPB1STAMP.bit.DLYSTAMP == SYNC + WINDOW + 41 - 10
    assert not list(bench.findings)


def test_a_stamp_belongs_to_the_window_that_opens_in_the_end() -> None:
    bench = Bench()
    bench.regs.ADCSOCPRICTL.bit.SOCPRIORITY = 16
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 7
    bench.soc(7).bit.TRIGSEL = 5
    bench.soc(3).bit.TRIGSEL = 6
    bench.adc.trigger(5)
    bench.at(1)
    # SOC3 comes before SOC7 has got the S/H, and has the higher priority.
    bench.adc.trigger(6)
    bench.at(1000)
    assert bench.regs.ADCPPB1STAMP.bit.DLYSTAMP == SYNC + WINDOW + 41


def test_a_stopped_clock_does_not_count_in_a_stamp() -> None:
    bench = Bench()
    bench.soc(0).bit.TRIGSEL = 5
    bench.adc.trigger(5)
    bench.at(1)
    bench.adc.set_clock(False)
    bench.at(10_001)
    bench.adc.set_clock(True)
    bench.at(20_000)
    assert bench.regs.ADCPPB4STAMP.bit.DLYSTAMP == SYNC


def test_a_reset_makes_all_blocks_forget() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    bench.regs.ADCPPB1OFFCAL.all = 100
    converted(bench, 1, 2000)
    bench.adc.reset()
    assert (bench.regs.ADCEVTSTAT.all, ppb_result(bench, 1), bench.regs.ADCPPB1OFFCAL.all) == (0, 0, 0)


SETTINGS = st.tuples(
    st.integers(0, 2),  # CONFIG
    st.booleans(),  # TWOSCOMPEN
    st.integers(-512, 511),  # OFFCAL
    st.integers(0, 4095),  # OFFREF
    st.integers(-4096, 4095),  # the two limits, 13 bits
    st.integers(-4096, 4095),
)


@given(
    settings=st.lists(SETTINGS, min_size=4, max_size=4), enabled=st.integers(0, 0x7777),
    conversions=st.lists(st.tuples(st.integers(0, 2), st.integers(0, 4095), st.integers(0, 0x7777)), max_size=6),
)  # fmt: skip
def test_blocks_do_what_the_manual_says(
    settings: list[tuple[int, bool, int, int, int, int]], enabled: int, conversions: list[tuple[int, int, int]]
) -> None:
    bench = Bench()
    for ppb, (soc, turned, offcal, offref, high, low) in enumerate(settings, 1):
        register = bench.regs.registers
        register[f"ADCPPB{ppb}CONFIG"].write(turned << 4 | soc, 0xFFFF)
        register[f"ADCPPB{ppb}OFFCAL"].write(offcal & 0x3FF, 0xFFFF)
        register[f"ADCPPB{ppb}OFFREF"].write(offref, 0xFFFF)
        register[f"ADCPPB{ppb}TRIPHI"].write(high & 0x1FFFF, 0xFFFFFFFF)
        register[f"ADCPPB{ppb}TRIPLO"].write(low & 0x1FFFF, 0xFFFFFFFF)
    bench.regs.ADCEVTINTSEL.all = enabled
    flags: set[tuple[int, str]] = set()
    differences = [0, 0, 0, 0]
    pulses = 0
    for soc, code, clear in conversions:
        corrected = code
        for watched, _, offcal, _, _, _ in settings:
            if watched == soc:
                corrected = code - offcal
        corrected = min(max(corrected, 0), 4095)
        before = set(flags)
        for ppb, (watched, turned, _, offref, high, low) in enumerate(settings):
            if watched == soc:
                difference = offref - corrected if turned else corrected - offref
                if difference > high:
                    flags.add((ppb, "HI"))
                if difference < low:
                    flags.add((ppb, "LO"))
                if (difference < 0) != (differences[ppb] < 0):
                    flags.add((ppb, "ZERO"))
                differences[ppb] = difference
        bits = {(ppb, event): 1 << 4 * ppb + k for ppb in range(4) for k, event in enumerate(("HI", "LO", "ZERO"))}
        pulses += any(bits[flag] & enabled for flag in flags - before)
        assert converted(bench, soc, code) == corrected
        assert [ppb_result(bench, ppb) for ppb in (1, 2, 3, 4)] == differences
        assert bench.regs.ADCEVTSTAT.all == sum(bits[flag] for flag in flags)
        assert len(bench.events) == pulses
        bench.regs.ADCEVTCLR.all = clear
        flags = {flag for flag in flags if not bits[flag] & clear}


def test_a_block_costs_no_clock_event() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 1
    before = bench.clock.events_run
    converted(bench, 1, 5)
    assert bench.clock.events_run - before == 1


# What TI's three examples of the blocks promise, in programs of our own.

SETUP = """
# drv.c: Power
def Power() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.all = 3
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1
    DELAY_US(1000.0)
    EDIS()

"""


def test_offset_two_socs_of_one_pin_of_which_one_is_corrected() -> None:
    driver = Driver(
        """
Plain: array[uint16, 2]
Corrected: array[uint16, 2]
"""
        + SETUP
        + """
# drv.c: Run
def Run() -> void:
    Power()
    EALLOW()
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 14
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 1
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 14
    AdcbRegs.ADCSOC1CTL.bit.ACQPS = 14
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 1
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1
    AdcaRegs.ADCPPB1CONFIG.bit.CONFIG = 1
    AdcaRegs.ADCPPB1OFFCAL.bit.OFFCAL = 100
    AdcbRegs.ADCPPB1CONFIG.bit.CONFIG = 1
    AdcbRegs.ADCPPB1OFFCAL.bit.OFFCAL = -100
    EDIS()
    AdcaRegs.ADCSOCFRC1.all = 3
    AdcbRegs.ADCSOCFRC1.all = 3
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    while AdcbRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    Plain[0] = AdcaResultRegs.ADCRESULT0
    Corrected[0] = AdcaResultRegs.ADCRESULT1
    Plain[1] = AdcbResultRegs.ADCRESULT0
    Corrected[1] = AdcbResultRegs.ADCRESULT1
"""
    )
    driver.board.analog["A"][0].follow("test", lambda _cycles: 1.5)
    driver.board.analog["B"][0].follow("test", lambda _cycles: 0.75)
    driver.Run()
    objects = driver.linked.objects
    plain, corrected = objects["drv.Plain"].data, objects["drv.Corrected"].data
    assert [c - p for p, c in zip(plain, corrected, strict=True)] == [-100, 100]
    assert driver.rules() == []


EPWM = """
# drv.c: Epwm1
def Epwm1(period: uint16, compare: uint16) -> void:
    EALLOW()
    CpuSysRegs.PCLKCR2.all = 3
    EPwm1Regs.TBCTL.bit.CTRMODE = 3
    EPwm1Regs.CMPA.bit.CMPA = compare
    EPwm1Regs.TBPRD = period
    EPwm1Regs.ETSEL.bit.SOCASEL = 4
    EPwm1Regs.ETPS.bit.SOCAPRD = 1
    EPwm1Regs.ETSEL.bit.SOCAEN = 1
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5
    EDIS()
"""


def test_limits_interrupt_while_the_voltage_is_outside() -> None:
    driver = Driver(
        """
High: uint16 = 0
Low: uint16 = 0

# drv.c: Outside
def Outside() -> void:
    if AdcaRegs.ADCEVTSTAT.bit.PPB1TRIPHI:
        High += 1
        AdcaRegs.ADCEVTCLR.bit.PPB1TRIPHI = 1
    if AdcaRegs.ADCEVTSTAT.bit.PPB1TRIPLO:
        Low += 1
        AdcaRegs.ADCEVTCLR.bit.PPB1TRIPLO = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP10
"""
        + SETUP
        + EPWM
        + """
# drv.c: Init
def Init() -> void:
    DINT()
    InitPieCtrl()
    InitPieVectTable()
    EALLOW()
    PieVectTable.ADCA_EVT_INT = Outside
    EDIS()
    Power()
    Epwm1(0x1000, 0x0800)
    EALLOW()
    AdcaRegs.ADCPPB1CONFIG.bit.CONFIG = 0
    AdcaRegs.ADCPPB1TRIPHI.bit.LIMITHI = 3000
    AdcaRegs.ADCPPB1TRIPLO.bit.LIMITLO = 1000
    AdcaRegs.ADCEVTINTSEL.bit.PPB1TRIPHI = 1
    AdcaRegs.ADCEVTINTSEL.bit.PPB1TRIPLO = 1
    IER |= M_INT10
    PieCtrlRegs.PIEIER10.bit.INTx1 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    EPwm1Regs.TBCTL.bit.CTRMODE = 0
    EDIS()
    EINT()
"""
    )
    volts = [1.5]
    driver.board.analog["A"][0].follow("test", lambda _cycles: volts[0])
    driver.Init()
    counted = []
    objects = driver.linked.objects
    # 1000 and 3000 of 4096 parts of 3.0 V are 0.73 V and 2.20 V.
    for level in (1.5, 2.25, 2.15, 0.70, 0.75):
        volts[0] = level
        before = objects["drv.High"].data[0], objects["drv.Low"].data[0]
        driver.wait_ms(1.0)
        counted.append((objects["drv.High"].data[0] - before[0], objects["drv.Low"].data[0] - before[1]))
    # 1 ms holds 200000 / (2 * 4097) = 24 periods of the ePWM, which runs at half of EPWMCLK (100 MHz / 2).
    periods = counted[1][0]
    assert periods in range(11, 26)
    assert [high > 0 for high, _ in counted] == [False, True, False, False, False]
    assert [low > 0 for _, low in counted] == [False, False, False, True, False]
    assert driver.rules() == []


def test_delay_of_samples_that_two_asynchronous_triggers_ask_for() -> None:
    driver = Driver(
        """
Delays: array[uint16, 10]
Delayed: uint16 = 0
Count: uint32 = 0

# drv.c: First
def First() -> void:
    if AdcaRegs.ADCPPB1STAMP.bit.DLYSTAMP > 2 and Delayed < 10:
        Delays[Delayed] = AdcaRegs.ADCPPB1STAMP.bit.DLYSTAMP - 2
        Delayed += 1
    Count += 1
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1
"""
        + SETUP
        + EPWM
        + """
# drv.c: Init
def Init() -> void:
    DINT()
    InitPieCtrl()
    InitPieVectTable()
    EALLOW()
    PieVectTable.ADCA1_INT = First
    EDIS()
    Power()
    Epwm1(0x0800, 0x0400)
    EALLOW()
    EPwm2Regs.TBCTL.bit.CTRMODE = 3
    EPwm2Regs.CMPA.bit.CMPA = 0x0400
    EPwm2Regs.TBPRD = 9999
    EPwm2Regs.ETSEL.bit.SOCASEL = 4
    EPwm2Regs.ETPS.bit.SOCAPRD = 1
    EPwm2Regs.ETSEL.bit.SOCAEN = 1
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 1
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 14
    AdcaRegs.ADCSOC1CTL.bit.TRIGSEL = 7
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    IER |= M_INT1
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    EPwm1Regs.TBCTL.bit.CTRMODE = 0
    EPwm2Regs.TBCTL.bit.CTRMODE = 0
    EDIS()
    EINT()
"""
    )
    driver.Init()
    driver.wait_ms(300.0)
    objects = driver.linked.objects
    delays, delayed = objects["drv.Delays"].data, objects["drv.Delayed"].data[0]
    count = objects["drv.Count"].data[0]
    # A conversion takes 15 + 41 cycles: nobody waits longer for the other one, and so long if both come at once.
    assert delayed == 10
    assert all(0 < delay <= 15 + 41 for delay in delays)
    assert count > 100 * delayed, "most samples are not delayed"
    assert driver.rules() == []
