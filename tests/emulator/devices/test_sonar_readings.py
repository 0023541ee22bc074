"""What a driver makes of the sonars' analog outputs: each finding with a driver that does it right.

A sensor's cycle takes 49 ms; in the board's ring of three a range is held for 147 ms.
"""

from __future__ import annotations

from emulator.clock import CYCLES_PER_MS
from emulator.devices.lv_maxsonar_beam import INCH_M, Echo
from tests.emulator.drivers import Driver

SOURCE = """
total: int32 = 0

# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
    DelayUs(1000)
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 1
    EDIS()


# drv.c: ring
def ring() -> void:
    GpioDataRegs.GPCSET.bit.GPIO69 = 1
    DelayUs(30)
    GpioDataRegs.GPCCLEAR.bit.GPIO69 = 1
    DelayUs(10)
    EALLOW()
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 0
    EDIS()


# drv.c: convert
def convert() -> uint16:
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    AdcaRegs.ADCSOCFRC1.all = 1  #!
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    return AdcaResultRegs.ADCRESULT0


# drv.c: distance
def distance() -> uint16:
    n: int16
    total = 0
    for n in range(12):
        total += convert()
    return uint16(total / 12)


# drv.c: task
def task(times: int16, ms: uint16) -> void:
    k: int16
    n: int16
    for k in range(times):
        distance()  #!
        for n in range(ms):
            DelayUs(1000)
"""


class Scene:
    """Every sensor sees this many inches."""

    def __init__(self, inches: float) -> None:
        self.inches = inches

    def __call__(self, _name: str, _cycles: int) -> Echo:
        return Echo(self.inches * INCH_M)


def sonars(*, ringing: bool = True, settled: bool = True) -> tuple[Driver, Scene]:
    driver, scene = Driver(SOURCE), Scene(40)
    driver.board.sonars.set_range_source(scene)
    driver.start()
    if ringing:
        driver.ring()
        if settled:
            driver.wait_ms(200)
    return driver, scene


def test_a_reading_every_5_ms_is_29_readings_of_one_range() -> None:
    driver, _ = sonars()
    driver.task(60, 5)
    finding = driver.only("stale-sample")
    assert finding.object == "sonar LEFT AN"
    # A reading takes 5 ms and the time of twelve conversions; 147 ms hold 28 or 29 of them.
    assert finding.value in (28, 29)
    assert [place.function for place in finding.call_path] == ["task"]


def test_a_burst_of_twelve_at_each_range_is_silent() -> None:
    driver, _ = sonars()
    driver.task(8, 147)
    assert not driver.rules()


def test_two_readings_in_a_cycle_are_silent() -> None:
    driver, _ = sonars()
    driver.task(30, 25)
    assert not driver.rules()


def test_a_reading_before_the_first_range() -> None:
    driver, _ = sonars(settled=False)
    driver.convert()
    assert driver.only("startup-read").object == "sonar LEFT AN"
    driver.wait_ms(100)
    driver.convert()
    assert driver.only("startup-read").count == 1


def test_a_sonar_that_nobody_starts() -> None:
    driver, _ = sonars(ringing=False)
    driver.convert()
    assert driver.only("not-configured").object == "sonar LEFT RX"


def test_a_reading_while_the_output_moves_far() -> None:
    driver, scene = sonars()
    sensor = driver.board.sonars.sensors["LEFT"]
    scene.inches = 20.0
    readings = sensor.readings
    while sensor.readings == readings:
        driver.wait_ms(1)
    # From 40 to 20 inches: the echo comes after 20 * 147 us = 2.94 ms, the move ends at 44.3 ms; half-way is 30.
    ping_ms = (driver.board.clock.now - sensor.last_ping_cycles) / CYCLES_PER_MS
    driver.wait_ms(23.6 - ping_ms)
    driver.convert()
    finding = driver.only("slew-read")
    assert finding.value == 30
    assert "from 40 to 20 inches" in finding.message


def test_a_reading_while_the_output_moves_a_little_or_holds_is_silent() -> None:
    driver, scene = sonars()
    sensor = driver.board.sonars.sensors["LEFT"]
    scene.inches = 37.0
    readings = sensor.readings
    while sensor.readings == readings:
        driver.wait_ms(1)
    driver.wait_ms(20)
    driver.convert()
    scene.inches = 100.0
    while sensor.readings == readings + 1:
        driver.wait_ms(1)
    driver.wait_ms(46)  # past 44.3 ms of the cycle
    driver.convert()
    assert not driver.rules()
