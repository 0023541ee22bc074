"""A board of one's own: a sensor on SPI-B, an infrared sensor at ADC-B, twenty lines beside the tests."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

import pytest

from emulator.devices.l3g4200d import L3G4200D
from emulator.image import link
from hil.board import Board, Face, load
from hil.cli import invoke
from hil.testing.outside import Outside

BOARD = '''
from hil.board import Board, Face


class Thermometer:
    """Answers each word with its temperature in sixteenths of a degree."""

    temperature_c = 21.5

    def select(self, level):
        pass

    def exchange(self, out_bits, length, cpol, cpha):
        return round(self.temperature_c * 16) & 0xFFFF


class Infrared:
    """Volts fall with the distance: 0.24 V m over it, at most 3 V."""

    distance_m = 0.8

    def volts(self, cycles):
        return min(3.0, 0.24 / self.distance_m)


class Station(Board):
    spi_pins = {"B": (63, 64, 65)}

    def solder(self):
        self.on_spi("thermometer", Thermometer(), bus="B", select=66)
        self.on_adc("infrared", Infrared(), adc="B", channel=3, faces=[Face("distance_m", "m", 0.08, 2.0)])
'''
DRIVER = """#include "F28x_Project.h"

void Init_Station(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_B = 1;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 3;
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    DELAY_US(1000);
    GPIO_SetupPinMux(63, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(64, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(65, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinOptions(63, GPIO_OUTPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(64, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(65, GPIO_OUTPUT, GPIO_ASYNC);
    GPIO_SetupPinMux(66, GPIO_MUX_CPU1, 0);
    GPIO_WritePin(66, 1);
    GPIO_SetupPinOptions(66, GPIO_OUTPUT, GPIO_PUSHPULL);
    SpibRegs.SPICCR.bit.SPISWRESET = 0;
    SpibRegs.SPICCR.bit.SPICHAR = 15;
    SpibRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpibRegs.SPICTL.bit.TALK = 1;
    SpibRegs.SPIBRR.bit.SPI_BIT_RATE = 49;
    SpibRegs.SPICCR.bit.SPISWRESET = 1;
}

int Read_Sixteenths(void)
{
    int sixteenths;

    GPIO_WritePin(66, 0);
    SpibRegs.SPITXBUF = 0;
    while (SpibRegs.SPISTS.bit.INT_FLAG == 0)
        ;
    sixteenths = SpibRegs.SPIRXBUF;
    GPIO_WritePin(66, 1);
    return sixteenths;
}

Uint16 Read_Infrared(void)
{
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcbRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcbRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    return AdcbResultRegs.ADCRESULT0;
}
"""
TESTS = '''
import pytest

pytestmark = [pytest.mark.board("station.py"), pytest.mark.firmware("station.c")]


def test_both_sensors_are_read(firmware, outside):
    firmware.station.Init_Station()
    outside.part("thermometer").temperature_c = -3.25
    outside.put("infrared", distance_m=0.16)
    assert firmware.station.Read_Sixteenths() == -52  # -3.25 times 16
    assert firmware.station.Read_Infrared() == 2048  # 1.5 V of 3 V, of 4096


def test_a_gyro_is_not_on_this_board(outside):
    with pytest.raises(ValueError, match="Station must have one gyro for this, and has none"):
        outside.gyro_rate_dps(z=10)
    with pytest.raises(ValueError, match="infrared.distance_m = 9: must be 0.08 to 2 m"):
        outside.put("infrared", distance_m=9)
'''


def test_a_project_with_a_board_of_its_own_needs_no_robot(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(station=BOARD, test_station=TESTS)
    (pytester.path / "station.c").write_text(DRIVER)
    (pytester.path / "conftest.py").write_text(
        "import sys\n\n\ndef pytest_sessionfinish():\n    print('robot:', 'firmware_model' in sys.modules)\n"
    )
    outcome = pytester.runpytest_subprocess("-p", "no:xdist", "-s")
    outcome.assert_outcomes(passed=2)
    outcome.stdout.fnmatch_lines(["*robot: False*"])


def test_hil_check_of_drivers_on_a_board_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "station.py").write_text(BOARD)
    (tmp_path / "station.c").write_text(DRIVER)
    script = (
        "import sys\nfrom hil.cli import invoke\n"
        "status = invoke(['check', 'station.c', '--board', 'station.py'])\n"
        "print('robot:', 'firmware_model' in sys.modules, 'status:', status)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True
    )
    assert "robot: False status: 0" in done.stdout, done.stdout


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("class NoBoard: pass\n", "expected one class made from hil.board.Board, found none"),
        ("from hil.board import Board\nclass A(Board): pass\nclass B(Board): pass\n", "found A, B"),
        ("1 / 0\n", "ZeroDivisionError"),
        ("def (:\n", "SyntaxError"),
    ],
)
def test_a_file_that_is_no_board_is_one_line(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "my.py").write_text(text)
    with pytest.raises(ValueError, match=said) as error:
        load("my.py", tmp_path)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["my", "missing.py", "robots"])
def test_a_board_that_is_not_there_is_one_line(tmp_path: Path, name: str) -> None:
    with pytest.raises(ValueError, match="board"):
        load(name, tmp_path)


def test_parts_have_names_of_their_own_and_places_that_exist() -> None:
    class Twice(Board):
        def solder(self) -> None:
            self.add("lamp", object())
            self.add("lamp", object())

    class Elsewhere(Board):
        def solder(self) -> None:
            self.on_adc("infrared", Volts(), adc="E", channel=0)

    class Beyond(Board):
        def solder(self) -> None:
            self.on_adc("infrared", Volts(), adc="B", channel=16)

    with pytest.raises(ValueError, match="two parts called 'lamp'"):
        Twice()
    with pytest.raises(ValueError, match="infrared on ADC-E: this chip has ADC-A, ADC-B, ADC-C, ADC-D"):
        Elsewhere()
    with pytest.raises(ValueError, match="infrared at ADCINB16: ADC-B has ADCINB0 to ADCINB15"):
        Beyond()


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"spi_pins": {"Q": (63, 64, 65)}}, "Wrong.spi_pins: no SPI-Q: this chip has SPI-A, SPI-B, SPI-C"),
        ({"spi_pins": {"B": (63, 64)}}, "Wrong.spi_pins.'B'.: expected the pins of SIMO, SOMI, CLK"),
        ({"i2c_pins": {"A": (32, 169)}}, "Wrong.i2c_pins: no GPIO169: this chip has GPIO0 to GPIO168"),
        ({"pulls": {-1: 1}}, "Wrong.pulls: no GPIO-1"),
    ],
)
def test_wires_lead_to_pins_that_the_chip_has(wrong: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        type("Wrong", (Board,), wrong)()


def test_a_face_that_sets_nothing_is_refused() -> None:
    class Misspelled(Board):
        def solder(self) -> None:
            self.on_adc("v", Volts(), adc="C", channel=0, faces=[Face("level_mv", "mV")])

    with pytest.raises(ValueError, match="the part 'v' has no attribute 'level_mv' for its face"):
        Misspelled()


class Volts:
    """A part whose voltage is set."""

    level_v = 1.0

    def volts(self, cycles: int) -> float:
        """What is set."""
        return self.level_v


def test_a_part_is_found_by_name_and_by_kind_and_its_faces_are_set() -> None:
    class Two(Board):
        def solder(self) -> None:
            for n in (0, 1):
                self.on_adc(f"v{n}", Volts(), adc="C", channel=n, faces=[Face("level_v", "V", 0, 3)])

    board = Two()
    board.part("v1").put("level_v", 2.5)
    assert board.analog["C"][1].source.volts(0) == 2.5
    assert board.analog["C"][0].source.volts(0) == 1.0
    assert list(board.find(Volts)) == ["v0", "v1"]
    with pytest.raises(ValueError, match="one voltage for this, and has 2: v0, v1"):
        board.only(Volts, "voltage")
    with pytest.raises(ValueError, match="no part 'v2': v0, v1"):
        board.part("v2")


def test_a_gyro_on_an_i2c_answers_to_its_address_alone() -> None:
    class OnI2c(Board):
        i2c_pins: ClassVar[Mapping[str, tuple[int, int]]] = {"A": (32, 33)}

        def solder(self) -> None:
            gyro = L3G4200D(self.clock, rng=self.rng("gyro"), ideal=self.ideal, report=self.reports)
            self.on_i2c("gyro", gyro.i2c, bus="A", address=gyro.i2c.address)

    board = OnI2c()
    assert board.part("gyro").pins == {"SDA": "GPIO32", "SCL": "GPIO33"}
    bus = board.i2c_bus["A"]
    assert bus.connected is False, "the pins belong to nobody yet"
    for pin in (32, 33):
        board.device_functions.GPIO_SetupPinMux(pin, 0, 1)
    for address, answers in ((0x68, True), (0x50, False)):
        bus.start()
        assert bus.address(address, False) is answers
    with pytest.raises(ValueError, match="I2C-C"):
        board.on_i2c("other", L3G4200D(board.clock, rng=board.rng("x")).i2c, bus="C", address=0x10)


def test_two_parts_at_one_place_are_a_conflict_with_both_names() -> None:
    class Voltage:
        def volts(self, cycles: int) -> float:
            return 1.0

    board = Board()
    first, second = (L3G4200D(board.clock, rng=board.rng(name)) for name in ("first", "second"))
    board.on_i2c("first", first.i2c, bus="A", address=0x68)
    board.on_i2c("elsewhere", second.i2c, bus="B", address=0x68)
    with pytest.raises(ValueError, match="first and second are both at address 0x68 of I2C-A"):
        board.on_i2c("second", second.i2c, bus="A", address=0x68)
    board.on_spi("third", first, bus="A", select=61)
    with pytest.raises(ValueError, match="third and fourth are both at chip select GPIO61 of SPI-A"):
        board.on_spi("fourth", second, bus="A", select=61)
    board.on_adc("infrared", Voltage(), adc="B", channel=3)
    with pytest.raises(ValueError, match="ADCINB3 has two sources: infrared and light"):
        board.on_adc("light", Voltage(), adc="B", channel=3)
    Outside(board).adc_volts(3, 2.5, adc="B")
    assert board.analog["B"][3].source.volts(0) == 2.5, "a test unplugs the part"
    assert list(board.parts) == ["first", "elsewhere", "third", "infrared"]


def test_hil_board_shows_parts_pins_and_faces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "station.py").write_text(BOARD)
    assert invoke(["board", str(tmp_path / "station.py"), "--json"]) == 0
    parts = {part["name"]: part for part in json.loads(capsys.readouterr().out)["parts"]}
    assert parts["thermometer"]["pins"] == {"SIMO": "GPIO63", "SOMI": "GPIO64", "CLK": "GPIO65", "CS": "GPIO66"}
    assert parts["infrared"]["faces"] == [{"name": "distance_m", "unit": "m", "low": 0.08, "high": 2.0}]
    assert invoke(["board"]) == 0
    shown = capsys.readouterr().out
    assert "L3G4200D" in shown
    assert "FRONT ADCINA3" in shown
    assert invoke(["board", "mine"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_face_may_be_worked_out_by_the_part_or_asked_for_by_a_function() -> None:
    class Lamp:
        level = 1

        @property
        def lux(self) -> float:
            return 100.0 / self.level

    lamp = Lamp()
    faces = [Face("lux", "lx"), Face("level", "", 0, 3), Face("heat", "W", get=lambda: 2.0 * lamp.level)]

    class Lit(Board):
        def solder(self) -> None:
            self.add("lamp", lamp, faces=faces)

    part = Lit().part("lamp")
    part.put("level", 2)
    assert [part.value(face.name) for face in faces] == [50.0, 2.0, 4.0]
    assert [part.is_set(face.name) for face in faces] == [False, True, False]
    for name in ("lux", "heat"):
        with pytest.raises(ValueError, match=f"lamp.{name} can only be read"):
            part.put(name, 1.0)
    part.put("level", 0)
    assert part.value("lux") is None, "a look that fails ends nothing"
    assert [str(face) for face in faces] == ["lux (lx)", "level (0 to 3)", "heat (W)"]


HEAP = """
#include <stdlib.h>

unsigned Blocks(unsigned words)
{
    unsigned n = 0;
    while (n < 1000 && malloc(words) != NULL) n++;
    return n;
}
"""


@pytest.mark.parametrize(("words", "blocks"), [(64, 5), (None, 341)])
def test_the_heap_is_as_large_as_the_board_says(tmp_path: Path, words: int | None, blocks: int) -> None:
    # A block of 8 words takes 12: malloc lays a header of 4 before it.  64 = 5 * 12 + 4, 4096 = 341 * 12 + 4.
    class Small(Board):
        """What the linker would be told by -heap 64, or nothing."""

        if words is not None:
            heap_words = words

    (tmp_path / "heap.c").write_text(HEAP, encoding="utf-8")
    assert link(Small(), [str(tmp_path / "heap.c")]).heap.Blocks(8) == blocks


def test_a_heap_without_room_for_a_block_is_refused() -> None:
    class Tiny(Board):
        """Too small."""

        heap_words = 3

    with pytest.raises(ValueError, match="a heap of 3 words is too small: expected at least 4"):
        Tiny()
