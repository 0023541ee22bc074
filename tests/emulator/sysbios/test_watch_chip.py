"""Peripherals that tasks share, and buffers that a handler sends: every defect with its correct twin."""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.watched import OnChip, two_tasks

GATE = "key = GateMutexPri_enter(gate)\n{}\nGateMutexPri_leave(gate, key)"

ADC = """
# drv.c: adc
def adc() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
    DelayUs(1000)
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 19
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 3
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    AdcaRegs.ADCINTSEL1N2.bit.INT2SEL = 1
    AdcaRegs.ADCINTSEL1N2.bit.INT2E = 1
    EDIS()


# drv.c: read_first
def read_first() -> uint16:
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    AdcaRegs.ADCSOCFRC1.all = 1
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    return AdcaResultRegs.ADCRESULT0


# drv.c: read_second
def read_second() -> uint16:
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT2 = 1
    AdcaRegs.ADCSOCFRC1.all = 2
    while AdcaRegs.ADCINTFLG.bit.ADCINT2 == 0:
        pass
    return AdcaResultRegs.ADCRESULT1
"""

SPI = """
# drv.c: spi
def spi() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1
    EDIS()
    SpiaRegs.SPICCR.bit.SPICHAR = 7
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1
    SpiaRegs.SPICTL.bit.TALK = 1
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49
    SpiaRegs.SPICCR.bit.SPISWRESET = 1


# drv.c: transfer
def transfer(c: uint16) -> uint16:
    SpiaRegs.SPITXBUF = c << 8
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    return SpiaRegs.SPIRXBUF
"""

TRANSFER = "GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1\n{}\n{}\nGpioDataRegs.GPBSET.bit.GPIO61 = 1"
PLAIN = TRANSFER.format("n = transfer(1)", "n = transfer(2)")
GATED = GATE.format("n = transfer(1)")
RETAKE = "GateMutexPri_leave(gate, key)\nkey = GateMutexPri_enter(gate)\nn = transfer(2)"
SELECT = "spi()\nEALLOW()\nGpioDataRegs.GPBSET.bit.GPIO61 = 1\nGpioCtrlRegs.GPBDIR.bit.GPIO61 = 1\nEDIS()"

#: 9600 baud from LSPCLK 50 MHz; a character of 10 bits takes 1.04 ms.
SCI = """
text: array[char, 40]
sending: ptr[char]
left: int16 = 0

# drv.c: sci
def sci() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1
    GpioCtrlRegs.GPBMUX1.bit.GPIO42 = 0
    GpioCtrlRegs.GPBGMUX1.bit.GPIO42 = 3
    GpioCtrlRegs.GPBMUX1.bit.GPIO42 = 3
    EDIS()
    SciaRegs.SCICCR.all = 0x0007
    SciaRegs.SCIHBAUD.all = 2
    SciaRegs.SCILBAUD.all = 0x8A
    SciaRegs.SCIFFTX.all = 0xE040
    SciaRegs.SCIFFRX.all = 0x6041
    SciaRegs.SCICTL1.all = 0x0022


# drv.c: transmit
def transmit(arg: UArg) -> void:
    while left > 0 and SciaRegs.SCIFFTX.bit.TXFFST < 16:
        SciaRegs.SCITXBUF.all = sending[0] & 0x00FF
        sending += 1
        left -= 1
    if left == 0:
        SciaRegs.SCIFFTX.bit.TXFFIENA = 0
        Semaphore_post(semC)
    SciaRegs.SCIFFTX.bit.TXFFINTCLR = 1


# drv.c: send
def send(data: ptr[char], n: int16) -> void:
    key: uint16
    key = Hwi_disable()
    sending = data
    left = n
    Hwi_restore(key)
    SciaRegs.SCIFFTX.bit.TXFFIENA = 1


# drv.c: put
def put(c: char) -> void:
    while SciaRegs.SCIFFTX.bit.TXFFST == 16:
        pass
    SciaRegs.SCITXBUF.all = c
"""
FILL = "for i in range(30):\n    text[i] = 65 + i\n"
SENDER = "Hwi_create(97, transmit, NULL, NULL)\nsci()"  # PIE 9.2: SCI-A transmit
TAKEN = "Semaphore_pend(semC, BIOS_WAIT_FOREVER)"
WORDS = "for i in range(4):\n    put(65)"

RELEASES = "every(postA, 5, {})\nevery(postB, 7, 5)"


def chip(peripheral: str, high: str, low: str, *, start: str, period: int = 5) -> str:
    return two_tasks(peripheral, high, low, start=start, clocks=RELEASES.format(period))


PAIRS = {
    "conversion on one SOC and flag": (
        "transaction-cut", chip(ADC, "n = read_first()", "n = read_first()", start="adc()"),
        chip(ADC, GATE.format("n = read_first()"), GATE.format("n = read_first()"), start="adc()"),
    ),
    "conversion on one SOC, held off": (
        "transaction-cut", chip(ADC, "n = read_first()", "n = read_first()", start="adc()"),
        chip(ADC, "n = read_first()", "key = Task_disable()\nn = read_first()\nTask_restore(key)", start="adc()"),
    ),
    "conversions on a SOC and flag each": (
        "transaction-cut", chip(ADC, "n = read_second()", "n = read_second()", start="adc()"),
        chip(ADC, "n = read_first()", "n = read_second()", start="adc()"),
    ),
    "words on SPI": (
        "transaction-cut", chip(SPI, "n = transfer(1)", "n = transfer(2)", start="spi()"),
        chip(SPI, GATE.format("n = transfer(1)"), GATE.format("n = transfer(2)"), start="spi()"),
    ),
    "words on SPI under a gate, the transfer not": (
        "transaction-cut", chip(SPI, TRANSFER.format(GATED, GATED), TRANSFER.format(GATED, GATED), start=SELECT),
        chip(SPI, GATE.format(PLAIN), GATE.format(PLAIN), start=SELECT),
    ),
    "transfer on SPI under a gate that is left in between": (
        "transaction-cut",
        chip(SPI, GATE.format(TRANSFER.format("n = transfer(1)", RETAKE)),
             GATE.format(TRANSFER.format("n = transfer(1)", RETAKE)), start=SELECT),
        chip(SPI, PLAIN, "key = Task_disable()\n" + PLAIN + "\nTask_restore(key)", start=SELECT),
    ),
    "characters of two tasks": (
        "transaction-cut", chip(SCI, WORDS, WORDS, start="sci()", period=20),
        chip(SCI, GATE.format(WORDS), GATE.format(WORDS), start="sci()", period=20),
    ),
    "frame written while it is sent": (
        # 30 characters take 31 ms; the next frame is made after 20.
        "buffer-rewritten", chip(SCI, FILL + "send(text, 30)", "pass", start=SENDER, period=20),
        chip(SCI, FILL + "send(text, 30)", "pass", start=SENDER, period=40),
    ),
    "frame written before the handler has read it": (
        "buffer-rewritten", chip(SCI, f"{FILL}send(text, 30)\n{FILL}send(text, 30)", "pass", start=SENDER, period=80),
        # The handler says when it has read all; what is in the FIFO then is out of reach.
        chip(SCI, f"{FILL}send(text, 30)\n{TAKEN}\n{FILL}send(text, 30)\n{TAKEN}", "pass", start=SENDER, period=80),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PAIRS)
def test_the_defect_is_found(name: str) -> None:
    rule, defect, _ = PAIRS[name]
    assert rule in OnChip(defect).run(150).rules()


@pytest.mark.parametrize("name", PAIRS)
def test_its_correct_twin_is_silent(name: str) -> None:
    specimen = OnChip(PAIRS[name][2]).run(150)
    assert specimen.rules() == set()
    assert specimen.board.clock.now == 150 * 200_000


def test_a_conversion_that_was_cut_is_told_as_such() -> None:
    """Low converts without a pause, a little later in every job, so that High comes in between sooner or later."""
    low = "steps = steps + 7\nfor i in range(steps):\n    x = x + 1\nfor i in range(6000):\n    n = read_first()"
    specimen = OnChip(chip("steps: int16 = 0\n" + ADC, "n = read_first()", low, start="adc()")).run(60)
    finding = specimen.one("transaction-cut")
    assert finding.object == "AdcaRegs"
    assert any(detail.startswith("it has happened: Low began at") for detail in finding.details)


def test_a_handler_that_takes_the_result_cuts_nothing() -> None:
    """A task starts the conversion and waits; the handler clears the flag and reads."""
    source = chip(
        ADC + """
value: uint16

# drv.c: converted
def converted(arg: UArg) -> void:
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    value = AdcaResultRegs.ADCRESULT0
    Semaphore_post(semC)
""",
        "AdcaRegs.ADCSOCFRC1.all = 1\nSemaphore_pend(semC, BIOS_WAIT_FOREVER)\nn = value", "pass",
        start="adc()\nHwi_create(32, converted, NULL, NULL)",
    )  # fmt: skip
    specimen = OnChip(source).run(60)
    assert specimen.rules() == set()
    assert specimen.board.adc["A"].conversions > 5


def test_a_driver_may_hold_its_handler_off_by_the_peripheral_alone() -> None:
    """The transmit interrupt is off while pointer and length change."""
    quiet = SCI.replace("    key = Hwi_disable()\n", "    SciaRegs.SCIFFTX.bit.TXFFIENA = 0\n").replace(
        "    Hwi_restore(key)\n", ""
    )
    specimen = OnChip(chip(quiet, FILL + "send(text, 30)", "pass", start=SENDER, period=40)).run(150)
    assert specimen.rules() == set()
    bare = SCI.replace("    key = Hwi_disable()\n", "").replace("    Hwi_restore(key)\n", "")
    assert "race-long" in OnChip(chip(bare, FILL + "send(text, 30)", "pass", start=SENDER, period=20)).run(150).rules()
