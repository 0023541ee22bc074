"""What a driver does wrong with a module: one driver with the defect, one without, for each rule."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver

ADC = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE)
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = {power}
    DelayUs(1000)
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 8
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 19
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 9
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    EDIS()
"""
CONVERT = """
# drv.c: convert
def convert() -> uint16:
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    AdcaRegs.ADCSOCFRC1.all = 1
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    return AdcaResultRegs.ADCRESULT0
"""


def adc(source: str, power: int = 1) -> Driver:
    driver = Driver(ADC.format(power=power) + source)
    driver.start()
    return driver


def test_a_conversion_that_is_waited_for_is_silent() -> None:
    driver = adc(CONVERT)
    for _ in range(3):
        driver.convert()
    assert not driver.rules()


def test_a_result_read_while_its_conversion_runs() -> None:
    driver = adc("""
# drv.c: convert
def convert() -> uint16:
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    AdcaRegs.ADCSOCFRC1.all = 1
    return AdcaResultRegs.ADCRESULT0  #!
""")
    driver.convert()
    finding = driver.only("result-not-ready")
    assert finding.object == "AdcaResultRegs.ADCRESULT0"


def test_a_result_of_a_soc_that_was_never_converted() -> None:
    driver = adc(CONVERT + """
# drv.c: wrong
def wrong() -> uint16:
    return AdcaResultRegs.ADCRESULT1  #!
""")
    driver.convert()
    driver.wrong()
    assert "SOC1 was ever converted" in driver.only("result-not-ready").message


def test_a_result_of_a_converter_without_power() -> None:
    driver = adc("""
# drv.c: read
def read() -> uint16:
    return AdcaResultRegs.ADCRESULT0  #!
""", power=0)
    driver.read()
    assert driver.only("not-configured").object == "AdcaRegs.ADCCTL1.ADCPWDNZ"


def test_a_flag_of_the_conversion_before_ends_the_wait() -> None:
    driver = adc("""
# drv.c: convert
def convert() -> uint16:
    AdcaRegs.ADCSOCFRC1.all = 1
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    return AdcaResultRegs.ADCRESULT0  #!
""")
    driver.convert()
    assert not driver.rules(), "the first wait is right"
    driver.convert()
    assert driver.only("flag-not-cleared").object == "AdcaRegs.ADCINTFLG.ADCINT1"


def test_the_latest_result_of_a_hardware_trigger_may_be_read_at_any_time() -> None:
    driver = adc("""
# drv.c: latest
def latest() -> uint16:
    return AdcaResultRegs.ADCRESULT0
""")
    board = driver.board
    board.register("AdcaRegs", "ADCINTSEL1N2").value = 0
    board.cpu.eallow = True
    soc = board.register("AdcaRegs", "ADCSOC0CTL")
    soc.write(soc.value | 5 << 20, 0xFFFFFFFF)  # TRIGSEL 5: ePWM1 SOCA
    board.adc.trigger(5)
    driver.wait_ms(1)
    board.adc.trigger(5)
    driver.latest()  # in the middle of the second conversion
    assert not driver.rules()


def test_the_flag_given_to_another_conversion_while_one_runs() -> None:
    source = """
# drv.c: both
def both() -> uint16:
    EALLOW()
    AdcaRegs.ADCSOCFRC1.all = 1
    {wait}
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 1
    DelayUs(5)
    return AdcaResultRegs.ADCRESULT0
"""
    cut = adc(source.format(wait=""))
    cut.both()
    finding = cut.only("adc-flag-shared")
    assert (finding.object, finding.value) == ("AdcaRegs.ADCINTSEL1N2.INT1SEL", 1)
    whole = adc(source.format(wait="DelayUs(5)"))
    whole.both()
    assert not whole.rules()


def test_an_soc_forced_again_before_it_began_loses_a_conversion() -> None:
    driver = adc("""
# drv.c: twice
def twice() -> void:
    AdcaRegs.ADCSOCFRC1.all = 3
    AdcaRegs.ADCSOCFRC1.all = 2  #!
    DelayUs(5)
""")
    driver.twice()
    assert driver.only("data-lost").object == "AdcaRegs.ADCSOCOVF1.SOC1"


SPI = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1
    GpioCtrlRegs.GPBGMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO60 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO59 = {somi}
    GpioCtrlRegs.GPBMUX2.bit.GPIO60 = 3
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    GpioCtrlRegs.GPBDIR.bit.GPIO61 = 1
    EDIS()
    SpiaRegs.SPICCR.bit.SPICHAR = 7
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1
    SpiaRegs.SPICTL.bit.TALK = {talk}
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49
    SpiaRegs.SPICCR.bit.SPISWRESET = {run}


# drv.c: cs
def cs(level: uint16) -> void:
    if level == 0:
        GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    else:
        GpioDataRegs.GPBSET.bit.GPIO61 = 1  #cs


# drv.c: transfer
def transfer(c: uint16) -> uint16:
    SpiaRegs.SPITXBUF = c << 8
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    return SpiaRegs.SPIRXBUF & 0xFF


# drv.c: who
def who() -> uint16:
    c: uint16
    cs(0)
    transfer(0x8F)
    c = transfer(0)
    cs(1)
    return c
"""


def spi(source: str = "", *, talk: int = 1, run: int = 1, somi: int = 3) -> Driver:
    driver = Driver(SPI.format(talk=talk, run=run, somi=somi) + source)
    driver.start()
    return driver


def test_a_transaction_that_is_waited_for_is_silent() -> None:
    driver = spi("""
# drv.c: flush
def flush() -> uint16:
    return SpiaRegs.SPIRXBUF
""")
    driver.flush()  # start-up code empties the buffer
    assert [driver.who() for _ in range(2)] == [0xD3, 0xD3]
    assert not driver.rules()


@pytest.mark.parametrize(("setting", "name"), [
    ({"talk": 0}, "SpiaRegs.SPICTL.TALK"), ({"run": 0}, "SpiaRegs.SPICCR.SPISWRESET"), ({"somi": 0}, "SPI-A"),
])  # fmt: skip
def test_a_word_for_a_module_that_cannot_send_it(setting: dict[str, int], name: str) -> None:
    driver = spi("""
# drv.c: send
def send() -> void:
    cs(0)
    SpiaRegs.SPITXBUF = 0x8F00  #!
    DelayUs(20)
    cs(1)
""", **setting)
    driver.send()
    assert driver.only("not-configured").object == name


def test_a_word_read_while_it_shifts_and_a_word_read_twice() -> None:
    early = spi("""
# drv.c: send
def send() -> uint16:
    cs(0)
    SpiaRegs.SPITXBUF = 0x8F00
    return SpiaRegs.SPIRXBUF  #!
""")
    early.send()
    assert "ends in" in early.only("result-not-ready").message
    twice = spi("""
# drv.c: again
def again() -> uint16:
    return SpiaRegs.SPIRXBUF  #!
""")
    twice.who()
    twice.again()
    assert "no word has come" in twice.only("result-not-ready").message


def test_the_flag_of_a_word_that_was_not_read_ends_the_next_wait() -> None:
    driver = spi("""
# drv.c: send_only
def send_only(c: uint16) -> void:
    SpiaRegs.SPITXBUF = c << 8
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:  #!
        pass
""")
    driver.cs(0)
    driver.send_only(0x8F)
    assert not driver.rules()
    driver.send_only(0)
    assert driver.only("flag-not-cleared").object == "SpiaRegs.SPISTS.INT_FLAG"


def test_a_pipeline_of_words_is_silent() -> None:
    driver = spi("""
# drv.c: pipeline
def pipeline() -> uint16:
    c: uint16
    cs(0)
    SpiaRegs.SPITXBUF = 0x8F00
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    SpiaRegs.SPITXBUF = 0
    c = SpiaRegs.SPIRXBUF
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    c = SpiaRegs.SPIRXBUF
    cs(1)
    return c & 0xFF
""")
    assert driver.pipeline() == 0xD3
    assert not driver.rules()


def test_a_chip_select_that_rises_before_the_word_has_left() -> None:
    driver = spi("""
# drv.c: hasty
def hasty() -> void:
    cs(0)
    SpiaRegs.SPITXBUF = 0x8F00
    cs(1)
    DelayUs(20)
""")
    driver.hasty()
    finding = driver.only("spi-transaction-cut")
    assert finding.place is not None
    assert driver.lines[finding.place.line - 1].endswith("#cs")
    assert [place.function for place in finding.call_path] == ["cs", "hasty"]


def test_a_word_to_nobody() -> None:
    driver = spi()
    driver.transfer(0x8F)
    assert driver.only("spi-no-device").object == "SPI-A"


SCI = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_C = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO89 = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO90 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO89 = {tx}
    GpioCtrlRegs.GPCMUX2.bit.GPIO90 = {rx}
    EDIS()
    ScicRegs.SCICCR.all = 0x0007
    ScicRegs.SCIHBAUD.all = {high}
    ScicRegs.SCILBAUD.all = {low}
    ScicRegs.SCICTL1.all = {control}


# drv.c: put
def put(c: uint16) -> void:
    while ScicRegs.SCICTL2.bit.TXRDY == 0:
        pass
    ScicRegs.SCITXBUF.all = c  #!


# drv.c: get
def get() -> uint16:
    while ScicRegs.SCIRXST.bit.RXRDY == 0:
        pass
    return ScicRegs.SCIRXBUF.all


# drv.c: peek
def peek() -> uint16:
    return ScicRegs.SCIRXBUF.all  #!
"""


def sci(*, tx: int = 2, rx: int = 2, high: int = 2, low: int = 0x8A, control: int = 0x23) -> Driver:
    driver = Driver(SCI.format(tx=tx, rx=rx, high=high, low=low, control=control))
    driver.start()
    return driver


def test_characters_that_are_waited_for_are_silent() -> None:
    driver = sci()
    driver.peek()  # start-up code empties the buffer
    driver.put(0x41)
    driver.board.link.feed(b"xy")
    assert [driver.get(), driver.get()] == [0x78, 0x79]
    assert not driver.rules()


@pytest.mark.parametrize(("setting", "name"), [
    ({"tx": 0}, "SCITXDC"), ({"control": 0x21}, "ScicRegs.SCICTL1.TXENA"),
    ({"control": 0x03}, "ScicRegs.SCICTL1.SWRESET"), ({"high": 0, "low": 0}, "ScicRegs.SCILBAUD"),
])  # fmt: skip
def test_a_character_for_a_module_that_cannot_send_it(setting: dict[str, int], name: str) -> None:
    driver = sci(**setting)
    driver.put(0x41)
    assert driver.only("not-configured").object == name


def test_a_character_that_comes_to_a_pin_with_another_function() -> None:
    driver = sci(rx=0)
    driver.board.link.feed(b"x")
    driver.wait_ms(3)
    finding = driver.findings.of("not-configured")[0]
    assert finding.object == "SCIRXDC"
    assert "GPIO90 has function 4" in finding.message  # GMUX 1, MUX 0


def test_a_character_read_without_looking() -> None:
    driver = sci()
    driver.board.link.feed(b"x")
    driver.get()
    driver.peek()
    assert "RXRDY = 0" in driver.only("result-not-ready").message


EQEP = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO11 = {gmux}
    GpioCtrlRegs.GPAMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO11 = 1
    EDIS()
    EQep1Regs.QPOSMAX = {maximum}
    EQep1Regs.QUPRD = 200000
    EQep1Regs.QEPCTL.bit.UTE = {unit}
    EQep1Regs.QEPCTL.bit.QPEN = {on}


# drv.c: position
def position() -> int32:
    return int32(EQep1Regs.QPOSCNT)  #!


# drv.c: latched
def latched() -> int32:
    return int32(EQep1Regs.QPOSLAT)  #!


# drv.c: unit
def unit() -> int32:
    while EQep1Regs.QFLG.bit.UTO == 0:
        pass
    EQep1Regs.QCLR.bit.UTO = 1
    return int32(EQep1Regs.QPOSLAT)
"""


def eqep(source: str = "", *, gmux: int = 1, maximum: str = "0xFFFFFFFF", unit: int = 1, on: int = 1) -> Driver:
    driver = Driver(EQEP.format(gmux=gmux, maximum=maximum, unit=unit, on=on) + source)
    driver.start()
    return driver


def test_an_encoder_that_counts_is_silent() -> None:
    driver = eqep()
    for _ in range(4):
        driver.position()
        driver.unit()
    assert not driver.rules()


@pytest.mark.parametrize(("setting", "name"), [
    ({"on": 0}, "EQep1Regs.QEPCTL.QPEN"), ({"maximum": "0"}, "EQep1Regs.QPOSMAX"), ({"gmux": 0}, "EQEP1"),
])  # fmt: skip
def test_a_position_that_cannot_count(setting: dict[str, object], name: str) -> None:
    driver = eqep(**setting)  # type: ignore[arg-type]
    driver.position()
    assert driver.only("not-configured").object == name


def test_a_latch_that_nothing_fills() -> None:
    driver = eqep(unit=0)
    driver.latched()
    assert driver.only("not-configured").object == "EQep1Regs.QEPCTL.UTE"


def test_a_unit_time_out_that_is_never_cleared() -> None:
    driver = eqep("""
# drv.c: forgetful
def forgetful() -> void:
    while EQep1Regs.QFLG.bit.UTO == 0:  #!
        pass
    DelayUs(1500)
""")
    driver.forgetful()
    assert not driver.rules(), "the first wait is right"
    driver.forgetful()
    assert driver.only("flag-not-cleared").object == "EQep1Regs.QFLG.UTO"


PWM = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = {mux}
    EDIS()
    EPwm2Regs.TBPRD = 4999
    EPwm2Regs.CMPA.bit.CMPA = 0
    EPwm2Regs.AQCTLA.bit.ZRO = 2
    EPwm2Regs.AQCTLA.bit.CAU = 1
    EPwm2Regs.TBCTL.bit.CTRMODE = {mode}
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = {sync}
    EDIS()


# drv.c: duty
def duty(counts: uint16) -> void:
    EPwm2Regs.CMPA.bit.CMPA = counts  #!
"""


@pytest.mark.parametrize(("setting", "name"), [
    ((1, 0, 0), "CpuSysRegs.PCLKCR0.TBCLKSYNC"), ((1, 3, 1), "EPwm2Regs.TBCTL.CTRMODE"), ((0, 0, 1), "EPWM2A"),
    ((1, 0, 1), ""),
])  # fmt: skip
def test_a_duty_that_reaches_no_pin(setting: tuple[int, int, int], name: str) -> None:
    mux, mode, sync = setting
    driver = Driver(PWM.format(mux=mux, mode=mode, sync=sync))
    driver.start()
    driver.duty(100)  # start-up code may still be at work
    assert not driver.rules()
    driver.wait_ms(20)
    driver.duty(200)
    if name:
        assert driver.only("not-configured").object == name
    else:
        assert not driver.rules()


@pytest.mark.parametrize(("word", "reserved"), [("0x028A", True), ("0x008A", False), ("0xFFFF", False)])
def test_ones_in_reserved_bits(word: str, reserved: bool) -> None:
    driver = Driver(f"""
# drv.c: baud
def baud() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_C = 1
    EDIS()
    ScicRegs.SCILBAUD.all = {word}  #!
""")
    driver.baud()
    if reserved:
        assert driver.only("reserved-field").object == "ScicRegs.SCILBAUD"
    else:
        assert not driver.rules()


def test_flag_registers_may_be_cleared_whole() -> None:
    driver = Driver("""
# drv.c: clear
def clear() -> void:
    PieCtrlRegs.PIEACK.all = 0x8FFF
""")
    driver.clear()
    assert not driver.rules()
