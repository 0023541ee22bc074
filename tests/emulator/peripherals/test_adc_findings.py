"""What a driver does wrong with the ADC: one driver with the defect, one without, for each rule."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files
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
    driver = adc(
        CONVERT
        + """
# drv.c: wrong
def wrong() -> uint16:
    return AdcaResultRegs.ADCRESULT1  #!
"""
    )
    driver.convert()
    driver.wrong()
    assert "SOC1 was ever converted" in driver.only("result-not-ready").message


def test_a_result_of_a_converter_without_power() -> None:
    driver = adc(
        """
# drv.c: read
def read() -> uint16:
    return AdcaResultRegs.ADCRESULT0  #!
""",
        power=0,
    )
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
    board.adc["A"].trigger(5)
    driver.wait_ms(1)
    board.adc["A"].trigger(5)
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


TRIGGERED = """
# drv.c: run
def run() -> void:
    EALLOW()
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 1
    EDIS()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200, 10)
    CpuTimer0Regs.TCR.bit.TIE = 1
    CpuTimer0Regs.TCR.bit.TSS = 0
    DelayUs(100)
"""
LOOK = """
# drv.c: look
def look() -> uint16:
    return AdcaRegs.ADCINTFLG.bit.ADCINT1
"""


def test_a_flag_that_nobody_looks_at_may_stand() -> None:
    driver = adc(TRIGGERED)
    driver.run()
    assert driver.board.register("AdcaRegs", "ADCINTOVF").value == 1, "conversions have ended, with the flag set"
    assert not driver.rules()


def test_a_flag_that_a_program_reads_must_be_cleared() -> None:
    driver = adc(TRIGGERED + LOOK)
    driver.run()
    assert driver.only("flag-not-cleared").object == "AdcaRegs.ADCINTFLG.ADCINT1"


def test_a_flag_whose_interrupt_is_enabled_must_be_cleared() -> None:
    enabled = TRIGGERED.replace("    EDIS()", "    EDIS()\n    PieCtrlRegs.PIEIER1.bit.INTx1 = 1", 1)
    driver = adc(enabled)
    driver.run()
    assert driver.only("flag-not-cleared").object == "AdcaRegs.ADCINTFLG.ADCINT1"


DMA = """
# drv.c: listen
def listen(source: uint16) -> void:
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.DMA = 1
    DmaClaSrcSelRegs.DMACHSRCSEL1.bit.CH1 = source
    DmaRegs.CH1.MODE.bit.PERINTSEL = 1
    DmaRegs.CH1.MODE.bit.PERINTE = 1
    EDIS()
"""


@pytest.mark.parametrize(
    ("source", "found"),
    # HDR F2837xS_Dma_defines.h: 1 is ADCAINT1, 2 ADCAINT2, 109 the level of SPI-A's transmit FIFO.
    [(1, ["flag-not-cleared"]), (2, []), (109, [])],
)
def test_a_flag_that_triggers_the_dma_must_be_cleared_and_no_other(source: int, found: list[str]) -> None:
    driver = adc(TRIGGERED + DMA)
    driver.listen(source)
    driver.run()
    assert driver.rules() == found


@pytest.mark.parametrize(("trigger", "found"), [(1, ["flag-not-cleared"]), (2, [])])
def test_a_flag_that_triggers_a_soc_must_be_cleared_and_no_other(trigger: int, found: list[str]) -> None:
    # TRM ADCINTSOCSEL1: 1 is ADCINT1, 2 is ADCINT2; SOC0 raises ADCINT1 only.
    triggers = TRIGGERED.replace("    EDIS()", f"    AdcaRegs.ADCINTSOCSEL1.bit.SOC1 = {trigger}\n    EDIS()", 1)
    driver = adc(triggers)
    driver.run()
    assert driver.rules() == found


SEQUENCE = """#include "F28x_Project.h"
int32 power = 0;
interrupt void sample(void)
{
    Uint16 u = AdcaResultRegs.ADCRESULT0;
    power += (int32)u * AdcaResultRegs.ADCRESULT1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.ADCA1_INT = &sample;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.all = 0x00100000UL + (2UL << 15) + 29;     /* CPU timer 0 */
    AdcaRegs.ADCSOC1CTL.all = 0x00100000UL + (3UL << 15) + 29;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200.0f, 100.0f);
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    for (;;) ;
}
"""


@pytest.mark.parametrize(("was", "now", "noted"), [
    ("", "", True),
    ("    Uint16 u =", "    Uint16 u;\n    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;\n    u =", True),
    # The last of the trigger; a routine that is slow enough; another trigger.
    ("INT1SEL = 0", "INT1SEL = 1", False),
    ("    Uint16 u =", "    Uint16 u;\n    DELAY_US(1);\n    u =", False),
    ("ADCSOC1CTL.all = 0x00100000UL", "ADCSOC1CTL.all = 0x00200000UL", False),
])  # fmt: skip
def test_a_result_of_the_trigger_before_in_the_routine_of_another_soc(
    tmp_path: Path, was: str, now: str, noted: bool
) -> None:
    (tmp_path / "drv.c").write_text(SEQUENCE.replace(was, now) if was else SEQUENCE, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, seconds=0.005))
    assert [f.object for f in checked.findings if f.rule == "result-of-before"] == (
        ["AdcaResultRegs.ADCRESULT1"] * noted
    )
