"""What a driver makes of the gyro's samples, at 100 Hz: each finding with a driver that does it right.

One sample lasts 10 ms; turn-on is over 250 ms after power-down.
"""

from __future__ import annotations

import pytest

from emulator.clock import CYCLES_PER_MS
from tests.emulator.drivers import Driver

SOURCE = """
total: int32 = 0

# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1
    GpioCtrlRegs.GPBGMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO60 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO60 = 3
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    GpioCtrlRegs.GPBDIR.bit.GPIO61 = 1
    EDIS()
    SpiaRegs.SPICCR.bit.SPICHAR = 7
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1
    SpiaRegs.SPICTL.bit.TALK = 1
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49
    SpiaRegs.SPICCR.bit.SPISWRESET = 1


# drv.c: transfer
def transfer(c: uint16) -> uint16:
    SpiaRegs.SPITXBUF = c << 8
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    return SpiaRegs.SPIRXBUF & 0xFF


# drv.c: put
def put(reg: uint16, value: uint16) -> void:
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    transfer(reg)
    transfer(value)
    GpioDataRegs.GPBSET.bit.GPIO61 = 1


# drv.c: byte
def byte(reg: uint16) -> uint16:
    c: uint16
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    transfer(0x80 | reg)
    c = transfer(0)
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    return c


# drv.c: get
def get() -> int16:
    low: uint16
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    transfer(0xEC)
    low = transfer(0)
    low = low | transfer(0) << 8
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    return int16(low)


# drv.c: all_axes
def all_axes() -> uint16:
    c: uint16
    n: uint16
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    transfer(0xE8)
    for n in range(6):
        c = transfer(0)
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    return c
"""


def gyro(source: str = "", *, reg1: int = 0x0F, reg4: int = 0x80, settled: bool = True) -> Driver:
    driver = Driver(SOURCE + source)
    driver.start()
    driver.put(0x23, reg4)
    driver.put(0x20, reg1)
    if settled:
        driver.wait_ms(261)
    return driver


def sampled(driver: Driver, period_ms: float, times: int) -> None:
    for _ in range(times):
        driver.get()
        driver.wait_ms(period_ms)


FIFTY = """
# drv.c: offset
def offset() -> int32:
    n: int16
    for n in range(50):
        total += get(){mark}
        {wait}
    return total / 50
"""


def test_fifty_reads_of_one_sample_are_one_finding_in_the_loop_that_makes_them() -> None:
    driver = gyro(FIFTY.format(mark="  #!", wait="pass"))
    driver.offset()
    finding = driver.only("stale-sample")
    assert finding.value == 50  # 50 reads of three words at 1 MHz, about 27 us each, are 2 ms of a sample's 10 ms
    assert finding.message.startswith("50 reads of L3G4200D.OUT_Z")
    assert finding.call_path[0].function == "offset"


def test_fifty_reads_of_fifty_samples_are_silent() -> None:
    driver = gyro(FIFTY.format(mark="", wait="DelayUs(10100)"))
    driver.offset()
    assert not driver.rules()


def test_waiting_for_data_ready_is_silent_however_fast_the_loop() -> None:
    driver = gyro("""
# drv.c: offset
def offset() -> int32:
    n: int16
    for n in range(50):
        while byte(0x27) & 8 == 0:
            pass
        all_axes()
    return total / 50
""")
    driver.all_axes()
    driver.offset()
    assert not driver.rules()


def test_a_pair_of_reads_each_period_takes_the_mean_of_one_sample() -> None:
    driver = gyro("""
# drv.c: loop
def loop() -> void:
    n: int16
    for n in range(20):
        total += get()
        total += get()  #!
        DelayUs(9900)
""")
    driver.loop()
    assert "10 of 20 reads" in driver.only("stale-sample").message


def test_a_task_at_twice_the_data_rate_polls_above_it() -> None:
    driver = gyro("""
# drv.c: loop
def loop() -> void:
    n: int16
    for n in range(60):
        total += get()  #!
        DelayUs(4964)
""")
    driver.loop()  # 200 reads a second
    finding = driver.only("polling-above-rate")
    assert finding.value == pytest.approx(2.0, abs=0.05)
    assert "sampled 100.0 times" in finding.message


@pytest.mark.parametrize("period_ms", [9.6, 10.0, 12.0, 30.0])
def test_a_reader_near_the_data_rate_may_meet_a_sample_twice(period_ms: float) -> None:
    # 9.6 ms: a sample is met twice once in 25 reads, 4 %.
    driver = gyro()
    sampled(driver, period_ms - 0.03, 100)
    assert not driver.rules()


def test_reads_in_the_turn_on_time() -> None:
    driver = gyro(settled=False)
    driver.get()
    assert "before the first sample" in driver.only("startup-read").message
    driver.wait_ms(100)
    driver.get()
    driver.wait_ms(161)
    driver.get()
    assert driver.only("startup-read").count == 2


def test_an_output_in_power_down_and_of_a_disabled_axis() -> None:
    asleep = gyro(reg1=0x07)
    asleep.get()
    assert asleep.only("not-configured").object == "L3G4200D.CTRL_REG1.PD"
    no_z = gyro(reg1=0x0B)
    no_z.get()
    assert no_z.only("not-configured").object == "L3G4200D.CTRL_REG1.Zen"


def test_a_burst_over_axes_that_are_off_to_one_that_is_on_is_silent() -> None:
    driver = gyro(reg1=0x0C)
    driver.all_axes()
    assert not driver.rules()


@pytest.mark.parametrize(("reg4", "torn"), [(0x00, True), (0x80, False)])
def test_two_bytes_in_two_transactions(reg4: int, torn: bool) -> None:
    driver = gyro(reg4=reg4)
    driver.byte(0x2C)
    driver.wait_ms(11)
    driver.byte(0x2D)
    if torn:
        assert driver.only("spread-read").object == "L3G4200D.OUT_Z"
    else:
        assert not driver.rules()


def test_two_bytes_of_one_sample_in_two_transactions_are_silent() -> None:
    driver = gyro(reg4=0)
    # Just after a sample: the next is 10 ms away.
    device = driver.board.gyro
    driver.wait_ms((device.period_cycles - driver.board.clock.now % device.period_cycles) / CYCLES_PER_MS)
    driver.byte(0x2C)
    driver.byte(0x2D)
    assert not driver.rules()


@pytest.mark.parametrize(("mode", "bypassed"), [(0x00, True), (0x40, False)])
def test_a_fifo_that_is_enabled_and_bypassed(mode: int, bypassed: bool) -> None:
    driver = gyro()
    driver.put(0x24, 0x40)
    driver.put(0x2E, mode)
    driver.wait_ms(11)
    driver.get()
    assert driver.rules() == (["fifo-bypassed"] if bypassed else [])
