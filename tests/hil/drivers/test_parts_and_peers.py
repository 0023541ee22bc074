"""What the parts around the chip take: clocks, baud rates; and what a statement does to pins that it does not name."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.board import load
from hil.drivers.check import DriverFiles, check_files
from tests.corpus.corpus import chosen, drivers, measured

HEAD = '#include "F28x_Project.h"\nvolatile Uint16 Seen;\n'


def found(folder: Path, text: str, rule: str, *, seconds: float = 0.01, named: bool = False) -> list[Finding]:
    """What the check of a program says by one rule, with the parts of the robot around it."""
    file = folder / "drv.c"
    file.write_text(text, encoding="utf-8")
    wanted = DriverFiles([file], seconds=seconds, board=load("robot"), board_named=named)
    return [finding for finding in check_files(wanted).findings if finding.rule == rule]


def gyro(divider: int) -> str:
    """WHO_AM_I of the gyro is read with LSPCLK (50 MHz) divided by `divider`."""
    (driver,) = (driver for driver in drivers() if driver.name == "gyro_rate")
    text = driver.text
    (line,) = (line for line in text.splitlines() if "SPI_BIT_RATE = " in line)
    return text.replace(line, f"    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = {divider - 1};")


@pytest.mark.parametrize(("divider", "megahertz"), [(4, "12.5"), (5, "")])
def test_a_part_is_not_clocked_faster_than_its_data_sheet_allows(tmp_path: Path, divider: int, megahertz: str) -> None:
    # 50 MHz / 5 is 10 MHz, which the L3G4200D takes just so.
    findings = found(tmp_path, gyro(divider), "device-clock")
    assert [f"with {megahertz} MHz" in finding.message for finding in findings] == [True] * bool(megahertz)


def serial(baud: int) -> str:
    """SCI-C sends at a rate to the radio of the robot, which has 9600 baud."""
    rate = 50_000_000 // (8 * baud) - 1
    return f"""{HEAD}void main(void)
{{
    InitSysCtrl();
    GPIO_SetupPinMux(89, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinOptions(89, GPIO_OUTPUT, GPIO_PUSHPULL);
    ScicRegs.SCICCR.all = 0x0007;
    ScicRegs.SCIHBAUD.all = {rate >> 8};
    ScicRegs.SCILBAUD.all = {rate & 0xFF};
    ScicRegs.SCICTL1.all = 0x0022;
    for (;;) {{
        while (ScicRegs.SCICTL2.bit.TXRDY == 0)
            ;
        ScicRegs.SCITXBUF.all = 'x';
    }}
}}
"""


@pytest.mark.parametrize(("baud", "told"), [(9600, False), (9200, False), (9000, True), (19200, True)])
def test_the_other_end_of_a_line_hears_its_own_rate(tmp_path: Path, baud: int, told: bool) -> None:
    # Half a bit off at the tenth bit, 5.3 %, is too much: 9200 is 4.3 % off, 9000 is 6.7 %.
    findings = found(tmp_path, serial(baud), "serial-rate", named=True)
    assert [(f.place.function, f.how) for f in findings if f.place] == [("main", "dynamic")] * told
    lines = serial(baud).splitlines()
    assert all("SCILBAUD" in lines[finding.place.line - 1] for finding in findings if finding.place)


def test_a_program_without_a_board_of_its_own_may_have_another_peer(tmp_path: Path) -> None:
    assert [finding.how for finding in found(tmp_path, serial(115200), "serial-rate")] == ["generated"]


BOARD = """from hil.board import Board

class Own(Board):
    def solder(self):
        line = self.to_pc(tx_gpio=89, rx_gpio=90, baud=57600)
        self.clock.after(2_000_000, lambda: line.feed(b"hi"))
"""


@pytest.mark.parametrize(("baud", "told"), [(57600, False), (115200, True)])
def test_the_chip_hears_its_own_rate_too(tmp_path: Path, baud: int, told: bool) -> None:
    (tmp_path / "own.py").write_text(BOARD, encoding="utf-8")
    begin, _, _ = serial(baud).partition("    for (;;)")
    text = begin.replace("GPIO_SetupPinMux(89,", "GPIO_SetupPinMux(90, GPIO_MUX_CPU1, 6);\n    GPIO_SetupPinMux(89,")
    text += "    for (;;) {\n    if (ScicRegs.SCIRXST.bit.RXRDY)\n        Seen = ScicRegs.SCIRXBUF.all;\n    }\n}\n"
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "own.py"))
    checked = check_files(DriverFiles([tmp_path / "drv.c"], seconds=0.02, board=board, board_named=True))
    places = [finding.place for finding in checked.findings if finding.rule == "serial-rate" and finding.place]
    assert ["SCILBAUD" in text.splitlines()[place.line - 1] for place in places] == [True] * told


def test_a_bus_of_two_wires_has_400_khz_at_most() -> None:
    ((driver, _, lines, result),) = measured(chosen("i2c-bus-faster-than-400-khz"))
    assert [(rule, "625 kHz" in text) for line, rule, text in result.told if line in lines] == [("i2c-clock", True)]
    assert driver.name == "i2c_probe"


LATCH = """void main(void)
{{
    InitSysCtrl();
    EALLOW;
    GpioCtrlRegs.GPBPUD.bit.GPIO33 = 0;            /* an input that its pull-up holds high */
    GpioCtrlRegs.GPBDIR.bit.GPIO34 = 1;
    EDIS;
    DELAY_US(5);
    {lamp}
    {before}
    EALLOW;
    GpioCtrlRegs.GPBDIR.bit.GPIO33 = 1;
    EDIS;
    Seen = GpioDataRegs.GPBDAT.bit.GPIO33;
    for (;;) {{ DELAY_US(10); }}
}}
"""


@pytest.mark.parametrize(("lamp", "before", "told"), [
    ("GpioDataRegs.GPBDAT.bit.GPIO34 = 1;", "", True),
    ("GpioDataRegs.GPBDAT.all ^= 4;", "", True),
    ("GpioDataRegs.GPBSET.bit.GPIO34 = 1;", "", False),
    ("GpioDataRegs.GPBTOGGLE.bit.GPIO34 = 1;", "", False),
    # A latch that is given on purpose before the pin drives is nobody's copy.
    ("GpioDataRegs.GPBDAT.bit.GPIO34 = 1;", "GpioDataRegs.GPBCLEAR.bit.GPIO33 = 1;", False),
    ("GpioDataRegs.GPBDAT.all = 6;", "", False),
])  # fmt: skip
def test_a_statement_about_one_pin_does_not_decide_what_another_one_drives(
    tmp_path: Path, lamp: str, before: str, told: bool
) -> None:
    text = HEAD + LATCH.format(lamp=lamp, before=before)
    findings = found(tmp_path, text, "latch-copied")
    assert [f.object for f in findings] == ["GPIO33"] * told
    assert all(f.place and lamp in text.splitlines()[f.place.line - 1] for f in findings)


TRIP = """__interrupt void Tripped(void)
{{
    EALLOW;
    EPwm1Regs.TZCLR.bit.OST = 1;
    {clear}
    EDIS;
    Seen++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP2;
}}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    InitPieVectTable();
    EALLOW;
    PieVectTable.EPWM1_TZ_INT = &Tripped;
    EPwm1Regs.TZEINT.bit.OST = 1;
    EDIS;
    PieCtrlRegs.PIEIER2.bit.INTx1 = 1;
    IER |= M_INT2;
    EINT;
    for (;;) {{
        DELAY_US(100);
        EALLOW;
        EPwm1Regs.TZFRC.bit.OST = 1;
        EDIS;
    }}
}}
"""


@pytest.mark.parametrize(("clear", "told"), [("EPwm1Regs.TZCLR.bit.INT = 1;", False), ("", True)])
def test_the_interrupt_flag_of_a_trip_holds_the_next_one_back(tmp_path: Path, clear: str, told: bool) -> None:
    # A routine may leave a flag for what comes later: 100 ms are too long for that.
    findings = found(tmp_path, HEAD + TRIP.format(clear=clear), "flag-not-cleared", seconds=0.15)
    assert [(f.object, f.place.function) for f in findings if f.place] == [("EPwm1Regs.TZFLG.INT", "Tripped")] * told


#: A pot at ADCINB2, a thermistor at ADCINB3.
SENSORS = """from hil.board import Board

class Volts:
    def volts(self, cycles):
        return 1.0

class Own(Board):
    def solder(self):
        self.on_adc("pot", Volts(), adc="B", channel=2)
        self.on_adc("thermistor", Volts(), adc="B", channel=3)
"""
CONVERTS = HEAD + """void main(void)
{
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcbRegs.ADCSOC1CTL.bit.ACQPS = 14;
    AdcbRegs.ADCSOC1CTL.bit.CHSEL = 3;
    EDIS;
    for (;;) {
        AdcbRegs.ADCSOCFRC1.all = 3;
        DELAY_US(100);
        Seen = AdcbResultRegs.ADCRESULT0 + AdcbResultRegs.ADCRESULT1;
    }
}
"""


@pytest.mark.parametrize(("was", "now", "at", "named"), [
    ("", "", "", True),
    ("CHSEL = 3;", "CHSEL = 4;", "CHSEL = 4;", True),
    # Without a board of its own the program may be meant for another one.
    ("CHSEL = 3;", "CHSEL = 4;", "CHSEL = 4;", False),
    # It keeps its reset value, 0.
    ("    AdcbRegs.ADCSOC1CTL.bit.CHSEL = 3;\n", "", "ADCSOC1CTL.bit.ACQPS", True),
    # Both parts are converted, and another input, too.
    ("CHSEL = 3;", "CHSEL = 3; AdcbRegs.ADCSOC2CTL.bit.CHSEL = 5; Seen = AdcbResultRegs.ADCRESULT2;", "", True),
    # Another statement chooses the part.
    ("        DELAY_US(100);", "        DELAY_US(100);\n        if (Seen == 7) AdcbRegs.ADCSOC1CTL.bit.CHSEL = 3;\n"
     "        else AdcbRegs.ADCSOC1CTL.bit.CHSEL = 4;", "", True),
    # Channels inside of the chip are no inputs; nobody reads this result.
    ("CHSEL = 3;", "CHSEL = 12;", "", True),
    ("CHSEL = 3;", "CHSEL = 4;\n#define ADCRESULT1 ADCRESULT0", "", True),
])  # fmt: skip
def test_an_input_that_nothing_drives(tmp_path: Path, was: str, now: str, at: str, named: bool) -> None:
    assert not was or CONVERTS.count(was) == 1
    text = CONVERTS.replace(was, now) if was else CONVERTS
    (tmp_path / "own.py").write_text(SENSORS, encoding="utf-8")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "own.py"))
    checked = check_files(DriverFiles([tmp_path / "drv.c"], seconds=0.003, board=board, board_named=named))
    findings = [f for f in checked.findings if f.rule == "adc-input-open"]
    assert [(f.how, "thermistor drives ADCINB3" in f.message) for f in findings] == [
        ("dynamic" if named else "generated", True)
    ] * bool(at)
    assert all(f.place is not None and at in text.splitlines()[f.place.line - 1] for f in findings)
