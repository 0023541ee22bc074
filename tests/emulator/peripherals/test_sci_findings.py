"""What a driver does wrong with an SCI: one driver with the defect, one without, for each rule."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver

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
    ScicRegs.SCICCR.all = {frame}
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


def sci(
    *, tx: int = 2, rx: int = 2, high: int = 2, low: int = 0x8A, control: int = 0x23, frame: int = 7
) -> Driver:  # fmt: skip
    driver = Driver(SCI.format(tx=tx, rx=rx, high=high, low=low, control=control, frame=frame))
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


def test_loopback_needs_no_pins() -> None:
    driver = sci(tx=0, rx=0, frame=0x17)  # SCICCR: 8 bits, LOOPBKENA
    driver.put(0x41)
    assert driver.get() == 0x41
    assert not driver.rules()


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
