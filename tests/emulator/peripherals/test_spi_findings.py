"""What a driver does wrong with the SPI: one driver with the defect, one without, for each rule."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver

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
    GpioCtrlRegs.GPBMUX2.bit.GPIO60 = {clk}
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


def spi(source: str = "", *, talk: int = 1, run: int = 1, somi: int = 3, clk: int = 3) -> Driver:
    driver = Driver(SPI.format(talk=talk, run=run, somi=somi, clk=clk) + source)
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
    ({"talk": 0}, "SpiaRegs.SPICTL.TALK"), ({"run": 0}, "SpiaRegs.SPICCR.SPISWRESET"), ({"clk": 0}, "SPI-A"),
])  # fmt: skip
def test_a_word_for_a_module_that_cannot_send_it(setting: dict[str, int], name: str) -> None:
    driver = spi(
        """
# drv.c: send
def send() -> void:
    cs(0)
    SpiaRegs.SPITXBUF = 0x8F00  #!
    DelayUs(20)
    cs(1)
""",
        **setting,
    )
    driver.send()
    assert driver.only("not-configured").object == name


def test_an_answer_without_a_pin_is_lost_and_a_word_without_answer_is_not() -> None:
    driver = spi("""
# drv.c: send
def send() -> void:
    cs(0)
    transfer(0x8F)
    cs(1)
""", somi=0)
    driver.send()
    assert not driver.rules()
    assert driver.who() == 0
    found = driver.only("not-configured")
    assert "the answer does not reach the module" in found.message
    assert found.place is not None
    assert driver.lines[found.place.line - 1].lstrip().startswith("SpiaRegs.SPITXBUF")


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
    assert "no word was received" in twice.only("result-not-ready").message


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


SENDER = """
# drv.c: send
def send(word: uint16) -> uint16:
    SpiaRegs.SPITXBUF = word  # here
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    return SpiaRegs.SPIRXBUF
"""


def test_a_word_to_nobody() -> None:
    driver = spi()
    driver.transfer(0x8F)
    assert driver.only("spi-no-device").object == "SPI-A"


@pytest.mark.parametrize(("words", "told"), [
    # A command and the words that fetch its answer, all in the lower half.
    ((0x009F, 0, 0), True), ((0x0003, 0x0000), True), ((0, 0x0005), True),
    # The command is in the upper half; what fetches the answer may be anything, if it stays the same.
    ((0x9F00, 0x00FF, 0x00FF), False), ((0x00FF, 0x00FF, 0x00FF), False), ((0, 0, 0), False), ((0x0005,), False),
    # Nothing is known before the transaction ends: its last word may be one that is sent.
    ((0x0003, 0x0000, 0x8000), False),
])  # fmt: skip
def test_a_transaction_that_sends_nothing_of_its_words(words: tuple[int, ...], told: bool) -> None:
    driver = spi(SENDER)
    driver.cs(0)
    for word in words:
        driver.send(word)
    assert not driver.findings.of("spi-width")
    driver.cs(1)
    found = [(f.value, driver.lines[f.place.line - 1]) for f in driver.findings.of("spi-width") if f.place]
    assert found == [(next(filter(None, words), 0), "    SpiaRegs.SPITXBUF = word  # here")] * told


@pytest.mark.parametrize(("words", "told"), [
    ((0x1234, 0x5678), True), ((0x008F, 0x0003), True), ((0x1234, 0x3400, 0x5678, 0x7800), False),
    ((0x00FF, 0x00FF), False), ((0x1200, 0x3400), False),
])  # fmt: skip
def test_words_of_which_characters_of_eight_bits_send_the_upper_half(words: tuple[int, ...], told: bool) -> None:
    driver = spi(SENDER)
    driver.cs(0)
    for word in words:
        driver.send(word)
    found = [(f.value, driver.lines[f.place.line - 1]) for f in driver.findings.of("spi-width") if f.place]
    assert found == [(words[1], "    SpiaRegs.SPITXBUF = word  # here")] * told
